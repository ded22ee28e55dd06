/* image.h: what the files of this room share. The functions themselves are in tetcast.h and writer.h. */
#ifndef TC_IMAGE_IMAGE_H
#define TC_IMAGE_IMAGE_H

#include "core/status.h"

/* The largest image: 32768 x 32768, 16 GiB; the largest one that is read whole from a file: 16384 x 16384. */
enum { TC_IMAGE_MAX_PIXELS = 1 << 30, TC_IMAGE_MAX_READ = 1 << 28 };

#endif
