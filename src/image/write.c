/* write.c: image files. PNG is encoded here (png.c); the helper program tetcast-image encodes all else and decodes. All
 * access to files is here. */
#define _GNU_SOURCE
#include "image/writer.h"
#include "core/file.h"
#include "core/memory.h"
#include "core/wire.h"
#include "core/worker.h"
#include "image/image.h"
#include "image/png.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

struct tc_image_writer {
    tc_worker *worker; /* NULL before there is need of it, and after it died */
};

typedef enum format { PNG, EXR, TIFF, JPEG, N_FORMAT } format;

static const struct {
    const char *name;
    int bits[3]; /* the first is the default; 0 ends */
} formats[N_FORMAT] = {
    [PNG] = {"png", {8, 16}}, [EXR] = {"openexr", {32, 16}}, [TIFF] = {"tiff", {32}}, [JPEG] = {"jpeg", {8}}};

static const struct {
    const char *extension;
    format format;
} extensions[] = {{"png", PNG}, {"exr", EXR}, {"tif", TIFF}, {"tiff", TIFF}, {"jpg", JPEG}, {"jpeg", JPEG}};

static tc_status choose_format(format *out, const char *path, tc_error *err)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    *out = PNG;
    if (strcmp(path, "-") == 0)
        return TC_OK;
    for (size_t i = 0; dot && i < sizeof extensions / sizeof *extensions; i++)
        if (strcasecmp(dot + 1, extensions[i].extension) == 0) {
            *out = extensions[i].format;
            return TC_OK;
        }
    return tc_fail(err, TC_E_ARG,
                   "%s has %s%s; images are written as .png, .exr, .tif, .tiff, .jpg or .jpeg, or as PNG to -", path,
                   dot ? "the unknown extension " : "no extension", dot ? dot : "");
}

static tc_status check_meta(const tc_text_pair *meta, size_t n, tc_error *err)
{
    for (size_t i = 0; i < n; i++) {
        const char *key = meta[i].key;
        size_t length = key ? strlen(key) : 0;
        bool good = length >= 1 && length <= 79 && key[0] != ' ' && key[length - 1] != ' ' && meta[i].value;
        for (size_t j = 0; good && j < length; j++)
            good = key[j] >= ' ' && key[j] < 0x7f;
        if (!good)
            return tc_fail(err, TC_E_ARG,
                           "\"%s\" cannot name a text in an image; a key has 1 to 79 printable ASCII characters",
                           key ? key : "");
    }
    return TC_OK;
}

/* Refuses what is not finite; *glowing: pixels with more colour than alpha; *open: pixels that are not opaque. */
static tc_status check_pixels(size_t *glowing, size_t *open, const tc_image *image, tc_error *err)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    *glowing = *open = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float *p = image->rgba + 4 * i;
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]) || !isfinite(p[3]))
            return tc_fail(err, TC_E_ARG,
                           "pixel (%zu, %zu) holds a value that is not finite (%g %g %g %g); not written",
                           i % (size_t)image->width, i / (size_t)image->width, (double)p[0], (double)p[1], (double)p[2],
                           (double)p[3]);
        float brightest = p[0] > p[1] ? p[0] : p[1];
        brightest = brightest > p[2] ? brightest : p[2];
        *glowing += p[3] < 1 && brightest > p[3] + 0.5f / 255;
        *open += p[3] < 1;
    }
    return TC_OK;
}

static void warn_of_losses(format kind, size_t glowing, size_t open, const char *path, const tc_log *log)
{
    if (kind == PNG && glowing > 0)
        tc_say(log, TC_WARNING,
               "%s: %zu pixels have more light than opacity, which PNG cannot hold; use .exr or an opaque background",
               path, glowing);
    if (kind == JPEG && open > 0)
        tc_say(log, TC_WARNING, "%s: JPEG has no transparency; %zu pixels were laid over white", path, open);
}

static tc_status start(tc_image_writer *writer, tc_error *err)
{
    static const tc_worker_limits limits = {.idle_s = 60};
    if (writer->worker)
        return TC_OK;
    return tc_worker_start(&writer->worker, "tetcast-image", &limits, err);
}

/* Starts the helper if it is not there, and drops it when it failed. */
static tc_status call(tc_reply *reply, tc_image_writer *writer, json_t *request, const tc_array *array,
                      const tc_log *log, tc_error *err)
{
    *reply = (tc_reply){0};
    tc_status status = start(writer, err);
    if (status != TC_OK)
        return status;
    status = tc_worker_call(reply, writer->worker, request, array, 1, log, err);
    if (status != TC_OK && status != TC_E_FILE)
        tc_worker_stop(&writer->worker);
    return status;
}

tc_status tc_image_writer_create(tc_image_writer **out, tc_error *err)
{
    *out = tc_calloc(1, sizeof **out);
    return *out ? TC_OK : tc_fail_memory(err, "an image writer", 1, sizeof **out);
}

