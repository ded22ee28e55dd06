/* upload.c: packed arrays and transfer functions → textures. */
#include "gpu/upload.h"

#include "core/memory.h"
#include "core/parallel.h"

#include <stdlib.h>
#include <string.h>

enum { POISON_BYTES = 4096 };

/* For tests (gl->poison): data, and NaN behind it, where nothing is to be read. */
static tc_status upload_poisoned(const tc_texture_buffer *b, const tc_gl *gl, const void *data, const char *what,
                                 tc_error *err)
{
    const uint32_t nan_bits = 0x7fc00000u;
    unsigned char *padded = tc_alloc(b->bytes + POISON_BYTES, 1);
    if (!padded)
        return tc_fail_memory(err, what, b->bytes + POISON_BYTES, 1);
    if (b->bytes > 0 && data)
        memcpy(padded, data, b->bytes);
    for (size_t i = data ? b->bytes : 0; i < b->bytes + POISON_BYTES; i += sizeof nan_bits)
        memcpy(padded + i, &nan_bits, sizeof nan_bits);
    gl->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)(b->bytes + POISON_BYTES), padded, GL_STATIC_DRAW);
    free(padded);
    return TC_OK;
}

tc_status tc_texture_buffer_upload(tc_texture_buffer *out, const tc_gl *gl, const void *data, size_t n_texel,
                               size_t texel_bytes, GLenum format, const char *what, tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (n_texel > (size_t)gl->max_texture_buffer)
        return tc_fail(err, TC_E_MEMORY, "%s needs %zu texels, %s offers %d in a texture buffer; use a smaller mesh",
                       what, n_texel, gl->renderer, gl->max_texture_buffer);
    out->bytes = n_texel * texel_bytes;
    gl->GenBuffers(1, &out->buffer);
    gl->BindBuffer(GL_TEXTURE_BUFFER, out->buffer);
    if (!gl->poison)
        gl->BufferData(GL_TEXTURE_BUFFER, (GLsizeiptr)out->bytes, data, GL_STATIC_DRAW);
    else if (upload_poisoned(out, gl, data, what, err) != TC_OK)
        return TC_E_MEMORY;
    gl->GenTextures(1, &out->texture);
    gl->BindTexture(GL_TEXTURE_BUFFER, out->texture);
    gl->TexBuffer(GL_TEXTURE_BUFFER, format, out->buffer);
    gl->BindBuffer(GL_TEXTURE_BUFFER, 0);
    return tc_gl_check(gl, what, err);
}

void tc_texture_buffer_finish(tc_texture_buffer *b, const tc_gl *gl)
{
    if (b->texture)
        gl->DeleteTextures(1, &b->texture);
    if (b->buffer)
        gl->DeleteBuffers(1, &b->buffer);
    memset(b, 0, sizeof *b);
}

static tc_status upload_planes(tc_gpu_mesh *out, const tc_gl *gl, const tc_pack_planes *planes, tc_error *err)
{
    size_t n = planes->n_cell;
    tc_status status = tc_texture_buffer_upload(&out->planes_vertices, gl, planes->vertex, 4 * n, 16, GL_RGBA32F,
                                     "uploading the cells' vertices", err);
    if (status == TC_OK)
        status = tc_texture_buffer_upload(&out->planes_normals, gl, planes->normal, 4 * n, 16, GL_RGBA32F,
                               "uploading the faces' normals", err);
    if (status == TC_OK)
        status = tc_texture_buffer_upload(&out->planes_neighbours, gl, planes->neighbour, 4 * n, 4, GL_R32I,
                               "uploading the cells' neighbours", err);
    if (status == TC_OK)
        status = tc_texture_buffer_upload(&out->planes_scalars, gl, planes->scalar, n, 16, GL_RGBA32F,
                               "uploading the cells' gradients", err);
    return status;
}

