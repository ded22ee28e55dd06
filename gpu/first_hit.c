/* first_hit.c: draws the proposed boundary faces to find each ray's entry. */
#include "gpu/first_hit.h"

#include "gpu/pass.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

/* Proposals → vertex buffer; once a frame. */
static void upload_proposals(const tc_job *job)
{
    const tc_gl *gl = job->gl;
    gl->BindBuffer(GL_ARRAY_BUFFER, job->hit_buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(job->proposals->n * sizeof(tc_proposal)), job->proposals->corner,
                   GL_STREAM_DRAW);
    gl->VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, sizeof(tc_proposal), NULL);
    gl->VertexAttribIPointer(1, 1, GL_INT, sizeof(tc_proposal), (const void *)offsetof(tc_proposal, face));
    gl->EnableVertexAttribArray(0);
    gl->EnableVertexAttribArray(1);
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
    const tc_program_source source = {"first_hit.vert", "first_hit.frag", defines, NULL};
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
    const GLfloat zero[4] = {0, 0, 0, 0}, far_depth = 1;
    int next = layer & 1;
    if (job->peel && layer == 0) {
        gl->BindFramebuffer(GL_FRAMEBUFFER, s->hit_framebuffer[1]);
        gl->ClearBufferiv(GL_COLOR, 2, no_key);
    }
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->hit_framebuffer[job->peel ? next : 0]);
    gl->Viewport(0, 0, s->width, s->height);
    gl->DepthMask(GL_TRUE);
    gl->ClearBufferiv(GL_COLOR, 0, nowhere);
    gl->ClearBufferfv(GL_COLOR, 1, zero);
    if (job->peel) {
        /* A ray without a further entry is out: no later layer may revive it. */
        const GLint last_key[4] = {0x7fffffff, 0x7fffffff, 0, 0};
        gl->ClearBufferiv(GL_COLOR, 2, last_key);
    }
    gl->ClearBufferfv(GL_DEPTH, 0, &far_depth);

    if (!job->peel) {
        const GLuint none = 0;
        gl->BindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, job->entry_counter);
        gl->BufferData(GL_ATOMIC_COUNTER_BUFFER, sizeof none, &none, GL_DYNAMIC_READ);
    }
    gl->UseProgram(program);
    gl->BindVertexArray(job->hit_array);
    if (layer == 0)
        upload_proposals(job);
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
    if (job->proposals->n > 0)
        gl->DrawArrays(GL_TRIANGLES, 0, (GLsizei)job->proposals->n);
    gl->DepthMask(GL_FALSE);
    gl->BindVertexArray(job->screen_array);
    return tc_gl_check(gl, "finding the first hits", err);
}
