/* test_cli_parts.c: parts of the program that can be judged without a picture. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/info_text.h"
#include "cli/input.h"
#include "cli/nearest.h"
#include "cli/picture/render_verify.h"
#include "cli/picture/render_view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void distance_counts_edits_and_swaps(void **state)
{
    (void)state;
    assert_int_equal(tc_name_distance("", ""), 0);
    assert_int_equal(tc_name_distance("render", "render"), 0);
    assert_int_equal(tc_name_distance("", "abc"), 3);
    assert_int_equal(tc_name_distance("abc", ""), 3);
    assert_int_equal(tc_name_distance("rendr", "render"), 1);
    assert_int_equal(tc_name_distance("redner", "render"), 1);
    assert_int_equal(tc_name_distance("kitten", "sitting"), 3);
    assert_int_equal(tc_name_distance("ab", "ba"), 1);
    assert_int_equal(tc_name_distance("ca", "abc"), 3); /* optimal string alignment: no edit between swapped letters */
    char a[200], b[200];
    memset(a, 'x', sizeof a);
    memset(b, 'y', sizeof b);
    a[199] = b[199] = 0;
    assert_int_equal(tc_name_distance(a, b), 63);
}

static void numbers_are_taken_whole_or_refused(void **state)
{
    (void)state;
    double value, list[4];
    int integer, n = 0;
    static const char *const bad[] = {"", "x", "1x", "1 ", "nan", "inf", "-inf", "1e999", "--1"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_false(tc_parse_real(&value, bad[i]));
        assert_false(tc_parse_int(&integer, bad[i]));
    }
    assert_true(tc_parse_real(&value, "-1.5e3") && value == -1500);
    assert_true(tc_parse_int(&integer, "-7") && integer == -7);
    assert_false(tc_parse_int(&integer, "2147483648"));
    assert_false(tc_parse_int(&integer, "1.0"));
    assert_true(tc_parse_reals(list, &n, 4, "1,-2,3e1") && n == 3 && list[1] == -2 && list[2] == 30);
    assert_false(tc_parse_reals(list, &n, 2, "1,2,3"));
    assert_false(tc_parse_reals(list, &n, 4, "1,,3"));
    assert_false(tc_parse_reals(list, &n, 4, "1,2,"));
    assert_false(tc_parse_reals(list, &n, 4, "1;2"));
}

static void default_name_is_the_inputs_own(void **state)
{
    (void)state;
    static const char *const pair[][2] = {
        {"fin.vtu", "fin"},        {"/data/run.7/fin.vtu", "fin"},
        {"a.b.c", "a.b"},          {"case/", "case"},
        {"mesh", "mesh"},          {".hidden", ".hidden"},
        {"synth:ball", "ball"},    {"synth:ball:500", "ball"},
        {"dir.d/file", "file"},    {"./x.ex2", "x"},
        {"//case.foam//", "case"},
    };
    char stem[64];
    for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
        tc_input_stem(stem, sizeof stem, pair[i][0]);
        assert_string_equal(stem, pair[i][1]);
    }
    tc_input_stem(stem, 5, "abcdefgh.vtu");
    assert_string_equal(stem, "abcd");
}

static void median_leaves_out_what_was_not_measured(void **state)
{
    (void)state;
    tc_spread spread;
    double odd[] = {5, 1, 3}, even[] = {4, 1, 3, 2}, holes[] = {NAN, 7, -1, 9, INFINITY}, none[] = {-1, NAN};
    tc_spread_of(&spread, odd, 3);
    assert_true(spread.median == 3 && spread.low == 1 && spread.high == 5);
    tc_spread_of(&spread, even, 4);
    assert_true(spread.median == 2.5 && spread.low == 1 && spread.high == 4);
    tc_spread_of(&spread, holes, 5);
    assert_true(spread.median == 8 && spread.low == 7 && spread.high == 9);
    tc_spread_of(&spread, none, 2);
    assert_true(isnan(spread.median) && isnan(spread.low) && isnan(spread.high));
}

static void json_leaves_out_what_was_not_measured(void **state)
{
    (void)state;
    json_t *json = json_object();
    tc_json_measured(json, "negative", -1);
    tc_json_measured(json, "nan", NAN);
    tc_json_real(json, "infinite", INFINITY);
    tc_json_text(json, "null", NULL);
    tc_json_text(json, "empty", "");
    tc_json_measured_count(json, "unknown", -1);
    assert_int_equal(json_object_size(json), 0);
    tc_json_measured(json, "zero", 0);
    tc_json_measured_count(json, "none", 0);
    tc_json_text(json, "latin1", "caf\xe9");
    assert_int_equal(json_object_size(json), 3);
    assert_string_equal(json_string_value(json_object_get(json, "latin1")), "caf?");
    json_decref(json);
}

