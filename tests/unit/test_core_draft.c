/* test_core_draft.c: files on their way: killed, crowded out and refused. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

typedef tc_status opener(tc_file_draft *out, const char *path, tc_error *err);
static opener *const openers[] = {tc_file_draft_open, tc_file_draft_open_named};
enum { N_OPENER = 2, LENGTH = 100000 };

static char folder[64];

static char *in_folder(const char *name)
{
    static char path[4][512];
    static int turn;
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static int files(bool remove_them)
{
    int n = 0;
    DIR *d = opendir(folder);
    for (struct dirent *e; d && (e = readdir(d));)
        if (strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0) {
            n++;
            if (remove_them)
                unlink(in_folder(e->d_name));
        }
    closedir(d);
    return n;
}

static int setup(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tetcast-test-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int teardown(void **state)
{
    (void)state;
    files(true);
    return rmdir(folder);
}

static void must(tc_status status, const tc_error *err)
{
    if (status != TC_OK)
        fail_msg("%s", err->text);
}

static void put(opener *open_it, const char *path, const char *text, bool keep)
{
    tc_file_draft draft;
    tc_error err = {0};
    must(open_it(&draft, path, &err), &err);
    must(tc_file_write(draft.fd, text, strlen(text), path, &err), &err);
    if (keep)
        must(tc_file_draft_keep(&draft, &err), &err);
    tc_file_draft_drop(&draft);
    tc_file_draft_drop(&draft); /* ended twice */
}

static void assert_holds(const char *path, const char *text)
{
    void *data;
    size_t n;
    tc_error err = {0};
    must(tc_file_read(&data, &n, path, &err), &err);
    assert_int_equal(n, strlen(text));
    assert_memory_equal(data, text, n);
    free(data);
}

static void a_dropped_file_stays_or_takes_the_old_one_with_it(void **state)
{
    (void)state;
    for (int i = 0; i < N_OPENER; i++) {
        put(openers[i], in_folder("a"), "never", false);
        assert_int_equal(files(false), 0);
        put(openers[i], in_folder("a"), "old", true);
        assert_holds(in_folder("a"), "old");
        put(openers[i], in_folder("a"), "never", false);
        assert_holds(in_folder("a"), "old");
        chmod(in_folder("a"), 0640);
        put(openers[i], in_folder("a"), "new", true);
        assert_holds(in_folder("a"), "new");
        struct stat info;
        assert_int_equal(stat(in_folder("a"), &info), 0);
        assert_int_equal(info.st_mode & 07777, 0640);
        assert_int_equal(files(true), 1);
    }
}

static bool can_be_nameless(void)
{
    int fd = open(folder, O_TMPFILE | O_RDWR, 0600);
    if (fd >= 0)
        close(fd);
    return fd >= 0;
}

/* A child that is killed while it writes. */
static void killed_while_writing(opener *open_it, const char *path)
{
    int ready[2];
    char c;
    assert_int_equal(pipe(ready), 0);
    pid_t child = fork();
    if (child == 0) {
        tc_file_draft draft;
        if (open_it(&draft, path, NULL) != TC_OK || write(draft.fd, "half", 4) != 4 || write(ready[1], "", 1) != 1)
            _exit(1);
        pause();
        _exit(2);
    }
    assert_int_equal(read(ready[0], &c, 1), 1);
    kill(child, SIGKILL);
    int how;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_true(WIFSIGNALED(how));
    close(ready[0]);
    close(ready[1]);
}

static void a_killed_writer_leaves_files_that_pile_up(void **state)
{
    (void)state;
    for (int i = 0; i < N_OPENER; i++)
        for (int replace = 0; replace < 2; replace++) {
            if (replace)
                put(openers[i], in_folder("a.png"), "old", true);
            for (int k = 0; k < 3; k++)
                killed_while_writing(openers[i], in_folder("a.png"));
            assert_int_equal(files(false), replace + (i == 1 || !can_be_nameless()));
            if (replace)
                assert_holds(in_folder("a.png"), "old");
            put(openers[i], in_folder("a.png"), "new", true);
            assert_holds(in_folder("a.png"), "new");
            assert_int_equal(files(true), 1);
        }
}

/* As after a kill between link and rename; also of a name that leaves no room for the prefix. */
static void what_a_killed_writer_left_is_kept_or_in_the_way(void **state)
{
    (void)state;
    char name[256], beside[512];
    for (int i = 0; i < N_OPENER; i++)
        for (int replace = 0; replace < 2; replace++)
            for (int n = 1; n <= 255; n += 127) {
                memset(name, 'n', (size_t)n);
                name[n] = 0;
                tc_file_draft draft;
                tc_error err = {0};
                must(tc_file_draft_open(&draft, in_folder(name), &err), &err);
                snprintf(beside, sizeof beside, "%s", draft.part);
                assert_true(strlen(strrchr(beside, '/') + 1) <= 255);
                tc_file_draft_drop(&draft);
                int fd = open(beside, O_CREAT | O_EXCL | O_WRONLY, 0600);
                assert_true(fd >= 0);
                assert_int_equal(write(fd, "left", 4), 4);
                close(fd);
                if (replace) {
                    fd = open(in_folder(name), O_CREAT | O_EXCL | O_WRONLY, 0600);
                    close(fd);
                }
                put(openers[i], in_folder(name), "new", true);
                assert_holds(in_folder(name), "new");
                assert_int_equal(files(true), 1);
            }
}

typedef struct crowd {
    char path[128];
    opener *open_it;
    char letter;
    int bad;
} crowd;