tc_status tc_image_writer_expect(tc_image_writer *writer, const char *path, tc_error *err)
{
    format kind;
    if (!writer || !path)
        return tc_fail(err, TC_E_ARG, "tc_image_writer_expect: a writer and a path are needed");
    tc_status status = choose_format(&kind, path, err);
    return status == TC_OK && kind != PNG ? start(writer, err) : status;
}

void tc_image_writer_destroy(tc_image_writer **writer)
{
    if (!writer || !*writer)
        return;
    tc_worker_stop(&(*writer)->worker);
    free(*writer);
    *writer = NULL;
}

/* The request to encode; NULL when memory is out. */
static json_t *make_request(format kind, const tc_image *image, const tc_image_encoding *encoding,
                            const tc_text_pair *meta, size_t n)
{
    json_t *pairs = json_array();
    for (size_t i = 0; pairs && i < n; i++)
        if (json_array_append_new(pairs, json_pack("[s,o]", meta[i].key, tc_wire_string(meta[i].value))) != 0) {
            json_decref(pairs);
            return NULL;
        }
    return json_pack("{s:s,s:s,s:i,s:i,s:i,s:i,s:o}", "do", "encode", "format", formats[kind].name, "width",
                     image->width, "height", image->height, "bits", encoding->bits, "quality", encoding->quality,
                     "meta", pairs);
}

static tc_status check_encoding(tc_image_encoding *out, format kind, const tc_image_encoding *asked, const char *path,
                                tc_error *err)
{
    *out = asked ? *asked : (tc_image_encoding){0};
    const int *bits = formats[kind].bits;
    out->bits = out->bits ? out->bits : bits[0];
    out->quality = out->quality ? out->quality : 95;
    if (out->bits != bits[0] && out->bits != bits[1])
        return tc_fail(err, TC_E_ARG, "%s cannot have %d bits a channel; %s has %d%s", path, out->bits,
                       formats[kind].name, bits[0], bits[1] ? " or 16" : "");
    if (out->quality < 1 || out->quality > 100)
        return tc_fail(err, TC_E_ARG, "a quality of %d is not possible; 1 to 100 are", out->quality);
    return TC_OK;
}

/* Everything that can be said before a helper is started. */
static tc_status check(format *kind, tc_image_encoding *encoding, const tc_image *image, const char *path,
                       const tc_image_encoding *asked, const tc_text_pair *meta, size_t n, tc_error *err)
{
    if (!image || !image->rgba || image->width < 1 || image->height < 1 || !path || (n > 0 && !meta))
        return tc_fail(err, TC_E_ARG, "an image with pixels and a path are needed for writing");
    if ((int64_t)image->width * image->height > TC_IMAGE_MAX_PIXELS)
        return tc_fail(err, TC_E_ARG, "an image of %d x %d is too large to be written; at most %d pixels are possible",
                       image->width, image->height, TC_IMAGE_MAX_PIXELS);
    tc_status status = choose_format(kind, path, err);
    if (status == TC_OK)
        status = check_encoding(encoding, *kind, asked, path, err);
    if (status == TC_OK)
        status = check_meta(meta, n, err);
    if (status == TC_OK && strcmp(path, "-") == 0 && isatty(STDOUT_FILENO))
        status = tc_fail(err, TC_E_ARG, "the image is not written to a terminal; redirect the standard output");
    return status;
}

static tc_status put_file(const char *path, const void *data, size_t bytes, tc_error *err)
{
    if (strcmp(path, "-") == 0)
        return tc_file_write(STDOUT_FILENO, data, bytes, "the standard output", err);
    return tc_file_replace(path, data, bytes, err);
}

static tc_status write_png(const tc_image *image, const char *path, int bits, const tc_text_pair *meta, size_t n,
                           const tc_log *log, tc_error *err)
{
    tc_png file;
    tc_status status = tc_png_encode(&file, image, bits, meta, n, log, err);
    if (status != TC_OK)
        return tc_fail_prefix(err, status, "%s cannot be written: ", path);
    status = put_file(path, file.bytes, file.n, err);
    tc_png_finish(&file);
    return status;
}

static tc_status write_by_helper(tc_image_writer *writer, format kind, const tc_image *image, const char *path,
                                 const tc_image_encoding *how, const tc_text_pair *meta, size_t n, const tc_log *log,
                                 tc_error *err)
{
    tc_reply reply = {0};
    json_t *request = make_request(kind, image, how, meta, n);
    if (!request)
        return tc_fail_memory(err, "the texts of an image", n, 256);
    size_t count = 4 * (size_t)image->width * (size_t)image->height;
    const tc_array pixels = {"rgba", TC_F32, count, image->rgba};
    tc_status status = call(&reply, writer, request, &pixels, log, err);
    const tc_array *file = status == TC_OK ? tc_reply_array(&reply, "file", TC_U8) : NULL;
    if (status != TC_OK)
        tc_fail_prefix(err, status, "%s cannot be written: ", path);
    else if (!file || file->count == 0)
        status = tc_fail(err, TC_E_WORKER, "%s cannot be written: tetcast-image gave no file", path);
    else
        status = put_file(path, file->data, file->count, err);
    tc_reply_finish(&reply);
    json_decref(request);
    return status;
}

