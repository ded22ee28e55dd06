/* base.c: what all frames of a batch have in common. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/base.h"
#include "cli/picture/render_setup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { TC_TRIED = 4 }; /* steps of a dataset whose first one cannot be read */

tc_over tc_range_over(const tc_batch_command *look)
{
    if (look->picture.has_range)
        return TC_OVER_AUTO;
    return look->range_over == TC_OVER_AUTO ? TC_OVER_ALL : (tc_over)look->range_over;
}

tc_over tc_unit_over(const tc_batch_command *look)
{
    if (look->picture.unit_distance > 0)
        return TC_OVER_AUTO;
    return look->unit_over == TC_OVER_AUTO ? TC_OVER_FIRST : (tc_over)look->unit_over;
}

tc_over tc_camera_over(const tc_batch_command *look)
{
    return look->camera_over == TC_OVER_AUTO ? TC_OVER_FIRST : (tc_over)look->camera_over;
}

const double *tc_base_range(const tc_batch_base *base, const tc_batch_command *look, size_t field)
{
    return base->range[field][tc_range_over(look) == TC_OVER_ALL];
}

double tc_base_unit(const tc_batch_base *base, const tc_batch_command *look)
{
    return base->unit[tc_unit_over(look) == TC_OVER_ALL];
}

tc_load tc_batch_load(const tc_batch_base *base, const tc_batch_scene *scene, int step, size_t field)
{
    const tc_series *series = &scene->series;
    return (tc_load){
        .path = series->of_files ? series->path[step] : scene->look[0].picture.input,
        .step = base->stepped ? step : -1,
        .field = scene->look[field * scene->n_function].picture.source.field,
        .number = step,
    };
}

