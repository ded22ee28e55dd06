/* choose.c: tc_choose: an error or a frame time instead of knobs.
 *
 * Errors come from a calibration that is kept (trial.c, calibration.c), frame times are measured in the asked view and
 * size, and the picture of the setting that is taken is checked: what fails is remembered and followed by the next. */
#include "study/calibration.h"
#include "study/trial.h"

#include "api/driver.h"
#include "core/parallel.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A setting is tried whose calibrated error is below this share of the error that was asked for. Over five pairs of
 * mesh and function the largest error of all 262 144 pixels was at most 1.2 times that of the calibration's 49 152 rays
 * in 11 of 15 choices, and 1.5, 1.7, 4.5 and 18 times in the others, where steps or spikes meet few rays: those are for
 * the check of the picture to find, and no share would do for all. */
static const double SAFETY = 0.7;
/* Share of a frame budget that is kept back: medians of five frames of one setting differ by about as much. */
static const double MARGIN = 0.05;
enum { VERIFY = 4096, GROUPS = TC_CANDIDATE_MAX, TIME_ROUNDS = 4 };

typedef struct chooser {
    tc_trial trial;
    const tc_choose_request *request;
    tc_choose_report *report;
    tc_candidate candidate[TC_CANDIDATE_MAX];
    size_t n;
    tc_calibration kept;
    const char *key;
    uint64_t view;
    bool changed; /* kept or candidate, since it was stored */
} chooser;

/* Times of another view tell which setting is cheaper, but not how long a frame takes. */
static void forget_times(chooser *c)
{
    for (size_t i = 0; i < c->n; i++)
        c->candidate[i].ms = NAN;
    c->kept.view = c->view;
}

static tc_status time_them(chooser *c, const size_t *index, size_t m, tc_error *err)
{
    if (c->kept.view != c->view)
        forget_times(c);
    c->changed = true;
    return tc_trial_times(c->candidate, index, m, &c->trial, err);
}

static void store(chooser *c)
{
    if (c->changed && !c->request->no_cache)
        tc_calibration_store(&c->kept, c->candidate, c->n, c->request->cache, c->key, c->trial.log);
    c->changed = false;
}

