/* test_reference_segment.c: the segment integral against closed forms and against brute-force sums in long double. */
#include "test_reference_fixture.h"

static void segment(double out[4], tc_knot *knot, size_t n, double s0, double s1, double l)
{
    struct tc_transfer tf = {.n = n, .knot = knot};
    tc_reference_segment(out, &tf, s0, s1, l);
}

static void constant_function_is_not_one_minus_exp(void **state)
{
    (void)state;
    const double depths[] = {1e-12, 1e-6, 1e-3, 0.02, 0.3, 1, 5, 30, 700, 1e9};
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++) {
        tc_knot k = {.s = 7, .r = 0.25, .g = 0.5, .b = 1, .a = 2};
        double out[4], a = -expm1(-depths[i]);
        segment(out, &k, 1, -3, 11, depths[i] / 2);
        NEAR(out[3], a, 1e-15 * a);
        NEAR(out[0], 0.25 * a, 1e-15 * a);
        NEAR(out[1], 0.5 * a, 1e-15 * a);
        NEAR(out[2], a, 1e-15 * a);
    }
}

/* tau = constant, colour linear: the integral of x exp(-T x) T is (1 - exp(-T) (1 + T)) / T. */
static void linear_colour_at_constant_extinction_is_wrong(void **state)
{
    (void)state;
    for (double depth = 1e-5; depth < 1e4; depth *= 1.7) {
        tc_knot k[2] = {{0, 0.2, 0, 1, 1}, {1, 0.9, 1, 0, 1}};
        double out[4];
        segment(out, k, 2, 0, 1, depth);
        long double T = depth, j;
        if (T > 0.5L) {
            j = (1 - expl(-T) * (1 + T)) / T;
        } else {
            j = 0;
            long double term = T;
            for (int i = 0; i < 25; i++)
                j += term / (i + 2), term *= -T / (i + 1);
        }
        double a = -expm1(-depth);
        NEAR(out[0], 0.2 * a + 0.7 * (double)j, 1e-14);
        NEAR(out[1], (double)j, 1e-14 * (double)j + 1e-18);
        NEAR(out[2], a - (double)j, 1e-14);
    }
}

/* What the function is at s, by a plain search of its own; at a step the side of `toward`. */
static void lookup(long double out[4], const tc_knot *k, size_t n, long double s, long double toward)
{
    size_t i = 0;
    long double probe = s == toward ? s : s + (toward - s) * 1e-12L;
    while (i < n && (long double)k[i].s <= probe)
        i++;
    const tc_knot *a = &k[i ? i - 1 : 0], *b = &k[i < n ? i : n - 1];
    long double w = b->s > a->s ? (s - a->s) / ((long double)b->s - a->s) : 0;
    out[0] = a->r + w * ((long double)b->r - a->r);
    out[1] = a->g + w * ((long double)b->g - a->g);
    out[2] = a->b + w * ((long double)b->b - a->b);
    out[3] = a->a + w * ((long double)b->a - a->a);
}

/* Brute force: the segment is cut at every knot and each part into many panels; in each, T is exact (trapezoid of a
 * linear function) and the emission is Simpson's sum. */
