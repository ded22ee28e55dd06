/* pieces.c: a transfer function as its linear pieces. */
#include "transfer_functions/pieces.h"

#include "core/memory.h"
#include "transfer_functions/place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double OPAQUE = 1e25; /* attenuation beyond which more is no different, and floats overflow */

static void knot_value(float out[4], const tc_knot *k)
{
    out[0] = (float)k->r;
    out[1] = (float)k->g;
    out[2] = (float)k->b;
    out[3] = (float)fmin(k->a, OPAQUE);
}

static tc_piece_end end_at(double x, const tc_knot *k)
{
    tc_piece_end end = {.x = (float)x};
    knot_value(end.below, k);
    memcpy(end.above, end.below, sizeof end.above);
    return end;
}

tc_status tc_pieces_build(tc_pieces *out, const tc_transfer *tf, const double span[2], tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (!tf || !(span[1] > span[0]) || !isfinite(span[0]) || !isfinite(span[1]))
        return tc_fail(err, TC_E_ARG, "linear pieces over the scalars %g to %g: the range must be finite and not empty",
                       span[0], span[1]);
    tc_piece_end *end = tc_alloc(tf->n + 2, sizeof *end);
    if (!end)
        return tc_fail_memory(err, "the pieces of a transfer function", tf->n + 2, sizeof *end);
    size_t n = 0, first = 0, last = tf->n - 1;
    /* Knots from the last one at or before x = 0 to the first one at or behind x = 1. */
    while (first < last && tc_place(tf->knot[first + 1].s, span[0], span[1]) <= 0)
        first++;
    while (last > first && tc_place(tf->knot[last - 1].s, span[0], span[1]) >= 1)
        last--;
    end[n++] = end_at(-(double)TC_PIECE_FAR, &tf->knot[first]);
    for (size_t k = first; k <= last; k++) {
        tc_piece_end next = end_at(tc_place(tf->knot[k].s, span[0], span[1]), &tf->knot[k]);
        if (k == first || next.x > end[n - 1].x)
            end[n++] = next;
        else /* the piece between has no width: a step */
            memcpy(end[n - 1].above, next.above, sizeof next.above);
    }
    end[n] = end_at((double)TC_PIECE_FAR, &tf->knot[last]);
    for (size_t k = 0; k <= n; k++)
        out->steps = out->steps || memcmp(end[k].below, end[k].above, sizeof end[k].below) != 0;
    out->n = n;
    out->end = end;
    return TC_OK;
}

void tc_pieces_finish(tc_pieces *pieces)
{
    free(pieces->end);
    memset(pieces, 0, sizeof *pieces);
}
