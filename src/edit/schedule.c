/* schedule.c: what to render next, from what renderings took. The filter is R. E. Kalman's (A new approach to linear
 * filtering and prediction problems, 1960) with a state of two numbers that wander slowly. */
#include "edit/schedule.h"

#include <math.h>
#include <stddef.h>

/* ------------------------------------------------------------------------------------------ what it takes */

/* Standard deviations, as shares: of a time that is measured; of how much from one to the next all costs wander
 * together (the machine is busy, the view is a fuller one), and each for itself. */
static const double tc_noise = 0.15, tc_together = 0.05, tc_apart = 0.01;

static double tc_cost_ms(const tc_cost *cost, double pixels)
{
    return cost->fixed_ms + cost->ns_a_pixel * pixels * 1e-6;
}

/* Its standard deviation. */
static double tc_cost_doubt(const tc_cost *cost, double pixels)
{
    const double x = pixels * 1e-6;
    return sqrt(fmax(cost->spread[0] + 2 * x * cost->spread[1] + x * x * cost->spread[2], 0));
}

/* From one measurement: all of it is put down to the pixels, so that a finer picture is never thought cheaper than it
 * is. */
static void tc_cost_begin(tc_cost *cost, double n, double million, double ms)
{
    const double slope = ms / million, each = ms / n;
    cost->far = 0;
    cost->fixed_ms = 0;
    cost->ns_a_pixel = slope;
    cost->spread[0] = each * each;
    cost->spread[1] = -each * slope;
    cost->spread[2] = slope * slope * (1 + tc_noise * tc_noise);
}

/* n renderings of so many pixels in all took ms. */
static void tc_cost_learn(tc_cost *cost, double n, double pixels, double ms)
{
    const double x = pixels * 1e-6;
    if (cost->count < 2) { /* of the first one much is what happens once: its word holds until the second */
        cost->count++;
        tc_cost_begin(cost, n, x, ms);
        return;
    }
    double *p = cost->spread;
    const double fixed = cost->fixed_ms, slope = cost->ns_a_pixel;
    const double expected = n * fixed + x * slope, error = ms - expected;
    p[0] += tc_together * tc_together * fixed * fixed + pow(tc_apart * expected / n, 2);
    p[1] += tc_together * tc_together * fixed * slope;
    p[2] += tc_together * tc_together * slope * slope + pow(tc_apart * slope, 2);
    /* what is not seen for long is not known worse than not at all */
    const double large = fmax(ms, expected), most[2] = {pow(large / n, 2), pow(large / x, 2)};
    for (int i = 0; i < 2; i++)
        if (p[2 * i] > most[i] && most[i] > 0) {
            p[1] *= sqrt(most[i] / p[2 * i]);
            p[2 * i] = most[i];
        }
    const double noise = tc_noise * large;
    const double f = n * p[0] + x * p[1], s = n * p[1] + x * p[2], total = n * f + x * s + noise * noise;
    if (!(total > 0))
        return;
    const bool far =
        n < 2 && error * error > 9 * total && /* of many, some are noise */ (ms > 2 * expected || ms < expected / 2);
    cost->far = far ? cost->far + 1 : 0;
    if (cost->far == 1)
        return;                /* an accident, until it happens twice */
    if (far && expected > 0) { /* another regime: all is as much slower or faster */
        const double share = ms / expected;
        cost->fixed_ms *= share;
        cost->ns_a_pixel *= share;
        for (int i = 0; i < 3; i++)
            p[i] *= share * share;
        cost->far = 0;
        return;
    }
    cost->fixed_ms += f / total * error;
    cost->ns_a_pixel += s / total * error;
    p[0] -= f * f / total;
    p[1] -= f * s / total;
    p[2] -= s * s / total;
    const double now = fmax(n * cost->fixed_ms + x * cost->ns_a_pixel, 0);
    if (cost->fixed_ms < 0) { /* neither is below 0; what they give together stays */
        cost->fixed_ms = 0;
        cost->ns_a_pixel = now / x;
    } else if (cost->ns_a_pixel < 0) {
        cost->ns_a_pixel = 0;
        cost->fixed_ms = now / n;
    }
}

/* What is known of it, or of the other way to render; NULL: nothing. */
static const tc_cost *tc_cost_of(const tc_schedule *schedule, bool kept)
{
    const tc_cost *cost = schedule->cost;
    return cost[kept].count ? &cost[kept] : cost[!kept].count ? &cost[!kept] : NULL;
}

/* ------------------------------------------------------------------------------------------ sizes */

static int tc_divided(int size, int divide)
{
    return size / divide + (size % divide != 0);
}

