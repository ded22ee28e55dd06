/* line.h: what a line meets of a mesh: its part in each real cell. */
#ifndef TC_PROBE_LINE_H
#define TC_PROBE_LINE_H

#include "mesh/mesh.h"

/* What of a line lies in one cell. */
typedef struct tc_line_part {
    double t[2], s[2]; /* distances from the line's origin, t[0] < t[1], and the scalars there; both NaN: one of the
                          cell's is not finite */
    double length;     /* t[1] - t[0], of more digits where the origin is far away */
    uint32_t tet;
} tc_line_part;

/* Parts of the line origin + t direction (unit) with range[0] <= t <= range[1], by t[0], then t[1], then tet. Each cell
 * is judged alone by exact signs: of a line through an edge or a vertex no cell is lost or met twice, and two cells
 * with a common face that it passes have one t there, to the last bit.
 *   out      [*n], free(); NULL where n is 0
 *   mesh     prepared; its real cells
 *   threads  0: all cores; the same bits with any number
 * Errors: TC_E_MEMORY. Cost: O(vertices + tets), 1 byte a vertex. */
tc_status tc_line_meet(tc_line_part **out, size_t *n, const tc_mesh *mesh, const double origin[3],
                       const double direction[3], const double range[2], int threads, tc_error *err);

#endif
