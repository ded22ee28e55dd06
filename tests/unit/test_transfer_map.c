/* Tests of colour spaces, built-in maps, opacity curves and tc_transfer_create. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "transfer_functions/color_space.h"
#include "transfer_functions/preset.h"
#include "transfer_functions/resolve.h"
#include "transfer_functions/thin.h"
#include "transfer_functions/transfer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static tc_transfer *create(const tc_transfer_options *options)
{
    tc_transfer *tf = NULL;
    tc_error err = {0};
    if (tc_transfer_create(&tf, options, &err) != TC_OK)
        fail_msg("%s", err.text);
    return tf;
}

static void refuse(const tc_transfer_options *options, tc_status status, const char *says)
{
    tc_transfer *tf = NULL;
    tc_error err = {0};
    const tc_status got = tc_transfer_create(&tf, options, &err);
    if (got != status || !strstr(err.text, says))
        fail_msg("status %d, \"%s\" lacks \"%s\"", got, err.text, says);
    assert_null(tf);
}

static double attenuation(const tc_transfer *tf, double s)
{
    double v[4];
    tc_transfer_evaluate(v, tf, s);
    return v[3];
}

/* --------------------------------------------------------------------------------------------- interpolation */

/* Values printed by VTK 9.1's vtkColorTransferFunction for these three points. */
static void colour_spaces_differ_from_vtk(void **state)
{
    (void)state;
    static const double x[3] = {0, 1, 3}, rgb[3][3] = {{.9, .1, .4}, {.1, .2, .8}, {.2, .7, .3}};
    static const struct {
        tc_color_space space;
        double at, rgb[3];
    } want[] = {
        {TC_SPACE_RGB, 0.2, {0.74, 0.12, 0.48}},
        {TC_SPACE_RGB, 2.9, {0.195, 0.675, 0.325}},
        {TC_SPACE_HSV, 0.2, {0.88, 0.100222222, 0.668346032}},
        {TC_SPACE_HSV, 0.7, {0.383053646, 0.100291667, 0.83}},
        {TC_SPACE_HSV, 1.5, {0.128013393, 0.48847736, 0.775}},
        {TC_SPACE_HSV, 2.9, {0.195763393, 0.705, 0.339804605}},
        {TC_SPACE_LAB, 0.2, {0.806481241, 0.125217592, 0.479955585}},
        {TC_SPACE_LAB, 0.7, {0.51142794, 0.17407522, 0.678778355}},
        {TC_SPACE_LAB, 1.5, {0.291166356, 0.335692377, 0.686994143}},
        {TC_SPACE_LAB, 2.9, {0.237189727, 0.676033643, 0.333139428}},
        {TC_SPACE_DIVERGING, 0.2, {1, 0.541040988, 0.563465558}},
        {TC_SPACE_DIVERGING, 0.7, {0.766041701, 0.697584996, 1}},
        {TC_SPACE_DIVERGING, 1.5, {0.707755535, 0.632168929, 1}},
        {TC_SPACE_DIVERGING, 2.9, {0.300690751, 0.759997026, 0.396756822}},
        {TC_SPACE_STEP, 0.2, {0.1, 0.2, 0.8}},
        {TC_SPACE_STEP, 2.9, {0.2, 0.7, 0.3}},
    };
    for (size_t i = 0; i < sizeof want / sizeof *want; i++) {
        tc_preset *map = tc_preset_create("three", 3, 0);
        map->space = want[i].space;
        for (int k = 0; k < 3; k++) {
            map->color[k].x = x[k];
            memcpy(map->color[k].rgb, rgb[k], sizeof rgb[k]);
        }
        const tc_resolve_input input = {.map = map, .range = {0, 3}};
        tc_knot *knot;
        size_t n;
        assert_int_equal(tc_resolve(&knot, &n, &input, NULL), TC_OK);
        tc_transfer *tf;
        assert_int_equal(tc_transfer_from_knots(&tf, knot, n, NULL), TC_OK);
        double v[4];
        tc_transfer_evaluate(v, tf, want[i].at);
        for (int c = 0; c < 3; c++)
            assert_float_equal(v[c], want[i].rgb[c], 1e-4);
        tc_transfer_destroy(&tf);
        free(knot);
        tc_preset_destroy(&map);
    }
}

