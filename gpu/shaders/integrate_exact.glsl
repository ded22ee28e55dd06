// integrate_exact.glsl: segments are cut at the function's knots and integrated piece by piece (pieces.glsl). The error
// does not depend on the resolution of any table; the cost grows with the knots that are crossed.
#include "pieces.glsl"

uniform vec2 tf_map; // scalar → x = s * tf_map.x + tf_map.y

vec2 kept_map = vec2(0.0);

struct Integral {
    Gathered sum;
    Place at;
};

float tf_place(float s)
{
#ifdef NONFINITE
    s = isnan(s) ? 0.0 : s; // of a cell that contributes nothing
#endif
    return s * kept_map.x + kept_map.y;
}

Integral integral_begin(vec4 color, float s)
{
    kept_map = keep(tf_map);
    pieces_begin();
    Integral i;
    i.sum = gathered_begin(color);
    i.at = place_at(tf_place(s));
    return i;
}

// The scalar jumps to s without a segment.
void integral_enter(inout Integral i, float s)
{
    i.at = place_at(tf_place(s));
}

// A segment of length l (unit distances) over which the scalar runs linearly from the last one to s. Its pieces are added by
// the rounds that follow.
void integral_add(inout Integral i, float s, float l)
{
    piece_begin(i.at, tf_place(s), l);
}

bool integral_round(inout Integral i)
{
    return piece_round(i.sum, i.at);
}

bool integral_waits(Integral i)
{
    return false;
}

// The ray ends where the scalar is s.
void integral_stop(inout Integral i, float s)
{
    gathered_absorb_half(i.sum, i.at.front.rgb); //@or exact_rest
}

#ifdef NAN_COLOR
// A segment of length l of one colour: r, g, b and attenuation per unit distance. The scalar is not known behind it.
void integral_add_constant(inout Integral i, vec4 color, float l)
{
    gathered_add(i.sum, color.rgb, color.a * l);
}
#endif

float integral_transmittance(Integral i)
{
    return i.sum.transmittance;
}

vec4 integral_end(Integral i)
{
    return gathered_end(i.sum);
}
