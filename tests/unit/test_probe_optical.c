/* test_probe_optical.c: the optical depth of a segment, against sums over a fine grid and closed forms, and its
 * inverse. */
#include "test_reference_fixture.h"

#include "probe/optical.h"

/* Steps, flat parts, nothing, and knots at three places. */
static tc_knot KNOT[] = {{-1, 0, 0, 0, 0.5}, {0, 0, 0, 0, 0},   {0.3, 0, 0, 0, 0},        {0.3, 0, 0, 0, 2},
                         {0.6, 0, 0, 0, 1},  {1, 0, 0, 0, 0.1}, {1.0000001, 0, 0, 0, 40}, {2, 0, 0, 0, 3}};
static const struct tc_transfer TF = {.n = sizeof KNOT / sizeof *KNOT, .knot = KNOT};

/* Attenuation by definition: the knot before s and the one after it. */
static double attenuation(double s)
{
    size_t i = 0;
    while (i < TF.n && KNOT[i].s <= s)
        i++;
    if (i == 0 || i == TF.n)
        return KNOT[i == 0 ? 0 : TF.n - 1].a;
    return KNOT[i - 1].a + (s - KNOT[i - 1].s) / (KNOT[i].s - KNOT[i - 1].s) * (KNOT[i].a - KNOT[i - 1].a);
}

/* Integral over s of the attenuation, from the first knot: trapezoids between knots are exact. */
static double antiderivative(double s)
{
    double sum = 0;
    if (s < KNOT[0].s)
        return (s - KNOT[0].s) * KNOT[0].a;
    for (size_t i = 0; i + 1 < TF.n; i++) {
        const tc_knot *k = &KNOT[i];
        if (s <= k[0].s)
            return sum;
        const double w = k[1].s - k[0].s, x = fmin((s - k[0].s) / fmax(w, 1e-300), 1);
        sum += w * x * (k[0].a + 0.5 * x * (k[1].a - k[0].a));
    }
    return sum + fmax(s - KNOT[TF.n - 1].s, 0) * KNOT[TF.n - 1].a;
}

static void depth_is_not_the_integral_of_the_attenuation(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int run = 0; run < 20000; run++) {
        double s0 = uniform(&seed, -1.5, 2.5), s1 = uniform(&seed, -1.5, 2.5), l = uniform(&seed, 0, 3);
        if (run % 5 == 0)
            s0 = KNOT[run % TF.n].s;
        if (run % 7 == 0)
            s1 = KNOT[run / 7 % TF.n].s;
        double truth = s0 == s1 ? l * attenuation(s0) : l * (antiderivative(s1) - antiderivative(s0)) / (s1 - s0);
        if (fabs(s1 - s0) < 1e-4 && s0 != s1)
            continue; /* the truth cancels */
        NEAR(tc_optical_depth(&TF, s0, s1, l), truth, 1e-11 * (1 + l));
        double rgba[4];
        tc_reference_segment(rgba, &TF, s0, s1, l);
        NEAR(-expm1(-tc_optical_depth(&TF, s0, s1, l)), rgba[3], 1e-12);
    }
    NEAR(tc_optical_depth(&TF, 0.3, 0.3, 2), 4, 0); /* on a step the right value holds */
    NEAR(tc_optical_depth(&TF, 0.3, 0.2, 2), 0, 0);
}

static void place_is_not_the_inverse_of_depth(void **state)
{
    (void)state;
    uint64_t seed = 6;
    for (int run = 0; run < 20000; run++) {
        const double s0 = uniform(&seed, -1.5, 2.5), s1 = run % 9 ? uniform(&seed, -1.5, 2.5) : s0;
        const double l = uniform(&seed, 0.01, 3), whole = tc_optical_depth(&TF, s0, s1, l);
        const double depth = whole * uniform(&seed, 0, 1), x = tc_optical_place(&TF, s0, s1, l, depth);
        assert_true(x >= 0 && x <= 1);
        NEAR(tc_optical_depth(&TF, s0, s0 + x * (s1 - s0), x * l), depth, 2e-10 * (1 + whole));
        NEAR(tc_optical_place(&TF, s0, s1, l, 2 * whole + 1), 1, 0);
    }
    NEAR(tc_optical_place(&TF, 0, 0.6, 1, 0), 0.5, 1e-15); /* nothing is before the step at 0.3 */
    NEAR(tc_optical_place(&TF, 5, 6, 2, 1.5), 0.25, 1e-15);
}

static void values_at_the_ends_of_doubles_give_no_number(void **state)
{
    (void)state;
    tc_knot wide[2] = {{-1.5e308, 0, 0, 0, 0}, {1.5e308, 0, 0, 0, 1}};
    const struct tc_transfer tf = {.n = 2, .knot = wide};
    NEAR(tc_optical_depth(&tf, -1.5e308, 1.5e308, 4), 2, 1e-12);
    NEAR(tc_optical_depth(&tf, 1.5e308, -1.5e308, 4), 2, 1e-12);
    NEAR(tc_optical_place(&tf, -1.5e308, 1.5e308, 4, 0.5), 0.5, 1e-12);
    tc_knot thick = {0, 0, 0, 0, 1e308};
    const struct tc_transfer solid = {.n = 1, .knot = &thick};
    assert_true(isfinite(tc_optical_depth(&solid, 0, 1, 1e300)));
    NEAR(tc_optical_place(&solid, 0, 1, 1e300, 1), 0, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth_is_not_the_integral_of_the_attenuation),
        cmocka_unit_test(place_is_not_the_inverse_of_depth),
        cmocka_unit_test(values_at_the_ends_of_doubles_give_no_number),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
