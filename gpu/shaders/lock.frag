// lock.frag: the z-update pass (Weiler et al. 2003, 5.2): pixels of finished rays get the near depth, so that the early
// depth test keeps later passes away. The occlusion query around it counts rays that finished since the last one.
uniform isampler2D state_walk;
void main()
{
    if (texelFetch(state_walk, ivec2(gl_FragCoord.xy), 0).x >= 0)
        discard;
    gl_FragDepth = 0.0;
}
