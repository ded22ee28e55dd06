/* transfer_plan.c: chooses between running integrals and linear pieces of the function, and how many nodes. */
#include "gpu/transfer_plan.h"

#include "transfer_functions/running.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PIECES_MOST = 50000 }; /* a segment that crosses them all is within the loop limit of software renderers */
enum { INTERVALS_LEAST = 8192, INTERVALS_MOST = 65536 }; /* powers of two: places of nodes are exact in float */
static const double STEEP_SHARE = 0.02;                  /* of nodes that may leave segments to pieces */
/* A segment is left to pieces where its drift adds more colour, or it is optically deeper: of what cells hide of a
 * function between their ends no sample tells. With only this, over five meshes, four functions and eight views, the
 * largest error was 1.4e-3; with a depth of 0.8, in two of these views, it was 2e-3, at 5 % less time. */
static const double HARD_DRIFT = 5e-4, HARD_DEPTH = 0.5, HARD_DEPTH_WILD = 0.1;
static const double MORE_VARIED = 20; /* of the shares */
static const double VARIED = 3;       /* a colour that goes up and down more often than maps do hides more in a cell */
static const double UNSPLIT_ERROR = 1e-3;                               /* a picture would err by more */
static const double UNSPLIT_SHARE_WILD = 0.01, UNSPLIT_SHARE = 0.00125; /* as drifts() reckons */
static const double DENSE_DEPTH = 0.99; /* of an edge, at the largest extinction: within 1 pieces.glsl cuts no piece */
/* Knots crossed by a segment up to which pieces are not slower than running integrals: where these leave nearly every
 * segment to pieces (VARIED), some (HARD), or none (FEW). */
static const double CROSSED_VARIED = 1, CROSSED_HARD = 0.5, CROSSED_FEW = 0.02;
/* … above which a second round of pieces for each step costs less than the steps that wait for it. At 0.4 and 0.5 it
 * is even, at 1.1 and 1.3 it saves 2 to 9 % of the cycles, at 0.2 and below it costs 8 to 30 %. */
static const double CROSSED_TWICE = 0.5;
/* Of a cell's range, by a segment: most lie askew, or cut a corner. 0.06 to 0.18 on five meshes. */
static const double CROSSED_PART = 0.15;
static const double BIN_MARGIN = 1e-3; /* of a bin */
static const double DEPTH_MOST = 1000; /* of an edge: running integrals round to 1e-7 of their whole */
/* Running integrals are for spans that nodes can divide, for a function that is not far narrower than the data, and for
 * lengths whose squares are floats; the rest is integrated piece by piece. */
static const double WIDTH_LEAST = 1e-300;
static const double NARROW_MOST = 1e6;
static const double LENGTH_UNIT_MOST = 1e15;
static const double STEP_MARGIN = 1.0 / 16; /* of the knots' span */
static const double WIDEN_CONSTANT = 1e-3;  /* of the scalar: the span of data of one value */

/* The part of the data's range in which the function changes: beyond its end knots it is constant. */
static void find_span(double span[2], const tc_transfer_gpu_request *request)
{
    const tc_transfer *tf = request->transfer;
    double knots[2];
    tc_transfer_span(knots, tf);
    /* A step at an end: beyond it the function is another constant. */
    double margin = STEP_MARGIN * (knots[1] - knots[0]);
    if (tf->n > 1 && tf->knot[1].s == knots[0])
        knots[0] -= margin;
    if (tf->n > 1 && tf->knot[tf->n - 2].s == knots[1])
        knots[1] += margin;
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

/* Intervals between nodes: enough that at most this share of the nodes lies beside rises too steep for them; as many as
 * there may be where no number is enough. */
static int choose_intervals(const tc_transfer *tf, const double span[2], double share)
{
    int n = INTERVALS_LEAST;
    while (n < INTERVALS_MOST && tc_running_steep(tf, n + 1, span) > share)
        n *= 2;
    return n;
}

/* The optical depth of the longest edge at the function's largest extinction, among the scalars that its cell holds:
 * running integrals round to 1e-7 of it. Bins are taken a little wider, as scalars are floats. */
static double deepest(const tc_transfer_gpu_request *request)
{
    const tc_transfer *tf = request->transfer;
    double range = request->scalar[1] - request->scalar[0], most = 0;
    if (!isfinite(range))
        return INFINITY;
    for (int b = 0; b < TC_PACK_BINS; b++) {
        double edge = request->extent->edge[b] * request->length_unit;
        double lo = request->scalar[0] + range * (b - BIN_MARGIN) / TC_PACK_BINS, ends[2][4];
        double hi = request->scalar[0] + range * (b + 1 + BIN_MARGIN) / TC_PACK_BINS;
        if (!(edge > 0))
            continue;
        tc_transfer_evaluate(ends[0], tf, lo);
        tc_transfer_evaluate(ends[1], tf, hi);
        double a = fmax(ends[0][3], ends[1][3]);
        for (size_t i = 0; i < tf->n; i++)
            if (tf->knot[i].s >= lo && tf->knot[i].s <= hi)
                a = fmax(a, tf->knot[i].a);
        most = fmax(most, a * edge);
    }
    return most;
}

/* How far the colour goes up and down over the span: of the channel that does so most. */
static double color_variation(const tc_transfer *tf, const double span[2])
{
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i + 1 < tf->n; i++) {
        const tc_knot *p = &tf->knot[i], *q = p + 1;
        if (q->s < span[0] || p->s > span[1])
            continue;
        sum[0] += fabs(q->r - p->r);
        sum[1] += fabs(q->g - p->g);
        sum[2] += fabs(q->b - p->b);
    }
    return fmax(sum[0], fmax(sum[1], sum[2]));
}

