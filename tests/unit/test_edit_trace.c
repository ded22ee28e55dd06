/* test_edit_trace.c: what a trace's file holds, from one thread and from many; none where it failed. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "edit/trace.h"

#include <dirent.h>
#include <jansson.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/test_edit_trace.XXXXXX";
static char path[64];

static int setup(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/trace.json", folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    unlink(path);
    return rmdir(folder); /* fails where something else stayed */
}

static size_t files_in_folder(void)
{
    size_t n = 0;
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir));)
        n += entry->d_name[0] != '.';
    closedir(dir);
    return n;
}

static json_t *load(json_t **events)
{
    json_error_t error;
    json_t *root = json_load_file(path, JSON_REJECT_DUPLICATES, &error);
    if (!root)
        fail_msg("%s: %s", path, error.text);
    *events = json_object_get(root, "traceEvents");
    assert_true(json_is_array(*events));
    return root;
}

static double number(const json_t *object, const char *key)
{
    const json_t *value = json_object_get(object, key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static const char *text(const json_t *object, const char *key)
{
    const char *value = json_string_value(json_object_get(object, key));
    assert_non_null(value);
    return value;
}

static void events_are_in_the_file_with_their_times(void **state)
{
    (void)state;
    tc_trace *trace;
    unlink(path);
    assert_int_equal(tc_trace_open(&trace, path, NULL), TC_OK);
    assert_true(tc_trace_keeps(trace));
    assert_int_equal(files_in_folder(), 0);
    double before = tc_trace_now();
    tc_trace_mark(trace, "pointer", 7, NULL, 3);
    double after = tc_trace_now();
    tc_trace_span(trace, "render \"1\"\n", 1000.25, 1060.5, 7, "divide", 2);
    tc_trace_span(trace, "table", 5, 4, 0, "ms", NAN);
    assert_int_equal(tc_trace_close(&trace, NULL), TC_OK);
    assert_null(trace);
    assert_int_equal(files_in_folder(), 1);

    json_t *events, *root = load(&events);
    assert_int_equal(json_array_size(events), 3);
    const json_t *mark = json_array_get(events, 0), *span = json_array_get(events, 1),
                 *last = json_array_get(events, 2);
    assert_string_equal(text(mark, "name"), "pointer");
    assert_string_equal(text(mark, "ph"), "i");
    assert_true(number(mark, "ts") >= before * 1e3 - 0.01 && number(mark, "ts") <= after * 1e3 + 0.01);
    assert_null(json_object_get(mark, "dur"));
    assert_int_equal(json_object_size(json_object_get(mark, "args")), 1);
    assert_true(number(json_object_get(mark, "args"), "id") == 7);
    assert_string_equal(text(span, "name"), "render \"1\"\n");
    assert_string_equal(text(span, "ph"), "X");
    assert_true(number(span, "ts") == 1000250 && number(span, "dur") == 60250);
    assert_true(number(span, "tid") == number(mark, "tid"));
    assert_true(number(json_object_get(span, "args"), "divide") == 2);
    assert_true(number(last, "dur") == 0);
    assert_int_equal(json_object_size(json_object_get(last, "args")), 0);
    json_decref(root);
}

enum { THREADS = 8, EVENTS = 5000 };

static void *trace_much(void *user)
{
    for (int i = 0; i < EVENTS; i++)
        tc_trace_span(user, "work", i, i + 1, (unsigned)i + 1, "value", i);
    return NULL;
}

static void no_event_of_any_thread_is_lost(void **state)
{
    (void)state;
    tc_trace *trace;
    assert_int_equal(tc_trace_open(&trace, path, NULL), TC_OK);
    pthread_t thread[THREADS];
    for (int i = 0; i < THREADS; i++)
        assert_int_equal(pthread_create(&thread[i], NULL, trace_much, trace), 0);
    for (int i = 0; i < THREADS; i++)
        pthread_join(thread[i], NULL);
    assert_int_equal(tc_trace_close(&trace, NULL), TC_OK);
    json_t *events, *root = load(&events);
    assert_int_equal(json_array_size(events), THREADS * EVENTS);
    int next[THREADS + 1] = {0}; /* of each thread: its events come in their order */
    for (size_t i = 0; i < json_array_size(events); i++) {
        const json_t *event = json_array_get(events, i);
        int tid = (int)number(event, "tid");
        assert_true(tid >= 1 && tid <= THREADS);
        assert_true(number(event, "ts") == 1e3 * next[tid] && number(event, "dur") == 1e3);
        assert_true(number(json_object_get(event, "args"), "value") == next[tid]++);
    }
    json_decref(root);
}

static void a_trace_without_a_file_keeps_nothing(void **state)
{
    (void)state;
    tc_trace *trace;
    assert_int_equal(tc_trace_open(&trace, NULL, NULL), TC_OK);
    assert_false(tc_trace_keeps(trace));
    tc_trace_mark(trace, "pointer", 1, NULL, 0);
    tc_trace_span(trace, "render", 0, 1, 1, "divide", 1);
    assert_int_equal(tc_trace_close(&trace, NULL), TC_OK);
    assert_null(trace);
    assert_int_equal(tc_trace_close(&trace, NULL), TC_OK);
}

static void a_file_that_cannot_be_is_refused_at_once(void **state)
{
    (void)state;
    tc_trace *trace = NULL;
    tc_error err = {0};
    assert_int_equal(tc_trace_open(&trace, "/nowhere/at/all.json", &err), TC_E_FILE);
    assert_null(trace);
    assert_non_null(strstr(err.text, "/nowhere/at/all.json"));
    assert_int_equal(tc_trace_open(&trace, folder, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, folder));
}

static void a_failed_trace_leaves_what_was_there(void **state)
{
    (void)state;
    char sub[80], file[120];
    snprintf(sub, sizeof sub, "%s/sub", folder);
    snprintf(file, sizeof file, "%s/trace.json", sub);
    assert_int_equal(mkdir(sub, 0777), 0);
    tc_trace *trace;
    tc_error err = {0};
    assert_int_equal(tc_trace_open(&trace, file, NULL), TC_OK);
    tc_trace_mark(trace, "pointer", 1, NULL, 0);
    assert_int_equal(rmdir(sub), 0); /* empty: nothing lies there while it is traced */
    assert_int_equal(tc_trace_close(&trace, &err), TC_E_FILE);
    assert_null(trace);
    assert_non_null(strstr(err.text, file));

    FILE *old = fopen(path, "w");
    assert_non_null(old);
    fputs("old", old);
    fclose(old);
    assert_int_equal(tc_trace_open(&trace, path, NULL), TC_OK);
    tc_trace_mark(trace, "not UTF-8: \xff", 1, NULL, 0);
    assert_int_not_equal(tc_trace_close(&trace, &err), TC_OK);
    assert_non_null(strstr(err.text, path));
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_size, 3);
    assert_int_equal(files_in_folder(), 1);
}

static void a_full_disk_is_told(void **state)
{
    (void)state;
    if (access("/dev/full", W_OK) != 0)
        skip();
    tc_trace *trace;
    tc_error err = {0};
    assert_int_equal(tc_trace_open(&trace, "/dev/full", NULL), TC_OK);
    for (int i = 0; i < 1000; i++)
        tc_trace_mark(trace, "pointer", 1, NULL, 0);
    assert_int_equal(tc_trace_close(&trace, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "/dev/full"));
}

static void a_locale_with_a_decimal_comma_changes_nothing(void **state)
{
    (void)state;
    if (!setlocale(LC_ALL, "de_DE.UTF-8") && !setlocale(LC_ALL, "fr_FR.UTF-8"))
        skip();
    events_are_in_the_file_with_their_times(state);
    setlocale(LC_ALL, "C");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(events_are_in_the_file_with_their_times),
        cmocka_unit_test(no_event_of_any_thread_is_lost),
        cmocka_unit_test(a_trace_without_a_file_keeps_nothing),
        cmocka_unit_test(a_file_that_cannot_be_is_refused_at_once),
        cmocka_unit_test(a_failed_trace_leaves_what_was_there),
        cmocka_unit_test(a_full_disk_is_told),
        cmocka_unit_test(a_locale_with_a_decimal_comma_changes_nothing),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
