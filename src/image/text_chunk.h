/* text_chunk.h: texts of PNG files' chunks. */
#ifndef TC_IMAGE_TEXT_CHUNK_H
#define TC_IMAGE_TEXT_CHUNK_H

#include "core/status.h"

/* Is a chunk of this type [4] one that holds a text? */
bool tc_png_is_text(const uint8_t *type);

/* The text of a chunk that is_text, in *out from malloc, if it has that key and is not compressed; else *out stays.
 * path is named in errors. Errors: TC_E_MEMORY. */
tc_status tc_png_text(char **out, const uint8_t *type, const uint8_t *body, size_t n, const char *key, const char *path,
                      tc_error *err);

/* A key without what marks it as ours ("tetcast:"), which EXR files have and the others do not. */
const char *tc_image_plain_key(const char *key);

#endif
