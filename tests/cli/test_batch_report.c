/* How a batch tells of its frames (cli/batch/report.h). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* stdout and stderr go to files while a report is made. */
static FILE *heard[2];
static int kept[2];
static char text[2][16384];

static void listen_on(void)
{
    fflush(NULL);
    for (int i = 0; i < 2; i++) {
        heard[i] = tmpfile();
        kept[i] = dup(i + 1);
        dup2(fileno(heard[i]), i + 1);
    }
}

static void understand(void)
{
    fflush(NULL);
    for (int i = 0; i < 2; i++) {
        dup2(kept[i], i + 1);
        close(kept[i]);
        rewind(heard[i]);
        text[i][fread(text[i], 1, sizeof text[i] - 1, heard[i])] = 0;
        fclose(heard[i]);
    }
}
#define OUT text[0]
#define ERR text[1]

static tc_talk talk;

static tc_report report(bool json, size_t all)
{
    tc_report out;
    tc_talk_init(&talk);
    talk.terminal = false;
    listen_on();
    tc_report_begin(&out, &talk, json, all);
    return out;
}

static void say(tc_report *r, tc_frame_end end, size_t number, const char *why)
{
    char file[32];
    snprintf(file, sizeof file, "f%zu.png", number);
    tc_report_frame(r, end, number, file, (int)number / 2, 0.5 * (double)number, why, end == TC_FRAME_DONE ? 3.0 : NAN,
                    end == TC_FRAME_DONE ? 100 : 0);
}

static void close_report(tc_report *r, const char *stopped)
{
    tc_report_end(r, stopped);
    tc_report_finish(r);
    understand();
}

static size_t count(const char *where, const char *what)
{
    size_t n = 0;
    for (const char *c = where; (c = strstr(c, what)) != NULL; c += strlen(what))
        n++;
    return n;
}

/* The i-th line as JSON. */
static json_t *event(size_t i)
{
    const char *line = OUT;
    for (; i > 0; i--)
        line = strchr(line, '\n') + 1;
    json_t *json = json_loadb(line, strcspn(line, "\n"), 0, NULL);
    assert_non_null(json);
    return json;
}

static void expect(json_t *json, const char *key, long long value)
{
    assert_true(json_is_integer(json_object_get(json, key)));
    assert_int_equal(json_integer_value(json_object_get(json, key)), value);
}

static void counts_of_events_agree(void **state)
{
    (void)state;
    tc_report r = report(true, 6);
    say(&r, TC_FRAME_KEPT, 0, NULL);
    say(&r, TC_FRAME_DONE, 1, NULL);
    say(&r, TC_FRAME_FAILED, 2, "f2.png \"cannot\" be\nwritten");
    tc_report_failed(&r, "step 2 (2 pictures)", "it is damaged", 2);
    say(&r, TC_FRAME_DONE, 5, NULL);
    close_report(&r, NULL);
    assert_int_equal(count(OUT, "\n"), 6);
    json_t *json = event(1);
    assert_string_equal(json_string_value(json_object_get(json, "status")), "done");
    assert_string_equal(json_string_value(json_object_get(json, "file")), "f1.png");
    expect(json, "frame", 1);
    expect(json, "step", 0);
    expect(json, "bytes", 100);
    expect(json, "finished", 2);
    json_decref(json);
    json = event(0);
    assert_null(json_object_get(json, "write_ms")); /* not measured */
    json_decref(json);
    json = event(2);
    assert_string_equal(json_string_value(json_object_get(json, "error")), "f2.png \"cannot\" be\nwritten");
    json_decref(json);
    json = event(3);
    expect(json, "frames_failed", 2);
    json_decref(json);
    json = event(4);
    expect(json, "finished", 6);
    json_decref(json);
    json = event(5);
    assert_string_equal(json_string_value(json_object_get(json, "event")), "end");
    expect(json, "done", 2);
    expect(json, "kept", 1);
    expect(json, "failed", 3);
    assert_null(json_object_get(json, "stopped"));
    json_decref(json);
    assert_int_equal(count(ERR, "wrote"), 0); /* the events say so */
}

