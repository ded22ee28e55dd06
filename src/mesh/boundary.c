/* boundary.c: the faces of a linked mesh that have no neighbour, as a surface. */
#include "mesh/boundary.h"

#include "core/memory.h"
#include "core/vec.h"
#include "mesh/adjacency.h"
#include "mesh/predicate.h"

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

/* The least of the widths of the tet (a, b, c, d) in the directions in which one of its faces, or two opposite edges,
 * lie level: to make the four points coplanar takes moving them by no less than a quarter of it, however narrow the
 * faces. Positive when d lies above (a, b, c). */
static double thickness(const double *a, const double *b, const double *c, const double *d)
{
    const double *x[4] = {a, b, c, d};
    double e[4][4][3], longest = 0, most = 0, n[3];
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++) {
            tc_vec_sub(e[i][j], x[j], x[i]);
            for (int k = 0; k < 3; k++)
                longest = fabs(e[i][j][k]) > longest ? fabs(e[i][j][k]) : longest;
        }
    if (longest == 0)
        return 0;
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            for (int k = 0; k < 3; k++)
                e[i][j][k] /= longest; /* no overflow for meshes of any size */
    static const uint8_t level[7][4] = {{0, 1, 0, 2}, {0, 1, 0, 3}, {0, 2, 0, 3}, {1, 2, 1, 3},
                                        {0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}};
    for (int i = 0; i < 7; i++) {
        tc_vec_cross(n, e[level[i][0]][level[i][1]], e[level[i][2]][level[i][3]]);
        double area = tc_vec_length(n);
        most = area > most ? area : most;
    }
    tc_vec_cross(n, e[0][1], e[0][2]);
    return most > 0 ? longest * (tc_vec_dot(n, e[0][3]) / most) : 0;
}

static bool edge_is_convex(const tc_boundary *b, const double *vertex, int64_t id, double tolerance)
{
    const double *p = corner(b, vertex, id), *q = corner(b, vertex, next(id)), *r = corner(b, vertex, next(next(id)));
    const double *beyond = corner(b, vertex, next(next(b->across[id])));
    return thickness(p, q, r, beyond) <= tolerance || tc_orient3d(p, q, r, beyond) <= 0;
}

/* Does x lie below the plane of a face wider than the tolerance, as far as the face can tell? Moving its corners tilts
 * it the more the narrower it is and the farther x is. */
static bool is_below(const double *x, const plane *p, double tolerance)
{
    double away[3];
    tc_vec_sub(away, x, p->point);
    return height(p, x) <= 4 * tolerance * (1 + tc_vec_length(away) / p->altitude);
}

/* A face no wider than the tolerance hides the angle between those around it. Do the wide faces that one comes to from
 * edge `id` of wide face p, through narrow ones alone, lie below p? Where there are more of them than a strip or a
 * point of contact has, that is not known, and the answer no. */
static bool is_convex_across_narrow(const tc_boundary *b, const double *vertex, int64_t id, const plane *p,
                                    double tolerance)
{
    int64_t queue[64];
    size_t n = 0;
    queue[n++] = b->across[id] / 3;
    for (size_t i = 0; i < n; i++) {
        int64_t f = queue[i];
        bool wide = plane_of(b, vertex, f).altitude > tolerance;
        for (int64_t k = 3 * f; k < 3 * f + 3; k++) {
            if (wide && !is_below(corner(b, vertex, k), p, tolerance))
                return false;
            int64_t g = b->across[k] / 3;
            bool seen = wide || g == id / 3;
            for (size_t j = 0; j < n && !seen; j++)
                seen = queue[j] == g;
            if (!seen && n == sizeof queue / sizeof queue[0])
                return false;
            if (!seen)
                queue[n++] = g;
        }
    }
    return true;
}

/* Dents too small to be told at one edge add up around a vertex of many faces: each face is compared with the ring's
 * vertices 2, 4, 8 … steps ahead. ring [n]: the corners at the vertex, in order. */
static bool ring_is_convex(const int64_t *ring, size_t n, const tc_boundary *b, const double *vertex, double tolerance)
{
    for (size_t i = 0; i < n; i++) {
        plane p = plane_of(b, vertex, ring[i] / 3);
        for (size_t step = 2; step < n && p.altitude > tolerance; step *= 2)
            if (!is_below(corner(b, vertex, next(ring[(i + step) % n])), &p, tolerance))
                return false;
    }
    return true;
}

/* Out of memory it says no. */
static bool rings_are_convex(const tc_boundary *b, const double *vertex, double tolerance)
{
    size_t n = 3 * b->n_face, m;
    int64_t *ring = tc_alloc(n, sizeof *ring);
    uint8_t *seen = tc_calloc(n, sizeof *seen);
    bool convex = ring && seen;
    for (size_t first = 0; first < n && convex; first++) {
        m = 0;
        for (int64_t id = (int64_t)first; !seen[id]; id = next(b->across[id])) { /* the same vertex in the next face */
            seen[id] = 1;
            ring[m++] = id;
        }
        convex = ring_is_convex(ring, m, b, vertex, tolerance);
    }
    free(ring);
    free(seen);
    return convex;
}

static void middle_of(double out[3], const tc_boundary *b, const double *vertex)
{
    out[0] = out[1] = out[2] = 0;
    for (size_t v = 0; v < b->n_vertex; v++)
        tc_vec_mul_add(out, out, 1.0 / (double)b->n_vertex, vertex + 3 * (size_t)b->vertex[v]);
}

/* How many times the surface goes around a point: the sum of its faces' solid angles there (Van Oosterom and Strackee
 * 1983) over the full one. */
static double turns_around(const tc_boundary *b, const double *vertex, const double middle[3])
{
    double sum = 0;
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

/* Seen from the mean of its corners every face shows its inner side, and all faces together cover the view once: then
 * no two of them lie behind each other, and none is folded back. Where in addition no edge is reflex, the surface is
 * convex at every point. One that is wound twice around itself covers the view twice, or shows outer sides. */
bool tc_boundary_is_convex(const tc_boundary *b, const double *vertex, double tolerance)
{
    if (b->n_face == 0 || b->n_odd_edge > 0 || b->n_component != 1)
        return false;
    int64_t n = (int64_t)b->n_face;
    for (int64_t id = 0; id < 3 * n; id++)
        if (b->across[id] > id && !edge_is_convex(b, vertex, id, tolerance))
            return false;
    double middle[3];
    bool some = false;
    middle_of(middle, b, vertex);
    for (int64_t f = 0; f < n; f++) {
        plane p = plane_of(b, vertex, f);
        if (!(p.altitude > tolerance))
            continue;
        some = true;
        const double *x = corner(b, vertex, 3 * f), *y = corner(b, vertex, 3 * f + 1),
                     *z = corner(b, vertex, 3 * f + 2);
        if (tc_orient3d(x, y, z, middle) >= 0)
            return false;
        for (int64_t id = 3 * f; id < 3 * f + 3; id++)
            if (!(plane_of(b, vertex, b->across[id] / 3).altitude > tolerance) &&
                !is_convex_across_narrow(b, vertex, id, &p, tolerance))
                return false;
    }
    /* a surface thinner than the tolerance in every face is not told */
    return some && fabs(turns_around(b, vertex, middle) - 1) < 0.01 && rings_are_convex(b, vertex, tolerance);
}
