// integrate_integral.glsl: a segment's colour and opacity from one-dimensional running integrals of the transfer function
// (transfer_functions/running.h). Density emitter: Weiler et al. 2003, eq. 3 and 4.
//
// Optical depth is exact up to the sampling of the function. For the colour, the mean over the segment is exact, and its
// drift from front to back is taken as linear in optical depth:
//   C = T0 [ c (1 - e^-t) - (c_b - c_f) k(t) ],  k(t) = (1 + e^-t)/2 - (1 - e^-t)/t ≈ t^2 / (12 + 6 t + 2 t^2)
// (the same to order t^3 and in the limit, within 0.008 between). TF_FIRST_ORDER leaves the drift out; TF_SPLIT cuts
// segments of more optical depth than tf_split.
// Optical depth is summed, not transmittance multiplied: exp() errs once per ray, not once per segment.

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

struct TfSample {
    float x;
#ifdef TF_EXTEND
    float beyond; // how far x lies outside the nodes, signed
#endif
    vec4 point, cumulative;
};

struct Integral {
    vec3 rgb;
    float depth;         // optical depth so far
    float transmittance; // exp(-depth)
    TfSample front;
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

TfSample tf_sample(float s)
{
#ifdef NONFINITE
    s = isnan(s) ? 0.0 : s; // of a cell that contributes nothing
#endif
    return tf_sample_at(s * tf_map.x + tf_map.y);
}

Integral integral_begin(vec4 color, float s)
{
    Integral i;
    i.rgb = color.rgb;
    i.depth = color.a;
    i.transmittance = exp(-color.a);
    i.front = tf_sample(s);
    return i;
}

// The scalar jumps to s without a segment.
void integral_enter(inout Integral i, float s)
{
    i.front = tf_sample(s);
}

// Mean of (tau rgb, tau) between two samples.
vec4 tf_mean_between(TfSample front, TfSample back)
{
    float dx = back.x - front.x;
    bool near = abs(dx) < tf_near;
#ifdef TF_EXTEND
    near = near || front.beyond * back.beyond > 0.0; // constant there
#endif
    vec4 ends = tf_mean + 0.5 * (front.point + back.point);
    vec4 between = tf_mean + (back.cumulative - front.cumulative) * (1.0 / (near ? 1.0 : dx));
    return near ? ends : between;
}

// Adds a piece of optical depth t from the last sample to back.
void integral_piece(inout Integral i, TfSample back, vec4 mean, float t)
{
    i.depth += t;
    float transmittance = exp(-i.depth);
    float inverse = mean.a > 1.0e-37 ? 1.0 / mean.a : 0.0;
#ifdef TF_FIRST_ORDER
    vec3 c = mean.rgb * ((i.transmittance - transmittance) * inverse);
#else
    float k = i.transmittance * t * t / (12.0 + t * (6.0 + 2.0 * t));
    float e = (i.transmittance - transmittance) * inverse;
    k *= inverse;
    vec3 c = mean.rgb * (e + k * inverse * (back.point.a - i.front.point.a)) - k * (back.point.rgb - i.front.point.rgb);
#endif
    i.rgb += c;
    i.transmittance = transmittance;
    i.front = back;
}

// A segment of length l (unit distances) over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    TfSample back = tf_sample(s);
    vec4 mean = tf_mean_between(i.front, back);
#ifdef TF_SPLIT
    if (l * mean.a > tf_split) {
        float n = min(ceil(l * mean.a / tf_split), SPLIT_MOST), x = i.front.x, part = l / n;
        for (float k = 1.0; k < n; k += 1.0) {
            TfSample middle = tf_sample_at(mix(x, back.x, k / n));
            vec4 share = tf_mean_between(i.front, middle);
            integral_piece(i, middle, share, max(part * share.a, 0.0));
        }
        mean = tf_mean_between(i.front, back);
        l = part;
    }
#endif
    integral_piece(i, back, mean, max(l * mean.a, 0.0));
}

#include "integrate_depth.glsl"
