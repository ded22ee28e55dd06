/* test_suite_look_shade.c: light is not what tc_shade says, or is paid for without being asked for. */
#include "look.h"

#include "core/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 40,
    HEIGHT = 36,
    SIDE = 5,
    POINTS = (SIDE + 1) * (SIDE + 1) * (SIDE + 1),
    TETS = 6 * SIDE * SIDE * SIDE
};

static const double SLOPE[3] = {1, 0.3, 0.2};

static double ramp(const double *x)
{
    return tc_vec_dot(x, SLOPE);
}

/* Both bend, so that gradients differ from cell to cell and along a ray. */
static double bowl(const double *x)
{
    return (x[0] - 0.4) * (x[0] - 0.4) + 0.8 * x[1] * x[1] - 0.5 * x[2] * x[0] + 0.3 * x[2];
}

static double saddle(const double *x)
{
    return 0.2 + x[1] * x[2] - 0.6 * x[0] * x[0];
}

static double level(const double *x)
{
    (void)x;
    return 0.25;
}

static const struct view {
    double direction[3];
    bool parallel;
} views[] = {{{0.3, 0.5, 1}, false}, {{-1, 0.2, 0.1}, true}, {{0, 0, 1}, true}, {{0.7, -0.6, -0.4}, false}};
enum { WITHIN = 3 }; /* the view whose eye check() puts into the box */

static const tc_knot fog[1] = {{0, 0.8, 0.6, 0.4, 1}};
static const tc_knot hills[5] = {
    {-0.3, 0, 0, 1, 0}, {0.1, 0, 1, 0, 0.8}, {0.3, 1, 0.5, 0, 0.1}, {0.3, 0.2, 0.5, 1, 0.7}, {1.2, 1, 1, 1, 1},
};
static const tc_light three[3] = {{.direction = {2, 1, 3}, .color = {1, 0.7, 0.2}},
                                  {.head = true, .color = {0.1, 0.3, 0.5}},
                                  {.direction = {-1, -0.2, 0.1}, .color = {0.3, 0.3, 0.3}}};

static tc_shade shade_of(tc_gradient gradient, bool colored, bool one_sided, double magnitude)
{
    tc_shade shade;
    tc_shade_defaults(&shade);
    shade.gradient = gradient;
    shade.one_sided = one_sided;
    shade.magnitude = magnitude;
    shade.specular = 0.4;
    shade.n_light = colored ? 3 : 0;
    shade.light = three;
    return shade;
}

