/* wire.c: the frames between the library and its helper programs: JSON text, and arrays in shared memory. */
#define _GNU_SOURCE
#include "core/wire.h"
#include "core/memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ALIGN = 64, MAX_FD = 4, HEADER = 3 * sizeof(uint32_t), MAX_ARRAYS = 65536 };
static const uint32_t MAGIC = 0x31436374u; /* "tcC1" */
static const uint32_t MAX_TEXT = 64u << 20;

static const char *const type_name[] = {"f64", "f32", "i32", "i64", "u8"};
static const size_t type_size[] = {8, 4, 4, 8, 1};
enum { N_TYPE = sizeof type_size / sizeof *type_size };

size_t tc_wire_type_size(tc_array_type type)
{
    return (unsigned)type < N_TYPE ? type_size[type] : 0;
}

int tc_wire_file(void)
{
    int fd = memfd_create("tetcast", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (fd >= 0)
        return fd;
    const char *folder = secure_getenv("TMPDIR");
    char path[4096];
    int n = snprintf(path, sizeof path, "%s/tetcast-XXXXXX", folder && *folder ? folder : "/tmp");
    if (n < 0 || (size_t)n >= sizeof path) {
        errno = ENAMETOOLONG;
        return -1;
    }
    fd = mkostemp(path, O_CLOEXEC);
    if (fd >= 0)
        unlink(path);
    return fd;
}

/* Length of the UTF-8 sequence at s, 0 when it is none (overlong, surrogate, beyond U+10FFFF, cut off). */
static size_t utf8_length(const unsigned char *s)
{
    if (s[0] < 0x80)
        return 1;
    size_t n = s[0] >= 0xf0 ? 4 : s[0] >= 0xe0 ? 3 : 2;
    if (s[0] < 0xc2 || s[0] > 0xf4)
        return 0;
    for (size_t i = 1; i < n; i++)
        if ((s[i] & 0xc0) != 0x80)
            return 0;
    if ((s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xed && s[1] > 0x9f) || (s[0] == 0xf0 && s[1] < 0x90) ||
        (s[0] == 0xf4 && s[1] > 0x8f))
        return 0;
    return n;
}

json_t *tc_wire_string(const char *text)
{
    json_t *json = json_string(text);
    char *copy = json ? NULL : tc_strdup(text);
    if (!copy)
        return json;
    for (char *s = copy; *s;) {
        size_t n = utf8_length((const unsigned char *)s);
        if (n == 0)
            *s = '?';
        s += n ? n : 1;
    }
    json = json_string(copy);
    free(copy);
    return json;
}

size_t tc_wire_peak_bytes(void)
{
    size_t kib = 0;
    FILE *file = fopen("/proc/self/status", "re");
    if (file) {
        char line[256];
        while (fgets(line, sizeof line, file))
            if (sscanf(line, "VmHWM: %zu", &kib) == 1)
                break;
        fclose(file);
    }
    if (kib == 0) {
        struct rusage usage;
        if (getrusage(RUSAGE_SELF, &usage) == 0 && usage.ru_maxrss > 0)
            kib = (size_t)usage.ru_maxrss;
    }
    return kib * 1024;
}

/* Writes all bytes at offset; pwrite, since a full shared memory gives an error here and SIGBUS through a mapping. */
static bool write_at(int fd, const void *data, size_t bytes, size_t offset)
{
    const char *p = data;
    while (bytes > 0) {
        ssize_t n = pwrite(fd, p, bytes < (1u << 30) ? bytes : (1u << 30), (off_t)offset);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        p += n, offset += (size_t)n, bytes -= (size_t)n;
    }
    return true;
}

/* Copies the arrays into a new file and lists them in *list. */
static tc_status pack_arrays(int *fd, json_t **list, const tc_array *array, size_t n_array, tc_error *err)
{
    size_t end = 0;
    *list = json_array();
    for (size_t i = 0; i < n_array; i++) {
        size_t size = tc_wire_type_size(array[i].type), bytes, offset;
        if (size == 0 || (array[i].count > 0 && !array[i].data))
            return tc_fail(err, TC_E_ARG, "array \"%s\" has no data or an unknown type", array[i].name);
        if (__builtin_mul_overflow(array[i].count, size, &bytes) ||
            __builtin_add_overflow(end, (size_t)(ALIGN - 1), &offset) ||
            __builtin_add_overflow(offset & ~(size_t)(ALIGN - 1), bytes, &end) || end > (size_t)INT64_MAX)
            return tc_fail_memory(err, array[i].name, array[i].count, size);
        offset &= ~(size_t)(ALIGN - 1);
        json_t *name = tc_wire_string(array[i].name ? array[i].name : "");
        json_t *entry = json_pack("{s:o,s:s,s:I,s:I}", "name", name, "type", type_name[array[i].type], "count",
                                  (json_int_t)array[i].count, "offset", (json_int_t)offset);
        if (!*list || !entry || json_array_append_new(*list, entry) != 0)
            return tc_fail_memory(err, "a message", 1, 4096);
        if (bytes == 0)
            continue;
        if (*fd < 0 && (*fd = tc_wire_file()) < 0)
            return tc_fail(err, TC_E_MEMORY, "no shared memory: %s; set TMPDIR to a folder with free space",
                           strerror(errno));
        if (!write_at(*fd, array[i].data, bytes, offset))
            return tc_fail(err, TC_E_MEMORY, "shared memory for \"%s\" (%.1f MiB) ran out: %s", array[i].name,
                           (double)bytes / 1048576.0, strerror(errno));
    }
    if (*fd >= 0) /* the receiver may trust its size; fails harmlessly on a temporary file */
        (void)fcntl(*fd, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL);
    return TC_OK;
}

tc_status tc_wire_pack(tc_wire_out *out, json_t *message, const tc_array *array, size_t n_array, tc_error *err)
{
    *out = (tc_wire_out){.fd = -1};
    tc_status status = TC_OK;
    json_t *list = NULL, *copy = json_copy(message);
    if (!copy) {
        status = tc_fail_memory(err, "a message", 1, 4096);
        goto done;
    }
    if (n_array > 0) {
        status = pack_arrays(&out->fd, &list, array, n_array, err);
        if (status != TC_OK)
            goto done;
        if (json_object_set(copy, "arrays", list) != 0) {
            status = tc_fail_memory(err, "a message", 1, 4096);
            goto done;
        }
    } else {
        json_object_del(copy, "arrays");
    }
    size_t length = json_dumpb(copy, NULL, 0, JSON_COMPACT);
    if (length == 0 || length > MAX_TEXT) {
        status = tc_fail(err, TC_E_ARG, "a message to a helper program has %zu bytes of text, of at most %u", length,
                         MAX_TEXT);
        goto done;
    }
    out->size = HEADER + length;
    out->frame = tc_alloc(out->size, 1);
    if (!out->frame) {
        status = tc_fail_memory(err, "a message", out->size, 1);
        goto done;
    }
    uint32_t header[3] = {MAGIC, (uint32_t)length, out->fd >= 0};
    memcpy(out->frame, header, HEADER);
    json_dumpb(copy, (char *)out->frame + HEADER, length, JSON_COMPACT);
done:
    json_decref(list);
    json_decref(copy);
    if (status != TC_OK)
        tc_wire_out_finish(out);
    return status;
}

tc_wire_state tc_wire_send(tc_wire_out *out, int socket, int flags, tc_error *err)
{
    while (out->sent < out->size) {
        struct iovec part = {.iov_base = out->frame + out->sent, .iov_len = out->size - out->sent};
        struct msghdr header = {.msg_iov = &part, .msg_iovlen = 1};
        union {
            struct cmsghdr align;
            char bytes[CMSG_SPACE(sizeof(int))];
        } control;
        if (out->fd >= 0 && out->sent == 0) {
            memset(&control, 0, sizeof control);
            header.msg_control = control.bytes;
            header.msg_controllen = sizeof control.bytes;
            struct cmsghdr *c = CMSG_FIRSTHDR(&header);
            c->cmsg_level = SOL_SOCKET;
            c->cmsg_type = SCM_RIGHTS;
            c->cmsg_len = CMSG_LEN(sizeof(int));
            memcpy(CMSG_DATA(c), &out->fd, sizeof(int));
        }
        ssize_t n = sendmsg(socket, &header, flags | MSG_NOSIGNAL);
        if (n >= 0) {
            out->sent += (size_t)n;
            continue;
        }
        if (errno == EINTR)
            continue;
        if (errno == EAGAIN || errno == EWOULDBLOCK)
            return TC_WIRE_AGAIN;
        if (errno == EPIPE || errno == ECONNRESET)
            return TC_WIRE_CLOSED;
        tc_fail(err, TC_E_WORKER, "sending failed: %s", strerror(errno));
        return TC_WIRE_BROKEN;
    }
    return TC_WIRE_DONE;
}

void tc_wire_out_finish(tc_wire_out *out)
{
    free(out->frame);
    if (out->fd >= 0)
        close(out->fd);
    *out = (tc_wire_out){.fd = -1};
}

void tc_wire_in_init(tc_wire_in *in)
{
    *in = (tc_wire_in){.fd = -1};
}

void tc_wire_in_finish(tc_wire_in *in)
{
    free(in->text);
    if (in->fd >= 0)
        close(in->fd);
    tc_wire_in_init(in);
}

/* Takes over the descriptors that came with some bytes; false when there were more than a frame may have. */
static bool take_descriptors(tc_wire_in *in, struct msghdr *header)
{
    bool good = !(header->msg_flags & MSG_CTRUNC);
    for (struct cmsghdr *c = CMSG_FIRSTHDR(header); c; c = CMSG_NXTHDR(header, c)) {
        if (c->cmsg_level != SOL_SOCKET || c->cmsg_type != SCM_RIGHTS)
            continue;
        size_t n = (c->cmsg_len - CMSG_LEN(0)) / sizeof(int);
        for (size_t i = 0; i < n; i++) {
            int fd;
            memcpy(&fd, CMSG_DATA(c) + i * sizeof fd, sizeof fd);
            if (in->fd < 0) {
                in->fd = fd;
            } else {
                close(fd);
                good = false;
            }
        }
    }
    return good;
}

/* Looks at a complete header and makes room for the text. */
static bool check_header(tc_wire_in *in, tc_error *err)
{
    if (in->header[0] != MAGIC || in->header[1] == 0 || in->header[1] > MAX_TEXT || in->header[2] > 1) {
        tc_fail(err, TC_E_WORKER, "what came is not a message (%08x %08x %08x)", in->header[0], in->header[1],
                in->header[2]);
        return false;
    }
    if ((in->header[2] == 1) != (in->fd >= 0)) {
        tc_fail(err, TC_E_WORKER, "a message came with %d descriptors instead of %u", in->fd >= 0, in->header[2]);
        return false;
    }
    in->text = tc_alloc(in->header[1], 1);
    if (!in->text)
        tc_fail_memory(err, "a message", in->header[1], 1);
    return in->text != NULL;
}

tc_wire_state tc_wire_receive(tc_wire_in *in, int socket, int flags, tc_error *err)
{
    for (;;) {
        size_t want = in->have < HEADER ? HEADER : HEADER + (size_t)in->header[1];
        char *to = in->have < HEADER ? (char *)in->header + in->have : in->text + (in->have - HEADER);
        struct iovec part = {.iov_base = to, .iov_len = want - in->have};
        union {
            struct cmsghdr align;
            char bytes[CMSG_SPACE(MAX_FD * sizeof(int))];
        } control;
        struct msghdr header = {
            .msg_iov = &part, .msg_iovlen = 1, .msg_control = control.bytes, .msg_controllen = sizeof control.bytes};
        ssize_t n = recvmsg(socket, &header, flags | MSG_CMSG_CLOEXEC);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK))
            return TC_WIRE_AGAIN;
        if (n == 0 || (n < 0 && errno == ECONNRESET)) {
            if (in->have > 0)
                tc_fail(err, TC_E_WORKER, "it ended in the midst of a message");
            return TC_WIRE_CLOSED;
        }
        if (n < 0) {
            tc_fail(err, TC_E_WORKER, "receiving failed: %s", strerror(errno));
            return TC_WIRE_BROKEN;
        }
        if (!take_descriptors(in, &header)) {
            tc_fail(err, TC_E_WORKER, "a message came with too many descriptors");
            return TC_WIRE_BROKEN;
        }
        in->have += (size_t)n;
        if (in->have == HEADER && !in->text && !check_header(in, err))
            return TC_WIRE_BROKEN;
        if (in->have > HEADER && in->have == HEADER + (size_t)in->header[1])
            return TC_WIRE_DONE;
    }
}

