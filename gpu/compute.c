/* compute.c: rays are walked by a compute shader (march.comp), each from its entry to its end.
 *
 * The entries are drawn as for pingpong (first_hit.c), into state set 0, and what rays gathered goes back there. A
 * dispatch walks every ray by at most steps_per_pass steps: GPUs end what takes seconds, and llvmpipe cuts loops. So
 * that is far more than a ray is likely to make, and most layers are done with one. */
#include "gpu/compute.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "gpu/first_hit.h"
#include "gpu/march.h"
#include "gpu/pass.h"

#include <stdlib.h>
#include <string.h>

enum { TILE = 8 }; /* pixels along a side of a work group: march.comp's */
/* Images that are written. Where the renderer is software, those before hold what march.comp reads (fetch.glsl). */
enum { IMAGE_STATE_SOFTWARE = 8, IMAGES_MOST = 5 };
enum { WALKED, OPEN, GIVEN_UP, COUNTERS }; /* of march.comp, in its order */

typedef struct loop {
    const tc_job *job;
    tc_job_result *result;
    tc_error *err;
    GLuint program;
    size_t capacity; /* of result->fragments */
} loop;

static GLuint first_image(const tc_job *job)
{
    return job->software ? IMAGE_STATE_SOFTWARE : 0;
}

static tc_status get_program(GLuint *program, const tc_job *job, tc_error *err)
{
    int units = (int)first_image(job) + IMAGES_MOST;
    if (job->gl->max_image_units < units)
        return tc_fail(err, TC_E_GL, "%s offers %d image units, the driver 'compute' needs %d; use --driver pingpong",
                       job->gl->renderer, job->gl->max_image_units, units);
    return tc_march_program(program, job, NULL, "march.comp", err);
}

static tc_status compile(const tc_job *job, tc_error *err)
{
    GLuint unused;
    tc_status status = tc_first_hit_compile(job, err);
    return status == TC_OK ? get_program(&unused, job, err) : status;
}

static void bind_image(const loop *l, const char *name, GLuint unit, GLenum format, GLuint texture)
{
    const tc_gl *gl = l->job->gl;
    gl->BindImageTexture(unit, texture, 0, GL_FALSE, 0, GL_WRITE_ONLY, format);
    tc_pass_int(gl, l->program, name, (int)unit);
}

/* Binds what the march reads and writes; again after each first hit, which uses the same units. */
static tc_status prepare_march(loop *l)
{
    const tc_job *job = l->job;
    const tc_state *s = job->state;
    const tc_state_set *set = &s->set[0];
    const int *rect = job->proposals->rect;
    GLuint unit = first_image(job);
    tc_status status = get_program(&l->program, job, l->err);
    if (status != TC_OK)
        return status;
    tc_march_bind(job, l->program);
    tc_march_bind_state(job, l->program, set);
    bind_image(l, "out_walk", unit++, GL_RGBA32I, set->walk);
    bind_image(l, "out_color", unit++, s->color_bits == 16 ? GL_RGBA16F : GL_RGBA32F, set->color);
    bind_image(l, "out_at", unit++, GL_RGBA32I, set->at);
    if (job->count)
        bind_image(l, "out_steps", unit++, GL_R32UI, set->steps);
    if (job->audit)
        bind_image(l, "out_audit", unit++, GL_RGBA32UI, set->audit);
    job->gl->Uniform4i(job->gl->GetUniformLocation(l->program, "rect"), rect[0], rect[1], rect[2], rect[3]);
    return TC_OK;
}

/* Keeps how many rays a dispatch walked. */
static tc_status keep_walked(loop *l, GLuint walked)
{
    tc_job_result *result = l->result;
    size_t n = (size_t)result->passes;
    if (n >= l->capacity) {
        size_t capacity = l->capacity ? 2 * l->capacity : 16;
        int64_t *grown = tc_realloc(result->fragments, capacity, sizeof *grown);
        if (!grown)
            return tc_fail_memory(l->err, "the pass counters", capacity, sizeof *grown);
        result->fragments = grown;
        l->capacity = capacity;
    }
    result->fragments[n] = walked;
    return TC_OK;
}