/* Values printed by VTK 9.1's vtkPiecewiseFunction for these points. */
static void midpoint_and_sharpness_differ_from_vtk(void **state)
{
    (void)state;
    static const tc_opacity_point point[] = {
        {0, 0, .3, 0}, {1, .8, .5, .4}, {2, .2, .7, 1}, {4, .6, .2, .7}, {5, 0, .5, 0}};
    static const double want[][2] = {{0.1, 0.1333333333},
                                     {0.5, 0.5142857143},
                                     {1.2, 0.7981379901},
                                     {1.5, 0.5},
                                     {1.9, 0.2000576184},
                                     {3, 0.2},
                                     {3.3, 0.2},
                                     {3.5, 0.6},
                                     {4.1, 0.5996436372},
                                     {4.3, 0.06385619994},
                                     {4.9, 5.364419149e-09}};
    tc_preset *map = tc_preset_create("one", 1, 0);
    const tc_resolve_input input = {
        .map = map, .kind = TC_OPACITY_SCALARS, .n_opacity = 5, .opacity = point, .range = {0, 5}};
    tc_knot *knot;
    size_t n;
    assert_int_equal(tc_resolve(&knot, &n, &input, NULL), TC_OK);
    tc_transfer *tf;
    assert_int_equal(tc_transfer_from_knots(&tf, knot, n, NULL), TC_OK);
    for (size_t i = 0; i < sizeof want / sizeof *want; i++)
        assert_float_equal(attenuation(tf, want[i][0]), want[i][1], 1e-4);
    tc_transfer_destroy(&tf);
    free(knot);
    tc_preset_destroy(&map);
}

/* Test data of G. Sharma, W. Wu, E. Dalal 2005, table 1 (pairs 1, 7, 10, 14, 17, 25, 33). */
static void colour_difference_is_not_ciede2000(void **state)
{
    (void)state;
    static const double pair[][7] = {{50, 2.6772, -79.7751, 50, 0, -82.7485, 2.0425},
                                     {50, 0, 0, 50, -1, 2, 2.3669},
                                     {50, 2.4900, -0.0010, 50, -2.4900, 0.0010, 7.1792},
                                     {50, -0.0010, 2.4900, 50, 0.0011, -2.4900, 4.7461},
                                     {50, 2.5, 0, 73, 25, -18, 27.1492},
                                     {60.2574, -34.0099, 36.2677, 60.4626, -34.1751, 39.4387, 1.2644},
                                     {6.7747, -0.2908, -2.4247, 5.8714, -0.0985, -2.2286, 0.6377}};
    for (size_t i = 0; i < sizeof pair / sizeof *pair; i++) {
        assert_float_equal(tc_color_difference(pair[i], pair[i] + 3), pair[i][6], 1e-4);
        assert_float_equal(tc_color_difference(pair[i] + 3, pair[i]), pair[i][6], 1e-4);
    }
}

static void shortest_colour_path_is_longer_than_a_straight_one(void **state)
{
    (void)state;
    const double a[3] = {0, 0, 1}, b[3] = {1, 1, 0};
    tc_color_point *point;
    size_t n;
    assert_int_equal(tc_color_path(&point, &n, a, b, NULL), TC_OK);
    assert_true(n > 2);
    double length = 0, straight = 0;
    for (size_t i = 0; i + 1 < n; i++) {
        double p[3], q[3];
        tc_color_rgb_to_lab(p, point[i].rgb);
        tc_color_rgb_to_lab(q, point[i + 1].rgb);
        length += tc_color_difference(p, q);
        assert_true(point[i].x < point[i + 1].x);
    }
    for (int i = 0; i < 16; i++) {
        const double from[3] = {i / 16.0, i / 16.0, 1 - i / 16.0},
                     to[3] = {(i + 1) / 16.0, (i + 1) / 16.0, 1 - (i + 1) / 16.0};
        double p[3], q[3];
        tc_color_rgb_to_lab(p, from);
        tc_color_rgb_to_lab(q, to);
        straight += tc_color_difference(p, q);
    }
    assert_true(length <= straight * (1 + 1e-12));
    assert_memory_equal(point[0].rgb, a, sizeof a);
    assert_memory_equal(point[n - 1].rgb, b, sizeof b);
    free(point);
    assert_int_equal(tc_color_path(&point, &n, a, a, NULL), TC_OK);
    assert_int_equal(n, 1);
    free(point);
}

