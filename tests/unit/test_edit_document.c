/* test_edit_document.c: documents of the transfer-function window: their ends and order under random edits, and that
 * the curve which is drawn is the function with which pictures are made. */
#include "edit/document.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "edit_make.h"

static void new_document_is_not_the_default_function(void **state)
{
    (void)state;
    tc_document *d = create(-2, 6);
    check(d);
    assert_string_equal(d->name, "Cool to Warm");
    assert_int_equal(d->space, TC_EDIT_DIVERGING);
    assert_false(d->has_nan_color);
    const tc_transfer_options options = {.data_range = {-2, 6}};
    tc_transfer *plain, *tf = function(d);
    assert_int_equal(tc_transfer_create(&plain, &options, NULL), TC_OK);
    assert_near(difference(plain, tf), 0, 1e-12);
    tc_transfer_destroy(&plain);
    tc_transfer_destroy(&tf);
    tc_document_destroy(&d);
    assert_null(d);
    tc_document_destroy(&d);
}

static void random_edits_break_ends_or_order(void **state)
{
    (void)state;
    uint64_t seed = 1;
    for (int run = 0; run < 60; run++) {
        tc_document *d = create(0, 1);
        for (int i = 0; i < 150; i++) {
            random_edit(d, &seed);
            check(d);
        }
        tc_document_destroy(&d);
    }
}

static void edits_break_on_odd_numbers(void **state)
{
    (void)state;
    const double odd[] = {NAN, INFINITY, -INFINITY, DBL_MAX, -DBL_MAX, 5e-324, -0.0};
    tc_document *d = create(0, 1);
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
        for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
            double went[2];
            const double rgb[3] = {odd[i], odd[k], 0.5};
            const tc_edit_point point[] = {{odd[i], odd[k], odd[i], odd[k], true},
                                           {odd[k], odd[i], odd[k], odd[i], false}};
            tc_document_move(went, d, odd[i], odd[k]);
            check(d);
            assert_true(isfinite(went[0]) && isfinite(went[1]));
            tc_document_scale(d, odd[k], odd[i]);
            tc_document_move_colors(d, odd[i]);
            assert_int_equal(tc_document_add_point(d, NULL, odd[i], odd[k], NULL), TC_OK);
            assert_int_equal(tc_document_add_color(d, NULL, odd[i], rgb, NULL), TC_OK);
            check(d);
            assert_int_equal(tc_document_replace(d, odd[i], odd[k], point, 2, NULL), TC_OK);
            check(d);
        }
    tc_document_destroy(&d);
}

static void points_pass_their_neighbours(void **state)
{
    (void)state;
    tc_document *d = create(0, 1);
    double went[2];
    for (int i = 1; i <= 4; i++)
        assert_int_equal(tc_document_add_point(d, NULL, i / 5.0, 0.1 * i, NULL), TC_OK);
    for (size_t i = 0; i < 6; i++)
        d->point[i].selected = i == 2 || i == 3;
    tc_document_move(went, d, 0.1, 0.05);
    assert_near(went[0], 0.1, 1e-15);
    assert_near(went[1], 0.05, 1e-15);
    assert_near(d->point[2].x, 0.5, 1e-15);
    assert_near(d->point[3].a, 0.35, 1e-15);
    tc_document_move(went, d, 0.5, -3); /* up to the next, down to 0 */
    assert_near(went[0], 0.1, 1e-15);
    assert_near(went[1], -0.25, 1e-15);
    assert_true(d->point[3].x == d->point[4].x && d->point[2].a == 0);
    tc_document_move(went, d, -3, 0);
    assert_near(went[0], -0.4, 1e-15);
    assert_true(d->point[2].x == d->point[1].x);
    assert_near(d->point[3].x - d->point[2].x, 0.2, 1e-15); /* as far apart as ever */
    for (size_t i = 0; i < 6; i++)
        d->point[i].selected = i == 0 || i == 5;
    tc_document_move(went, d, 0.3, 0.2); /* ends go up, not along */
    assert_true(went[0] == 0 && d->point[0].x == 0 && d->point[5].x == 1);
    assert_near(d->point[0].a, 0.2, 1e-15);
    assert_near(d->point[5].a, 0.5, 1e-15);
    for (size_t i = 0; i < 6; i++)
        d->point[i].selected = true;
    tc_document_scale(d, 0, 2);
    assert_near(d->point[5].a, 1, 1e-15);
    assert_true(d->point[2].a == 0);
    tc_document_delete_points(d);
    assert_int_equal(d->n_point, 2);
    for (size_t i = 0; i < 2; i++)
        d->point[i].selected = false;
    tc_document_move(went, d, 0.3, 0.2); /* nothing is selected */
    assert_true(went[0] == 0 && went[1] == 0);
    tc_document_destroy(&d);
}

