// pieces.glsl: a segment's colour and opacity, linear piece by linear piece of the transfer function
// (transfer_functions/pieces.h). Density emitter: Weiler et al. 2003, eq. 3 and 4.
// Within a piece colour and extinction are linear in the scalar (Williams and Max 1992), so the optical depth q(u) up to
// the share u of it is quadratic and exact, and by parts
//   C = ∫ c dq e^-q = c0 (1 - M) + c1 (M - E),   M = ∫ e^-q(u) du over 0 … 1,   E = e^-q(1).
// With t = q(1) and q(u) = t u - d u (1 - u), M is a series in d:
//   M = m0 + d m1 + d^2/2 m2 + d^3/6 m3 …,   mk = ∫ e^-tu (u (1 - u))^k du,   m0 = (1 - e^-t) / t,
// the others up to t = 1 by their middle, e^-t/2 (B(k+1,k+1) + …), beyond in closed form. Pieces are cut until t <= 1, where
// it errs by 1e-5 at most as |d| <= t, or |d| <= 1/4: 2e-5. Constant extinction is one stretch at any depth.
// As e^-q lies between E and 1 so does M: the colour never exceeds opacity times the larger colour.
#include "integrate_depth.glsl"

FETCH_BUFFER(3) tf_pieces; // three a piece: from, to; r g b a at from; their slopes
uniform int tf_piece_count;
uniform int tf_piece_half; // a power of two, at least half the count

const float PIECE_FAR = 1.0e30; // the outer pieces reach there
const float PIECE_THICK = 1.0, PIECE_STRAIGHT = 0.25;
const float PIECE_OPAQUE = 1.0e-6; // transmittance below which the rest of a segment is nothing

// Where a ray is in the function.
struct Place {
    float x;
    vec4 front; // colour and extinction at x
    int piece;  // the one that x is in
    vec2 span;  // where it begins and ends
    vec4 value, slope;
};

// Makes `piece` the current one, x being in it.
void piece_enter(inout Place p, int piece)
{
    p.piece = piece;
    p.span = fetch(tf_pieces, 3 * piece).xy;
    p.value = fetch(tf_pieces, 3 * piece + 1);
    p.slope = fetch(tf_pieces, 3 * piece + 2);
    p.front = p.value + p.slope * (p.x - p.span.x);
}

Place place_at(float x)
{
    Place p;
    p.x = clamp(x, -PIECE_FAR, PIECE_FAR);
    int piece = 0; // the last one that begins at or before x
    for (int step = tf_piece_half; step > 0; step /= 2)
        if (piece + step < tf_piece_count && fetch(tf_pieces, 3 * min(piece + step, tf_piece_count - 1)).x <= p.x)
            piece += step;
    piece_enter(p, piece);
    return p;
}

// Adds a stretch of optical depth t: shares 1 - M of what is left in the front's colour and M - E in the back's.
void piece_gather(inout Gathered g, inout Place p, vec4 back, float t, float front_share, float back_share)
{
    g.rgb += g.transmittance * (p.front.rgb * max(front_share, 0.0) + back.rgb * max(back_share, 0.0));
    g.depth += t;
    g.transmittance = exp(-g.depth);
    p.front = back;
}

// Colour and extinction run linearly from front to back, over an optical depth t <= PIECE_THICK. Nothing that is near 1 is
// subtracted from 1, so that no digits are lost as t -> 0: with n = (1 - m0) / t, 1 - m0 = t n and m0 - E = t (1 - t n - n).
void piece_thin(inout Gathered g, inout Place p, vec4 back, float l, float t)
{
    float d = t - l * p.front.a, e = exp(-t), t2 = t * t;
    float m1 = 1.0 / 6.0 + t2 * (1.0 / 240.0 + t2 * (1.0 / 26880.0)), m2 = 1.0 / 60.0 + t2 * (1.0 / 3360.0);
    float n = t < 0.25 ? 0.5 - t * (1.0 / 6.0 - t * (1.0 / 24.0 - t * (1.0 / 120.0 - t * (1.0 / 720.0)))) : (t - 1.0 + e) / t2;
    float bend = sqrt(e) * d * (m1 + d * (m2 + d * (1.0 / 840.0 + d * (1.0 / 15120.0))));
    piece_gather(g, p, back, t, t * n - bend, t * (1.0 - t * n - n) + bend);
}

