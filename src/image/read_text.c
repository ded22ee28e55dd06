/* read_text.c: a text of a picture's metadata. PNG is read here; the helper program tetcast-image decodes all else.
 * PNG specification, second edition (W3C 2003): 5.3 chunk layout, 11.3.4 textual information. */
#include "core/file.h"
#include "core/memory.h"
#include "image/writer.h"

#include <stdlib.h>
#include <string.h>

/* Without what marks it as ours, which EXR files have and the others do not. */
static const char *plain_key(const char *key)
{
    return strncmp(key, "tetcast:", 8) == 0 ? key + 8 : key;
}

static size_t big_endian(const uint8_t *p)
{
    return (size_t)p[0] << 24 | (size_t)p[1] << 16 | (size_t)p[2] << 8 | p[3];
}

/* Where the text of a chunk's body begins: behind the key of tEXt; of iTXt behind the key, two flags, language and
 * translated key. NULL: its key is another one, it is compressed or broken. */
static const uint8_t *text_of(const uint8_t *body, size_t n, bool international, const char *key)
{
    const uint8_t *end = body + n, *at = memchr(body, 0, n);
    if (!at || strcmp((const char *)body, key) != 0)
        return NULL;
    at++;
    if (!international)
        return at;
    if (end - at < 2 || at[0] != 0)
        return NULL;
    at += 2;
    for (int skip = 0; skip < 2; skip++) {
        at = memchr(at, 0, (size_t)(end - at));
        if (!at)
            return NULL;
        at++;
    }
    return at;
}

static tc_status png_text(char **out, const uint8_t *file, size_t n, const char *path, const char *key, tc_error *err)
{
    for (size_t at = 8; at + 12 <= n && !*out;) {
        const size_t length = big_endian(file + at);
        if (length > n - at - 12)
            break;
        const uint8_t *type = file + at + 4, *body = type + 4;
        const bool plain = memcmp(type, "tEXt", 4) == 0, international = memcmp(type, "iTXt", 4) == 0;
        const uint8_t *text = plain || international ? text_of(body, length, international, key) : NULL;
        if (text) {
            const size_t size = (size_t)(body + length - text);
            *out = tc_calloc(size + 1, 1);
            if (!*out)
                return tc_fail_memory(err, path, size, 1);
            memcpy(*out, text, size);
        }
        at += 12 + length;
    }
    return TC_OK;
}

static tc_status other_text(char **out, const char *path, const char *key, tc_error *err)
{
    tc_image_writer *writer = NULL;
    tc_image *image = NULL;
    tc_image_meta meta = {0};
    tc_status status = tc_image_writer_create(&writer, err);
    if (status == TC_OK)
        status = tc_image_writer_read(&image, &meta, writer, path, err);
    for (size_t i = 0; i < meta.n && status == TC_OK && !*out; i++)
        if (strcmp(plain_key(meta.pair[i].key), plain_key(key)) == 0 && !(*out = tc_strdup(meta.pair[i].value)))
            status = tc_fail_memory(err, path, strlen(meta.pair[i].value), 1);
    tc_image_meta_finish(&meta);
    tc_image_destroy(&image);
    tc_image_writer_destroy(&writer);
    return status;
}

tc_status tc_image_read_text(char **out, const char *path, const char *key, tc_error *err)
{
    void *data = NULL;
    size_t n = 0;
    *out = NULL;
    tc_status status = tc_file_read(&data, &n, path, err);
    if (status != TC_OK)
        return status;
    if (n >= 8 && memcmp(data, "\x89PNG\r\n\x1a\n", 8) == 0)
        status = png_text(out, data, n, path, key, err);
    else
        status = other_text(out, path, key, err);
    free(data);
    return status;
}
