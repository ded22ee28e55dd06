/* pack.c: the mesh as arrays for the GPU (design: "Record"). */
#include "gpu/pack.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "transfer_functions/place.h"

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

/* x mapped; NaN where it is not finite: march.frag leaves out what it reaches. */
static float map_scalar(double x, double lo, double hi)
{
    return isfinite(x) ? (float)tc_place(x, lo, hi) : NAN;
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

static int bin_of(float s)
{
    int bin = (int)(s * TC_PACK_BINS);
    return bin < 0 ? 0 : bin >= TC_PACK_BINS ? TC_PACK_BINS - 1 : bin;
}

/* Returns the cell's weight in `held`, which is left as a sum; 0 where a value is not finite. */
static double measure_cell(tc_pack_extent *out, const tc_pack *pack, const int32_t *tet, const float *cell_scalar)
{
    float edge = 0, lo = INFINITY, hi = -INFINITY;
    for (int i = 0; i < 4; i++) {
        const float *p = pack->vertex + 4 * (size_t)tet[i];
        float s = cell_scalar ? *cell_scalar : p[3];
        if (isnan(s))
            return 0; /* contributes nothing */
        lo = fminf(lo, s);
        hi = fmaxf(hi, s);
        for (int j = 0; j < i; j++) {
            const float *q = pack->vertex + 4 * (size_t)tet[j];
            float x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
            edge = fmaxf(edge, x * x + y * y + z * z);
        }
    }
    double weight = edge;
    edge = sqrtf(edge);
    float edge_range = edge * (hi - lo);
    for (int b = bin_of(lo), last = bin_of(hi); b <= last; b++) {
        out->edge[b] = fmaxf(out->edge[b], edge);
        out->edge_range[b] = fmaxf(out->edge_range[b], edge_range);
        double from = fmax(lo * TC_PACK_BINS, b), to = fmin(hi * TC_PACK_BINS, b + 1);
        out->held[b] += weight * fmax(to - from, 0);
    }
    return weight;
}

/* Writes an open face's corners, the least by place first: two open faces at one place, as where cells overlap, then give
 * a ray the same depth to the last bit, and not its rounding but their numbers tell which is entered first. */
static void pack_face(int32_t *face, float *corner, const tc_pack *pack, const int32_t *tet, int f)
{
    int first = 0;
    const float *at[3];
    for (int k = 0; k < 3; k++)
        at[k] = pack->vertex + 4 * (size_t)tet[face_corner[f][k]];
    for (int k = 1; k < 3; k++) {
        const float *p = at[k], *q = at[first];
        if (p[0] != q[0] ? p[0] < q[0] : p[1] != q[1] ? p[1] < q[1] : p[2] < q[2])
            first = k;
    }
    for (int k = 0; k < 3; k++) {
        int from = (first + k) % 3;
        face[k] = tet[face_corner[f][from]];
        memcpy(corner + 3 * k, at[from], 3 * sizeof *corner);
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
                pack_face(face, corner, out, tet, f);
                corner += 9;
                face[3] = (int32_t)i * TC_PACK_CELL_INTS;
                face += TC_PACK_FACE_INTS;
            }
    }
    for (size_t i = 0; cell_data && i < mesh->n_tet; i++)
        out->cell_scalar[i] = map_scalar(mesh->scalar[i], out->scalar_lo, out->scalar_hi);
    double weight = 0;
    for (size_t i = 0; i < mesh->n_tet; i++)
        weight += measure_cell(&out->extent, out, mesh->tet + 4 * i, cell_data ? &out->cell_scalar[i] : NULL);
    for (int b = 0; b < TC_PACK_BINS; b++)
        out->extent.held[b] = weight > 0 ? out->extent.held[b] / weight : 0;
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
