/* image.c: the float image: premultiplied RGBA, row 0 at the top. */
#include "image/image.h"
#include "core/memory.h"
#include "core/room.h"

#include <stdlib.h>

enum { ASK_PIXELS = 1 << 24 }; /* from 256 MiB on the system is asked whether it has them */

tc_status tc_image_create(tc_image **out, int width, int height, tc_error *err)
{
    *out = NULL;
    if (width < 1 || height < 1 || (int64_t)width * height > TC_IMAGE_MAX_PIXELS)
        return tc_fail(err, TC_E_ARG, "an image of %d x %d is not possible; 1 x 1 to %d pixels in all are", width,
                       height, TC_IMAGE_MAX_PIXELS);
    size_t pixels = (size_t)width * (size_t)height;
    if (pixels >= ASK_PIXELS) {
        const size_t bytes = pixels * 4 * sizeof(float), room = tc_room_available();
        if (bytes > room)
            return tc_fail(err, TC_E_MEMORY,
                           "an image of %d x %d needs %.1f GiB of memory, and %.1f GiB are free; make it smaller, or "
                           "write it in rows",
                           width, height, (double)bytes / 0x1p30, (double)room / 0x1p30);
    }
    tc_image *image = tc_calloc(1, sizeof *image);
    float *rgba = image ? tc_calloc(pixels, 4 * sizeof *rgba) : NULL;
    if (!rgba) {
        free(image);
        return tc_fail_memory(err, "an image", pixels, 4 * sizeof *rgba);
    }
    *image = (tc_image){.width = width, .height = height, .rgba = rgba};
    *out = image;
    return TC_OK;
}

void tc_image_destroy(tc_image **image)
{
    if (!image || !*image)
        return;
    free((*image)->rgba);
    free(*image);
    *image = NULL;
}

void tc_image_background(tc_image *image, const float *rgba)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        float *p = image->rgba + 4 * i, through = 1 - p[3];
        for (int c = 0; c < 4; c++)
            p[c] += through * rgba[c];
    }
}
