/* pack_gradient.c: the scalar's gradient in cells or at vertices, as floats for the GPU.
 *
 * Positions and scalars are scaled by powers of two, which rounds nothing, and what is left to the packed units is one
 * factor at the end. A tet with corners a, b, c, d and e0, e1, e2 from a to the others has six volumes v = e0.(e1 x e2)
 * and, of its linear interpolation, the gradient g with v g = s0 (e1 x e2) + s1 (e2 x e0) + s2 (e0 x e1), s0 … s2 the
 * differences of the scalar. The mean by volume at a vertex needs v g alone. */
#include "gpu/pack_gradient.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/room.h"
#include "core/vec.h"
#include "mesh/predicate.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A tet is thin where its volume is less than this part of the product of its edges: then double would lose digits. */
static const double THIN = 1e-6;
/* The spread of centroids, squared, across an open direction as part of the widest; and the determinant, as part of the
 * cube of the trace, above which none can be that narrow. */
static const double OPEN = 1e-12, SAFE = 1e-6;
static const double LONGEST = 1e18;

enum { CHUNK = 4096 };               /* cells, one thread's at a time */
enum { SPANS = 64, SPAN_BITS = 12 }; /* of vertices: at most; at least 2^12 vertices each */

typedef struct job {
    const tc_mesh *mesh;
    float *out;
    double position, scalar; /* powers of two */
    double factor;           /* of a gradient in these units to that in packed ones */
    /* of vertices only */
    int shift;         /* vertex v is in span v >> shift */
    uint64_t *touched; /* [chunks] spans that a chunk of cells has vertices in */
    struct slot *slot; /* [threads][1 << shift] */
} job;

/* What a tet says: v g, v, and g itself where v is 0. */
typedef struct plane {
    double sum[3], volume;
} plane;

static void clear(plane *p)
{
    memset(p, 0, sizeof *p);
}

/* ------------------------------------------------------------------------------- twice the digits (Dekker 1971) */

typedef struct twice {
    double hi, lo;
} twice;

static twice twice_sum(double a, double b)
{
    const double s = a + b, t = s - a;
    return (twice){s, (a - (s - t)) + (b - t)};
}

static twice twice_add(twice a, twice b)
{
    const twice s = twice_sum(a.hi, b.hi);
    return twice_sum(s.hi, s.lo + (a.lo + b.lo));
}

static twice twice_mul(twice a, twice b)
{
    const double p = a.hi * b.hi;
    return twice_sum(p, fma(a.hi, b.hi, -p) + (a.hi * b.lo + a.lo * b.hi));
}

/* a b - c d */
static twice twice_cross(twice a, twice b, twice c, twice d)
{
    const twice minus = {-c.hi, -c.lo};
    return twice_add(twice_mul(a, b), twice_mul(minus, d));
}

static void plane_of_thin(plane *p, double x[4][3], const double s[4])
{
    twice e[3][3], d[3], n[3][3], volume = {0, 0};
    clear(p);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            e[i][k] = twice_sum(x[i + 1][k], -x[0][k]);
        d[i] = twice_sum(s[i + 1], -s[0]);
    }
    for (int i = 0; i < 3; i++) {
        const twice *a = e[(i + 1) % 3], *b = e[(i + 2) % 3];
        for (int k = 0; k < 3; k++)
            n[i][k] = twice_cross(a[(k + 1) % 3], b[(k + 2) % 3], a[(k + 2) % 3], b[(k + 1) % 3]);
    }
    for (int k = 0; k < 3; k++) {
        volume = twice_add(volume, twice_mul(e[0][k], n[0][k]));
        twice sum = {0, 0};
        for (int i = 0; i < 3; i++)
            sum = twice_add(sum, twice_mul(d[i], n[i][k]));
        p->sum[k] = sum.hi;
    }
    p->volume = volume.hi;
    if (!(p->volume > 0)) /* too small for its product */
        clear(p);
}

/* --------------------------------------------------------------------------------------------------- point data */

static double largest(const double *e)
{
    const double x = fabs(e[0]), y = fabs(e[1]), z = fabs(e[2]);
    const double xy = x > y ? x : y;
    return xy > z ? xy : z;
}

static void load_corners(double x[4][3], const job *j, const int32_t *tet)
{
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            x[i][k] = j->position * j->mesh->vertex[3 * (size_t)tet[i] + (size_t)k];
}

