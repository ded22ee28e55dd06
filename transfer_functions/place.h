/* place.h: where a scalar lies between two others, for every finite double. */
#ifndef TC_TRANSFER_FUNCTIONS_PLACE_H
#define TC_TRANSFER_FUNCTIONS_PLACE_H

#include <math.h>

/* (s - a) / (b - a); 0 unless a < b. Halves keep the difference of two huge scalars finite; of denormal ones they would
 * lose all, so they are taken only where they are needed. */
static inline double tc_place(double s, double a, double b)
{
    const double width = b - a;
    if (!(width > 0))
        return 0;
    return isfinite(width) ? (s - a) / width : (0.5 * s - 0.5 * a) / (0.5 * b - 0.5 * a);
}

#endif
