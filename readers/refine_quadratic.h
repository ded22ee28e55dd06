// refine_quadratic.h: curved cells into smaller linear cells that follow the curve.
#ifndef TC_READERS_REFINE_QUADRATIC_H
#define TC_READERS_REFINE_QUADRATIC_H

#include "cell_types.h"
#include "tets.h"

#include <array>
#include <unordered_map>

class vtkCell;

namespace tetcast
{

// Halves tets, pyramids, wedges and hexahedra along every edge, level by level. New points lie where the cell's shape
// functions put them; those on edges and faces are shared by key, so that neighbours stay conforming whatever their
// types.
class Refiner
{
  public:
    Refiner(Tets &tets, int n_level) : out(tets), levels(n_level) {}

    // Can cells of this type be refined? Prisms of five and six sides, polyhedra, point sets cannot.
    static bool can(const CellType &type);
    // Refines one cell and splits what comes of it into tets.
    //   cell        VTK's cell, with points and point ids; first_point: number of the block's point 0
    void add(int64_t cell_id, const CellType &type, vtkCell *cell, size_t first_point);

  private:
    struct Node {
        int32_t id;
        double p[3]; // parametric; a pyramid's in the straight-sided pyramid with apex (1/2, 1/2, 1)
    };
    using Key = std::array<int32_t, 4>;
    struct KeyHash {
        size_t operator()(const Key &key) const;
    };

    Tets &out;
    int levels;
    std::unordered_map<Key, int32_t, KeyHash> shared;

    // The cell at work.
    int64_t cell_id = 0;
    vtkCell *cell = nullptr;
    Shape shape = Shape::none;
    std::vector<int32_t> file_id;
    std::vector<double> weight;

    Node middle(const std::vector<const Node *> &parents);
    void split(Shape part, const std::vector<Node> &node, int level);
    void split_tetra(const std::vector<Node> &v, int level);
    void split_pyramid(const std::vector<Node> &v, int level);
    void split_wedge(const std::vector<Node> &v, int level);
    void split_hexahedron(const std::vector<Node> &v, int level);
};

} // namespace tetcast
#endif
