// integrate_integral.glsl: a segment's colour and opacity from one-dimensional running integrals of the transfer function
// (transfer_functions/running.h). Density emitter: Weiler et al. 2003, eq. 3 and 4.
//
// Optical depth is exact up to the sampling of the function. For the colour, the mean over the segment is exact, and its
// drift from front to back is taken as linear in optical depth:
//   C = T0 [ c (1 - e^-t) + (c_b - c_f) k(t) ],  k(t) = (1 - e^-t)/t - (1 + e^-t)/2.
// Optical depth is summed, not transmittance multiplied: exp() errs once per ray, not once per segment.

uniform sampler1D tf_point;      // (tau rgb, tau) at x
uniform sampler1D tf_cumulative; // running integral of the same over x, its mean slope taken out
uniform vec4 tf_mean;            // that slope
uniform vec2 tf_map;             // scalar → x = s * tf_map.x + tf_map.y
uniform vec2 tf_texel;           // x → texture coordinate: x * tf_texel.x + tf_texel.y

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

TfSample tf_sample(float s)
{
    TfSample f;
    f.x = s * tf_map.x + tf_map.y;
#ifdef TF_EXTEND // the data reach beyond the function's knots, where it is constant
    float x = clamp(f.x, 0.0, 1.0);
    float t = x * tf_texel.x + tf_texel.y;
    f.point = textureLod(tf_point, t, 0.0);
    f.cumulative = textureLod(tf_cumulative, t, 0.0) + (f.point - tf_mean) * (f.x - x);
#else
    float t = f.x * tf_texel.x + tf_texel.y;
    f.point = textureLod(tf_point, t, 0.0);
    f.cumulative = textureLod(tf_cumulative, t, 0.0);
#endif
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

void integral_add(inout Integral i, Segment segment, float l)
{
    TfSample back = tf_sample(segment.s1);
    if (segment.real) {
        float dx = back.x - i.front.x;
        bool near = abs(dx) < TF_NEAR;
        vec4 mean = near ? 0.5 * (i.front.point + back.point)
                         : tf_mean + (back.cumulative - i.front.cumulative) / (near ? 1.0 : dx);
        float t = max(l * mean.a, 0.0);
        float depth = i.depth + t;
        float transmittance = exp(-depth);
        float e = i.transmittance - transmittance; // T0 (1 - e^-t)
        // k(t) T0, by its series where the difference would cancel
        float k = t < 0.25 ? i.transmittance * t * t * (t * (1.0 / 24.0 - t * (1.0 / 80.0)) - 1.0 / 12.0)
                           : e / t - 0.5 * (i.transmittance + transmittance);
        float inverse = mean.a > 0.0 ? 1.0 / mean.a : 0.0;
        vec3 c = mean.rgb * inverse;
        vec3 drift = (back.point.rgb - i.front.point.rgb - c * (back.point.a - i.front.point.a)) * inverse;
        i.rgb += max(c * e + drift * k, 0.0);
        i.depth = depth;
        i.transmittance = transmittance;
    }
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
