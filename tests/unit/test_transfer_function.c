/* Tests of the piecewise linear transfer function and of its running integrals. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "transfer_functions/running.h"
#include "transfer_make.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static void evaluation_takes_wrong_side_of_a_step(void **state)
{
    (void)state;
    const tc_knot knot[] = {{0, 0, 0, 0, 0}, {1, 1, 0, 0, 2}, {1, 0, 1, 0, 4}, {3, 0, 0, 1, 0}};
    tc_transfer *tf = make(knot, 4);
    double v[4];
    tc_transfer_evaluate(v, tf, 0.5);
    assert_float_equal(v[0], 0.5, 1e-15);
    assert_float_equal(v[3], 1, 1e-15);
    tc_transfer_evaluate(v, tf, 1);
    assert_float_equal(v[0], 0, 0);
    assert_float_equal(v[1], 1, 0);
    assert_float_equal(v[3], 4, 0);
    tc_transfer_evaluate(v, tf, nextafter(1, 0));
    assert_float_equal(v[3], 2, 1e-12);
    tc_transfer_evaluate(v, tf, -7);
    assert_float_equal(v[3], 0, 0);
    tc_transfer_evaluate(v, tf, 7);
    assert_float_equal(v[2], 1, 0);
    tc_transfer_evaluate(v, tf, 2);
    assert_float_equal(v[1], 0.5, 1e-15);
    tc_transfer_destroy(&tf);
    assert_null(tf);
    tc_transfer_destroy(&tf);
}

static void step_at_the_ends_is_lost(void **state)
{
    (void)state;
    const tc_knot knot[] = {{0, 0, 0, 0, 1}, {0, 0, 0, 0, 2}, {1, 0, 0, 0, 3}, {1, 0, 0, 0, 4}};
    tc_transfer *tf = make(knot, 4);
    double v[4];
    tc_transfer_evaluate(v, tf, -1e-9);
    assert_float_equal(v[3], 1, 0);
    tc_transfer_evaluate(v, tf, 0);
    assert_float_equal(v[3], 2, 0);
    tc_transfer_evaluate(v, tf, 1);
    assert_float_equal(v[3], 4, 0);
    tc_transfer_destroy(&tf);
}

static void the_peak_is_elsewhere(void **state)
{
    (void)state;
    const tc_knot knot[] = {{0, 0, 0, 0, 0}, {1, 0, 0, 0, 0}, {2, 0, 0, 0, 4}, {2, 0, 0, 0, 1}, {3, 0, 0, 0, 0.5}};
    const double range[][3] = {{0, 1, 0},   {-5, 1, 0},   {0.2, 0.8, 0}, {0, 1.5, 2}, {1.25, 1.75, 3}, {0, 9, 4},
                               {2, 2, 4},   {2.5, 9, 0.75}, {3, 3, 0.5},   {4, 9, 0.5}, {-2, -1, 0},     {1, 1, 0}};
    tc_transfer *tf = make(knot, 5);
    for (size_t i = 0; i < sizeof range / sizeof *range; i++)
        assert_float_equal(tc_transfer_peak(tf, range[i][0], range[i][1]), range[i][2], 1e-15);
    tc_transfer_destroy(&tf);
}

static void single_knot_or_zero_width_gives_an_empty_span(void **state)
{
    (void)state;
    const double places[] = {0, 5, -3e7, 1e-300, 5e-324};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const tc_knot knot[] = {{places[i], 0.5, 0.5, 0.5, 3}, {places[i], 0.1, 0.5, 0.5, 2}};
        for (size_t n = 1; n <= 2; n++) {
            tc_transfer *tf = make(knot, n);
            double span[2];
            tc_transfer_span(span, tf);
            assert_true(span[0] < span[1]);
            assert_true(span[0] <= places[i] && places[i] <= span[1]);
            tc_transfer_destroy(&tf);
        }
    }
}

static void bad_knots_are_taken(void **state)
{
    (void)state;
    const tc_knot good = {0, 0, 0, 0, 0};
    const tc_knot bad[] = {{NAN, 0, 0, 0, 0}, {INFINITY, 0, 0, 0, 0}, {1, NAN, 0, 0, 0}, {1, 2, 0, 0, 0},
                           {1, 0, -1, 0, 0},  {1, 0, 0, 0, NAN},      {1, 0, 0, 0, -1},  {-1, 0, 0, 0, 0}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const tc_knot knot[] = {good, bad[i]};
        tc_transfer *tf = NULL;
        tc_error err = {0};
        assert_int_equal(tc_transfer_from_knots(&tf, knot, 2, &err), TC_E_ARG);
        assert_null(tf);
        assert_non_null(strstr(err.text, "knot 1"));
    }
    tc_transfer *tf = NULL;
    assert_int_equal(tc_transfer_from_knots(&tf, &good, 0, NULL), TC_E_ARG);
    assert_int_equal(tc_transfer_from_knots(&tf, NULL, 3, NULL), TC_E_ARG);
}

static void serial_does_not_follow_the_knots(void **state)
{
    (void)state;
    tc_knot knot[] = {{0, 0, 0, 0, 0}, {1, 1, 1, 1, 1}};
    tc_transfer *a = make(knot, 2), *b = make(knot, 2);
    assert_int_equal(a->serial, b->serial);
    knot[1].a = nextafter(1, 2);
    tc_transfer *c = make(knot, 2);
    assert_int_not_equal(a->serial, c->serial);
    tc_transfer_destroy(&a);
    tc_transfer_destroy(&b);
    tc_transfer_destroy(&c);
}

static void knots_between_two_at_one_place_are_kept(void **state)
{
    (void)state;
    const tc_knot knot[] = {{1, 0, 0, 0, 0}, {1, 0, 0, 0, 9}, {1, 0, 0, 0, 8}, {1, 0, 0, 0, 2}, {2, 0, 0, 0, 0}};
    tc_transfer *tf = make(knot, 5);
    size_t n = 0;
    const tc_knot *kept = tc_transfer_knots(tf, &n);
    assert_int_equal(n, 3);
    assert_float_equal(kept[0].a, 0, 0);
    assert_float_equal(kept[1].a, 2, 0);
    tc_transfer_destroy(&tf);
}

/* Emission and extinction integrated over [a, b] by the three-point Gauss rule between all knots (exact for
 * quadratics). */
