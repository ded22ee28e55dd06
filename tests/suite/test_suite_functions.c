/* test_suite_functions.c: transfer functions and data out of the ordinary, cell data, new values: the default
 * integrator against the reference. */
#include "suite.h"

#include "tests/common/sane.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 96 };

/* A function on the kuhn field (linear, 0 to 1) and on the ball's (curved). All that it is asked for is said before the
 * test ends with the worst. */
static void check_function(const char *what, const tc_transfer *tf)
{
    double worst = 0;
    tc_mesh *kuhn = suite_synth("kuhn", 4000, TC_REENTRY_AUTO), *ball = suite_synth("ball", 6000, TC_REENTRY_AUTO);
    const tc_mesh *mesh[2] = {kuhn, ball};
    for (int i = 0; i < 2; i++) {
        tc_camera camera = suite_camera(mesh[i], 0.6, 0.4, 1, false);
        const tc_render_options options = suite_options(SIZE, SIZE);
        char text[96];
        snprintf(text, sizeof text, "%s, %s", what, i ? "ball" : "kuhn");
        tc_image *image = suite_render(NULL, mesh[i], tf, &camera, &options);
        worst =
            fmax(worst, suite_verify(text, INFINITY, SIZE_MAX, image, mesh[i], tf, &camera, &options).max_abs_error);
        tc_image_destroy(&image);
    }
    tc_mesh_destroy(&kuhn);
    tc_mesh_destroy(&ball);
    if (!(worst <= SUITE_HALF_STEP))
        fail_msg("%s: error %.3e exceeds half an 8-bit step", what, worst);
}

static void check_knots(const char *what, const tc_knot *knot, size_t n)
{
    tc_transfer *tf = suite_function(knot, n);
    check_function(what, tf);
    tc_transfer_destroy(&tf);
}

static void a_function_narrower_than_the_data_is_wrong(void **state)
{
    (void)state;
    static const tc_knot knot[] = {{0.4, 0.1, 0.2, 0.9, 0.05}, {0.5, 0.9, 0.8, 0.1, 0.4}, {0.6, 0.8, 0.1, 0.1, 0.2}};
    check_knots("narrower", knot, 3);
}

static void a_function_beside_the_data_is_wrong(void **state)
{
    (void)state;
    static const tc_knot beside[] = {{5, 0.1, 0.2, 0.9, 0.1}, {6, 0.9, 0.8, 0.1, 0.9}};
    check_knots("beside the data", beside, 2);
}

static void a_function_of_a_thousandth_of_the_data_is_wrong(void **state)
{
    (void)state;
    static const tc_knot tiny[] = {{0.5, 0.1, 0.2, 0.9, 0.1}, {0.501, 0.9, 0.8, 0.1, 0.4}};
    check_knots("a thousandth of the data", tiny, 2);
}

static void a_function_wider_than_the_data_is_wrong(void **state)
{
    (void)state;
    static const tc_knot knot[] = {{-10, 0.1, 0.2, 0.9, 0}, {0.3, 0.9, 0.8, 0.1, 0.1}, {12, 0.8, 0.1, 0.1, 5}};
    check_knots("wider", knot, 3);
}

static void a_step_is_blurred(void **state)
{
    (void)state;
    static const tc_knot one[] = {
        {0, 0.1, 0.2, 0.9, 0.02}, {0.5, 0.1, 0.2, 0.9, 0.02}, {0.5, 0.9, 0.2, 0.1, 0.5}, {1, 0.9, 0.2, 0.1, 0.5}};
    check_knots("one step", one, 4);
}

static void a_step_where_the_function_ends_goes_beyond(void **state)
{
    (void)state;
    static const tc_knot box[] = {
        {0.3, 0.1, 0.2, 0.9, 0}, {0.3, 0.1, 0.2, 0.9, 0.5}, {0.6, 0.9, 0.2, 0.1, 0.5}, {0.6, 1, 1, 1, 0}};
    check_knots("a box within the data", box, 4);
    check_knots("a step at the lower end", box, 3);
    check_knots("a step at the upper end", box + 1, 3);
}

