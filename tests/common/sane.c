/* sane.c: pixels that no picture may hold. */
#include "sane.h"

#include <math.h>
#include <stdio.h>

double picture_color_excess(const tc_image *image, const tc_transfer *tf, const double *nan_color)
{
    size_t n, pixels = (size_t)image->width * (size_t)image->height;
    const tc_knot *knot = tc_transfer_knots(tf, &n);
    double most[3] = {0, 0, 0}, excess = 0;
    for (size_t i = 0; i < n; i++) {
        const double color[3] = {knot[i].r, knot[i].g, knot[i].b};
        for (int c = 0; c < 3; c++)
            most[c] = fmax(most[c], color[c]);
    }
    for (int c = 0; c < 3 && nan_color; c++)
        most[c] = fmax(most[c], nan_color[c]);
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3; c++)
            excess = fmax(excess, image->rgba[4 * i + c] - image->rgba[4 * i + 3] * most[c]);
    return excess;
}

bool picture_is_sane(char *out, size_t capacity, const tc_image *image, const tc_transfer *tf, const double *nan_color,
                     double excess)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        const float *p = image->rgba + 4 * i;
        if (p[0] >= 0 && p[1] >= 0 && p[2] >= 0 && p[3] >= 0 && p[3] <= 1 && isfinite(p[0] + p[1] + p[2]))
            continue;
        snprintf(out, capacity, "pixel %d, %d is %g %g %g, alpha %g", (int)(i % (size_t)image->width),
                 (int)(i / (size_t)image->width), (double)p[0], (double)p[1], (double)p[2], (double)p[3]);
        return false;
    }
    double found = picture_color_excess(image, tf, nan_color);
    if (!(found <= excess))
        snprintf(out, capacity, "a colour exceeds alpha times the function's largest by %g", found);
    return found <= excess;
}
