/* geometry.c: the triangles and lines of a look as buffers for the GPU. */
#include "gpu/geometry.h"

#include "core/memory.h"
#include "core/vec.h"

#include <stdlib.h>
#include <string.h>

enum { MOST_TRIANGLES = INT32_MAX / 3, MOST_LINES = INT32_MAX / 6 }; /* their corners are counted in an int */

typedef struct arrays {
    size_t n_vertex, n_triangle, n_line;
    float *vertex, *plane;    /* [n][4] */
    int32_t *triangle, *line; /* [n][4] */
} arrays;

static tc_hash hash_of(const tc_geometry *geometry, int n, const double center[3], double scale)
{
    tc_hash sum = tc_hash_bytes(center, 3 * sizeof *center, (uint64_t)n);
    for (int i = 0; i < n; i++) {
        const tc_geometry *g = &geometry[i];
        const struct {
            uint64_t vertex[2], triangle[2], line[2], size[3];
        } all = {
            {tc_hash_bytes(g->vertex, 3 * g->n_vertex * sizeof(double), sum.word[0]).word[0], sum.word[1]},
            {tc_hash_bytes(g->triangle, 3 * g->n_triangle * sizeof(int32_t), sum.word[0]).word[0], 0},
            {tc_hash_bytes(g->line, 2 * g->n_line * sizeof(int32_t), sum.word[0]).word[0], 0},
            {g->n_vertex, g->n_triangle, g->n_line},
        };
        sum = tc_hash_bytes(&all, sizeof all, sum.word[0]);
    }
    const struct {
        uint64_t word[2];
        double scale;
    } whole = {{sum.word[0], sum.word[1]}, scale};
    return tc_hash_bytes(&whole, sizeof whole, 0);
}

/* The plane of a triangle whose corners are in mesh space; 0 for one without area. */
static void find_plane(float out[4], double x[3][3])
{
    double a[3], b[3], n[3], at = 0;
    tc_vec_sub(a, x[1], x[0]);
    tc_vec_sub(b, x[2], x[0]);
    tc_vec_cross(n, a, b);
    tc_vec_normalize(n);
    for (int k = 0; k < 3; k++)
        at += tc_vec_dot(n, x[k]) / 3;
    for (int k = 0; k < 3; k++)
        out[k] = (float)n[k];
    out[3] = (float)at;
}

/* Behind what is in out; ids are moved behind the vertices that are there. */
static void add(arrays *out, const tc_geometry *g, const double center[3], double scale)
{
    const int32_t base = (int32_t)out->n_vertex;
    float *vertex = out->vertex + 4 * out->n_vertex;
    for (size_t i = 0; i < g->n_vertex; i++) {
        for (int k = 0; k < 3; k++)
            vertex[4 * i + (size_t)k] = (float)((g->vertex[3 * i + (size_t)k] - center[k]) * scale);
        vertex[4 * i + 3] = 0;
    }
    for (size_t i = 0; i < g->n_triangle; i++) {
        int32_t *to = out->triangle + 4 * (out->n_triangle + i);
        double x[3][3];
        for (int c = 0; c < 3; c++) {
            const int32_t id = g->triangle[3 * i + (size_t)c];
            to[c] = base + id;
            for (int k = 0; k < 3; k++)
                x[c][k] = (g->vertex[3 * (size_t)id + (size_t)k] - center[k]) * scale;
        }
        to[3] = 0;
        find_plane(out->plane + 4 * (out->n_triangle + i), x);
    }
    for (size_t i = 0; i < g->n_line; i++) {
        int32_t *to = out->line + 4 * (out->n_line + i);
        to[0] = base + g->line[2 * i];
        to[1] = base + g->line[2 * i + 1];
        to[2] = to[3] = 0;
    }
    out->n_vertex += g->n_vertex;
    out->n_triangle += g->n_triangle;
    out->n_line += g->n_line;
}

