/* pack_planes.c: the mesh as the textures of the paper's own arithmetic.
 * Weiler et al. 2003, 3.2 (normals, neighbours, face numbers), eq. 2 (gradient) and Table 1. */
#include "gpu/pack_planes.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/vec.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The corners of face f (opposite vertex f), counter-clockwise seen from outside a positive tet. */
static const int face_corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

/* The vertices of a cell as the pack rounded them: exact in double. */
typedef struct corners {
    double x[4][3], s[4];
} corners;

static corners corners_of(const tc_pack *pack, const int32_t *tet)
{
    corners c;
    for (int i = 0; i < 4; i++) {
        const float *v = pack->vertex + TC_PACK_VERTEX_FLOATS * (size_t)tet[i];
        for (int k = 0; k < 3; k++)
            c.x[i][k] = (double)v[k];
        c.s[i] = (double)v[3];
    }
    return c;
}

/* Unit normal of face f, away from vertex f; where that lies in the face's plane, by the face's winding. */
static void pack_normal(float *out, const corners *c, int f)
{
    double ab[3], ac[3], inside[3], n[3];
    const double *a = c->x[face_corner[f][0]];
    tc_vec_sub(ab, c->x[face_corner[f][1]], a);
    tc_vec_sub(ac, c->x[face_corner[f][2]], a);
    tc_vec_sub(inside, c->x[f], a);
    tc_vec_cross(n, ab, ac);
    tc_vec_normalize(n);
    double sign = tc_vec_dot(n, inside) > 0 ? -1 : 1;
    for (int k = 0; k < 3; k++)
        out[k] = (float)(sign * n[k]);
}

/* The face of cell `neighbour` that the face f of cell t is. */
static int face_in(const tc_mesh *mesh, size_t t, int f, int32_t neighbour)
{
    const int32_t *tet = mesh->tet + 4 * t, *other = mesh->tet + 4 * (size_t)neighbour;
    for (int k = 0; k < 4; k++) {
        bool shared = false;
        for (int i = 0; i < 4; i++)
            shared = shared || (i != f && tet[i] == other[k]);
        if (!shared)
            return k;
    }
    return 0; /* both cells have the same four vertices; mesh.h: duplicates are dropped */
}

/* Gradient and offset of the linear field through the four vertices (eq. 2, with the cell's middle for x0). */
static void pack_scalar(float *out, const corners *c)
{
    double e[3][3], n[3][3], g[3], middle[3], mean = 0.25 * (c->s[0] + c->s[1] + c->s[2] + c->s[3]);
    for (int i = 0; i < 3; i++)
        tc_vec_sub(e[i], c->x[i + 1], c->x[0]);
    tc_vec_cross(n[0], e[1], e[2]);
    tc_vec_cross(n[1], e[2], e[0]);
    tc_vec_cross(n[2], e[0], e[1]);
    double det = tc_vec_dot(e[0], n[0]);
    bool steep = false;
    for (int k = 0; k < 3; k++) {
        g[k] = ((c->s[1] - c->s[0]) * n[0][k] + (c->s[2] - c->s[0]) * n[1][k] + (c->s[3] - c->s[0]) * n[2][k]) / det;
        steep = steep || !(fabs(g[k]) <= TC_PACK_PLANES_STEEP);
        middle[k] = 0.25 * (c->x[0][k] + c->x[1][k] + c->x[2][k] + c->x[3][k]);
    }
    for (int k = 0; k < 3; k++) {
        out[k] = steep ? 0 : (float)g[k];
        g[k] = (double)out[k]; /* the offset takes up what rounding did to the gradient */
    }
    out[3] = (float)(mean - tc_vec_dot(g, middle));
}

tc_status tc_pack_planes_build(tc_pack_planes *out, const tc_mesh *mesh, const tc_pack *pack, tc_error *err)
{
    memset(out, 0, sizeof *out);
    double start = tc_now_ms();
    size_t n = pack->n_cell;
    if (n > INT32_MAX / 4)
        return tc_fail(err, TC_E_MESH, "%zu cells are more than this version can address (%d)", n, INT32_MAX / 4);
    out->n_cell = n;
    out->vertex = tc_alloc(n, 16 * sizeof *out->vertex);
    out->normal = tc_alloc(n, 16 * sizeof *out->normal);
    out->neighbour = tc_alloc(n, 4 * sizeof *out->neighbour);
    out->scalar = tc_alloc(n, 4 * sizeof *out->scalar);
    if (!out->vertex || !out->normal || !out->neighbour || !out->scalar) {
        tc_pack_planes_finish(out);
        return tc_fail_memory(err, "the planes of the cells", n, TC_PACK_PLANES_BYTES);
    }
    for (size_t t = 0; t < n; t++) {
        const corners c = corners_of(pack, mesh->tet + 4 * t);
        for (int f = 0; f < 4; f++) {
            float *vertex = out->vertex + 16 * t + 4 * (size_t)f, *normal = out->normal + 16 * t + 4 * (size_t)f;
            int32_t neighbour = mesh->neighbour[4 * t + (size_t)f];
            for (int k = 0; k < 3; k++)
                vertex[k] = (float)c.x[f][k];
            vertex[3] = 0;
            pack_normal(normal, &c, f);
            normal[3] = (float)(1 + (neighbour < 0 ? 0 : face_in(mesh, t, f, neighbour)));
            if (t >= pack->n_real)
                normal[3] = -normal[3];
            out->neighbour[4 * t + (size_t)f] = neighbour < 0 ? -1 : neighbour;
        }
        pack_scalar(out->scalar + 4 * t, &c);
    }
    out->ms = tc_now_ms() - start;
    return TC_OK;
}

void tc_pack_planes_finish(tc_pack_planes *planes)
{
    free(planes->vertex);
    free(planes->normal);
    free(planes->neighbour);
    free(planes->scalar);
    memset(planes, 0, sizeof *planes);
}
