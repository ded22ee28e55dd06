/* stream.h: pictures written row by row; tc_image_writer_save sends a whole one the same way. */
#ifndef TC_IMAGE_STREAM_H
#define TC_IMAGE_STREAM_H

#include "core/status.h"

/* What a picture is to be; all is copied when the stream begins. */
typedef struct tc_image_stream_plan {
    const char *path;
    int width, height;
    bool opaque;
    const tc_image_encoding *encoding; /* NULL: defaults; depth set: all rows come with depth */
    const tc_text_pair *meta;          /* [n] */
    size_t n;
    const tc_log *log;
} tc_image_stream_plan;

/* tc_image_stream_open with a helper that is there already (borrowed until the stream is closed; meanwhile it serves
 * nobody else), or NULL: its own. */
tc_status tc_image_stream_begin(tc_image_stream **out, tc_image_writer *writer, const tc_image_stream_plan *plan,
                                tc_error *err);
/* tc_image_stream_rows; depth [rows][width] where the stream's plan has one. */
tc_status tc_image_stream_put(tc_image_stream *stream, const float *rgba, const float *depth, int rows, tc_error *err);
/* Are the rows written where they cannot be taken back (a pipe, a device)? */
bool tc_image_stream_is_direct(const tc_image_stream *stream);

/* Refuses pixels that are not finite: rgba [rows][width][4] begin at row `first` of the image. *glowing and *open grow
 * by the pixels with more colour than alpha and those that are not opaque. Errors: TC_E_ARG: says where. */
tc_status tc_image_check_rows(size_t *glowing, size_t *open, const float *rgba, int width, int rows, int first,
                              tc_error *err);

#endif
