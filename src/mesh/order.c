/* order.c: cells and vertices along a Hilbert curve.
 * The curve's index from coordinates follows the idea of Skilling 2004, "Programming the Hilbert curve" (undo the
 * rotations bit by bit from the top, then Gray-decode), written for three axes of 21 bits and for several points at
 * once, without a branch, so that a compiler makes vector instructions of it. */
#include "mesh/order.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "mesh/sort.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BITS = 21, CHUNK = 8192, LANES = 16 };

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

/* All ones where the bit of x is set. */
static uint32_t mask_of(uint32_t x, int bit)
{
    return 0 - (x >> bit & 1);
}

/* Places of LANES points; x, y and z are scratch. */
static void hilbert_lanes(uint64_t *out, uint32_t *x, uint32_t *y, uint32_t *z)
{
    for (int bit = BITS - 1; bit > 0; bit--) {
        const uint32_t low = ((uint32_t)1 << bit) - 1;
        for (int i = 0; i < LANES; i++) {
            uint32_t a = x[i], b = y[i], c = z[i], t, m;
            a ^= mask_of(a, bit) & low;
            m = mask_of(b, bit);
            t = ~m & (a ^ b) & low; /* exchange the low bits of x and y, or invert x's */
            a ^= (m & low) | t, b ^= t;
            m = mask_of(c, bit);
            t = ~m & (a ^ c) & low;
            a ^= (m & low) | t, c ^= t;
            x[i] = a, y[i] = b, z[i] = c;
        }
    }
    for (int i = 0; i < LANES; i++) {
        y[i] ^= x[i], z[i] ^= y[i];
        uint32_t t = z[i] >> 1; /* parity of all bits of z above each place */
        t ^= t >> 1, t ^= t >> 2, t ^= t >> 4, t ^= t >> 8, t ^= t >> 16;
        x[i] ^= t, y[i] ^= t, z[i] ^= t;
    }
    for (int i = 0; i < LANES; i++)
        out[i] = spread(x[i]) << 2 | spread(y[i]) << 1 | spread(z[i]);
}

uint64_t tc_hilbert(uint32_t x, uint32_t y, uint32_t z)
{
    uint64_t out[LANES];
    uint32_t a[LANES] = {x}, b[LANES] = {y}, c[LANES] = {z};
    hilbert_lanes(out, a, b, c);
    return out[0];
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

/* The point that item i is ordered by: a vertex, or the middle of a tet. */
static void point_of(double p[3], const keys *j, size_t i)
{
    if (!j->tet) {
        memcpy(p, j->vertex + 3 * i, 3 * sizeof *p);
        return;
    }
    int32_t v[4], k; /* ascending, so that equal cells in any orientation have equal keys */
    memcpy(v, j->tet + 4 * i, sizeof v);
    for (int a = 1; a < 4; a++)
        for (int b = a; b > 0 && v[b] < v[b - 1]; b--)
            k = v[b], v[b] = v[b - 1], v[b - 1] = k;
    for (int a = 0; a < 3; a++)
        p[a] = 0.25 * j->vertex[3 * (size_t)v[0] + (size_t)a] + 0.25 * j->vertex[3 * (size_t)v[1] + (size_t)a] +
               0.25 * j->vertex[3 * (size_t)v[2] + (size_t)a] + 0.25 * j->vertex[3 * (size_t)v[3] + (size_t)a];
}

static void make_keys(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    keys *j = context;
    for (size_t first = begin; first < end; first += LANES) {
        size_t n = end - first < LANES ? end - first : LANES;
        uint64_t key[LANES];
        uint32_t cell[3][LANES] = {{0}};
        for (size_t i = 0; i < n; i++) {
            double p[3];
            point_of(p, j, first + i);
            for (int a = 0; a < 3; a++)
                cell[a][i] = cell_of(p[a], j->low[a], j->scale);
            j->id[first + i] = (uint32_t)(first + i);
        }
        hilbert_lanes(key, cell[0], cell[1], cell[2]);
        memcpy(j->key + first, key, n * sizeof *key);
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
        tc_parallel_for(n, CHUNK, threads, make_keys, &j);
        status = tc_sort_keys(j.key, j.id, n, threads, err);
    }
    free(j.key);
    if (status == TC_OK)
        *id = j.id;
    else
        free(j.id);
    return status;
}

/* One array after another from an old order to a new one. */
typedef struct move {
    const uint32_t *id; /* new place → old */
    int32_t *rank;      /* old place → new */
    double *to, *scalar_to;
    int32_t *tet_to;
    const double *from, *scalar_from; /* scalars: NULL, none */
    const int32_t *tet_from;
    int32_t *name; /* to be renamed by rank; below 0 it stays */
} move;

static void move_vertices(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const move *j = context;
    for (size_t i = begin; i < end; i++) {
        j->rank[j->id[i]] = (int32_t)i;
        memcpy(j->to + 3 * i, j->from + 3 * (size_t)j->id[i], 3 * sizeof *j->to);
        if (j->scalar_from)
            j->scalar_to[i] = j->scalar_from[j->id[i]];
    }
}

static void move_tets(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const move *j = context;
    for (size_t i = begin; i < end; i++) {
        if (j->rank)
            j->rank[j->id[i]] = (int32_t)i;
        memcpy(j->tet_to + 4 * i, j->tet_from + 4 * (size_t)j->id[i], 4 * sizeof *j->tet_to);
        if (j->scalar_from)
            j->scalar_to[i] = j->scalar_from[j->id[i]];
    }
}

static void rename_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const move *j = context;
    for (size_t i = begin; i < end; i++)
        if (j->name[i] >= 0)
            j->name[i] = j->rank[j->name[i]];
}

