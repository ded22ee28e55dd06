/* transfer_gpu.c: chooses an integrator and keeps its textures. */
#include "gpu/transfer_gpu.h"

#include "core/parallel.h"
#include "transfer_functions/place.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PIECES_MOST = 50000 }; /* a segment that crosses them all is within the loop limit of software renderers */
enum { INTERVALS_LEAST = 8192, INTERVALS_MOST = 65536 }; /* powers of two: places of nodes are exact in float */
static const double INTERVALS_A_RISE = 64;               /* over which the function may go from none to all */
static const double UNSPLIT_ERROR = 1e-3;                /* running integrals are taken where a picture errs by less, */
static const double UNSPLIT_DEPTH = 100;                 /* no edge is optically deeper, */
static const double UNSPLIT_SHARE_WILD = 0.04;
static const double UNSPLIT_SHARE = 0.005;    /* as needs_pieces reckons */
static const double NEAR_LEAST = 1.0 / 16384; /* smallest difference of x that cumulatives resolve */
/* Running integrals are for spans that nodes can divide, for a function that is not far narrower than the data, and for
 * lengths whose squares are floats; the rest is integrated piece by piece. */
static const double WIDTH_LEAST = 1e-300;
static const double NARROW_MOST = 1e6;
static const double LENGTH_UNIT_MOST = 1e15;
static const double MAP_MOST = 1e30;       /* x beyond is the same piece: integrate_exact.glsl */
static const double WIDEN_CONSTANT = 1e-3; /* of the scalar: the span of data of one value */

/* The part of the data's range in which the function changes: beyond its end knots it is constant. */
static void find_span(double span[2], const tc_transfer_gpu_request *request)
{
    double knots[2];
    tc_transfer_span(knots, request->transfer);
    span[0] = fmax(knots[0], request->scalar[0]);
    span[1] = fmin(knots[1], request->scalar[1]);
    if (!(span[1] > span[0])) { /* constant over the data, or data without a range */
        span[0] = request->scalar[0];
        span[1] = request->scalar[1];
    }
    if (!(span[1] > span[0])) { /* data of one value: any width that a double tells apart from it */
        double widen = fmax(1, fabs(span[0]) * WIDEN_CONSTANT);
        span[1] = span[0] + widen;
        if (!isfinite(span[1])) {
            span[1] = span[0];
            span[0] -= widen;
        }
    }
}

/* Is the function over the span beyond what nodes a fixed share of it apart can hold? */
static bool is_beyond_nodes(const tc_transfer_gpu_request *request, const double span[2])
{
    double range = request->scalar[1] - request->scalar[0], width = span[1] - span[0];
    return !isfinite(range) || !isfinite(width) || width < WIDTH_LEAST || range > NARROW_MOST * width ||
           request->length_unit > LENGTH_UNIT_MOST;
}

/* Enough nodes to resolve the steepest rise; more than INTERVALS_MOST where no number is enough. */
static int choose_nodes(const tc_transfer *tf, const double span[2])
{
    double most = 0, steepest = 0;
    for (size_t i = 0; i < tf->n; i++)
        most = fmax(most, tf->knot[i].a);
    for (size_t i = 1; i < tf->n; i++) {
        const tc_knot *p = &tf->knot[i - 1], *q = p + 1;
        double change = fmax(fabs(q->r - p->r), fmax(fabs(q->g - p->g), fabs(q->b - p->b)));
        if (most > 0)
            change = fmax(change, fabs(q->a - p->a) / most);
        if (change > 0 && q->s > span[0] && p->s < span[1])
            steepest = fmax(steepest, change * (span[1] - span[0]) / (q->s - p->s));
    }
    int n = INTERVALS_LEAST;
    while (n < INTERVALS_MOST && n < INTERVALS_A_RISE * steepest)
        n *= 2;
    return n + 1;
}

/* The optical depth of the longest edge at the function's largest extinction: running integrals round to 1e-7 of it. */
static double deepest(const tc_transfer_gpu_request *request)
{
    double most = 0, edge = 0;
    for (size_t i = 0; i < request->transfer->n; i++)
        most = fmax(most, request->transfer->knot[i].a);
    for (int b = 0; b < TC_PACK_BINS; b++)
        edge = fmax(edge, request->extent->edge[b]);
    return most * edge * request->length_unit;
}

