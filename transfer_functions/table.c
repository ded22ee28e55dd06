/* table.c: the three-dimensional pre-integrated table, built incrementally.
 * Weiler et al. 2003, section 4: the slice of length dl is integrated numerically (segment.h); every further one is put
 * together from two shorter ones by equations 5 and 6, with linear interpolation at the split point s_p.
 *
 * Two things keep the error from growing with l (the paper's note on accumulation), where splitting off dl each time
 * blurs the table along s by one more interpolation a slice:
 * - The front part is the longest slice of 2^j dl shorter than l, so an entry stands on about log2(l / dl)
 * interpolations, not l / dl. The slices of 2^j dl come from halves.
 * - The transparency of a segment depends on its length and its mean extinction alone, so
 *     alpha(s_f, s_b, l1 + l2) = alpha(s_f, s_b, l1) + (1 - alpha(s_f, s_b, l1)) alpha(s_f, s_b, l2)
 *   holds without any interpolation; the colour of equation 5 is scaled by that opacity over the interpolated one.
 *
 * The rear part has the same s_b, so each s_b is a recursion of its own, given the slices of 2^j dl. An entry is one
 * four-float vector. */
#include "transfer_functions/table.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "transfer_functions/table_frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct build {
    tc_table_frame frame;      /* its segments have the length dl */
    size_t n_level, level_now; /* level j: length 2^j dl */
    tc_quad *level;            /* [n_level][n_front][n_front]: s_front, then s_back, both at the places of s_front */
    tc_quad *first;            /* [n_back][n_front]: base slice at the table's own s_back */
    size_t n_history;          /* slices 1 .. n_history are front or rear parts of others */
    tc_quad *history;          /* [threads][n_history + 1][n_front]; the last row is for what is no part */
    double (*value)[4];        /* [threads][n_node] */
    double *error;             /* [threads] */
} build;

/* ------------------------------------------------------------------------------------------------------- recursion */

/* Equations 5 and 6; opacity: that of the whole. */
static inline tc_quad blend(tc_quad front, tc_quad rear, float opacity)
{
    const float pass = 1 - front[3];
    tc_quad whole = front + pass * rear;
    whole *= opacity / (whole[3] + 1e-37f);
    whole[3] = opacity;
    return whole;
}

/* Row of slice k from the same row (s_back) of two shorter slices.
 *   split   fraction of the length that is the front part; its slice is `level`
 *   near, far   the row in the slices of the front and of the rear part's length
 *   back    s_back in units of the s_front spacing */
static void blend_row(tc_quad *restrict out, const tc_quad *restrict level, const tc_quad *restrict near,
                      const tc_quad *restrict far, size_t n, double split, double back)
{
    for (size_t f = 0; f < n; f++) {
        const double place = (double)f + (back - (double)f) * split;
        int p = (int)place;
        p = p > (int)n - 2 ? (int)n - 2 : p;
        const float t = (float)(place - p);
        const tc_quad *front = level + n * f + p, *rear = far + p;
        out[f] = blend(front[0] + t * (front[1] - front[0]), rear[0] + t * (rear[1] - rear[0]),
                       near[f][3] + (1 - near[f][3]) * far[f][3]);
    }
}

/* Rows [begin, end) of s_front of the next level from the one before, split in the middle. */
static void level_rows(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const build *job = context;
    const size_t n = job->frame.n_front;
    const tc_quad *half = job->level + n * n * (job->level_now - 1);
    tc_quad *out = job->level + n * n * job->level_now;
    for (size_t f = begin; f < end; f++)
        for (size_t b = 0; b < n; b++) {
            const size_t low = (f + b) / 2, high = (f + b + 1) / 2;
            const tc_quad front = 0.5f * (half[n * f + low] + half[n * f + high]);
            const tc_quad rear = 0.5f * (half[n * low + b] + half[n * high + b]);
            const float opacity = half[n * f + b][3];
            out[n * f + b] = blend(front, rear, opacity + (1 - opacity) * opacity);
        }
}

static void incremental_rows(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    const size_t n = job->frame.n_front;
    tc_quad *history = job->history + n * (job->n_history + 1) * (size_t)worker - n; /* slice 1 comes first */
    for (size_t back = begin; back < end; back++) {
        const double place = (double)back * (double)(n - 1) / (double)(job->frame.n_back - 1);
        memcpy(history + n, job->first + n * back, n * sizeof *history);
        tc_table_frame_store(&job->frame, 1, back, history + n);
        size_t j = 0, power = 1; /* the front part: 2^j < k */
        for (size_t k = 2; k < job->frame.n_length; k++) {
            if (k > 2 * power) {
                power *= 2;
                j++;
            }
            tc_quad *out = history + n * (k <= job->n_history ? k : job->n_history + 1);
            blend_row(out, job->level + n * n * j, history + n * power, history + n * (k - power), n,
                      (double)power / (double)k, place);
            tc_table_frame_store(&job->frame, k, back, out);
        }
    }
}

