/* png.h: pictures as PNG files in memory, in this process: no helper program has to start for the usual picture. */
#ifndef TC_IMAGE_PNG_H
#define TC_IMAGE_PNG_H

#include "core/status.h"

/* A file's bytes; tc_png_finish ends it. */
typedef struct tc_png {
    uint8_t *bytes;
    size_t n;
} tc_png;

/* The PNG file of an image.
 *   image  finite pixels, at most TC_IMAGE_MAX_PIXELS; un-premultiplied in float, then rounded; RGB when all are opaque
 *   bits   8 or 16 a channel
 *   meta   [n] texts as tEXt, or iTXt where not ASCII; keys of 1 to 79 printable ASCII characters; what of a value is
 *          not UTF-8 becomes '?'
 * Errors: TC_E_MEMORY, TC_E_FILE (a text of 2 GiB); *out is then empty. Cost: 7 ms for 512 x 512; memory: the file
 * and one row. */
tc_status tc_png_encode(tc_png *out, const tc_image *image, int bits, const tc_text_pair *meta, size_t n,
                        const tc_log *log, tc_error *err);
void tc_png_finish(tc_png *file);

#endif
