/* Files over time (cli/batch/series.h). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/series.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];
/* One that is a pattern itself, if it is read as one. */
static char odd[80];

static void touch(const char *where, const char *name)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", where, name);
    int file = open(path, O_WRONLY | O_CREAT, 0600);
    assert_true(file >= 0);
    close(file);
}

static int set_up(void **state)
{
    (void)state;
    static const char *const name[] = {"a_1.vtu",   "a_2.vtu",    "a_10.vtu",   "a_11.vtu",   "a_02.vtu",
                                       "a_x.vtu",   "b_0000.vtu", "b_0010.vtu", "b_0030.vtu", "b_10000.vtu",
                                       "b_010.vtu", "c.e",        "50%.vtu",    "d_%04d.vtu", "e[1].vtu",
                                       "e1.vtu",    "f*.vtu",     "f2.vtu",     ".a_3.vtu"};
    char path[128];
    snprintf(folder, sizeof folder, "/tmp/tc_series_XXXXXX");
    if (!mkdtemp(folder))
        return -1;
    snprintf(odd, sizeof odd, "%s/o[d]%%d", folder);
    if (mkdir(odd, 0700) != 0)
        return -1;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++)
        touch(folder, name[i]);
    touch(odd, "a_1.vtu");
    touch(odd, "a_2.vtu");
    for (int i = 1; i <= 3; i++) {
        snprintf(path, sizeof path, "%s/run%d", folder, i * 4);
        if (mkdir(path, 0700) != 0)
            return -1;
        touch(path, "out.vtu");
    }
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/* What is printed on stderr while a series is made. */
static int make(tc_series *out, char *told, size_t capacity, const char *where, const char *data, const char *times)
{
    json_t *json = json_loads(data, JSON_DECODE_ANY, NULL),
           *list = times ? json_loads(times, JSON_DECODE_ANY, NULL) : NULL;
    assert_non_null(json);
    tc_talk talk;
    tc_talk_init(&talk);
    fflush(stderr);
    int saved = dup(2), file = memfd_create("told", 0);
    assert_true(saved >= 0 && file >= 0);
    dup2(file, 2);
    int code = tc_series_make(out, json, list, where, &talk);
    fflush(stderr);
    dup2(saved, 2);
    close(saved);
    ssize_t n = pread(file, told, capacity - 1, 0);
    told[n > 0 ? n : 0] = 0;
    close(file);
    json_decref(json);
    json_decref(list);
    return code;
}

static void a_series_is_not_its_files_in_their_order(void **state)
{
    (void)state;
    static const struct {
        const char *data, *files; /* NULL: refused; data with ' for " */
        bool of_files;
        const char *told; /* "": nothing */
    } row[] = {
        {"'c.e'", "c.e", false, ""},
        {"'synth:ball:8'", "synth:ball:8", false, ""},
        {"'a_%d.vtu'", "a_1.vtu a_2.vtu a_10.vtu a_11.vtu", true, "no files for 3, 4, 5, 6, 7, 8, 9\n"},
        {"'b_%04d.vtu'", "b_0000.vtu b_0010.vtu b_0030.vtu b_10000.vtu", true,
         "no files for 20, 40, 50, 60, 70, 80, 90, 100 and 989 more"},
        {"'b_%.4d.vtu'", "b_0000.vtu b_0010.vtu b_0030.vtu b_10000.vtu", true, "20, 40"},
        {"'a_*.vtu'", "a_1.vtu a_02.vtu a_2.vtu a_10.vtu a_11.vtu a_x.vtu", true, ""},
        {"'a_?.vtu'", "a_1.vtu a_2.vtu a_x.vtu", true, ""},
        {"'a_1[01].vtu'", "a_10.vtu a_11.vtu", true, ""},
        {"'run*/out.vtu'", "run4/out.vtu run8/out.vtu run12/out.vtu", true, ""},
        {"'run%d/out.vtu'", "run4/out.vtu run8/out.vtu run12/out.vtu", true, ""},
        {"'50%.vtu'", "50%.vtu", false, ""},
        {"'d_%04d.vtu'", "d_%04d.vtu", false, ""},
        {"'e[1].vtu'", "e[1].vtu", false, ""},
        {"'f*.vtu'", "f*.vtu", false, ""},
        {"'e[0-9].vtu'", "e1.vtu", true, ""},
        {"['a_10.vtu', 'c.e']", "a_10.vtu c.e", true, ""},
        {"['c.e']", "c.e", true, ""},
        {"['c.e', 'a_1?.vtu', 'a_1.vtu']", "c.e a_10.vtu a_11.vtu a_1.vtu", true, ""},
        {"['a_1.vtu', 'gone.vtu']", "a_1.vtu gone.vtu", true, ""},
        {"['gone.vtu', 'gone2.vtu']", NULL, true, "there is no such file"},
        {"'c.f'", NULL, true, "the nearest there is 'c.e'"},
        {"'bb_%04d.vtu'", NULL, true, "no file matches"},
        {"'nowhere/a_%d.vtu'", NULL, true, "nowhere/ cannot be read"},
        {"'a_%d_%d.vtu'", NULL, true, "has two numbers"},
        {"'a_%s.vtu'", NULL, true, "write %d or %04d"},
        {"'a_%4d.vtu'", NULL, true, "write %d or %04d"},
        {"'a_%%.vtu'", NULL, true, "there is no such file"},
        {"'z_*.vtu'", NULL, true, "no file matches"},
        {"''", NULL, true, "data takes"},
        {"[]", NULL, true, "data takes"},
        {"['a_1.vtu', 3]", NULL, true, "data takes"},
        {"{}", NULL, true, "data takes"},
        {"3", NULL, true, "data takes"},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char data[128], told[1024], files[512] = "";
        tc_series series;
        snprintf(data, sizeof data, "%s", row[i].data);
        for (char *at = data; *at; at++)
            *at = *at == '\'' ? '"' : *at;
        int code = make(&series, told, sizeof told, folder, data, NULL);
        if (code != (row[i].files ? -1 : TC_EXIT_FAILED))
            fail_msg("%s: code %d: %s", data, code, told);
        if (*row[i].told ? !strstr(told, row[i].told) : *told)
            fail_msg("%s says %s", data, told);
        for (size_t k = 0; row[i].files && k < series.n; k++) {
            const char *path = series.path[k];
            if (!strncmp(path, folder, strlen(folder)))
                path += strlen(folder) + 1;
            snprintf(files + strlen(files), sizeof files - strlen(files), "%s%s", k ? " " : "", path);
            if (series.of_files)
                assert_true(series.time[k] == (double)k);
        }
        if (row[i].files) {
            assert_string_equal(files, row[i].files);
            assert_int_equal(series.of_files, row[i].of_files);
            assert_int_equal(series.time != NULL, row[i].of_files);
        }
        tc_series_finish(&series);
    }
}