static tc_status upload(tc_gpu_geometry *g, const tc_gl *gl, const arrays *all, tc_error *err)
{
    static const char what[] = "uploading the geometry";
    tc_status status =
        tc_texture_buffer_upload(&g->vertices, gl, all->vertex, all->n_vertex, 16, GL_RGBA32F, what, err);
    if (status == TC_OK && all->n_triangle)
        status = tc_texture_buffer_upload(&g->triangles, gl, all->triangle, all->n_triangle, 16, GL_RGBA32I, what, err);
    if (status == TC_OK && all->n_triangle)
        status = tc_texture_buffer_upload(&g->planes, gl, all->plane, all->n_triangle, 16, GL_RGBA32F, what, err);
    if (status == TC_OK && all->n_line)
        status = tc_texture_buffer_upload(&g->lines, gl, all->line, all->n_line, 16, GL_RGBA32I, what, err);
    return status;
}

static tc_status pack_and_upload(tc_gpu_geometry *g, const tc_gl *gl, const tc_geometry *geometry, int n,
                                 const double center[3], double scale, tc_error *err)
{
    arrays all = {0};
    size_t n_vertex = 0, n_triangle = 0, n_line = 0;
    for (int i = 0; i < n; i++) {
        n_vertex += geometry[i].n_vertex;
        n_triangle += geometry[i].n_triangle;
        n_line += geometry[i].n_line;
    }
    if (n_vertex > INT32_MAX || n_triangle > MOST_TRIANGLES || n_line > MOST_LINES)
        return tc_fail(
            err, TC_E_MEMORY,
            "a picture's geometry has %zu vertices, %zu triangles and %zu lines, more than can be drawn; show "
            "less of it",
            n_vertex, n_triangle, n_line);
    tc_status status = TC_OK;
    g->part = tc_calloc((size_t)n, sizeof *g->part);
    all.vertex = tc_alloc(n_vertex, 4 * sizeof *all.vertex);
    all.triangle = tc_alloc(n_triangle, 4 * sizeof *all.triangle);
    all.plane = tc_alloc(n_triangle, 4 * sizeof *all.plane);
    all.line = tc_alloc(n_line, 4 * sizeof *all.line);
    if (!g->part || !all.vertex || !all.triangle || !all.plane || !all.line) {
        status = tc_fail_memory(err, "the geometry of a picture", n_vertex + 2 * n_triangle + n_line, 16);
        goto done;
    }
    g->n_part = n;
    for (int i = 0; i < n; i++) {
        g->part[i] = (tc_gpu_geometry_part){.first_triangle = (GLint)all.n_triangle,
                                            .n_triangle = (GLint)geometry[i].n_triangle,
                                            .first_line = (GLint)all.n_line,
                                            .n_line = (GLint)geometry[i].n_line};
        add(&all, &geometry[i], center, scale);
    }
    status = upload(g, gl, &all, err);
done:
    free(all.vertex);
    free(all.triangle);
    free(all.plane);
    free(all.line);
    return status;
}

tc_status tc_gpu_geometry_update(tc_gpu_geometry *g, const tc_gl *gl, const tc_geometry *geometry, int n,
                                 const double center[3], double scale, tc_error *err)
{
    const tc_hash hash = hash_of(geometry, n, center, scale);
    if (g->there && memcmp(&hash, &g->hash, sizeof hash) == 0)
        return TC_OK;
    tc_gpu_geometry_finish(g, gl);
    tc_status status = pack_and_upload(g, gl, geometry, n, center, scale, err);
    if (status != TC_OK) {
        tc_gpu_geometry_finish(g, gl);
        return status;
    }
    g->hash = hash;
    g->there = true;
    return TC_OK;
}

size_t tc_gpu_geometry_bytes(const tc_gpu_geometry *g)
{
    return g->vertices.bytes + g->triangles.bytes + g->planes.bytes + g->lines.bytes;
}

void tc_gpu_geometry_finish(tc_gpu_geometry *g, const tc_gl *gl)
{
    tc_texture_buffer_finish(&g->vertices, gl);
    tc_texture_buffer_finish(&g->triangles, gl);
    tc_texture_buffer_finish(&g->planes, gl);
    tc_texture_buffer_finish(&g->lines, gl);
    free(g->part);
    memset(g, 0, sizeof *g);
}