static void worse_error_is_not_lighter(void **state)
{
    (void)state;
    float rgb[3], last = -1;
    for (double at = -7; at <= -1; at += 1.0 / 64) {
        tc_error_color(rgb, pow(10, at));
        float luma = 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2];
        assert_true(luma > last + 1e-4f);
        last = luma;
    }
    static const double low[] = {0, 1e-300, -1, NAN, 1e-7}, high[] = {0.1, 1, 3e38, INFINITY};
    for (size_t i = 0; i < sizeof low / sizeof *low; i++) {
        tc_error_color(rgb, low[i]);
        assert_true(rgb[0] < 0.05f && rgb[1] < 0.05f && rgb[2] < 0.1f);
    }
    for (size_t i = 0; i < sizeof high / sizeof *high; i++) {
        tc_error_color(rgb, high[i]);
        assert_true(rgb[0] == 1 && rgb[1] == 1 && rgb[2] == 1);
    }
    /* Neither grey nor turquoise can be taken for an error: looked at, ill-posed, not looked at. */
    float pixel[3][4] = {{1e-4f, 1e-3f, 0, 1}, {0.2f, 0, 0, 0.5f}, {0, 0, 0, 0}};
    tc_image image = {3, 1, &pixel[0][0]};
    tc_error_paint(&image);
    tc_error_color(rgb, 1e-3f);
    assert_memory_equal(pixel[0], rgb, sizeof rgb);
    assert_true(pixel[1][1] > pixel[1][0] + 0.5f && pixel[1][2] > pixel[1][0] + 0.5f);
    assert_true(pixel[2][0] == pixel[2][1] && pixel[2][1] == pixel[2][2] && pixel[2][0] == 0.5f);
    assert_true(pixel[0][3] == 1 && pixel[1][3] == 1 && pixel[2][3] == 1);
    assert_true(tc_error_is_painted("a.exr/b.png") && tc_error_is_painted("-") && tc_error_is_painted("x.JPG"));
    assert_false(tc_error_is_painted("x.EXR") || tc_error_is_painted("y.tif") || tc_error_is_painted("z.tiff"));
}

static void stated_bound_is_rounded_down(void **state)
{
    (void)state;
    static const double value[][2] = {{5.91e-5, 6.0e-5}, {5.9e-5, 5.9e-5}, {0.07301, 0.074},
                                      {9.91, 10},        {100, 100},       {0, 0}};
    for (size_t i = 0; i < sizeof value / sizeof *value; i++) {
        double up = tc_round_up(value[i][0]);
        assert_true(fabs(up - value[i][1]) <= 1e-12 * value[i][1]);
    }
    char text[192];
    tc_verify_result v = {
        .pixels = 4096, .n_all = 262144, .confidence = 0.95, .unseen_share = 7.21e-4, .max_abs_error = 5.83e-5};
    tc_confidence_text(text, sizeof text, &v);
    assert_string_equal(text, "with 95 % confidence at most 0.073 % of the other pixels err by more than 5.9e-05");
    v.unseen_share = 1;
    tc_confidence_text(text, sizeof text, &v);
    assert_non_null(strstr(text, "too few"));
    v.unseen_share = NAN; /* not drawn at random */
    tc_confidence_text(text, sizeof text, &v);
    assert_string_equal(text, "");
    v.pixels = v.n_all, v.unseen_share = 0;
    tc_confidence_text(text, sizeof text, &v);
    assert_string_equal(text, "");
    char legend[512];
    tc_error_legend(legend, sizeof legend, true);
    assert_non_null(strstr(legend, "orange 1e-3, yellow 1e-2, white 1e-1 and more, turquoise ill-posed"));
    tc_error_legend(legend, sizeof legend, false);
    assert_true(strlen(legend) < sizeof legend - 1);
}

static void gpu_bytes_count_imaginary_cells_and_added_points(void **state)
{
    (void)state;
    tc_mesh_report report = {.n_tet = 100, .n_imaginary = 10, .n_vertex = 50, .n_steiner = 2};
    assert_true(tc_info_gpu_bytes(&report) == 110 * 16 + 52 * 16);
}

/* ------------------------------------------------------------------------------------------------ empty pictures */

typedef struct tc_test_view {
    tc_mesh_report report;
    tc_camera camera;
    tc_size size;
} tc_test_view;

static void scene_make(tc_test_view *scene)
{
    memset(scene, 0, sizeof *scene);
    for (int i = 0; i < 3; i++) {
        scene->report.bounds[2 * i] = -1;
        scene->report.bounds[2 * i + 1] = 1;
    }
    scene->report.scalar_range[1] = 10;
    scene->camera = (tc_camera){.position = {0, 0, 8}, .view_up = {0, 1, 0}, .view_angle = 30, .parallel_scale = 2};
    scene->size = (tc_size){100, 100};
}

