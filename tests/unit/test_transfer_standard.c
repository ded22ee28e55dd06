/* test_transfer_standard.c: the functions that errors and times are measured with are what their names promise. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "transfer_functions/transfer.h"

#include <math.h>
#include <string.h>

static tc_transfer *make(const char *name, double lo, double hi)
{
    tc_transfer *tf = NULL;
    tc_error err = {0};
    const double range[2] = {lo, hi};
    if (tc_transfer_standard(&tf, name, range, &err) != TC_OK)
        fail_msg("%s: %s", name, err.text);
    return tf;
}

/* Share of the range in which the attenuation is at least a. */
static double share_above(const tc_transfer *tf, double lo, double hi, double a)
{
    enum { N = 100000 };
    int n = 0;
    for (int i = 0; i < N; i++) {
        double value[4];
        tc_transfer_evaluate(value, tf, lo + (hi - lo) * (i + 0.5) / N);
        n += value[3] >= a;
    }
    return (double)n / N;
}

static void each_is_laid_over_the_range_and_keeps_its_name(void **state)
{
    (void)state;
    size_t n, knots;
    const tc_standard_function *list = tc_transfer_standard_list(&n);
    assert_int_equal(n, 4);
    for (size_t i = 0; i < n; i++) {
        tc_transfer *tf = make(list[i].name, -3, 7);
        const tc_knot *knot = tc_transfer_knots(tf, &knots);
        assert_true(fabs(knot[0].s + 3) < 1e-12 && fabs(knot[knots - 1].s - 7) < 1e-12);
        for (size_t k = 1; k < knots; k++)
            assert_true(knot[k].s >= knot[k - 1].s);
        if (i > 0)
            assert_string_equal(tc_transfer_name(tf), list[i].name);
        tc_transfer_destroy(&tf);
    }
}

static void each_has_the_shape_that_it_is_for(void **state)
{
    (void)state;
    size_t n;
    tc_transfer *smooth = make("smooth", 0, 10), *plain = NULL, *knots = make("knots12", 0, 10),
                *spike = make("spike", 0, 10), *steps = make("steps", 0, 10);
    const tc_transfer_options options = {.data_range = {0, 10}};
    assert_int_equal(tc_transfer_create(&plain, &options, NULL), TC_OK);
    for (double s = 0; s <= 10; s += 0.37) { /* the function without options */
        double a[4], b[4];
        tc_transfer_evaluate(a, smooth, s);
        tc_transfer_evaluate(b, plain, s);
        assert_memory_equal(a, b, sizeof a);
        assert_true(fabs(a[3] - 0.03 * s) < 1e-12);
    }
    tc_transfer_knots(knots, &n);
    assert_int_equal(n, 12);
    assert_true(fabs(share_above(spike, 0, 10, 0.15) - 1.0 / 500) < 1e-4); /* all of it but its feet */
    assert_true(share_above(spike, 0, 10, 29) > 0);
    const tc_knot *knot = tc_transfer_knots(steps, &n);
    int jumps = 0;
    for (size_t k = 1; k < n; k++) {
        bool jump = knot[k].s == knot[k - 1].s;
        jumps += jump;
        assert_true(jump || knot[k].a == knot[k - 1].a);
        assert_true(knot[k].a == 20 || knot[k].a < 0.2);
    }
    assert_in_range(jumps, 3, 12);
    tc_transfer_destroy(&smooth);
    tc_transfer_destroy(&plain);
    tc_transfer_destroy(&knots);
    tc_transfer_destroy(&spike);
    tc_transfer_destroy(&steps);
}

static void a_range_of_one_value_or_none_is_widened_and_an_unknown_name_is_refused(void **state)
{
    (void)state;
    const double one[2] = {5, 5}, none[2] = {INFINITY, -INFINITY};
    tc_transfer *tf = NULL;
    tc_error err = {0};
    double span[2];
    size_t n;
    const tc_standard_function *list = tc_transfer_standard_list(&n);
    for (size_t i = 0; i < n; i++) {
        assert_int_equal(tc_transfer_standard(&tf, list[i].name, one, &err), TC_OK);
        tc_transfer_span(span, tf);
        assert_true(span[0] < 5 && span[1] > 5);
        tc_transfer_destroy(&tf);
        assert_int_equal(tc_transfer_standard(&tf, list[i].name, none, &err), TC_OK);
        tc_transfer_destroy(&tf);
    }
    assert_int_equal(tc_transfer_standard(&tf, "wavy", one, &err), TC_E_ARG);
    assert_null(tf);
    assert_non_null(strstr(err.text, "'wavy'"));
    assert_non_null(strstr(err.text, "knots12"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_is_laid_over_the_range_and_keeps_its_name),
        cmocka_unit_test(each_has_the_shape_that_it_is_for),
        cmocka_unit_test(a_range_of_one_value_or_none_is_widened_and_an_unknown_name_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
