/* test_edit_axis.c: places on an axis, and the numbers it is marked with. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "edit/axis.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CAPACITY = 200 };

static uint64_t state_of_random = 1;

static double uniform(double lo, double hi)
{
    state_of_random = state_of_random * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * ((double)(state_of_random >> 11) * 0x1p-53);
}

static tc_axis axis_of(double top, bool log)
{
    return (tc_axis){.top = top, .log = log, .decades = 5, .foot = 0.06};
}

static void place_and_value_are_inverses(void **state)
{
    (void)state;
    for (int i = 0; i < 100000; i++) {
        tc_axis axis = {.top = pow(10, uniform(-12, 12)), .log = i & 1, .decades = uniform(0.5, 12)};
        axis.foot = uniform(0.01, 0.3);
        double place = uniform(-0.5, 1.5);
        double value = tc_axis_value(&axis, place);
        assert_true(fabs(tc_axis_place(&axis, value) - place) <= 1e-12);
        value = axis.top * (i & 2 ? pow(10, uniform(-15, 1)) : uniform(-0.1, 2));
        double again = tc_axis_value(&axis, tc_axis_place(&axis, value));
        assert_true(fabs(again - value) <= 1e-12 * (axis.log ? fabs(value) : fmax(fabs(value), axis.top)));
    }
}

static void ends_and_foot_are_where_they_are_promised(void **state)
{
    (void)state;
    const double top[] = {1, 0.3, 1e-9, 12345.678};
    for (size_t i = 0; i < sizeof top / sizeof *top; i++)
        for (int log = 0; log < 2; log++) {
            tc_axis axis = axis_of(top[i], log);
            assert_true(tc_axis_place(&axis, 0) == 0 && tc_axis_value(&axis, 0) == 0);
            assert_true(tc_axis_place(&axis, top[i]) == 1 && tc_axis_value(&axis, 1) == top[i]);
            if (log) { /* evenly down to the foot, by decades */
                for (int e = 0; e <= 5; e++)
                    assert_true(fabs(tc_axis_place(&axis, top[i] * pow(10, -e)) - (1 - 0.94 * e / 5)) < 1e-12);
                assert_true(fabs(tc_axis_place(&axis, top[i] * 0.5e-5) - 0.03) < 1e-12);
            }
        }
}

static void a_larger_value_is_never_at_a_lower_place(void **state)
{
    (void)state;
    tc_axis axis = axis_of(0.3, true);
    double at = 0.3e-5, before = -1;
    for (int i = 0; i < 200; i++) /* down past the foot's end, one double after the other */
        at = nextafter(at, 0);
    for (int i = 0; i < 400; i++, at = nextafter(at, 1)) {
        double place = tc_axis_place(&axis, at);
        assert_true(place >= before && fabs(place - 0.06) < 1e-12);
        before = place;
    }
    before = -1;
    for (int i = 0; i <= 100000; i++) {
        double place = tc_axis_place(&axis, 0.3 * i / 1e5);
        assert_true(place > before);
        before = place;
    }
}

/* "0 [-] 0.1 [----] 0.2": labels and how many small marks lie between them. */
static void write_marks(char *out, const tc_axis_tick *tick, size_t n)
{
    *out = 0;
    for (size_t i = 0; i < n; i++)
        sprintf(out + strlen(out), "%s%s", tick[i].label[0] ? " " : "", tick[i].label[0] ? tick[i].label : ".");
}

static void expect_range(double lo, double hi, bool log, int labels, const char *expected)
{
    tc_axis_tick tick[CAPACITY];
    char text[4000];
    write_marks(text, tick, tc_range_ticks(tick, CAPACITY, lo, hi, log, labels));
    assert_string_equal(text, expected);
}

static void a_range_is_marked_with_round_numbers(void **state)
{
    (void)state;
    expect_range(0, 1, false, 6, " 0... 0.2... 0.4... 0.6... 0.8... 1");
    expect_range(0, 1, false, 3, " 0.... 0.5.... 1");
    expect_range(0, 1, false, 5, " 0.... 0.25.... 0.5.... 0.75.... 1");
    expect_range(0.3, 0.9, false, 7, " 0.3.... 0.4.... 0.5.... 0.6.... 0.7.... 0.8.... 0.9");
    expect_range(-3, 3, false, 4, ".. -2... 0... 2..");
    expect_range(0.00019, 0.00041, false, 3, " 0.0002.... 0.0003.... 0.0004");
    expect_range(1e-7, 3e-7, false, 3, " 1e-7.... 2e-7.... 3e-7");
    expect_range(0, 4e6, false, 5, " 0.... 1e6.... 2e6.... 3e6.... 4e6");
    expect_range(101325, 101325.5, false, 3, " 101325... 101325.2... 101325.4..");
    expect_range(1, 1000, true, 4, " 1........ 10........ 100........ 1000");
    expect_range(1, 100, true, 8, " 1 2.. 5.... 10 20.. 50.... 100");
    expect_range(1e-30, 1e30, true, 4, ".............. 1e-16............... 1............... 1e16..............");
    expect_range(3, 8, true, 6, " 3.... 4.... 5.... 6.... 7.... 8");
    expect_range(-1.5e300, 1.5e300, false, 4, ".. -1e300.... 0.... 1e300..");
}

