/* test_transfer_thin.c: a function of fewer knots that stands for another. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "transfer_functions/thin.h"
#include "transfer_make.h"

#include <math.h>
#include <stdlib.h>

static tc_transfer *thin(const tc_transfer *tf, double tolerance)
{
    tc_transfer *out;
    tc_error err = {0};
    if (tc_transfer_thin(&out, tf, tolerance, &err) != TC_OK)
        fail_msg("%s", err.text);
    return out;
}

/* Largest difference of a channel, and largest share of attenuation, at knots and between them. */
static void differ(double out[2], const tc_transfer *a, const tc_transfer *b)
{
    out[0] = out[1] = 0;
    for (size_t i = 0; i + 1 < a->n; i++)
        for (int part = 0; part < 8; part++) { /* not the knots: at a step only one side would be seen */
            double s = a->knot[i].s + (a->knot[i + 1].s - a->knot[i].s) * (part + 0.5) / 8, va[4], vb[4];
            tc_transfer_evaluate(va, a, s);
            tc_transfer_evaluate(vb, b, s);
            for (int c = 0; c < 3; c++)
                out[0] = fmax(out[0], fabs(va[c] - vb[c]));
            out[1] = fmax(out[1], fabs(va[3] - vb[3]) / fmax(1e-300, fmin(va[3], vb[3])));
        }
}

static void a_color_map_keeps_its_knots_or_changes(void **state)
{
    (void)state;
    tc_transfer *tf;
    tc_error err = {0};
    const tc_transfer_options options = {.data_range = {-3, 5}};
    if (tc_transfer_create(&tf, &options, &err) != TC_OK)
        fail_msg("%s", err.text);
    size_t before = tf->n;
    for (double tolerance = 1e-4; tolerance < 0.1; tolerance *= 4) {
        tc_transfer *fewer = thin(tf, tolerance);
        double d[2];
        differ(d, tf, fewer);
        print_message("    %zu knots, to %g: %zu, differs by %.2g and %.2g\n", tf->n, tolerance, fewer->n, d[0], d[1]);
        assert_true(fewer->n < before);
        assert_true(d[0] <= tolerance * (1 + 1e-9) && d[1] <= tolerance * (1 + 1e-9));
        assert_true(fewer->knot[0].s == tf->knot[0].s && fewer->knot[fewer->n - 1].s == tf->knot[tf->n - 1].s);
        before = fewer->n;
        tc_transfer_destroy(&fewer);
    }
    tc_transfer_destroy(&tf);
}

static void knots_on_a_line_stay(void **state)
{
    static const tc_knot line[] = {
        {0, 0, 1, 0.5, 0}, {1, 0.25, 0.75, 0.5, 2}, {3, 0.75, 0.25, 0.5, 6}, {4, 1, 0, 0.5, 8}};
    (void)state;
    tc_transfer *tf = make(line, 4), *two = thin(tf, 1e-12);
    assert_int_equal(two->n, 2);
    assert_true(two->knot[1].a == 8);
    tc_transfer_destroy(&two);
    tc_transfer_destroy(&tf);
}

static void a_step_or_a_spike_goes(void **state)
{
    static const tc_knot knot[] = {{0, 0, 0, 0, 1},      {1, 0, 0, 0, 1},      {1, 0, 0, 0, 2},
                                   {2, 0, 0, 0, 2},      {2, 1, 0, 0, 2},      {3, 1, 0, 0, 2},
                                   {3.0001, 1, 0, 0, 9}, {3.0002, 1, 0, 0, 2}, {9, 1, 0, 0, 2}};
    (void)state;
    tc_transfer *tf = make(knot, sizeof knot / sizeof *knot), *same = thin(tf, 0.01);
    assert_int_equal(same->n, tf->n);
    tc_transfer_destroy(&same);
    tc_transfer_destroy(&tf);
}

/* However thin: the share of it counts, and nothing is not the same as little. */
static void thin_attenuation_turns_into_none(void **state)
{
    static const tc_knot knot[] = {
        {0, 0, 0, 0, 0}, {1, 0, 0, 0, 1e-9}, {2, 0, 0, 0, 0}, {3, 0, 0, 0, 0}, {4, 0, 0, 0, 0}};
    (void)state;
    tc_transfer *tf = make(knot, sizeof knot / sizeof *knot), *fewer = thin(tf, 0.1);
    assert_int_equal(fewer->n, 4); /* one of the clear ones is on a line */
    assert_true(fewer->knot[1].a == 1e-9);
    tc_transfer_destroy(&fewer);
    tc_transfer_destroy(&tf);
}

static void bad_arguments_or_single_knots_fail_otherwise(void **state)
{
    static const tc_knot knot[] = {{1, 0.5, 0, 0, 3}};
    (void)state;
    tc_transfer *tf = make(knot, 1), *out = thin(tf, 1);
    assert_int_equal(out->n, tf->n);
    tc_transfer_destroy(&out);
    tc_error err = {0};
    assert_int_equal(tc_transfer_thin(&out, tf, -1, &err), TC_E_ARG);
    assert_int_equal(tc_transfer_thin(&out, tf, NAN, &err), TC_E_ARG);
    assert_null(out);
    tc_transfer_destroy(&tf);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_color_map_keeps_its_knots_or_changes),
        cmocka_unit_test(knots_on_a_line_stay),
        cmocka_unit_test(a_step_or_a_spike_goes),
        cmocka_unit_test(thin_attenuation_turns_into_none),
        cmocka_unit_test(bad_arguments_or_single_knots_fail_otherwise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
