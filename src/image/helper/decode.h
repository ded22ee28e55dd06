/* decode.h: pictures of PNG, EXR, TIFF and JPEG files. */
#ifndef TC_IMAGE_DECODE_H
#define TC_IMAGE_DECODE_H

#include "core/serve.h"

/* Answers "decode": a file's bytes become pixels, "depth" where that is asked for and there, and texts. Throws
 * std::exception with a sentence. */
void decode(tc_serve *serve, json_t *request, const tc_array *array, size_t n_array);

/* Answers "check": decodes all of the library's open file, piece by piece, and gives its texts. Throws as decode. */
void check(tc_serve *serve, json_t *request);

#endif
