/* running.c: running integrals of extinction and emission, exact at the nodes.
 * Between knots extinction and colour are linear, so their product is quadratic and Simpson's rule integrates it
 * without error. Everything is summed as the difference to the first node's value: a constant function leaves exactly
 * nothing. */
#include "transfer_functions/running.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "transfer_functions/place.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* r, g, b, a at s on the linear piece that ends at knot `piece`; 0 and n are the constant outer pieces. */
static void piece_value(double out[4], const tc_transfer *tf, size_t piece, double s)
{
    const tc_knot *a = &tf->knot[piece > 0 ? piece - 1 : 0], *b = &tf->knot[piece < tf->n ? piece : tf->n - 1];
    double t = tc_place(s, a->s, b->s);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    out[0] = a->r + t * (b->r - a->r);
    out[1] = a->g + t * (b->g - a->g);
    out[2] = a->b + t * (b->b - a->b);
    out[3] = a->a + t * (b->a - a->a);
}

static void emission(double out[4], const double value[4])
{
    for (int c = 0; c < 3; c++)
        out[c] = value[3] * value[c];
    out[3] = value[3];
}

/* Adds the integral of (emission - pivot) over [a, b] inside one piece, in units of the span's width. */
static void add_piece(double sum[4], const tc_transfer *tf, size_t piece, double a, double b, double width,
                      const double pivot[4])
{
    double va[4], vb[4], vm[4], ea[4], eb[4], em[4];
    piece_value(va, tf, piece, a);
    piece_value(vb, tf, piece, b);
    for (int c = 0; c < 4; c++)
        vm[c] = 0.5 * (va[c] + vb[c]);
    emission(ea, va);
    emission(eb, vb);
    emission(em, vm);
    const double h = (b - a) / width;
    for (int c = 0; c < 4; c++)
        sum[c] += h * ((ea[c] - pivot[c]) + 4 * (em[c] - pivot[c]) + (eb[c] - pivot[c])) / 6;
}

/* Emission at a node: the mean of both sides where knots lie at it, within rounding of the node's place. */
static void node_value(double out[4], const tc_transfer *tf, size_t piece, double s, double tolerance)
{
    size_t left = piece, right = piece;
    while (left > 0 && fabs(tf->knot[left - 1].s - s) <= tolerance)
        left--;
    while (right < tf->n && fabs(tf->knot[right].s - s) <= tolerance)
        right++;
    double value[4], a[4], b[4];
    piece_value(value, tf, left, s);
    emission(a, value);
    piece_value(value, tf, right, s);
    emission(b, value);
    for (int c = 0; c < 4; c++)
        out[c] = a[c] + 0.5 * (b[c] - a[c]);
}

static const double INTERVALS_A_RISE = 64; /* over which the function may go from none to all */
static const double NO_STEP = 4e-4;        /* a change that may stand as a step: 1/10 of an 8-bit one */
static const double CLEAR_SHARE = 0.02;    /* of the span: where that much is clear it is to be clear exactly */
static const double BESIDE = 1.5;          /* intervals beside a steep rise in which the nearest node may misjudge it */

/* Does the function rise too steeply behind knot k for intervals of this width? most: its largest attenuation. */
static bool is_steep(const tc_transfer *tf, size_t k, double interval, double most)
{
    const tc_knot *p = &tf->knot[k], *q = p + 1;
    double change = fmax(fabs(q->r - p->r), fmax(fabs(q->g - p->g), fabs(q->b - p->b)));
    if (most > 0)
        change = fmax(change, fabs(q->a - p->a) / most);
    return change > NO_STEP && change * INTERVALS_A_RISE * interval > q->s - p->s;
}

static double most_attenuation(const tc_transfer *tf)
{
    double most = 0;
    for (size_t i = 0; i < tf->n; i++)
        most = fmax(most, tf->knot[i].a);
    return most;
}

double tc_running_steep(const tc_transfer *tf, int n, const double span[2])
{
    const double interval = (span[1] - span[0]) / (n - 1), most = most_attenuation(tf);
    double share = 0, end = span[0];
    for (size_t k = 0; k + 1 < tf->n; k++) {
        double from = fmax(tf->knot[k].s - BESIDE * interval, end),
               to = fmin(tf->knot[k + 1].s + BESIDE * interval, span[1]);
        if (to > from && is_steep(tf, k, interval, most)) {
            share += (to - from) / (span[1] - span[0]);
            end = to;
        }
    }
    return fmin(share, 1);
}

