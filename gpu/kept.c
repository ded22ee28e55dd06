/* kept.c: walks that are kept. */
#include "gpu/kept.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "gpu/effect.h"
#include "gpu/first_hit.h"
#include "gpu/pass.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SEEN_OTHER = 2, SEEN_SAME = 3, PAIR_BYTES = 8, FIRST_BYTES = 8, CHUNK = 1 << 15 };
enum { RECORDS_BUFFER = 1 }; /* record.frag */
_Static_assert(sizeof(tc_kept_face) == 28, "record.frag writes seven words");

void tc_kept_clear(tc_kept *k, const tc_gl *gl)
{
    for (int i = 0; i < k->n; i++) {
        tc_texture_buffer_finish(&k->view[i].pairs, gl);
        free(k->view[i].record);
        if (k->view[i].first)
            gl->DeleteTextures(1, &k->view[i].first);
    }
    free(k->view);
    k->view = NULL;
    k->n = 0;
    k->bytes = 0;
    free(k->scalar);
    k->scalar = NULL;
    k->values_serial = 0;
}

/* Is it a picture whose rays go where the mesh and the view alone say, and whose colours come from values of points? */
static bool is_plain(const tc_job *job)
{
    const tc_effects *e = job->effects;
    const tc_frame *f = job->frame;
    return job->software && job->driver->locks && !job->peel && !job->count && !job->planes && !job->cell_data &&
           !job->nonfinite && !job->masked && job->integrator != TC_INTEGRATOR_EXACT && !f->clip_near && !f->clip_far &&
           !f->ahead && !f->hidden && e && e->needs == 0 && !*e->shaders && !e->integrator && !tc_effects_have_frame(e);
}

tc_kept_view *tc_kept_find(tc_kept *k, const tc_job *job, uint64_t mesh_serial, uint64_t scalar_serial, int width,
                           int height)
{
    if (k->most == 0 || !is_plain(job))
        return NULL;
    if (k->mesh_serial != mesh_serial)
        tc_kept_clear(k, job->gl);
    k->mesh_serial = mesh_serial;
    tc_kept_view *view = NULL;
    for (int i = 0; i < k->n && !view; i++)
        if (k->view[i].width == width && k->view[i].height == height &&
            !memcmp(&k->view[i].frame, job->frame, sizeof *job->frame))
            view = &k->view[i];
    if (!view) {
        tc_kept_view *more = k->n < TC_KEPT_VIEWS ? tc_realloc(k->view, (size_t)k->n + 1, sizeof *more) : NULL;
        if (!more)
            return NULL;
        k->view = more;
        view = &k->view[k->n++];
        memset(view, 0, sizeof *view);
        memcpy(&view->frame, job->frame, sizeof *job->frame);
        view->width = width;
        view->height = height;
        view->scalar_serial = scalar_serial;
    }
    view->seen++;
    view->other = view->other || view->scalar_serial != scalar_serial;
    return view;
}

bool tc_kept_due(const tc_kept_view *view)
{
    return !view->recorded && !view->refused && view->seen >= (view->other ? SEEN_OTHER : SEEN_SAME);
}

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

static tc_status get_begin(GLuint *program, const tc_job *job, tc_error *err)
{
    const tc_program_source source = {"screen.vert", "kept_begin.frag", "", NULL, NULL};
    return tc_program_get(program, job->programs, &source, err);
}

tc_status tc_kept_compile(const tc_job *job, tc_error *err)
{
    GLuint unused;
    return get_begin(&unused, job, err);
}

/* Walks all rays; counts go to the framebuffer, with a view that has room the records to it. */
static tc_status walk_rays(const tc_job *job, GLuint framebuffer, const tc_kept_view *view, GLuint buffer,
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
        gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, RECORDS_BUFFER, buffer);
    }
    tc_pass_screen(gl);
    if (view)
        gl->MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    return tc_gl_check(gl, "recording walks", err);
}