static void the_opacity_axis_is_marked_down_to_its_foot(void **state)
{
    (void)state;
    tc_axis_tick tick[CAPACITY];
    char text[4000];
    tc_axis axis = axis_of(1, true);
    size_t n = tc_axis_ticks(tick, CAPACITY, &axis, 8);
    write_marks(text, tick, n);
    assert_string_equal(text, " 0 1e-5........ 0.0001........ 0.001........ 0.01........ 0.1........ 1");
    assert_true(tick[0].place == 0 && tick[n - 1].place == 1 && fabs(tick[1].place - 0.06) < 1e-12);
    axis.top = 0.3;
    write_marks(text, tick, tc_axis_ticks(tick, CAPACITY, &axis, 4));
    assert_string_equal(text, " 0. 0.0001. 0.01.");
    axis.log = false;
    write_marks(text, tick, tc_axis_ticks(tick, CAPACITY, &axis, 4));
    assert_string_equal(text, " 0.... 0.1.... 0.2.... 0.3");
}

/* What holds of all marks, whatever the range. */
static void check(const tc_axis_tick *tick, size_t n, size_t capacity, int labels, double lo, double hi, bool log)
{
    int n_label = 0;
    assert_true(n <= capacity);
    for (size_t i = 0; i < n; i++) {
        assert_true(tick[i].place >= 0 && tick[i].place <= 1 && (i == 0 || tick[i].place > tick[i - 1].place));
        if (!tick[i].label[0])
            continue;
        n_label++;
        double value = atof(tick[i].label);
        double place =
            log ? (log10(value) - log10(lo)) / (log10(hi) - log10(lo)) : (value / 2 - lo / 2) / (hi / 2 - lo / 2);
        double error = log ? 1e-12 + 8 * DBL_EPSILON * (fabs(log10(lo)) + 1) / (log10(hi) - log10(lo))
                           : 1e-12 + DBL_EPSILON * fmax(fabs(lo), fabs(hi)) / (hi / 2 - lo / 2);
        if (!(fabs(place - tick[i].place) <= error + 1e-9 * (place < 0 || place > 1)))
            fail_msg("[%.17g, %.17g]: \"%s\" is at %.17g, not at %.17g", lo, hi, tick[i].label, tick[i].place, place);
    }
    assert_true(n_label <= labels);
    if (capacity >= 12 && labels >= 5 && n_label < 2)
        fail_msg("[%.17g, %.17g]%s: %d labels of %d", lo, hi, log ? " log" : "", n_label, labels);
}

static void labels_tell_their_places_in_any_range(void **state)
{
    (void)state;
    tc_axis_tick tick[CAPACITY];
    for (int i = 0; i < 20000; i++) {
        double lo = uniform(-1, 1) * pow(10, uniform(-300, 300));
        double span = i % 3 ? fabs(lo) * pow(10, uniform(-9, 3)) : pow(10, uniform(-300, 300));
        if (!(lo + span > lo) || span < 1e-9 * fabs(lo))
            continue;
        size_t capacity = (size_t)uniform(1, CAPACITY);
        int labels = (int)uniform(1, 12);
        check(tick, tc_range_ticks(tick, capacity, lo, lo + span, false, labels), capacity, labels, lo, lo + span,
              false);
        lo = fabs(lo);
        double hi = lo * (i % 2 ? 1 + pow(10, uniform(-6, 1)) : pow(10, uniform(0.3, 200)));
        if (isfinite(hi))
            check(tick, tc_range_ticks(tick, capacity, lo, hi, true, labels), capacity, labels, lo, hi, true);
    }
}

static void what_is_no_axis_has_no_marks(void **state)
{
    (void)state;
    tc_axis_tick tick[4];
    assert_int_equal(tc_range_ticks(tick, 4, 1, 1, false, 4), 0);
    assert_int_equal(tc_range_ticks(tick, 4, 2, 1, false, 4), 0);
    assert_int_equal(tc_range_ticks(tick, 4, 0, 1, true, 4), 0);
    assert_int_equal(tc_range_ticks(tick, 4, NAN, 1, false, 4), 0);
    assert_int_equal(tc_range_ticks(tick, 4, 0, INFINITY, false, 4), 0);
    assert_int_equal(tc_range_ticks(tick, 4, 0, 1, false, 0), 0);
    assert_int_equal(tc_range_ticks(tick, 0, 0, 1, false, 4), 0);
    assert_true(tc_range_ticks(tick, 4, 1, nextafter(1, 2), false, 4) <= 4);
    tc_axis axis = axis_of(0, true);
    assert_int_equal(tc_axis_ticks(tick, 4, &axis, 4), 0);
    axis = axis_of(1e-320, true);
    assert_true(tc_axis_ticks(tick, 4, &axis, 4) <= 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(place_and_value_are_inverses),
        cmocka_unit_test(ends_and_foot_are_where_they_are_promised),
        cmocka_unit_test(a_larger_value_is_never_at_a_lower_place),
        cmocka_unit_test(a_range_is_marked_with_round_numbers),
        cmocka_unit_test(the_opacity_axis_is_marked_down_to_its_foot),
        cmocka_unit_test(labels_tell_their_places_in_any_range),
        cmocka_unit_test(what_is_no_axis_has_no_marks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
