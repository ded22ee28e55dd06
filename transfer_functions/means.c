/* means.c: integrals of extinction and emission over the scalar.
 * Between knots extinction and colour are linear (Weiler et al. 2003, equations 3 and 4 without attenuation), so that
 * emission is quadratic and its integral a polynomial of third degree. */
#include "transfer_functions/means.h"

#include "core/memory.h"
#include "core/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double STEP_MARGIN = 1e-6; /* of an interval: steps so near its ends are at them */
enum { INTERVALS_LEAST = 8192, INTERVALS_MOST = 65536, INTERVALS_A_PIECE = 64 };

/* Over a linear piece from its beginning to x. */
static void piece_integral(double out[4], const tc_segment_piece *p, double x)
{
    const double width = p->x[1] - p->x[0], u = width > 0 ? (x - p->x[0]) / width : 0;
    const double *a = p->value[0], rise = p->value[1][3] - a[3];
    for (int c = 0; c < 3; c++) {
        const double slope = p->value[1][c] - a[c];
        out[c] = width * u * (a[3] * a[c] + u * (0.5 * (a[3] * slope + rise * a[c]) + u * (1.0 / 3) * rise * slope));
    }
    out[3] = width * u * (a[3] + 0.5 * u * rise);
}

tc_status tc_cumulative_build(tc_cumulative *out, const tc_segments *segments, tc_error *err)
{
    out->segments = segments;
    out->sum = tc_alloc(segments->n_piece + 1, sizeof *out->sum);
    if (!out->sum)
        return tc_fail_memory(err, "integrals of a transfer function", segments->n_piece + 1, sizeof *out->sum);
    memset(out->sum[0], 0, sizeof out->sum[0]);
    for (size_t i = 0; i < segments->n_piece; i++) {
        double part[4];
        piece_integral(part, &segments->piece[i], segments->piece[i].x[1]);
        for (int c = 0; c < 4; c++)
            out->sum[i + 1][c] = out->sum[i][c] + part[c];
    }
    return TC_OK;
}

void tc_cumulative_finish(tc_cumulative *cumulative)
{
    free(cumulative->sum);
    cumulative->sum = NULL;
}

void tc_cumulative_at(double out[4], const tc_cumulative *cumulative, double x, size_t *piece)
{
    const tc_segments *s = cumulative->segments;
    size_t p = *piece;
    while (p > 0 && s->piece[p].x[0] > x)
        p--;
    while (p + 1 < s->n_piece && s->piece[p].x[1] <= x)
        p++;
    piece_integral(out, &s->piece[p], x);
    for (int c = 0; c < 4; c++)
        out[c] += cumulative->sum[p][c];
    *piece = p;
}

int tc_means_intervals(const tc_transfer *tf, const double span[2])
{
    double narrowest = span[1] - span[0];
    for (size_t i = 1; i < tf->n; i++)
        if (tf->knot[i].s > span[0] && tf->knot[i - 1].s < span[1])
            narrowest = fmin(narrowest, tf->knot[i].s - tf->knot[i - 1].s);
    int n = INTERVALS_LEAST;
    while (n < INTERVALS_MOST && n * narrowest < INTERVALS_A_PIECE * (span[1] - span[0]))
        n *= 2;
    return n;
}

/* The steepest rise between two knots that lie within x0 … x1, off its ends: its middle. */
static bool find_step(double *place, const tc_transfer *tf, const double *x, size_t *knot, double x0, double x1)
{
    const double margin = STEP_MARGIN * (x1 - x0);
    double steepest = 0;
    while (*knot < tf->n && x[*knot] <= x0 + margin)
        ++*knot;
    size_t k = *knot;
    for (; k + 1 < tf->n && x[k + 1] < x1 - margin; k++) {
        const tc_knot *p = &tf->knot[k], *q = p + 1;
        const double rise = fmax(
            fabs(q->a - p->a), fmax(p->a, q->a) * fmax(fabs(q->r - p->r), fmax(fabs(q->g - p->g), fabs(q->b - p->b))));
        if (rise > steepest) {
            steepest = rise;
            *place = 0.5 * (x[k] + x[k + 1]);
        }
    }
    *knot = k;
    return steepest > 0;
}

static void mean_of(float out[4], const double low[4], const double high[4], double width)
{
    for (int c = 0; c < 4; c++)
        out[c] = (float)(fmax(high[c] - low[c], 0) / width);
}

static void fill_cells(tc_means *out, const tc_cumulative *cumulative, const tc_transfer *tf, const double *knot_x)
{
    double low[4] = {0, 0, 0, 0}, middle[4], high[4], place = 0;
    size_t piece = 0, knot = 0;
    for (int i = 0; i < out->n; i++) {
        float *cell = out->cell + 12 * (size_t)i;
        const double x0 = i / (double)out->n, x1 = (i + 1) / (double)out->n;
        tc_cumulative_at(high, cumulative, x1, &piece);
        for (int c = 0; c < 4; c++) {
            cell[4 + c] = (float)low[c];
            cell[8 + c] = (float)(low[c] - (double)cell[4 + c]);
        }
        if (find_step(&place, tf, knot_x, &knot, x0, x1)) {
            const size_t record = 3 * (size_t)out->n + 2 * (size_t)out->n_step++;
            tc_cumulative_at(middle, cumulative, place, &piece);
            mean_of(out->cell + 4 * record, low, middle, place - x0);
            mean_of(out->cell + 4 * record + 4, middle, high, x1 - place);
            cell[0] = (float)(place - x0);
            cell[1] = (float)record;
            cell[2] = 0;
            cell[3] = -1;
        } else
            mean_of(cell, low, high, x1 - x0);
        memcpy(low, high, sizeof low);
    }
}

tc_status tc_means_build(tc_means *out, const tc_transfer *tf, int n, const double span[2], tc_error *err)
{
    memset(out, 0, sizeof *out);
    const double start = tc_now_ms(), width = span[1] - span[0], ends[2] = {0, 1};
    if (!tf || n < 1)
        return tc_fail(err, TC_E_ARG, "means need a transfer function and at least one interval, not %d", n);
    if (!isfinite(width) || !(width > 0))
        return tc_fail(err, TC_E_ARG, "means over the scalars %g to %g: the range must be finite and not empty",
                       span[0], span[1]);
    tc_segments segments;
    tc_cumulative cumulative = {0};
    tc_status status = tc_segments_build(&segments, tf, span, 1, ends, 2, err);
    if (status != TC_OK)
        return status;
    status = tc_cumulative_build(&cumulative, &segments, err);
    out->n = n;
    const size_t steps = tf->n < (size_t)n ? tf->n : (size_t)n, room = 3 * (size_t)n + 2 * steps;
    double *x = tc_alloc(tf->n, sizeof *x);
    out->cell = tc_alloc(room, 4 * sizeof *out->cell);
    if (status == TC_OK && (!x || !out->cell))
        status = tc_fail_memory(err, "means of a transfer function", room, 4 * sizeof *out->cell);
    if (status == TC_OK) {
        for (size_t i = 0; i < tf->n; i++)
            x[i] = (tf->knot[i].s - span[0]) / width;
        fill_cells(out, &cumulative, tf, x);
    }
    free(x);
    tc_cumulative_finish(&cumulative);
    tc_segments_finish(&segments);
    if (status != TC_OK)
        tc_means_finish(out);
    out->ms = status == TC_OK ? tc_now_ms() - start : 0;
    return status;
}

void tc_means_finish(tc_means *means)
{
    free(means->cell);
    memset(means, 0, sizeof *means);
}
