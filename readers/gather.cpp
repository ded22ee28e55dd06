// gather.cpp: all blocks that a reader gave, as one list of points and cells.
#include "gather.h"

#include "cell_types.h"

#include <vtkCellArray.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataSetAttributes.h>
#include <vtkIdList.h>
#include <vtkInformation.h>
#include <vtkInformationStringKey.h>
#include <vtkNew.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

namespace tetcast
{

static void add_leaf(Gathered &out, vtkDataObject *object, unsigned block, const char *name)
{
    vtkDataSet *data = vtkDataSet::SafeDownCast(object);
    if (!data || data->GetNumberOfPoints() == 0)
        return;
    out.leaf.push_back({data, out.n_point, out.n_cell, block, name ? name : ""});
    out.n_point += (size_t)data->GetNumberOfPoints();
    out.n_cell += (size_t)data->GetNumberOfCells();
}

// Gives the index behind the last leaf, where the root's is base.
static unsigned add_leaves(Gathered &out, vtkDataObject *data, unsigned base)
{
    vtkCompositeDataSet *composite = vtkCompositeDataSet::SafeDownCast(data);
    unsigned last = 0;
    if (!composite) {
        add_leaf(out, data, base, nullptr);
        return base + 1;
    }
    vtkSmartPointer<vtkCompositeDataIterator> it;
    it.TakeReference(composite->NewIterator());
    it->SkipEmptyNodesOff(); // they count
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem()) {
        last = it->GetCurrentFlatIndex();
        const char *name =
            it->HasCurrentMetaData() ? it->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME()) : nullptr;
        add_leaf(out, it->GetCurrentDataObject(), base + last, name);
    }
    return base + last + 1;
}

void gather_leaves(Gathered &out, const std::vector<vtkSmartPointer<vtkDataObject>> &data)
{
    unsigned base = data.size() > 1;
    for (const auto &object : data)
        base = add_leaves(out, object, base);
}

bool is_ghost(const Leaf &leaf, size_t cell)
{
    vtkUnsignedCharArray *ghost = leaf.data->GetCellGhostArray();
    if (!ghost || (size_t)ghost->GetNumberOfTuples() <= cell)
        return false;
    const int skip = vtkDataSetAttributes::DUPLICATECELL | vtkDataSetAttributes::HIDDENCELL;
    return (ghost->GetValue((vtkIdType)cell) & skip) != 0;
}

static void check_cell(const std::string &path, size_t cell, const CellType &type, vtkIdType n, const vtkIdType *id,
                       size_t n_point)
{
    if (type.dimension == 3 && n < corner_count(type.shape))
        throw Refusal(path + ": cell " + std::to_string(cell) + " is a " + type.name + " with " + std::to_string(n) +
                      " points instead of " + std::to_string(corner_count(type.shape)) + "; the file is damaged");
    for (vtkIdType i = 0; i < n; i++)
        if (id[i] < 0 || (size_t)id[i] >= n_point)
            throw Refusal(path + ": cell " + std::to_string(cell) + " refers to point " + std::to_string(id[i]) +
                          ", but there are " + std::to_string(n_point) + " points; the file is damaged");
}

// The lists of an unstructured grid must agree with each other before any cell is asked for.
static void check_lists(const std::string &path, vtkUnstructuredGrid *grid)
{
    vtkCellArray *cells = grid->GetCells();
    if (!cells)
        return;
    const vtkIdType n = cells->GetNumberOfCells();
    if (!grid->GetCellTypesArray() || grid->GetCellTypesArray()->GetNumberOfTuples() < n)
        throw Refusal(path + " has fewer cell types than cells; the file is damaged");
    vtkDataArray *offset = cells->GetOffsetsArray();
    const double size = (double)cells->GetConnectivityArray()->GetNumberOfTuples();
    double last = 0;
    for (vtkIdType i = 0; i <= n; i++) {
        const double at = offset->GetComponent(i, 0);
        if (at < last || at > size)
            throw Refusal(path + ": the offset of cell " + std::to_string(i) +
                          " is out of order or past the end of the "
                          "connectivity; the file is damaged");
        last = at;
    }
}

void count_cells(Gathered &out, const std::string &path)
{
    for (const Leaf &leaf : out.leaf) {
        vtkUnstructuredGrid *grid = vtkUnstructuredGrid::SafeDownCast(leaf.data);
        const size_t n_point = (size_t)leaf.data->GetNumberOfPoints();
        vtkNew<vtkIdList> list;
        if (grid)
            check_lists(path, grid);
        const size_t n = (size_t)leaf.data->GetNumberOfCells();
        const bool explicit_cells = grid || leaf.data->IsA("vtkPolyData");
        for (size_t c = 0; c < n; c++) {
            if (is_ghost(leaf, c)) {
                out.n_ghost++;
                continue;
            }
            const int vtk = leaf.data->GetCellType((vtkIdType)c);
            const CellType &type = cell_type(vtk);
            if (vtk == 0 && !explicit_cells) { // a blanked cell of a structured grid
                out.n_ghost++;
                continue;
            }
            out.by_type[vtk]++;
            out.n_solid += type.dimension == 3;
            out.n_curved += type.dimension == 3 && type.curved;
            if (grid) {
                vtkIdType m;
                const vtkIdType *id;
                grid->GetCells()->GetCellAtId((vtkIdType)c, m, id);
                check_cell(path, leaf.first_cell + c, type, m, id, n_point);
                if (vtk == 0 && m > 0)
                    throw Refusal(path + ": cell " + std::to_string(leaf.first_cell + c) + " has " + std::to_string(m) +
                                  " points but no type; the file is damaged or cut short");
            }
        }
    }
}

void gather_points(Tets &out, const Gathered &from)
{
    if (from.n_point > (size_t)INT32_MAX)
        throw Refusal("the file holds " + std::to_string(from.n_point) + " points, more than 2147483647");
    out.point.resize(3 * from.n_point);
    out.rank.resize(from.n_point);
    out.n_file_point = from.n_point;
    for (const Leaf &leaf : from.leaf) {
        const size_t n = (size_t)leaf.data->GetNumberOfPoints();
        double *x = &out.point[3 * leaf.first_point];
        for (size_t i = 0; i < n; i++)
            leaf.data->GetPoint((vtkIdType)i, x + 3 * i);
    }
    for (size_t i = 0; i < from.n_point; i++)
        out.rank[i] = (int32_t)i;
}

} // namespace tetcast
