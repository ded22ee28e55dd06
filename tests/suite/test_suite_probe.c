/* test_suite_probe.c: a probed ray has the opacity of the picture's pixel, which is made by other means. */
#include "suite.h"

#include <string.h>

enum { WIDTH = 40, HEIGHT = 31 };

/* Views of the whole mesh, of a slab of it, and from within. */
static tc_camera view(const tc_mesh *mesh, int k)
{
    static const double from[5][3] = {
        {0.3, 0.5, 1}, {1, 0.2, 0.1}, {-0.7, 0.3, -0.4}, {0.2, -0.9, 0.4}, {0.5, 0.6, -1}};
    const double diagonal = suite_diagonal(mesh);
    tc_camera c = suite_camera(mesh, from[k][0], from[k][1], from[k][2], k == 1 || k == 3);
    double away[3], distance = 0;
    for (int i = 0; i < 3; i++) {
        away[i] = c.focal_point[i] - c.position[i];
        distance += away[i] * away[i];
    }
    distance = sqrt(distance);
    if (k == 2 || k == 3)
        c.clip_near = distance - 0.1 * diagonal, c.clip_far = distance + 0.15 * diagonal;
    for (int i = 0; i < 3 && k == 4; i++) {
        c.position[i] = c.focal_point[i] + 0.03 * (i - 1) * diagonal;
        c.focal_point[i] = c.position[i] + away[i];
    }
    return c;
}

static void opacity_of_a_probed_ray_is_not_that_of_the_pixel(void **state)
{
    (void)state;
    static const char *const name[] = {"ball", "heatsink", "shells", "nan-region", "nan-cells"};
    const bool exact = strcmp(suite_context(), "reference") == 0;
    for (int i = 0; i < 5; i++) {
        tc_mesh *mesh = suite_synth(name[i], 3000, TC_REENTRY_PEEL);
        tc_transfer *tf = suite_benchmark(mesh);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.integrator = TC_INTEGRATOR_EXACT;
        options.opacity_stop = 1;
        double worst = 0;
        for (int k = 0; k < 5; k++) {
            const tc_camera camera = view(mesh, k);
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
            size_t far = 0, seen = 0;
            for (int p = 0; p < WIDTH * HEIGHT; p++) {
                tc_probe *probe = NULL;
                assert_int_equal(tc_mesh_probe(&probe, mesh, tf, 0, &camera, WIDTH, HEIGHT, p % WIDTH, p / WIDTH, NULL),
                                 TC_OK);
                const double error = fabs(probe->opacity - (double)image->rgba[4 * p + 3]);
                if (error > (exact ? 1e-6 : SUITE_HALF_STEP))
                    far++; /* at a silhouette what a GPU's floats move tells */
                else
                    worst = fmax(worst, error);
                seen += probe->opacity > 0;
                tc_probe_destroy(&probe);
            }
            if (far > (exact ? 0 : 2) || seen < 100)
                fail_msg("%s, view %d: %zu of %zu pixels differ", name[i], k, far, seen);
            tc_image_destroy(&image);
        }
        suite_say("%s: opacities differ by at most %.2g", name[i], worst);
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(opacity_of_a_probed_ray_is_not_that_of_the_pixel),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
