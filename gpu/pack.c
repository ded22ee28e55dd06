/* pack.c: the mesh as arrays for the GPU (design: "Record"). */
#include "gpu/pack.h"

#include "core/memory.h"
#include "core/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The corners of face f (opposite vertex f), counter-clockwise seen from outside a positive tet. */
static const int face_corner[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

static void pack_cell(int32_t *out, const int32_t *tet, const int32_t *neighbour)
{
    out[0] = tet[0] ^ tet[1] ^ tet[2] ^ tet[3];
    for (int f = 0; f < 4; f++) {
        int rank = 0;
        for (int k = 0; k < 4; k++)
            rank += tet[f] > tet[k];
        out[1 + rank] = neighbour[f] < 0 ? -1 : neighbour[f] * TC_PACK_CELL_INTS;
    }
}

static void find_frame(tc_pack *pack, const tc_mesh *mesh)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY}, d2 = 0;
    for (size_t i = 0; i < mesh->n_vertex; i++)
        for (int k = 0; k < 3; k++) {
            lo[k] = fmin(lo[k], mesh->vertex[3 * i + k]);
            hi[k] = fmax(hi[k], mesh->vertex[3 * i + k]);
        }
    for (int k = 0; k < 3; k++) {
        pack->center[k] = 0.5 * lo[k] + 0.5 * hi[k];
        double half = 0.5 * hi[k] - 0.5 * lo[k];
        d2 = hypot(d2, half);
    }
    pack->scale = d2 > 0 && isfinite(1 / d2) ? 1 / d2 : 1;
}

/* Exactly x mapped, 0 where it is not finite. */
static float map_scalar(double x, double lo, double hi)
{
    if (!isfinite(x) || !(hi > lo))
        return 0;
    return (float)((x - lo) / (hi - lo));
}

static void pack_vertices(tc_pack *pack, const tc_mesh *mesh)
{
    bool has_scalar = mesh->association == TC_POINT_DATA && mesh->scalar;
    for (size_t i = 0; i < mesh->n_vertex; i++) {
        float *v = pack->vertex + 4 * i;
        for (int k = 0; k < 3; k++)
            v[k] = (float)((mesh->vertex[3 * i + k] - pack->center[k]) * pack->scale);
        v[3] = has_scalar ? map_scalar(mesh->scalar[i], pack->scalar_lo, pack->scalar_hi) : 0;
    }
}

tc_status tc_pack_build(tc_pack *out, const tc_mesh *mesh, tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (!mesh->prepared || !mesh->neighbour)
        return tc_fail(err, TC_E_ARG, "the mesh was not prepared; call tc_mesh_prepare first");
    double start = tc_now_ms();
    size_t n = mesh->n_tet + mesh->n_imaginary, faces = 0;
    if (n > INT32_MAX / TC_PACK_CELL_INTS)
        return tc_fail(err, TC_E_MESH, "%zu cells are more than this version can address (%d)", n,
                       INT32_MAX / TC_PACK_CELL_INTS);
    for (size_t i = 0; i < 4 * n; i++)
        faces += mesh->neighbour[i] < 0;
    out->n_cell = n;
    out->n_real = mesh->n_tet;
    out->n_vertex = mesh->n_vertex;
    out->n_face = faces;
    bool cell_data = mesh->association == TC_CELL_DATA && mesh->scalar;
    out->cell = tc_alloc(n, TC_PACK_CELL_INTS * sizeof *out->cell);
    out->vertex = tc_alloc(mesh->n_vertex, TC_PACK_VERTEX_FLOATS * sizeof *out->vertex);
    out->face = tc_alloc(faces, TC_PACK_FACE_INTS * sizeof *out->face);
    out->face_corner = tc_alloc(faces, 9 * sizeof *out->face_corner);
    out->cell_scalar = cell_data ? tc_alloc(mesh->n_tet, sizeof *out->cell_scalar) : NULL;
    if (!out->cell || !out->vertex || !out->face || !out->face_corner || (cell_data && !out->cell_scalar)) {
        tc_pack_finish(out);
        return tc_fail_memory(err, "the packed mesh", n, 24);
    }
    find_frame(out, mesh);
    out->scalar_lo = mesh->report.scalar_range[0];
    out->scalar_hi = mesh->report.scalar_range[1];
    pack_vertices(out, mesh);
    int32_t *face = out->face;
    float *corner = out->face_corner;
    for (size_t i = 0; i < n; i++) {
        const int32_t *tet = mesh->tet + 4 * i, *neighbour = mesh->neighbour + 4 * i;
        pack_cell(out->cell + TC_PACK_CELL_INTS * i, tet, neighbour);
        for (int f = 0; f < 4; f++)
            if (neighbour[f] < 0) {
                for (int k = 0; k < 3; k++) {
                    face[k] = tet[face_corner[f][k]];
                    memcpy(corner + 3 * k, out->vertex + 4 * (size_t)face[k], 3 * sizeof *corner);
                }
                corner += 9;
                face[3] = (int32_t)i * TC_PACK_CELL_INTS;
                face += TC_PACK_FACE_INTS;
            }
    }
    for (size_t i = 0; cell_data && i < mesh->n_tet; i++)
        out->cell_scalar[i] = map_scalar(mesh->scalar[i], out->scalar_lo, out->scalar_hi);
    out->ms = tc_now_ms() - start;
    return TC_OK;
}

void tc_pack_finish(tc_pack *pack)
{
    free(pack->cell);
    free(pack->vertex);
    free(pack->face);
    free(pack->face_corner);
    free(pack->cell_scalar);
    memset(pack, 0, sizeof *pack);
}
