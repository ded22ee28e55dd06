/* gradient.c: the scalar's gradient in cells and at vertices, as tc_shade defines it.
 *
 * Neighbours are found from the vertex ids of faces: two real cells are neighbours that alone have a face and lie on
 * different sides of it. */
#include "core/memory.h"
#include "core/vec.h"
#include "mesh/predicate.h"
#include "reference/look.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Directions in which centroids spread by less than this part of the most (its square) are open. */
static const double OPEN = 1e-12;

static const double *corner_of(const tc_reference *r, size_t tet, int k)
{
    return &r->vertex[3 * (size_t)r->mesh->tet[4 * tet + (size_t)k]];
}

/* Six volumes of a tet, without sign; exactly 0 where its corners lie in a plane. */
static double six_volumes(double e[3][3], const tc_reference *r, size_t tet)
{
    const double *x[4];
    double n[3];
    for (int k = 0; k < 4; k++)
        x[k] = &r->mesh->vertex[3 * (size_t)r->mesh->tet[4 * tet + (size_t)k]];
    for (int k = 0; k < 3; k++)
        tc_vec_sub(e[k], corner_of(r, tet, k + 1), corner_of(r, tet, 0));
    if (tc_orient3d(x[0], x[1], x[2], x[3]) == 0)
        return 0;
    tc_vec_cross(n, e[0], e[1]);
    return fabs(tc_vec_dot(n, e[2]));
}

static void keep_finite(double g[3])
{
    if (!isfinite(g[0]) || !isfinite(g[1]) || !isfinite(g[2]))
        g[0] = g[1] = g[2] = 0;
}

/* Of the linear interpolation: the plane through the four values. In long double, from the mesh's own coordinates: the
 * volume of a thin tet is a small difference. */
static void gradient_of_points(double g[3], const tc_reference *r, size_t tet)
{
    const int32_t *id = &r->mesh->tet[4 * tet];
    const double *value = r->mesh->scalar, *x = r->mesh->vertex;
    double rough[3][3];
    long double e[3][3], sum[3] = {0, 0, 0}, volume = 0;
    g[0] = g[1] = g[2] = 0;
    if (six_volumes(rough, r, tet) == 0)
        return;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            e[k][i] = ((long double)x[3 * (size_t)id[k + 1] + (size_t)i] - x[3 * (size_t)id[0] + (size_t)i]) * r->scale;
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            const long double *p = e[(k + 1) % 3], *q = e[(k + 2) % 3];
            long double n = p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3];
            sum[i] += ((long double)value[id[k + 1]] - value[id[0]]) * n;
            volume += k == 2 ? n * e[2][i] : 0;
        }
    for (int i = 0; i < 3; i++)
        g[i] = (double)(sum[i] / volume);
    keep_finite(g); /* values that are not finite, too */
}

/* ------------------------------------------------------------------------------------------------- cell data */

typedef struct face {
    int32_t id[3]; /* ascending */
    int32_t apex;
    uint32_t tet;
} face;

static int face_compare(const void *a, const void *b)
{
    const face *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->id[i] != q->id[i])
            return p->id[i] < q->id[i] ? -1 : 1;
    return p->tet < q->tet ? -1 : p->tet > q->tet;
}

static int side_of(const tc_mesh *mesh, const face *f)
{
    const double *x = mesh->vertex;
    return tc_orient3d(x + 3 * (size_t)f->id[0], x + 3 * (size_t)f->id[1], x + 3 * (size_t)f->id[2],
                       x + 3 * (size_t)f->apex);
}

/* near [mesh->n_tet][4]: neighbours, as many as there are, then UINT32_MAX. */
static bool find_neighbours(uint32_t *near, const tc_reference *r)
{
    size_t n = r->bvh.n_item;
    face *f = tc_alloc(4 * n, sizeof *f);
    if (!f)
        return false;
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 4; k++) {
            face *at = &f[4 * i + (size_t)k];
            at->apex = r->tet[i][k];
            at->tet = r->bvh.order[i];
            for (int j = 0, m = 0; j < 4; j++)
                if (j != k)
                    at->id[m++] = r->tet[i][j];
        }
    qsort(f, 4 * n, sizeof *f, face_compare);
    memset(near, 0xff, 4 * r->mesh->n_tet * sizeof *near);
    for (size_t i = 0, j; i < 4 * n; i = j) {
        for (j = i + 1; j < 4 * n && memcmp(f[i].id, f[j].id, sizeof f->id) == 0; j++) {
        }
        if (j - i != 2 || side_of(r->mesh, &f[i]) * side_of(r->mesh, &f[i + 1]) > 0)
            continue;
        for (int k = 0; k < 2; k++) {
            uint32_t *to = &near[4 * (size_t)f[i + (size_t)k].tet];
            while (*to != UINT32_MAX)
                to++;
            *to = f[i + 1 - (size_t)k].tet;
        }
    }
    free(f);
    return true;
}

/* Eigenvalues (a's diagonal) and unit eigenvectors (columns of v) of a symmetric matrix, by Jacobi's rotations. */
static void diagonalize(double a[3][3], double v[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            v[i][j] = i == j;
    for (int sweep = 0; sweep < 30; sweep++)
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++) {
                if (a[p][q] == 0)
                    continue;
                double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
                double t = copysign(1, theta) / (fabs(theta) + hypot(theta, 1));
                double c = 1 / hypot(t, 1), s = t * c;
                for (int k = 0; k < 3; k++) {
                    double x = a[k][p], y = a[k][q];
                    a[k][p] = c * x - s * y, a[k][q] = s * x + c * y;
                }
                for (int k = 0; k < 3; k++) {
                    double x = a[p][k], y = a[q][k];
                    a[p][k] = c * x - s * y, a[q][k] = s * x + c * y;
                    x = v[k][p], y = v[k][q];
                    v[k][p] = c * x - s * y, v[k][q] = s * x + c * y;
                }
                a[p][q] = a[q][p] = 0;
            }
}

