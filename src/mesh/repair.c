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

enum { CHUNK = 8192 };

/* Points in a hash table with open addressing. A slot that holds a point of some place goes on to hold one of that
 * place, the first that has come by, so that the end does not depend on who came when. */
typedef struct merge {
    int32_t *same;
    atomic_int *slot; /* point + 1, or 0 */
    size_t n_slot;    /* a power of two, at most 2^32 */
    const double *vertex, *scalar;
    atomic_uchar *use;
    atomic_size_t merged;
} merge;

static bool is_used(atomic_uchar *use, size_t v)
{
    return atomic_load_explicit(&use[v], memory_order_relaxed) != 0;
}

static void enter_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const merge *j = context;
    for (size_t v = begin; v < end; v++) {
        if (!is_used(j->use, v))
            continue;
        const double *p = j->vertex + 3 * v;
        uint64_t h = mix(mix(mix(0, bits_of(p[0])), bits_of(p[1])), bits_of(p[2]));
        if (j->scalar)
            h = mix(h, bits_of(j->scalar[v]));
        const int mine = (int)v + 1;
        size_t i = (size_t)(h ^ h >> 32) & (j->n_slot - 1);
        for (;; i = (i + 1) & (j->n_slot - 1)) {
            int there = atomic_load_explicit(&j->slot[i], memory_order_relaxed);
            if (there == 0 && atomic_compare_exchange_strong(&j->slot[i], &there, mine))
                break;
            size_t w = (size_t)there - 1;
            if (!same_point(p, j->vertex + 3 * w) || (j->scalar && !same_value(j->scalar[v], j->scalar[w])))
                continue;
            while (mine < there && !atomic_compare_exchange_weak(&j->slot[i], &there, mine)) {
            }
            break;
        }
        j->same[v] = (int32_t)(uint32_t)i;
    }
}

static void leave_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    merge *j = context;
    size_t merged = 0;
    for (size_t v = begin; v < end; v++) {
        j->same[v] = is_used(j->use, v) ? atomic_load_explicit(&j->slot[(uint32_t)j->same[v]], memory_order_relaxed) - 1
                                        : (int32_t)v;
        merged += j->same[v] != (int32_t)v;
    }
    atomic_fetch_add(&j->merged, merged);
}

/* Points by coordinates.
 *   same [n] gets for each point in use the first such point with equal coordinates (and equal scalar where scalar is
 * not NULL), for the others the point itself. *merged: how many got another than themselves. Errors: TC_E_MEMORY. Cost:
 * O(n), 8 to 16 B a point of scratch. */
static tc_status merge_points(int32_t *same, size_t *merged, const double *vertex, const double *scalar,
                              atomic_uchar *use, size_t n, int threads, tc_error *err)
{
    merge j = {.same = same, .n_slot = 16, .vertex = vertex, .scalar = scalar, .use = use};
    while (j.n_slot < 2 * n)
        j.n_slot *= 2;
    j.slot = tc_calloc(j.n_slot, sizeof *j.slot);
    atomic_init(&j.merged, 0);
    if (!j.slot)
        return tc_fail_memory(err, "merging points", j.n_slot, sizeof *j.slot);
    tc_parallel_for(n, CHUNK, threads, enter_range, &j);
    tc_parallel_for(n, CHUNK, threads, leave_range, &j);
    *merged = atomic_load(&j.merged);
    free(j.slot);
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------------------ repair */

typedef struct fix {
    const tc_mesh *in;
    tc_mesh *out;
    uint8_t *finite;   /* [points] */
    atomic_uchar *use; /* [points] by tets that are kept */
    int32_t *same;     /* [points] as merge_points gives it */
    size_t *kept;      /* of each chunk of tets: how many are kept; then, how many before it */
    size_t *numbered;  /* the same of points */
    atomic_size_t degenerate, nonfinite, reoriented, zero;
} fix;

static bool repeats(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return a == b || a == c || a == d || b == c || b == d || c == d;
}

static void finite_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const fix *j = context;
    for (size_t v = begin; v < end; v++) {
        const double *p = j->in->vertex + 3 * v;
        j->finite[v] = isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
    }
}

static void use_point(const fix *j, int32_t v)
{
    if (!is_used(j->use, (size_t)v))
        atomic_store_explicit(&j->use[v], 1, memory_order_relaxed);
}

