/* writer.c: the helper program tetcast-image, and reading of image files through it. */
#include "image/writer.h"
#include "core/file.h"
#include "core/memory.h"
#include "image/call.h"
#include "image/encoding.h"
#include "image/image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

tc_status tc_image_helper_start(tc_image_writer *writer, tc_error *err)
{
    static const tc_worker_limits limits = {.idle_s = 60};
    if (writer->worker)
        return TC_OK;
    return tc_worker_start(&writer->worker, "tetcast-image", &limits, err);
}

tc_status tc_image_helper_call(tc_reply *reply, tc_image_writer *writer, json_t *request, const tc_array *array,
                               size_t n_array, const tc_log *log, tc_error *err)
{
    *reply = (tc_reply){0};
    tc_status status = tc_image_helper_start(writer, err);
    if (status != TC_OK)
        return status;
    status = tc_worker_call(reply, writer->worker, request, array, n_array, log, err);
    if (status != TC_OK && status != TC_E_FILE)
        tc_worker_stop(&writer->worker);
    return status;
}

void tc_image_helper_path(char *out, int fd)
{
    snprintf(out, 64, "/proc/%ld/fd/%d", (long)getpid(), fd);
}

tc_status tc_image_writer_create(tc_image_writer **out, tc_error *err)
{
    *out = tc_calloc(1, sizeof **out);
    return *out ? TC_OK : tc_fail_memory(err, "an image writer", 1, sizeof **out);
}

tc_status tc_image_writer_expect(tc_image_writer *writer, const char *path, tc_error *err)
{
    tc_image_format format;
    if (!writer || !path)
        return tc_fail(err, TC_E_ARG, "tc_image_writer_expect: a writer and a path are needed");
    tc_status status = tc_image_format_of(&format, path, err);
    return status == TC_OK && format != TC_PNG ? tc_image_helper_start(writer, err) : status;
}

void tc_image_writer_destroy(tc_image_writer **writer)
{
    if (!writer || !*writer)
        return;
    tc_worker_stop(&(*writer)->worker);
    free(*writer);
    *writer = NULL;
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

/* What the answer holds; *depth: where it is asked for and there. */
static tc_status take(tc_image **out, float **depth, tc_image_meta *meta, const tc_reply *reply, const char *path,
                      tc_error *err)
{
    const tc_array *pixels = tc_reply_array(reply, "rgba", TC_F32);
    const tc_array *z = depth ? tc_reply_array(reply, "depth", TC_F32) : NULL;
    json_int_t width = json_integer_value(json_object_get(reply->json, "width"));
    json_int_t height = json_integer_value(json_object_get(reply->json, "height"));
    if (!pixels || width < 1 || height < 1 || width > TC_IMAGE_MAX_READ || height > TC_IMAGE_MAX_READ ||
        pixels->count != 4 * (size_t)width * (size_t)height || (z && z->count != pixels->count / 4))
        return tc_fail(err, TC_E_WORKER, "%s cannot be read: tetcast-image gave a broken answer", path);
    tc_status status = tc_image_create(out, (int)width, (int)height, err);
    if (status == TC_OK)
        memcpy((*out)->rgba, pixels->data, pixels->count * sizeof(float));
    if (status == TC_OK && z) {
        *depth = tc_alloc(z->count, sizeof(float));
        if (*depth)
            memcpy(*depth, z->data, z->count * sizeof(float));
        else
            status = tc_fail_memory(err, path, z->count, sizeof(float));
    }
    return status == TC_OK && meta ? copy_meta(meta, json_object_get(reply->json, "meta"), err) : status;
}

tc_status tc_image_writer_read_depth(tc_image **out, float **depth, tc_image_meta *meta, tc_image_writer *writer,
                                     const char *path, tc_error *err)
{
    tc_reply reply = {0};
    void *data = NULL;
    json_t *request = NULL;
    tc_array file = {"file", TC_U8, 0, NULL};
    *out = NULL;
    if (depth)
        *depth = NULL;
    if (meta)
        *meta = (tc_image_meta){0};
    tc_status status = tc_file_read(&data, &file.count, path, err);
    if (status != TC_OK)
        return status;
    file.data = data;
    request = json_pack("{s:s,s:b}", "do", "decode", "depth", depth != NULL);
    if (request)
        status = tc_image_helper_call(&reply, writer, request, &file, 1, NULL, err);
    else
        status = tc_fail_memory(err, "a message", 1, 256);
    if (status != TC_OK)
        tc_fail_prefix(err, status, "%s cannot be read: ", path);
    else
        status = take(out, depth, meta, &reply, path, err);
    if (status != TC_OK) {
        tc_image_destroy(out);
        if (depth) {
            free(*depth);
            *depth = NULL;
        }
        if (meta)
            tc_image_meta_finish(meta);
    }
    tc_reply_finish(&reply);
    json_decref(request);
    free(data);
    return status;
}

tc_status tc_image_writer_read(tc_image **out, tc_image_meta *meta, tc_image_writer *writer, const char *path,
                               tc_error *err)
{
    return tc_image_writer_read_depth(out, NULL, meta, writer, path, err);
}

tc_status tc_image_read(tc_image **out, const char *path, tc_error *err)
{
    tc_image_writer writer = {0};
    tc_status status = tc_image_writer_read(out, NULL, &writer, path, err);
    tc_worker_stop(&writer.worker);
    return status;
}
