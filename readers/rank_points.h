// rank_points.h: the order of points that decides how quadrilaterals are cut.
#ifndef TC_READERS_RANK_POINTS_H
#define TC_READERS_RANK_POINTS_H

#include "cell_types.h"
#include "tets.h"

namespace tetcast
{

// Gives coinciding points (equal coordinates, bit by bit) the rank of the first of them, so that blocks whose points
// lie on each other cut their common faces alike. Cost: O(n) time, 16 bytes a point of scratch.
void rank_points(Tets &out);

// Two colours for the ends of each edge of the hexahedra; points of the first colour come first in rank. Where this
// succeeds (all structured grids, most others) every hexahedron has five tets instead of six. Any order is conforming:
// an edge that cannot have two colours is passed over.
class EdgeColours
{
  public:
    explicit EdgeColours(const Tets &tets);
    void add_cell(const Tets &tets, Shape shape,
                  const int32_t *corner); // edges of a hexahedron or voxel; others nothing
    void apply(Tets &tets);

  private:
    std::vector<int32_t> parent; // union-find
    std::vector<uint8_t> odd;    // colour differs from the parent's
    int32_t root_of(int32_t v, uint8_t &parity);
};

} // namespace tetcast
#endif
