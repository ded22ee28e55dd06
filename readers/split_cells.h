// split_cells.h: linear cells into conforming tets.
#ifndef TC_READERS_SPLIT_CELLS_H
#define TC_READERS_SPLIT_CELLS_H

#include "cell_types.h"
#include "tets.h"

namespace tetcast
{

// Splits one cell with faces of a fixed shape. id: its corner_count(shape) corners. A face is cut from its point of
// lowest rank, so that the neighbour cuts it alike. Cells that are not star-shaped from their lowest corner go to the
// polyhedron splitter; where that fails too the cell is folded: its tets are turned to positive volume and overlap.
void split_cell(Tets &out, int64_t cell_id, Shape shape, const int32_t *id);

// Splits a polyhedron. face: lists of point ids, in any orientation. Leaves it out (refused_cells) when it cannot be
// filled with tets of its own faces.
void split_polyhedral_cell(Tets &out, int64_t cell_id, const std::vector<std::vector<int32_t>> &face);

} // namespace tetcast
#endif