/* Might a segment left whole err by more than UNSPLIT_ERROR? Its colour is taken to drift linearly in optical depth t
 * (integrate_integral.glsl). Over 12 pairs of mesh and function the largest picture error, against the reference, was
 * at the most 0.0046 t min(1, t) times the change of colour, mostly a tenth of it. Where the colour comes and goes
 * within a cell that does not hold; t^2/24 is a step's share, and UNSPLIT_SHARE_WILD about that. */
static bool needs_pieces(const tc_transfer_gpu_request *request)
{
    const tc_transfer *tf = request->transfer;
    double range = request->scalar[1] - request->scalar[0];
    if (deepest(request) > UNSPLIT_DEPTH)
        return true;
    for (int b = 0; b < TC_PACK_BINS; b++) {
        double lo = request->scalar[0] + range * b / TC_PACK_BINS,
               hi = request->scalar[0] + range * (b + 1) / TC_PACK_BINS;
        double edge = request->extent->edge[b] * request->length_unit;
        double edge_range = request->extent->edge_range[b] * request->length_unit * range;
        if (!(edge > 0))
            continue;
        double ends[2][4], a, slope = 0;
        tc_transfer_evaluate(ends[0], tf, lo);
        tc_transfer_evaluate(ends[1], tf, hi);
        a = fmax(ends[0][3], ends[1][3]);
        for (size_t i = 0; i + 1 < tf->n; i++) {
            const tc_knot *p = &tf->knot[i], *q = p + 1;
            if (q->s < lo || p->s > hi || q->s <= request->scalar[0] || p->s >= request->scalar[1])
                continue; /* elsewhere, or beyond the data */
            double change = fmax(fabs(q->r - p->r), fmax(fabs(q->g - p->g), fabs(q->b - p->b)));
            slope = fmax(slope, change > 0 ? change / (q->s - p->s) : 0); /* infinite at a step */
            if (p->s >= lo)
                a = fmax(a, p->a);
            if (q->s <= hi)
                a = fmax(a, q->a);
        }
        /* Where the colour comes and goes within a cell, its change says little: the share is that of a step. */
        bool wild = slope * edge_range > edge;
        double colored_edge = wild ? edge : slope > 0 ? slope * edge_range : 0;
        double share = wild ? UNSPLIT_SHARE_WILD : UNSPLIT_SHARE;
        if (share * a * colored_edge * fmin(1, a * edge) > UNSPLIT_ERROR)
            return true;
    }
    return false;
}

/* INTEGRAL or EXACT for what was asked for, and why. */
static tc_status choose(tc_transfer_gpu *wanted, const tc_transfer_gpu_request *request, tc_render_stats *stats,
                        tc_error *err)
{
    const tc_render_options *options = request->options;
    bool few = request->transfer->n <= PIECES_MOST;
    const char *why = NULL;
    if (options->integrator == TC_INTEGRATOR_EXACT && !few)
        return tc_fail(
            err, TC_E_ARG,
            "the transfer function has %zu knots, more than the %d that can be integrated one by one; use the "
            "integrator 'integral' or fewer knots",
            request->transfer->n, PIECES_MOST);
    if (options->integrator == TC_INTEGRATOR_EXACT)
        return TC_OK;
    wanted->integrator = TC_INTEGRATOR_INTEGRAL;
    bool as_it_is = options->integral_order > 0 || options->integral_split > 0;
    if (!(request->scalar[1] > request->scalar[0])) /* it may lie on a step, where nodes hold the mean of both sides */
        why = "the data have one value";
    else if (is_beyond_nodes(request, wanted->span))
        why = "ranges are too wide or too narrow for nodes";
    else if (!as_it_is && wanted->size[0] > INTERVALS_MOST)
        why = "the function has steps or rises that nodes cannot resolve";
    else if (!as_it_is && needs_pieces(request))
        why = "cells are so dense that their colour would err by more than 0.001 if integrated whole";
    if (why && few)
        wanted->integrator = TC_INTEGRATOR_EXACT;
    if (wanted->integrator == TC_INTEGRATOR_EXACT)
        snprintf(stats->integrator_why, sizeof stats->integrator_why, "exact, piece by piece of the function: %s", why);
    else
        snprintf(stats->integrator_why, sizeof stats->integrator_why,
                 "running integrals: a fifth of the error of a 128x128x256 table of half floats, a hundredth of one of "
                 "8 bits, and faster on llvmpipe");
    return TC_OK;
}

