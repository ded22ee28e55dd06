// integrate_table.glsl: a segment's colour and opacity from the three-dimensional pre-integrated table
// (Röttger et al. 2000; Weiler et al. 2003, 3.3 and 4; transfer_functions/table.h).
#include "fetch.glsl"

uniform sampler3D tf_table;      // associated colour and opacity over (front, back, length)
uniform vec2 tf_map;             // scalar → x = s * tf_map.x + tf_map.y in [0, 1]
uniform vec2 tf_texel[3];        // x front, x back, length in unit distances → texture coordinate v * .x + .y

vec2 kept_map = vec2(0.0), kept_texel[3] = vec2[](vec2(0.0), vec2(0.0), vec2(0.0));

struct Integral {
    vec4 color; // rgb, transmittance
    float front;
};

vec3 tf_coordinate(float front, float back, float l)
{
    // max() and min() drop a NaN, of a cell that contributes nothing.
    vec2 x = clamp(vec2(front, back) * kept_map.x + kept_map.y, 0.0, 1.0);
    return vec3(x.x * kept_texel[0].x + kept_texel[0].y, x.y * kept_texel[1].x + kept_texel[1].y, l * kept_texel[2].x + kept_texel[2].y);
}

Integral integral_begin(vec4 color, float s)
{
    kept_map = keep(tf_map);
    for (int k = 0; k < 3; k++)
        kept_texel[k] = keep(tf_texel[k]);
    return Integral(color, s);
}

void integral_enter(inout Integral i, float s)
{
    i.front = s;
}

// A segment of length l (unit distances) over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    vec3 at = tf_coordinate(i.front, s, l);
    vec4 c = textureLod(tf_table, at, 0.0);
    c *= l > 0.0 ? 1.0 : 0.0;
    i.color.rgb += i.color.a * c.rgb;
    i.color.a *= 1.0 - c.a;
    i.front = s;
}

// A segment is added at once; no round need follow.
bool integral_round(inout Integral i)
{
    return false;
}

bool integral_waits(Integral i)
{
    return false;
}

// As the paper: a ray that is stopped stays as it is.
void integral_stop(inout Integral i, float s)
{
}

#ifdef NAN_COLOR
// A segment of length l of one colour: r, g, b and attenuation per unit distance. The scalar is not known behind it.
void integral_add_constant(inout Integral i, vec4 color, float l)
{
    float clear = exp(-color.a * l);
    i.color.rgb += i.color.a * (1.0 - clear) * color.rgb;
    i.color.a *= clear;
}
#endif

float integral_transmittance(Integral i)
{
    return i.color.a;
}

vec4 integral_end(Integral i)
{
    return i.color;
}
