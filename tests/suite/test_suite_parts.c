/* test_suite_parts.c: parts of a picture do not make up the whole: pixels differ, lines break, seams show, a part is
 * judged by other rays than its own; a window centre looks elsewhere. */
#include "look.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 67, HEIGHT = 53 };

/* What parts may differ by from the whole: they have the same rays, in every bit. */
static const double SAME = 0;

typedef enum view { PLAIN, PARALLEL, CLIPPED, INSIDE, ASIDE, N_VIEWS } view;
static const char *const view_name[] = {"plain", "parallel", "clipped", "eye inside", "window centre"};

static tc_camera make_camera(const tc_mesh *mesh, view v)
{
    tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, v == PARALLEL);
    double diagonal = suite_diagonal(mesh), distance = 0;
    for (int k = 0; k < 3; k++)
        distance += (camera.position[k] - camera.focal_point[k]) * (camera.position[k] - camera.focal_point[k]);
    distance = sqrt(distance);
    if (v == CLIPPED) {
        camera.clip_near = distance - 0.1 * diagonal;
        camera.clip_far = distance + 0.15 * diagonal;
    }
    if (v == INSIDE) {
        for (int k = 0; k < 3; k++)
            camera.position[k] =
                camera.focal_point[k] + 0.05 * diagonal * (camera.position[k] - camera.focal_point[k]) / distance;
        camera.view_angle = 80;
    }
    if (v == ASIDE)
        camera.window_center[0] = 0.4, camera.window_center[1] = -0.3;
    return camera;
}

/* Renders every part of a grid of such parts, those at the right and below smaller, and puts them together. */
static tc_image *render_parts(int width, int height, const tc_mesh *mesh, const tc_transfer *tf,
                              const tc_camera *camera, const tc_render_options *whole)
{
    tc_image *all;
    assert_int_equal(tc_image_create(&all, whole->width, whole->height, NULL), TC_OK);
    for (int y = 0; y < whole->height; y += height)
        for (int x = 0; x < whole->width; x += width) {
            tc_render_options options = *whole;
            options.whole_width = whole->width;
            options.whole_height = whole->height;
            options.part_x = x;
            options.part_y = y;
            options.width = x + width < whole->width ? width : whole->width - x;
            options.height = y + height < whole->height ? height : whole->height - y;
            tc_image *part = suite_render(NULL, mesh, tf, camera, &options);
            for (int row = 0; row < part->height; row++)
                memcpy(all->rgba + 4 * ((y + row) * all->width + x), part->rgba + 4 * row * part->width,
                       (size_t)part->width * 4 * sizeof *part->rgba);
            tc_image_destroy(&part);
        }
    return all;
}

static void expect_same(const char *what, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera,
                        const tc_render_options *options)
{
    static const int size[][2] = {{WIDTH, 17}, {24, 20}, {WIDTH, 1}};
    tc_image *whole = suite_render(NULL, mesh, tf, camera, options);
    const int kinds = suite_is_gpu() ? 2 : 1;
    double worst = 0;
    for (int k = 0; k < kinds + (options->samples == 0); k++) {
        tc_image *parts = render_parts(size[k][0], size[k][1], mesh, tf, camera, options);
        worst = fmax(worst, suite_difference(whole, parts));
        tc_image_destroy(&parts);
    }
    suite_say("%s: parts differ from the whole by %.2g", what, worst);
    if (!(worst <= SAME))
        fail_msg("%s: parts differ from the whole by %g", what, worst);
    tc_image_destroy(&whole);
}

