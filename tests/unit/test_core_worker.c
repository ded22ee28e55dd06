/* test_core_worker.c: helper programs that work, fail, crash, hang and lie. The helper is tests/unit/helpers/fake.c. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/worker.h"

#include <dirent.h>
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

static int open_descriptors(void)
{
    DIR *folder = opendir("/proc/self/fd");
    int n = 0;
    assert_non_null(folder);
    while (readdir(folder))
        n++;
    closedir(folder);
    return n;
}

/* Each test leaves as many descriptors as it found and no child. */
static int setup(void **state)
{
    *state = (void *)(intptr_t)open_descriptors();
    return 0;
}

static int teardown(void **state)
{
    assert_int_equal(open_descriptors(), (int)(intptr_t)*state);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    assert_int_equal(errno, ECHILD);
    return 0;
}

static tc_worker *start(double total_s, double idle_s, size_t memory_bytes)
{
    tc_worker_limits limits = {total_s, idle_s, memory_bytes};
    tc_error err = {0};
    tc_worker *worker = NULL;
    if (tc_worker_start(&worker, "tetcast-fake", &limits, &err) != TC_OK)
        fail_msg("%s", err.text);
    return worker;
}

static tc_status ask(tc_reply *reply, tc_worker *worker, const char *what, tc_error *err)
{
    json_t *request = json_pack("{s:s}", "do", what);
    *err = (tc_error){0};
    tc_status status = tc_worker_call(reply, worker, request, NULL, 0, NULL, err);
    json_decref(request);
    return status;
}

static void assert_says(const tc_error *err, const char *part)
{
    if (!strstr(err->text, part))
        fail_msg("\"%s\" does not say \"%s\"", err->text, part);
}

/* Asks for trouble and expects a TC_E_WORKER sentence with `part`, and that the helper is gone afterwards. */
static void assert_trouble(const char *what, double total_s, double idle_s, const char *part)
{
    tc_worker *worker = start(total_s, idle_s, 0);
    tc_reply reply;
    tc_error err;
    assert_int_equal(ask(&reply, worker, what, &err), TC_E_WORKER);
    assert_says(&err, "tetcast-fake");
    assert_says(&err, part);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1); /* reaped already */
    assert_int_equal(ask(&reply, worker, "echo", &err), TC_E_WORKER);
    assert_says(&err, "no more requests");
    tc_worker_stop(&worker);
    assert_null(worker);
}

typedef struct heard {
    int progress, messages;
    double fraction;
    char text[64];
} heard;

static void on_message(void *user, tc_level level, const char *text)
{
    heard *h = user;
    h->messages++;
    assert_int_equal(level, TC_INFO);
    snprintf(h->text, sizeof h->text, "%s", text);
}

static void on_progress(void *user, const char *what, double fraction)
{
    heard *h = user;
    h->progress++;
    h->fraction = fraction;
    assert_string_equal(what, "echoing");
}

static void arrays_come_back_changed(void **state)
{
    (void)state;
    enum { N = 100003 };
    double *big = malloc(N * sizeof *big);
    for (int i = 0; i < N; i++)
        big[i] = i / 3.0;
    const float f[3] = {1.5f, -0.0f, 3e38f};
    const int32_t i32[1] = {-7};
    const int64_t i64[2] = {INT64_MIN, INT64_MAX};
    const uint8_t u8[5] = {1, 2, 3, 4, 255};
    const tc_array sent[] = {{"big", TC_F64, N, big}, {"f", TC_F32, 3, f},   {"none", TC_I32, 0, NULL},
                             {"i", TC_I32, 1, i32},   {"l", TC_I64, 2, i64}, {"u", TC_U8, 5, u8}};
    tc_worker *worker = start(0, 20, 0);
    heard h = {0};
    tc_log log = {on_message, on_progress, &h};
    for (int round = 0; round < 3; round++) { /* one helper serves many requests */
        json_t *request = json_pack("{s:s,s:i}", "do", "echo", "echo", round);
        tc_reply reply;
        tc_error err = {0};
        assert_int_equal(tc_worker_call(&reply, worker, request, sent, 6, &log, &err), TC_OK);
        json_decref(request);
        assert_int_equal(json_integer_value(json_object_get(reply.json, "echo")), round);
        assert_int_equal(reply.n_array, 6);
        for (int a = 0; a < 6; a++) {
            static const size_t size[] = {8, 4, 4, 8, 1};
            const tc_array *got = tc_reply_array(&reply, sent[a].name, sent[a].type);
            assert_non_null(got);
            assert_int_equal(got->count, sent[a].count);
            assert_non_null(got->data);
            if (got->count > 0)
                assert_memory_equal(got->data, sent[a].data, got->count * size[got->type]);
        }
        assert_null(tc_reply_array(&reply, "big", TC_F32));
        assert_null(tc_reply_array(&reply, "absent", TC_F64));
        ((double *)tc_reply_array(&reply, "big", TC_F64)->data)[0] = 42; /* the mapping is ours to write */
        assert_true(reply.peak_bytes > 100000);
        tc_reply_finish(&reply);
    }
    assert_int_equal(h.progress, 3);
    assert_int_equal(h.messages, 3);
    assert_true(h.fraction == 0.5);
    assert_string_equal(h.text, "here is 100% of it");
    tc_worker_stop(&worker);
    free(big);
}

