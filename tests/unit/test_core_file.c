/* test_core_file.c: files appear whole or not at all. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/file.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static char *in_folder(const char *name)
{
    static char path[2][512];
    static int turn;
    turn = !turn;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static int setup(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tetcast-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

/* Deletes the folder; gives the number of files that were in it. */
static int clear(void)
{
    int n = 0;
    DIR *d = opendir(folder);
    for (struct dirent *e; d && (e = readdir(d));)
        if (strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0) {
            n++;
            unlink(in_folder(e->d_name));
        }
    closedir(d);
    return n;
}

static int teardown(void **state)
{
    (void)state;
    clear();
    return rmdir(folder);
}

static void assert_holds(const char *path, const char *text)
{
    void *data;
    size_t n;
    assert_int_equal(tc_file_read(&data, &n, path, NULL), TC_OK);
    assert_int_equal(n, strlen(text));
    assert_memory_equal(data, text, n);
    free(data);
}

static void a_file_is_not_replaced_whole(void **state)
{
    (void)state;
    char *path = in_folder("a");
    assert_int_equal(tc_file_replace(path, "first", 5, NULL), TC_OK);
    assert_holds(path, "first");
    assert_int_equal(chmod(path, 0640), 0);
    assert_int_equal(tc_file_replace(path, "2", 1, NULL), TC_OK);
    assert_holds(path, "2");
    struct stat info;
    stat(path, &info);
    assert_int_equal(info.st_mode & 07777, 0640);
    assert_int_equal(tc_file_replace(path, NULL, 0, NULL), TC_OK);
    assert_holds(path, "");
    assert_int_equal(clear(), 1);
}

static void a_long_name_has_no_room_for_the_temporary_one(void **state)
{
    (void)state;
    char name[256];
    memset(name, 'n', 255);
    name[255] = 0;
    assert_int_equal(tc_file_replace(in_folder(name), "x", 1, NULL), TC_OK);
    assert_holds(in_folder(name), "x");
}

static void a_link_is_replaced_instead_of_its_target(void **state)
{
    (void)state;
    assert_int_equal(tc_file_replace(in_folder("target"), "old", 3, NULL), TC_OK);
    assert_int_equal(symlink("target", in_folder("link")), 0);
    assert_int_equal(tc_file_replace(in_folder("link"), "new", 3, NULL), TC_OK);
    assert_holds(in_folder("target"), "new");
    struct stat info;
    assert_int_equal(lstat(in_folder("link"), &info), 0);
    assert_true(S_ISLNK(info.st_mode));
}

static void a_device_is_replaced_by_a_file(void **state)
{
    (void)state;
    struct stat info;
    tc_error err;
    assert_int_equal(tc_file_replace("/dev/null", "x", 1, &err), TC_OK);
    stat("/dev/null", &info);
    assert_true(S_ISCHR(info.st_mode));
    assert_int_equal(tc_file_replace("/dev/full", "x", 1, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "No space left"));
    assert_non_null(strstr(err.text, "/dev/full"));
}

static void a_full_disk_leaves_half_a_file(void **state)
{
    (void)state;
    struct rlimit before, tiny;
    tc_error err;
    static const char data[100000];
    assert_int_equal(tc_file_replace(in_folder("a"), "old", 3, NULL), TC_OK);
    getrlimit(RLIMIT_FSIZE, &before);
    tiny = before;
    tiny.rlim_cur = 4096;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &tiny);
    tc_status status = tc_file_replace(in_folder("a"), data, sizeof data, &err);
    tc_status other = tc_file_replace(in_folder("b"), data, sizeof data, NULL);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, SIG_DFL);
    assert_int_equal(status, TC_E_FILE);
    assert_int_equal(other, TC_E_FILE);
    assert_non_null(strstr(err.text, "free some space"));
    assert_holds(in_folder("a"), "old");
    assert_int_equal(clear(), 1);
}

static void a_wrong_place_is_not_named(void **state)
{
    (void)state;
    tc_error err;
    void *data;
    size_t n;
    assert_int_equal(tc_file_replace(in_folder("absent/a"), "x", 1, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "absent/a cannot be written"));
    assert_int_equal(tc_file_replace(folder, "x", 1, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "not a folder"));
    assert_int_equal(tc_file_replace("", "x", 1, &err), TC_E_FILE);
    assert_int_equal(tc_file_read(&data, &n, in_folder("absent"), &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "absent cannot be read"));
    assert_int_equal(tc_file_read(&data, &n, folder, &err), TC_E_FILE);
    assert_null(data);
}

static void a_file_that_does_not_tell_its_size_is_cut(void **state)
{
    (void)state;
    void *data;
    size_t n;
    assert_int_equal(tc_file_read(&data, &n, "/proc/self/status", NULL), TC_OK);
    assert_true(n > 100);
    free(data);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_file_is_not_replaced_whole),
        TEST(a_long_name_has_no_room_for_the_temporary_one),
        TEST(a_link_is_replaced_instead_of_its_target),
        TEST(a_device_is_replaced_by_a_file),
        TEST(a_full_disk_leaves_half_a_file),
        TEST(a_wrong_place_is_not_named),
        TEST(a_file_that_does_not_tell_its_size_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
