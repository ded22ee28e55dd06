// integrate_drift.glsl: a segment's colour and opacity from integrals of the transfer function (transfer_functions/means.h)
// and a three-dimensional table of what they leave out of the colour (transfer_functions/drift.h).
// Weiler et al. 2003, eq. 3 and 4: optical depth t is the mean extinction times l; the colour over the opacity is the mean
// one, each place weighted by its extinction, and the table's drift towards the front.

#include "integrate_depth.glsl"

uniform sampler3D tf_table; // drift over (front, back, length)
uniform vec2 tf_map;        // scalar → x = s * tf_map.x + tf_map.y in [0, 1]
uniform vec2 tf_texel[2];   // x front, x back → texture coordinate v * .x + .y
FETCH_BUFFER(2) tf_cells; // three an interval of x: mean (tau rgb, tau) in it; integral up to it, and what that was rounded by
uniform vec2 tf_grid;     // intervals, a power of two, and the length of one: their places are exact
uniform vec3 tf_octave;   // l → octaves of the length axis; those → texture coordinate v * .y + .z
uniform vec3 tf_most;     // largest r, g, b of the function

vec2 kept_texel[2] = vec2[](vec2(0.0), vec2(0.0));
vec3 kept_octave = vec3(0.0), kept_most = vec3(0.0);

struct TfSample {
    float x;
    vec4 sum, rest; // integral of (tau rgb, tau) up to x: sum + rest
};

struct Integral {
    Gathered gathered;
    TfSample front;
};

vec4 tf_cell(int cell, float x, out TfSample f)
{
    vec4 mean = fetch(tf_cells, 3 * cell);
    float part = x - float(cell) * tf_grid.y;
    f.x = x;
    f.sum = fetch(tf_cells, 3 * cell + 1);
    f.rest = fetch(tf_cells, 3 * cell + 2);
#ifdef TF_STEPS
    if (mean.a < 0.0) { // place of the step, and where the means before and behind it are
        float behind = part - mean.x;
        int record = int(mean.y);
        part = min(part, mean.x);
        mean = fetch(tf_cells, record);
        if (behind >= 0.0) {
            f.rest += mean * part;
            part = behind;
            mean = fetch(tf_cells, record + 1);
        }
    }
#endif
    f.rest += mean * part;
    return mean;
}

// max() and min() drop a NaN, of a cell that contributes nothing. Returns the mean of (tau rgb, tau) around.
vec4 tf_sample(float s, out TfSample f)
{
    float x = clamp(s * tf_map.x + tf_map.y, 0.0, 1.0);
    return tf_cell(min(int(x * tf_grid.x), int(tf_grid.x) - 1), x, f);
}

// Texture coordinate of a length: entries up to the first whole octave are equally far apart, as are those of each octave
// from there on, so that the exponent and the mantissa together count them.
float tf_length(float l)
{
    float v = l * kept_octave.x;
    float octaves = float(floatBitsToInt(v) - 0x3f800000) * (1.0 / 8388608.0) + 1.0;
    return (v < 1.0 ? v : octaves) * kept_octave.y + kept_octave.z;
}

Integral integral_begin(vec4 color, float s)
{
    kept_texel[0] = keep(tf_texel[0]);
    kept_texel[1] = keep(tf_texel[1]);
    kept_octave = keep(tf_octave);
    kept_most = keep(tf_most);
    Integral i;
    i.gathered = gathered_begin(color);
    tf_sample(s, i.front);
    return i;
}

// The scalar jumps to s without a segment.
void integral_enter(inout Integral i, float s)
{
    tf_sample(s, i.front);
}

// A segment of length l (unit distances) over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    TfSample back;
    vec4 around = tf_sample(s, back);
    float dx = back.x - i.front.x;
    vec4 between = ((back.sum - i.front.sum) + (back.rest - i.front.rest)) * (1.0 / (dx == 0.0 ? 1.0 : dx));
    vec4 mean = dx == 0.0 ? around : between;
    vec2 at = vec2(i.front.x, back.x) * vec2(kept_texel[0].x, kept_texel[1].x) + vec2(kept_texel[0].y, kept_texel[1].y);
    vec3 drift = textureLod(tf_table, vec3(at, tf_length(l)), 0.0).rgb;
    vec3 color = clamp(mean.rgb * (mean.a > 1.0e-37 ? 1.0 / mean.a : 0.0) + drift, vec3(0.0), kept_most);
    gathered_add(i.gathered, color, max(l * mean.a, 0.0));
    i.front = back;
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

// The ray ends where the scalar is s.
void integral_stop(inout Integral i, float s)
{
    TfSample f;
    integral_enter(i, s);
    vec4 here = tf_cell(min(int(i.front.x * tf_grid.x), int(tf_grid.x) - 1), i.front.x, f);
    gathered_absorb_half(i.gathered, here.a > 1.0e-37 ? here.rgb / here.a : vec3(0.0));
}

#ifdef NAN_COLOR
// A segment of length l of one colour: r, g, b and attenuation per unit distance. The scalar is not known behind it.
void integral_add_constant(inout Integral i, vec4 color, float l)
{
    gathered_add(i.gathered, color.rgb, color.a * l);
}
#endif

float integral_transmittance(Integral i)
{
    return i.gathered.transmittance;
}

vec4 integral_end(Integral i)
{
    return gathered_end(i.gathered);
}
