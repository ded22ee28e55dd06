// split_mesh.h: all cells of all blocks into one list of tets.
#ifndef TC_READERS_SPLIT_MESH_H
#define TC_READERS_SPLIT_MESH_H

#include "gather.h"
#include "vtk_talk.h"

namespace tetcast
{

// Fills out from data. refine: levels of 1:8 splitting when the data hold curved cells. Gives the levels applied.
int split_mesh(Tets &out, const Gathered &data, int refine, std::vector<std::string> &notes, VtkTalk &talk);

// Numbers the points that tets use 0, 1, … in their order and renumbers the tets; gives the old numbers.
std::vector<int32_t> compact_points(Tets &tets);

// The file's points that no tet uses, but for those that cells of other kinds or curved ones hold.
struct LostPoints {
    size_t unused = 0; // no cell of any kind names them
    size_t merged = 0; // a point in use lies at the same place, and a cell took that one instead
};
// used: from compact_points. Cost: nothing when all points are used, else once through the cells.
LostPoints count_lost_points(const Tets &tets, const Gathered &data, const std::vector<int32_t> &used);

} // namespace tetcast
#endif
