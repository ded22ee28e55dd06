// kept.frag: a picture along kept walks (stepper_kept.glsl), whole in one pass: from the beginning of a ray's records to its
// colour in the picture. A ray that has not come to its end is discarded, for the occlusion query around the pass to miss.
#include "march.glsl"
#include "resolved.glsl"

uniform isampler2D kept_first; // 1 + the ray's first record; the one behind its last; 0: none
layout(location = 0) out vec4 out_rgba;

void main()
{
    ivec2 first = texelFetch(kept_first, ivec2(gl_FragCoord.xy), 0).xy;
    ivec4 walk = ivec4(first.x - 1, first.y, 0, 0), at = ivec4(0, 0, -1, 0);
    vec4 color = STATE_EMPTY;
    if (walk.x >= 0)
        march(walk, color, at, gl_FragCoord.xy);
    if (walk.x >= 0)
        discard;
    out_rgba = resolved_color(color);
}