/* Which tets are kept as they are given. */
static void judge_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    fix *j = context;
    size_t degenerate = 0, nonfinite = 0;
    for (size_t t = begin; t < end; t++) {
        const int32_t *v = j->in->tet + 4 * t;
        bool twice = repeats(v[0], v[1], v[2], v[3]);
        bool finite = j->finite[v[0]] && j->finite[v[1]] && j->finite[v[2]] && j->finite[v[3]];
        degenerate += twice;
        nonfinite += !twice && !finite;
        j->out->tet_of_source[t] = twice || !finite ? -1 : 0;
        for (int i = 0; i < 4 && !twice && finite; i++)
            use_point(j, v[i]);
    }
    j->kept[begin / CHUNK] = end - begin - degenerate - nonfinite;
    atomic_fetch_add(&j->degenerate, degenerate);
    atomic_fetch_add(&j->nonfinite, nonfinite);
}

/* Which of them are kept now that points are merged. */
static void judge_merged_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    fix *j = context;
    size_t degenerate = 0;
    for (size_t t = begin; t < end; t++) {
        if (j->out->tet_of_source[t] < 0)
            continue;
        const int32_t *v = j->in->tet + 4 * t;
        int32_t w[4];
        for (int i = 0; i < 4; i++)
            w[i] = j->same[v[i]];
        bool twice = repeats(w[0], w[1], w[2], w[3]);
        degenerate += twice;
        if (twice)
            j->out->tet_of_source[t] = -1;
        for (int i = 0; i < 4 && !twice; i++)
            use_point(j, w[i]);
    }
    j->kept[begin / CHUNK] -= degenerate;
    atomic_fetch_add(&j->degenerate, degenerate);
}

static void count_points_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const fix *j = context;
    size_t n = 0;
    for (size_t v = begin; v < end; v++)
        n += is_used(j->use, v);
    j->numbered[begin / CHUNK] = n;
}

static void number_points_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const fix *j = context;
    const tc_mesh *in = j->in;
    size_t n = j->numbered[begin / CHUNK];
    for (size_t v = begin; v < end; v++) {
        bool used = is_used(j->use, v);
        j->out->vertex_of_source[v] = used ? (int32_t)n : -1;
        if (!used)
            continue;
        for (int k = 0; k < 3; k++)
            j->out->vertex[3 * n + (size_t)k] = in->vertex[3 * v + (size_t)k] + 0.0; /* -0 becomes 0 */
        if (in->association != TC_CELL_DATA)
            j->out->scalar[n] = in->scalar[v];
        n++;
    }
}

static void number_merged_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const fix *j = context;
    for (size_t v = begin; v < end; v++)
        if (j->same[v] != (int32_t)v) /* then v itself is not used, and no other entry that is read here is written */
            j->out->vertex_of_source[v] = j->out->vertex_of_source[j->same[v]];
}

/* Writes the tets that are kept, turned to positive volume. */
static void write_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    fix *j = context;
    tc_mesh *out = j->out;
    const double *x = out->vertex;
    size_t n = j->kept[begin / CHUNK], reoriented = 0, zero = 0;
    for (size_t t = begin; t < end; t++) {
        if (out->tet_of_source[t] < 0)
            continue;
        int32_t *v = out->tet + 4 * n;
        for (size_t i = 0; i < 4; i++)
            v[i] = out->vertex_of_source[j->in->tet[4 * t + i]];
        int sign = tc_orient3d(x + 3 * (size_t)v[0], x + 3 * (size_t)v[1], x + 3 * (size_t)v[2], x + 3 * (size_t)v[3]);
        if (sign < 0) {
            int32_t k = v[2];
            v[2] = v[3], v[3] = k;
        }
        reoriented += sign < 0;
        zero += sign == 0;
        if (j->in->association == TC_CELL_DATA)
            out->scalar[n] = j->in->scalar[t];
        out->tet_of_source[t] = (int32_t)n++;
    }
    atomic_fetch_add(&j->reoriented, reoriented);
    atomic_fetch_add(&j->zero, zero);
}

/* Counts of chunks become sums of those before; gives the sum of all. */
static size_t sum_before(size_t *count, size_t n)
{
    size_t sum = 0;
    for (size_t i = 0; i < n; i++) {
        size_t c = count[i];
        count[i] = sum;
        sum += c;
    }
    return sum;
}