// The same over any optical depth t from PIECE_THICK on, where extinction changes little: |d| <= PIECE_STRAIGHT.
void piece_straight(inout Gathered g, inout Place p, vec4 back, float l, float t)
{
    float d = t - l * p.front.a, e = exp(-t), k = clamp(t, PIECE_THICK, 1.0e6), i = 1.0 / k;
    float m1 = (k - 2.0 + (k + 2.0) * e) * i * i * i;
    float m2 = (k * k - 6.0 * k + 12.0 - (k * k + 6.0 * k + 12.0) * e) * i * i * i * i * i;
    float m = (1.0 - e) * i + d * (m1 + d * m2);
    piece_gather(g, p, back, t, 1.0 - m, m - e);
}

#ifdef PIECES_DENSE
// The part of a dense stretch up to where it is PIECE_THICK, or as far as it is straight.
void piece_cut(inout Gathered g, inout Place p, float x, inout float rest, vec4 back, float end, float part)
{
    float rise = back.a - p.front.a, most_a = max(p.front.a, back.a), bend = abs(0.5 * part * rise), f = 1.0;
    if (bend > PIECE_STRAIGHT) { // a f^2 + b f = c
        float a = 0.5 * rise / most_a, b = p.front.a / most_a, c = max(PIECE_THICK / part / most_a, 1.0e-37);
        f = clamp(2.0 * c / (b + sqrt(max(b * b + 4.0 * a * c, 0.0))), 0.0, 1.0);
        f = max(f, sqrt(PIECE_STRAIGHT / bend));
    }
    back = mix(p.front, back, f);
    part *= f;
    float t = max(0.5 * part * (p.front.a + back.a), 0.0);
    end = f < 1.0 ? mix(p.x, end, f) : end;
    if (t <= 1.01 * PIECE_THICK) // the cut rounds
        piece_thin(g, p, back, part, t);
    else
        piece_straight(g, p, back, part, t);
    p.x = end;
    rest = max(rest - part, 0.0);
    if (end != x && (x > end ? end >= p.span.y : end <= p.span.x))
        piece_enter(p, clamp(x > end ? p.piece + 1 : p.piece - 1, 0, tf_piece_count - 1));
}
#endif

// A segment of length l (unit distances) over which x runs linearly from where the place is. Rounds of the inner loop are
// thin pieces; a dense one waits outside of it, as lanes of one group do all or nothing.
void pieces_add(inout Gathered g, inout Place p, float to, float l)
{
    float x = clamp(to, -PIECE_FAR, PIECE_FAR), rest = max(l, 0.0);
    int n = tf_piece_count + 64; // each round crosses a piece, or takes PIECE_THICK at least of the 14 until PIECE_OPAQUE
    bool open = true;
    do {
        bool dense = false;
        vec4 back;
        float end, part;
        do {
            end = clamp(x, p.span.x, p.span.y);
            back = p.value + p.slope * (end - p.span.x);
            part = end == x ? rest : rest * clamp((end - p.x) / (x - p.x), 0.0, 1.0);
            float t = max(0.5 * part * (p.front.a + back.a), 0.0);
            dense = t > PIECE_THICK;
            if (!dense) {
                piece_thin(g, p, back, part, t);
                p.x = end;
                rest = max(rest - part, 0.0);
                open = end != x;
                if (open)
                    piece_enter(p, clamp(x > end ? p.piece + 1 : p.piece - 1, 0, tf_piece_count - 1));
            }
            n--;
        } while (open && !dense && n > 0);
#ifdef PIECES_DENSE
        if (dense) {
            end = clamp(x, p.span.x, p.span.y); // again: llvmpipe has those of the round in which the last lane left
            back = p.value + p.slope * (end - p.span.x);
            part = end == x ? rest : rest * clamp((end - p.x) / (x - p.x), 0.0, 1.0);
            piece_cut(g, p, x, rest, back, end, part);
            open = p.x != x || rest > 0.0;
        }
#endif
        open = open && g.transmittance >= PIECE_OPAQUE;
    } while (open && n > 0);
    if (rest > 0.0 && g.transmittance >= PIECE_OPAQUE) // rounds ran out: as it is at the end
        gathered_add(g, p.front.rgb, rest * p.front.a);
    if (p.x != x)
        p = place_at(x); // the rest is behind what is opaque
}
