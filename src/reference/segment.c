/* segment.c: the volume integral over one segment, exact between the transfer function's knots.
 *
 * Density emitter (Williams and Max 1992; Weiler et al. 2003, equations 3 and 4). Over a piece on which attenuation and
 * colour are linear, x in [0, 1], with optical depth T(x) = alpha x + beta x^2:
 *     alpha of the piece   A = 1 - exp(-T(1))
 *     colour               integral of c T' exp(-T) dx = c0 A + (c1 - c0) J,   J = integral of x T' exp(-T) dx
 * so that a single scalar integral J, the same for all channels, is left to quadrature. It has a closed form where the
 * attenuation is constant; else Gauss-Legendre of 4, 6 or 8 points over pieces of optical depth at most 1, whose error
 * term f^(2n) (n!)^4 / ((2n+1) ((2n)!)^3) is below 1e-12. */
#include "reference/segment.h"

#include <math.h>
#include <string.h>

/* Abscissas and weights on [0, 1]: roots of the shifted Legendre polynomials, symmetric about 1/2. */
static const double X4[4] = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629};
static const double W4[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307, 0.17392742256872693};
static const double X6[6] = {0.033765242898423989, 0.16939530676686774, 0.38069040695840155,
                             0.61930959304159845,  0.83060469323313226, 0.96623475710157601};
static const double W6[6] = {0.085662246189585173, 0.18038078652406930, 0.23395696728634552,
                             0.23395696728634552,  0.18038078652406930, 0.085662246189585173};
static const double X8[8] = {0.019855071751231884, 0.10166676129318664, 0.23723379504183550, 0.40828267875217510,
                             0.59171732124782490,  0.76276620495816450, 0.89833323870681336, 0.98014492824876812};
static const double W8[8] = {0.050614268145188129, 0.11119051722668724, 0.15685332293894364, 0.18134189168918099,
                             0.18134189168918099,  0.15685332293894364, 0.11119051722668724, 0.050614268145188129};

/* Optical depths are cut here so that their squares stay finite; exp(-1e30) is 0 anyway. */
static const double DEPTH_MAX = 1e30;

/* Integral over [x0, x1] of x T'(x) exp(-T(x)). */
static double gauss(double alpha, double beta, double x0, double x1, int n)
{
    const double *x = n == 4 ? X4 : n == 6 ? X6 : X8, *w = n == 4 ? W4 : n == 6 ? W6 : W8;
    double sum = 0, h = x1 - x0;
    for (int i = 0; i < n; i++) {
        double p = x0 + h * x[i];
        sum += w[i] * p * (alpha + 2 * beta * p) * exp(-p * (alpha + beta * p));
    }
    return h * sum;
}

/* J for attenuation times length running from t0 to t1; depth = (t0 + t1) / 2. */
static double first_moment(double t0, double t1, double depth)
{
    if (t0 == t1) {
        if (depth > 0.5)
            return (1 - exp(-depth) * (1 + depth)) / depth;
        double sum = 0, term = depth; /* sum of (-1)^k depth^(k+1) / (k! (k+2)) */
        for (int k = 0; k < 16; k++) {
            sum += term / (k + 2);
            term *= -depth / (k + 1);
        }
        return sum;
    }
    double alpha = t0, beta = 0.5 * (t1 - t0);
    if (depth <= 0.01)
        return gauss(alpha, beta, 0, 1, 4);
    if (depth <= 0.25)
        return gauss(alpha, beta, 0, 1, 6);
    if (depth <= 1)
        return gauss(alpha, beta, 0, 1, 8);
    /* Pieces between the depths 0, 1, 2 …: the root of alpha x + beta x^2 = k without cancellation. Behind 45 what is
     * left is below exp(-45) = 3e-20. */
    double sum = 0, x0 = 0;
    for (int k = 1; x0 < 1 && k <= 45; k++) {
        double root = alpha * alpha + 4 * beta * k, x1 = 1;
        if (k < depth)
            x1 = fmin(1, 2 * k / (alpha + sqrt(fmax(root, 0))));
        sum += gauss(alpha, beta, x0, x1, 8);
        x0 = x1;
    }
    return sum;
}

