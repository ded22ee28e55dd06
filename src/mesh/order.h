/* order.h: cells and vertices along a Hilbert curve, so that neighbours in space are neighbours in memory. */
#ifndef TC_MESH_ORDER_H
#define TC_MESH_ORDER_H

#include "mesh/mesh.h"

/* Position of cell (x, y, z), 21 bits each, on a Hilbert curve through the 2^21 cube: 63 bits. One at a time, for tests of
 * what the order is made with. */
uint64_t tc_hilbert(uint32_t x, uint32_t y, uint32_t z);

/* Orders an unlinked mesh: vertices by position, tets by centroid; scalars and maps follow.
 * Errors: TC_E_MEMORY. Cost: O(n), threaded. */
tc_status tc_mesh_order(tc_mesh *mesh, int threads, tc_error *err);

/* Orders tets [n][4] by centroid (imaginary ones, which carry no data). Errors: TC_E_MEMORY. */
tc_status tc_tets_order(int32_t *tet, size_t n, const double *vertex, const double bounds[6], int threads,
                        tc_error *err);

/* xmin xmax ymin ymax zmin zmax of n points; zeros when n is 0. */
void tc_points_bounds(double bounds[6], const double *vertex, size_t n);

#endif
