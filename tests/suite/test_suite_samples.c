/* test_suite_samples.c: pictures of several rays a pixel are the means of those rays; adaptive ones are, pixel by
 * pixel, that of 4 or that of 16; the bits of what rays carry from pass to pass are as asked for, and no memory grows.
 */
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 45, HEIGHT = 37 };

static const double LIMIT = 1.0 / 32; /* between the first rays of a pixel, as tetcast.h has it */
static const double SURE = 1e-4;      /* how far a difference may be from it, rounded otherwise */

/* What a ray may have to do with: projection, clipping planes, an eye in the mesh. */
typedef enum view { PLAIN, PARALLEL, CLIPPED, INSIDE, N_VIEWS } view;
static const char *const view_name[] = {"plain", "parallel", "clipped", "eye inside"};

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
    return camera;
}

/* The mean of n x n pixels of a picture n times as large, and the largest difference among them. */
static void mean_of(double mean[4], double *spread, const tc_image *big, int n, int x, int y)
{
    double least[4], most[4];
    *spread = 0;
    for (int c = 0; c < 4; c++) {
        mean[c] = 0;
        least[c] = (double)INFINITY;
        most[c] = -(double)INFINITY;
        for (int k = 0; k < n * n; k++) {
            double value = (double)big->rgba[4 * ((y * n + k / n) * big->width + x * n + k % n) + c];
            mean[c] += value / (n * n);
            least[c] = fmin(least[c], value);
            most[c] = fmax(most[c], value);
        }
        *spread = fmax(*spread, most[c] - least[c]);
    }
}

/* The rays of the larger picture are the same but for rounding, which a ray along an edge may feel. */
static void expect_mean(const char *what, const tc_image *image, const tc_image *big, int n)
{
    int wrong = 0;
    double worst = 0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            double mean[4], spread, error = 0;
            mean_of(mean, &spread, big, n, x, y);
            for (int c = 0; c < 4; c++)
                error = fmax(error, fabs((double)image->rgba[4 * (y * image->width + x) + c] - mean[c]));
            worst = fmax(worst, error);
            wrong += error > 1e-4;
        }
    suite_say("%s: %d pixels differ from the mean of %d rays, at most by %.1e", what, wrong, n * n, worst);
    if (wrong > 1 || worst > 0.1)
        fail_msg("%s: %d pixels are not the mean of %d rays", what, wrong, n * n);
}

static void expect_means(const char *what, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera)
{
    tc_render_options options = suite_options(WIDTH, HEIGHT), big_options = options;
    tc_render_stats one, stats, big_stats;
    tc_image *single = suite_render(&one, mesh, tf, camera, &options);
    assert_int_equal(one.samples, 1);
    for (int edge = 2; edge <= 4; edge += 2) {
        options.samples = edge * edge;
        big_options.width = WIDTH * edge;
        big_options.height = HEIGHT * edge;
        tc_image *image = suite_render(&stats, mesh, tf, camera, &options);
        tc_image *big = suite_render(&big_stats, mesh, tf, camera, &big_options);
        expect_mean(what, image, big, edge);
        assert_int_equal(stats.samples, edge * edge);
        assert_true(suite_difference(image, single) > 0.01);
        if (suite_is_gpu()) { /* sums over all frames */
            assert_in_range(stats.rays - big_stats.rays + 1, 0, 2);
            assert_true(stats.passes >= edge * edge && stats.layers >= one.layers);
            assert_true(stats.gpu_bytes_state == one.gpu_bytes_state); /* whatever the number of rays */
            assert_int_equal(stats.refined, -1);
        }
        tc_image_destroy(&image);
        tc_image_destroy(&big);
    }
    tc_image_destroy(&single);
}

