// surface.cpp: the triangles and lines that a file's cells of dimension 2 and 1 make.
#include "surface.h"

#include "cell_types.h"

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <cmath>

namespace tetcast
{

static std::string counted(size_t n, const char *one, const char *many)
{
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

// ------------------------------------------------------------------------------------------------ checks

// kind: "polygon", for sentences.
static void check_list(const std::string &path, const char *kind, vtkCellArray *cells, size_t n_point)
{
    if (!cells)
        return;
    const vtkIdType n = cells->GetNumberOfCells();
    const double size = (double)cells->GetConnectivityArray()->GetNumberOfTuples();
    vtkDataArray *offset = cells->GetOffsetsArray();
    double last = 0;
    for (vtkIdType i = 0; i <= n && n > 0; i++) {
        const double at = offset->GetComponent(i, 0);
        if (!(at >= last && at <= size))
            throw Refusal(path + ": the offset of " + kind + " " + std::to_string(i) +
                          " is out of order or past the end of the connectivity; the file is damaged");
        last = at;
    }
    for (vtkIdType i = 0; i < n; i++) {
        vtkIdType m;
        const vtkIdType *id;
        cells->GetCellAtId(i, m, id);
        for (vtkIdType k = 0; k < m; k++)
            if (id[k] < 0 || (size_t)id[k] >= n_point)
                throw Refusal(path + ": " + kind + " " + std::to_string(i) + " refers to point " +
                              std::to_string(id[k]) + ", but there are " + std::to_string(n_point) +
                              " points; the file is damaged");
    }
}

void check_surface_cells(const Leaf &leaf, const std::string &path)
{
    const size_t n_point = (size_t)leaf.data->GetNumberOfPoints();
    if (vtkPolyData *poly = vtkPolyData::SafeDownCast(leaf.data)) {
        check_list(path, "vertex cell", poly->GetVerts(), n_point);
        check_list(path, "line", poly->GetLines(), n_point);
        check_list(path, "polygon", poly->GetPolys(), n_point);
        check_list(path, "strip", poly->GetStrips(), n_point);
    } else if (vtkUnstructuredGrid *grid = vtkUnstructuredGrid::SafeDownCast(leaf.data)) {
        check_list(path, "cell", grid->GetCells(), n_point);
    }
}

// ------------------------------------------------------------------------------------------------ cells

namespace
{

// Triangles and lines by the file's point numbers.
struct Splitter {
    std::vector<int64_t> triangle, line;
    size_t n_flat = 0;   // polygons of which nothing came
    size_t n_short = 0;  // cells with too few points
    size_t n_curved = 0; // made linear by their corners

    vtkNew<vtkIdList> id, piece;
    vtkNew<vtkPoints> place;
    vtkNew<vtkGenericCell> cell;

    void add(const Leaf &leaf, vtkIdType number);

  private:
    void add_corners(const Leaf &leaf, bool curve, bool four);
    void add_by_vtk(const Leaf &leaf, vtkIdType number, int dimension);
};

// Fewest points of a cell that VTK may be given; 0: such cells are taken by their corners.
size_t least_points(int vtk)
{
    switch (vtk) {
    case 3: // line
        return 2;
    case 5:  // triangle
    case 7:  // polygon
    case 21: // quadratic edge
        return 3;
    case 8:  // pixel
    case 9:  // quad
    case 35: // cubic line
        return 4;
    case 22: // quadratic triangle
    case 30: // quadratic linear quad
        return 6;
    case 34: // biquadratic triangle
        return 7;
    case 23: // quadratic quad
        return 8;
    case 28: // biquadratic quad
        return 9;
    default:
        return 0;
    }
}

void Splitter::add(const Leaf &leaf, vtkIdType number)
{
    const int vtk = leaf.data->GetCellType(number);
    const CellType &type = cell_type(vtk);
    if (type.dimension != 1 && type.dimension != 2)
        return;
    leaf.data->GetCellPoints(number, id);
    const size_t n = (size_t)id->GetNumberOfIds(), least = least_points(vtk);
    const auto at = [&](size_t i) { return (int64_t)leaf.first_point + id->GetId((vtkIdType)i); };
    if (n < (size_t)type.dimension + 1 || n < least) {
        n_short++;
    } else if (vtk == 3 || vtk == 4) {
        for (size_t i = 0; i + 1 < n; i++)
            line.insert(line.end(), {at(i), at(i + 1)});
    } else if (vtk == 5) {
        triangle.insert(triangle.end(), {at(0), at(1), at(2)});
    } else if (vtk == 6) {
        for (size_t i = 0; i + 2 < n; i++)
            triangle.insert(triangle.end(), {at(i), at(i + 1 + i % 2), at(i + 2 - i % 2)});
    } else if (least > 0) {
        add_by_vtk(leaf, number, type.dimension);
    } else {
        const std::string name = type.name;
        const bool four = name.find("quad") != std::string::npos && name.find("quadratic") == std::string::npos;
        if (name.find("polygon") != std::string::npos || (four && n < 4))
            n_short++;
        else
            add_corners(leaf, type.dimension == 1, four);
    }
}

void Splitter::add_corners(const Leaf &leaf, bool curve, bool four)
{
    const auto at = [&](vtkIdType i) { return (int64_t)leaf.first_point + id->GetId(i); };
    n_curved++;
    if (curve)
        line.insert(line.end(), {at(0), at(1)});
    else
        triangle.insert(triangle.end(), {at(0), at(1), at(2)});
    if (four)
        triangle.insert(triangle.end(), {at(0), at(2), at(3)});
}

void Splitter::add_by_vtk(const Leaf &leaf, vtkIdType number, int dimension)
{
    leaf.data->GetCell(number, cell);
    piece->Reset();
    place->Reset();
    cell->Triangulate(0, piece, place);
    const vtkIdType corners = dimension + 1, n = piece->GetNumberOfIds() / corners * corners;
    std::vector<int64_t> &list = dimension == 1 ? line : triangle;
    n_flat += n == 0;
    for (vtkIdType i = 0; i < n; i++)
        list.push_back((int64_t)leaf.first_point + piece->GetId(i));
}

// Marks what items (corners each) use, and leaves out those with a vertex that is not finite; gives how many these
// were.
size_t keep_finite(std::vector<int64_t> &item, size_t corners, const std::vector<double> &point,
                   std::vector<char> &used)
{
    size_t kept = 0;
    for (size_t i = 0; i < item.size(); i += corners) {
        bool finite = true;
        for (size_t k = 0; k < corners; k++)
            for (int c = 0; c < 3; c++)
                finite = finite && std::isfinite(point[3 * (size_t)item[i + k] + (size_t)c]);
        for (size_t k = 0; finite && k < corners; k++) {
            used[(size_t)item[i + k]] = 1;
            item[kept++] = item[i + k];
        }
    }
    const size_t lost = (item.size() - kept) / corners;
    item.resize(kept);
    return lost;
}

std::string kinds_of(const Gathered &data)
{
    std::string kinds;
    for (const auto &entry : data.by_type)
        kinds += (kinds.empty() ? "" : ", ") + std::to_string(entry.second) + " " + cell_type(entry.first).name;
    return kinds.empty() ? "no cells at all (is it cut short?)" : kinds;
}

} // namespace

void make_surface(Surface &out, const Gathered &data, const std::string &path)
{
    Splitter split;
    std::vector<double> point(3 * data.n_point);
    for (const Leaf &leaf : data.leaf) {
        const vtkIdType n = leaf.data->GetNumberOfCells(), n_point = leaf.data->GetNumberOfPoints();
        for (vtkIdType i = 0; i < n_point; i++)
            leaf.data->GetPoint(i, &point[3 * (leaf.first_point + (size_t)i)]);
        for (vtkIdType c = 0; c < n; c++)
            if (!is_ghost(leaf, (size_t)c))
                split.add(leaf, c);
    }
    if (split.triangle.empty() && split.line.empty())
        throw Refusal(path + " has no surface and no lines to draw; it holds " + kinds_of(data) +
                      (data.n_solid ? "; save its surface: in ParaView, Filters, Extract Surface" : ""));
    std::vector<char> used(data.n_point);
    const size_t lost = keep_finite(split.triangle, 3, point, used) + keep_finite(split.line, 2, point, used);
    if (split.triangle.empty() && split.line.empty())
        throw Refusal(path + ": each of its " + counted(lost, "triangle or line", "triangles and lines") +
                      " has a point that is not finite; the file is damaged");
    std::vector<int64_t> number(data.n_point);
    int64_t n_used = 0;
    for (size_t i = 0; i < data.n_point; i++)
        if (used[i]) {
            number[i] = n_used++;
            out.vertex.insert(out.vertex.end(), &point[3 * i], &point[3 * i] + 3);
        }
    if (n_used > INT32_MAX)
        throw Refusal(path + ": its surface has " + std::to_string(n_used) + " points, more than 2147483647");
    out.triangle.reserve(split.triangle.size());
    for (int64_t v : split.triangle)
        out.triangle.push_back((int32_t)number[(size_t)v]);
    out.line.reserve(split.line.size());
    for (int64_t v : split.line)
        out.line.push_back((int32_t)number[(size_t)v]);

    if (lost)
        out.notes.push_back(counted(lost, "triangle or line with a point that is not finite was",
                                    "triangles and lines with a point that is not finite were") +
                            " left out");
    if (split.n_flat)
        out.notes.push_back(counted(split.n_flat, "polygon", "polygons") +
                            " could not be split into triangles and left out");
    if (split.n_short)
        out.notes.push_back(counted(split.n_short, "line or polygon has", "lines and polygons have") +
                            " too few points and left out");
    if (split.n_curved)
        out.notes.push_back(counted(split.n_curved, "cell of higher order was", "cells of higher order were") +
                            " made linear by their corners");
}

} // namespace tetcast
