/* test_study_choose.c: which setting is chosen from given errors and times, and what is kept of a calibration. */
#define _GNU_SOURCE
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "mesh/mesh.h"
#include "study/calibration.h"
#include "study/candidate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* ---------------------------------------------------------------------------------------------------- candidates */

static size_t list(tc_candidate *out, const tc_render_options *fixed)
{
    size_t n = tc_candidate_list(out, fixed);
    assert_in_range(n, 1, TC_CANDIDATE_MAX);
    for (size_t i = 0; i < n; i++) {
        char a[TC_CANDIDATE_TEXT], b[TC_CANDIDATE_TEXT];
        assert_true(isnan(out[i].error) && isnan(out[i].ms));
        tc_candidate_key(a, &out[i]);
        assert_null(strchr(a, ' '));
        for (size_t k = 0; k < i; k++) {
            tc_candidate_key(b, &out[k]);
            assert_string_not_equal(a, b);
        }
        if (i > 0) {
            assert_in_range(out[i].group - out[i - 1].group, 0, 1);
            assert_true(out[i].group != out[i - 1].group || out[i].stop > out[i - 1].stop);
        }
    }
    return n;
}

static void what_is_fixed_stays(void **state)
{
    (void)state;
    const tc_render_options fixed[] = {
        {0},
        {.integrator = TC_INTEGRATOR_TABLE},
        {.integrator = TC_INTEGRATOR_TABLE, .table_size = {64, 64, 32}, .table_format = TC_TABLE_8},
        {.integrator = TC_INTEGRATOR_INTEGRAL, .integral_order = 1},
        {.integral_order = 2},
        {.integral_split = 0.3},
        {.integrator = TC_INTEGRATOR_EXACT},
        {.opacity_stop = 0.97},
        {.integrator = TC_INTEGRATOR_EXACT, .opacity_stop = 1},
    };
    for (size_t f = 0; f < sizeof fixed / sizeof *fixed; f++) {
        tc_candidate all[TC_CANDIDATE_MAX];
        size_t n = list(all, &fixed[f]);
        for (size_t i = 0; i < n; i++) {
            tc_render_options o = fixed[f];
            o.width = 77;
            o.samples = 4;
            tc_candidate_apply(&o, &all[i]);
            assert_int_equal(o.width, 77);
            assert_int_equal(o.samples, 4);
            assert_int_not_equal(o.integrator, TC_INTEGRATOR_AUTO);
            assert_true(o.opacity_stop > 0 && o.opacity_stop <= 1);
            if (fixed[f].integrator != TC_INTEGRATOR_AUTO)
                assert_int_equal(o.integrator, fixed[f].integrator);
            else
                assert_int_not_equal(o.integrator, TC_INTEGRATOR_TABLE);
            if (fixed[f].integral_order)
                assert_int_equal(o.integral_order, fixed[f].integral_order);
            if (fixed[f].integral_split > 0)
                assert_true(o.integral_split == fixed[f].integral_split && o.integrator == TC_INTEGRATOR_INTEGRAL);
            if (fixed[f].opacity_stop > 0)
                assert_true(o.opacity_stop == fixed[f].opacity_stop);
            if (fixed[f].table_size[0])
                assert_memory_equal(o.table_size, fixed[f].table_size, sizeof o.table_size);
            if (fixed[f].table_format)
                assert_int_equal(o.table_format, fixed[f].table_format);
        }
    }
}

/* Errors and times of settings with errors growing as the stop falls, from an error and a time of each group. */
static size_t fake(tc_candidate *out, const double *error, const double *ms, int groups)
{
    const tc_render_options none = {0};
    size_t n = list(out, &none), m = 0;
    for (size_t i = 0; i < n && out[i].group < groups; i++, m++) {
        out[i].error = fmax(error[out[i].group], 0.5 * (1 - out[i].stop));
        out[i].ms = ms[out[i].group] * (0.8 + 0.2 * out[i].stop);
    }
    return m;
}