static void integrate(double out[4], const tc_transfer *tf, double a, double b)
{
    static const double x[3] = {-0.7745966692414834, 0, 0.7745966692414834};
    static const double w[3] = {5.0 / 9, 8.0 / 9, 5.0 / 9};
    for (int c = 0; c < 4; c++)
        out[c] = 0;
    double lo = a;
    for (size_t k = 0; k <= tf->n && lo < b; k++) {
        double hi = k < tf->n ? tf->knot[k].s : b;
        hi = hi < b ? hi : b;
        if (hi <= lo)
            continue;
        for (int g = 0; g < 3; g++) {
            double v[4];
            tc_transfer_evaluate(v, tf, 0.5 * (lo + hi) + 0.5 * (hi - lo) * x[g]);
            for (int c = 0; c < 4; c++)
                out[c] += 0.5 * (hi - lo) * w[g] * v[3] * (c < 3 ? v[c] : 1);
        }
        lo = hi;
    }
}

static void running_integrals_are_not_exact_at_nodes(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int round = 0; round < 40; round++) {
        tc_knot knot[30];
        size_t n = 1 + (size_t)(random01(&seed) * 29);
        double s = -3;
        for (size_t i = 0; i < n; i++) {
            s += random01(&seed) < 0.2 ? 0 : random01(&seed);
            knot[i] = (tc_knot){s, random01(&seed), random01(&seed), random01(&seed), 5 * random01(&seed)};
        }
        tc_transfer *tf = make(knot, n);
        const double span[2] = {-4 + 2 * random01(&seed), s + 2 * random01(&seed) - 0.3};
        if (!(span[0] < span[1])) {
            tc_transfer_destroy(&tf);
            continue;
        }
        tc_running running;
        tc_error err = {0};
        const int nodes = 2 + (int)(random01(&seed) * 60);
        assert_int_equal(tc_running_build(&running, tf, nodes, span, false, &err), TC_OK);
        for (int i = 0; i < nodes; i++) {
            const double x = (double)i / (nodes - 1), at = span[0] + (span[1] - span[0]) * x;
            double want[4], value[4];
            integrate(want, tf, span[0], at);
            tc_transfer_evaluate(value, tf, at);
            for (int c = 0; c < 4; c++) {
                const double got = running.cumulative[4 * i + c] + running.mean[c] * x;
                assert_float_equal(got, want[c] / (span[1] - span[0]), 1e-6);
                if (i > 0 && i < nodes - 1)
                    assert_float_equal(running.point[4 * i + c], value[3] * (c < 3 ? value[c] : 1), 1e-5);
            }
        }
        tc_running_finish(&running);
        tc_transfer_destroy(&tf);
    }
}

