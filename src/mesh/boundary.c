/* boundary.c: the faces of a linked mesh that have no neighbour, as a surface. */
#include "mesh/boundary.h"

#include "core/memory.h"
#include "core/vec.h"
#include "mesh/adjacency.h"

#include <stdlib.h>
#include <string.h>

void tc_boundary_finish(tc_boundary *b)
{
    free(b->face);
    free(b->owner);
    free(b->vertex);
    free(b->across);
    *b = (tc_boundary){0};
}

/* Fills face (mesh ids), owner, vertex and numbers the corners locally. */
static tc_status collect(tc_boundary *b, const tc_mesh *m, size_t n_tet, tc_error *err)
{
    int32_t *local = tc_calloc(m->n_vertex, sizeof *local);
    if (!local)
        return tc_fail_memory(err, "the boundary", m->n_vertex, sizeof *local);
    tc_status status = TC_OK;
    for (size_t i = 0; i < 4 * n_tet; i++)
        b->n_face += m->neighbour[i] < 0 || (size_t)m->neighbour[i] >= n_tet;
    b->face = tc_alloc(b->n_face, 3 * sizeof *b->face);
    b->owner = tc_alloc(b->n_face, sizeof *b->owner);
    b->across = tc_alloc(b->n_face, 3 * sizeof *b->across);
    if (!b->face || !b->owner || !b->across) {
        status = tc_fail_memory(err, "the boundary", b->n_face, 40);
        goto done;
    }
    size_t n = 0;
    for (size_t i = 0; i < 4 * n_tet; i++) {
        if (m->neighbour[i] >= 0 && (size_t)m->neighbour[i] < n_tet)
            continue;
        b->owner[n] = (uint32_t)i;
        for (int k = 0; k < 3; k++) {
            int32_t v = m->tet[(i & ~(size_t)3) + tc_tet_face[i & 3][k]];
            b->face[3 * n + (size_t)k] = v;
            local[v] = 1;
        }
        n++;
    }
    for (size_t v = 0; v < m->n_vertex; v++)
        b->n_vertex += (size_t)local[v];
    b->vertex = tc_alloc(b->n_vertex, sizeof *b->vertex);
    if (!b->vertex) {
        status = tc_fail_memory(err, "the boundary", b->n_vertex, sizeof *b->vertex);
        goto done;
    }
    n = 0;
    for (size_t v = 0; v < m->n_vertex; v++)
        if (local[v]) {
            local[v] = (int32_t)n;
            b->vertex[n++] = (int32_t)v;
        }
    for (size_t i = 0; i < 3 * b->n_face; i++)
        b->face[i] = local[b->face[i]];
done:
    free(local);
    return status;
}

typedef struct edge {
    int32_t other; /* the larger vertex */
    bool up;       /* runs from the smaller to the larger */
    int64_t id;    /* 3 * face + edge */
} edge;

static int edge_compare(const void *a, const void *b)
{
    const edge *p = a, *q = b;
    if (p->other != q->other)
        return p->other < q->other ? -1 : 1;
    return p->id < q->id ? -1 : p->id > q->id;
}

static void ends(int32_t *lo, int32_t *hi, bool *up, const tc_boundary *b, size_t id)
{
    int32_t p = b->face[id], q = b->face[id % 3 == 2 ? id - 2 : id + 1];
    *up = p < q;
    *lo = *up ? p : q, *hi = *up ? q : p;
}

