/* Tests of the pre-integration table against closed forms and an adaptive quadrature of its own. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "segment_truth.h"
#include "table_lookup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------------ tools */

static tc_table build(const tc_transfer *tf, tc_table_options options)
{
    tc_table table;
    tc_error err = {0};
    if (options.span[0] == options.span[1])
        options.span[1] = 1;
    if (tc_table_build(&table, tf, &options, &err) != TC_OK)
        fail_msg("%s", err.text);
    return table;
}

/* Largest difference of slice k's entries (every `stride`-th) and the truth. */
static double slice_error(const tc_table *table, const tc_transfer *tf, int k, int stride, bool diagonal)
{
    double worst = 0;
    for (int b = 0; b < table->size[1]; b += stride)
        for (int f = 0; f < table->size[0]; f += stride) {
            const double width = table->span[1] - table->span[0];
            const double front = table->span[0] + width * f / (table->size[0] - 1),
                         back = table->span[0] + width * b / (table->size[1] - 1);
            if (!diagonal && front == back)
                continue;
            double want[4];
            truth(want, tf, front, back, table->length_max * k / (table->size[2] - 1));
            for (int c = 0; c < 4; c++)
                worst = fmax(worst, fabs(entry(table, f, b, k)[c] - want[c]));
        }
    return worst;
}

/* ------------------------------------------------------------------------------------------------------ tests */

static void base_slice_is_less_accurate_than_stated(void **state)
{
    (void)state;
    const double lengths[] = {1e-3, 1, 8, 60};
    for (size_t i = 0; i < 4; i++)
        for (int function = 0; function < 2; function++) {
            tc_transfer *tf = function == 0 ? make(smooth, 3) : make(steps, 8);
            tc_table table =
                build(tf, (tc_table_options){.size = {33, 33, 2}, .length_max = lengths[i], .format = TC_TABLE_32F});
            assert_true(table.base_error < 2e-6);
            const double worst = slice_error(&table, tf, 1, 1, true);
            if (worst > table.base_error + 1e-11)
                fail_msg("length %g, function %d: off by %g, stated %g", lengths[i], function, worst, table.base_error);
            tc_table_finish(&table);
            tc_transfer_destroy(&tf);
        }
}

static void error_accumulates_over_slices(void **state)
{
    (void)state;
    tc_transfer *tf = make(smooth, 3);
    tc_table table = build(tf, (tc_table_options){.size = {129, 129, 256}, .length_max = 5, .format = TC_TABLE_32F});
    const int slice[] = {1, 2, 3, 7, 20, 64, 128, 255};
    for (size_t i = 0; i < sizeof slice / sizeof *slice; i++) {
        const double worst = slice_error(&table, tf, slice[i], 9, true);
        if (worst > 5e-4)
            fail_msg("slice %d of 255 is off by %g", slice[i], worst);
    }
    tc_table_finish(&table);
    tc_transfer_destroy(&tf);
}

static void error_does_not_shrink_with_the_grid(void **state)
{
    (void)state;
    tc_transfer *tf = make(smooth, 3);
    double worst[2];
    for (int i = 0; i < 2; i++) {
        const int n = i == 0 ? 33 : 129;
        tc_table table = build(tf, (tc_table_options){.size = {n, n, 64}, .length_max = 5, .format = TC_TABLE_32F});
        worst[i] = slice_error(&table, tf, 63, i == 0 ? 1 : 4, true);
        tc_table_finish(&table);
    }
    assert_true(worst[1] < worst[0] / 4);
    tc_transfer_destroy(&tf);
}

static double lookup(const tc_table *table, double front, double back, double length, int c)
{
    const double place[3] = {(front - table->span[0]) / (table->span[1] - table->span[0]) * (table->size[0] - 1),
                             (back - table->span[0]) / (table->span[1] - table->span[0]) * (table->size[1] - 1),
                             length / table->length_max * (table->size[2] - 1)};
    return between_entries(table, place, c);
}

