/* Tests of what is kept against a crash. */
#define _DEFAULT_SOURCE
#define _POSIX_C_SOURCE 200809L
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "edit/recovery.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char root[200], folder[220];

static int set_up(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(root, sizeof root, "%s/tc_recovery_XXXXXX", base ? base : "/tmp");
    if (!mkdtemp(root))
        return -1;
    snprintf(folder, sizeof folder, "%s/a/b", root);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", root);
    return system(command);
}

static int files(void)
{
    int n = 0;
    DIR *dir = opendir(folder);
    for (const struct dirent *entry; dir && (entry = readdir(dir));)
        n += entry->d_name[0] != '.';
    if (dir)
        closedir(dir);
    return n;
}

static void text_is(const tc_recovery *recovery, const char *text)
{
    char got[100] = "";
    FILE *file = fopen(tc_recovery_path(recovery), "r");
    assert_non_null(file);
    const size_t n = fread(got, 1, sizeof got - 1, file);
    got[n] = 0;
    fclose(file);
    assert_string_equal(got, text);
}

/* A process that keeps a text and ends as a crash does: without a word. */
static void crash_with(const char *text, int age_s)
{
    const pid_t child = fork();
    if (child == 0) {
        tc_recovery *own;
        if (tc_recovery_open(&own, folder, NULL) || (text && tc_recovery_save(own, text, NULL)))
            _exit(1);
        _exit(0);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    if (!text || age_s == 0)
        return;
    char command[400];
    snprintf(command, sizeof command, "touch -d '-%d seconds' '%s/edit-%ld-0.json'", age_s, folder, (long)child);
    assert_int_equal(system(command), 0);
}

static void what_a_running_window_keeps_is_offered(void **state)
{
    (void)state;
    tc_recovery *own, *other, *none;
    assert_int_equal(tc_recovery_claim(&none, folder, NULL), TC_OK); /* no folder */
    assert_null(none);
    assert_int_equal(tc_recovery_open(&own, folder, NULL), TC_OK);
    struct stat about;
    assert_int_equal(stat(folder, &about), 0);
    assert_int_equal(about.st_mode & 0777, 0700);
    assert_int_equal(tc_recovery_time(own), 0);
    assert_int_equal(tc_recovery_save(own, "{\"data\": 1}", NULL), TC_OK);
    assert_int_equal(tc_recovery_save(own, "{\"data\": 2}", NULL), TC_OK);
    text_is(own, "{\"data\": 2}");
    assert_true(tc_recovery_time(own) > 0);
    assert_int_equal(tc_recovery_open(&other, folder, NULL), TC_OK); /* another window of this process */
    assert_string_not_equal(tc_recovery_path(own), tc_recovery_path(other));
    assert_int_equal(tc_recovery_claim(&none, folder, NULL), TC_OK);
    assert_null(none);
    text_is(own, "{\"data\": 2}");
    assert_int_equal(files(), 3); /* and no half-written one */
    tc_recovery_close(&own, false);
    tc_recovery_close(&other, false);
    assert_int_equal(files(), 0);
}

static void what_a_crash_left_is_lost_or_offered_twice(void **state)
{
    (void)state;
    tc_recovery *first, *second, *none;
    crash_with("old", 100);
    crash_with("new", 10);
    crash_with(NULL, 0); /* nothing was kept */
    assert_int_equal(files(), 5);
    assert_int_equal(tc_recovery_claim(&first, folder, NULL), TC_OK);
    assert_non_null(first);
    text_is(first, "new");
    assert_int_equal(files(), 4); /* the lock without a file is gone */
    assert_int_equal(tc_recovery_claim(&second, folder, NULL), TC_OK);
    text_is(second, "old");
    assert_int_equal(tc_recovery_claim(&none, folder, NULL), TC_OK);
    assert_null(none);
    assert_int_equal(tc_recovery_save(first, "gone on", NULL), TC_OK); /* it is this window's now */
    tc_recovery_close(&second, true);                                  /* later */
    tc_recovery_close(&first, false);
    assert_int_equal(tc_recovery_claim(&second, folder, NULL), TC_OK);
    text_is(second, "old");
    tc_recovery_close(&second, false);
    assert_int_equal(files(), 0);
}

static void a_folder_that_cannot_be_is_not_told(void **state)
{
    (void)state;
    char path[300];
    snprintf(path, sizeof path, "%s/file", root);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fclose(file);
    strcat(path, "/below");
    tc_recovery *own;
    tc_error err = {0};
    assert_int_equal(tc_recovery_open(&own, path, &err), TC_E_FILE);
    assert_null(own);
    assert_non_null(strstr(err.text, path));
    assert_int_equal(tc_recovery_open(&own, folder, &err), TC_OK);
    char command[400];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    assert_int_equal(system(command), 0);
    assert_int_equal(tc_recovery_save(own, "text", &err), TC_E_FILE);
    assert_non_null(strstr(err.text, folder));
    tc_recovery_close(&own, true);
}

static void the_folder_is_not_the_one_of_the_state(void **state)
{
    (void)state;
    setenv("HOME", "/home/x", 1);
    setenv("XDG_STATE_HOME", "/state", 1);
    char *path = tc_recovery_folder();
    assert_string_equal(path, "/state/tetcast");
    free(path);
    setenv("XDG_STATE_HOME", "not/absolute", 1);
    path = tc_recovery_folder();
    assert_string_equal(path, "/home/x/.local/state/tetcast");
    free(path);
    unsetenv("XDG_STATE_HOME");
    unsetenv("HOME");
    assert_null(tc_recovery_folder());
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(what_a_running_window_keeps_is_offered, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_a_crash_left_is_lost_or_offered_twice, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_folder_that_cannot_be_is_not_told, set_up, tear_down),
        cmocka_unit_test(the_folder_is_not_the_one_of_the_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
