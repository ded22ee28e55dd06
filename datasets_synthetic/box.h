/* box.h: one axis-aligned box, divided by a lattice; and the linear field that most hard cases carry. */
#ifndef TC_DATASETS_SYNTHETIC_BOX_H
#define TC_DATASETS_SYNTHETIC_BOX_H

#include "lattice.h"

typedef struct tc_box {
    double lo[3], hi[3];
    size_t n[3]; /* cubes along each axis */
    double
        jitter; /* inner vertices move by up to this share of a step along each axis; 0.15 leaves all tets positive */
    uint64_t seed; /* of that */
    tc_split split;
} tc_box;

/* The unit cube with n x n x n cubes of about n_cells tets, at least n_least a side; jitter 0.15. */
tc_box tc_box_unit(size_t n_cells, size_t n_least, uint64_t seed);
/* Cubes a side so that side^3 * tets_per_cube is about n_cells; at least n_least. */
size_t tc_box_side(size_t n_cells, double tets_per_cube, size_t n_least);
/* Vertices in lattice order (x fastest), lo and hi exact. Errors: TC_E_MEMORY, TC_E_ARG. */
tc_status tc_box_build(tc_synth_soup *out, const tc_box *box, tc_error *err);

/* (x + 2 y + 3 z) / 6 */
double tc_field_linear(const double *point);

#endif
