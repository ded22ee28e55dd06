// pieces.glsl: a segment's colour and opacity, linear piece by linear piece of the transfer function
// (transfer_functions/pieces.h). Density emitter: Weiler et al. 2003, eq. 3 and 4.
// Within a piece colour and extinction are linear in the scalar (Williams and Max 1992), so the optical depth q(u) up to
// the share u of it is quadratic and exact, and by parts
//   C = ∫ c dq e^-q = c0 (1 - M) + c1 (M - E),   M = ∫ e^-q(u) du over 0 … 1,   E = e^-q(1).
// With t = q(1) and q(u) = t u - d u (1 - u), M is a series in d:
//   M = m0 + d m1 + d^2/2 m2 + d^3/6 m3 …,   mk = ∫ e^-tu (u (1 - u))^k du,   m0 = (1 - e^-t) / t,
// the others by their middle, e^-t/2 (B(k+1,k+1) + …). Pieces are cut until t <= 1, where it errs by 1e-5 at most as
// |d| <= t. As e^-q lies between E and 1 so does M: the colour never exceeds opacity times the larger colour.
//
// A round is one such piece. Rays of one group need different numbers of them; in a loop inside the loop over steps all
// would wait for the one that needs most, at every step. So march.glsl has one loop, in whose rounds every ray adds a piece,
// or with PIECES_TWICE two, and those whose segment is done make a step first.
#include "integrate_depth.glsl" //@then pieces_declare

FETCH_BUFFER(3) tf_pieces; // three an end of pieces: x; r g b a below; those above, which differ at a step
FETCH_FLOATS(13) tf_piece_floats; // the same, float by float
uniform int tf_piece_count;
uniform int tf_piece_half; // a power of two, at least half the count

int kept_last_piece = 0;

const float PIECE_FAR = 1.0e30; // the outer pieces reach there
const float PIECE_OPAQUE = 1.0e-6; // transmittance below which the rest of a segment is nothing
#ifdef PIECES_DENSE
const float PIECE_DEEPEST = 1.0e20; // as deep as any depth
#endif

// Where a ray is in the function, and its segment on from there.
struct Place {
    float x;
    vec4 front; // colour and extinction at x
    int piece;  // the one that x is in: from this end to the next
    float to, rest; // the segment's end, and how long it is until there
};

float piece_end(int end)
{
    return fetch(tf_piece_floats, 12 * end).x;
}

vec4 piece_below(int end)
{
    return fetch(tf_pieces, 3 * end + 1);
}

vec4 piece_above(int end)
{
#ifdef TF_STEPS
    return fetch(tf_pieces, 3 * end + 2);
#else
    return piece_below(end);
#endif
}

// Before the first round.
void pieces_begin()
{
    kept_last_piece = keep(tf_piece_count - 1);
}

Place place_at(float x)
{
    Place p;
    p.x = clamp(x, -PIECE_FAR, PIECE_FAR);
    p.to = p.x;
    p.rest = 0.0;
    p.piece = 0; // the last one that begins at or before x
    for (int step = tf_piece_half; step > 0; step /= 2)
        if (p.piece + step <= kept_last_piece && piece_end(min(p.piece + step, kept_last_piece)) <= p.x)
            p.piece += step;
    float from = piece_end(p.piece), to = piece_end(p.piece + 1);
    p.front = mix(piece_above(p.piece), piece_below(p.piece + 1), clamp((p.x - from) / (to - from), 0.0, 1.0));
    return p;
}

// A segment of length l (unit distances) over which x runs linearly from where the place is.
void piece_begin(inout Place p, float to, float l)
{
    p.to = clamp(to, -PIECE_FAR, PIECE_FAR);
    p.rest = max(l, 0.0);
}

// Adds the segment's next piece; false when it was the last.
bool piece_round(inout Gathered g, inout Place p)
{
    // The end of the piece that lies ahead, and whether the segment crosses it. Only places between are interpolated, so
    // that what rounding does to them does not add up.
    bool up = p.to > p.x;
    int ahead = up ? p.piece + 1 : p.piece;
    float end = piece_end(ahead);
    vec4 back = piece_below(ahead);
#ifdef TF_STEPS
    vec4 below = back, above = piece_above(ahead), behind = up ? above : below;
    back = up ? below : above;
#endif
    bool last = up ? p.to <= end : p.to >= end;
    float segment = abs(p.to - p.x), piece = abs(end - p.x);
    float ratio = min(min(segment, piece) / max(max(segment, piece), 1.0e-37), 1.0);
    float part = last ? p.rest : p.rest * ratio;
    end = last ? p.to : end;
    back = last ? mix(p.front, back, ratio) : back;
    float rise = 0.5 * part * (back.a - p.front.a);
    float front = part * p.front.a;
#ifdef PIECES_DENSE
    // As far as t = 1 at most, and 1/2 at least: with f = 1 / (a + b), a f + b^2 f^2 <= 1.
    float f = 1.0 / max(1.0, min(front, PIECE_DEEPEST) + min(sqrt(max(rise, 0.0)), PIECE_DEEPEST));
    bool whole = f == 1.0;
    last = last && whole;
    end = whole ? end : mix(p.x, end, f);
    back = whole ? back : mix(p.front, back, f);
    part *= f;
    front *= f;
    rise *= f * f;
#endif
    float t = clamp(front + rise, 0.0, 1.0);
    // Nothing that is near 1 is subtracted from 1, so that no digits are lost as t -> 0: with n = (1 - m0) / t,
    // 1 - m0 = t n and m0 - E = t (1 - t n - n). n by Chebyshev, 1e-8.
    float d = t - front, t2 = t * t;
    float n = 0.499999991 + t * (-0.166666048 + t * (0.0416593471 + t * (-0.00830142618 + t * (0.0013251093 + t * -0.000137540439))));
    float opacity = t * (1.0 - t * n);
    float m1 = 1.0 / 6.0 + t2 * (1.0 / 240.0 + t2 * (1.0 / 26880.0)), m2 = 1.0 / 60.0 + t2 * (1.0 / 3360.0);
    float bend = sqrt(1.0 - opacity) * d * (m1 + d * (m2 + d * (1.0 / 840.0 + d * (1.0 / 15120.0))));
    float share = clamp(t * n - bend, 0.0, opacity);
    g.rgb += g.transmittance * (p.front.rgb * share + back.rgb * (opacity - share)); //@or piece_light
    g.depth += t; //@or piece_light
    g.transmittance -= g.transmittance * opacity; //@or piece_light
    p.x = end;
    p.rest = max(p.rest - part, 0.0);
#ifdef PIECES_DENSE
    bool crosses = !last && whole;
#else
    bool crosses = !last;
#endif
    p.front = back;
#ifdef TF_STEPS
    p.front = crosses ? behind : back;
#endif
    p.piece = clamp(p.piece + (crosses ? up ? 1 : -1 : 0), 0, kept_last_piece);
    return !(last || g.transmittance < PIECE_OPAQUE);
}
