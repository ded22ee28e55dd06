/* table.c: the three-dimensional pre-integrated table, built incrementally.
 * Weiler et al. 2003, section 4: the slice of length dl is integrated numerically (segment.h), each further one is put
 * together from it and the slice before it by equations 5 and 6, with linear interpolation at the split point
 *   s_p = s_f + (s_b - s_f) / k,  k = l / dl.
 * The rear part has the same s_b, so each s_b is a recursion of its own. In units of the s_front spacing the split
 * point lies (s_b - s_f) / k beyond s_f: floor of that is constant over runs of up to k consecutive s_f. With the base
 * slice stored by diagonals, all reads of a run are contiguous and the loop over it needs no gather. */
#include "transfer_functions/table.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "transfer_functions/segment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct build {
    const tc_table_options *options;
    tc_table *table;
    tc_segments segments;
    size_t n_front, n_back;
    int *node_front, *node_back; /* [n_node] entry along s_front, s_back at a node, or -1 */
    size_t *front_node;          /* [n_front] */
    size_t stride;               /* floats between channels: n_front and a margin that is read with weight 0 */
    float *diagonal;             /* [2 n_front + 1][4][stride]: base slice at (f, f + d - n_front) */
    float *first;                /* [n_back][4][stride]: base slice at the table's own s_back */
    float *rows;                 /* [threads][2][4][stride] */
    double (*value)[4];          /* [threads][n_node] */
    double *error;               /* [threads] */
} build;

/* --------------------------------------------------------------------------------------------------- out of floats */

/* Nearest IEEE half of v in [0, 65504]. Below the normal halves, adding 0.5 rounds to their spacing. */
static inline uint32_t half_of(float v)
{
    const float small = v + 0.5f;
    uint32_t bits, small_bits;
    memcpy(&bits, &v, sizeof bits);
    memcpy(&small_bits, &small, sizeof small_bits);
    const uint32_t normal = (bits - (UINT32_C(112) << 23) + 0xfff + ((bits >> 13) & 1)) >> 13;
    const uint32_t tiny = small_bits - (UINT32_C(126) << 23);
    return bits < (UINT32_C(113) << 23) ? tiny : normal;
}

static void store_8(uint8_t *restrict out, const float *restrict row, size_t stride, size_t n)
{
    const float *r = row, *g = row + stride, *b = row + 2 * stride, *a = row + 3 * stride;
    for (size_t i = 0; i < n; i++) {
        out[4 * i + 0] = (uint8_t)(int)(r[i] * 255.0f + 0.5f);
        out[4 * i + 1] = (uint8_t)(int)(g[i] * 255.0f + 0.5f);
        out[4 * i + 2] = (uint8_t)(int)(b[i] * 255.0f + 0.5f);
        out[4 * i + 3] = (uint8_t)(int)(a[i] * 255.0f + 0.5f);
    }
}

static void store_16(uint16_t *restrict out, const float *restrict row, size_t stride, size_t n)
{
    const float *r = row, *g = row + stride, *b = row + 2 * stride, *a = row + 3 * stride;
    for (size_t i = 0; i < n; i++) {
        out[4 * i + 0] = (uint16_t)half_of(r[i]);
        out[4 * i + 1] = (uint16_t)half_of(g[i]);
        out[4 * i + 2] = (uint16_t)half_of(b[i]);
        out[4 * i + 3] = (uint16_t)half_of(a[i]);
    }
}

static void store_32(float *restrict out, const float *restrict row, size_t stride, size_t n)
{
    const float *r = row, *g = row + stride, *b = row + 2 * stride, *a = row + 3 * stride;
    for (size_t i = 0; i < n; i++) {
        out[4 * i + 0] = r[i];
        out[4 * i + 1] = g[i];
        out[4 * i + 2] = b[i];
        out[4 * i + 3] = a[i];
    }
}

static void store_row(const build *job, size_t slice, size_t back, const float *row)
{
    const size_t at = 4 * job->n_front * (back + job->n_back * slice);
    switch (job->table->format) {
    case TC_TABLE_8:
        store_8((uint8_t *)job->table->rgba + at, row, job->stride, job->n_front);
        break;
    case TC_TABLE_16F:
        store_16((uint16_t *)job->table->rgba + at, row, job->stride, job->n_front);
        break;
    default:
        store_32((float *)job->table->rgba + at, row, job->stride, job->n_front);
        break;
    }
}