tc_status tc_gpu_mesh_upload(tc_gpu_mesh *out, const tc_gl *gl, const tc_pack *pack, const tc_pack_planes *planes,
                             tc_error *err)
{
    double start = tc_now_ms();
    memset(out, 0, sizeof *out);
    out->n_cell = pack->n_cell;
    out->n_real = pack->n_real;
    out->n_vertex = pack->n_vertex;
    out->n_face = pack->n_face;
    tc_status status =
        planes ? upload_planes(out, gl, planes, err)
               : tc_texture_buffer_upload(&out->cells, gl, pack->cell, pack->n_cell, 16, GL_RGBA32I, "uploading the cells", err);
    if (status == TC_OK)
        status = tc_texture_buffer_upload(&out->vertices, gl, pack->vertex, pack->n_vertex, 16, GL_RGBA32F,
                               "uploading the vertices", err);
    if (status == TC_OK)
        status = tc_texture_buffer_upload(&out->faces, gl, pack->face, pack->n_face, 16, GL_RGBA32I,
                               "uploading the boundary faces", err);
    if (status == TC_OK && pack->cell_scalar)
        status = tc_texture_buffer_upload(&out->cell_scalar, gl, pack->cell_scalar, pack->n_real, 4, GL_R32F,
                               "uploading the cell data", err);
    if (status != TC_OK)
        tc_gpu_mesh_finish(out, gl);
    out->ms = tc_now_ms() - start;
    return status;
}

/* Other contents of the same size. */
static void replace_buffer(const tc_texture_buffer *b, const tc_gl *gl, const void *data)
{
    gl->BindBuffer(GL_TEXTURE_BUFFER, b->buffer);
    gl->BufferSubData(GL_TEXTURE_BUFFER, 0, (GLsizeiptr)b->bytes, data);
    gl->BindBuffer(GL_TEXTURE_BUFFER, 0);
}

tc_status tc_gpu_mesh_values(tc_gpu_mesh *mesh, size_t *bytes, const tc_gl *gl, const tc_pack *pack, tc_error *err)
{
    double start = tc_now_ms();
    bool had_cells = mesh->cell_scalar.texture != 0;
    tc_status status = TC_OK;
    *bytes = 0;
    if (!had_cells || !pack->cell_scalar) { /* with cell data vertices hold 0 */
        replace_buffer(&mesh->vertices, gl, pack->vertex);
        *bytes += mesh->vertices.bytes;
    }
    if (had_cells && pack->cell_scalar)
        replace_buffer(&mesh->cell_scalar, gl, pack->cell_scalar);
    else if (had_cells)
        tc_texture_buffer_finish(&mesh->cell_scalar, gl);
    else if (pack->cell_scalar)
        status = tc_texture_buffer_upload(&mesh->cell_scalar, gl, pack->cell_scalar, pack->n_real, 4, GL_R32F,
                               "uploading the cell data", err);
    *bytes += mesh->cell_scalar.bytes;
    if (status == TC_OK)
        status = tc_gl_check(gl, "uploading new values", err);
    mesh->ms = tc_now_ms() - start;
    return status;
}

size_t tc_gpu_mesh_bytes(const tc_gpu_mesh *m)
{
    return m->cells.bytes + m->vertices.bytes + m->faces.bytes + m->cell_scalar.bytes + m->planes_vertices.bytes +
           m->planes_normals.bytes + m->planes_neighbours.bytes + m->planes_scalars.bytes;
}

void tc_gpu_mesh_finish(tc_gpu_mesh *mesh, const tc_gl *gl)
{
    tc_texture_buffer_finish(&mesh->cells, gl);
    tc_texture_buffer_finish(&mesh->vertices, gl);
    tc_texture_buffer_finish(&mesh->faces, gl);
    tc_texture_buffer_finish(&mesh->cell_scalar, gl);
    tc_texture_buffer_finish(&mesh->planes_vertices, gl);
    tc_texture_buffer_finish(&mesh->planes_normals, gl);
    tc_texture_buffer_finish(&mesh->planes_neighbours, gl);
    tc_texture_buffer_finish(&mesh->planes_scalars, gl);
}

