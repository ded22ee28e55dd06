// fields.h: the arrays a file offers, and the one that is rendered.
#ifndef TC_READERS_FIELDS_H
#define TC_READERS_FIELDS_H

#include "gather.h"

#include "tetcast.h"

#include <functional>

namespace tetcast
{

// One array by name and association, over all blocks.
struct Offered {
    std::string name;
    tc_association association;
    int components = 0; // 0: not read
    bool ranged = false;
    double lo = 0, hi = 0; // finite range, of the magnitude where components > 1; lo > hi: nothing finite
    size_t blocks_without = 0;
    std::vector<std::string> component_name;
    bool block_numbers = false; // made by us or by VTK, not the file's own: never taken unless it is asked for
};

// What the user asked for.
struct FieldWish {
    bool any = true;  // the first array there is
    std::string text; // "NAME", "NAME:COMPONENT", "NAME:magnitude"
    tc_association association = TC_ANY_DATA;
};

struct Chosen {
    bool none = true;
    std::string name, label; // label: "U:magnitude"
    tc_association association = TC_POINT_DATA;
    int components = 1;
    int component = 0; // -1: magnitude
    bool block_numbers = false;
};

// Arrays that number things rather than measure them; never the first choice.
bool is_bookkeeping(const std::string &name);

// The array of a mesh of several blocks that has none of its own: VTK's flat index, by the name that ParaView gives it.
extern const char *const block_array;

// May this array be the one that is wanted? (Before reading: the component is not known yet.)
bool may_be_wanted(const FieldWish &wish, const std::string &name, tc_association association);
// Throws a Refusal that lists the arrays when none of offered may be wanted.
void require_wanted(const std::string &path, const FieldWish &wish, const std::vector<Offered> &offered);

// The arrays that the gathered data hold, appended to offered where they are not in it; components filled in.
void list_read_arrays(std::vector<Offered> &offered, const Gathered &data);
// Offers the block's number of each cell, last, where there are several blocks and no array of such numbers, and names
// them in blocks; where offered holds numbers that VTK makes, blocks has been filled.
void list_block_numbers(std::vector<Offered> &offered, std::vector<Block> &blocks, const Gathered &data);
// Ranges of the arrays that were read and for which wanted is true.
void find_ranges(std::vector<Offered> &offered, const Gathered &data,
                 const std::function<bool(const Offered &)> &wanted);

// The array and component. Throws a Refusal for a missing array or component; lists those there are.
Chosen choose_field(const std::string &path, const FieldWish &wish, const std::vector<Offered> &offered);

// Values of the chosen array at points of the mesh (numbers in Tets, added ones interpolated), or at file cells.
//   out [n]; NaN where a block lacks the array
void point_values(double *out, const Chosen &chosen, const Gathered &data, const Tets &tets, const int32_t *point,
                  size_t n);
void cell_values(double *out, const Chosen &chosen, const Gathered &data, const int64_t *cell, size_t n);

} // namespace tetcast
#endif