static void a_folders_name_is_read_as_a_pattern(void **state)
{
    (void)state;
    static const char *const data[] = {"\"a_*.vtu\"", "\"a_%d.vtu\"", "\"a_1.vtu\""};
    for (size_t i = 0; i < 3; i++) {
        char told[512], path[128];
        tc_series series;
        assert_int_equal(make(&series, told, sizeof told, odd, data[i], NULL), -1);
        assert_int_equal(series.n, i < 2 ? 2 : 1);
        snprintf(path, sizeof path, "%s/a_1.vtu", odd);
        assert_string_equal(series.path[0], path);
        tc_series_finish(&series);
    }
    char told[512];
    tc_series series;
    assert_int_equal(make(&series, told, sizeof told, odd, "\"b_%d.vtu\"", NULL), TC_EXIT_FAILED);
    assert_non_null(strstr(told, odd));
    assert_non_null(strstr(told, "the nearest there is 'a_1.vtu'"));
    tc_series_finish(&series);
}

static void times_that_do_not_fit_are_taken(void **state)
{
    (void)state;
    static const struct {
        const char *data, *times;
        bool good;
    } row[] = {
        {"\"a_1?.vtu\"", "[0.5, 2]", true},
        {"\"a_1?.vtu\"", "[-1, 0]", true},
        {"\"a_1?.vtu\"", "[0.5]", false},
        {"\"a_1?.vtu\"", "[1, 2, 3]", false},
        {"\"a_1?.vtu\"", "[2, 2]", false},
        {"\"a_1?.vtu\"", "[3, 2]", false},
        {"\"a_1?.vtu\"", "[1, \"2\"]", false},
        {"\"a_1?.vtu\"", "\"1,2\"", false},
        {"\"c.e\"", "[1]", false},
        {"\"c.e\"", "null", true},
        {"[\"c.e\"]", "[7]", true},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        char told[512];
        tc_series series;
        int code = make(&series, told, sizeof told, folder, row[i].data, row[i].times);
        if (code != (row[i].good ? -1 : TC_EXIT_FAILED) || (*told != 0) == row[i].good)
            fail_msg("%s %s: %d %s", row[i].data, row[i].times, code, told);
        if (i == 0)
            assert_true(series.time[0] == 0.5 && series.time[1] == 2);
        tc_series_finish(&series);
    }
}

static void ten_comes_before_two(void **state)
{
    (void)state;
    static const char *const order[] = {"",
                                        "a",
                                        "a1",
                                        "a01",
                                        "a2",
                                        "a2b",
                                        "a02c",
                                        "a10",
                                        "a10b2",
                                        "a10b10",
                                        "a100",
                                        "a18446744073709551616",
                                        "a18446744073709551617",
                                        "ab",
                                        "b"};
    enum { N = sizeof order / sizeof *order };
    for (int i = 0; i < N; i++)
        for (int j = 0; j < N; j++) {
            int found = tc_natural_compare(order[i], order[j]), wanted = (i > j) - (i < j);
            /* a1 and a01 differ by zeros alone: then the bytes decide */
            if ((i == 2 && j == 3) || (i == 3 && j == 2))
                wanted = -wanted;
            if ((found > 0) - (found < 0) != wanted)
                fail_msg("'%s' and '%s': %d", order[i], order[j], found);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_series_is_not_its_files_in_their_order),
        cmocka_unit_test(a_folders_name_is_read_as_a_pattern),
        cmocka_unit_test(times_that_do_not_fit_are_taken),
        cmocka_unit_test(ten_comes_before_two),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
