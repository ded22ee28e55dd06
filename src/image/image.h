/* image.h: what the files of this room share. The functions themselves are in tetcast.h and writer.h. */
#ifndef TC_IMAGE_IMAGE_H
#define TC_IMAGE_IMAGE_H

#include "core/status.h"

/* The largest image: 16384 x 16384, 4 GiB. */
enum { TC_IMAGE_MAX_PIXELS = 1 << 28 };

#endif
