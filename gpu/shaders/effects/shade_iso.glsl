// shade_iso.glsl: light on isosurfaces, by the gradient where the ray crosses them.

//@section parts_declare
// For a gradient g; `inverse` is 1 over its length.
vec3 shade_surface(vec3 color, vec3 g, float inverse, Ray ray)
{
    Light light = light_of(g * -inverse, ray, SHADE_ONE_SIDED);
    return inverse > 0.0 && inverse < 1.0e30 ? color * light.gain + light.glow : color;
}

//@section iso_color
#ifdef GRADIENT_VERTEX
                    vec3 gradient_here = mix(gradient_from, gradient_to, parts.to);
                    float gradient_inverse = inversesqrt(dot(gradient_here, gradient_here));
#else
                    vec3 gradient_here = gradient_cell.xyz;
                    float gradient_inverse = 1.0 / gradient_cell.w;
#endif
                    iso.rgb = shade_surface(iso.rgb, gradient_here, gradient_inverse, ray);
