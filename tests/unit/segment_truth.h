/* segment_truth.h: functions to try, and the colour and opacity of one segment by an adaptive quadrature of its own. */
#ifndef TC_TESTS_UNIT_SEGMENT_TRUTH_H
#define TC_TESTS_UNIT_SEGMENT_TRUTH_H

#include "transfer_make.h"

#include <math.h>

static const tc_knot smooth[] = {{0, 0.2, 0.3, 0.7, 0}, {0.5, 0.9, 0.8, 0.9, 0.4}, {1, 0.7, 0.1, 0.1, 1}};
static const tc_knot steps[] = {{-1, 1, 0, 0, 0},   {0.2, 1, 1, 0, 0.5}, {0.2, 0, 1, 0, 3}, {0.61, 0, 1, 1, 2},
                                {0.61, 1, 1, 1, 0}, {0.9, 0, 0, 1, 0},   {0.9, 1, 0, 0, 9}, {2, 0, 0, 1, 1}};

/* The truth: between knots the optical depth in closed form, the emission by adaptive Simpson. */
typedef struct stretch {
    double a[4], b[4], length; /* values at both ends */
} stretch;

static double stretch_depth(const stretch *p, double u)
{
    return p->length * (p->a[3] * u + 0.5 * (p->b[3] - p->a[3]) * u * u);
}

static double stretch_emission(const stretch *p, double u, int c)
{
    return p->length * (p->a[3] + u * (p->b[3] - p->a[3])) * (p->a[c] + u * (p->b[c] - p->a[c])) *
           exp(-stretch_depth(p, u));
}

static double simpson(const stretch *p, int c, double u0, double f0, double u1, double f1, double u2, double f2,
                      int level)
{
    const double ua = 0.5 * (u0 + u1), ub = 0.5 * (u1 + u2);
    const double fa = stretch_emission(p, ua, c), fb = stretch_emission(p, ub, c), h = u2 - u0;
    const double coarse = h / 6 * (f0 + 4 * f1 + f2), fine = h / 12 * (f0 + 4 * fa + 2 * f1 + 4 * fb + f2);
    if (level > 3 && (fabs(fine - coarse) < 1e-12 || level > 40))
        return fine + (fine - coarse) / 15;
    return simpson(p, c, u0, f0, ua, fa, u1, f1, level + 1) + simpson(p, c, u1, f1, ub, fb, u2, f2, level + 1);
}

static void truth(double out[4], const tc_transfer *tf, double front, double back, double length)
{
    double at = 0, depth = 0;
    for (int c = 0; c < 4; c++)
        out[c] = 0;
    const bool up = back >= front;
    for (size_t k = 0; k <= tf->n && at < 1; k++) {
        double next = 1;
        if (k < tf->n && front != back)
            next = (tf->knot[up ? k : tf->n - 1 - k].s - front) / (back - front);
        next = next > 1 ? 1 : next;
        if (next <= at)
            continue;
        /* Values just inside the stretch, extended to its ends: no doubt about the side of a step. */
        double p[4], q[4];
        stretch part = {.length = length * (next - at)};
        tc_transfer_evaluate(p, tf, front + (back - front) * (at + 0.25 * (next - at)));
        tc_transfer_evaluate(q, tf, front + (back - front) * (at + 0.75 * (next - at)));
        for (int c = 0; c < 4; c++) {
            part.a[c] = p[c] - 0.5 * (q[c] - p[c]);
            part.b[c] = q[c] + 0.5 * (q[c] - p[c]);
        }
        for (int c = 0; c < 3; c++)
            out[c] += exp(-depth) * simpson(&part, c, 0, stretch_emission(&part, 0, c), 0.5,
                                            stretch_emission(&part, 0.5, c), 1, stretch_emission(&part, 1, c), 0);
        depth += stretch_depth(&part, 1);
        at = next;
    }
    out[3] = -expm1(-depth);
}

#endif
