/* Cinema databases (cli/batch/cinema.h) and their CSV (cli/batch/csv.h). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/cinema.h"
#include "cli/batch/csv.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const tc_cinema_column column[] = {{"time", TC_CINEMA_FLOAT},
                                          {"step", TC_CINEMA_INTEGER},
                                          {"tf", TC_CINEMA_TEXT},
                                          {"FILE", TC_CINEMA_FILE},
                                          {"FILE_depth", TC_CINEMA_FILE}};
enum { N_COLUMN = 5 };
static char folder[64], cdb[96], csv[128];

static int begin(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tetcast-cinema-XXXXXX");
    if (!mkdtemp(folder))
        return -1;
    snprintf(cdb, sizeof cdb, "%s/run.cdb", folder);
    snprintf(csv, sizeof csv, "%s/data.csv", cdb);
    return 0;
}

static int end(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static tc_cinema *open_it(void)
{
    tc_cinema *c;
    tc_error err = {0};
    if (tc_cinema_open(&c, cdb, column, N_COLUMN, false, &err) != TC_OK)
        fail_msg("%s", err.text);
    return c;
}

static void add(tc_cinema *c, double time, long long step, const char *tf, const char *file, const char *depth)
{
    const tc_cinema_value value[N_COLUMN] = {
        {.number = time}, {.integer = step}, {.text = tf}, {.text = file}, {.text = depth}};
    tc_error err = {0};
    if (tc_cinema_add(c, value, &err) != TC_OK)
        fail_msg("%s", err.text);
}

static void save(tc_cinema *c)
{
    tc_error err = {0};
    if (tc_cinema_save(c, &err) != TC_OK)
        fail_msg("%s", err.text);
}

/* All of a file, static memory. */
static const char *content(const char *path)
{
    static char text[1 << 20];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    size_t n = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[n] = 0;
    return text;
}

static void put(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

/* The validator, which lies beside this test, finds nothing wrong. */
static void keeps_the_rules(void)
{
    char self[256], command[512];
    ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
    assert_true(n > 0);
    self[n] = 0;
    *strrchr(self, '/') = 0;
    snprintf(command, sizeof command, "'%s/cinema_check' '%s'", self, cdb);
    assert_int_equal(system(command), 0);
}

static void nothing_stays_beside(void)
{
    char path[160];
    snprintf(path, sizeof path, "%s/.data.csv.new", cdb);
    assert_int_not_equal(access(path, F_OK), 0);
}

static void a_float_is_not_read_as_it_was_or_has_no_point(void **state)
{
    (void)state;
    static const struct {
        double value;
        const char *text;
    } row[] = {{30, "30.0"},           {1e-5, "1.0e-05"},
               {0.1, "0.1"},           {-0.0, "0.0"},
               {-2.5, "-2.5"},         {1e15, "1000000000000000.0"},
               {1e16, "1.0e+16"},      {123456789.25, "123456789.25"},
               {0.0001, "0.0001"},     {0.1 + 0.2, "0.30000000000000004"},
               {1.5e300, "1.5e+300"},  {5e-324, "4.94065645841247e-324"},
               {NAN, "nan"},           {100, "100.0"},
               {-1.25e-7, "-1.25e-07"}};
    char text[64];
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_csv_float(text, row[i].value);
        assert_string_equal(text, row[i].text);
    }
    uint64_t bits = 12345;
    for (int i = 0; i < 20000; i++) {
        double value, again;
        bits = bits * 6364136223846793005u + 1442695040888963407u;
        uint64_t mixed = bits ^ bits >> 31;
        memcpy(&value, &mixed, sizeof value);
        if (!isfinite(value))
            continue;
        tc_csv_float(text, value);
        assert_true(tc_csv_read_float(&again, text));
        assert_true(again == value);
        assert_non_null(strchr(text, '.'));
    }
}

static void the_locale_changes_the_table(void **state)
{
    (void)state;
    char command[200];
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 '%s/de_DE.UTF-8' >%s/said 2>&1", folder, folder);
    (void)!system(command);
    setenv("LOCPATH", folder, 1);
    if (!setlocale(LC_ALL, "de_DE.UTF-8"))
        skip();
    char text[64];
    double value;
    snprintf(text, sizeof text, "%.1f", 2.5);
    bool comma = !strcmp(text, "2,5");
    tc_csv_float(text, 2.5);
    bool read = tc_csv_read_float(&value, "2.5");
    setlocale(LC_ALL, "C");
    assert_true(comma);
    assert_string_equal(text, "2.5");
    assert_true(read && value == 2.5);
}

