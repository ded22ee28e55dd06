/* test_core_room.c: what does not fit into memory is refused before it is begun. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/room.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void the_system_has_no_or_endless_memory(void **state)
{
    (void)state;
    unsetenv("TETCAST_MEMORY");
    size_t room = tc_room_available(), all = (size_t)sysconf(_SC_PHYS_PAGES) * (size_t)sysconf(_SC_PAGESIZE);
    assert_true(room > 1 << 20 && room <= all);
    tc_error err = {0};
    assert_int_equal(tc_room_check(all + 1, &err, "making %d of %s", 3, "all"), TC_E_MEMORY);
    assert_non_null(strstr(err.text, "making 3 of all needs about"));
    assert_int_equal(tc_room_check(1, NULL, "next to nothing"), TC_OK);
}

static void what_the_user_says_is_misread(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        size_t bytes;
    } said[] = {{"0", 0},         {"12345", 12345},     {"3k", 3072},         {"1.5M", 3 << 19},
                {"2G", 2ull << 30}, {"1T", 1ull << 40}, {"1e40", SIZE_MAX}, {"1e3", 1000}};
    for (size_t i = 0; i < sizeof said / sizeof *said; i++) {
        assert_int_equal(setenv("TETCAST_MEMORY", said[i].text, 1), 0);
        assert_true(tc_room_available() == said[i].bytes);
    }
    unsetenv("TETCAST_MEMORY");
    const size_t room = tc_room_available();
    static const char *const wrong[] = {"", "much", "1X", "1GB", "-1", "nan"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(setenv("TETCAST_MEMORY", wrong[i], 1), 0);
        assert_true(tc_room_available() > room / 2); /* as if nothing was said */
    }
    unsetenv("TETCAST_MEMORY");
}

static void a_limit_is_off_by_one_or_its_figures_are_missing(void **state)
{
    (void)state;
    tc_error err = {0};
    assert_int_equal(setenv("TETCAST_MEMORY", "1.25G", 1), 0);
    assert_int_equal(tc_room_check((size_t)5 << 28, &err, "this"), TC_OK);
    assert_int_equal(tc_room_check(((size_t)5 << 28) + 1, &err, "this"), TC_E_MEMORY);
    assert_int_equal(tc_room_check((size_t)7 << 30, &err, "this"), TC_E_MEMORY);
    assert_non_null(strstr(err.text, "needs about 7.00 GiB"));
    assert_non_null(strstr(err.text, "1.25 GiB are free"));
    assert_non_null(strstr(err.text, "TETCAST_MEMORY"));
    assert_int_equal(setenv("TETCAST_MEMORY", "10", 1), 0);
    assert_int_equal(tc_room_check(11, &err, "this"), TC_E_MEMORY);
    unsetenv("TETCAST_MEMORY");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_system_has_no_or_endless_memory),
        cmocka_unit_test(what_the_user_says_is_misread),
        cmocka_unit_test(a_limit_is_off_by_one_or_its_figures_are_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
