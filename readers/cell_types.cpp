// cell_types.cpp: the table of VTK's cell types (numbers: vtkCellType.h) and of the faces of the linear shapes.
#include "cell_types.h"

#include <cstddef>

namespace tetcast
{

static const CellType table[] = {
    {0, "empty", 0, Shape::none, false},
    {1, "vertex", 0, Shape::none, false},
    {2, "poly_vertex", 0, Shape::none, false},
    {3, "line", 1, Shape::none, false},
    {4, "poly_line", 1, Shape::none, false},
    {5, "triangle", 2, Shape::none, false},
    {6, "triangle_strip", 2, Shape::none, false},
    {7, "polygon", 2, Shape::none, false},
    {8, "pixel", 2, Shape::none, false},
    {9, "quad", 2, Shape::none, false},
    {10, "tetra", 3, Shape::tetra, false},
    {11, "voxel", 3, Shape::voxel, false},
    {12, "hexahedron", 3, Shape::hexahedron, false},
    {13, "wedge", 3, Shape::wedge, false},
    {14, "pyramid", 3, Shape::pyramid, false},
    {15, "pentagonal_prism", 3, Shape::pentagonal_prism, false},
    {16, "hexagonal_prism", 3, Shape::hexagonal_prism, false},
    {21, "quadratic_edge", 1, Shape::none, true},
    {22, "quadratic_triangle", 2, Shape::none, true},
    {23, "quadratic_quad", 2, Shape::none, true},
    {24, "quadratic_tetra", 3, Shape::tetra, true},
    {25, "quadratic_hexahedron", 3, Shape::hexahedron, true},
    {26, "quadratic_wedge", 3, Shape::wedge, true},
    {27, "quadratic_pyramid", 3, Shape::pyramid, true},
    {28, "biquadratic_quad", 2, Shape::none, true},
    {29, "triquadratic_hexahedron", 3, Shape::hexahedron, true},
    {30, "quadratic_linear_quad", 2, Shape::none, true},
    {31, "quadratic_linear_wedge", 3, Shape::wedge, true},
    {32, "biquadratic_quadratic_wedge", 3, Shape::wedge, true},
    {33, "biquadratic_quadratic_hexahedron", 3, Shape::hexahedron, true},
    {34, "biquadratic_triangle", 2, Shape::none, true},
    {35, "cubic_line", 1, Shape::none, true},
    {36, "quadratic_polygon", 2, Shape::none, true},
    {37, "triquadratic_pyramid", 3, Shape::pyramid, true},
    {41, "convex_point_set", 3, Shape::points, false},
    {42, "polyhedron", 3, Shape::polyhedron, false},
    {60, "higher_order_edge", 1, Shape::none, true},
    {61, "higher_order_triangle", 2, Shape::none, true},
    {62, "higher_order_quad", 2, Shape::none, true},
    {63, "higher_order_polygon", 2, Shape::none, true},
    {64, "higher_order_tetrahedron", 3, Shape::tetra, true},
    {65, "higher_order_wedge", 3, Shape::wedge, true},
    {66, "higher_order_pyramid", 3, Shape::pyramid, true},
    {67, "higher_order_hexahedron", 3, Shape::hexahedron, true},
    {68, "lagrange_curve", 1, Shape::none, true},
    {69, "lagrange_triangle", 2, Shape::none, true},
    {70, "lagrange_quadrilateral", 2, Shape::none, true},
    {71, "lagrange_tetrahedron", 3, Shape::tetra, true},
    {72, "lagrange_hexahedron", 3, Shape::hexahedron, true},
    {73, "lagrange_wedge", 3, Shape::wedge, true},
    {74, "lagrange_pyramid", 3, Shape::pyramid, true},
    {75, "bezier_curve", 1, Shape::none, true},
    {76, "bezier_triangle", 2, Shape::none, true},
    {77, "bezier_quadrilateral", 2, Shape::none, true},
    {78, "bezier_tetrahedron", 3, Shape::tetra, true},
    {79, "bezier_hexahedron", 3, Shape::hexahedron, true},
    {80, "bezier_wedge", 3, Shape::wedge, true},
    {81, "bezier_pyramid", 3, Shape::pyramid, true},
};

const CellType &cell_type(int vtk)
{
    static const CellType unknown = {-1, "unknown", -1, Shape::none, false};
    for (const CellType &row : table)
        if (row.vtk == vtk)
            return row;
    return unknown;
}

int corner_count(Shape shape)
{
    switch (shape) {
    case Shape::tetra:
        return 4;
    case Shape::pyramid:
        return 5;
    case Shape::wedge:
        return 6;
    case Shape::hexahedron:
    case Shape::voxel:
        return 8;
    case Shape::pentagonal_prism:
        return 10;
    case Shape::hexagonal_prism:
        return 12;
    default:
        return 0;
    }
}

const std::vector<std::vector<int>> &shape_faces(Shape shape)
{
    using Faces = std::vector<std::vector<int>>;
    static const Faces tetra = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 2, 1}};
    static const Faces pyramid = {{0, 3, 2, 1}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    static const Faces wedge = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}};
    static const Faces hexahedron = {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4},
                                     {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}};
    static const Faces voxel = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    static const Faces pentagonal = {{0, 4, 3, 2, 1}, {5, 6, 7, 8, 9}, {0, 1, 6, 5}, {1, 2, 7, 6},
                                     {2, 3, 8, 7},    {3, 4, 9, 8},    {4, 0, 5, 9}};
    static const Faces hexagonal = {{0, 5, 4, 3, 2, 1}, {6, 7, 8, 9, 10, 11}, {0, 1, 7, 6},   {1, 2, 8, 7},
                                    {2, 3, 9, 8},       {3, 4, 10, 9},        {4, 5, 11, 10}, {5, 0, 6, 11}};
    static const Faces none;
    switch (shape) {
    case Shape::tetra:
        return tetra;
    case Shape::pyramid:
        return pyramid;
    case Shape::wedge:
        return wedge;
    case Shape::hexahedron:
        return hexahedron;
    case Shape::voxel:
        return voxel;
    case Shape::pentagonal_prism:
        return pentagonal;
    case Shape::hexagonal_prism:
        return hexagonal;
    default:
        return none;
    }
}

} // namespace tetcast