static void copies_differ_or_share(void **state)
{
    (void)state;
    uint64_t seed = 3;
    tc_document *a = random_document(&seed), *b = copy(a), *c = copy(a);
    assert_true(tc_document_equal(a, b));
    b->point[0].selected = !b->point[0].selected;
    b->color[0].selected = !b->color[0].selected;
    assert_true(tc_document_equal(a, b));
    tc_document_destroy(&a);
    check(b);
    void *const part[] = {&b->space, &b->hsv_wrap, &b->log, &b->has_nan_color};
    const size_t size[] = {1, 1, 1, 1};
    for (size_t i = 0; i < 4; i++) {
        unsigned char *byte = part[i];
        byte[size[i] - 1] ^= 1;
        assert_false(tc_document_equal(b, c));
        byte[size[i] - 1] ^= 1;
        assert_true(tc_document_equal(b, c));
    }
    double *const number[] = {&b->point[1].x,      &b->point[0].a,   &b->point[1].midpoint, &b->point[0].sharpness,
                              &b->color[0].rgb[2], &b->color[1].x,   &b->range[0],          &b->range[1],
                              &b->unit_distance,   &b->nan_color[3], &b->nan_color[0]};
    for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
        const double was = *number[i];
        *number[i] += 0.125;
        assert_false(tc_document_equal(b, c));
        *number[i] = was;
    }
    b->n_point--;
    assert_false(tc_document_equal(b, c));
    b->n_point++;
    tc_document_destroy(&b);
    tc_document_destroy(&c);
}

static void drawn_curve_is_not_the_function_of_pictures(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int run = 0; run < 120; run++) {
        tc_document *d = random_document(&seed);
        tc_transfer *tf = function(d);
        double top = 1;
        for (size_t i = 0; i < d->n_point; i++)
            top = fmax(top, d->point[i].a);
        for (int i = 0; i <= 1500; i++) {
            const double x = i == 1500 ? 1 : random01(&seed), s = tc_document_scalar(d, x), near = 1e-9;
            double right[4], left[4], rgb[3];
            evaluate(right, tf, s, false);
            evaluate(left, tf, s, true);
            tc_document_color(rgb, d, x);
            /* A step may come before or behind, as rounding has it. */
            double a = tc_document_opacity(d, x);
            if (fabs(a - right[3]) > 1e-3 * top)
                a = tc_document_opacity(
                    d, x + (fabs(tc_document_opacity(d, x - near) - right[3]) < 1e-3 * top ? -near : near));
            assert_true(fabs(a - right[3]) <= 1e-3 * top || fabs(a - left[3]) <= 1e-3 * top);
            for (int c = 0; c < 3; c++)
                if (fabs(rgb[c] - right[c]) > 5e-4 && fabs(rgb[c] - left[c]) > 5e-4) {
                    double before[3], behind[3];
                    tc_document_color(before, d, x - near);
                    tc_document_color(behind, d, x + near);
                    assert_true(fabs(before[c] - right[c]) <= 5e-4 || fabs(behind[c] - right[c]) <= 5e-4);
                }
        }
        tc_transfer_destroy(&tf);
        tc_document_destroy(&d);
    }
}