static void a_big_request_text_deadlocks(void **state)
{
    (void)state;
    size_t n = 8u << 20; /* far more than a socket buffers */
    char *text = malloc(n + 1);
    memset(text, 'x', n);
    text[n] = 0;
    json_t *request = json_pack("{s:s,s:s}", "do", "echo", "echo", text);
    tc_worker *worker = start(0, 20, 0);
    tc_reply reply;
    tc_error err = {0};
    assert_int_equal(tc_worker_call(&reply, worker, request, NULL, 0, NULL, &err), TC_OK);
    assert_string_equal(json_string_value(json_object_get(reply.json, "echo")), text);
    tc_reply_finish(&reply);
    tc_worker_stop(&worker);
    json_decref(request);
    free(text);
}

static void a_crash_is_not_told_with_signal_and_last_words(void **state)
{
    (void)state;
    assert_trouble("crash", 0, 20, "ended with signal 11 (");
    assert_trouble("crash", 0, 20, ": the last words");
}

static void an_exit_is_not_told_with_its_code(void **state)
{
    (void)state;
    assert_trouble("exit", 0, 20, "ended with exit code 3");
    assert_trouble("exit", 0, 20, "said on standard output");
}

static void a_hanging_helper_outlives_its_limits(void **state)
{
    (void)state;
    assert_trouble("hang", 0, 0.2, "made no progress for 0.2 s and was stopped");
    assert_trouble("hang", 0.2, 0, "was not done after 0.2 s and was stopped");
    assert_trouble("hang", 0.2, 20, "was not done after 0.2 s and was stopped");
}

static void a_flood_of_progress_or_talk_defeats_the_time_limit(void **state)
{
    (void)state;
    assert_trouble("flood", 0.2, 5, "was not done after 0.2 s");
    assert_trouble("babble", 0.2, 0, "babbling without end");
    assert_trouble("babble", 0, 0.2, "made no progress for 0.2 s");
}

static void malformed_messages_are_believed(void **state)
{
    (void)state;
    assert_trouble("garbage", 0, 20, "broke the protocol");
    assert_trouble("huge", 0, 20, "broke the protocol");
    assert_trouble("missing", 0, 20, "0 descriptors instead of 1");
    assert_trouble("half", 0, 20, "in the midst of a message");
    assert_trouble("array", 0, 20, "no JSON object");
    assert_trouble("unknown", 0, 20, "neither result");
}

static void arrays_outside_their_memory_are_read(void **state)
{
    (void)state;
    static const char *const what[] = {"beyond", "overflow", "negative", "crooked", "nothing"};
    for (size_t i = 0; i < sizeof what / sizeof *what; i++)
        assert_trouble(what[i], 0, 20, "lies outside its memory");
}

static void an_error_reply_ends_the_helper(void **state)
{
    (void)state;
    tc_worker *worker = start(0, 20, 0);
    tc_reply reply;
    tc_error err;
    assert_int_equal(ask(&reply, worker, "complain", &err), TC_E_FILE);
    assert_string_equal(err.text, "no such ? file"); /* not UTF-8, made so */
    assert_int_equal(ask(&reply, worker, "silent", &err), TC_E_FILE);
    assert_says(&err, "no answer");
    assert_int_equal(ask(&reply, worker, "echo", &err), TC_OK);
    tc_reply_finish(&reply);
    tc_worker_stop(&worker);
}

