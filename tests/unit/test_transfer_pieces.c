/* test_transfer_pieces.c: a transfer function as its linear pieces. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "transfer_functions/pieces.h"
#include "transfer_make.h"

#include <math.h>
#include <string.h>

static tc_pieces build(const tc_transfer *tf, double lo, double hi)
{
    tc_pieces pieces;
    tc_error err = {0};
    if (tc_pieces_build(&pieces, tf, (const double[2]){lo, hi}, &err) != TC_OK)
        fail_msg("%s", err.text);
    return pieces;
}

/* Every x lies in one piece, pieces join, and within them the value is the function's. */
static void a_piece_has_another_value_than_the_function(void **state)
{
    static const tc_knot knot[] = {{-3, 0.1, 0.2, 0.3, 0},  {-1, 0.9, 0.1, 0.5, 4}, {-1, 0.2, 0.7, 0.5, 1},
                                   {0.5, 0.2, 0.7, 0, 0.5}, {2, 0, 0, 1, 2},        {2, 1, 0, 0, 0},
                                   {7, 1, 1, 1, 9}};
    static const double spans[][2] = {{-3, 7}, {-2, 1}, {-10, 20}, {-1, 2}, {3, 4}};
    (void)state;
    tc_transfer *tf = make(knot, sizeof knot / sizeof *knot);
    for (size_t i = 0; i < sizeof spans / sizeof *spans; i++) {
        const double *span = spans[i];
        tc_pieces p = build(tf, span[0], span[1]);
        assert_true(p.end[0].x == -TC_PIECE_FAR && p.end[p.n].x == TC_PIECE_FAR);
        for (size_t k = 0; k < p.n; k++)
            assert_true(p.end[k + 1].x > p.end[k].x);
        for (int j = 0; j <= 1000; j++) {
            double x = j / 1000.0, s = span[0] + x * (span[1] - span[0]), value[4];
            if (fabs(s + 1) < 1e-5 || fabs(s - 2) < 1e-5)
                continue; /* either side of a step is right */
            size_t k = 0;
            while ((double)p.end[k + 1].x < x)
                k++;
            double from = (double)p.end[k].x, to = (double)p.end[k + 1].x;
            tc_transfer_evaluate(value, tf, s);
            for (int c = 0; c < 4; c++) {
                double front = (double)p.end[k].above[c], back = (double)p.end[k + 1].below[c];
                assert_true(fabs(front + (back - front) * (x - from) / (to - from) - value[c]) < 1e-5);
            }
        }
        assert_true(p.steps == ((span[0] < -1 && span[1] > -1) || (span[0] < 2 && span[1] > 2)));
        tc_pieces_finish(&p);
    }
    tc_transfer_destroy(&tf);
}

/* Two knots that float cannot tell apart make a step. */
static void a_narrow_piece_is_no_step(void **state)
{
    static const tc_knot knot[] = {
        {0, 0, 0, 0, 0}, {0.5, 0, 0, 0, 1e30}, {0.5 + 1e-12, 1, 1, 1, 1e300}, {1, 1, 1, 1, 0}};
    (void)state;
    tc_transfer *tf = make(knot, sizeof knot / sizeof *knot);
    tc_pieces p = build(tf, 0, 1);
    assert_int_equal(p.n, 4);
    assert_true(p.steps && p.end[2].x == 0.5F && p.end[2].below[0] == 0 && p.end[2].above[0] == 1);
    assert_true(p.end[2].below[3] == p.end[2].above[3] && isfinite(p.end[2].above[3]));
    tc_pieces_finish(&p);
    tc_transfer_destroy(&tf);
}

/* Float tells its ends apart: it is a piece, however steep. */
static void a_steep_piece_is_left_out(void **state)
{
    static const tc_knot knot[] = {{0, 0, 0, 0, 0.5}, {1e-20, 1, 1, 1, 1e20}, {2e-20, 0, 0, 0, 0}, {1, 0, 0, 0, 1e20}};
    (void)state;
    tc_transfer *tf = make(knot, 4);
    tc_pieces p = build(tf, 0, 1);
    assert_true(p.n == 5 && !p.steps);
    for (size_t k = 0; k < 4; k++)
        assert_true(p.end[k + 1].x == (float)knot[k].s && p.end[k + 1].below[3] == (float)knot[k].a);
    tc_pieces_finish(&p);
    tc_transfer_destroy(&tf);
}

static void one_knot_makes_no_pieces(void **state)
{
    (void)state;
    tc_transfer *tf = make((const tc_knot[]){{5, 0.25, 0.5, 1, 3}}, 1);
    tc_pieces p = build(tf, 0, 1);
    assert_int_equal(p.n, 2);
    assert_true(!p.steps);
    for (size_t k = 0; k <= p.n; k++)
        assert_true(p.end[k].below[3] == 3 && p.end[k].above[3] == 3);
    tc_pieces_finish(&p);
    tc_error err = {0};
    assert_int_equal(tc_pieces_build(&p, tf, (const double[2]){1, 1}, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "not empty"));
    tc_transfer_destroy(&tf);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_piece_has_another_value_than_the_function),
        cmocka_unit_test(a_narrow_piece_is_no_step),
        cmocka_unit_test(a_steep_piece_is_left_out),
        cmocka_unit_test(one_knot_makes_no_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
