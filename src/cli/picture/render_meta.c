/* render_meta.c: the metadata that a picture carries, so that it can be made again. */
#define _GNU_SOURCE
#include "cli/picture/render_choose.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *tc_run_field(const tc_render_run *run)
{
    const tc_source *source = tc_mesh_source(run->mesh);
    return source ? (source->field ? source->field : "") : "field"; /* a synthetic dataset has the one */
}

double tc_run_unit_distance(const tc_render_run *run)
{
    return run->options->unit_distance > 0 ? run->options->unit_distance : tc_default_unit_distance(run->mesh);
}

/* One word of a shell's command line, quoted where it must be. */
static void tc_word_put(FILE *stream, const char *word)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
    if (*word && strspn(word, plain) == strlen(word)) {
        fputs(word, stream);
        return;
    }
    fputc('\'', stream);
    for (; *word; word++)
        if (*word == '\'')
            fputs("'\\''", stream);
        else
            fputc(*word, stream);
    fputc('\'', stream);
}

static char *tc_command_text(int argc, char **argv)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return NULL;
    fputs("tetcast", stream);
    for (int i = 0; i < argc; i++) {
        fputc(' ', stream);
        tc_word_put(stream, argv[i]);
    }
    fclose(stream);
    return text;
}

static char *tc_compact(json_t *json)
{
    char *text = json_dumps(json, JSON_COMPACT | JSON_REAL_PRECISION(9));
    json_decref(json);
    return text;
}

static char *tc_camera_text(const tc_camera *camera)
{
    json_t *json = json_object();
    json_object_set_new(json, "position", tc_json_reals(camera->position, 3));
    json_object_set_new(json, "focal_point", tc_json_reals(camera->focal_point, 3));
    json_object_set_new(json, "view_up", tc_json_reals(camera->view_up, 3));
    if (camera->parallel)
        tc_json_real(json, "parallel_scale", camera->parallel_scale);
    else
        tc_json_real(json, "view_angle", camera->view_angle);
    const double clip[2] = {camera->clip_near, camera->clip_far};
    if (camera->clip_far > 0)
        json_object_set_new(json, "clipping_range", tc_json_reals(clip, 2));
    if (camera->window_center[0] != 0 || camera->window_center[1] != 0)
        json_object_set_new(json, "window_center", tc_json_reals(camera->window_center, 2));
    return tc_compact(json);
}

static char *tc_transfer_text(const tc_render_run *run)
{
    json_t *json = json_object(), *list = json_array();
    size_t n = 0;
    const tc_knot *knot = tc_transfer_knots(run->tf, &n);
    tc_json_text(json, "name", tc_transfer_name(run->tf));
    tc_json_text(json, "opacity", run->options->opacity);
    json_object_set_new(json, "log", json_boolean(run->options->log));
    tc_json_real(json, "unit_distance", tc_run_unit_distance(run));
    if (run->options->nan_color.there)
        json_object_set_new(json, "nan_color", tc_json_reals(run->options->nan_color.rgba, 4));
    for (size_t i = 0; i < n; i++) {
        double row[5] = {knot[i].s, knot[i].r, knot[i].g, knot[i].b, knot[i].a};
        json_array_append_new(list, tc_json_reals(row, 5));
    }
    json_object_set_new(json, "knots", list);
    return tc_compact(json);
}

/* What was done to the data, one sentence after another; NULL when nothing is to be said. */
static char *tc_notes_text(const tc_render_run *run)
{
    const tc_source *source = tc_mesh_source(run->mesh);
    const tc_mesh_report *report = &run->report;
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return NULL;
    if (source && source->linearised) {
        fputs("quadratic cells were linearised", stream);
        if (source->refine)
            fprintf(stream, " after %d levels of refinement", source->refine);
        fputs("; ", stream);
    }
    if (source && source->dropped_cells)
        fprintf(stream, "%zu cells were left out; ", source->dropped_cells);
    if (report->dropped_degenerate)
        fprintf(stream, "%zu cells that repeat a point were dropped; ", report->dropped_degenerate);
    if (report->reoriented)
        fprintf(stream, "%zu inverted cells were turned; ", report->reoriented);
    if (report->nonfinite_scalars)
        fprintf(stream, "%zu values are not finite; ", report->nonfinite_scalars);
    for (size_t i = 0; source && i < source->n_note; i++)
        fprintf(stream, "%s; ", source->note[i]);
    if (*report->reentry_why)
        fprintf(stream, "%s; ", report->reentry_why);
    fclose(stream);
    if (text && size >= 2)
        text[size - 2] = 0;
    if (text && !*text) {
        free(text);
        text = NULL;
    }
    return text;
}

/* The time step's number and time; NULL when the file has none. */
static char *tc_step_text(const tc_render_run *run)
{
    const tc_source *source = tc_mesh_source(run->mesh);
    if (!source || source->step < 0 || (size_t)source->step >= source->n_time)
        return NULL;
    json_t *json = json_object();
    json_object_set_new(json, "step", json_integer(source->step));
    tc_json_real(json, "time", source->time[source->step]);
    return tc_compact(json);
}

static char *tc_verify_text(const tc_verify_result *verify)
{
    json_t *json = json_object();
    tc_json_count(json, "pixels", verify->pixels);
    tc_json_count(json, "ill_posed", verify->ill_posed);
    tc_json_count(json, "pixels_all", verify->n_all);
    tc_json_measured(json, "max_abs_error", verify->max_abs_error);
    tc_json_measured(json, "p9999_abs_error", verify->p9999_abs_error);
    tc_json_measured(json, "p999_abs_error", verify->p999_abs_error);
    tc_json_measured(json, "mean_abs_error", verify->mean_abs_error);
    tc_json_measured(json, "confidence", verify->confidence);
    tc_json_measured(json, "unseen_share", verify->unseen_share);
    tc_json_measured_count(json, "rays_lost", verify->rays_lost);
    return tc_compact(json);
}

void tc_meta_add(tc_meta *meta, const char *key, char *owned)
{
    if (!owned)
        return;
    meta->owned[meta->n] = owned;
    meta->pair[meta->n] = (tc_text_pair){key, owned};
    meta->n++;
}

void tc_meta_make(tc_meta *out, const tc_render_run *run, int argc, char **argv)
{
    const char *field = tc_run_field(run);
    memset(out, 0, sizeof *out);
    tc_meta_add(out, "tetcast:version", strdup(tc_version()));
    tc_meta_add(out, "tetcast:command", tc_command_text(argc, argv));
    tc_meta_add(out, "tetcast:scene", tc_scene_text(run));
    tc_meta_add(out, "tetcast:frame", run->frame_text ? strdup(run->frame_text) : NULL);
    tc_meta_add(out, "tetcast:camera", tc_camera_text(&run->camera));
    tc_meta_add(out, "tetcast:transfer_function", tc_transfer_text(run));
    tc_meta_add(out, "tetcast:field", *field ? strdup(field) : NULL);
    tc_meta_add(out, "tetcast:step", tc_step_text(run));
    tc_meta_add(out, "tetcast:notes", tc_notes_text(run));
    tc_meta_add(out, "tetcast:choice", run->chosen ? tc_compact(tc_choice_json(run)) : NULL);
    tc_meta_add(out, "tetcast:verify", run->verified ? tc_verify_text(&run->verify) : NULL);
}

void tc_meta_finish(tc_meta *meta)
{
    for (size_t i = 0; i < meta->n; i++)
        free(meta->owned[i]);
    meta->n = 0;
}
