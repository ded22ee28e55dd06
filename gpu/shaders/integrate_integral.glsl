// integrate_integral.glsl: a segment's colour and opacity from one-dimensional running integrals of the transfer function
// (transfer_functions/running.h). Density emitter: Weiler et al. 2003, eq. 3 and 4.
//
// Optical depth is exact up to the sampling of the function. For the colour, the mean over the segment is exact, and its
// drift from front to back is taken as linear in optical depth:
//   C = T0 [ c (1 - e^-t) - (c_b - c_f) k(t) ],  k(t) = (1 + e^-t)/2 - (1 - e^-t)/t ≈ t^2 / (12 + 6 t + 2 t^2)
// (the same to order t^3 and in the limit, within 0.008 between). TF_FIRST_ORDER leaves the drift out; TF_SPLIT cuts
// segments of more optical depth than tf_split.
//
// TF_HARD: where the drift adds much it may not be linear, where x hardly changes the integrals' rounding grows, and a node
// beside a step, of attenuation 1e30, knows no mean. Such a segment waits, the ray leaves the inner loop, and integral_settle integrates it piece by piece.

#include "integrate_depth.glsl"
#ifdef TF_HARD
#include "pieces.glsl"
// The largest drift; that over the largest optical depth; that over the largest quotient of a length and its difference of
// x, by which the rounding of the integrals is multiplied.
uniform vec4 tf_hard;
const float TF_LEFT_OUT = 1.0e29; // below the attenuation of nodes that know no mean
#endif

FETCH_BUFFER(2) tf_nodes; // two a node: (tau rgb, tau) there less the mean; its running integral over x
uniform vec4 tf_mean;           // of (tau rgb, tau) over the nodes' span; taken out so that float keeps digits
uniform vec2 tf_map;            // scalar → x = s * tf_map.x + tf_map.y, 0 … 1 between the end nodes
uniform vec2 tf_grid;           // intervals between nodes, a power of two, and the length of one: places of nodes are exact

// Below this difference of x the mean is the average of the ends: the difference of two cumulatives would have lost its
// digits.
uniform float tf_near;
#ifdef TF_SPLIT
uniform float tf_split;
const float SPLIT_MOST = 256.0;
#endif

vec4 kept_mean = vec4(0.0);
float kept_near = 0.0;
#ifdef TF_SPLIT
float kept_split = 0.0;
#endif
#ifdef TF_HARD
vec4 kept_hard = vec4(0.0);
#endif

struct TfSample {
    float x;
#ifdef TF_EXTEND
    float beyond; // how far x lies outside the nodes, signed
#endif
    vec4 point, cumulative;
};

struct Integral {
    Gathered sum;
    TfSample front;
#ifdef TF_HARD
    float wait_from, wait_to, wait_length; // of the segment that waits for integral_settle; none: length 0
#endif
};

// The nearest node, and the integral from there on with the function's value at the node.
TfSample tf_sample_at(float x)
{
    TfSample f;
    f.x = x;
#ifdef TF_EXTEND // the data reach beyond the function's knots, where it is constant
    float inside = clamp(f.x, 0.0, 1.0);
    int node = int(inside * tf_grid.x + 0.5);
    f.beyond = f.x - inside;
#else
    int node = int(f.x * tf_grid.x + 0.5);
#endif
    f.point = fetch(tf_nodes, 2 * node);
    f.cumulative = fetch(tf_nodes, 2 * node + 1) + f.point * (f.x - float(node) * tf_grid.y);
    return f;
}

float tf_place(float s)
{
#ifdef NONFINITE
    s = isnan(s) ? 0.0 : s; // of a cell that contributes nothing
#endif
    return s * tf_map.x + tf_map.y;
}

TfSample tf_sample(float s)
{
    return tf_sample_at(tf_place(s));
}

Integral integral_begin(vec4 color, float s)
{
    kept_mean = keep(tf_mean);
    kept_near = keep(tf_near);
#ifdef TF_SPLIT
    kept_split = keep(tf_split);
#endif
#ifdef TF_HARD
    kept_hard = keep(tf_hard);
    pieces_begin();
#endif
    Integral i;
    i.sum = gathered_begin(color);
    i.front = tf_sample(s);
#ifdef TF_HARD
    i.wait_from = i.wait_to = i.wait_length = 0.0;
#endif
    return i;
}

// The scalar jumps to s without a segment.
void integral_enter(inout Integral i, float s)
{
    i.front = tf_sample(s);
}

