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

/* What a volume is made of where it is not the plain density emitter. */
typedef struct tc_matter {
    const tc_transfer *opacity; /* attenuation, by the scalar */
    const tc_transfer *color;   /* colour, by another value; NULL: of opacity, by the scalar */
    bool emission;              /* nothing is absorbed, and there is no opacity */
    double gain[3], glow[3];    /* a colour c becomes gain c + glow */
} tc_matter;

/* Adds a segment of length l over which the scalar runs linearly from s0 to s1 and the value for colour from q0 to q1,
 * all finite, behind what is there: exact between the knots of both functions. */
void tc_segment_add_matter(tc_segment_sum *out, const tc_matter *matter, double s0, double s1, double q0, double q1,
                           double l);
/* The same for one colour and attenuation: color [4]. */
void tc_segment_add_matter_constant(tc_segment_sum *out, const tc_matter *matter, const double color[4], double l);
/* r, g, b, a of the function at s; at a step the right value holds. */
void tc_segment_value(double out[4], const tc_transfer *tf, double s);

#endif
