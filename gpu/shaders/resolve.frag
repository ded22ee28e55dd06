// resolve.frag: the accumulated state as premultiplied colour.
#include "state.glsl"
uniform sampler2D state_color;
uniform vec3 color_most; // of the function: rounding may leave a little more light than opacity and colours allow
layout(location = 0) out vec4 out_rgba;
void main()
{
    vec4 color = texelFetch(state_color, ivec2(gl_FragCoord.xy), 0);
    float opacity = state_opacity(color);
    out_rgba = vec4(clamp(color.rgb, vec3(0.0), opacity * color_most), opacity); // or -1e-9
}
