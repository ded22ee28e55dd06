/* Threads that write pictures (cli/batch/writers.h). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cli/batch/writers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static void path_of(char out[128], const char *kind, size_t i)
{
    snprintf(out, 128, "%s/%s%zu.png", folder, kind, i);
}

static int begin(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tetcast-writers-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int end(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/* A frame of as many small pictures as kinds are given, whose paths are to be made of them. */
static tc_frame_files frame(size_t number, const char *first, const char *second)
{
    tc_frame_files out = {.frame = number};
    const char *const kind[] = {first, second};
    for (int i = 0; i < 2 && kind[i]; i++) {
        char path[128];
        tc_picture_file *file = &out.file[out.n++];
        path_of(path, kind[i], number);
        file->path = strdup(path);
        assert_int_equal(tc_image_create(&file->image, 8, 6, NULL), TC_OK);
        for (size_t k = 0; k < 8 * 6 * 4; k++)
            file->image->rgba[k] = (float)(number % 10) / 10;
        tc_meta_add(&file->meta, "key", strdup(kind[i]));
    }
    return out;
}

static bool is_whole(const char *kind, size_t i)
{
    char path[128], *text = NULL;
    path_of(path, kind, i);
    const bool good = tc_image_check(&text, path, "key", NULL, NULL) == TC_OK && text && !strcmp(text, kind);
    free(text);
    return good;
}

static bool is_there(const char *kind, size_t i)
{
    char path[128];
    path_of(path, kind, i);
    return access(path, F_OK) == 0;
}

static void every_frame_is_written_and_told_once(void **state)
{
    (void)state;
    enum { N = 24 };
    bool told[N] = {false};
    tc_written written;
    tc_writers *writers = tc_writers_start(3, 4);
    assert_non_null(writers);
    assert_false(tc_writers_take(&written, writers, true)); /* none is under way */
    size_t n = 0;
    for (size_t i = 0; i < N; i++) {
        tc_frame_files files = frame(i, "depth", "own");
        assert_true(tc_writers_put(writers, &files));
        assert_int_equal(files.n, 0); /* they are the writers' now */
        while (tc_writers_take(&written, writers, false))
            told[written.frame] = ++n > 0;
    }
    while (tc_writers_take(&written, writers, true)) {
        struct stat depth, own;
        char path[128];
        n++;
        assert_false(told[written.frame]);
        told[written.frame] = true;
        assert_int_equal(written.status, TC_OK);
        path_of(path, "depth", written.frame);
        assert_int_equal(stat(path, &depth), 0);
        path_of(path, "own", written.frame);
        assert_int_equal(stat(path, &own), 0);
        assert_int_equal(written.bytes, depth.st_size + own.st_size);
        assert_true(written.ms >= 0);
    }
    assert_int_equal(n, N);
    tc_writers_stop(&writers);
    assert_null(writers);
    for (size_t i = 0; i < N; i++)
        assert_true(told[i] && is_whole("depth", i) && is_whole("own", i));
}

static void what_comes_after_a_file_that_failed_is_not_written(void **state)
{
    (void)state;
    tc_written written;
    tc_writers *writers = tc_writers_start(1, 2);
    tc_frame_files bad = frame(70, "no/folder", "after"), good = frame(71, "first", "after");
    assert_true(tc_writers_put(writers, &bad));
    assert_true(tc_writers_put(writers, &good));
    assert_true(tc_writers_take(&written, writers, true));
    assert_int_equal(written.frame, 70);
    assert_int_equal(written.status, TC_E_FILE);
    assert_non_null(strstr(written.err.text, "no/folder70.png"));
    assert_int_equal(written.bytes, 0);
    assert_true(tc_writers_take(&written, writers, true));
    assert_int_equal(written.frame, 71);
    assert_int_equal(written.status, TC_OK);
    assert_false(tc_writers_take(&written, writers, true));
    tc_writers_stop(&writers);
    assert_false(is_there("after", 70));
    assert_true(is_whole("after", 71));
}

static void what_waits_is_written_before_the_threads_end(void **state)
{
    (void)state;
    tc_writers *writers = tc_writers_start(1, 10);
    for (size_t i = 80; i < 90; i++) {
        tc_frame_files files = frame(i, "late", NULL);
        assert_true(tc_writers_put(writers, &files));
    }
    tc_writers_stop(&writers); /* results that nobody took go with them */
    for (size_t i = 80; i < 90; i++)
        assert_true(is_whole("late", i));
}

static void room_for_one_is_enough(void **state)
{
    (void)state;
    tc_written written;
    size_t n = 0;
    tc_writers *writers = tc_writers_start(2, 5);
    tc_writers_set_room(writers, 0); /* one at least */
    for (size_t i = 90; i < 99; i++) {
        tc_frame_files files = frame(i, "one", NULL);
        assert_true(tc_writers_put(writers, &files));
    }
    while (tc_writers_take(&written, writers, true))
        n++;
    assert_int_equal(n, 9);
    tc_writers_stop(&writers);
    tc_writers_stop(&writers); /* once more is nothing */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_frame_is_written_and_told_once),
        cmocka_unit_test(what_comes_after_a_file_that_failed_is_not_written),
        cmocka_unit_test(what_waits_is_written_before_the_threads_end),
        cmocka_unit_test(room_for_one_is_enough),
    };
    return cmocka_run_group_tests(tests, begin, end);
}