/* The slow way: k segments of length dl for an entry of slice k, each integrated as those of the base slice. */
static void separate_rows(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    const tc_table_frame *frame = &job->frame;
    tc_quad *row = job->history + frame->n_front * (job->n_history + 1) * (size_t)worker;
    for (size_t back = begin; back < end; back++)
        for (int k = 1; k < (int)frame->n_length; k++) {
            const double x_back = (double)back / (double)(frame->n_back - 1);
            size_t hint = 0;
            for (size_t front = 0; front < frame->n_front; front++) {
                const double x_front = (double)front / (double)(frame->n_front - 1);
                double sum[4];
                tc_table_frame_march(sum, frame, (const double[2]){x_front, x_back}, k, 1, &hint);
                row[front] = (tc_quad){(float)sum[0], (float)sum[1], (float)sum[2], (float)sum[3]};
            }
            tc_table_frame_store(frame, (size_t)k, back, row);
        }
}

/* ------------------------------------------------------------------------------------------------------ base slice */

static void base_rows(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    const tc_table_frame *frame = &job->frame;
    const size_t n = frame->n_front, n_node = frame->n_node;
    double(*value)[4] = job->value + n_node * (size_t)worker;
    for (size_t front = begin; front < end; front++) {
        tc_segments_row(value, &job->error[worker], &frame->segments, frame->front_node[front]);
        for (size_t i = 0; i < n_node; i++) {
            const tc_quad v = {(float)value[i][0], (float)value[i][1], (float)value[i][2], (float)value[i][3]};
            if (frame->node_front[i] >= 0)
                job->level[n * front + (size_t)frame->node_front[i]] = v;
            if (frame->node_back[i] >= 0)
                job->first[n * (size_t)frame->node_back[i] + front] = v;
        }
    }
}

/* ------------------------------------------------------------------------------------------------------- the whole */

static tc_status allocate(build *job, tc_error *err)
{
    const tc_table_frame *frame = &job->frame;
    const size_t threads = (size_t)frame->threads, row = frame->n_front * sizeof(tc_quad);
    job->level = tc_alloc(job->n_level * frame->n_front, row);
    job->first = tc_alloc(frame->n_back, row);
    job->history = tc_alloc(threads * (job->n_history + 1), row);
    job->value = tc_alloc(threads, frame->n_node * sizeof *job->value);
    job->error = tc_calloc(threads, sizeof *job->error);
    if (!job->level || !job->first || !job->history || !job->value || !job->error)
        return tc_fail_memory(err, "the pre-integration table's base", job->n_level * frame->n_front, row);
    return TC_OK;
}

static void fill(build *job)
{
    const tc_table_frame *frame = &job->frame;
    if (frame->options->entry_by_entry) {
        tc_parallel_for(frame->n_back, 1, frame->threads, separate_rows, job);
    } else {
        tc_parallel_for(frame->n_front, 4, frame->threads, base_rows, job);
        for (job->level_now = 1; job->level_now < job->n_level; job->level_now++)
            tc_parallel_for(frame->n_front, 16, frame->threads, level_rows, job);
        tc_parallel_for(frame->n_back, 4, frame->threads, incremental_rows, job);
    }
    for (int i = 0; i < frame->threads; i++)
        frame->table->base_error = fmax(frame->table->base_error, job->error[i]);
    frame->table->base_error += 0x1p-25; /* rounding to float */
}

tc_status tc_table_build(tc_table *out, const tc_transfer *tf, const tc_table_options *options, tc_error *err)
{
    build job = {.n_level = 1, .n_history = 1};
    tc_table_frame *frame = &job.frame;
    tc_status status = tc_table_frame_begin(frame, out, tf, options, err);
    if (status != TC_OK)
        goto done;
    for (; 2 * job.n_history + 1 < frame->n_length; job.n_history *= 2)
        job.n_level++;
    status = allocate(&job, err);
    if (status != TC_OK)
        goto done;
    status = tc_segments_build(&frame->segments, tf, options->span, options->length_max / (options->size[2] - 1),
                               frame->x, frame->n_node, err);
    if (status == TC_OK)
        fill(&job);
done:
    free(job.level);
    free(job.first);
    free(job.history);
    free(job.value);
    free(job.error);
    return tc_table_frame_end(frame, status);
}

void tc_table_finish(tc_table *table)
{
    free(table->rgba);
    memset(table, 0, sizeof *table);
}
