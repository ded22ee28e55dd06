/* writer.h: image files; those that are not PNG through the helper program tetcast-image, which stays alive for many.
 * Pixels are taken and given as they are, in display space: no colour conversion either way. */
#ifndef TC_IMAGE_WRITER_H
#define TC_IMAGE_WRITER_H

#include "core/status.h"

/* Pairs read from a file; owned. */
typedef struct tc_image_meta {
    size_t n;
    tc_text_pair *pair;
} tc_image_meta;

/* tc_image_write with a helper that is there already, or is started now if the format needs it. One that died is
 * started anew by the next call. PNG: un-premultiplied in float, then rounded; RGB when every pixel is opaque. JPEG:
 * 4:4:4, over white where not opaque. EXR, TIFF: premultiplied, lossless; depth of EXR is not looked at. meta: keys of
 * 1 to 79 printable ASCII characters, values UTF-8. PNG: text chunks; EXR: attributes "tetcast:KEY"; TIFF and JPEG: one
 * JSON object as ImageDescription (JPEG: at most 60 000 bytes, else left out with a warning). Errors: TC_E_ARG
 * (extension, encoding, key, a pixel that is not finite: says where), TC_E_FILE, TC_E_WORKER. */
tc_status tc_image_writer_write(tc_image_writer *writer, const tc_image *image, const char *path,
                                const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n,
                                const tc_log *log, tc_error *err);

/* Reads PNG, EXR, TIFF or JPEG, by content; colours become premultiplied float RGBA, grey becomes RGB. meta may be
 * NULL; tc_image_meta_finish ends it. Errors: TC_E_FILE, TC_E_WORKER, TC_E_MEMORY. */
tc_status tc_image_writer_read(tc_image **out, tc_image_meta *meta, tc_image_writer *writer, const char *path,
                               tc_error *err);
/* The same, with the channel Z of EXR in *depth: [height][width], the caller's to free; NULL: the file has none. */
tc_status tc_image_writer_read_depth(tc_image **out, float **depth, tc_image_meta *meta, tc_image_writer *writer,
                                     const char *path, tc_error *err);
void tc_image_meta_finish(tc_image_meta *meta);

#endif
