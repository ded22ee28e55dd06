/* test_suite_poison.c: what is in the GPU's memory before a frame never reaches the picture. Where the environment says
 * TETCAST_GL_POISON=1 every texture of the ray state holds NaN and every ray is locked before each frame, a new result
 * holds NaN, and NaN stands behind every uploaded array. For drivers that render with GL. */
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 61, HEIGHT = 47 };

static tc_renderer *plain, *poisoned;

static int set_up(void **state)
{
    (void)state;
    plain = suite_renderer("0");
    poisoned = suite_renderer("1");
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    tc_renderer_destroy(&plain);
    tc_renderer_destroy(&poisoned);
    return 0;
}

/* Both renderers give the same bits and the same counts. Gives the largest alpha. */
static float expect_same(const char *what, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                         const tc_render_options *options)
{
    tc_render_stats a_stats, b_stats;
    tc_image *a = suite_render_by(&a_stats, plain, mesh, tf, camera, options);
    tc_image *b = suite_render_by(&b_stats, poisoned, mesh, tf, camera, options);
    size_t n = 4 * (size_t)options->width * (size_t)options->height;
    float most = 0;
    for (size_t i = 0; i < n; i++)
        if (memcmp(a->rgba + i, b->rgba + i, sizeof *a->rgba) != 0)
            fail_msg("%s: channel %zu of pixel %zu is %g, with poison %g", what, i % 4, i / 4, (double)a->rgba[i],
                     (double)b->rgba[i]);
    for (size_t i = 3; i < n; i += 4)
        most = fmaxf(most, a->rgba[i]);
    assert_int_equal(a_stats.rays, b_stats.rays);
    assert_int_equal(a_stats.rays_lost, 0);
    assert_int_equal(b_stats.rays_lost, 0);
    assert_int_equal(a_stats.steps, b_stats.steps);
    assert_int_equal(a_stats.steps_max, b_stats.steps_max);
    assert_int_equal(a_stats.layers, b_stats.layers);
    if (options->audit) {
        static tc_audit_ray rays[2][WIDTH * HEIGHT];
        tc_error err = {0};
        if (tc_render_audit(rays[0], plain, &err) != TC_OK || tc_render_audit(rays[1], poisoned, &err) != TC_OK)
            fail_msg("%s: %s", what, err.text);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            if (memcmp(&rays[0][i], &rays[1][i], sizeof rays[0][i]) != 0)
                fail_msg("%s: the audit of pixel %d: %u cells, length %g; with poison %u, %g", what, i,
                         rays[0][i].cells, (double)rays[0][i].length, rays[1][i].cells, (double)rays[1][i].length);
    }
    tc_image_destroy(&a);
    tc_image_destroy(&b);
    return most;
}

static void what_was_in_memory_reaches_the_picture(void **state)
{
    (void)state;
    static const int steps[] = {1, 64};
    static const tc_reentry ways[] = {TC_REENTRY_CONVEXIFY, TC_REENTRY_PEEL};
    int pictures = 0;
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 3000, ways[way]);
        tc_transfer *tf = suite_benchmark(mesh);
        for (int k = 0; k < 2; k++)
            for (int watch = 0; watch < 3; watch++) /* nothing, count, audit */
                for (int integrator = 0; integrator < 2; integrator++) {
                    char what[128];
                    snprintf(what, sizeof what, "%s, %d steps a pass, %s, %s", way ? "peel" : "convexify", steps[k],
                             watch == 0   ? "plain"
                             : watch == 1 ? "count"
                                          : "audit",
                             integrator ? "table" : "integral");
                    tc_render_options options = suite_options(WIDTH, HEIGHT);
                    options.steps_per_pass = steps[k];
                    options.count = watch == 1;
                    options.audit = watch == 2;
                    options.integrator = integrator ? TC_INTEGRATOR_TABLE : TC_INTEGRATOR_INTEGRAL;
                    if (integrator)
                        options.table_size[0] = options.table_size[1] = options.table_size[2] = 32;
                    tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
                    assert_true(expect_same(what, mesh, tf, &camera, &options) > 0.05f);
                    tc_camera_azimuth(&camera, 50); /* what the last frame left is elsewhere */
                    tc_camera_zoom(&camera, 0.6);
                    expect_same(what, mesh, tf, &camera, &options);
                    tc_camera_zoom(&camera, 8); /* every pixel */
                    options.z_update_every = -1;
                    expect_same(what, mesh, tf, &camera, &options);
                    pictures += 3;
                }
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
    suite_say("%d pictures, each with the same bits", pictures);
}

