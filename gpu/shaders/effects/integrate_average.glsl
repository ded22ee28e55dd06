// integrate_average.glsl: the mean of the scalar over a ray's length in cells. Gathered: its integral, the length.

struct Integral {
    vec2 sum;
    float front;
};

Integral integral_begin(vec4 color, float s)
{
    return Integral(color.xy, s);
}

// The scalar jumps to s without a segment.
void integral_enter(inout Integral i, float s)
{
    i.front = s;
}

// A segment of length l over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    i.sum += l * vec2(0.5 * (i.front + s), 1.0);
    i.front = s;
}

#include "effects/integrate_at_once.glsl"

// Nothing hides what lies behind.
float integral_transmittance(Integral i)
{
    return 1.0;
}

vec4 integral_end(Integral i)
{
    return vec4(i.sum, 0.0, 0.0);
}