static bool is_flat(const tc_mesh *m, const int32_t *tet)
{
    return tc_orient3d(m->vertex + 3 * (size_t)tet[0], m->vertex + 3 * (size_t)tet[1], m->vertex + 3 * (size_t)tet[2],
                       m->vertex + 3 * (size_t)tet[3]) == 0;
}

/* Of the linear interpolation of s [4], all finite. */
static void plane_of_values(plane *p, const job *j, const int32_t *tet, const double s[4])
{
    double x[4][3], e[3][3], n[3][3];
    load_corners(x, j, tet);
    for (int i = 0; i < 3; i++)
        tc_vec_sub(e[i], x[i + 1], x[0]);
    for (int i = 0; i < 3; i++)
        tc_vec_cross(n[i], e[(i + 1) % 3], e[(i + 2) % 3]);
    p->volume = tc_vec_dot(e[0], n[0]);
    if (p->volume <= THIN * largest(e[0]) * largest(e[1]) * largest(e[2])) {
        if (is_flat(j->mesh, tet))
            clear(p);
        else
            plane_of_thin(p, x, s);
        return;
    }
    const double d[3] = {s[1] - s[0], s[2] - s[0], s[3] - s[0]};
    for (int k = 0; k < 3; k++)
        p->sum[k] = d[0] * n[0][k] + d[1] * n[1][k] + d[2] * n[2][k];
}

/* ---------------------------------------------------------------------------------------------------- cell data */

/* Eigenvalues (a's diagonal) and unit eigenvectors (v's columns) of a symmetric matrix (Jacobi 1846). */
static void rotate_to_axes(double a[3][3], double v[3][3])
{
    memset(v, 0, 9 * sizeof v[0][0]);
    for (int i = 0; i < 3; i++)
        v[i][i] = 1;
    for (int turn = 0; turn < 60; turn++) {
        const int p = turn % 3 == 2 ? 1 : 0, q = turn % 3 == 0 ? 1 : 2;
        if (a[p][q] == 0)
            continue;
        const double half = (a[q][q] - a[p][p]) / (2 * a[p][q]);
        const double t = copysign(1, half) / (fabs(half) + hypot(half, 1)), c = 1 / sqrt(t * t + 1), s = t * c;
        const int r = 3 - p - q;
        const double rp = a[r][p], rq = a[r][q];
        a[p][p] -= t * a[p][q];
        a[q][q] += t * a[p][q];
        a[p][q] = a[q][p] = 0;
        a[r][p] = a[p][r] = c * rp - s * rq;
        a[r][q] = a[q][r] = s * rp + c * rq;
        for (int k = 0; k < 3; k++) {
            const double x = v[k][p], y = v[k][q];
            v[k][p] = c * x - s * y;
            v[k][q] = s * x + c * y;
        }
    }
}

/* The least g with a g = b, as far as directions are not open. */
static void solve_least(double g[3], double a[3][3], const double b[3])
{
    double n[3][3], v[3][3];
    const double trace = a[0][0] + a[1][1] + a[2][2];
    for (int i = 0; i < 3; i++)
        tc_vec_cross(n[i], a[(i + 1) % 3], a[(i + 2) % 3]);
    const double volume = tc_vec_dot(a[0], n[0]);
    if (volume > SAFE * trace * trace * trace) {
        for (int k = 0; k < 3; k++)
            g[k] = (b[0] * n[0][k] + b[1] * n[1][k] + b[2] * n[2][k]) / volume;
        return;
    }
    rotate_to_axes(a, v);
    const double most = fmax(a[0][0], fmax(a[1][1], a[2][2]));
    g[0] = g[1] = g[2] = 0;
    for (int i = 0; i < 3; i++) {
        const double axis[3] = {v[0][i], v[1][i], v[2][i]};
        if (a[i][i] > OPEN * most)
            tc_vec_mul_add(g, g, tc_vec_dot(axis, b) / a[i][i], axis);
    }
}

/* Where a cell's centroid lies from `origin`. */
static void centroid_from(double out[3], const job *j, size_t cell, const double *origin)
{
    double x[4][3];
    load_corners(x, j, j->mesh->tet + 4 * cell);
    for (int k = 0; k < 3; k++)
        out[k] = 0.25 * ((x[0][k] - origin[k]) + (x[1][k] - origin[k]) + (x[2][k] - origin[k]) + (x[3][k] - origin[k]));
}

