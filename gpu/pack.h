/* pack.h: the mesh as arrays for the GPU. No GL call in it. */
#ifndef TC_GPU_PACK_H
#define TC_GPU_PACK_H

#include "mesh/mesh.h"

enum { TC_PACK_BINS = 64, TC_PACK_CELL_INTS = 4, TC_PACK_VERTEX_FLOATS = 4, TC_PACK_FACE_INTS = 4 };

/* How large cells are, by the scalars they hold: what a transfer function needs to know of a mesh to tell whether any
 * segment is optically thick. Bin i: packed scalars i/TC_PACK_BINS … (i+1)/TC_PACK_BINS. Over the real cells that reach
 * into a bin: the longest edge, and the greatest longest edge × scalar range; in mesh space. And how likely a ray's cell
 * holds a scalar of the bin: the mean, over real cells by the square of their longest edge, of the share of the bin that
 * they hold. */
typedef struct tc_pack_extent {
    float edge[TC_PACK_BINS], edge_range[TC_PACK_BINS];
    double held[TC_PACK_BINS];
} tc_pack_extent;

/* Positions are recentred on the bounding box and scaled by its half diagonal in double, then rounded to float once;
 * scalars are mapped from scalar_lo … scalar_hi to 0 … 1. 16 bytes a cell, 16 a vertex (after Aman et al. 2022):
 *   cell   [n_cell][4]   XOR of the four vertex ids; of the neighbours n0 … n3 in the order of the sorted vertex ids
 *                        (-1 outside), n0 ^ n3, n1 ^ n3, n2 ^ n3: who comes from one of them knows them all
 *   vertex [n_vertex][4] x, y, z, scalar (0 with cell data, NaN where a value is not finite)
 *   face   [n_face][4]   boundary faces: three ids counter-clockwise from outside, and the cell behind
 *   face_corner [n_face][3][3] where those three are: stays on the CPU (propose.h)
 *   cell_scalar [n_tet]  with cell data only, else NULL */
typedef struct tc_pack {
    size_t n_cell, n_real, n_vertex, n_face;
    int32_t *cell;
    float *vertex;
    int32_t *face;
    float *face_corner;
    float *cell_scalar;
    double center[3], scale; /* mesh space = (world - center) * scale */
    double scalar_lo, scalar_hi;
    tc_pack_extent extent;
    double ms;
} tc_pack;

/* The mesh must be prepared. threads: 0, all cores; the result does not depend on them. Errors: TC_E_ARG (not prepared),
 * TC_E_MESH (more cells than 32 bits address), TC_E_MEMORY. Cost: O(cells), about 0.1 us a cell on one core. */
tc_status tc_pack_build(tc_pack *out, const tc_mesh *mesh, int threads, tc_error *err);
/* What new values change, and no more: vertex (positions as before, and the scalars), cell_scalar, scalar_lo and _hi, extent,
 * with center, scale and all counts but n_face; the other arrays are NULL. All is as tc_pack_build gives it. Ends with
 * tc_pack_finish, too. Errors: as tc_pack_build. Cost: O(cells), some 15 ns a cell on one core, 16 B a vertex. */
tc_status tc_pack_scalars(tc_pack *out, const tc_mesh *mesh, int threads, tc_error *err);
void tc_pack_finish(tc_pack *pack);

#endif
