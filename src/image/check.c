/* check.c: are image files whole and undamaged? PNG is checked here by its checksums; the helper program tetcast-image
 * decodes all else.
 * PNG specification, second edition (W3C 2003): 5.3 chunk layout, 5.6 chunk ordering, 11.2 critical chunks. */
#define _GNU_SOURCE
#include "core/memory.h"
#include "image/call.h"
#include "image/encoding.h"
#include "image/text_chunk.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

enum { HELD = 1 << 18 };

/* A file that is read once, from its start. */
typedef struct source {
    const char *path;
    int fd;
    uint64_t at, size; /* of the file */
    uint8_t *held;     /* [HELD]; used: [from, to) */
    size_t from, to;
    tc_error *err;
} source;

static tc_status fail_short(const source *s)
{
    return tc_fail(s->err, TC_E_FILE, "%s is cut short: it ends after %llu bytes; write it anew", s->path,
                   (unsigned long long)s->size);
}

/* The next n bytes to `to`; NULL: their checksum alone. *crc goes on with them. */
static tc_status take(source *s, uint8_t *to, size_t n, uLong *crc)
{
    while (n > 0) {
        if (s->from == s->to) {
            ssize_t got = read(s->fd, s->held, HELD);
            if (got < 0 && errno == EINTR)
                continue;
            if (got < 0)
                return tc_fail(s->err, TC_E_FILE, "%s cannot be read: %s", s->path, strerror(errno));
            if (got == 0)
                return fail_short(s);
            s->from = 0, s->to = (size_t)got;
        }
        const size_t now = n < s->to - s->from ? n : s->to - s->from;
        if (to)
            memcpy(to, s->held + s->from, now);
        *crc = crc32(*crc, s->held + s->from, (uInt)now);
        to = to ? to + now : NULL;
        s->from += now, s->at += now, n -= now;
    }
    return TC_OK;
}

static uint32_t big_endian(const uint8_t *p)
{
    return (uint32_t)p[0] << 24 | (uint32_t)p[1] << 16 | (uint32_t)p[2] << 8 | p[3];
}

static tc_status fail_damaged(const source *s, uint64_t at, const char *what)
{
    return tc_fail(s->err, TC_E_FILE, "%s is damaged: %s at byte %llu; write it anew", s->path, what,
                   (unsigned long long)at);
}

/* One chunk; its text goes to *text if it is the one that is looked for and the first. type [4]. */
static tc_status check_chunk(source *s, uint8_t *type, uint32_t *length, char **text, const char *key)
{
    uint8_t head[8], sum[4], *body = NULL;
    const uint64_t at = s->at;
    uLong crc = 0, ignored = 0;
    tc_status status = take(s, head, 4, &ignored);
    if (status == TC_OK)
        status = take(s, head + 4, 4, &crc);
    if (status != TC_OK)
        return status;
    *length = big_endian(head);
    memcpy(type, head + 4, 4);
    for (int i = 0; i < 4; i++)
        if (!((type[i] >= 'A' && type[i] <= 'Z') || (type[i] >= 'a' && type[i] <= 'z')))
            return fail_damaged(s, at, "no chunk begins");
    if (*length > 0x7fffffffu)
        return fail_damaged(s, at, "a chunk of impossible length begins");
    if ((uint64_t)*length + 4 > s->size - s->at)
        return fail_short(s);
    const bool look = key && !*text && tc_png_is_text(type);
    if (look && !(body = tc_alloc(*length, 1)))
        return tc_fail_memory(s->err, s->path, *length, 1);
    status = take(s, body, *length, &crc);
    if (status == TC_OK)
        status = take(s, sum, 4, &ignored);
    if (status == TC_OK && big_endian(sum) != (uint32_t)crc)
        status = fail_damaged(s, at, "the checksum is wrong of the chunk that begins");
    if (status == TC_OK && look)
        status = tc_png_text(text, type, body, *length, key, s->path, s->err);
    free(body);
    return status;
}