tc_status tc_image_writer_write(tc_image_writer *writer, const tc_image *image, const char *path,
                                const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n,
                                const tc_log *log, tc_error *err)
{
    format kind = PNG;
    tc_image_encoding how = {0};
    size_t glowing = 0, open = 0;
    tc_status status = check(&kind, &how, image, path, encoding, meta, n, err);
    if (status == TC_OK)
        status = check_pixels(&glowing, &open, image, err);
    if (status == TC_OK)
        status = kind == PNG ? write_png(image, path, how.bits, meta, n, log, err)
                             : write_by_helper(writer, kind, image, path, &how, meta, n, log, err);
    if (status == TC_OK)
        warn_of_losses(kind, glowing, open, path, log);
    return status;
}

tc_status tc_image_writer_save(tc_image_writer *writer, const tc_image *image, const char *path,
                               const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n,
                               const tc_log *log, tc_error *err)
{
    if (!writer)
        return tc_fail(err, TC_E_ARG, "tc_image_writer_save: writer is NULL");
    return tc_image_writer_write(writer, image, path, encoding, meta, n, log, err);
}

tc_status tc_image_write(const tc_image *image, const char *path, const tc_text_pair *meta, size_t n, const tc_log *log,
                         tc_error *err)
{
    tc_image_writer writer = {0}; /* the helper starts after the arguments were checked */
    tc_status status = tc_image_writer_write(&writer, image, path, NULL, meta, n, log, err);
    tc_worker_stop(&writer.worker);
    return status;
}

/* ------------------------------------------------------------------------------------------------------- reading */

static tc_status copy_meta(tc_image_meta *out, const json_t *list, tc_error *err)
{
    size_t n = json_array_size(list);
    out->pair = tc_calloc(n, sizeof *out->pair);
    if (!out->pair)
        return tc_fail_memory(err, "the texts of an image", n, sizeof *out->pair);
    for (size_t i = 0; i < n; i++) {
        const json_t *entry = json_array_get(list, i);
        const char *key = json_string_value(json_array_get(entry, 0)),
                   *value = json_string_value(json_array_get(entry, 1));
        if (!key || !value)
            return tc_fail(err, TC_E_WORKER, "tetcast-image gave a broken list of texts");
        tc_text_pair *pair = &out->pair[out->n++];
        pair->key = tc_strdup(key);
        pair->value = tc_strdup(value);
        if (!pair->key || !pair->value)
            return tc_fail_memory(err, "the texts of an image", n, 256);
    }
    return TC_OK;
}

void tc_image_meta_finish(tc_image_meta *meta)
{
    for (size_t i = 0; i < meta->n; i++) {
        free((char *)meta->pair[i].key);
        free((char *)meta->pair[i].value);
    }
    free(meta->pair);
    *meta = (tc_image_meta){0};
}

tc_status tc_image_writer_read(tc_image **out, tc_image_meta *meta, tc_image_writer *writer, const char *path,
                               tc_error *err)
{
    tc_reply reply = {0};
    void *data = NULL;
    json_t *request = NULL;
    tc_array file = {"file", TC_U8, 0, NULL};
    *out = NULL;
    if (meta)
        *meta = (tc_image_meta){0};
    tc_status status = tc_file_read(&data, &file.count, path, err);
    if (status != TC_OK)
        return status;
    file.data = data;
    request = json_pack("{s:s}", "do", "decode");
    if (!request) {
        status = tc_fail_memory(err, "a message", 1, 256);
        goto done;
    }
    status = call(&reply, writer, request, &file, NULL, err);
    if (status != TC_OK) {
        tc_fail_prefix(err, status, "%s cannot be read: ", path);
        goto done;
    }
    const tc_array *pixels = tc_reply_array(&reply, "rgba", TC_F32);
    json_int_t width = json_integer_value(json_object_get(reply.json, "width"));
    json_int_t height = json_integer_value(json_object_get(reply.json, "height"));
    if (!pixels || width < 1 || height < 1 || width > TC_IMAGE_MAX_PIXELS || height > TC_IMAGE_MAX_PIXELS ||
        pixels->count != 4 * (size_t)width * (size_t)height) {
        status = tc_fail(err, TC_E_WORKER, "%s cannot be read: tetcast-image gave a broken answer", path);
        goto done;
    }
    status = tc_image_create(out, (int)width, (int)height, err);
    if (status == TC_OK)
        memcpy((*out)->rgba, pixels->data, pixels->count * sizeof(float));
    if (status == TC_OK && meta)
        status = copy_meta(meta, json_object_get(reply.json, "meta"), err);
    if (status != TC_OK) {
        tc_image_destroy(out);
        if (meta)
            tc_image_meta_finish(meta);
    }
done:
    tc_reply_finish(&reply);
    json_decref(request);
    free(data);
    return status;
}

tc_status tc_image_read(tc_image **out, const char *path, tc_error *err)
{
    tc_image_writer writer = {0};
    tc_status status = tc_image_writer_read(out, NULL, &writer, path, err);
    tc_worker_stop(&writer.worker);
    return status;
}
