/* sane.h: what must hold of every picture, whatever is in it. */
#ifndef TC_TESTS_COMMON_SANE_H
#define TC_TESTS_COMMON_SANE_H

#include "tetcast.h"

/* By how much a colour exceeds alpha times the function's largest in that channel, or nan_color's (NULL: none); 0 where
 * none does. */
double picture_color_excess(const tc_image *image, const tc_transfer *tf, const double *nan_color);
/* False where a pixel is NaN, Inf, negative or has alpha above 1, or a colour exceeds alpha times the function's
 * largest by more than `excess`: then out [capacity] says which. */
bool picture_is_sane(char *out, size_t capacity, const tc_image *image, const tc_transfer *tf, const double *nan_color,
                     double excess);

#endif