static GLuint linear_texture(const tc_gl *gl, GLenum target)
{
    GLuint texture;
    gl->GenTextures(1, &texture);
    gl->BindTexture(target, texture);
    gl->TexParameteri(target, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl->TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl->TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(target, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(target, GL_TEXTURE_MAX_LEVEL, 0);
    return texture;
}

tc_status tc_gpu_table_upload(tc_gpu_transfer *out, const tc_gl *gl, const tc_table *table, tc_error *err)
{
    memset(out, 0, sizeof *out);
    for (int k = 0; k < 3; k++)
        if (table->size[k] > gl->max_texture_3d)
            return tc_fail(err, TC_E_ARG,
                           "a table %d entries wide is too large for %s (%d); use a smaller --table-size",
                           table->size[k], gl->renderer, gl->max_texture_3d);
    GLenum internal = table->format == TC_TABLE_8 ? GL_RGBA8 : table->format == TC_TABLE_16F ? GL_RGBA16F : GL_RGBA32F;
    GLenum type = table->format == TC_TABLE_8     ? GL_UNSIGNED_BYTE
                  : table->format == TC_TABLE_16F ? GL_HALF_FLOAT
                                                  : GL_FLOAT;
    out->table = linear_texture(gl, GL_TEXTURE_3D);
    out->bytes = table->bytes;
    gl->TexImage3D(GL_TEXTURE_3D, 0, (GLint)internal, table->size[0], table->size[1], table->size[2], 0, GL_RGBA, type,
                   table->rgba);
    tc_status status = tc_gl_check(gl, "uploading the pre-integration table", err);
    if (status != TC_OK)
        tc_gpu_transfer_finish(out, gl);
    return status;
}

tc_status tc_gpu_running_upload(tc_gpu_transfer *out, const tc_gl *gl, const tc_running *running, tc_error *err)
{
    memset(out, 0, sizeof *out);
    size_t n = (size_t)running->n;
    float *nodes = tc_alloc(n, 8 * sizeof *nodes);
    if (!nodes)
        return tc_fail_memory(err, "the running integrals", n, 8 * sizeof *nodes);
    for (size_t i = 0; i < n; i++) {
        for (size_t k = 0; k < 4; k++)
            nodes[8 * i + k] = (float)(running->point[4 * i + k] - running->mean[k]);
        memcpy(nodes + 8 * i + 4, running->cumulative + 4 * i, 4 * sizeof *nodes);
    }
    tc_status status =
        tc_texture_buffer_upload(&out->nodes, gl, nodes, 2 * n, 16, GL_RGBA32F, "uploading the running integrals", err);
    out->bytes = out->nodes.bytes;
    free(nodes);
    if (status != TC_OK)
        tc_gpu_transfer_finish(out, gl);
    return status;
}

tc_status tc_gpu_means_upload(tc_gpu_transfer *out, const tc_gl *gl, const tc_means *means, tc_error *err)
{
    tc_status status = tc_texture_buffer_upload(&out->nodes, gl, means->cell, 3 * (size_t)means->n + 2 * (size_t)means->n_step, 16,
                                     GL_RGBA32F, "uploading a transfer function's means", err);
    out->bytes += out->nodes.bytes;
    if (status != TC_OK)
        tc_gpu_transfer_finish(out, gl);
    return status;
}

tc_status tc_gpu_pieces_upload(tc_gpu_transfer *out, const tc_gl *gl, const tc_pieces *pieces, tc_error *err)
{
    _Static_assert(sizeof(tc_piece_end) == 48, "three texels an end");
    tc_status status = tc_texture_buffer_upload(&out->pieces, gl, pieces->end, 3 * (pieces->n + 1), 16, GL_RGBA32F,
                                     "uploading the pieces of a transfer function", err);
    out->bytes += out->pieces.bytes;
    if (status == TC_OK) {
        gl->GenTextures(1, &out->piece_floats);
        gl->BindTexture(GL_TEXTURE_BUFFER, out->piece_floats);
        gl->TexBuffer(GL_TEXTURE_BUFFER, GL_R32F, out->pieces.buffer);
        status = tc_gl_check(gl, "uploading the pieces of a transfer function", err);
    }
    if (status != TC_OK)
        tc_gpu_transfer_finish(out, gl);
    return status;
}

void tc_gpu_transfer_finish(tc_gpu_transfer *transfer, const tc_gl *gl)
{
    if (transfer->table)
        gl->DeleteTextures(1, &transfer->table);
    tc_texture_buffer_finish(&transfer->nodes, gl);
    if (transfer->piece_floats)
        gl->DeleteTextures(1, &transfer->piece_floats);
    tc_texture_buffer_finish(&transfer->pieces, gl);
    memset(transfer, 0, sizeof *transfer);
}