static void constant_extinction_misses_beers_law(void **state)
{
    (void)state;
    const double taus[] = {0.01, 0.3, 1, 7};
    for (int i = 0; i < 4; i++) {
        const tc_knot knot[] = {{0, 0.3, 0.6, 1, taus[i]}, {1, 0.3, 0.6, 1, taus[i]}};
        tc_transfer *tf = make(knot, 2);
        tc_table table =
            build(tf, (tc_table_options){.size = {128, 128, 256}, .length_max = 2, .format = TC_TABLE_32F});
        uint64_t seed = 3;
        for (int n = 0; n < 2000; n++) {
            const double f = random01(&seed), b = random01(&seed), l = 2 * random01(&seed);
            const double alpha = 1 - exp(-taus[i] * l);
            assert_float_equal(lookup(&table, f, b, l, 3), alpha, 5e-4);
            assert_float_equal(lookup(&table, f, b, l, 1), 0.6 * alpha, 5e-4);
        }
        for (int k = 0; k < 256; k++)
            assert_float_equal(entry(&table, 17, 99, k)[3], 1 - exp(-taus[i] * 2 * k / 255.0), 5e-7);
        tc_table_finish(&table);
        tc_transfer_destroy(&tf);
    }
}

static void opacity_is_not_symmetric_or_not_monotone_or_colour_exceeds_it(void **state)
{
    (void)state;
    for (int function = 0; function < 2; function++) {
        tc_transfer *tf = function == 0 ? make(smooth, 3) : make(steps, 8);
        tc_table table = build(tf, (tc_table_options){.size = {65, 65, 100}, .length_max = 4, .format = TC_TABLE_32F});
        for (int b = 0; b < 65; b++)
            for (int f = 0; f < 65; f++)
                for (int k = 0; k < 100; k++) {
                    const float *e = entry(&table, f, b, k);
                    if (k == 0) {
                        assert_true(e[0] == 0 && e[1] == 0 && e[2] == 0 && e[3] == 0);
                        continue;
                    }
                    assert_true(e[3] == entry(&table, b, f, k)[3]);
                    assert_true(e[3] >= 0 && e[3] <= 1);
                    for (int c = 0; c < 3; c++)
                        assert_true(e[c] >= 0 && e[c] <= e[3] * (1 + 1e-5f));
                    assert_true(e[3] >= entry(&table, f, b, k - 1)[3]);
                }
        tc_table_finish(&table);
        tc_transfer_destroy(&tf);
    }
}

static void two_halves_differ_from_the_whole(void **state)
{
    (void)state;
    tc_transfer *tf = make(smooth, 3);
    tc_table table = build(tf, (tc_table_options){.size = {129, 129, 129}, .length_max = 5, .format = TC_TABLE_32F});
    for (int b = 0; b < 129; b += 4)
        for (int f = 0; f < 129; f += 4)
            for (int k = 2; k < 129; k += 18) {
                const float *whole = entry(&table, f, b, k), *near = entry(&table, f, (f + b) / 2, k / 2),
                            *far = entry(&table, (f + b) / 2, b, k / 2);
                for (int c = 0; c < 4; c++)
                    assert_float_equal(near[c] + (1 - near[3]) * far[c], whole[c], 3e-4);
            }
    tc_table_finish(&table);
    tc_transfer_destroy(&tf);
}

static void axes_of_different_size_are_mixed_up(void **state)
{
    (void)state;
    tc_transfer *tf = make(smooth, 3);
    const int size[][3] = {{101, 40, 30}, {41, 101, 30}, {2, 129, 3}, {129, 2, 9}, {64, 65, 2}, {2, 2, 2}};
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        tc_table_options options = {.span = {0, 1}, .length_max = 3, .format = TC_TABLE_32F, .threads = 2};
        memcpy(options.size, size[i], sizeof options.size);
        tc_table table = build(tf, options);
        assert_true(slice_error(&table, tf, 1, 1, true) < 2e-6);
        if (size[i][0] > 30)
            assert_true(slice_error(&table, tf, size[i][2] - 1, size[i][0] > 100 || size[i][1] > 100 ? 3 : 1, true) <
                        2e-3);
        tc_table_finish(&table);
    }
    tc_transfer_destroy(&tf);
}

