// integrate_none.glsl: nothing between surfaces.
#include "integrate_depth.glsl" //@then pieces_declare

struct Integral {
    Gathered sum;
};

Integral integral_begin(vec4 color, float s)
{
    return Integral(gathered_begin(color));
}

void integral_enter(inout Integral i, float s)
{
}

void integral_add(inout Integral i, float s, float l)
{
}

#include "effects/integrate_at_once.glsl"

float integral_transmittance(Integral i)
{
    return i.sum.transmittance;
}

vec4 integral_end(Integral i)
{
    return gathered_end(i.sum);
}
