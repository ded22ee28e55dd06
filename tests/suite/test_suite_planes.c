/* test_suite_planes.c: the paper's own arithmetic (TC_STEPPER_PLANES) draws the same picture where a mesh is benign,
 * says what it loses where it is not, and is not there unless it is asked for. For drivers that render with GL. */
#include "suite.h"

#include <stdlib.h>
#include <string.h>

enum { SIZE = 96 };

/* How far the paper's arithmetic may be from ours on a benign mesh: about 60 segments a ray, each with an end that is
 * off by some 8 units in the last place of a float (5e-7 of the half diagonal), more where a face is seen at a slant,
 * and a picture that changes by about 3 along a half diagonal. */
#define PLANES_BOUND 1e-4

static tc_render_options planes_options(void)
{
    tc_render_options options = suite_options(SIZE, SIZE);
    options.stepper = TC_STEPPER_PLANES;
    return options;
}

/* Both steppers' pictures of a mesh, and the reference's. */
static void check(const char *what, const tc_mesh *mesh, const tc_camera *camera)
{
    tc_render_stats stats;
    tc_transfer *tf = suite_benchmark(mesh);
    const tc_render_options signs = suite_options(SIZE, SIZE), planes = planes_options();
    tc_image *a = suite_render(&stats, mesh, tf, camera, &signs);
    assert_string_equal(stats.stepper, "signs");
    tc_image *b = suite_render(&stats, mesh, tf, camera, &planes);
    assert_string_equal(stats.stepper, "planes");
    assert_true(stats.rays > SIZE);
    double difference = suite_difference(a, b);
    suite_say("%s: %.2e from the exact signs", what, difference);
    if (!(difference <= PLANES_BOUND))
        fail_msg("%s: the steppers' pictures differ by %.3e, more than %.3e", what, difference, PLANES_BOUND);
    suite_verify(what, SUITE_HALF_STEP, SIZE_MAX, b, mesh, tf, camera, &planes);
    tc_image_destroy(&a);
    tc_image_destroy(&b);
    tc_transfer_destroy(&tf);
}

static void a_benign_mesh_looks_different(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t n_cells;
        tc_reentry reentry;
    } each[] = {{"kuhn", 6000, TC_REENTRY_AUTO},
                {"ball", 6000, TC_REENTRY_AUTO},
                {"comb", 4000, TC_REENTRY_CONVEXIFY},
                {"shells", 6000, TC_REENTRY_PEEL}};
    for (size_t i = 0; i < sizeof each / sizeof *each; i++) {
        tc_mesh *mesh = suite_synth(each[i].name, each[i].n_cells, each[i].reentry);
        for (int parallel = 0; parallel < 2; parallel++) {
            tc_camera camera = suite_camera(mesh, 0.5, 0.3, 1, parallel);
            check(each[i].name, mesh, &camera);
        }
        tc_mesh_destroy(&mesh);
    }
}

static void an_eye_inside_sees_another_mesh(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("ball", 6000, TC_REENTRY_AUTO);
    tc_camera camera = suite_camera(mesh, 0.5, 0.3, 1, false);
    for (int k = 0; k < 3; k++)
        camera.position[k] = camera.focal_point[k] + 0.1 * (camera.position[k] - camera.focal_point[k]);
    check("ball from within", mesh, &camera);
    tc_mesh_destroy(&mesh);
}

static void cell_data_and_missing_values_look_different(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("kuhn", 2000, TC_REENTRY_AUTO);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    tc_camera camera = suite_camera(mesh, 0.5, 0.3, 1, false);
    double *value = malloc((report.n_tet + report.n_vertex) * sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < report.n_tet; i++)
        value[i] = (double)(i % 7);
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_CELL_DATA, NULL), TC_OK);
    check("cell data", mesh, &camera);
    for (size_t i = 0; i < report.n_vertex; i++)
        value[i] = i % 50 == 3 ? NAN : (double)(i % 11);
    assert_int_equal(tc_mesh_set_scalar(mesh, value, TC_POINT_DATA, NULL), TC_OK);
    check("missing values", mesh, &camera);
    free(value);
    tc_mesh_destroy(&mesh);
}

