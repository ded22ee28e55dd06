/* predicate.h: the exact sign of a tet's volume. */
#ifndef TC_MESH_PREDICATE_H
#define TC_MESH_PREDICATE_H

/* Sign (-1, 0, +1) of dot(cross(b-a, c-a), d-a) for four finite points [3], exact for every finite double: a filter in
 * double first, long integers when it cannot decide. Cost: about 5 ns when the filter decides, some 0.5 µs when not. */
int tc_orient3d(const double *a, const double *b, const double *c, const double *d);

/* The same by long integers alone: what the filter is tested against. */
int tc_orient3d_exact(const double *a, const double *b, const double *c, const double *d);

#endif
