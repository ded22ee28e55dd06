/* segment.h: front-to-back sums of exact segment integrals. */
#ifndef TC_REFERENCE_SEGMENT_H
#define TC_REFERENCE_SEGMENT_H

#include "reference/reference.h"

typedef struct tc_segment_sum {
    double rgba[4]; /* premultiplied */
    double clear;   /* transmittance so far; 1 at the start */
} tc_segment_sum;

/* Adds a segment of length l (unit distances) over which the scalar runs linearly from s0 to s1, both finite, behind
 * what is there. Error below 1e-10. Where s0 = s1 lies on a step the right value holds. Cost: O(log n + knots crossed).
 */
void tc_segment_add(tc_segment_sum *out, const tc_transfer *tf, double s0, double s1, double l);
/* The same for a segment of one colour and attenuation: color [4], r, g, b and attenuation per unit distance. */
void tc_segment_add_constant(tc_segment_sum *out, const double color[4], double l);

#endif