static void curve_of_one_piece_is_not_vtk_s(void **state)
{
    (void)state;
    /* vtkPiecewiseFunction of (0, 0.1), (1, 0.7): GetValue of VTK 9.1. */
    static const double vtk[][5] = {{0.5, 0, 0.25, 0.4, 0.55},
                                    {0.3, 0, 0.35, 0.485714285714, 0.592857142857},
                                    {0.8, 0, 0.19375, 0.2875, 0.38125},
                                    {0.5, 0.005, 0.25, 0.4, 0.55},
                                    {0.5, 0.2, 0.13134765625, 0.4, 0.66865234375},
                                    {0.3, 0.5, 0.172652866072, 0.676285467513, 0.699687757593},
                                    {0.7, 0.9, 0.100001013302, 0.101515624762, 0.685159508156},
                                    {0.6, 0.99, 0.10000021748, 0.108398251746, 0.699966344099},
                                    {0.6, 1, 0.1, 0.1, 0.7},
                                    {0.001, 0.3, 0.621107039588, 0.686301905964, 0.699174324255},
                                    {0, 0, 0.474997749977, 0.549998499985, 0.624999249992},
                                    {1, 0.4, 0.100175961662, 0.105799248758, 0.152052497962}};
    tc_document *d = create(0, 1);
    d->point[0].a = 0.1;
    d->point[1].a = 0.7;
    for (size_t i = 0; i < sizeof vtk / sizeof *vtk; i++) {
        d->point[0].midpoint = vtk[i][0];
        d->point[0].sharpness = vtk[i][1];
        for (int k = 0; k < 3; k++)
            assert_near(tc_document_opacity(d, 0.25 * (k + 1)), vtk[i][2 + k], 1e-9);
    }
    tc_document_destroy(&d);
}

/* Largest change of the curve between places, where it has no step nearby; both ends left out. */
static double change(const tc_document *a, const tc_document *b, double from, double to)
{
    double most = 0;
    for (int i = 1; i < 1000 && from < to; i++) {
        const double x = from + (to - from) * i / 1000;
        most = fmax(most, fabs(tc_document_opacity(a, x) - tc_document_opacity(b, x)));
    }
    return most;
}

/* Root of the mean square of the change between places. */
static double mean_change(const tc_document *a, const tc_document *b, double from, double to)
{
    double sum = 0;
    for (int i = 1; i < 128; i++) {
        const double x = from + (to - from) * i / 128;
        const double off = tc_document_opacity(a, x) - tc_document_opacity(b, x);
        sum += off * off;
    }
    return sqrt(sum / 127);
}

/* The least that any midpoint and sharpness of the piece that begins at point i would leave. */
static double least_change(const tc_document *added, const tc_document *before, size_t i)
{
    tc_document *d = copy(added);
    double least = INFINITY;
    for (int m = 0; m <= 50; m++)
        for (int s = 0; s <= 50; s++) {
            d->point[i].midpoint = m / 50.0;
            d->point[i].sharpness = s / 50.0;
            least = fmin(least, mean_change(d, before, d->point[i].x, d->point[i + 1].x));
        }
    tc_document_destroy(&d);
    return least;
}

