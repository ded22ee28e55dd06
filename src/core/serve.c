/* serve.c: the helper's side: receives requests, sends progress, results and errors, and ends with its parent. */
#define _GNU_SOURCE
#include "core/serve.h"
#include "core/wire.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#ifndef __has_feature
#define __has_feature(name) 0 /* clang's way to ask; gcc defines macros */
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || __has_feature(address_sanitizer) ||                \
    __has_feature(thread_sanitizer)
#define SANITIZED 1 /* sanitizers reserve terabytes of addresses: no RLIMIT_AS */
#else
#define SANITIZED 0
#endif

struct tc_serve {
    const char *name;
    atomic_bool busy; /* a request is being worked on */
    bool answered;
    char what[128]; /* of the last progress */
    double last_ms; /* when it was sent; negative: none yet */
};

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

/* Ends a helper whose parent is gone while it works: nobody waits for the answer any more. */
static void *watch_parent(void *argument)
{
    tc_serve *serve = argument;
    struct pollfd socket = {.fd = TC_WIRE_SOCKET, .events = 0};
    while (poll(&socket, 1, -1) < 0 && errno == EINTR)
        ;
    if (atomic_load(&serve->busy))
        _exit(0);
    return NULL; /* idle: the main thread sees the end of the stream by itself */
}

static void start_watch(tc_serve *serve)
{
    sigset_t all, before;
    pthread_attr_t attributes;
    pthread_t thread;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    if (pthread_attr_init(&attributes) == 0) {
        pthread_attr_setstacksize(&attributes, 256 << 10);
        pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
        (void)pthread_create(&thread, &attributes, watch_parent, serve); /* without it the helper ends later */
        pthread_attr_destroy(&attributes);
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
}

static void set_limits(void)
{
    struct rlimit limit = {0, 0};
    if (getrlimit(RLIMIT_CORE, &limit) == 0) {
        limit.rlim_cur = 0; /* a crash is an expected answer and leaves no file behind */
        setrlimit(RLIMIT_CORE, &limit);
    }
    const char *text = getenv(TC_WIRE_MEMORY);
    unsigned long long bytes = text ? strtoull(text, NULL, 10) : 0;
    if (bytes > 0 && !SANITIZED && getrlimit(RLIMIT_AS, &limit) == 0) {
        limit.rlim_cur = limit.rlim_max == RLIM_INFINITY || bytes < limit.rlim_max ? (rlim_t)bytes : limit.rlim_max;
        setrlimit(RLIMIT_AS, &limit);
    }
}

/* Sends a message with peak_bytes in it; a parent that is gone ends the helper. False: it could not be packed. */
static bool send_message(json_t *message, const tc_array *array, size_t n_array, tc_error *err)
{
    tc_wire_out out;
    json_object_set_new(message, "peak_bytes", json_integer((json_int_t)tc_wire_peak_bytes()));
    if (tc_wire_pack(&out, message, array, n_array, err) != TC_OK)
        return false;
    if (tc_wire_send(&out, TC_WIRE_SOCKET, 0, err) != TC_WIRE_DONE)
        _exit(0);
    tc_wire_out_finish(&out);
    return true;
}

/* Sends a small message that this function owns; a helper without memory for it cannot go on. */
static void send_small(json_t *message)
{
    tc_error err = {0};
    if (!message || !send_message(message, NULL, 0, &err)) {
        fprintf(stderr, "out of memory for a message\n");
        _exit(1);
    }
    json_decref(message);
}

void tc_serve_progress(tc_serve *serve, const char *what, double fraction)
{
    double now = now_ms();
    bool same = serve->last_ms >= 0 && strncmp(serve->what, what, sizeof serve->what - 1) == 0;
    if (serve->answered || (same && now - serve->last_ms < 50))
        return;
    snprintf(serve->what, sizeof serve->what, "%s", what);
    serve->last_ms = now;
    if (!(fraction >= 0 && fraction <= 1))
        fraction = fraction > 1 ? 1 : -1;
    send_small(json_pack("{s:s,s:o,s:f}", "reply", "progress", "what", tc_wire_string(what), "fraction", fraction));
}

void tc_serve_say(tc_serve *serve, tc_level level, const char *text)
{
    if (!serve->answered)
        send_small(json_pack("{s:s,s:i,s:o}", "reply", "say", "level", (int)level, "text", tc_wire_string(text)));
}

void tc_serve_error(tc_serve *serve, const char *text)
{
    if (serve->answered)
        return;
    serve->answered = true;
    send_small(json_pack("{s:s,s:o}", "reply", "error", "text", tc_wire_string(text)));
}

void tc_serve_result(tc_serve *serve, json_t *result, const tc_array *array, size_t n_array)
{
    tc_error err = {0};
    if (serve->answered)
        return;
    if (!result || json_object_set_new(result, "reply", json_string("result")) != 0) {
        tc_serve_error(serve, "out of memory for the result");
    } else if (!send_message(result, array, n_array, &err)) {
        tc_serve_error(serve, err.text);
    } else {
        serve->answered = true;
    }
}

/* One request, from the complete frame. False: it was not one, the stream cannot be trusted any more. */
static bool answer(tc_serve *serve, tc_wire_in *in, tc_serve_function *handle, void *context)
{
    tc_reply request;
    tc_error err = {0};
    tc_status status = tc_wire_open(&request, in, &err);
    serve->answered = false;
    serve->last_ms = -1;
    if (status == TC_E_MEMORY) {
        tc_serve_error(serve, err.text);
        return true;
    }
    if (status != TC_OK) {
        fprintf(stderr, "%s: %s\n", serve->name, err.text);
        return false;
    }
    handle(context, serve, request.json, request.array, request.n_array);
    if (!serve->answered)
        tc_serve_error(serve, "the helper gave no answer to this request");
    tc_reply_finish(&request);
    return true;
}

int tc_serve_main(int argc, char **argv, const char *name, tc_serve_function *handle, void *context)
{
    (void)argc, (void)argv;
    struct stat info;
    if (fstat(TC_WIRE_SOCKET, &info) != 0 || !S_ISSOCK(info.st_mode)) {
        fprintf(stderr, "%s %s: a helper program that tetcast runs; it does nothing by hand\n", name,
                TC_VERSION_STRING);
        return 2;
    }
    fcntl(TC_WIRE_SOCKET, F_SETFD, FD_CLOEXEC);
    signal(SIGPIPE, SIG_IGN);
    set_limits();

    static tc_serve serve; /* not on the stack: the watching thread may look at it while the program ends */
    serve = (tc_serve){.name = name, .answered = true, .last_ms = -1};
    tc_wire_in in;
    tc_error err = {0};
    tc_wire_state state;
    start_watch(&serve);
    tc_wire_in_init(&in);
    while ((state = tc_wire_receive(&in, TC_WIRE_SOCKET, 0, &err)) == TC_WIRE_DONE) {
        atomic_store(&serve.busy, true);
        bool good = answer(&serve, &in, handle, context);
        atomic_store(&serve.busy, false);
        if (!good)
            return 1;
    }
    tc_wire_in_finish(&in);
    if (state == TC_WIRE_BROKEN)
        fprintf(stderr, "%s: %s\n", name, err.text);
    fflush(NULL);
    if (!SANITIZED) /* which look for leaks at the end; destructors of hundreds of libraries only take time */
        _exit(state == TC_WIRE_BROKEN);
    return state == TC_WIRE_BROKEN;
}