static void a_memory_limit_is_not_set(void **state)
{
    (void)state;
    size_t limit = (size_t)3 << 30;
    tc_worker *worker = start(0, 20, limit);
    tc_reply reply;
    tc_error err;
    assert_int_equal(ask(&reply, worker, "about", &err), TC_OK);
    json_int_t got = json_integer_value(json_object_get(reply.json, "limit"));
    if (!SANITIZED)
        assert_int_equal(got, limit);
    tc_reply_finish(&reply);
    assert_int_equal(ask(&reply, worker, "crash", &err), TC_E_WORKER);
    assert_says(&err, "under its memory limit of 3072 MiB");
    tc_worker_stop(&worker);
}

static void the_machines_memory_is_not_a_number(void **state)
{
    (void)state;
    const double all = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    tc_worker *worker = start(0, 20, TC_WORKER_MACHINE);
    tc_reply reply;
    tc_error err;
    assert_int_equal(ask(&reply, worker, "about", &err), TC_OK);
    json_int_t got = json_integer_value(json_object_get(reply.json, "limit"));
    if (!SANITIZED)
        assert_true(got > 0 && (double)got <= all * 7 / 8 + 1);
    tc_reply_finish(&reply);
    assert_int_equal(ask(&reply, worker, "crash", &err), TC_E_WORKER);
    assert_says(&err, " MiB (7/8 of the machine's");
    char sentence[64];
    snprintf(sentence, sizeof sentence, "under its memory limit of %.0f MiB", (double)got / 1048576);
    if (!SANITIZED)
        assert_says(&err, sentence);
    tc_worker_stop(&worker);
}

static void descriptors_of_the_host_reach_the_helper(void **state)
{
    (void)state;
    FILE *file = tmpfile(); /* without CLOEXEC */
    assert_non_null(file);
    tc_worker *worker = start(0, 20, 0);
    tc_reply reply;
    tc_error err;
    assert_int_equal(ask(&reply, worker, "about", &err), TC_OK);
    assert_int_equal(json_integer_value(json_object_get(reply.json, "open")), 0);
    tc_reply_finish(&reply);
    tc_worker_stop(&worker);
    fclose(file);
}

static void peak_memory_is_not_the_helpers_own(void **state)
{
    (void)state;
    tc_worker *worker = start(0, 20, 0);
    tc_reply reply;
    tc_error err;
    size_t self, helper;
    assert_int_equal(ask(&reply, worker, "touch", &err), TC_OK);
    assert_true(reply.peak_bytes >= 64u << 20);
    tc_memory_peak(&self, &helper);
    assert_true(helper >= reply.peak_bytes);
    assert_true(self > 0);
    tc_reply_finish(&reply);
    tc_worker_stop(&worker);
}

static void a_host_that_reaps_children_breaks_the_call(void **state)
{
    (void)state;
    struct sigaction ignore = {.sa_handler = SIG_IGN}, before;
    sigaction(SIGCHLD, &ignore, &before); /* children are collected by the kernel */
    tc_worker *worker = start(0, 20, 0);
    tc_reply reply;
    tc_error err;
    assert_int_equal(ask(&reply, worker, "echo", &err), TC_OK);
    tc_reply_finish(&reply);
    assert_int_equal(ask(&reply, worker, "crash", &err), TC_E_WORKER);
    assert_says(&err, "tetcast-fake ended");
    tc_worker_stop(&worker);
    sigaction(SIGCHLD, &before, NULL);
}

static void closed_standard_descriptors_break_the_start(void **state)
{
    (void)state;
    int saved = dup(0);
    close(0); /* the socket pair then gets low numbers */
    tc_worker *worker = start(0, 20, 0);
    tc_reply reply;
    tc_error err;
    tc_status status = ask(&reply, worker, "echo", &err);
    tc_reply_finish(&reply);
    tc_worker_stop(&worker);
    dup2(saved, 0);
    close(saved);
    assert_int_equal(status, TC_OK);
}

static void a_helper_that_died_between_requests_raises_sigpipe(void **state)
{
    (void)state;
    tc_worker *worker = start(0, 20, 0);
    tc_reply reply;
    tc_error err;
    assert_int_equal(ask(&reply, worker, "about", &err), TC_OK);
    pid_t pid = (pid_t)json_integer_value(json_object_get(reply.json, "pid"));
    tc_reply_finish(&reply);
    siginfo_t info;
    kill(pid, SIGKILL);
    waitid(P_PID, (id_t)pid, &info, WEXITED | WNOWAIT);
    assert_int_equal(ask(&reply, worker, "echo", &err), TC_E_WORKER);
    assert_says(&err, "signal 9");
    tc_worker_stop(&worker);
}