/* The plane that fits the values of the cell and its real neighbours best; the cell's own is finite. */
static void gradient_of_cell(double g[3], const job *j, size_t cell)
{
    const tc_mesh *m = j->mesh;
    double at[5][3], s[5], x[4][3], middle[3] = {0, 0, 0}, mean = 0, a[3][3] = {{0}}, b[3] = {0, 0, 0};
    int n = 0;
    load_corners(x, j, m->tet + 4 * cell);
    for (int f = -1; f < 4; f++) {
        const int32_t of = f < 0 ? (int32_t)cell : m->neighbour[4 * cell + (size_t)f];
        if (of < 0 || (size_t)of >= m->n_tet || !isfinite(m->scalar[of]))
            continue;
        centroid_from(at[n], j, (size_t)of, x[0]);
        s[n] = j->scalar * m->scalar[of] - j->scalar * m->scalar[cell];
        n++;
    }
    for (int i = 0; i < n; i++) {
        tc_vec_mul_add(middle, middle, 1.0 / n, at[i]);
        mean += s[i] / n;
    }
    for (int i = 0; i < n; i++) {
        double d[3];
        tc_vec_sub(d, at[i], middle);
        for (int k = 0; k < 3; k++) {
            tc_vec_mul_add(a[k], a[k], d[k], d);
            b[k] += d[k] * (s[i] - mean);
        }
    }
    solve_least(g, a, b);
}

/* --------------------------------------------------------------------------------------------------------- cells */

/* False: a value is not finite, the cell counts nowhere. */
static bool plane_of_cell(plane *p, const job *j, size_t cell)
{
    const tc_mesh *m = j->mesh;
    const int32_t *tet = m->tet + 4 * cell;
    double s[4];
    if (m->association == TC_CELL_DATA) {
        if (!isfinite(m->scalar[cell]))
            return false;
        double g[3];
        static const double none[4];
        plane_of_values(p, j, tet, none); /* for its volume */
        gradient_of_cell(g, j, cell);
        for (int k = 0; k < 3; k++)
            p->sum[k] = p->volume > 0 ? p->volume * g[k] : g[k];
        return true;
    }
    for (int i = 0; i < 4; i++) {
        s[i] = j->scalar * m->scalar[tet[i]];
        if (!isfinite(s[i]))
            return false;
    }
    plane_of_values(p, j, tet, s);
    return true;
}

/* Writes sum / weight in packed units, and its length. */
static void put(float *out, const job *j, const double sum[3], double weight)
{
    double g[3];
    for (int k = 0; k < 3; k++)
        g[k] = sum[k] / weight * j->factor;
    const double most = largest(g);
    memset(out, 0, 4 * sizeof *out);
    if (!isfinite(g[0]) || !isfinite(g[1]) || !isfinite(g[2]) || most < FLT_MIN)
        return;
    if (most > LONGEST)
        for (int k = 0; k < 3; k++)
            g[k] /= most;
    double length = tc_vec_length(g), shrink = 1;
    if (most > LONGEST || length > LONGEST)
        shrink = LONGEST / length;
    for (int k = 0; k < 3; k++)
        out[k] = (float)(shrink * g[k]);
    out[3] = (float)(shrink * length);
}

static void cell_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const job *j = context;
    for (size_t i = begin; i < end; i++) {
        plane p;
        if (plane_of_cell(&p, j, i))
            put(j->out + 4 * i, j, p.sum, p.volume > 0 ? p.volume : 1);
        else
            memset(j->out + 4 * i, 0, 4 * sizeof *j->out);
    }
}

/* ------------------------------------------------------------------------------------------------------ vertices */

/* What is summed up at a vertex: of tets with a volume, and until there is one of the others. */
typedef struct slot {
    double sum[3], volume;
    size_t n; /* of those without one */
} slot;

static void add_plane(slot *to, const plane *p)
{
    if (p->volume > 0) {
        if (to->volume == 0)
            to->sum[0] = to->sum[1] = to->sum[2] = 0;
        tc_vec_add(to->sum, to->sum, p->sum);
        to->volume += p->volume;
    } else if (to->volume == 0) {
        tc_vec_add(to->sum, to->sum, p->sum);
        to->n++;
    }
}

static void touch_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const job *j = context;
    uint64_t spans = 0;
    for (size_t i = 4 * begin; i < 4 * end; i++)
        spans |= UINT64_C(1) << (j->mesh->tet[i] >> j->shift);
    j->touched[begin / CHUNK] = spans;
}