/* ------------------------------------------------------------------------------------------------------- recursion */

/* s_back of a row in units of the s_front spacing. */
static double back_place(const build *job, size_t back)
{
    return (double)back * (double)(job->n_front - 1) / (double)(job->n_back - 1);
}

/* Equations 5 and 6 over `count` entries whose split points lie between the diagonals front0 and front1.
 *   before, base   slice k - 1 and the base slice at the entries themselves */
static void blend_run(float *restrict out, const float *restrict rear, const float *restrict front0,
                      const float *restrict front1, const float *restrict before, const float *restrict base,
                      size_t stride, int count, float weight, float step)
{
    const size_t g = stride, b = 2 * stride, a = 3 * stride;
    for (int j = 0; j < count; j++) {
        const float place = weight - step * (float)j, t = place > 0 ? place : 0;
        const float front_r = front0[j] + t * (front1[j] - front0[j]);
        const float front_g = front0[g + j] + t * (front1[g + j] - front0[g + j]);
        const float front_b = front0[b + j] + t * (front1[b + j] - front0[b + j]);
        const float front_a = front0[a + j] + t * (front1[a + j] - front0[a + j]);
        const float rear_a = rear[a + j] + t * (rear[a + j + 1] - rear[a + j]);
        const float pass = 1 - front_a, blended = front_a + pass * rear_a;
        const float opacity = before[a + j] + (1 - before[a + j]) * base[a + j];
        const float scale = opacity / (blended + 1e-37f);
        out[j] = scale * (front_r + pass * (rear[j] + t * (rear[j + 1] - rear[j])));
        out[g + j] = scale * (front_g + pass * (rear[g + j] + t * (rear[g + j + 1] - rear[g + j])));
        out[b + j] = scale * (front_b + pass * (rear[b + j] + t * (rear[b + j + 1] - rear[b + j])));
        out[a + j] = opacity;
    }
}

/* Row of slice k from the same row of slice k - 1; base: that of slice 1. */
static void blend_row(float *restrict out, const float *rear, const float *base, const build *job, size_t row, int k)
{
    const int n = (int)job->n_front;
    const double back = back_place(job, row);
    int offset = (int)floor(back / k);
    for (int front = 0; front < n; offset--) {
        const double last = floor(back - (double)offset * k);
        const int end = last >= n - 1 ? n : (int)last + 1;
        if (end <= front)
            continue;
        const float *front0 = job->diagonal + 4 * job->stride * (size_t)(n + offset) + front;
        blend_run(out + front, rear + front + offset, front0, front0 + 4 * job->stride, rear + front, base + front,
                  job->stride, end - front, (float)((back - front - (double)offset * k) / k), (float)(1.0 / k));
        front = end;
    }
    for (int c = 0; c < 4; c++)
        out[(size_t)c * job->stride + job->n_front] = out[(size_t)c * job->stride + job->n_front - 1];
}

static void incremental_rows(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    const size_t floats = 4 * job->stride;
    for (size_t back = begin; back < end; back++) {
        float *even = job->rows + 2 * floats * (size_t)worker, *odd = even + floats;
        const float *base = job->first + floats * back, *rear = base;
        store_row(job, 1, back, base);
        for (int k = 2; k < job->options->size[2]; k++) {
            float *out = k % 2 ? odd : even;
            blend_row(out, rear, base, job, back, k);
            store_row(job, (size_t)k, back, out);
            rear = out;
        }
    }
}

/* The slow way: k segments of length dl for an entry of slice k, each integrated as those of the base slice. */
static void separate_rows(void *context, size_t begin, size_t end, int worker)
{
    const build *job = context;
    float *row = job->rows + 2 * 4 * job->stride * (size_t)worker;
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
                for (int c = 0; c < 4; c++)
                    row[(size_t)c * job->stride + front] = (float)sum[c];
            }
            store_row(job, (size_t)k, back, row);
        }
}

/* ------------------------------------------------------------------------------------------------------ base slice */

