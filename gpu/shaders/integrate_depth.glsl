// integrate_depth.glsl: what the integrators share whose state is colour and optical depth (struct Integral is theirs).

#ifdef NAN_COLOR
// A segment of length l of one colour: r, g, b and attenuation per unit distance. The scalar is not known behind it.
void integral_add_constant(inout Integral i, vec4 color, float l)
{
    i.depth += color.a * l;
    float transmittance = exp(-i.depth);
    i.rgb += color.rgb * (i.transmittance - transmittance);
    i.transmittance = transmittance;
}
#endif

float integral_transmittance(Integral i)
{
    return i.transmittance;
}

vec4 integral_end(Integral i)
{
    return vec4(i.rgb, i.depth);
}
