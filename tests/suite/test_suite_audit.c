/* test_suite_audit.c: the walk's own account of itself (tc_render_audit): cells, lengths, faces that hold the ray. */
#define _DEFAULT_SOURCE
#include "suite.h"

#include "datasets_synthetic/synth.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 72, HEIGHT = 60, PIXELS = WIDTH * HEIGHT };

static const tc_knot function[1] = {{0, 0.9, 0.5, 0.2, 1}};
static tc_audit_ray first[PIXELS], second[PIXELS];

/* An audited picture of the mesh, its audit into `out`. */
static tc_render_stats audited(tc_audit_ray *out, const tc_mesh *mesh, const tc_camera *camera, int steps_per_pass)
{
    tc_transfer *tf = suite_function(function, 1);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_render_stats stats;
    options.opacity_stop = 1;
    options.unit_distance = 10 * suite_diagonal(mesh);
    options.steps_per_pass = steps_per_pass;
    tc_image *plain = suite_render(&stats, mesh, tf, camera, &options);
    assert_true(stats.audit_broken < 0);
    double state = stats.gpu_bytes_state;
    options.audit = true;
    tc_image *image = suite_render(&stats, mesh, tf, camera, &options);
    assert_true(stats.gpu_bytes_state > state); /* its textures are there only when asked for */
    assert_true(suite_difference(plain, image) == 0);
    suite_audit(out);
    tc_image_destroy(&image);
    tc_image_destroy(&plain);
    tc_transfer_destroy(&tf);
    return stats;
}

/* The cells of the audit are the steps of the statistics, none broken, and the lengths are the analytic chords. */
static void the_lengths_are_not_the_chords(void **state)
{
    static const char *const names[] = {"kuhn", "comb", "shells", "ball"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const tc_synth_generator *g = tc_synth_find(names[i]);
        tc_mesh *mesh = suite_synth(names[i], 3000, TC_REENTRY_CONVEXIFY);
        tc_camera camera = suite_camera(mesh, 0.3, 0.5, 1, false);
        tc_render_stats stats = audited(first, mesh, &camera, 0);
        int64_t cells = 0, rays = 0;
        double worst = 0, bound = 1e-5 * suite_diagonal(mesh);
        size_t off = 0;
        for (int p = 0; p < PIXELS; p++) {
            double o[3], d[3];
            suite_ray(o, d, &camera, WIDTH, HEIGHT, p % WIDTH, p / WIDTH);
            double error = fabs(g->chord(o, d, 3000) - (double)first[p].length_real);
            cells += first[p].cells;
            rays += first[p].cells > 0;
            assert_true(first[p].length_real <= first[p].length);
            off += error > bound;
            worst = error > bound ? worst : fmax(worst, error);
        }
        suite_say("%s: lengths within %.2g of the diagonal, %zu rays graze", names[i], worst / suite_diagonal(mesh),
                  off);
        assert_true(off <= 1); /* a ray along a silhouette may be on either side of it */
        assert_int_equal(stats.audit_broken, 0);
        assert_int_equal(cells, stats.steps);
        assert_int_equal(rays, stats.rays);
        tc_mesh_destroy(&mesh);
    }
}

static void the_cells_depend_on_the_passes(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("heatsink", 8000, TC_REENTRY_CONVEXIFY);
    tc_camera camera = suite_camera(mesh, 1, 0.4, 0.7, false);
    audited(first, mesh, &camera, 1);
    audited(second, mesh, &camera, 64);
    assert_memory_equal(first, second, sizeof first);
    tc_mesh_destroy(&mesh);
}

/* Peeled and convexified rays cross the same real cells: lengths agree, imaginary ones aside. */
static void peeling_and_convexifying_differ_in_real_length(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("heatsink", 8000, TC_REENTRY_CONVEXIFY);
    tc_camera camera = suite_camera(mesh, 1, 0.4, 0.7, true);
    audited(first, mesh, &camera, 0);
    suite_prepare(mesh, TC_REENTRY_PEEL);
    audited(second, mesh, &camera, 0);
    double worst = 0;
    for (int p = 0; p < PIXELS; p++) {
        worst = fmax(worst, fabs((double)first[p].length_real - (double)second[p].length_real));
        assert_true(second[p].length == second[p].length_real);
    }
    suite_say("peeled and convexified lengths differ by %.2g of the diagonal", worst / suite_diagonal(mesh));
    assert_true(worst <= 1e-5 * suite_diagonal(mesh));
    tc_mesh_destroy(&mesh);
}

static void a_picture_without_audit_gives_one(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("tet", 0, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.2, 0.3, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
    tc_error err = {0};
    assert_int_equal(suite_try_audit(first, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "audit"));
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* Fails behind the first hits, with the last picture's state still there, by a shader that does not compile. */
static void a_failed_picture_gives_the_last_ones_audit(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("tet", 0, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.2, 0.3, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_error err = {0};
    char folder[] = "/tmp/tetcast-test-XXXXXX", path[64];
    options.audit = true;
    tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
    suite_audit(first);
    tc_image_destroy(&image);
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/march.glsl", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs("#error broken on purpose\n", file) >= 0 && fclose(file) == 0);
    assert_int_equal(setenv("TETCAST_SHADERS", folder, 1), 0);
    tc_status status = suite_try_render(mesh, tf, &camera, &options, &err);
    unsetenv("TETCAST_SHADERS");
    unlink(path);
    rmdir(folder);
    assert_int_equal(status, TC_E_GL);
    assert_int_equal(suite_try_audit(second, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "audit"));
    image = suite_render(NULL, mesh, tf, &camera, &options);
    suite_audit(second);
    assert_memory_equal(first, second, sizeof first);
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void the_reference_takes_an_audit(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("tet", 0, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.2, 0.3, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_error err = {0};
    options.audit = true;
    assert_int_equal(suite_try_render(mesh, tf, &camera, &options, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "audit needs the driver 'pingpong'"));
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest gpu[] = {
        cmocka_unit_test(the_lengths_are_not_the_chords),
        cmocka_unit_test(the_cells_depend_on_the_passes),
        cmocka_unit_test(peeling_and_convexifying_differ_in_real_length),
        cmocka_unit_test(a_picture_without_audit_gives_one),
        cmocka_unit_test(a_failed_picture_gives_the_last_ones_audit),
    };
    const struct CMUnitTest reference[] = {
        cmocka_unit_test(a_picture_without_audit_gives_one),
        cmocka_unit_test(the_reference_takes_an_audit),
    };
    int failed =
        suite_is_gpu() ? cmocka_run_group_tests(gpu, NULL, NULL) : cmocka_run_group_tests(reference, NULL, NULL);
    suite_end();
    return failed;
}
