/* Tests of the table of colour drift and the means beside it, looked up as the shader does, against closed forms and an
 * adaptive quadrature of its own. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "segment_truth.h"
#include "table_lookup.h"
#include "transfer_functions/drift.h"
#include "transfer_functions/means.h"

#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------------ tools */

typedef struct fixture {
    tc_transfer *tf;
    tc_table table;
    tc_means means;
    double most[3];
} fixture;

static fixture build_options(const tc_knot *knot, size_t n, tc_table_options options)
{
    fixture f = {.tf = make(knot, n)};
    tc_error err = {0};
    if (options.span[0] == options.span[1])
        options.span[1] = 1;
    if (tc_drift_build(&f.table, f.tf, &options, &err) != TC_OK ||
        tc_means_build(&f.means, f.tf, tc_means_intervals(f.tf, options.span), options.span, &err) != TC_OK)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < n; i++) {
        f.most[0] = fmax(f.most[0], knot[i].r);
        f.most[1] = fmax(f.most[1], knot[i].g);
        f.most[2] = fmax(f.most[2], knot[i].b);
    }
    return f;
}

static fixture build(const tc_knot *knot, size_t n, int size, double length_max)
{
    return build_options(
        knot, n, (tc_table_options){.size = {size, size, size}, .length_max = length_max, .format = TC_TABLE_32F});
}

static void finish(fixture *f)
{
    tc_table_finish(&f->table);
    tc_means_finish(&f->means);
    tc_transfer_destroy(&f->tf);
}

/* tf_cell of integrate_drift.glsl, in float as there. */
static void cell_at(float around[4], float sum[4], float rest[4], const tc_means *m, float x)
{
    int i = (int)(x * (float)m->n);
    i = i < m->n ? i : m->n - 1;
    const float *cell = m->cell + 12 * (size_t)i, *mean = cell;
    float part = x - (float)i * (1.0f / (float)m->n);
    memcpy(sum, cell + 4, 4 * sizeof *sum);
    memcpy(rest, cell + 8, 4 * sizeof *rest);
    if (mean[3] < 0) {
        const float behind = part - cell[0];
        part = fminf(part, cell[0]);
        mean = m->cell + 4 * (size_t)cell[1];
        if (behind >= 0) {
            for (int c = 0; c < 4; c++)
                rest[c] += mean[c] * part;
            part = behind;
            mean += 4;
        }
    }
    for (int c = 0; c < 4; c++)
        rest[c] += mean[c] * part;
    memcpy(around, mean, 4 * sizeof *around);
}

/* Place along the length axis, as tf_length has it. */
static double place_of_length(const tc_table *table, double length)
{
    const int octave = tc_drift_octave(table->size[2]);
    const float v = (float)(length * tc_drift_length(table->size[2] - 1, octave) / octave / table->length_max);
    int32_t bits;
    memcpy(&bits, &v, sizeof bits);
    const float octaves = (float)(bits - 0x3f800000) * (1.0f / 8388608) + 1;
    return octave * (double)(v < 1 ? v : octaves);
}

static double drift_at(const tc_table *table, double front, double back, double length, int c)
{
    const double place[3] = {front * (table->size[0] - 1), back * (table->size[1] - 1), place_of_length(table, length)};
    return between_entries(table, place, c);
}

/* integral_add of integrate_drift.glsl: colour and optical depth of a segment. */
static void segment(double out[4], const fixture *f, double front, double back, double length)
{
    float around[4], sum[2][4], rest[2][4], mean[4];
    const double width = f->table.span[1] - f->table.span[0];
    const float x[2] = {(float)((front - f->table.span[0]) / width), (float)((back - f->table.span[0]) / width)};
    cell_at(around, sum[0], rest[0], &f->means, x[0]);
    cell_at(around, sum[1], rest[1], &f->means, x[1]);
    const float dx = x[1] - x[0];
    for (int c = 0; c < 4; c++)
        mean[c] = dx == 0 ? around[c] : ((sum[1][c] - sum[0][c]) + (rest[1][c] - rest[0][c])) * (1 / dx);
    out[3] = fmax((float)length * mean[3], 0);
    const double opacity = -expm1(-out[3]);
    for (int c = 0; c < 3; c++) {
        const double k =
            (mean[3] > 1e-37f ? mean[c] / mean[3] : 0) + drift_at(&f->table, (double)x[0], (double)x[1], length, c);
        out[c] = opacity * fmin(fmax(k, 0), f->most[c]);
    }
}

