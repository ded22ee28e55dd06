/* test_probe_ray.c: what a ray meets, against closed forms and, over every synthetic mesh, against the reference
 * caster. */
#include "test_reference_fixture.h"

#include "datasets_synthetic/synth.h"
#include "probe/line.h"

#include <stdio.h>

static const double UP[3] = {0.1, 1, 0.2};

static tc_mesh *prepared(const char *name, size_t cells, tc_reentry reentry)
{
    tc_error err = {0};
    tc_mesh *m = NULL;
    if (tc_synth_create(&m, name, cells, 3, &err) != TC_OK)
        return NULL; /* the ones that are no mesh */
    if (tc_mesh_prepare(m, &(tc_prepare_options){.reentry = reentry}, NULL, &err) != TC_OK)
        tc_mesh_destroy(&m);
    return m;
}

static tc_mesh *from_fixture(struct tc_mesh *f)
{
    tc_mesh *m;
    const tc_mesh_arrays arrays = {f->n_vertex, f->vertex, f->n_tet, f->tet, f->scalar, f->association, "x"};
    assert_int_equal(tc_mesh_create(&m, &arrays, NULL), TC_OK);
    assert_int_equal(tc_mesh_prepare(m, &(tc_prepare_options){.reentry = TC_REENTRY_PEEL}, NULL, NULL), TC_OK);
    mesh_free(f);
    return m;
}

static tc_transfer *function(const tc_knot *knot, size_t n)
{
    tc_transfer *tf;
    tc_error err;
    if (tc_transfer_from_knots(&tf, knot, n, &err) != TC_OK)
        fail_msg("%s", err.text);
    return tf;
}

/* Rises, has a step, falls to nothing. */
static tc_transfer *crooked(const tc_mesh *m)
{
    const double lo = m->report.scalar_range[0], w = m->report.scalar_range[1] - lo;
    const tc_knot knot[7] = {{lo, 0, 0, 0, 0},
                             {lo + 0.2 * w, 1, 0, 0, 0.4},
                             {lo + 0.21 * w, 1, 0, 0, 0.1},
                             {lo + 0.5 * w, 0, 1, 0, 0.1},
                             {lo + 0.5 * w, 0, 1, 1, 0.7},
                             {lo + 0.9 * w, 1, 1, 1, 0},
                             {lo + 1.1 * w, 1, 1, 1, 0.3}};
    return function(knot, 7);
}

static tc_probe *probe(const tc_mesh *m, const tc_transfer *tf, double unit, const tc_camera *camera, int w, int h,
                       int x, int y)
{
    tc_probe *p;
    tc_error err;
    if (tc_mesh_probe(&p, m, tf, unit, camera, w, h, x, y, &err) != TC_OK)
        fail_msg("%s", err.text);
    return p;
}

static double length_of(const tc_probe *p)
{
    double sum = 0;
    for (size_t i = 0; i < p->n; i++)
        sum += p->part[i].depth[1] - p->part[i].depth[0];
    return sum;
}

/* ---------------------------------------------------------------------------------------------------- reference */

enum { WIDE = 37, HIGH = 23, VIEWS = 7 };