/* From counts [n][2] to first [n][2] and the most cells; *sum gets the records, -1: they cannot be kept. Rays of no record have no walk. */
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

/* Room for so many records, and the places in it. */
static tc_status make_room(tc_kept *k, tc_kept_view *view, const tc_job *job, const int32_t *first, size_t n_record,
                           tc_error *err)
{
    const tc_gl *gl = job->gl;
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    const size_t bytes = n_record * (sizeof *view->record + PAIR_BYTES) + pixels * FIRST_BYTES;
    if (bytes > k->most || k->bytes > k->most - bytes || n_record > (size_t)gl->max_texture_buffer || n_record == 0) {
        view->refused = true;
        return TC_OK;
    }
    tc_status status =
        tc_texture_buffer_upload(&view->pairs, gl, NULL, n_record, PAIR_BYTES, GL_RG32F, "keeping walks", err);
    if (status != TC_OK)
        return status;
    view->record = tc_alloc(n_record, sizeof *view->record);
    if (!view->record)
        return tc_fail_memory(err, "kept walks", n_record, sizeof *view->record);
    view->n_record = n_record;
    view->first = tc_pass_new_texture(gl, view->width, view->height, GL_RG32I, GL_RG_INTEGER, GL_INT);
    gl->PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl->TexImage2D(GL_TEXTURE_2D, 0, GL_RG32I, view->width, view->height, 0, GL_RG_INTEGER, GL_INT, first);
    view->bytes = bytes;
    k->bytes += bytes;
    return tc_gl_check(gl, "keeping walks", err);
}

/* Walks all rays once more, and keeps what they write. */
static tc_status write_records(tc_kept_view *view, const tc_job *job, GLuint framebuffer, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const GLsizeiptr bytes = (GLsizeiptr)(view->n_record * sizeof *view->record);
    GLuint buffer;
    gl->GenBuffers(1, &buffer);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    memset(view->record, 0, (size_t)bytes);
    gl->BufferData(GL_SHADER_STORAGE_BUFFER, bytes, view->record, GL_STREAM_READ);
    tc_status status = walk_rays(job, framebuffer, view, buffer, err);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    if (status == TC_OK)
        gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, bytes, view->record);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    gl->DeleteBuffers(1, &buffer);
    for (size_t i = 0; i < view->n_record && status == TC_OK; i++) /* a ray that wrote less than it counted: not this way */
        view->refused = view->refused || !(view->record[i].weight[0] + view->record[i].weight[1] > 0);
    return status == TC_OK ? tc_gl_check(gl, "keeping walks", err) : status;
}

tc_status tc_kept_record(tc_kept *k, tc_kept_view *view, const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const size_t n = (size_t)view->width * (size_t)view->height;
    int32_t *count = tc_alloc(n, 2 * sizeof *count), *first = tc_alloc(n, 2 * sizeof *first);
    int64_t sum = 0, entered = 0;
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
    status = walk_rays(job, framebuffer, NULL, 0, err);
    if (status != TC_OK)
        goto done;
    gl->ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->ReadPixels(0, 0, view->width, view->height, GL_RG_INTEGER, GL_INT, count);
    place_records(&sum, &entered, &view->cells, first, count, n);
    view->refused = sum < 0 || tc_first_hit_entries(job) != entered;
    if (!view->refused)
        status = make_room(k, view, job, first, (size_t)sum, err);
    if (status == TC_OK && !view->refused)
        status = write_records(view, job, framebuffer, err);
    view->recorded = status == TC_OK && !view->refused;
    memcpy(view->rect, job->proposals->rect, sizeof view->rect);
done:
    if (framebuffer)
        gl->DeleteFramebuffers(1, &framebuffer);
    if (texture)
        gl->DeleteTextures(1, &texture);
    free(count);
    free(first);
    return status;
}

