/* pingpong.c: the rasterization loop of Weiler et al. 2003, 5.2.
 *
 * Each pass reads one set of state textures and writes the other. After every z_update_every passes (an even number, so
 * that the final state of a finished ray stands in set 0) a z-update pass locks finished rays by depth; the occlusion
 * query around it counts them. A query's result is asked for only when it is there: the loop stays two passes ahead of
 * the last z-update. Only where the first pass may finish every ray its count is waited for; then the final state
 * stands in set 1 (tc_job_result.last). */
#include "gpu/pingpong.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "gpu/first_hit.h"
#include "gpu/march.h"
#include "gpu/pass.h"

#include <stdlib.h>
#include <string.h>

enum { AHEAD = 2, ONE_PASS_STEPS = 64 };
static const GLuint64 WAIT_NS = 1000000000ull; /* for a fence, at a time */
enum { WAITS = 3600 };                         /* a pass over a large picture on a slow machine takes minutes */

typedef struct loop {
    const tc_job *job;
    tc_job_result *result;
    tc_error *err;
    GLuint march, lock, lost; /* programs; lost: only with the paper's arithmetic */
    GLuint lock_query;
    GLsync lock_fence;
    GLuint *pass_query; /* counting: one each pass */
    size_t pass_capacity;
    int64_t entered; /* rays of this layer */
    int64_t open;    /* rays not known to be finished */
} loop;

/* The programs of the loop, compiled if need be. */
static tc_status get_programs(loop *l)
{
    const tc_job *job = l->job;
    const tc_program_source lock = {"screen.vert", "lock.frag", "", NULL, NULL},
                            lost = {"screen.vert", "lost.frag", "", NULL, NULL};
    tc_status status = tc_march_program(&l->march, job, "screen.vert", "march.frag", l->err);
    if (status == TC_OK)
        status = tc_program_get(&l->lock, job->programs, &lock, l->err);
    return status == TC_OK && job->planes ? tc_program_get(&l->lost, job->programs, &lost, l->err) : status;
}

static tc_status compile(const tc_job *job, tc_error *err)
{
    loop l = {.job = job, .err = err};
    tc_status status = tc_first_hit_compile(job, err);
    return status == TC_OK ? get_programs(&l) : status;
}

/* Binds what the march reads; again after each first hit, which uses the same units. */
static tc_status prepare_march(loop *l)
{
    tc_status status = get_programs(l);
    if (status == TC_OK)
        tc_march_bind(l->job, l->march);
    return status;
}

/* Issues a pass whose query counts the rays of a set that are finished, and not locked; with `locks`, the z-update,
 * which locks them. */
static void issue_count(loop *l, int set, bool locks)
{
    const tc_gl *gl = l->job->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, l->job->state->lock_framebuffer);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthMask(locks);
    gl->UseProgram(l->lock);
    tc_pass_texture(gl, l->lock, "state_walk", TC_UNIT_WALK, GL_TEXTURE_2D, l->job->state->set[set].walk);
    gl->BeginQuery(GL_SAMPLES_PASSED, l->lock_query);
    tc_pass_screen(gl);
    gl->EndQuery(GL_SAMPLES_PASSED);
    gl->DepthMask(GL_FALSE);
    if (l->job->z_update_every < 0)
        gl->Disable(GL_DEPTH_TEST); /* march as if nothing were locked: the query alone is wanted */
    l->lock_fence = gl->FenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl->Flush();
}

static void issue_lock(loop *l)
{
    issue_count(l, 0, true);
    l->result->z_updates++;
}

/* Waits on the fence behind the last issue_count (passes issued since keep the GPU busy), then reads its count. */
static tc_status collect_count(int64_t *count, loop *l)
{
    const tc_gl *gl = l->job->gl;
    GLenum state = GL_TIMEOUT_EXPIRED;
    for (int i = 0; i < WAITS && state == GL_TIMEOUT_EXPIRED; i++)
        state = gl->ClientWaitSync(l->lock_fence, GL_SYNC_FLUSH_COMMANDS_BIT, WAIT_NS);
    gl->DeleteSync(l->lock_fence);
    l->lock_fence = NULL;
    if (state == GL_WAIT_FAILED)
        return tc_gl_check(gl, "waiting for a pass", l->err) != TC_OK
                   ? TC_E_GL
                   : tc_fail(l->err, TC_E_GL, "%s failed while it rendered a pass", gl->renderer);
    if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED)
        return tc_fail(l->err, TC_E_GL, "%s did not finish a pass within an hour; use fewer --steps-per-pass",
                       gl->renderer);
    GLuint available = 0;
    GLuint64 finished = 0;
    do
        gl->GetQueryObjectuiv(l->lock_query, GL_QUERY_RESULT_AVAILABLE, &available);
    while (!available);
    gl->GetQueryObjectui64v(l->lock_query, GL_QUERY_RESULT, &finished);
    *count = (int64_t)finished;
    return TC_OK;
}