static void a_text_is_not_read_as_it_was_written(void **state)
{
    (void)state;
    static const char *const value[] = {"plain",  "a,b",    "say \"hi\"", "two\nlines", "cr\r\nlf",
                                        " blank", "blank ", "",           "\"",         "ä"};
    tc_csv_text text = {0};
    tc_csv_reader reader;
    tc_csv_cell cell[10];
    size_t n;
    const char *why = NULL;
    for (size_t i = 0; i < 10; i++) {
        tc_csv_put(&text, ",", i > 0);
        tc_csv_put_value(&text, value[i]);
    }
    tc_csv_put(&text, "\n", 1);
    assert_false(text.failed);
    assert_memory_equal(text.data, "plain,\"a,b\",\"say \"\"hi\"\"\",\"two\nlines\",", 37);
    tc_csv_begin(&reader, text.data, text.n);
    assert_int_equal(tc_csv_next(&reader, cell, 10, &n, &why), 1);
    assert_int_equal(n, 10);
    for (size_t i = 0; i < 10; i++)
        assert_string_equal(cell[i].text, value[i]);
    assert_true(cell[7].quoted && !cell[0].quoted);
    assert_int_equal(tc_csv_next(&reader, cell, 10, &n, &why), 0);
    free(text.data);
    static const char *const damaged[] = {"a,b", "a,\"b", "a,\"b\"", "a\"b,c\n", "\"a\"b,c\n", "a\rb\n", "\"a\" ,b\n"};
    for (size_t i = 0; i < sizeof damaged / sizeof *damaged; i++) {
        char *copy = malloc(strlen(damaged[i])); /* exactly as long, so that valgrind sees what is read behind it */
        memcpy(copy, damaged[i], strlen(damaged[i]));
        tc_csv_begin(&reader, copy, strlen(damaged[i]));
        why = NULL;
        assert_int_equal(tc_csv_next(&reader, cell, 10, &n, &why), -1);
        assert_non_null(why);
        free(copy);
    }
}

static void a_text_is_taken_for_a_number(void **state)
{
    (void)state;
    static const char *const number[] = {"1",    "0001",  "-2.5e3", "nan",  "NaN",  "inf", "Infinity",
                                         "0x1f", "1_000", " 7 ",    "0b11", "0o17", "",    " "};
    static const char *const text[] = {"front", "0001a", "1-2", "_", "1.2.3", "e5", "0b12x", "a.png", "infra"};
    char why[320];
    for (size_t i = 0; i < sizeof number / sizeof *number; i++) {
        assert_false(tc_cinema_text_ok(number[i], why, sizeof why));
        assert_non_null(strstr(why, "because it"));
    }
    for (size_t i = 0; i < sizeof text / sizeof *text; i++)
        assert_true(tc_cinema_text_ok(text[i], NULL, 0));
    assert_false(tc_cinema_text_ok("\xff\xfe", NULL, 0));
    assert_false(tc_cinema_text_ok("a\xed\xa0\x80", NULL, 0));
    assert_true(tc_cinema_text_ok("\xf0\x9f\x8e\xac", NULL, 0));
}

static void the_order_of_adding_changes_the_bytes(void **state)
{
    (void)state;
    tc_cinema *c = open_it();
    assert_int_equal(access(csv, F_OK), -1);
    save(c);
    assert_int_equal(access(csv, F_OK), -1); /* no table without rows */
    add(c, 10, 1, "warm, dark", "b.png", NULL);
    add(c, 2, 1, "cool", "a.png", "a_depth.exr");
    add(c, NAN, 7, "cool", "c.png", NULL);
    add(c, 2, -3, "Cool", "d.png", NULL);
    assert_int_equal(tc_cinema_count(c), 4);
    save(c);
    tc_cinema_destroy(&c);
    static const char want[] = "time,step,tf,FILE,FILE_depth\n"
                               "2.0,-3,Cool,d.png,\n"
                               "2.0,1,cool,a.png,a_depth.exr\n"
                               "10.0,1,\"warm, dark\",b.png,\n"
                               ",7,cool,c.png,\n";
    assert_string_equal(content(csv), want);
    keeps_the_rules();
    nothing_stays_beside();
    remove(csv);
    for (int part = 0; part < 2; part++) { /* two runs, the other way round */
        c = open_it();
        assert_int_equal(tc_cinema_count(c), part ? 2 : 0);
        add(c, 2, part ? 1 : -3, part ? "cool" : "Cool", part ? "a.png" : "d.png", part ? "a_depth.exr" : NULL);
        add(c, part ? 10 : NAN, part ? 1 : 7, part ? "warm, dark" : "cool", part ? "b.png" : "c.png", NULL);
        save(c);
        tc_cinema_destroy(&c);
    }
    assert_string_equal(content(csv), want);
}