/* Pairs the edges: one bucket per smaller vertex. */
static tc_status pair_edges(tc_boundary *b, tc_error *err)
{
    size_t n = 3 * b->n_face;
    size_t *start = tc_calloc(b->n_vertex + 2, sizeof *start);
    edge *e = tc_alloc(n, sizeof *e);
    if (!start || !e) {
        free(start);
        free(e);
        return tc_fail_memory(err, "the boundary's edges", n, sizeof *e);
    }
    int32_t lo, hi;
    bool up;
    for (size_t i = 0; i < n; i++) {
        ends(&lo, &hi, &up, b, i);
        start[lo + 2]++;
    }
    for (size_t v = 0; v < b->n_vertex; v++)
        start[v + 2] += start[v + 1];
    for (size_t i = 0; i < n; i++) {
        ends(&lo, &hi, &up, b, i);
        e[start[lo + 1]++] = (edge){hi, up, (int64_t)i};
    }
    for (size_t v = 0; v < b->n_vertex; v++) {
        edge *f = e + start[v];
        size_t m = start[v + 1] - start[v];
        qsort(f, m, sizeof *f, edge_compare);
        for (size_t i = 0, j; i < m; i = j) {
            for (j = i + 1; j < m && f[j].other == f[i].other; j++) {
            }
            bool good = j - i == 2 && f[i].up != f[i + 1].up;
            for (size_t k = i; k < j; k++)
                b->across[f[k].id] = good ? f[i + i + 1 - k].id : -1;
            b->n_odd_edge += good ? 0 : j - i;
        }
    }
    free(start);
    free(e);
    return TC_OK;
}

static tc_status count_components(tc_boundary *b, tc_error *err)
{
    uint8_t *seen = tc_calloc(b->n_face, 1);
    size_t *stack = tc_alloc(b->n_face, sizeof *stack);
    if (!seen || !stack) {
        free(seen);
        free(stack);
        return tc_fail_memory(err, "the boundary's parts", b->n_face, sizeof *stack);
    }
    for (size_t root = 0; root < b->n_face; root++) {
        if (seen[root])
            continue;
        size_t top = 0;
        b->n_component++;
        seen[root] = 1;
        stack[top++] = root;
        while (top > 0) {
            size_t f = stack[--top];
            for (size_t k = 0; k < 3; k++) {
                int64_t g = b->across[3 * f + k];
                if (g >= 0 && !seen[g / 3])
                    seen[g / 3] = 1, stack[top++] = (size_t)g / 3;
            }
        }
    }
    free(seen);
    free(stack);
    return TC_OK;
}

tc_status tc_boundary_build(tc_boundary *out, const tc_mesh *mesh, size_t n_tet, tc_error *err)
{
    *out = (tc_boundary){0};
    tc_status status = collect(out, mesh, n_tet, err);
    if (status == TC_OK)
        status = pair_edges(out, err);
    if (status == TC_OK)
        status = count_components(out, err);
    if (status != TC_OK)
        tc_boundary_finish(out);
    return status;
}

double tc_boundary_rounding(const double bounds[6])
{
    double d[3], most = 0;
    for (int k = 0; k < 3; k++) {
        d[k] = bounds[2 * k + 1] - bounds[2 * k];
        most = fabs(bounds[2 * k]) > most ? fabs(bounds[2 * k]) : most;
        most = fabs(bounds[2 * k + 1]) > most ? fabs(bounds[2 * k + 1]) : most;
    }
    return 1e-14 * hypot(hypot(d[0], d[1]), d[2]) + 1e-15 * most;
}

/* ------------------------------------------------------------------------------------------------------ convexity */

typedef struct plane {
    double point[3], normal[3]; /* unit, or zero */
    double area;                /* twice */
    double altitude;            /* the least */
} plane;

static const double *corner(const tc_boundary *b, const double *vertex, int64_t id)
{
    return vertex + 3 * (size_t)b->vertex[b->face[id]];
}

static int64_t next(int64_t id)
{
    return id % 3 == 2 ? id - 2 : id + 1;
}

static plane plane_of(const tc_boundary *b, const double *vertex, int64_t face)
{
    plane p;
    double u[3], v[3];
    tc_vec_copy(p.point, corner(b, vertex, 3 * face));
    tc_vec_sub(u, corner(b, vertex, 3 * face + 1), p.point);
    tc_vec_sub(v, corner(b, vertex, 3 * face + 2), p.point);
    double lu = tc_vec_normalize(u), lv = tc_vec_normalize(v); /* no overflow for meshes of any size */
    tc_vec_cross(p.normal, u, v);
    p.area = tc_vec_normalize(p.normal) * lu * lv;
    tc_vec_sub(v, corner(b, vertex, 3 * face + 2), corner(b, vertex, 3 * face + 1));
    double lw = tc_vec_length(v), longest = lu > lv ? lu : lv;
    longest = lw > longest ? lw : longest;
    p.altitude = longest > 0 ? p.area / longest : 0;
    return p;
}

