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
#include "transfer_functions/half.h"
#include "transfer_functions/segment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef float quad __attribute__((vector_size(16))); /* r, g, b, a */

typedef struct build {
    const tc_table_options *options;
    tc_table *table;
    tc_segments segments;
    size_t n_front, n_back;
    int *node_front, *node_back; /* [n_node] entry along s_front, s_back at a node, or -1 */
    size_t *front_node;          /* [n_front] */
    size_t n_level, level_now;   /* level j: length 2^j dl */
    quad *level;                 /* [n_level][n_front][n_front]: s_front, then s_back, both at the places of s_front */
    quad *first;                 /* [n_back][n_front]: base slice at the table's own s_back */
    size_t n_history;            /* slices 1 .. n_history are front or rear parts of others */
    quad *history;               /* [threads][n_history + 1][n_front]; the last row is for what is no part */
    double (*value)[4];          /* [threads][n_node] */
    double *error;               /* [threads] */
} build;

/* --------------------------------------------------------------------------------------------------- out of floats */

static void store_8(uint8_t *restrict out, const float *restrict value, size_t n)
{
    for (size_t i = 0; i < n; i++)
        out[i] = (uint8_t)(int)(value[i] * 255.0f + 0.5f);
}

static void store_16(uint16_t *restrict out, const float *restrict value, size_t n)
{
    for (size_t i = 0; i < n; i++)
        out[i] = tc_half_of(value[i]);
}

static void store_row(const build *job, size_t slice, size_t back, const quad *row)
{
    const size_t n = 4 * job->n_front, at = n * (back + job->n_back * slice);
    const float *value = (const float *)row;
    switch (job->table->format) {
    case TC_TABLE_8:
        store_8((uint8_t *)job->table->rgba + at, value, n);
        break;
    case TC_TABLE_16F:
        store_16((uint16_t *)job->table->rgba + at, value, n);
        break;
    default:
        memcpy((float *)job->table->rgba + at, value, n * sizeof *value);
        break;
    }
}

/* ------------------------------------------------------------------------------------------------------- recursion */

/* Equations 5 and 6; opacity: that of the whole. */
static inline quad blend(quad front, quad rear, float opacity)
{
    const float pass = 1 - front[3];
    quad whole = front + pass * rear;
    whole *= opacity / (whole[3] + 1e-37f);
    whole[3] = opacity;
    return whole;
}

/* Row of slice k from the same row (s_back) of two shorter slices.
 *   split   fraction of the length that is the front part; its slice is `level`
 *   near, far   the row in the slices of the front and of the rear part's length
 *   back    s_back in units of the s_front spacing */
static void blend_row(quad *restrict out, const quad *restrict level, const quad *restrict near,
                      const quad *restrict far, size_t n, double split, double back)
{
    for (size_t f = 0; f < n; f++) {
        const double place = (double)f + (back - (double)f) * split;
        int p = (int)place;
        p = p > (int)n - 2 ? (int)n - 2 : p;
        const float t = (float)(place - p);
        const quad *front = level + n * f + p, *rear = far + p;
        out[f] = blend(front[0] + t * (front[1] - front[0]), rear[0] + t * (rear[1] - rear[0]),
                       near[f][3] + (1 - near[f][3]) * far[f][3]);
    }
}

/* Rows [begin, end) of s_front of the next level from the one before, split in the middle. */
static void level_rows(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const build *job = context;
    const size_t n = job->n_front;
    const quad *half = job->level + n * n * (job->level_now - 1);
    quad *out = job->level + n * n * job->level_now;
    for (size_t f = begin; f < end; f++)
        for (size_t b = 0; b < n; b++) {
            const size_t low = (f + b) / 2, high = (f + b + 1) / 2;
            const quad front = 0.5f * (half[n * f + low] + half[n * f + high]);
            const quad rear = 0.5f * (half[n * low + b] + half[n * high + b]);
            const float opacity = half[n * f + b][3];
            out[n * f + b] = blend(front, rear, opacity + (1 - opacity) * opacity);
        }
}

