// integrate_depth.glsl: what the integrators share that sum optical depth.
// Depth is summed, not transmittance multiplied: exp() errs once per ray, not once per segment.
#include "fetch.glsl"

struct Gathered {
    vec3 rgb;
    float depth;         // optical depth so far
    float transmittance; // exp(-depth)
}; //@then gathered_declare

Gathered gathered_begin(vec4 color)
{
    return Gathered(color.rgb, color.a, exp(-color.a));
}

vec4 gathered_end(Gathered g)
{
    return vec4(g.rgb, g.depth);
}

// A stretch of optical depth t of one colour.
void gathered_add(inout Gathered g, vec3 color, float t)
{
    g.depth += t; //@or gathered_light
    float transmittance = exp(-g.depth); //@or gathered_light
    g.rgb += color * (g.transmittance - transmittance); //@or gathered_light
    g.transmittance = transmittance; //@or gathered_light
}

// Half of what is left is absorbed, in this colour.
void gathered_absorb_half(inout Gathered g, vec3 color)
{
    g.depth += 0.69314718;
    g.transmittance *= 0.5;
    g.rgb += g.transmittance * color;
}