static void knots_stray_from_the_curve(void **state)
{
    (void)state;
    const double range[2][2] = {{-3, 7}, {1e-3, 1e5}};
    for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
        tc_transfer *tf = create(&(tc_transfer_options){
            .data_range = {range[logarithmic][0], range[logarithmic][1]}, .log = logarithmic, .opacity = "sigmoid"});
        assert_true(tf->n > 20 && tf->n < 2000);
        static const double blue[3] = {0.231373, 0.298039, 0.752941}, white[3] = {0.865, 0.865, 0.865},
                            red[3] = {0.705882, 0.015686, 0.149020};
        for (int i = 1; i < 5000; i++) {
            const double u = i / 5000.0, *r = range[logarithmic];
            const double s = logarithmic ? r[0] * pow(r[1] / r[0], u) : r[0] + u * (r[1] - r[0]);
            double v[4], want[3];
            tc_transfer_evaluate(v, tf, s);
            tc_color_interpolate(want, TC_SPACE_DIVERGING, false, u < 0.5 ? blue : white, u < 0.5 ? white : red,
                                 u < 0.5 ? 2 * u : 2 * u - 1, 0.5, 0);
            for (int c = 0; c < 3; c++)
                assert_float_equal(v[c], want[c], 1e-4);
            assert_float_equal(v[3], 0.3 / (1 + exp(-20 * (u - 0.5))), 1e-4);
        }
        tc_transfer_destroy(&tf);
    }
}

/* Who crosses knots pays for each: lines are as long as the tolerance, 0.8e-4, lets them be, so that one in the place of
 * two is more than twice as far off. */
static void more_knots_than_needed(void **state)
{
    (void)state;
    const tc_transfer_options options[] = {{.data_range = {-3, 7}, .opacity = "-3:0.3,7:0.3"},
                                           {.data_range = {1e-3, 1e5}, .log = true, .opacity = "0.001:0.3,1e5:0.3"}};
    for (int i = 0; i < 2; i++) {
        tc_transfer *tf = create(&options[i]), *thin = NULL;
        assert_int_equal(tc_transfer_thin(&thin, tf, 2e-4, NULL), TC_OK);
        assert_true(thin->n >= 0.9 * tf->n); /* what is left before a corner may be short */
        tc_transfer_destroy(&thin);
        tc_transfer_destroy(&tf);
    }
}

/* ------------------------------------------------------------------------------------------------- built-in maps */

