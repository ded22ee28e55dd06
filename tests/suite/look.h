/* look.h: a box of tets with a field of one's own, and the parts of a ray in it: what tests of looks share. */
#ifndef TC_TESTS_SUITE_LOOK_H
#define TC_TESTS_SUITE_LOOK_H

#include "suite.h"

/* The box 0 … 1 in n x n x n cubes of six tets each, prepared; field(x), x [3], at points or at the tets' centroids. */
tc_mesh *look_box(int n, double (*field)(const double *x), tc_association association);
/* The part of a ray where all `n` planes keep it and the unit box holds it: 0 when none. */
bool look_chord(double t[2], const double *origin, const double *direction, const tc_plane *plane, int n);

#endif
