/* The plan of frames (cli/batch/plan.h). */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static bool make(tc_plan *out, const char *ranges, size_t n_time, size_t n_field, size_t n_function, size_t n_view,
                 const char *shard, char *why, size_t capacity)
{
    tc_plan_ranges list = {0};
    tc_plan_shard part = {0};
    if (ranges)
        assert_true(tc_plan_ranges_parse(&list, ranges, why));
    if (shard)
        assert_true(tc_plan_shard_parse(&part, shard, why));
    const tc_plan_options options = {.n_time = n_time,
                                     .ranges = &list,
                                     .n_field = n_field,
                                     .n_function = n_function,
                                     .n_view = n_view,
                                     .shard = part};
    return tc_plan_make(out, &options, why, capacity);
}

static void a_range_is_misread(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t n_time;
        const char *steps; /* "": refused */
    } row[] = {
        {"2:4", 10, "2 3 4"},
        {":2", 10, "0 1 2"},
        {"8:", 10, "8 9"},
        {":", 3, "0 1 2"},
        {"-2:", 10, "8 9"},
        {":-9", 10, "0 1"},
        {"0:9:4", 10, "0 4 8"},
        {"::5", 10, "0 5"},
        {"3", 10, "3"},
        {"-1", 10, "9"},
        {"7,1,3", 10, "1 3 7"},
        {"1:3,2:4", 10, "1 2 3 4"},
        {"0:10:5", 10, "0 5"},
        {"0:400:4", 10, "0 4 8"},
        {"5,::4", 10, "0 4 5 8"},
        {":", 0, "0"},
        {"0", 0, "0"},
        {"-1", 0, "0"},
        {"1", 0, ""},
        {"4:2", 10, ""},
        {"10", 10, ""},
        {"10:", 10, ""},
        {"-11", 10, ""},
        {"-11:", 10, ""},
        {":-11", 10, ""},
        {"0,10", 10, ""},
        {"-1:2", 10, ""},
        {"1:9:9223372036854775807", 10, "1"},
        {"9223372036854775807", 10, ""},
        {"-9223372036854775808:", 10, ""},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char why[160] = "", text[64] = "";
        tc_plan plan;
        const bool good = make(&plan, row[i].text, row[i].n_time, 1, 1, 1, NULL, why, sizeof why);
        for (size_t k = 0; good && k < plan.n_step; k++)
            snprintf(text + strlen(text), sizeof text - strlen(text), "%s%d", k ? " " : "", plan.step[k]);
        if (strcmp(text, row[i].steps) != 0)
            fail_msg("%s of %zu: %s %s", row[i].text, row[i].n_time, text, why);
        assert_int_equal(good, strlen(why) < 10);
        assert_int_equal(good, *row[i].steps != 0);
        tc_plan_finish(&plan);
    }
    static const char *const wrong[] = {"",
                                        "a",
                                        "1:2:3:4",
                                        "1:2:",
                                        "1:2:0",
                                        "1:2:-1",
                                        " 1",
                                        "1: 2",
                                        "+1:2",
                                        "1.5:2",
                                        "1,",
                                        ",1",
                                        "1,,2",
                                        "--1",
                                        "1-2",
                                        "-",
                                        "1:2 ",
                                        "0x1",
                                        "99999999999999999999",
                                        "1:1e3"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_plan_ranges ranges = {.n = 77};
        char why[64] = "";
        if (tc_plan_ranges_parse(&ranges, wrong[i], why))
            fail_msg("'%s'", wrong[i]);
        assert_int_equal(ranges.n, 77);
    }
    char many[200] = "0";
    tc_plan_ranges ranges;
    char why[64] = "";
    for (int i = 1; i < TC_PLAN_RANGES; i++)
        strcat(many, ",1");
    assert_true(tc_plan_ranges_parse(&ranges, many, why));
    assert_int_equal(ranges.n, TC_PLAN_RANGES);
    strcat(many, ",1");
    assert_false(tc_plan_ranges_parse(&ranges, many, why));
    assert_non_null(strstr(why, "at most"));
}

static void a_shard_that_is_none_is_taken(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        int index, of; /* 0: refused */
        const char *why;
    } row[] = {
        {"1/1", 1, 1, ""},
        {"3/16", 3, 16, ""},
        {"16/16", 16, 16, ""},
        {"0/16", 0, 0, "shards count from 1, as in 1/16"},
        {"-1/4", 0, 0, "shards count from 1, as in 1/4"},
        {"17/16", 0, 0, "of 16 shards the last is 16/16"},
        {"1/0", 0, 0, "1 to 1000000 shards"},
        {"1/1000001", 0, 0, "1 to 1000000 shards"},
        {"1", 0, 0, ""},
        {"/4", 0, 0, ""},
        {"1/", 0, 0, ""},
        {"1/4/2", 0, 0, ""},
        {"a/b", 0, 0, ""},
        {"1 /4", 0, 0, ""},
        {"", 0, 0, ""},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_plan_shard shard = {0};
        char why[64] = "";
        assert_int_equal(tc_plan_shard_parse(&shard, row[i].text, why), row[i].index > 0);
        assert_int_equal(shard.index, row[i].index);
        assert_int_equal(shard.of, row[i].of);
        assert_string_equal(why, row[i].why);
    }
}

