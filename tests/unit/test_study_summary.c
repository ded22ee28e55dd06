/* test_study_summary.c: medians, percentiles, the front of error against time, and sums over views. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "study/settings.h"
#include "study/summary.h"

#include <math.h>
#include <string.h>

static void median_is_the_middle_or_the_mean_of_the_middle_two(void **state)
{
    (void)state;
    double odd[] = {9, 1, 5}, even[] = {4, 1, 3, 2};
    assert_true(tc_median(odd, 3) == 5);
    assert_true(tc_median(even, 4) == 2.5);
    assert_true(isnan(tc_median(even, 0)));
}

static void percentile_leaves_no_more_above_it_than_its_share_says(void **state)
{
    (void)state;
    enum { N = 12345 };
    static double value[N], ordered[N];
    static const double share[] = {0, 0.5, 0.9, 0.999, 0.9999, 1};
    for (size_t i = 0; i < N; i++)
        value[i] = (double)(i * 7919 % N);
    memcpy(ordered, value, sizeof value);
    for (size_t k = 0; k < sizeof share / sizeof *share; k++) {
        double p = tc_percentile(ordered, N, share[k]);
        size_t not_above = 0, below = 0;
        for (size_t i = 0; i < N; i++) {
            not_above += value[i] <= p;
            below += value[i] < p;
        }
        assert_true((double)not_above >= share[k] * N);
        assert_true(below == 0 || (double)below < share[k] * N);
    }
    assert_true(isnan(tc_percentile(ordered, 0, 0.5)));
}

static void front_holds_what_nothing_else_beats_and_nothing_else(void **state)
{
    (void)state;
    static const double time[] = {1, 2, 3, 2, 4, 1, NAN, 5}, error[] = {9, 5, 5, 5, 1, 9.5, 0, NAN};
    static const bool expected[] = {true, true, false, true, true, false, false, false};
    bool front[8];
    tc_front(front, time, error, 8);
    for (size_t i = 0; i < 8; i++)
        assert_int_equal(front[i], expected[i]);
}

static tc_study_row row(const char *function, int view, const char *setting, double ms, double error)
{
    size_t n;
    tc_study_row r;
    tc_study_row_clear(&r);
    strcpy(r.scene, "cube");
    strcpy(r.function, function);
    strcpy(r.truth, "ray");
    r.view = view;
    r.setting = tc_study_settings(&n)[tc_study_find(setting)].name;
    r.knob = tc_study_settings(&n)[tc_study_find(setting)].knob;
    r.ms_median = ms;
    r.ms_min = ms - 1;
    r.ms_max = ms + 1;
    r.max_error = error;
    r.mean_error = error / 10;
    r.pixels = 100 * (view + 1);
    r.ill_posed = view;
    r.rays = 50;
    r.rays_lost = 0;
    r.steps_per_ray = 4;
    return r;
}

static const tc_sum *find(const tc_summary *s, const char *function, const char *setting)
{
    for (size_t i = 0; i < s->n; i++)
        if (!strcmp(s->sum[i].row.function, function) && !strcmp(s->sum[i].row.setting, setting))
            return &s->sum[i];
    fail_msg("no %s of %s", setting, function);
    return NULL;
}

static void sums_take_the_worst_error_and_the_median_time_of_each_pair_alone(void **state)
{
    (void)state;
    tc_error err = {0};
    tc_summary s;
    tc_study_row rows[] = {
        row("a", 0, "default", 10, 1e-3), row("a", 0, "exact", 20, 1e-6),   row("a", 1, "default", 30, 4e-3),
        row("a", 1, "exact", 90, 2e-6),   row("a", 2, "default", 20, 2e-3), row("a", 2, "exact", 50, 3e-6),
        row("b", 0, "default", 1, 0.5),   row("b", 0, "table8", 2, 0.6),    row("b", 0, "planes", 0.5, 0.1),
    };
    rows[8].rays_lost = 3;
    assert_int_equal(tc_summary_build(&s, rows, sizeof rows / sizeof *rows, &err), TC_OK);
    assert_int_equal(s.n, 5);
    const tc_sum *d = find(&s, "a", "default"), *e = find(&s, "a", "exact");
    assert_int_equal(d->views, 3);
    assert_true(d->row.ms_median == 20 && d->row.ms_min == 9 && d->row.ms_max == 31);
    assert_true(d->row.max_error == 4e-3 && e->row.max_error == 3e-6);
    assert_int_equal(d->row.pixels, 600);
    assert_int_equal(d->row.ill_posed, 3);
    assert_true(fabs(d->row.mean_error - (1e-4 * 100 + 4e-4 * 199 + 2e-4 * 298) / 597) < 1e-12);
    assert_true(d->time_ratio == 1 && e->time_ratio == 2.5); /* of 2, 3 and 2.5 */
    assert_true(d->front && e->front);
    assert_true(find(&s, "b", "default")->front);
    assert_false(find(&s, "b", "table8")->front);
    assert_false(find(&s, "b", "planes")->front); /* it lost rays */
    assert_int_equal(find(&s, "b", "planes")->row.rays_lost, 3);
    tc_summary_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(median_is_the_middle_or_the_mean_of_the_middle_two),
        cmocka_unit_test(percentile_leaves_no_more_above_it_than_its_share_says),
        cmocka_unit_test(front_holds_what_nothing_else_beats_and_nothing_else),
        cmocka_unit_test(sums_take_the_worst_error_and_the_median_time_of_each_pair_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
