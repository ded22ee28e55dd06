/* geometry.c: triangles and lines in a picture: a mesh's outline, boundary wireframe and boundary surface; checks. */
#include "scene/geometry.h"

#include "core/memory.h"
#include "mesh/boundary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TC_MOST_WIDTH = 256 }; /* pixels */

void tc_geometry_finish(tc_geometry *g)
{
    if (!g)
        return;
    free((void *)(uintptr_t)g->vertex);
    free((void *)(uintptr_t)g->triangle);
    free((void *)(uintptr_t)g->line);
    *g = (tc_geometry){0};
}

/* ------------------------------------------------------------------------------------------ of a mesh */

/* Corner i of a box: bit 0 chooses x's end, bit 1 y's, bit 2 z's. */
static tc_status make_outline(tc_geometry *out, const double bounds[6], tc_error *err)
{
    double *vertex = tc_alloc(8, 3 * sizeof *vertex);
    int32_t *line = tc_alloc(12, 2 * sizeof *line);
    out->vertex = vertex;
    out->line = line;
    if (!vertex || !line)
        return tc_fail_memory(err, "an outline", 12, 3 * sizeof *vertex);
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++)
            vertex[3 * i + k] = bounds[2 * k + (i >> k & 1)];
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 8; i++)
            if (!(i >> k & 1)) {
                *line++ = i;
                *line++ = i | 1 << k;
            }
    out->n_vertex = 8;
    out->n_line = 12;
    return TC_OK;
}

static tc_status copy_vertices(tc_geometry *out, const tc_boundary *b, const tc_mesh *mesh, tc_error *err)
{
    double *vertex = tc_alloc(b->n_vertex, 3 * sizeof *vertex);
    if (!vertex)
        return tc_fail_memory(err, "a boundary's vertices", b->n_vertex, 3 * sizeof *vertex);
    for (size_t i = 0; i < b->n_vertex; i++)
        memcpy(vertex + 3 * i, mesh->vertex + 3 * (size_t)b->vertex[i], 3 * sizeof *vertex);
    out->vertex = vertex;
    out->n_vertex = b->n_vertex;
    return TC_OK;
}

static int compare_ids(const void *a, const void *b)
{
    const int32_t p = *(const int32_t *)a, q = *(const int32_t *)b;
    return (p > q) - (p < q);
}

/* The edges of the faces, each once: one bucket per smaller vertex, sorted in itself. */
static tc_status make_wireframe(tc_geometry *out, const tc_boundary *b, tc_error *err)
{
    const size_t n = 3 * b->n_face;
    size_t *start = tc_calloc(b->n_vertex + 2, sizeof *start);
    int32_t *larger = tc_alloc(n, sizeof *larger), *line = NULL;
    tc_status status = TC_OK;
    size_t n_line = 0;
    if (!start || !larger) {
        status = tc_fail_memory(err, "a boundary's edges", n, sizeof *larger);
        goto done;
    }
    for (int fill = 0; fill < 2; fill++) {
        for (size_t i = 0; i < n; i++) {
            const int32_t p = b->face[i], q = b->face[i % 3 == 2 ? i - 2 : i + 1];
            if (fill)
                larger[start[(p < q ? p : q) + 1]++] = p < q ? q : p;
            else
                start[(p < q ? p : q) + 2]++;
        }
        for (size_t v = 0; !fill && v < b->n_vertex; v++)
            start[v + 2] += start[v + 1];
    }
    line = tc_alloc(n, 2 * sizeof *line);
    if (!line) {
        status = tc_fail_memory(err, "a boundary's edges", n, 2 * sizeof *line);
        goto done;
    }
    for (size_t v = 0; v < b->n_vertex; v++) {
        qsort(larger + start[v], start[v + 1] - start[v], sizeof *larger, compare_ids);
        for (size_t i = start[v]; i < start[v + 1]; i++)
            if (i == start[v] || larger[i] != larger[i - 1]) {
                line[2 * n_line] = (int32_t)v;
                line[2 * n_line++ + 1] = larger[i];
            }
    }
    int32_t *less = tc_realloc(line, n_line, 2 * sizeof *line);
    out->line = less ? less : line;
    out->n_line = n_line;
done:
    free(start);
    free(larger);
    return status;
}

