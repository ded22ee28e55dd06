// surface.h: the triangles and lines that a file's cells of dimension 2 and 1 make.
#ifndef TC_READERS_SURFACE_H
#define TC_READERS_SURFACE_H

#include "gather.h"

namespace tetcast
{

struct Surface {
    std::vector<double> vertex;          // [n][3] of those that triangles and lines use, in the file's order
    std::vector<int32_t> triangle, line; // [n][3], [n][2] vertex numbers; triangles wound as their cells are
    std::vector<std::string> notes;
};

// Cells with faces and lines of any kind: strips and polylines fall apart, quads and polygons are split by VTK (the
// shorter diagonal; ear cutting, as vtkTriangleFilter does), quadratic ones too, those of higher order by their
// corners. Cells of dimension 3 and 0 and ghosts are left out, as are triangles and lines with a point that is not
// finite (a note counts them). path is for sentences. Throws a Refusal where point numbers are out of range, or nothing
// is left. Cost: O(points + cells).
void make_surface(Surface &out, const Gathered &data, const std::string &path);

// Every list of point numbers of a leaf: in order, within its points. To be called before any cell is asked for.
void check_surface_cells(const Leaf &leaf, const std::string &path);

} // namespace tetcast
#endif
