// integrate_table.glsl: a segment's colour and opacity from the three-dimensional pre-integrated table
// (Röttger et al. 2000; Weiler et al. 2003, 3.3 and 4; transfer_functions/table.h).

uniform sampler3D tf_table;      // associated colour and opacity over (front, back, length)
uniform vec2 tf_map;             // scalar → x = s * tf_map.x + tf_map.y in [0, 1]
uniform vec2 tf_texel[3];        // x front, x back, length in unit distances → texture coordinate v * .x + .y

struct Integral {
    vec4 color; // rgb, transmittance
    float front;
};

vec3 tf_coordinate(float front, float back, float l)
{
    // max() and min() drop a NaN, of a cell that contributes nothing.
    vec2 x = clamp(vec2(front, back) * tf_map.x + tf_map.y, 0.0, 1.0);
    return vec3(x.x * tf_texel[0].x + tf_texel[0].y, x.y * tf_texel[1].x + tf_texel[1].y, l * tf_texel[2].x + tf_texel[2].y);
}

Integral integral_begin(vec4 color, float s)
{
    return Integral(color, s);
}

void integral_enter(inout Integral i, float s)
{
    i.front = s;
}

#ifdef TF_TABLE_FLOAT
// Opacity is interpolated linearly between the table's lengths; where cells are much shorter than the longest one that adds
// up. Optical depth, however, is linear in length: with n steps of the table's length and the share f of one more,
//   y = -log(1 - a) = (n + f) x - f (1 - f) x^2 / 2 + O(x^3)
// for the optical depth x of one step. Solved for x by iteration, this gives (n + f) x. What to multiply a by: near
// 1 + missing a for a small a, of which 1 - a would lose the digits.
float length_correction(float a, float steps)
{
    float f = fract(steps), y = a < 1.0e-3 ? a * (1.0 + a * (0.5 + a * (1.0 / 3.0))) : -log(max(1.0 - a, 1.0e-6));
    float missing = 0.5 * f * (1.0 - f) / max(steps * steps, 1.0e-12);
    float depth = y + missing * y * y;
    depth = y + missing * depth * depth;
    depth = y + missing * depth * depth;
    float opacity = depth < 0.01 ? depth * (1.0 - depth * (0.5 - depth * (1.0 / 6.0))) : 1.0 - exp(-depth);
    return a > 0.0 ? min(opacity, 1.0) / a : 1.0;
}
#endif

// A segment of length l (unit distances) over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    vec3 at = tf_coordinate(i.front, s, l);
    vec4 c = textureLod(tf_table, at, 0.0);
    c *= l > 0.0 ? 1.0 : 0.0;
#ifdef TF_TABLE_FLOAT
    c *= length_correction(c.a, at.z * float(textureSize(tf_table, 0).z) - 0.5);
#endif
    i.color.rgb += i.color.a * c.rgb;
    i.color.a *= 1.0 - c.a;
    i.front = s;
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
