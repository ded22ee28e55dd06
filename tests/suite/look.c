/* look.c: a box of tets with a field of one's own. */
#include "look.h"

#include <stdlib.h>
#include <string.h>

tc_mesh *look_box(int n, double (*field)(const double *x), tc_association association)
{
    /* Kuhn: the six paths along the axes from a cube's first corner to its last. */
    static const int path[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    size_t side = (size_t)n + 1, n_vertex = side * side * side, n_tet = 6 * (size_t)n * (size_t)n * (size_t)n;
    double *vertex = malloc(n_vertex * 3 * sizeof *vertex);
    double *scalar = malloc((n_vertex > n_tet ? n_vertex : n_tet) * sizeof *scalar);
    int32_t *tet = malloc(n_tet * 4 * sizeof *tet);
    assert_true(vertex && scalar && tet);
    const int step[3] = {1, (int)side, (int)(side * side)};
    for (size_t i = 0; i < n_vertex; i++) {
        size_t at[3] = {i % side, i / side % side, i / side / side};
        for (int k = 0; k < 3; k++)
            vertex[3 * i + (size_t)k] = (double)at[k] / n;
    }
    size_t t = 0;
    for (int z = 0; z < n; z++)
        for (int y = 0; y < n; y++)
            for (int x = 0; x < n; x++)
                for (int p = 0; p < 6; p++, t++) {
                    int32_t *v = tet + 4 * t;
                    v[0] = x + step[1] * y + step[2] * z;
                    for (int k = 0; k < 3; k++)
                        v[k + 1] = v[k] + step[path[p][k]];
                }
    for (size_t i = 0; i < (association == TC_CELL_DATA ? n_tet : n_vertex); i++) {
        double centre[3] = {0, 0, 0};
        for (size_t c = 0; c < 4; c++)
            for (size_t k = 0; k < 3; k++)
                centre[k] += 0.25 * vertex[3 * (size_t)tet[4 * (i < n_tet ? i : 0) + c] + k];
        scalar[i] = field(association == TC_CELL_DATA ? centre : vertex + 3 * i);
    }
    const tc_mesh_arrays arrays = {.n_vertex = n_vertex,
                                   .vertex = vertex,
                                   .n_tet = n_tet,
                                   .tet = tet,
                                   .scalar = scalar,
                                   .association = association,
                                   .field_name = "f"};
    tc_mesh *mesh = suite_mesh(&arrays, TC_REENTRY_CONVEXIFY);
    free(vertex);
    free(scalar);
    free(tet);
    return mesh;
}

static void cut(double t[2], double slope, double at)
{
    if (slope > 0)
        t[0] = fmax(t[0], at / slope);
    else if (slope < 0)
        t[1] = fmin(t[1], at / slope);
    else if (at > 0)
        t[1] = -INFINITY;
}

bool look_chord(double t[2], const double *origin, const double *direction, const tc_plane *plane, int n)
{
    t[0] = -INFINITY; /* the box lies before the eye */
    t[1] = INFINITY;
    for (int k = 0; k < 3; k++) {
        cut(t, direction[k], -origin[k]);
        cut(t, -direction[k], origin[k] - 1);
    }
    for (int i = 0; i < n; i++) {
        double slope = 0, at = plane[i].offset;
        for (int k = 0; k < 3; k++) {
            slope += plane[i].normal[k] * direction[k];
            at -= plane[i].normal[k] * origin[k];
        }
        cut(t, slope, at);
    }
    if (t[1] > t[0])
        return true;
    t[0] = t[1] = 0;
    return false;
}
