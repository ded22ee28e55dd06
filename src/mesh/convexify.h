/* convexify.h: imaginary tets between a mesh and its convex hull, so that rays cross gaps without leaving the mesh. */
#ifndef TC_MESH_CONVEXIFY_H
#define TC_MESH_CONVEXIFY_H

#include "mesh/boundary.h"

/* Adds imaginary tets (and Steiner points, which only they use) to a linked mesh that has none, by the helper
 * tetcast-convexify.
 *   boundary: of the real tets, borrowed
 *   limit_s:  time limit of the helper; 0: 120 s
 * The result is accepted only if TetGen left the boundary's points as they were, the points it added lie within the
 * mesh's bounds and belong to its cells, none of these has negative volume, every face but the outside's joins two
 * cells on opposite sides, the outside is one closed convex surface (up to 1e-7 of the diagonal), and real and
 * imaginary volumes add up to the hull's that TetGen made (to 1e-9). Otherwise the mesh stays as it is. Errors:
 * TC_E_WORKER (the helper is missing, died or took too long), TC_E_MESH (TetGen refused the boundary, or its result was
 * not accepted), TC_E_MEMORY. */
tc_status tc_mesh_convexify(tc_mesh *mesh, const tc_boundary *boundary, double limit_s, int threads, const tc_log *log,
                            tc_error *err);

/* Is one picture of so many pixels, 0 for more pictures, made sooner by peeling than after filling the gaps? By the size of the
 * boundary, which TetGen's time grows with, and by how often it lies behind itself. boundary: of mesh's real tets. Cost:
 * O(n_face). */
bool tc_mesh_peel_is_sooner(const tc_mesh *mesh, const tc_boundary *boundary, size_t pixels);

/* Takes the imaginary tets and Steiner points away again. */
void tc_mesh_strip(tc_mesh *mesh);

#endif
