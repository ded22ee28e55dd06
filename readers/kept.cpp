// kept.cpp: hashes of a file's points and cells, and of the tets they became.
#include "kept.h"

extern "C" {
#include "core/hash.h"
}

#include <vtkCellArray.h>
#include <vtkDataArray.h>
#include <vtkIdTypeArray.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkStructuredGrid.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

namespace tetcast
{

// The hash of what `before` stands for, followed by the bytes.
static uint64_t hash_bytes(uint64_t before, const void *data, size_t bytes)
{
    const tc_hash hash = tc_hash_bytes(data, bytes, before);
    return hash.word[0] ^ hash.word[1] * 3;
}

// NULL counts as an array of its own.
static bool hash_array(uint64_t &hash, vtkDataArray *array)
{
    int64_t head[3] = {-1, 0, 0};
    if (!array) {
        hash = hash_bytes(hash, head, sizeof head);
        return true;
    }
    if (!array->HasStandardMemoryLayout())
        return false;
    head[0] = array->GetDataType();
    head[1] = array->GetNumberOfTuples();
    head[2] = array->GetNumberOfComponents();
    hash = hash_bytes(hash, head, sizeof head);
    const size_t bytes = (size_t)(head[1] * head[2]) * (size_t)array->GetDataTypeSize();
    hash = hash_bytes(hash, bytes ? array->GetVoidPointer(0) : nullptr, bytes);
    return true;
}

bool hash_input(uint64_t &out, const Gathered &data)
{
    uint64_t hash = data.leaf.size();
    for (const Leaf &leaf : data.leaf) {
        vtkUnstructuredGrid *grid = vtkUnstructuredGrid::SafeDownCast(leaf.data);
        vtkStructuredGrid *structured = vtkStructuredGrid::SafeDownCast(leaf.data);
        vtkPointSet *set = vtkPointSet::SafeDownCast(leaf.data);
        if ((!grid && !structured) || !set->GetPoints())
            return false;
        bool good = hash_array(hash, set->GetPoints()->GetData()) && hash_array(hash, leaf.data->GetCellGhostArray()) &&
                    hash_array(hash, leaf.data->GetPointGhostArray());
        if (structured) {
            int extent[6];
            structured->GetExtent(extent);
            hash = hash_bytes(hash, extent, sizeof extent);
        } else {
            vtkCellArray *cells = grid->GetCells();
            good = good && hash_array(hash, grid->GetCellTypesArray()) &&
                   hash_array(hash, cells ? cells->GetOffsetsArray() : nullptr) &&
                   hash_array(hash, cells ? cells->GetConnectivityArray() : nullptr) &&
                   hash_array(hash, grid->GetFaces()) && hash_array(hash, grid->GetFaceLocations());
        }
        if (!good)
            return false;
    }
    out = hash;
    return true;
}

std::vector<double> SplitFile::vertices() const
{
    std::vector<double> out(3 * used.size());
    for (size_t i = 0; i < used.size(); i++)
        for (size_t k = 0; k < 3; k++)
            out[3 * i + k] = tets.at(used[i])[k];
    return out;
}

void hash_split(SplitFile &split, const std::vector<double> &vertex, size_t n_solid)
{
    uint64_t hash = n_solid;
    hash = hash_bytes(hash, vertex.data(), vertex.size() * sizeof vertex[0]);
    hash = hash_bytes(hash, split.tets.tet.data(), split.tets.tet.size() * sizeof split.tets.tet[0]);
    split.hash = hash ? hash : 1; // 0 stands for none
}

} // namespace tetcast
