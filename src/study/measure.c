/* measure.c: one view of one scene under every setting: errors from one counted frame each, then times of frames that
 * are interleaved over the settings. */
#include "study/study.h"

#include "core/memory.h"
#include "mesh/mesh.h"
#include "study/judge.h"
#include "study/summary.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double SLOW_TABLE_MS = 150; /* a table that takes longer is built once for all frames of its setting */

/* One setting in one view. */
typedef struct task {
    size_t setting;
    tc_render_options options;
    tc_study_row row;
    double *ms; /* [frames] */
    int timed;
    bool failed, slow, kept;
} task;

typedef struct view {
    tc_study *study;
    const tc_study_pair *pair;
    tc_camera camera;
    tc_judge *judge;
    int index;
    size_t n;
    task *task; /* [n] */
    size_t steps, steps_done;
} view;

static void report_progress(view *v)
{
    char what[128];
    const tc_study *s = v->study;
    double inside = v->steps ? (double)++v->steps_done / (double)v->steps : 1;
    double scene = (v->index + inside) / s->options.views;
    snprintf(what, sizeof what, "%s, %s, view %d of %d", v->pair->scene, v->pair->function, v->index + 1,
             s->options.views);
    tc_progress(s->log, what, s->options.n_scene > 0 ? (s->done + scene) / s->options.n_scene : scene);
}

static const char *samples_text(int samples)
{
    return samples == TC_SAMPLES_ADAPTIVE ? "adaptive" : samples == 4 ? "4" : samples == 16 ? "16" : "1";
}

static void fill_row(tc_study_row *row, const tc_render_stats *s, const tc_mesh *mesh)
{
    row->bytes_table = s->gpu_bytes_table >= 0 ? s->gpu_bytes_table : NAN;
    row->bytes_state = s->gpu_bytes_state >= 0 ? s->gpu_bytes_state : NAN;
    row->steps = s->steps;
    row->rays = s->rays;
    row->rays_lost = s->rays_lost;
    row->steps_per_ray = s->steps >= 0 && s->rays > 0 ? (double)s->steps / (double)s->rays : NAN;
    row->fragments = s->n_fragments_per_pass ? 0 : -1;
    for (size_t i = 0; i < s->n_fragments_per_pass; i++)
        row->fragments += s->fragments_per_pass[i];
    row->passes = s->passes;
    row->z_updates = s->z_updates;
    row->steps_per_pass = s->steps_per_pass;
    row->z_update_every = s->z_update_every;
    row->integral_order = s->integral_order;
    row->state_bits = s->state_bits;
    row->opacity_stop = s->opacity_stop;
    snprintf(row->integrator, sizeof row->integrator, "%s", s->integrator);
    snprintf(row->driver, sizeof row->driver, "%s", s->driver);
    snprintf(row->stepper, sizeof row->stepper, "%s", s->stepper);
    snprintf(row->samples, sizeof row->samples, "%s", samples_text(s->samples));
    if (strcmp(s->driver, "reference") != 0)
        snprintf(row->reentry, sizeof row->reentry, "%s",
                 mesh->report.reentry == TC_REENTRY_PEEL ? "peel" : "convexify");
}