static void frames_stand_in_another_order(void **state)
{
    (void)state;
    tc_plan plan;
    char why[160];
    assert_true(make(&plan, "1:9:3", 12, 2, 3, 4, NULL, why, sizeof why));
    assert_int_equal(plan.n, 3 * 2 * 3 * 4);
    assert_int_equal(plan.n_of_step, 2 * 3 * 4);
    size_t frame = 0;
    for (size_t p = 0; p < 3; p++)
        for (size_t field = 0; field < 2; field++)
            for (size_t function = 0; function < 3; function++)
                for (size_t view = 0; view < 4; view++, frame++) {
                    const tc_plan_frame at = tc_plan_frame_at(&plan, frame);
                    assert_int_equal(at.position, p);
                    assert_int_equal(at.step, 1 + 3 * (int)p);
                    assert_int_equal(at.field, field);
                    assert_int_equal(at.function, function);
                    assert_int_equal(at.view, view);
                    assert_int_equal(tc_plan_frame_of(&plan, &at), frame);
                    assert_true(tc_plan_mine(&plan, frame));
                }
    tc_plan_finish(&plan);
}

static void views_along_time_are_crossed_with_steps(void **state)
{
    (void)state;
    const tc_plan_options options = {.n_time = 5, .n_field = 2, .n_function = 1, .n_view = 99, .along = true};
    tc_plan plan;
    char why[160];
    assert_true(tc_plan_make(&plan, &options, why, sizeof why));
    assert_int_equal(plan.n, 10);
    for (size_t i = 0; i < plan.n; i++) {
        const tc_plan_frame at = tc_plan_frame_at(&plan, i);
        assert_int_equal(at.view, i / 2);
        assert_int_equal(tc_plan_frame_of(&plan, &at), i);
    }
    tc_plan_finish(&plan);
}

static void shards_leave_a_frame_out_or_make_it_twice(void **state)
{
    (void)state;
    for (size_t n_step = 1; n_step <= 9; n_step++)
        for (size_t n_field = 1; n_field <= 2; n_field++)
            for (size_t n_view = 1; n_view <= 5; n_view += 2)
                for (int of = 1; of <= 21; of++) {
                    int *made = calloc(n_step * n_field * n_view, sizeof *made), *read = calloc(n_step, sizeof *read);
                    size_t least = SIZE_MAX, most = 0, n = 0;
                    assert_non_null(made);
                    assert_non_null(read);
                    for (int k = 1; k <= of; k++) {
                        tc_plan plan;
                        char text[32], why[160];
                        size_t mine = 0, last = 0;
                        snprintf(text, sizeof text, "%d/%d", k, of);
                        assert_true(make(&plan, NULL, n_step, n_field, 1, n_view, text, why, sizeof why));
                        n = plan.n;
                        for (size_t p = 0; p < plan.n_step; p++) {
                            const tc_plan_span span = tc_plan_span_of(&plan, p);
                            read[p] += span.n > 0;
                            for (size_t f = span.first; f < span.first + span.n; f++, mine++) {
                                assert_true(tc_plan_mine(&plan, f));
                                assert_int_equal(tc_plan_frame_at(&plan, f).position, p);
                                assert_true(mine == 0 || f > last);
                                last = f;
                                made[f]++;
                            }
                        }
                        assert_int_equal(mine, tc_plan_n_mine(&plan));
                        size_t counted = 0;
                        for (size_t f = 0; f < plan.n; f++)
                            counted += tc_plan_mine(&plan, f);
                        assert_int_equal(counted, mine);
                        least = mine < least ? mine : least;
                        most = mine > most ? mine : most;
                        tc_plan_finish(&plan);
                    }
                    for (size_t f = 0; f < n; f++)
                        assert_int_equal(made[f], 1);
                    /* Where there are enough steps each is read by one shard, and none has two steps more than another.
                     */
                    for (size_t p = 0; p < n_step && n_step >= (size_t)of; p++)
                        assert_int_equal(read[p], 1);
                    if (n_step >= (size_t)of)
                        assert_true(most - least <= n_field * n_view);
                    else
                        assert_true(most <= n_field * n_view);
                    free(made);
                    free(read);
                }
}

static void too_many_frames_overflow(void **state)
{
    (void)state;
    tc_plan plan;
    char why[160] = "";
    assert_false(make(&plan, NULL, 1000, 1 << 20, SIZE_MAX / 2, SIZE_MAX / 2, NULL, why, sizeof why));
    assert_non_null(strstr(why, "has more than"));
    tc_plan_finish(&plan);
    assert_false(make(&plan, NULL, (size_t)1 << 40, 1, 1, 1, NULL, why, sizeof why));
    tc_plan_finish(&plan);
    assert_false(make(&plan, NULL, 3, 1, 0, 1, NULL, why, sizeof why));
    tc_plan_finish(&plan);
    /* The most that there may be, among the most shards: the blocks' bounds still fit. */
    assert_true(make(&plan, NULL, 1, 1000000, 1000, 1000, "1000000/1000000", why, sizeof why));
    const tc_plan_span span = tc_plan_span_of(&plan, 0);
    assert_true(span.n == 1000000 && span.first == plan.n - span.n);
    tc_plan_finish(&plan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_range_is_misread),
        cmocka_unit_test(a_shard_that_is_none_is_taken),
        cmocka_unit_test(frames_stand_in_another_order),
        cmocka_unit_test(views_along_time_are_crossed_with_steps),
        cmocka_unit_test(shards_leave_a_frame_out_or_make_it_twice),
        cmocka_unit_test(too_many_frames_overflow),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