/* Largest error over random segments; lengths are length_max times the given share, or any share for 0. */
static void random_errors(double out[2], const fixture *f, double share, int n, bool relative)
{
    uint64_t seed = 7;
    out[0] = out[1] = 0;
    for (int i = 0; i < n; i++) {
        const double a = random01(&seed), b = random01(&seed);
        const double l = f->table.length_max * (share > 0 ? share : random01(&seed));
        const double width = f->table.span[1] - f->table.span[0];
        const double front = f->table.span[0] + a * width, back = f->table.span[0] + b * width;
        double got[4], want[4];
        segment(got, f, front, back, l);
        truth(want, f->tf, front, back, l);
        for (int c = 0; c < 4; c++) {
            double error = fabs((c < 3 ? got[c] : -expm1(-got[c])) - want[c]);
            if (relative)
                error = want[3] > 0 ? error / want[3] : error > 0;
            out[c == 3] = fmax(out[c == 3], error);
        }
    }
}

/* ------------------------------------------------------------------------------------------------------ tests */

static void entries_are_not_where_the_lookup_is(void **state)
{
    (void)state;
    static const int sizes[] = {2, 3, 9, 10, 64, 100, 128, 256, 257, 1024, 16384};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const int octave = tc_drift_octave(sizes[i]);
        assert_true(octave >= 1 && (octave & (octave - 1)) == 0);
        const tc_table table = {.size = {2, 2, sizes[i]}, .length_max = 3};
        const double longest = tc_drift_length(sizes[i] - 1, octave);
        assert_true(longest <= 512.0 * octave);
        assert_true(tc_drift_length(0, octave) == 0);
        for (int k = 1; k < sizes[i]; k++) {
            const double length = tc_drift_length(k, octave);
            assert_true(length > tc_drift_length(k - 1, octave));
            const double place = place_of_length(&table, 3 * length / longest);
            assert_true(fabs(place - k) <= 1e-6 * octave * 16);
        }
    }
}

static void constant_extinction_misses_beers_law(void **state)
{
    (void)state;
    const double taus[] = {1e-6, 0.01, 1, 7, 1e3, 1e6};
    for (int i = 0; i < 6; i++) {
        const tc_knot knot[] = {{0, 0.3, 0.6, 1, taus[i]}, {1, 0.3, 0.6, 1, taus[i]}};
        fixture f = build(knot, 2, 16, 2);
        uint64_t seed = 3;
        for (int n = 0; n < 2000; n++) {
            const double a = random01(&seed), b = n % 8 ? random01(&seed) : a, l = 2 * random01(&seed);
            double got[4];
            segment(got, &f, a, b, l);
            assert_true(fabs(got[3] - taus[i] * l) <= 1e-6 * taus[i] * l);
            assert_true(fabs(got[1] - 0.6 * -expm1(-taus[i] * l)) <= 1e-6 * -expm1(-taus[i] * l));
        }
        finish(&f);
    }
}

static void segments_are_far_from_the_truth(void **state)
{
    (void)state;
    static const struct {
        const tc_knot *knot;
        size_t n;
        int size;
        double length_max, color, alpha;
    } cases[] = {{smooth, 3, 32, 5, 3e-3, 5e-6},
                 {smooth, 3, 64, 5, 1e-3, 5e-6},
                 {smooth, 3, 64, 40, 1e-2, 2e-5},
                 {steps, 8, 64, 4, 0.2, 5e-6},
                 {steps, 8, 128, 4, 0.2, 5e-6}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        fixture f = build(cases[i].knot, cases[i].n, cases[i].size, cases[i].length_max);
        double worst[2];
        random_errors(worst, &f, 0, 4000, false);
        print_message("    case %zu: colour off by %.1e, opacity by %.1e\n", i, worst[0], worst[1]);
        if (worst[0] > cases[i].color || worst[1] > cases[i].alpha)
            fail_msg("case %zu: colour off by %g, opacity by %g", i, worst[0], worst[1]);
        finish(&f);
    }
}

