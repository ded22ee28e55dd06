/* table_frame.c: what every build of a table over front scalar, back scalar and length rests on. */
#include "transfer_functions/table_frame.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "transfer_functions/half.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------- begin and end */

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

static tc_status allocate(tc_table_frame *frame, tc_error *err)
{
    tc_table *table = frame->table;
    const size_t nodes = frame->n_front + frame->n_back;
    const size_t texel = table->format == TC_TABLE_8 ? 4 : table->format == TC_TABLE_16F ? 8 : 16;
    const size_t entries = frame->n_front * frame->n_back * frame->n_length; /* at most 2^42 */
    frame->x = tc_alloc(nodes, sizeof *frame->x);
    frame->node_front = tc_alloc(nodes, sizeof *frame->node_front);
    frame->node_back = tc_alloc(nodes, sizeof *frame->node_back);
    frame->front_node = tc_alloc(frame->n_front, sizeof *frame->front_node);
    table->rgba = tc_alloc(entries, texel);
    table->bytes = entries * texel;
    if (!frame->x || !frame->node_front || !frame->node_back || !frame->front_node || !table->rgba)
        return tc_fail_memory(err, "the pre-integration table", entries, texel);
    return TC_OK;
}

static void fill_nodes(tc_table_frame *frame)
{
    size_t n = 0, front = 0, back = 0;
    const size_t last_front = frame->n_front - 1, last_back = frame->n_back - 1;
    while (front <= last_front || back <= last_back) {
        const uint64_t a = (uint64_t)front * last_back, b = (uint64_t)back * last_front; /* front/last, back/last */
        const bool take_front = front <= last_front && (back > last_back || a <= b);
        const bool take_back = back <= last_back && (front > last_front || b <= a);
        frame->x[n] = take_front ? (double)front / (double)last_front : (double)back / (double)last_back;
        frame->node_front[n] = take_front ? (int)front : -1;
        frame->node_back[n] = take_back ? (int)back : -1;
        if (take_front)
            frame->front_node[front++] = n;
        back += take_back;
        n++;
    }
    frame->n_node = n;
}

tc_status tc_table_frame_begin(tc_table_frame *frame, tc_table *out, const tc_transfer *tf,
                               const tc_table_options *options, tc_error *err)
{
    memset(out, 0, sizeof *out);
    *frame = (tc_table_frame){.options = options, .table = out};
    tc_status status = check(tf, options, err);
    if (status != TC_OK)
        return status;
    frame->start = tc_now_ms();
    frame->threads = tc_threads(options->threads);
    frame->n_front = (size_t)options->size[0];
    frame->n_back = (size_t)options->size[1];
    frame->n_length = (size_t)options->size[2];
    memcpy(out->size, options->size, sizeof out->size);
    memcpy(out->span, options->span, sizeof out->span);
    out->length_max = options->length_max;
    out->format = options->format == TC_TABLE_AUTO ? TC_TABLE_16F : options->format;
    status = allocate(frame, err);
    if (status != TC_OK)
        return status;
    fill_nodes(frame);
    memset(out->rgba, 0, out->bytes / frame->n_length); /* length 0 */
    return TC_OK;
}

tc_status tc_table_frame_end(tc_table_frame *frame, tc_status status)
{
    tc_segments_finish(&frame->segments);
    free(frame->x);
    free(frame->node_front);
    free(frame->node_back);
    free(frame->front_node);
    if (status == TC_OK)
        frame->table->ms = tc_now_ms() - frame->start;
    else
        tc_table_finish(frame->table);
    memset(frame, 0, sizeof *frame);
    return status;
}

/* ------------------------------------------------------------------------------------------------- out of floats */

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

void tc_table_frame_store(const tc_table_frame *frame, size_t slice, size_t back, const tc_quad *row)
{
    const size_t n = 4 * frame->n_front, at = n * (back + frame->n_back * slice);
    const float *value = (const float *)row;
    switch (frame->table->format) {
    case TC_TABLE_8:
        store_8((uint8_t *)frame->table->rgba + at, value, n);
        break;
    case TC_TABLE_16F:
        store_16((uint16_t *)frame->table->rgba + at, value, n);
        break;
    default:
        memcpy((float *)frame->table->rgba + at, value, n * sizeof *value);
        break;
    }
}

/* ------------------------------------------------------------------------------------------------ entry by entry */

void tc_table_frame_march(double out[4], const tc_table_frame *frame, const double x[2], int n, double part,
                          size_t *hint)
{
    double pass = 1;
    memset(out, 0, 4 * sizeof *out);
    for (int i = 0; i < n; i++) {
        double one[4];
        tc_segments_short(one, &frame->segments, x[0] + (x[1] - x[0]) * i / n, x[0] + (x[1] - x[0]) * (i + 1) / n, part,
                          hint);
        for (int c = 0; c < 4; c++)
            out[c] += pass * one[c];
        pass *= 1 - one[3];
    }
}
