// spread.frag: adaptive sampling: with blending by GL_MAX, the most of each channel among a pixel's rays, and the least.
#include "resolved.glsl"
layout(location = 0) out vec4 out_most;
layout(location = 1) out vec4 out_least; // negative, so that the least is the greatest
void main()
{
    vec4 color = resolved(ivec2(gl_FragCoord.xy)); //@then spread_behind
    out_most = color;
    out_least = -color;
}