static tc_status collect_lock(loop *l)
{
    int64_t finished = 0;
    tc_status status = collect_count(&finished, l);
    l->open -= finished;
    return status;
}

static tc_status issue_pass(loop *l, int from)
{
    const tc_job *job = l->job;
    const tc_gl *gl = job->gl;
    const tc_state_set *read = &job->state->set[from], *write = &job->state->set[1 - from];
    gl->BindFramebuffer(GL_FRAMEBUFFER, write->framebuffer);
    gl->UseProgram(l->march);
    tc_march_bind_state(job, l->march, read);
    size_t pass = (size_t)l->result->passes++;
    if (!job->count) {
        tc_pass_screen(gl);
        return TC_OK;
    }
    if (pass >= l->pass_capacity) {
        size_t capacity = l->pass_capacity ? 2 * l->pass_capacity : 256;
        GLuint *grown = tc_realloc(l->pass_query, capacity, sizeof *grown);
        if (!grown)
            return tc_fail_memory(l->err, "the pass counters", capacity, sizeof *grown);
        l->pass_query = grown;
        gl->GenQueries((GLsizei)(capacity - l->pass_capacity), grown + l->pass_capacity);
        l->pass_capacity = capacity;
    }
    gl->BeginQuery(GL_SAMPLES_PASSED, l->pass_query[pass]);
    tc_pass_screen(gl);
    gl->EndQuery(GL_SAMPLES_PASSED);
    return TC_OK;
}

/* Where a pass is long enough for most rays the first may be the last: then none copies what is finished back to set 0.
 */
static bool may_do_in_one(const tc_job *job)
{
    return job->software && !job->peel && !job->count && job->steps_per_pass >= ONE_PASS_STEPS;
}

/* The first pass; l->open becomes 0 if it finished every ray, whose colours are then in set 1. */
static tc_status march_once(loop *l)
{
    const tc_job *job = l->job;
    int64_t finished = 0;
    tc_march_clear(job, 1); /* rays that miss the mesh are locked: no pass gives them a colour there */
    tc_status status = issue_pass(l, 0);
    if (status != TC_OK)
        return status;
    issue_count(l, 1, false);
    status = collect_count(&finished, l);
    if (status == TC_OK && finished == l->open) {
        l->open = 0;
        l->result->last = 1;
    }
    return status;
}

/* Passes until every ray of this layer is finished, or until no cell can be left to step through. */
static tc_status march_layer(loop *l)
{
    const tc_job *job = l->job;
    const tc_gl *gl = job->gl;
    const GLfloat far_depth = 1;
    gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->lock_framebuffer);
    gl->DepthMask(GL_TRUE);
    gl->ClearBufferfv(GL_DEPTH, 0, &far_depth);
    gl->DepthMask(GL_FALSE);
    l->open = (int64_t)job->proposals->rect[2] * job->proposals->rect[3];
    issue_lock(l); /* rays that miss the mesh */
    tc_status status = collect_lock(l);
    if (status != TC_OK || l->open == 0)
        return status;
    if (l->result->layers == 0)
        l->result->rays = l->open;
    if (!job->peel) {
        l->result->twice = tc_first_hit_entries(job) - l->open;
        if (l->result->twice > 0)
            return TC_OK; /* not this way */
    }
    l->result->layers++;
    l->entered = l->open;
    int interval = job->z_update_every > 0 ? job->z_update_every : 2, since = 0, ahead = 0;
    int64_t passes = 0;
    int64_t limit = ((int64_t)job->mesh->n_cell + 2) / job->steps_per_pass + 2 * interval + AHEAD + 4;
    bool waiting = false;
    int first = 0; /* set that the next pass reads */
    if (may_do_in_one(job)) {
        status = march_once(l);
        first = 1;
        passes++, since++;
    }
    while (status == TC_OK && l->open > 0 && passes < limit) {
        for (int from = first; from < 2 && status == TC_OK; from++, passes++, since++)
            status = issue_pass(l, from);
        first = 0;
        if (waiting)
            ahead += 2;
        if (status == TC_OK && waiting && ahead >= AHEAD) {
            status = collect_lock(l);
            waiting = false;
        }
        if (status == TC_OK && !waiting && since >= interval && l->open > 0) {
            issue_lock(l);
            waiting = true;
            since = 0;
            ahead = 0;
        }
    }
    if (waiting) {
        tc_status last = collect_lock(l);
        status = status == TC_OK ? last : status;
    }
    return status;
}

