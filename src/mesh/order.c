/* order.c: cells and vertices along a Hilbert curve.
 * The curve's index from coordinates follows the idea of Skilling 2004, "Programming the Hilbert curve" (undo the
 * rotations bit by bit from the top, then Gray-decode), written for three axes of 21 bits. */
#include "mesh/order.h"

#include "core/memory.h"
#include "core/parallel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BITS = 21, DIGIT = 11, BINS = 1 << DIGIT, PASSES = (3 * BITS + DIGIT - 1) / DIGIT };

/* Bits of x, 21 of them, two places apart. */
static uint64_t spread(uint64_t x)
{
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffffu;
    x = (x | x << 16) & 0x1f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

uint64_t tc_hilbert(uint32_t x, uint32_t y, uint32_t z)
{
    for (uint32_t bit = 1u << (BITS - 1); bit > 1; bit >>= 1) {
        uint32_t low = bit - 1, t;
        x ^= x & bit ? low : 0;
        t = y & bit ? 0 : (x ^ y) & low; /* exchange the low bits of x and y, or invert x's */
        x ^= y & bit ? low : t, y ^= t;
        t = z & bit ? 0 : (x ^ z) & low;
        x ^= z & bit ? low : t, z ^= t;
    }
    y ^= x, z ^= y;
    uint32_t t = z >> 1; /* parity of all bits of z above each place */
    t ^= t >> 1, t ^= t >> 2, t ^= t >> 4, t ^= t >> 8, t ^= t >> 16;
    x ^= t, y ^= t, z ^= t;
    return spread(x) << 2 | spread(y) << 1 | spread(z);
}

tc_status tc_sort_keys(uint64_t *key, uint32_t *id, size_t n, tc_error *err)
{
    tc_status status = TC_OK;
    uint64_t *key2 = tc_alloc(n, sizeof *key2);
    uint32_t *id2 = tc_alloc(n, sizeof *id2);
    size_t(*count)[BINS] = tc_calloc(PASSES, sizeof *count);
    if (!key2 || !id2 || !count) {
        status = tc_fail_memory(err, "sorting cells", n, sizeof *key2 + sizeof *id2);
        goto done;
    }
    for (size_t i = 0; i < n; i++)
        for (int p = 0; p < PASSES; p++)
            count[p][key[i] >> (p * DIGIT) & (BINS - 1)]++;
    uint64_t *from = key, *to = key2;
    uint32_t *id_from = id, *id_to = id2;
    for (int p = 0; p < PASSES; p++) {
        if (n == 0 || count[p][from[0] >> (p * DIGIT) & (BINS - 1)] == n)
            continue;
        size_t sum = 0;
        for (int b = 0; b < BINS; b++) {
            size_t c = count[p][b];
            count[p][b] = sum;
            sum += c;
        }
        for (size_t i = 0; i < n; i++) {
            size_t at = count[p][from[i] >> (p * DIGIT) & (BINS - 1)]++;
            to[at] = from[i], id_to[at] = id_from[i];
        }
        uint64_t *k = from;
        from = to, to = k;
        uint32_t *d = id_from;
        id_from = id_to, id_to = d;
    }
    if (from != key) {
        memcpy(key, from, n * sizeof *key);
        memcpy(id, id_from, n * sizeof *id);
    }
done:
    free(key2);
    free(id2);
    free(count);
    return status;
}

void tc_points_bounds(double bounds[6], const double *vertex, size_t n)
{
    for (int k = 0; k < 3; k++) {
        double lo = n ? vertex[k] : 0, hi = lo;
        for (size_t v = 1; v < n; v++) {
            double x = vertex[3 * v + (size_t)k];
            lo = x < lo ? x : lo;
            hi = x > hi ? x : hi;
        }
        bounds[2 * k] = lo, bounds[2 * k + 1] = hi;
    }
}

typedef struct keys {
    uint64_t *key;
    uint32_t *id;
    const double *vertex;
    const int32_t *tet; /* NULL: the vertices' own keys */
    double low[3], scale;
} keys;

static uint32_t cell_of(double x, double low, double scale)
{
    double c = (x * 0.25 - low) * scale; /* a quarter, so that no difference of finite numbers overflows */
    return c <= 0 ? 0 : c >= (1 << BITS) - 1 ? (1u << BITS) - 1 : (uint32_t)c;
}

static void make_keys(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    keys *j = context;
    for (size_t i = begin; i < end; i++) {
        double p[3];
        if (j->tet) {
            int32_t v[4], k; /* ascending, so that equal cells in any orientation have equal keys */
            memcpy(v, j->tet + 4 * i, sizeof v);
            for (int a = 1; a < 4; a++)
                for (int b = a; b > 0 && v[b] < v[b - 1]; b--)
                    k = v[b], v[b] = v[b - 1], v[b - 1] = k;
            for (int a = 0; a < 3; a++)
                p[a] = 0.25 * j->vertex[3 * (size_t)v[0] + (size_t)a] + 0.25 * j->vertex[3 * (size_t)v[1] + (size_t)a] +
                       0.25 * j->vertex[3 * (size_t)v[2] + (size_t)a] + 0.25 * j->vertex[3 * (size_t)v[3] + (size_t)a];
        } else {
            memcpy(p, j->vertex + 3 * i, sizeof p);
        }
        j->id[i] = (uint32_t)i;
        j->key[i] = tc_hilbert(cell_of(p[0], j->low[0], j->scale), cell_of(p[1], j->low[1], j->scale),
                               cell_of(p[2], j->low[2], j->scale));
    }
}

/* id [n] gets the order of n vertices (tet NULL) or tets along the curve. */
static tc_status curve(uint32_t **id, size_t n, const double *vertex, const int32_t *tet, const double *bounds,
                       int threads, tc_error *err)
{
    keys j = {.vertex = vertex, .tet = tet};
    double extent = 0;
    for (int k = 0; k < 3; k++) {
        j.low[k] = 0.25 * bounds[2 * k];
        double e = 0.25 * bounds[2 * k + 1] - j.low[k];
        extent = e > extent ? e : extent;
    }
    j.scale = (1 << BITS) / extent;
    if (!(j.scale < HUGE_VAL)) /* one point, or an extent below the smallest normal number: any order will do */
        j.scale = 0;
    *id = NULL;
    j.key = tc_alloc(n, sizeof *j.key);
    j.id = tc_alloc(n, sizeof *j.id);
    tc_status status;
    if (!j.key || !j.id) {
        status = tc_fail_memory(err, "ordering cells", n, sizeof *j.key + sizeof *j.id);
    } else {
        tc_parallel_for(n, 4096, threads, make_keys, &j);
        status = tc_sort_keys(j.key, j.id, n, err);
    }
    free(j.key);
    if (status == TC_OK)
        *id = j.id;
    else
        free(j.id);
    return status;
}

static tc_status order_vertices(tc_mesh *mesh, const double *bounds, int threads, tc_error *err)
{
    size_t n = mesh->n_vertex;
    bool point_data = mesh->association != TC_CELL_DATA;
    uint32_t *id = NULL;
    tc_status status = curve(&id, n, mesh->vertex, NULL, bounds, threads, err);
    if (status != TC_OK)
        return status;
    double *vertex = tc_alloc(n, 3 * sizeof *vertex), *scalar = point_data ? tc_alloc(n, sizeof *scalar) : NULL;
    int32_t *rank = tc_alloc(n, sizeof *rank);
    if (!vertex || !rank || (point_data && !scalar)) {
        free(vertex);
        free(scalar);
        status = tc_fail_memory(err, "ordering vertices", n, 4 * sizeof *vertex);
        goto done;
    }
    for (size_t i = 0; i < n; i++) {
        rank[id[i]] = (int32_t)i;
        memcpy(vertex + 3 * i, mesh->vertex + 3 * (size_t)id[i], 3 * sizeof *vertex);
        if (point_data)
            scalar[i] = mesh->scalar[id[i]];
    }
    free(mesh->vertex);
    mesh->vertex = vertex;
    if (point_data) {
        free(mesh->scalar);
        mesh->scalar = scalar;
    }
    for (size_t i = 0; i < 4 * mesh->n_tet; i++)
        mesh->tet[i] = rank[mesh->tet[i]];
    for (size_t s = 0; s < mesh->n_vertex_source; s++)
        if (mesh->vertex_of_source[s] >= 0)
            mesh->vertex_of_source[s] = rank[mesh->vertex_of_source[s]];
done:
    free(id);
    free(rank);
    return status;
}

static tc_status order_cells(tc_mesh *mesh, const double *bounds, int threads, tc_error *err)
{
    size_t n = mesh->n_tet;
    bool cell_data = mesh->association == TC_CELL_DATA;
    uint32_t *id = NULL;
    tc_status status = curve(&id, n, mesh->vertex, mesh->tet, bounds, threads, err);
    if (status != TC_OK)
        return status;
    int32_t *tet = tc_alloc(n, 4 * sizeof *tet), *rank = tc_alloc(n, sizeof *rank);
    double *scalar = cell_data ? tc_alloc(n, sizeof *scalar) : NULL;
    if (!tet || !rank || (cell_data && !scalar)) {
        free(tet);
        free(scalar);
        status = tc_fail_memory(err, "ordering cells", n, 7 * sizeof *tet);
        goto done;
    }
    for (size_t i = 0; i < n; i++) {
        rank[id[i]] = (int32_t)i;
        memcpy(tet + 4 * i, mesh->tet + 4 * (size_t)id[i], 4 * sizeof *tet);
        if (cell_data)
            scalar[i] = mesh->scalar[id[i]];
    }
    free(mesh->tet);
    mesh->tet = tet;
    if (cell_data) {
        free(mesh->scalar);
        mesh->scalar = scalar;
    }
    for (size_t s = 0; s < mesh->n_tet_source; s++)
        if (mesh->tet_of_source[s] >= 0)
            mesh->tet_of_source[s] = rank[mesh->tet_of_source[s]];
done:
    free(id);
    free(rank);
    return status;
}

tc_status tc_mesh_order(tc_mesh *mesh, int threads, tc_error *err)
{
    double bounds[6];
    tc_points_bounds(bounds, mesh->vertex, mesh->n_vertex);
    tc_status status = order_vertices(mesh, bounds, threads, err);
    return status == TC_OK ? order_cells(mesh, bounds, threads, err) : status;
}

tc_status tc_tets_order(int32_t *tet, size_t n, const double *vertex, const double bounds[6], int threads,
                        tc_error *err)
{
    uint32_t *id = NULL;
    tc_status status = curve(&id, n, vertex, tet, bounds, threads, err);
    if (status != TC_OK)
        return status;
    int32_t *copy = tc_alloc(n, 4 * sizeof *copy);
    if (!copy) {
        status = tc_fail_memory(err, "ordering imaginary cells", n, 4 * sizeof *copy);
    } else {
        memcpy(copy, tet, n * 4 * sizeof *copy);
        for (size_t i = 0; i < n; i++)
            memcpy(tet + 4 * i, copy + 4 * (size_t)id[i], 4 * sizeof *copy);
    }
    free(copy);
    free(id);
    return status;
}