static int tc_no_memory(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* The steps of the dataset and their times. */
static int tc_times_take(tc_batch_base *out, const tc_batch_scene *scene, tc_talk *talk)
{
    const tc_series *series = &scene->series;
    const tc_source *source = tc_mesh_source(out->loader.mesh);
    const size_t own = source ? source->n_time : 0;
    out->stepped = !series->of_files && own > 0;
    out->n_step = series->of_files ? series->n : own > 0 ? own : 1;
    out->time = malloc(out->n_step * sizeof *out->time);
    if (!out->time)
        return tc_no_memory(talk);
    for (size_t i = 0; i < out->n_step; i++)
        out->time[i] = series->of_files ? series->time[i] : own > 0 ? source->time[i] : NAN;
    if (series->of_files && own > 1)
        tc_talk_warning(talk, "%s has %zu steps of its own; of each file of the series the first is shown",
                        series->path[0], own);
    return -1;
}

/* The first step that can be read: of a series the first such file; a dataset with steps of its own is asked for a
 * few. Those before it are told of when it is their turn. */
static int tc_first_open(tc_batch_base *out, const tc_batch_scene *scene, tc_talk *talk)
{
    const tc_series *series = &scene->series;
    const tc_input_options *source = &scene->look[0].picture.source;
    const int n = series->of_files ? (int)series->n : tc_input_is_synthetic(series->path[0]) ? 1 : 1 + TC_TRIED;
    tc_load load = tc_batch_load(out, scene, 0, 0);
    char why[sizeof talk->last];
    talk->muted = n > 1;
    tc_identity_make(out->identity, sizeof out->identity, load.path);
    int first = tc_loader_open(&out->loader, source, &load, talk), code = first;
    memcpy(why, talk->last, sizeof why);
    for (int i = 1; i < n && code == TC_EXIT_FAILED; i++) {
        load = tc_batch_load(out, scene, series->of_files ? i : 0, 0);
        load.step = series->of_files ? load.step : i;
        out->first = i;
        tc_loader_finish(&out->loader);
        tc_identity_make(out->identity, sizeof out->identity, load.path);
        code = tc_loader_open(&out->loader, source, &load, talk);
    }
    talk->muted = false;
    if (code >= 0) {
        if (n > 1)
            tc_talk_error(talk, "%s", why);
        return first;
    }
    tc_source_notes_say(out->loader.mesh, load.path, talk);
    return -1;
}

int tc_batch_base_open(tc_batch_base *out, const tc_batch_scene *scene, tc_talk *talk)
{
    *out = (tc_batch_base){.ms_survey = NAN};
    int code = tc_first_open(out, scene, talk);
    if (code < 0)
        code = tc_times_take(out, scene, talk);
    out->range = code < 0 ? calloc(scene->n_field, sizeof *out->range) : NULL;
    if (code >= 0 || !out->range)
        return code < 0 ? tc_no_memory(talk) : code;
    if (out->stepped)
        out->loader.last.step = out->first;
    out->field_name = calloc(scene->n_field, sizeof *out->field_name);
    out->n_field = scene->n_field;
    for (size_t i = 0; i < scene->n_field; i++) {
        const tc_source *source = tc_mesh_source(out->loader.mesh);
        const char *own = source ? source->field : "field"; /* a synthetic dataset has the one */
        const char *name = *scene->field[i] ? scene->field[i] : own ? own : "none";
        if (!out->field_name || !(out->field_name[i] = strdup(name)))
            return tc_no_memory(talk);
    }
    tc_mesh_report report;
    tc_mesh_get_report(&report, out->loader.mesh);
    memcpy(out->bounds, report.bounds, sizeof out->bounds);
    out->unit[0] = out->unit[1] = tc_default_unit_distance(out->loader.mesh);
    for (size_t i = 0; i < scene->n_field; i++)
        for (int k = 0; k < 2; k++) {
            const double *found = i == 0 ? report.scalar_range : (const double[2]){INFINITY, -INFINITY};
            memcpy(out->range[i][k], found, sizeof out->range[i][k]);
        }
    return -1;
}

/* --------------------------------------------------------------------------------------------------------- surveys */

/* What is to be known of a field's steps. */
static bool tc_any_over(const tc_batch_scene *scene, size_t field, tc_over over, tc_over (*of)(const tc_batch_command *))
{
    for (size_t i = 0; i < scene->n_function; i++)
        if (of(&scene->look[field * scene->n_function + i]) == over)
            return true;
    return false;
}

/* What a pass is for. */
typedef struct tc_pass {
    size_t field;
    bool all; /* over all steps; else over the first alone */
    bool range, box, unit;
} tc_pass;

static void tc_survey_add(tc_batch_base *base, const tc_survey *survey, const tc_pass *pass)
{
    if (survey->status != TC_OK)
        return;
    double *range = base->range[pass->field][pass->all];
    if (pass->range && survey->range[0] <= survey->range[1]) {
        range[0] = fmin(range[0], survey->range[0]);
        range[1] = fmax(range[1], survey->range[1]);
    }
    const double *b = survey->bounds;
    for (int i = 0; pass->box && i < 6; i++)
        base->bounds[i] = i % 2 ? fmax(base->bounds[i], b[i]) : fmin(base->bounds[i], b[i]);
    const double diagonal = hypot(hypot(b[1] - b[0], b[3] - b[2]), b[5] - b[4]);
    if (pass->unit && survey->source_cells > 0)
        base->unit[1] = fmax(base->unit[1], diagonal / cbrt((double)survey->source_cells));
}

/* Nothing is known yet of what the pass is for. */
static void tc_pass_begin(tc_batch_base *base, const tc_pass *pass)
{
    if (pass->range) {
        base->range[pass->field][pass->all][0] = INFINITY;
        base->range[pass->field][pass->all][1] = -INFINITY;
    }
    for (int i = 0; pass->box && i < 6; i++)
        base->bounds[i] = i % 2 ? -INFINITY : INFINITY;
    if (pass->unit)
        base->unit[1] = 0;
}

/* One pass over step [n]. */
static int tc_survey_run(tc_batch_base *base, const tc_batch_scene *scene, const tc_pass *pass, const int *step,
                         size_t n, tc_talk *talk)
{
    tc_error err = {0};
    const double first[6] = {base->bounds[0], base->bounds[1], base->bounds[2],
                             base->bounds[3], base->bounds[4], base->bounds[5]};
    tc_survey *survey = calloc(n, sizeof *survey);
    const char **path = calloc(n, sizeof *path);
    int *number = calloc(n, sizeof *number);
    tc_status status = survey && path && number ? TC_OK : TC_E_MEMORY;
    tc_input_options source = scene->look[pass->field * scene->n_function].picture.source;
    source.has_step = source.has_time = false;
    const tc_read_options read = tc_input_read_options(&source);
    for (size_t i = 0; i < n && status == TC_OK; i++) {
        const tc_load load = tc_batch_load(base, scene, step[i], pass->field);
        path[i] = load.path;
        number[i] = load.step;
    }
    if (status == TC_OK)
        status = base->stepped ? tc_mesh_survey(survey, number, n, path[0], &read, &talk->log, &err)
                               : tc_mesh_survey_files(survey, path, n, &read, &talk->log, &err);
    tc_pass_begin(base, pass);
    for (size_t i = 0; i < n && status == TC_OK; i++)
        tc_survey_add(base, &survey[i], pass);
    if (base->bounds[0] > base->bounds[1])
        memcpy(base->bounds, first, sizeof first);
    if (!(base->unit[1] > 0))
        base->unit[1] = base->unit[0];
    free(survey);
    free(path);
    free(number);
    return status == TC_E_MEMORY && !*err.text ? tc_no_memory(talk) : status ? tc_talk_status(talk, status, &err) : -1;
}

/* A range of one value is made one around it, as tc_transfer_create would: pictures of other steps, whose own range is
 * another, name it as theirs. */
static void tc_range_widen(double range[2])
{
    const double widen = range[0] != 0 ? fabs(range[0]) / 1024 : 0.5;
    if (range[0] != range[1])
        return;
    range[0] -= widen;
    range[1] += widen;
}

int tc_batch_base_survey(tc_batch_base *base, const tc_batch_scene *scene, const int *step, size_t n, tc_talk *talk)
{
    const double start = tc_talk_clock_s();
    const tc_batch_command *look = &scene->look[0];
    const bool other = n > 1 || step[0] != base->first; /* all steps are not just the first, which is known */
    int code = -1;
    if (tc_input_is_synthetic(look->picture.input))
        return -1;
    for (size_t i = 0; i < scene->n_field && code < 0; i++) {
        const tc_pass first = {.field = i, .range = tc_any_over(scene, i, TC_OVER_FIRST, tc_range_over)};
        const tc_pass all = {
            .field = i,
            .all = true,
            .range = (other || i > 0) && tc_any_over(scene, i, TC_OVER_ALL, tc_range_over),
            .box = other && i == 0 && tc_camera_over(look) == TC_OVER_ALL,
            .unit = other && i == 0 && tc_any_over(scene, i, TC_OVER_ALL, tc_unit_over),
        };
        if (first.range && i > 0)
            code = tc_survey_run(base, scene, &first, &base->first, 1, talk);
        if (code < 0 && (all.range || all.box || all.unit))
            code = tc_survey_run(base, scene, &all, step, n, talk);
    }
    for (size_t i = 0; i < scene->n_field; i++)
        for (int k = 0; k < 2; k++)
            tc_range_widen(base->range[i][k]);
    base->ms_survey = 1e3 * (tc_talk_clock_s() - start);
    return code;
}

void tc_batch_base_finish(tc_batch_base *base)
{
    tc_loader_finish(&base->loader);
    for (size_t i = 0; base->field_name && i < base->n_field; i++)
        free(base->field_name[i]);
    free(base->field_name);
    base->field_name = NULL;
    free(base->time);
    free(base->range);
    base->time = NULL;
    base->range = NULL;
}
