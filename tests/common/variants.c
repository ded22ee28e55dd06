/* variants.c: permuted, refined and moved meshes. */
#include "variants.h"

#include "core/memory.h"

#include <stdlib.h>
#include <string.h>

void variant_finish(mesh_variant *v)
{
    free(v->vertex);
    free(v->scalar);
    free(v->tet);
    memset(v, 0, sizeof *v);
}

static size_t scalars_of(const tc_mesh_arrays *a)
{
    return !a->scalar ? 0 : a->association == TC_CELL_DATA ? a->n_tet : a->n_vertex;
}

/* Room for the given counts, with from's field. */
static tc_status reserve(mesh_variant *out, const tc_mesh_arrays *from, size_t n_vertex, size_t n_tet, tc_error *err)
{
    if (n_vertex > INT32_MAX || n_tet > INT32_MAX / 4)
        return tc_fail(err, TC_E_ARG, "%zu vertices and %zu tets are too many", n_vertex, n_tet);
    out->arrays = *from;
    out->arrays.n_vertex = n_vertex;
    out->arrays.n_tet = n_tet;
    out->vertex = tc_alloc(n_vertex, 3 * sizeof *out->vertex);
    out->tet = tc_alloc(n_tet, 4 * sizeof *out->tet);
    out->scalar = from->scalar ? tc_alloc(scalars_of(&out->arrays), sizeof *out->scalar) : NULL;
    out->arrays.vertex = out->vertex;
    out->arrays.tet = out->tet;
    out->arrays.scalar = out->scalar;
    return out->vertex && out->tet && (out->scalar || !from->scalar)
               ? TC_OK
               : tc_fail_memory(err, "a variant of a mesh", n_vertex * 4 + n_tet * 2, sizeof(double));
}

static void shuffle(int32_t *order, size_t n, uint64_t seed)
{
    for (size_t i = 0; i < n; i++)
        order[i] = (int32_t)i;
    for (size_t i = n; i > 1; i--) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        size_t j = (size_t)(seed >> 33) % i;
        int32_t t = order[i - 1];
        order[i - 1] = order[j];
        order[j] = t;
    }
}

tc_status variant_permute(mesh_variant *out, const tc_mesh_arrays *from, uint64_t seed, tc_error *err)
{
    tc_status status = reserve(out, from, from->n_vertex, from->n_tet, err);
    int32_t *vertex = tc_alloc(from->n_vertex, sizeof *vertex), *tet = tc_alloc(from->n_tet, sizeof *tet);
    if (status == TC_OK && (!vertex || !tet))
        status = tc_fail_memory(err, "a new order", from->n_vertex + from->n_tet, sizeof *tet);
    if (status != TC_OK)
        goto done;
    shuffle(vertex, from->n_vertex, seed);
    shuffle(tet, from->n_tet, seed + 1);
    bool cells = from->association == TC_CELL_DATA;
    for (size_t i = 0; i < from->n_vertex; i++)
        memcpy(out->vertex + 3 * (size_t)vertex[i], from->vertex + 3 * i, 3 * sizeof *out->vertex);
    for (size_t i = 0; i < scalars_of(from); i++)
        out->scalar[cells ? tet[i] : vertex[i]] = from->scalar[i];
    for (size_t i = 0; i < from->n_tet; i++) {
        int32_t corner[4];
        shuffle(corner, 4, seed + i);
        for (int k = 0; k < 4; k++)
            out->tet[4 * (size_t)tet[i] + (size_t)corner[k]] = vertex[from->tet[4 * i + (size_t)k]];
    }
done:
    free(vertex);
    free(tet);
    return status;
}

/* The mean of n of from's vertices becomes vertex `at`, and its value theirs. */
static void add_mean(mesh_variant *out, const tc_mesh_arrays *from, size_t at, const int32_t *id, int n)
{
    bool points = from->scalar && from->association != TC_CELL_DATA;
    double sum[4] = {0, 0, 0, 0};
    for (int k = 0; k < n; k++) {
        for (size_t a = 0; a < 3; a++)
            sum[a] += from->vertex[3 * (size_t)id[k] + a] / n;
        sum[3] += points ? from->scalar[id[k]] / n : 0;
    }
    memcpy(out->vertex + 3 * at, sum, 3 * sizeof *sum);
    if (points)
        out->scalar[at] = sum[3];
}

/* What is there already, before the new vertices; each cell's value goes to its `parts`. */
static void copy_coarse(mesh_variant *out, const tc_mesh_arrays *from, size_t parts)
{
    memcpy(out->vertex, from->vertex, from->n_vertex * 3 * sizeof *out->vertex);
    if (from->scalar && from->association != TC_CELL_DATA)
        memcpy(out->scalar, from->scalar, from->n_vertex * sizeof *out->scalar);
    if (from->scalar && from->association == TC_CELL_DATA)
        for (size_t i = 0; i < parts * from->n_tet; i++)
            out->scalar[i] = from->scalar[i / parts];
}

/* Each tet's vertices ascending: equal tets are then divided alike. */
static void sort_corners(int32_t *sorted, const tc_mesh_arrays *from)
{
    memcpy(sorted, from->tet, from->n_tet * 4 * sizeof *sorted);
    for (size_t i = 0; i < from->n_tet; i++)
        for (size_t k = 1; k < 4; k++)
            for (int32_t *at = sorted + 4 * i + k; at > sorted + 4 * i && at[-1] > at[0]; at--) {
                int32_t t = at[0];
                at[0] = at[-1];
                at[-1] = t;
            }
}