/* Perspective, parallel, from within, clipped; along an axis, where rays run through edges and vertices. */
static tc_camera view(const tc_mesh *m, int k)
{
    static const double from[VIEWS][3] = {{1, 0.7, 0.4}, {0, 0, 1},   {-0.3, 0.2, 0.9}, {1, 0, 0},
                                          {0.2, 1, 0.1}, {-1, 2, -1}, {1, 1, 1}};
    const double *b = m->report.bounds;
    tc_camera c = {.parallel = k == 1 || k == 3 || k == 5};
    tc_camera_reset(&c, b, from[k], UP, 30, (double)WIDE / HIGH);
    double diagonal = 0, distance = 0;
    for (int i = 0; i < 3; i++) {
        diagonal += (b[2 * i + 1] - b[2 * i]) * (b[2 * i + 1] - b[2 * i]);
        distance += (c.focal_point[i] - c.position[i]) * (c.focal_point[i] - c.position[i]);
    }
    diagonal = sqrt(diagonal), distance = sqrt(distance);
    if (k >= 4 && k != 6) /* within the mesh */
        for (int i = 0; i < 3; i++)
            c.position[i] = c.focal_point[i] + 0.07 * (i + 1) * (b[2 * i + 1] - b[2 * i]);
    if (k >= 4 && k != 6)
        for (int i = 0; i < 3; i++)
            c.focal_point[i] = c.position[i] - diagonal * from[k][i];
    if (k == 5)
        c.clip_near = 0.05 * diagonal, c.clip_far = 0.3 * diagonal;
    if (k == 6)
        c.clip_near = distance - 0.11 * diagonal, c.clip_far = distance + 0.17 * diagonal;
    c.window_center[0] = k == 2 ? 0.2 : 0;
    return c;
}

/* Number of rays that meet something. */
static size_t compare_view(const char *name, const tc_mesh *m, const tc_reference *r, const tc_transfer *tf,
                           double unit, const tc_camera *camera, int k)
{
    tc_rays rays;
    size_t met = 0;
    assert_int_equal(tc_rays_from_camera(&rays, camera, WIDE, HIGH, NULL), TC_OK);
    for (int y = 0; y < HIGH; y += 2)
        for (int x = y % 3; x < WIDE; x += 3) {
            double origin[3], direction[3], range[2];
            tc_reference_ray ray;
            tc_rays_pixel(origin, direction, &rays, x + 0.5, HIGH - y - 0.5);
            tc_rays_range(range, &rays, x + 0.5, HIGH - y - 0.5);
            assert_int_equal(tc_reference_trace(&ray, r, tf, unit, origin, direction, range, 0), TC_OK);
            tc_probe *p = probe(m, tf, unit, camera, WIDE, HIGH, x, y);
            const double length = length_of(p), size = tc_vec_length(m->report.bounds) + ray.length;
            if (!(fabs(p->opacity - ray.rgba[3]) <= 1e-9 && fabs(length - ray.length) <= 1e-11 * size))
                fail_msg("%s, view %d, pixel %d,%d: opacity %.17g, not %.17g; length %.17g, not %.17g", name, k, x, y,
                         p->opacity, ray.rgba[3], length, ray.length);
            if (p->n > 0)
                NEAR(1 - p->part[p->n - 1].transmittance, p->opacity, 1e-15);
            for (size_t i = 0; i < p->n; i++) {
                const tc_probe_part *q = &p->part[i];
                assert_true(q->depth[0] < q->depth[1] && q->depth[0] >= 0);
                assert_true(i == 0 || (q[-1].depth[0] <= q->depth[0] && q[-1].transmittance >= q->transmittance));
                assert_true(isnan(q->scalar[0]) == isnan(q->scalar[1]));
            }
            assert_true(isnan(p->picked) == (p->opacity == 0));
            met += p->n > 0;
            tc_probe_destroy(&p);
        }
    return met;
}

static void opacity_is_not_that_of_the_reference_caster(void **state)
{
    (void)state;
    size_t n, met = 0, meshes = 0, cell_data = 0, unknown = 0, folded = 0;
    const tc_synth_info *list = tc_synth_list(&n);
    for (size_t i = 0; i < n; i++) {
        tc_mesh *m = prepared(list[i].name, 900, TC_REENTRY_PEEL);
        if (!m)
            continue;
        tc_reference *r = reference_of(m);
        tc_transfer *tf = crooked(m);
        const double unit = tc_default_unit_distance(m);
        for (int k = 0; k < VIEWS; k++) {
            tc_camera camera = view(m, k);
            met += compare_view(list[i].name, m, r, tf, unit, &camera, k);
        }
        meshes++;
        cell_data += m->association == TC_CELL_DATA, unknown += m->report.nonfinite_cells > 0;
        folded += !m->report.convex;
        tc_transfer_destroy(&tf);
        tc_reference_destroy(&r);
        tc_mesh_destroy(&m);
    }
    assert_true(meshes > 30 && cell_data > 0 && unknown > 2 && folded > 10);
    assert_true(met > 100 * meshes);
}

