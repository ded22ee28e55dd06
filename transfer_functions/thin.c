/* thin.c: leaves out knots on or near the line between their neighbours. */
#include "transfer_functions/thin.h"

#include "core/memory.h"

#include <math.h>
#include <stdlib.h>

enum { SPAN_MOST = 256 }; /* knots that one line may replace: what is looked at stays linear in the knots */

/* May one line from knot i to knot j stand for those between? */
static bool is_straight(const tc_knot *knot, size_t i, size_t j, double tolerance)
{
    const tc_knot *p = &knot[i], *q = &knot[j];
    double width = q->s - p->s;
    if (!(width > 0) || !isfinite(width))
        return false;
    for (size_t k = i + 1; k < j; k++) {
        double t = (knot[k].s - p->s) / width, a = p->a + t * (q->a - p->a);
        if (!(fabs(p->r + t * (q->r - p->r) - knot[k].r) <= tolerance &&
              fabs(p->g + t * (q->g - p->g) - knot[k].g) <= tolerance &&
              fabs(p->b + t * (q->b - p->b) - knot[k].b) <= tolerance &&
              fabs(a - knot[k].a) <= tolerance * fmin(a, knot[k].a)))
            return false;
    }
    return true;
}

tc_status tc_transfer_thin(tc_transfer **out, const tc_transfer *tf, double tolerance, tc_error *err)
{
    *out = NULL;
    if (!(tolerance >= 0))
        return tc_fail(err, TC_E_ARG,
                       "knots of a transfer function left out up to a difference of %g: it must be 0 or more",
                       tolerance);
    tc_knot *kept = tc_alloc(tf->n, sizeof *kept);
    if (!kept)
        return tc_fail_memory(err, "a transfer function of fewer knots", tf->n, sizeof *kept);
    size_t n = 0, i = 0;
    kept[n++] = tf->knot[0];
    while (i + 1 < tf->n) {
        size_t j = i + 1;
        while (j + 1 < tf->n && j + 1 - i <= SPAN_MOST && is_straight(tf->knot, i, j + 1, tolerance))
            j++;
        kept[n++] = tf->knot[j];
        i = j;
    }
    tc_status status = tc_transfer_from_knots(out, kept, n, err);
    free(kept);
    return status;
}
