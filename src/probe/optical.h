/* optical.h: optical depth along a part of a ray, and where it is reached. */
#ifndef TC_PROBE_OPTICAL_H
#define TC_PROBE_OPTICAL_H

#include "transfer_functions/transfer.h"

/* Integral of the attenuation over a segment of length l (unit distances) along which the scalar runs linearly from s0
 * to s1, both finite: exact but for rounding, at most 1e300. Where s0 = s1 lies on a step the right value holds. Cost:
 * O(log knots + knots crossed). */
double tc_optical_depth(const tc_transfer *tf, double s0, double s1, double l);
/* Where along that segment, 0 to 1, its first part has that optical depth; 1 where the whole has less. Cost: the same.
 */
double tc_optical_place(const tc_transfer *tf, double s0, double s1, double l, double depth);

#endif
