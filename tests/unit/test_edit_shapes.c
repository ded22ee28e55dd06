/* test_edit_shapes.c: curves of opacity by a few numbers, and lines drawn by hand. */
#include "edit/document.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "edit_make.h"

/* Of points joined by lines; the right one at a step. */
static double line_at(const tc_edit_point *point, size_t n, double x)
{
    size_t i = 0;
    while (i + 1 < n && point[i + 1].x <= x)
        i++;
    if (x < point[0].x || i + 1 == n)
        return point[x < point[0].x ? 0 : n - 1].a;
    const double t = (x - point[i].x) / (point[i + 1].x - point[i].x);
    return point[i].a * (1 - t) + point[i + 1].a * t;
}

static void check_points(const tc_edit_point *point, size_t n, double from, double to)
{
    assert_true(n >= 2);
    assert_true(point[0].x == from && point[n - 1].x == to);
    for (size_t i = 0; i < n; i++) {
        assert_true(point[i].a >= 0);
        assert_true(point[i].midpoint == 0.5 && point[i].sharpness == 0 && !point[i].selected);
        assert_true(i == 0 || point[i].x >= point[i - 1].x);
    }
}

static void gaussian_is_no_bell(void **state)
{
    (void)state;
    static const double number[][4] = {
        {0, 1, 1, 0}, {0.2, 0.7, 0.4, 0.1}, {0.5, 0.500001, 20, 0}, {0.1, 0.9, 0.05, 0.6}};
    for (size_t c = 0; c < sizeof number / sizeof *number; c++) {
        const double from = number[c][0], to = number[c][1], height = number[c][2], floor = number[c][3];
        tc_edit_point point[32];
        const size_t n = tc_shape_gaussian(point, 32, from, to, height, floor);
        check_points(point, n, from, to);
        assert_near(point[0].a, floor, 1e-15);
        assert_near(point[n - 1].a, floor, 1e-15);
        assert_near(point[n / 2].x, 0.5 * (from + to), 1e-15);
        assert_near(point[n / 2].a, height, 1e-15);
        const double sigma = (to - from) / 6, end = exp(-4.5);
        for (int i = 0; i <= 1000; i++) {
            const double z = (i / 1000.0 - 0.5) * 6, x = 0.5 * (from + to) + z * sigma;
            const double bell = floor + (height - floor) * (exp(-0.5 * z * z) - end) / (1 - end);
            assert_near(line_at(point, n, x), bell, 0.005 * fabs(height - floor));
        }
        for (size_t i = 0; i < n; i++) /* left and right are alike */
            assert_near(point[i].a, point[n - 1 - i].a, 1e-14 * height);
        assert_int_equal(tc_shape_gaussian(point, n - 1, from, to, height, floor), 0);
    }
}

static void trapezoid_has_other_corners(void **state)
{
    (void)state;
    tc_edit_point p[8];
    assert_int_equal(tc_shape_trapezoid(p, 8, 0.2, 0.6, 0.5, 0.8, 0.1), 4);
    check_points(p, 4, 0.2, 0.6);
    assert_near(p[1].x, 0.3, 1e-15);
    assert_near(p[2].x, 0.5, 1e-15);
    assert_true(p[0].a == 0.1 && p[1].a == 0.8 && p[2].a == 0.8 && p[3].a == 0.1);
    assert_int_equal(tc_shape_trapezoid(p, 8, 0.2, 0.6, 0, 0.8, 0.1), 3); /* a tent */
    assert_near(p[1].x, 0.4, 1e-15);
    assert_true(p[0].a == 0.1 && p[1].a == 0.8 && p[2].a == 0.1);
    assert_int_equal(tc_shape_trapezoid(p, 2, 0.2, 0.6, 0, 0.8, 0.1), 0);
    assert_int_equal(tc_shape_trapezoid(p, 3, 0.2, 0.6, 0.5, 0.8, 0.1), 0);
    assert_int_equal(tc_shape_trapezoid(p, 4, 0.2, 0.6, NAN, 0.8, -3), 3);
    assert_true(p[0].a == 0 && p[2].a == 0); /* no attenuation below 0 */
}

static void step_rises_elsewhere(void **state)
{
    (void)state;
    tc_edit_point p[8];
    assert_int_equal(tc_shape_step(p, 8, 0.1, 0.7, 0.8, 0.05), 4);
    assert_true(p[0].x == 0.1 && p[1].x == 0.1 && p[2].x == 0.7 && p[3].x == 0.7);
    assert_true(p[0].a == 0.05 && p[1].a == 0.8 && p[2].a == 0.8 && p[3].a == 0.05);
    assert_int_equal(tc_shape_step(p, 3, 0.1, 0.7, 0.8, 0.05), 0);
}

static void thinned_line_leaves_the_drawn_one(void **state)
{
    (void)state;
    enum { MOST = 600 };
    uint64_t seed = 5;
    for (int run = 0; run < 300; run++) {
        double x[MOST], a[MOST];
        tc_edit_point p[MOST + 1];
        const size_t n = 1 + (size_t)(random01(&seed) * (MOST - 1));
        double at = 0.1, value = 0.5;
        for (size_t i = 0; i < n; i++) {
            at += random01(&seed) < 0.2 ? 0 : random01(&seed) / 1000; /* some places come again */
            value += (random01(&seed) - 0.52) / 20;
            x[i] = at;
            a[i] = value;
        }
        const double error = run % 3 == 0 ? 0 : 0.03 * random01(&seed);
        const size_t kept = tc_shape_freehand(p, MOST, x, a, n, error);
        assert_true(kept >= 1 && kept <= n);
        for (size_t i = 0; i < kept; i++)
            assert_true((i == 0 || p[i].x > p[i - 1].x) && p[i].a >= 0);
        assert_true(p[0].x == x[0] && p[kept - 1].x == x[n - 1]);
        for (size_t i = 0; i < n; i++)
            if (i + 1 == n || x[i + 1] > x[i]) /* the last at its place */
                assert_near(line_at(p, kept, x[i]), fmax(0, a[i]), error + 1e-12);
        if (kept > 1) {
            assert_int_equal(tc_shape_freehand(p, kept, x, a, n, error), kept); /* no more room than it takes */
            assert_int_equal(tc_shape_freehand(p, kept - 1, x, a, n, error), 0);
        }
    }
}

static void straight_line_keeps_more_than_its_ends(void **state)
{
    (void)state;
    double x[100], a[100];
    tc_edit_point p[100];
    for (int i = 0; i < 100; i++) {
        x[i] = i / 99.0;
        a[i] = 0.2 + 0.3 * x[i];
    }
    assert_int_equal(tc_shape_freehand(p, 100, x, a, 100, 1e-9), 2);
    a[50] += 0.01;
    assert_int_equal(tc_shape_freehand(p, 100, x, a, 100, 0.011), 2);
    assert_int_equal(tc_shape_freehand(p, 100, x, a, 100, 0.005), 5); /* a peak, and what is beside it */
    assert_int_equal(tc_shape_freehand(p, 100, x, a, 0, 0.005), 0);
    assert_int_equal(tc_shape_freehand(p, 0, x, a, 100, 0.005), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gaussian_is_no_bell),
        cmocka_unit_test(trapezoid_has_other_corners),
        cmocka_unit_test(step_rises_elsewhere),
        cmocka_unit_test(thinned_line_leaves_the_drawn_one),
        cmocka_unit_test(straight_line_keeps_more_than_its_ends),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
