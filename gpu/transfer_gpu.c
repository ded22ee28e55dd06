/* transfer_gpu.c: chooses an integrator and keeps its textures. */
#include "gpu/transfer_gpu.h"

#include "core/parallel.h"
#include "gpu/transfer_plan.h"
#include "transfer_functions/drift.h"
#include "transfer_functions/place.h"
#include "transfer_functions/thin.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double MAP_MOST = 1e30;                            /* x beyond is the same piece: pieces.glsl */
static const double THIN = 2.5e-4;                              /* of a function: an eighth of 1/510 */
static const double THIN_NUMBERS = 1e-8;                        /* … where floats tell nothing */
static const double HARD_ROUNDING = 2e-4, HARD_RELATIVE = 1e-3; /* of optical depth */
static const double NEAR_LEAST = 1.0 / 16384;                   /* smallest difference of x that cumulatives resolve */

static void bind_drift(tc_job *job, const tc_transfer_gpu *t)
{
    int octave = tc_drift_octave(t->size[2]);
    double longest = tc_drift_length(t->size[2] - 1, octave);
    job->octave[0] = longest / octave / t->length_max;
    job->octave[1] = octave / (double)t->size[2];
    job->octave[2] = job->texel[2][1];
    job->grid[0] = t->intervals;
    job->grid[1] = 1 / job->grid[0];
    memcpy(job->tf_most, t->most, sizeof job->tf_most);
}

static void bind(tc_job *job, const tc_transfer_gpu *t)
{
    job->integrator = t->integrator;
    double range = t->scalar[1] - t->scalar[0], width = t->span[1] - t->span[0];
    if (!isfinite(range) || !isfinite(width)) { /* halves only there: they lose the digits of denormal numbers */
        range = 0.5 * t->scalar[1] - 0.5 * t->scalar[0];
        width = 0.5 * t->span[1] - 0.5 * t->span[0];
    }
    job->map[0] = range / width;
    job->map[1] = tc_place(t->scalar[0], t->span[0], t->span[1]);
    if (!(job->map[0] <= MAP_MOST)) { /* a step to float, at the same scalar; the range holds the span */
        job->map[0] = MAP_MOST;
        job->map[1] = -MAP_MOST * tc_place(t->span[0], t->scalar[0], t->scalar[1]);
    }
    job->extend = t->integrator == TC_INTEGRATOR_INTEGRAL && range > 0 &&
                  (t->span[0] > t->scalar[0] || t->span[1] < t->scalar[1]);
    memcpy(job->mean, t->mean, sizeof job->mean);
    for (int k = 0; k < 3; k++) { /* entries sit at texel centres, the end ones on the ends */
        double n = t->size[k];
        job->texel[k][0] = n > 0 ? (n - 1) / n : 0;
        job->texel[k][1] = n > 0 ? 0.5 / n : 0;
    }
    if (t->integrator == TC_INTEGRATOR_TABLE)
        job->texel[2][0] /= t->length_max;
    job->grid[0] = t->size[0] - 1;
    job->grid[1] = 1 / job->grid[0];
    job->near = fmax(job->grid[1], NEAR_LEAST);
    job->drift = t->intervals > 0;
    if (job->drift)
        bind_drift(job, t);
    job->n_piece = t->n_piece;
    job->steps = t->steps;
}

static tc_status build_means(tc_transfer_gpu *t, const tc_transfer_gpu_request *request, const tc_gl *gl,
                             tc_render_stats *stats, tc_error *err)
{
    const tc_transfer *tf = request->transfer;
    tc_means means;
    t->intervals = tc_means_intervals(tf, t->span);
    tc_status status = tc_means_build(&means, tf, t->intervals, t->span, err);
    if (status != TC_OK)
        return status;
    stats->ms_table += means.ms;
    t->steps = means.n_step > 0;
    status = tc_gpu_means_upload(&t->textures, gl, &means, err);
    tc_means_finish(&means);
    memset(t->most, 0, sizeof t->most);
    for (size_t i = 0; i < tf->n; i++) {
        const double color[3] = {tf->knot[i].r, tf->knot[i].g, tf->knot[i].b};
        for (int c = 0; c < 3; c++)
            t->most[c] = fmax(t->most[c], color[c]);
    }
    return status;
}

