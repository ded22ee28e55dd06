/* accumulate.c: the passes that make the picture from what rays gathered. */
#include "gpu/accumulate.h"

#include "core/memory.h"
#include "gpu/effect.h"
#include "gpu/pass.h"
#include "scene/samples.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static tc_status get_program(GLuint *program, const tc_job *job, const char *fragment, bool share, tc_error *err)
{
    bool depth = tc_job_holds_depth(job);
    const tc_effects *effects = job->effects;
    char defines[1024];
    snprintf(defines, sizeof defines, "%s%s%s%s", depth ? "#define COLOR_HOLDS_DEPTH\n" : "",
             share ? "#define SHARE\n" : "", effects && *effects->shaders && job->software ? "#define SOFTWARE\n" : "",
             effects ? effects->defines : "");
    const tc_program_source source = {"screen.vert", fragment, defines, NULL, effects ? effects->shaders : NULL};
    return tc_program_get(program, job->programs, &source, err);
}

static tc_status get_mask_program(GLuint *program, const tc_job *job, tc_error *err)
{
    const tc_program_source source = {"screen.vert", "mask.frag", "", NULL, NULL};
    return tc_program_get(program, job->programs, &source, err);
}

tc_status tc_accumulate_compile(const tc_job *job, int samples, tc_error *err)
{
    GLuint unused;
    tc_status status = get_program(&unused, job, "resolve.frag", tc_samples_edge(samples) > 1, err);
    if (status == TC_OK && samples == TC_SAMPLES_ADAPTIVE)
        status = get_program(&unused, job, "spread.frag", false, err);
    if (status == TC_OK && samples == TC_SAMPLES_ADAPTIVE)
        status = get_mask_program(&unused, job, err);
    return status;
}

void tc_accumulate_begin(const tc_job *job, const int drawn[4])
{
    const tc_gl *gl = job->gl;
    const tc_state *s = job->state;
    const GLfloat empty[4] = {0, 0, 0, 0};
    if (s->adaptive) { /* what no frame proposes: all of its rays are empty */
        gl->Disable(GL_SCISSOR_TEST);
        gl->BindFramebuffer(GL_FRAMEBUFFER, s->spread_framebuffer);
        gl->ClearBufferfv(GL_COLOR, 0, empty);
        gl->ClearBufferfv(GL_COLOR, 1, empty);
    }
    gl->Enable(GL_SCISSOR_TEST);
    gl->Scissor(drawn[0], drawn[1], drawn[2], drawn[3]);
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->result_framebuffer);
    gl->ClearBufferfv(GL_COLOR, 0, empty);
}

/* Draws what rays gathered with a program. */
static void draw_state(const tc_job *job, GLuint program, GLuint framebuffer)
{
    const tc_gl *gl = job->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->Viewport(0, 0, job->state->width, job->state->height);
    gl->Disable(GL_DEPTH_TEST);
    tc_pass_texture(gl, program, "state_color", 0, GL_TEXTURE_2D, job->state->set[job->last].color);
    gl->Uniform3f(gl->GetUniformLocation(program, "color_most"), (float)job->most[0], (float)job->most[1],
                  (float)job->most[2]);
    if (job->effects)
        tc_effects_bind(job->effects, job, program);
    tc_pass_screen(gl);
    gl->Disable(GL_BLEND);
}

tc_status tc_accumulate_add(const tc_job *job, double share, tc_error *err)
{
    const tc_gl *gl = job->gl;
    GLuint program;
    tc_status status = get_program(&program, job, "resolve.frag", share < 1, err);
    if (status != TC_OK)
        return status;
    gl->UseProgram(program);
    if (share < 1) { /* a power of two: shares and sums are those of whole colours, in every bit */
        tc_pass_float(gl, program, "share", share);
        gl->Enable(GL_BLEND);
        gl->BlendEquation(GL_FUNC_ADD);
        gl->BlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE);
    }
    draw_state(job, program, job->state->result_framebuffer);
    gl->Finish();
    return tc_gl_check(gl, "resolving the picture", err);
}

tc_status tc_accumulate_spread(const tc_job *job, bool first, tc_error *err)
{
    const tc_gl *gl = job->gl;
    GLuint program;
    tc_status status = get_program(&program, job, "spread.frag", false, err);
    if (status != TC_OK)
        return status;
    gl->UseProgram(program);
    if (!first) {
        gl->Enable(GL_BLEND);
        gl->BlendEquation(GL_MAX);
    }
    draw_state(job, program, job->state->spread_framebuffer);
    return tc_gl_check(gl, "comparing the rays of a pixel", err);
}

/* The pixels of rect that are marked: their number and the rectangle that holds them. */
static tc_status find_marked(int rect[4], int64_t *n, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    size_t width = (size_t)rect[2], height = (size_t)rect[3];
    int lo[2] = {rect[2], rect[3]}, hi[2] = {0, 0};
    *n = 0;
    if (width == 0 || height == 0)
        return TC_OK;
    uint8_t *mark = tc_alloc(height, width);
    if (!mark)
        return tc_fail_memory(err, "the marked pixels", height, width);
    gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->mask_framebuffer);
    gl->ReadBuffer(GL_COLOR_ATTACHMENT1);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl->ReadPixels(rect[0], rect[1], rect[2], rect[3], GL_RED_INTEGER, GL_UNSIGNED_BYTE, mark);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    for (int y = 0; y < rect[3]; y++)
        for (int x = 0; x < rect[2]; x++)
            if (mark[(size_t)y * width + (size_t)x]) {
                ++*n;
                lo[0] = x < lo[0] ? x : lo[0];
                lo[1] = y < lo[1] ? y : lo[1];
                hi[0] = x + 1 > hi[0] ? x + 1 : hi[0];
                hi[1] = y + 1 > hi[1] ? y + 1 : hi[1];
            }
    free(mark);
    for (int k = 0; k < 2; k++) {
        rect[k] += *n ? lo[k] : 0;
        rect[2 + k] = *n ? hi[k] - lo[k] : 0;
    }
    return tc_gl_check(gl, "reading the marked pixels", err);
}

tc_status tc_accumulate_mark(int rect[4], int64_t *n, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const tc_state *s = job->state;
    const GLuint none[4] = {0, 0, 0, 0};
    GLuint program;
    tc_status status = get_mask_program(&program, job, err);
    if (status != TC_OK)
        return status;
    gl->Scissor(rect[0], rect[1], rect[2], rect[3]);
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->mask_framebuffer);
    gl->Viewport(0, 0, s->width, s->height);
    gl->ClearBufferuiv(GL_COLOR, 1, none);
    gl->Disable(GL_DEPTH_TEST);
    gl->UseProgram(program);
    tc_pass_texture(gl, program, "spread_most", 0, GL_TEXTURE_2D, s->spread[0]);
    tc_pass_texture(gl, program, "spread_least", 1, GL_TEXTURE_2D, s->spread[1]);
    tc_pass_float(gl, program, "spread_limit", TC_SAMPLES_SPREAD);
    tc_pass_screen(gl);
    status = tc_gl_check(gl, "marking the pixels whose rays differ", err);
    return status == TC_OK ? find_marked(rect, n, job, err) : status;
}
