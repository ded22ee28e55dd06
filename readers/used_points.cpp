// used_points.cpp: the points that the tets of a file will hold, told from its cells without splitting them.
#include "survey.h"

#include "cell_types.h"

#include <vtkCellArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace tetcast
{

namespace
{

// Of the cell's size cubed: a volume above it is not a rounding error, whatever the order of the tet's corners.
constexpr double sure_volume = 1e-14;

using Corners = std::array<int, 4>;

// Every tet that a cell of this shape may be cut into (split_cells.cpp: cones from any corner over triangles of the
// faces that do not touch it, each cut from any of its corners; a hexahedron also into five), once each, all of one
// orientation.
std::vector<Corners> possible_tets(Shape shape)
{
    std::vector<Corners> all;
    std::set<Corners> seen;
    const auto add = [&](const Corners &t) {
        Corners sorted = t;
        std::sort(sorted.begin(), sorted.end());
        if (seen.insert(sorted).second)
            all.push_back(t);
    };
    for (int top = 0; top < corner_count(shape); top++)
        for (const std::vector<int> &face : shape_faces(shape)) {
            if (std::find(face.begin(), face.end(), top) != face.end())
                continue;
            const size_t m = face.size();
            for (size_t start = 0; start < m; start++)
                for (size_t i = 1; i + 1 < m; i++)
                    add({top, face[start], face[(start + i) % m], face[(start + i + 1) % m]});
        }
    if (shape == Shape::hexahedron) {
        add({0, 2, 7, 5});
        add({1, 3, 4, 6});
    } else if (shape == Shape::voxel) {
        add({0, 3, 6, 5});
        add({1, 2, 4, 7});
    }
    return all;
}

bool coincide(const double *a, const double *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

// Is every corner finite and in a place of its own? *size gets the cell's extent.
bool apart(double *size, const Tets &points, const int32_t *corner, int n)
{
    double lo[3], hi[3];
    *size = 0;
    for (int i = 0; i < n; i++) {
        const double *a = points.at(corner[i]);
        for (int k = 0; k < 3; k++) {
            if (!std::isfinite(a[k]))
                return false;
            lo[k] = i == 0 ? a[k] : std::min(lo[k], a[k]);
            hi[k] = i == 0 ? a[k] : std::max(hi[k], a[k]);
        }
        for (int j = 0; j < i; j++)
            if (corner[j] == corner[i] || coincide(a, points.at(corner[j])))
                return false;
    }
    for (int k = 0; k < 3; k++)
        *size = std::max(*size, hi[k] - lo[k]);
    return true;
}

// Has the cell tets of one sign alone, however it is cut?
bool unfolded(const std::vector<Corners> &tets, const Tets &points, const int32_t *corner, int n, double size)
{
    const double least = sure_volume * size * size * size;
    double x[12][3], low = INFINITY, high = -INFINITY;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++)
            x[i][k] = points.at(corner[i])[k];
    for (const Corners &t : tets) {
        const double *a = x[t[0]], *b = x[t[1]], *c = x[t[2]], *d = x[t[3]];
        const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
        const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
        const double wx = d[0] - a[0], wy = d[1] - a[1], wz = d[2] - a[2];
        const double v = (uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz;
        low = v < low ? v : low;
        high = v > high ? v : high;
    }
    return low > least || high < -least;
}

} // namespace

bool find_used(std::vector<int32_t> &used, const Tets &points, const Gathered &data, int refine)
{
    std::map<Shape, std::vector<Corners>> tets;
    std::vector<char> mark(points.n_file_point, 0);
    vtkNew<vtkIdList> list;
    if (refine > 0 && data.n_curved > 0)
        return false;
    for (const Leaf &leaf : data.leaf) {
        vtkUnstructuredGrid *grid = vtkUnstructuredGrid::SafeDownCast(leaf.data);
        const vtkIdType n_cell = leaf.data->GetNumberOfCells();
        int last = -1;
        const CellType *type = nullptr;
        const std::vector<Corners> *possible = nullptr;
        for (vtkIdType c = 0; c < n_cell; c++) {
            const int vtk = leaf.data->GetCellType(c);
            if (!type || vtk != last) {
                type = &cell_type(last = vtk);
                if (type->dimension == 3) {
                    const auto made = tets.find(type->shape);
                    possible = made != tets.end() ? &made->second : &(tets[type->shape] = possible_tets(type->shape));
                }
            }
            if (type->dimension != 3 || is_ghost(leaf, (size_t)c))
                continue;
            const int n = corner_count(type->shape);
            if (n == 0)
                return false; // polyhedra and point sets
            vtkIdType m = 0;
            const vtkIdType *id = nullptr;
            if (grid) {
                grid->GetCells()->GetCellAtId(c, m, id);
            } else {
                leaf.data->GetCellPoints(c, list);
                m = list->GetNumberOfIds();
                id = list->GetPointer(0);
            }
            if (m < n)
                return false;
            int32_t corner[12];
            for (int k = 0; k < n; k++)
                corner[k] = (int32_t)(leaf.first_point + (size_t)id[k]);
            double size;
            if (!apart(&size, points, corner, n) ||
                (type->shape != Shape::tetra && !unfolded(*possible, points, corner, n, size)))
                return false;
            for (int k = 0; k < n; k++)
                mark[(size_t)corner[k]] = 1;
        }
    }
    used.clear();
    for (size_t i = 0; i < mark.size(); i++)
        if (mark[i])
            used.push_back((int32_t)i);
    return true;
}

} // namespace tetcast
