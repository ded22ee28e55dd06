/* test_suite_drivers.c: the drivers with GL beside each other, whichever of them the back end names. */
#include "suite.h"

#include <stdio.h>
#include <string.h>

enum { WIDTH = 90, HEIGHT = 61 }; /* no whole work groups */

/* What rounding may do on a GPU, whose compiler sees two programs; on llvmpipe the bits are the same. */
#define ROUNDING 2e-6

static tc_renderer *make(const char *driver)
{
    const tc_renderer_options options = {.gl = suite_context(), .driver = driver};
    tc_renderer *renderer;
    tc_error err = {0};
    if (tc_renderer_create(&renderer, &options, NULL, &err) != TC_OK)
        fail_msg("%s: %s", driver, err.text);
    return renderer;
}

/* Both drivers walk the same rays through the same cells; compute in as many dispatches as there are layers. */
static void expect_same(const char *what, tc_renderer *const *each, const tc_mesh *mesh, const tc_transfer *tf,
                        const tc_camera *camera, const tc_render_options *options)
{
    tc_render_stats stats[2];
    tc_image *image[2];
    int64_t walked = 0;
    for (int i = 0; i < 2; i++)
        image[i] = suite_render_by(&stats[i], each[i], mesh, tf, camera, options);
    const tc_render_stats *compute = &stats[1];
    double difference = suite_difference(image[0], image[1]);
    suite_say("%s: %lld rays, %lld steps, %d layers; the drivers differ by %.1e", what, (long long)compute->rays,
              (long long)compute->steps, compute->layers, difference);
    assert_true(compute->rays > 500 && compute->steps > 5000);
    assert_true(difference <= ROUNDING);
    assert_string_equal(stats[0].driver, "pingpong");
    assert_string_equal(compute->driver, "compute");
    assert_int_equal(compute->rays_lost, 0);
    assert_int_equal(compute->rays, stats[0].rays);
    assert_int_equal(compute->steps, stats[0].steps);
    assert_int_equal(compute->steps_max, stats[0].steps_max);
    assert_int_equal(compute->layers, stats[0].layers);
    assert_int_equal(compute->passes, compute->layers);
    assert_int_equal(compute->n_fragments_per_pass, compute->passes);
    assert_int_equal(compute->fragments_per_pass[0], compute->rays);
    for (int i = 0; i < compute->passes; i++)
        walked += compute->fragments_per_pass[i];
    assert_true(compute->layers == 1 ? walked == compute->rays : walked > compute->rays);
    assert_true(compute->z_updates < 0 && compute->z_update_every < 0); /* it has none */
    for (int i = 0; i < 2; i++)
        tc_image_destroy(&image[i]);
}

static void the_drivers_make_different_pictures(void **state)
{
    (void)state;
    static const tc_reentry ways[] = {TC_REENTRY_CONVEXIFY, TC_REENTRY_PEEL};
    static const tc_integrator integrators[] = {TC_INTEGRATOR_INTEGRAL, TC_INTEGRATOR_EXACT, TC_INTEGRATOR_TABLE};
    static const tc_state_format formats[] = {TC_STATE_32F, TC_STATE_32F, TC_STATE_16F};
    tc_renderer *each[2] = {make("pingpong"), make("compute")};
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 4000, ways[way]);
        tc_transfer *tf = suite_benchmark(mesh);
        tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
        camera.view_angle = 10; /* rays in the pixels at all sides */
        for (int k = 0; k < 3; k++) {
            char what[64];
            snprintf(what, sizeof what, "%s, integrator %d", way ? "peeled" : "convexified", (int)integrators[k]);
            tc_render_options options = suite_options(WIDTH, HEIGHT);
            options.integrator = integrators[k];
            options.state_format = formats[k];
            options.steps_per_pass = 1024; /* of both: 16 bits round after each pass */
            options.count = true;
            expect_same(what, each, mesh, tf, &camera, &options);
        }
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
    for (int i = 0; i < 2; i++)
        tc_renderer_destroy(&each[i]);
}

/* An empty picture has no rays, so nothing was dispatched. */
static void a_picture_of_nothing_is_walked(void **state)
{
    (void)state;
    tc_renderer *renderer = make("compute");
    tc_mesh *mesh = suite_synth("tet", 0, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, false);
    for (int k = 0; k < 3; k++) /* looking away */
        camera.focal_point[k] = 2 * camera.position[k] - camera.focal_point[k];
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_render_stats stats;
    options.count = true;
    tc_image *image = suite_render_by(&stats, renderer, mesh, tf, &camera, &options);
    assert_int_equal(stats.rays, 0);
    assert_int_equal(stats.passes, 0);
    assert_int_equal(stats.n_fragments_per_pass, 0);
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        assert_true(image->rgba[i] == 0);
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    tc_renderer_destroy(&renderer);
}

static void auto_takes_the_driver_that_is_slow(void **state)
{
    (void)state;
    tc_renderer *renderer = make("auto");
    tc_mesh *mesh = suite_synth("tet", 0, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, false);
    tc_render_options options = suite_options(16, 16);
    tc_render_stats stats;
    tc_image *image = suite_render_by(&stats, renderer, mesh, tf, &camera, &options);
    suite_say("%s: auto is %s", stats.gl_renderer, stats.driver);
    assert_string_equal(stats.driver, strstr(stats.gl_renderer, "llvmpipe") ? "pingpong" : "compute");
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    tc_renderer_destroy(&renderer);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_drivers_make_different_pictures),
        cmocka_unit_test(a_picture_of_nothing_is_walked),
        cmocka_unit_test(auto_takes_the_driver_that_is_slow),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
