/* test_reference_look_surfaces.c: isosurfaces and geometry of the reference caster: where they are, in what order, and
 * what the judge of pictures says of rays that graze them. */
#include "reference_look.h"
#include "reference_scene.h"

#include "mesh/field.h"

static tc_knot grey_knot = {0, 1, 0.5, 0.25, 1.5};
static const double GREY[3] = {1, 0.5, 0.25};
static struct tc_transfer grey = {.n = 1, .knot = &grey_knot};
static tc_knot ramp_knot[2] = {{0, 0.9, 0.1, 0.3, 0.5}, {1, 0.2, 0.7, 0.6, 3}};
static struct tc_transfer ramp = {.n = 2, .knot = ramp_knot};

/* ---------------------------------------------------------------------------------------------------- isosurfaces */

/* Planes of a linear field, in the order in which the ray meets them, within a medium of one colour or alone. */
static void isosurface_lies_elsewhere_or_in_another_order(void **state)
{
    (void)state;
    static const tc_iso iso[4] = {{0.62, 0.4, true, {1, 0, 0}},
                                  {0.2, 0.7, true, {0, 1, 0}},
                                  {0.45, 0.1, false, {0, 0, 0}},
                                  {0.9, 1, true, {0, 0.2, 1}}};
    static const int by_value[4] = {1, 2, 0, 3};
    uint64_t seed = 1;
    int crossings = 0;
    for (int sign = -1; sign <= 1; sign += 2) {
        const double a = sign > 0 ? 0.1 : 0.9, b[3] = {sign * 0.3, sign * 0.2, sign * 0.35};
        struct tc_mesh m = kuhn_cube(3);
        linear_field(&m, a, b[0], b[1], b[2]);
        tc_reference *r = reference_of(&m);
        for (int run = 0; run < 600; run++) {
            double d[3], t[2];
            const bool alone = run % 2, hit = random_ray(d, t, &seed);
            look_of(r,
                    &(tc_look){.model = alone ? TC_MODEL_SURFACES : TC_MODEL_DENSITY_EMITTER, .n_iso = 4, .iso = iso});
            tc_reference_ray ray = trace(r, &grey, OUTSIDE, d, 0);
            stack s = {.clear = 1};
            double at = t[0], rise = tc_vec_dot(b, d), start = scalar_on(d, 0, a, b[0], b[1], b[2]);
            for (int k = 0; k < 5 && hit; k++) {
                const tc_iso *next = k == 4 ? NULL : &iso[by_value[rise > 0 ? k : 3 - k]];
                double to = next ? (next->value - start) / rise : t[1];
                if (to < t[0] || to > t[1])
                    continue;
                if (!alone)
                    stack_add(&s, GREY, -expm1(-1.5 * (to - at)));
                if (next)
                    stack_add(&s, next->has_color ? next->color : GREY, next->opacity), crossings++;
                at = to;
            }
            for (int c = 0; c < 4; c++)
                NEAR(ray.rgba[c], s.rgba[c], 1e-12);
        }
        tc_reference_destroy(&r);
        mesh_free(&m);
    }
    assert_true(crossings > 500);
}