static void many_steps_are_blurred(void **state)
{
    (void)state;
    tc_knot many[20];
    for (int i = 0; i < 10; i++) {
        const double c = i % 2, a = i % 3 ? 0.3 : 0.01;
        many[2 * i] = (tc_knot){0.1 * i, c, 1 - c, 0.5, a};
        many[2 * i + 1] = (tc_knot){0.1 * (i + 1), c, 1 - c, 0.5, a};
    }
    check_knots("ten steps", many, 20);
}

static void a_spike_of_a_500th_is_missed(void **state)
{
    (void)state;
    static const tc_knot wide[] = {
        {0, 0, 0, 1, 0.01}, {0.498, 0, 0, 1, 0.01}, {0.499, 1, 0.5, 0, 5}, {0.5, 0, 0, 1, 0.01}, {1, 0, 0, 1, 0.01}};
    check_knots("spike of a 500th", wide, 5);
}

static void a_spike_of_a_10000th_is_missed(void **state)
{
    (void)state;
    static const tc_knot narrow[] = {{0, 0, 0, 1, 0.01},
                                     {0.4999, 0, 0, 1, 0.01},
                                     {0.49995, 1, 0.5, 0, 20},
                                     {0.5, 0, 0, 1, 0.01},
                                     {1, 0, 0, 1, 0.01}};
    check_knots("spike of a 10000th", narrow, 5);
}

static void a_single_knot_is_not_constant(void **state)
{
    (void)state;
    static const tc_knot one[] = {{0.5, 0.9, 0.6, 0.3, 0.1}};
    check_knots("one knot", one, 1);
}

static void a_function_of_no_width_is_wrong(void **state)
{
    (void)state;
    static const tc_knot coincident[] = {{0.5, 0.9, 0.6, 0.3, 0.1}, {0.5, 0.1, 0.6, 0.9, 0.3}};
    check_knots("a range of no width", coincident, 2);
}

static void an_opaque_medium_is_wrong(void **state)
{
    (void)state;
    static const tc_knot opaque[] = {{0, 1, 0, 0, 1e6}, {0.5, 0, 1, 0, 1e6}, {1, 0, 0, 1, 1e6}};
    check_knots("opaque in a millionth of a cell", opaque, 3);
}

static void a_thin_medium_is_wrong(void **state)
{
    (void)state;
    static const tc_knot thin[] = {{0, 1, 0, 0, 1e-6}, {0.5, 0, 1, 0, 2e-6}, {1, 0, 0, 1, 1e-6}};
    check_knots("almost nothing", thin, 3);
    static const tc_knot nothing[] = {{0, 1, 0, 0, 0}, {1, 0, 0, 1, 0}};
    check_knots("nothing", nothing, 2);
}

static void a_medium_from_nothing_to_opaque_is_wrong(void **state)
{
    (void)state;
    static const tc_knot mixed[] = {{0, 1, 0, 0, 0}, {0.45, 1, 0, 0, 0}, {0.55, 0, 1, 0, 100}, {1, 0, 0, 1, 1e-3}};
    check_knots("from nothing to opaque", mixed, 4);
}

static void many_knots_are_wrong(void **state)
{
    (void)state;
    enum { N = 10000 };
    tc_knot *knot = malloc(N * sizeof *knot);
    assert_non_null(knot);
    for (int i = 0; i < N; i++) {
        double s = (double)i / (N - 1);
        knot[i] = (tc_knot){s, 0.5 + 0.5 * sin(40 * s), 0.5 + 0.5 * cos(70 * s), s, 0.1 + 0.1 * sin(90 * s)};
    }
    check_knots("10000 knots", knot, N);
    free(knot);
}

static void built_in_maps_are_wrong(void **state)
{
    (void)state;
    static const char *const maps[] = {"Viridis", "Jet", "Grayscale"};
    for (int i = 0; i < 3; i++) {
        const tc_transfer_options options = {.color_map = maps[i],
                                             .opacity = i == 1 ? "sigmoid" : "geom",
                                             .data_range = {0, 1},
                                             .log = i == 2,
                                             .has_range = i == 2,
                                             .range = {0.01, 1}};
        tc_transfer *tf;
        tc_error err = {0};
        if (tc_transfer_create(&tf, &options, &err) != TC_OK)
            fail_msg("%s", err.text);
        check_function(maps[i], tf);
        tc_transfer_destroy(&tf);
    }
}

