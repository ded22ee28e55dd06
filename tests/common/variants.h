/* variants.h: the same body in other words: meshes that must give the same picture. */
#ifndef TC_TESTS_COMMON_VARIANTS_H
#define TC_TESTS_COMMON_VARIANTS_H

#include "core/status.h"

/* Arrays of one's own; zeroed by the caller, freed with variant_finish whether making them succeeded or not. */
typedef struct mesh_variant {
    tc_mesh_arrays arrays; /* points into the three below */
    double *vertex, *scalar;
    int32_t *tet;
} mesh_variant;

void variant_finish(mesh_variant *v);

/* Vertices, cells and the vertices within a cell in another order; half of the cells are turned inside out. All of
 * these: from is borrowed for the call; Errors: TC_E_MEMORY, TC_E_ARG (more than 32-bit ids can name). */
tc_status variant_permute(mesh_variant *out, const tc_mesh_arrays *from, uint64_t seed, tc_error *err);
/* Every tet becomes four around its centre, where the value is the mean: the same piecewise linear field. */
tc_status variant_refine4(mesh_variant *out, const tc_mesh_arrays *from, tc_error *err);
/* Every tet becomes eight by the middles of its edges, which neighbours share. */
tc_status variant_refine8(mesh_variant *out, const tc_mesh_arrays *from, tc_error *err);
/* Vertices become scale * (turn * x) + offset: turn [3][3] row-major, or NULL; offset [3]. */
tc_status variant_move(mesh_variant *out, const tc_mesh_arrays *from, const double *turn, double scale,
                       const double *offset, tc_error *err);

#endif
