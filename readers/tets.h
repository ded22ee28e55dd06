// tets.h: the tets under construction: points, ranks that choose diagonals, weights of added points, counts.
#ifndef TC_READERS_TETS_H
#define TC_READERS_TETS_H

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace tetcast
{

// Thrown with the sentence that the user gets.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class Tets
{
  public:
    std::vector<double> point; // [n][3]; the file's points first, added ones behind
    std::vector<int32_t>
        rank; // [n]; equal for points that coincide bit by bit: both sides of a seam agree on diagonals
    size_t n_file_point = 0;

    // Added points: point n_file_point + i is the weighted sum of file points weight_id[weight_first[i] …].
    std::vector<size_t> weight_first{0};
    std::vector<int32_t> weight_id;
    std::vector<double> weight;

    std::vector<int32_t> tet;  // [n_tet][4], positive volume or zero
    std::vector<int64_t> cell; // [n_tet] the file's cell that each came from

    size_t turned_cells =
        0; // cells of negative volume that were turned (wedges not counted: two numberings are in use)
    size_t folded_cells = 0;  // cells that fold over themselves: their tets overlap
    size_t refused_cells = 0; // polyhedra that could not be filled
    size_t centred_cells = 0; // cells that got a point inside
    size_t open_cells = 0;    // polyhedra whose faces do not close
    size_t empty_cells = 0;   // cells that repeat so many points that no tet is left

    const double *at(int32_t id) const { return &point[3 * (size_t)id]; }
    size_t n_point() const { return point.size() / 3; }

    // A point at x that interpolates file points; gives its id.
    int32_t add_point(const double *x, const int32_t *id, const double *w, size_t n);
    // Turns it to positive volume; drops it when it repeats a vertex.
    void add_tet(int64_t cell_id, int32_t a, int32_t b, int32_t c, int32_t d);
};

// dot(cross(b-a, c-a), d-a): six times the signed volume.
double tet_volume6(const double *a, const double *b, const double *c, const double *d);

} // namespace tetcast
#endif
