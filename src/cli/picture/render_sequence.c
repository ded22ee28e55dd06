/* render_sequence.c: `render --step FROM:TO`: one picture of each step, with one function, camera and unit distance. */
#define _GNU_SOURCE
#include "cli/picture/render_sequence.h"
#include "cli/picture/render_picture.h"
#include "cli/picture/render_setup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TC_NAME_MOST = 1024 };

typedef struct tc_sequence {
    tc_render_command options; /* of the step at hand: its number, its files */
    const char *output, *error_image;
    size_t n;
    int *step;          /* [n] */
    double *time;       /* [n]; NAN where the file has no times */
    char **name;        /* [2][n] of the pictures, then of the images of errors, or NULL */
    tc_mesh *mesh;      /* of the step that was read last */
    double ms_read;     /* of it */
    tc_input_seen seen; /* how the first was come by */
    bool moved;         /* its mesh is not the one before */
    double range[2];    /* of the values of all steps */
    bool has_range;
    double ms_ranges;   /* NAN: no pass over the values */
    tc_render_run kept; /* the function, camera and look of the first step */
    tc_frames frames;
    json_t *stats, *steps;
    int failed; /* the exit code of steps that failed after they were written; -1: none did */
} tc_sequence;

static void tc_about(tc_talk *talk, int step)
{
    snprintf(talk->about, sizeof talk->about, "step %d", step);
}