static void builtin_maps_are_not_paraviews(void **state)
{
    (void)state;
    tc_preset_list list;
    if (access(TC_SHARED_DATA "/tf/ParaView_ColorMaps.json", R_OK) != 0)
        skip();
    tc_error err = {0};
    if (tc_preset_read(&list, TC_SHARED_DATA "/tf/ParaView_ColorMaps.json", &err) != TC_OK)
        fail_msg("%s", err.text);
    size_t n;
    const char *const *name = tc_transfer_builtin(&n);
    assert_int_equal(n, 12);
    for (size_t i = 0; i < n; i++) {
        const tc_preset *want;
        if (tc_preset_choose(&want, &list, name[i], "the file", &err) != TC_OK)
            fail_msg("%s", err.text);
        const double first = want->color[0].x, last = want->color[want->n_color - 1].x;
        tc_transfer *ours = create(&(tc_transfer_options){.color_map = name[i], .data_range = {first, last}});
        tc_transfer *theirs = create(&(tc_transfer_options){
            .color_map = TC_SHARED_DATA "/tf/ParaView_ColorMaps.json", .preset = name[i], .data_range = {first, last}});
        assert_string_equal(tc_transfer_name(ours), name[i]);
        for (int k = 0; k <= 2550; k++) {
            double a[4], b[4];
            tc_transfer_evaluate(a, ours, first + (last - first) * k / 2550);
            tc_transfer_evaluate(b, theirs, first + (last - first) * k / 2550);
            for (int c = 0; c < 3; c++)
                if (fabs(a[c] - b[c]) > 2.0 / 255)
                    fail_msg("%s at %g: channel %d is %g, not %g", name[i], k / 2550.0, c, a[c], b[c]);
        }
        tc_transfer_destroy(&ours);
        tc_transfer_destroy(&theirs);
    }
    tc_preset_list_finish(&list);
}

static void names_are_matched_too_strictly(void **state)
{
    (void)state;
    const char *const name[] = {
        "viridis", "VIRIDIS", "Viridis (matplotlib)", "cool to warm", "Cool-To_Warm", "black-body radiation", "Xray"};
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        tc_transfer *tf = create(&(tc_transfer_options){.color_map = name[i], .data_range = {0, 1}});
        tc_transfer_destroy(&tf);
    }
    refuse(&(tc_transfer_options){.color_map = "viridsi", .data_range = {0, 1}}, TC_E_ARG, "\"Viridis\"");
    refuse(&(tc_transfer_options){.color_map = "rainbow", .data_range = {0, 1}}, TC_E_ARG, "\"Rainbow Desaturated\"");
}

/* ------------------------------------------------------------------------------------------------ ranges, opacity */

static void default_is_not_the_benchmark_function(void **state)
{
    (void)state;
    tc_transfer *tf = create(&(tc_transfer_options){.data_range = {2, 6}});
    assert_string_equal(tc_transfer_name(tf), "Cool to Warm");
    double v[4], span[2];
    tc_transfer_evaluate(v, tf, 4);
    for (int c = 0; c < 3; c++)
        assert_float_equal(v[c], 0.865, 1e-4);
    assert_float_equal(v[3], 0.15, 1e-12);
    tc_transfer_evaluate(v, tf, 6);
    assert_float_equal(v[0], 0.705882, 1e-4);
    assert_float_equal(v[3], 0.3, 1e-12);
    assert_float_equal(attenuation(tf, 1), 0, 0);
    tc_transfer_span(span, tf);
    assert_float_equal(span[0], 2, 0);
    assert_float_equal(span[1], 6, 0);
    tc_transfer_destroy(&tf);
}