static void a_row_is_there_twice(void **state)
{
    (void)state;
    tc_cinema *c = open_it();
    for (int i = 0; i < 1000; i++) {
        char name[32];
        snprintf(name, sizeof name, "%d.png", i);
        add(c, i % 10, 0, "a", name, NULL); /* the same parameters */
    }
    assert_int_equal(tc_cinema_count(c), 10);
    add(c, 99, 5, "b", "990.png", NULL); /* the same file */
    assert_int_equal(tc_cinema_count(c), 10);
    save(c);
    tc_cinema_destroy(&c);
    c = open_it();
    add(c, 99, 5, "b", "new.png", NULL);
    add(c, 77, 5, "b", "991.png", NULL);
    save(c);
    assert_int_equal(tc_cinema_count(c), 10);
    save(c);
    tc_cinema_destroy(&c);
    assert_string_equal(content(csv), "time,step,tf,FILE,FILE_depth\n"
                                      "2.0,0,a,992.png,\n3.0,0,a,993.png,\n4.0,0,a,994.png,\n5.0,0,a,995.png,\n"
                                      "6.0,0,a,996.png,\n7.0,0,a,997.png,\n8.0,0,a,998.png,\n9.0,0,a,999.png,\n"
                                      "77.0,5,b,991.png,\n99.0,5,b,new.png,\n");
}

static void a_value_that_breaks_the_rules_is_taken(void **state)
{
    (void)state;
    static const tc_cinema_value wrong[][N_COLUMN] = {
        {{.number = INFINITY}, {.integer = 1}, {.text = "a"}, {.text = "a.png"}, {.missing = true}},
        {{.number = 1}, {.integer = 1}, {.text = "1"}, {.text = "a.png"}, {.missing = true}},
        {{.number = 1}, {.integer = 1}, {.text = "a"}, {.text = "/a.png"}, {.missing = true}},
        {{.number = 1}, {.integer = 1}, {.text = "a"}, {.text = "12"}, {.missing = true}},
        {{.missing = true}, {.missing = true}, {.missing = true}, {.missing = true}, {.text = NULL}},
    };
    tc_cinema *c = open_it();
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_error err = {0};
        assert_int_equal(tc_cinema_add(c, wrong[i], &err), TC_E_ARG);
        assert_non_null(strstr(err.text, cdb));
    }
    assert_int_equal(tc_cinema_count(c), 0);
    tc_cinema_destroy(&c);
    static const tc_cinema_column bad[][2] = {
        {{"a", TC_CINEMA_FLOAT}, {"a", TC_CINEMA_FLOAT}},      {{"a", TC_CINEMA_FLOAT}, {"file", TC_CINEMA_FILE}},
        {{"FILES", TC_CINEMA_FLOAT}, {"b", TC_CINEMA_FLOAT}},  {{"FILE", TC_CINEMA_FILE}, {"b", TC_CINEMA_FLOAT}},
        {{"FILE", TC_CINEMA_FILE}, {"FILE2", TC_CINEMA_FILE}}, {{" a", TC_CINEMA_FLOAT}, {"b", TC_CINEMA_FLOAT}},
        {{"3", TC_CINEMA_FLOAT}, {"b", TC_CINEMA_FLOAT}},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        tc_error err = {0};
        assert_int_equal(tc_cinema_open(&c, cdb, bad[i], 2, false, &err), TC_E_ARG);
        assert_null(c);
        assert_true(strlen(err.text) > 20);
    }
    tc_error err = {0};
    assert_int_equal(tc_cinema_open(&c, folder, column, N_COLUMN, false, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, ".cdb"));
}