/* Maps the descriptor of a frame, if it has one. */
static tc_status map_file(tc_reply *out, int fd, tc_error *err)
{
    struct stat info;
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode) || info.st_size <= 0)
        return tc_fail(err, TC_E_WORKER, "a message came with something that is no memory");
    if ((uintmax_t)info.st_size > SIZE_MAX)
        return tc_fail(err, TC_E_MEMORY, "arrays of %jd bytes do not fit into memory", (intmax_t)info.st_size);
    void *map = mmap(NULL, (size_t)info.st_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_NORESERVE, fd, 0);
    if (map == MAP_FAILED)
        return tc_fail_memory(err, "the arrays of a message", (size_t)info.st_size, 1);
    out->map = map;
    out->map_bytes = (size_t)info.st_size;
    return TC_OK;
}

/* One entry of "arrays"; false when anything about it does not fit the mapping. */
static bool read_entry(tc_array *out, json_t *entry, const tc_reply *message)
{
    static const double nothing[1];
    const char *name, *type;
    json_int_t count, offset;
    if (json_unpack(entry, "{s:s,s:s,s:I,s:I}", "name", &name, "type", &type, "count", &count, "offset", &offset) != 0)
        return false;
    size_t kind = 0, bytes, end;
    while (kind < N_TYPE && strcmp(type, type_name[kind]) != 0)
        kind++;
    if (kind == N_TYPE || count < 0 || offset < 0 || (uintmax_t)count > SIZE_MAX || (uintmax_t)offset > SIZE_MAX)
        return false;
    if (__builtin_mul_overflow((size_t)count, type_size[kind], &bytes) ||
        __builtin_add_overflow((size_t)offset, bytes, &end))
        return false;
    if (bytes > 0 && (end > message->map_bytes || (size_t)offset % type_size[kind] != 0))
        return false;
    *out = (tc_array){.name = name, .type = (tc_array_type)kind, .count = (size_t)count};
    out->data = bytes > 0 ? (const void *)((const char *)message->map + offset) : (const void *)nothing;
    return true;
}

