/* cubeskin.c: the surface of the cube [-1, 1]^3, cut into triangles. */
#include "cubeskin.h"

#include "chord.h"
#include "core/memory.h"

#include <stdlib.h>
#include <string.h>

/* Number of the vertices of layers below k, and of one within its layer: whole squares at both ends, rings between. */
static size_t index_of(size_t n, const size_t *v)
{
    size_t whole = (n + 1) * (n + 1), i = v[0], j = v[1], k = v[2];
    if (k == 0 || k == n)
        return (k == 0 ? 0 : whole + (n - 1) * 4 * n) + i + (n + 1) * j;
    size_t ring = j == 0 ? i : i == n ? n + j : j == n ? 3 * n - i : 4 * n - j;
    return whole + (k - 1) * 4 * n + ring;
}

static void set_face(tc_cubeskin *s, size_t *at, int axis, bool upper, size_t i, size_t j)
{
    int32_t q[4];
    for (int c = 0; c < 4; c++) {
        size_t v[3];
        v[axis] = upper ? s->n : 0;
        v[(axis + 1) % 3] = i + (c == 1 || c == 2);
        v[(axis + 2) % 3] = j + (c >= 2);
        size_t id = index_of(s->n, v);
        q[c] = (int32_t)id;
        for (int a = 0; a < 3; a++)
            s->vertex[3 * id + (size_t)a] = v[a] == s->n ? 1 : 2 * (double)v[a] / (double)s->n - 1;
    }
    int32_t *f = s->face + 3 * *at;
    *at += 2;
    f[0] = q[0], f[1] = q[upper ? 1 : 2], f[2] = q[upper ? 2 : 1];
    f[3] = q[0], f[4] = q[upper ? 2 : 3], f[5] = q[upper ? 3 : 2];
}

tc_status tc_cubeskin_build(tc_cubeskin *out, size_t n, tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (n > 8192)
        return tc_fail(err, TC_E_ARG, "%zu squares along the edge of a cube are too many; ask for fewer cells", n);
    out->n = n, out->n_vertex = 6 * n * n + 2, out->n_face = 12 * n * n;
    out->vertex = tc_alloc(out->n_vertex, 3 * sizeof *out->vertex);
    out->face = tc_alloc(out->n_face, 3 * sizeof *out->face);
    if (!out->vertex || !out->face)
        return tc_fail_memory(err, "the surface of a cube", out->n_face, 3 * sizeof *out->vertex);
    size_t at = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int upper = 0; upper < 2; upper++)
            for (size_t j = 0; j < n; j++)
                for (size_t i = 0; i < n; i++)
                    set_face(out, &at, axis, upper, i, j);
    return TC_OK;
}

void tc_cubeskin_finish(tc_cubeskin *s)
{
    free(s->vertex);
    free(s->face);
    memset(s, 0, sizeof *s);
}

double tc_cubeskin_chord(const double *origin, const double *direction, size_t n_cells)
{
    (void)n_cells;
    static const double lo[3] = {-1, -1, -1}, hi[3] = {1, 1, 1};
    return tc_chord_box(lo, hi, origin, direction);
}