/* The distance from the middle, its own isosurface: seen inside of the silhouette alone, and where a sphere is. */
static void isosurface_of_a_distance_is_no_sphere(void **state)
{
    (void)state;
    enum { N = 32 };
    const double radius = 0.36;
    struct tc_mesh m = kuhn_cube(N);
    double *z = malloc(m.n_vertex * sizeof *z);
    assert_non_null(z);
    for (size_t i = 0; i < m.n_vertex; i++) {
        const double *x = &m.vertex[3 * i];
        m.scalar[i] = sqrt((x[0] - 0.5) * (x[0] - 0.5) + (x[1] - 0.5) * (x[1] - 0.5) + (x[2] - 0.5) * (x[2] - 0.5));
        z[i] = x[2];
    }
    static tc_knot place_knot[2] = {{0, 0, 0, 0, 0}, {1, 1, 1, 1, 0}};
    struct tc_transfer place = {.n = 2, .knot = place_knot};
    const tc_field field = {.association = TC_POINT_DATA, .n = m.n_vertex, .value = z};
    tc_iso iso = {.value = radius, .opacity = 1};
    tc_reference *r = reference_of(&m);
    const tc_look look = {
        .model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &iso, .color_field = &field, .color_function = &place};
    uint64_t seed = 2;
    double worst = 0;
    for (int run = 0; run < 1500; run++) {
        const double o[3] = {uniform(&seed, 0, 1), uniform(&seed, 0, 1), 3}, down[3] = {0, 0, -1};
        double off = hypot(o[0] - 0.5, o[1] - 0.5), half = sqrt(fmax(radius * radius - off * off, 0));
        iso.opacity = run % 2 ? 1 : 0.5;
        look_of(r, &look);
        tc_reference_ray ray = trace(r, &grey, o, down, 0);
        if (fabs(off - radius) < 2.0 / (N * N)) /* the mesh's sphere is a polyhedron */
            continue;
        if (off > radius) {
            assert_true(ray.rgba[3] == 0);
        } else if (run % 2) { /* the colour tells where */
            assert_true(ray.rgba[3] == 1);
            if (half > 0.1)
                worst = fmax(worst, fabs(ray.rgba[0] - 0.5 - half));
        } else { /* in and out */
            NEAR(ray.rgba[3], 0.75, 1e-15);
            if (half > 0.1)
                NEAR(ray.rgba[1], 0.5 * (0.5 + half) + 0.25 * (0.5 - half), 3.0 / (N * N));
        }
    }
    assert_true(worst > 0 && worst < 3.0 / (N * N));
    free(z);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* Rays along axes and diagonals through vertices, edges and faces, to surfaces that run through vertices. */
static void surface_through_vertices_has_holes_or_is_met_twice(void **state)
{
    (void)state;
    static const tc_iso iso[3] = {
        {0.7, 0.5, true, {1, 1, 1}}, {0.35, 0.25, true, {1, 1, 1}}, {1.05, 0.5, true, {1, 1, 1}}};
    struct tc_mesh m = kuhn_cube(4);
    linear_field(&m, 0, 0.1, 0.3, 1.0);
    tc_reference *r = reference_of(&m);
    look_of(r, &(tc_look){.model = TC_MODEL_SURFACES, .n_iso = 3, .iso = iso});
    for (int a = -2; a <= 2; a++)
        for (int b = -2; b <= 2; b++)
            for (int c = -2; c <= 2; c++)
                for (int g = 0; g < 125; g++) {
                    double d[3] = {a, b, c}, p[3] = {g % 5 / 8.0 + 0.25, g / 5 % 5 / 8.0 + 0.25, g / 25 / 8.0 + 0.25};
                    const double gradient[3] = {0.1, 0.3, 1.0};
                    if (fabs(tc_vec_dot(d, gradient)) < 0.01)
                        continue;
                    double o[3], t0 = -INFINITY, t1 = INFINITY, clear = 1;
                    tc_vec_normalize(d);
                    tc_vec_mul_add(o, p, -3, d);
                    for (int i = 0; i < 3; i++)
                        if (d[i] != 0) {
                            t0 = fmax(t0, fmin(-o[i] / d[i], (1 - o[i]) / d[i]));
                            t1 = fmin(t1, fmax(-o[i] / d[i], (1 - o[i]) / d[i]));
                        }
                    bool edge = false;
                    for (int k = 0; k < 3; k++) {
                        double at = (iso[k].value - tc_vec_dot(gradient, o)) / tc_vec_dot(gradient, d);
                        edge = edge || fabs(at - t0) < 1e-9 || fabs(at - t1) < 1e-9;
                        if (at > t0 && at < t1)
                            clear *= 1 - iso[k].opacity;
                    }
                    if (!edge) /* at the hull's very rim a surface may be met or not */
                        NEAR(trace(r, &grey, o, d, -INFINITY).rgba[3], 1 - clear, 1e-15);
                }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* Two cubes one above the other, without common vertices: 0 … 0.4 and 0.6 … 1. */
static void jump_from_cell_to_cell_or_a_cut_is_a_surface(void **state)
{
    (void)state;
    struct tc_mesh one = kuhn_cube(1), m = mesh_alloc(16, 12);
    for (size_t i = 0; i < 16; i++) {
        memcpy(&m.vertex[3 * i], &one.vertex[3 * (i % 8)], 3 * sizeof(double));
        m.vertex[3 * i + 2] += (double)(i / 8);
        m.scalar[i] = 0.6 * (double)(i / 8) + 0.4 * one.vertex[3 * (i % 8) + 2];
    }
    for (size_t i = 0; i < 48; i++)
        m.tet[i] = one.tet[i % 24] + (i < 24 ? 0 : 8);
    const tc_iso jump = {0.5, 1, true, {1, 1, 1}}, inside = {0.3, 0.5, true, {1, 1, 1}};
    const double o[3] = {0.3, 0.4, 3}, down[3] = {0, 0, -1};
    const tc_plane above = {{0, 0, 1}, 0.8}, below = {{0, 0, 1}, 0.7};
    tc_reference *r = reference_of(&m);
    look_of(r, &(tc_look){.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &jump});
    assert_true(trace(r, &grey, o, down, 0).rgba[3] == 0);
    look_of(r, &(tc_look){.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &inside});
    assert_true(trace(r, &grey, o, down, 0).rgba[3] == 0.5);
    look_of(r, &(tc_look){.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &inside, .n_plane = 1, .plane = &above});
    assert_true(trace(r, &grey, o, down, 0).rgba[3] == 0);
    look_of(r, &(tc_look){.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &inside, .n_plane = 1, .plane = &below});
    assert_true(trace(r, &grey, o, down, 0).rgba[3] == 0.5);
    /* Nor is a cell that is left out. */
    const double range[1][2] = {{0.5, 1}};
    const tc_select select = {NULL, 1, range};
    look_of(r, &(tc_look){.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &inside, .n_select = 1, .select = &select});
    assert_true(trace(r, &grey, o, down, 0).rgba[3] == 0);
    tc_reference_destroy(&r);
    mesh_free(&m);
    mesh_free(&one);
}

static void colour_of_a_surface_is_not_the_right_one_at_a_step(void **state)
{
    (void)state;
    static tc_knot knot[4] = {{0, 1, 0, 0, 1}, {0.5, 1, 0, 0, 1}, {0.5, 0, 1, 0, 1}, {1, 0, 0, 1, 1}};
    struct tc_transfer step = {.n = 4, .knot = knot};
    struct tc_mesh m = kuhn_cube(2);
    linear_field(&m, 0, 0, 0, 1);
    const tc_iso iso[2] = {{0.5, 1, false, {0}}, {0.75, 1, false, {0}}};
    tc_reference *r = reference_of(&m);
    for (int k = 0; k < 4; k++) {
        const double o[3] = {0.3, 0.4, k % 2 ? 3 : -3}, d[3] = {0, 0, k % 2 ? -1 : 1};
        look_of(r, &(tc_look){.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &iso[k / 2]});
        tc_reference_ray ray = trace(r, &step, o, d, 0);
        NEAR(ray.rgba[0], 0, 1e-15);
        NEAR(ray.rgba[1], k / 2 ? 0.5 : 1, 1e-15);
        NEAR(ray.rgba[2], k / 2 ? 0.5 : 0, 1e-15);
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* ------------------------------------------------------------------------------------------------------- geometry */

/* A square of two triangles at height z, from lo to hi. */
static void square(double vertex[12], int32_t triangle[6], double z, double lo, double hi)
{
    const double x[12] = {lo, lo, z, hi, lo, z, hi, hi, z, lo, hi, z};
    const int32_t id[6] = {0, 1, 2, 2, 3, 0};
    memcpy(vertex, x, sizeof x);
    memcpy(triangle, id, sizeof id);
}

/* Squares before, in and behind a medium with an isosurface, given in no order; one is far larger than the mesh. */
static void geometry_is_out_of_order_with_the_volume(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(3);
    linear_field(&m, 0, 0, 0, 1);
    static const double height[4] = {0.4, -1.5, 1.25, 0.8}, opacity[4] = {0.5, 1, 0.25, 0.3};
    static const int down_order[4] = {2, 3, 0, 1};
    double vertex[4][12];
    int32_t triangle[4][6];
    tc_geometry geometry[4];
    for (int k = 0; k < 4; k++) {
        square(vertex[k], triangle[k], height[k], k == 1 ? -4e6 : -0.5, k == 1 ? 5e6 : 1.5);
        geometry[k] = (tc_geometry){.n_vertex = 4,
                                    .n_triangle = 2,
                                    .vertex = vertex[k],
                                    .triangle = triangle[k],
                                    .color = {0.25 * k, 1 - 0.2 * k, 0.5},
                                    .opacity = opacity[k],
                                    .lit = true};
    }
    const tc_iso iso = {0.6, 0.4, true, {0.2, 0.9, 0.4}};
    const tc_look look = {.n_geometry = 4, .geometry = geometry, .n_iso = 1, .iso = &iso};
    tc_reference *r = reference_of(&m);
    look_of(r, &look);
    uint64_t seed = 3;
    for (int run = 0; run < 200; run++) {
        double d[3], o[3], p[3] = {uniform(&seed, -0.1, 1.1), uniform(&seed, -0.1, 1.1), 0.5};
        if (run % 4 == 0)
            p[1] = p[0]; /* along the diagonal that the two triangles share */
        tc_vec_sub(d, (double[3]){0.5, 0.5, 0.5}, OUTSIDE);
        if (run % 2 == 0)
            d[0] = d[1] = 0;
        tc_vec_normalize(d);
        tc_vec_mul_add(o, p, -4, d);
        double t[2] = {-INFINITY, INFINITY}, heights[6] = {1.25, 0.8, 0.6, 0.4, -1.5, 0}, at;
        for (int i = 0; i < 3; i++)
            if (d[i] != 0) {
                t[0] = fmax(t[0], fmin(-o[i] / d[i], (1 - o[i]) / d[i]));
                t[1] = fmin(t[1], fmax(-o[i] / d[i], (1 - o[i]) / d[i]));
            } else if (o[i] < 0 || o[i] > 1) {
                t[0] = INFINITY;
            }
        stack s = {.clear = 1};
        at = t[0];
        for (int k = 0, n = 0; k < 5; k++) {
            double to = (heights[k] - o[2]) / d[2], x = o[0] + to * d[0], y = o[1] + to * d[1];
            double end = fmin(fmax(to, t[0]), t[1]);
            if (t[0] < t[1])
                stack_add(&s, GREY, -expm1(-1.5 * (end - at))), at = end;
            if (k == 2) {
                if (to > t[0] && to < t[1])
                    stack_add(&s, iso.color, iso.opacity);
                continue;
            }
            const tc_geometry *g = &geometry[down_order[n++]];
            if (n == 4 || (x > -0.5 && x < 1.5 && y > -0.5 && y < 1.5))
                stack_add(&s, g->color, g->opacity);
        }
        tc_reference_ray ray = trace(r, &grey, o, d, 0);
        for (int c = 0; c < 4; c++)
            NEAR(ray.rgba[c], s.rgba[c], 1e-9); /* the large one's depth is that of a point 4e6 away */
    }
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void geometry_is_seen_where_the_camera_clips_it_or_not_where_planes_cut(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(2);
    double vertex[12];
    int32_t triangle[6];
    square(vertex, triangle, 0.5, 0, 1);
    const tc_geometry geometry = {
        .n_vertex = 4, .n_triangle = 2, .vertex = vertex, .triangle = triangle, .color = {1, 0, 0}, .opacity = 0.5};
    const tc_plane plane = {{0, 0, 1}, 0.75};
    tc_reference *r = reference_of(&m);
    look_of(r, &(tc_look){
                   .model = TC_MODEL_SURFACES, .n_geometry = 1, .geometry = &geometry, .n_plane = 1, .plane = &plane});
    const double o[3] = {0.3, 0.6, 3}, down[3] = {0, 0, -1};
    const double seen[3][2] = {{0, 10}, {2.6, 10}, {0, 2.4}};
    for (int k = 0; k < 3; k++) {
        tc_reference_ray ray;
        assert_int_equal(tc_reference_trace(&ray, r, &grey, 1, o, down, seen[k], 0), TC_OK);
        NEAR(ray.rgba[3], k == 0 ? 0.5 : 0, 0);
    }
    const double beside[3] = {1.3, 0.6, 3};
    assert_true(trace(r, &grey, beside, down, 0).rgba[3] == 0);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

static void geometry_hides_what_an_extreme_shows(void **state)
{
    (void)state;
    struct tc_mesh m = kuhn_cube(2);
    linear_field(&m, 0, 0, 0, 1);
    double vertex[12], expected[4];
    int32_t triangle[6];
    square(vertex, triangle, -0.5, 0, 1);
    tc_geometry geometry = {
        .n_vertex = 4, .n_triangle = 2, .vertex = vertex, .triangle = triangle, .color = {1, 0, 0}, .opacity = 0.25};
    tc_reference *r = reference_of(&m);
    look_of(r, &(tc_look){.model = TC_MODEL_MAXIMUM, .n_geometry = 1, .geometry = &geometry});
    const double o[3] = {0.3, 0.6, 3}, down[3] = {0, 0, -1};
    tc_reference_ray ray = trace(r, &ramp, o, down, 0);
    tc_transfer_evaluate(expected, &ramp, 1);
    for (int c = 0; c < 4; c++)
        NEAR(ray.rgba[c], c == 3 ? 1 : 0.25 * geometry.color[c] + 0.75 * expected[c], 1e-15);
    tc_reference_destroy(&r);
    mesh_free(&m);
}

/* A closed box, seen through edges and corners of it: in and out, once each. */
static void edge_of_geometry_is_met_twice_or_not_at_all(void **state)
{
    (void)state;
    static const int32_t triangle[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    struct tc_mesh m = kuhn_cube(1), inner = kuhn_cube(1);
    for (int i = 0; i < 24; i++)
        inner.vertex[i] = 0.25 + 0.5 * inner.vertex[i];
    const tc_geometry geometry = {.n_vertex = 8,
                                  .n_triangle = 12,
                                  .vertex = inner.vertex,
                                  .triangle = triangle,
                                  .color = {1, 1, 1},
                                  .opacity = 0.5};
    tc_reference *r = reference_of(&m);
    look_of(r, &(tc_look){.model = TC_MODEL_SURFACES, .n_geometry = 1, .geometry = &geometry});
    for (int a = -2; a <= 2; a++)
        for (int b = -2; b <= 2; b++)
            for (int c = -2; c <= 2; c++)
                for (int g = 0; g < 27 && (a || b || c); g++) {
                    double d[3] = {a, b, c}, p[3] = {g % 3 / 8.0 + 0.375, g / 3 % 3 / 8.0 + 0.375, g / 9 / 8.0 + 0.375},
                           o[3];
                    tc_vec_normalize(d);
                    tc_vec_mul_add(o, p, -3, d);
                    NEAR(trace(r, &grey, o, d, -INFINITY).rgba[3], 0.75, 0);
                }
    tc_reference_destroy(&r);
    mesh_free(&m);
    mesh_free(&inner);
}

/* -------------------------------------------------------------------------------------------------------- judging */

/* A picture without what the reference sees at rays that graze: not an error; with another colour elsewhere: one. */
static void grazing_rays_count_or_plain_errors_do_not(void **state)
{
    (void)state;
    scene s;
    scene_of(&s, &(scene_choice){.width = 16,
                                 .height = 16,
                                 .cells = 2,
                                 .gradient = {0, 0, 1},
                                 .knot = {{0, 0, 0, 1, 0.5}, {1, 1, 0.2, 0, 3}},
                                 .front = {0, 0, 1},
                                 .parallel = true,
                                 .zoom = 1});
    double vertex[2][12];
    int32_t triangle[6];
    square(vertex[0], triangle, 0.5, -9, 9);
    square(vertex[1], triangle, 0.5, -9, 9);
    const tc_geometry twice[2] = {
        {.n_vertex = 4, .n_triangle = 2, .vertex = vertex[0], .triangle = triangle, .color = {1, 0, 0}, .opacity = 1},
        {.n_vertex = 4, .n_triangle = 2, .vertex = vertex[1], .triangle = triangle, .color = {0, 1, 0}, .opacity = 1}};
    const tc_iso rim = {1, 1, true, {0, 1, 0}}, middle = {0.55, 1, true, {0, 1, 0}};
    const tc_look looks[3] = {
        {.n_iso = 1, .iso = &rim}, {.n_iso = 1, .iso = &middle}, {.n_geometry = 2, .geometry = twice}};
    for (int k = 0; k < 3; k++) {
        look_of(s.reference, &looks[k]);
        scene_draw(&s, 1);
        size_t changed = 0;
        for (size_t i = 0; i < 256; i++)
            if (s.pixels[4 * i + 3] > 0 && i % 3 == 0) { /* the other order, or no surface at all */
                if (k == 2)
                    s.pixels[4 * i] = 0, s.pixels[4 * i + 1] = 1;
                else
                    memset(&s.pixels[4 * i], 0, 4 * sizeof(float));
                changed++;
            }
        assert_true(changed > 20);
        tc_verify_result v = scene_verify(&s, 256, 1, 1);
        if (k == 1) {
            assert_int_equal(v.ill_posed, 0);
            assert_true(v.max_abs_error > 0.4);
        } else {
            assert_int_equal(v.ill_posed, changed);
            assert_true(v.max_abs_error < 1e-6);
        }
    }
    scene_finish(&s);
}

/* Cells of two colours by a second field, whose value lies on a step of the function. */
static void step_of_the_colour_field_is_no_doubt(void **state)
{
    (void)state;
    scene s;
    scene_of(&s, &(scene_choice){.width = 8,
                                 .height = 8,
                                 .cells = 2,
                                 .gradient = {0, 0, 0},
                                 .knot = {{0, 0, 0, 1, 2}, {1, 1, 0.2, 0, 2}},
                                 .front = {0, 0, 1},
                                 .parallel = true,
                                 .zoom = 2});
    static tc_knot knot[4] = {{0, 1, 0, 0, 1}, {0.5, 1, 0, 0, 1}, {0.5, 0, 1, 0, 1}, {1, 0, 1, 0, 1}};
    struct tc_transfer step = {.n = 4, .knot = knot};
    double cells[48];
    const tc_field field = {.association = TC_CELL_DATA, .n = 48, .value = cells};
    const tc_look look = {.color_field = &field, .color_function = &step};
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 48; i++)
            cells[i] = i ? 0.5 + 0.1 * k : 1.5; /* one of them gives the range */
        look_of(s.reference, &look);
        scene_draw(&s, 1);
        for (size_t i = 0; i < 64; i++)
            s.pixels[4 * i] = s.pixels[4 * i + 1], s.pixels[4 * i + 1] = 0;
        tc_verify_result v = scene_verify(&s, 64, 1, 1);
        assert_int_equal(v.ill_posed, k ? 0 : 64);
    }
    scene_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(isosurface_lies_elsewhere_or_in_another_order),
        cmocka_unit_test(isosurface_of_a_distance_is_no_sphere),
        cmocka_unit_test(surface_through_vertices_has_holes_or_is_met_twice),
        cmocka_unit_test(jump_from_cell_to_cell_or_a_cut_is_a_surface),
        cmocka_unit_test(colour_of_a_surface_is_not_the_right_one_at_a_step),
        cmocka_unit_test(geometry_is_out_of_order_with_the_volume),
        cmocka_unit_test(geometry_is_seen_where_the_camera_clips_it_or_not_where_planes_cut),
        cmocka_unit_test(geometry_hides_what_an_extreme_shows),
        cmocka_unit_test(edge_of_geometry_is_met_twice_or_not_at_all),
        cmocka_unit_test(grazing_rays_count_or_plain_errors_do_not),
        cmocka_unit_test(step_of_the_colour_field_is_no_doubt),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
