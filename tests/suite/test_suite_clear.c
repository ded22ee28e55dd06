/* test_suite_clear.c: functions that show none of a mesh's values: rays are counted, and none is walked; nothing that
 * walks is compiled. What shows something, if only at one value, in the colour of missing values or as a surface, is
 * walked. */
#include "suite.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 60, HEIGHT = 44 };

/* Opacity from `from` to `to` of the mesh's range, 0 elsewhere. */
static tc_transfer *window(const tc_mesh *mesh, double from, double to)
{
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    const double lo = report.scalar_range[0], d = report.scalar_range[1] - lo;
    const tc_knot knot[] = {{lo + (from - 0.1) * d, 0.9, 0.5, 0.2, 0},
                            {lo + from * d, 0.9, 0.5, 0.2, 0},
                            {lo + (from + to) / 2 * d, 0.1, 0.5, 0.9, 7},
                            {lo + to * d, 0.1, 0.5, 0.9, 0}};
    return suite_function(knot, 4);
}

static bool is_empty(const tc_image *image)
{
    for (size_t i = 0; i < 4 * (size_t)image->width * (size_t)image->height; i++)
        if (image->rgba[i] != 0)
            return false;
    return true;
}

/* Renders; gives whether the rays were walked. */
static bool walked(const tc_mesh *mesh, const tc_transfer *tf, const tc_render_options *options, int64_t *rays,
                   bool empty)
{
    tc_render_stats stats;
    const tc_camera camera = suite_camera(mesh, 0.4, -0.3, 1, false);
    tc_image *image = suite_render(&stats, mesh, tf, &camera, options);
    assert_true(is_empty(image) == empty);
    assert_int_equal(stats.rays_lost, 0);
    *rays = stats.rays;
    tc_image_destroy(&image);
    return stats.passes > 0;
}

static void rays_are_walked_where_nothing_is_shown_or_are_not_counted(void **state)
{
    static const tc_reentry way[] = {TC_REENTRY_CONVEXIFY, TC_REENTRY_PEEL};
    (void)state;
    for (int w = 0; w < 2; w++) {
        tc_mesh *mesh = suite_synth("heatsink", 3000, way[w]);
        tc_transfer *seen = suite_benchmark(mesh), *below = window(mesh, -0.6, -0.1), *above = window(mesh, 1.1, 1.8);
        static const int samples[] = {1, 4, TC_SAMPLES_ADAPTIVE};
        for (int s = 0; s < 3; s++) {
            tc_render_options options = suite_options(WIDTH, HEIGHT);
            int64_t rays, all;
            options.samples = samples[s];
            assert_true(walked(mesh, seen, &options, &all, false) && all > 0);
            assert_false(walked(mesh, below, &options, &rays, true));
            assert_true(s == 2 ? rays > 0 && rays <= all : rays == all); /* adaptively, marked pixels come again */
            assert_false(walked(mesh, above, &options, &rays, true));
            assert_true(walked(mesh, seen, &options, &rays, false) && rays == all);
        }
        tc_transfer_destroy(&seen);
        tc_transfer_destroy(&below);
        tc_transfer_destroy(&above);
        tc_mesh_destroy(&mesh);
    }
}

/* A picture after an empty one is that of a renderer that made no other. */
static void an_empty_picture_leaves_something_to_the_next(void **state)
{
    tc_mesh *mesh = suite_synth("ball", 2000, TC_REENTRY_CONVEXIFY);
    tc_transfer *seen = suite_benchmark(mesh), *none = window(mesh, 1.2, 1.5);
    const tc_camera near_by = suite_camera(mesh, 0.4, -0.3, 1, false), other = suite_camera(mesh, -1, 0.2, 0.3, true);
    const tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_renderer *used = suite_renderer(NULL), *fresh = suite_renderer(NULL);
    (void)state;
    tc_image *image[3] = {suite_render_by(NULL, used, mesh, seen, &near_by, &options),
                          suite_render_by(NULL, used, mesh, none, &other, &options),
                          suite_render_by(NULL, used, mesh, seen, &other, &options)};
    tc_image *alone = suite_render_by(NULL, fresh, mesh, seen, &other, &options);
    assert_true(is_empty(image[1]));
    assert_memory_equal(image[2]->rgba, alone->rgba, sizeof(float) * 4 * WIDTH * HEIGHT);
    for (int i = 0; i < 3; i++)
        tc_image_destroy(&image[i]);
    tc_image_destroy(&alone);
    tc_renderer_destroy(&used);
    tc_renderer_destroy(&fresh);
    tc_transfer_destroy(&seen);
    tc_transfer_destroy(&none);
    tc_mesh_destroy(&mesh);
}

