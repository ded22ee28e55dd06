// split_mesh.cpp: all cells of all blocks into one list of tets.
#include "split_mesh.h"

#include "cell_types.h"
#include "rank_points.h"
#include "refine_quadratic.h"
#include "split_cells.h"

#include <vtkCellArray.h>
#include <vtkConvexPointSet.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

#include <algorithm>

namespace tetcast
{

namespace
{

constexpr size_t progress_every = 1 << 12;

void split_face_stream(Tets &out, const Leaf &leaf, vtkUnstructuredGrid *grid, size_t c)
{
    vtkIdType n_face = 0;
    const vtkIdType *stream = nullptr;
    grid->GetFaceStream((vtkIdType)c, n_face, stream);
    std::vector<std::vector<int32_t>> face;
    for (vtkIdType f = 0; f < n_face; f++) {
        const vtkIdType n = *stream++;
        face.emplace_back();
        for (vtkIdType i = 0; i < n; i++) {
            const vtkIdType id = *stream++;
            if (id < 0 || id >= grid->GetNumberOfPoints())
                throw Refusal("cell " + std::to_string(leaf.first_cell + c) + ", a polyhedron, refers to point " +
                              std::to_string(id) + ", but there are " + std::to_string(grid->GetNumberOfPoints()) +
                              " points; the file is damaged");
            face.back().push_back((int32_t)(leaf.first_point + (size_t)id));
        }
    }
    split_polyhedral_cell(out, (int64_t)(leaf.first_cell + c), face);
}

// A convex point set has no faces of its own: VTK's ordered Delaunay triangulation, which neighbours share.
void split_point_set(Tets &out, const Leaf &leaf, size_t c)
{
    vtkCell *cell = leaf.data->GetCell((vtkIdType)c);
    vtkNew<vtkIdList> ids;
    vtkNew<vtkPoints> points;
    if (!cell || !cell->Triangulate(0, ids, points)) {
        out.refused_cells++;
        return;
    }
    for (vtkIdType i = 0; i + 3 < ids->GetNumberOfIds(); i += 4) {
        int32_t v[4];
        for (int k = 0; k < 4; k++)
            v[k] = (int32_t)(leaf.first_point + (size_t)ids->GetId(i + k));
        out.add_tet((int64_t)(leaf.first_cell + c), v[0], v[1], v[2], v[3]);
    }
}

// The corners of cell c; number is a list to work with.
void corners_of(int32_t *corner, const Leaf &leaf, vtkUnstructuredGrid *grid, size_t c, Shape shape, vtkIdList *number)
{
    vtkIdType n = 0;
    const vtkIdType *id = nullptr;
    if (grid) {
        grid->GetCells()->GetCellAtId((vtkIdType)c, n, id);
    } else {
        leaf.data->GetCellPoints((vtkIdType)c, number);
        id = number->GetPointer(0);
    }
    for (int k = 0; k < corner_count(shape); k++)
        corner[k] = (int32_t)(leaf.first_point + (size_t)id[k]);
}

// Calls visit(leaf, grid or NULL, cell, type) for every cell of dimension 3.
template <class Visit> void for_each_solid(const Gathered &data, VtkTalk &talk, const char *what, Visit visit)
{
    for (const Leaf &leaf : data.leaf) {
        vtkUnstructuredGrid *grid = vtkUnstructuredGrid::SafeDownCast(leaf.data);
        const size_t n = (size_t)leaf.data->GetNumberOfCells();
        for (size_t c = 0; c < n; c++) {
            if (c % progress_every == 0)
                talk.progress(what, (double)(leaf.first_cell + c) / (double)data.n_cell);
            const CellType &type = cell_type(leaf.data->GetCellType((vtkIdType)c));
            if (type.dimension == 3 && !is_ghost(leaf, c))
                visit(leaf, grid, c, type);
        }
    }
}

} // namespace

int split_mesh(Tets &out, const Gathered &data, int refine, std::vector<std::string> &notes, VtkTalk &talk)
{
    gather_points(out, data);
    bool only_tets = true;
    size_t n_fixed = 0; // cells that cannot be refined
    for (const auto &entry : data.by_type) {
        const CellType &type = cell_type(entry.first);
        only_tets = only_tets && (type.dimension < 3 || type.shape == Shape::tetra);
        n_fixed += type.dimension == 3 && !Refiner::can(type) ? entry.second : 0;
    }
    if (refine > 0 && data.n_curved == 0) {
        notes.push_back("no cell is curved, so nothing was refined");
        refine = 0;
    }
    if (refine > 0 && n_fixed > 0)
        notes.push_back(std::to_string(n_fixed) +
                        " cells of types that cannot be refined stay as they are; their faces do "
                        "not match refined neighbours");
    vtkNew<vtkIdList> number;
    if (!only_tets || refine > 0)
        rank_points(out);
    if (!only_tets) {
        EdgeColours colours(out);
        for_each_solid(data, talk, "colouring edges",
                       [&](const Leaf &leaf, vtkUnstructuredGrid *grid, size_t c, const CellType &type) {
                           int32_t corner[12];
                           if (type.shape != Shape::hexahedron && type.shape != Shape::voxel)
                               return;
                           corners_of(corner, leaf, grid, c, type.shape, number);
                           colours.add_cell(out, type.shape, corner);
                       });
        colours.apply(out);
    }
    const size_t per_cell = (only_tets ? 1 : 5);
    if (refine == 0) {
        out.tet.reserve(4 * data.n_solid * per_cell);
        out.cell.reserve(data.n_solid * per_cell);
    }
    Refiner refiner(out, refine);
    for_each_solid(data, talk, "splitting cells",
                   [&](const Leaf &leaf, vtkUnstructuredGrid *grid, size_t c, const CellType &type) {
                       const int64_t id = (int64_t)(leaf.first_cell + c);
                       const size_t turned = out.turned_cells, folded = out.folded_cells, centred = out.centred_cells;
                       const size_t told = out.open_cells + out.refused_cells, made = out.cell.size();
                       int32_t corner[12];
                       if (type.shape == Shape::polyhedron) {
                           split_face_stream(out, leaf, grid, c);
                       } else if (type.shape == Shape::points) {
                           split_point_set(out, leaf, c);
                       } else if (refine > 0 && Refiner::can(type)) {
                           refiner.add(id, type, leaf.data->GetCell((vtkIdType)c), leaf.first_point);
                       } else {
                           corners_of(corner, leaf, grid, c, type.shape, number);
                           split_cell(out, id, type.shape, corner);
                       }
                       // Parts of one cell count once.
                       out.turned_cells = std::min(out.turned_cells, turned + 1);
                       out.folded_cells = std::min(out.folded_cells, folded + 1);
                       out.centred_cells = std::min(out.centred_cells, centred + 1);
                       out.empty_cells += out.cell.size() == made && out.open_cells + out.refused_cells == told;
                   });
    return refine;
}

std::vector<int32_t> compact_points(Tets &tets)
{
    std::vector<int32_t> number(tets.n_point(), -1), used;
    for (int32_t v : tets.tet)
        number[(size_t)v] = 0;
    for (size_t i = 0; i < number.size(); i++)
        if (number[i] == 0) {
            number[i] = (int32_t)used.size();
            used.push_back((int32_t)i);
        }
    for (int32_t &v : tets.tet)
        v = number[(size_t)v];
    return used;
}

LostPoints count_lost_points(const Tets &tets, const Gathered &data, const std::vector<int32_t> &used)
{
    LostPoints lost;
    std::vector<char> in_use(data.n_point, 0), rank_in_use(tets.n_point(), 0);
    size_t n_used = 0;
    for (int32_t v : used) {
        rank_in_use[(size_t)tets.rank[(size_t)v]] = 1;
        if ((size_t)v < data.n_point)
            in_use[(size_t)v] = 1, n_used++;
    }
    if (n_used == data.n_point)
        return lost;
    std::vector<char> in_cell(data.n_point, 0);
    vtkNew<vtkIdList> list;
    for (const Leaf &leaf : data.leaf) {
        vtkUnstructuredGrid *grid = vtkUnstructuredGrid::SafeDownCast(leaf.data);
        const vtkIdType n = leaf.data->GetNumberOfCells();
        for (vtkIdType c = 0; c < n; c++) {
            vtkIdType m = 0;
            const vtkIdType *id = nullptr;
            if (grid) {
                grid->GetCells()->GetCellAtId(c, m, id);
            } else {
                leaf.data->GetCellPoints(c, list);
                m = list->GetNumberOfIds(), id = list->GetPointer(0);
            }
            for (vtkIdType i = 0; i < m; i++)
                in_cell[leaf.first_point + (size_t)id[i]] = 1;
        }
    }
    for (size_t v = 0; v < data.n_point; v++)
        if (!in_cell[v])
            lost.unused++;
        else if (!in_use[v] && rank_in_use[(size_t)tets.rank[v]])
            lost.merged++;
    return lost;
}

} // namespace tetcast
