/* cubeskin.h: the surface of the cube [-1, 1]^3, cut into triangles. */
#ifndef TC_DATASETS_SYNTHETIC_CUBESKIN_H
#define TC_DATASETS_SYNTHETIC_CUBESKIN_H

#include "synth.h"

typedef struct tc_cubeskin {
    size_t n;                /* squares along an edge of the cube */
    size_t n_vertex, n_face; /* 6 n^2 + 2, 12 n^2 */
    double *vertex;          /* [n_vertex][3], owned */
    int32_t *face;           /* [n_face][3] counter-clockwise seen from outside, owned */
} tc_cubeskin;

/* Errors: TC_E_MEMORY, TC_E_ARG (n above 8192). *out is to be finished after an error, too. */
tc_status tc_cubeskin_build(tc_cubeskin *out, size_t n, tc_error *err);
void tc_cubeskin_finish(tc_cubeskin *skin);

/* Length of the line within [-1, 1]^3. */
double tc_cubeskin_chord(const double *origin, const double *direction, size_t n_cells);

#endif