/* Walks every ray that is not finished; gives march.comp's counters. */
static tc_status dispatch(GLuint counters[COUNTERS], loop *l)
{
    const tc_job *job = l->job;
    const tc_gl *gl = job->gl;
    const int *rect = job->proposals->rect;
    memset(counters, 0, COUNTERS * sizeof *counters);
    gl->BindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, job->march_counter);
    gl->BufferData(GL_ATOMIC_COUNTER_BUFFER, COUNTERS * sizeof *counters, counters, GL_DYNAMIC_READ);
    gl->DispatchCompute((GLuint)(rect[2] + TILE - 1) / TILE, (GLuint)(rect[3] + TILE - 1) / TILE, 1);
    /* What was written is read as textures, by the next dispatch and the passes behind it, and is drawn over; the
     * counters are read here. */
    gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT |
                      GL_TEXTURE_UPDATE_BARRIER_BIT | GL_ATOMIC_COUNTER_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    gl->GetBufferSubData(GL_ATOMIC_COUNTER_BUFFER, 0, COUNTERS * sizeof *counters, counters);
    tc_status status = tc_gl_check(gl, "walking the rays", l->err);
    if (status != TC_OK || counters[WALKED] == 0)
        return status;
    if (job->count)
        status = keep_walked(l, counters[WALKED]);
    l->result->passes++;
    return status;
}

/* Dispatches until every ray of this layer is finished, or until no cell can be left to step through; rays that entered
 * and those that are left to `entered` and `open`. */
static tc_status march_layer(int64_t *entered, int64_t *open, loop *l)
{
    const tc_job *job = l->job;
    GLuint counters[COUNTERS];
    int64_t limit = ((int64_t)job->mesh->n_cell + 2) / job->steps_per_pass + 2;
    tc_status status = dispatch(counters, l);
    *entered = counters[WALKED];
    *open = counters[OPEN];
    if (status != TC_OK || *entered == 0)
        return status;
    l->result->rays_lost += counters[GIVEN_UP];
    if (l->result->layers++ == 0)
        l->result->rays = *entered;
    if (!job->peel) {
        l->result->twice = tc_first_hit_entries(job) - (int64_t)counters[WALKED];
        if (l->result->twice > 0)
            return TC_OK; /* not this way */
    }
    for (int64_t n = 1; status == TC_OK && *open > 0 && n < limit; n++) {
        status = dispatch(counters, l);
        *open = counters[OPEN];
        l->result->rays_lost += counters[GIVEN_UP];
    }
    return status;
}

static tc_status frame(tc_job_result *out, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    memset(out, 0, sizeof *out);
    loop l = {.job = job, .result = out, .err = err};
    double start = tc_now_ms();
    tc_march_clear(job, 0);
    tc_status status = tc_first_hit(job, 0, err);
    gl->Finish();
    out->ms_first_hit = tc_now_ms() - start;
    start = tc_now_ms();
    if (job->proposals->rect[2] <= 0 || job->proposals->rect[3] <= 0)
        return status;
    for (size_t layer = 0; status == TC_OK; layer++) {
        int64_t entered = 0, open = 0;
        status = prepare_march(&l);
        if (status == TC_OK)
            status = march_layer(&entered, &open, &l);
        if (status != TC_OK || entered == 0 || out->twice > 0)
            break;
        if (layer > job->mesh->n_face) /* more entries than there are faces */
            open = entered;
        out->rays_lost += open;
        if (open > 0 || !job->peel)
            break;
        status = tc_first_hit(job, (int)layer + 1, err);
    }
    gl->Finish();
    out->ms_march = tc_now_ms() - start;
    return status;
}

const tc_gl_driver tc_driver_compute = {"compute", false, compile, frame};