/* ------------------------------------------------------------------------------------------------- closed forms */

/* A cube with the field a + b . x, and rays to it from far and near. */
static void chord_scalar_or_opacity_of_a_cube_is_wrong(void **state)
{
    (void)state;
    for (int parallel = 0; parallel < 2; parallel++)
        for (int far = 0; far < 2; far++) {
            struct tc_mesh f = kuhn_cube(6);
            linear_field(&f, 0.25, 2, -1, 0.5);
            tc_mesh *m = from_fixture(&f);
            const tc_knot constant = {0, 1, 1, 1, 0.6};
            tc_transfer *tf = function(&constant, 1);
            tc_camera c = {.parallel = parallel};
            const double from[3] = {0.9, -0.5, 0.7};
            tc_camera_reset(&c, m->report.bounds, from, UP, 30, 1);
            const double away = far ? 1e6 : 0; /* digits are lost in depths, not in opacity */
            for (int i = 0; i < 3; i++)
                c.position[i] += away * (c.position[i] - c.focal_point[i]);
            c.view_angle = far ? 1e-5 : 30;
            size_t met = 0;
            for (int i = 0; i < 400; i++) {
                tc_probe *p = probe(m, tf, 0.5, &c, 20, 20, i % 20, i / 20);
                double chord = box_chord(p->origin, p->direction, 1, 0);
                NEAR(length_of(p), chord, far ? 2e-8 : 1e-14);
                NEAR(p->opacity, -expm1(-0.6 * chord / 0.5), far ? 2e-8 : 1e-13);
                for (size_t k = 0; k < p->n; k++) {
                    const tc_probe_part *q = &p->part[k];
                    for (int e = 0; e < 2; e++) {
                        double at[3];
                        tc_vec_mul_add(at, p->origin, q->depth[e], p->direction);
                        NEAR(q->scalar[e], 0.25 + 2 * at[0] - at[1] + 0.5 * at[2], far ? 1e-7 : 1e-13);
                    }
                    /* the parts of a convex mesh meet, to the last bit */
                    assert_true(k == 0 || q->depth[0] == q[-1].depth[1]);
                }
                /* half of the opacity: of constant attenuation in closed form */
                if (chord > 0)
                    NEAR(p->picked, p->part[0].depth[0] - log1p(-0.5 * p->opacity) * 0.5 / 0.6, far ? 2e-8 : 1e-13);
                met += chord > 0;
                tc_probe_destroy(&p);
            }
            assert_true(met > 60);
            tc_transfer_destroy(&tf);
            tc_mesh_destroy(&m);
        }
}

/* What is met of a polyhedron, convex or not, is what the line has of its analytic shape. */
static void chord_is_not_that_of_the_shape(void **state)
{
    (void)state;
    static const char *const name[] = {"ball", "heatsink", "cylinder", "comb", "shells"};
    for (int i = 0; i < 5; i++) {
        tc_mesh *m = prepared(name[i], 3000, TC_REENTRY_PEEL);
        const tc_synth_generator *g = tc_synth_find(name[i]);
        size_t met = 0;
        assert_non_null(m);
        for (int k = 0; k < 4; k++) {
            static const double from[4][3] = {{0.3, 0.5, 1}, {1, 0.2, 0.1}, {-0.7, 0.3, -0.4}, {0.11, -1, 0.23}};
            tc_camera c = {.parallel = k >= 2};
            tc_camera_reset(&c, m->report.bounds, from[k], UP, 30, 1);
            for (int x = 0; x < 196; x++) {
                tc_probe *p = probe(m, NULL, 0, &c, 14, 14, x % 14, x / 14);
                NEAR(length_of(p), g->chord(p->origin, p->direction, 3000), 1e-9 * tc_vec_length(c.position));
                met += p->n > 0;
                tc_probe_destroy(&p);
            }
        }
        assert_true(met > 200);
        tc_mesh_destroy(&m);
    }
}