static void added_point_bends_the_curve_more_than_it_must(void **state)
{
    (void)state;
    static const double bend[][2] = {{0.5, 0}, {0.3, 0}, {0.5, 0.3}, {0.7, 0.6}, {0.5, 0.1}, {0.1, 0.9}};
    uint64_t seed = 11;
    for (size_t k = 0; k < sizeof bend / sizeof *bend; k++)
        for (int run = 0; run < 8; run++) {
            tc_document *d = create(0, 1);
            d->point[1].a = 1;
            d->point[0].midpoint = bend[k][0];
            d->point[0].sharpness = bend[k][1];
            tc_document *before = copy(d);
            const double x = run == 0 ? 0 : run == 1 ? 1 : random01(&seed);
            size_t index = 77;
            assert_int_equal(tc_document_add_point(d, &index, x, tc_document_opacity(d, x), NULL), TC_OK);
            assert_int_equal(index, 1);
            assert_true(d->point[1].selected && !d->point[0].selected && !d->point[2].selected);
            if (run < 2 || k == 0) {
                assert_true(change(d, before, 0, 1) <= 1e-12);
            } else {
                assert_true(mean_change(d, before, 0, x) <= 1.05 * least_change(d, before, 0) + 1e-3);
                assert_true(mean_change(d, before, x, 1) <= 1.05 * least_change(d, before, 1) + 1e-3);
            }
            tc_document_destroy(&d);
            tc_document_destroy(&before);
        }
    /* A step stays where it is, on either side. */
    for (int run = 0; run < 20; run++) {
        tc_document *d = create(0, 1);
        d->point[0].midpoint = 0.4;
        d->point[0].sharpness = 1;
        const double x = random01(&seed), a = tc_document_opacity(d, x);
        assert_int_equal(tc_document_add_point(d, NULL, x, a, NULL), TC_OK);
        assert_near(tc_document_opacity(d, 0.4 - 1e-6), 0, 1e-12);
        assert_near(tc_document_opacity(d, 0.4 + 1e-6), 0.3, 1e-12);
        tc_document_destroy(&d);
    }
}

static void replacing_changes_what_lies_outside(void **state)
{
    (void)state;
    uint64_t seed = 13;
    for (int run = 0; run < 200; run++) {
        tc_document *d = random_document(&seed);
        for (size_t i = 0; i < d->n_point && run % 2; i++) {
            d->point[i].midpoint = 0.5;
            d->point[i].sharpness = 0;
        }
        tc_document *before = copy(d);
        const double p = random_place(&seed), q = random_place(&seed), from = fmin(p, q), to = fmax(p, q);
        tc_edit_point shape[32];
        const size_t n = run % 3 == 0 ? 0 : tc_shape_trapezoid(shape, 32, from, to, 0.5, 0.9, 0.2);
        assert_int_equal(tc_document_replace(d, from, to, shape, n, NULL), TC_OK);
        check(d);
        /* Pieces that are cut may be curved otherwise; where all are straight nothing is. */
        size_t last = 0, next = before->n_point - 1;
        while (before->point[last + 1].x < from)
            last++;
        while (next > 0 && before->point[next - 1].x > to)
            next--;
        assert_true(change(d, before, 0, run % 2 ? from : before->point[last].x) <= 1e-9);
        assert_true(change(d, before, run % 2 ? to : before->point[next].x, 1) <= 1e-9);
        for (int i = 1; i < 100 && n > 0 && to > from + 1e-3; i++) {
            const double x = from + (to - from) * i / 100, u = i / 100.0;
            const double tall = u < 0.25 ? u / 0.25 : u > 0.75 ? (1 - u) / 0.25 : 1;
            assert_near(tc_document_opacity(d, x), 0.2 + 0.7 * tall, 1e-9);
        }
        for (int i = 1; i < 100 && n == 0 && to > from + 1e-3 && from > 0 && to < 1;
             i++) { /* a line between what is beside */
            const double x = from + (to - from) * i / 100, left = tc_document_opacity(d, from);
            size_t first = 0;
            while (d->point[first + 1].x <= to)
                first++;
            while (d->point[first - 1].x >= to)
                first--;
            assert_near(tc_document_opacity(d, x), left + (d->point[first].a - left) * i / 100, 1e-9);
        }
        tc_document_destroy(&d);
        tc_document_destroy(&before);
    }
}