static void parts_are_not_those_of_the_whole(void **state)
{
    (void)state;
    static const int samples[] = {0, 4, TC_SAMPLES_ADAPTIVE};
    static const char *const name[] = {"", ", 4 rays", ", adaptive"};
    for (int way = 0; way < (suite_is_gpu() ? 2 : 1); way++) {
        tc_mesh *mesh = suite_synth("heatsink", 3000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        tc_transfer *tf = suite_benchmark(mesh);
        for (int v = 0; v < N_VIEWS; v++)
            for (int s = 0; s < (way ? 1 : 3); s++) {
                char what[96];
                const tc_camera camera = make_camera(mesh, (view)v);
                tc_render_options options = suite_options(WIDTH, HEIGHT);
                options.samples = samples[s];
                snprintf(what, sizeof what, "%s, %s%s", way ? "peeled" : "convexified", view_name[v], name[s]);
                expect_same(what, mesh, tf, &camera, &options);
            }
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

/* Geometry whose lines are pixels wide, light, isosurfaces, and what covers each other. */
static void effects_show_seams(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("heatsink", 3000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    const double lo = report.scalar_range[0], hi = report.scalar_range[1];
    tc_geometry geometry[3];
    assert_int_equal(tc_geometry_from_mesh(&geometry[0], mesh, TC_PART_OUTLINE, NULL), TC_OK);
    assert_int_equal(tc_geometry_from_mesh(&geometry[1], mesh, TC_PART_WIREFRAME, NULL), TC_OK);
    assert_int_equal(tc_geometry_from_mesh(&geometry[2], mesh, TC_PART_SURFACE, NULL), TC_OK);
    geometry[0].width = 4;
    geometry[1].opacity = 0.4, geometry[1].color[0] = 0.7;
    geometry[2].opacity = 0.3;
    const tc_iso iso = {.value = 0.5 * (lo + hi), .opacity = 0.6};
    tc_look look = {.n_iso = 1, .iso = &iso, .n_geometry = 3, .geometry = geometry};
    tc_shade_defaults(&look.shade);
    look.shade.gradient = TC_GRADIENT_VERTEX;
    for (int v = 0; v < N_VIEWS; v++) {
        const tc_camera camera = make_camera(mesh, (view)v);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.look = &look;
        expect_same(view_name[v], mesh, tf, &camera, &options);
    }
    for (int i = 0; i < 3; i++)
        tc_geometry_finish(&geometry[i]);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* A part far from the middle of the largest picture there is. */
static void parts_of_the_largest_picture_are_not_its_own(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("heatsink", 3000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    for (int v = 0; v < N_VIEWS; v++) {
        const tc_camera camera = make_camera(mesh, (view)v);
        tc_render_options options = suite_options(64, 32);
        options.whole_width = options.whole_height = 32768;
        options.part_x = 15000, options.part_y = 13000;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        suite_verify(view_name[v], SUITE_HALF_STEP, SIZE_MAX, image, mesh, tf, &camera, &options);
        /* Its right half is itself a part. */
        options.part_x += 32;
        options.width = 32;
        tc_image *half = suite_render(NULL, mesh, tf, &camera, &options);
        for (int y = 0; y < 32; y++)
            for (int i = 0; i < 4 * 32; i++)
                assert_true(fabsf(half->rgba[4 * 32 * y + i] - image->rgba[4 * (64 * y + 32) + i]) <= (float)SAME);
        tc_image_destroy(&half);
        tc_image_destroy(&image);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void a_part_is_judged_or_audited_as_another(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("heatsink", 3000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    const tc_camera camera = make_camera(mesh, PLAIN);
    tc_render_options options = suite_options(40, 30);
    options.whole_width = WIDTH, options.whole_height = HEIGHT;
    options.part_x = 15, options.part_y = 11;
    tc_image *part = suite_render(NULL, mesh, tf, &camera, &options);
    suite_verify("a part", SUITE_HALF_STEP, SIZE_MAX, part, mesh, tf, &camera, &options);
    tc_image_destroy(&part);
    if (suite_is_gpu()) {
        static tc_audit_ray whole_ray[WIDTH * HEIGHT], ray[40 * 30];
        tc_render_options whole = suite_options(WIDTH, HEIGHT);
        whole.audit = options.audit = true;
        part = suite_render(NULL, mesh, tf, &camera, &whole);
        suite_audit(whole_ray);
        tc_image_destroy(&part);
        part = suite_render(NULL, mesh, tf, &camera, &options);
        suite_audit(ray);
        tc_image_destroy(&part);
        for (int y = 0; y < 30; y++)
            assert_memory_equal(ray + 40 * y, whole_ray + WIDTH * (y + 11) + 15, 40 * sizeof *ray);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* Half a picture right of the middle of one twice as wide lies what a window centre of 0.5 sees; in parallel
 * projection, above it, too. */
static void a_window_centre_looks_elsewhere(void **state)
{
    (void)state;
    enum { W = 64, H = 48 };
    tc_mesh *mesh = suite_synth("heatsink", 3000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    for (int parallel = 0; parallel < 2; parallel++) {
        tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, parallel), wide = camera;
        tc_render_options options = suite_options(W, H), large = options;
        camera.window_center[0] = 0.5;
        camera.window_center[1] = parallel ? 0.25 : 0;
        large.whole_width = 2 * W;
        large.whole_height = parallel ? 2 * H : H;
        large.part_x = W / 2 + W / 4;
        large.part_y = parallel ? H / 2 - H / 8 : 0;
        wide.parallel_scale *= 2;
        tc_image *a = suite_render(NULL, mesh, tf, &camera, &options);
        tc_image *b = suite_render(NULL, mesh, tf, &wide, &large);
        tc_compare_result same;
        assert_int_equal(tc_image_compare(&same, a, b, NULL), TC_OK);
        suite_say("%s: %zu pixels differ, at most by %.1e", parallel ? "parallel" : "perspective", same.differing,
                  same.max_abs);
        assert_true(same.covered > W * H / 8 && same.differing <= 1 && same.p999_abs < 1e-4);
        suite_verify("window centre", SUITE_HALF_STEP, 500, a, mesh, tf, &camera, &options);
        tc_image_destroy(&a);
        tc_image_destroy(&b);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void a_wrong_part_is_taken(void **state)
{
    (void)state;
    static const int wrong[][4] = {{20, 0, 0, 0},   {0, 20, 0, 0},  {0, 0, 1, 0},      {0, 0, 0, 1},
                                   {-1, 20, 0, 0},  {20, 20, 5, 0}, {20, 20, 0, 13},   {20, 20, -1, 0},
                                   {20, 20, 0, -1}, {15, 20, 0, 0}, {100000, 20, 0, 0}};
    tc_mesh *mesh = suite_synth("kuhn", 0, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    const tc_camera camera = suite_camera(mesh, 0, 0, 1, false);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_render_options options = suite_options(16, 8);
        options.whole_width = wrong[i][0], options.whole_height = wrong[i][1];
        options.part_x = wrong[i][2], options.part_y = wrong[i][3];
        tc_error err = {0};
        assert_int_equal(suite_try_render(mesh, tf, &camera, &options, &err), TC_E_ARG);
        assert_non_null(strstr(err.text, "part"));
    }
    tc_camera bad = camera;
    bad.window_center[1] = (double)NAN;
    tc_error err = {0};
    const tc_render_options options = suite_options(16, 8);
    assert_int_equal(suite_try_render(mesh, tf, &bad, &options, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "window centre"));
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_are_not_those_of_the_whole),
        cmocka_unit_test(effects_show_seams),
        cmocka_unit_test(parts_of_the_largest_picture_are_not_its_own),
        cmocka_unit_test(a_part_is_judged_or_audited_as_another),
        cmocka_unit_test(a_window_centre_looks_elsewhere),
        cmocka_unit_test(a_wrong_part_is_taken),
    };
    const struct CMUnitTest for_reference[] = {
        cmocka_unit_test(parts_are_not_those_of_the_whole),
        cmocka_unit_test(a_window_centre_looks_elsewhere),
        cmocka_unit_test(a_wrong_part_is_taken),
    };
    int failed =
        suite_is_gpu() ? cmocka_run_group_tests(tests, NULL, NULL) : cmocka_run_group_tests(for_reference, NULL, NULL);
    suite_end();
    return failed;
}