static void memory_is_seen_where_there_is_no_mesh(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("kuhn", 48, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    expect_same("before", mesh, tf, &camera, &options);
    for (int k = 0; k < 3; k++)
        camera.focal_point[k] += 2 * (camera.position[k] - camera.focal_point[k]);
    assert_true(expect_same("looking away", mesh, tf, &camera, &options) <= 0);
    options.width = WIDTH - 1; /* a new state: its result holds NaN */
    assert_true(expect_same("looking away, anew", mesh, tf, &camera, &options) <= 0);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* Cell data, some of it NaN. */
static void memory_is_read_behind_the_arrays(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("shells", 2000, TC_REENTRY_CONVEXIFY);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    double *value = calloc(report.n_tet, sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < report.n_tet; i++)
        value[i] = i % 7 == 3 ? (double)NAN : (double)(i % 5);
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_CELL_DATA, NULL), TC_OK);
    free(value);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 1, 0.2, 0.3, true);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.steps_per_pass = 1;
    assert_true(expect_same("cell data", mesh, tf, &camera, &options) > 0.05f);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* Points of no cell have no place and no value: the picture has the bits of the mesh without them. */
static void points_of_no_cell_reach_the_picture(void **state)
{
    (void)state;
    const double nan = (double)NAN, inf = (double)INFINITY;
    const double few[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};
    const double few_values[] = {0, 1, 2, 3, 4};
    const int32_t few_tets[] = {0, 1, 2, 3, 1, 2, 3, 4};
    const double many[] = {nan, nan, nan, 0, 0,   0, 1,   0,   0,   1e300, inf, nan, 0, 1,
                           0,   0,   0,   1, 1e9, 1, 1e9, nan, nan, nan,   1,   1,   1};
    const double many_values[] = {nan, 0, 1, inf, 2, 3, -1e300, nan, 4};
    const int32_t many_tets[] = {1, 2, 4, 5, 2, 4, 5, 8};
    const tc_mesh_arrays arrays[2] = {
        {.n_vertex = 5, .vertex = few, .n_tet = 2, .tet = few_tets, .scalar = few_values, .association = TC_POINT_DATA},
        {.n_vertex = 9,
         .vertex = many,
         .n_tet = 2,
         .tet = many_tets,
         .scalar = many_values,
         .association = TC_POINT_DATA}};
    tc_mesh *mesh[2] = {suite_mesh(&arrays[0], TC_REENTRY_AUTO), suite_mesh(&arrays[1], TC_REENTRY_AUTO)};
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh[1]);
    assert_int_equal(report.n_tet, 2);
    tc_transfer *tf = suite_benchmark(mesh[0]);
    tc_camera camera = suite_camera(mesh[0], 0.3, 0.5, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_image *a = suite_render_by(NULL, plain, mesh[0], tf, &camera, &options);
    tc_image *b = suite_render_by(NULL, poisoned, mesh[1], tf, &camera, &options);
    assert_memory_equal(a->rgba, b->rgba, sizeof(float) * 4 * WIDTH * HEIGHT);
    tc_image_destroy(&a);
    tc_image_destroy(&b);
    for (int i = 0; i < 2; i++)
        tc_mesh_destroy(&mesh[i]);
    tc_transfer_destroy(&tf);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_was_in_memory_reaches_the_picture, set_up, tear_down),
        cmocka_unit_test_setup_teardown(memory_is_seen_where_there_is_no_mesh, set_up, tear_down),
        cmocka_unit_test_setup_teardown(memory_is_read_behind_the_arrays, set_up, tear_down),
        cmocka_unit_test_setup_teardown(points_of_no_cell_reach_the_picture, set_up, tear_down),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
