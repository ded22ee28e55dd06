// kept.h: the tets of the last request, for one with the same points and cells.
#ifndef TC_READERS_KEPT_H
#define TC_READERS_KEPT_H

#include "split_mesh.h"

namespace tetcast
{

// What a file's cells became.
struct SplitFile {
    Tets tets;
    std::vector<int32_t> used; // from compact_points
    LostPoints lost;
    int refined = 0;
    std::vector<std::string> notes; // of splitting
    uint64_t hash = 0;              // of what is sent of it: vertices, tets, and the number of 3-D cells

    // [used.size()][3]
    std::vector<double> vertices() const;
};

// The last one, while more requests are expected.
struct Kept {
    bool there = false;
    uint64_t input = 0; // of the points and cells that it was made of
    int refine = 0;     // as asked for
    SplitFile split;
};

// A hash of all that splitting depends on. False: such data cannot be hashed as they lie in memory.
bool hash_input(uint64_t &out, const Gathered &data);

// Sets split.hash.
void hash_split(SplitFile &split, const std::vector<double> &vertex, size_t n_solid);

} // namespace tetcast
#endif
