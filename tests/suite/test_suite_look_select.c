/* test_suite_look_select.c: cells that a selection does not keep are not seen, and the others are as they were. */
#include "look.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 48, HEIGHT = 40, PIXELS = WIDTH * HEIGHT, N = 6, SIDE = N + 1 };

static const double KAPPA = 3; /* per unit length */
static const tc_knot fog[1] = {{0, 0.8, 0.6, 0.4, 1}};
static const tc_knot steep[4] = {
    {0, 0.1, 0.2, 0.9, 0.2}, {0.4, 0.9, 0.1, 0.3, 3}, {0.6, 0.3, 0.9, 0.2, 0.4}, {1, 1, 1, 0, 2}};

static double wave(const double *x)
{
    return 0.5 + 0.3 * sin(9 * x[0] + 4 * x[1]) * cos(7 * x[2] - 3 * x[1]) + 0.15 * x[0];
}

/* Of the vertices of look_box in their order: x or y; with what is missing beyond z = 0.8. */
static tc_field *axis_field(const tc_mesh *mesh, int axis, bool hole)
{
    double value[SIDE * SIDE * SIDE];
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        const int at[3] = {i % SIDE, i / SIDE % SIDE, i / SIDE / SIDE};
        value[i] = hole && at[2] > 0.8 * N ? NAN : (double)at[axis] / N;
    }
    tc_field *field;
    tc_error err = {0};
    if (tc_field_create(&field, mesh, value, TC_POINT_DATA, "axis", &err) != TC_OK)
        fail_msg("%s", err.text);
    return field;
}

/* Alpha of constant matter in what planes keep of the box, which is what the selection should keep. */
static void check_kept(const char *what, const tc_mesh *mesh, const tc_look *look, const tc_plane *plane, int n)
{
    static const double direction_of[3][3] = {{0.3, 0.5, 1}, {1, 0.2, 0.1}, {-0.7, 0.3, -0.4}};
    tc_transfer *tf = suite_function(fog, 1);
    double worst = 0;
    int seen = 0;
    for (int v = 0; v < 3; v++) {
        const double *d = direction_of[v];
        const tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], v == 1);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 1 / KAPPA;
        options.opacity_stop = 1;
        options.look = look;
        options.steps_per_pass = v == 1 ? 3 : 0;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        for (int i = 0; i < PIXELS; i++) {
            double origin[3], direction[3], t[2];
            suite_ray(origin, direction, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
            seen += look_chord(t, origin, direction, plane, n);
            worst = fmax(worst, fabs(image->rgba[4 * i + 3] - (1 - exp(-KAPPA * (t[1] - t[0])))));
        }
        tc_image_destroy(&image);
    }
    suite_say("%s: alpha of what is kept is off by %.2g at most", what, worst);
    assert_true(seen > 100);
    assert_true(worst < 2e-5);
    tc_transfer_destroy(&tf);
}

static void other_cells_are_kept(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(N, wave, TC_POINT_DATA);
    tc_field *x = axis_field(mesh, 0, false), *y = axis_field(mesh, 1, true);
    /* Ends are included: whole cubes from 1/6 to 4/6; a cell across two ranges lies in neither. */
    const double ranges[2][2] = {{1.0 / N - 1e-9, 3.0 / N + 1e-9}, {3.0 / N - 1e-9, 4.0 / N + 1e-9}},
                 low[1][2] = {{-1, 0.5 + 1e-9}};
    const tc_select select[2] = {{.field = x, .n_range = 2, .range = ranges}, {.field = y, .n_range = 1, .range = low}};
    const tc_plane plane[4] = {
        {{1, 0, 0}, 1.0 / N}, {{-1, 0, 0}, -4.0 / N}, {{0, -1, 0}, -0.5}, {{0, 0, -1}, -4.0 / N}};
    const tc_look one = {.n_select = 1, .select = select}, both = {.n_select = 2, .select = select};
    check_kept("a field along x", mesh, &one, plane, 2);
    check_kept("two fields, one with a hole", mesh, &both, plane, 4);
    check_kept("again the first one", mesh, &one, plane, 2); /* the mask that is there is not the one */
    tc_field_destroy(&x);
    tc_field_destroy(&y);
    tc_mesh_destroy(&mesh);
}