static double tc_pixels(const tc_schedule *schedule, int divide)
{
    return (double)tc_divided(schedule->width, divide) * tc_divided(schedule->height, divide);
}

static double tc_picture_ms(const tc_schedule *schedule, const tc_cost *cost, int divide)
{
    return tc_cost_ms(cost, tc_pixels(schedule, divide));
}

/* How coarse the next picture is while something moves. */
static int tc_coarse(const tc_schedule *schedule, bool kept)
{
    const tc_cost *cost = tc_cost_of(schedule, kept);
    if (!cost)
        return TC_COARSEST;
    const double enough = 0.8 * schedule->budget_ms;
    int at = schedule->coarse[kept] ? schedule->coarse[kept] : schedule->coarse[!kept];
    if (!at)
        at = TC_COARSEST;
    int fine = 1; /* that leaves something of the budget */
    while (fine < TC_COARSEST && tc_picture_ms(schedule, cost, fine) > enough)
        fine++;
    if (fine < at || tc_picture_ms(schedule, cost, at) > schedule->budget_ms)
        return fine;
    if (at > 1 && cost->count > 2) { /* what may well suffice, but is not known for long, is tried */
        const double ms = tc_picture_ms(schedule, cost, at - 1);
        const double doubt = tc_cost_doubt(cost, tc_pixels(schedule, at - 1));
        if (ms <= 1.25 * schedule->budget_ms && doubt > tc_noise * ms && ms - doubt <= enough)
            return at - 1;
    }
    return at;
}

/* The next finer picture at rest: the finest that is there in twice the budget, else a small one. */
static int tc_finer(const tc_schedule *schedule, bool kept)
{
    const tc_cost *cost = tc_cost_of(schedule, kept);
    int finer = 1;
    for (int divide = 1; divide <= 4 && divide < schedule->shown; divide *= 2) {
        finer = divide;
        if (cost && tc_picture_ms(schedule, cost, divide) <= 2 * schedule->budget_ms)
            break;
    }
    return finer;
}

/* In how many parts. Planned as if each walk were new, so that the parts are the same for both. */
static int tc_plan_parts(const tc_schedule *schedule, int divide)
{
    const int rows = tc_divided(schedule->height, divide);
    const tc_cost *cost = tc_cost_of(schedule, false);
    if (!cost)
        return 1;
    /* with its doubt, but no more than if a small picture's whole time were its pixels' */
    const double slope = cost->ns_a_pixel +
                         fmin(sqrt(fmax(cost->spread[2], 0)), cost->fixed_ms * 1e6 / tc_pixels(schedule, TC_COARSEST));
    const double ms = slope * tc_pixels(schedule, divide) * 1e-6 * schedule->crowd;
    const double room = fmax(fmax(schedule->part_ms - cost->fixed_ms, 2 * cost->fixed_ms), schedule->part_ms / 4);
    const double wanted = fmin(fmax(ceil(ms / room - 0.2), 1), rows);
    int parts = (int)wanted;
    if (divide == 1 && schedule->parts > 0 && schedule->parts <= rows && ms / schedule->parts <= 1.4 * room &&
        parts > 0.7 * schedule->parts)
        parts = schedule->parts;
    return parts;
}

/* ------------------------------------------------------------------------------------------ the plan */

void tc_schedule_begin(tc_schedule *schedule, int width, int height)
{
    *schedule = (tc_schedule){.width = width, .height = height, .budget_ms = 60, .part_ms = 40, .crowd = 1.5};
}

void tc_schedule_resize(tc_schedule *schedule, int width, int height)
{
    if (width == schedule->width && height == schedule->height)
        return;
    schedule->width = width;
    schedule->height = height;
    schedule->parts = 0;
    tc_schedule_change(schedule, schedule->moving);
    schedule->sized = schedule->state;
}

void tc_schedule_change(tc_schedule *schedule, bool moving)
{
    schedule->state++;
    schedule->moving = moving;
    schedule->shown = 0;
    schedule->divide = 0;
    schedule->row = 0;
}

void tc_schedule_rest(tc_schedule *schedule)
{
    schedule->moving = false;
}

