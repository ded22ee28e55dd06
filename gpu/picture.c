/* picture.c: makes a picture of one frame of rays (Weiler et al. 2003, 5.2), or of several. */
#include "gpu/picture.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "gpu/accumulate.h"
#include "gpu/audit.h"
#include "gpu/effect.h"
#include "gpu/first_hit.h"
#include "gpu/kept.h"
#include "scene/samples.h"

#include <stdlib.h>
#include <string.h>

enum { GROUP = 4 }; /* pixels along a side of what llvmpipe shades at once */

/* The smallest rectangle that holds both; width 0: nothing. */
static void unite_rects(int *rect, const int *other)
{
    if (rect[2] == 0)
        memcpy(rect, other, 4 * sizeof *rect);
    for (int k = 0; k < 2 && other[2] > 0; k++) {
        int end = rect[k] + rect[2 + k], other_end = other[k] + other[2 + k];
        rect[k] = rect[k] < other[k] ? rect[k] : other[k];
        rect[2 + k] = (end > other_end ? end : other_end) - rect[k];
    }
}

static void intersect_rects(int *rect, const int *other)
{
    for (int k = 0; k < 2; k++) {
        int end = rect[k] + rect[2 + k], other_end = other[k] + other[2 + k];
        rect[k] = rect[k] > other[k] ? rect[k] : other[k];
        rect[2 + k] = (end < other_end ? end : other_end) - rect[k];
    }
    if (rect[2] <= 0 || rect[3] <= 0)
        memset(rect, 0, 4 * sizeof *rect);
}

/* To whole groups of pixels that llvmpipe shades at once: of those at the border the lanes outside the scissor rectangle run, too,
 * from wherever another picture left their rays, and the others wait for them. */
static void widen_rect(int *rect, int width, int height)
{
    const int size[2] = {width, height};
    for (int k = 0; k < 2 && rect[2] > 0; k++) {
        const int end = (rect[k] + rect[2 + k] + GROUP - 1) / GROUP * GROUP;
        rect[k] = rect[k] / GROUP * GROUP;
        rect[2 + k] = (end < size[k] ? end : size[k]) - rect[k];
    }
}

tc_status tc_picture_compile(tc_picture *p, tc_error *err)
{
    const int samples = p->options->samples;
    tc_frame rays; /* those of shifted rays call for the same */
    tc_frame_build(&rays, p->rays, p->center, p->scale);
    p->job->frame = &rays;
    p->job->masked = false;
    tc_status status = p->job->clear ? tc_first_hit_compile(p->job, err) : p->job->driver->compile(p->job, err);
    if (status == TC_OK)
        status = tc_accumulate_compile(p->job, samples, err);
    if (status == TC_OK && p->job->effects)
        status = tc_effects_compile(p->job->effects, p->job, err);
    if (status == TC_OK && samples == TC_SAMPLES_ADAPTIVE) {
        p->job->masked = true;
        status = tc_first_hit_compile(p->job, err);
        if (status == TC_OK && p->job->effects)
            status = tc_effects_compile(p->job->effects, p->job, err);
    }
    p->job->frame = NULL;
    return status;
}

/* Steps are read as a whole, also where nothing is drawn. */
static void clear_steps(const tc_job *job)
{
    const GLuint none[4] = {0, 0, 0, 0};
    job->gl->Disable(GL_SCISSOR_TEST);
    job->gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->set[0].framebuffer);
    job->gl->ClearBufferuiv(GL_COLOR, TC_STATE_STEPS, none);
}

/* Adds what one frame did to the picture's. */
static tc_status add_result(tc_picture *p, const tc_job_result *one, tc_error *err)
{
    tc_job_result *sum = &p->result;
    if (one->fragments && one->passes > 0) {
        size_t n = (size_t)sum->passes + (size_t)one->passes;
        int64_t *grown = tc_realloc(sum->fragments, n, sizeof *grown);
        if (!grown)
            return tc_fail_memory(err, "the pass counters", n, sizeof *grown);
        memcpy(grown + sum->passes, one->fragments, (size_t)one->passes * sizeof *grown);
        sum->fragments = grown;
    }
    sum->passes += one->passes;
    sum->z_updates += one->z_updates;
    sum->layers = one->layers > sum->layers ? one->layers : sum->layers;
    sum->rays += one->rays;
    sum->rays_lost += one->rays_lost;
    sum->ms_first_hit += one->ms_first_hit;
    sum->ms_march += one->ms_march;
    return TC_OK;
}

/* The frame of rays, which stays until the next one, for what makes colours of what they gathered; how depths on them
 * lie before the eye. */
static void set_view(tc_job *job, const tc_picture *p)
{
    const tc_frame *frame = &p->rays_now;
    const double *axis = p->rays->axis;
    job->frame = frame;
    job->view[3] = -tc_vec_dot(p->rays->eye, axis);
    for (int k = 0; k < 3; k++) {
        job->view[k] = axis[k] / p->scale;
        job->view[3] += axis[k] * (p->center[k] + frame->point[k] / p->scale);
    }
}

/* In place of a walk on which nothing would be gathered. */
static tc_status count_rays(tc_job_result *out, const tc_job *job, tc_error *err)
{
    const double start = tc_now_ms();
    tc_status status = tc_first_hit(job, 0, err);
    if (status == TC_OK)
        status = tc_first_hit_rays(&out->rays, job, err);
    out->layers = out->rays > 0;
    out->ms_first_hit = tc_now_ms() - start;
    return status;
}