static void short_segments_lose_digits(void **state)
{
    (void)state;
    fixture f = build(smooth, 3, 64, 5);
    const double shares[] = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 1};
    for (int i = 0; i < 7; i++) {
        double worst[2];
        random_errors(worst, &f, shares[i], 2000, true);
        print_message("    %g of the longest: colour off by %.1e of the opacity, opacity by %.1e\n", shares[i],
                      worst[0], worst[1]);
        if (worst[0] > 1e-3 * shares[i] + 2e-5 || worst[1] > 1e-5)
            fail_msg("%g of the longest: off by %g, %g", shares[i], worst[0], worst[1]);
    }
    finish(&f);
}

static void opacity_is_not_symmetric_or_not_monotone_or_colour_exceeds_it(void **state)
{
    (void)state;
    for (int function = 0; function < 2; function++) {
        fixture f = function == 0 ? build(smooth, 3, 32, 4) : build(steps, 8, 32, 4);
        uint64_t seed = 9;
        for (int n = 0; n < 20000; n++) {
            const double a = random01(&seed), b = n % 2 ? random01(&seed) : a + 1e-5 * (random01(&seed) - 0.5);
            const double back = fmin(fmax(b, 0), 1), l = 4 * random01(&seed);
            double there[4], home[4], longer[4];
            segment(there, &f, a, back, l);
            segment(home, &f, back, a, l);
            segment(longer, &f, a, back, l * (1 + random01(&seed)));
            assert_true((float)a == (float)back || there[3] == home[3]);
            assert_true(there[3] >= 0 && longer[3] >= there[3]);
            for (int c = 0; c < 3; c++)
                assert_true(there[c] >= 0 && there[c] <= -expm1(-there[3]) * f.most[c]);
        }
        finish(&f);
    }
}

static void two_parts_absorb_more_or_less_than_the_whole(void **state)
{
    (void)state;
    for (int function = 0; function < 2; function++) {
        fixture f = function == 0 ? build(smooth, 3, 16, 4) : build(steps, 8, 16, 4);
        uint64_t seed = 5;
        for (int n = 0; n < 20000; n++) {
            /* Places that float holds, with a split point that it holds, too. */
            const double a = floor(random01(&seed) * 0x1p20) * 0x1p-20;
            const double b = n % 2 ? floor(random01(&seed) * 0x1p20) * 0x1p-20 : fmin(a + 0x1p-18, 1);
            const double l = 4 * random01(&seed);
            double whole[4], near[4], far[4];
            segment(whole, &f, a, b, l);
            segment(near, &f, a, 0.5 * (a + b), 0.5 * l);
            segment(far, &f, 0.5 * (a + b), b, 0.5 * l);
            if (fabs(near[3] + far[3] - whole[3]) > 5e-6 * whole[3])
                fail_msg("%.9g %.9g, length %g: %.9g and %.9g, together %.9g", a, b, l, near[3], far[3], whole[3]);
        }
        finish(&f);
    }
}

/* A step within an interval: segments about it, far shorter in scalar than the interval. */
static void a_step_is_smeared(void **state)
{
    (void)state;
    const double at = 0.3141592;
    const tc_knot knot[] = {{0, 0, 1, 0, 0.01}, {at, 0, 1, 0, 0.01}, {at, 1, 0, 0, 20}, {1, 1, 0, 0, 20}};
    fixture f = build(knot, 4, 64, 1);
    uint64_t seed = 5;
    double worst = 0;
    assert_int_equal(f.means.n_step, 1);
    for (int n = 0; n < 20000; n++) {
        const double front = (double)(float)(at + 2e-5 * (random01(&seed) - 0.5)),
                     back = (double)(float)(at + 2e-5 * (random01(&seed) - 0.5)), l = random01(&seed);
        if (fabs(front - back) < 2e-6)
            continue; /* the places themselves are rounded, by 3e-8 */
        double got[4], want[4];
        segment(got, &f, front, back, l);
        truth(want, f.tf, front, back, l);
        worst = fmax(worst, fabs(-expm1(-got[3]) - want[3]));
    }
    print_message("    opacity off by %.1e\n", worst);
    assert_true(worst < 1e-3); /* smeared over the interval it is off by 0.5 */
    finish(&f);
}

