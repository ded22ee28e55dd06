// surface.glsl: what a surface without thickness does to a ray.

//@section march_declare
const float SURFACE_CLEAR = 1.0e-30; // light that an opaque one leaves, so that its depth is a number

void gathered_surface(inout Gathered g, vec3 color, float opacity)
{
    float clear = max(1.0 - opacity, SURFACE_CLEAR);
    g.rgb += g.transmittance * opacity * color; //@or surface_light
    g.transmittance *= clear; //@or surface_light
    g.depth -= log(clear); //@or surface_light
}
