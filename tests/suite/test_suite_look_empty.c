/* test_suite_look_empty.c: stepping through empty space changes no picture, and is done only where nearly all is empty.
 */
#include "look.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 56, HEIGHT = 48, PIXELS = WIDTH * HEIGHT, N = 14, SIDE = N + 1 };

/* A small thing in a large box: above 0.5 within 0.15 of its middle. */
static double blob(const double *x)
{
    const double d[3] = {x[0] - 0.63, x[1] - 0.41, x[2] - 0.55};
    return exp(-(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * 30);
}

static double blob_with_holes(const double *x)
{
    return x[0] > 0.97 && x[1] > 0.97 && x[2] > 0.97 ? NAN : blob(x);
}

static const tc_knot over_half[4] = {
    {0, 0.2, 0.9, 0.1, 0}, {0.5, 0.9, 0.2, 0.1, 0}, {0.7, 0.3, 0.9, 0.4, 4}, {1, 0.9, 1, 0.2, 9}};
static const tc_knot over_step[5] = {{0, 0.2, 0.9, 0.1, 0},
                                     {0.55, 0.9, 0.2, 0.1, 0},
                                     {0.55, 0.9, 0.2, 0.8, 5},
                                     {0.8, 0.3, 0.9, 0.4, 0},
                                     {1, 0.9, 1, 0.2, 0}};

static tc_render_options options_of(const tc_look *look, int steps)
{
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.unit_distance = 0.3;
    options.steps_per_pass = steps;
    options.look = look;
    return options;
}

static tc_camera camera_of(const tc_mesh *mesh, bool inside)
{
    tc_camera camera = suite_camera(mesh, 0.4, 0.3, 1, false);
    const double eye[3] = {0.33, 0.35, 0.8}, at[3] = {0.63, 0.41, 0.55};
    if (inside) {
        memcpy(camera.position, eye, sizeof eye);
        memcpy(camera.focal_point, at, sizeof at);
        camera.view_angle = 60;
    }
    return camera;
}

/* The picture, of a scene in which empty space is stepped through or not, and is that of all cells. */
static void check(const char *what, bool wanted, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                  const tc_render_options *options)
{
    tc_render_options all = *options;
    tc_render_stats stats, without;
    all.without = " empty-space ";
    tc_image *a = suite_render(&stats, mesh, tf, camera, options), *b = suite_render(&without, mesh, tf, camera, &all);
    double difference = suite_difference(a, b);
    size_t covered = 0;
    for (int i = 0; i < PIXELS; i++)
        covered += a->rgba[4 * i + 3] > 0.01f || a->rgba[4 * i] > 0.01f;
    if (!(difference < 1e-6) || covered < 40)
        fail_msg("%s: %zu pixels are covered, and differ by %g", what, covered, difference);
    suite_verify(what, SUITE_HALF_STEP, 300, a, mesh, tf, camera, options);
    if (suite_is_gpu()) {
        if ((strstr(stats.effects, "empty-space") != NULL) != wanted || strstr(without.effects, "empty-space"))
            fail_msg("%s: in force are %s; %s", what, stats.effects, without.effects);
        assert_true((stats.gpu_bytes_other > without.gpu_bytes_other) == wanted);
        assert_true(stats.passes == without.passes);
    }
    tc_image_destroy(&a);
    tc_image_destroy(&b);
}

static void empty_space_is_seen(void **state)
{
    (void)state;
    tc_mesh *point = look_box(N, blob, TC_POINT_DATA), *cell = look_box(N, blob, TC_CELL_DATA);
    tc_transfer *tf = suite_function(over_half, 4), *step = suite_function(over_step, 5);
    const tc_camera camera = camera_of(point, false), inside = camera_of(point, true);
    const tc_plane plane = {{-1, 0.2, 0.1}, -0.6};
    const tc_look emission = {.model = TC_MODEL_EMISSION}, xray = {.model = TC_MODEL_XRAY},
                  clipped = {.n_plane = 1, .plane = &plane};
    const double range[1][2] = {{-1, 0.75}};
    const tc_select select = {.n_range = 1, .range = range};
    const tc_look selected = {.n_select = 1, .select = &select};
    tc_render_options options = options_of(&selected, 0);
    check("without the densest cells", true, point, tf, &camera, &options);
    options = options_of(NULL, 0);
    check("points", true, point, tf, &camera, &options);
    check("a step, the eye inside", true, point, step, &inside, &options);
    check("cells", true, cell, tf, &camera, &options);
    options = options_of(&clipped, 7);
    check("clipped, in passes of 7 steps", true, point, tf, &camera, &options);
    options = options_of(&emission, 1);
    check("emission, in passes of a step", true, point, tf, &camera, &options);
    options = options_of(&xray, 0);
    options.integrator = TC_INTEGRATOR_EXACT;
    check("X-ray, piece by piece", true, point, tf, &camera, &options);
    tc_transfer_destroy(&tf);
    tc_transfer_destroy(&step);
    tc_mesh_destroy(&point);
    tc_mesh_destroy(&cell);
}

static void missing_values_are_empty(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(N, blob_with_holes, TC_POINT_DATA);
    tc_transfer *tf = suite_function(over_half, 4);
    const tc_camera camera = camera_of(mesh, false);
    const double violet[4] = {0.6, 0.1, 0.9, 0.7};
    tc_render_options options = options_of(NULL, 0);
    options.has_nan_color = true;
    memcpy(options.nan_color, violet, sizeof violet);
    check("cells without values", true, mesh, tf, &camera, &options);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* The mask follows function and values. */
static void another_function_or_value_is_taken_for_this_one(void **state)
{
    (void)state;
    static const tc_knot fog[2] = {{0, 0.2, 0.9, 0.1, 0.5}, {1, 0.9, 0.2, 0.1, 0.6}};
    static const tc_knot low[3] = {{0, 0.2, 0.9, 0.1, 4}, {0.5, 0.9, 0.2, 0.1, 0}, {1, 0.9, 0.2, 0.1, 0}};
    tc_mesh *mesh = look_box(N, blob, TC_POINT_DATA);
    tc_transfer *tf = suite_function(over_half, 4), *dense = suite_function(fog, 2), *turned = suite_function(low, 3);
    const tc_camera camera = camera_of(mesh, false);
    const tc_render_options options = options_of(NULL, 0);
    double *value = malloc(SIDE * SIDE * SIDE * sizeof *value);
    assert_non_null(value);
    check("over half", true, mesh, tf, &camera, &options);
    check("opaque all over", false, mesh, dense, &camera, &options);
    check("over half again", true, mesh, tf, &camera, &options);
    check("where nearly all is dense", false, mesh, turned, &camera, &options);
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        const double x[3] = {(double)(i % SIDE) / N, (double)(i / SIDE % SIDE) / N, (double)(i / SIDE / SIDE) / N};
        value[i] = 1 - blob(x);
    }
    tc_error err = {0};
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_POINT_DATA, &err), TC_OK);
    check("other values, for which it is not", true, mesh, turned, &camera, &options);
    check("… and where those were that are dense now", false, mesh, tf, &camera, &options);
    free(value);
    tc_transfer_destroy(&tf);
    tc_transfer_destroy(&dense);
    tc_transfer_destroy(&turned);
    tc_mesh_destroy(&mesh);
}

