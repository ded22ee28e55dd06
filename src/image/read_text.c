/* read_text.c: a text of a picture's metadata. PNG is read here; the helper program tetcast-image decodes all else.
 * PNG specification, second edition (W3C 2003): 5.3 chunk layout. */
#include "core/file.h"
#include "core/memory.h"
#include "image/text_chunk.h"
#include "image/writer.h"

#include <stdlib.h>
#include <string.h>

static size_t big_endian(const uint8_t *p)
{
    return (size_t)p[0] << 24 | (size_t)p[1] << 16 | (size_t)p[2] << 8 | p[3];
}

static tc_status png_text(char **out, const uint8_t *file, size_t n, const char *path, const char *key, tc_error *err)
{
    for (size_t at = 8; at + 12 <= n && !*out;) {
        const size_t length = big_endian(file + at);
        if (length > n - at - 12)
            break;
        const uint8_t *type = file + at + 4;
        tc_status status = tc_png_is_text(type) ? tc_png_text(out, type, type + 4, length, key, path, err) : TC_OK;
        if (status != TC_OK)
            return status;
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
        if (strcmp(tc_image_plain_key(meta.pair[i].key), tc_image_plain_key(key)) == 0 &&
            !(*out = tc_strdup(meta.pair[i].value)))
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
