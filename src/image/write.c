/* write.c: whole images to files, as streams of all their rows. */
#include "image/writer.h"
#include "image/call.h"
#include "image/encoding.h"
#include "image/stream.h"

#include <string.h>

static bool is_opaque(const tc_image *image)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++)
        if (image->rgba[4 * i + 3] < 1)
            return false;
    return true;
}

tc_status tc_image_writer_write(tc_image_writer *writer, const tc_image *image, const char *path,
                                const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n,
                                const tc_log *log, tc_error *err)
{
    tc_image_stream *stream;
    tc_image_format format;
    if (!image || !image->rgba || image->width < 1 || image->height < 1 || !path)
        return tc_fail(err, TC_E_ARG, "an image with pixels and a path are needed for writing");
    tc_status status = tc_image_format_of(&format, path, err);
    if (status != TC_OK)
        return status;
    const tc_image_stream_plan plan = {.path = path,
                                       .width = image->width,
                                       .height = image->height,
                                       .opaque = format == TC_PNG && is_opaque(image),
                                       .encoding = encoding,
                                       .meta = meta,
                                       .n = n,
                                       .log = log};
    status = tc_image_stream_begin(&stream, writer, &plan, err);
    if (status != TC_OK)
        return status;
    if (tc_image_stream_is_direct(stream)) { /* nothing is written of what will be refused */
        size_t glowing = 0, open = 0;
        status = tc_image_check_rows(&glowing, &open, image->rgba, image->width, image->height, 0, err);
    }
    if (status == TC_OK)
        status = tc_image_stream_put(stream, image->rgba, encoding ? encoding->depth : NULL, image->height, err);
    if (status == TC_OK)
        return tc_image_stream_close(&stream, true, err);
    (void)tc_image_stream_close(&stream, false, NULL);
    return status;
}

tc_status tc_image_writer_save(tc_image_writer *writer, const tc_image *image, const char *path,
                               const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n, const tc_log *log,
                               tc_error *err)
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
