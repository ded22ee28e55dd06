/* first_hit.c: draws the boundary faces to find each ray's entry. */
#include "gpu/first_hit.h"

#include "gpu/pass.h"

enum { VERTICES_PER_FACE = 21, FACES_PER_DRAW = 1 << 22 };

tc_status tc_first_hit(const tc_job *job, int layer, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const tc_state *s = job->state;
    char defines[256];
    tc_job_defines(defines, sizeof defines, job);
    const tc_program_source source = {"first_hit.vert", "first_hit.frag", defines, NULL};
    GLuint program;
    tc_status status = tc_program_get(&program, job->programs, &source, err);
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
        /* A ray without a further entry keeps no key and would begin again: it is out by its missing cell, and no later
         * layer may revive it. */
        const GLint last_key[4] = {0x7fffffff, 0x7fffffff, 0, 0};
        gl->ClearBufferiv(GL_COLOR, 2, last_key);
    }
    gl->ClearBufferfv(GL_DEPTH, 0, &far_depth);

    gl->UseProgram(program);
    tc_job_bind_mesh(job, program);
    tc_pass_texture(gl, program, "faces", 3, GL_TEXTURE_BUFFER, job->mesh->faces.texture);
    tc_pass_vec2(gl, program, "viewport", s->width, s->height);
    gl->UniformMatrix4fv(gl->GetUniformLocation(program, "clip"), 1, GL_FALSE, job->frame->clip);
    if (job->peel) {
        tc_pass_texture(gl, program, "peel_key", 4, GL_TEXTURE_2D, s->key[1 - next]);
        tc_pass_texture(gl, program, "state_color", 5, GL_TEXTURE_2D, s->set[0].color);
        tc_pass_float(gl, program, "transmittance_stop", job->transmittance_stop);
    }
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_LESS);
    for (size_t first = 0; first < job->mesh->n_face; first += FACES_PER_DRAW) {
        size_t n = job->mesh->n_face - first;
        if (n > FACES_PER_DRAW)
            n = FACES_PER_DRAW;
        gl->DrawArrays(GL_TRIANGLES, (GLint)(first * VERTICES_PER_FACE), (GLsizei)(n * VERTICES_PER_FACE));
    }
    gl->DepthMask(GL_FALSE);
    return tc_gl_check(gl, "finding the first hits", err);
}
