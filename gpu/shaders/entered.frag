// entered.frag: draws the pixels whose ray enters the mesh, for an occlusion query to count.
uniform isampler2D state_walk;

void main()
{
    if (texelFetch(state_walk, ivec2(gl_FragCoord.xy), 0).x < 0)
        discard;
}