/* The counted frame: what a setting does, and how far it is from the truth. What a setting cannot do is noted. */
static tc_status judge(view *v, task *t, tc_error *err)
{
    tc_renderer *renderer = NULL;
    tc_image *image = NULL;
    tc_render_stats stats;
    tc_error why = {0};
    const tc_study_change *change = &tc_study_changes[t->setting];
    tc_status status = tc_study_renderer(&renderer, v->study, change->reference, err);
    if (status != TC_OK)
        return status;
    t->options.count = true;
    status = tc_render(&image, &stats, renderer, v->pair->mesh, v->pair->tf, &v->camera, &t->options, &v->study->quiet,
                       &why);
    t->options.count = false;
    if (status == TC_OK || status == TC_E_LOST) {
        fill_row(&t->row, &stats, v->pair->mesh);
        t->slow = stats.ms_table > SLOW_TABLE_MS;
        if (status == TC_E_LOST)
            snprintf(t->row.note, sizeof t->row.note, "%lld rays were lost", (long long)stats.rays_lost);
        status = change->samples ? tc_judge_area(&t->row, v->judge, image, err)
                                 : tc_judge_ray(&t->row, v->judge, image, err);
        if (change->reference && status == TC_OK) { /* seconds a frame: one tells enough */
            t->ms[t->timed++] = stats.ms_frame;
            t->slow = true;
        }
    } else {
        snprintf(t->row.note, sizeof t->row.note, "%.180s", why.text);
        t->failed = true;
        if (t->setting == 0) /* what cannot be rendered at all */
            status = tc_fail(err, status, "%s", why.text);
        else
            status = TC_OK;
    }
    tc_image_destroy(&image);
    return status;
}

/* One frame more, timed or not. A setting that lost rays before may do so again. */
static tc_status frame(view *v, task *t, bool timed, tc_error *err)
{
    tc_renderer *renderer = NULL;
    tc_image *image = NULL;
    tc_render_stats stats;
    tc_status status = tc_study_renderer(&renderer, v->study, false, err);
    if (status != TC_OK)
        return status;
    status =
        tc_render(&image, &stats, renderer, v->pair->mesh, v->pair->tf, &v->camera, &t->options, &v->study->quiet, err);
    tc_image_destroy(&image);
    if (status == TC_E_LOST)
        status = TC_OK;
    if (status == TC_OK && timed)
        t->ms[t->timed++] = stats.ms_frame;
    return status;
}

/* Does setting k belong to the phase in which gaps are crossed in this way? */
static bool in_phase(size_t k, tc_reentry reentry)
{
    return tc_study_changes[k].reentry == reentry;
}

static tc_status time_tasks(view *v, tc_reentry phase, tc_error *err)
{
    const int frames = v->study->options.frames;
    tc_status status = TC_OK;
    for (int f = 0; f < frames && status == TC_OK; f++)
        for (size_t i = 0; i < v->n && status == TC_OK; i++) {
            task *t = &v->task[i];
            if (t->failed || t->kept || !in_phase(t->setting, phase) || tc_study_changes[t->setting].reference ||
                (t->slow && f > 0))
                continue;
            status = frame(v, t, false, err); /* programs and tables, and what the one before left in the caches */
            do
                status = status == TC_OK ? frame(v, t, true, err) : status;
            while (status == TC_OK && t->slow && t->timed < frames);
            report_progress(v);
        }
    return status;
}

static tc_status keep_rows(view *v, tc_reentry phase, tc_error *err)
{
    tc_status status = TC_OK;
    for (size_t i = 0; i < v->n && status == TC_OK; i++) {
        task *t = &v->task[i];
        if (t->kept || !in_phase(t->setting, phase))
            continue;
        if (t->timed > 0) {
            t->row.frames = t->timed;
            t->row.ms_median = tc_median(t->ms, (size_t)t->timed); /* sorts */
            t->row.ms_min = t->ms[0];
            t->row.ms_max = t->ms[t->timed - 1];
        }
        t->kept = true;
        status = tc_study_keep(v->study, &t->row, err);
    }
    return status;
}

/* All settings of one way across gaps. */
static tc_status run_phase(view *v, tc_reentry phase, tc_error *err)
{
    tc_status status = TC_OK;
    for (size_t i = 0; i < v->n && status == TC_OK; i++)
        if (!v->task[i].kept && !v->task[i].failed && in_phase(v->task[i].setting, phase)) {
            status = judge(v, &v->task[i], err);
            report_progress(v);
        }
    if (status == TC_OK)
        status = time_tasks(v, phase, err);
    return status == TC_OK ? keep_rows(v, phase, err) : status;
}

