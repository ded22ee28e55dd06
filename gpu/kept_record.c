/* kept_record.c: writes down where the rays of a view go, and makes pictures along that. */
#include "gpu/kept.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "gpu/first_hit.h"
#include "gpu/march.h"
#include "gpu/pass.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PAIR_BYTES = 8, FIRST_BYTES = 8 };
enum { RECORDS_BUFFER = 0 }; /* record.frag */
_Static_assert(sizeof(tc_kept_face) == 28, "record.frag writes seven words");

static tc_status get_record(GLuint *program, const tc_job *job, bool writes, tc_error *err)
{
    char defines[1024];
    tc_job_defines(defines, sizeof defines, job);
    size_t n = strlen(defines);
    snprintf(defines + n, sizeof defines - n, "%s%s", job->software ? "#define RAYS_FLAT\n" : "",
             writes ? "#define RECORD\n" : "");
    const tc_program_source source = {"screen.vert", "record.frag", defines, NULL, NULL};
    return tc_program_get(program, job->programs, &source, err);
}

/* Walks all rays and gives their counts [n][2]; with a view that has room the records go to it. */
static tc_status walk_rays(int32_t *count, const tc_job *job, GLuint framebuffer, const tc_kept_view *view,
                           tc_error *err)
{
    const tc_gl *gl = job->gl;
    GLuint program;
    tc_status status = get_record(&program, job, view != NULL, err);
    if (status != TC_OK)
        return status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->Disable(GL_DEPTH_TEST);
    gl->UseProgram(program);
    tc_job_bind_mesh(job, program);
    tc_pass_texture(gl, program, "state_walk", 4, GL_TEXTURE_2D, job->state->set[0].walk);
    if (view) {
        tc_pass_texture(gl, program, "kept_first", 5, GL_TEXTURE_2D, view->first);
        gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, RECORDS_BUFFER, view->record);
    }
    tc_pass_screen(gl);
    if (view)
        gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    gl->ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->ReadPixels(0, 0, job->state->width, job->state->height, GL_RG_INTEGER, GL_INT, count);
    return tc_gl_check(gl, "recording walks", err);
}

/* From counts [n][2] to first [n][2] and the most cells; *sum gets the records, -1: they cannot be kept. Rays of no
 * record have no walk. */
static void place_records(int64_t *sum, int64_t *entered, int *cells, int32_t *first, const int32_t *count, size_t n)
{
    *sum = *entered = 0;
    for (size_t i = 0; i < n; i++) {
        const int32_t own = count[2 * i] - 1;
        *cells = count[2 * i + 1] > *cells ? count[2 * i + 1] : *cells;
        if (own < -1 || *sum > INT32_MAX / 7 - 100000) {
            *sum = -1;
            return;
        }
        *entered += own >= 0;
        first[2 * i] = own > 0 ? (int32_t)(*sum + 1) : 0;
        first[2 * i + 1] = own > 0 ? (int32_t)(*sum + own) : 0;
        *sum += own > 0 ? own : 0;
    }
}

static void forget(tc_kept *k, tc_kept_view *view, const tc_gl *gl)
{
    tc_texture_buffer_finish(&view->pairs, gl);
    gl->DeleteBuffers(1, &view->record);
    gl->DeleteTextures(1, &view->first);
    view->record = view->first = 0;
    k->bytes -= view->bytes;
    view->bytes = 0;
}

/* Room for so many records, and the places in it. */
static tc_status make_room(tc_kept *k, tc_kept_view *view, const tc_job *job, const int32_t *first, size_t n_record,
                           tc_error *err)
{
    const tc_gl *gl = job->gl;
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    const size_t bytes = n_record * (sizeof(tc_kept_face) + PAIR_BYTES) + pixels * FIRST_BYTES;
    if (bytes > k->most || k->bytes > k->most - bytes || n_record > (size_t)gl->max_texture_buffer || n_record == 0) {
        view->refused = true;
        return TC_OK;
    }
    tc_status status =
        tc_texture_buffer_upload(&view->pairs, gl, NULL, n_record, PAIR_BYTES, GL_RG32F, "keeping walks", err);
    if (status != TC_OK)
        return status;
    view->n_record = n_record;
    view->first = tc_pass_new_texture(gl, view->width, view->height, GL_RG32I, GL_RG_INTEGER, GL_INT);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RG32I, view->width, view->height, 0, GL_RG_INTEGER, GL_INT, first);
    gl->GenBuffers(1, &view->record);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, view->record);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, (GLsizeiptr)(n_record * sizeof(tc_kept_face)), NULL, GL_STREAM_READ);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    view->bytes = bytes;
    k->bytes += bytes;
    return tc_gl_check(gl, "keeping walks", err);
}

