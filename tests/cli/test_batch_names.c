/* Names of pictures from templates (cli/batch/names.h). */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/names.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const tc_name_values values = {
    .time = 2.625,
    .step = 12,
    .frame = 345,
    .number = 7,
    .phi = 30,
    .theta = -22.5,
    .view = "from above",
    .tf = "maps/Cool to Warm",
    .field = "velocity:magnitude",
    .kind = "depth",
};

static void a_name_is_not_that_of_its_template(void **state)
{
    (void)state;
    static const struct {
        const char *pattern, *name; /* NULL: refused */
        unsigned uses;
    } row[] = {
        {"a.png", "a.png", 0},
        {"", "", 0},
        {"{time}.png", "2.625.png", TC_NAME_TIME},
        {"{time:.1f}", "2.6", TC_NAME_TIME},
        {"{time:06d}", "000003", TC_NAME_TIME},
        {"{time:08.2f}", "00002.62", TC_NAME_TIME},
        {"{time:.2e}", "2.62e+00", TC_NAME_TIME},
        {"d/{step}_{step:06d}.exr", "d/12_000012.exr", TC_NAME_STEP},
        {"{frame}_{frame:06d}", "345_000345", TC_NAME_FRAME},
        {"{phi}_{theta}", "30_-22.5", TC_NAME_PHI | TC_NAME_THETA},
        {"{theta:+}", NULL, 0},
        {"{theta:05.0f}", "-0022", TC_NAME_THETA},
        {"{view}.png", "from_above.png", TC_NAME_VIEW},
        {"{tf}/{field}_{kind}", "maps_Cool_to_Warm/velocity_magnitude_depth",
         TC_NAME_TF | TC_NAME_FIELD | TC_NAME_KIND},
        {"p.%04d.png", "p.0007.png", TC_NAME_NUMBER},
        {"p%.4d", "p0007", TC_NAME_NUMBER},
        {"p%d_%3d", "p7_  7", TC_NAME_NUMBER},
        {"{step}%d", "127", TC_NAME_STEP | TC_NAME_NUMBER},
        {"50%%{{x}}", "50%{x}", 0},
        {"{{{step}}}", "{12}", TC_NAME_STEP},
        {"%", NULL, 0},
        {"%s", NULL, 0},
        {"%5.3d", NULL, 0},
        {"%0d", NULL, 0},
        {"%.d", NULL, 0},
        {"%99d", NULL, 0},
        {"%99999999999999999999d", NULL, 0},
        {"%n", NULL, 0},
        {"{eye}", NULL, TC_NAME_EYE},
        {"{Step}", NULL, 0},
        {"{}", NULL, 0},
        {"{", NULL, 0},
        {"}", NULL, 0},
        {"{step", NULL, 0},
        {"{step:.2f}", NULL, 0},
        {"{frame:x}", NULL, 0},
        {"{view:3}", NULL, 0},
        {"{time:.99f}", NULL, 0},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char name[96], why[256] = "";
        const bool good = tc_name_make(name, sizeof name, row[i].pattern, &values, why, sizeof why);
        if (good != (row[i].name != NULL))
            fail_msg("%s: %s", row[i].pattern, good ? name : why);
        if (good)
            assert_string_equal(name, row[i].name);
        else
            assert_true(strlen(why) > 10);
        const unsigned uses = tc_name_uses(row[i].pattern, why, sizeof why);
        if (uses != row[i].uses)
            fail_msg("%s uses %x, not %x", row[i].pattern, uses, row[i].uses);
        assert_int_equal(*why != 0, row[i].name == NULL && row[i].uses == 0);
    }
}

