/* repair.h: drops what cannot be rendered, merges what a file duplicated, turns every tet to positive volume. */
#ifndef TC_MESH_REPAIR_H
#define TC_MESH_REPAIR_H

#include "mesh/mesh.h"

/* Makes vertex, tet, scalar, the two maps and the repair counts of out from in (arrays as given; not changed).
 * Every array of out that this sets is new and owned by out; out comes zeroed and is to be finished by the caller
 * with tc_mesh_finish_arrays whether this succeeds or not. In this order:
 *   tets that repeat a vertex, and tets with a non-finite vertex, are dropped;
 *   points with equal coordinates (-0 is 0) are merged when their point data agree too (equal, or both NaN). Where the
 *   data differ along a seam of duplicated points, merging would change the picture: they stay apart, and
 *   their faces are boundary;
 *   tets that repeat a vertex by that are dropped; points that no tet uses are dropped;
 *   tets of negative volume (exact sign) get vertices 2 and 3 swapped; tets of zero volume stay.
 * Errors: TC_E_MEMORY, TC_E_MESH (no tet is left; says why). Cost: O(n), threaded; the result does not depend on the threads. */
tc_status tc_mesh_repair(tc_mesh *out, const tc_mesh *in, int threads, tc_error *err);

/* Drops the tets with drop[t] != 0 (of an unlinked mesh without imaginary tets) and updates tet_of_source. */
void tc_mesh_drop_tets(tc_mesh *mesh, const uint8_t *drop);

/* Frees vertex, tet, neighbour, scalar and the two maps, and nulls them. */
void tc_mesh_finish_arrays(tc_mesh *mesh);

#endif