static void colours_that_were_kept_outlive_a_change(void **state)
{
    (void)state;
    tc_document *d = create(0, 1), *e;
    double a[3], b[3];
    tc_document_color(a, d, 0.3);
    d->space = TC_EDIT_RGB;
    tc_document_color(b, d, 0.3);
    assert_true(fabs(a[0] - b[0]) > 1e-3);
    assert_near(b[0], d->color[0].rgb[0] * 0.4 + d->color[1].rgb[0] * 0.6, 1e-12);
    d->color[1].rgb[0] = 0;
    tc_document_color(a, d, 0.3);
    assert_near(a[0], d->color[0].rgb[0] * 0.4, 1e-12);
    d->color[1].x = 0.3;
    tc_document_color(a, d, 0.3);
    assert_near(a[0], 0, 1e-12);
    d->space = TC_EDIT_HSV;
    memcpy(d->color[1].rgb, (const double[3]){1, 0.3, 0}, sizeof d->color[1].rgb); /* across red from the last */
    tc_document_color(a, d, 0.6);
    d->hsv_wrap = true;
    tc_document_color(b, d, 0.6);
    assert_true(fabs(a[0] - b[0]) + fabs(a[1] - b[1]) + fabs(a[2] - b[2]) > 1e-2);
    const double rgb[3] = {0.25, 0.5, 0.75};
    assert_int_equal(tc_document_add_color(d, NULL, 0.6, rgb, NULL), TC_OK);
    tc_document_color(a, d, 0.6);
    for (int c = 0; c < 3; c++)
        assert_near(a[c], rgb[c], 1e-12);
    d->space = TC_EDIT_CIEDE2000;
    tc_document_color(a, d, 0.45);
    e = copy(d);
    free(e->name);
    tc_document borrowed = *e; /* without what is kept, and without a name */
    borrowed.kept = NULL;
    borrowed.name = e->name = NULL;
    tc_document_color(b, &borrowed, 0.45);
    assert_memory_equal(a, b, sizeof a);
    tc_document *named = copy(&borrowed);
    assert_string_equal(named->name, "");
    tc_document_destroy(&named);
    tc_document_destroy(&d);
    tc_document_destroy(&e);
}

static void place_and_scalar_are_no_inverses(void **state)
{
    (void)state;
    tc_document *d = create(-3, 7);
    uint64_t seed = 41;
    for (int log_scale = 0; log_scale < 2; log_scale++) {
        assert_true(tc_document_scalar(d, 0) == d->range[0] && tc_document_scalar(d, 1) == d->range[1]);
        assert_true(tc_document_place(d, d->range[0]) == 0 && tc_document_place(d, d->range[1]) == 1);
        for (int i = 0; i < 1000; i++) {
            const double x = 3 * random01(&seed) - 1;
            assert_near(tc_document_place(d, tc_document_scalar(d, x)), x, 1e-13);
        }
        d->range[0] = 0.001;
        d->range[1] = 1000;
        d->log = true;
    }
    assert_near(tc_document_scalar(d, 0.5), 1, 1e-12);
    assert_true(tc_document_place(d, 0) == -INFINITY && tc_document_place(d, -4) == -INFINITY);
    d->log = false;
    d->range[0] = -DBL_MAX;
    d->range[1] = DBL_MAX;
    assert_near(tc_document_place(d, 0), 0.5, 1e-15);
    assert_near(tc_document_place(d, DBL_MAX / 2), 0.75, 1e-15);
    assert_near(tc_document_scalar(d, 0.5), 0, 1e-15);
    tc_document_destroy(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(new_document_is_not_the_default_function),
        cmocka_unit_test(random_edits_break_ends_or_order),
        cmocka_unit_test(edits_break_on_odd_numbers),
        cmocka_unit_test(points_pass_their_neighbours),
        cmocka_unit_test(copies_differ_or_share),
        cmocka_unit_test(drawn_curve_is_not_the_function_of_pictures),
        cmocka_unit_test(curve_of_one_piece_is_not_vtk_s),
        cmocka_unit_test(added_point_bends_the_curve_more_than_it_must),
        cmocka_unit_test(replacing_changes_what_lies_outside),
        cmocka_unit_test(colours_that_were_kept_outlive_a_change),
        cmocka_unit_test(place_and_scalar_are_no_inverses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