/* Takes away what nodes beside steep rises would say. */
static void leave_out(tc_running *out, const tc_transfer *tf)
{
    const double interval = (out->span[1] - out->span[0]) / (out->n - 1), most = most_attenuation(tf);
    for (size_t k = 0; k + 1 < tf->n; k++) {
        if (!is_steep(tf, k, interval, most))
            continue;
        double from = (tf->knot[k].s - out->span[0]) / interval - BESIDE,
               to = (tf->knot[k + 1].s - out->span[0]) / interval + BESIDE;
        if (!(to >= 0) || !(from <= out->n - 1))
            continue;
        int last = (int)fmin(floor(to), out->n - 1);
        for (int i = (int)fmax(ceil(from), 0); i <= last; i++)
            out->point[4 * (size_t)i + 3] = TC_RUNNING_LEFT_OUT;
    }
}

/* The share of the span in which the function absorbs nothing. */
static double clear_share(const tc_transfer *tf, const double span[2])
{
    double share = 0;
    for (size_t k = 0; k <= tf->n; k++) { /* the pieces that end at knot k */
        const tc_knot *p = &tf->knot[k > 0 ? k - 1 : 0], *q = &tf->knot[k < tf->n ? k : tf->n - 1];
        double from = fmax(k > 0 ? p->s : span[0], span[0]), to = fmin(k < tf->n ? q->s : span[1], span[1]);
        if (p->a == 0 && q->a == 0 && to > from)
            share += (to - from) / (span[1] - span[0]);
    }
    return share;
}

tc_status tc_running_build(tc_running *out, const tc_transfer *tf, int n, const double span[2], bool leave_steep,
                           tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (!tf || n < 2)
        return tc_fail(err, TC_E_ARG, "running integrals need a transfer function and at least 2 nodes, not %d", n);
    const double width = span[1] - span[0];
    if (!isfinite(width) || !(width > 0))
        return tc_fail(err, TC_E_ARG,
                       "running integrals over the scalars %g to %g: the range must be finite and not "
                       "empty",
                       span[0], span[1]);
    const double start = tc_now_ms();
    float *point = tc_alloc((size_t)n, 4 * sizeof *point), *cumulative = tc_alloc((size_t)n, 4 * sizeof *cumulative);
    double(*exact)[4] = tc_alloc((size_t)n, sizeof *exact);
    if (!point || !cumulative || !exact) {
        free(point);
        free(cumulative);
        free(exact);
        return tc_fail_memory(err, "running integrals", (size_t)n, 8 * sizeof *point + sizeof *exact);
    }
    const double tolerance = 4 * DBL_EPSILON * fmax(fabs(span[0]), fabs(span[1]));
    double pivot[4], sum[4] = {0, 0, 0, 0}, at = span[0];
    size_t piece = 0; /* the first knot beyond `at` ends the piece */
    for (int i = 0; i < n; i++) {
        const double s = i == n - 1 ? span[1] : span[0] + width * ((double)i / (n - 1));
        if (i > 0) {
            while (piece < tf->n && tf->knot[piece].s <= s) {
                if (tf->knot[piece].s > at) {
                    add_piece(sum, tf, piece, at, tf->knot[piece].s, width, pivot);
                    at = tf->knot[piece].s;
                }
                piece++;
            }
            if (s > at)
                add_piece(sum, tf, piece, at, s, width, pivot);
            at = s;
        } else
            while (piece < tf->n && tf->knot[piece].s <= s)
                piece++;
        double value[4];
        node_value(value, tf, piece, s, tolerance);
        if (i == 0)
            memcpy(pivot, value, sizeof pivot);
        for (int c = 0; c < 4; c++) {
            point[4 * (size_t)i + (size_t)c] = (float)value[c];
            exact[i][c] = sum[c];
        }
    }
    bool clear = clear_share(tf, span) > CLEAR_SHARE;
    for (int c = 0; c < 4; c++)
        out->mean[c] = clear ? 0 : pivot[c] + sum[c];
    for (int i = 0; i < n; i++)
        for (int c = 0; c < 4; c++) {
            double left = exact[i][c] + (pivot[c] - out->mean[c]) * ((double)i / (n - 1));
            cumulative[4 * (size_t)i + (size_t)c] = i == n - 1 && !clear ? 0.0f : (float)left;
        }
    free(exact);
    out->n = n;
    out->point = point;
    out->cumulative = cumulative;
    out->span[0] = span[0];
    out->span[1] = span[1];
    if (leave_steep)
        leave_out(out, tf);
    out->ms = tc_now_ms() - start;
    return TC_OK;
}

void tc_running_finish(tc_running *running)
{
    free(running->point);
    free(running->cumulative);
    memset(running, 0, sizeof *running);
}