tc_status tc_geometry_from_mesh(tc_geometry *out, const tc_mesh *mesh, tc_mesh_part part, tc_error *err)
{
    if (!out)
        return tc_fail(err, TC_E_ARG, "tc_geometry_from_mesh: out is NULL");
    *out = (tc_geometry){.opacity = 1, .width = 1};
    if (!mesh || !mesh->prepared)
        return tc_fail(err, TC_E_ARG,
                       "a mesh must be prepared before its outline or boundary can be told; call "
                       "tc_mesh_prepare");
    tc_boundary boundary = {0};
    tc_status status;
    switch (part) {
    case TC_PART_OUTLINE:
        status = make_outline(out, mesh->report.bounds, err);
        break;
    case TC_PART_WIREFRAME:
    case TC_PART_SURFACE:
        status = tc_boundary_build(&boundary, mesh, mesh->n_tet, err);
        if (!status)
            status = copy_vertices(out, &boundary, mesh, err);
        if (!status && part == TC_PART_WIREFRAME)
            status = make_wireframe(out, &boundary, err);
        if (!status && part == TC_PART_SURFACE) {
            out->triangle = boundary.face;
            out->n_triangle = boundary.n_face;
            out->lit = true;
            boundary.face = NULL;
        }
        break;
    default:
        status = tc_fail(err, TC_E_ARG, "a mesh has no part %d; ask for its outline, wireframe or surface", (int)part);
    }
    tc_boundary_finish(&boundary);
    if (status)
        tc_geometry_finish(out);
    return status;
}

/* ------------------------------------------------------------------------------------------ checks */

static bool share(double v)
{
    return v >= 0 && v <= 1; /* not NaN */
}

/* The first of n ids that is not below n_vertex; n: none. */
static size_t first_wrong(const int32_t *id, size_t n, size_t n_vertex)
{
    for (size_t i = 0; i < n; i++)
        if (id[i] < 0 || (size_t)id[i] >= n_vertex)
            return i;
    return n;
}

const char *tc_geometry_wrong(char *why, size_t capacity, const tc_geometry *g)
{
    const size_t n_id[2] = {3 * g->n_triangle, 2 * g->n_line};
    const int32_t *id[2] = {g->triangle, g->line};
    static const char *const what[2] = {"triangle", "line"};
    if ((g->n_vertex && !g->vertex) || (n_id[0] && !id[0]) || (n_id[1] && !id[1])) {
        snprintf(why, capacity, "a geometry counts vertices, triangles or lines that it does not hold; set its arrays");
        return why;
    }
    if (!share(g->color[0]) || !share(g->color[1]) || !share(g->color[2]) || !share(g->opacity)) {
        snprintf(why, capacity, "a geometry's colour %g,%g,%g and opacity %g must be from 0 to 1", g->color[0],
                 g->color[1], g->color[2], g->opacity);
        return why;
    }
    if (g->n_line && !(g->width > 0 && g->width <= TC_MOST_WIDTH)) {
        snprintf(why, capacity, "a geometry's lines are %g pixels wide; give a width above 0 and up to %d", g->width,
                 TC_MOST_WIDTH);
        return why;
    }
    for (size_t i = 0; i < 3 * g->n_vertex; i++)
        if (!isfinite(g->vertex[i])) {
            snprintf(why, capacity, "vertex %zu of a geometry is not finite; leave it out, with what uses it", i / 3);
            return why;
        }
    for (int k = 0; k < 2; k++) {
        const size_t bad = first_wrong(id[k], n_id[k], g->n_vertex);
        if (bad < n_id[k]) {
            snprintf(why, capacity, "%s %zu of a geometry refers to vertex %d, but it has %zu vertices", what[k],
                     bad / (size_t)(3 - k), (int)id[k][bad], g->n_vertex);
            return why;
        }
    }
    return NULL;
}