static void what_shows_something_is_left_out(void **state)
{
    tc_mesh *mesh = suite_synth("ball", 2000, TC_REENTRY_CONVEXIFY);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    tc_transfer *none = window(mesh, 1.2, 1.5);
    const tc_knot at_the_end[] = {{report.scalar_range[0], 1, 1, 1, 0},
                                  {report.scalar_range[1], 1, 1, 1, 0},
                                  {report.scalar_range[1], 1, 0, 0, 30}};
    tc_transfer *end = suite_function(at_the_end, 3);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    int64_t rays;
    (void)state;
    assert_false(walked(mesh, none, &options, &rays, true));
    tc_render_stats stats;
    const tc_camera camera = suite_camera(mesh, 0.4, -0.3, 1, false);
    tc_image *image = suite_render(&stats, mesh, end, &camera, &options); /* a value alone: perhaps no volume has it */
    assert_true(stats.passes > 0);
    tc_image_destroy(&image);
    const tc_iso iso = {.value = 0.5 * (report.scalar_range[0] + report.scalar_range[1]), .opacity = 1};
    const tc_look look = {.n_iso = 1, .iso = &iso};
    options.look = &look;
    assert_true(walked(mesh, none, &options, &rays, false));
    const tc_plane plane = {{1, 0.2, 0.1}, 0};
    const double range[1][2] = {{report.scalar_range[0], iso.value}};
    const tc_select select = {.n_range = 1, .range = range};
    const tc_look cut = {.model = TC_MODEL_XRAY, .n_plane = 1, .plane = &plane, .n_select = 1, .select = &select};
    options.look = &cut; /* shows less of nothing */
    assert_false(walked(mesh, none, &options, &rays, true));
    const tc_look most = {.model = TC_MODEL_MAXIMUM};
    options.look = &most;
    assert_true(walked(mesh, none, &options, &rays, false));
    options.look = NULL;
    options.count = true; /* asks for steps */
    assert_true(walked(mesh, none, &options, &rays, true));
    tc_transfer_destroy(&none);
    tc_transfer_destroy(&end);
    tc_mesh_destroy(&mesh);
}

static void missing_values_are_not_seen_for_the_function(void **state)
{
    tc_mesh *mesh = NULL;
    tc_mesh_report report;
    (void)state;
    assert_int_equal(tc_synth_create(&mesh, "kuhn", 400, 1, NULL), TC_OK);
    tc_mesh_get_report(&report, mesh);
    double *value = calloc(report.n_vertex, sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < report.n_vertex; i++)
        value[i] = i % 3 == 0 ? NAN : (double)i / (double)report.n_vertex;
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_POINT_DATA, NULL), TC_OK);
    suite_prepare(mesh, TC_REENTRY_CONVEXIFY);
    tc_transfer *none = window(mesh, 1.2, 1.5);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    int64_t rays;
    assert_false(walked(mesh, none, &options, &rays, true));
    options.has_nan_color = true;
    options.nan_color[0] = options.nan_color[3] = 1;
    assert_true(walked(mesh, none, &options, &rays, false));
    free(value);
    tc_transfer_destroy(&none);
    tc_mesh_destroy(&mesh);
}

/* In a new renderer: of one that made others its programs are still known. */
static void programs_that_walk_are_compiled_for_nothing(void **state)
{
    tc_mesh *mesh = suite_synth("ball", 500, TC_REENTRY_CONVEXIFY);
    tc_transfer *none = window(mesh, 1.2, 1.5);
    const tc_camera camera = suite_camera(mesh, 0.4, -0.3, 1, false);
    const tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_renderer *renderer = suite_renderer(NULL);
    tc_explanation explanation;
    tc_error err = {0};
    (void)state;
    tc_image *image = suite_render_by(NULL, renderer, mesh, none, &camera, &options);
    if (tc_render_explain(&explanation, renderer, &err) != TC_OK)
        fail_msg("%s", err.text);
    for (int i = 0; i < explanation.n_program; i++)
        assert_null(strstr(explanation.program[i].name, "march"));
    assert_true(explanation.n_program > 0);
    tc_image_destroy(&image);
    tc_renderer_destroy(&renderer);
    tc_transfer_destroy(&none);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_are_walked_where_nothing_is_shown_or_are_not_counted),
        cmocka_unit_test(an_empty_picture_leaves_something_to_the_next),
        cmocka_unit_test(what_shows_something_is_left_out),
        cmocka_unit_test(missing_values_are_not_seen_for_the_function),
        cmocka_unit_test(programs_that_walk_are_compiled_for_nothing),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
