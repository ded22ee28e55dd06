// emission.glsl: light that nothing absorbs: the integral of colour times attenuation. Both are linear in a piece, so that
// Simpson's rule is exact. What is left is no opacity, but light to be added to what lies behind; geometry alone hides some of
// it.

//@section piece_light
    g.rgb += g.transmittance * part * (1.0 / 6.0) * (p.front.rgb * (2.0 * p.front.a + back.a) + back.rgb * (p.front.a + 2.0 * back.a));

//@section gathered_light
    g.rgb += g.transmittance * color * t;

//@section resolved
    return vec4(max(color.rgb, vec3(0.0)), state_opacity(color));