static void extinction_shows_where_there_is_none(void **state)
{
    (void)state;
    /* Next to extinction that makes differences of integrals in one float worthless. */
    const tc_knot knot[] = {{0, 0, 1, 0, 0},     {0.4, 0, 1, 0, 0},   {0.4, 1, 0, 0, 1e9}, {0.5, 1, 0, 0, 1e9},
                            {0.5, 0, 0, 1, 0.1}, {0.8, 0, 0, 1, 0.1}, {0.8, 1, 1, 1, 0},   {1, 1, 1, 1, 0}};
    fixture f = build(knot, 8, 64, 3);
    uint64_t seed = 2;
    for (int n = 0; n < 5000; n++) {
        const double l = 3 * random01(&seed);
        double got[4];
        segment(got, &f, 0.39 * random01(&seed), 0.39 * random01(&seed), l);
        assert_true(got[3] == 0 && got[0] == 0);
        segment(got, &f, 0.81 + 0.19 * random01(&seed), 0.81 + 0.19 * random01(&seed), l);
        assert_true(got[3] <= 1e-6);
        const double a = 0.51 + 0.28 * random01(&seed), b = 0.51 + 0.28 * random01(&seed);
        segment(got, &f, a, b, l);
        if (fabs(a - b) > 1e-3)
            assert_true(fabs(got[3] - 0.1 * l) <= 1e-3 * l);
    }
    finish(&f);
}

static void doubling_is_not_what_entry_by_entry_gives(void **state)
{
    (void)state;
    for (int function = 0; function < 2; function++) {
        const tc_knot *knot = function ? steps : smooth;
        tc_table_options options = {
            .size = {65, 65, 40}, .span = {0, 1}, .length_max = 3, .format = TC_TABLE_32F, .threads = 2};
        fixture fast = build_options(knot, function ? 8 : 3, options);
        options.entry_by_entry = true;
        fixture slow = build_options(knot, function ? 8 : 3, options);
        double worst = 0;
        for (int k = 0; k < 40; k++)
            for (int b = 0; b < 65; b++)
                for (int a = 0; a < 65; a++)
                    for (int c = 0; c < 4; c++)
                        worst = fmax(worst, fabs(entry(&fast.table, a, b, k)[c] - entry(&slow.table, a, b, k)[c]));
        print_message("    function %d: entries off by %.1e\n", function, worst);
        assert_true(worst < (function ? 0.1 : 3e-4));
        finish(&fast);
        finish(&slow);
    }
}

static void axes_of_different_size_are_mixed_up(void **state)
{
    (void)state;
    const int size[][3] = {{101, 40, 30}, {41, 101, 30}, {2, 129, 3}, {129, 2, 9}, {64, 65, 2}, {2, 2, 2}};
    for (size_t i = 0; i < sizeof size / sizeof *size; i++) {
        tc_table_options options = {.span = {0.1, 0.4}, .length_max = 3, .format = TC_TABLE_32F, .threads = 2};
        memcpy(options.size, size[i], sizeof options.size);
        fixture f = build_options(smooth, 3, options);
        double worst[2];
        random_errors(worst, &f, 0, 2000, false);
        const bool coarse = size[i][0] == 2 || size[i][1] == 2 || size[i][2] < 10;
        if (worst[0] > (coarse ? 2e-2 : 5e-5) || worst[1] > 1e-6)
            fail_msg("%d x %d x %d: colour off by %g, opacity by %g", size[i][0], size[i][1], size[i][2], worst[0],
                     worst[1]);
        finish(&f);
    }
}

static void halves_are_not_the_nearest(void **state)
{
    (void)state;
    tc_table_options options = {.size = {33, 33, 50}, .length_max = 3, .format = TC_TABLE_32F};
    fixture full = build_options(smooth, 3, options);
    options.format = TC_TABLE_AUTO;
    fixture half = build_options(smooth, 3, options);
    assert_int_equal(half.table.format, TC_TABLE_16F);
    assert_int_equal(2 * half.table.bytes, full.table.bytes);
    size_t negative = 0;
    for (size_t i = 0; i < full.table.bytes / 4; i++) {
        const float v = ((const float *)full.table.rgba)[i], got = half_value(((const uint16_t *)half.table.rgba)[i]);
        assert_true(fabsf(got - v) <= fmaxf(fabsf(v) * 0x1p-11f, 0x1p-25f));
        negative += v < 0;
    }
    assert_true(negative > 100);
    finish(&full);
    finish(&half);
}