static void bind(tc_job *job, const tc_transfer_gpu *t, const tc_render_options *options)
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
    job->order = options->integral_order == 1 ? 1 : 2;
    job->split = isfinite(options->integral_split) ? options->integral_split : 0;
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
    job->float_table = t->integrator == TC_INTEGRATOR_TABLE && t->format != TC_TABLE_8;
    job->n_piece = t->size[0];
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
    tc_status status = tc_table_build(&table, request->transfer, &options, err);
    if (status != TC_OK)
        return status;
    stats->ms_table = table.ms;
    status = tc_gpu_table_upload(&t->textures, gl, &table, err);
    tc_table_finish(&table);
    return status;
}

static tc_status build_running(tc_transfer_gpu *t, const tc_transfer_gpu_request *request, const tc_gl *gl,
                               tc_render_stats *stats, tc_error *err)
{
    tc_running running;
    tc_status status = tc_running_build(&running, request->transfer, t->size[0], t->span, err);
    if (status != TC_OK)
        return status;
    stats->ms_table = running.ms;
    memcpy(t->mean, running.mean, sizeof t->mean);
    status = tc_gpu_running_upload(&t->textures, gl, &running, err);
    tc_running_finish(&running);
    return status;
}

static tc_status build_pieces(tc_transfer_gpu *t, const tc_transfer_gpu_request *request, const tc_gl *gl,
                              tc_render_stats *stats, tc_error *err)
{
    tc_pieces pieces;
    double start = tc_now_ms();
    tc_status status = tc_pieces_build(&pieces, request->transfer, t->span, err);
    if (status != TC_OK)
        return status;
    stats->ms_table = tc_now_ms() - start;
    t->size[0] = (int)pieces.n;
    status = tc_gpu_pieces_upload(&t->textures, gl, &pieces, err);
    tc_pieces_finish(&pieces);
    return status;
}

tc_status tc_transfer_gpu_ensure(tc_transfer_gpu *t, tc_job *job, const tc_transfer_gpu_request *request,
                                 const tc_gl *gl, tc_render_stats *stats, tc_error *err)
{
    const tc_render_options *options = request->options;
    tc_transfer_gpu wanted = {.serial = request->transfer->serial,
                              .integrator = options->integrator,
                              .scalar = {request->scalar[0], request->scalar[1]}};
    find_span(wanted.span, request);
    if (wanted.integrator == TC_INTEGRATOR_TABLE && request->scalar[1] > request->scalar[0])
        memcpy(wanted.span, request->scalar, sizeof wanted.span); /* a table knows nothing outside */
    if (wanted.integrator == TC_INTEGRATOR_TABLE) {
        static const int paper_size[3] = {128, 128, 256};
        for (int k = 0; k < 3; k++)
            wanted.size[k] = options->table_size[k] > 0 ? options->table_size[k] : paper_size[k];
        wanted.format = options->table_format == TC_TABLE_AUTO ? TC_TABLE_16F : options->table_format;
        wanted.length_max = request->length_max > 0 ? request->length_max : 1;
    } else {
        wanted.size[0] = choose_nodes(request->transfer, wanted.span);
        tc_status status = choose(&wanted, request, stats, err);
        if (status != TC_OK)
            return status;
    }
    bool same = t->serial == wanted.serial && t->integrator == wanted.integrator && t->format == wanted.format &&
                (wanted.integrator == TC_INTEGRATOR_EXACT || memcmp(t->size, wanted.size, sizeof t->size) == 0) &&
                t->length_max == wanted.length_max && memcmp(t->scalar, wanted.scalar, sizeof t->scalar) == 0;
    tc_status status = TC_OK;
    if (!same) {
        tc_transfer_gpu_finish(t, gl);
        *t = wanted;
        t->serial = 0;
        double start = tc_now_ms();
        status = wanted.integrator == TC_INTEGRATOR_TABLE   ? build_table(t, request, gl, stats, err)
                 : wanted.integrator == TC_INTEGRATOR_EXACT ? build_pieces(t, request, gl, stats, err)
                                                            : build_running(t, request, gl, stats, err);
        if (status != TC_OK)
            return status;
        t->serial = wanted.serial;
        double upload = tc_now_ms() - start - stats->ms_table;
        stats->ms_upload = (stats->ms_upload > 0 ? stats->ms_upload : 0) + upload;
    }
    bind(job, t, options);
    return status;
}

void tc_transfer_gpu_finish(tc_transfer_gpu *t, const tc_gl *gl)
{
    tc_gpu_transfer_finish(&t->textures, gl);
    t->serial = 0;
}