static void a_mistyped_placeholder_is_not_led_to_the_right_one(void **state)
{
    (void)state;
    static const char *const row[][2] = {
        {"{stpe}", "{step}"},
        {"{tiem:.3f}", "{time}"},
        {"{feild}", "{field}"},
        {"{fram}", "{frame}"},
        {"{thta}", "{theta}"},
        {"{views}", "{view}"},
        {"{tf:3}", "{tf} takes no format"},
        {"{step:e}", "{step:06d}"},
        {"{phi:q}", "{phi:.3f}"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char why[256] = "";
        assert_int_equal(tc_name_uses(row[i][0], why, sizeof why), 0);
        if (!strstr(why, row[i][1]) || !strstr(why, row[i][0]))
            fail_msg("%s: %s", row[i][0], why);
    }
}

static void what_there_is_none_of_gets_into_a_name(void **state)
{
    (void)state;
    const tc_name_values none = {.time = NAN, .phi = NAN, .theta = INFINITY};
    static const char *const row[] = {"{time}", "{time:06d}", "{phi}",   "{theta:.3f}",
                                      "{view}", "{tf}",       "{field}", "{eye}"};
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char name[64], why[256] = "";
        if (tc_name_make(name, sizeof name, row[i], &none, why, sizeof why))
            fail_msg("%s: %s", row[i], name);
        assert_true(strstr(why, "has no value here"));
    }
}

static void a_number_is_longer_than_it_need_be_or_reads_back_as_another(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } row[] = {
        {0, "0"},
        {-0.0, "0"},
        {1, "1"},
        {100000, "100000"},
        {-2.5, "-2.5"},
        {0.1, "0.1"},
        {1.0 / 3, "0.3333333333333333"},
        {1e15, "1000000000000000"},
        {1e16, "1e+16"},
        {1e-4, "0.0001"},
        {1e-5, "1e-05"},
        {123456.789, "123456.789"},
        {5e-324, "5e-324"},
        {DBL_MAX, "1.7976931348623157e+308"},
        {0.1 + 0.2, "0.30000000000000004"},
        {9007199254740993.0, "9007199254740992"},
    };
    char text[32];
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_name_number(text, sizeof text, row[i].value);
        assert_string_equal(text, row[i].text);
    }
    uint64_t bits = 12345;
    for (int i = 0; i < 20000; i++) {
        double value;
        bits = bits * 6364136223846793005u + 1442695040888963407u;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        tc_name_number(text, sizeof text, value);
        assert_true(strtod(text, NULL) == value);
    }
}

static void a_text_leads_out_of_its_folder_or_to_none(void **state)
{
    (void)state;
    static const char *const row[][2] = {
        {"", "_"},
        {".", "_"},
        {"..", "__"},
        {"...", "..."},
        {"../x", ".._x"},
        {"a b", "a_b"},
        {"/etc", "_etc"},
        {"a\nb", "a_b"},
        {"x-1.2_y", "x-1.2_y"},
        {"K\xc3\xbchl", "K_hl"},
        {"\xe6\x97\xa5\xe6\x9c\xac", "__"},
        {"{a}%d", "_a__d"},
        {"\xff", "_"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char text[32];
        tc_name_safe(text, sizeof text, row[i][0]);
        assert_string_equal(text, row[i][1]);
    }
    char small[3];
    tc_name_safe(small, sizeof small, "abcdef");
    assert_string_equal(small, "ab");
}

static void a_name_that_does_not_fit_is_cut(void **state)
{
    (void)state;
    for (size_t capacity = 0; capacity < 32; capacity++) {
        char *name = malloc(capacity + 1), why[256] = ""; /* so that what is written behind it is seen */
        assert_non_null(name);
        name[capacity] = 'x';
        const bool good = tc_name_make(name, capacity, "abc{step:012d}.png", &values, why, sizeof why);
        assert_int_equal(good, capacity > 19);
        assert_int_equal(name[capacity], 'x');
        if (good)
            assert_string_equal(name, "abc000000000012.png");
        else
            assert_true(strlen(why) > 10);
        free(name);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_name_is_not_that_of_its_template),
        cmocka_unit_test(a_mistyped_placeholder_is_not_led_to_the_right_one),
        cmocka_unit_test(what_there_is_none_of_gets_into_a_name),
        cmocka_unit_test(a_number_is_longer_than_it_need_be_or_reads_back_as_another),
        cmocka_unit_test(a_text_leads_out_of_its_folder_or_to_none),
        cmocka_unit_test(a_name_that_does_not_fit_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