static void the_cheapest_below_the_error_is_taken(void **state)
{
    (void)state;
    const double error[] = {0.02, 0.001, 1e-4, 1e-6}, ms[] = {10, 20, 15, 60};
    tc_candidate all[TC_CANDIDATE_MAX];
    size_t n = fake(all, error, ms, 4), index[TC_CANDIDATE_MAX];

    size_t m = tc_candidate_frugal(index, all, n, 0.03);
    assert_int_equal(m, 4);
    assert_int_equal(all[tc_candidate_cheapest(all, index, m)].group, 0);

    m = tc_candidate_frugal(index, all, n, 0.002); /* the first is out; the third is faster than the second */
    assert_int_equal(m, 3);
    for (size_t k = 0; k < m; k++)
        assert_true(all[index[k]].error <= 0.002 && all[index[k]].stop == 0.998);
    assert_int_equal(all[tc_candidate_cheapest(all, index, m)].group, 2);

    m = tc_candidate_frugal(index, all, n, 5e-5);
    assert_int_equal(m, 1);
    assert_int_equal(all[index[0]].group, 3);
    assert_true(all[index[0]].stop == 0.9999);
}

static void nothing_reaches_what_none_reaches(void **state)
{
    (void)state;
    const double error[] = {0.02, 1e-6}, ms[] = {10, 20};
    tc_candidate all[TC_CANDIDATE_MAX];
    size_t n = fake(all, error, ms, 2), index[TC_CANDIDATE_MAX];
    assert_int_equal(tc_candidate_frugal(index, all, n, 1e-8), 0);
    size_t best = tc_candidate_best(all, n);
    assert_int_equal(all[best].group, 1);
    assert_true(all[best].error == 1e-6 && all[best].stop == 1);

    for (size_t i = 0; i < n; i++)
        all[i].error = i % 2 ? INFINITY : NAN;
    assert_int_equal(tc_candidate_best(all, n), n);
    assert_int_equal(tc_candidate_frugal(index, all, n, 1), 0);
}

static void ties_go_to_the_more_accurate(void **state)
{
    (void)state;
    const double error[] = {1.5e-3, 1e-4, 1e-5}, ms[] = {20, 20.1, 30};
    tc_candidate all[TC_CANDIDATE_MAX];
    size_t n = fake(all, error, ms, 3), index[TC_CANDIDATE_MAX];
    size_t m = tc_candidate_frugal(index, all, n, 0.0016);
    assert_int_equal(all[tc_candidate_cheapest(all, index, m)].group, 1);
    for (size_t i = 0; i < n; i++) /* without times the first is as good as any */
        all[i].ms = NAN;
    assert_in_range(tc_candidate_cheapest(all, index, m), 0, n - 1);
}

static void a_stop_that_nothing_reaches_buys_nothing(void **state)
{
    (void)state;
    const double error[] = {1e-3}, ms[] = {20};
    tc_candidate all[TC_CANDIDATE_MAX];
    size_t n = fake(all, error, ms, 1), index[TC_CANDIDATE_MAX];
    size_t m = tc_candidate_ladder(index, all, n, 0);
    assert_in_range(m, 2, n - 1);
    for (size_t k = 1; k < m; k++)
        assert_true(all[index[k]].error < all[index[k - 1]].error);
    assert_true(all[index[m - 1]].error == 1e-3 && all[index[m - 1]].stop < 1);
    for (size_t i = 0; i < n; i++)
        all[i].error = 1e-6; /* a transparent scene */
    assert_int_equal(tc_candidate_ladder(index, all, n, 0), 1);
    assert_int_equal(index[0], 0);
    assert_int_equal(tc_candidate_best(all, n), 0);
}

/* ---------------------------------------------------------------------------------------------------------- cache */

static char folder[] = "/tmp/tetcast_choose_XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int drop_folder(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

/* The one file below folder/deep/er. */
static void file_of(char *out, size_t capacity)
{
    char command[128];
    snprintf(command, sizeof command, "ls %s/deep/er/*.json", folder);
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    assert_non_null(fgets(out, (int)capacity, pipe));
    out[strcspn(out, "\n")] = 0;
    pclose(pipe);
}