/* What light makes of a colour, for a gradient g and a ray's unit direction. */
static void lit(double out[3], const double *color, const double *g, const double *direction, const tc_shade *shade,
                double m)
{
    static const tc_light white = {.head = true, .color = {1, 1, 1}};
    const tc_light *light = shade->n_light ? shade->light : &white;
    double n[3], eye[3], gain[3], glow[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        n[k] = -g[k], eye[k] = -direction[k], gain[k] = shade->ambient;
    tc_vec_normalize(n);
    double turn = !shade->one_sided && tc_vec_dot(n, eye) < 0 ? -1 : 1;
    for (int i = 0; i < (shade->n_light ? shade->n_light : 1); i++) {
        double to[3], half[3];
        tc_vec_copy(to, light[i].head ? eye : light[i].direction);
        tc_vec_normalize(to);
        tc_vec_add(half, to, eye);
        tc_vec_normalize(half);
        double facing = turn * tc_vec_dot(n, to), shine = turn * tc_vec_dot(n, half);
        for (int k = 0; k < 3 && facing > 0; k++) {
            gain[k] += shade->diffuse * light[i].color[k] * facing;
            glow[k] += shade->specular * light[i].color[k] * pow(fmax(shine, 0), shade->power);
        }
    }
    for (int k = 0; k < 3; k++)
        out[k] = (1 - m) * color[k] + m * (gain[k] * color[k] + glow[k]);
}

/* ---------------------------------------------------------------------------------------------------- closed form */

/* Matter of one colour, and a gradient that is the same everywhere. */
static void a_ramp_is_lit_otherwise(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(SIDE, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 1);
    double worst = 0;
    for (int way = 0; way < 4; way++) {
        const struct view *view = &views[way];
        const double magnitude = way & 2 ? 1.7 : 0;
        const tc_shade shade =
            shade_of(way & 1 ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX, way == 0 || way == 3, way & 2, magnitude);
        const tc_look look = {.shade = shade};
        tc_camera camera =
            suite_camera(mesh, view->direction[0], view->direction[1], view->direction[2], view->parallel);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.4;
        options.opacity_stop = way < 2 ? 1 : 0.9; /* half of what is left is added: lit, too */
        options.look = &look;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        /* R is 1.5, D the box's diagonal. */
        double m = tc_vec_length(SLOPE) / (tc_vec_length(SLOPE) + magnitude * 1.5 / sqrt(3));
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const float *p = image->rgba + 4 * i;
            const double color[3] = {0.8, 0.6, 0.4};
            double origin[3], direction[3], c[3];
            suite_ray(origin, direction, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
            lit(c, color, SLOPE, direction, &shade, m);
            for (int k = 0; k < 3; k++)
                worst = fmax(worst, fabs((double)p[k] - (double)p[3] * c[k]));
        }
        tc_image_destroy(&image);
    }
    suite_say("a ramp: colours are off by %.2g at most", worst);
    assert_true(worst < 1e-5);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* An opaque isosurface of the ramp, with nothing around it. */
static void a_plane_of_one_value_is_lit_otherwise(void **state)
{
    (void)state;
    static const tc_iso iso = {.value = 0.5, .opacity = 1, .has_color = true, .color = {0.7, 0.4, 0.9}};
    tc_mesh *mesh = look_box(SIDE, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 1);
    double worst = 0;
    size_t seen = 0;
    for (int way = 0; way < 2; way++) {
        const struct view *view = &views[way];
        const tc_shade shade = shade_of(way ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX, way, false, 3);
        const tc_look look = {.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &iso, .shade = shade};
        tc_camera camera =
            suite_camera(mesh, view->direction[0], view->direction[1], view->direction[2], view->parallel);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.look = &look;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const float *p = image->rgba + 4 * i;
            double origin[3], direction[3], c[3];
            suite_ray(origin, direction, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
            lit(c, iso.color, SLOPE, direction, &shade, 1);
            seen += p[3] > 0.5f;
            for (int k = 0; k < 3 && p[3] > 0.5f; k++)
                worst = fmax(worst, fabs((double)p[k] - c[k]));
        }
        tc_image_destroy(&image);
    }
    suite_say("a plane: colours are off by %.2g at most", worst);
    assert_true(seen > 300);
    assert_true(worst < 1e-5);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* ------------------------------------------------------------------------------------------------------ reference */

/* One look from one of the views; steps a pass differ with it. */
static void check(const char *what, const tc_mesh *mesh, const tc_look *look, int v)
{
    tc_transfer *tf = suite_function(hills, 5);
    const double *d = views[v].direction;
    tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
    if (v == WITHIN) {
        tc_vec_copy(camera.position, (const double[3]){0.45, 0.52, 0.61});
        camera.view_angle = 80;
    }
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.unit_distance = 0.2;
    options.look = look;
    options.steps_per_pass = v == 0 ? 7 : v == 2 ? 1 : 0;
    if (v == 1 && look->n_iso == 0)
        options.integrator = TC_INTEGRATOR_INTEGRAL; /* leaves some segments to pieces, which are added later */
    suite_check(what, mesh, tf, &camera, &options);
    tc_transfer_destroy(&tf);
}

static void points_differ_from_the_reference(void **state)
{
    (void)state;
    static const tc_plane plane[2] = {{{1, 0.2, 0.4}, 0.45}, {{-0.2, 0.3, -1}, -0.7}};
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA), *coarse = look_box(1, bowl, TC_POINT_DATA);
    for (int way = 0; way < 2; way++) {
        tc_look look = {.shade = shade_of(way ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX, way, way, 1)};
        for (int v = 0; v < WITHIN; v++)
            check("points", mesh, &look, v);
        look.n_plane = 2;
        look.plane = plane;
        check("points, cut by planes", coarse, &look, 0);
        check("points, cut by planes, from within", coarse, &look, WITHIN);
    }
    tc_mesh_destroy(&coarse);
    tc_mesh_destroy(&mesh);
}

static void cells_differ_from_the_reference(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(SIDE, saddle, TC_CELL_DATA);
    for (int way = 0; way < 2; way++) {
        const tc_look look = {.shade = shade_of(way ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX, false, false, 0.3)};
        check("values of cells", mesh, &look, way);
    }
    tc_mesh_destroy(&mesh);
}

static void surfaces_in_matter_differ_from_the_reference(void **state)
{
    (void)state;
    static const tc_iso iso[2] = {{.value = 0.15, .opacity = 0.5},
                                  {.value = 0.4, .opacity = 0.8, .has_color = true, .color = {1, 0.9, 0.2}}};
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA);
    for (int way = 0; way < 3; way++) {
        tc_look look = {.n_iso = 2, .iso = iso};
        look.shade = shade_of(way ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX, false, false, 0.5);
        look.shade.volume = way != 1;
        look.shade.surfaces = way != 2;
        check("surfaces in matter", mesh, &look, way);
        if (way == 0)
            check("surfaces in matter, from within", mesh, &look, WITHIN);
    }
    tc_mesh_destroy(&mesh);
}

/* The box's points as look_box has them. */
static void at_points(double value[POINTS], double (*field)(const double *x))
{
    for (int i = 0; i < POINTS; i++) {
        const int n = SIDE + 1;
        const double x[3] = {(double)(i % n) / SIDE, (double)(i / n % n) / SIDE, (double)(i / n / n) / SIDE};
        value[i] = field(x);
    }
}

static void set_values(tc_mesh *mesh, const double value[POINTS])
{
    tc_error err = {0};
    if (tc_mesh_set_scalar(mesh, value, TC_POINT_DATA, &err) != TC_OK)
        fail_msg("%s", err.text);
}

/* Light falls on the colours of the second field, of surfaces too. */
static void colors_of_another_field_differ_from_the_reference(void **state)
{
    (void)state;
    static const tc_knot map[4] = {{-0.5, 1, 0, 0, 5}, {0.1, 0, 1, 0, 0}, {0.1, 0, 0, 1, 0}, {0.9, 1, 1, 0, 2}};
    static const tc_iso iso[2] = {{.value = 0.15, .opacity = 0.5},
                                  {.value = 0.4, .opacity = 0.8, .has_color = true, .color = {1, 0.9, 0.2}}};
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA);
    tc_transfer *colors = suite_function(map, 4);
    double value[POINTS];
    tc_field *field = NULL;
    tc_error err = {0};
    at_points(value, saddle);
    if (tc_field_create(&field, mesh, value, TC_POINT_DATA, "other", &err) != TC_OK)
        fail_msg("%s", err.text);
    const tc_look look = {.color_field = field,
                          .color_function = colors,
                          .n_iso = 2,
                          .iso = iso,
                          .shade = shade_of(TC_GRADIENT_VERTEX, false, false, 1)};
    check("colours of another field", mesh, &look, 0);
    tc_field_destroy(&field);
    tc_transfer_destroy(&colors);
    tc_mesh_destroy(&mesh);
}