static void base_rows(void *context, size_t begin, size_t end, int worker)
{
    build *job = context;
    const size_t n_node = job->segments.n_node, floats = 4 * job->stride;
    double(*value)[4] = job->value + n_node * (size_t)worker;
    for (size_t front = begin; front < end; front++) {
        tc_segments_row(value, &job->error[worker], &job->segments, job->front_node[front]);
        for (size_t i = 0; i < n_node; i++)
            for (size_t c = 0; c < 4; c++) {
                const float v = (float)value[i][c];
                if (job->node_front[i] >= 0)
                    job->diagonal[floats * (job->n_front + (size_t)job->node_front[i] - front) + c * job->stride +
                                  front] = v;
                if (job->node_back[i] >= 0)
                    job->first[floats * (size_t)job->node_back[i] + c * job->stride + front] = v;
            }
    }
}

/* The places of both axes in one ascending list, each once. */
static size_t merge_axes(double *x, build *job)
{
    size_t n = 0, front = 0, back = 0;
    const size_t last_front = job->n_front - 1, last_back = job->n_back - 1;
    while (front <= last_front || back <= last_back) {
        const uint64_t a = (uint64_t)front * last_back, b = (uint64_t)back * last_front; /* front/last, back/last */
        const bool take_front = front <= last_front && (back > last_back || a <= b);
        const bool take_back = back <= last_back && (front > last_front || b <= a);
        x[n] = take_front ? (double)front / (double)last_front : (double)back / (double)last_back;
        job->node_front[n] = take_front ? (int)front : -1;
        job->node_back[n] = take_back ? (int)back : -1;
        if (take_front)
            job->front_node[front++] = n;
        back += take_back;
        n++;
    }
    return n;
}

/* ------------------------------------------------------------------------------------------------------- the whole */

static tc_status check(const tc_transfer *tf, const tc_table_options *options, tc_error *err)
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
    const size_t nodes = job->n_front + job->n_back, floats = 4 * job->stride;
    tc_table *table = job->table;
    const size_t texel = table->format == TC_TABLE_8 ? 4 : table->format == TC_TABLE_16F ? 8 : 16;
    const size_t entries = job->n_front * job->n_back * (size_t)table->size[2]; /* at most 2^42 */
    job->node_front = tc_alloc(nodes, sizeof *job->node_front);
    job->node_back = tc_alloc(nodes, sizeof *job->node_back);
    job->front_node = tc_alloc(job->n_front, sizeof *job->front_node);
    job->diagonal = tc_calloc(2 * job->n_front + 1, floats * sizeof *job->diagonal);
    job->first = tc_calloc(job->n_back, floats * sizeof *job->first);
    job->rows = tc_calloc((size_t)threads, 2 * floats * sizeof *job->rows);
    job->value = tc_alloc((size_t)threads, nodes * sizeof *job->value);
    job->error = tc_calloc((size_t)threads, sizeof *job->error);
    table->rgba = tc_alloc(entries, texel);
    table->bytes = entries * texel;
    if (!job->node_front || !job->node_back || !job->front_node || !job->diagonal || !job->first || !job->rows ||
        !job->value || !job->error || !table->rgba)
        return tc_fail_memory(err, "the pre-integration table", entries, texel);
    return TC_OK;
}

tc_status tc_table_build(tc_table *out, const tc_transfer *tf, const tc_table_options *options, tc_error *err)
{
    memset(out, 0, sizeof *out);
    tc_status status = check(tf, options, err);
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
                 .stride = ((size_t)options->size[0] + 1 + 7) / 8 * 8};
    status = allocate(&job, threads, err);
    double *x = status == TC_OK ? tc_alloc(job.n_front + job.n_back, sizeof *x) : NULL;
    if (status == TC_OK && !x)
        status = tc_fail_memory(err, "the pre-integration table", job.n_front + job.n_back, sizeof *x);
    if (status != TC_OK)
        goto done;
    const size_t n_node = merge_axes(x, &job);
    status = tc_segments_build(&job.segments, tf, options->span, options->length_max / (options->size[2] - 1), x,
                               n_node, err);
    if (status != TC_OK)
        goto done;
    memset(out->rgba, 0, out->bytes / (size_t)options->size[2]); /* length 0 */
    if (options->entry_by_entry) {
        tc_parallel_for(job.n_back, 1, threads, separate_rows, &job);
    } else {
        tc_parallel_for(job.n_front, 4, threads, base_rows, &job);
        for (size_t i = 0; i < job.n_back; i++) /* the margin beyond the last s_front */
            for (size_t c = 0; c < 4; c++) {
                float *row = job.first + 4 * job.stride * i + c * job.stride;
                row[job.n_front] = row[job.n_front - 1];
            }
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
    free(job.diagonal);
    free(job.first);
    free(job.rows);
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