static tc_status check_png(char **text, source *s, const char *key)
{
    uint8_t type[4] = {0}, signature[8];
    uint32_t length;
    uLong crc = 0;
    bool pixels = false;
    tc_status status = take(s, signature, 8, &crc);
    for (int n = 0; status == TC_OK; n++) {
        const uint64_t at = s->at;
        status = check_chunk(s, type, &length, text, key);
        if (status != TC_OK)
            break;
        const bool header = memcmp(type, "IHDR", 4) == 0;
        if (header != (n == 0) || (header && length != 13))
            return fail_damaged(s, at, n == 0 ? "there is no header" : "there is a second header");
        pixels = pixels || memcmp(type, "IDAT", 4) == 0;
        if (memcmp(type, "IEND", 4) != 0)
            continue;
        if (!pixels)
            return fail_damaged(s, at, "it ends without pixels");
        return s->at == s->size ? TC_OK : fail_damaged(s, s->at, "there is more behind the end");
    }
    return status;
}

/* The helper decodes the file of descriptor fd, and gives its texts. */
static tc_status check_other(char **text, const source *s, const char *key, tc_image_writer *writer)
{
    char file[64];
    tc_reply reply = {0};
    tc_image_helper_path(file, s->fd);
    json_t *request = json_pack("{s:s,s:s}", "do", "check", "file", file);
    if (!request)
        return tc_fail_memory(s->err, "a message", 1, 256);
    tc_status status = tc_image_helper_call(&reply, writer, request, NULL, 0, NULL, s->err);
    json_decref(request);
    if (status != TC_OK)
        tc_fail_prefix(s->err, status, "%s %s: ", s->path,
                       status == TC_E_FILE ? "is damaged or cut short" : "cannot be checked");
    const json_t *list = json_object_get(reply.json, "meta");
    for (size_t i = 0; status == TC_OK && key && !*text && i < json_array_size(list); i++) {
        const json_t *pair = json_array_get(list, i);
        const char *name = json_string_value(json_array_get(pair, 0)),
                   *value = json_string_value(json_array_get(pair, 1));
        if (name && value && strcmp(tc_image_plain_key(name), tc_image_plain_key(key)) == 0 &&
            !(*text = tc_strdup(value)))
            status = tc_fail_memory(s->err, s->path, strlen(value), 1);
    }
    tc_reply_finish(&reply);
    return status;
}

/* By what the file begins with, which is to be what its name says. */
static tc_status check_open(char **text, source *s, const char *key, tc_image_writer *writer)
{
    uint8_t magic[8];
    tc_image_format named, found;
    tc_error ignored;
    if (s->size == 0)
        return tc_fail(s->err, TC_E_FILE, "%s is empty; write it anew", s->path);
    ssize_t n = pread(s->fd, magic, sizeof magic, 0);
    const bool has_name = tc_image_format_of(&named, s->path, &ignored) == TC_OK;
    if (n <= 0 || !tc_image_format_of_bytes(&found, magic, (size_t)n))
        return tc_fail(s->err, TC_E_FILE, "%s does not begin as an image does (PNG, EXR, TIFF or JPEG); write it anew",
                       s->path);
    if (has_name && named != found)
        return tc_fail(s->err, TC_E_FILE, "%s is no %s file, as its name says, but %s; write it anew", s->path,
                       tc_image_format_name(named), tc_image_format_name(found));
    return found == TC_PNG ? check_png(text, s, key) : check_other(text, s, key, writer);
}

tc_status tc_image_check(char **text, const char *path, const char *key, tc_image_writer *writer, tc_error *err)
{
    struct stat info;
    tc_image_writer own = {0};
    char *found = NULL;
    if (text)
        *text = NULL;
    if (!path)
        return tc_fail(err, TC_E_ARG, "tc_image_check: path is NULL");
    source s = {.path = path, .err = err, .fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
    if (s.fd < 0 && errno == ENOENT)
        return tc_fail(err, TC_E_FILE, "%s is not there", path);
    if (s.fd < 0)
        return tc_fail(err, TC_E_FILE, "%s cannot be read: %s", path, strerror(errno));
    tc_status status;
    if (fstat(s.fd, &info) != 0 || !S_ISREG(info.st_mode)) {
        status = tc_fail(err, TC_E_FILE, "%s is no file", path);
    } else if (!(s.held = tc_alloc(HELD, 1))) {
        status = tc_fail_memory(err, path, HELD, 1);
    } else {
        s.size = (uint64_t)info.st_size;
        status = check_open(&found, &s, text ? key : NULL, writer ? writer : &own);
    }
    free(s.held);
    close(s.fd);
    tc_worker_stop(&own.worker);
    if (status == TC_OK && text)
        *text = found;
    else
        free(found);
    return status;
}