static int tc_memory_fail(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* ------------------------------------------------------------------------------------------ steps and their files */

static int tc_steps_find(tc_sequence *s, const char *input, tc_talk *talk)
{
    const tc_source *source = tc_mesh_source(s->mesh);
    char why[160];
    if (!source) {
        tc_talk_error(talk, "%s is a synthetic dataset, which has no time steps: give --step no range", input);
        return TC_EXIT_USAGE;
    }
    s->n = tc_step_range_list(NULL, 0, &s->options.steps, source->n_time, why, sizeof why);
    if (s->n == 0) {
        tc_talk_error(talk, "%s %s", input, why);
        return TC_EXIT_FAILED;
    }
    s->step = calloc(s->n, sizeof *s->step);
    s->time = calloc(s->n, sizeof *s->time);
    s->name = calloc(s->n, 2 * sizeof *s->name);
    if (!s->step || !s->time || !s->name)
        return tc_memory_fail(talk);
    tc_step_range_list(s->step, s->n, &s->options.steps, source->n_time, why, sizeof why);
    for (size_t i = 0; i < s->n; i++)
        s->time[i] = source->n_time > 0 ? source->time[s->step[i]] : NAN;
    return -1;
}

static int tc_names_make(tc_sequence *s, char **out, const char *option, const char *pattern, tc_talk *talk)
{
    char name[TC_NAME_MOST], why[256];
    for (size_t i = 0; i < s->n && pattern; i++) {
        double time = isfinite(s->time[i]) ? s->time[i] : 0;
        if (!tc_step_name(name, sizeof name, pattern, s->step[i], time, why, sizeof why)) {
            tc_talk_error(talk, "%s %s: %s", option, pattern, why);
            return TC_EXIT_USAGE;
        }
        out[i] = strdup(name);
        if (!out[i])
            return tc_memory_fail(talk);
    }
    return -1;
}

static int tc_name_order(const void *a, const void *b)
{
    char *const *x = a, *const *y = b;
    return strcmp(*x, *y);
}

/* Each file its own, none the input or the statistics, in folders that are there. */
static int tc_names_check(const tc_sequence *s, tc_talk *talk)
{
    size_t n = 0;
    const char *stats = s->options.stats;
    char **all = calloc(s->n, 2 * sizeof *all);
    if (!all)
        return tc_memory_fail(talk);
    for (size_t i = 0; i < 2 * s->n; i++)
        if (s->name[i])
            all[n++] = s->name[i];
    qsort(all, n, sizeof *all, tc_name_order);
    int code = -1;
    for (size_t i = 0; i < n && code < 0; i++) {
        if (i > 0 && !strcmp(all[i], all[i - 1])) {
            tc_talk_error(talk, "two pictures would be written to %s: put {step} into the name", all[i]);
            code = TC_EXIT_USAGE;
        } else if (tc_same_file(s->options.input, all[i])) {
            tc_talk_error(talk, "%s is the input and would be written over: give --output another name", all[i]);
            code = TC_EXIT_USAGE;
        } else if (stats && tc_same_file(stats, all[i])) {
            tc_talk_error(talk, "--stats and a picture are one file, %s: give each its own", all[i]);
            code = TC_EXIT_USAGE;
        } else {
            code = tc_output_check(all[i], talk);
        }
    }
    free(all);
    return code;
}

/* ------------------------------------------------------------------------------------------ one step after the other
 */

/* The mesh takes the values of step i, or is replaced. */
static int tc_step_read(tc_sequence *s, size_t i, tc_talk *talk)
{
    s->options.source.has_step = true;
    s->options.source.step = s->step[i];
    return tc_input_step(&s->mesh, &s->moved, &s->ms_read, &s->options.source, s->options.input, talk);
}

static void tc_range_add(tc_sequence *s)
{
    tc_mesh_report report;
    tc_mesh_get_report(&report, s->mesh);
    size_t values = report.association == TC_CELL_DATA ? report.n_tet : report.n_vertex;
    if (report.nonfinite_scalars >= values)
        return;
    s->range[0] = s->has_range ? fmin(s->range[0], report.scalar_range[0]) : report.scalar_range[0];
    s->range[1] = s->has_range ? fmax(s->range[1], report.scalar_range[1]) : report.scalar_range[1];
    s->has_range = true;
}

/* The range over all steps; the mesh has the values of the first one, before and after. */
static int tc_ranges_find(tc_sequence *s, tc_talk *talk)
{
    double start = tc_talk_clock_s(), ms_read = s->ms_read;
    int code = -1;
    tc_range_add(s);
    for (size_t i = 1; i < s->n && code < 0; i++) {
        tc_about(talk, s->step[i]);
        if (talk->log.progress)
            talk->log.progress(talk->log.user, "finding the range of all steps", (double)i / (double)s->n);
        code = tc_step_read(s, i, talk);
        if (code < 0)
            tc_range_add(s);
    }
    tc_about(talk, s->step[0]);
    if (code < 0)
        code = tc_step_read(s, 0, talk);
    s->ms_read = ms_read;
    s->ms_ranges = 1e3 * (tc_talk_clock_s() - start);
    return code;
}

static int tc_stats_add(tc_sequence *s, const tc_render_run *run, size_t i, bool set_up, tc_talk *talk)
{
    if (!s->options.stats || !run->measured)
        return -1;
    if (!s->stats) {
        s->stats = tc_render_shared_json(run);
        s->steps = json_array();
    }
    json_t *step = tc_render_step_json(run, s->step[i], s->time[i], set_up);
    return json_array_append_new(s->steps, step) ? tc_memory_fail(talk) : -1;
}

/* A picture of the mesh, which holds step i. set_up: it is to be prepared. */
static int tc_step_render(tc_sequence *s, size_t i, bool set_up, tc_talk *talk, int argc, char **argv)
{
    tc_render_run run = {.options = &s->options, .ms_read = s->ms_read, .ms_write = NAN, .ms_total = NAN};
    int code = set_up ? tc_input_prepare(s->mesh, &s->options.source, talk) : -1;
    if (code >= 0)
        return code;
    s->options.output = s->name[i];
    s->options.error_image = s->name[s->n + i];
    run.mesh = s->mesh;
    if (i == 0)
        run.seen = s->seen;
    tc_mesh_get_report(&run.report, run.mesh);
    if (!set_up) /* these were measured in an earlier step */
        run.report.ms_check = run.report.ms_adjacency = run.report.ms_order = run.report.ms_convexify = NAN;
    tc_nonfinite_say(&run, talk);
    if (i == 0) {
        if (!(s->options.unit_distance > 0))
            s->options.unit_distance = tc_default_unit_distance(run.mesh);
        if (s->n == 1)
            tc_range_add(s);
    }
    run.tf = s->kept.tf;
    run.look = s->kept.look;
    run.camera = s->kept.camera;
    memcpy(run.range, s->kept.range, sizeof run.range);
    code = tc_render_setup(&run, s->has_range ? s->range : run.report.scalar_range, talk);
    s->kept.tf = run.tf;
    s->kept.look = run.look;
    s->kept.camera = run.camera;
    memcpy(s->kept.range, run.range, sizeof run.range);
    if (code < 0 && i == 0)
        code = tc_render_ready(&s->frames, talk);
    if (code < 0)
        code = tc_render_picture(&run, &s->frames, talk, argc, argv);
    int counted = tc_stats_add(s, &run, i, set_up, talk);
    if (code < 0)
        code = counted;
    if (code < 0) {
        int end = tc_render_end(&run, talk); /* what is wrong with a picture that was written stops no other */
        s->failed = s->failed < 0 ? end : s->failed;
    }
    tc_image_destroy(&run.image);
    tc_image_destroy(&run.errors);
    return code;
}

static int tc_stats_end(tc_sequence *s, tc_talk *talk)
{
    json_t *time = json_object();
    tc_json_measured(time, "ranges", s->ms_ranges);
    tc_json_measured(time, "total", 1e3 * (tc_talk_clock_s() - talk->start_s));
    json_object_set_new(s->stats, "time_ms", time);
    if (s->options.has_range || s->has_range)
        json_object_set_new(s->stats, "transfer_range",
                            tc_json_reals(s->options.has_range ? s->options.range : s->range, 2));
    tc_render_memory_json(s->stats);
    if (json_object_set(s->stats, "steps", s->steps))
        return tc_memory_fail(talk);
    return tc_json_write(s->stats, s->options.stats, talk);
}

static int tc_sequence_run(tc_sequence *s, tc_talk *talk, int argc, char **argv)
{
    int code = tc_input_open(&s->mesh, &s->seen, &s->options.source, s->options.input, talk);
    s->ms_read = s->seen.ms_read;
    if (s->mesh)
        tc_source_notes_say(s->mesh, s->options.input, talk);
    if (code < 0)
        code = tc_steps_find(s, s->options.input, talk);
    if (code < 0)
        code = tc_names_make(s, s->name, "--output", s->output, talk);
    if (code < 0)
        code = tc_names_make(s, s->name + s->n, "--error-image", s->error_image, talk);
    if (code < 0)
        code = tc_names_check(s, talk);
    if (code < 0 && s->n > 1 && !s->options.has_range)
        code = tc_ranges_find(s, talk);
    bool whole = code < 0, fresh = true;
    for (size_t i = 0; i < s->n && code < 0; i++) {
        tc_about(talk, s->step[i]);
        if (talk->log.progress)
            talk->log.progress(talk->log.user, "rendering", (double)i / (double)s->n);
        if (i > 0) {
            code = tc_step_read(s, i, talk);
            fresh = s->moved;
            if (fresh && code < 0)
                tc_talk_detail(talk, "the mesh is not that of step %d and is set up anew", s->step[i - 1]);
        }
        size_t before = json_array_size(s->steps);
        if (code < 0)
            code = tc_step_render(s, i, fresh, talk, argc, argv);
        whole = code < 0 || json_array_size(s->steps) > before;
    }
    *talk->about = 0;
    if (s->stats && whole) {
        int wrote = tc_stats_end(s, talk);
        code = code < 0 ? wrote : code;
    }
    return code < 0 ? s->failed : code;
}

int tc_render_sequence(const tc_render_command *options, tc_talk *talk, int argc, char **argv)
{
    tc_sequence s = {.options = *options,
                     .output = options->output,
                     .error_image = options->error_image,
                     .ms_ranges = NAN,
                     .failed = -1};
    s.options.source.keep_reader = true;
    s.options.source.has_step = options->steps.has_from;
    s.options.source.step = options->steps.from;
    int code = tc_frames_make(&s.frames, options, talk);
    if (code < 0)
        code = tc_sequence_run(&s, talk, argc, argv);
    for (size_t i = 0; s.name && i < 2 * s.n; i++)
        free(s.name[i]);
    free(s.name);
    free(s.step);
    free(s.time);
    json_decref(s.stats);
    json_decref(s.steps);
    tc_frames_finish(&s.frames);
    s.kept.mesh = s.mesh;
    tc_render_close(&s.kept);
    return code;
}