static void gaps_differ_from_the_reference(void **state)
{
    (void)state;
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 1500, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        tc_transfer *tf = suite_benchmark(mesh);
        const tc_look look = {.shade = shade_of(TC_GRADIENT_VERTEX, false, false, 1)};
        tc_camera camera = suite_camera(mesh, 0.6, 0.8 * way, 1 - 2 * way, way);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.look = &look;
        options.steps_per_pass = way ? 0 : 7;
        suite_check(way ? "peeled" : "gaps filled", mesh, tf, &camera, &options);
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

static void missing_values_differ_from_the_reference(void **state)
{
    (void)state;
    static const double violet[4] = {0.6, 0.1, 0.9, 0.7};
    double value[POINTS];
    at_points(value, bowl);
    for (int i = 3; i < POINTS; i += 29)
        value[i] = i % 2 ? NAN : INFINITY;
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA);
    set_values(mesh, value);
    tc_transfer *tf = suite_function(hills, 5);
    for (int way = 0; way < 2; way++) {
        const tc_look look = {.shade = shade_of(way ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX, false, false, 1)};
        tc_camera camera = suite_camera(mesh, 0.3, 0.5, 1, false);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.2;
        options.look = &look;
        options.has_nan_color = way;
        memcpy(options.nan_color, violet, sizeof violet);
        suite_check("missing values", mesh, tf, &camera, &options);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* Rays that end early are many to a group, and end one after another. */
static void what_is_left_is_lit_as_another_ray(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5);
    for (int way = 0; way < 2; way++) {
        const tc_look look = {.shade = shade_of(way ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX, false, false, 1)};
        tc_camera camera = suite_camera(mesh, 0.3, 0.5, 1, false);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.1;
        options.opacity_stop = 0.7;
        options.integrator = TC_INTEGRATOR_INTEGRAL;
        options.look = &look;
        tc_image *together = suite_render(NULL, mesh, tf, &camera, &options);
        options.steps_per_pass = 1;
        tc_image *apart = suite_render(NULL, mesh, tf, &camera, &options);
        suite_say("rays of a group: %.2g apart", suite_difference(together, apart));
        assert_true(suite_difference(together, apart) < 1e-5);
        tc_image_destroy(&together);
        tc_image_destroy(&apart);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void several_rays_a_pixel_differ_from_the_reference(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5);
    const tc_look look = {.shade = shade_of(TC_GRADIENT_VERTEX, false, false, 1)};
    tc_camera camera = suite_camera(mesh, 0.3, 0.5, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.unit_distance = 0.2;
    options.look = &look;
    options.samples = 4;
    suite_check("4 rays a pixel", mesh, tf, &camera, &options);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* ------------------------------------------------------------------------------------------------- what is there */

static void new_values_are_lit_by_old_gradients(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA), *other = look_box(SIDE, saddle, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5);
    tc_look look = {.shade = shade_of(TC_GRADIENT_VERTEX, false, false, 1)};
    tc_camera camera = suite_camera(mesh, 0.3, 0.5, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.look = &look;
    tc_image *before = suite_render(NULL, mesh, tf, &camera, &options);
    double value[POINTS];
    at_points(value, saddle);
    set_values(mesh, value);
    tc_image *after = suite_render(NULL, mesh, tf, &camera, &options);
    tc_image *fresh = suite_render(NULL, other, tf, &camera, &options);
    assert_true(suite_difference(after, fresh) == 0);
    assert_true(suite_difference(after, before) > 0.05);
    look.shade.gradient = TC_GRADIENT_CELL;
    tc_image *flat = suite_render(NULL, other, tf, &camera, &options);
    assert_true(suite_difference(flat, fresh) > 0.01);
    tc_image_destroy(&before);
    tc_image_destroy(&after);
    tc_image_destroy(&fresh);
    tc_image_destroy(&flat);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&other);
    tc_mesh_destroy(&mesh);
}

/* No slope, no normal: colours as they are. */
static void level_values_are_lit(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(SIDE, level, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 1);
    tc_camera camera = suite_camera(mesh, 0.3, 0.5, 1, false);
    for (int way = 0; way < 4; way++) {
        const tc_look look = {.shade =
                                  shade_of(way & 1 ? TC_GRADIENT_CELL : TC_GRADIENT_VERTEX, false, false, way & 2)};
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.integrator = TC_INTEGRATOR_EXACT;
        tc_image *plain = suite_render(NULL, mesh, tf, &camera, &options);
        options.look = &look;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        assert_true(suite_difference(plain, image) < 1e-6);
        tc_image_destroy(&plain);
        tc_image_destroy(&image);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void a_table_is_lit_by_halves(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        return;
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5);
    const tc_look look = {.shade = shade_of(TC_GRADIENT_CELL, false, false, 1)};
    tc_camera camera = suite_camera(mesh, 0.3, 0.5, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.look = &look;
    options.integrator = TC_INTEGRATOR_TABLE;
    tc_error err = {0};
    assert_int_equal(suite_try_render(mesh, tf, &camera, &options, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "'integral'"));
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void light_that_falls_on_nothing_is_paid_for(void **state)
{
    (void)state;
    static const tc_iso iso = {.value = 0.2, .opacity = 1};
    static const struct {
        tc_gradient gradient;
        bool volume, surfaces;
        int n_iso;
        double bytes;
        const char *effects;
    } row[] = {
        {TC_GRADIENT_NONE, true, true, 0, 0, "density-emitter"},
        {TC_GRADIENT_CELL, false, true, 0, 0, "density-emitter"},
        {TC_GRADIENT_CELL, true, true, 0, 16.0 * TETS, "density-emitter, lights, gradients, shade"},
        {TC_GRADIENT_VERTEX, true, false, 0, 16.0 * POINTS, "density-emitter, lights, gradients, shade"},
        {TC_GRADIENT_VERTEX, true, false, 1, 16.0 * POINTS, "density-emitter, lights, gradients, shade, isosurfaces"},
        {TC_GRADIENT_CELL, false, true, 1, 16.0 * TETS,
         "density-emitter, lights, gradients, isosurfaces, shade-isosurfaces"},
        {TC_GRADIENT_NONE, true, true, 1, 0, "density-emitter, isosurfaces"},
    };
    if (!suite_is_gpu())
        return;
    tc_mesh *mesh = look_box(SIDE, bowl, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5);
    tc_camera camera = suite_camera(mesh, 0.2, 0.3, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_render_stats plain, stats;
    tc_image *a = suite_render(&plain, mesh, tf, &camera, &options);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_look look = {.n_iso = row[i].n_iso, .iso = &iso, .shade = shade_of(row[i].gradient, true, false, 1)};
        look.shade.volume = row[i].volume;
        look.shade.surfaces = row[i].surfaces;
        options.look = &look;
        tc_image *b = suite_render(&stats, mesh, tf, &camera, &options);
        assert_string_equal(stats.effects, row[i].effects);
        assert_true(stats.gpu_bytes_other - plain.gpu_bytes_other == row[i].bytes);
        assert_true(i >= 2 || suite_difference(a, b) == 0);
        tc_image_destroy(&b);
    }
    tc_image_destroy(&a);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_ramp_is_lit_otherwise),
        cmocka_unit_test(a_plane_of_one_value_is_lit_otherwise),
        cmocka_unit_test(points_differ_from_the_reference),
        cmocka_unit_test(cells_differ_from_the_reference),
        cmocka_unit_test(surfaces_in_matter_differ_from_the_reference),
        cmocka_unit_test(colors_of_another_field_differ_from_the_reference),
        cmocka_unit_test(gaps_differ_from_the_reference),
        cmocka_unit_test(missing_values_differ_from_the_reference),
        cmocka_unit_test(what_is_left_is_lit_as_another_ray),
        cmocka_unit_test(several_rays_a_pixel_differ_from_the_reference),
        cmocka_unit_test(new_values_are_lit_by_old_gradients),
        cmocka_unit_test(level_values_are_lit),
        cmocka_unit_test(a_table_is_lit_by_halves),
        cmocka_unit_test(light_that_falls_on_nothing_is_paid_for),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