/* Every view of a mesh with gaps, which are convexified or peeled. */
static void expect_of_views(void (*expect)(const char *what, const tc_mesh *mesh, const tc_transfer *tf,
                                           const tc_camera *camera))
{
    static const tc_reentry ways[] = {TC_REENTRY_CONVEXIFY, TC_REENTRY_PEEL};
    for (int way = 0; way < (suite_is_gpu() ? 2 : 1); way++) {
        tc_mesh *mesh = suite_synth("heatsink", 3000, ways[way]);
        tc_transfer *tf = suite_benchmark(mesh);
        for (int v = 0; v < N_VIEWS; v++) {
            char what[96];
            tc_camera camera = make_camera(mesh, (view)v);
            snprintf(what, sizeof what, "%s, %s", way ? "peeled" : "convexified", view_name[v]);
            expect(what, mesh, tf, &camera);
        }
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

static void a_pixel_is_not_the_mean_of_its_rays(void **state)
{
    (void)state;
    expect_of_views(expect_means);
}

/* Each pixel of the adaptive picture has the bits of the picture of 4 or of that of 16 rays, as its first rays demand.
 */
static void expect_adaptive(const char *what, const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera)
{
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_render_stats few_stats, many_stats, stats;
    options.samples = 4;
    tc_image *few = suite_render(&few_stats, mesh, tf, camera, &options);
    options.samples = 16;
    tc_image *many = suite_render(&many_stats, mesh, tf, camera, &options);
    options.samples = TC_SAMPLES_ADAPTIVE;
    tc_image *image = suite_render(&stats, mesh, tf, camera, &options);
    options.samples = 1;
    options.width *= 2;
    options.height *= 2;
    tc_image *rays = suite_render(NULL, mesh, tf, camera, &options);
    int refined = 0, sure = 0, covered = 0;
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const size_t at = 4 * ((size_t)y * WIDTH + (size_t)x), bytes = 4 * sizeof *image->rgba;
            double mean[4], spread;
            mean_of(mean, &spread, rays, 2, x, y);
            bool is_few = memcmp(image->rgba + at, few->rgba + at, bytes) == 0;
            bool is_many = memcmp(image->rgba + at, many->rgba + at, bytes) == 0;
            if (!is_few && !is_many)
                fail_msg("%s: pixel %d, %d is neither that of 4 nor that of 16 rays: alpha %.9g, not %.9g or %.9g",
                         what, x, y, (double)image->rgba[at + 3], (double)few->rgba[at + 3],
                         (double)many->rgba[at + 3]);
            if (spread > LIMIT + SURE && !is_many)
                fail_msg("%s: pixel %d, %d has 4 rays, though they differ by %g", what, x, y, spread);
            if (spread < LIMIT - SURE && !is_few)
                fail_msg("%s: pixel %d, %d has 16 rays, though 4 differ by %g only", what, x, y, spread);
            refined += !is_few;
            sure += spread > LIMIT + SURE;
            covered += many->rgba[at + 3] > 0;
        }
    suite_say("adaptive, %s: %d of %d covered pixels are refined", what, refined, covered);
    assert_true(refined > 0 && refined < covered);
    assert_int_equal(stats.samples, TC_SAMPLES_ADAPTIVE);
    assert_int_equal(stats.rays_lost, 0);
    if (suite_is_gpu()) {
        assert_true(stats.refined >= refined && stats.refined >= sure && stats.refined <= covered);
        assert_true(stats.rays > few_stats.rays && stats.rays <= few_stats.rays + 16 * stats.refined);
        assert_true(stats.gpu_bytes_state == few_stats.gpu_bytes_state + 33.0 * WIDTH * HEIGHT);
        assert_true(many_stats.gpu_bytes_state == few_stats.gpu_bytes_state);
    }
    tc_image_destroy(&few);
    tc_image_destroy(&many);
    tc_image_destroy(&image);
    tc_image_destroy(&rays);
}

static void an_adaptive_pixel_is_neither_that_of_4_nor_of_16_rays(void **state)
{
    (void)state;
    expect_of_views(expect_adaptive);
}

/* Nothing is seen, and nothing is refined; a mesh that fills the picture without an edge is not refined either. */
static void pixels_are_refined_without_need(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("kuhn", 384, TC_REENTRY_AUTO);
    const tc_knot gray[] = {{0, 0.5, 0.5, 0.5, 0.2}};
    tc_transfer *tf = suite_function(gray, 1);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, true), away = camera;
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.samples = TC_SAMPLES_ADAPTIVE;
    tc_render_stats stats;
    tc_camera_zoom(&camera, 8);
    tc_image *image = suite_render(&stats, mesh, tf, &camera, &options);
    assert_true(image->rgba[3] > 0.05f);
    if (suite_is_gpu()) {
        assert_int_equal(stats.refined, 0);
        assert_int_equal(stats.rays, 4 * WIDTH * HEIGHT);
    }
    tc_image_destroy(&image);
    for (int k = 0; k < 3; k++)
        away.focal_point[k] += 2 * (away.position[k] - away.focal_point[k]);
    image = suite_render(&stats, mesh, tf, &away, &options);
    for (size_t i = 0; i < (size_t)4 * WIDTH * HEIGHT; i++)
        assert_true(image->rgba[i] <= 0 && image->rgba[i] >= 0);
    if (suite_is_gpu())
        assert_int_equal(stats.refined, 0);
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* How much of a pixel a turned square covers: the square's middle is the picture's, its half edge `half` pixels. */
static double coverage(int x, int y, double half, double cosine, double sine)
{
    enum { FINE = 64 };
    int inside = 0;
    for (int k = 0; k < FINE * FINE; k++) {
        double px = x + (k % FINE + 0.5) / FINE - 0.5 * WIDTH, py = y + (k / FINE + 0.5) / FINE - 0.5 * WIDTH;
        inside += fabs(px * cosine + py * sine) < half && fabs(py * cosine - px * sine) < half;
    }
    return inside / (double)(FINE * FINE);
}

/* A box of one colour, seen along its edges and turned about the view: alpha is coverage times 1 - exp(-depth). */
static void more_rays_do_not_come_nearer_to_coverage(void **state)
{
    (void)state;
    const double turn = -17 * 3.14159265358979323846 / 180;
    tc_mesh *mesh = suite_synth("kuhn", 48, TC_REENTRY_AUTO);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    const double *b = report.bounds, edge = b[1] - b[0];
    assert_true(fabs(b[3] - b[2] - edge) < 1e-9 * edge);
    const tc_knot gray[] = {{0, 1, 1, 1, 3}};
    tc_transfer *tf = suite_function(gray, 1);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, true);
    camera.parallel_scale = 0.9 * edge;
    tc_camera_roll(&camera, 17);
    tc_render_options options = suite_options(WIDTH, WIDTH);
    options.unit_distance = b[5] - b[4];
    const double alpha = 1 - exp(-3.0), half = 0.5 * edge / (2 * camera.parallel_scale) * WIDTH;
    static const int samples[] = {1, 4, 16, TC_SAMPLES_ADAPTIVE};
    double mean[4], most[4];
    for (int i = 0; i < 4; i++) {
        options.samples = samples[i];
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        int edges = 0;
        mean[i] = most[i] = 0;
        for (int y = 0; y < WIDTH; y++)
            for (int x = 0; x < WIDTH; x++) {
                double covered = coverage(x, y, half, cos(turn), sin(turn));
                double error = fabs((double)image->rgba[4 * (y * WIDTH + x) + 3] / alpha - covered);
                if (!(covered > 0 && covered < 1)) { /* but a ray at a corner */
                    assert_true(error <= 1e-3);
                    continue;
                }
                edges++;
                mean[i] += error;
                most[i] = fmax(most[i], error);
            }
        mean[i] /= edges;
        suite_say("samples %2d: coverage of %d pixels at edges is wrong by %.3f, at most %.3f", samples[i], edges,
                  mean[i], most[i]);
        assert_true(edges > 60);
        tc_image_destroy(&image);
    }
    assert_true(mean[0] < 0.3 && mean[1] < 0.6 * mean[0] && mean[2] < 0.6 * mean[1]);
    assert_true(most[1] < 0.8 * most[0] && most[2] < 0.8 * most[1] && most[2] < 0.2);
    assert_true(mean[3] < 0.8 * mean[1] && most[3] < most[1] + 1e-3); /* 4 rays miss an edge at a corner */
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void several_rays_are_audited(void **state)
{
    (void)state;
    static const int samples[] = {4, 16, TC_SAMPLES_ADAPTIVE};
    tc_mesh *mesh = suite_synth("kuhn", 48, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, true);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.audit = true;
    for (int i = 0; i < 3; i++) {
        tc_error err = {0};
        options.samples = samples[i];
        assert_int_equal(suite_try_render(mesh, tf, &camera, &options, &err), TC_E_ARG);
        assert_non_null(strstr(err.text, "samples"));
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* What is counted is the sum over all frames. */
static void counts_are_those_of_one_frame(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        skip();
    tc_mesh *mesh = suite_synth("heatsink", 3000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_render_stats stats, big;
    options.count = true;
    options.steps_per_pass = 3;
    static const int samples[] = {16, TC_SAMPLES_ADAPTIVE};
    for (int i = 0; i < 2; i++) {
        options.samples = samples[i];
        tc_image *image = suite_render(&stats, mesh, tf, &camera, &options);
        assert_int_equal(stats.n_fragments_per_pass, stats.passes);
        for (size_t k = 0; k < stats.n_fragments_per_pass; k++)
            assert_true(stats.fragments_per_pass[k] >= 0);
        assert_true(stats.fragments_per_pass[0] > 0 && stats.steps > stats.rays && stats.steps_max > 3);
        tc_image_destroy(&image);
        if (i > 0)
            break;
        options.samples = 1;
        options.width *= 4;
        options.height *= 4;
        image = suite_render(&big, mesh, tf, &camera, &options);
        options.width /= 4;
        options.height /= 4;
        tc_image_destroy(&image);
        assert_true(fabs((double)(stats.steps - big.steps)) <= 1e-3 * (double)big.steps);
        assert_true(stats.passes > big.passes && llabs(stats.steps_max - big.steps_max) <= 2);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void state_has_other_bits_than_asked_for(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("heatsink", 3000, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
    static const tc_integrator integrators[] = {TC_INTEGRATOR_INTEGRAL, TC_INTEGRATOR_TABLE, TC_INTEGRATOR_EXACT};
    for (int i = 0; i < 3; i++)
        for (int k = 1; k <= 64; k *= 64) {
            tc_render_options options = suite_options(WIDTH, HEIGHT);
            tc_render_stats chosen, full, half;
            options.integrator = integrators[i];
            options.steps_per_pass = k;
            tc_image *a = suite_render(&chosen, mesh, tf, &camera, &options);
            options.state_format = TC_STATE_32F;
            tc_image *b = suite_render(&full, mesh, tf, &camera, &options);
            options.state_format = TC_STATE_16F;
            tc_image *c = suite_render(&half, mesh, tf, &camera, &options);
            assert_memory_equal(a->rgba, b->rgba, sizeof(float) * 4 * WIDTH * HEIGHT);
            double difference = suite_difference(b, c);
            suite_say("integrator %d, %d steps a pass: 16 bits differ from 32 by %.1e", (int)integrators[i], k,
                      difference);
            if (suite_is_gpu()) {
                assert_int_equal(chosen.state_bits, 32);
                assert_int_equal(full.state_bits, 32);
                assert_int_equal(half.state_bits, 16);
                assert_true(half.gpu_bytes_state == full.gpu_bytes_state - 16.0 * WIDTH * HEIGHT);
                assert_true(difference > 0 &&
                            difference < (k == 1 ? 0.02 : 1e-3)); /* of values up to 1, 2^-11 a pass */
            } else {
                assert_int_equal(half.state_bits, -1);
                assert_true(difference <= 0);
            }
            tc_image_destroy(&a);
            tc_image_destroy(&b);
            tc_image_destroy(&c);
        }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* As test_suite_poison.c, for what several rays a pixel need besides. */
static void what_was_in_memory_reaches_the_picture(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        skip();
    static const tc_reentry ways[] = {TC_REENTRY_CONVEXIFY, TC_REENTRY_PEEL};
    static const int samples[] = {16, TC_SAMPLES_ADAPTIVE, 1, 4, TC_SAMPLES_ADAPTIVE};
    tc_renderer *renderer[2] = {suite_renderer("0"), suite_renderer("1")};
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 3000, ways[way]);
        tc_transfer *tf = suite_benchmark(mesh);
        tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
        for (int i = 0; i < 5; i++) {
            tc_render_options options = suite_options(WIDTH, HEIGHT);
            tc_render_stats stats[2];
            tc_image *image[2];
            options.samples = samples[i];
            options.state_format = i % 2 ? TC_STATE_16F : TC_STATE_32F;
            options.count = i > 1;
            for (int k = 0; k < 2; k++)
                image[k] = suite_render_by(&stats[k], renderer[k], mesh, tf, &camera, &options);
            assert_memory_equal(image[0]->rgba, image[1]->rgba, sizeof(float) * 4 * WIDTH * HEIGHT);
            assert_int_equal(stats[0].rays, stats[1].rays);
            assert_int_equal(stats[0].refined, stats[1].refined);
            assert_int_equal(stats[0].steps, stats[1].steps);
            for (int k = 0; k < 2; k++)
                tc_image_destroy(&image[k]);
            tc_camera_azimuth(&camera, 40); /* what the last picture left is elsewhere */
            tc_camera_zoom(&camera, i % 2 ? 2 : 0.6);
        }
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
    tc_renderer_destroy(&renderer[0]);
    tc_renderer_destroy(&renderer[1]);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pixel_is_not_the_mean_of_its_rays),
        cmocka_unit_test(an_adaptive_pixel_is_neither_that_of_4_nor_of_16_rays),
        cmocka_unit_test(pixels_are_refined_without_need),
        cmocka_unit_test(more_rays_do_not_come_nearer_to_coverage),
        cmocka_unit_test(several_rays_are_audited),
        cmocka_unit_test(counts_are_those_of_one_frame),
        cmocka_unit_test(state_has_other_bits_than_asked_for),
        cmocka_unit_test(what_was_in_memory_reaches_the_picture),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