/* A frame: a ray through each pixel, or each marked one, at place k of a grid of edge * edge in it. touch: pixels that
 * it has to touch besides its own, or NULL. Gives result.twice above 0, and nothing else, where it has to be peeled. */
static tc_status cast_rays(tc_picture *p, int k, int edge, const int *touch, tc_error *err)
{
    tc_job *job = p->job;
    const tc_gl *gl = job->gl;
    tc_frame *now = &p->rays_now;
    tc_rays shifted;
    tc_job_result one = {0};
    tc_status status = TC_OK;
    if (job->count)
        clear_steps(job);
    double start = tc_now_ms();
    tc_rays_shift(&shifted, p->rays, tc_samples_offset(k % edge, edge), tc_samples_offset(k / edge, edge));
    tc_frame_build(now, &shifted, p->center, p->scale);
    set_view(job, p);
    job->proposals = p->proposals;
    int *rect = p->proposals->rect;
    p->proposals->n = 0;
    memset(rect, 0, sizeof p->proposals->rect);
    tc_kept_view *view = edge > 1 || job->clear ? NULL
                                                : tc_kept_find(p->kept, job, p->mesh_serial, p->scalar_serial, p->options->width,
                                                 p->options->height);
    job->kept = view && view->recorded && view->cells <= job->steps_per_pass ? view : NULL;
    if (job->kept)
        memcpy(rect, view->rect, sizeof view->rect);
    else if (!now->hidden)
        status = tc_propose(p->proposals, now, p->options->width, p->options->height, p->face_corner, job->mesh->n_face,
                            err);
    const bool effect_frame = job->effects && tc_effects_have_frame(job->effects);
    if (effect_frame) /* is seen anywhere */
        unite_rects(rect, (const int[4]){0, 0, p->options->width, p->options->height});
    if (touch)
        unite_rects(rect, touch);
    if (job->masked)
        intersect_rects(rect, p->marked);
    if (job->software && !job->kept)
        widen_rect(rect, p->options->width, p->options->height);
    gl->Enable(GL_SCISSOR_TEST); /* nothing is done where no face is seen */
    gl->Scissor(rect[0], rect[1], rect[2], rect[3]);
    if (status == TC_OK && effect_frame)
        status = tc_effects_frame(job->effects, job, err);
    if (status == TC_OK && !job->kept && view && tc_kept_due(p->kept, view)) {
        status = tc_kept_record(p->kept, view, job, err);
        job->kept = view->recorded && view->cells <= job->steps_per_pass ? view : NULL;
    }
    if (status == TC_OK && job->kept)
        status = tc_kept_values(p->kept, view, job, p->scalar_serial, p->threads, err);
    double ms_propose = tc_now_ms() - start;
    if (status == TC_OK)
        status = job->clear  ? count_rays(&one, job, err)
                 : job->kept ? tc_kept_draw(&one, job, err)
                             : job->driver->frame(&one, job, err);
    job->last = one.last;
    one.ms_first_hit += ms_propose;
    p->result.twice = one.twice;
    if (status == TC_OK && one.twice == 0)
        status = add_result(p, &one, err);
    free(one.fragments);
    unite_rects(p->drawn, rect);
    if (status == TC_OK && one.twice == 0 && job->count) {
        start = tc_now_ms();
        status = tc_audit_steps(p->stats, job->state, gl, err);
        p->ms_aside += tc_now_ms() - start;
    }
    return status;
}

/* All rays of a grid, each added to the picture. compare: keeps how they differ, for which every frame touches what
 * those before it did. */
static tc_status cast_grid(tc_picture *p, int edge, bool compare, tc_error *err)
{
    tc_status status = TC_OK;
    for (int k = 0; k < edge * edge && status == TC_OK; k++) {
        status = cast_rays(p, k, edge, compare ? p->drawn : NULL, err);
        if (status != TC_OK || p->result.twice > 0)
            return status;
        if (p->job->clear || p->job->kept) /* nothing to add; all is in its place */
            continue;
        status = tc_accumulate_add(p->job, 1.0 / (edge * edge), err);
        if (status == TC_OK && compare)
            status = tc_accumulate_spread(p->job, k == 0, err);
    }
    return status;
}

tc_status tc_picture_make(tc_picture *p, tc_error *err)
{
    const int samples = p->options->samples;
    const bool adaptive = samples == TC_SAMPLES_ADAPTIVE;
    free(p->result.fragments);
    memset(&p->result, 0, sizeof p->result);
    p->job->masked = false;
    p->job->kept = NULL;
    p->stats->refined = adaptive ? 0 : -1;
    if (p->job->count)
        p->stats->steps = p->stats->steps_max = 0;
    tc_accumulate_begin(p->job, p->drawn);
    memset(p->drawn, 0, 4 * sizeof *p->drawn);
    tc_status status = cast_grid(p, tc_samples_edge(samples), adaptive, err);
    if (status != TC_OK || p->result.twice > 0 || !adaptive)
        return status;
    memcpy(p->marked, p->drawn, sizeof p->marked);
    status = tc_accumulate_mark(p->marked, &p->stats->refined, p->job, err);
    if (status != TC_OK || p->stats->refined == 0)
        return status;
    p->job->masked = true;
    return cast_grid(p, tc_samples_edge(16), false, err);
}
