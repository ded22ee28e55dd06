/* test_mesh_predicate.c: the sign of a tet's volume where rounding would get it wrong. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh/predicate.h"

#include <float.h>
#include <math.h>

static uint64_t random_state = 1;

static uint32_t random_bits(void)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(random_state >> 33);
}

static double random_unit(void)
{
    return random_bits() / 2147483648.0 - 0.5;
}

static void a_right_handed_tet_is_positive_at_every_size(void **state)
{
    (void)state;
    const double size[] = {1, 1e-30, 1e30, 1e-160, 1e150, 1e-320, 1e308};
    for (size_t i = 0; i < sizeof size / sizeof size[0]; i++) {
        double s = size[i], a[3] = {0, 0, 0}, b[3] = {s, 0, 0}, c[3] = {0, s, 0}, d[3] = {0, 0, s};
        assert_int_equal(tc_orient3d(a, b, c, d), 1);
        assert_int_equal(tc_orient3d(a, c, b, d), -1);
        assert_int_equal(tc_orient3d(a, b, c, b), 0);
    }
}

static void a_point_one_unit_in_the_last_place_off_a_plane_is_seen(void **state)
{
    (void)state;
    /* the plane x + y + z = 3; all four points are on it up to the last bit of one coordinate */
    double a[3] = {1, 1, 1}, b[3] = {1.5, 0.75, 0.75}, c[3] = {0.25, 2.5, 0.25}, d[3] = {12, 12, -21};
    assert_int_equal(tc_orient3d(a, b, c, d), 0);
    d[2] = nextafter(-21, 0);
    int up = tc_orient3d(a, b, c, d);
    d[2] = nextafter(-21, -22);
    assert_int_equal(up, 1);
    assert_int_equal(tc_orient3d(a, b, c, d), -1);
}

static void tiny_terms_beside_huge_ones_are_not_lost(void **state)
{
    (void)state;
    double a[3] = {0, 0, 0}, b[3] = {1, 0, 0}, c[3] = {0, 1, 0}, d[3] = {1e300, -1e300, DBL_TRUE_MIN};
    assert_int_equal(tc_orient3d(a, b, c, d), 1);
    d[2] = -DBL_TRUE_MIN;
    assert_int_equal(tc_orient3d(a, b, c, d), -1);
    d[2] = 0;
    assert_int_equal(tc_orient3d(a, b, c, d), 0);
}

/* Points on a small integer grid: 64-bit integers give the truth. */
static void the_filter_and_the_long_integers_agree_with_integers(void **state)
{
    (void)state;
    int count[3] = {0, 0, 0};
    for (int n = 0; n < 20000; n++) {
        double p[4][3];
        int64_t q[4][3];
        for (int i = 0; i < 4; i++)
            for (int k = 0; k < 3; k++) {
                q[i][k] = (int64_t)(random_bits() % 5) - 2;
                p[i][k] = (double)q[i][k] * 0x1p-40 + 1e3; /* exact: 1e3 needs 10 bits, the rest 42 */
            }
        int64_t u[3][3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                u[i][k] = q[i + 1][k] - q[0][k];
        int64_t det = (u[0][1] * u[1][2] - u[0][2] * u[1][1]) * u[2][0] +
                      (u[0][2] * u[1][0] - u[0][0] * u[1][2]) * u[2][1] +
                      (u[0][0] * u[1][1] - u[0][1] * u[1][0]) * u[2][2];
        int sign = (det > 0) - (det < 0);
        count[sign + 1]++;
        assert_int_equal(tc_orient3d(p[0], p[1], p[2], p[3]), sign);
        assert_int_equal(tc_orient3d_exact(p[0], p[1], p[2], p[3]), sign);
    }
    for (int i = 0; i < 3; i++)
        assert_true(count[i] > 1000);
}

static void nearly_flat_tets_have_one_sign_in_every_even_order(void **state)
{
    (void)state;
    for (int n = 0; n < 20000; n++) {
        double p[4][3], s = random_unit(), t = random_unit();
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                p[i][k] = random_unit();
        for (int k = 0; k < 3; k++) /* in the plane up to rounding */
            p[3][k] = p[0][k] + s * (p[1][k] - p[0][k]) + t * (p[2][k] - p[0][k]);
        int sign = tc_orient3d(p[0], p[1], p[2], p[3]);
        assert_int_equal(tc_orient3d(p[1], p[2], p[0], p[3]), sign);
        assert_int_equal(tc_orient3d(p[1], p[0], p[3], p[2]), sign);
        assert_int_equal(tc_orient3d(p[3], p[2], p[1], p[0]), sign);
        assert_int_equal(tc_orient3d(p[1], p[0], p[2], p[3]), -sign);
        assert_int_equal(tc_orient3d_exact(p[0], p[1], p[2], p[3]), sign);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_right_handed_tet_is_positive_at_every_size),
        cmocka_unit_test(a_point_one_unit_in_the_last_place_off_a_plane_is_seen),
        cmocka_unit_test(tiny_terms_beside_huge_ones_are_not_lost),
        cmocka_unit_test(the_filter_and_the_long_integers_agree_with_integers),
        cmocka_unit_test(nearly_flat_tets_have_one_sign_in_every_even_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
