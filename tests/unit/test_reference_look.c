/* test_reference_look.c: optical models, clipping, selection and a second field of the reference caster against closed
 * forms, against rays of a part of the line, and against meshes of the cells that are left. */
#include "test_reference_fixture.h"

#include "mesh/field.h"
#include "reference_look.h"

static tc_knot grey_knot = {0, 1, 0.5, 0.25, 1.5};
static const double GREY[3] = {1, 0.5, 0.25};
static struct tc_transfer grey = {.n = 1, .knot = &grey_knot};
static tc_knot ramp_knot[2] = {{0, 0.9, 0.1, 0.3, 0.5}, {1, 0.2, 0.7, 0.6, 3}};
static struct tc_transfer ramp = {.n = 2, .knot = ramp_knot};
static tc_knot wild_knot[6] = {{0, 1, 0, 0, 0},   {0.3, 0, 1, 0, 6},   {0.3, 0, 0, 1, 1},
                               {0.5, 1, 1, 0, 0}, {0.52, 0, 1, 1, 40}, {0.9, 1, 0, 1, 2}};
static struct tc_transfer wild = {.n = 6, .knot = wild_knot};

/* -------------------------------------------------------------------------------------------------- optical models */

static void light_alone_is_absorbed_or_covers_what_is_behind(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    tc_reference *r = reference_of(&m);
    look_of(r, &(tc_look){.model = TC_MODEL_EMISSION});
    uint64_t seed = 1;
    for (int run = 0; run < 200; run++) {
        double d[3], t[2];
        bool hit = random_ray(d, t, &seed);
        tc_reference_ray ray = trace(r, &grey, OUTSIDE, d, 0);
        double chord = hit ? t[1] - t[0] : 0;
        for (int c = 0; c < 3; c++)
            NEAR(ray.rgba[c], GREY[c] * 1.5 * chord, 1e-13);
        assert_true(ray.rgba[3] == 0);
    }
    linear_field(&m, 0.1, 0.3, 0.2, 0.35);
    for (int run = 0; run < 60; run++) {
        double d[3], t[2], sum[3] = {0, 0, 0};
        if (!random_ray(d, t, &seed))
            continue;
        /* Between knots a product of two linear functions of t: Simpson's rule is exact. */
        for (int i = 0; i < 3; i++) {
            double at = t[0] + 0.5 * i * (t[1] - t[0]), c[4];
            tc_transfer_evaluate(c, &ramp, scalar_on(d, at, 0.1, 0.3, 0.2, 0.35));
            for (int k = 0; k < 3; k++)
                sum[k] += (i == 1 ? 4 : 1) * c[k] * c[3] * (t[1] - t[0]) / 6;
        }
        tc_reference_ray ray = trace(r, &ramp, OUTSIDE, d, 0);
        for (int k = 0; k < 3; k++)
            NEAR(ray.rgba[k], sum[k], 1e-12);
        assert_true(ray.rgba[3] == 0);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void absorption_shines_or_xray_is_not_the_optical_depth(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    linear_field(&m, 0.1, 0.3, 0.2, 0.35);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 2;
    for (int run = 0; run < 200; run++) {
        double d[3], t[2];
        bool hit = random_ray(d, t, &seed);
        double a0 = hit ? 0.5 + 2.5 * scalar_on(d, t[0], 0.1, 0.3, 0.2, 0.35) : 0;
        double a1 = hit ? 0.5 + 2.5 * scalar_on(d, t[1], 0.1, 0.3, 0.2, 0.35) : 0;
        double alpha = hit ? -expm1(-0.5 * (a0 + a1) * (t[1] - t[0])) : 0;
        look_of(r, &(tc_look){.model = TC_MODEL_ABSORPTION});
        tc_reference_ray dark = trace(r, &ramp, OUTSIDE, d, 0);
        look_of(r, &(tc_look){.model = TC_MODEL_XRAY});
        tc_reference_ray white = trace(r, &ramp, OUTSIDE, d, 0);
        NEAR(dark.rgba[3], alpha, 1e-13);
        for (int c = 0; c < 4; c++)
            NEAR(white.rgba[c], alpha, 1e-13);
        assert_true(dark.rgba[0] == 0 && dark.rgba[1] == 0 && dark.rgba[2] == 0);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void extreme_or_mean_on_a_ray_is_another(void **state)
{
    (void)state;
    static const tc_model model[3] = {TC_MODEL_MAXIMUM, TC_MODEL_MINIMUM, TC_MODEL_AVERAGE};
    struct tc_mesh m = kuhn_cube(4);
    linear_field(&m, 0.1, 0.3, -0.2, 0.35);
    tc_reference *r = reference_of(&m);
    uint64_t seed = 3;
    int missed = 0;
    for (int run = 0; run < 600; run++) {
        double d[3], t[2], expected[4] = {0, 0, 0, 0};
        bool hit = random_ray(d, t, &seed);
        if (hit) {
            double a = scalar_on(d, t[0], 0.1, 0.3, -0.2, 0.35), b = scalar_on(d, t[1], 0.1, 0.3, -0.2, 0.35);
            tc_transfer_evaluate(expected, &ramp,
                                 run % 3 == 0   ? fmax(a, b)
                                 : run % 3 == 1 ? fmin(a, b)
                                                : 0.5 * (a + b));
            expected[3] = 1;
        }
        missed += !hit;
        look_of(r, &(tc_look){.model = model[run % 3]});
        tc_reference_ray ray = trace(r, &ramp, OUTSIDE, d, 0);
        for (int c = 0; c < 4; c++)
            NEAR(ray.rgba[c], expected[c], 1e-13);
    }
    assert_true(missed > 20);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void values_that_are_not_finite_count_in_extremes(void **state)
{
    (void)state;
    static const tc_model model[3] = {TC_MODEL_MAXIMUM, TC_MODEL_MINIMUM, TC_MODEL_AVERAGE};
    static const double nan_color[4] = {1, 0, 0, 5};
    struct tc_mesh m = kuhn_cube(2);
    linear_field(&m, 0, 0, 0, 1);
    const double o[3] = {0.3, 0.4, 3}, down[3] = {0, 0, -1};
    tc_reference *r = reference_of(&m);
    tc_reference_set_nan_color(r, nan_color);
    for (int all = 0; all < 2; all++) {
        for (size_t i = 0; i < m.n_vertex; i++)
            if (m.vertex[3 * i + 2] == 1 || all)
                m.scalar[i] = i % 2 ? NAN : INFINITY;
        for (int k = 0; k < 3; k++) { /* only the lower layer is known: 0 … 0.5 */
            double expected[4];
            look_of(r, &(tc_look){.model = model[k]});
            tc_transfer_evaluate(expected, &ramp, k == 0 ? 0.5 : k == 1 ? 0 : 0.25);
            expected[3] = 1;
            tc_reference_ray ray = trace(r, &ramp, o, down, 0);
            for (int c = 0; c < 4; c++)
                NEAR(ray.rgba[c], all ? 0 : expected[c], 1e-14);
        }
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void empty_look_changes_the_last_bit(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(4);
    linear_field(&m, 0.05, 0.4, 0.3, 0.2);
    tc_reference *plain = reference_of(&m), *r = reference_of(&m);
    uint64_t seed = 4;
    for (int run = 0; run < 200; run++) {
        double d[3], t[2];
        random_ray(d, t, &seed);
        look_of(r, run % 2 ? &(tc_look){.shade.gradient = TC_GRADIENT_CELL} : &(tc_look){.model = 0});
        tc_reference_ray x = trace(plain, &wild, OUTSIDE, d, 0), y = trace(r, &wild, OUTSIDE, d, 0);
        assert_memory_equal(&x, &y, sizeof x);
        /* The other way through the same integral, of a look that takes nothing away: near, but its own arithmetic. */
        const tc_plane far = {{0, 0, 1}, -10};
        look_of(r, &(tc_look){.n_plane = 1, .plane = &far});
        y = trace(r, &wild, OUTSIDE, d, 0);
        for (int c = 0; c < 4; c++)
            NEAR(y.rgba[c], x.rgba[c], 1e-13);
    }
    tc_reference_destroy(&plain);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* ------------------------------------------------------------------------------------------------------- clipping */

static void planes_or_box_cut_elsewhere(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(4);
    linear_field(&m, 0.05, 0.4, 0.3, 0.2);
    tc_reference *whole = reference_of(&m), *r = reference_of(&m);
    const tc_plane slab[3] = {{{1, 2, -1}, 0.2}, {{-2, -4, 2}, -3.2}, {{0, 0, 7}, 0.7}};
    const tc_look looks[3] = {{.n_plane = 3, .plane = slab},
                              {.has_box = true, .box = {0.1, 0.6, -5, 0.85, 0.3, 9}},
                              {.n_plane = 2, .plane = slab, .has_box = true, .box = {0.1, 0.6, -5, 0.85, 0.3, 9}}};
    uint64_t seed = 5;
    int cut = 0;
    for (int run = 0; run < 900; run++) {
        const tc_look *look = &looks[run % 3];
        double d[3], t[2], part[2] = {0, INFINITY};
        random_ray(d, t, &seed);
        for (int k = 0; k < look->n_plane; k++)
            keep_side(part, d, look->plane[k].normal, look->plane[k].offset);
        for (int a = 0; look->has_box && a < 3; a++) {
            const double n[3] = {a == 0, a == 1, a == 2}, p[3] = {-n[0], -n[1], -n[2]};
            keep_side(part, d, n, look->box[2 * a]);
            keep_side(part, d, p, -look->box[2 * a + 1]);
        }
        tc_reference_ray x = {.length = 0}, y;
        if (part[0] < part[1])
            assert_int_equal(tc_reference_trace(&x, whole, &wild, 1, OUTSIDE, d, part, 0), TC_OK);
        look_of(r, look);
        y = trace(r, &wild, OUTSIDE, d, 0);
        NEAR(y.length, x.length, 1e-13);
        for (int c = 0; c < 4; c++)
            NEAR(y.rgba[c], x.rgba[c], 1e-11);
        cut += x.length > 0 && x.length < t[1] - t[0] - 1e-9;
    }
    assert_true(cut > 300);
    tc_reference_destroy(&whole);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void plane_along_the_ray_keeps_the_wrong_side(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(2);
    tc_reference *r = reference_of(&m);
    const double o[3] = {0.3, 0.4, 3}, down[3] = {0, 0, -1};
    for (int k = 0; k < 4; k++) {
        const tc_plane plane = {{k % 2 ? -1 : 1, 0, 0}, (k % 2 ? -1 : 1) * (k < 2 ? 0.29 : 0.31)};
        look_of(r, &(tc_look){.n_plane = 1, .plane = &plane});
        NEAR(trace(r, &grey, o, down, 0).length, k == 0 || k == 3 ? 1 : 0, 1e-14);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* ------------------------------------------------------------------------------------------------------ selection */

static void cells_left_out_are_seen_or_others_go_with_them(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(4), q = mesh_alloc(m.n_vertex, m.n_tet);
    uint64_t seed = 6;
    linear_field(&m, 0.05, 0.4, 0.3, 0.2);
    memcpy(q.vertex, m.vertex, 3 * m.n_vertex * sizeof *m.vertex);
    memcpy(q.scalar, m.scalar, m.n_vertex * sizeof *m.scalar);
    double *points = malloc(m.n_vertex * sizeof *points), *cells = malloc(m.n_tet * sizeof *cells);
    assert_true(points && cells);
    for (size_t i = 0; i < m.n_vertex; i++)
        points[i] = i % 31 == 5 ? NAN : m.vertex[3 * i] + 0.25 * (double)(i % 2);
    for (size_t i = 0; i < m.n_tet; i++)
        cells[i] = i % 11 == 3 ? NAN : i % 12 == 7 ? INFINITY : (double)(i % 5);
    const tc_field by_point = {.association = TC_POINT_DATA, .n = m.n_vertex, .value = points};
    const tc_field by_cell = {.association = TC_CELL_DATA, .n = m.n_tet, .value = cells};
    const double two[2][2] = {{0, 0.5}, {0.25, 0.75}}, ids[2][2] = {{1, 1}, {3, 4}}, all[1][2] = {{-9, INFINITY}};
    const double own[1][2] = {{0.2, 0.7}};
    const tc_select select[4] = {{&by_point, 2, two}, {&by_cell, 2, ids}, {NULL, 1, own}, {&by_cell, 1, all}};
    tc_reference *r = reference_of(&m);
    for (int kind = 0; kind < 6; kind++) { /* each alone, then two, then all */
        const tc_look look = {.n_select = kind < 4 ? 1 : kind == 4 ? 2 : 4, .select = &select[kind < 4 ? kind : 0]};
        q.n_tet = 0;
        for (size_t i = 0; i < m.n_tet; i++) {
            const int32_t *id = &m.tet[4 * i];
            bool in[4] = {false, cells[i] == 1 || cells[i] == 3 || cells[i] == 4, true, cells[i] < INFINITY};
            for (int k = 0; k < 2; k++) {
                bool inside = true;
                for (int j = 0; j < 4; j++)
                    inside = inside && points[id[j]] >= two[k][0] && points[id[j]] <= two[k][1];
                in[0] = in[0] || inside;
            }
            for (int j = 0; j < 4; j++)
                in[2] = in[2] && m.scalar[id[j]] >= 0.2 && m.scalar[id[j]] <= 0.7;
            if (kind < 4 ? in[kind] : kind == 4 ? in[0] && in[1] : in[0] && in[1] && in[2] && in[3])
                memcpy(&q.tet[4 * q.n_tet++], id, 4 * sizeof *id);
        }
        assert_true(q.n_tet > 3 && q.n_tet < m.n_tet);
        tc_reference *rest = reference_of(&q);
        look_of(r, &look);
        for (int run = 0; run < 100; run++) {
            double d[3], t[2];
            random_ray(d, t, &seed);
            tc_reference_ray x = trace(rest, &wild, OUTSIDE, d, 0), y = trace(r, &wild, OUTSIDE, d, 0);
            NEAR(y.length, x.length, 1e-13);
            for (int c = 0; c < 4; c++)
                NEAR(y.rgba[c], x.rgba[c], 1e-12);
        }
        tc_reference_destroy(&rest);
    }
    free(points), free(cells);
    tc_reference_destroy(&r);
    mesh_free(&m);
    mesh_free(&q);
}

/* ---------------------------------------------------------------------------------------------------- a second field
 */

static void colour_of_another_field_is_not_that_of_its_integral(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    linear_field(&m, 0.1, 0.3, 0.2, 0.35);
    double *other = malloc(m.n_vertex * sizeof *other);
    assert_non_null(other);
    for (size_t i = 0; i < m.n_vertex; i++) {
        const double *x = &m.vertex[3 * i];
        other[i] = 0.9 - 0.5 * x[0] - 0.1 * x[1] + 0.1 * x[2];
    }
    const tc_field field = {.association = TC_POINT_DATA, .n = m.n_vertex, .value = other};
    tc_reference *r = reference_of(&m);
    look_of(r, &(tc_look){.color_field = &field, .color_function = &wild});
    uint64_t seed = 7;
    for (int run = 0; run < 40; run++) {
        double d[3], t[2], sum[4] = {0, 0, 0, 0}, depth = 0;
        if (!random_ray(d, t, &seed))
            continue;
        enum { N = 20000 };
        const double h = (t[1] - t[0]) / N;
        for (int i = 0; i < N; i++) { /* the middle of each step; colours jump at steps of the function */
            double at = t[0] + (i + 0.5) * h, a[4], c[4];
            tc_transfer_evaluate(a, &ramp, scalar_on(d, at, 0.1, 0.3, 0.2, 0.35));
            tc_transfer_evaluate(c, &wild, scalar_on(d, at, 0.9, -0.5, -0.1, 0.1));
            double light = exp(-depth) * -expm1(-a[3] * h);
            for (int k = 0; k < 3; k++)
                sum[k] += c[k] * light;
            sum[3] += light;
            depth += a[3] * h;
        }
        tc_reference_ray ray = trace(r, &ramp, OUTSIDE, d, 0);
        for (int k = 0; k < 3; k++)
            NEAR(ray.rgba[k], sum[k], 2e-4);
        NEAR(ray.rgba[3], sum[3], 1e-9);
    }
    free(other);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* The mesh's own scalar as the field for colour, and cells that each have one colour. */
static void colour_field_that_says_nothing_new_changes_the_picture(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    uint64_t seed = 8;
    for (size_t i = 0; i < m.n_vertex; i++)
        m.scalar[i] = uniform(&seed, 0, 1);
    const tc_field same = {.association = TC_POINT_DATA, .n = m.n_vertex, .value = m.scalar};
    double *cells = calloc(m.n_tet, sizeof *cells);
    assert_non_null(cells);
    for (size_t i = 0; i < m.n_tet; i++)
        cells[i] = 7;
    const tc_field constant = {.association = TC_CELL_DATA, .n = m.n_tet, .value = cells};
    tc_knot one_knot[6];
    for (int i = 0; i < 6; i++)
        one_knot[i] = wild_knot[i], one_knot[i].r = 0.2, one_knot[i].g = 0.3, one_knot[i].b = 0.8;
    struct tc_transfer one = {.n = 6, .knot = one_knot};
    static tc_knot step_knot[4] = {{0, 1, 1, 1, 9}, {7, 1, 1, 1, 9}, {7, 0.2, 0.3, 0.8, 0}, {8, 0.2, 0.3, 0.8, 0}};
    struct tc_transfer step = {.n = 4, .knot = step_knot};
    tc_reference *plain = reference_of(&m), *r = reference_of(&m);
    for (int run = 0; run < 300; run++) {
        double d[3], t[2];
        random_ray(d, t, &seed);
        look_of(r, run % 2 ? &(tc_look){.color_field = &same, .color_function = &wild}
                           : &(tc_look){.color_field = &constant, .color_function = &step});
        tc_reference_ray x = trace(plain, run % 2 ? &wild : &one, OUTSIDE, d, 0), y = trace(r, &wild, OUTSIDE, d, 0);
        for (int c = 0; c < 4; c++)
            NEAR(y.rgba[c], x.rgba[c], 1e-12);
    }
    free(cells);
    tc_reference_destroy(&plain);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* Rays that run in faces and along edges, where what corners weigh is hard to tell. */
static void colour_along_edges_is_that_of_another_place(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(4);
    linear_field(&m, 0, 0.1, 0.3, 0.55);
    const tc_field same = {.association = TC_POINT_DATA, .n = m.n_vertex, .value = m.scalar};
    tc_reference *plain = reference_of(&m), *r = reference_of(&m);
    look_of(r, &(tc_look){.color_field = &same, .color_function = &ramp});
    for (int a = -2; a <= 2; a++)
        for (int b = -2; b <= 2; b++)
            for (int c = -2; c <= 2; c++)
                for (int g = 0; g < 27 && (a || b || c); g++) {
                    double d[3] = {a, b, c}, p[3] = {g % 3 / 8.0 + 0.25, g / 3 % 3 / 8.0 + 0.25, g / 9 / 8.0 + 0.25},
                           o[3];
                    tc_vec_normalize(d);
                    tc_vec_mul_add(o, p, -3, d);
                    tc_reference_ray x = trace(plain, &ramp, o, d, 0), y = trace(r, &ramp, o, d, 0);
                    for (int k = 0; k < 4; k++)
                        NEAR(y.rgba[k], x.rgba[k], 1e-11);
                }
    tc_reference_destroy(&plain);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void unknown_colour_hides_or_shows_the_wrong_cells(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(2), q = kuhn_cube(2);
    double *points = calloc(m.n_vertex, sizeof *points);
    assert_non_null(points);
    static const double nan_color[4] = {0.1, 0.6, 0.2, 2};
    for (size_t i = 0; i < m.n_vertex; i++)
        if (m.vertex[3 * i] == 1)
            points[i] = NAN, q.scalar[i] = NAN;
    const tc_field field = {.association = TC_POINT_DATA, .n = m.n_vertex, .value = points};
    tc_reference *r = reference_of(&m), *bad = reference_of(&q);
    look_of(r, &(tc_look){.color_field = &field, .color_function = &grey});
    uint64_t seed = 9;
    for (int run = 0; run < 100; run++) {
        double d[3], t[2];
        random_ray(d, t, &seed);
        if (run == 50)
            tc_reference_set_nan_color(r, nan_color), tc_reference_set_nan_color(bad, nan_color);
        tc_reference_ray x = trace(bad, &grey, OUTSIDE, d, 0), y = trace(r, &grey, OUTSIDE, d, 0);
        for (int c = 0; c < 4; c++)
            NEAR(y.rgba[c], x.rgba[c], 1e-13);
    }
    free(points);
    tc_reference_destroy(&r);
    tc_reference_destroy(&bad);
    mesh_free(&m);
    mesh_free(&q);
}

/* -------------------------------------------------------------------------------------------------------- refusals */

static void what_cannot_be_shown_is_taken(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(1);
    tc_reference *r = reference_of(&m);
    tc_error err;
    const tc_field small = {.association = TC_POINT_DATA, .n = 3, .value = m.scalar};
    const tc_field fits = {.association = TC_POINT_DATA, .n = 8, .value = m.scalar};
    const double range[1][2] = {{0, 1}};
    const tc_select select = {&small, 1, range};
    const int32_t beyond[3] = {0, 1, 3};
    const double vertex[9] = {0, 0, 0, 1, 0, 0, 0, NAN, 0};
    const int32_t good[3] = {0, 1, 2};
    const tc_geometry missing = {.n_vertex = 2, .n_triangle = 1, .vertex = vertex, .triangle = beyond};
    const tc_geometry unknown = {.n_vertex = 3, .n_triangle = 1, .vertex = vertex, .triangle = good};
    const tc_iso iso = {.value = 0.5, .opacity = 1};
    const tc_look wrong[] = {{.color_field = &small, .color_function = &grey},
                             {.color_field = &fits},
                             {.n_select = 1, .select = &select},
                             {.n_geometry = 1, .geometry = &missing},
                             {.n_geometry = 1, .geometry = &unknown},
                             {.n_iso = 1, .iso = &iso}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        m.association = k == 5 ? TC_CELL_DATA : TC_POINT_DATA;
        err.text[0] = 0;
        assert_int_equal(tc_reference_set_look(r, &wrong[k], &err), TC_E_ARG);
        assert_true(strlen(err.text) > 20);
        m.association = TC_POINT_DATA;
        const double o[3] = {0.3, 0.4, 3}, down[3] = {0, 0, -1};
        NEAR(trace(r, &grey, o, down, 0).rgba[3], -expm1(-1.5), 1e-14); /* plain */
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_alone_is_absorbed_or_covers_what_is_behind),
        cmocka_unit_test(absorption_shines_or_xray_is_not_the_optical_depth),
        cmocka_unit_test(extreme_or_mean_on_a_ray_is_another),
        cmocka_unit_test(values_that_are_not_finite_count_in_extremes),
        cmocka_unit_test(empty_look_changes_the_last_bit),
        cmocka_unit_test(planes_or_box_cut_elsewhere),
        cmocka_unit_test(plane_along_the_ray_keeps_the_wrong_side),
        cmocka_unit_test(cells_left_out_are_seen_or_others_go_with_them),
        cmocka_unit_test(colour_of_another_field_is_not_that_of_its_integral),
        cmocka_unit_test(colour_field_that_says_nothing_new_changes_the_picture),
        cmocka_unit_test(colour_along_edges_is_that_of_another_place),
        cmocka_unit_test(unknown_colour_hides_or_shows_the_wrong_cells),
        cmocka_unit_test(what_cannot_be_shown_is_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
