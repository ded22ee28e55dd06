// mask.frag: adaptive sampling: marks the pixels whose rays differ, and empties them for a finer grid of rays.
uniform sampler2D spread_most, spread_least; // of spread.frag
uniform float spread_limit;
layout(location = 0) out vec4 out_rgba;
layout(location = 1) out uint out_mask;
void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 spread = texelFetch(spread_most, pixel, 0) + texelFetch(spread_least, pixel, 0);
    if (all(lessThanEqual(spread, vec4(spread_limit))))
        discard;
    out_rgba = vec4(0.0);
    out_mask = 1u;
}