static void a_table_that_cannot_be_merged_is_lost(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } row[] = {
        {"time,step,FILE\n1.0,2,a.png\n", "another run"},
        {"time,step,tf,FILE,FILE_depth\n1.0,x,a,a.png,\n", "no whole number"},
        {"time,step,tf,FILE,FILE_depth\nsoon,1,a,a.png,\n", "no number"},
        {"time,step,tf,FILE,FILE_depth\n1.0,1,a,a.png,\n2.0,1,a,b.p", "line 3: it ends within a row"},
        {"time,step,tf,FILE,FILE_depth\n1.0,1,a,a.png,\n2.0,1\n", "2 values where 5"},
        {"time,step,tf,FILE,FILE_depth\n1.0,1,\"a\"b,a.png,\n", "line 2"},
        {"time", "first line"},
    };
    assert_int_equal(mkdir(cdb, 0777), 0);
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        tc_cinema *c;
        tc_error err = {0};
        put(csv, row[i].text);
        assert_int_equal(tc_cinema_open(&c, cdb, column, N_COLUMN, false, &err), TC_E_FILE);
        assert_non_null(strstr(err.text, row[i].says));
        assert_non_null(strstr(err.text, csv));
        assert_null(strchr(err.text, '\n'));
        nothing_stays_beside();
        remove(csv);
        c = open_it(); /* damaged while the run goes on */
        add(c, 5, 5, "a", "new.png", NULL);
        put(csv, row[i].text);
        assert_int_equal(tc_cinema_save(c, &err), TC_E_FILE);
        assert_string_equal(content(csv), row[i].text);
        nothing_stays_beside();
        remove(csv); /* mended: nothing that was added is lost */
        save(c);
        assert_non_null(strstr(content(csv), "5.0,5,a,new.png,\n"));
        remove(csv);
        tc_cinema_destroy(&c);
    }
    put(csv,
        "\xEF\xBB\xBFtime,step,tf,FILE,FILE_depth\r\n3,4,\"x\",y.png,\"\"\r\n"); /* of another program, but whole */
    tc_cinema *c = open_it();
    add(c, 1, 1, "a", "a.png", NULL);
    save(c);
    tc_cinema_destroy(&c);
    assert_string_equal(content(csv), "time,step,tf,FILE,FILE_depth\n1.0,1,a,a.png,\n3.0,4,x,y.png,\"\"\n");
}

static void rows_of_lost_files_stay_or_go_unasked(void **state)
{
    (void)state;
    char path[160];
    tc_cinema *c = open_it();
    add(c, 1, 1, "a", "kept.png", NULL);
    add(c, 2, 1, "a", "gone.png", NULL);
    add(c, 3, 1, "a", "empty.png", NULL);
    snprintf(path, sizeof path, "%s/kept.png", cdb);
    put(path, "x");
    snprintf(path, sizeof path, "%s/empty.png", cdb);
    put(path, "");
    save(c);
    tc_cinema_destroy(&c);
    c = open_it();
    save(c);
    assert_int_equal(tc_cinema_count(c), 3);
    tc_cinema_drop_missing(c, true);
    add(c, 2, 9, "a", "soon.png", NULL); /* what this run adds is believed */
    save(c);
    assert_int_equal(tc_cinema_count(c), 2);
    assert_string_equal(content(csv), "time,step,tf,FILE,FILE_depth\n1.0,1,a,kept.png,\n2.0,9,a,soon.png,\n");
    tc_cinema_destroy(&c);
}

/* Adds every n-th row of 400 and saves now and then. */
static void add_share(int part, int n)
{
    tc_cinema *c = open_it();
    for (int i = part; i < 400; i += n) {
        char name[32];
        snprintf(name, sizeof name, "f%d.png", i);
        add(c, (i * 37 % 400) / 8.0, i, i % 3 ? "cool" : "warm", name, NULL);
        if (i % 7 == 0)
            save(c);
    }
    save(c);
    tc_cinema_destroy(&c);
}