static void constant_function_leaves_a_remainder(void **state)
{
    (void)state;
    const tc_knot knot[] = {{0, 0.1, 0.7, 1.0 / 3, 0.3}, {0.37, 0.1, 0.7, 1.0 / 3, 0.3}, {1, 0.1, 0.7, 1.0 / 3, 0.3}};
    tc_transfer *tf = make(knot, 3);
    const double span[2] = {-0.1, 1.3};
    tc_running running;
    assert_int_equal(tc_running_build(&running, tf, 1000, span, false, NULL), TC_OK);
    for (int i = 0; i < 4000; i++)
        assert_true(running.cumulative[i] == 0);
    assert_float_equal(running.mean[3], 0.3, 1e-16);
    tc_running_finish(&running);
    tc_transfer_destroy(&tf);
}

static void node_at_a_step_takes_one_side(void **state)
{
    (void)state;
    const tc_knot knot[] = {{0, 1, 1, 1, 0}, {0.3, 1, 1, 1, 0}, {0.3, 1, 1, 0, 2}, {1, 1, 1, 0, 2}};
    tc_transfer *tf = make(knot, 4);
    const double span[2] = {0, 1};
    tc_running running;
    assert_int_equal(tc_running_build(&running, tf, 11, span, false, NULL), TC_OK);
    assert_float_equal(running.point[4 * 2 + 3], 0, 0);
    assert_float_equal(running.point[4 * 3 + 3], 1, 0);
    assert_float_equal(running.point[4 * 4 + 3], 2, 0);
    assert_float_equal(running.mean[3], 0, 0); /* it is clear over a part of the span */
    assert_float_equal(running.cumulative[4 * 10 + 3], 1.4, 1e-7);
    assert_float_equal(running.cumulative[4 * 2 + 3], 0, 0);
    tc_running_finish(&running);
    tc_transfer_destroy(&tf);
}

static void running_integrals_accept_bad_input_or_fail_on_many_knots(void **state)
{
    (void)state;
    const tc_knot one = {2, 0.2, 0.4, 0.6, 0.5};
    tc_transfer *tf = make(&one, 1);
    tc_running running;
    const double good[2] = {0, 1}, empty[2] = {1, 1}, backward[2] = {1, 0}, nan[2] = {NAN, 1};
    assert_int_equal(tc_running_build(&running, tf, 1, good, false, NULL), TC_E_ARG);
    assert_int_equal(tc_running_build(&running, tf, 8, empty, false, NULL), TC_E_ARG);
    assert_int_equal(tc_running_build(&running, tf, 8, backward, false, NULL), TC_E_ARG);
    assert_int_equal(tc_running_build(&running, tf, 8, nan, false, NULL), TC_E_ARG);
    tc_transfer_destroy(&tf);

    enum { MANY = 10000 };
    tc_knot *knot = malloc(MANY * sizeof *knot);
    for (int i = 0; i < MANY; i++)
        knot[i] = (tc_knot){i, 1, 0.5, 0, i % 2};
    tf = make(knot, MANY);
    const double span[2] = {0, MANY - 1};
    assert_int_equal(tc_running_build(&running, tf, 257, span, false, NULL), TC_OK);
    assert_float_equal(running.mean[3], 0.5, 1e-12);
    assert_float_equal(running.mean[1], 0.25, 1e-12);
    tc_running_finish(&running);
    tc_transfer_destroy(&tf);
    free(knot);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(evaluation_takes_wrong_side_of_a_step),
        cmocka_unit_test(step_at_the_ends_is_lost),
        cmocka_unit_test(the_peak_is_elsewhere),
        cmocka_unit_test(single_knot_or_zero_width_gives_an_empty_span),
        cmocka_unit_test(bad_knots_are_taken),
        cmocka_unit_test(serial_does_not_follow_the_knots),
        cmocka_unit_test(knots_between_two_at_one_place_are_kept),
        cmocka_unit_test(running_integrals_are_not_exact_at_nodes),
        cmocka_unit_test(constant_function_leaves_a_remainder),
        cmocka_unit_test(node_at_a_step_takes_one_side),
        cmocka_unit_test(running_integrals_accept_bad_input_or_fail_on_many_knots),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