/* A ray that runs through vertices, along edges and in faces still has one chord. */
static void a_ray_along_edges_loses_or_doubles_a_cell(void **state)
{
    (void)state;
    struct tc_mesh f = kuhn_cube(4);
    tc_mesh *m = from_fixture(&f);
    const double range[2] = {-INFINITY, INFINITY};
    for (int a = -2; a <= 2; a++)
        for (int b = -2; b <= 2; b++)
            for (int c = -2; c <= 2; c++)
                for (int g = 0; g < 125 && (a || b || c); g++) {
                    double d[3] = {a, b, c}, o[3], sum = 0;
                    const double p[3] = {g % 5 / 8.0 + 0.125, g / 5 % 5 / 8.0 + 0.25, g / 25 / 8.0 + 0.375};
                    tc_line_part *part;
                    size_t n;
                    tc_vec_normalize(d);
                    tc_vec_mul_add(o, p, -3, d);
                    assert_int_equal(tc_line_meet(&part, &n, m, o, d, range, 1, NULL), TC_OK);
                    for (size_t i = 0; i < n; i++) {
                        sum += part[i].length;
                        assert_true(i == 0 || part[i].t[0] == part[i - 1].t[1]);
                    }
                    NEAR(sum, box_chord(o, d, 1, 0), 2e-11); /* rays along a face are moved by 2^-40 */
                    free(part);
                }
    tc_mesh_destroy(&m);
}

/* Which of the cells around an edge, vertex or face a ray through it meets, and whether one in the rim is in: as the
 * reference decides it. The data of cells tell. */
static void a_tie_is_decided_otherwise_than_by_the_reference_caster(void **state)
{
    (void)state;
    struct tc_mesh f = kuhn_cube(4);
    uint64_t seed = 8;
    f.association = TC_CELL_DATA;
    f.scalar = realloc(f.scalar, f.n_tet * sizeof *f.scalar);
    assert_non_null(f.scalar);
    for (size_t i = 0; i < f.n_tet; i++)
        f.scalar[i] = uniform(&seed, 0, 1);
    tc_mesh *m = from_fixture(&f);
    tc_reference *r = reference_of(m);
    const tc_knot ramp[2] = {{0, 1, 1, 1, 0}, {1, 1, 1, 1, 1}};
    tc_transfer *tf = function(ramp, 2);
    const double range[2] = {-INFINITY, INFINITY};
    for (int a = -1; a <= 1; a++)
        for (int b = -1; b <= 1; b++)
            for (int c = -1; c <= 1; c++)
                for (int g = 0; g < 125 && (a || b || c); g++) {
                    double d[3] = {a, b, c}, o[3], depth = 0;
                    const double p[3] = {g % 5 / 4.0, g / 5 % 5 / 4.0, g / 25 / 4.0};
                    tc_line_part *part;
                    size_t n;
                    tc_vec_normalize(d);
                    tc_vec_mul_add(o, p, -3, d);
                    assert_int_equal(tc_line_meet(&part, &n, m, o, d, range, 1, NULL), TC_OK);
                    for (size_t i = 0; i < n; i++)
                        depth += part[i].length * part[i].s[0];
                    NEAR(-expm1(-depth), trace(r, tf, o, d, -INFINITY).rgba[3], 1e-9);
                    free(part);
                }
    tc_transfer_destroy(&tf);
    tc_reference_destroy(&r);
    tc_mesh_destroy(&m);
}