static void brute(double out[4], const tc_knot *k, size_t n, double s0, double s1, double l)
{
    enum { PANELS = 16000 };
    long double cutat[64];
    size_t cuts = 0;
    cutat[cuts++] = 0;
    for (size_t q = 0; q < n; q++) {
        size_t i = s1 > s0 ? q : n - 1 - q;
        long double x = ((long double)k[i].s - s0) / ((long double)s1 - s0);
        if (s0 != s1 && x > cutat[cuts - 1] && x < 1)
            cutat[cuts++] = x;
    }
    cutat[cuts] = 1;
    long double sum[4] = {0}, T = 0;
    for (size_t c = 0; c < cuts; c++) {
        long double middle = s0 + (cutat[c] + cutat[c + 1]) / 2 * ((long double)s1 - s0);
        for (int p = 0; p < PANELS; p++) {
            /* Finer towards the entry, where thick segments have all their light. */
            long double u0 = (long double)p / PANELS, u1 = (long double)(p + 1) / PANELS;
            long double x[3] = {cutat[c] + (cutat[c + 1] - cutat[c]) * u0 * u0 * u0, 0,
                                cutat[c] + (cutat[c + 1] - cutat[c]) * u1 * u1 * u1};
            x[1] = (x[0] + x[2]) / 2;
            long double v[3][4], depth[3], h = x[2] - x[0];
            for (int i = 0; i < 3; i++)
                lookup(v[i], k, n, s0 + x[i] * ((long double)s1 - s0), middle);
            depth[0] = T;
            depth[1] = T + l * h / 2 * (v[0][3] + v[1][3]) / 2;
            depth[2] = T + l * h * (v[0][3] + v[2][3]) / 2;
            for (int i = 0; i < 3; i++)
                sum[i] += l * h / 6 *
                          (v[0][3] * v[0][i] * expl(-depth[0]) + 4 * v[1][3] * v[1][i] * expl(-depth[1]) +
                           v[2][3] * v[2][i] * expl(-depth[2]));
            T = depth[2];
        }
    }
    for (int i = 0; i < 3; i++)
        out[i] = (double)sum[i];
    out[3] = (double)-expm1l(-T);
}

static void integral_is_off_by_more_than_1e_10(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int run = 0; run < 200; run++) {
        tc_knot k[12];
        size_t n = 1 + random_bits(&seed) % 12;
        double s = -0.2;
        for (size_t i = 0; i < n; i++) {
            k[i] = (tc_knot){s, uniform(&seed, 0, 1), uniform(&seed, 0, 1), uniform(&seed, 0, 1), uniform(&seed, 0, 1)};
            if (random_bits(&seed) % 4 == 0)
                k[i].a = 0;
            if (random_bits(&seed) % 3) /* else a step */
                s += pow(10, uniform(&seed, -4, -0.5));
        }
        double s0 = uniform(&seed, -0.5, 1.5), s1 = uniform(&seed, -0.5, 1.5), l = pow(10, uniform(&seed, -6, 2.5));
        if (run % 10 == 0)
            s1 = s0;
        if (run % 10 == 1)
            s0 = k[n / 2].s; /* starts at a knot or step */
        if (run % 10 == 2)
            s1 = k[n / 2].s;
        double out[4], truth[4];
        segment(out, k, n, s0, s1, l);
        brute(truth, k, n, s0, s1, l);
        for (int i = 0; i < 4; i++)
            NEAR(out[i], truth[i], 1e-10);
    }
}

/* The quadrature's own worst cases: attenuation from or to zero at all optical depths. */
static void thick_ramps_lose_digits(void **state)
{
    (void)state;
    for (double l = 1e-3; l < 4000; l *= 2.3)
        for (int way = 0; way < 4; way++) {
            tc_knot k[2] = {{0, 0, 1, 0.3, way & 1 ? 0 : 1}, {1, 1, 0, 0.8, way & 1 ? 1 : 0.001}};
            double out[4], truth[4];
            segment(out, k, 2, way & 2 ? 1 : 0, way & 2 ? 0 : 1, l);
            brute(truth, k, 2, way & 2 ? 1 : 0, way & 2 ? 0 : 1, l);
            for (int i = 0; i < 4; i++)
                NEAR(out[i], truth[i], 2e-11);
        }
}

static void step_takes_the_wrong_side(void **state)
{
    (void)state;
    tc_knot k[4] = {{0, 1, 0, 0, 1}, {1, 1, 0, 0, 1}, {1, 0, 0, 1, 3}, {2, 0, 0, 1, 3}};
    double out[4], half = exp(-0.5), tail = exp(-1.5);
    segment(out, k, 4, 0.5, 1.5, 1);
    NEAR(out[0], 1 - half, 1e-15);
    NEAR(out[2], half * (1 - tail), 1e-15);
    NEAR(out[3], 1 - half * tail, 1e-15);
    segment(out, k, 4, 1.5, 0.5, 1);
    NEAR(out[2], 1 - tail, 1e-15);
    NEAR(out[0], tail * (1 - half), 1e-15);
    segment(out, k, 4, 1, 1, 1); /* on the step: the right one */
    NEAR(out[2], 1 - exp(-3), 1e-15);
    NEAR(out[0], 0, 0);
    segment(out, k, 4, 1, 0.5, 1); /* from the step down: the left one */
    NEAR(out[0], 1 - exp(-1), 1e-15);
    NEAR(out[2], 0, 0);
    segment(out, k, 4, -5, 7, 12); /* both ends hold outside */
    NEAR(out[3], 1 - exp(-1.0 * 6 - 3.0 * 6), 1e-15);
}