// Mean of (tau rgb, tau) between two samples; by what the rounding of their integrals is multiplied.
vec4 tf_mean_between(TfSample front, TfSample back, out float rounding)
{
    float dx = back.x - front.x;
    bool near = abs(dx) < kept_near;
#ifdef TF_EXTEND
    near = near || front.beyond * back.beyond > 0.0; // constant there
#endif
    rounding = 1.0 / (near ? 1.0 : dx);
    vec4 ends = front.point + back.point, between = back.cumulative - front.cumulative;
    return kept_mean + (near ? ends : between) * (near ? 0.5 : rounding);
}

// Adds a piece of length l from the last sample to back. With TF_HARD nothing is added, and the piece waits, where its
// colour is not known well enough. Selections, not branches: lanes of one group differ here.
void integral_piece(inout Integral i, TfSample back, vec4 mean, float l, float rounding)
{
    float t = max(l * mean.a, 0.0);
    float inverse = mean.a > 1.0e-37 ? 1.0 / mean.a : 0.0;
    // The drift: k times the mean colour times what tau rises by, less what tau rgb rises by.
    float k = 0.0, rise = back.point.a - i.front.point.a;
#ifndef TF_FIRST_ORDER
    k = i.sum.transmittance * inverse * t * t / (12.0 + t * (6.0 + 2.0 * t));
#endif
#ifdef TF_HARD
    vec3 drift = k * (mean.rgb * (inverse * rise) - (back.point.rgb - i.front.point.rgb));
    float slope = mean.a > 0.0 ? abs(rounding) * kept_hard.z - mean.a * kept_hard.w : 0.0;
    float most = max(max(abs(drift.r), abs(drift.g)), max(abs(drift.b), l * max(abs(mean.a) * kept_hard.y, slope)));
    bool hard = !(most <= kept_hard.x) || max(i.front.point.a, back.point.a) > TF_LEFT_OUT, add = l > 0.0 && !hard;
    t = add ? t : 0.0;
    k = add ? k : 0.0;
    // Carried from round to round of the loop: of a value made anew in each, llvmpipe keeps, behind the loop, that of the
    // round in which the last lane left.
    i.wait_from = hard ? i.front.x : i.wait_from;
    i.wait_to = hard ? back.x : i.wait_to;
    i.wait_length = hard ? max(l, 0.0) : i.wait_length;
#endif
    i.sum.depth += t;
    float transmittance = exp(-i.sum.depth);
    i.sum.rgb += mean.rgb * (inverse * (i.sum.transmittance - transmittance + k * rise)) - k * (back.point.rgb - i.front.point.rgb);
    i.sum.transmittance = transmittance;
    i.front = back;
}

// A segment of length l (unit distances) over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    TfSample back = tf_sample(s);
    float rounding;
    vec4 mean = tf_mean_between(i.front, back, rounding);
#ifdef TF_SPLIT
    if (l * mean.a > kept_split) {
        float n = min(ceil(l * mean.a / kept_split), SPLIT_MOST), x = i.front.x, part = l / n;
        for (float k = 1.0; k < n; k += 1.0) {
            TfSample middle = tf_sample_at(mix(x, back.x, k / n));
            vec4 share = tf_mean_between(i.front, middle, rounding);
            integral_piece(i, middle, share, part, rounding);
        }
        mean = tf_mean_between(i.front, back, rounding);
        l = part;
    }
#endif
    integral_piece(i, back, mean, l, rounding);
}

// A segment is added at once; no round need follow.
bool integral_round(inout Integral i)
{
    return false;
}

bool integral_waits(Integral i)
{
#ifdef TF_HARD
    return i.wait_length > 0.0;
#else
    return false;
#endif
}

#ifdef TF_HARD
void integral_settle(inout Integral i)
{
    if (i.wait_length > 0.0) {
        Place p = place_at(i.wait_from);
        piece_begin(p, i.wait_to, i.wait_length);
        while (piece_round(i.sum, p))
            ;
        i.wait_length = 0.0;
    }
}
#endif

// The ray ends where the scalar is s.
void integral_stop(inout Integral i, float s)
{
#ifdef TF_HARD
    vec3 color = place_at(tf_place(s)).front.rgb;
#else
    vec4 here = kept_mean + tf_sample(s).point;
    vec3 color = here.a > 1.0e-37 ? here.rgb / here.a : vec3(0.0);
#endif
    gathered_absorb_half(i.sum, color);
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