static void opacity_lists_are_read_wrongly(void **state)
{
    (void)state;
    tc_transfer *tf = create(&(tc_transfer_options){
        .color_map = "Grayscale", .data_range = {0, 1}, .opacity = "-1:0, 0.5:0.25,0.5:2 ,1.5e0:4,"});
    assert_float_equal(attenuation(tf, -2), 0, 0);
    assert_float_equal(attenuation(tf, -0.25), 0.125, 1e-12);
    assert_float_equal(attenuation(tf, 0.5), 2, 1e-12);
    assert_float_equal(attenuation(tf, 1), 3, 1e-12);
    assert_float_equal(attenuation(tf, 9), 4, 1e-12);
    double v[4];
    tc_transfer_evaluate(v, tf, 0.5);
    assert_float_equal(v[1], 0.5, 1e-12);
    tc_transfer_destroy(&tf);
    tf = create(&(tc_transfer_options){.data_range = {0, 1}, .opacity = "1:1,0:0"}); /* in any order */
    assert_float_equal(attenuation(tf, 0.5), 0.5, 1e-12);
    tc_transfer_destroy(&tf);
    const char *const bad[] = {"0:0,1", "0:0,1:", "0:0,:1", "0:0;1:1", "0:nan", "0:-1", "0:0,,1:1", "inf:1", "0.5"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        refuse(&(tc_transfer_options){.data_range = {0, 1}, .opacity = bad[i]}, TC_E_ARG, "opacity");
    refuse(&(tc_transfer_options){.data_range = {0, 1}, .opacity = "linaer"}, TC_E_ARG, "neither linear");
    refuse(&(tc_transfer_options){.data_range = {0, 1}, .opacity = "none.json"}, TC_E_FILE, "none.json");
}

static void named_opacities_are_wrong(void **state)
{
    (void)state;
    tc_transfer *tf = create(&(tc_transfer_options){.data_range = {0, 10}, .opacity = "linear"});
    assert_float_equal(attenuation(tf, 5), 0.15, 1e-12);
    tc_transfer_destroy(&tf);
    tf = create(&(tc_transfer_options){.data_range = {0, 10}, .opacity = "geom"});
    assert_float_equal(attenuation(tf, 10), 0.3, 1e-12);
    assert_float_equal(attenuation(tf, 9), 0.3 * pow(1e-6 / 255, 0.1), 1e-4);
    tc_transfer_destroy(&tf);
    tf = create(&(tc_transfer_options){.data_range = {0, 10}, .opacity = "Sigmoid"});
    assert_float_equal(attenuation(tf, 5), 0.15, 1e-12);
    assert_float_equal(attenuation(tf, 6), 0.3 / (1 + exp(-2)), 1e-4);
    tc_transfer_destroy(&tf);
}

static void odd_ranges_fail(void **state)
{
    (void)state;
    double v[4];
    tc_transfer *tf = create(&(tc_transfer_options){.color_map = "Grayscale", .data_range = {5, 5}});
    tc_transfer_evaluate(v, tf, 5); /* one value: the middle of map and curve */
    assert_float_equal(v[0], 0.5, 1e-9);
    assert_float_equal(v[3], 0.15, 1e-9);
    tc_transfer_destroy(&tf);
    tf = create(&(tc_transfer_options){.data_range = {INFINITY, -INFINITY}}); /* nothing finite */
    tc_transfer_destroy(&tf);
    tf = create(&(tc_transfer_options){.data_range = {0, 0}});
    tc_transfer_destroy(&tf);
    tf = create(&(tc_transfer_options){.data_range = {-1e308, 1e308}});
    assert_float_equal(attenuation(tf, 0), 0.15, 1e-9);
    tc_transfer_destroy(&tf);
    tf = create(&(tc_transfer_options){.data_range = {1e-300, 1e300}, .log = true});
    assert_float_equal(attenuation(tf, 1), 0.15, 1e-4);
    tc_transfer_destroy(&tf);
    refuse(&(tc_transfer_options){.has_range = true, .range = {3, 1}}, TC_E_ARG, "ascending");
    refuse(&(tc_transfer_options){.has_range = true, .range = {NAN, 1}}, TC_E_ARG, "finite");
    refuse(&(tc_transfer_options){.data_range = {-1, 1}, .log = true}, TC_E_ARG, "--range");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(more_knots_than_needed),
        cmocka_unit_test(colour_spaces_differ_from_vtk),
        cmocka_unit_test(midpoint_and_sharpness_differ_from_vtk),
        cmocka_unit_test(colour_difference_is_not_ciede2000),
        cmocka_unit_test(shortest_colour_path_is_longer_than_a_straight_one),
        cmocka_unit_test(knots_stray_from_the_curve),
        cmocka_unit_test(builtin_maps_are_not_paraviews),
        cmocka_unit_test(names_are_matched_too_strictly),
        cmocka_unit_test(default_is_not_the_benchmark_function),
        cmocka_unit_test(opacity_lists_are_read_wrongly),
        cmocka_unit_test(named_opacities_are_wrong),
        cmocka_unit_test(odd_ranges_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