static void a_missing_helper_is_not_named(void **state)
{
    (void)state;
    tc_worker *worker;
    tc_error err = {0};
    tc_worker_limits limits = {0};
    assert_int_equal(tc_worker_start(&worker, "tetcast-absent", &limits, &err), TC_E_WORKER);
    assert_null(worker);
    assert_says(&err, "tetcast-absent was not found");
    assert_says(&err, "TETCAST_HELPERS");
}

static void a_file_that_is_no_program_is_run(void **state)
{
    (void)state;
    char folder[] = "/tmp/tetcast-test-XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/tetcast-text", folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("no program\n", file);
    fclose(file);
    chmod(path, 0755);
    char *before = getenv("TETCAST_HELPERS") ? strdup(getenv("TETCAST_HELPERS")) : NULL;
    setenv("TETCAST_HELPERS", folder, 1);
    tc_worker *worker;
    tc_error err = {0};
    assert_int_equal(tc_worker_start(&worker, "tetcast-text", NULL, &err), TC_E_WORKER);
    assert_says(&err, "tetcast-text could not be started");
    if (before)
        setenv("TETCAST_HELPERS", before, 1);
    else
        unsetenv("TETCAST_HELPERS");
    free(before);
    unlink(path);
    rmdir(folder);
}

/* The parent process of this test ends while its helper works; the helper must end, too. */
static void a_helper_outlives_its_parent(void **state)
{
    (void)state;
    int said[2];
    assert_int_equal(pipe(said), 0);
    pid_t middle = fork();
    if (middle == 0) {
        tc_worker *worker = start(0, 0, 0);
        tc_reply reply;
        tc_error err;
        ask(&reply, worker, "about", &err);
        pid_t pid = (pid_t)json_integer_value(json_object_get(reply.json, "pid"));
        if (write(said[1], &pid, sizeof pid) != sizeof pid)
            _exit(1);
        alarm(1); /* ends us in the call */
        ask(&reply, worker, "hang", &err);
        _exit(1);
    }
    pid_t helper = 0;
    assert_int_equal(read(said[0], &helper, sizeof helper), sizeof helper);
    close(said[0]);
    close(said[1]);
    int how = 0;
    assert_int_equal(waitpid(middle, &how, 0), middle);
    assert_true(WIFSIGNALED(how) && WTERMSIG(how) == SIGALRM);
    char path[64], line[256], run_state = 'X';
    snprintf(path, sizeof path, "/proc/%d/stat", (int)helper);
    for (int i = 0; i < 500; i++, usleep(10000)) { /* until it is gone, or a zombie of init */
        FILE *file = fopen(path, "r");
        run_state = 'X';
        if (!file)
            break;
        if (fgets(line, sizeof line, file) && strrchr(line, ')'))
            run_state = strrchr(line, ')')[2];
        fclose(file);
        if (run_state == 'Z' || run_state == 'X')
            break;
    }
    assert_true(run_state == 'Z' || run_state == 'X');
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, setup, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(arrays_come_back_changed),
        TEST(a_big_request_text_deadlocks),
        TEST(a_crash_is_not_told_with_signal_and_last_words),
        TEST(an_exit_is_not_told_with_its_code),
        TEST(a_hanging_helper_outlives_its_limits),
        TEST(a_flood_of_progress_or_talk_defeats_the_time_limit),
        TEST(malformed_messages_are_believed),
        TEST(arrays_outside_their_memory_are_read),
        TEST(an_error_reply_ends_the_helper),
        TEST(a_memory_limit_is_not_set),
        TEST(the_machines_memory_is_not_a_number),
        TEST(descriptors_of_the_host_reach_the_helper),
        TEST(peak_memory_is_not_the_helpers_own),
        TEST(a_host_that_reaps_children_breaks_the_call),
        TEST(closed_standard_descriptors_break_the_start),
        TEST(a_helper_that_died_between_requests_raises_sigpipe),
        TEST(a_missing_helper_is_not_named),
        TEST(a_file_that_is_no_program_is_run),
        TEST(a_helper_outlives_its_parent),
    };
    if (getenv("TC_VALGRIND")) /* it makes another process of posix_spawn, whose failing exec is not told here */
        cmocka_set_skip_filter("a_file_that_is_no_program_is_run");
    return cmocka_run_group_tests(tests, NULL, NULL);
}