static void colours_exceed_what_alpha_allows(void **state)
{
    (void)state;
    static const tc_knot narrow[] = {{0.4, 0.1, 0.2, 0.9, 0.05}, {0.5, 0.9, 0.8, 0.1, 0.4}, {0.6, 0.8, 0.1, 0.1, 0.2}};
    static const tc_knot step[] = {
        {0, 0.1, 0.2, 0.9, 0.02}, {0.5, 0.1, 0.2, 0.9, 0.02}, {0.5, 0.9, 0.2, 0.1, 0.5}, {1, 0.9, 0.2, 0.1, 0.5}};
    static const tc_knot jump[] = {{0.5, 0.9, 0.6, 0.3, 0.1}, {0.5, 0.1, 0.6, 0.9, 0.3}};
    static const struct {
        const char *name;
        const tc_knot *knot;
        size_t n;
    } function[] = {{"narrow", narrow, 3}, {"step", step, 4}, {"jump", jump, 2}};
    tc_mesh *mesh = suite_synth("kuhn", 4000, TC_REENTRY_AUTO);
    double worst = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++) { /* from both sides */
            tc_transfer *tf = suite_function(function[i].knot, function[i].n);
            tc_camera camera = suite_camera(mesh, k ? -0.6 : 0.6, 0.4, k ? -1 : 1, false);
            const tc_render_options options = suite_options(SIZE, SIZE);
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
            double excess = picture_color_excess(image, tf, NULL);
            suite_say("%s: a colour exceeds alpha times the largest by %.1e", function[i].name, excess);
            worst = fmax(worst, excess);
            tc_image_destroy(&image);
            tc_transfer_destroy(&tf);
        }
    tc_mesh_destroy(&mesh);
    assert_true(worst <= 1e-5);
}

static void the_table_is_far_from_the_reference(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        skip(); /* it has one integrator */
    static const tc_table_format formats[] = {TC_TABLE_8, TC_TABLE_16F, TC_TABLE_32F};
    static const double bounds[] = {0.08, 2e-3, 2e-3}; /* 8 bits: the paper's, about 0.04 on smooth functions */
    tc_mesh *mesh = suite_synth("ball", 6000, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.6, 0.4, 1, false);
    for (int i = 0; i < 3; i++) {
        tc_render_options options = suite_options(SIZE, SIZE);
        options.integrator = TC_INTEGRATOR_TABLE;
        options.table_format = formats[i];
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        char what[64];
        snprintf(what, sizeof what, "table, %d bits", (int)formats[i]);
        suite_verify(what, bounds[i], SIZE_MAX, image, mesh, tf, &camera, &options);
        tc_image_destroy(&image);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* ------------------------------------------------------------------------------------------ data of other kinds */

static tc_mesh *two_tets(const double *scalar, tc_association association, tc_reentry reentry)
{
    static const double vertex[5][3] = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {2, 2, 2}};
    static const int32_t tet[2][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}};
    const tc_mesh_arrays arrays = {5, &vertex[0][0], 2, &tet[0][0], scalar, association, "field"};
    return suite_mesh(&arrays, reentry);
}

