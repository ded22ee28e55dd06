/* fuzz_wire.c: the messages between the library and its helper programs, from any bytes, on either side.
 * Input: flags; the size and the bytes of the shared memory that goes with the first message; then what comes over the
 * socket: as it is, or as the texts of messages (they end with a line feed) with a proper header before each.
 * worker.c and serve.c are compiled in: the library's side gets a helper without a process, the helper's side a socket
 * of ours. Promises: every array lies within its memory; the call ends with a result or a sentence. */
#define _GNU_SOURCE
#include "fuzz.h"

#include "core/wire.h"

static int fuzz_socket = -1;
#undef TC_WIRE_SOCKET
#define TC_WIRE_SOCKET fuzz_socket
#include "core/serve.c"
#include "core/worker.c"

enum { HELPER = 1, FRAMED = 2, MEMORY = 4, TWICE = 8, ANSWER_ARRAYS = 16, MAGIC_NUMBER = 0x31436374 };

static size_t sum_of_all; /* so that reading the arrays is not left out */

static void read_arrays(const tc_array *array, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const unsigned char *p = array[i].data;
        size_t bytes = array[i].count * tc_wire_type_size(array[i].type);
        TC_FUZZ_CHECK(p && array[i].name && tc_wire_type_size(array[i].type) > 0);
        TC_FUZZ_CHECK(bytes == 0 || (uintptr_t)p % tc_wire_type_size(array[i].type) == 0);
        for (size_t b = 0; b < bytes; b += 509)
            sum_of_all += p[b];
        if (bytes > 0)
            sum_of_all += p[bytes - 1];
    }
}

static void on_message(void *user, tc_level level, const char *text)
{
    (void)user;
    TC_FUZZ_CHECK(level >= TC_WARNING && level <= TC_DEBUG && strlen(text) < 1024 && !strchr(text, '\n'));
}

static void on_progress(void *user, const char *what, double fraction)
{
    (void)user;
    sum_of_all += strlen(what) + (fraction > 0);
}

static void send_bytes(int socket, const void *data, size_t n, int fd)
{
    struct iovec part = {.iov_base = (void *)data, .iov_len = n};
    struct msghdr header = {.msg_iov = &part, .msg_iovlen = 1};
    union {
        struct cmsghdr align;
        char bytes[CMSG_SPACE(sizeof(int))];
    } control = {.bytes = {0}};
    if (fd >= 0) {
        header.msg_control = control.bytes;
        header.msg_controllen = sizeof control.bytes;
        struct cmsghdr *c = CMSG_FIRSTHDR(&header);
        c->cmsg_level = SOL_SOCKET;
        c->cmsg_type = SCM_RIGHTS;
        c->cmsg_len = CMSG_LEN(sizeof(int));
        memcpy(CMSG_DATA(c), &fd, sizeof fd);
    }
    if (n > 0 && sendmsg(socket, &header, MSG_DONTWAIT | MSG_NOSIGNAL) < 0)
        return; /* more than the socket holds: the rest never comes */
}

static void send_input(int socket, tc_fuzz_input *in, int flags)
{
    int fd = -1;
    if (flags & MEMORY) {
        uint8_t some[64];
        size_t bytes = tc_fuzz_u16(in);
        tc_fuzz_take(some, in, sizeof some);
        fd = tc_wire_file();
        if (fd < 0 || ftruncate(fd, (off_t)bytes) != 0 || pwrite(fd, some, bytes < 64 ? bytes : 64, 0) < 0)
            abort();
    }
    if (!(flags & FRAMED)) {
        send_bytes(socket, in->data, in->n, fd);
        if (flags & TWICE)
            send_bytes(socket, in->data, in->n, fd);
    }
    for (int first = fd; flags & FRAMED && in->n > 0; first = -1) {
        char *text = tc_fuzz_text(in, '\n');
        uint32_t header[3] = {MAGIC_NUMBER, (uint32_t)strlen(text), first >= 0};
        send_bytes(socket, header, sizeof header, first);
        send_bytes(socket, text, strlen(text), -1);
        free(text);
    }
    if (fd >= 0)
        close(fd);
}

/* The library's side: what comes answers a request. */
static void be_library(int socket, int flags)
{
    tc_error err = {0};
    tc_log log = {on_message, on_progress, NULL};
    tc_worker *w = calloc(1, sizeof *w);
    const double number[3] = {1, 2, 3};
    const tc_array array = {"number", TC_F64, 3, number};
    json_t *request = json_pack("{s:s}", "do", "read");
    if (!w || !request)
        abort();
    *w = (tc_worker){.name = strdup("tetcast-read"), .pid = getpid(), .pidfd = -1, .socket = socket, .talk = -1};
    tc_wire_in_init(&w->in);
    w->limits = (tc_worker_limits){.idle_s = 2, .total_s = 4};
    for (int call = 0; call < (flags & TWICE ? 3 : 1); call++) {
        tc_reply reply;
        tc_status status = tc_worker_call(&reply, w, request, &array, call == 1, &log, &err);
        TC_FUZZ_CHECK(status == TC_OK || (err.code == status && err.text[0] && !strchr(err.text, '\n')));
        TC_FUZZ_CHECK(status == TC_OK || !reply.json);
        if (status == TC_OK) {
            read_arrays(reply.array, reply.n_array);
            (void)tc_reply_array(&reply, "vertex", TC_F64);
        }
        tc_reply_finish(&reply);
    }
    tc_worker_stop(&w);
    json_decref(request);
}

static void handle(void *context, tc_serve *serve, json_t *request, const tc_array *array, size_t n_array)
{
    const char *what = json_string_value(json_object_get(request, "do"));
    int flags = *(int *)context;
    read_arrays(array, n_array);
    if (what && strcmp(what, "progress") == 0)
        tc_serve_progress(serve, json_string_value(json_object_get(request, "text")) ? "what" : "", 0.5);
    else if (what && strcmp(what, "say") == 0)
        tc_serve_say(serve, TC_INFO, json_string_value(json_object_get(request, "text")) ? "said" : "\xff\n");
    else if (what && strcmp(what, "error") == 0)
        tc_serve_error(serve, "no");
    else if (what && flags & ANSWER_ARRAYS)
        tc_serve_result(serve, request, array, n_array < 4 ? n_array : 4);
}

/* The helper's side: what comes are requests. */
static void be_helper(int socket, int flags)
{
    tc_serve serve = {.name = "tetcast-read", .answered = true, .last_ms = -1};
    tc_wire_in in;
    tc_error err = {0};
    fuzz_socket = socket;
    tc_wire_in_init(&in);
    for (int i = 0; i < 16 && tc_wire_receive(&in, socket, 0, &err) == TC_WIRE_DONE; i++)
        if (!answer(&serve, &in, handle, &flags))
            break;
    tc_wire_in_finish(&in);
    fuzz_socket = -1;
    close(socket);
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc, (void)argv;
    FILE *nowhere = fopen("/dev/null", "w");
    if (nowhere)
        stdout = stderr = nowhere;
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    tc_fuzz_input in = {data, size};
    int flags = tc_fuzz_u8(&in), pair[2];
    char drain[4096];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, pair) != 0)
        abort();
    send_input(pair[0], &in, flags);
    shutdown(pair[0], SHUT_WR);
    if (flags & HELPER)
        be_helper(pair[1], flags);
    else
        be_library(pair[1], flags);
    while (recv(pair[0], drain, sizeof drain, MSG_DONTWAIT) > 0)
        ;
    close(pair[0]);
    return 0;
}