static tc_status read_entries(tc_reply *out, tc_error *err)
{
    json_t *list = json_object_get(out->json, "arrays");
    if (!list)
        return TC_OK;
    size_t n = json_array_size(list);
    if (!json_is_array(list) || n > MAX_ARRAYS)
        return tc_fail(err, TC_E_WORKER, "a message has a broken list of arrays");
    out->array = tc_calloc(n, sizeof *out->array);
    if (!out->array)
        return tc_fail_memory(err, "a list of arrays", n, sizeof *out->array);
    for (size_t i = 0; i < n; i++)
        if (!read_entry(&out->array[i], json_array_get(list, i), out))
            return tc_fail(err, TC_E_WORKER, "array %zu of a message lies outside its memory or is of unknown type", i);
    out->n_array = n;
    return TC_OK;
}

tc_status tc_wire_open(tc_reply *out, tc_wire_in *in, tc_error *err)
{
    *out = (tc_reply){0};
    json_error_t where;
    tc_status status = TC_OK;
    out->json = json_loadb(in->text, in->header[1], JSON_REJECT_DUPLICATES, &where);
    if (!out->json || !json_is_object(out->json))
        status =
            tc_fail(err, TC_E_WORKER, "a message is no JSON object (%s)", out->json ? "another value" : where.text);
    if (status == TC_OK && in->fd >= 0)
        status = map_file(out, in->fd, err);
    if (status == TC_OK)
        status = read_entries(out, err);
    if (status == TC_OK) {
        json_int_t peak = json_integer_value(json_object_get(out->json, "peak_bytes"));
        out->peak_bytes = peak > 0 ? (size_t)peak : 0;
    } else {
        tc_reply_finish(out);
    }
    tc_wire_in_finish(in);
    return status;
}

const tc_array *tc_reply_array(const tc_reply *reply, const char *name, tc_array_type type)
{
    for (size_t i = 0; i < reply->n_array; i++)
        if (reply->array[i].type == type && strcmp(reply->array[i].name, name) == 0)
            return &reply->array[i];
    return NULL;
}

void tc_reply_finish(tc_reply *reply)
{
    if (!reply)
        return;
    if (reply->map)
        munmap(reply->map, reply->map_bytes);
    free(reply->array);
    json_decref(reply->json);
    *reply = (tc_reply){0};
}
