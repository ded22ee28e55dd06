// integrate_integral.glsl: a segment's colour and opacity from one-dimensional running integrals of the transfer function
// (transfer_functions/running.h). Density emitter: Weiler et al. 2003, eq. 3 and 4.
//
// Optical depth is exact up to the sampling of the function. For the colour, the mean over the segment is exact, and its
// drift from front to back is taken as linear in optical depth:
//   C = T0 [ c (1 - e^-t) - (c_b - c_f) k(t) ],  k(t) = (1 + e^-t)/2 - (1 - e^-t)/t ≈ t^2 / (12 + 6 t + 2 t^2)
// (the same to order t^3 and in the limit, within 0.008 between).
// Optical depth is summed, not transmittance multiplied: exp() errs once per ray, not once per segment.

uniform samplerBuffer tf_nodes; // two a node: (tau rgb, tau) there; running integral of the same over x, its mean slope taken out
uniform vec4 tf_mean;           // that slope
uniform vec2 tf_map;            // scalar → x = s * tf_map.x + tf_map.y, 0 … 1 between the end nodes
uniform vec2 tf_grid;           // intervals between nodes, and the length of one

// Below this difference of x the mean is the average of the ends: the difference of two cumulatives would have lost its
// digits.
const float TF_NEAR = 1.0 / 2048.0;

struct TfSample {
    float x;
    vec4 point, cumulative;
};

struct Integral {
    vec3 rgb;
    float depth;         // optical depth so far
    float transmittance; // exp(-depth)
    TfSample front;
};

// The nearest node, and the integral from there on with the function's value at the node.
TfSample tf_sample(float s)
{
    TfSample f;
    f.x = s * tf_map.x + tf_map.y;
#ifdef TF_EXTEND // the data reach beyond the function's knots, where it is constant
    int node = int(clamp(f.x, 0.0, 1.0) * tf_grid.x + 0.5);
#else
    int node = int(f.x * tf_grid.x + 0.5);
#endif
    f.point = texelFetch(tf_nodes, 2 * node);
    f.cumulative = texelFetch(tf_nodes, 2 * node + 1) + (f.point - tf_mean) * (f.x - float(node) * tf_grid.y);
    return f;
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

// A segment of length l (unit distances) over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    TfSample back = tf_sample(s);
    float dx = back.x - i.front.x;
    bool near = abs(dx) < TF_NEAR;
    vec4 mean = near ? 0.5 * (i.front.point + back.point)
                     : tf_mean + (back.cumulative - i.front.cumulative) * (1.0 / (near ? 1.0 : dx));
    float t = max(l * mean.a, 0.0);
    i.depth += t;
    float transmittance = exp(-i.depth);
    float inverse = mean.a > 0.0 ? 1.0 / mean.a : 0.0;
    float e = (i.transmittance - transmittance) * inverse;
    float k = i.transmittance * inverse * t * t / (12.0 + t * (6.0 + 2.0 * t));
    i.rgb += mean.rgb * (e + k * inverse * (back.point.a - i.front.point.a)) - k * (back.point.rgb - i.front.point.rgb);
    i.transmittance = transmittance;
    i.front = back;
}

float integral_transmittance(Integral i)
{
    return i.transmittance;
}

vec4 integral_end(Integral i)
{
    return vec4(i.rgb, i.depth);
}