/* The same with gaps prepared in that way, and then as they were. */
static tc_status run_reentry(view *v, tc_reentry reentry, tc_error *err)
{
    tc_mesh *mesh = v->pair->mesh;
    const tc_prepare_options before = {.reentry = mesh->asked, .threads = v->study->options.threads},
                             wanted = {.reentry = reentry, .threads = v->study->options.threads};
    tc_error why = {0};
    size_t first = 0;
    while (first < v->n && (v->task[first].kept || !in_phase(v->task[first].setting, reentry)))
        first++;
    if (first == v->n)
        return TC_OK;
    tc_status status = mesh->report.convex ? TC_E_ARG : tc_mesh_prepare(mesh, &wanted, &v->study->quiet, &why);
    if (status == TC_OK) {
        status = run_phase(v, reentry, err);
    } else {
        snprintf(v->task[first].row.note, sizeof v->task[first].row.note, "%.180s",
                 mesh->report.convex ? "the mesh is convex: it has no gaps" : why.text);
        v->task[first].failed = true;
        status = keep_rows(v, reentry, err);
    }
    if (!mesh->report.convex) {
        tc_status back = tc_mesh_prepare(mesh, &before, &v->study->quiet, status == TC_OK ? err : NULL);
        status = status == TC_OK ? back : status;
    }
    return status;
}

static void init_task(task *t, const view *v, size_t setting, double *ms)
{
    size_t n;
    const tc_study_setting *s = &tc_study_settings(&n)[setting];
    t->setting = setting;
    t->ms = ms;
    tc_study_base(&t->options, &v->study->options);
    tc_study_apply(&t->options, setting);
    tc_study_row_clear(&t->row);
    memcpy(t->row.scene, v->pair->scene, sizeof t->row.scene);
    memcpy(t->row.function, v->pair->function, sizeof t->row.function);
    t->row.view = v->index;
    tc_study_view(&t->row.azimuth, &t->row.elevation, v->index);
    t->row.knob = s->knob;
    t->row.setting = s->name;
}

tc_status tc_study_measure(tc_study *study, const tc_study_pair *pair, int index, tc_error *err)
{
    view v = {.study = study, .pair = pair, .index = index};
    const size_t frames = (size_t)study->options.frames;
    double azimuth, elevation;
    tc_render_options base;
    v.task = tc_calloc(TC_STUDY_SETTINGS, sizeof *v.task);
    double *ms = tc_calloc(TC_STUDY_SETTINGS * frames, sizeof *ms);
    if (!v.task || !ms) {
        free(v.task);
        free(ms);
        return tc_fail_memory(err, "the times of a view", TC_STUDY_SETTINGS * frames, sizeof *ms);
    }
    for (size_t k = 0; k < TC_STUDY_SETTINGS; k++)
        if (study->on[k] && !tc_study_changes[k].figure &&
            !tc_study_has_row(study, pair->scene, pair->function, index, k)) {
            init_task(&v.task[v.n], &v, k, ms + v.n * frames);
            v.n++;
        }
    v.steps = v.n * (frames + 1);
    tc_study_view(&azimuth, &elevation, index);
    tc_study_camera(&v.camera, pair->mesh, &study->options, azimuth, elevation);
    tc_study_base(&base, &study->options);
    const tc_judge_view judged = {.mesh = pair->mesh,
                                  .tf = pair->tf,
                                  .camera = &v.camera,
                                  .options = &base,
                                  .n = study->options.verify,
                                  .seed = study->options.seed,
                                  .threads = study->options.threads,
                                  .log = &study->quiet};
    tc_status status = tc_judge_create(&v.judge, &judged, err);
    if (status == TC_OK)
        status = run_phase(&v, TC_REENTRY_AUTO, err);
    if (status == TC_OK)
        status = run_reentry(&v, TC_REENTRY_CONVEXIFY, err);
    if (status == TC_OK)
        status = run_reentry(&v, TC_REENTRY_PEEL, err);
    tc_judge_destroy(&v.judge);
    free(v.task);
    free(ms);
    return status;
}