bool tc_schedule_next(tc_step *out, tc_schedule *schedule, bool kept)
{
    if (schedule->width < 1 || schedule->height < 1)
        return false;
    const bool believed = kept && schedule->doubt == 0;
    if (schedule->shown == 0) {
        const int divide = tc_coarse(schedule, believed);
        schedule->coarse[believed] = divide;
        *out = (tc_step){divide, 0, tc_divided(schedule->height, divide), divide == 1, believed, schedule->state};
        return true;
    }
    if (schedule->moving || schedule->shown == 1)
        return false;
    if (schedule->divide == 0) {
        schedule->divide = tc_finer(schedule, believed);
        schedule->row = 0;
        const int rows = tc_divided(schedule->height, schedule->divide),
                  parts = tc_plan_parts(schedule, schedule->divide);
        schedule->part_rows = schedule->pass.rows = tc_divided(rows, parts);
        if (schedule->divide == 1)
            schedule->parts = parts;
        schedule->pass.ms = schedule->pass.most = schedule->pass.most_of_two = schedule->pass.before = 0;
        schedule->pass.parts = schedule->pass.kept = 0;
    }
    const int left = tc_divided(schedule->height, schedule->divide) - schedule->row;
    const int rows = left < schedule->part_rows ? left : schedule->part_rows;
    *out = (tc_step){schedule->divide, schedule->row,  rows, schedule->divide == 1 && rows == left,
                     believed,         schedule->state};
    return true;
}

/* Kept walks were hoped for: were they there? */
static void tc_promise(tc_schedule *schedule, const tc_step *step, bool kept)
{
    if (schedule->doubt > 0)
        schedule->doubt--;
    if (!step->kept)
        return;
    schedule->missed = kept ? 0 : schedule->missed + 1;
    if (schedule->missed >= 4) {
        schedule->missed = 0;
        schedule->doubt = 200;
    }
}

/* A whole picture, in so many parts, took so long. Where kept walks were hoped for and were not there, they are perhaps
 * being kept, which takes longer: that tells nothing of others, but where nothing else is known. */
static void tc_picture_done(tc_schedule *schedule, const tc_step *step, int parts, double ms, bool kept)
{
    tc_cost *cost = &schedule->cost[kept];
    if (kept || !step->kept || cost->count < 2)
        tc_cost_learn(cost, parts, tc_pixels(schedule, step->divide), ms);
}

/* A part of a finer picture is done. */
static void tc_part_done(tc_schedule *schedule, const tc_step *step, double ms, bool kept)
{
    const tc_cost *cost = tc_cost_of(schedule, kept);
    const double fixed = cost ? cost->fixed_ms : 0;
    const int rows = tc_divided(schedule->height, step->divide);
    schedule->pass.ms += ms;
    const double a_row = (ms - fixed) / step->rows;
    schedule->pass.most = fmax(schedule->pass.most, a_row);
    schedule->pass.most_of_two = fmax(schedule->pass.most_of_two, fmin(a_row, schedule->pass.before));
    const bool again = schedule->pass.parts == 0 || schedule->pass.before * step->rows > schedule->part_ms;
    schedule->pass.before = a_row;
    schedule->pass.kept += kept;
    schedule->pass.parts++;
    schedule->row += step->rows;
    if (schedule->row < rows) {
        const double part = fmax(schedule->part_ms, 3 * fixed);
        if (ms > 2 * part && again) /* the plan is wrong here: the next parts are smaller */
            schedule->part_rows = (int)fmax(1, schedule->part_rows * fmax(part / ms, 0.1));
        else if (ms < part / 2 && schedule->part_rows < schedule->pass.rows)
            schedule->part_rows = (int)fmin(schedule->pass.rows, 2.0 * schedule->part_rows);
        return;
    }
    const int parts = schedule->pass.parts;
    if (schedule->pass.kept == 0 || schedule->pass.kept == parts)
        tc_picture_done(schedule, step, parts, schedule->pass.ms, kept);
    const double mean = (schedule->pass.ms - parts * fixed) / rows;
    const double most = parts > 4 ? schedule->pass.most_of_two : schedule->pass.most; /* of many one is an accident */
    if (parts > 2 && mean > 0)
        schedule->crowd = fmin(fmax((schedule->crowd + most / mean) / 2, 1), 4);
    schedule->shown = step->divide;
    schedule->divide = 0;
}

void tc_schedule_done(tc_schedule *schedule, const tc_step *step, double ms, bool kept)
{
    ms = ms > 1e-3 ? fmin(ms, 1e7) : 1e-3; /* NaN, too: no clock is that fine, and no picture takes hours */
    tc_promise(schedule, step, kept);
    const bool whole = step->from == 0 && step->rows == tc_divided(schedule->height, step->divide);
    if (step->state == schedule->state && schedule->shown != 0) {
        if (step->divide == schedule->divide && step->from == schedule->row)
            tc_part_done(schedule, step, ms, kept);
    } else if (whole && (int)(step->state - schedule->sized) >= 0) {
        tc_picture_done(schedule, step, 1, ms, kept);
        if (step->state == schedule->state)
            schedule->shown = step->divide;
    }
}