static void a_ray_does_not_survive_the_end_of_a_pass(void **state)
{
    (void)state;
    static const int steps[] = {1, 2, 5, 64};
    tc_mesh *mesh = suite_synth("heatsink", 8000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.5, 0.4, 1, false);
    tc_render_options options = planes_options();
    options.count = true;
    options.steps_per_pass = 1000;
    tc_render_stats whole, stats;
    tc_image *image = suite_render(&whole, mesh, tf, &camera, &options);
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        options.steps_per_pass = steps[i];
        tc_image *other = suite_render(&stats, mesh, tf, &camera, &options);
        assert_true(suite_difference(image, other) < 1e-5);
        assert_int_equal(stats.steps, whole.steps);
        assert_true(stats.passes > whole.passes || steps[i] >= whole.steps_max);
        tc_image_destroy(&other);
    }
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void planes_are_there_without_being_asked_for(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("comb", 4000, TC_REENTRY_CONVEXIFY);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    double n_cell = (double)(report.n_tet + report.n_imaginary),
           n_vertex = (double)(report.n_vertex + report.n_steiner);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
    const tc_render_options signs = suite_options(SIZE, SIZE), planes = planes_options();
    tc_render_stats stats[4];
    tc_image *image[4];
    for (int i = 0; i < 4; i++)
        image[i] = suite_render(&stats[i], mesh, tf, &camera, i & 1 ? &planes : &signs);
    for (int i = 0; i < 4; i++) {
        assert_string_equal(stats[i].stepper, i & 1 ? "planes" : "signs");
        /* Table 1 of the paper in place of the records; the vertices stay, the first hit reads them. */
        assert_true(stats[i].gpu_bytes_mesh == (i & 1 ? 160 : 16) * n_cell + 16 * n_vertex);
        assert_true(stats[i].gpu_bytes_other == stats[0].gpu_bytes_other);
        assert_true(stats[i].gpu_bytes_state == stats[0].gpu_bytes_state);
        assert_true(stats[i].audit_broken == -1);
        if (i > 1) /* coming back changes nothing */
            assert_memory_equal(image[i]->rgba, image[i - 2]->rgba, SIZE * SIZE * 4 * sizeof(float));
    }
    for (int i = 0; i < 4; i++)
        tc_image_destroy(&image[i]);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* A thin sheet of n x n x n cubes of six tets that lies at a slant, its vertices moved within it: the planes of its
 * cells are all but one plane. */
static tc_mesh *sheet(int n)
{
    static const int way[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    const int m = n + 1, step[3] = {1, m, m * m};
    size_t n_vertex = (size_t)(m * m * m), n_tet = (size_t)(6 * n * n * n), k = 0;
    double *vertex = malloc(n_vertex * 3 * sizeof *vertex), *scalar = malloc(n_vertex * sizeof *scalar);
    int32_t *tet = malloc(n_tet * 4 * sizeof *tet);
    assert_true(vertex && scalar && tet);
    uint32_t noise = 1;
    for (size_t i = 0; i < n_vertex; i++) {
        double *v = vertex + 3 * i;
        int at[3] = {(int)i % m, (int)i / m % m, (int)i / (m * m)};
        for (int a = 0; a < 2; a++) {
            noise = noise * 1664525u + 1013904223u;
            v[a] = (at[a] + 0.3 * ((double)noise / 4294967296.0 - 0.5)) / n;
        }
        v[2] = 0.37 * v[0] + 0.21 * v[1] + 1e-5 * at[2] / n;
        scalar[i] = v[0] + v[1];
    }
    for (size_t cube = 0; cube < n_tet / 6; cube++)
        for (int w = 0; w < 6; w++, k++) {
            int c = (int)cube, id = c % n + m * (c / n % n) + m * m * (c / (n * n));
            tet[4 * k] = id;
            for (int i = 0; i < 3; i++)
                tet[4 * k + 1 + (size_t)i] = id += step[way[w][i]];
        }
    const tc_mesh_arrays arrays = {n_vertex, vertex, n_tet, tet, scalar, TC_POINT_DATA, "f"};
    tc_mesh *mesh = suite_mesh(&arrays, TC_REENTRY_AUTO);
    free(vertex);
    free(scalar);
    free(tet);
    return mesh;
}

static void lost_rays_are_not_told_or_end_the_work(void **state)
{
    (void)state;
    tc_mesh *mesh = sheet(8);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.1, 0.2, 1, false);
    tc_render_options options = suite_options(SIZE, SIZE);
    tc_image *image = suite_render(NULL, mesh, tf, &camera, &options); /* none with the exact signs */
    tc_image_destroy(&image);
    options = planes_options();
    tc_renderer *renderer = suite_renderer(NULL);
    tc_render_stats stats;
    tc_error err = {0};
    tc_status status = tc_render(&image, &stats, renderer, mesh, tf, &camera, &options, NULL, &err);
    const int64_t plain = stats.rays_lost; /* in as few passes as may be, which an audit's are not */
    assert_int_equal(status, TC_E_LOST);
    tc_image_destroy(&image);
    options.audit = true;
    status = tc_render(&image, &stats, renderer, mesh, tf, &camera, &options, NULL, &err);
    suite_say("thin sheet: %lld of %lld rays lost, %d passes", (long long)stats.rays_lost, (long long)stats.rays,
              stats.passes);
    assert_int_equal(status, TC_E_LOST);
    assert_non_null(strstr(err.text, "'planes'"));
    assert_true(stats.rays_lost > 0 && stats.rays_lost <= stats.rays && stats.rays_lost == plain);
    assert_true(stats.steps_max <=
                4 * (int64_t)(8 * 8 * 8 * 6)); /* a circle is noticed; it does not go on to the pass limit */
    assert_true(stats.audit_broken == -1);
    for (size_t i = 0; i < SIZE * SIZE; i++) {
        const float *p = image->rgba + 4 * i;
        assert_true(isfinite(p[0] + p[1] + p[2]) && p[3] >= 0 && p[3] <= 1);
    }
    tc_audit_ray *ray = malloc(sizeof *ray * SIZE * SIZE);
    assert_non_null(ray);
    assert_int_equal(tc_render_audit(ray, renderer, &err), TC_OK);
    int64_t cells = 0;
    for (size_t i = 0; i < SIZE * SIZE; i++)
        cells += ray[i].cells;
    assert_true(cells == stats.steps && cells > 0);
    free(ray);
    tc_image_destroy(&image);
    tc_renderer_destroy(&renderer);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void the_reference_takes_planes_for_an_answer(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("two", 0, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, false);
    tc_render_options options = planes_options();
    const tc_renderer_options make = {.driver = "reference"};
    tc_renderer *renderer;
    tc_image *image;
    tc_error err = {0};
    assert_int_equal(tc_renderer_create(&renderer, &make, NULL, &err), TC_OK);
    assert_int_equal(tc_render(&image, NULL, renderer, mesh, tf, &camera, &options, NULL, &err), TC_E_ARG);
    assert_null(image);
    assert_non_null(strstr(err.text, "'pingpong'"));
    options.stepper = (tc_stepper)7;
    assert_int_equal(tc_render(&image, NULL, renderer, mesh, tf, &camera, &options, NULL, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "stepper 7"));
    tc_renderer_destroy(&renderer);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_benign_mesh_looks_different),
        cmocka_unit_test(an_eye_inside_sees_another_mesh),
        cmocka_unit_test(cell_data_and_missing_values_look_different),
        cmocka_unit_test(a_ray_does_not_survive_the_end_of_a_pass),
        cmocka_unit_test(planes_are_there_without_being_asked_for),
        cmocka_unit_test(lost_rays_are_not_told_or_end_the_work),
        cmocka_unit_test(the_reference_takes_planes_for_an_answer),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
