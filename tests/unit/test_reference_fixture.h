/* test_reference_fixture.h: small meshes, functions and rays for the reference caster's tests. */
#ifndef TC_TEST_REFERENCE_FIXTURE_H
#define TC_TEST_REFERENCE_FIXTURE_H

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/vec.h"
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NEAR(a, b, tolerance) near_(a, b, tolerance, #a, __LINE__)

static inline void near_(double a, double b, double tolerance, const char *what, int line)
{
    if (!(fabs(a - b) <= tolerance)) /* NaN fails, too */
        fail_msg("line %d: %s = %.17g, expected %.17g within %g", line, what, a, b, tolerance);
}

static inline uint64_t random_bits(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    uint64_t x = *state ^ *state >> 33;
    x *= 0xff51afd7ed558ccdu;
    return x ^ x >> 33;
}

static inline double uniform(uint64_t *state, double lo, double hi)
{
    return lo + (hi - lo) * ((double)(random_bits(state) >> 11) * 0x1p-53);
}

static inline struct tc_mesh mesh_alloc(size_t n_vertex, size_t n_tet)
{
    struct tc_mesh m = {.n_vertex = n_vertex, .n_tet = n_tet, .association = TC_POINT_DATA};
    m.vertex = calloc(n_vertex + 1, 3 * sizeof(double));
    m.scalar = calloc(n_vertex + 1, sizeof(double));
    m.tet = calloc(n_tet + 1, 4 * sizeof(int32_t));
    assert_true(m.vertex && m.scalar && m.tet);
    return m;
}

static inline void mesh_free(struct tc_mesh *m)
{
    free(m->vertex);
    free(m->scalar);
    free(m->tet);
    memset(m, 0, sizeof *m);
}

/* The unit cube as n^3 little cubes of six tets each (Kuhn 1960). */
static inline struct tc_mesh kuhn_cube(int n)
{
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    int s = n + 1;
    struct tc_mesh m = mesh_alloc((size_t)(s * s * s), (size_t)(6 * n * n * n));
    for (int k = 0; k < s; k++)
        for (int j = 0; j < s; j++)
            for (int i = 0; i < s; i++) {
                double *x = &m.vertex[3 * ((k * s + j) * s + i)];
                x[0] = (double)i / n, x[1] = (double)j / n, x[2] = (double)k / n;
            }
    int32_t *t = m.tet;
    const int step[3] = {1, s, s * s};
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++)
                for (int q = 0; q < 6; q++, t += 4) {
                    t[0] = (k * s + j) * s + i;
                    for (int a = 0; a < 3; a++)
                        t[a + 1] = t[a] + step[order[q][a]];
                }
    return m;
}

/* scalar = a + b . x */
static inline void linear_field(struct tc_mesh *m, double a, double bx, double by, double bz)
{
    for (size_t i = 0; i < m->n_vertex; i++)
        m->scalar[i] = a + bx * m->vertex[3 * i] + by * m->vertex[3 * i + 1] + bz * m->vertex[3 * i + 2];
}

/* Where the line o + t d is inside the box [0, size]^3: slabs. */
static inline double box_chord(const double o[3], const double d[3], double size, double t_min)
{
    double t0 = t_min, t1 = INFINITY;
    for (int i = 0; i < 3; i++) {
        if (d[i] == 0) {
            if (o[i] < 0 || o[i] > size)
                return 0;
            continue;
        }
        double a = -o[i] / d[i], b = (size - o[i]) / d[i];
        t0 = fmax(t0, fmin(a, b)), t1 = fmin(t1, fmax(a, b));
    }
    return t1 > t0 ? t1 - t0 : 0;
}

static inline tc_reference *reference_of(const struct tc_mesh *m)
{
    tc_reference *r;
    tc_error err;
    if (tc_reference_create(&r, m, 1, &err) != TC_OK)
        fail_msg("%s", err.text);
    return r;
}

static inline tc_reference_ray trace(const tc_reference *r, const tc_transfer *tf, const double o[3], const double d[3],
                                     double t_min)
{
    tc_reference_ray ray;
    const double range[2] = {t_min, INFINITY};
    assert_int_equal(tc_reference_trace(&ray, r, tf, 1.0, o, d, range, 0), TC_OK);
    return ray;
}

/* A ray from o towards p. */
static inline tc_reference_ray trace_to(const tc_reference *r, const tc_transfer *tf, const double o[3],
                                        const double p[3])
{
    double d[3];
    tc_vec_sub(d, p, o);
    tc_vec_normalize(d);
    return trace(r, tf, o, d, 0);
}

#endif