/* Puts a piece of attenuation times length a0 l … a1 l, colours c0 … c1 behind what *out holds (front to back). */
static void add_piece(tc_segment_sum *out, const double c0[4], const double c1[4], double l)
{
    double t0 = fmin(fmax(c0[3] * l, 0), DEPTH_MAX), t1 = fmin(fmax(c1[3] * l, 0), DEPTH_MAX);
    double depth = 0.5 * t0 + 0.5 * t1;
    if (!(depth > 0))
        return;
    double a = -expm1(-depth);
    bool flat = c0[0] == c1[0] && c0[1] == c1[1] && c0[2] == c1[2];
    double j = flat ? 0 : fmin(fmax(first_moment(t0, t1, depth), 0), a);
    for (int i = 0; i < 3; i++)
        out->rgba[i] += out->clear * (c0[i] * (a - j) + c1[i] * j);
    out->rgba[3] += out->clear * a;
    out->clear *= depth < 0.5 ? 1 - a : exp(-depth);
}

/* r, g, b, a of knot piece i (between knots i and i + 1; -1 and n - 1: the constant ends) at s. */
static void piece_value(double out[4], const tc_transfer *tf, ptrdiff_t i, double s)
{
    const tc_knot *k0 = &tf->knot[i < 0 ? 0 : i], *k1 = &tf->knot[i + 1 < (ptrdiff_t)tf->n ? i + 1 : i];
    double w = 0;
    if (i >= 0 && k1->s > k0->s)
        w = fmin(fmax((0.5 * s - 0.5 * k0->s) / (0.5 * k1->s - 0.5 * k0->s), 0), 1);
    out[0] = k0->r + w * (k1->r - k0->r);
    out[1] = k0->g + w * (k1->g - k0->g);
    out[2] = k0->b + w * (k1->b - k0->b);
    out[3] = k0->a + w * (k1->a - k0->a);
}

/* Number of knots with knot.s <= s (or < s). */
static size_t knots_below(const tc_transfer *tf, double s, bool or_equal)
{
    size_t lo = 0, hi = tf->n;
    while (lo < hi) {
        size_t mid = lo + (hi - lo) / 2;
        if (or_equal ? tf->knot[mid].s <= s : tf->knot[mid].s < s)
            lo = mid + 1;
        else
            hi = mid;
    }
    return lo;
}

void tc_segment_add(tc_segment_sum *out, const tc_transfer *tf, double s0, double s1, double l)
{
    double c0[4], c1[4];
    if (!(l > 0) || tf->n == 0)
        return;
    if (s0 == s1) {
        piece_value(c0, tf, (ptrdiff_t)knots_below(tf, s0, true) - 1, s0);
        add_piece(out, c0, c0, l);
        return;
    }
    bool up = s1 > s0;
    ptrdiff_t n = (ptrdiff_t)tf->n, i = (ptrdiff_t)knots_below(tf, s0, up) - 1;
    double span = 0.5 * s1 - 0.5 * s0, s = s0; /* halves: the range itself may overflow */
    while (s != s1) {
        double end = s1;
        if (up && i + 1 < n)
            end = fmin(s1, tf->knot[i + 1].s);
        if (!up && i >= 0)
            end = fmax(s1, tf->knot[i].s);
        if (end != s) { /* pieces of no width are the steps */
            piece_value(c0, tf, i, s);
            piece_value(c1, tf, i, end);
            add_piece(out, c0, c1, l * ((0.5 * end - 0.5 * s) / span));
            s = end;
        }
        i += up ? 1 : -1;
    }
}

void tc_segment_add_constant(tc_segment_sum *out, const double color[4], double l)
{
    if (l > 0)
        add_piece(out, color, color, l);
}

/* ------------------------------------------------------------------------------------- other models, and two functions
 */

