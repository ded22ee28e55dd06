/* means.h: integrals of extinction and emission over the scalar, in closed form, and their means in equal intervals.
 *
 * The mean over any stretch of scalar is a difference of two integrals over its width. In two floats an integral loses
 * nothing in that difference, however short the stretch or large the extinction elsewhere; linear in each interval, it
 * is continuous and never falls, so that extinction is never negative and a segment's parts add up to the whole. */
#ifndef TC_TRANSFER_FUNCTIONS_MEANS_H
#define TC_TRANSFER_FUNCTIONS_MEANS_H

#include "transfer_functions/segment.h"

/* sum [n_piece + 1][4]: integral over x of (tau r, tau g, tau b, tau) up to each piece of the segments, borrowed. */
typedef struct tc_cumulative {
    const tc_segments *segments;
    double (*sum)[4];
} tc_cumulative;

tc_status tc_cumulative_build(tc_cumulative *out, const tc_segments *segments, tc_error *err);
void tc_cumulative_finish(tc_cumulative *cumulative);
/* From 0 to x in [0, 1]. *piece: any value < n_piece; keeps the place for the next call. */
void tc_cumulative_at(double out[4], const tc_cumulative *cumulative, double x, size_t *piece);

/* cell [n][3][4], of (tau r, tau g, tau b, tau) each: the mean in interval i / n … (i+1) / n of the span; its integral
 * over x from 0 to i / n, rounded to float; what rounding took from it. Where the function has a step, or a rise within
 * an interval, the first of the three is (place, record, 0, -1) instead: the step lies `place` behind the interval's
 * beginning, and cell + 4 * record has the means before and behind it. n_step such records follow the n intervals. */
typedef struct tc_means {
    int n, n_step;
    float *cell;
    double ms;
} tc_means;

/* Intervals that resolve the function's pieces over the span: a power of two from 2^13 to 2^16, so that places of
 * intervals are exact in float. */
int tc_means_intervals(const tc_transfer *tf, const double span[2]);
/* n >= 1. Extinction beyond 1e12 counts as 1e12. Errors: TC_E_ARG, TC_E_MEMORY. Cost: O(n + knots). */
tc_status tc_means_build(tc_means *out, const tc_transfer *tf, int n, const double span[2], tc_error *err);
void tc_means_finish(tc_means *means);

#endif
