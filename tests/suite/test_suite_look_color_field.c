/* test_suite_look_color_field.c: colour by a second field is not that field's, or is paid for without being asked for.
 */
#include "look.h"

#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 72,
    HEIGHT = 64,
    SIDE = 5,
    POINTS = (SIDE + 1) * (SIDE + 1) * (SIDE + 1),
    TETS = 6 * SIDE * SIDE * SIDE
};

static double slope(const double *x)
{
    return x[0] + 0.4 * x[1] * x[1];
}

static double other(const double *x)
{
    return 10 * (x[2] - 0.3 * x[0] * x[1]);
}

static const struct view {
    double direction[3];
    bool parallel;
} views[] = {{{1, 0.3, 0.2}, false}, {{-0.2, 0.1, -1}, true}, {{-0.7, 0.3, 0.4}, false}};
enum { N_VIEW = sizeof views / sizeof *views };

static const tc_knot hills[5] = {
    {0.1, 0, 0, 1, 0}, {0.4, 0, 1, 0, 0.8}, {0.6, 1, 0.5, 0, 0.1}, {0.6, 0.2, 0.5, 1, 0.7}, {1.2, 1, 1, 1, 1},
};

/* The box's points as look_box has them. */
static double *at_points(double (*field)(const double *x))
{
    double *value = malloc(POINTS * sizeof *value);
    assert_non_null(value);
    for (int i = 0; i < POINTS; i++) {
        const int n = SIDE + 1;
        const double x[3] = {(double)(i % n) / SIDE, (double)(i / n % n) / SIDE, (double)(i / n / n) / SIDE};
        value[i] = field(x);
    }
    return value;
}

static tc_field *make_field(const tc_mesh *mesh, const double *value, tc_association association)
{
    tc_field *field = NULL;
    tc_error err = {0};
    if (tc_field_create(&field, mesh, value, association, "other", &err) != TC_OK)
        fail_msg("%s", err.text);
    return field;
}

/* The same field and function for both: the plain picture. */
static void a_field_colors_itself_otherwise(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(SIDE, slope, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5);
    double *value = at_points(slope);
    tc_field *field = make_field(mesh, value, TC_POINT_DATA);
    const tc_plane plane = {{1, 0.2, 0.4}, 0.45};
    for (int v = 0; v < N_VIEW; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_look plain = {.n_plane = v == 1, .plane = &plane}, look = plain;
        look.color_field = field;
        look.color_function = tf;
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.integrator = TC_INTEGRATOR_EXACT;
        options.unit_distance = 0.2;
        options.look = &plain;
        tc_image *a = suite_render(NULL, mesh, tf, &camera, &options);
        options.look = &look;
        options.steps_per_pass = v == 2 ? 5 : 0;
        tc_image *b = suite_render(NULL, mesh, tf, &camera, &options);
        double difference = suite_difference(a, b);
        suite_say("coloured by itself: %.2g apart", difference);
        assert_true(difference < 1e-4);
        tc_image_destroy(&a);
        tc_image_destroy(&b);
    }
    tc_field_destroy(&field);
    free(value);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void two_fields_differ_from_the_reference(void **state)
{
    (void)state;
    static const tc_knot map[4] = {{-2, 1, 0, 0, 5}, {3, 0, 1, 0, 0}, {3, 0, 0, 1, 0}, {9, 1, 1, 0, 2}};
    tc_mesh *mesh = look_box(SIDE, slope, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5), *colors = suite_function(map, 4);
    double *value = at_points(other);
    tc_field *field = make_field(mesh, value, TC_POINT_DATA);
    const tc_iso iso[2] = {{.value = 0.5, .opacity = 0.6}, {.value = 0.9, .opacity = 0.5, .has_color = true}};
    for (int v = 0; v < N_VIEW; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_look look = {.color_field = field, .color_function = colors, .n_iso = v, .iso = iso};
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.2;
        options.look = &look;
        suite_check("two fields of points", mesh, tf, &camera, &options);
        look.model = TC_MODEL_SURFACES;
        if (v > 0)
            suite_check("surfaces coloured by another field", mesh, tf, &camera, &options);
    }
    tc_field_destroy(&field);
    free(value);
    tc_transfer_destroy(&colors);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* Materials: a colour a cell, crisp. */
static void materials_run_into_each_other(void **state)
{
    (void)state;
    static const tc_knot map[6] = {{0.5, 1, 0, 0, 0}, {0.5, 0, 1, 0, 0}, {1.5, 0, 1, 0, 0},
                                   {1.5, 0, 0, 1, 0}, {2.5, 0, 0, 1, 0}, {2.5, 1, 1, 0, 0}};
    tc_mesh *mesh = look_box(SIDE, slope, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5), *colors = suite_function(map, 6);
    double value[TETS];
    for (int i = 0; i < TETS; i++)
        value[i] = i / 7 % 4;
    tc_field *field = make_field(mesh, value, TC_CELL_DATA);
    const tc_look look = {.color_field = field, .color_function = colors};
    for (int v = 0; v < N_VIEW; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.2;
        options.look = &look;
        suite_check("a colour a cell", mesh, tf, &camera, &options);
    }
    tc_field_destroy(&field);
    tc_transfer_destroy(&colors);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void bytes_of_another_field_are_there_without_one(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        return;
    tc_mesh *mesh = look_box(SIDE, slope, TC_POINT_DATA);
    tc_transfer *tf = suite_function(hills, 5);
    double *value = at_points(other);
    tc_field *field = make_field(mesh, value, TC_POINT_DATA);
    tc_camera camera = suite_camera(mesh, 1, 0.2, 0.3, false);
    tc_look look = {.color_field = field, .color_function = tf};
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_render_stats stats[3];
    for (int i = 0; i < 3; i++) {
        options.look = i == 1 ? &look : NULL;
        tc_image *image = suite_render(&stats[i], mesh, tf, &camera, &options);
        tc_image_destroy(&image);
    }
    assert_string_equal(stats[1].effects, "density-emitter, color-field");
    assert_true(stats[1].gpu_bytes_other >= stats[0].gpu_bytes_other + 4.0 * POINTS);
    assert_true(stats[2].gpu_bytes_other == stats[0].gpu_bytes_other);
    tc_field_destroy(&field);
    free(value);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_field_colors_itself_otherwise),
        cmocka_unit_test(two_fields_differ_from_the_reference),
        cmocka_unit_test(materials_run_into_each_other),
        cmocka_unit_test(bytes_of_another_field_are_there_without_one),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
