// state.glsl: what the accumulated colour texture means. Its fourth channel is the optical depth so far (running integrals,
// COLOR_HOLDS_DEPTH) or the transmittance (table).
#ifdef COLOR_HOLDS_DEPTH
const vec4 STATE_EMPTY = vec4(0.0); // tc_march_clear
#else
const vec4 STATE_EMPTY = vec4(0.0, 0.0, 0.0, 1.0);
#endif

float state_transmittance(vec4 color)
{
#ifdef COLOR_HOLDS_DEPTH
    return exp(-color.a);
#else
    return color.a;
#endif
}

float state_opacity(vec4 color)
{
#ifdef COLOR_HOLDS_DEPTH
    float t = color.a;
    return t < 0.01 ? t * (1.0 - t * (0.5 - t * (1.0 / 6.0))) : 1.0 - exp(-t); // digits of small opacities
#else
    return 1.0 - color.a;
#endif
}