/* Rays of this layer that the paper's arithmetic gave up. */
static int64_t count_given_up(loop *l)
{
    const tc_gl *gl = l->job->gl;
    GLuint64 n = 0;
    gl->BindFramebuffer(GL_FRAMEBUFFER, l->job->state->lock_framebuffer);
    gl->Disable(GL_DEPTH_TEST);
    gl->UseProgram(l->lost);
    tc_pass_texture(gl, l->lost, "state_walk", TC_UNIT_WALK, GL_TEXTURE_2D, l->job->state->set[l->result->last].walk);
    gl->BeginQuery(GL_SAMPLES_PASSED, l->lock_query);
    tc_pass_screen(gl);
    gl->EndQuery(GL_SAMPLES_PASSED);
    gl->GetQueryObjectui64v(l->lock_query, GL_QUERY_RESULT, &n);
    return (int64_t)n;
}

static tc_status read_fragments(loop *l)
{
    const tc_gl *gl = l->job->gl;
    l->result->fragments = tc_alloc((size_t)l->result->passes, sizeof *l->result->fragments);
    if (!l->result->fragments)
        return tc_fail_memory(l->err, "the pass counters", (size_t)l->result->passes, sizeof *l->result->fragments);
    for (int i = 0; i < l->result->passes; i++) {
        GLuint64 n = 0;
        gl->GetQueryObjectui64v(l->pass_query[i], GL_QUERY_RESULT, &n);
        l->result->fragments[i] = (int64_t)n;
    }
    return TC_OK;
}

static tc_status frame(tc_job_result *out, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    memset(out, 0, sizeof *out);
    loop l = {.job = job, .result = out, .err = err};
    double start = tc_now_ms();
    tc_march_clear(job, 0);
    tc_status status = tc_first_hit(job, 0, err);
    if (status == TC_OK)
        status = prepare_march(&l);
    gl->Finish();
    out->ms_first_hit = tc_now_ms() - start;
    start = tc_now_ms();
    gl->GenQueries(1, &l.lock_query);
    gl->DepthFunc(GL_LESS);
    for (int layer = 0; status == TC_OK; layer++) {
        int before = out->layers;
        status = march_layer(&l);
        if (status != TC_OK || out->layers == before)
            break;       /* no ray entered, or some more than once */
        if (job->planes) /* with peeling, a ray counts for each entry from which it is lost */
            out->rays_lost += count_given_up(&l);
        if (l.open > 0) {
            out->rays_lost += l.open;
            break;
        }
        if (!job->peel)
            break;
        if ((size_t)layer > job->mesh->n_face) { /* more entries than there are faces */
            out->rays_lost = l.entered;
            break;
        }
        status = tc_first_hit(job, layer + 1, err);
        if (status == TC_OK)
            status = prepare_march(&l);
    }
    gl->Finish();
    out->ms_march = tc_now_ms() - start;
    if (status == TC_OK && job->count)
        status = read_fragments(&l);
    gl->DeleteQueries(1, &l.lock_query);
    if (l.pass_query)
        gl->DeleteQueries((GLsizei)l.pass_capacity, l.pass_query);
    free(l.pass_query);
    return status == TC_OK ? tc_gl_check(gl, "marching", err) : status;
}

const tc_gl_driver tc_driver_pingpong = {"pingpong", true, compile, frame};