tc_status variant_refine4(mesh_variant *out, const tc_mesh_arrays *from, tc_error *err)
{
    int32_t *sorted = tc_alloc(from->n_tet, 4 * sizeof *sorted);
    tc_status status = sorted ? reserve(out, from, from->n_vertex + from->n_tet, 4 * from->n_tet, err)
                              : tc_fail_memory(err, "the corners of a mesh", from->n_tet, 4 * sizeof *sorted);
    if (status != TC_OK)
        goto done;
    copy_coarse(out, from, 4);
    sort_corners(sorted, from);
    for (size_t i = 0; i < from->n_tet; i++) {
        const int32_t *tet = sorted + 4 * i;
        size_t center = from->n_vertex + i;
        add_mean(out, from, center, tet, 4);
        for (size_t k = 0; k < 4; k++) {
            int32_t *part = out->tet + 16 * i + 4 * k;
            memcpy(part, tet, 4 * sizeof *part);
            part[k] = (int32_t)center;
        }
    }
done:
    free(sorted);
    return status;
}

/* An edge of a tet: its vertices, ascending, and where its middle's number is wanted. */
typedef struct edge {
    int32_t id[2];
    uint32_t slot; /* 6 * tet + edge */
} edge;

static int by_vertices(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    for (int k = 0; k < 2; k++)
        if (x->id[k] != y->id[k])
            return x->id[k] < y->id[k] ? -1 : 1;
    return 0;
}

static const int edge_corner[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/* Gives every edge of the mesh a number: middle [6 n_tet]; *n gets their count. */
static void number_edges(int32_t *middle, edge *e, size_t *n, const int32_t *sorted, size_t n_tet)
{
    for (size_t i = 0; i < 6 * n_tet; i++) {
        const int32_t *tet = sorted + 4 * (i / 6);
        e[i] = (edge){{tet[edge_corner[i % 6][0]], tet[edge_corner[i % 6][1]]}, (uint32_t)i};
    }
    qsort(e, 6 * n_tet, sizeof *e, by_vertices);
    *n = 0;
    for (size_t i = 0; i < 6 * n_tet; i++) {
        *n += i > 0 && by_vertices(&e[i - 1], &e[i]) != 0;
        middle[e[i].slot] = (int32_t)*n;
    }
    *n += n_tet > 0;
}

tc_status variant_refine8(mesh_variant *out, const tc_mesh_arrays *from, tc_error *err)
{
    /* Corners 0-3, middles 4-9 in edge_corner's order: a tet at each corner, and four around the diagonal 01-23. */
    static const uint8_t part[8][4] = {{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3},
                                       {4, 9, 5, 6}, {4, 9, 6, 8}, {4, 9, 8, 7}, {4, 9, 7, 5}};
    size_t n_edge = 0, nv = from->n_vertex;
    int32_t *middle = tc_alloc(from->n_tet, 6 * sizeof *middle);
    int32_t *sorted = tc_alloc(from->n_tet, 4 * sizeof *sorted);
    edge *e = tc_alloc(from->n_tet, 6 * sizeof *e);
    tc_status status = TC_OK;
    if (middle && e && sorted) {
        sort_corners(sorted, from);
        number_edges(middle, e, &n_edge, sorted, from->n_tet);
    } else
        status = tc_fail_memory(err, "the edges of a mesh", from->n_tet, 6 * sizeof *e);
    if (status == TC_OK)
        status = reserve(out, from, nv + n_edge, 8 * from->n_tet, err);
    if (status != TC_OK)
        goto done;
    copy_coarse(out, from, 8);
    for (size_t i = 0; i < 6 * from->n_tet; i++)
        add_mean(out, from, nv + (size_t)middle[e[i].slot], e[i].id, 2);
    for (size_t i = 0; i < from->n_tet; i++) {
        int32_t id[10];
        memcpy(id, sorted + 4 * i, 4 * sizeof *id);
        for (size_t k = 0; k < 6; k++)
            id[4 + k] = (int32_t)nv + middle[6 * i + k];
        for (size_t p = 0; p < 8; p++)
            for (size_t k = 0; k < 4; k++)
                out->tet[32 * i + 4 * p + k] = id[part[p][k]];
    }
done:
    free(middle);
    free(sorted);
    free(e);
    return status;
}

tc_status variant_move(mesh_variant *out, const tc_mesh_arrays *from, const double *turn, double scale,
                       const double *offset, tc_error *err)
{
    static const double stay[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    tc_status status = reserve(out, from, from->n_vertex, from->n_tet, err);
    if (status != TC_OK)
        return status;
    const double *m = turn ? turn : stay;
    for (size_t i = 0; i < from->n_vertex; i++)
        for (size_t k = 0; k < 3; k++) {
            const double *x = from->vertex + 3 * i, *row = m + 3 * k;
            double y = turn ? row[0] * x[0] + row[1] * x[1] + row[2] * x[2] : x[k];
            out->vertex[3 * i + k] = scale * y + offset[k];
        }
    memcpy(out->tet, from->tet, from->n_tet * 4 * sizeof *out->tet);
    if (scalars_of(from))
        memcpy(out->scalar, from->scalar, scalars_of(from) * sizeof *out->scalar);
    return TC_OK;
}
