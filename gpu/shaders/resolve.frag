// resolve.frag: the accumulated state as premultiplied colour.
#include "state.glsl"
uniform sampler2D state_color;
layout(location = 0) out vec4 out_rgba;
void main()
{
    vec4 color = texelFetch(state_color, ivec2(gl_FragCoord.xy), 0);
    out_rgba = vec4(max(color.rgb, 0.0), state_opacity(color)); // rounding may leave -1e-9
}