static void *write_many(void *argument)
{
    crowd *c = argument;
    char *text = malloc(LENGTH);
    memset(text, c->letter, LENGTH);
    for (int i = 0; i < 200; i++) {
        tc_file_draft draft;
        tc_error err = {0};
        if (c->open_it(&draft, c->path, &err) == TC_OK) {
            if (tc_file_write(draft.fd, text, LENGTH, c->path, &err) == TC_OK &&
                tc_file_draft_keep(&draft, &err) == TC_OK)
                continue;
            tc_file_draft_drop(&draft);
        }
        fprintf(stderr, "%s\n", err.text);
        c->bad++;
    }
    free(text);
    return NULL;
}

/* Both ways to write at once; now and then the target goes, so that both ways to name are met. */
static void writers_of_one_file_mix_or_fail(void **state)
{
    (void)state;
    enum { N = 4 };
    crowd member[N];
    pthread_t thread[N];
    for (int i = 0; i < N; i++) {
        member[i] = (crowd){.open_it = openers[i % 2], .letter = (char)('a' + i)};
        snprintf(member[i].path, sizeof member[i].path, "%s", in_folder("a"));
        assert_int_equal(pthread_create(&thread[i], NULL, write_many, &member[i]), 0);
    }
    for (int look = 0; look < 100; look++) {
        void *data;
        size_t n;
        if (tc_file_read(&data, &n, in_folder("a"), NULL) == TC_OK) {
            assert_int_equal(n, LENGTH);
            assert_true(memcmp(data, (char *)data + 1, n - 1) == 0);
            free(data);
        }
        if (look % 10 == 0)
            unlink(in_folder("a"));
        sched_yield();
    }
    for (int i = 0; i < N; i++) {
        pthread_join(thread[i], NULL);
        assert_int_equal(member[i].bad, 0);
    }
    put(openers[0], in_folder("a"), "end", true);
    assert_holds(in_folder("a"), "end");
    assert_int_equal(files(false), 1);
}

/* On a file system of 256 KiB; 77: it may not be mounted. */
static int on_a_small_disk(void)
{
    static char zeros[LENGTH];
    if ((unshare(CLONE_NEWNS) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) ||
        mount(NULL, "/", NULL, MS_REC | MS_PRIVATE, NULL) != 0 || mount("none", folder, "tmpfs", 0, "size=256k") != 0)
        return 77;
    for (int i = 0; i < N_OPENER; i++) {
        tc_file_draft draft;
        tc_error err = {0};
        tc_status status = openers[i](&draft, in_folder("a"), NULL);
        if (status != TC_OK)
            return 1;
        for (int k = 0; k < 5 && status == TC_OK; k++)
            status = tc_file_write(draft.fd, zeros, LENGTH, draft.path, &err);
        if (status != TC_E_FILE || !strstr(err.text, "free some space"))
            return 2;
        err.text[0] = 0;
        if (tc_file_draft_full(&draft, &err) != TC_E_FILE || !strstr(err.text, "free some space"))
            return 3;
        tc_file_draft_drop(&draft);
        if (files(false) != 0)
            return 4;
        if (openers[i](&draft, in_folder("a"), NULL) != TC_OK || write(draft.fd, zeros, 10) != 10 ||
            tc_file_draft_full(&draft, NULL) != TC_E_FILE)
            return 5;
        tc_file_draft_drop(&draft);
    }
    return 0;
}

static void a_full_disk_is_not_told_or_not_given_back(void **state)
{
    (void)state;
    pid_t child = fork();
    if (child == 0)
        _exit(on_a_small_disk());
    int how;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_true(WIFEXITED(how));
    if (WEXITSTATUS(how) == 77)
        skip(); /* no right to mount */
    assert_int_equal(WEXITSTATUS(how), 0);
    tc_file_draft draft;
    tc_error err = {0};
    must(tc_file_draft_open(&draft, in_folder("a"), &err), &err);
    must(tc_file_draft_full(&draft, &err), &err); /* here is room */
    tc_file_draft_drop(&draft);
}

static void a_folder_that_may_not_be_written_to_is_not_told_at_once(void **state)
{
    (void)state;
    assert_int_equal(chmod(folder, 0555), 0);
    pid_t child = fork();
    if (child == 0) {
        int bad = geteuid() == 0 && setuid(65534) != 0; /* root may write everywhere */
        for (int i = 0; i < N_OPENER && !bad; i++) {
            tc_file_draft draft;
            tc_error err = {0};
            bad = openers[i](&draft, in_folder("a"), &err) != TC_E_FILE || draft.path ||
                  !strstr(err.text, "choose a folder that you may write to");
            bad = bad || openers[i](&draft, in_folder("none/a"), &err) != TC_E_FILE ||
                  !strstr(err.text, "make its folder first");
        }
        _exit(bad);
    }
    int how;
    assert_int_equal(waitpid(child, &how, 0), child);
    chmod(folder, 0755);
    assert_true(WIFEXITED(how) && WEXITSTATUS(how) == 0);
}

static void a_name_too_long_is_told_at_the_end(void **state)
{
    (void)state;
    char name[400];
    tc_file_draft draft;
    tc_error err = {0};
    memset(name, 'n', sizeof name);
    name[300] = 0;
    for (int i = 0; i < N_OPENER; i++) {
        assert_int_equal(openers[i](&draft, in_folder(name), &err), TC_E_FILE);
        assert_non_null(strstr(err.text, "too long"));
    }
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_dropped_file_stays_or_takes_the_old_one_with_it),
        TEST(a_killed_writer_leaves_files_that_pile_up),
        TEST(what_a_killed_writer_left_is_kept_or_in_the_way),
        TEST(writers_of_one_file_mix_or_fail),
        TEST(a_full_disk_is_not_told_or_not_given_back),
        TEST(a_folder_that_may_not_be_written_to_is_not_told_at_once),
        TEST(a_name_too_long_is_told_at_the_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