static void shards_lose_rows_of_each_other(void **state)
{
    (void)state;
    add_share(0, 1);
    char *one = strdup(content(csv));
    keeps_the_rules();
    size_t lines = 0;
    for (const char *p = one; *p; p++)
        lines += *p == '\n';
    assert_int_equal(lines, 401);
    for (int round = 0; round < 3; round++) {
        pid_t child[2];
        remove(csv);
        for (int part = 0; part < 2; part++) {
            child[part] = fork();
            if (child[part] == 0) {
                add_share(part, 2);
                _exit(0);
            }
        }
        for (int part = 0; part < 2; part++) {
            int how = 1;
            assert_int_equal(waitpid(child[part], &how, 0), child[part]);
            assert_int_equal(how, 0);
        }
        assert_string_equal(content(csv), one);
        nothing_stays_beside();
    }
    free(one);
}

static void a_killed_process_damages_the_table_or_blocks_others(void **state)
{
    (void)state;
    for (int round = 0; round < 20; round++) {
        pid_t child = fork();
        if (child == 0) {
            for (;;)
                add_share(0, 1);
        }
        usleep(3000 + (useconds_t)round * 1700);
        kill(child, SIGKILL);
        waitpid(child, NULL, 0);
        tc_cinema *c = open_it(); /* refused where data.csv is damaged */
        tc_cinema_destroy(&c);
    }
    remove(csv);
    add_share(0, 1);
    nothing_stays_beside();
}

static void a_save_without_a_place_loses_the_table(void **state)
{
    (void)state;
    tc_error err = {0};
    tc_cinema *c = open_it();
    add(c, 1, 1, "a", "a.png", NULL);
    save(c);
    char *before = strdup(content(csv));
    for (int i = 0; i < 200; i++)
        add(c, 2 + i, 1, "a", NULL, NULL);
    struct rlimit had, small = {1024, RLIM_INFINITY};
    getrlimit(RLIMIT_FSIZE, &had);
    small.rlim_max = had.rlim_max;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    tc_status status = tc_cinema_save(c, &err);
    setrlimit(RLIMIT_FSIZE, &had);
    assert_int_equal(status, TC_E_FILE);
    assert_non_null(strstr(err.text, csv));
    assert_non_null(strstr(err.text, "free some space"));
    assert_string_equal(content(csv), before);
    nothing_stays_beside();
    save(c);
    assert_int_equal(tc_cinema_count(c), 201);
    tc_cinema_destroy(&c);
    free(before);
    snprintf(cdb, sizeof cdb, "%s/none/run.cdb", folder);
    assert_int_equal(tc_cinema_open(&c, cdb, column, N_COLUMN, false, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "make the one around it first"));
}

static void a_lock_that_is_held_is_not_respected(void **state)
{
    (void)state;
    char path[160];
    tc_cinema *c = open_it();
    add(c, 1, 1, "a", "a.png", NULL);
    snprintf(path, sizeof path, "%s/.data.csv.new", cdb);
    int file = open(path, O_RDWR | O_CREAT, 0666);
    assert_int_equal(flock(file, LOCK_EX), 0);
    pid_t child = fork();
    if (child == 0) {
        close(file); /* else the lock is the child's, too */
        save(c);
        _exit(0);
    }
    usleep(200000);
    assert_int_equal(waitpid(child, NULL, WNOHANG), 0); /* it waits */
    assert_int_equal(access(csv, F_OK), -1);
    rename(path, csv); /* the holder writes an empty table: the child must begin anew and not write into it */
    close(file);
    int how = 1;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    assert_string_equal(content(csv), "time,step,tf,FILE,FILE_depth\n1.0,1,a,a.png,\n");
    tc_cinema_destroy(&c);
}

#define CASE(name) cmocka_unit_test_setup_teardown(name, begin, end)

int main(void)
{
    const struct CMUnitTest test[] = {
        cmocka_unit_test(a_float_is_not_read_as_it_was_or_has_no_point),
        CASE(the_locale_changes_the_table),
        cmocka_unit_test(a_text_is_not_read_as_it_was_written),
        cmocka_unit_test(a_text_is_taken_for_a_number),
        CASE(the_order_of_adding_changes_the_bytes),
        CASE(a_row_is_there_twice),
        CASE(a_value_that_breaks_the_rules_is_taken),
        CASE(a_table_that_cannot_be_merged_is_lost),
        CASE(rows_of_lost_files_stay_or_go_unasked),
        CASE(shards_lose_rows_of_each_other),
        CASE(a_killed_process_damages_the_table_or_blocks_others),
        CASE(a_save_without_a_place_loses_the_table),
        CASE(a_lock_that_is_held_is_not_respected),
    };
    return cmocka_run_group_tests(test, NULL, NULL);
}