static void rename_all(move *j, int32_t *name, size_t n, int threads)
{
    j->name = name;
    tc_parallel_for(n, 4 * CHUNK, threads, rename_range, j);
}

static tc_status order_vertices(tc_mesh *mesh, const double *bounds, int threads, tc_error *err)
{
    size_t n = mesh->n_vertex;
    bool point_data = mesh->association != TC_CELL_DATA;
    uint32_t *id = NULL;
    tc_status status = curve(&id, n, mesh->vertex, NULL, bounds, threads, err);
    if (status != TC_OK)
        return status;
    move j = {.id = id,
              .rank = tc_alloc(n, sizeof *j.rank),
              .to = tc_alloc(n, 3 * sizeof *j.to),
              .scalar_to = point_data ? tc_alloc(n, sizeof *j.scalar_to) : NULL,
              .from = mesh->vertex,
              .scalar_from = point_data ? mesh->scalar : NULL};
    if (!j.to || !j.rank || (point_data && !j.scalar_to)) {
        free(j.to);
        free(j.scalar_to);
        status = tc_fail_memory(err, "ordering vertices", n, 4 * sizeof *j.to);
        goto done;
    }
    tc_parallel_for(n, CHUNK, threads, move_vertices, &j);
    free(mesh->vertex);
    mesh->vertex = j.to;
    if (point_data) {
        free(mesh->scalar);
        mesh->scalar = j.scalar_to;
    }
    rename_all(&j, mesh->tet, 4 * mesh->n_tet, threads);
    rename_all(&j, mesh->vertex_of_source, mesh->n_vertex_source, threads);
done:
    free(id);
    free(j.rank);
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
    move j = {.id = id,
              .rank = tc_alloc(n, sizeof *j.rank),
              .tet_to = tc_alloc(n, 4 * sizeof *j.tet_to),
              .scalar_to = cell_data ? tc_alloc(n, sizeof *j.scalar_to) : NULL,
              .tet_from = mesh->tet,
              .scalar_from = cell_data ? mesh->scalar : NULL};
    if (!j.tet_to || !j.rank || (cell_data && !j.scalar_to)) {
        free(j.tet_to);
        free(j.scalar_to);
        status = tc_fail_memory(err, "ordering cells", n, 7 * sizeof *j.tet_to);
        goto done;
    }
    tc_parallel_for(n, CHUNK, threads, move_tets, &j);
    free(mesh->tet);
    mesh->tet = j.tet_to;
    if (cell_data) {
        free(mesh->scalar);
        mesh->scalar = j.scalar_to;
    }
    rename_all(&j, mesh->tet_of_source, mesh->n_tet_source, threads);
done:
    free(id);
    free(j.rank);
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
        move j = {.id = id, .tet_to = tet, .tet_from = copy};
        tc_parallel_for(n, CHUNK, threads, move_tets, &j);
    }
    free(copy);
    free(id);
    return status;
}
