// split_polyhedron.h: one polyhedron, convex or not, into tets that fill exactly its volume.
#ifndef TC_READERS_SPLIT_POLYHEDRON_H
#define TC_READERS_SPLIT_POLYHEDRON_H

#include <array>
#include <vector>

namespace tetcast
{

struct Polyhedron {
    std::vector<std::array<double, 3>> point;
    std::vector<int> rank;              // [points] distinct for distinct places; chooses diagonals
    std::vector<std::vector<int>> face; // indices into point, any orientation
    unsigned attempts = 48;             // orders of cutting to try before giving up
};

struct PolyhedronTets {
    std::vector<std::array<int, 4>> tet;      // of non-negative volume; index >= points: added[index - points]
    std::vector<std::array<double, 3>> added; // points inside
};

enum class PolyhedronResult { ok, open, failed };

// open: an edge does not have exactly two faces. failed: no filling was found (or the faces cross each other).
// The triangles of a face depend on its points and ranks alone, not on the side it is seen from.
// Cost: O(faces) for a convex one, O(faces^3) at worst.
PolyhedronResult split_polyhedron(PolyhedronTets &out, const Polyhedron &in);

} // namespace tetcast
#endif
