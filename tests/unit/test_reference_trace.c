/* test_reference_trace.c: chords, scalars and pictures of the reference caster against closed forms and against a
 * clipper of another kind (four half spaces from plane equations), written here. */
#include "test_reference_fixture.h"

static tc_knot grey_knot = {0, 1, 0.5, 0.25, 1};
static struct tc_transfer grey = {.n = 1, .knot = &grey_knot};

static const double OUTSIDE[3] = {3.1, -2.3, 4.7};

/* ------------------------------------------------------------------------------------------------ closed forms */

/* The corner tet x, y, z >= 0, x + y + z <= 1. */
static struct tc_mesh corner_tet(void)
{
    struct tc_mesh m = mesh_alloc(4, 1);
    m.vertex[3] = m.vertex[7] = m.vertex[11] = 1;
    for (int i = 0; i < 4; i++)
        m.tet[i] = i;
    return m;
}

static void chord_through_one_tet_is_wrong(void **state)
{
    (void)state;
    static const int32_t orders[3][4] = {{0, 1, 2, 3}, {1, 0, 2, 3}, {3, 1, 0, 2}}; /* both orientations */
    uint64_t seed = 1;
    for (int order = 0; order < 3; order++) {
        struct tc_mesh m = corner_tet();
        memcpy(m.tet, orders[order], sizeof orders[order]);
        tc_reference *r = reference_of(&m);
        for (int run = 0; run < 500; run++) {
            double p[3], d[3], t0 = -INFINITY, t1 = INFINITY;
            for (int i = 0; i < 3; i++)
                p[i] = uniform(&seed, -0.2, 0.7);
            tc_vec_sub(d, p, OUTSIDE);
            tc_vec_normalize(d);
            /* x, y, z >= 0 and x + y + z <= 1 along OUTSIDE + t d */
            double g0[4] = {OUTSIDE[0], OUTSIDE[1], OUTSIDE[2], 1 - OUTSIDE[0] - OUTSIDE[1] - OUTSIDE[2]};
            double g1[4] = {d[0], d[1], d[2], -d[0] - d[1] - d[2]};
            for (int i = 0; i < 4; i++) {
                if (g1[i] > 0)
                    t0 = fmax(t0, -g0[i] / g1[i]);
                else
                    t1 = fmin(t1, -g0[i] / g1[i]);
            }
            double chord = fmax(t1 - t0, 0);
            tc_reference_ray ray = trace(r, &grey, OUTSIDE, d, 0);
            NEAR(ray.length, chord, 3e-14);
            NEAR(ray.rgba[3], -expm1(-chord), 3e-14);
            NEAR(ray.rgba[1], -0.5 * expm1(-chord), 3e-14);
            assert_int_equal(ray.segments, chord > 1e-13 ? 1 : ray.segments);
        }
        tc_reference_destroy(&r);
        mesh_free(&m);
    }
}

