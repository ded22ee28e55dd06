/* running.h: one-dimensional running integrals of extinction and emission (docs/architecture.md, "Segment integrals").
 *
 * Over x = (s - span[0]) / (span[1] - span[0]) in [0, 1] and nodes x_i = i / (n-1):
 *   point[i]      = (tau r, tau g, tau b, tau) at x_i (at a step: the mean of both sides)
 *   cumulative[i] = integral from 0 to x_i of (tau r, tau g, tau b, tau) dx, MINUS mean * x_i: what is left after the
 *                   mean slope is taken out, so that a constant function has cumulative = 0 exactly and float keeps
 * digits; mean is 0 where the function is clear over a part of the span, so that differences there are 0 exactly.
 * The mean of the function over [x0, x1] is  mean + (cumulative(x1) - cumulative(x0)) / (x1 - x0). Both arrays
 * are exact at the nodes (closed form per linear piece, double) and rounded to float once. */
#ifndef TC_TRANSFER_FUNCTIONS_RUNNING_H
#define TC_TRANSFER_FUNCTIONS_RUNNING_H

#include "transfer_functions/transfer.h"

/* The attenuation of a node that says nothing: means with it are far beyond any other, in float as well. */
#define TC_RUNNING_LEFT_OUT 1e30f

typedef struct tc_running {
    int n;
    float *point;      /* [n][4] */
    float *cumulative; /* [n][4] */
    double mean[4];
    double span[2];
    double ms;
} tc_running;

/* n >= 2 nodes over span. leave_steep: the points of nodes within one and a half intervals of a rise that is too steep
 * for them (tc_running_steep) get the attenuation
 * TC_RUNNING_LEFT_OUT: who meets one must integrate otherwise; cumulative stays right there.
 * Errors: TC_E_ARG, TC_E_MEMORY. Cost: O(n + knots). */
tc_status tc_running_build(tc_running *out, const tc_transfer *tf, int n, const double span[2], bool leave_steep,
                           tc_error *err);
/* The share of n nodes that leave_steep leaves out, at most 1: beside rises, or steps, that would go from none to all
 * within fewer than 64 intervals. Cost: O(knots). */
double tc_running_steep(const tc_transfer *tf, int n, const double span[2]);
void tc_running_finish(tc_running *running);

#endif