static void a_calibration_comes_back_as_it_was_kept(void **state)
{
    (void)state;
    const double error[] = {0.02, 0.001, 1e-4, 1e-6}, ms[] = {10, 20, 15, 60};
    tc_candidate all[TC_CANDIDATE_MAX], back[TC_CANDIDATE_MAX];
    const tc_render_options none = {0};
    size_t n = fake(all, error, ms, 4);
    char path[64], file[128];
    tc_calibration kept = {.rays = 27000, .ms = 812, .ratio = 1.25, .view = 0xfedcba9876543210u}, found = {0};
    all[1].error = INFINITY;
    all[2].ms = NAN;
    list(back, &none);
    snprintf(path, sizeof path, "%s/deep/er", folder);
    assert_false(tc_calibration_load(&found, back, n, path, "key one", NULL));
    tc_calibration_store(&kept, all, n, path, "key one", NULL);
    assert_true(tc_calibration_load(&found, back, n, path, "key one", NULL));
    assert_int_equal(found.rays, 27000);
    assert_true(found.ratio == 1.25 && found.ms == 812 && found.view == 0xfedcba9876543210u);
    for (size_t i = 0; i < n; i++) {
        assert_true(back[i].error == all[i].error || fabs(back[i].error - all[i].error) <= 1e-8 * all[i].error);
        assert_true(isnan(all[i].ms) ? isnan(back[i].ms) : fabs(back[i].ms - all[i].ms) <= 1e-8 * all[i].ms);
    }
    assert_false(tc_calibration_load(&found, back, n, path, "key two", NULL));

    /* Damaged, of another key under its name, or without a setting: ignored, and nothing is changed. */
    file_of(file, sizeof file);
    static const char *const wrong[] = {
        "",
        "{\"key\": \"key one\"",
        "[]",
        "{\"key\": \"key two\", \"rays\": 1, \"ms\": 1, \"ratio\": 1, \"candidates\": {}}",
        "{\"key\": \"key one\", \"rays\": 1, \"ms\": 1, \"ratio\": 1, \"candidates\": {}}",
        "{\"key\": \"key one\", \"rays\": -1, \"ms\": 1, \"ratio\": 1, \"candidates\": {}}",
        "{\"key\": \"key one\", \"rays\": 1, \"ms\": 1, \"ratio\": 1, \"candidates\": {\"exact-1\": {\"error\": -1}}}",
    };
    for (size_t w = 0; w < sizeof wrong / sizeof *wrong; w++) {
        FILE *stream = fopen(file, "w");
        assert_non_null(stream);
        fputs(wrong[w], stream);
        fclose(stream);
        list(back, &none);
        assert_false(tc_calibration_load(&found, back, n, path, "key one", NULL));
        assert_true(isnan(back[0].error));
    }
    tc_calibration_store(&kept, all, n, path, "key one", NULL);
    assert_true(tc_calibration_load(&found, back, n, path, "key one", NULL));
}

static void a_folder_that_cannot_be_is_no_error(void **state)
{
    (void)state;
    const double error[] = {0.02}, ms[] = {10};
    tc_candidate all[TC_CANDIDATE_MAX];
    size_t n = fake(all, error, ms, 1);
    tc_calibration kept = {.rays = 1, .ratio = 1};
    tc_calibration_store(&kept, all, n, "/dev/null/cache", "key", NULL);
    assert_false(tc_calibration_load(&kept, all, n, "/dev/null/cache", "key", NULL));
    tc_calibration_store(&kept, all, n, "/proc/cache", "key", NULL);
    assert_false(tc_calibration_load(&kept, all, n, "/proc/cache", "key", NULL));
}

static void the_folder_follows_the_environment(void **state)
{
    (void)state;
    char out[256];
    setenv("TETCAST_CACHE", "/a", 1);
    setenv("XDG_CACHE_HOME", "/b", 1);
    setenv("HOME", "/c", 1);
    tc_calibration_folder(out, sizeof out, "/mine");
    assert_string_equal(out, "/mine");
    tc_calibration_folder(out, sizeof out, NULL);
    assert_string_equal(out, "/a");
    unsetenv("TETCAST_CACHE");
    tc_calibration_folder(out, sizeof out, NULL);
    assert_string_equal(out, "/b/tetcast");
    setenv("XDG_CACHE_HOME", "relative", 1);
    tc_calibration_folder(out, sizeof out, NULL);
    assert_string_equal(out, "/c/.cache/tetcast");
    unsetenv("HOME");
    tc_calibration_folder(out, sizeof out, NULL);
    assert_string_equal(out, "");
}