static void constant_extinction_in_a_cube_is_not_one_minus_exp(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(7);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 2;
    for (int run = 0; run < 2000; run++) {
        double p[3], d[3];
        for (int i = 0; i < 3; i++)
            p[i] = uniform(&seed, 0, 1);
        tc_vec_sub(d, p, OUTSIDE);
        tc_vec_normalize(d);
        double chord = box_chord(OUTSIDE, d, 1, 0);
        tc_reference_ray ray = trace(r, &grey, OUTSIDE, d, 0);
        NEAR(ray.length, chord, 1e-14);
        NEAR(ray.rgba[3], -expm1(-chord), 1e-12 * -expm1(-chord) + 1e-15);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void ray_through_vertices_edges_or_faces_loses_or_doubles_a_cell(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(4);
    tc_reference *r = reference_of(&m);
    /* All directions of small integers through all points of a finer grid: along axes, edges and diagonals, in faces.
     */
    for (int a = -2; a <= 2; a++)
        for (int b = -2; b <= 2; b++)
            for (int c = -2; c <= 2; c++)
                for (int g = 0; g < 125 && (a || b || c); g++) {
                    double d[3] = {a, b, c}, p[3] = {g % 5 / 8.0 + 0.125, g / 5 % 5 / 8.0 + 0.25, g / 25 / 8.0 + 0.375},
                           o[3];
                    tc_vec_normalize(d);
                    tc_vec_mul_add(o, p, -3, d);
                    double chord = box_chord(o, d, 1, 0);
                    tc_reference_ray ray = trace(r, &grey, o, d, -INFINITY);
                    NEAR(ray.length, chord, 2e-11); /* rays along an edge are moved by 2^-40 */
                    NEAR(ray.rgba[3], -expm1(-chord), 2e-11);
                }
    /* On the hull's own rim the ray is in or out as a whole, never in part. */
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 9; side++) {
            double o[3] = {side % 3 * 0.5, side / 3 * 0.5, 0}, d[3] = {0, 0, 0}, q[3];
            for (int i = 0; i < 3; i++)
                q[(i + axis) % 3] = o[i];
            q[(axis + 2) % 3] = -2;
            d[(axis + 2) % 3] = 1;
            double length = trace(r, &grey, q, d, 0).length;
            if (side == 4)
                NEAR(length, 1, 1e-14);
            else
                assert_true(length == 0 || fabs(length - 1) < 1e-14);
        }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* Tets with corners on a 3 x 3 x 3 grid and a ray through its middle column: it meets corners, edges and faces, and
 * sees corners coincide. What it finds must be what a ray very near it finds. */
static void points_on_a_small_grid_confuse_the_signs(void **state)
{
    (void)state;
    const double o[3] = {1, 1, -5}, d[3] = {0, 0, 1};
    uint64_t seed = 3;
    for (int block = 0; block < 200; block++) {
        enum { N = 500 };
        struct tc_mesh m = mesh_alloc(4 * N, N);
        for (int i = 0; i < 4 * N; i++) {
            uint64_t bits = random_bits(&seed) >> 8;
            for (int a = 0; a < 3; a++, bits >>= 4)
                m.vertex[3 * i + a] = (double)(bits % 3);
            m.tet[i] = i;
        }
        tc_reference *all = reference_of(&m);
        double sum = 0;
        for (int k = 0; k < N; k++) {
            const double *v[4];
            for (int i = 0; i < 4; i++)
                v[i] = &m.vertex[3 * (4 * k + i)];
            double e[3][3], n[3], least = 4, most = -4;
            for (int i = 0; i < 3; i++)
                tc_vec_sub(e[i], v[i + 1], v[0]);
            tc_vec_cross(n, e[0], e[1]);
            /* A tie is decided by moving the ray by (e, e^2) along u and v of its frame; here by a real (1e-5, 1e-10).
             * For d = z and the axis x, u = axis x d = -y and v = d x u = x. */
            double volume = tc_vec_dot(n, e[2]);
            if (volume == 0)
                continue;
            const double u[3] = {0, -1, 0}, w[3] = {1, 0, 0};
            double q[3];
            for (int a = 0; a < 3; a++)
                q[a] = o[a] + 1e-5 * u[a] + 1e-10 * w[a];
            least = -INFINITY, most = INFINITY;
            for (int f = 0; f < 4; f++) {
                double f1[3], f2[3], to[3], from[3];
                const double *x = v[(f + 1) % 4];
                tc_vec_sub(f1, v[(f + 2) % 4], x), tc_vec_sub(f2, v[(f + 3) % 4], x);
                tc_vec_cross(n, f1, f2);
                tc_vec_sub(to, v[f], x), tc_vec_sub(from, q, x);
                double side = tc_vec_dot(n, to) > 0 ? 1 : -1;
                double g0 = side * tc_vec_dot(n, from), g1 = side * tc_vec_dot(n, d);
                if (g1 > 0)
                    least = fmax(least, -g0 / g1);
                else if (g1 < 0)
                    most = fmin(most, -g0 / g1);
                else if (g0 < 0)
                    most = -INFINITY;
            }
            sum += fmax(most - least, 0);
        }
        NEAR(trace(all, &grey, o, d, 0).length, sum, 1e-2);
        tc_reference_destroy(&all);
        mesh_free(&m);
    }
}

/* --------------------------------------------------------------------------- a clipper of another kind, and scalars */

typedef struct part {
    double t0, t1, s0, s1;
} part;

static int by_entry(const void *a, const void *b)
{
    double x = ((const part *)a)->t0, y = ((const part *)b)->t0;
    return (x > y) - (x < y);
}

/* Every tet of the mesh as four half spaces, no hierarchy; scalar by barycentric coordinates. */
static void clip_all(double rgba[4], double *length, const struct tc_mesh *m, const tc_transfer *tf, const double o[3],
                     const double d[3], double t_min)
{
    part *parts = malloc((m->n_tet + 1) * sizeof *parts);
    assert_non_null(parts);
    size_t n = 0;
    for (size_t k = 0; k < m->n_tet; k++) {
        const double *v[4];
        double g0[4], g1[4], t0 = t_min, t1 = INFINITY;
        for (int i = 0; i < 4; i++)
            v[i] = &m->vertex[3 * m->tet[4 * k + i]];
        for (int f = 0; f < 4; f++) {
            double a[3], b[3], c[3], p[3], normal[3];
            tc_vec_sub(a, v[(f + 2) % 4], v[(f + 1) % 4]);
            tc_vec_sub(b, v[(f + 3) % 4], v[(f + 1) % 4]);
            tc_vec_sub(c, v[f], v[(f + 1) % 4]);
            tc_vec_sub(p, o, v[(f + 1) % 4]);
            tc_vec_cross(normal, a, b);
            double height = tc_vec_dot(normal, c);
            g0[f] = tc_vec_dot(normal, p) / height, g1[f] = tc_vec_dot(normal, d) / height;
            if (g1[f] > 0)
                t0 = fmax(t0, -g0[f] / g1[f]);
            else
                t1 = fmin(t1, -g0[f] / g1[f]);
        }
        if (!(t0 < t1))
            continue;
        part *x = &parts[n++];
        *x = (part){t0, t1, 0, 0};
        for (int f = 0; f < 4; f++) {
            double s = m->association == TC_CELL_DATA ? m->scalar[k] : m->scalar[m->tet[4 * k + f]];
            x->s0 += s * (g0[f] + t0 * g1[f]), x->s1 += s * (g0[f] + t1 * g1[f]);
        }
        if (m->association == TC_CELL_DATA)
            x->s0 = x->s1 = m->scalar[k];
    }
    qsort(parts, n, sizeof *parts, by_entry);
    double clear = 1;
    memset(rgba, 0, 4 * sizeof *rgba);
    *length = 0;
    for (size_t i = 0; i < n; i++) {
        double out[4];
        tc_reference_segment(out, tf, parts[i].s0, parts[i].s1, parts[i].t1 - parts[i].t0);
        for (int c = 0; c < 4; c++)
            rgba[c] += clear * out[c];
        clear *= 1 - out[3];
        *length += parts[i].t1 - parts[i].t0;
    }
    free(parts);
}

static tc_knot wild_knot[6] = {{0, 1, 0, 0, 0},   {0.3, 0, 1, 0, 6},   {0.3, 0, 0, 1, 1},
                               {0.5, 1, 1, 0, 0}, {0.52, 0, 1, 1, 40}, {0.9, 1, 0, 1, 2}};
static struct tc_transfer wild = {.n = 6, .knot = wild_knot};

/* A cube whose inner vertices are jittered, with a random field. */
static struct tc_mesh jittered(int n, uint64_t seed)
{
    struct tc_mesh m = kuhn_cube(n);
    for (size_t i = 0; i < m.n_vertex; i++) {
        for (int a = 0; a < 3; a++) {
            double *x = &m.vertex[3 * i + (size_t)a];
            if (*x > 0 && *x < 1)
                *x += uniform(&seed, -0.15, 0.15) / n;
        }
        m.scalar[i] = uniform(&seed, 0, 1);
    }
    return m;
}

static void half_space_clipper_sees_another_picture(void **state)
{
    (void)state;
    uint64_t seed = 11;
    struct tc_mesh m = jittered(5, 4);
    double *cells = malloc(m.n_tet * sizeof *cells), *points = m.scalar;
    assert_non_null(cells);
    for (size_t i = 0; i < m.n_tet; i++)
        cells[i] = uniform(&seed, 0, 1);
    for (int cell_data = 0; cell_data < 2; cell_data++) {
        m.scalar = cell_data ? cells : points;
        m.association = cell_data ? TC_CELL_DATA : TC_POINT_DATA;
        tc_reference *r = reference_of(&m);
        for (int run = 0; run < 300; run++) {
            double o[3], p[3], d[3], rgba[4], length;
            for (int i = 0; i < 3; i++)
                o[i] = run % 2 ? uniform(&seed, 0.1, 0.9) : OUTSIDE[i], p[i] = uniform(&seed, -0.1, 1.1);
            tc_vec_sub(d, p, o); /* every other eye lies in the mesh */
            tc_vec_normalize(d);
            double t_min = run % 3 ? 0 : -INFINITY;
            clip_all(rgba, &length, &m, &wild, o, d, t_min);
            tc_reference_ray ray = trace(r, &wild, o, d, t_min);
            NEAR(ray.length, length, 1e-12);
            for (int c = 0; c < 4; c++)
                NEAR(ray.rgba[c], rgba[c], 1e-10);
        }
        tc_reference_destroy(&r);
    }
    m.scalar = points;
    free(cells);
    mesh_free(&m);
}

static void linear_field_depends_on_the_mesh(void **state)
{
    (void)state;
    struct tc_mesh coarse = kuhn_cube(1), fine = jittered(6, 8);
    linear_field(&coarse, 0.1, 0.5, 0.2, 0.15);
    linear_field(&fine, 0.1, 0.5, 0.2, 0.15);
    tc_reference *a = reference_of(&coarse), *b = reference_of(&fine);
    uint64_t seed = 6;
    for (int run = 0; run < 500; run++) {
        double p[3];
        for (int i = 0; i < 3; i++)
            p[i] = uniform(&seed, 0, 1);
        tc_reference_ray x = trace_to(a, &wild, OUTSIDE, p), y = trace_to(b, &wild, OUTSIDE, p);
        NEAR(x.length, y.length, 1e-14);
        for (int c = 0; c < 4; c++)
            NEAR(x.rgba[c], y.rgba[c], 2e-11);
    }
    tc_reference_destroy(&a);
    tc_reference_destroy(&b);
    mesh_free(&coarse);
    mesh_free(&fine);
}

static void picture_depends_on_the_order_of_cells_vertices_or_corners(void **state)
{
    (void)state;
    struct tc_mesh m = jittered(5, 12), q = mesh_alloc(m.n_vertex, m.n_tet);
    uint64_t seed = 13;
    int32_t *to = malloc(m.n_vertex * sizeof *to);
    assert_non_null(to);
    for (size_t i = 0; i < m.n_vertex; i++)
        to[i] = (int32_t)i;
    for (size_t i = m.n_vertex - 1; i > 0; i--) {
        size_t j = random_bits(&seed) % (i + 1);
        int32_t t = to[i];
        to[i] = to[j], to[j] = t;
    }
    for (size_t i = 0; i < m.n_vertex; i++) {
        memcpy(&q.vertex[3 * to[i]], &m.vertex[3 * i], 3 * sizeof(double));
        q.scalar[to[i]] = m.scalar[i];
    }
    for (size_t k = 0; k < m.n_tet; k++)
        for (int i = 0; i < 4; i++) /* reversed cells, turned corners */
            q.tet[4 * (m.n_tet - 1 - k) + (size_t)(i + (int)k) % 4] = to[m.tet[4 * k + i]];
    tc_reference *a = reference_of(&m), *b = reference_of(&q);
    for (int run = 0; run < 500; run++) {
        double p[3];
        for (int i = 0; i < 3; i++)
            p[i] = uniform(&seed, -0.1, 1.1);
        tc_reference_ray x = trace_to(a, &wild, OUTSIDE, p), y = trace_to(b, &wild, OUTSIDE, p);
        assert_int_equal(x.segments, y.segments);
        for (int c = 0; c < 4; c++)
            NEAR(x.rgba[c], y.rgba[c], 1e-13);
    }
    free(to);
    tc_reference_destroy(&a);
    tc_reference_destroy(&b);
    mesh_free(&m);
    mesh_free(&q);
}

static void reversed_ray_has_another_transmittance(void **state)
{
    (void)state;
    struct tc_mesh m = jittered(5, 17);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 18;
    for (int run = 0; run < 500; run++) {
        double p[3], d[3], e[3], o[3];
        for (int i = 0; i < 3; i++)
            p[i] = uniform(&seed, 0, 1);
        tc_vec_sub(d, p, OUTSIDE);
        double far = 3 * tc_vec_normalize(d);
        tc_vec_mul_add(o, OUTSIDE, far, d);
        for (int i = 0; i < 3; i++)
            e[i] = -d[i];
        tc_reference_ray x = trace(r, &wild, OUTSIDE, d, 0), y = trace(r, &wild, o, e, 0);
        NEAR(x.rgba[3], y.rgba[3], 1e-12);
        NEAR(x.length, y.length, 1e-13);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* ------------------------------------------------------------------------------------------------- hard meshes */

/* The cube squeezed by 1e-8 along z: every tet a sliver. Chords scale; a linear field along x stays. */
static void slivers_lose_length_or_scalar(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(6);
    for (size_t i = 0; i < m.n_vertex; i++)
        m.vertex[3 * i + 2] *= 1e-8;
    linear_field(&m, 0, 0.9, 0, 0);
    tc_reference *r = reference_of(&m);
    tc_knot k[2] = {{0, 1, 0, 0, 0}, {0.9, 0, 1, 0, 3}};
    struct tc_transfer ramp = {.n = 2, .knot = k};
    uint64_t seed = 20;
    for (int run = 0; run < 400; run++) {
        double p[3] = {uniform(&seed, 0.02, 0.98), uniform(&seed, 0.02, 0.98), 0}, o[3], d[3];
        double slope = run % 2 ? 0 : uniform(&seed, -1, 1);
        d[0] = slope, d[1] = 0.3 * slope, d[2] = 1;
        tc_vec_normalize(d);
        tc_vec_mul_add(o, p, -2, d);
        double chord = 1e-8 / d[2], out[4];
        tc_reference_ray ray = trace(r, &ramp, o, d, 0);
        NEAR(ray.length, chord, 1e-15);
        tc_reference_segment(out, &ramp, 0.9 * p[0], 0.9 * p[0], chord);
        NEAR(ray.rgba[3], out[3], 1e-15);
    }
    /* Along the sheet, just inside it: the chord is 1, and the scalar runs from 0 to 0.9. */
    for (int run = 0; run < 50; run++) {
        double o[3] = {-1, uniform(&seed, 0.02, 0.98), uniform(&seed, 1e-9, 9e-9)}, d[3] = {1, 0, 0}, out[4];
        tc_reference_ray ray = trace(r, &ramp, o, d, 0);
        NEAR(ray.length, 1, 1e-12);
        tc_reference_segment(out, &ramp, 0, 0.9, 1);
        for (int c = 0; c < 4; c++)
            NEAR(ray.rgba[c], out[c], 1e-7);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* The cube's lower half, sixteen layers of flat cells (all four corners in one plane), the upper half. */
static void zero_volume_cells_change_the_picture(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(2), q = mesh_alloc(m.n_vertex, m.n_tet + 200);
    linear_field(&m, 0.1, 0.5, 0.2, 0.15);
    memcpy(q.vertex, m.vertex, 3 * m.n_vertex * sizeof(double));
    memcpy(q.scalar, m.scalar, m.n_vertex * sizeof(double));
    memcpy(q.tet, m.tet, 4 * m.n_tet * sizeof(int32_t));
    uint64_t seed = 23;
    size_t n = m.n_tet;
    while (n < q.n_tet) {
        int32_t *t = &q.tet[4 * n];
        int layer = (int)(random_bits(&seed) % 3), axis = (int)(random_bits(&seed) % 3), step[3] = {1, 3, 9};
        for (int i = 0; i < 4; i++) {
            int a = (int)(random_bits(&seed) % 3), b = (int)(random_bits(&seed) % 3);
            t[i] = layer * step[axis] + a * step[(axis + 1) % 3] + b * step[(axis + 2) % 3];
        }
        bool distinct = true;
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < i; j++)
                distinct = distinct && t[i] != t[j];
        n += distinct;
    }
    tc_reference *a = reference_of(&m), *b = reference_of(&q);
    for (int run = 0; run < 2000; run++) {
        double p[3], o[3];
        for (int i = 0; i < 3; i++) { /* every other ray passes grid points or lies in a plane of flat cells */
            p[i] = run % 2 ? uniform(&seed, 0, 1) : (double)(random_bits(&seed) % 5) / 4;
            o[i] = run % 4 ? OUTSIDE[i] : p[i] + (double)(i == run / 4 % 3) * 2;
        }
        tc_reference_ray x = trace_to(a, &wild, o, p), y = trace_to(b, &wild, o, p);
        NEAR(x.length, y.length, 2e-11);
        for (int c = 0; c < 4; c++)
            NEAR(x.rgba[c], y.rgba[c], 1e-9);
    }
    tc_reference_destroy(&a);
    tc_reference_destroy(&b);
    mesh_free(&m);
    mesh_free(&q);
}

static void size_or_offset_changes_the_picture(void **state)
{
    (void)state;
    static const struct {
        double size, offset, tolerance;
    } cases[] = {{1, 1e7, 3e-8}, {1e-30, 0, 1e-11}, {1e30, 0, 1e-11}, {1e30, -1e31, 1e-11}, {0x1p-90, 0x1p-80, 1e-11}};
    struct tc_mesh m = kuhn_cube(4);
    uint64_t noise = 30;
    for (size_t i = 0; i < m.n_vertex; i++)
        m.scalar[i] = uniform(&noise, 0, 1);
    tc_knot k[2] = {{0, 1, 0, 0, 0}, {1, 0, 1, 0, 3}};
    struct tc_transfer ramp = {.n = 2, .knot = k};
    tc_reference *a = reference_of(&m);
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        struct tc_mesh q = kuhn_cube(4);
        memcpy(q.scalar, m.scalar, m.n_vertex * sizeof(double));
        for (size_t i = 0; i < 3 * q.n_vertex; i++)
            q.vertex[i] = q.vertex[i] * cases[c].size + cases[c].offset;
        tc_reference *b = reference_of(&q);
        uint64_t seed = 31;
        for (int run = 0; run < 200; run++) {
            double p[3], d[3], o[3];
            for (int i = 0; i < 3; i++) {
                p[i] = uniform(&seed, 0, 1);
                o[i] = OUTSIDE[i] * cases[c].size + cases[c].offset;
            }
            tc_vec_sub(d, p, OUTSIDE);
            tc_vec_normalize(d);
            tc_reference_ray x = trace(a, &ramp, OUTSIDE, d, 0), y;
            const double ahead[2] = {0, INFINITY};
            assert_int_equal(tc_reference_trace(&y, b, &ramp, cases[c].size, o, d, ahead, 0), TC_OK);
            NEAR(y.length / cases[c].size, x.length, cases[c].tolerance);
            for (int i = 0; i < 4; i++)
                NEAR(y.rgba[i], x.rgba[i], cases[c].tolerance);
        }
        tc_reference_destroy(&b);
        mesh_free(&q);
    }
    tc_reference_destroy(&a);
    mesh_free(&m);
}

static void distant_eye_sees_another_chord(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(5);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 33;
    for (int run = 0; run < 200; run++) {
        double p[3], o[3], d[3] = {uniform(&seed, -1, 1), uniform(&seed, -1, 1), 1};
        for (int i = 0; i < 3; i++)
            p[i] = uniform(&seed, 0, 1);
        tc_vec_normalize(d);
        tc_vec_mul_add(o, p, -1e6, d);
        NEAR(trace(r, &grey, o, d, 0).length, box_chord(p, d, 1, -INFINITY), 1e-8);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void what_lies_behind_the_eye_is_seen(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 35;
    for (int run = 0; run < 500; run++) { /* eyes inside, on the grid's vertices, edges and faces, and beyond the box */
        double o[3], d[3];
        for (int i = 0; i < 3; i++) {
            o[i] = run % 2 ? (double)(random_bits(&seed) % 7) / 6 : uniform(&seed, -0.3, 1.3);
            d[i] = uniform(&seed, -1, 1);
        }
        tc_vec_normalize(d);
        NEAR(trace(r, &grey, o, d, 0).length, box_chord(o, d, 1, 0), 1e-14);
        NEAR(trace(r, &grey, o, d, 0.25).length, box_chord(o, d, 1, 0.25), 1e-14);
        NEAR(trace(r, &grey, o, d, -INFINITY).length, box_chord(o, d, 1, -INFINITY), 1e-14);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* Two corner tets on top of each other: seen in the order they are entered; twice the length. */
static void overlapping_tets_are_merged(void **state)
{
    (void)state;
    struct tc_mesh m = mesh_alloc(8, 2);
    double cells[2] = {2, 1}, *points = m.scalar;
    for (int k = 0; k < 2; k++) {
        m.vertex[3 * (4 * k + 1)] = m.vertex[3 * (4 * k + 2) + 1] = m.vertex[3 * (4 * k + 3) + 2] = k ? 1 : 2;
        for (int i = 0; i < 4; i++)
            m.tet[4 * k + i] = 4 * k + i;
    }
    m.scalar = cells, m.association = TC_CELL_DATA;
    tc_knot k[2] = {{1, 1, 0, 0, 1}, {2, 0, 1, 0, 2}};
    struct tc_transfer tf = {.n = 2, .knot = k};
    tc_reference *r = reference_of(&m);
    const double o[3] = {0.2, 0.2, 5}, d[3] = {0, 0, -1}; /* in at 1.6 and 0.6, out of both at 0 */
    tc_reference_ray ray = trace(r, &tf, o, d, 0);
    assert_int_equal(ray.segments, 2);
    NEAR(ray.length, 2.2, 1e-14);
    NEAR(ray.rgba[1], 1 - exp(-3.2), 1e-14);
    NEAR(ray.rgba[0], exp(-3.2) * (1 - exp(-0.6)), 1e-14);
    m.scalar = points;
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void unknown_values_colour_the_picture(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(1);
    const double o[3] = {0.3, 0.4, 3}, d[3] = {0, 0, -1};
    tc_reference *r = reference_of(&m);
    double whole = trace(r, &grey, o, d, 0).rgba[3];
    NEAR(whole, 1 - exp(-1), 1e-14);
    m.scalar[0] = NAN; /* a corner of all six tets; read at the time of tracing */
    tc_reference_ray ray = trace(r, &grey, o, d, 0);
    NEAR(ray.rgba[3], 0, 0);
    NEAR(ray.length, 1, 1e-14);
    m.scalar[0] = 0, m.scalar[1] = INFINITY; /* (1, 0, 0): a corner of the tets with x >= y, z or so */
    tc_knot k[2] = {{0, 1, 0, 0, 1}, {1, 1, 0, 0, 1}};
    struct tc_transfer two = {.n = 2, .knot = k};
    ray = trace(r, &two, o, d, 0);
    assert_true(ray.rgba[3] >= 0 && ray.rgba[3] <= whole);
    /* A mesh without a field shows the value 0. */
    double *points = m.scalar;
    m.scalar = NULL;
    NEAR(trace(r, &grey, o, d, 0).rgba[3], whole, 0);
    m.scalar = points;
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void unknown_values_have_another_colour_than_asked(void **state)
{
    (void)state;
    /* Three cells along z, the middle one with unknown values: closed form, points and cells. */
    struct tc_mesh m = kuhn_cube(3);
    const double o[3] = {0.42, 0.45, 3}, d[3] = {0, 0, -1}, violet[4] = {0.5, 0, 1, 6};
    tc_reference *r = reference_of(&m);
    double *points = m.scalar, *cells = calloc(m.n_tet, sizeof *cells);
    assert_non_null(cells);
    for (size_t t = 0; t < m.n_tet; t++) /* 6 a cube, x fastest: the middle layer */
        cells[t] = t / 54 == 1 ? (t % 2 ? NAN : -INFINITY) : 0;
    m.scalar = cells, m.association = TC_CELL_DATA;
    const double third = exp(-1.0 / 3), hidden = exp(-2.0);
    for (int pass = 0; pass < 3; pass++) { /* transparent, violet, transparent again */
        tc_reference_set_nan_color(r, pass == 1 ? violet : NULL);
        tc_reference_ray ray = trace(r, &grey, o, d, 0);
        double clear = pass == 1 ? third * hidden * third : third * third;
        NEAR(ray.rgba[3], 1 - clear, 1e-14);
        NEAR(ray.length, 1, 1e-14);
        double last =
            trace(r, &grey, o, d, 3 - 1.0 / 3).rgba[2]; /* from z = 1/3 down: the last layer; so is the first */
        double blue = pass == 1 ? last + third * (1 - hidden) + third * hidden * last : last + third * last;
        NEAR(ray.rgba[2], blue, 1e-13);
    }
    m.scalar = points, m.association = TC_POINT_DATA;
    m.scalar[0] = NAN; /* a corner of all tets of one cube only */
    tc_reference_set_nan_color(r, violet);
    const double through[3] = {0.1, 0.12, 3};
    NEAR(trace(r, &grey, through, d, 0).rgba[3], 1 - third * third * hidden, 1e-13);
    tc_reference_destroy(&r);
    free(cells);
    mesh_free(&m);
}

static void clipping_keeps_or_takes_too_much(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    linear_field(&m, 0.1, 0.3, 0.2, 0.4);
    tc_reference *r = reference_of(&m);
    tc_knot k[3] = {{0, 1, 0, 0, 1}, {0.4, 0, 1, 0, 3}, {1, 0, 0, 1, 0.5}};
    struct tc_transfer tf = {.n = 3, .knot = k};
    uint64_t seed = 77;
    for (int run = 0; run < 300; run++) {
        double p[3], d[3], t = uniform(&seed, 1, 3), far = t + uniform(&seed, 1e-9, 1.5);
        for (int i = 0; i < 3; i++)
            p[i] = uniform(&seed, 0, 1);
        tc_vec_sub(d, p, OUTSIDE);
        tc_vec_normalize(d);
        /* What is left between near and far, and what lies before and behind, make the whole. */
        const double range[3][2] = {{-INFINITY, t}, {t, far}, {far, INFINITY}};
        tc_reference_ray piece[3], whole = trace(r, &tf, OUTSIDE, d, 0);
        double clear = 1, rgba[4] = {0, 0, 0, 0}, length = 0;
        for (int i = 0; i < 3; i++) {
            assert_int_equal(tc_reference_trace(&piece[i], r, &tf, 1, OUTSIDE, d, range[i], 0), TC_OK);
            for (int c = 0; c < 4; c++)
                rgba[c] += clear * piece[i].rgba[c];
            clear *= 1 - piece[i].rgba[3];
            length += piece[i].length;
        }
        NEAR(length, whole.length, 1e-13);
        for (int c = 0; c < 4; c++)
            NEAR(rgba[c], whole.rgba[c], 1e-12);
        double behind = box_chord(OUTSIDE, d, 1, t), beyond = box_chord(OUTSIDE, d, 1, far);
        NEAR(piece[1].length, behind - beyond, 1e-13);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void broken_tets_break_the_others(void **state)
{
    (void)state;
    struct tc_mesh good = kuhn_cube(2), m = mesh_alloc(good.n_vertex + 2, good.n_tet + 4);
    memcpy(m.vertex, good.vertex, 3 * good.n_vertex * sizeof(double));
    memcpy(m.tet, good.tet, 4 * good.n_tet * sizeof(int32_t));
    m.vertex[3 * good.n_vertex] = NAN;
    m.vertex[3 * good.n_vertex + 4] = INFINITY;
    const int32_t nan = (int32_t)good.n_vertex;
    const int32_t bad[16] = {0, 1, 2, nan, nan + 1, 3, 4, 5, 1, 1, 2, 3, 0, -1, 5000, 2};
    memcpy(&m.tet[4 * good.n_tet], bad, sizeof bad);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 41;
    for (int run = 0; run < 100; run++) {
        double p[3], d[3];
        for (int i = 0; i < 3; i++)
            p[i] = uniform(&seed, 0, 1);
        tc_vec_sub(d, p, OUTSIDE);
        tc_vec_normalize(d);
        NEAR(trace(r, &grey, OUTSIDE, d, 0).length, box_chord(OUTSIDE, d, 1, 0), 1e-14);
    }
    tc_reference_destroy(&r);
    /* Nothing at all, and all points in one place. */
    m.n_tet = 0;
    r = reference_of(&m);
    assert_int_equal(trace_to(r, &grey, OUTSIDE, OUTSIDE + 0).segments, 0);
    tc_reference_destroy(&r);
    m.n_tet = good.n_tet;
    for (size_t i = 0; i < 3 * m.n_vertex; i++)
        m.vertex[i] = 0.5;
    r = reference_of(&m);
    const double d[3] = {0, 0, 1}, o[3] = {0.5, 0.5, -1};
    NEAR(trace(r, &grey, o, d, 0).length, 0, 0);
    tc_reference_destroy(&r);
    mesh_free(&m);
    mesh_free(&good);
}

/* Cells from 1e-6 to 1: a chain of cubes, each half the size of the one before. */
static void small_cells_are_missed(void **state)
{
    (void)state;
    enum { LEVELS = 21 };
    struct tc_mesh cube = kuhn_cube(1), m = mesh_alloc(8 * LEVELS, 6 * LEVELS);
    double at = 0, size = 1;
    for (int k = 0; k < LEVELS; k++, at += size, size *= 0.5) {
        for (int i = 0; i < 24; i++)
            m.vertex[24 * k + i] = cube.vertex[i] * size + (i % 3 ? 0 : at);
        for (int i = 0; i < 24; i++)
            m.tet[24 * k + i] = cube.tet[i] + 8 * k;
    }
    tc_reference *r = reference_of(&m);
    const double along[3] = {1, 0, 0}, start[3] = {-1, size / 3, size / 5}, down[3] = {0, 0, -1};
    NEAR(trace(r, &grey, start, along, 0).length, at, 1e-13);
    for (int k = 0; k < LEVELS; k++) {
        size = ldexp(1, -k);
        const double o[3] = {2 - 1.3 * size, size * 0.4, 1};
        NEAR(trace(r, &grey, o, down, 0).length, size, 1e-15);
    }
    tc_reference_destroy(&r);
    mesh_free(&cube);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(chord_through_one_tet_is_wrong),
        cmocka_unit_test(constant_extinction_in_a_cube_is_not_one_minus_exp),
        cmocka_unit_test(ray_through_vertices_edges_or_faces_loses_or_doubles_a_cell),
        cmocka_unit_test(points_on_a_small_grid_confuse_the_signs),
        cmocka_unit_test(half_space_clipper_sees_another_picture),
        cmocka_unit_test(linear_field_depends_on_the_mesh),
        cmocka_unit_test(picture_depends_on_the_order_of_cells_vertices_or_corners),
        cmocka_unit_test(reversed_ray_has_another_transmittance),
        cmocka_unit_test(slivers_lose_length_or_scalar),
        cmocka_unit_test(zero_volume_cells_change_the_picture),
        cmocka_unit_test(size_or_offset_changes_the_picture),
        cmocka_unit_test(distant_eye_sees_another_chord),
        cmocka_unit_test(what_lies_behind_the_eye_is_seen),
        cmocka_unit_test(overlapping_tets_are_merged),
        cmocka_unit_test(unknown_values_colour_the_picture),
        cmocka_unit_test(unknown_values_have_another_colour_than_asked),
        cmocka_unit_test(clipping_keeps_or_takes_too_much),
        cmocka_unit_test(broken_tets_break_the_others),
        cmocka_unit_test(small_cells_are_missed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
