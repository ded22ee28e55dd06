/* png.h: pictures as PNG files, row by row, in this process: no helper program has to start for the usual picture. */
#ifndef TC_IMAGE_PNG_H
#define TC_IMAGE_PNG_H

#include "core/status.h"

typedef struct tc_png tc_png;

/* Takes the next bytes of the file. False: no more, which ends the file; *err of the call under way is then filled by
 * it. */
typedef bool tc_png_sink(void *context, const void *bytes, size_t n, tc_error *err);

/* A level beside zlib's: only runs of a byte are sought. On renders half the time of level 4 and 10 to 15 % larger. */
enum { TC_PNG_RUNS = -1 };

typedef struct tc_png_plan {
    int width, height;        /* 1 x 1 to TC_IMAGE_MAX_PIXELS in all */
    bool opaque;              /* RGB; a pixel that is not opaque is laid over black. Else RGBA, un-premultiplied */
    int bits;                 /* 8 or 16 a channel */
    int level;                /* zlib's, 0 to 9; or TC_PNG_RUNS */
    const tc_text_pair *meta; /* [n] texts as tEXt, or iTXt where not ASCII; keys of 1 to 79 printable ASCII characters;
                                 what of a value is not UTF-8 becomes '?' */
    size_t n;
    tc_png_sink *sink;
    void *context; /* of sink */
} tc_png_plan;

/* Writes all that comes before the pixels. plan is borrowed for the call. Errors: TC_E_MEMORY, TC_E_FILE (a text of 2
 * GiB), those of sink; *out is then NULL. */
tc_status tc_png_begin(tc_png **out, const tc_png_plan *plan, tc_error *err);
/* The next row: rgba [width][4], finite; rounded to the nearest level. After an error only tc_png_destroy is allowed.
 * Errors: those of sink, TC_E_MEMORY. Cost: 3 ms for 512 rows of 512 by TC_PNG_RUNS; memory: some rows. */
tc_status tc_png_row(tc_png *png, const float *rgba, tc_error *err);
/* The row before once more, for a fifth of that. Errors: as tc_png_row. */
tc_status tc_png_again(tc_png *png, tc_error *err);
/* All rows are there: writes what comes after them. Errors: as tc_png_row. */
tc_status tc_png_end(tc_png *png, tc_error *err);
void tc_png_destroy(tc_png **png);

#endif
