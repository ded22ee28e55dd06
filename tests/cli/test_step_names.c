/* The names and numbers of several steps (cli/picture/step_names.h). */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/picture/step_names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void a_range_is_misread(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int n_time;
        const char *steps; /* "": refused */
    } row[] = {
        {"2:4", 10, "2 3 4"},   {":2", 10, "0 1 2"},     {"8:", 10, "8 9"},
        {":", 3, "0 1 2"},      {"-2:", 10, "8 9"},      {":-9", 10, "0 1"},
        {"0:9:4", 10, "0 4 8"}, {"::5", 10, "0 5"},      {"3:3", 10, "3"},
        {"-3:-2", 10, "7 8"},   {":", 0, "0"},           {"0:0", 0, "0"},
        {"1:", 0, ""},          {"4:2", 10, ""},         {":10", 10, ""},
        {"-11:", 10, ""},       {"0:2147483647", 3, ""}, {"1:9:2147483647", 10, "1"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_step_range range;
        char why[160] = "", text[64] = "";
        int step[8];
        assert_true(tc_step_range_parse(&range, row[i].text, why));
        size_t n = tc_step_range_list(step, 8, &range, (size_t)row[i].n_time, why, sizeof why);
        assert_true(n <= 8);
        for (size_t k = 0; k < n; k++) {
            size_t at = strlen(text);
            snprintf(text + at, sizeof text - at, "%s%d", k ? " " : "", step[k]);
        }
        assert_string_equal(text, row[i].steps);
        assert_int_equal(n == 0, strlen(why) > 10);
    }
    static const char *const wrong[] = {"",       "3",    "a:b",  "1:2:3:4", "1:2:",  "1:2:0",
                                        "1:2:-1", " 1:2", "1: 2", "+1:2",    "1.5:2", "1:99999999999"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_step_range range;
        char why[64];
        assert_false(tc_step_range_parse(&range, wrong[i], why));
    }
}

static void a_name_is_not_that_of_its_pattern(void **state)
{
    (void)state;
    static const struct {
        const char *pattern, *name; /* NULL: refused */
    } row[] = {
        {"a.png", "a_0012.png"},
        {"b.c/a", "b.c/a_0012"},
        {"{step}.png", "12.png"},
        {"{step:04d}.png", "0012.png"},
        {"{step:4d}.png", "  12.png"},
        {"x{step:06}y.exr", "x000012y.exr"},
        {"t{time}.png", "t2.625.png"},
        {"t{time:.1f}_{step:03d}.png", "t2.6_012.png"},
        {"{time:06d}.png", "000003.png"},
        {"{time:08.2f}.png", "00002.62.png"},
        {"{time:.2e}.png", "2.62e+00.png"},
        {"{{step}}.png", "{step}_0012.png"},
        {"{{{step}}}.png", "{12}.png"},
        {"{frame}.png", NULL},
        {"{step:04x}.png", NULL},
        {"{step:.2f}.png", NULL},
        {"{time:.2d}.png", NULL},
        {"{time:999f}.png", NULL},
        {"{time:.99f}.png", NULL},
        {"{step:99999999999999999999d}.png", NULL},
        {"{time:.99999999999999999999f}.png", NULL},
        {"{step.png", NULL},
        {"{steps}.png", NULL},
        {"step}.png", NULL},
        {"{}.png", NULL},
        {"{", NULL},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char name[64], why[256] = "";
        bool good = tc_step_name(name, sizeof name, row[i].pattern, 12, 2.625, why, sizeof why);
        if (good != (row[i].name != NULL))
            fail_msg("%s: %s", row[i].pattern, good ? name : why);
        if (good)
            assert_string_equal(name, row[i].name);
        else
            assert_true(strlen(why) > 10);
    }
}

static void a_placeholder_is_not_seen(void **state)
{
    (void)state;
    static const char *const with[] = {"{step}.png", "a{time:.3f}", "{{{step}}}", "{x{step", "a_{steps}"};
    static const char *const without[] = {"", "{", "a.png", "step}", "{{step}}", "{ste", "{{{{time}}}}", "{x}"};
    for (size_t i = 0; i < sizeof with / sizeof *with; i++)
        if (!tc_step_is_in_name(with[i]))
            fail_msg("%s", with[i]);
    for (size_t i = 0; i < sizeof without / sizeof *without; i++)
        if (tc_step_is_in_name(without[i]))
            fail_msg("%s", without[i]);
}

static void a_name_that_does_not_fit_is_cut(void **state)
{
    (void)state;
    for (size_t capacity = 1; capacity < 32; capacity++) {
        for (int k = 0; k < 2; k++) {
            char *name = malloc(capacity), why[256]; /* so that what is written behind it is seen */
            assert_non_null(name);
            bool good =
                tc_step_name(name, capacity, k ? "abc{step:012d}.png" : "abcdefghijk.png", 1, 0, why, sizeof why);
            assert_int_equal(good, capacity > (k ? 19 : 20));
            if (good)
                assert_string_equal(name, k ? "abc000000000001.png" : "abcdefghijk_0001.png");
            free(name);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_range_is_misread),
        cmocka_unit_test(a_name_is_not_that_of_its_pattern),
        cmocka_unit_test(a_placeholder_is_not_seen),
        cmocka_unit_test(a_name_that_does_not_fit_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
