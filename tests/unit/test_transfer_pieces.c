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
        assert_true(p.piece[0].from == -TC_PIECE_FAR && p.piece[p.n - 1].to == TC_PIECE_FAR);
        for (size_t k = 1; k < p.n; k++) {
            assert_true(p.piece[k].from == p.piece[k - 1].to);
            assert_true(p.piece[k].to > p.piece[k].from);
        }
        for (int j = 0; j <= 1000; j++) {
            double x = j / 1000.0, s = span[0] + x * (span[1] - span[0]), value[4];
            if (fabs(s + 1) < 1e-5 || fabs(s - 2) < 1e-5)
                continue; /* either side of a step is right */
            size_t k = 0;
            while ((double)p.piece[k].to < x)
                k++;
            tc_transfer_evaluate(value, tf, s);
            for (int c = 0; c < 4; c++)
                assert_true(fabs((double)p.piece[k].value[c] +
                                 (double)p.piece[k].slope[c] * (x - (double)p.piece[k].from) - value[c]) < 1e-5);
        }
        tc_pieces_finish(&p);
    }
    tc_transfer_destroy(&tf);
}

/* Two knots that float cannot tell apart make a step, not an infinite slope. */
static void a_narrow_piece_has_an_infinite_slope(void **state)
{
    static const tc_knot knot[] = {
        {0, 0, 0, 0, 0}, {0.5, 0, 0, 0, 1e30}, {0.5 + 1e-12, 1, 1, 1, 1e300}, {1, 1, 1, 1, 0}};
    (void)state;
    tc_transfer *tf = make(knot, sizeof knot / sizeof *knot);
    tc_pieces p = build(tf, 0, 1);
    assert_int_equal(p.n, 4);
    for (size_t k = 0; k < p.n; k++)
        for (int c = 0; c < 4; c++)
            assert_true(isfinite(p.piece[k].value[c]) && isfinite(p.piece[k].slope[c]));
    tc_pieces_finish(&p);
    tc_transfer_destroy(&tf);
}

/* Float tells its ends apart, and yet its slope is no float: it begins with its own value and so does the next one. */
static void a_piece_near_zero_has_an_infinite_slope(void **state)
{
    static const tc_knot knot[] = {{0, 0, 0, 0, 0.5}, {1e-20, 1, 1, 1, 1e20}, {2e-20, 0, 0, 0, 0}, {1, 0, 0, 0, 1e20}};
    (void)state;
    tc_transfer *tf = make(knot, 4);
    tc_pieces p = build(tf, 0, 1);
    assert_int_equal(p.n, 5);
    for (size_t k = 0; k < p.n; k++)
        for (int c = 0; c < 4; c++) {
            float width = k > 0 && k + 1 < p.n ? p.piece[k].to - p.piece[k].from : 0;
            float end = p.piece[k].value[c] + p.piece[k].slope[c] * width;
            assert_true(isfinite(p.piece[k].slope[c]) && end >= 0 && end <= 1.001e20F);
        }
    for (size_t k = 0; k < 4; k++)
        assert_true(p.piece[k + 1].value[3] == (float)knot[k].a);
    tc_pieces_finish(&p);
    tc_transfer_destroy(&tf);
}

static void one_knot_makes_no_pieces(void **state)
{
    (void)state;
    tc_transfer *tf = make((const tc_knot[]){{5, 0.25, 0.5, 1, 3}}, 1);
    tc_pieces p = build(tf, 0, 1);
    assert_int_equal(p.n, 2);
    for (size_t k = 0; k < p.n; k++)
        assert_true(p.piece[k].value[3] == 3 && p.piece[k].slope[3] == 0);
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
        cmocka_unit_test(a_narrow_piece_has_an_infinite_slope),
        cmocka_unit_test(a_piece_near_zero_has_an_infinite_slope),
        cmocka_unit_test(one_knot_makes_no_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
