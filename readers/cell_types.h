// cell_types.h: what each VTK cell type is: its name, dimension, the linear shape of its corners.
#ifndef TC_READERS_CELL_TYPES_H
#define TC_READERS_CELL_TYPES_H

#include <array>
#include <vector>

namespace tetcast
{

enum class Shape {
    none,
    tetra,
    pyramid,
    wedge,
    hexahedron,
    voxel,
    pentagonal_prism,
    hexagonal_prism,
    polyhedron,
    points
};

struct CellType {
    int vtk;
    const char *name; // "quadratic_tetra"
    int dimension;    // -1: not known
    Shape shape;      // of its corner nodes, which come first; none for dimensions below 3
    bool curved;      // has nodes beyond its corners
};

// The row of a VTK cell type; a row named "unknown" for any other number.
const CellType &cell_type(int vtk);

// How many corners a shape has; 0 for polyhedron and points, which vary.
int corner_count(Shape shape);

// Faces of a shape, turned outwards for a cell of positive volume by VTK's numbering; empty where they vary.
// Source: the figures in VTK's documentation of each cell class.
const std::vector<std::vector<int>> &shape_faces(Shape shape);

} // namespace tetcast
#endif
