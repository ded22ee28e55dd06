/* pieces.c: a transfer function as its linear pieces. */
#include "transfer_functions/pieces.h"

#include "core/memory.h"
#include "transfer_functions/place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double OPAQUE = 1e25; /* attenuation beyond which more is no different, and floats overflow */

/* A float holds it and what comes of it. Only pieces narrower than 1e-12 of the span are steeper: they begin with their
 * own value and rise less, the next one begins with its own again. */
static const double STEEPEST = 1e37;

static void knot_value(float out[4], const tc_knot *k)
{
    out[0] = (float)k->r;
    out[1] = (float)k->g;
    out[2] = (float)k->b;
    out[3] = (float)fmin(k->a, OPAQUE);
}

static tc_piece constant(float from, float to, const tc_knot *k)
{
    tc_piece p = {.from = from, .to = to};
    knot_value(p.value, k);
    return p;
}

static tc_piece linear(double x0, double x1, const tc_knot *p, const tc_knot *q)
{
    const double rise[4] = {q->r - p->r, q->g - p->g, q->b - p->b, fmin(q->a, OPAQUE) - fmin(p->a, OPAQUE)};
    tc_piece piece = {.from = (float)x0, .to = (float)x1};
    knot_value(piece.value, p);
    for (int c = 0; c < 4; c++) /* over the width that float sees, so that the piece ends at the next knot's value */
        piece.slope[c] = (float)fmax(-STEEPEST, fmin(STEEPEST, rise[c] / ((double)piece.to - (double)piece.from)));
    return piece;
}

tc_status tc_pieces_build(tc_pieces *out, const tc_transfer *tf, const double span[2], tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (!tf || !(span[1] > span[0]) || !isfinite(span[0]) || !isfinite(span[1]))
        return tc_fail(err, TC_E_ARG, "linear pieces over the scalars %g to %g: the range must be finite and not empty",
                       span[0], span[1]);
    tc_piece *piece = tc_alloc(tf->n + 1, sizeof *piece);
    if (!piece)
        return tc_fail_memory(err, "the pieces of a transfer function", tf->n + 1, sizeof *piece);
    size_t n = 0, first = 0, last = tf->n - 1;
    /* Knots from the last one at or before x = 0 to the first one at or behind x = 1. */
    while (first < last && tc_place(tf->knot[first + 1].s, span[0], span[1]) <= 0)
        first++;
    while (last > first && tc_place(tf->knot[last - 1].s, span[0], span[1]) >= 1)
        last--;
    piece[n++] = constant(-TC_PIECE_FAR, (float)tc_place(tf->knot[first].s, span[0], span[1]), &tf->knot[first]);
    for (size_t k = first; k < last; k++) {
        double x0 = piece[n - 1].to, x1 = tc_place(tf->knot[k + 1].s, span[0], span[1]);
        if ((float)x1 > (float)x0)
            piece[n++] = linear(x0, x1, &tf->knot[k], &tf->knot[k + 1]);
    }
    piece[n] = constant(piece[n - 1].to, TC_PIECE_FAR, &tf->knot[last]);
    out->n = n + 1;
    out->piece = piece;
    return TC_OK;
}

void tc_pieces_finish(tc_pieces *pieces)
{
    free(pieces->piece);
    memset(pieces, 0, sizeof *pieces);
}
