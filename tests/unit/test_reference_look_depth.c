/* test_reference_look_depth.c: where the reference caster says that a ray has an opacity, against closed forms and
 * against the opacity of the ray up to there. */
#include "test_reference_fixture.h"

#include "reference_look.h"
#include "reference_scene.h"

static tc_knot ramp_knot[2] = {{0, 0.9, 0.1, 0.3, 0.5}, {1, 0.2, 0.7, 0.6, 3}};
static struct tc_transfer ramp = {.n = 2, .knot = ramp_knot};
static tc_knot wild_knot[6] = {{0, 1, 0, 0, 0},   {0.3, 0, 1, 0, 6},   {0.3, 0, 0, 1, 1},
                               {0.5, 1, 1, 0, 0}, {0.52, 0, 1, 1, 40}, {0.9, 1, 0, 1, 2}};
static struct tc_transfer wild = {.n = 6, .knot = wild_knot};
static tc_knot clear_knot = {0, 1, 1, 1, 0};
static struct tc_transfer clear = {.n = 1, .knot = &clear_knot};

static double opacity_to(const tc_reference *r, const tc_transfer *tf, const double d[3], double t)
{
    tc_reference_ray ray;
    const double range[2] = {0, t};
    assert_int_equal(tc_reference_trace(&ray, r, tf, 1.0, OUTSIDE, d, range, 0), TC_OK);
    return ray.rgba[3];
}