static void the_walk_goes_astray(void **state)
{
    (void)state;
    static tc_audit_ray a[PIXELS], b[PIXELS];
    if (!suite_is_gpu())
        skip();
    tc_mesh *mesh = look_box(N, blob, TC_POINT_DATA);
    tc_transfer *tf = suite_function(over_half, 4);
    const tc_camera camera = camera_of(mesh, false);
    tc_render_options options = options_of(NULL, 0);
    tc_render_stats stats, without;
    options.audit = true;
    tc_image *image = suite_render(&stats, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    suite_audit(a);
    options.without = " empty-space ";
    image = suite_render(&without, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    suite_audit(b);
    assert_non_null(strstr(stats.effects, "empty-space"));
    assert_true(stats.audit_broken == 0 && stats.steps == without.steps && stats.steps_max == without.steps_max);
    for (int i = 0; i < PIXELS; i++)
        assert_true(a[i].hash == b[i].hash && a[i].length == b[i].length && a[i].cells == b[i].cells);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void what_looks_at_empty_cells_misses_them(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(N, blob, TC_POINT_DATA);
    tc_transfer *tf = suite_function(over_half, 4);
    const tc_camera camera = camera_of(mesh, false);
    const tc_iso iso = {.value = 0.1, .opacity = 0.5};
    tc_look look[3] = {
        {.model = TC_MODEL_MAXIMUM}, {.n_iso = 1, .iso = &iso}, {.shade = {.gradient = TC_GRADIENT_NONE}}};
    tc_shade_defaults(&look[2].shade);
    look[2].shade.gradient = TC_GRADIENT_VERTEX;
    for (int i = 0; i < 3; i++) {
        const tc_render_options options = options_of(&look[i], 0);
        check("maximum, an isosurface, light", false, mesh, tf, &camera, &options);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(empty_space_is_seen),
        cmocka_unit_test(missing_values_are_empty),
        cmocka_unit_test(another_function_or_value_is_taken_for_this_one),
        cmocka_unit_test(the_walk_goes_astray),
        cmocka_unit_test(what_looks_at_empty_cells_misses_them),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
