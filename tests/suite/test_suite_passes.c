/* test_suite_passes.c: the multi-pass loop: steps per pass, z-updates and queries, early ray termination (Weiler et al.
 * 2003, 5.2 and figure 8). For drivers that have passes. */
#include "suite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void steps_per_pass_change_the_picture(void **state)
{
    (void)state;
    static const int steps[] = {1, 8, 64, 3, 1000};
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 12000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        tc_transfer *tf = suite_benchmark(mesh);
        tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
        tc_render_options options = suite_options(128, 128);
        tc_image *first = NULL;
        for (int i = 0; i < 5; i++) {
            options.steps_per_pass = steps[i];
            tc_render_stats stats;
            tc_image *image = suite_render(&stats, mesh, tf, &camera, &options);
            /* software renderers cut loops: they may take fewer than very many */
            assert_true(stats.steps_per_pass == steps[i] || (steps[i] > 64 && stats.steps_per_pass < steps[i]));
            if (first) {
                double difference = suite_difference(first, image);
                suite_say("%s, K = %d: %d passes, difference to K = 1 %.1e", way ? "peeled" : "convexified", steps[i],
                          stats.passes, difference);
                assert_true(difference <= 1e-4);
                tc_image_destroy(&image);
            } else {
                first = image;
            }
        }
        tc_image_destroy(&first);
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

static void z_updates_change_the_picture(void **state)
{
    (void)state;
    static const int every[] = {-1, 2, 6, 14, 100};
    static const int steps[] = {1, 8};
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("comb", 5000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        tc_transfer *tf = suite_benchmark(mesh);
        tc_camera camera = suite_camera(mesh, 1, 0.1, 0.3, false);
        tc_render_options options = suite_options(128, 128);
        for (int k = 0; k < 2; k++) {
            tc_image *first = NULL;
            options.steps_per_pass = steps[k];
            for (int i = 0; i < 5; i++) {
                options.z_update_every = every[i];
                tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
                if (first) {
                    double difference = suite_difference(first, image);
                    if (!(difference <= 1e-4))
                        fail_msg("K = %d: a z-update every %d passes changes the picture by %g", steps[k], every[i],
                                 difference);
                    tc_image_destroy(&image);
                } else {
                    first = image;
                }
            }
            tc_image_destroy(&first);
        }
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

/* One curve of figure 8: fragments shaded in each pass. */
typedef struct curve {
    size_t n;
    int64_t *fragments, sum;
    tc_render_stats stats;
} curve;

static curve measure(const tc_mesh *mesh, const tc_transfer *tf, const tc_camera *camera, int z_update_every,
                     double opacity_stop, double unit_distance)
{
    tc_render_options options = suite_options(512, 512);
    options.steps_per_pass = 1;
    options.count = true;
    options.z_update_every = z_update_every;
    options.opacity_stop = opacity_stop;
    options.unit_distance = unit_distance;
    curve c = {0};
    tc_image *image = suite_render(&c.stats, mesh, tf, camera, &options);
    c.n = c.stats.n_fragments_per_pass;
    assert_int_equal(c.n, c.stats.passes);
    c.fragments = malloc((c.n + 1) * sizeof *c.fragments);
    assert_non_null(c.fragments);
    for (size_t i = 0; i < c.n; i++) {
        c.fragments[i] = c.stats.fragments_per_pass[i];
        c.sum += c.fragments[i];
    }
    tc_image_destroy(&image);
    return c;
}

enum { BRUTE_FORCE, EARLY_Z, EARLY_Z_AND_STOP, DENSE_EARLY_Z_AND_STOP, N_CURVE };
static const double SCREEN = 512 * 512;

static void write_figure(const char *path, const curve *each)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "pass,brute_force,early_z,early_z_and_ray_termination,the_same_64_times_denser\n");
    for (size_t i = 0; i < each[BRUTE_FORCE].n || i < each[EARLY_Z].n; i++) {
        fprintf(file, "%zu", i + 1);
        for (int k = 0; k < N_CURVE; k++)
            fprintf(file, ",%lld", (long long)(i < each[k].n ? each[k].fragments[i] : 0));
        fprintf(file, "\n");
    }
    assert_int_equal(fclose(file), 0);
    suite_say("the curves of figure 8 are in %s", path);
}

/* The loop asks for the count of finished rays two passes behind and stops at even passes: no more than that late. */
static void expect_few_passes(const curve *c)
{
    if (c->stats.passes > c->stats.steps_max + c->stats.z_update_every + 3)
        fail_msg("%d passes for a longest ray of %lld steps with a z-update every %d", c->stats.passes,
                 (long long)c->stats.steps_max, c->stats.z_update_every);
}

static void early_z_or_queries_do_not_work(void **state)
{
    (void)state;
    static const char *const names[N_CURVE] = {"brute force", "early z", "early z and ray termination",
                                               "the same, 64 times denser"};
    tc_mesh *mesh = suite_synth("heatsink", 0, TC_REENTRY_CONVEXIFY);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    double unit = suite_diagonal(mesh) / cbrt((double)report.n_tet); /* the default */
    tc_transfer *tf = suite_benchmark(mesh);
    /* From the front, where most rays are about as long as the longest, and obliquely. */
    tc_camera front = suite_camera(mesh, 0, 0, 1, false), camera = suite_camera(mesh, 0.43, 0.5, 0.75, false);
    curve ahead = measure(mesh, tf, &front, 0, 1, unit), each[N_CURVE];
    each[BRUTE_FORCE] = measure(mesh, tf, &camera, -1, 1, unit);
    each[EARLY_Z] = measure(mesh, tf, &camera, 0, 1, unit);
    each[EARLY_Z_AND_STOP] = measure(mesh, tf, &camera, 0, 0.999, unit);
    each[DENSE_EARLY_Z_AND_STOP] = measure(mesh, tf, &camera, 0, 0.999, unit / 64);
    const curve *brute = &each[BRUTE_FORCE], *early = &each[EARLY_Z];
    double covered = (double)brute->stats.rays * brute->stats.passes;
    for (int k = 0; k < N_CURVE; k++)
        suite_say("%s: %lld fragments; %.3f of without z-updates, %.3f of covered pixels x passes, %.3f of screen x "
                  "passes; %d passes, longest ray %lld steps; %lld rays, %lld steps",
                  names[k], (long long)each[k].sum, (double)each[k].sum / (double)brute->sum,
                  (double)each[k].sum / covered, (double)each[k].sum / (SCREEN * brute->stats.passes),
                  each[k].stats.passes, (long long)each[k].stats.steps_max, (long long)each[k].stats.rays,
                  (long long)each[k].stats.steps);
    suite_say("from the front, early z: %lld fragments; %.3f of covered pixels x passes, %.3f of screen x passes",
              (long long)ahead.sum, (double)ahead.sum / ((double)ahead.stats.rays * ahead.stats.passes),
              (double)ahead.sum / (SCREEN * ahead.stats.passes));
    char path[1024];
    snprintf(path, sizeof path, "%s/fig8_%s.csv", TC_SUITE_OUT, suite_backend());
    write_figure(path, each);

    /* Without z-updates no pixel is spared in any pass. */
    for (size_t i = 0; i < brute->n; i++)
        assert_int_equal(brute->fragments[i], brute->fragments[0]);
    assert_true(brute->fragments[0] >= brute->stats.rays);
    assert_true((double)early->sum <= 0.6 * (double)brute->sum);
    assert_true((double)early->sum <= 0.6 * covered);
    assert_true((double)ahead.sum <= 0.6 * SCREEN * ahead.stats.passes);
    assert_true(each[EARLY_Z_AND_STOP].sum <= early->sum);
    assert_true((double)each[DENSE_EARLY_Z_AND_STOP].sum < 0.8 * (double)early->sum);
    expect_few_passes(&ahead);
    free(ahead.fragments);
    for (int k = 0; k < N_CURVE; k++)
        expect_few_passes(&each[k]);
    /* A fragment is a step, or waits for the next z-update: no ray is shaded longer than that. */
    for (int k = EARLY_Z; k < N_CURVE; k++) {
        const tc_render_stats *s = &each[k].stats;
        assert_true(each[k].sum >= s->steps);
        assert_true(each[k].sum <= s->steps + s->rays * (s->z_update_every + 4));
    }
    for (int k = 0; k < N_CURVE; k++)
        free(each[k].fragments);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void opacity_stop_costs_more_than_it_says(void **state)
{
    (void)state;
    static const double stops[] = {0.5, 0.9, 0.99, 0.999};
    static const tc_integrator integrators[] = {TC_INTEGRATOR_INTEGRAL, TC_INTEGRATOR_TABLE};
    tc_mesh *mesh = suite_synth("heatsink", 12000, TC_REENTRY_PEEL);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 1, 0.3, 0.4, false);
    for (int way = 0; way < 2; way++) {
        suite_prepare(mesh, way ? TC_REENTRY_CONVEXIFY : TC_REENTRY_PEEL);
        for (int k = 0; k < 2; k++) {
            tc_render_options options = suite_options(128, 128);
            options.integrator = integrators[k];
            options.unit_distance = suite_diagonal(mesh) / 400; /* dense: most rays stop */
            options.opacity_stop = 1;
            tc_image *whole = suite_render(NULL, mesh, tf, &camera, &options);
            for (int i = 0; i < 4; i++) {
                options.opacity_stop = stops[i];
                tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
                double difference = suite_difference(whole, image);
                int stopped = 0;
                for (int p = 0; p < 128 * 128; p++) {
                    float alpha = image->rgba[4 * p + 3], full = whole->rgba[4 * p + 3];
                    stopped += alpha != full;
                    if (alpha < (float)(stops[i] - 1e-6) && fabsf(full - alpha) > 1e-6f)
                        fail_msg("a ray stopped at alpha %g instead of %g", (double)alpha, stops[i]);
                }
                suite_say("%s, stop %g: error %.2e, %d rays stopped", k ? "table" : "integral", stops[i], difference,
                          stopped);
                assert_true(difference <= 1 - stops[i] + 1e-6);
                assert_true(stopped > 100); /* else nothing was tested */
                tc_image_destroy(&image);
            }
            tc_image_destroy(&whole);
        }
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steps_per_pass_change_the_picture),
        cmocka_unit_test(z_updates_change_the_picture),
        cmocka_unit_test(early_z_or_queries_do_not_work),
        cmocka_unit_test(opacity_stop_costs_more_than_it_says),
    };
    const struct CMUnitTest without_locks[] = {
        cmocka_unit_test(steps_per_pass_change_the_picture),
        cmocka_unit_test(opacity_stop_costs_more_than_it_says),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed =
        suite_locks() ? cmocka_run_group_tests(tests, NULL, NULL) : cmocka_run_group_tests(without_locks, NULL, NULL);
    suite_end();
    return failed;
}