/* The mask follows the mesh's values. */
static void old_values_select(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(N, wave, TC_POINT_DATA);
    double value[SIDE * SIDE * SIDE];
    const double low[1][2] = {{-1, 0.5 + 1e-9}};
    const tc_select select = {.n_range = 1, .range = low};
    const tc_look look = {.n_select = 1, .select = &select};
    for (int axis = 0; axis < 2; axis++) {
        const tc_plane plane = {{axis == 0 ? -1 : 0, axis == 1 ? -1 : 0, 0}, -0.5};
        tc_error err = {0};
        for (int i = 0; i < SIDE * SIDE * SIDE; i++)
            value[i] = (double)(axis == 0 ? i % SIDE : i / SIDE % SIDE) / N;
        assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_POINT_DATA, &err), TC_OK);
        check_kept("new values", mesh, &look, &plane, 1);
    }
    tc_mesh_destroy(&mesh);
}

static void what_is_kept_looks_different(void **state)
{
    (void)state;
    const double ranges[2][2] = {{0.1, 0.5}, {0.45, 0.7}};
    const tc_select select = {.n_range = 2, .range = ranges};
    const tc_iso iso = {.value = 0.52, .opacity = 0.6};
    const struct {
        const char *mesh;
        tc_reentry reentry;
        tc_look look;
    } c[] = {
        {NULL, TC_REENTRY_AUTO, {.n_select = 1, .select = &select}},
        {NULL, TC_REENTRY_AUTO, {.n_select = 1, .select = &select, .model = TC_MODEL_MAXIMUM}},
        {NULL, TC_REENTRY_AUTO, {.n_select = 1, .select = &select, .n_iso = 1, .iso = &iso}},
        {"comb", TC_REENTRY_PEEL, {.n_select = 1, .select = &select}},
        {"comb", TC_REENTRY_CONVEXIFY, {.n_select = 1, .select = &select, .model = TC_MODEL_EMISSION}},
    };
    tc_transfer *tf = suite_function(steep, 4);
    for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
        tc_mesh *mesh = c[i].mesh ? suite_synth(c[i].mesh, 3000, c[i].reentry) : look_box(N, wave, TC_POINT_DATA);
        const tc_camera camera = suite_camera(mesh, 0.4, 0.3, 1, false);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.3;
        options.look = &c[i].look;
        suite_check(c[i].mesh ? c[i].mesh : "wave", mesh, tf, &camera, &options);
        tc_mesh_destroy(&mesh);
    }
    tc_transfer_destroy(&tf);
}

static void a_selection_is_paid_for_where_all_is_kept(void **state)
{
    (void)state;
    const double all[1][2] = {{-5, 5}}, some[1][2] = {{0.3, 5}};
    tc_mesh *mesh = look_box(N, wave, TC_POINT_DATA);
    tc_transfer *tf = suite_function(steep, 4);
    const tc_camera camera = suite_camera(mesh, 0.4, 0.3, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_select select = {.n_range = 1, .range = some};
    const tc_look look = {.n_select = 1, .select = &select};
    tc_render_stats plain, stats;
    tc_image *a = suite_render(&plain, mesh, tf, &camera, &options);
    options.look = &look;
    tc_image *b = suite_render(&stats, mesh, tf, &camera, &options);
    assert_true(suite_difference(a, b) > 0.01);
    if (suite_is_gpu()) {
        assert_string_equal(stats.effects, "density-emitter, select");
        assert_true(stats.gpu_bytes_other - plain.gpu_bytes_other == (6 * N * N * N + 31) / 32 * 4);
        assert_true(stats.gpu_bytes_sent == 0);
    }
    tc_image_destroy(&b);
    select.range = all;
    b = suite_render(&stats, mesh, tf, &camera, &options);
    assert_true(suite_difference(a, b) == 0);
    if (suite_is_gpu()) {
        assert_string_equal(stats.effects, "density-emitter");
        assert_true(stats.gpu_bytes_other == plain.gpu_bytes_other);
    }
    tc_image_destroy(&a);
    tc_image_destroy(&b);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(other_cells_are_kept),
        cmocka_unit_test(old_values_select),
        cmocka_unit_test(what_is_kept_looks_different),
        cmocka_unit_test(a_selection_is_paid_for_where_all_is_kept),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
