/* kept.c: the views whose walks are kept, and the scalars along them. */
#include "gpu/kept.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "gpu/effect.h"

#include <stdlib.h>
#include <string.h>

enum { SEEN_OTHER = 2, SEEN_SAME = 3, CHUNK = 1 << 15 };

void tc_kept_clear(tc_kept *k, const tc_gl *gl)
{
    for (int i = 0; i < k->n; i++) {
        tc_texture_buffer_finish(&k->view[i].pairs, gl);
        gl->DeleteBuffers(1, &k->view[i].record); /* 0 is ignored */
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
           !job->nonfinite && !job->masked && job->state->color_bits == 32 &&
           job->integrator != TC_INTEGRATOR_EXACT && !f->clip_near && !f->clip_far &&
           !f->ahead && !f->hidden && e && tc_effects_are_plain(e);
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

bool tc_kept_due(const tc_kept *k, const tc_kept_view *view)
{
    return !view->recorded && !view->refused &&
           (k->at_once || view->seen >= (view->other ? SEEN_OTHER : SEEN_SAME));
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
    /* In software both lie in memory already. */
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, view->record);
    gl->BindBuffer(GL_TEXTURE_BUFFER, view->pairs.buffer);
    pair_job j = {.scalar = k->scalar};
    j.record = gl->MapBufferRange(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(view->n_record * sizeof *j.record),
                                  GL_MAP_READ_BIT);
    j.pair = gl->MapBufferRange(GL_TEXTURE_BUFFER, 0, (GLsizeiptr)view->pairs.bytes, GL_MAP_WRITE_BIT);
    if (j.record && j.pair)
        tc_parallel_for(view->n_record, CHUNK, threads, make_pairs, &j);
    else
        status = tc_fail(err, TC_E_GL, "%s does not give access to the walks that are kept", gl->renderer);
    if (j.pair)
        gl->UnmapBuffer(GL_TEXTURE_BUFFER);
    if (j.record)
        gl->UnmapBuffer(GL_SHADER_STORAGE_BUFFER);
    gl->BindBuffer(GL_TEXTURE_BUFFER, 0);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    if (status != TC_OK)
        return status;
    view->values_serial = scalar_serial;
    return tc_gl_check(gl, "values along kept walks", err);
}
