/* drift.c: the table of colour drift, built incrementally.
 * Weiler et al. 2003, section 4, equations 5 and 6 with both parts of half the length: with the lengths of an octave
 * twice those of the octave below, each slice is put together from two of the same shorter one. For parts of colour K1,
 * K2 over opacity, opacity A1, A2 and mean colour M1, M2 the whole has K = w1 K1 + w2 K2,   w2 = (1 - A1) A2 / A,   w1
 * = 1 - w2, and without length the same with weights v by optical depth, so that the drifts D = K - M add as D = w1 D1
 * + w2 D2 + (w2 - v2) (M2 - M1). Means and opacities at the split point are exact; only the parts' drifts, small as
 * they are, are interpolated. An octave begins with lengths so short that the drift is a series of three terms in
 * length.
 *
 * Slices of odd units are integrated; all others come from them by doubling, each chain by itself. */
#include "transfer_functions/drift.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "transfer_functions/means.h"
#include "transfer_functions/table_frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const int OCTAVES = 8;                /* below length_max, if there are entries enough */
static const double SERIES_DEPTH = 1.0 / 16; /* optical depth up to which the series is used */

/* What does not depend on length, for each pair of s_front, s_back; s_front runs fastest.
 *   step   M2 - M1, v2
 *   term   series of the drift in length / length_max; fourth of term 0 and 1: optical depth of either part at 1 */
typedef struct pair {
    tc_quad step, term[3];
} pair;

typedef struct build {
    tc_table_frame frame; /* its segments have length_max */
    int octave, extra;    /* extra: doublings before the table's first slices */
    double unit;          /* of length, as a share of length_max */
    tc_cumulative cumulative;
    pair *pair;                /* [n_back][n_front] */
    tc_segment_series *series; /* [threads][n_node] */
    tc_quad *slice;            /* [threads][2][n_back][n_front] */
    float *opacity;            /* [threads][2][n_back][n_front] of both parts */
} build;

int tc_drift_octave(int n)
{
    int octave = 1;
    while ((OCTAVES + 1) * octave < n - 1)
        octave *= 2;
    return octave;
}

double tc_drift_length(int entry, int octave)
{
    return entry < 2 * octave ? entry : ldexp(octave + entry % octave, entry / octave - 1);
}

/* The entry of a length that is one. */
static size_t entry_of(size_t length, size_t octave)
{
    size_t entry = 0;
    for (; length >= 2 * octave; length /= 2)
        entry += octave;
    return entry + length;
}

/* ----------------------------------------------------------------------------------------------------------- means */

/* Mean colour and mean extinction between two places whose integrals are given. */
static void mean_between(double out[4], const double near[4], const double far[4], double width)
{
    const double depth = far[3] - near[3];
    for (int c = 0; c < 3; c++)
        out[c] = depth > 0 ? fmax(0, (far[c] - near[c]) / depth) : 0;
    out[3] = fmax(0, depth) / width;
}

/* One row of pairs: `front` fixed, for base_rows. */
static void pair_row(build *job, size_t front, const tc_segment_series *series)
{
    const tc_table_frame *frame = &job->frame;
    const tc_segments *s = &frame->segments;
    const size_t node = frame->front_node[front];
    size_t hint[2] = {0, 0};
    double here[4];
    tc_cumulative_at(here, &job->cumulative, s->x[node], &hint[0]);
    for (size_t i = 0; i < s->n_node; i++) {
        if (frame->node_back[i] < 0)
            continue;
        const tc_segment_series *d = &series[i];
        pair *out = &job->pair[(size_t)frame->node_back[i] * frame->n_front + front];
        double first[4] = {0, 0, 0, d->depth}, second[4] = {0, 0, 0, d->depth};
        if (i != node) {
            double middle[4], there[4];
            const double x = 0.5 * (s->x[node] + s->x[i]), width = x - s->x[node];
            tc_cumulative_at(middle, &job->cumulative, x, &hint[0]);
            tc_cumulative_at(there, &job->cumulative, s->x[i], &hint[1]);
            if (width > 0) {
                mean_between(first, here, middle, width);
                mean_between(second, middle, there, width);
            } else {
                mean_between(first, middle, here, -width);
                mean_between(second, there, middle, -width);
            }
        }
        const double depth = first[3] + second[3];
        for (int c = 0; c < 4; c++)
            out->step[c] = c < 3 && first[3] > 0 && second[3] > 0 ? (float)(second[c] - first[c]) : 0;
        out->step[3] = depth > 0 ? (float)(second[3] / depth) : 0;
        for (int k = 0; k < 3; k++)
            out->term[k] = (tc_quad){(float)d->term[k][0], (float)d->term[k][1], (float)d->term[k][2], 0};
        out->term[0][3] = (float)first[3];
        out->term[1][3] = (float)second[3];
    }
}