/* The vertices of a span, from the cells of all chunks that touch it, in their order: cells that lie across spans are
 * computed once for each, which along a Hilbert curve are few. */
static void span_range(void *context, size_t begin, size_t end, int worker)
{
    const job *j = context;
    const tc_mesh *m = j->mesh;
    const size_t span = (size_t)1 << j->shift;
    slot *at = j->slot + (size_t)worker * span;
    for (size_t s = begin; s < end; s++) {
        const size_t first = s << j->shift, n = m->n_vertex - first < span ? m->n_vertex - first : span;
        memset(at, 0, n * sizeof *at);
        for (size_t c = 0; c < m->n_tet; c++) {
            if (c % CHUNK == 0 && !(j->touched[c / CHUNK] >> s & 1)) {
                c += CHUNK - 1;
                continue;
            }
            const int32_t *tet = m->tet + 4 * c;
            plane p;
            bool any = false;
            for (int k = 0; k < 4; k++)
                any |= (size_t)tet[k] >> j->shift == s;
            if (!any || !plane_of_cell(&p, j, c))
                continue;
            for (int k = 0; k < 4; k++)
                if ((size_t)tet[k] >> j->shift == s)
                    add_plane(&at[(size_t)tet[k] - first], &p);
        }
        for (size_t v = 0; v < n; v++)
            put(j->out + 4 * (first + v), j, at[v].sum,
                at[v].volume > 0 ? at[v].volume
                : at[v].n > 0    ? (double)at[v].n
                                 : 1);
    }
}

static tc_status sum_at_vertices(job *j, int threads, tc_error *err)
{
    const tc_mesh *m = j->mesh;
    const size_t workers = (size_t)tc_threads(threads);
    j->shift = SPAN_BITS;
    while (m->n_vertex > 0 && (m->n_vertex - 1) >> j->shift >= SPANS)
        j->shift++;
    j->touched = tc_alloc((m->n_tet + CHUNK - 1) / CHUNK, sizeof *j->touched);
    j->slot = tc_alloc(workers << j->shift, sizeof *j->slot);
    tc_status status = TC_OK;
    if (j->touched && j->slot) {
        tc_parallel_for(m->n_tet, CHUNK, threads, touch_range, j);
        tc_parallel_for(m->n_vertex > 0 ? ((m->n_vertex - 1) >> j->shift) + 1 : 0, 1, threads, span_range, j);
    } else {
        status = tc_fail_memory(err, "gradients", workers << j->shift, sizeof *j->slot);
    }
    free(j->touched);
    free(j->slot);
    return status;
}

/* ---------------------------------------------------------------------------------------------------------- units */

/* A power of two near 1/x, one for no length. */
static double inverse_power(double x)
{
    return x > 0 && isfinite(x) ? ldexp(1, -ilogb(x) < 1023 ? -ilogb(x) : 1023) : 1;
}

static void set_units(job *j, const tc_pack_units *units)
{
    const double whole = units->scalar_hi - units->scalar_lo, half = 0.5 * units->scalar_hi - 0.5 * units->scalar_lo;
    j->position = 1 / inverse_power(units->scale);
    j->scalar = inverse_power(isfinite(whole) ? whole : half);
    const double width = j->scalar * units->scalar_hi - j->scalar * units->scalar_lo;
    j->factor = width > 0 ? j->position / units->scale / width : 0;
}

tc_status tc_pack_gradient(float **out, const tc_mesh *mesh, tc_gradient kind, const tc_pack_units *units, int threads,
                           tc_error *err)
{
    const size_t n = kind == TC_GRADIENT_CELL ? mesh->n_tet : mesh->n_vertex;
    job j = {.mesh = mesh};
    *out = NULL;
    tc_status status = tc_room_check(2 * 16 * n, err, "gradients of %zu cells", mesh->n_tet); /* GL copies them */
    if (status != TC_OK)
        return status;
    j.out = tc_alloc(n, 4 * sizeof *j.out);
    if (!j.out)
        return tc_fail_memory(err, "gradients", n, 4 * sizeof *j.out);
    set_units(&j, units);
    if (kind == TC_GRADIENT_CELL)
        tc_parallel_for(mesh->n_tet, CHUNK, threads, cell_range, &j);
    else
        status = sum_at_vertices(&j, threads, err);
    if (status != TC_OK)
        free(j.out);
    else
        *out = j.out;
    return status;
}