static void cell_data_are_not_crisp(void **state)
{
    (void)state;
    /* One cell absorbs, the other does not: 1 - exp(-l) with l the length in the first alone, whatever the colours. */
    static const double value[2] = {1, 0};
    static const tc_knot knot[] = {{0, 0, 0, 1, 0}, {1, 1, 0.5, 0, 1}};
    tc_mesh *mesh = two_tets(value, TC_CELL_DATA, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_function(knot, 2);
    tc_camera camera = {
        .position = {-5, -5, -5}, .focal_point = {0.5, 0.5, 0.5}, .view_up = {0, 1, 0}, .view_angle = 20};
    tc_render_options options = suite_options(65, 65);
    options.unit_distance = 1;
    options.opacity_stop = 1;
    tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
    /* The middle ray runs from (0,0,0) through the face x + y + z = 2 at (2/3, 2/3, 2/3). */
    const float *middle = image->rgba + 4 * (32 * 65 + 32);
    double alpha = 1 - exp(-2 / sqrt(3));
    const double expected[4] = {alpha, 0.5 * alpha, 0, alpha};
    for (int c = 0; c < 4; c++)
        assert_true(fabs(middle[c] - expected[c]) < 1e-5);
    suite_verify("two cells", 1e-4, SIZE_MAX, image, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void cell_data_of_a_whole_mesh_are_wrong(void **state)
{
    (void)state;
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 8000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        tc_mesh_report report;
        tc_mesh_get_report(&report, mesh);
        double *value = malloc(report.n_tet * sizeof *value);
        assert_non_null(value);
        for (size_t i = 0; i < report.n_tet; i++)
            value[i] = (double)((i * 2654435761u) % 1000) - 500;
        tc_error err = {0};
        if (tc_mesh_set_scalar(mesh, value, TC_CELL_DATA, &err) != TC_OK)
            fail_msg("%s", err.text);
        tc_transfer *tf = suite_benchmark(mesh);
        static const tc_integrator integrators[] = {TC_INTEGRATOR_AUTO, TC_INTEGRATOR_TABLE};
        for (int k = 0; k < (suite_is_gpu() ? 2 : 1); k++) {
            tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
            tc_render_options options = suite_options(SIZE, SIZE);
            options.integrator = integrators[k];
            tc_render_stats stats;
            tc_image *image = suite_render(&stats, mesh, tf, &camera, &options);
            suite_verify(k ? "cell data, table" : "cell data", k ? 5e-3 : SUITE_HALF_STEP, SIZE_MAX, image, mesh, tf,
                         &camera, &options);
            tc_image_destroy(&image);
        }
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
        free(value);
    }
}

static void constant_missing_or_broken_data_are_wrong(void **state)
{
    (void)state;
    static const double constant[5] = {7, 7, 7, 7, 7};
    static const double broken[5] = {NAN, 1, 2, 6, 3}; /* the first cell shows nothing, the second does */
    static const tc_knot knot[] = {{0, 0, 0, 1, 0.5}, {7, 1, 0.5, 0, 1}, {8, 0, 1, 0, 2}};
    const double *values[3] = {constant, NULL, broken};
    tc_transfer *tf = suite_function(knot, 3);
    for (int i = 0; i < 3; i++) {
        tc_mesh *mesh = two_tets(values[i], TC_POINT_DATA, TC_REENTRY_AUTO);
        tc_camera camera = suite_camera(mesh, 0.3, 0.2, 1, false);
        tc_render_options options = suite_options(65, 65);
        options.unit_distance = 1;
        static const char *const what[3] = {"constant data", "no data", "data with NaN and Inf"};
        suite_check(what[i], mesh, tf, &camera, &options);
        tc_mesh_destroy(&mesh);
    }
    tc_transfer_destroy(&tf);
}

static void constant_data_of_large_magnitude_are_wrong(void **state)
{
    (void)state;
    static const double value[] = {1e16, -1e300, 1.7e308};
    static const tc_integrator integrators[] = {TC_INTEGRATOR_AUTO, TC_INTEGRATOR_INTEGRAL, TC_INTEGRATOR_TABLE};
    for (int i = 0; i < 3; i++) {
        const tc_knot knot[] = {{value[i], 1, 0.5, 0, 0.7}};
        const double values[5] = {value[i], value[i], value[i], value[i], value[i]};
        tc_transfer *tf = suite_function(knot, 1);
        tc_mesh *mesh = two_tets(values, TC_POINT_DATA, TC_REENTRY_AUTO);
        tc_camera camera = suite_camera(mesh, 0.3, 0.2, 1, false);
        for (int k = 0; k < (suite_is_gpu() ? 3 : 1); k++) {
            tc_render_options options = suite_options(33, 33);
            options.unit_distance = 1;
            options.integrator = integrators[k];
            suite_check("constant data of large magnitude", mesh, tf, &camera, &options);
        }
        tc_mesh_destroy(&mesh);
        tc_transfer_destroy(&tf);
    }
}

/* The function is a step to float, rises too steeply for it, or acts over lengths that are no floats. */
static void functions_at_the_ends_of_float_are_wrong(void **state)
{
    (void)state;
    static const struct {
        const char *what;
        double unit_distance;
        tc_knot knot[3];
    } c[] = {
        {"a span of 1e-31", 1, {{0, 1, 0, 0, 0}, {1e-31, 0, 1, 0, 1}, {1e-31, 0, 1, 0, 1}}},
        {"a slope of 1e40", 1, {{0, 1, 0, 0, 0.5}, {1e-20, 1, 0, 0, 1e20}, {1, 1, 0, 0, 1e20}}},
        {"a unit of 1e-42", 1e-42, {{0, 1, 0, 0, 0}, {1, 1, 0, 0, 1}, {2, 1, 0, 0, 2}}},
    };
    static const double values[5] = {0, 1, 0, 1, 2};
    tc_mesh *mesh = two_tets(values, TC_POINT_DATA, TC_REENTRY_AUTO);
    tc_camera camera = suite_camera(mesh, 0.3, 0.2, 1, false);
    for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
        tc_transfer *tf = suite_function(c[i].knot, 3);
        tc_render_options options = suite_options(33, 33);
        options.unit_distance = c[i].unit_distance;
        suite_check(c[i].what, mesh, tf, &camera, &options);
        tc_transfer_destroy(&tf);
    }
    tc_mesh_destroy(&mesh);
}

static void new_values_are_not_seen(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("kuhn", 4000, TC_REENTRY_AUTO), *other = suite_synth("kuhn", 4000, TC_REENTRY_AUTO);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    double *value = malloc(report.n_vertex * sizeof *value);
    assert_non_null(value);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 1, 0.4, 0.7, false);
    const tc_render_options options = suite_options(SIZE, SIZE);
    tc_image *before = suite_render(NULL, mesh, tf, &camera, &options);
    for (int round = 0; round < 2; round++) { /* other values, then a wider range */
        for (size_t i = 0; i < report.n_vertex; i++)
            value[i] = round ? 3.0 * (double)(i % 17) - 20 : (double)(i % 11) / 10;
        tc_error err = {0};
        if (tc_mesh_set_scalar(mesh, value, TC_POINT_DATA, &err) != TC_OK)
            fail_msg("%s", err.text);
        tc_image *after = suite_render(NULL, mesh, tf, &camera, &options);
        assert_true(suite_difference(before, after) > 0.02);
        suite_verify("new values", SUITE_HALF_STEP, SIZE_MAX, after, mesh, tf, &camera, &options);
        tc_image_destroy(&after);
    }
    tc_image *unmoved = suite_render(NULL, other, tf, &camera, &options);
    assert_memory_equal(before->rgba, unmoved->rgba, SIZE * SIZE * 4 * sizeof(float));
    tc_image_destroy(&unmoved);
    tc_image_destroy(&before);
    free(value);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    tc_mesh_destroy(&other);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_function_narrower_than_the_data_is_wrong),
        cmocka_unit_test(a_function_beside_the_data_is_wrong),
        cmocka_unit_test(a_function_of_a_thousandth_of_the_data_is_wrong),
        cmocka_unit_test(a_function_wider_than_the_data_is_wrong),
        cmocka_unit_test(a_step_is_blurred),
        cmocka_unit_test(a_step_where_the_function_ends_goes_beyond),
        cmocka_unit_test(many_steps_are_blurred),
        cmocka_unit_test(a_spike_of_a_500th_is_missed),
        cmocka_unit_test(a_spike_of_a_10000th_is_missed),
        cmocka_unit_test(a_single_knot_is_not_constant),
        cmocka_unit_test(a_function_of_no_width_is_wrong),
        cmocka_unit_test(an_opaque_medium_is_wrong),
        cmocka_unit_test(a_thin_medium_is_wrong),
        cmocka_unit_test(a_medium_from_nothing_to_opaque_is_wrong),
        cmocka_unit_test(many_knots_are_wrong),
        cmocka_unit_test(built_in_maps_are_wrong),
        cmocka_unit_test(colours_exceed_what_alpha_allows),
        cmocka_unit_test(the_table_is_far_from_the_reference),
        cmocka_unit_test(cell_data_are_not_crisp),
        cmocka_unit_test(cell_data_of_a_whole_mesh_are_wrong),
        cmocka_unit_test(constant_missing_or_broken_data_are_wrong),
        cmocka_unit_test(constant_data_of_large_magnitude_are_wrong),
        cmocka_unit_test(functions_at_the_ends_of_float_are_wrong),
        cmocka_unit_test(new_values_are_not_seen),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
