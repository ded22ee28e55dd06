/* frames.c: every frame of a batch: its camera and its file. */
#define _GNU_SOURCE
#include "cli/batch/frames.h"
#include "cli/picture/render_view.h"
#include "cli/picture/stereo_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { TC_PATH_ROOM = 4096 };

static int tc_no_memory(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* ------------------------------------------------------------------------------------------------------------ plan */

/* The ranges that --step and --time stand for. A time beyond all of them is told, as the readers do. */
static void tc_ranges_of(tc_plan_ranges *out, const tc_batch_base *base, const tc_batch_command *look, tc_talk *talk)
{
    const tc_render_command *o = &look->picture;
    tc_plan_range range = {.stride = 1};
    *out = look->frames;
    if (o->steps.there) {
        range.has_from = o->steps.has_from;
        range.has_to = o->steps.has_to;
        range.from = o->steps.from;
        range.to = o->steps.to;
        range.stride = o->steps.stride;
    } else if (o->source.has_step) {
        range.one = range.has_from = true;
        range.from = o->source.step;
    } else if (o->source.has_time) { /* at or before it, as the readers have it */
        range.one = range.has_from = true;
        for (size_t i = 0; i < base->n_step; i++)
            if (base->time[i] <= o->source.time)
                range.from = (long long)i;
        const double asked = o->source.time, taken = base->time[range.from];
        if (asked < base->time[0] || asked > base->time[base->n_step - 1])
            tc_talk_say(talk, "time %g lies %s step; the step at %g is shown", asked,
                        asked < taken ? "before the first" : "after the last", taken);
    } else {
        return;
    }
    out->n = 1;
    out->range[0] = range;
}

int tc_batch_plan(tc_batch_frames *out, const tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk)
{
    char why[256];
    tc_plan_ranges ranges;
    const tc_batch_command *look = &scene->look[0];
    tc_ranges_of(&ranges, base, look, talk);
    const tc_plan_options options = {
        .n_time = base->stepped || scene->series.of_files ? base->n_step : 0,
        .ranges = ranges.n > 0 ? &ranges : NULL,
        .n_field = scene->n_field,
        .n_function = scene->n_function,
        .n_view = scene->views.along ? 1 : tc_views_count(&scene->views, 0),
        .along = scene->views.along,
        .shard = look->shard,
    };
    *out = (tc_batch_frames){0};
    if (!tc_plan_make(&out->plan, &options, why, sizeof why)) {
        tc_talk_error(talk, "%s %s", look->picture.input, why);
        return TC_EXIT_FAILED;
    }
    return scene->views.along ? tc_views_check(&scene->views, out->plan.n_step, talk) : -1;
}

/* ----------------------------------------------------------------------------------------------------------- views */

int tc_batch_view_camera(tc_camera *out, const tc_batch_frames *frames, const tc_batch_scene *scene, size_t view,
                         const double bounds[6], tc_talk *talk)
{
    const tc_render_command *o = &scene->look[0].picture;
    tc_camera base = {0};
    int code = tc_render_camera(&base, o, bounds, talk);
    if (code >= 0)
        return code;
    *out = base;
    if (scene->views.kind == TC_VIEWS_NONE)
        return -1;
    return tc_view_camera(out, NULL, NULL, &scene->views, view, frames->plan.n_step, &base, bounds,
                          (double)o->size.width / o->size.height, talk);
}

static int tc_views_make(tc_batch_frames *f, const tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk)
{
    const tc_render_command *o = &scene->look[0].picture;
    const tc_views *views = &scene->views;
    tc_camera camera = {0};
    f->n_view = views->kind == TC_VIEWS_NONE ? 1 : tc_views_count(views, f->plan.n_step);
    f->view = calloc(f->n_view, sizeof *f->view);
    int code = f->view ? tc_render_camera(&camera, o, base->bounds, talk) : tc_no_memory(talk);
    for (size_t i = 0; i < f->n_view && code < 0; i++) {
        tc_batch_view *view = &f->view[i];
        *view = (tc_batch_view){.camera = camera, .phi = NAN, .theta = NAN};
        if (views->kind == TC_VIEWS_NONE) {
            view->phi = view->theta = 0;
            snprintf(view->name, sizeof view->name, "view");
            continue;
        }
        tc_view_name(view->name, sizeof view->name, views, i);
        code = tc_view_camera(&view->camera, &view->phi, &view->theta, views, i, f->plan.n_step, &camera, base->bounds,
                              (double)o->size.width / o->size.height, talk);
    }
    return code;
}

size_t tc_batch_view_of(const tc_batch_frames *frames, const tc_plan_frame *place)
{
    return frames->plan.along ? place->position : place->view;
}

/* ----------------------------------------------------------------------------------------------------------- names */

tc_name_values tc_batch_values(const tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene,
                               size_t frame)
{
    const tc_plan_frame place = tc_plan_frame_at(&frames->plan, frame);
    const tc_batch_view *view = &frames->view[tc_batch_view_of(frames, &place)];
    return (tc_name_values){
        .time = isfinite(base->time[place.step]) ? base->time[place.step] : place.step,
        .step = place.step,
        .frame = (long long)frame,
        .number = (long long)place.position,
        .phi = view->phi,
        .theta = view->theta,
        .view = view->name,
        .tf = scene->function[place.function],
        .field = base->field_name[place.field],
    };
}

/* What tells the frames apart, where no name is given. */
static char *tc_default_pattern(const tc_batch_frames *f, const tc_batch_scene *scene)
{
    char stem[480], safe[960], *out = NULL;
    size_t n = 0;
    tc_input_stem(stem, sizeof stem, scene->path ? scene->path : scene->series.path[0]);
    for (const char *c = stem; *c && n + 2 < sizeof safe; c++) { /* no placeholders in it */
        safe[n++] = *c;
        if (*c == '{' || *c == '}' || *c == '%')
            safe[n++] = *c;
    }
    safe[n] = 0;
    const bool degrees = scene->views.kind == TC_VIEWS_GRID || scene->views.kind == TC_VIEWS_ORBIT;
    if (asprintf(&out, "%s%s%s%s%s.png", safe, f->plan.n_step > 1 ? "_{step:04d}" : "",
                 f->plan.n_field > 1 ? "_{field}" : "", f->plan.n_function > 1 ? "_{tf}" : "",
                 f->plan.n_view < 2 ? ""
                 : degrees          ? "_{phi}_{theta}"
                                    : "_{view}") < 0)
        return NULL;
    return out;
}

/* The Cinema database's folder: the one that the pattern names, else STEM.cdb before the first part that differs between
 * pictures; the pattern then leads into it. -1, or the exit code of an error that was printed. */
static int tc_database_place(tc_batch_frames *f, const tc_batch_scene *scene, tc_talk *talk)
{
    char stem[480], why[256] = "", cdb[TC_PATH_ROOM], *pattern = NULL;
    for (char *c = f->pattern; (c = strcasestr(c, ".cdb/")) != NULL; c++) {
        if (c == f->pattern || c[-1] == '/')
            continue;
        const tc_name_values none = {0};
        char *named = strndup(f->pattern, (size_t)(c - f->pattern) + 4);
        const bool several = named && tc_name_uses(named, why, sizeof why) != 0;
        const bool good = named && !several && tc_name_make(cdb, sizeof cdb, named, &none, why, sizeof why);
        free(named);
        if (good && (f->cdb = strdup(cdb)) != NULL)
            return -1;
        if (good || !named)
            return tc_no_memory(talk);
        tc_talk_error(talk, "--output %s: %s", f->pattern,
                      several ? "all pictures are of one database: put what differs behind .cdb/" : why);
        return TC_EXIT_USAGE;
    }
    tc_input_stem(stem, sizeof stem, scene->path ? scene->path : scene->series.path[0]);
    for (char *c = stem; *c; c++)
        *c = strchr("{}%", *c) ? '_' : *c;
    int folder = (int)strcspn(f->pattern, "{}%");
    while (folder > 0 && f->pattern[folder - 1] != '/')
        folder--;
    if (asprintf(&f->cdb, "%.*s%s.cdb", folder, f->pattern, stem) < 0) {
        f->cdb = NULL;
        return tc_no_memory(talk);
    }
    if (asprintf(&pattern, "%s/%s", f->cdb, f->pattern + folder) < 0)
        return tc_no_memory(talk);
    free(f->pattern);
    f->pattern = pattern;
    return -1;
}

/* A dimension with several values that the names do not tell; NULL: none. */
static const char *tc_untold(const tc_batch_frames *f, const tc_batch_scene *scene, unsigned uses)
{
    const tc_plan *p = &f->plan;
    if (uses & TC_NAME_FRAME)
        return NULL;
    if (p->n_step > 1 && !(uses & (TC_NAME_STEP | TC_NAME_TIME | TC_NAME_NUMBER)))
        return "{step:04d}";
    if (p->n_field > 1 && !(uses & TC_NAME_FIELD))
        return "{field}";
    if (p->n_function > 1 && !(uses & TC_NAME_TF))
        return "{tf}";
    if (p->n_view > 1 && !(uses & (TC_NAME_VIEW | TC_NAME_PHI | TC_NAME_THETA)))
        return scene->views.kind == TC_VIEWS_GRID ? "{phi}_{theta}" : "{view}";
    if (p->n_view > 1 && scene->views.kind == TC_VIEWS_GRID && !(uses & TC_NAME_VIEW)) {
        if (scene->views.n_phi > 1 && !(uses & TC_NAME_PHI))
            return "{phi}";
        if (scene->views.n_theta > 1 && !(uses & TC_NAME_THETA))
            return "{theta}";
    }
    return NULL;
}

char *tc_batch_eye_file(const tc_batch_frames *f, const tc_batch_base *base, const tc_batch_scene *scene, size_t frame,
                        int eye)
{
    static const char *const side[] = {"left", "right"};
    char name[TC_PATH_ROOM], both[TC_PATH_ROOM], why[256];
    tc_name_values values = tc_batch_values(f, base, scene, frame);
    values.eye = side[eye];
    if (!tc_name_make(name, sizeof name, f->pattern, &values, why, sizeof why))
        return NULL;
    if (tc_name_uses(f->pattern, why, sizeof why) & TC_NAME_EYE)
        return strdup(name);
    return tc_stereo_name(both, sizeof both, name, eye) ? strdup(both) : NULL;
}

static int tc_name_order(const void *a, const void *b)
{
    const char *const *x = a, *const *y = b;
    return strcmp(*x, *y);
}

/* No two frames have one file. */
static int tc_names_apart(const tc_batch_frames *f, tc_talk *talk)
{
    const size_t n = f->plan.n;
    const char **all = malloc(n * sizeof *all);
    int code = all ? -1 : tc_no_memory(talk);
    for (size_t i = 0; i < n && all; i++)
        all[i] = f->frame[i].file;
    if (all)
        qsort(all, n, sizeof *all, tc_name_order);
    for (size_t i = 1; i < n && code < 0; i++)
        if (!strcmp(all[i], all[i - 1])) {
            tc_talk_error(talk, "two pictures would be written to %s: put {frame} into --output, or more digits, or other "
                                "names of views and functions",
                          all[i]);
            code = TC_EXIT_USAGE;
        }
    free(all);
    return code;
}

static int tc_names_make(tc_batch_frames *f, const tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk)
{
    char name[TC_PATH_ROOM], why[256] = "";
    const tc_render_command *o = &scene->look[0].picture;
    const bool pair = o->out.stereo == TC_STEREO_PAIR; /* of which the left eye's stands for both */
    const unsigned uses = tc_name_uses(f->pattern, why, sizeof why);
    const char *untold = *why ? NULL : tc_untold(f, scene, uses);
    if (untold) {
        tc_talk_error(talk, "--output %s: pictures would have one name: put %s into it", f->pattern, untold);
        return TC_EXIT_USAGE;
    }
    f->frame = calloc(f->plan.n, sizeof *f->frame);
    if (!f->frame)
        return tc_no_memory(talk);
    for (size_t i = 0; i < f->plan.n; i++) {
        tc_name_values values = tc_batch_values(f, base, scene, i);
        values.eye = pair ? "left" : NULL;
        if (*why || !tc_name_make(name, sizeof name, f->pattern, &values, why, sizeof why)) {
            tc_talk_error(talk, "--output %s: %s", f->pattern, why);
            return TC_EXIT_USAGE;
        }
        f->frame[i].file = pair ? tc_batch_eye_file(f, base, scene, i, 0) : strdup(name);
        if (!f->frame[i].file)
            return tc_no_memory(talk);
        f->frame[i].state = tc_plan_mine(&f->plan, i) ? TC_STATE_TO_DO : TC_STATE_OTHER;
        if ((o->scene_path && tc_same_file(o->scene_path, name)) || tc_same_file(o->input, name)) {
            tc_talk_error(talk, "%s is the input and would be written over: give --output another name", name);
            return TC_EXIT_USAGE;
        }
    }
    return tc_names_apart(f, talk);
}

int tc_batch_frames_make(tc_batch_frames *f, const tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk)
{
    const tc_batch_command *look = &scene->look[0];
    int code = tc_views_make(f, base, scene, talk);
    if (code >= 0)
        return code;
    f->pattern = look->picture.output ? strdup(look->picture.output) : tc_default_pattern(f, scene);
    if (!f->pattern)
        return tc_no_memory(talk);
    code = tc_output_kind_check(f->pattern, talk);
    char why[160] = "";
    if (code < 0)
        tc_output_wrong(why, &look->picture.out, f->pattern);
    if (*why)
        code = tc_given_refuse(&look->picture.given, talk, "--bits", NULL, "%s: %s", f->pattern, why);
    if (code < 0 && look->cinema)
        code = tc_database_place(f, scene, talk);
    return code < 0 ? tc_names_make(f, base, scene, talk) : code;
}

void tc_batch_frames_finish(tc_batch_frames *f)
{
    for (size_t i = 0; f->frame && i < f->plan.n; i++)
        free(f->frame[i].file);
    free(f->frame);
    free(f->view);
    free(f->pattern);
    free(f->cdb);
    tc_plan_finish(&f->plan);
    *f = (tc_batch_frames){0};
}