/* Numbers the points in use and the tets that are kept, and writes them to out. */
static tc_status write_kept(fix *j, size_t n_merged, int threads, tc_error *err)
{
    tc_mesh *out = j->out;
    const size_t nv = j->in->n_vertex, nt = j->in->n_tet;
    tc_parallel_for(nv, CHUNK, threads, count_points_range, j);
    out->n_vertex = sum_before(j->numbered, nv / CHUNK + 1);
    size_t n_scalar = out->association == TC_CELL_DATA ? out->n_tet : out->n_vertex;
    out->vertex = tc_alloc(out->n_vertex, 3 * sizeof(double));
    out->scalar = tc_alloc(n_scalar, sizeof(double));
    out->tet = tc_alloc(out->n_tet, 4 * sizeof *out->tet);
    if (!out->vertex || !out->scalar || !out->tet)
        return tc_fail_memory(err, "the repaired mesh", 3 * out->n_vertex + n_scalar + 2 * out->n_tet, sizeof(double));
    tc_parallel_for(nv, CHUNK, threads, number_points_range, j);
    if (n_merged > 0)
        tc_parallel_for(nv, CHUNK, threads, number_merged_range, j);
    tc_parallel_for(nt, CHUNK, threads, write_range, j);
    return TC_OK;
}

tc_status tc_mesh_repair(tc_mesh *out, const tc_mesh *in, int threads, tc_error *err)
{
    tc_status status = TC_OK;
    tc_mesh_report *r = &out->report;
    const size_t nv = in->n_vertex, nt = in->n_tet;
    fix j = {.in = in,
             .out = out,
             .finite = tc_alloc(nv, 1),
             .use = tc_calloc(nv, sizeof *j.use),
             .same = tc_alloc(nv, sizeof *j.same),
             .kept = tc_calloc(nt / CHUNK + 1, sizeof *j.kept),
             .numbered = tc_calloc(nv / CHUNK + 1, sizeof *j.numbered)};
    atomic_init(&j.degenerate, 0);
    atomic_init(&j.nonfinite, 0);
    atomic_init(&j.reoriented, 0);
    atomic_init(&j.zero, 0);
    out->n_vertex_source = nv, out->n_tet_source = nt;
    out->association = in->association;
    out->vertex_of_source = tc_alloc(nv, sizeof *out->vertex_of_source);
    out->tet_of_source = tc_alloc(nt, sizeof *out->tet_of_source);
    if (!j.finite || !j.use || !j.same || !j.kept || !j.numbered || !out->vertex_of_source || !out->tet_of_source) {
        status = tc_fail_memory(err, "checking the mesh", nt + nv * 3, sizeof(int32_t));
        goto done;
    }
    tc_parallel_for(nv, CHUNK, threads, finite_range, &j);
    tc_parallel_for(nt, CHUNK, threads, judge_range, &j);
    const double *key = in->association == TC_CELL_DATA ? NULL : in->scalar;
    status = merge_points(j.same, &r->merged_vertices, in->vertex, key, j.use, nv, threads, err);
    if (status != TC_OK)
        goto done;
    if (r->merged_vertices > 0) {
        for (size_t v = 0; v < nv; v++)
            atomic_store_explicit(&j.use[v], 0, memory_order_relaxed);
        tc_parallel_for(nt, CHUNK, threads, judge_merged_range, &j);
    }
    r->dropped_degenerate = atomic_load(&j.degenerate);
    r->dropped_nonfinite = atomic_load(&j.nonfinite);
    out->n_tet = sum_before(j.kept, nt / CHUNK + 1);
    if (out->n_tet == 0) {
        status = nt == 0 ? tc_fail(err, TC_E_MESH, "the mesh has no tetrahedra: there is nothing to render")
                         : tc_fail(err, TC_E_MESH,
                                   "none of the %zu tetrahedra can be rendered: %zu repeat a vertex, %zu have a vertex "
                                   "that is not finite; check the coordinates and the connectivity",
                                   nt, r->dropped_degenerate, r->dropped_nonfinite);
        goto done;
    }
    status = write_kept(&j, r->merged_vertices, threads, err);
    r->unused_vertices = nv - r->merged_vertices - out->n_vertex;
    r->reoriented = atomic_load(&j.reoriented);
    r->zero_volume = atomic_load(&j.zero);
done:
    free(j.finite);
    free(j.use);
    free(j.same);
    free(j.kept);
    free(j.numbered);
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