static void base_rows(void *context, size_t begin, size_t end, int worker)
{
    build *job = context;
    const tc_table_frame *frame = &job->frame;
    tc_segment_series *series = job->series + frame->n_node * (size_t)worker;
    for (size_t front = begin; front < end; front++) {
        tc_segments_series(series, &frame->segments, frame->front_node[front]);
        pair_row(job, front, series);
    }
}

/* ---------------------------------------------------------------------------------------------------------- chains */

/* Drift at a short length, and the opacity of the parts that make up the double of it. */
static void begin_chain(tc_quad *restrict out, float *restrict a1, float *restrict a2, const build *job, float length)
{
    const size_t n = job->frame.n_front * job->frame.n_back;
    for (size_t i = 0; i < n; i++) {
        const pair *p = &job->pair[i];
        out[i] = length * (p->term[0] + length * (p->term[1] + length * p->term[2]));
        out[i][3] = 0;
        const float t1 = length * p->term[0][3], t2 = length * p->term[1][3];
        a1[i] = t1 * (1 - t1 * (0.5f - t1 * (1.0f / 6 - t1 * (1.0f / 24))));
        a2[i] = t2 * (1 - t2 * (0.5f - t2 * (1.0f / 6 - t2 * (1.0f / 24))));
    }
}

/* One row (s_back) of the slice of twice the length. */
static void double_row(tc_quad *restrict out, float *restrict a1, float *restrict a2, const tc_quad *half,
                       const build *job, size_t back)
{
    const size_t n = job->frame.n_front, last = job->frame.n_back - 1;
    const pair *p = job->pair + n * back;
    const double scale = 0.5 * (double)last / (double)(n - 1), offset = 0.5 * (double)back;
    const double middle = 0.5 * (double)back * (double)(n - 1) / (double)last;
    const tc_quad *row = half + n * back;
    for (size_t f = 0; f < n; f++) {
        /* the split point, in entries along s_back and s_front */
        const double place1 = (double)(int)f * scale + offset, place2 = 0.5 * (double)(int)f + middle;
        int i1 = (int)place1, i2 = (int)place2;
        i1 = i1 < (int)last ? i1 : (int)last - 1;
        i2 = i2 < (int)n - 1 ? i2 : (int)n - 2;
        const float t1 = (float)(place1 - i1), t2 = (float)(place2 - i2);
        const tc_quad *near = half + n * (size_t)i1 + f;
        const tc_quad d1 = near[0] + t1 * (near[n] - near[0]), d2 = row[i2] + t2 * (row[i2 + 1] - row[i2]);
        const float rear = (1 - a1[f]) * a2[f], w2 = rear / (a1[f] + rear + 1e-37f);
        out[f] = d1 + w2 * (d2 - d1) + (w2 - p[f].step[3]) * p[f].step;
        out[f][3] = 0;
        a1[f] *= 2 - a1[f];
        a2[f] *= 2 - a2[f];
    }
}

static void chains(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    const tc_table_frame *frame = &job->frame;
    const size_t row = frame->n_front, n = row * frame->n_back, octave = (size_t)job->octave;
    tc_quad *slice[2] = {job->slice + 2 * n * (size_t)worker, job->slice + n * (2 * (size_t)worker + 1)};
    float *a1 = job->opacity + 2 * n * (size_t)worker, *a2 = a1 + n;
    const size_t longest = (size_t)tc_drift_length((int)frame->n_length - 1, job->octave);
    for (size_t chain = begin; chain < end; chain++) {
        size_t length = 2 * chain + 1;
        if (length > longest)
            break;
        begin_chain(slice[0], a1, a2, job, (float)ldexp((double)length * job->unit, -job->extra));
        for (int level = -job->extra;; level++) {
            if (level >= 0) {
                const size_t entry = entry_of(length, octave);
                for (size_t back = 0; back < frame->n_back; back++)
                    tc_table_frame_store(frame, entry, back, slice[0] + row * back);
                if (2 * length > longest)
                    break;
                length *= 2;
            }
            for (size_t back = 0; back < frame->n_back; back++)
                double_row(slice[1] + row * back, a1 + row * back, a2 + row * back, slice[0], job, back);
            tc_quad *swap = slice[0];
            slice[0] = slice[1];
            slice[1] = swap;
        }
    }
}

/* -------------------------------------------------------------------------------------------------- entry by entry */

