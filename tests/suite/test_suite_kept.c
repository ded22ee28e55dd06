/* test_suite_kept.c: walks that are kept (tc_renderer_options.keep_bytes): pictures that go along them are those of a
 * renderer that keeps nothing, bit by bit, whatever values, function and view come in what order; what cannot go along
 * them does not. */
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 72, HEIGHT = 56, VIEWS = 3, ROUNDS = 5 };

static tc_renderer *make(size_t keep, bool at_once)
{
    const tc_renderer_options options = {
        .gl = suite_context(), .driver = "pingpong", .keep_bytes = keep, .keep_at_once = at_once};
    tc_renderer *renderer = NULL;
    tc_error err = {0};
    if (tc_renderer_create(&renderer, &options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return renderer;
}

static tc_image *render(tc_render_stats *stats, tc_renderer *renderer, const tc_mesh *mesh, const tc_transfer *tf,
                        const tc_camera *camera, const tc_render_options *options)
{
    tc_image *image = NULL;
    tc_error err = {0};
    if (tc_render(&image, stats, renderer, mesh, tf, camera, options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return image;
}

/* Renders by both and compares; gives whether the second went along a kept walk. */
static bool same(tc_renderer *const pair[2], const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                 const tc_render_options *options, const char *what)
{
    tc_render_stats stats[2];
    tc_image *image[2];
    for (int k = 0; k < 2; k++)
        image[k] = render(&stats[k], pair[k], mesh, tf, camera, options);
    const size_t bytes = sizeof(float) * 4 * (size_t)options->width * (size_t)options->height;
    assert_false(stats[0].kept);
    if (memcmp(image[0]->rgba, image[1]->rgba, bytes) != 0) {
        tc_compare_result r;
        tc_image_compare(&r, image[0], image[1], NULL);
        fail_msg("%s: kept walks change the picture by %g (%d, %d)", what, r.max_abs, r.worst_x, r.worst_y);
    }
    tc_image_destroy(&image[0]);
    tc_image_destroy(&image[1]);
    return stats[1].kept;
}

/* Functions that the integrators take in their ways: smooth, with a step and a spike, all but clear, all but opaque. */
static tc_transfer *function(const tc_mesh *mesh, int i)
{
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    const double lo = report.scalar_range[0], d = report.scalar_range[1] - lo;
    const tc_knot smooth[] = {{lo, 0.2, 0.3, 0.9, 0}, {lo + 0.4 * d, 0.9, 0.9, 0.8, 0.3}, {lo + d, 0.7, 0, 0.1, 2}};
    const tc_knot sharp[] = {{lo, 0.1, 0.8, 0.2, 0.05},           {lo + 0.5 * d, 0.9, 0.4, 0.1, 0.1},
                             {lo + 0.5 * d, 0.1, 0.1, 0.9, 5},    {lo + 0.51 * d, 0.9, 0.9, 0.1, 60},
                             {lo + 0.52 * d, 0.3, 0.3, 0.3, 0.2}, {lo + d, 1, 1, 1, 0.4}};
    const tc_knot opaque[] = {{lo, 0.9, 0.1, 0.1, 30}, {lo + d, 0.1, 0.9, 0.9, 90}};
    return i == 0 ? suite_function(smooth, 3) : i == 1 ? suite_function(sharp, 6) : suite_function(opaque, 2);
}

static void turn(tc_mesh *mesh, double *value, size_t n, int round)
{
    for (size_t i = 0; i < n; i++)
        value[i] = 0.5 + 0.5 * sin(0.013 * (double)i * (1 + 0.1 * round) + round);
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_POINT_DATA, NULL), TC_OK);
}

/* Meshes with and without gaps, large and of few cells (whose rays end at different rounds of one loop). */
static void compare_pictures(bool at_once)
{
    static const struct {
        const char *name;
        size_t cells;
    } mesh_of[] = {{"kuhn", 6}, {"kuhn", 3000}, {"ball", 2000}, {"heatsink", 3000}};
    static const tc_integrator integrator[] = {TC_INTEGRATOR_INTEGRAL, TC_INTEGRATOR_TABLE, TC_INTEGRATOR_AUTO};
    tc_renderer *pair[2] = {make(0, false), make((size_t)1 << 28, at_once)};
    int kept = 0, all = 0;
    for (size_t m = 0; m < sizeof mesh_of / sizeof *mesh_of; m++) {
        tc_mesh *mesh = NULL;
        tc_mesh_report made;
        assert_int_equal(tc_synth_create(&mesh, mesh_of[m].name, mesh_of[m].cells, 1, NULL), TC_OK);
        tc_mesh_get_report(&made, mesh);
        double *value = calloc(made.n_vertex, sizeof *value);
        assert_non_null(value);
        suite_prepare(mesh, TC_REENTRY_CONVEXIFY);
        for (int round = 0; round < ROUNDS; round++) {
            if (round > 0)
                turn(mesh, value, made.n_vertex, round);
            for (int f = 0; f < 3; f++) {
                tc_transfer *tf = function(mesh, f);
                for (int v = 0; v < VIEWS; v++) {
                    char what[96];
                    const tc_camera camera = suite_camera(mesh, v, 0.3 - v, 1, v == 2);
                    tc_render_options options = suite_options(WIDTH, HEIGHT);
                    options.integrator = integrator[(f + round) % 3];
                    snprintf(what, sizeof what, "%s %zu, round %d, function %d, view %d", mesh_of[m].name,
                             mesh_of[m].cells, round, f, v);
                    kept += same(pair, mesh, tf, &camera, &options, what);
                    all++;
                }
                tc_transfer_destroy(&tf);
            }
        }
        free(value);
        tc_mesh_destroy(&mesh);
    }
    suite_say("%d of %d pictures went along kept walks", kept, all);
    assert_true(at_once ? kept > all * 3 / 5 : kept > all / 2);
    for (int k = 0; k < 2; k++)
        tc_renderer_destroy(&pair[k]);
}

static void pictures_along_kept_walks_are_the_same_bit_by_bit(void **state)
{
    (void)state;
    compare_pictures(false);
}

static void walks_that_are_kept_at_once_are_others(void **state)
{
    (void)state;
    compare_pictures(true);
}

/* What rays add along the way otherwise, or where they go otherwise, is walked; so is what has no room. */
static void what_cannot_go_along_them_is_walked(void **state)
{
    tc_mesh *mesh = suite_synth("ball", 2000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    const tc_camera camera = suite_camera(mesh, 0.2, 0.1, 1, false);
    tc_renderer *pair[2] = {make(0, false), make((size_t)1 << 28, false)}, *poor[2] = {pair[0], make(4096, true)};
    const tc_iso iso = {.value = 0.5, .opacity = 0.5};
    const tc_look look = {.n_iso = 1, .iso = &iso};
    tc_render_stats stats;
    (void)state;
    for (int i = 0; i < 6; i++) {
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        const bool plain = same(pair, mesh, tf, &camera, &options, "plain");
        assert_true(plain == (i >= 1)); /* the third of the view: one of few cells a pass is in between */
        assert_false(same(poor, mesh, tf, &camera, &options, "without room"));
        options.steps_per_pass = 2; /* sums are rounded where a pass ends */
        assert_false(same(pair, mesh, tf, &camera, &options, "few cells a pass"));
        options.steps_per_pass = 0;
        options.integrator = TC_INTEGRATOR_EXACT;
        assert_false(same(pair, mesh, tf, &camera, &options, "exact"));
        options.integrator = TC_INTEGRATOR_AUTO;
        options.samples = 4;
        assert_false(same(pair, mesh, tf, &camera, &options, "four rays"));
        options.samples = 1;
        options.look = &look;
        assert_false(same(pair, mesh, tf, &camera, &options, "with a surface"));
        options.look = NULL;
        options.count = true;
        assert_false(same(pair, mesh, tf, &camera, &options, "counted"));
    }
    tc_image *image =
        render(&stats, pair[1], mesh, tf, &camera, &(tc_render_options){.width = WIDTH, .height = HEIGHT});
    suite_say("one view of %d x %d takes %.0f KiB", WIDTH, HEIGHT, stats.bytes_kept / 1024);
    assert_true(stats.bytes_kept > 0 && stats.bytes_kept < 1 << 28);
    tc_image_destroy(&image);
    for (int k = 0; k < 2; k++)
        tc_renderer_destroy(&pair[k]);
    tc_renderer_destroy(&poor[1]);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_along_kept_walks_are_the_same_bit_by_bit),
        cmocka_unit_test(walks_that_are_kept_at_once_are_others),
        cmocka_unit_test(what_cannot_go_along_them_is_walked),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