static void reversed_segment_has_another_transmittance(void **state)
{
    (void)state;
    uint64_t seed = 9;
    for (int run = 0; run < 500; run++) {
        tc_knot k[6];
        for (int i = 0; i < 6; i++)
            k[i] = (tc_knot){i / 2 * 0.3 + i % 2 * 0.1 * (run % 2), 1, 0.5, 0, uniform(&seed, 0, 8)};
        double a[4], b[4], s0 = uniform(&seed, -0.2, 1), s1 = uniform(&seed, -0.2, 1), l = uniform(&seed, 0, 3);
        segment(a, k, 6, s0, s1, l);
        segment(b, k, 6, s1, s0, l);
        NEAR(a[3], b[3], 1e-14);
    }
}

static void extremes_are_not_finite(void **state)
{
    (void)state;
    const double attenuation[] = {0, 1e-300, 1, 1e30, 1e300, INFINITY}, lengths[] = {0, 1e-300, 1, 1e300, INFINITY};
    const double at[] = {-1e308, -1, 0, 1e-320, 0.5, 1, 1e308};
    for (int i = 0; i < 36; i++)
        for (int j = 0; j < 5; j++)
            for (int p = 0; p < 49; p++) {
                tc_knot k[3] = {{0, 1, 0.5, 0, attenuation[i / 6]},
                                {1, 0.2, 1, 0, attenuation[i % 6]},
                                {1, 0.7, 0, 1, attenuation[i / 6]}};
                if ((isinf(k[0].a) || isinf(k[1].a)) && k[0].a != k[1].a)
                    continue; /* no line joins them */
                double out[4];
                segment(out, k, 3, at[p / 7], at[p % 7], lengths[j]);
                for (int c = 0; c < 4; c++)
                    if (!(out[c] >= 0 && out[c] <= 1))
                        fail_msg("attenuation %g..%g length %g scalars %g..%g: channel %d is %g", k[0].a, k[1].a,
                                 lengths[j], at[p / 7], at[p % 7], c, out[c]);
            }
    /* One cell opaque in 1e-6 of its length: what is seen is its entry. */
    tc_knot k[2] = {{0, 1, 0, 0, 1e9}, {1, 0, 1, 0, 1e9}};
    double out[4];
    segment(out, k, 2, 0.25, 1, 1);
    NEAR(out[0], 0.75, 1e-8);
    NEAR(out[3], 1, 0);
}

static void ten_thousand_knots_differ_from_two(void **state)
{
    (void)state;
    enum { N = 10001 };
    tc_knot *k = malloc(N * sizeof *k), two[2] = {{0, 1, 0, 0.5, 0}, {1, 0, 1, 0.5, 4}};
    assert_non_null(k);
    for (int i = 0; i < N; i++) {
        double s = (double)i / (N - 1);
        k[i] = (tc_knot){s, 1 - s, s, 0.5, 4 * s};
    }
    double a[4], b[4];
    segment(a, k, N, 0.1, 0.95, 2.5);
    segment(b, two, 2, 0.1, 0.95, 2.5);
    for (int i = 0; i < 4; i++)
        NEAR(a[i], b[i], 1e-12);
    free(k);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_function_is_not_one_minus_exp),
        cmocka_unit_test(linear_colour_at_constant_extinction_is_wrong),
        cmocka_unit_test(integral_is_off_by_more_than_1e_10),
        cmocka_unit_test(thick_ramps_lose_digits),
        cmocka_unit_test(step_takes_the_wrong_side),
        cmocka_unit_test(reversed_segment_has_another_transmittance),
        cmocka_unit_test(extremes_are_not_finite),
        cmocka_unit_test(ten_thousand_knots_differ_from_two),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