static void reason_with(const tc_test_view *scene, const tc_knot *knot, size_t n, const double *nan_color,
                        const char *words)
{
    char why[512];
    tc_error err = {0};
    tc_transfer *tf = NULL;
    assert_int_equal(tc_transfer_from_knots(&tf, knot, n, &err), TC_OK);
    tc_empty_reason(why, sizeof why, &scene->report, "heat", tf, nan_color, &scene->camera, &scene->size);
    tc_transfer_destroy(&tf);
    if (!strstr(why, words))
        fail_msg("'%s' does not say '%s'", why, words);
}

static void reason_is(const tc_test_view *scene, const tc_knot *knot, size_t n, const char *words)
{
    reason_with(scene, knot, n, NULL, words);
}

static void empty_picture_names_its_reason(void **state)
{
    (void)state;
    static const tc_knot clear[] = {{0, 1, 1, 1, 0}, {10, 1, 1, 1, 0}}, solid[] = {{0, 1, 1, 1, 1}, {10, 1, 1, 1, 1}};
    static const tc_knot above[] = {{20, 1, 1, 1, 0}, {30, 1, 1, 1, 1}}, below[] = {{-9, 1, 1, 1, 1}, {-5, 1, 1, 1, 0}};
    static const tc_knot ramp[] = {{-10, 1, 1, 1, 0}, {20, 1, 1, 1, 1}}; /* no knot within the range */
    static const tc_knot held[] = {{-9, 1, 1, 1, 0}, {-5, 1, 1, 1, 1}};  /* the last value holds above */
    tc_test_view scene;
    scene_make(&scene);
    reason_is(&scene, clear, 2, "opacity is 0 for every value of heat");
    reason_is(&scene, above, 2, "opacity is 0");
    reason_is(&scene, below, 2, "opacity is 0");
    reason_is(&scene, solid, 2, "within the view");
    reason_is(&scene, ramp, 2, "within the view");
    reason_is(&scene, held, 2, "within the view");
    scene.camera.focal_point[2] = 16;
    reason_is(&scene, solid, 2, "behind the camera");
    scene.camera.parallel = true; /* nothing behind the camera is seen there, either */
    reason_is(&scene, solid, 2, "behind the camera");
    scene_make(&scene);
    scene.camera.clip_near = 100;
    scene.camera.clip_far = 200;
    reason_is(&scene, solid, 2, "outside the clipping range 100 to 200");
    scene.camera.clip_near = 0;
    scene.camera.clip_far = 0.001;
    reason_is(&scene, solid, 2, "outside the clipping range 0 to 0.001");
    scene_make(&scene);
    scene.camera.focal_point[0] = 8;
    reason_is(&scene, solid, 2, "outside the view");
    scene.camera.focal_point[0] = 0;
    scene.camera.parallel = true;
    scene.camera.position[1] = scene.camera.focal_point[1] = 9;
    reason_is(&scene, solid, 2, "outside the view");
    scene.camera.parallel_scale = 9;
    reason_is(&scene, solid, 2, "within the view");
    scene.report.n_tet = scene.report.nonfinite_cells = 7;
    reason_is(&scene, solid, 2, "every cell has a value of heat that is not finite");
    reason_is(&scene, solid, 2, "--nan-color shows them");
    const double hidden[4] = {1, 0, 1, 0}, shown[4] = {1, 0, 1, 1};
    reason_with(&scene, solid, 2, hidden, "the attenuation A of --nan-color R,G,B,A is 0");
    scene.report.scalar_range[0] = scene.report.scalar_range[1] = NAN;
    reason_with(&scene, solid, 2, shown, "within the view");
    scene.camera.parallel_scale = 2;
    reason_with(&scene, solid, 2, shown, "outside the view");
    scene.camera.parallel_scale = 9;
    scene.report.scalar_range[0] = 0;
    scene.report.scalar_range[1] = 10;
    scene.report.nonfinite_cells = 6;
    reason_is(&scene, solid, 2, "within the view");
}

static void one_faint_pixel_is_not_empty(void **state)
{
    (void)state;
    float rgba[2 * 3 * 4] = {0};
    tc_image image = {2, 3, rgba};
    assert_false(tc_image_peak(&image) > 0);
    rgba[5] = 1; /* colour without opacity */
    assert_false(tc_image_peak(&image) > 0);
    rgba[23] = 1e-30f;
    assert_true(tc_image_peak(&image) == 1e-30f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distance_counts_edits_and_swaps),
        cmocka_unit_test(numbers_are_taken_whole_or_refused),
        cmocka_unit_test(default_name_is_the_inputs_own),
        cmocka_unit_test(median_leaves_out_what_was_not_measured),
        cmocka_unit_test(json_leaves_out_what_was_not_measured),
        cmocka_unit_test(worse_error_is_not_lighter),
        cmocka_unit_test(stated_bound_is_rounded_down),
        cmocka_unit_test(gpu_bytes_count_imaginary_cells_and_added_points),
        cmocka_unit_test(empty_picture_names_its_reason),
        cmocka_unit_test(one_faint_pixel_is_not_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
