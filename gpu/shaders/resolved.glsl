// resolved.glsl: what a ray gathered as premultiplied colour.
#include "state.glsl"
uniform sampler2D state_color;
uniform vec3 color_most; // of the function: rounding may leave a little more light than opacity and colours allow //@then resolved_declare

vec4 resolved_color(vec4 color)
{
    float opacity = state_opacity(color); //@or resolved
    return vec4(clamp(color.rgb, vec3(0.0), opacity * color_most), opacity); // or -1e-9 //@or resolved
}

vec4 resolved(ivec2 pixel)
{
    return resolved_color(texelFetch(state_color, pixel, 0));
}