/* One tet, in which the scalar is linear: the place by the formula, from what the whole chord lets through. */
static void place_in_a_cell_is_not_at_the_logarithms_share(void **state)
{
    (void)state;
    struct tc_mesh m = mesh_alloc(4, 1);
    for (int i = 0; i < 3; i++) {
        m.vertex[3 * i + 3 + i] = 1;
        m.tet[i + 1] = i + 1;
    }
    linear_field(&m, 0.1, 0.3, 0.2, 0.35);
    tc_reference *plain = reference_of(&m), *r = reference_of(&m);
    const double o[3] = {0.2, 0.25, 3}, down[3] = {0, 0, -1};
    const double ends[2] = {0.1 + 0.06 + 0.05 + 0.35 * 0.55, 0.1 + 0.06 + 0.05}; /* enters at z 0.55, leaves at 0 */
    const double through = 1 - trace(plain, &ramp, o, down, 0).rgba[3];
    for (int k = 1; k < 100; k++) {
        const double opacity = k / 100.0;
        look_of(r, &(tc_look){.model = TC_MODEL_DEPTH, .depth_opacity = opacity});
        tc_reference_ray ray = trace(r, &ramp, o, down, 0);
        const bool there = 1 - through >= opacity;
        const double share = log(1 - opacity) / log(through);
        NEAR(ray.rgba[0], there ? 3 - 0.55 + 0.55 * share : 0, 1e-13);
        NEAR(ray.rgba[1], there ? ends[0] + share * (ends[1] - ends[0]) : 0, 1e-13);
        assert_true(ray.rgba[2] == 0 && ray.rgba[3] == there);
    }
    assert_true(through > 0.2 && through < 0.8);
    tc_reference_destroy(&plain);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* The plain ray that ends at the place. Cells of one value: as opaque as was wanted, to rounding. Values of points:
 * within the cell that reaches it. */
static void ray_up_to_the_place_has_another_opacity(void **state)
{
    (void)state;
    enum { N = 4 };
    uint64_t seed = 1;
    int found = 0, clear_rays = 0;
    for (int way = 0; way < 2; way++) {
        struct tc_mesh m = kuhn_cube(N);
        if (way == 0) {
            m.association = TC_CELL_DATA;
            free(m.scalar);
            m.scalar = calloc(m.n_tet, sizeof *m.scalar);
            assert_non_null(m.scalar);
        }
        for (size_t i = 0; i < (way == 0 ? m.n_tet : m.n_vertex); i++)
            m.scalar[i] = uniform(&seed, 0, 1);
        tc_reference *plain = reference_of(&m), *r = reference_of(&m);
        for (int run = 0; run < 600; run++) {
            double d[3], t[2], opacity = uniform(&seed, 1e-4, 1);
            random_ray(d, t, &seed);
            look_of(r, &(tc_look){.model = TC_MODEL_DEPTH, .depth_opacity = opacity});
            tc_reference_ray ray = trace(r, &wild, OUTSIDE, d, 0);
            const double whole = trace(plain, &wild, OUTSIDE, d, 0).rgba[3], at = ray.rgba[0];
            assert_true(ray.rgba[3] == (whole >= opacity));
            found += ray.rgba[3] == 1;
            clear_rays += ray.rgba[3] == 0;
            if (ray.rgba[3] == 0)
                continue;
            if (way == 0) {
                NEAR(opacity_to(plain, &wild, d, at), opacity, 1e-12);
            } else {
                assert_true(opacity_to(plain, &wild, d, at - sqrt(3) / N) < opacity);
                assert_true(opacity_to(plain, &wild, d, at + sqrt(3) / N) >= opacity);
            }
            assert_true(ray.rgba[1] >= 0 && ray.rgba[1] <= 1);
        }
        tc_reference_destroy(&plain);
        tc_reference_destroy(&r);
        mesh_free(&m);
    }
    assert_true(found > 300 && clear_rays > 100);
}

/* Matter so dense that nothing is left behind it, and where nothing but all is wanted. */
static void dense_matter_is_reached_behind_where_it_begins(void **state)
{
    (void)state;
    tc_knot dense_knot[2] = {{0, 1, 1, 1, 1e30}, {1, 1, 1, 1, 1e30}};
    struct tc_transfer dense = {.n = 2, .knot = dense_knot};
    struct tc_mesh m = kuhn_cube(2);
    linear_field(&m, 0.2, 0, 0, 0.5);
    tc_reference *r = reference_of(&m);
    const double o[3] = {0.3, 0.4, 3}, down[3] = {0, 0, -1};
    static const double opacity[4] = {0, 0.01, 0.9999, 1};
    for (int k = 0; k < 4; k++) {
        look_of(r, &(tc_look){.model = TC_MODEL_DEPTH, .depth_opacity = opacity[k]});
        tc_reference_ray ray = trace(r, &dense, o, down, 0);
        NEAR(ray.rgba[0], 2, 1e-14);
        NEAR(ray.rgba[1], 0.7, 1e-14);
        assert_true(ray.rgba[3] == 1);
        ray = trace(r, &ramp, o, down, 0); /* 0.2 … 0.7: optical depth 1.625 */
        assert_true(ray.rgba[3] == (k < 2 ? 1 : 0));
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void surfaces_count_for_nothing(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    linear_field(&m, 0, 0, 0, 1);
    tc_reference *r = reference_of(&m);
    const double o[3] = {0.3, 0.4, 3}, down[3] = {0, 0, -1}, away[3] = {0, 0, 1};
    const tc_iso iso[2] = {{.value = 0.9, .opacity = 0.5}, {.value = 0.31, .opacity = 0.5}};
    const double vertex[18] = {-9, -9, 0.6, 9, -9, 0.6, 0, 9, 0.6, -9, -9, -0.5, 9, -9, -0.5, 0, 9, -0.5};
    static const int32_t triangle[6] = {0, 1, 2, 3, 4, 5};
    const tc_geometry sheets = {.n_vertex = 6, .n_triangle = 2, .vertex = vertex, .triangle = triangle, .opacity = 0.5};
    /* 0.5 at z 0.9, 0.75 at the sheet, 0.875 at z 0.31, 0.9375 at the sheet behind */
    static const double opacity[6] = {0.4, 0.5, 0.75, 0.8, 0.9, 0.95}, at[6] = {0.9, 0.9, 0.6, 0.31, -0.5, 0},
                        value[6] = {0.9, 0.9, 0, 0.31, 0, 0};
    for (int k = 0; k < 6; k++) {
        look_of(r, &(tc_look){.model = TC_MODEL_DEPTH,
                              .depth_opacity = opacity[k],
                              .n_iso = 2,
                              .iso = iso,
                              .n_geometry = 1,
                              .geometry = &sheets});
        tc_reference_ray ray = trace(r, &clear, o, down, 0);
        NEAR(ray.rgba[0], k < 5 ? 3 - at[k] : 0, 1e-13);
        NEAR(ray.rgba[1], value[k], 1e-13);
        assert_true(ray.rgba[3] == (k < 5));
    }
    assert_true(trace(r, &clear, o, away, 0).rgba[3] == 0);
    /* Matter between two surfaces: the part between them, not the cell, is what is divided. */
    tc_knot even_knot = {0, 1, 1, 1, 2};
    struct tc_transfer even = {.n = 1, .knot = &even_knot};
    look_of(r, &(tc_look){.model = TC_MODEL_DEPTH, .depth_opacity = 0.7, .n_iso = 2, .iso = iso});
    NEAR(trace(r, &even, o, down, 0).rgba[0], 2 + log(0.5 / 0.3) / 2, 1e-13);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void missing_values_have_a_scalar_or_no_depth(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(2);
    linear_field(&m, 0, 0, 0, 1);
    for (size_t i = 0; i < m.n_vertex; i++)
        if (m.vertex[3 * i + 2] == 1)
            m.scalar[i] = NAN;
    static const double nan_color[4] = {1, 0, 0, 1};
    tc_reference *r = reference_of(&m);
    const double o[3] = {0.3, 0.4, 3}, down[3] = {0, 0, -1};
    look_of(r, &(tc_look){.model = TC_MODEL_DEPTH, .depth_opacity = 0.3});
    for (int way = 0; way < 2; way++) {
        tc_reference_set_nan_color(r, way ? nan_color : NULL);
        tc_reference_ray ray = trace(r, &ramp, o, down, 0);
        assert_true(ray.rgba[3] == 1);
        if (way == 1) {
            NEAR(ray.rgba[0], 2 - log(0.7), 1e-13);
            assert_true(ray.rgba[1] == 0);
        } else {
            assert_true(ray.rgba[0] > 2.5 && ray.rgba[1] > 0 && ray.rgba[1] < 0.5);
        }
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* Of a picture: from the eye's plane, along the view. */
static void a_pixel_is_as_far_as_its_ray_is_long(void **state)
{
    (void)state;
    const tc_knot even = {0, 1, 1, 1, 3};
    for (int parallel = 0; parallel < 2; parallel++) {
        const scene_choice choice = {.width = 24,
                                     .height = 16,
                                     .cells = 2,
                                     .gradient = {0.2, 0.3, 0.1},
                                     .knot = {even, {1, 1, 1, 1, 3}},
                                     .front = {0, 0, 1},
                                     .parallel = parallel,
                                     .zoom = 1.5};
        scene s;
        scene_of(&s, &choice);
        look_of(s.reference, &(tc_look){.model = TC_MODEL_DEPTH});
        int found = 0;
        for (int p = 0; p < 24 * 16; p++) {
            double out[4], origin[3], direction[3], d = log(2) / 3;
            const double X = p % 24 + 0.5, Y = p / 24 + 0.5;
            assert_int_equal(tc_reference_pixel(out, s.reference, &s.tf, 1, &s.rays, X, Y, 0), TC_OK);
            tc_rays_pixel(origin, direction, &s.rays, X, Y);
            double t = (1 - origin[2]) / direction[2]; /* the front face */
            const double x = origin[0] + t * direction[0], y = origin[1] + t * direction[1];
            if (!(fmin(fmin(x, y), fmin(1 - x, 1 - y)) > 0.2))
                continue;
            found++;
            NEAR(out[0], s.rays.eye[2] - (1 + d * direction[2]), 1e-12);
            NEAR(out[1], 0.2 * (x + d * direction[0]) + 0.3 * (y + d * direction[1]) + 0.1 * (1 + d * direction[2]),
                 1e-12);
            assert_true(out[2] == 0 && out[3] == 1);
        }
        assert_true(found > 20);
        scene_finish(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(place_in_a_cell_is_not_at_the_logarithms_share),
        cmocka_unit_test(ray_up_to_the_place_has_another_opacity),
        cmocka_unit_test(dense_matter_is_reached_behind_where_it_begins),
        cmocka_unit_test(surfaces_count_for_nothing),
        cmocka_unit_test(missing_values_have_a_scalar_or_no_depth),
        cmocka_unit_test(a_pixel_is_as_far_as_its_ray_is_long),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
