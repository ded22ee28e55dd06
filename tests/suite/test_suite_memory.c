/* test_suite_memory.c: bytes on the GPU, and that only what a scene calls for is there; the NASA Blunt Fin end to end.
 * For drivers that render with GL. */
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

enum { SIZE = 128 };

static void what_is_not_needed_is_uploaded(void **state)
{
    (void)state;
    const double pixels = SIZE * SIZE;
    tc_mesh *mesh = suite_synth("heatsink", 8000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
    tc_render_options options = suite_options(SIZE, SIZE);
    options.integrator = TC_INTEGRATOR_INTEGRAL;
    tc_render_stats plain, counting, table, peeled, cells;
    tc_image *image = suite_render(&plain, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    size_t n_cell = report.n_tet + report.n_imaginary, n_vertex = report.n_vertex + report.n_steiner;
    assert_true(plain.gpu_bytes_mesh == 16.0 * (double)n_cell + 16.0 * (double)n_vertex);
    assert_true(plain.gpu_bytes_table < 8e6); /* running integrals; the three-dimensional table has 33 MB */
    assert_string_equal(plain.integrator, "integral");
    assert_int_equal(plain.layers, 1);

    options.count = true;
    image = suite_render(&counting, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    options.count = false;
    assert_true(counting.gpu_bytes_state == plain.gpu_bytes_state + 8 * pixels); /* step counters, two sets */
    assert_true(counting.steps > 0 && plain.steps < 0 && plain.n_fragments_per_pass == 0);

    options.integrator = TC_INTEGRATOR_TABLE;
    options.table_size[0] = options.table_size[1] = 64;
    options.table_size[2] = 32;
    options.table_format = TC_TABLE_8;
    image = suite_render(&table, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    assert_true(table.gpu_bytes_table == 64 * 64 * 32 * 4); /* and no running integrals */
    assert_string_equal(table.integrator, "table");
    options.table_format = TC_TABLE_16F;
    image = suite_render(&table, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    double means = table.gpu_bytes_table - 64 * 64 * 32 * 8; /* and means: three texels an interval, a power of two */
    assert_true(means >= 8192 * 48 && means <= 65536 * 48 && fmod(means, 8192 * 48) == 0);
    options = suite_options(SIZE, SIZE);

    double *value = calloc(report.n_tet, sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < report.n_tet; i++) /* half of them seen: no mask says which are not */
        value[i] = report.scalar_range[i % 2];
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_CELL_DATA, NULL), TC_OK);
    free(value);
    image = suite_render(&cells, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    assert_true(cells.gpu_bytes_other == plain.gpu_bytes_other + 4.0 * (double)report.n_tet);

    suite_prepare(mesh, TC_REENTRY_PEEL);
    image = suite_render(&peeled, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    tc_mesh_get_report(&report, mesh);
    assert_int_equal(report.n_imaginary, 0);
    assert_true(peeled.gpu_bytes_mesh == 16.0 * (double)report.n_tet + 16.0 * (double)report.n_vertex);
    assert_true(peeled.gpu_bytes_state == plain.gpu_bytes_state + 16 * pixels); /* entry keys, only when peeling */
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void blunt_fin_is_wrong_or_too_large(void **state)
{
    (void)state;
    static const char path[] = TC_SHARED_DATA "/bluntfin_tets.vtu";
    if (access(path, R_OK) != 0) {
        suite_say("%s is not there", path);
        skip();
    }
    const tc_read_options read = {.field = "Density"};
    tc_mesh *mesh;
    tc_error err = {0};
    if (tc_mesh_read(&mesh, path, &read, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_render_options options = suite_options(512, 512);
    for (int way = 0; way < 2; way++) {
        suite_prepare(mesh, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        tc_mesh_report report;
        tc_mesh_get_report(&report, mesh);
        assert_int_equal(report.n_tet, 187318);
        tc_transfer *tf = suite_benchmark(mesh);
        tc_camera camera = suite_camera(mesh, 0, 0, 1, false);
        tc_render_stats stats;
        tc_image *image = suite_render(&stats, mesh, tf, &camera, &options);
        tc_verify_result v = suite_verify(way ? "Blunt Fin, peeled" : "Blunt Fin", SUITE_HALF_STEP, 4096, image, mesh,
                                          tf, &camera, &options);
        assert_true(v.mean_abs_error <= 1e-4);
        double n = (double)(report.n_tet + report.n_imaginary);
        suite_say("%zu imaginary tets; cells and vertices %.2f bytes a tet, with boundary %.2f; %d layers",
                  report.n_imaginary, stats.gpu_bytes_mesh / n, (stats.gpu_bytes_mesh + stats.gpu_bytes_other) / n,
                  stats.layers);
        if (way == 0)
            assert_in_range(report.n_imaginary, 3500, 3600);
        assert_true(stats.gpu_bytes_mesh <= 20 * n);
        assert_true(stats.gpu_bytes_mesh + stats.gpu_bytes_other <= 24 * n);
        tc_image_destroy(&image);
        tc_transfer_destroy(&tf);
    }
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_not_needed_is_uploaded),
        cmocka_unit_test(blunt_fin_is_wrong_or_too_large),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