static void threads_change_the_table(void **state)
{
    (void)state;
    tc_table_options options = {.size = {64, 50, 70}, .span = {-1, 2}, .length_max = 3, .threads = 1};
    fixture one = build_options(steps, 8, options);
    options.threads = 4;
    fixture four = build_options(steps, 8, options);
    assert_int_equal(one.table.bytes, four.table.bytes);
    assert_memory_equal(one.table.rgba, four.table.rgba, one.table.bytes);
    finish(&one);
    finish(&four);
}

static void extreme_functions_give_no_numbers(void **state)
{
    (void)state;
    for (size_t i = 0; i < EXTREMES; i++) {
        fixture f = build(extremes[i].knot, extremes[i].n, 16, 7);
        uint64_t seed = 3;
        for (size_t k = 0; k < f.table.bytes / 4; k++) {
            const float v = ((const float *)f.table.rgba)[k];
            if (!(fabsf(v) <= (i == HUGE_EXTINCTION ? 2 : i == NO_EXTINCTION ? 0 : 1e-6f)))
                fail_msg("function %zu: %g", i, (double)v);
        }
        for (int n = 0; n < 2000; n++) {
            double got[4];
            segment(got, &f, random01(&seed), random01(&seed), 7 * random01(&seed));
            for (int c = 0; c < 4; c++)
                assert_true(isfinite(got[c]) && got[c] >= 0 && (c == 3 || got[c] <= 1));
        }
        finish(&f);
    }
}

static void many_knots_fail(void **state)
{
    (void)state;
    enum { MANY = 10000 };
    tc_knot *knot = random_knots(MANY);
    fixture f = build(knot, MANY, 16, 1);
    double worst[2];
    random_errors(worst, &f, 0, 20, false);
    assert_true(worst[0] < 1e-2 && worst[1] < 1e-5);
    finish(&f);
    free(knot);
}

static void bad_options_are_taken(void **state)
{
    (void)state;
    tc_transfer *tf = make(smooth, 3);
    const tc_table_options good = {.size = {4, 4, 4}, .span = {0, 1}, .length_max = 1};
    tc_table_options bad[3] = {good, good, good};
    bad[0].size[0] = 1;
    bad[1].length_max = 0;
    bad[2].format = TC_TABLE_8;
    for (int i = 0; i < 3; i++) {
        tc_table table;
        tc_error err = {0};
        assert_int_equal(tc_drift_build(&table, tf, &bad[i], &err), TC_E_ARG);
        assert_null(table.rgba);
        assert_true(strlen(err.text) > 10);
    }
    tc_means means;
    const double span[2] = {0, 1}, empty[2] = {1, 1};
    assert_int_equal(tc_means_build(&means, tf, 0, span, NULL), TC_E_ARG);
    assert_int_equal(tc_means_build(&means, tf, 8, empty, NULL), TC_E_ARG);
    tc_transfer_destroy(&tf);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(entries_are_not_where_the_lookup_is),
        cmocka_unit_test(constant_extinction_misses_beers_law),
        cmocka_unit_test(segments_are_far_from_the_truth),
        cmocka_unit_test(short_segments_lose_digits),
        cmocka_unit_test(opacity_is_not_symmetric_or_not_monotone_or_colour_exceeds_it),
        cmocka_unit_test(two_parts_absorb_more_or_less_than_the_whole),
        cmocka_unit_test(a_step_is_smeared),
        cmocka_unit_test(extinction_shows_where_there_is_none),
        cmocka_unit_test(doubling_is_not_what_entry_by_entry_gives),
        cmocka_unit_test(axes_of_different_size_are_mixed_up),
        cmocka_unit_test(halves_are_not_the_nearest),
        cmocka_unit_test(threads_change_the_table),
        cmocka_unit_test(extreme_functions_give_no_numbers),
        cmocka_unit_test(many_knots_fail),
        cmocka_unit_test(bad_options_are_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