/* The slow way: as many segments as the entry's length has of length_max / (size[2] - 1), each integrated. */
static void separate_slices(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    const tc_table_frame *frame = &job->frame;
    const size_t nf = frame->n_front, nb = frame->n_back;
    tc_quad *row = job->slice + 2 * nf * nb * (size_t)worker;
    for (size_t k = begin + 1; k < end + 1; k++) {
        const double length = tc_drift_length((int)k, job->octave) * job->unit;
        const int parts = (int)ceil(length * (double)(frame->n_length - 1) - 1e-9);
        for (size_t back = 0; back < nb; back++) {
            const double x_back = (double)back / (double)(nb - 1);
            size_t hint = 0, place = 0;
            double there[4];
            tc_cumulative_at(there, &job->cumulative, x_back, &place);
            for (size_t front = 0; front < nf; front++) {
                const double x_front = (double)front / (double)(nf - 1);
                double sum[4], mean[4], here[4];
                tc_table_frame_march(sum, frame, (const double[2]){x_front, x_back}, parts, length / parts, &hint);
                row[front] = (tc_quad){0, 0, 0, 0};
                if (x_front == x_back || !(sum[3] > 0))
                    continue;
                tc_cumulative_at(here, &job->cumulative, x_front, &place);
                mean_between(mean, x_front < x_back ? here : there, x_front < x_back ? there : here, 1);
                for (int c = 0; c < 3; c++)
                    row[front][c] = (float)(sum[c] / sum[3] - mean[c]);
            }
            tc_table_frame_store(frame, k, back, row);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- the whole */

static tc_status allocate(build *job, tc_error *err)
{
    const tc_table_frame *frame = &job->frame;
    const size_t threads = (size_t)frame->threads, n = frame->n_front * frame->n_back;
    job->pair = tc_alloc(n, sizeof *job->pair);
    job->series = tc_alloc(threads * frame->n_node, sizeof *job->series);
    job->slice = tc_alloc(2 * threads * n, sizeof *job->slice);
    job->opacity = tc_alloc(2 * threads * n, sizeof *job->opacity);
    if (!job->pair || !job->series || !job->slice || !job->opacity)
        return tc_fail_memory(err, "the table of colour drift", 2 * threads * n, sizeof *job->slice);
    return TC_OK;
}

/* So many doublings before the first slices that their series is short enough. */
static int count_extra(const build *job)
{
    double deepest = 0;
    for (size_t i = 0; i < job->frame.segments.n_piece; i++) {
        const tc_segment_piece *piece = &job->frame.segments.piece[i];
        deepest = fmax(deepest, fmax(piece->value[0][3], piece->value[1][3]));
    }
    deepest *= (2 * job->octave - 1) * job->unit;
    int extra = 0;
    for (; deepest > SERIES_DEPTH; deepest /= 2)
        extra++;
    return extra;
}

static void fill(build *job)
{
    const tc_table_frame *frame = &job->frame;
    if (frame->options->entry_by_entry) {
        tc_parallel_for(frame->n_length - 1, 1, frame->threads, separate_slices, job);
    } else {
        job->extra = count_extra(job);
        tc_parallel_for(frame->n_front, 4, frame->threads, base_rows, job);
        tc_parallel_for((size_t)job->octave, 1, frame->threads, chains, job);
    }
    frame->table->base_error = SERIES_DEPTH * SERIES_DEPTH * SERIES_DEPTH * SERIES_DEPTH / 720 + 0x1p-24;
}

tc_status tc_drift_build(tc_table *out, const tc_transfer *tf, const tc_table_options *options, tc_error *err)
{
    if (options->format == TC_TABLE_8) {
        memset(out, 0, sizeof *out);
        return tc_fail(err, TC_E_ARG, "a table of colour drift has 16 or 32 bits a channel, not 8");
    }
    build job = {.extra = 0};
    tc_table_frame *frame = &job.frame;
    tc_status status = tc_table_frame_begin(frame, out, tf, options, err);
    if (status != TC_OK)
        goto done;
    job.octave = tc_drift_octave(options->size[2]);
    job.unit = 1 / tc_drift_length(options->size[2] - 1, job.octave);
    status = allocate(&job, err);
    if (status != TC_OK)
        goto done;
    status = tc_segments_build(&frame->segments, tf, options->span, options->length_max, frame->x, frame->n_node, err);
    if (status != TC_OK)
        goto done;
    status = tc_cumulative_build(&job.cumulative, &frame->segments, err);
    if (status == TC_OK)
        fill(&job);
done:
    tc_cumulative_finish(&job.cumulative);
    free(job.pair);
    free(job.series);
    free(job.slice);
    free(job.opacity);
    return tc_table_frame_end(frame, status);
}
