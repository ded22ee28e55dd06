/* pack_gradient.h: the scalar's gradient in cells or at vertices, as floats for the GPU. No GL call in it. */
#ifndef TC_GPU_PACK_GRADIENT_H
#define TC_GPU_PACK_GRADIENT_H

#include "mesh/mesh.h"

/* As tc_pack has them: positions are scaled by scale, scalars mapped from lo … hi to 0 … 1. */
typedef struct tc_pack_units {
    double scale, scalar_lo, scalar_hi;
} tc_pack_units;

/* The gradient of the packed scalar in packed space, as tc_gradient (tetcast_look.h) defines it.
 *   out  [n_tet][4] (TC_GRADIENT_CELL: real cells) or [n_vertex][4] (TC_GRADIENT_VERTEX): x, y, z, and its length; made
 * by the call, freed with free(). All 0 where the gradient is 0 or none, as at points of imaginary cells alone. One
 *        longer than 1e18 is shortened to that, so that a shader may square it.
 * With m = |g| / (|g| + magnitude R/D) of tc_shade, R/D is 1/2 here, since packed bounds have a diagonal of 2.
 *
 * Computed in double, of thin tets in twice that, so that one is right to float down to six volumes of 1e-24 of its
 * edges' product; whether the volume is 0 is told exactly. In cell data a direction in which the centroids spread less
 * than 1e-6 of the widest counts as open. threads: 0, all cores; the result does not depend on them. The mesh must be
 * prepared. Errors: TC_E_MEMORY. Cost on one core: 35 to 50 ns a cell, with cell data 85 to 100; at vertices 1.1 to 1.5
 * times that, and while it runs 40 B for a 32nd of the vertices (for 4096 at least) a thread. */
tc_status tc_pack_gradient(float **out, const tc_mesh *mesh, tc_gradient kind, const tc_pack_units *units, int threads,
                           tc_error *err);

#endif
