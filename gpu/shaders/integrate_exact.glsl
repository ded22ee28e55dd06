// integrate_exact.glsl: a segment's colour and opacity, linear piece by linear piece of the transfer function
// (transfer_functions/pieces.h): for functions with steps and spikes, or so dense that a cell is opaque.
// Density emitter: Weiler et al. 2003, eq. 3 and 4. Within a piece colour and extinction are linear in the scalar
// (Williams and Max 1992), so the optical depth q(u) up to the share u of it is quadratic and exact, and by parts
//   C = ∫ c dq e^-q = c0 (1 - M) + c1 (M - E),   M = ∫ e^-q(u) du over 0 … 1,   E = e^-q(1).
// M is the three-point Gauss sum; pieces are cut at optical depth 1, where it errs by 120 / 2016000 = 6e-5 at most.
// As e^-q lies between E and 1 so does M: the colour never exceeds opacity times the larger colour.
// Optical depth is summed, not transmittance multiplied: exp() errs once per ray, not once per segment.

FETCH_BUFFER(2) tf_pieces; // three a piece: from, to; r g b a at from; their slopes
uniform int tf_piece_count;
uniform int tf_piece_half; // a power of two, at least half the count
uniform vec2 tf_map;       // scalar → x = s * tf_map.x + tf_map.y

const float PIECE_FAR = 1.0e30; // the outer pieces reach there
const float PIECE_THICK = 1.0;
const float PIECE_OPAQUE = 1.0e-6; // transmittance below which the rest of a segment is nothing

struct Integral {
    vec3 rgb;
    float depth;         // optical depth so far
    float transmittance; // exp(-depth)
    float x;
    vec4 front; // colour and extinction at x
    int piece;  // the one that x is in
    vec2 span;  // where it begins and ends
    vec4 value, slope;
};

float tf_place(float s)
{
#ifdef NONFINITE
    s = isnan(s) ? 0.0 : s; // of a cell that contributes nothing
#endif
    return clamp(s * tf_map.x + tf_map.y, -PIECE_FAR, PIECE_FAR);
}

// Makes `piece` the current one, x being in it.
void piece_enter(inout Integral i, int piece)
{
    i.piece = piece;
    i.span = fetch(tf_pieces, 3 * piece).xy;
    i.value = fetch(tf_pieces, 3 * piece + 1);
    i.slope = fetch(tf_pieces, 3 * piece + 2);
    i.front = i.value + i.slope * (i.x - i.span.x);
}

// The scalar jumps to s without a segment.
void integral_enter(inout Integral i, float s)
{
    i.x = tf_place(s);
    int piece = 0; // the last one that begins at or before x
    for (int step = tf_piece_half; step > 0; step /= 2)
        if (piece + step < tf_piece_count && fetch(tf_pieces, 3 * min(piece + step, tf_piece_count - 1)).x <= i.x)
            piece += step;
    piece_enter(i, piece);
}

Integral integral_begin(vec4 color, float s)
{
    Integral i;
    i.rgb = color.rgb;
    i.depth = color.a;
    i.transmittance = exp(-color.a);
    integral_enter(i, s);
    return i;
}

// Adds a stretch of length l and optical depth t over which colour and extinction run linearly from front to back.
void integral_stretch(inout Integral i, vec4 back, float l, float t)
{
    float a = l * i.front.a, d = t - a; // q(u) = u (a + u d)
    vec3 u = vec3(0.1127016654, 0.5, 0.8872983346);
    vec3 e = exp(-(u * (a + u * d)));
    float m = (5.0 * (e.x + e.z) + 8.0 * e.y) * (1.0 / 18.0);
    i.depth += t;
    float transmittance = exp(-i.depth);
    float back_share = max(i.transmittance * m - transmittance, 0.0);
    i.rgb += i.front.rgb * max(i.transmittance - transmittance - back_share, 0.0) + back.rgb * back_share;
    i.transmittance = transmittance;
    i.front = back;
}

// A segment of length l (unit distances) over which the scalar runs linearly from the last one to s.
void integral_add(inout Integral i, float s, float l)
{
    float x = tf_place(s), rest = max(l, 0.0);
    int most = tf_piece_count + 64; // each round crosses a piece, or takes PIECE_THICK of the 14 until PIECE_OPAQUE
    for (int n = 0; n < most; n++) {
        float end = clamp(x, i.span.x, i.span.y);
        bool last = end == x;
        vec4 back = i.value + i.slope * (end - i.span.x);
        float part = last ? rest : rest * clamp((end - i.x) / (x - i.x), 0.0, 1.0);
        float t = max(0.5 * part * (i.front.a + back.a), 0.0);
        bool whole = t <= PIECE_THICK;
        if (!whole) { // up to the share f whose optical depth is PIECE_THICK: a f^2 + b f = c
            float most_a = max(i.front.a, back.a);
            float a = 0.5 * (back.a - i.front.a) / most_a, b = i.front.a / most_a, c = max(PIECE_THICK / part / most_a, 1.0e-37);
            float f = clamp(2.0 * c / (b + sqrt(max(b * b + 4.0 * a * c, 0.0))), 0.0, 1.0);
            back = mix(i.front, back, f);
            end = mix(i.x, end, f);
            part *= f;
            t = PIECE_THICK;
        }
        integral_stretch(i, back, part, t);
        i.x = end;
        rest = max(rest - part, 0.0);
        if (whole && !last)
            piece_enter(i, clamp(x > end ? i.piece + 1 : i.piece - 1, 0, tf_piece_count - 1));
        if ((whole && last) || i.transmittance < PIECE_OPAQUE)
            break;
    }
    if (i.x != x)
        integral_enter(i, s); // the rest is behind what is opaque
    if (rest > 0.0 && i.transmittance >= PIECE_OPAQUE) { // … or rounds ran out: as it is at the end
        i.depth += rest * i.front.a;
        float transmittance = exp(-i.depth);
        i.rgb += i.front.rgb * (i.transmittance - transmittance);
        i.transmittance = transmittance;
    }
}

#include "integrate_depth.glsl"
