// gather.h: all blocks that a reader gave, as one list of points and cells.
#ifndef TC_READERS_GATHER_H
#define TC_READERS_GATHER_H

#include "tets.h"

#include <vtkDataObject.h>
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include <map>

namespace tetcast
{

struct Leaf {
    vtkSmartPointer<vtkDataSet> data;
    size_t first_point, first_cell; // numbers of its point 0 and cell 0 in the whole
    unsigned block;                 // VTK's flat index: nodes of the tree before it, the root is 0
    std::string name;               // of the block; "": it has none
};

// A block by what the array of block numbers calls it.
struct Block {
    int64_t number;
    std::string name; // "": it has none
};

struct Gathered {
    std::vector<Leaf> leaf;
    size_t n_point = 0, n_cell = 0;
    size_t n_ghost = 0;            // cells left out: copies for neighbouring pieces, or blanked
    std::map<int, size_t> by_type; // VTK cell type -> count, without ghosts
    size_t n_solid = 0;            // of dimension 3
    size_t n_curved = 0;           // of dimension 3, with nodes beyond the corners
};

// The leaves of data (any nesting; null blocks and tables are skipped). Several files are counted as blocks of one tree.
void gather_leaves(Gathered &out, const std::vector<vtkSmartPointer<vtkDataObject>> &data);

// Counts the cells by type and checks every point number. path is for the sentence.
void count_cells(Gathered &out, const std::string &path);

// Copies the coordinates; ranks are the point numbers.
void gather_points(Tets &out, const Gathered &from);

// Is the leaf's cell one to leave out as ghost or blanked?
bool is_ghost(const Leaf &leaf, size_t cell);

} // namespace tetcast
#endif
