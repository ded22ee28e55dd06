// lost.frag: draws the pixels whose ray the stepper gave up (stepper_planes.glsl), for an occlusion query to count.
uniform isampler2D state_walk;

const int WALK_LOST = -3;

void main()
{
    if (texelFetch(state_walk, ivec2(gl_FragCoord.xy), 0).x != WALK_LOST)
        discard;
}