static void incremental_rows(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    const size_t n = job->n_front;
    quad *history = job->history + n * (job->n_history + 1) * (size_t)worker - n; /* slice 1 comes first */
    for (size_t back = begin; back < end; back++) {
        const double place = (double)back * (double)(n - 1) / (double)(job->n_back - 1);
        memcpy(history + n, job->first + n * back, n * sizeof *history);
        store_row(job, 1, back, history + n);
        size_t j = 0, power = 1; /* the front part: 2^j < k */
        for (size_t k = 2; k < (size_t)job->options->size[2]; k++) {
            if (k > 2 * power) {
                power *= 2;
                j++;
            }
            quad *out = history + n * (k <= job->n_history ? k : job->n_history + 1);
            blend_row(out, job->level + n * n * j, history + n * power, history + n * (k - power), n,
                      (double)power / (double)k, place);
            store_row(job, k, back, out);
        }
    }
}

/* The slow way: k segments of length dl for an entry of slice k, each integrated as those of the base slice. */
static void separate_rows(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    quad *row = job->history + job->n_front * (job->n_history + 1) * (size_t)worker;
    for (size_t back = begin; back < end; back++)
        for (int k = 1; k < job->options->size[2]; k++) {
            const double x_back = (double)back / (double)(job->n_back - 1);
            size_t hint = 0;
            for (size_t front = 0; front < job->n_front; front++) {
                const double x_front = (double)front / (double)(job->n_front - 1);
                double sum[4] = {0, 0, 0, 0}, pass = 1;
                for (int i = 0; i < k; i++) {
                    double part[4];
                    tc_segments_between(part, &job->segments, x_front + (x_back - x_front) * i / k,
                                        x_front + (x_back - x_front) * (i + 1) / k, &hint);
                    for (int c = 0; c < 4; c++)
                        sum[c] += pass * part[c];
                    pass *= 1 - part[3];
                }
                row[front] = (quad){(float)sum[0], (float)sum[1], (float)sum[2], (float)sum[3]};
            }
            store_row(job, (size_t)k, back, row);
        }
}

/* ------------------------------------------------------------------------------------------------------ base slice */

static void base_rows(void *context, size_t begin, size_t end, int worker)
{
    build *job = context;
    const size_t n = job->n_front, n_node = job->segments.n_node;
    double(*value)[4] = job->value + n_node * (size_t)worker;
    for (size_t front = begin; front < end; front++) {
        tc_segments_row(value, &job->error[worker], &job->segments, job->front_node[front]);
        for (size_t i = 0; i < n_node; i++) {
            const quad v = {(float)value[i][0], (float)value[i][1], (float)value[i][2], (float)value[i][3]};
            if (job->node_front[i] >= 0)
                job->level[n * front + (size_t)job->node_front[i]] = v;
            if (job->node_back[i] >= 0)
                job->first[n * (size_t)job->node_back[i] + front] = v;
        }
    }
}

size_t tc_table_axes(double *x, int *node_front, int *node_back, size_t *front_node, const int size[3])
{
    size_t n = 0, front = 0, back = 0;
    const size_t last_front = (size_t)size[0] - 1, last_back = (size_t)size[1] - 1;
    while (front <= last_front || back <= last_back) {
        const uint64_t a = (uint64_t)front * last_back, b = (uint64_t)back * last_front; /* front/last, back/last */
        const bool take_front = front <= last_front && (back > last_back || a <= b);
        const bool take_back = back <= last_back && (front > last_front || b <= a);
        x[n] = take_front ? (double)front / (double)last_front : (double)back / (double)last_back;
        node_front[n] = take_front ? (int)front : -1;
        node_back[n] = take_back ? (int)back : -1;
        if (take_front)
            front_node[front++] = n;
        back += take_back;
        n++;
    }
    return n;
}

/* ------------------------------------------------------------------------------------------------------- the whole */

tc_status tc_table_check(const tc_transfer *tf, const tc_table_options *options, tc_error *err)
{
    static const char *const axis[3] = {"s_front", "s_back", "length"};
    if (!tf)
        return tc_fail(err, TC_E_ARG, "a pre-integration table needs a transfer function");
    for (int i = 0; i < 3; i++)
        if (options->size[i] < 2 || options->size[i] > 16384)
            return tc_fail(err, TC_E_ARG, "a pre-integration table cannot have %d entries along %s; take 2 to 16384",
                           options->size[i], axis[i]);
    const double width = options->span[1] - options->span[0];
    if (!isfinite(width) || !(width > 0))
        return tc_fail(err, TC_E_ARG,
                       "a pre-integration table over the scalars %g to %g: the range must be finite and not empty",
                       options->span[0], options->span[1]);
    if (!isfinite(options->length_max) || !(options->length_max > 0))
        return tc_fail(err, TC_E_ARG, "a pre-integration table for lengths up to %g: give a positive length",
                       options->length_max);
    if (options->format != TC_TABLE_AUTO && options->format != TC_TABLE_8 && options->format != TC_TABLE_16F &&
        options->format != TC_TABLE_32F)
        return tc_fail(err, TC_E_ARG, "no table format %d; take 8, 16 or 32 bits", (int)options->format);
    return TC_OK;
}

