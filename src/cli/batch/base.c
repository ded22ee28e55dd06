/* base.c: what all frames of a batch have in common. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/base.h"
#include "cli/picture/render_setup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

int tc_batch_base_open(tc_batch_base *out, const tc_batch_scene *scene, tc_talk *talk)
{
    *out = (tc_batch_base){.ms_survey = NAN};
    const tc_render_command *first = &scene->look[0].picture;
    tc_load load = tc_batch_load(out, scene, 0, 0);
    int code = tc_loader_open(&out->loader, &first->source, &load, talk);
    if (code < 0)
        tc_source_notes_say(out->loader.mesh, load.path, talk);
    if (code < 0)
        code = tc_times_take(out, scene, talk);
    out->range = code < 0 ? calloc(scene->n_field, sizeof *out->range) : NULL;
    if (code >= 0 || !out->range)
        return code < 0 ? tc_no_memory(talk) : code;
    if (out->stepped)
        out->loader.last.step = 0;
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
    out->unit = tc_default_unit_distance(out->loader.mesh);
    for (size_t i = 0; i < scene->n_field; i++) {
        out->range[i][0] = INFINITY;
        out->range[i][1] = -INFINITY;
    }
    memcpy(out->range[0], report.scalar_range, sizeof out->range[0]);
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

static void tc_survey_add(tc_batch_base *base, const tc_survey *survey, size_t field, bool range, bool box)
{
    if (survey->status != TC_OK)
        return;
    if (range && survey->range[0] <= survey->range[1]) {
        base->range[field][0] = fmin(base->range[field][0], survey->range[0]);
        base->range[field][1] = fmax(base->range[field][1], survey->range[1]);
    }
    const double *b = survey->bounds;
    for (int i = 0; box && i < 6; i++)
        base->bounds[i] = i % 2 ? fmax(base->bounds[i], b[i]) : fmin(base->bounds[i], b[i]);
    const double diagonal = hypot(hypot(b[1] - b[0], b[3] - b[2]), b[5] - b[4]);
    if (box && survey->source_cells > 0)
        base->unit = fmax(base->unit, diagonal / cbrt((double)survey->source_cells));
}

/* One pass over the steps with one field. */
static int tc_survey_run(tc_batch_base *base, const tc_batch_scene *scene, size_t field, const int *step, size_t n,
                         bool range, bool box, tc_talk *talk)
{
    tc_error err = {0};
    tc_survey *survey = calloc(n, sizeof *survey);
    const char **path = calloc(n, sizeof *path);
    int *number = calloc(n, sizeof *number);
    tc_status status = survey && path && number ? TC_OK : TC_E_MEMORY;
    tc_input_options source = scene->look[field * scene->n_function].picture.source;
    source.has_step = source.has_time = false;
    const tc_read_options read = tc_input_read_options(&source);
    for (size_t i = 0; i < n && status == TC_OK; i++) {
        const tc_load load = tc_batch_load(base, scene, step[i], field);
        path[i] = load.path;
        number[i] = load.step;
    }
    if (status == TC_OK)
        status = base->stepped ? tc_mesh_survey(survey, number, n, path[0], &read, &talk->log, &err)
                               : tc_mesh_survey_files(survey, path, n, &read, &talk->log, &err);
    for (size_t i = 0; i < n && status == TC_OK; i++)
        tc_survey_add(base, &survey[i], field, range, box);
    free(survey);
    free(path);
    free(number);
    return status == TC_E_MEMORY && !*err.text ? tc_no_memory(talk) : status ? tc_talk_status(talk, status, &err) : -1;
}

int tc_batch_base_survey(tc_batch_base *base, const tc_batch_scene *scene, const int *step, size_t n, tc_talk *talk)
{
    const double start = tc_talk_clock_s();
    const tc_batch_command *look = &scene->look[0];
    const bool several = n > 1 && !tc_input_is_synthetic(look->picture.input);
    const bool box = several && (tc_unit_over(look) == TC_OVER_ALL || tc_camera_over(look) == TC_OVER_ALL);
    int code = -1;
    for (size_t i = 0; i < scene->n_field && code < 0; i++) {
        const bool all = several && tc_any_over(scene, i, TC_OVER_ALL, tc_range_over);
        const bool range = all || (i > 0 && !tc_input_is_synthetic(look->picture.input) &&
                                   (tc_any_over(scene, i, TC_OVER_FIRST, tc_range_over) ||
                                    tc_any_over(scene, i, TC_OVER_ALL, tc_range_over)));
        static const int first = 0;
        if (all && i == 0 && step[0] != 0) { /* the first step may not be among them */
            base->range[0][0] = INFINITY;
            base->range[0][1] = -INFINITY;
        }
        if (range || (box && i == 0))
            code = tc_survey_run(base, scene, i, all || box ? step : &first, all || box ? n : 1, range, box && i == 0,
                                 talk);
    }
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