/* The gradient of the plane that fits n values at places x best, all alike; the least one. */
static void fit_plane(double g[3], double x[5][3], const double *value, int n)
{
    double middle[3] = {0, 0, 0}, a[3][3] = {{0}}, b[3] = {0, 0, 0}, v[3][3];
    for (int k = 0; k < n; k++)
        tc_vec_mul_add(middle, middle, 1.0 / n, x[k]);
    for (int k = 0; k < n; k++) {
        double d[3];
        tc_vec_sub(d, x[k], middle);
        for (int i = 0; i < 3; i++) {
            for (int j = 0; j < 3; j++)
                a[i][j] += d[i] * d[j];
            b[i] += d[i] * (value[k] - value[0]); /* any value: the d add up to 0; of equal ones b is 0 exactly */
        }
    }
    diagonalize(a, v);
    double most = fmax(a[0][0], fmax(a[1][1], a[2][2]));
    g[0] = g[1] = g[2] = 0;
    for (int j = 0; j < 3; j++) {
        if (!(a[j][j] > OPEN * most))
            continue;
        const double axis[3] = {v[0][j], v[1][j], v[2][j]};
        tc_vec_mul_add(g, g, tc_vec_dot(axis, b) / a[j][j], axis);
    }
    keep_finite(g);
}

static void gradient_among_cells(double g[3], const tc_reference *r, size_t tet, const uint32_t *near)
{
    const double *value = r->mesh->scalar;
    double x[5][3], s[5];
    int n = 0;
    g[0] = g[1] = g[2] = 0;
    if (!isfinite(value[tet]))
        return;
    for (int k = -1; k < 4; k++) {
        size_t at = k < 0 ? tet : near[k];
        if (k >= 0 && near[k] == UINT32_MAX)
            break;
        if (!isfinite(value[at]))
            continue;
        x[n][0] = x[n][1] = x[n][2] = 0;
        for (int j = 0; j < 4; j++)
            tc_vec_mul_add(x[n], x[n], 0.25, corner_of(r, at, j));
        s[n++] = value[at];
    }
    fit_plane(g, x, s, n);
}

tc_status tc_gradient_of_cells(double *out, const tc_reference *reference)
{
    const tc_mesh *mesh = reference->mesh;
    memset(out, 0, 3 * mesh->n_tet * sizeof *out);
    if (!mesh->scalar)
        return TC_OK;
    if (mesh->association != TC_CELL_DATA) {
        for (size_t i = 0; i < reference->bvh.n_item; i++)
            gradient_of_points(&out[3 * (size_t)reference->bvh.order[i]], reference, reference->bvh.order[i]);
        return TC_OK;
    }
    uint32_t *near = tc_alloc(mesh->n_tet, 4 * sizeof *near);
    bool good = near && find_neighbours(near, reference);
    for (size_t i = 0; good && i < reference->bvh.n_item; i++) {
        size_t tet = reference->bvh.order[i];
        gradient_among_cells(&out[3 * tet], reference, tet, &near[4 * tet]);
    }
    free(near);
    return good ? TC_OK : TC_E_MEMORY;
}

/* ---------------------------------------------------------------------------------------------------- vertices */

static bool all_finite(const tc_mesh *mesh, size_t tet)
{
    if (mesh->association == TC_CELL_DATA)
        return isfinite(mesh->scalar[tet]);
    for (int k = 0; k < 4; k++)
        if (!isfinite(mesh->scalar[mesh->tet[4 * tet + (size_t)k]]))
            return false;
    return true;
}

/* What is summed up at a vertex. */
typedef struct mean {
    double by_volume[3], volume, plain[3];
    size_t n;
} mean;

tc_status tc_gradient_of_vertices(double *out, const double *cell, const tc_reference *reference)
{
    const tc_mesh *mesh = reference->mesh;
    mean *m = tc_calloc(mesh->n_vertex, sizeof *m);
    if (!m)
        return TC_E_MEMORY;
    for (size_t i = 0; mesh->scalar && i < reference->bvh.n_item; i++) {
        size_t tet = reference->bvh.order[i];
        double e[3][3];
        if (!all_finite(mesh, tet))
            continue;
        double volume = six_volumes(e, reference, tet);
        for (int k = 0; k < 4; k++) {
            mean *at = &m[mesh->tet[4 * tet + (size_t)k]];
            tc_vec_mul_add(at->by_volume, at->by_volume, volume, &cell[3 * tet]);
            tc_vec_add(at->plain, at->plain, &cell[3 * tet]);
            at->volume += volume;
            at->n++;
        }
    }
    for (size_t v = 0; v < mesh->n_vertex; v++)
        for (int i = 0; i < 3; i++)
            out[3 * v + (size_t)i] = m[v].volume > 0 ? m[v].by_volume[i] / m[v].volume
                                     : m[v].n > 0    ? m[v].plain[i] / (double)m[v].n
                                                     : 0;
    free(m);
    return TC_OK;
}