static void without_json_a_line_for_each_file(void **state)
{
    (void)state;
    tc_report r = report(false, 3);
    for (size_t i = 0; i < 3; i++)
        say(&r, TC_FRAME_DONE, i, NULL);
    close_report(&r, NULL);
    assert_string_equal(OUT, "");
    assert_int_equal(count(ERR, "tetcast: wrote f"), 3);
    assert_non_null(strstr(ERR, "wrote f2.png (3 of 3)\n"));
    assert_non_null(strstr(ERR, "3 of 3 frames made, in "));
    assert_null(strstr(ERR, "missing"));
}

static void what_failed_is_listed_once_with_its_reason(void **state)
{
    (void)state;
    tc_report r = report(false, 10);
    say(&r, TC_FRAME_DONE, 0, NULL);
    say(&r, TC_FRAME_FAILED, 1, "f1.png cannot be written: disk full");
    say(&r, TC_FRAME_FAILED, 2, "the camera is in its focal point");
    tc_report_failed(&r, "step 2 (2 pictures)", "it is damaged", 2);
    close_report(&r, NULL);
    assert_non_null(strstr(ERR, "9 of 10 frames are missing:\n"));
    assert_non_null(strstr(ERR, "\n  f1.png cannot be written: disk full\n"));
    assert_non_null(strstr(ERR, "\n  f2.png: the camera is in its focal point\n"));
    assert_non_null(strstr(ERR, "\n  step 2 (2 pictures): it is damaged\n"));
    assert_non_null(strstr(ERR, "\n  and 5 that were not begun\n"));
}

static void thousands_that_failed_are_not_all_listed(void **state)
{
    (void)state;
    tc_report r = report(false, 1000);
    for (size_t i = 0; i < 1000; i++)
        say(&r, TC_FRAME_FAILED, i, "no");
    close_report(&r, NULL);
    assert_int_equal(count(ERR, ": no\n"), 20);
    assert_non_null(strstr(ERR, "1000 of 1000 frames are missing:\n"));
    assert_non_null(strstr(ERR, "and 980 more\n"));
    assert_null(strstr(ERR, "not begun"));
}

static void a_signal_is_one_sentence(void **state)
{
    (void)state;
    tc_report r = report(false, 9);
    talk.quiet = true;
    say(&r, TC_FRAME_DONE, 0, NULL);
    say(&r, TC_FRAME_KEPT, 1, NULL);
    close_report(&r, "SIGTERM");
    assert_int_equal(count(ERR, "\n"), 1);
    assert_non_null(strstr(ERR, "stopped by SIGTERM after 2 of 9 frames"));
    r = report(true, 9);
    close_report(&r, "SIGTERM");
    json_t *json = event(0);
    assert_string_equal(json_string_value(json_object_get(json, "stopped")), "SIGTERM");
    json_decref(json);
}

static void nothing_to_do_is_told_as_such(void **state)
{
    (void)state;
    tc_report r = report(false, 2);
    say(&r, TC_FRAME_KEPT, 0, NULL);
    say(&r, TC_FRAME_KEPT, 1, NULL);
    close_report(&r, NULL);
    assert_non_null(strstr(ERR, "all 2 frames are there"));
    assert_int_equal(count(ERR, "\n"), 1);
    r = report(false, 0);
    close_report(&r, NULL);
    assert_non_null(strstr(ERR, "none of the frames is of this shard"));
}

static void a_bar_fits_the_terminal(void **state)
{
    (void)state;
    tc_report r = report(false, 2);
    talk.terminal = true;
    char name[600];
    memset(name, 'x', sizeof name);
    strcpy(name + sizeof name - 9, "/end.png");
    r.line_at_s = 0;
    tc_report_bar(&r, name);
    understand();
    assert_int_equal(ERR[0], '\r');
    assert_null(strchr(ERR, '\n'));
    assert_true(strlen(ERR) < 80 + strlen("\r\033[K"));
    assert_non_null(strstr(ERR, "] 0/2"));
    assert_non_null(strstr(ERR, "/end.png")); /* its end tells more than its beginning */
    tc_report_finish(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_of_events_agree),
        cmocka_unit_test(without_json_a_line_for_each_file),
        cmocka_unit_test(what_failed_is_listed_once_with_its_reason),
        cmocka_unit_test(thousands_that_failed_are_not_all_listed),
        cmocka_unit_test(a_signal_is_one_sentence),
        cmocka_unit_test(nothing_to_do_is_told_as_such),
        cmocka_unit_test(a_bar_fits_the_terminal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