static tc_status allocate(build *job, int threads, tc_error *err)
{
    const size_t nodes = job->n_front + job->n_back, row = job->n_front * sizeof(quad);
    tc_table *table = job->table;
    const size_t texel = table->format == TC_TABLE_8 ? 4 : table->format == TC_TABLE_16F ? 8 : 16;
    const size_t entries = job->n_front * job->n_back * (size_t)table->size[2]; /* at most 2^42 */
    job->node_front = tc_alloc(nodes, sizeof *job->node_front);
    job->node_back = tc_alloc(nodes, sizeof *job->node_back);
    job->front_node = tc_alloc(job->n_front, sizeof *job->front_node);
    job->level = tc_alloc(job->n_level * job->n_front, row);
    job->first = tc_alloc(job->n_back, row);
    job->history = tc_alloc((size_t)threads * (job->n_history + 1), row);
    job->value = tc_alloc((size_t)threads, nodes * sizeof *job->value);
    job->error = tc_calloc((size_t)threads, sizeof *job->error);
    table->rgba = tc_alloc(entries, texel);
    table->bytes = entries * texel;
    if (!job->node_front || !job->node_back || !job->front_node || !job->level || !job->first || !job->history ||
        !job->value || !job->error || !table->rgba)
        return tc_fail_memory(err, "the pre-integration table", entries, texel);
    return TC_OK;
}

tc_status tc_table_build(tc_table *out, const tc_transfer *tf, const tc_table_options *options, tc_error *err)
{
    memset(out, 0, sizeof *out);
    tc_status status = tc_table_check(tf, options, err);
    if (status != TC_OK)
        return status;
    const double start = tc_now_ms();
    const int threads = tc_threads(options->threads);
    memcpy(out->size, options->size, sizeof out->size);
    memcpy(out->span, options->span, sizeof out->span);
    out->length_max = options->length_max;
    out->format = options->format == TC_TABLE_AUTO ? TC_TABLE_16F : options->format;
    build job = {.options = options,
                 .table = out,
                 .n_front = (size_t)options->size[0],
                 .n_back = (size_t)options->size[1],
                 .n_level = 1,
                 .n_history = 1};
    for (; 2 * job.n_history + 1 < (size_t)options->size[2]; job.n_history *= 2)
        job.n_level++;
    status = allocate(&job, threads, err);
    double *x = status == TC_OK ? tc_alloc(job.n_front + job.n_back, sizeof *x) : NULL;
    if (status == TC_OK && !x)
        status = tc_fail_memory(err, "the pre-integration table", job.n_front + job.n_back, sizeof *x);
    if (status != TC_OK)
        goto done;
    const size_t n_node = tc_table_axes(x, job.node_front, job.node_back, job.front_node, options->size);
    status = tc_segments_build(&job.segments, tf, options->span, options->length_max / (options->size[2] - 1), x,
                               n_node, err);
    if (status != TC_OK)
        goto done;
    memset(out->rgba, 0, out->bytes / (size_t)options->size[2]); /* length 0 */
    if (options->entry_by_entry) {
        tc_parallel_for(job.n_back, 1, threads, separate_rows, &job);
    } else {
        tc_parallel_for(job.n_front, 4, threads, base_rows, &job);
        for (job.level_now = 1; job.level_now < job.n_level; job.level_now++)
            tc_parallel_for(job.n_front, 16, threads, level_rows, &job);
        tc_parallel_for(job.n_back, 4, threads, incremental_rows, &job);
    }
    for (int i = 0; i < threads; i++)
        out->base_error = fmax(out->base_error, job.error[i]);
    out->base_error += 0x1p-25; /* rounding to float */
done:
    free(x);
    tc_segments_finish(&job.segments);
    free(job.node_front);
    free(job.node_back);
    free(job.front_node);
    free(job.level);
    free(job.first);
    free(job.history);
    free(job.value);
    free(job.error);
    if (status != TC_OK)
        tc_table_finish(out);
    out->ms = status == TC_OK ? tc_now_ms() - start : 0;
    return status;
}

void tc_table_finish(tc_table *table)
{
    free(table->rgba);
    memset(table, 0, sizeof *table);
}