/* Two cubes one of which is moved by 3 along x. */
static void a_gap_is_filled_or_a_clipped_part_is_seen(void **state)
{
    (void)state;
    for (int reentry = TC_REENTRY_CONVEXIFY; reentry <= TC_REENTRY_PEEL; reentry++) {
        struct tc_mesh a = kuhn_cube(2), f = mesh_alloc(2 * a.n_vertex, 2 * a.n_tet);
        for (size_t i = 0; i < f.n_vertex; i++) {
            tc_vec_copy(&f.vertex[3 * i], &a.vertex[3 * (i % a.n_vertex)]);
            f.vertex[3 * i] += i < a.n_vertex ? 0 : 3;
            f.scalar[i] = f.vertex[3 * i];
        }
        for (size_t i = 0; i < 4 * f.n_tet; i++)
            f.tet[i] = a.tet[i % (4 * a.n_tet)] + (i < 4 * a.n_tet ? 0 : (int32_t)a.n_vertex);
        mesh_free(&a);
        tc_mesh *m = from_fixture(&f);
        tc_error err = {0};
        if (tc_mesh_prepare(m, &(tc_prepare_options){.reentry = (tc_reentry)reentry}, NULL, &err) != TC_OK)
            fail_msg("%s", err.text);
        assert_true((m->n_imaginary > 0) == (reentry == TC_REENTRY_CONVEXIFY));
        tc_camera c = {
            .position = {-2, 0.4, 0.3}, .focal_point = {0, 0.4, 0.3}, .view_up = {0, 1, 0}, .view_angle = 30};
        tc_probe *p = probe(m, NULL, 0, &c, 1, 1, 0, 0);
        double gap = 0;
        size_t gaps = 0;
        for (size_t i = 1; i < p->n; i++)
            if (p->part[i].depth[0] != p->part[i - 1].depth[1])
                gap = p->part[i].depth[0] - p->part[i - 1].depth[1], gaps++;
        assert_int_equal(gaps, 1);
        NEAR(gap, 2, 1e-15);
        NEAR(p->part[0].depth[0], 2, 1e-15);
        NEAR(p->part[p->n - 1].depth[1], 6, 1e-15);
        assert_true(p->opacity == 0 && isnan(p->picked) && p->part[0].transmittance == 1);
        tc_probe_destroy(&p);

        c.clip_near = 2.5, c.clip_far = 5.25;
        p = probe(m, NULL, 0, &c, 1, 1, 0, 0);
        assert_true(p->part[0].depth[0] == 2.5 && p->part[p->n - 1].depth[1] == 5.25);
        NEAR(p->part[0].scalar[0], 0.5, 1e-15);
        NEAR(p->part[p->n - 1].scalar[1], 3.25, 1e-15);
        NEAR(length_of(p), 0.75, 1e-14);
        tc_probe_destroy(&p);

        c.clip_near = 3.5, c.clip_far = 4.5; /* of the gap alone */
        p = probe(m, NULL, 0, &c, 1, 1, 0, 0);
        assert_int_equal(p->n, 0);
        tc_probe_destroy(&p);
        tc_mesh_destroy(&m);
    }
}

/* ----------------------------------------------------------------------------------------------------- the rest */

/* What lies before the picked depth has half of the opacity of all. */
static void picked_is_not_where_half_is_reached(void **state)
{
    (void)state;
    static const char *const name[] = {"ball", "heatsink", "nan-region", "nan-cells"};
    for (int i = 0; i < 4; i++) {
        tc_mesh *m = prepared(name[i], 3000, TC_REENTRY_PEEL);
        assert_non_null(m);
        tc_transfer *tf = crooked(m);
        size_t seen = 0;
        for (int k = 0; k < 100; k++) {
            tc_camera c = view(m, 3); /* parallel: depth is that of the clipping range */
            tc_probe *p = probe(m, tf, 0, &c, 10, 10, k % 10, k / 10);
            if (p->opacity > 0) {
                c.clip_far = p->picked;
                tc_probe *q = probe(m, tf, 0, &c, 10, 10, k % 10, k / 10);
                NEAR(q->opacity, 0.5 * p->opacity, 1e-12);
                tc_probe_destroy(&q);
                seen++;
            }
            tc_probe_destroy(&p);
        }
        assert_true(seen > 20);
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&m);
    }
}