static void span_beyond_the_knots_or_inside_them_is_wrong(void **state)
{
    (void)state;
    tc_transfer *tf = make(steps, 8);
    const double span[][2] = {{-5, 9}, {0.3, 0.31}, {0.2, 0.61}, {3, 4}};
    for (int i = 0; i < 4; i++) {
        tc_table table = build(
            tf, (tc_table_options){
                    .size = {20, 20, 2}, .span = {span[i][0], span[i][1]}, .length_max = 0.7, .format = TC_TABLE_32F});
        /* A step at an entry's own scalar has no one value there: the diagonal is left out. */
        assert_true(slice_error(&table, tf, 1, 1, false) < 2e-6);
        tc_table_finish(&table);
    }
    tc_transfer_destroy(&tf);
}

static void formats_are_not_rounded_to_nearest(void **state)
{
    (void)state;
    tc_transfer *tf = make(smooth, 3);
    tc_table_options options = {.size = {37, 41, 50}, .span = {0, 1}, .length_max = 1, .format = TC_TABLE_32F};
    tc_table full = build(tf, options);
    options.format = TC_TABLE_8;
    tc_table bytes = build(tf, options);
    options.format = TC_TABLE_AUTO;
    tc_table half = build(tf, options);
    assert_int_equal(half.format, TC_TABLE_16F);
    const size_t n = 4 * 37 * 41 * 50;
    assert_int_equal(full.bytes, 4 * n);
    assert_int_equal(half.bytes, 2 * n);
    assert_int_equal(bytes.bytes, n);
    size_t tiny = 0;
    for (size_t i = 0; i < n; i++) {
        const float v = ((const float *)full.rgba)[i];
        assert_true(fabsf((float)((const uint8_t *)bytes.rgba)[i] - v * 255) <= 0.5001f);
        const uint16_t h = ((const uint16_t *)half.rgba)[i];
        assert_true(h < 0x8000); /* not even -0 */
        const float got = half_value(h), up = half_value((uint16_t)(h + 1)),
                    down = h > 0 ? half_value((uint16_t)(h - 1)) : 0;
        assert_true(fabsf(got - v) <= fabsf(up - v) && (h == 0 || fabsf(got - v) <= fabsf(down - v)));
        tiny += v > 0 && v < 0x1p-14f;
    }
    assert_true(tiny > 0); /* the halves below the normal ones were tried, too */
    tc_table_finish(&full);
    tc_table_finish(&bytes);
    tc_table_finish(&half);
    tc_transfer_destroy(&tf);
}

static void entry_by_entry_is_no_truth(void **state)
{
    (void)state;
    for (int function = 0; function < 2; function++) {
        tc_transfer *tf = function == 0 ? make(smooth, 3) : make(steps, 8);
        tc_table table = build(
            tf,
            (tc_table_options){.size = {20, 17, 12}, .length_max = 3, .format = TC_TABLE_32F, .entry_by_entry = true});
        for (int k = 1; k < 12; k++)
            assert_true(slice_error(&table, tf, k, 1, true) < 2e-6);
        tc_table_finish(&table);
        tc_transfer_destroy(&tf);
    }
}

static void threads_change_the_table(void **state)
{
    (void)state;
    tc_transfer *tf = make(steps, 8);
    tc_table_options options = {.size = {64, 50, 40}, .span = {-1, 2}, .length_max = 3, .threads = 1};
    tc_table one = build(tf, options);
    options.threads = 4;
    tc_table four = build(tf, options);
    assert_int_equal(one.bytes, four.bytes);
    assert_memory_equal(one.rgba, four.rgba, one.bytes);
    assert_float_equal(one.base_error, four.base_error, 0);
    tc_table_finish(&one);
    tc_table_finish(&four);
    tc_transfer_destroy(&tf);
}

