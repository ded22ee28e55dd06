/* figures.c: the 2003 paper's figures 7 (frame time over a turn) and 8 (fragments in each pass), measured. */
#include "study/study.h"

#include "core/memory.h"
#include "study/summary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TURN_FRAMES = 3 }; /* timed at each angle */
static const double TURN_ELEVATION = 20;

static const struct {
    const char *rule;
    int z_update_every;
    double stop;
} rules[TC_FRAGMENT_CURVES] = {{"all", -1, 1}, {"locked", 0, 1}, {"stopped", 0, 0}};

static bool wants(const tc_study *study, int figure)
{
    for (size_t k = 0; k < TC_STUDY_SETTINGS; k++)
        if (study->on[k] && tc_study_changes[k].figure == figure)
            return true;
    return false;
}

static bool has_turn(const tc_study *study, const char *scene, const char *function, double angle)
{
    for (size_t i = 0; i < study->n_turn; i++)
        if (study->turn[i].angle == angle && !strcmp(study->turn[i].scene, scene) &&
            !strcmp(study->turn[i].function, function))
            return true;
    return false;
}

static bool has_curve(const tc_study *study, const char *scene, const char *function, const char *rule)
{
    for (size_t i = 0; i < study->n_curve; i++)
        if (!strcmp(study->curve[i].rule, rule) && !strcmp(study->curve[i].scene, scene) &&
            !strcmp(study->curve[i].function, function))
            return true;
    return false;
}

static double angle_of(int i)
{
    return 360.0 * i / TC_ROTATION_FRAMES;
}

bool tc_study_has_figures(const tc_study *study, const char *scene, const char *function)
{
    for (int i = 0; i < TC_ROTATION_FRAMES && wants(study, TC_FIGURE_ROTATION); i++)
        if (!has_turn(study, scene, function, angle_of(i)))
            return false;
    for (int i = 0; i < TC_FRAGMENT_CURVES && wants(study, TC_FIGURE_FRAGMENTS); i++)
        if (!has_curve(study, scene, function, rules[i].rule))
            return false;
    return true;
}

static tc_status render(tc_render_stats *stats, tc_study *study, const tc_study_pair *pair, const tc_camera *camera,
                        const tc_render_options *options, tc_error *err)
{
    tc_renderer *renderer = NULL;
    tc_image *image = NULL;
    tc_status status = tc_study_renderer(&renderer, study, false, err);
    if (status == TC_OK)
        status = tc_render(&image, stats, renderer, pair->mesh, pair->tf, camera, options, &study->quiet, err);
    tc_image_destroy(&image);
    return status;
}

static tc_status turn(tc_study *study, const tc_study_pair *pair, double angle, tc_error *err)
{
    double ms[TURN_FRAMES];
    tc_turn out = {.angle = angle};
    tc_render_options options;
    tc_render_stats stats;
    tc_camera camera;
    memcpy(out.scene, pair->scene, sizeof out.scene);
    memcpy(out.function, pair->function, sizeof out.function);
    tc_study_base(&options, &study->options);
    tc_study_camera(&camera, pair->mesh, &study->options, angle, TURN_ELEVATION);
    options.count = true;
    tc_status status = render(&stats, study, pair, &camera, &options, err);
    out.steps = stats.steps;
    options.count = false;
    for (int f = -1; f < TURN_FRAMES && status == TC_OK; f++) {
        status = render(&stats, study, pair, &camera, &options, err);
        if (f >= 0)
            ms[f] = stats.ms_frame;
    }
    if (status != TC_OK)
        return status;
    out.ms = tc_median(ms, TURN_FRAMES);
    return tc_study_keep_turn(study, &out, err);
}

static tc_status curve(tc_study *study, const tc_study_pair *pair, int rule, tc_error *err)
{
    tc_curve out = {0};
    tc_render_options options;
    tc_render_stats stats;
    tc_camera camera;
    double azimuth, elevation;
    memcpy(out.scene, pair->scene, sizeof out.scene);
    memcpy(out.function, pair->function, sizeof out.function);
    snprintf(out.rule, sizeof out.rule, "%s", rules[rule].rule);
    tc_study_view(&azimuth, &elevation, 0);
    tc_study_base(&options, &study->options);
    tc_study_camera(&camera, pair->mesh, &study->options, azimuth, elevation);
    options.steps_per_pass = 1;
    options.z_update_every = rules[rule].z_update_every;
    options.opacity_stop = rules[rule].stop;
    options.count = true;
    tc_status status = render(&stats, study, pair, &camera, &options, err);
    if (status != TC_OK)
        return status;
    out.n = stats.n_fragments_per_pass;
    out.fragments = tc_alloc(out.n, sizeof *out.fragments);
    if (!out.fragments)
        return tc_fail_memory(err, "a curve", out.n, sizeof *out.fragments);
    if (out.n)
        memcpy(out.fragments, stats.fragments_per_pass, out.n * sizeof *out.fragments);
    status = tc_study_keep_curve(study, &out, err);
    free(out.fragments);
    return status;
}

tc_status tc_study_figures(tc_study *study, const tc_study_pair *pair, tc_error *err)
{
    tc_status status = TC_OK;
    for (int i = 0; i < TC_ROTATION_FRAMES && status == TC_OK && wants(study, TC_FIGURE_ROTATION); i++)
        if (!has_turn(study, pair->scene, pair->function, angle_of(i)))
            status = turn(study, pair, angle_of(i), err);
    for (int i = 0; i < TC_FRAGMENT_CURVES && status == TC_OK && wants(study, TC_FIGURE_FRAGMENTS); i++)
        if (!has_curve(study, pair->scene, pair->function, rules[i].rule))
            status = curve(study, pair, i, err);
    return status;
}