/* How many knots a segment crosses, in the mean. */
static double crossed_knots(const tc_transfer_gpu_request *request)
{
    const tc_transfer *tf = request->pieces;
    double range = request->scalar[1] - request->scalar[0], sum = 0;
    for (size_t i = 0; i < tf->n; i++) {
        double x = (tf->knot[i].s - request->scalar[0]) / range;
        bool step = i > 0 && tf->knot[i].s == tf->knot[i - 1].s; /* both sides are one place */
        if (x > 0 && x < 1 && !step)
            sum += request->extent->held[(int)(x * TC_PACK_BINS)];
    }
    return CROSSED_PART * sum;
}

/* Might running integrals of whole segments err by more than UNSPLIT_ERROR? Their colour is taken to drift linearly in
 * optical depth t (integrate_integral.glsl). The estimate is a share of t min(1, t) times the change of colour, which
 * over 20 pairs of mesh and function was 0.3 to 10 times the largest error of a picture; where the colour comes and
 * goes within a cell, its change says little, and the share is eight times as large (values drawn at random, 50 times
 * as far apart as the function is wide, erred by 4e-3). */
static bool drifts(const tc_transfer_gpu_request *request, bool varied)
{
    const tc_transfer *tf = request->transfer;
    double range = request->scalar[1] - request->scalar[0];
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
        bool wild = slope * edge_range > edge;
        double colored_edge = wild ? edge : slope > 0 ? slope * edge_range : 0;
        double share = (wild ? UNSPLIT_SHARE_WILD : UNSPLIT_SHARE) * (varied ? MORE_VARIED : 1);
        if (share * a * colored_edge * fmin(1, a * edge) > UNSPLIT_ERROR)
            return true;
    }
    return false;
}

tc_status tc_transfer_plan_make(tc_transfer_plan *out, char *why, size_t capacity,
                                const tc_transfer_gpu_request *request, tc_error *err)
{
    const tc_render_options *options = request->options;
    const tc_transfer *tf = request->transfer;
    bool range = request->scalar[1] > request->scalar[0], few = tf->n <= PIECES_MOST;
    bool exact = options->integrator == TC_INTEGRATOR_EXACT || request->pieces_only;
    bool as_it_is = options->integral_order > 0 || options->integral_split > 0;
    const char *reason = NULL;
    *out = (tc_transfer_plan){.integrator = exact ? TC_INTEGRATOR_EXACT : options->integrator,
                              .order = options->integral_order == 1 ? 1 : 2};
    find_span(out->span, request);
    if (!exact && options->integrator == TC_INTEGRATOR_TABLE &&
        (range || options->table_format == TC_TABLE_8 || !few)) {
        if (range)
            memcpy(out->span, request->scalar, sizeof out->span); /* a table knows nothing outside */
        return TC_OK;
    }
    if (exact && !few)
        return tc_fail(
            err, TC_E_ARG,
            "the transfer function has %zu knots, more than the %d that can be integrated one by one; use the "
            "integrator 'integral' or fewer knots",
            tf->n, PIECES_MOST);
    out->dense = !(deepest(request) < DENSE_DEPTH);
    const double crossed = crossed_knots(request);
    out->twice = crossed > CROSSED_TWICE; /* as long as the integrator may be EXACT */
    if (options->integrator != TC_INTEGRATOR_EXACT && exact)
        snprintf(why, capacity, "piece by piece of the function: what else is shown needs it");
    if (exact)
        return TC_OK;
    out->integrator = TC_INTEGRATOR_INTEGRAL;
    out->split = isfinite(options->integral_split) ? options->integral_split : 0;
    bool varied = color_variation(tf, out->span) > VARIED;
    bool beyond = range && is_beyond_nodes(request, out->span);
    out->nodes = choose_intervals(tf, out->span, as_it_is || !few ? 0 : STEEP_SHARE) + 1;
    double steep = range && !beyond ? tc_running_steep(tf, out->nodes, out->span) : 0;
    bool wild = varied || steep > 0, hard = !as_it_is && few && range && (steep > 0 || drifts(request, varied));
    if (!range) /* the value may lie on a step, where nodes hold the mean of both sides */
        reason = "the data have one value";
    else if (request->cell_data && !as_it_is)
        reason = "a cell has one value, and crosses no knot";
    else if (beyond)
        reason = "ranges are too wide or too narrow for nodes";
    else if (!as_it_is && steep > STEEP_SHARE)
        reason = "the function is steep nearly everywhere";
    else if (!as_it_is && deepest(request) > DEPTH_MOST)
        reason = "cells are too dense for differences of integrals";
    else if (options->integrator == TC_INTEGRATOR_AUTO && !as_it_is &&
             crossed <= (varied ? CROSSED_VARIED
                         : hard ? CROSSED_HARD
                                : CROSSED_FEW))
        reason = "cells cross few of its knots";
    if (reason && few) {
        out->integrator = TC_INTEGRATOR_EXACT;
        snprintf(why, capacity, "piece by piece of the function: %s", reason);
        return TC_OK;
    }
    out->twice = false;
    if (hard) {
        out->hard = HARD_DRIFT;
        out->hard_depth = wild ? HARD_DEPTH_WILD : HARD_DEPTH;
    }
    snprintf(why, capacity, "running integrals: %s",
             out->hard > 0
                 ? "segments beside steps and in dense cells are integrated piece by piece of the function"
                 : "a fifth of the error of a 128x128x256 table of half floats, a hundredth of one of 8 bits, and "
                   "faster on llvmpipe");
    return TC_OK;
}
