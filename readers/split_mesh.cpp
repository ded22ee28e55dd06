// split_mesh.cpp: all cells of all blocks into one list of tets.
#include "split_mesh.h"

#include "cell_types.h"
#include "split_cells.h"

#include <vtkCellArray.h>
#include <vtkConvexPointSet.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>

namespace tetcast
{

namespace
{

constexpr size_t progress_every = 1 << 15;

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

} // namespace

int split_mesh(Tets &out, const Gathered &data, int refine, std::vector<std::string> &notes, VtkTalk &talk)
{
    (void)refine;
    (void)notes;
    gather_points(out, data);
    bool only_tets = true;
    for (const auto &entry : data.by_type)
        only_tets = only_tets && (cell_type(entry.first).dimension < 3 || cell_type(entry.first).shape == Shape::tetra);
    if (!only_tets)
        rank_points(out);
    out.tet.reserve(4 * data.n_solid * (only_tets ? 1 : 6));
    out.cell.reserve(data.n_solid * (only_tets ? 1 : 6));
    for (const Leaf &leaf : data.leaf) {
        vtkUnstructuredGrid *grid = vtkUnstructuredGrid::SafeDownCast(leaf.data);
        vtkNew<vtkIdList> list;
        const size_t n = (size_t)leaf.data->GetNumberOfCells();
        for (size_t c = 0; c < n; c++) {
            if (c % progress_every == 0)
                talk.progress("splitting cells", (double)(leaf.first_cell + c) / (double)data.n_cell);
            const CellType &type = cell_type(leaf.data->GetCellType((vtkIdType)c));
            if (type.dimension != 3 || is_ghost(leaf, c))
                continue;
            if (type.shape == Shape::polyhedron) {
                split_face_stream(out, leaf, grid, c);
                continue;
            }
            if (type.shape == Shape::points) {
                split_point_set(out, leaf, c);
                continue;
            }
            vtkIdType m = 0;
            const vtkIdType *id = nullptr;
            if (grid) {
                grid->GetCells()->GetCellAtId((vtkIdType)c, m, id);
            } else {
                leaf.data->GetCellPoints((vtkIdType)c, list);
                m = list->GetNumberOfIds();
                id = list->GetPointer(0);
            }
            int32_t corner[12];
            for (int k = 0; k < corner_count(type.shape); k++)
                corner[k] = (int32_t)(leaf.first_point + (size_t)id[k]);
            split_cell(out, (int64_t)(leaf.first_cell + c), type.shape, corner);
        }
    }
    return 0;
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

} // namespace tetcast
