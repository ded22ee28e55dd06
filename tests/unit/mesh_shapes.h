/* mesh_shapes.h: small hand-made meshes for the tests of src/mesh. Include after cmocka. */
#ifndef TC_TESTS_MESH_SHAPES_H
#define TC_TESTS_MESH_SHAPES_H

#include "mesh/mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A mesh under construction. */
typedef struct shape {
    size_t n_vertex, n_tet, vertex_room, tet_room;
    double *vertex;
    int32_t *tet;
} shape;

static inline int32_t shape_vertex(shape *s, double x, double y, double z)
{
    if (s->n_vertex == s->vertex_room) {
        s->vertex_room = 2 * s->vertex_room + 64;
        s->vertex = realloc(s->vertex, s->vertex_room * 3 * sizeof *s->vertex);
        assert_non_null(s->vertex);
    }
    double *p = s->vertex + 3 * s->n_vertex;
    p[0] = x, p[1] = y, p[2] = z;
    return (int32_t)s->n_vertex++;
}

static inline void shape_tet(shape *s, int32_t a, int32_t b, int32_t c, int32_t d)
{
    if (s->n_tet == s->tet_room) {
        s->tet_room = 2 * s->tet_room + 64;
        s->tet = realloc(s->tet, s->tet_room * 4 * sizeof *s->tet);
        assert_non_null(s->tet);
    }
    int32_t *t = s->tet + 4 * s->n_tet++;
    t[0] = a, t[1] = b, t[2] = c, t[3] = d;
}

/* The six Kuhn tets of grid cell (i, j, k); id(i, j, k) of a grid of (nx+1)(ny+1)(nz+1) vertices made by shape_grid. */
static inline void shape_cell(shape *s, const int n[3], int i, int j, int k)
{
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int o = 0; o < 6; o++) {
        int at[3] = {i, j, k};
        int32_t v[4];
        for (int a = 0;; a++) {
            v[a] = (int32_t)((at[2] * (n[1] + 1) + at[1]) * (n[0] + 1) + at[0]);
            if (a == 3)
                break;
            at[order[o][a]]++;
        }
        shape_tet(s, v[0], v[1], v[2], v[3]);
    }
}

/* Vertices of a grid of n cells, and the Kuhn tets of those cells that keep (or all, keep NULL) says to keep. */
static inline void shape_grid(shape *s, const int n[3], bool (*keep)(int i, int j, int k))
{
    for (int k = 0; k <= n[2]; k++)
        for (int j = 0; j <= n[1]; j++)
            for (int i = 0; i <= n[0]; i++)
                shape_vertex(s, i, j, k);
    for (int k = 0; k < n[2]; k++)
        for (int j = 0; j < n[1]; j++)
            for (int i = 0; i < n[0]; i++)
                if (!keep || keep(i, j, k))
                    shape_cell(s, n, i, j, k);
}

static inline tc_mesh *shape_mesh(const shape *s, const double *scalar, tc_association association)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    tc_mesh_arrays arrays = {.n_vertex = s->n_vertex,
                             .vertex = s->vertex,
                             .n_tet = s->n_tet,
                             .tet = s->tet,
                             .scalar = scalar,
                             .association = association};
    if (tc_mesh_create(&mesh, &arrays, &err) != TC_OK)
        fail_msg("tc_mesh_create: %s", err.text);
    return mesh;
}

static inline void shape_finish(shape *s)
{
    free(s->vertex);
    free(s->tet);
    *s = (shape){0};
}

static inline tc_mesh_report shape_prepare(tc_mesh *mesh, tc_reentry reentry)
{
    tc_error err = {0};
    tc_prepare_options options = {.reentry = reentry};
    if (tc_mesh_prepare(mesh, &options, NULL, &err) != TC_OK)
        fail_msg("tc_mesh_prepare: %s", err.text);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    return report;
}

static inline void shape_sort3(int32_t *v)
{
    for (int a = 1; a < 3; a++)
        for (int b = a; b > 0 && v[b] < v[b - 1]; b--) {
            int32_t k = v[b];
            v[b] = v[b - 1], v[b - 1] = k;
        }
}

static inline void shape_face(int32_t out[3], const int32_t *tet, int f)
{
    for (int i = 0, n = 0; i < 4; i++)
        if (i != f)
            out[n++] = tet[i];
    shape_sort3(out);
}

static inline double shape_volume6(const tc_mesh *m, const int32_t *t)
{
    const double *a = m->vertex + 3 * (size_t)t[0], *b = m->vertex + 3 * (size_t)t[1];
    const double *c = m->vertex + 3 * (size_t)t[2], *d = m->vertex + 3 * (size_t)t[3];
    double u[3], v[3], w[3];
    for (int k = 0; k < 3; k++)
        u[k] = b[k] - a[k], v[k] = c[k] - a[k], w[k] = d[k] - a[k];
    return (u[1] * v[2] - u[2] * v[1]) * w[0] + (u[2] * v[0] - u[0] * v[2]) * w[1] + (u[0] * v[1] - u[1] * v[0]) * w[2];
}

/* What every prepared mesh promises: distinct vertices, links between equal faces both ways, each side wound apart. */
static inline void shape_check_promises(const tc_mesh *m)
{
    size_t n = m->n_tet + m->n_imaginary;
    for (size_t t = 0; t < n; t++) {
        const int32_t *v = m->tet + 4 * t;
        for (int i = 0; i < 4; i++) {
            assert_true(v[i] >= 0 && (size_t)v[i] < m->n_vertex);
            for (int j = 0; j < i; j++)
                assert_int_not_equal(v[i], v[j]);
        }
        for (int f = 0; f < 4; f++) {
            int32_t u = m->neighbour[4 * t + (size_t)f], face[3], other[3];
            assert_true(u >= -1 && u < (int32_t)n);
            if (u < 0)
                continue;
            assert_int_not_equal(u, t);
            shape_face(face, v, f);
            int matches = 0;
            for (int g = 0; g < 4; g++) {
                shape_face(other, m->tet + 4 * (size_t)u, g);
                if (memcmp(face, other, sizeof face) == 0) {
                    matches++;
                    assert_int_equal(m->neighbour[4 * (size_t)u + (size_t)g], t);
                }
            }
            assert_int_equal(matches, 1);
        }
    }
}

#endif
