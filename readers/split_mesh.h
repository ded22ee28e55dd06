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

} // namespace tetcast
#endif