static double height(const plane *p, const double *x)
{
    double d[3];
    tc_vec_sub(d, x, p->point);
    return tc_vec_dot(d, p->normal);
}

/* A face no wider than the tolerance says nothing: its normal is noise. The fans of its neighbours reach across it. */
static bool edge_is_convex(const tc_boundary *b, const double *vertex, int64_t id, double tolerance)
{
    int64_t twin = b->across[id];
    plane p = plane_of(b, vertex, id / 3), q = plane_of(b, vertex, twin / 3);
    if (!(p.altitude > tolerance) && !(q.altitude > tolerance))
        return isfinite(p.altitude) && isfinite(q.altitude);
    /* the wider face tells the height best */
    double h = p.altitude >= q.altitude ? height(&p, corner(b, vertex, next(next(twin))))
                                        : height(&q, corner(b, vertex, next(next(id))));
    if (!(h <= tolerance))
        return false;
    if (h < -tolerance || !(p.altitude > tolerance) || !(q.altitude > tolerance))
        return true;
    return tc_vec_dot(p.normal, q.normal) > 0; /* flat, not folded back on itself */
}

/* Do the faces around corner `id` lie below the plane of its face? */
static bool fan_is_convex(const tc_boundary *b, const double *vertex, int64_t id, const plane *p, double tolerance)
{
    int64_t at = id;
    for (size_t step = 0; step <= b->n_face; step++) {
        at = next(b->across[at]); /* the same vertex in the next face */
        if (at == id)
            return true;
        if (!(height(p, corner(b, vertex, next(at))) <= tolerance))
            return false;
    }
    return false;
}

/* How many times the surface goes around the mean of its corners: the sum of its faces' solid angles there (Van
 * Oosterom and Strackee 1983) over the full one. 1 for a convex surface; 2 for one that is wound twice around itself,
 * which no edge or fan betrays. */
static double turns_around_middle(const tc_boundary *b, const double *vertex)
{
    double middle[3] = {0, 0, 0}, sum = 0;
    for (size_t v = 0; v < b->n_vertex; v++)
        tc_vec_mul_add(middle, middle, 1.0 / (double)b->n_vertex, vertex + 3 * (size_t)b->vertex[v]);
    for (int64_t f = 0; f < (int64_t)b->n_face; f++) {
        double p[3][3], c[3];
        for (int i = 0; i < 3; i++) {
            tc_vec_sub(p[i], corner(b, vertex, 3 * f + i), middle);
            tc_vec_normalize(p[i]);
        }
        tc_vec_cross(c, p[0], p[1]);
        sum += atan2(tc_vec_dot(c, p[2]), 1 + tc_vec_dot(p[0], p[1]) + tc_vec_dot(p[1], p[2]) + tc_vec_dot(p[2], p[0]));
    }
    return sum / 6.283185307179586;
}

bool tc_boundary_is_convex(const tc_boundary *b, const double *vertex, double tolerance)
{
    if (b->n_face == 0 || b->n_odd_edge > 0 || b->n_component != 1)
        return false;
    int64_t n = (int64_t)b->n_face;
    bool some = false;
    for (int64_t id = 0; id < 3 * n; id++)
        if (b->across[id] > id && !edge_is_convex(b, vertex, id, tolerance))
            return false;
    for (int64_t f = 0; f < n; f++) {
        plane p = plane_of(b, vertex, f);
        if (!(p.altitude > tolerance))
            continue;
        some = true;
        for (int64_t id = 3 * f; id < 3 * f + 3; id++)
            if (!fan_is_convex(b, vertex, id, &p, tolerance))
                return false;
    }
    /* a surface thinner than the tolerance in every face is not told */
    return some && fabs(turns_around_middle(b, vertex) - 1) < 0.01;
}