static tc_status build_table(tc_transfer_gpu *t, const tc_transfer_gpu_request *request, const tc_gl *gl,
                             tc_render_stats *stats, tc_error *err)
{
    const tc_table_options options = {
        .size = {t->size[0], t->size[1], t->size[2]},
        .span = {t->span[0], t->span[1]},
        .length_max = t->length_max,
        .format = t->format,
        .threads = request->threads,
    };
    tc_table table;
    bool drift = t->format != TC_TABLE_8; /* in 8 bits it is the paper's */
    tc_status status = drift ? tc_drift_build(&table, request->transfer, &options, err)
                             : tc_table_build(&table, request->transfer, &options, err);
    if (status != TC_OK)
        return status;
    stats->ms_table = table.ms;
    status = tc_gpu_table_upload(&t->textures, gl, &table, err);
    tc_table_finish(&table);
    return status == TC_OK && drift ? build_means(t, request, gl, stats, err) : status;
}

/* What a sample of the integral of extinction may err by: a float as large as the largest, and what half an interval's
 * change of the function does, which a sample leaves out. */
static double rounding_of(const tc_running *running)
{
    double rounding = 0, interval = 1.0 / (running->n - 1);
    for (int i = 0; i < running->n; i++) {
        double size = fabs((double)running->cumulative[4 * i + 3]);
        double rise = i > 0 ? fabs((double)running->point[4 * i + 3] - (double)running->point[4 * i - 1]) : 0;
        rounding = fmax(rounding, 0x1p-23 * size);
        if (rise < 0.5 * TC_RUNNING_LEFT_OUT)
            rounding = fmax(rounding, 0.125 * rise * interval);
    }
    return rounding;
}

static tc_status build_running(tc_transfer_gpu *t, const tc_transfer_gpu_request *request, const tc_gl *gl,
                               tc_render_stats *stats, tc_error *err)
{
    tc_running running;
    tc_status status = tc_running_build(&running, request->transfer, t->size[0], t->span, t->hard > 0, err);
    if (status != TC_OK)
        return status;
    stats->ms_table = running.ms;
    memcpy(t->mean, running.mean, sizeof t->mean);
    t->rounding = rounding_of(&running);
    status = tc_gpu_running_upload(&t->textures, gl, &running, err);
    tc_running_finish(&running);
    return status;
}

static tc_status build_pieces(tc_transfer_gpu *t, const tc_transfer_gpu_request *request, const tc_gl *gl,
                              tc_render_stats *stats, tc_error *err)
{
    tc_pieces pieces;
    double start = tc_now_ms();
    tc_status status = tc_pieces_build(&pieces, request->pieces, t->span, err);
    if (status != TC_OK)
        return status;
    stats->ms_table = (stats->ms_table > 0 ? stats->ms_table : 0) + tc_now_ms() - start;
    t->n_piece = (int)pieces.n;
    t->steps = pieces.steps;
    status = tc_gpu_pieces_upload(&t->textures, gl, &pieces, err);
    tc_pieces_finish(&pieces);
    return status;
}

/* Where nobody asked for exact pieces, a cell should not pay for knots that no picture shows. */
static tc_status ensure_thin(tc_transfer_gpu *t, tc_transfer_gpu_request *request, tc_error *err)
{
    const tc_transfer *tf = request->transfer;
    request->pieces = tf;
    if (request->options->integrator == TC_INTEGRATOR_EXACT || request->options->integrator == TC_INTEGRATOR_TABLE)
        return TC_OK;
    if (t->thin_serial != tf->serial || t->thin_numbers != request->numbers) {
        tc_transfer_destroy(&t->thin);
        t->thin_serial = 0;
        tc_status status = tc_transfer_thin(&t->thin, tf, request->numbers ? THIN_NUMBERS : THIN, err);
        if (status != TC_OK)
            return status;
        t->thin_serial = tf->serial;
        t->thin_numbers = request->numbers;
    }
    request->pieces = t->thin;
    return TC_OK;
}