/* The scalars of all vertices, as the shaders have them. */
static tc_status read_scalars(tc_kept *k, const tc_job *job, uint64_t serial, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const size_t n = job->mesh->n_vertex;
    float *vertex = tc_alloc(n, 4 * sizeof *vertex), *scalar = tc_realloc(k->scalar, n, sizeof *scalar);
    if (scalar)
        k->scalar = scalar;
    if (!vertex || !scalar) {
        free(vertex);
        return tc_fail_memory(err, "values along kept walks", n, 5 * sizeof *vertex);
    }
    gl->BindBuffer(GL_TEXTURE_BUFFER, job->mesh->vertices.buffer);
    gl->GetBufferSubData(GL_TEXTURE_BUFFER, 0, (GLsizeiptr)(n * 4 * sizeof *vertex), vertex);
    gl->BindBuffer(GL_TEXTURE_BUFFER, 0);
    for (size_t i = 0; i < n; i++)
        scalar[i] = vertex[4 * i + 3];
    free(vertex);
    k->values_serial = serial;
    return tc_gl_check(gl, "values along kept walks", err);
}

typedef struct pair_job {
    const tc_kept_face *record;
    const float *scalar;
    float *pair;
} pair_job;

/* As walk_face_point (stepper.glsl) sums, in its order. */
static void make_pairs(void *context, size_t begin, size_t end, int worker)
{
    const pair_job *j = context;
    (void)worker;
    for (size_t i = begin; i < end; i++) {
        const tc_kept_face *r = &j->record[i];
        const float *w = r->weight;
        float sum = w[0] * j->scalar[r->vertex[0]] + w[1] * j->scalar[r->vertex[1]];
        sum += w[2] * j->scalar[r->vertex[2]];
        j->pair[2 * i] = sum * (1 / (w[0] + w[1] + w[2]));
        j->pair[2 * i + 1] = r->length;
    }
}

tc_status tc_kept_values(tc_kept *k, tc_kept_view *view, const tc_job *job, uint64_t scalar_serial, int threads,
                         tc_error *err)
{
    const tc_gl *gl = job->gl;
    if (view->values_serial == scalar_serial)
        return TC_OK;
    tc_status status = k->values_serial == scalar_serial ? TC_OK : read_scalars(k, job, scalar_serial, err);
    if (status != TC_OK)
        return status;
    float *pair = tc_alloc(view->n_record, PAIR_BYTES);
    if (!pair)
        return tc_fail_memory(err, "values along kept walks", view->n_record, PAIR_BYTES);
    pair_job j = {view->record, k->scalar, pair};
    tc_parallel_for(view->n_record, CHUNK, threads, make_pairs, &j);
    gl->BindBuffer(GL_TEXTURE_BUFFER, view->pairs.buffer);
    gl->BufferSubData(GL_TEXTURE_BUFFER, 0, (GLsizeiptr)(view->n_record * PAIR_BYTES), pair);
    gl->BindBuffer(GL_TEXTURE_BUFFER, 0);
    free(pair);
    view->values_serial = scalar_serial;
    return tc_gl_check(gl, "values along kept walks", err);
}

tc_status tc_kept_begin(const tc_job *job, tc_error *err)
{
    const tc_gl *gl = job->gl;
    const tc_state *s = job->state;
    const GLint entry[4] = {0, 0, -1, 0};
    GLuint program;
    tc_status status = get_begin(&program, job, err);
    if (status != TC_OK)
        return status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->set[0].framebuffer);
    gl->ClearBufferiv(GL_COLOR, TC_STATE_AT, entry);
    gl->BindFramebuffer(GL_FRAMEBUFFER, s->hit_framebuffer[0]);
    gl->Viewport(0, 0, s->width, s->height);
    gl->Disable(GL_DEPTH_TEST);
    gl->UseProgram(program);
    tc_pass_texture(gl, program, "kept_first", 4, GL_TEXTURE_2D, job->kept->first);
    tc_pass_screen(gl);
    return tc_gl_check(gl, "beginning kept walks", err);
}