/* A function along a segment, at the piece of it that comes next. */
typedef struct runner {
    const tc_transfer *tf;
    double s0, s1;
    ptrdiff_t piece;
} runner;

static runner run(const tc_transfer *tf, double s0, double s1)
{
    return (runner){tf, s0, s1, (ptrdiff_t)knots_below(tf, s0, s1 >= s0) - 1};
}

/* Where, from 0 to 1, the piece ends. */
static double piece_end(const runner *r)
{
    bool up = r->s1 > r->s0;
    ptrdiff_t next = up ? r->piece + 1 : r->piece;
    if (r->s0 == r->s1 || next < 0 || next >= (ptrdiff_t)r->tf->n)
        return 1;
    double at = r->tf->knot[next].s;
    if (up ? at >= r->s1 : at <= r->s1)
        return 1;
    return fmin(fmax((0.5 * at - 0.5 * r->s0) / (0.5 * r->s1 - 0.5 * r->s0), 0), 1);
}

static void value_on(double out[4], const runner *r, double x)
{
    piece_value(out, r->tf, r->piece, x < 0.5 ? r->s0 + x * (r->s1 - r->s0) : r->s1 + (1 - x) * (r->s0 - r->s1));
}

/* What is emitted per length, a product of two linear functions, and not absorbed. */
static void add_emission(tc_segment_sum *out, const double c0[4], const double c1[4], double l)
{
    for (int i = 0; i < 3; i++)
        out->rgba[i] +=
            out->clear * l * (c0[i] * c0[3] / 3 + c0[i] * c1[3] / 6 + c1[i] * c0[3] / 6 + c1[i] * c1[3] / 3);
}

static void add_matter_piece(tc_segment_sum *out, const tc_matter *matter, double c0[4], double c1[4], double l)
{
    for (int i = 0; i < 3; i++) {
        c0[i] = matter->gain[i] * c0[i] + matter->glow[i];
        c1[i] = matter->gain[i] * c1[i] + matter->glow[i];
    }
    if (matter->emission)
        add_emission(out, c0, c1, l);
    else
        add_piece(out, c0, c1, l);
}

void tc_segment_add_matter(tc_segment_sum *out, const tc_matter *matter, double s0, double s1, double q0, double q1,
                           double l)
{
    if (!(l > 0) || matter->opacity->n == 0)
        return;
    runner a = run(matter->opacity, s0, s1), c = matter->color ? run(matter->color, q0, q1) : a;
    for (double x = 0; x < 1;) {
        double to_a = piece_end(&a), to_c = piece_end(&c), end = fmin(to_a, to_c);
        if (end > x) {
            double c0[4], c1[4], a0[4], a1[4];
            value_on(c0, &c, x), value_on(c1, &c, end);
            value_on(a0, &a, x), value_on(a1, &a, end);
            c0[3] = a0[3], c1[3] = a1[3];
            add_matter_piece(out, matter, c0, c1, (end - x) * l);
            x = end;
        }
        if (to_a <= x)
            a.piece += a.s1 > a.s0 ? 1 : -1;
        if (to_c <= x)
            c.piece += c.s1 > c.s0 ? 1 : -1;
    }
}

void tc_segment_add_matter_constant(tc_segment_sum *out, const tc_matter *matter, const double color[4], double l)
{
    double c0[4], c1[4];
    if (!(l > 0))
        return;
    memcpy(c0, color, sizeof c0);
    memcpy(c1, color, sizeof c1);
    add_matter_piece(out, matter, c0, c1, l);
}

void tc_segment_value(double out[4], const tc_transfer *tf, double s)
{
    piece_value(out, tf, (ptrdiff_t)knots_below(tf, s, true) - 1, s);
}

void tc_reference_segment(double out[4], const tc_transfer *tf, double s0, double s1, double l)
{
    tc_segment_sum sum = {.rgba = {0, 0, 0, 0}, .clear = 1};
    tc_segment_add(&sum, tf, s0, s1, l);
    for (int i = 0; i < 4; i++)
        out[i] = sum.rgba[i];
}