tc_status tc_transfer_gpu_ensure(tc_transfer_gpu *t, tc_job *job, const tc_transfer_gpu_request *asked, const tc_gl *gl,
                                 tc_render_stats *stats, tc_error *err)
{
    tc_transfer_gpu_request thinned = *asked;
    const tc_transfer_gpu_request *request = &thinned;
    const tc_render_options *options = request->options;
    tc_status status = ensure_thin(t, &thinned, err);
    if (status != TC_OK)
        return status;
    tc_transfer_plan plan;
    status = tc_transfer_plan_make(&plan, stats->integrator_why, sizeof stats->integrator_why, request, err);
    if (status != TC_OK)
        return status;
    tc_transfer_gpu wanted = {.serial = request->transfer->serial,
                              .integrator = plan.integrator,
                              .scalar = {request->scalar[0], request->scalar[1]},
                              .span = {plan.span[0], plan.span[1]},
                              .hard = plan.hard,
                              .thin = t->thin,
                              .thin_serial = t->thin_serial,
                              .thin_numbers = t->thin_numbers,
                              .thinned = request->pieces == t->thin,
                              .numbers = request->numbers};
    if (wanted.integrator == TC_INTEGRATOR_TABLE) {
        static const int paper_size[3] = {128, 128, 256};
        for (int k = 0; k < 3; k++)
            wanted.size[k] = options->table_size[k] > 0 ? options->table_size[k] : paper_size[k];
        wanted.format = options->table_format == TC_TABLE_AUTO ? TC_TABLE_16F : options->table_format;
        wanted.length_max = request->length_max > 0 ? request->length_max : 1;
    } else if (wanted.integrator == TC_INTEGRATOR_INTEGRAL) {
        wanted.size[0] = plan.nodes;
    }
    bool same = t->serial == wanted.serial && t->integrator == wanted.integrator && t->format == wanted.format &&
                memcmp(t->size, wanted.size, sizeof t->size) == 0 && t->hard == wanted.hard &&
                t->thinned == wanted.thinned && t->numbers == wanted.numbers && t->length_max == wanted.length_max &&
                memcmp(t->scalar, wanted.scalar, sizeof t->scalar) == 0;
    if (!same) {
        tc_gpu_transfer_finish(&t->textures, gl);
        *t = wanted;
        t->serial = 0;
        double start = tc_now_ms();
        status = wanted.integrator == TC_INTEGRATOR_TABLE   ? build_table(t, request, gl, stats, err)
                 : wanted.integrator == TC_INTEGRATOR_EXACT ? build_pieces(t, request, gl, stats, err)
                                                            : build_running(t, request, gl, stats, err);
        if (status == TC_OK && wanted.hard > 0)
            status = build_pieces(t, request, gl, stats, err);
        if (status != TC_OK)
            return status;
        t->serial = wanted.serial;
        double upload = tc_now_ms() - start - stats->ms_table;
        stats->ms_upload = (stats->ms_upload > 0 ? stats->ms_upload : 0) + upload;
    }
    job->order = plan.order;
    job->split = plan.split;
    job->hard = plan.hard;
    job->dense = plan.dense;
    job->twice = plan.twice;
    job->hard_depth = plan.hard_depth;
    job->hard_relative = HARD_RELATIVE / fmax(t->rounding, 1e-30);
    job->hard_slope = HARD_ROUNDING / fmax(t->rounding, 1e-30);
    bind(job, t);
    return status;
}

void tc_transfer_gpu_finish(tc_transfer_gpu *t, const tc_gl *gl)
{
    tc_gpu_transfer_finish(&t->textures, gl);
    tc_transfer_destroy(&t->thin);
    t->serial = t->thin_serial = 0;
}
