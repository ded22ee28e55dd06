/* first_hit.c: draws the proposed boundary faces to find each ray's entry. */
#include "gpu/first_hit.h"

#include "gpu/effect.h"
#include "gpu/pass.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum { COUNTERS = 16, COUNTER_APART = 16 }; /* first_hit.frag */

enum {
    DRAW_LEAST = 3 * 600,   /* corners a draw: they are on the GPU one draw at a time, */
    DRAW_MOST_SHARE = 64,   /* … or in so many draws */
    FLUSH_EVERY = 3 * 2400, /* corners: what is drawn by then is worth to be begun with */
};

size_t tc_first_hit_corners(size_t n)
{
    size_t share = (n / 3 + DRAW_MOST_SHARE - 1) / DRAW_MOST_SHARE * 3, most = share > DRAW_LEAST ? share : DRAW_LEAST;
    return n < most ? n : most;
}

/* Draws the proposals part by part, each through the same buffer: it stays small, and a renderer that works on the CPU
 * fills the triangles of one part while the next is set up. */
static void draw_proposals(const tc_job *job)
{
    const tc_gl *gl = job->gl;
    const tc_proposals *all = job->proposals;
    const size_t most = tc_first_hit_corners(all->n);
    size_t since = 0;
    gl->BindBuffer(GL_ARRAY_BUFFER, job->hit_buffer);
    gl->EnableVertexAttribArray(0);
    gl->EnableVertexAttribArray(1);
    for (size_t first = 0, n; first < all->n; first += n) {
        n = all->n - first < most ? all->n - first : most;
        gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(n * sizeof(tc_proposal)), all->corner + first, GL_STREAM_DRAW);
        gl->VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(tc_proposal), NULL);
        gl->VertexAttribIPointer(1, 1, GL_INT, sizeof(tc_proposal), (const void *)offsetof(tc_proposal, face));
        gl->DrawArrays(GL_TRIANGLES, 0, (GLsizei)n);
        since += n;
        if (since >= FLUSH_EVERY) {
            gl->Flush();
            since = 0;
        }
    }
    gl->BindBuffer(GL_ARRAY_BUFFER, 0);
}

void tc_first_hit_defines(char *out, size_t capacity, const tc_job *job)
{
    tc_job_defines(out, capacity, job);
    size_t n = strlen(out);
    if (job->masked)
        snprintf(out + n, capacity - n, "#define SAMPLE_MASK\n");
}

static tc_status get_program(GLuint *program, const tc_job *job, tc_error *err)
{
    char defines[512];
    tc_first_hit_defines(defines, sizeof defines, job);
    const tc_program_source source = {"first_hit.vert", "first_hit.frag", defines, NULL, NULL};
    return tc_program_get(program, job->programs, &source, err);
}

tc_status tc_first_hit_compile(const tc_job *job, tc_error *err)
{
    GLuint unused;
    return get_program(&unused, job, err);
}

tc_status tc_first_hit(const tc_job *job, int layer, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const tc_state *s = job->state;
    GLuint program;
    tc_status status = get_program(&program, job, err);
    if (status != TC_OK)
        return status;

    const GLint nowhere[4] = {-1, 0, 0, 0}, no_key[4] = {0, 0, 0, 0};
    const GLint entry[4] = {0, 0, -1, 0};
    const GLfloat far_depth = 1;
    int next = layer & 1;
    if (job->peel && layer == 0) {
        gl->BindFramebuffer(GL_FRAMEBUFFER, s->hit_framebuffer[1]);
        gl->ClearBufferiv(GL_COLOR, 1, no_key);
    }
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->set[0].framebuffer);
    if (layer == 0 || !job->effects || !(job->effects->needs & TC_NEEDS_WAY))
        gl->ClearBufferiv(GL_COLOR, TC_STATE_AT, entry);
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->hit_framebuffer[job->peel ? next : 0]);
    gl->Viewport(0, 0, s->width, s->height);
    gl->DepthMask(GL_TRUE);
    gl->ClearBufferiv(GL_COLOR, 0, nowhere);
    if (job->peel) {
        /* A ray without a further entry is out: no later layer may revive it. */
        const GLint last_key[4] = {0x7fffffff, 0x7fffffff, 0, 0};
        gl->ClearBufferiv(GL_COLOR, 1, last_key);
    }
    gl->ClearBufferfv(GL_DEPTH, 0, &far_depth);

    if (!job->peel) {
        const GLuint none[COUNTERS * COUNTER_APART] = {0};
        gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, job->entry_counter);
        gl->BufferData(GL_SHADER_STORAGE_BUFFER, sizeof none, none, GL_DYNAMIC_READ);
    }
    gl->UseProgram(program);
    gl->BindVertexArray(job->hit_array);
    tc_job_bind_mesh(job, program);
    tc_pass_texture(gl, program, "faces", 6, GL_TEXTURE_BUFFER, job->mesh->faces.texture);
    if (job->peel) {
        tc_pass_texture(gl, program, "peel_key", 4, GL_TEXTURE_2D, s->key[1 - next]);
        tc_pass_texture(gl, program, "state_color", 5, GL_TEXTURE_2D, s->set[0].color);
        tc_pass_float(gl, program, "transmittance_stop", job->transmittance_stop);
    }
    if (job->masked)
        tc_pass_texture(gl, program, "sample_mask", 7, GL_TEXTURE_2D, s->mask);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_LESS);
    draw_proposals(job);
    gl->DepthMask(GL_FALSE);
    gl->BindVertexArray(job->screen_array);
    return tc_gl_check(gl, "finding the first hits", err);
}

int64_t tc_first_hit_entries(const tc_job *job)
{
    const tc_gl *gl = job->gl;
    GLuint counter[COUNTERS * COUNTER_APART] = {0};
    int64_t sum = 0;
    gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, job->entry_counter);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof counter, counter);
    for (int i = 0; i < COUNTERS; i++)
        sum += counter[i * COUNTER_APART];
    return sum;
}

tc_status tc_first_hit_rays(int64_t *rays, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const tc_program_source source = {"screen.vert", "entered.frag", "", NULL, NULL};
    GLuint program, query;
    GLuint64 n = 0;
    tc_status status = tc_program_get(&program, job->programs, &source, err);
    if (status != TC_OK)
        return status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->lock_framebuffer);
    gl->Disable(GL_DEPTH_TEST);
    gl->UseProgram(program);
    tc_pass_texture(gl, program, "state_walk", 4, GL_TEXTURE_2D, job->state->set[0].walk);
    gl->GenQueries(1, &query);
    gl->BeginQuery(GL_SAMPLES_PASSED, query);
    tc_pass_screen(gl);
    gl->EndQuery(GL_SAMPLES_PASSED);
    gl->GetQueryObjectui64v(query, GL_QUERY_RESULT, &n);
    gl->DeleteQueries(1, &query);
    *rays = (int64_t)n;
    return tc_gl_check(gl, "counting the rays", err);
}