static void extreme_functions_give_no_numbers(void **state)
{
    (void)state;
    for (size_t i = 0; i < EXTREMES; i++) {
        tc_transfer *tf = make(extremes[i].knot, extremes[i].n);
        tc_table table = build(tf, (tc_table_options){.size = {16, 16, 8}, .length_max = 7, .format = TC_TABLE_32F});
        for (int k = 0; k < 8; k++)
            for (int b = 0; b < 16; b++)
                for (int f = 0; f < 16; f++)
                    for (int c = 0; c < 4; c++) {
                        const float v = entry(&table, f, b, k)[c];
                        assert_true(isfinite(v) && v >= 0 && v <= 1);
                        if (i == NO_EXTINCTION)
                            assert_true(v == 0);
                        if (i == ONE_KNOT)
                            assert_float_equal(v, (c < 3 ? 1.0 / (1 << c) : 1) * (1 - exp(-2.0 * k)), 1e-6);
                    }
        if (i == HUGE_EXTINCTION)
            assert_true(entry(&table, 0, 15, 7)[3] == 1);
        tc_table_finish(&table);
        tc_transfer_destroy(&tf);
    }
}

static void ten_thousand_knots_fail(void **state)
{
    (void)state;
    enum { MANY = 10000 };
    tc_knot *knot = random_knots(MANY);
    tc_transfer *tf = make(knot, MANY);
    tc_table table = build(tf, (tc_table_options){.size = {16, 16, 3}, .length_max = 1, .format = TC_TABLE_32F});
    assert_true(slice_error(&table, tf, 1, 5, false) < 2e-6);
    tc_table_finish(&table);
    tc_transfer_destroy(&tf);
    free(knot);
}

static void bad_options_are_taken(void **state)
{
    (void)state;
    tc_transfer *tf = make(smooth, 3);
    const tc_table_options good = {.size = {4, 4, 4}, .span = {0, 1}, .length_max = 1};
    tc_table_options bad[8];
    for (int i = 0; i < 8; i++)
        bad[i] = good;
    bad[0].size[0] = 1;
    bad[1].size[2] = 0;
    bad[2].size[1] = 1 << 30;
    bad[3].span[1] = 0;
    bad[4].span[0] = NAN;
    bad[5].length_max = 0;
    bad[6].length_max = INFINITY;
    bad[7].format = (tc_table_format)12;
    for (int i = 0; i < 8; i++) {
        tc_table table;
        tc_error err = {0};
        assert_int_equal(tc_table_build(&table, tf, &bad[i], &err), TC_E_ARG);
        assert_null(table.rgba);
        assert_true(strlen(err.text) > 10);
    }
    tc_table table;
    assert_int_equal(tc_table_build(&table, NULL, &good, NULL), TC_E_ARG);
    tc_transfer_destroy(&tf);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(base_slice_is_less_accurate_than_stated),
        cmocka_unit_test(error_accumulates_over_slices),
        cmocka_unit_test(error_does_not_shrink_with_the_grid),
        cmocka_unit_test(constant_extinction_misses_beers_law),
        cmocka_unit_test(opacity_is_not_symmetric_or_not_monotone_or_colour_exceeds_it),
        cmocka_unit_test(two_halves_differ_from_the_whole),
        cmocka_unit_test(axes_of_different_size_are_mixed_up),
        cmocka_unit_test(span_beyond_the_knots_or_inside_them_is_wrong),
        cmocka_unit_test(formats_are_not_rounded_to_nearest),
        cmocka_unit_test(entry_by_entry_is_no_truth),
        cmocka_unit_test(threads_change_the_table),
        cmocka_unit_test(extreme_functions_give_no_numbers),
        cmocka_unit_test(ten_thousand_knots_fail),
        cmocka_unit_test(bad_options_are_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