tc_status tc_kept_record(tc_kept *k, tc_kept_view *view, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const size_t n = (size_t)view->width * (size_t)view->height;
    int32_t *count = tc_alloc(n, 2 * sizeof *count), *first = tc_alloc(n, 2 * sizeof *first);
    int64_t sum = 0;
    const GLint none[4] = {0, 0, 0, 0};
    GLuint texture = 0, framebuffer = 0;
    tc_status status = count && first ? tc_first_hit(job, 0, err) : tc_fail_memory(err, "kept walks", n, 16);
    if (status != TC_OK)
        goto done;
    texture = tc_pass_new_texture(gl, view->width, view->height, GL_RG32I, GL_RG_INTEGER, GL_INT);
    gl->GenFramebuffers(1, &framebuffer);
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->FramebufferTexture(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0);
    gl->Disable(GL_SCISSOR_TEST); /* all counts are read, those where no face is proposed, too */
    gl->ClearBufferiv(GL_COLOR, 0, none);
    gl->Enable(GL_SCISSOR_TEST);
    status = walk_rays(count, job, framebuffer, NULL, err);
    if (status != TC_OK)
        goto done;
    place_records(&sum, &view->rays, &view->cells, first, count, n);
    view->refused = sum < 0 || tc_first_hit_entries(job) != view->rays;
    if (!view->refused)
        status = make_room(k, view, job, first, (size_t)sum, err);
    if (status == TC_OK && !view->refused) {
        int32_t *wrote = first; /* which is in its texture */
        status = walk_rays(wrote, job, framebuffer, view, err);
        view->refused =
            memcmp(wrote, count, n * 2 * sizeof *count) != 0; /* a ray that wrote what it did not count: not this way */
    }
    view->recorded = status == TC_OK && !view->refused;
    memcpy(view->rect, job->proposals->rect, sizeof view->rect);
done:
    if (!view->recorded)
        forget(k, view, gl);
    gl->DeleteFramebuffers(1, &framebuffer); /* 0 is ignored */
    gl->DeleteTextures(1, &texture);
    free(count);
    free(first);
    return status;
}

tc_status tc_kept_draw(tc_job_result *out, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const tc_kept_view *view = job->kept;
    const int *rect = view->rect;
    const double start = tc_now_ms();
    GLuint program, query;
    GLuint64 ended = 0;
    memset(out, 0, sizeof *out);
    tc_status status = tc_march_program(&program, job, "screen.vert", "kept.frag", err);
    if (status != TC_OK || rect[2] <= 0 || rect[3] <= 0)
        return status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, job->state->result_framebuffer);
    gl->Viewport(0, 0, view->width, view->height);
    gl->Disable(GL_DEPTH_TEST);
    tc_march_bind(job, program);
    tc_pass_texture(gl, program, "kept_first", TC_UNIT_WALK, GL_TEXTURE_2D, view->first);
    gl->Uniform3f(gl->GetUniformLocation(program, "color_most"), (float)job->most[0], (float)job->most[1],
                  (float)job->most[2]);
    gl->GenQueries(1, &query);
    gl->BeginQuery(GL_SAMPLES_PASSED, query);
    tc_pass_screen(gl);
    gl->EndQuery(GL_SAMPLES_PASSED);
    gl->GetQueryObjectui64v(query, GL_QUERY_RESULT, &ended);
    gl->DeleteQueries(1, &query);
    gl->Finish();
    out->passes = 1;
    out->layers = view->rays > 0;
    out->rays = view->rays;
    out->rays_lost = (int64_t)rect[2] * rect[3] - (int64_t)ended;
    out->ms_march = tc_now_ms() - start;
    return tc_gl_check(gl, "going along kept walks", err);
}
