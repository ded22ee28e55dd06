/* test_figure_ticks.c: round numbers in a range, and how they are written. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "figure/ticks.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t state_of_random = 1;

static double uniform(void)
{
    state_of_random = state_of_random * 6364136223846793005u + 1442695040888963407u;
    return (double)(state_of_random >> 11) * 0x1p-53;
}

/* A tick's text as a number: "−1.25×10⁻⁵", "10⁵". */
static double read_back(const char *text)
{
    static const char *const sign[] = {"−", "×10", "⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹", "⁻"};
    static const char *const plain[] = {"-", "e", "0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "-"};
    char out[200] = "";
    bool has_e = strstr(text, "×") != NULL;
    for (const char *s = text; *s;) {
        size_t i = 0;
        while (i < sizeof sign / sizeof *sign && strncmp(s, sign[i], strlen(sign[i])))
            i++;
        if (i < sizeof sign / sizeof *sign) {
            if (i >= 2 && !has_e && !strchr(out, 'e')) { /* a bare power: "10" stands there */
                char *ten = strstr(out, "10");
                assert_non_null(ten);
                strcpy(ten, "1e");
            }
            strcat(out, plain[i]);
            s += strlen(sign[i]);
        } else {
            assert_true(*s > 0);
            strncat(out, s++, 1);
        }
    }
    char *end;
    double value = strtod(out, &end);
    if (*end)
        fail_msg("\"%s\" is no number", text);
    return value;
}

/* What holds of all ticks, whatever the range. */
static void check(const tc_ticks *t, double lo, double hi)
{
    for (int i = 0; i < t->n; i++) {
        assert_true(t->value[i] >= lo && t->value[i] <= hi);
        double error = fabs(read_back(t->text[i]) - t->value[i]);
        if (!(error <= 1e-4 * (hi - lo) || error <= 1e-4 * fabs(t->value[i])))
            fail_msg("%.17g in %.17g ... %.17g is written as %s", t->value[i], lo, hi, t->text[i]);
        if (i)
            assert_true(t->value[i] > t->value[i - 1] && strcmp(t->text[i], t->text[i - 1]) != 0);
    }
}

static void any_range_has_four_to_seven(void **state)
{
    (void)state;
    int count[8] = {0};
    for (int i = 0; i < 20000; i++) {
        double size = pow(10, 40 * uniform() - 20), lo = (uniform() - 0.5) * size * pow(10, 3 * uniform()),
               hi = lo + size;
        tc_ticks t;
        tc_ticks_make(&t, lo, hi, false, 7);
        if (t.n < 4 || t.n > 7)
            fail_msg("%.17g ... %.17g has %d ticks", lo, hi, t.n);
        check(&t, lo, hi);
        count[t.n]++;
        double step = (t.value[t.n - 1] - t.value[0]) / (t.n - 1), digits = step / pow(10, floor(log10(step * 1.0001)));
        assert_true(fabs(digits - 1) < 1e-3 || fabs(digits - 2) < 1e-3 || fabs(digits - 2.5) < 1e-3 ||
                    fabs(digits - 5) < 1e-3);
    }
    print_message("    4: %d, 5: %d, 6: %d, 7: %d\n", count[4], count[5], count[6], count[7]);
}

static void a_logarithmic_range_has_four_to_seven(void **state)
{
    (void)state;
    for (int i = 0; i < 20000; i++) {
        double lo = pow(10, 60 * uniform() - 30), hi = lo * pow(10, 0.01 + 30 * uniform() * uniform());
        tc_ticks t;
        tc_ticks_make(&t, lo, hi, true, 7);
        if (t.n < 4 || t.n > 7)
            fail_msg("%.17g ... %.17g has %d ticks", lo, hi, t.n);
        check(&t, lo, hi);
        for (int k = 0; k < t.n_minor; k++)
            assert_true(t.minor[k] > lo && t.minor[k] < hi);
        if (hi / lo > 1000) /* round in logarithms: neighbours differ by a factor, not by a step */
            assert_true(t.value[1] / t.value[0] > 1.9 && t.value[t.n - 1] / t.value[t.n - 2] > 1.9);
    }
}

static void fewer_are_made_where_fewer_are_asked_for(void **state)
{
    (void)state;
    for (int most = 2; most <= TC_TICKS_MAX; most++)
        for (int i = 0; i < 500; i++) {
            double lo = uniform(), hi = lo + uniform();
            tc_ticks t;
            tc_ticks_make(&t, lo, hi, i % 2, most);
            assert_true(t.n >= 1 && t.n <= most);
            check(&t, lo, hi);
        }
}

static void numbers_are_written_as_a_reader_expects(void **state)
{
    static const struct {
        double lo, hi;
        bool log;
        const char *text[7];
    } row[] = {{-1, 1, false, {"−1.0", "−0.5", "0.0", "0.5", "1.0"}},
               {0, 100, false, {"0", "20", "40", "60", "80", "100"}},
               {0, 1.1e6, false, {"0", "2×10⁵", "4×10⁵", "6×10⁵", "8×10⁵", "1×10⁶"}},
               {101300, 101320, false, {"101300", "101305", "101310", "101315", "101320"}},
               {0, 5e-9, false, {"0", "1×10⁻⁹", "2×10⁻⁹", "3×10⁻⁹", "4×10⁻⁹", "5×10⁻⁹"}},
               {-5e-9, 5e-9, false, {"−4×10⁻⁹", "−2×10⁻⁹", "0", "2×10⁻⁹", "4×10⁻⁹"}},
               {0.001, 100, true, {"0.001", "0.01", "0.1", "1", "10", "100"}},
               {1e-8, 1e-2, true, {"10⁻⁸", "10⁻⁷", "10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"}},
               {1, 10, true, {"1", "2", "5", "10"}}};
    (void)state;
    for (size_t r = 0; r < sizeof row / sizeof *row; r++) {
        tc_ticks t;
        tc_ticks_make(&t, row[r].lo, row[r].hi, row[r].log, 7);
        for (int i = 0; i < t.n; i++)
            assert_string_equal(t.text[i], row[r].text[i] ? row[r].text[i] : "nothing");
        assert_true(t.n == 7 || !row[r].text[t.n]);
    }
}

static void ranges_without_room_have_one_tick(void **state)
{
    static const double range[][2] = {{3, 3}, {0, 0}, {1, 1 + 1e-15}, {-1e300, -1e300}, {5e-324, 1e-323}};
    (void)state;
    for (size_t i = 0; i < sizeof range / sizeof *range; i++) {
        tc_ticks t;
        tc_ticks_make(&t, range[i][0], range[i][1], false, 7);
        assert_int_equal(t.n, 1);
        assert_true(t.text[0][0] != 0);
    }
    tc_ticks t;
    tc_ticks_make(&t, -1.7e308, 1.7e308, false, 7); /* whose length is beyond doubles */
    assert_true(t.n >= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_range_has_four_to_seven),
        cmocka_unit_test(a_logarithmic_range_has_four_to_seven),
        cmocka_unit_test(fewer_are_made_where_fewer_are_asked_for),
        cmocka_unit_test(numbers_are_written_as_a_reader_expects),
        cmocka_unit_test(ranges_without_room_have_one_tick),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
