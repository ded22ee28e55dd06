/* repair.c: drops what cannot be rendered, merges what a file duplicated, turns every tet to positive volume. */
#include "mesh/repair.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "mesh/predicate.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

void tc_mesh_finish_arrays(tc_mesh *mesh)
{
    free(mesh->vertex);
    free(mesh->tet);
    free(mesh->neighbour);
    free(mesh->scalar);
    free(mesh->vertex_of_source);
    free(mesh->tet_of_source);
    mesh->vertex = mesh->scalar = NULL;
    mesh->tet = mesh->neighbour = mesh->vertex_of_source = mesh->tet_of_source = NULL;
}

/* ------------------------------------------------------------------------------------------- coincident points */

/* Bits of x with -0 as 0 and every NaN alike. */
static uint64_t bits_of(double x)
{
    if (x == 0)
        x = 0;
    uint64_t b;
    if (isnan(x))
        return UINT64_MAX;
    memcpy(&b, &x, sizeof b);
    return b;
}

static uint64_t mix(uint64_t h, uint64_t x)
{
    h = (h ^ x) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 29;
}

static bool same_point(const double *p, const double *q)
{
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

static bool same_value(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

tc_status tc_points_merge(int32_t *same, size_t *merged, const double *vertex, const double *scalar, const uint8_t *use,
                          size_t n, tc_error *err)
{
    *merged = 0;
    size_t capacity = 16;
    while (capacity < 2 * n)
        capacity *= 2;
    int32_t *table = tc_alloc(capacity, sizeof *table);
    if (!table)
        return tc_fail_memory(err, "merging points", capacity, sizeof *table);
    memset(table, 0xff, capacity * sizeof *table);
    for (size_t v = 0; v < n; v++) {
        same[v] = (int32_t)v;
        if (!use[v])
            continue;
        const double *p = vertex + 3 * v;
        uint64_t h = mix(mix(mix(0, bits_of(p[0])), bits_of(p[1])), bits_of(p[2]));
        if (scalar)
            h = mix(h, bits_of(scalar[v]));
        size_t i = (size_t)(h ^ h >> 32) & (capacity - 1);
        for (; table[i] >= 0; i = (i + 1) & (capacity - 1)) {
            size_t w = (size_t)table[i];
            if (same_point(p, vertex + 3 * w) && (!scalar || same_value(scalar[v], scalar[w]))) {
                same[v] = table[i];
                ++*merged;
                break;
            }
        }
        if (table[i] < 0)
            table[i] = (int32_t)v;
    }
    free(table);
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------------- orientation */

typedef struct turn {
    const double *vertex;
    int32_t *tet;
    atomic_size_t reoriented, zero;
} turn;

static void turn_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    turn *j = context;
    const double *x = j->vertex;
    size_t reoriented = 0, zero = 0;
    for (size_t t = begin; t < end; t++) {
        int32_t *v = j->tet + 4 * t;
        int sign = tc_orient3d(x + 3 * (size_t)v[0], x + 3 * (size_t)v[1], x + 3 * (size_t)v[2], x + 3 * (size_t)v[3]);
        if (sign < 0) {
            int32_t k = v[2];
            v[2] = v[3], v[3] = k;
            reoriented++;
        }
        zero += sign == 0;
    }
    atomic_fetch_add(&j->reoriented, reoriented);
    atomic_fetch_add(&j->zero, zero);
}

/* ------------------------------------------------------------------------------------------------------ repair */

static bool repeats(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return a == b || a == c || a == d || b == c || b == d || c == d;
}

static bool finite_point(const double *p)
{
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

/* Numbers the vertices in use (of source `in`), copies them and their data to out, and rewrites out->tet. */
static tc_status compact(tc_mesh *out, const tc_mesh *in, const int32_t *same, uint8_t *use, tc_error *err)
{
    size_t n = 0, n_tet = out->n_tet;
    memset(use, 0, in->n_vertex);
    for (size_t i = 0; i < 4 * n_tet; i++)
        use[out->tet[i]] = 1;
    for (size_t v = 0; v < in->n_vertex; v++)
        out->vertex_of_source[v] = use[v] ? (int32_t)n++ : -1;
    for (size_t v = 0; v < in->n_vertex; v++)
        if (!use[v] && same[v] != (int32_t)v && use[same[v]])
            out->vertex_of_source[v] = out->vertex_of_source[same[v]];
    size_t n_scalar = in->association == TC_CELL_DATA ? n_tet : n;
    out->n_vertex = n;
    out->vertex = tc_alloc(n, 3 * sizeof(double));
    out->scalar = tc_alloc(n_scalar, sizeof(double));
    if (!out->vertex || !out->scalar)
        return tc_fail_memory(err, "the repaired mesh", n + n_scalar, 3 * sizeof(double));
    for (size_t v = 0; v < in->n_vertex; v++) {
        if (!use[v])
            continue;
        size_t w = (size_t)out->vertex_of_source[v];
        for (int k = 0; k < 3; k++)
            out->vertex[3 * w + (size_t)k] = in->vertex[3 * v + (size_t)k] + 0.0; /* -0 becomes 0 */
        if (in->association != TC_CELL_DATA)
            out->scalar[w] = in->scalar[v];
    }
    for (size_t i = 0; i < 4 * n_tet; i++)
        out->tet[i] = out->vertex_of_source[out->tet[i]];
    if (in->association == TC_CELL_DATA)
        for (size_t t = 0; t < in->n_tet; t++)
            if (out->tet_of_source[t] >= 0)
                out->scalar[out->tet_of_source[t]] = in->scalar[t];
    return TC_OK;
}

tc_status tc_mesh_repair(tc_mesh *out, const tc_mesh *in, int threads, tc_error *err)
{
    tc_status status = TC_OK;
    tc_mesh_report *r = &out->report;
    const size_t nv = in->n_vertex, nt = in->n_tet;
    uint8_t *use = tc_calloc(nv, 1);
    int32_t *same = tc_alloc(nv, sizeof *same);
    out->n_vertex_source = nv, out->n_tet_source = nt;
    out->association = in->association;
    out->tet = tc_alloc(nt, 4 * sizeof *out->tet);
    out->vertex_of_source = tc_alloc(nv, sizeof *out->vertex_of_source);
    out->tet_of_source = tc_alloc(nt, sizeof *out->tet_of_source);
    if (!use || !same || !out->tet || !out->vertex_of_source || !out->tet_of_source) {
        status = tc_fail_memory(err, "checking the mesh", nt * 5 + nv * 2, sizeof(int32_t));
        goto done;
    }
    for (size_t t = 0; t < nt; t++) {
        const int32_t *v = in->tet + 4 * t;
        out->tet_of_source[t] = -1;
        if (repeats(v[0], v[1], v[2], v[3])) {
            r->dropped_degenerate++;
            continue;
        }
        bool finite = true;
        for (int i = 0; i < 4; i++)
            finite = finite && finite_point(in->vertex + 3 * (size_t)v[i]);
        if (!finite) {
            r->dropped_nonfinite++;
            continue;
        }
        for (int i = 0; i < 4; i++)
            use[v[i]] = 1;
        out->tet_of_source[t] = 0;
    }
    const double *key = in->association == TC_CELL_DATA ? NULL : in->scalar;
    for (size_t v = 0; v < nv; v++)
        r->unused_vertices += !use[v];
    status = tc_points_merge(same, &r->merged_vertices, in->vertex, key, use, nv, err);
    if (status != TC_OK)
        goto done;
    for (size_t t = 0; t < nt; t++) {
        if (out->tet_of_source[t] < 0)
            continue;
        const int32_t *v = in->tet + 4 * t;
        int32_t a = same[v[0]], b = same[v[1]], c = same[v[2]], d = same[v[3]];
        if (repeats(a, b, c, d)) {
            r->dropped_degenerate++;
            out->tet_of_source[t] = -1;
            continue;
        }
        int32_t *w = out->tet + 4 * out->n_tet;
        w[0] = a, w[1] = b, w[2] = c, w[3] = d;
        out->tet_of_source[t] = (int32_t)out->n_tet++;
    }
    if (out->n_tet == 0) {
        status = nt == 0 ? tc_fail(err, TC_E_MESH, "the mesh has no tetrahedra: there is nothing to render")
                         : tc_fail(err, TC_E_MESH,
                                   "none of the %zu tetrahedra can be rendered: %zu repeat a vertex, %zu have a vertex "
                                   "that is not finite; check the coordinates and the connectivity",
                                   nt, r->dropped_degenerate, r->dropped_nonfinite);
        goto done;
    }
    status = compact(out, in, same, use, err);
    if (status != TC_OK)
        goto done;
    r->unused_vertices = nv - r->merged_vertices - out->n_vertex;
    turn j = {.vertex = out->vertex, .tet = out->tet};
    atomic_init(&j.reoriented, 0);
    atomic_init(&j.zero, 0);
    tc_parallel_for(out->n_tet, 4096, threads, turn_range, &j);
    r->reoriented = atomic_load(&j.reoriented);
    r->zero_volume = atomic_load(&j.zero);
done:
    free(use);
    free(same);
    return status;
}

void tc_mesh_drop_tets(tc_mesh *mesh, const uint8_t *drop)
{
    size_t n = 0;
    for (size_t s = 0; s < mesh->n_tet_source; s++)
        if (mesh->tet_of_source[s] >= 0 && drop[mesh->tet_of_source[s]])
            mesh->tet_of_source[s] = -1;
    /* tets need not lie in the source's order: renumber through the kept ones' ranks */
    int32_t *rank = mesh->neighbour; /* [n_tet][4], not in use yet */
    for (size_t t = 0; t < mesh->n_tet; t++) {
        if (drop[t])
            continue;
        rank[t] = (int32_t)n;
        memmove(mesh->tet + 4 * n, mesh->tet + 4 * t, 4 * sizeof *mesh->tet);
        if (mesh->association == TC_CELL_DATA)
            mesh->scalar[n] = mesh->scalar[t];
        n++;
    }
    for (size_t s = 0; s < mesh->n_tet_source; s++)
        if (mesh->tet_of_source[s] >= 0)
            mesh->tet_of_source[s] = rank[mesh->tet_of_source[s]];
    mesh->n_tet = n;
}
