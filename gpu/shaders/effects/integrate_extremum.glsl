// integrate_extremum.glsl: the largest scalar that a ray meets, or with PROJECT_LEAST the least. Along a segment it is linear,
// so that the ends of segments, which have a length, are all that there is to look at. Gathered: that scalar, 1.

// No packed scalar, which are 0 … 1.
#ifdef PROJECT_LEAST
const float NOTHING_MET = 1.0e30;
#define EXTREMUM min
#else
const float NOTHING_MET = -1.0e30;
#define EXTREMUM max
#endif

struct Integral {
    float found, front;
};

Integral integral_begin(vec4 color, float s)
{
    return Integral(color.y > 0.0 ? color.x : NOTHING_MET, s);
}

// The scalar jumps to s without a segment.
void integral_enter(inout Integral i, float s)
{
    i.front = s;
}

// A segment of length l over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    float ends = EXTREMUM(i.front, s);
    i.found = l > 0.0 ? EXTREMUM(i.found, ends) : i.found;
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
    return i.found == NOTHING_MET ? vec4(0.0) : vec4(i.found, 1.0, 0.0, 0.0);
}