/* The key tells apart whatever errors depend on, and nothing else. */
static void the_key_is_of_all_that_matters(void **state)
{
    (void)state;
    double vertex[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, scalar[] = {0, 1, 2, 3};
    int32_t tet[] = {0, 1, 2, 3};
    tc_knot knot[] = {{0, 0, 0, 0, 0}, {3, 1, 1, 1, 0.3}};
    struct tc_mesh mesh = {
        .n_vertex = 4, .vertex = vertex, .n_tet = 1, .tet = tet, .scalar = scalar, .association = TC_POINT_DATA};
    struct tc_transfer tf = {.n = 2, .knot = knot};
    tc_render_options fixed = {.width = 10, .height = 10};
    char *first = tc_calibration_key(&mesh, &tf, 1, "r", &fixed), *other;
#define DIFFERS(change, back)                                                                                          \
    change;                                                                                                            \
    other = tc_calibration_key(&mesh, &tf, 1, "r", &fixed);                                                            \
    assert_string_not_equal(first, other);                                                                             \
    free(other);                                                                                                       \
    back
    DIFFERS(vertex[4] = 1e-300, vertex[4] = 0);
    DIFFERS(tet[2] = 3, tet[2] = 2);
    DIFFERS(scalar[3] = 3.0000001, scalar[3] = 3);
    DIFFERS(knot[1].a = 0.31, knot[1].a = 0.3);
    DIFFERS(fixed.has_nan_color = true, fixed.has_nan_color = false);
    DIFFERS(fixed.integrator = TC_INTEGRATOR_TABLE, fixed.integrator = TC_INTEGRATOR_AUTO);
    DIFFERS(fixed.opacity_stop = 0.9, fixed.opacity_stop = 0);
    DIFFERS(fixed.samples = TC_SAMPLES_ADAPTIVE, fixed.samples = 0);
    DIFFERS(fixed.state_format = TC_STATE_16F, fixed.state_format = TC_STATE_AUTO);
    other = tc_calibration_key(&mesh, &tf, 2, "r", &fixed);
    assert_string_not_equal(first, other);
    free(other);
    other = tc_calibration_key(&mesh, &tf, 1, "s", &fixed);
    assert_string_not_equal(first, other);
    free(other);
    fixed.width = 400;
    fixed.samples = 16;
    other = tc_calibration_key(&mesh, &tf, 1, "r", &fixed);
    assert_string_equal(first, other);
    free(other);
    free(first);

    tc_camera camera = {.position = {0, 0, 5}, .view_up = {0, 1, 0}, .view_angle = 30};
    uint64_t view = tc_calibration_view(&camera, &fixed);
    assert_true(view != 0 && view == tc_calibration_view(&camera, &fixed));
    camera.position[0] = 1;
    assert_true(view != tc_calibration_view(&camera, &fixed));
    camera.position[0] = 0;
    fixed.width = 10;
    assert_true(view != tc_calibration_view(&camera, &fixed));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_fixed_stays),
        cmocka_unit_test(the_cheapest_below_the_error_is_taken),
        cmocka_unit_test(nothing_reaches_what_none_reaches),
        cmocka_unit_test(ties_go_to_the_more_accurate),
        cmocka_unit_test(a_stop_that_nothing_reaches_buys_nothing),
        cmocka_unit_test(a_calibration_comes_back_as_it_was_kept),
        cmocka_unit_test(a_folder_that_cannot_be_is_no_error),
        cmocka_unit_test(the_folder_follows_the_environment),
        cmocka_unit_test(the_key_is_of_all_that_matters),
    };
    return cmocka_run_group_tests(tests, make_folder, drop_folder);
}