static tc_status calibrate(chooser *c, tc_error *err)
{
    const tc_log *log = c->trial.log;
    c->report->cached =
        !c->request->no_cache && tc_calibration_load(&c->kept, c->candidate, c->n, c->request->cache, c->key, log);
    if (!c->report->cached) {
        double start = tc_now_ms();
        c->kept = (tc_calibration){.ratio = 1};
        tc_status status = tc_trial_errors(c->candidate, c->n, &c->kept.rays, &c->trial, err);
        if (status != TC_OK)
            return status;
        c->kept.ms = tc_now_ms() - start;
        c->changed = true;
        store(c); /* also where what follows fails */
    }
    for (size_t i = 0; i < c->n; i++) {
        char text[TC_CANDIDATE_TEXT];
        tc_candidate_text(text, &c->candidate[i], c->trial.fixed);
        if (isfinite(c->candidate[i].error))
            tc_say(log, TC_DEBUG, "calibrated: %s: error %.3g", text, c->candidate[i].error);
    }
    c->report->rays = c->kept.rays;
    c->report->ms_calibrate = c->kept.ms;
    c->report->candidates = (int)c->n;
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------------------- the check */

/* What candidate k errs by beyond what its opacity stop can do (what a ray that ends at opacity A may still gather is
 * at most 1 - A) is the integrator's: the others of its group err by it, too, but for what their stops make up; those
 * whose calibrated error was the same, `before`, owe nothing to their stops. */
static void raise_group(chooser *c, size_t k, double before)
{
    const tc_candidate *one = &c->candidate[k];
    for (size_t i = 0; i < c->n; i++) {
        tc_candidate *other = &c->candidate[i];
        if (other->group != one->group || !isfinite(other->error))
            continue;
        double share = other->error == before ? 0 : (1 - one->stop) + (1 - other->stop);
        other->error = fmax(other->error, one->error - share);
    }
}

/* The picture of candidate k; *held: its error is at most `error`, 0: whatever it is. */
static tc_status check(bool *held, chooser *c, size_t k, double error, tc_error *err)
{
    tc_candidate *one = &c->candidate[k];
    tc_trial_check found;
    bool finest = one->integrator == TC_INTEGRATOR_EXACT && one->stop >= 1;
    tc_status status = tc_trial_picture(&found, one, !finest, &c->trial, err);
    if (status != TC_OK)
        return status;
    tc_choose_report *r = c->report;
    double max = found.error;
    r->tried++;
    r->verify = found.verify;
    r->suspects = found.suspects;
    r->suspect_error = found.suspect;
    r->ms = found.ms;
    r->calibrated_error = one->error;
    r->error = max;
    tc_candidate_text(r->setting, one, c->trial.fixed);
    *held = !(error > 0) || max <= error;
    if (max > one->error) { /* the next run knows */
        if (one->error > 0)
            c->kept.ratio = fmax(c->kept.ratio, max / one->error);
        double before = one->error;
        one->error = max;
        raise_group(c, k, before);
        c->changed = true;
    }
    if (!*held)
        tc_say(c->trial.log, TC_DEBUG, "%s: error %.3g in this picture, above %.3g: the next setting is tried",
               r->setting, max, error);
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------------------- by error */

/* One digit, rounded up: 0.00034 → 0.0004. */
static double round_up(double x)
{
    double unit = pow(10, floor(log10(x)));
    return x > 0 ? ceil(x / unit - 1e-9) * unit : x;
}

static bool is_fixed(const tc_render_options *o)
{
    return o->integrator != TC_INTEGRATOR_AUTO || o->integral_order > 0 || o->integral_split > 0 ||
           o->opacity_stop > 0 || o->state_format == TC_STATE_16F;
}

static tc_status fail_unreachable(chooser *c, tc_error *err)
{
    size_t best = tc_candidate_best(c->candidate, c->n);
    char text[TC_CANDIDATE_TEXT];
    tc_status status = TC_OK;
    if (!isfinite(c->candidate[best].ms) || c->kept.view != c->view)
        status = time_them(c, &best, 1, err);
    if (status != TC_OK)
        return status;
    const tc_candidate *b = &c->candidate[best];
    tc_candidate_text(text, b, c->trial.fixed);
    double ask = round_up(b->error / SAFETY);
    char advice[48] = "";
    if (ask < 1)
        snprintf(advice, sizeof advice, "ask for %.3g or more, or ", ask);
    return tc_fail(
        err, TC_E_ACCURACY,
        "no setting%s reaches an error of %.3g here: the least is %.3g (%s), %.1f ms a frame; %stake the driver "
        "'reference', which works in double precision%s%s",
        is_fixed(c->trial.fixed) ? " that keeps what was given" : "", c->request->error, b->error, text, b->ms, advice,
        is_fixed(c->trial.fixed) ? ", or leave more to be chosen" : "",
        c->trial.fixed->samples == TC_SAMPLES_ADAPTIVE
            ? ", or 16 rays in every pixel, as adaptively chosen ones miss some"
            : "");
}

/* The most accurate of the timed ones, if it is not the chosen one and slower: what accuracy would cost. */
static void say_dearer(char *out, size_t capacity, const chooser *c, size_t chosen)
{
    const tc_candidate *best = NULL;
    for (size_t i = 0; i < c->n; i++)
        if (isfinite(c->candidate[i].ms) && c->candidate[i].error < c->candidate[chosen].error &&
            c->candidate[i].group != c->candidate[chosen].group && (!best || c->candidate[i].error < best->error))
            best = &c->candidate[i];
    *out = 0;
    if (!best)
        return;
    char text[TC_CANDIDATE_TEXT];
    tc_candidate_text(text, best, c->trial.fixed);
    snprintf(out, capacity, "; %s would take %.1f ms", text, best->ms);
}

static tc_status choose_error(size_t *chosen, chooser *c, tc_error *err)
{
    double error = c->request->error, limit = SAFETY * error;
    size_t index[TC_CANDIDATE_MAX];
    for (;;) { /* each round puts one candidate above the error */
        size_t m = tc_candidate_frugal(index, c->candidate, c->n, limit);
        if (m == 0 && limit < error) {
            limit = error;
            continue;
        }
        if (m == 0)
            return fail_unreachable(c, err);
        bool timed = true, held = false;
        for (size_t k = 0; k < m; k++)
            timed = timed && isfinite(c->candidate[index[k]].ms);
        tc_status status = timed ? TC_OK : time_them(c, index, m, err);
        if (status != TC_OK)
            return status;
        *chosen = tc_candidate_cheapest(c->candidate, index, m);
        double calibrated = c->candidate[*chosen].error;
        status = check(&held, c, *chosen, error, err);
        if (status != TC_OK)
            return status;
        if (!held)
            continue;
        char dearer[TC_CANDIDATE_TEXT + 32];
        tc_choose_report *r = c->report;
        r->calibrated_error = calibrated;
        say_dearer(dearer, sizeof dearer, c, *chosen);
        snprintf(r->why, sizeof r->why,
                 "error %.3g: %s: measured %.2g on %zu rays%s and %.2g in this picture, %.1f ms a frame%s", error,
                 r->setting, calibrated, c->kept.rays, r->cached ? " (by an earlier run)" : "", r->error, r->ms,
                 dearer);
        return TC_OK;
    }
}

/* -------------------------------------------------------------------------------------------------------- by time */

/* Does candidate i fit into the budget? Measures what is not known. */
static tc_status fits(bool *out, chooser *c, size_t i, tc_error *err)
{
    tc_status status = TC_OK;
    if (!isfinite(c->candidate[i].ms) || c->kept.view != c->view)
        status = time_them(c, &i, 1, err);
    *out = c->candidate[i].ms <= (1 - MARGIN) * c->request->frame_ms;
    return status;
}

/* The most accurate member of a group that fits, by bisection: a higher stop takes longer. *fit: n where none does. */
static tc_status fit_group(size_t *fit, chooser *c, const size_t *ladder, size_t m, tc_error *err)
{
    bool good;
    size_t low = 0, high = m - 1; /* ladder[low] fits, ladder[high] does not */
    *fit = c->n;
    tc_status status = fits(&good, c, ladder[low], err);
    if (status != TC_OK || !good)
        return status;
    status = fits(&good, c, ladder[high], err);
    if (status == TC_OK && good)
        low = high;
    while (status == TC_OK && high - low > 1) {
        size_t middle = low + (high - low) / 2;
        status = fits(&good, c, ladder[middle], err);
        *(good ? &low : &high) = middle;
    }
    *fit = ladder[low];
    return status;
}

/* The fastest candidate. The first of each group are timed side by side, where one is not yet: a lower stop is never
 * slower. */
static tc_status find_fastest(size_t *out, chooser *c, tc_error *err)
{
    size_t index[TC_CANDIDATE_MAX];
    size_t m = tc_candidate_frugal(index, c->candidate, c->n, DBL_MAX);
    bool timed = c->kept.view == c->view;
    for (size_t k = 0; k < m; k++)
        timed = timed && isfinite(c->candidate[index[k]].ms);
    tc_status status = timed ? TC_OK : time_them(c, index, m, err);
    if (status == TC_OK)
        *out = tc_candidate_cheapest(c->candidate, index, m);
    return status;
}

/* The most accurate candidate within the budget; n where none fits. */
static tc_status find_in_time(size_t *chosen, chooser *c, tc_error *err)
{
    size_t any;
    tc_status status = find_fastest(&any, c, err); /* for their times */
    bool done[GROUPS] = {false};
    int groups = c->candidate[c->n - 1].group + 1;
    *chosen = c->n;
    for (int round = 0; round < groups && status == TC_OK; round++) {
        size_t ladder[TC_CANDIDATE_MAX], fit, m = 0;
        int next = -1;
        double least = INFINITY;
        for (int g = 0; g < groups; g++) { /* the most accurate group that is left */
            size_t k = tc_candidate_ladder(ladder, c->candidate, c->n, g);
            if (!done[g] && k > 0 && c->candidate[ladder[k - 1]].error < least) {
                least = c->candidate[ladder[k - 1]].error;
                next = g;
            }
        }
        if (next < 0 || (*chosen < c->n && least >= c->candidate[*chosen].error))
            break;
        done[next] = true;
        m = tc_candidate_ladder(ladder, c->candidate, c->n, next);
        status = fit_group(&fit, c, ladder, m, err);
        if (status == TC_OK && fit < c->n && (*chosen == c->n || c->candidate[fit].error < c->candidate[*chosen].error))
            *chosen = fit;
    }
    return status;
}

static tc_status choose_time(size_t *chosen, chooser *c, tc_error *err)
{
    bool kept = c->report->cached && c->kept.view == c->view, held;
    tc_choose_report *r = c->report;
    double budget = c->request->frame_ms;
    for (int round = 0;; round++) {
        tc_status status = find_in_time(chosen, c, err);
        r->in_time = *chosen < c->n;
        if (status == TC_OK && !r->in_time)
            status = find_fastest(chosen, c, err);
        r->tried = 0;
        if (status == TC_OK)
            status = check(&held, c, *chosen, 0, err);
        if (status != TC_OK)
            return status;
        bool late = r->in_time && r->ms > budget;
        if (round == TIME_ROUNDS || !(late || (kept && !r->in_time)))
            break;
        if (kept) /* the machine was busier, or less busy, when that was measured */
            forget_times(c);
        else
            c->candidate[*chosen].ms = r->ms;
        kept = false;
    }
    r->in_time = r->ms <= budget; /* of the picture's own frames: they are what was asked about */
    if (r->in_time) {
        snprintf(r->why, sizeof r->why,
                 "frame time %.4g ms: %s: the most accurate setting that fits, %.1f ms a frame, error %.2g in this "
                 "picture",
                 budget, r->setting, r->ms, r->error);
    } else {
        snprintf(
            r->why, sizeof r->why,
            "frame time %.4g ms: no setting is fast enough; the fastest is taken: %s, %.1f ms a frame, error %.2g in "
            "this picture; a smaller picture or fewer rays a pixel take less",
            budget, r->setting, r->ms, r->error);
        tc_say(c->trial.log, TC_WARNING,
               "no setting makes a frame within %.4g ms: the fastest takes %.1f ms (%s); a "
               "smaller picture or fewer rays a pixel take less",
               budget, r->ms, r->setting);
    }
    return TC_OK;
}

/* After choose_error: does what it chose fit into the budget, too? */
static tc_status judge_time(chooser *c, size_t chosen, tc_error *err)
{
    size_t within;
    char text[TC_CANDIDATE_TEXT];
    tc_choose_report *r = c->report;
    tc_status status = fits(&r->in_time, c, chosen, err);
    if (status != TC_OK || r->in_time)
        return status;
    status = find_in_time(&within, c, err);
    if (status != TC_OK)
        return status;
    if (within == c->n) {
        tc_say(
            c->trial.log, TC_WARNING,
            "an error of %.3g takes %.1f ms a frame, more than %.4g, and no setting is that fast; the error is kept: a "
            "smaller picture or fewer rays a pixel take less",
            c->request->error, c->candidate[chosen].ms, c->request->frame_ms);
        return TC_OK;
    }
    tc_candidate_text(text, &c->candidate[within], c->trial.fixed);
    tc_say(
        c->trial.log, TC_WARNING,
        "an error of %.3g takes %.1f ms a frame, more than %.4g, and is kept; within that time the least error is %.3g "
        "(%s)",
        c->request->error, c->candidate[chosen].ms, c->request->frame_ms, c->candidate[within].error, text);
    return TC_OK;
}

/* ----------------------------------------------------------------------------------------------------------- whole */

/* The driver that has no knobs. */
static tc_status choose_reference(chooser *c, tc_error *err)
{
    tc_choose_report *r = c->report;
    tc_trial_check found;
    tc_candidate only = {.integrator = TC_INTEGRATOR_EXACT, .stop = 1};
    tc_status status = tc_trial_picture(&found, &only, false, &c->trial, err);
    if (status != TC_OK)
        return status;
    double asked = c->request->error, budget = c->request->frame_ms, max = found.error;
    if (asked > 0 && max > asked)
        return tc_fail(err, TC_E_ACCURACY,
                       "an error of %.3g is not reached: a picture of floats errs by %.3g; ask for more", asked, max);
    snprintf(r->setting, sizeof r->setting, "double precision on the CPU, which has nothing to choose");
    snprintf(r->best_setting, sizeof r->best_setting, "%s", r->setting);
    r->verify = found.verify;
    r->ms = r->best_ms = found.ms;
    r->best_error = max;
    r->tried = 1;
    r->error = max;
    r->in_time = !(budget > 0) || r->ms <= (1 - MARGIN) * budget;
    snprintf(r->why, sizeof r->why, "%s: error %.2g in this picture, %.1f ms a frame", r->setting, max, r->ms);
    if (!r->in_time)
        tc_say(c->trial.log, TC_WARNING,
               "the driver 'reference' takes %.1f ms a frame, more than %.4g, and has nothing to choose; a smaller "
               "picture "
               "takes less",
               r->ms, budget);
    return TC_OK;
}

/* What renders here: its name, and whether it has knobs. Packs the mesh, which has to be done anyway. */
static tc_status ask_renderer(tc_render_stats *stats, const tc_trial *p, tc_error *err)
{
    tc_render_options small = *p->fixed;
    tc_image *image = NULL;
    small.width = small.height = 8;
    small.whole_width = small.whole_height = small.part_x = small.part_y = 0;
    small.samples = 1;
    small.count = small.audit = false;
    tc_status status = tc_render(&image, stats, p->renderer, p->mesh, p->tf, p->camera, &small, p->log, err);
    tc_image_destroy(&image);
    return status;
}

static tc_status choose(tc_render_options *options, chooser *c, tc_error *err)
{
    tc_choose_report *r = c->report;
    size_t chosen;
    tc_status status = calibrate(c, err);
    if (status == TC_OK)
        status = c->request->error > 0 ? choose_error(&chosen, c, err) : choose_time(&chosen, c, err);
    if (status == TC_OK && c->request->error > 0 && c->request->frame_ms > 0)
        status = judge_time(c, chosen, err);
    if (c->n > 0 && c->kept.rays > 0)
        store(c);
    if (status != TC_OK)
        return status;
    size_t best = tc_candidate_best(c->candidate, c->n);
    r->best_error = c->candidate[best].error;
    r->best_ms = c->kept.view == c->view ? c->candidate[best].ms : NAN;
    tc_candidate_text(r->best_setting, &c->candidate[best], c->trial.fixed);
    tc_candidate_apply(options, &c->candidate[chosen]);
    return TC_OK;
}

tc_status tc_choose(tc_render_options *options, tc_choose_report *report, tc_renderer *renderer, const tc_mesh *mesh,
                    const tc_transfer *tf, const tc_camera *camera, const tc_choose_request *request, const tc_log *log,
                    tc_error *err)
{
    tc_choose_report unused;
    const tc_render_options fixed = options ? *options : (tc_render_options){0};
    tc_rays rays;
    double unit;
    if (!report)
        report = &unused;
    *report = (tc_choose_report){.in_time = true,
                                 .calibrated_error = NAN,
                                 .ms_calibrate = NAN,
                                 .ms = NAN,
                                 .margin = MARGIN,
                                 .best_error = NAN,
                                 .best_ms = NAN,
                                 .error = NAN};
    if (!renderer || !request || !(request->error >= 0) || !(request->frame_ms >= 0) || isinf(request->error) ||
        isinf(request->frame_ms) || (request->error == 0 && request->frame_ms == 0))
        return tc_fail(err, TC_E_ARG,
                       "a renderer and an error or a frame time above 0 are needed to choose settings by");
    tc_status status = tc_render_resolve(&unit, &rays, mesh, tf, camera, options, err);
    if (status != TC_OK)
        return status;
    chooser *c = calloc(1, sizeof *c);
    char *key = NULL;
    tc_render_stats stats;
    if (!c)
        return tc_fail(err, TC_E_MEMORY, "out of memory: nothing could be chosen");
    c->request = request;
    c->report = report;
    c->trial = (tc_trial){.renderer = renderer,
                          .mesh = mesh,
                          .tf = tf,
                          .camera = camera,
                          .fixed = &fixed,
                          .verify = request->verify ? request->verify : VERIFY,
                          .seed = request->seed,
                          .threads = request->threads,
                          .log = log};
    status = ask_renderer(&stats, &c->trial, err);
    if (status == TC_OK && !strcmp(stats.driver, "reference")) {
        status = choose_reference(c, err);
    } else if (status == TC_OK) {
        c->n = tc_candidate_list(c->candidate, &fixed);
        c->view = tc_calibration_view(camera, &fixed);
        char where[sizeof stats.gl_renderer + sizeof stats.driver + 4]; /* either driver has times of its own */
        snprintf(where, sizeof where, "%s, %s", stats.gl_renderer, stats.driver);
        c->key = key = tc_calibration_key(mesh, tf, unit, where, &fixed);
        status = key ? choose(options, c, err) : tc_fail(err, TC_E_MEMORY, "out of memory: nothing could be chosen");
    }
    tc_trial_finish(&c->trial);
    free(key);
    free(c);
    return status;
}
