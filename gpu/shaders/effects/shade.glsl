// shade.glsl: light on a volume: the mean of what it makes of a colour at the two ends of the ray's part in a cell holds for
// all that this part adds to the ray.

//@section parts_declare
uniform float shade_soft; // gradients far below it leave colours as they are
float shade_kept_soft = 0.0;
Light shade_light = LIGHT_NONE; // on the part
Light shade_last = LIGHT_NONE;  // on the part behind which a ray leaves the loop over steps to have something added
#ifdef GRADIENT_VERTEX
Light shade_face = LIGHT_NONE; // where the ray meets the walk's face
#endif
vec3 shade_rgb = vec3(0.0); // what the ray gathered before
float shade_clear = 1.0;

// For a gradient g; `inverse` is 1 over its length.
Light shade_of(vec3 g, float inverse, Ray ray)
{
    Light light = light_of(g * -inverse, ray, SHADE_ONE_SIDED);
    float m = 1.0 / (1.0 + shade_kept_soft * inverse);
    bool none = !(inverse > 0.0 && inverse < 1.0e30); // 0, or not finite
    light.gain = none ? LIGHT_NONE.gain : 1.0 + m * (light.gain - 1.0);
    light.glow = none ? LIGHT_NONE.glow : m * light.glow;
    return light;
}

#ifdef GRADIENT_VERTEX
Light shade_of(vec3 g, Ray ray)
{
    return shade_of(g, inversesqrt(dot(g, g)), ray);
}
#endif

void shade_keep(Integral integral)
{
    shade_rgb = integral.sum.rgb;
    shade_clear = integral.sum.transmittance;
}

// Lights what was added since.
void shade_sum(inout Integral integral, Light light)
{
    integral.sum.rgb =
        shade_rgb + (integral.sum.rgb - shade_rgb) * light.gain + light.glow * (shade_clear - integral.sum.transmittance);
    shade_keep(integral);
}

//@section march_begin
    shade_kept_soft = keep(shade_soft);
#ifdef GRADIENT_VERTEX
    shade_face = shade_of(gradient_face, ray);
#endif

//@section part_begin
#ifdef GRADIENT_VERTEX
    Light shade_from = shade_face;
#ifdef CLIP_NEAR
    // A ray is cut once: a second round where one of the group is spares all others the light on its cut.
    bool shade_cut = segment.z0 > gradient_z0, shade_again;
    vec3 shade_gradient = shade_cut ? gradient_from : gradient_to;
    do {
        shade_face = shade_of(shade_gradient, ray);
        shade_again = shade_cut;
        if (shade_cut)
            shade_from = shade_face;
        shade_cut = false;
        shade_gradient = gradient_to;
    } while (shade_again);
#else
    shade_face = shade_of(gradient_to, ray);
#endif
    shade_light.gain = 0.5 * (shade_from.gain + shade_face.gain);
    shade_light.glow = 0.5 * (shade_from.glow + shade_face.glow);
#else
    shade_light = shade_of(gradient_cell.xyz, 1.0 / gradient_cell.w, ray);
#endif
#ifdef NAN_COLOR
    shade_light.gain = parts.constant ? LIGHT_NONE.gain : shade_light.gain; // the colour of missing values is not lit
    shade_light.glow = parts.constant ? LIGHT_NONE.glow : shade_light.glow;
#endif

//@section part_cut
    shade_keep(integral);

//@section part_done
                shade_sum(integral, shade_light);
                // Carried from round to round: of a light made anew in each, llvmpipe keeps, behind the loop, that of the
                // round in which the last lane left.
                bool shade_leaves = integral_waits(integral) || integral_transmittance(integral) <= march_least;
                shade_last.gain = shade_leaves ? shade_light.gain : shade_last.gain;
                shade_last.glow = shade_leaves ? shade_light.glow : shade_last.glow;

//@section march_settled
    shade_sum(integral, shade_last);

//@section march_rest
    shade_keep(integral);

//@section march_end
    shade_sum(integral, shade_last);
