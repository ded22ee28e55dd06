/* fake.c: a helper program that behaves in every way a helper may go wrong; for test_core_worker.c. */
#define _GNU_SOURCE
#include "core/memory.h"
#include "core/serve.h"
#include "core/wire.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

static const uint32_t magic = 0x31436374u;

/* Sends raw bytes as the answer. */
static void send_raw(const void *bytes, size_t n)
{
    if (send(TC_WIRE_SOCKET, bytes, n, MSG_NOSIGNAL) < 0)
        _exit(0);
}

/* Sends a well-formed frame around any text, with `fd` when it is not negative. */
static void send_text(const char *text, int fd)
{
    uint32_t n = (uint32_t)strlen(text), header[3] = {magic, n, fd >= 0};
    tc_wire_out out = {.frame = malloc(sizeof header + n), .size = sizeof header + n, .fd = fd};
    tc_error err;
    memcpy(out.frame, header, sizeof header);
    memcpy(out.frame + sizeof header, text, n);
    tc_wire_send(&out, TC_WIRE_SOCKET, 0, &err);
    tc_wire_out_finish(&out);
}

/* A frame whose list of arrays is `arrays`, with a memory of 64 bytes. */
static void send_arrays(const char *arrays)
{
    char text[512];
    int fd = tc_wire_file();
    if (fd < 0 || ftruncate(fd, 64) != 0)
        _exit(9);
    snprintf(text, sizeof text, "{\"reply\":\"result\",\"arrays\":%s}", arrays);
    send_text(text, fd);
}

static void hang(void)
{
    for (;;)
        pause();
}

static void misbehave(tc_serve *serve, const char *what)
{
    if (strcmp(what, "crash") == 0) {
        fprintf(stderr, "first line\nthe last words\n\n");
        signal(SIGSEGV, SIG_DFL); /* sanitizers catch it otherwise */
        raise(SIGSEGV);
    } else if (strcmp(what, "exit") == 0) {
        printf("said on standard output\n");
        exit(3);
    } else if (strcmp(what, "hang") == 0) {
        hang();
    } else if (strcmp(what, "flood") == 0) {
        for (;;)
            send_text("{\"reply\":\"progress\",\"what\":\"flooding\",\"fraction\":0.5}", -1);
    } else if (strcmp(what, "babble") == 0) {
        for (;;)
            fprintf(stderr, "babbling without end\n");
    } else if (strcmp(what, "garbage") == 0) {
        send_raw("this is not a frame at all", 26);
        hang();
    } else if (strcmp(what, "huge") == 0) {
        uint32_t header[3] = {magic, 0xffffffffu, 0};
        send_raw(header, sizeof header);
        hang();
    } else if (strcmp(what, "half") == 0) {
        uint32_t header[3] = {magic, 1000, 0};
        send_raw(header, sizeof header);
        send_raw("{\"reply\":", 9);
        _exit(0);
    } else if (strcmp(what, "missing") == 0) {
        uint32_t header[3] = {magic, 2, 1}; /* announces a descriptor that does not come */
        send_raw(header, sizeof header);
        send_raw("{}", 2);
        hang();
    } else if (strcmp(what, "array") == 0) {
        send_text("[1, 2, 3]", -1);
    } else if (strcmp(what, "unknown") == 0) {
        send_text("{\"reply\":\"dance\"}", -1);
    } else if (strcmp(what, "beyond") == 0) {
        send_arrays("[{\"name\":\"a\",\"type\":\"f64\",\"count\":9,\"offset\":0}]");
    } else if (strcmp(what, "overflow") == 0) {
        send_arrays("[{\"name\":\"a\",\"type\":\"f64\",\"count\":2305843009213693953,\"offset\":0}]");
    } else if (strcmp(what, "negative") == 0) {
        send_arrays("[{\"name\":\"a\",\"type\":\"f64\",\"count\":1,\"offset\":-8}]");
    } else if (strcmp(what, "crooked") == 0) {
        send_arrays("[{\"name\":\"a\",\"type\":\"f64\",\"count\":1,\"offset\":3}]");
    } else if (strcmp(what, "nothing") == 0) {
        send_text("{\"reply\":\"result\",\"arrays\":[{\"name\":\"a\",\"type\":\"u8\",\"count\":1,\"offset\":0}]}", -1);
    } else if (strcmp(what, "silent") == 0) {
        return;
    } else if (strcmp(what, "complain") == 0) {
        tc_serve_error(serve, "no such \xff file");
    }
}

static void handle(void *context, tc_serve *serve, json_t *request, const tc_array *array, size_t n_array)
{
    (void)context;
    const char *what = json_string_value(json_object_get(request, "do"));
    json_t *result = json_object();
    if (what && strcmp(what, "echo") == 0) {
        tc_serve_progress(serve, "echoing", 0.5);
        tc_serve_say(serve, TC_INFO, "here is 100% of it");
        json_object_set(result, "echo", json_object_get(request, "echo"));
        tc_serve_result(serve, result, array, n_array);
    } else if (what && strcmp(what, "about") == 0) {
        struct rlimit limit;
        getrlimit(RLIMIT_AS, &limit);
        json_object_set_new(result, "pid", json_integer(getpid()));
        json_object_set_new(result, "limit",
                            json_integer(limit.rlim_cur == RLIM_INFINITY ? -1 : (json_int_t)limit.rlim_cur));
        int open = 0; /* descriptors beyond our own */
        for (int fd = 4; fd < 1024; fd++)
            open += lseek(fd, 0, SEEK_CUR) >= 0;
        json_object_set_new(result, "open", json_integer(open));
        tc_serve_result(serve, result, NULL, 0);
    } else if (what && strcmp(what, "touch") == 0) {
        size_t n = 64u << 20;
        volatile char *p = tc_alloc(n, 1);
        for (size_t i = 0; p && i < n; i += 1024)
            p[i] = (char)i;
        free((void *)p);
        tc_serve_result(serve, result, NULL, 0);
    } else if (what) {
        misbehave(serve, what);
    }
    json_decref(result);
}

int main(int argc, char **argv)
{
    return tc_serve_main(argc, argv, "tetcast-fake", handle, NULL);
}
