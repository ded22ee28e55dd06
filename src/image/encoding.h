/* encoding.h: what formats image files have, and what each can hold. */
#ifndef TC_IMAGE_ENCODING_H
#define TC_IMAGE_ENCODING_H

#include "core/status.h"

typedef enum tc_image_format { TC_PNG, TC_EXR, TC_TIFF, TC_JPEG, TC_N_IMAGE_FORMAT } tc_image_format;

/* "png", "openexr", "tiff" or "jpeg": OpenImageIO's names. */
const char *tc_image_format_name(tc_image_format format);

/* The format of a file of that name, by its extension; "-" is PNG. Errors: TC_E_ARG. */
tc_status tc_image_format_of(tc_image_format *out, const char *path, tc_error *err);

/* The format of a file that begins with these bytes, of which 8 are enough; false: none of these. */
bool tc_image_format_of_bytes(tc_image_format *out, const uint8_t *bytes, size_t n);

/* What was asked for (NULL: nothing) with the format's defaults in place of zeros; level as of tc_png_plan. path is
 * named in errors. Errors: TC_E_ARG: the format has not that. */
tc_status tc_image_encoding_fill(tc_image_encoding *out, tc_image_format format, const tc_image_encoding *asked,
                                 const char *path, tc_error *err);

/* May the texts be in an image? Errors: TC_E_ARG: a key that is not 1 to 79 printable ASCII characters, no value. */
tc_status tc_image_meta_check(const tc_text_pair *meta, size_t n, tc_error *err);

#endif