static void more_threads_give_other_bits(void **state)
{
    (void)state;
    tc_mesh *m = prepared("ball", 300000, TC_REENTRY_PEEL);
    assert_true(m && m->n_tet > 200000);
    const double o[3] = {5, 4, 3}, range[2] = {0, INFINITY};
    double d[3], middle[3];
    for (int i = 0; i < 3; i++)
        middle[i] = 0.5 * (m->report.bounds[2 * i] + m->report.bounds[2 * i + 1]);
    tc_vec_sub(d, middle, o);
    tc_vec_normalize(d);
    tc_line_part *one, *other;
    size_t n, n_other;
    assert_int_equal(tc_line_meet(&one, &n, m, o, d, range, 1, NULL), TC_OK);
    assert_true(n > 40);
    for (int threads = 2; threads < 8; threads += 2) {
        assert_int_equal(tc_line_meet(&other, &n_other, m, o, d, range, threads, NULL), TC_OK);
        assert_int_equal(n, n_other);
        for (size_t i = 0; i < n; i++) {
            assert_memory_equal(one[i].t, other[i].t, sizeof one->t);
            assert_memory_equal(one[i].s, other[i].s, sizeof one->s);
            assert_int_equal(one[i].tet, other[i].tet);
        }
        free(other);
    }
    free(one);
    tc_mesh_destroy(&m);
}

static void what_cannot_be_probed_is_no_error_or_one_without_a_reason(void **state)
{
    (void)state;
    tc_mesh *m = prepared("kuhn", 200, TC_REENTRY_PEEL), *raw;
    assert_int_equal(tc_synth_create(&raw, "kuhn", 200, 0, NULL), TC_OK);
    const tc_camera good = view(m, 0);
    tc_camera bad = good;
    tc_vec_copy(bad.position, bad.focal_point);
    const struct {
        const tc_mesh *mesh;
        double unit;
        const tc_camera *camera;
        int x, y;
        const char *says;
    } wrong[] = {{NULL, 0, &good, 0, 0, "needed"},
                 {m, 0, NULL, 0, 0, "needed"},
                 {raw, 0, &good, 0, 0, "tc_mesh_prepare"},
                 {m, -1, &good, 0, 0, "unit distance"},
                 {m, NAN, &good, 0, 0, "unit distance"},
                 {m, 0, &good, 8, 0, "8,0"},
                 {m, 0, &good, 0, -1, "0,-1"},
                 {m, 0, &bad, 0, 0, "no direction"}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_probe *p = (tc_probe *)&p;
        tc_error err = {0};
        assert_int_equal(
            tc_mesh_probe(&p, wrong[i].mesh, NULL, wrong[i].unit, wrong[i].camera, 8, 6, wrong[i].x, wrong[i].y, &err),
            TC_E_ARG);
        assert_null(p);
        if (!strstr(err.text, wrong[i].says))
            fail_msg("\"%s\" does not say \"%s\"", err.text, wrong[i].says);
    }
    tc_probe_destroy(NULL);
    tc_mesh_destroy(&raw);
    tc_mesh_destroy(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opacity_is_not_that_of_the_reference_caster),
        cmocka_unit_test(chord_scalar_or_opacity_of_a_cube_is_wrong),
        cmocka_unit_test(chord_is_not_that_of_the_shape),
        cmocka_unit_test(a_ray_along_edges_loses_or_doubles_a_cell),
        cmocka_unit_test(a_tie_is_decided_otherwise_than_by_the_reference_caster),
        cmocka_unit_test(a_gap_is_filled_or_a_clipped_part_is_seen),
        cmocka_unit_test(picked_is_not_where_half_is_reached),
        cmocka_unit_test(more_threads_give_other_bits),
        cmocka_unit_test(what_cannot_be_probed_is_no_error_or_one_without_a_reason),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
