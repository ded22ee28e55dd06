/* pack_planes.h: the mesh as the textures of Weiler et al. 2003, Table 1: what the stepper of the paper's own
 * arithmetic reads (shaders/stepper_planes.glsl), and nothing else. No GL call in it. */
#ifndef TC_GPU_PACK_PLANES_H
#define TC_GPU_PACK_PLANES_H

#include "gpu/pack.h"

enum { TC_PACK_PLANES_BYTES = 4 * 16 + 4 * 16 + 4 * 4 + 16 }; /* a cell; the paper's section 6 counts the same 160 */

/* Vertex i of cell t lies opposite face i, as in the mesh. Positions and scalars are those of the pack, as it rounded
 * them. */
typedef struct tc_pack_planes {
    size_t n_cell;

    /* [n_cell][4][4] v(t,i) in x, y, z; the fourth is 0 */
    float *vertex;

    /* [n_cell][4][4] n(t,i): unit, pointing out of the cell, 0 where the face has no area. The fourth is 1 + f(t,i),
     * the number of this face in the neighbour (0 outside), negative in imaginary cells. */
    float *normal;

    /* [n_cell][4] g(t), and g^(t): the scalar at x is dot(g, x) + g^. A cell without volume, or so flat that its
     * gradient exceeds TC_PACK_PLANES_STEEP, holds the mean of its vertices; NaN where a vertex holds NaN. */
    float *scalar;

    /* [n_cell][4] a(t,i): the neighbour's index, -1 outside */
    int32_t *neighbour;

    double ms;
} tc_pack_planes;

#define TC_PACK_PLANES_STEEP 1e30

/* pack: of the same mesh. Errors: TC_E_MESH (more cells than the shader's 32 bits number faces of), TC_E_MEMORY.
 * Cost: O(cells), about 0.3 us a cell. */
tc_status tc_pack_planes_build(tc_pack_planes *out, const tc_mesh *mesh, const tc_pack *pack, tc_error *err);
void tc_pack_planes_finish(tc_pack_planes *planes);

#endif
