/* optical.c: the attenuation along a segment, piece by piece between the knots of the transfer function.
 *
 * Over a piece of length h on which the attenuation runs from a to b the optical depth is T(y) = h (a y + (b - a) y^2 /
 * 2), y in [0, 1]: a parabola in closed form, and so is its inverse, with t = T / h: y = 2 t / (a + sqrt(a^2 + 2 (b -
 * a) t)), the root in the form that does not cancel. */
#include "probe/optical.h"

#include <math.h>

static const double DEPTH_MAX = 1e300;

/* A segment, cut at the knots it crosses, front to back: what is left of it. */
typedef struct cutter {
    const tc_transfer *tf;
    double s0, s1;
    size_t above; /* the piece lies before this knot towards greater scalars */
    double x, s;  /* where the piece begins: along the segment, 0 to 1 (1: there is none), and the scalar there */
} cutter;

typedef struct piece {
    double x0, x1; /* along the segment */
    double a, b;   /* attenuation at its ends */
} piece;

/* Number of knots below s, or up to it. */
static size_t knots_below(const tc_transfer *tf, double s, bool or_at)
{
    size_t from = 0, n = tf->n;
    while (n > 0) {
        const size_t half = n / 2;
        const double at = tf->knot[from + half].s;
        if (at < s || (or_at && at == s))
            from += half + 1, n -= half + 1;
        else
            n = half;
    }
    return from;
}

static cutter cut(const tc_transfer *tf, double s0, double s1)
{
    return (cutter){tf, s0, s1, knots_below(tf, s0, s1 >= s0), 0, s0};
}

/* Attenuation at s in the piece before knot `above`; beyond the ends it is constant. */
static double attenuation(const tc_transfer *tf, size_t above, double s)
{
    const tc_knot *lo = &tf->knot[above > 0 ? above - 1 : 0], *hi = &tf->knot[above < tf->n ? above : tf->n - 1];
    double w = (0.5 * s - 0.5 * lo->s) / (0.5 * hi->s - 0.5 * lo->s); /* halves: the difference may overflow */
    w = fmin(fmax(w, 0), 1);                                          /* NaN, of no width: 0 */
    return fmax(w < 0.5 ? lo->a + w * (hi->a - lo->a) : hi->a + (1 - w) * (lo->a - hi->a), 0);
}

/* The next piece of some length; false: the segment is at its end. */
static bool next_piece(piece *out, cutter *c)
{
    const bool up = c->s1 > c->s0;
    while (c->x < 1) {
        const size_t above = c->above;
        const double x = c->x, s = c->s;
        c->x = 1, c->s = c->s1;
        if (c->s0 != c->s1 && (up ? above < c->tf->n : above > 0)) {
            const double knot = c->tf->knot[up ? above : above - 1].s;
            if (up ? knot < c->s1 : knot > c->s1) {
                c->above = up ? above + 1 : above - 1;
                c->s = knot;
                c->x = fmin(fmax((0.5 * knot - 0.5 * c->s0) / (0.5 * c->s1 - 0.5 * c->s0), x), 1);
            }
        }
        if (c->x > x) { /* those of no length are the steps */
            *out = (piece){x, c->x, attenuation(c->tf, above, s), attenuation(c->tf, above, c->s)};
            return true;
        }
    }
    return false;
}

static double depth_of(const piece *p, double l)
{
    return fmin((0.5 * p->a + 0.5 * p->b) * ((p->x1 - p->x0) * l), DEPTH_MAX);
}

double tc_optical_depth(const tc_transfer *tf, double s0, double s1, double l)
{
    double sum = 0;
    piece p;
    for (cutter c = cut(tf, s0, s1); tf->n > 0 && next_piece(&p, &c);)
        sum += depth_of(&p, l);
    return fmin(sum, DEPTH_MAX);
}

double tc_optical_place(const tc_transfer *tf, double s0, double s1, double l, double depth)
{
    piece p;
    for (cutter c = cut(tf, s0, s1); tf->n > 0 && next_piece(&p, &c);) {
        const double whole = depth_of(&p, l);
        if (whole > 0 && whole >= depth) {
            const double t = fmax(depth, 0) / ((p.x1 - p.x0) * l);
            const double root = p.a + sqrt(fmax(p.a * p.a + 2 * (p.b - p.a) * t, 0));
            return p.x0 + (root > 0 ? fmin(2 * t / root, 1) : 0) * (p.x1 - p.x0);
        }
        depth -= whole;
    }
    return 1;
}
