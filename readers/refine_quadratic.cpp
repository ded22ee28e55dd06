// refine_quadratic.cpp: curved cells into smaller linear cells that follow the curve.
// A tet becomes 4 corner tets and an octahedron cut along its shortest diagonal (Bey 1995, "Tetrahedral grid
// refinement"), a pyramid 6 pyramids and 4 tets, a wedge 8 wedges, a hexahedron 8 hexahedra: every edge is halved,
// every quadrilateral becomes 4, every triangle 4.
#include "refine_quadratic.h"

#include "split_cells.h"

#include <vtkCell.h>
#include <vtkCellType.h>
#include <vtkIdList.h>
#include <vtkPoints.h>

#include <algorithm>
#include <cmath>

namespace tetcast
{

size_t Refiner::KeyHash::operator()(const Key &key) const
{
    uint64_t h = 0;
    for (int32_t k : key) {
        h = (h ^ (uint32_t)k) * UINT64_C(0x9e3779b97f4a7c15);
        h ^= h >> 32;
    }
    return (size_t)h;
}

bool Refiner::can(const CellType &type)
{
    switch (type.shape) {
    case Shape::tetra:
    case Shape::pyramid:
    case Shape::wedge:
    case Shape::hexahedron:
    case Shape::voxel:
        return (type.vtk < 60 || type.vtk > 67) && type.vtk != 74 && type.vtk != 81; // VTK has no classes for these
    default:
        return false;
    }
}

// The point between nodes: an edge's two, a quadrilateral's four, or a hexahedron's eight (not shared).
Refiner::Node Refiner::middle(const std::vector<const Node *> &parents)
{
    Node made = {-1, {0, 0, 0}};
    Key key = {-1, -1, -1, -1};
    for (size_t i = 0; i < parents.size(); i++) {
        for (int k = 0; k < 3; k++)
            made.p[k] += parents[i]->p[k] / (double)parents.size();
        if (i < 4)
            key[i] = out.rank[(size_t)parents[i]->id];
    }
    const bool can_share = parents.size() <= 4;
    std::sort(key.begin(), key.end());
    if (can_share) {
        const auto at = shared.find(key);
        if (at != shared.end()) {
            made.id = at->second;
            return made;
        }
    }
    double r[3] = {made.p[0], made.p[1], made.p[2]};
    if (shape == Shape::pyramid && cell->GetCellType() == VTK_TRIQUADRATIC_PYRAMID) {
        r[2] = 0.5 + 0.5 * made.p[2]; // VTK's numbers for this one begin at 1/2
    } else if (shape == Shape::pyramid) {
        // VTK's other pyramids are cubes whose top is pulled together.
        for (int k = 0; k < 2; k++)
            r[k] = made.p[2] < 1 ? (made.p[k] - 0.5 * made.p[2]) / (1 - made.p[2]) : 0.5;
    }
    cell->InterpolateFunctions(r, weight.data());
    double x[3] = {0, 0, 0};
    for (size_t i = 0; i < file_id.size(); i++)
        for (int k = 0; k < 3; k++)
            x[k] += weight[i] * out.at(file_id[i])[k];
    made.id = out.add_point(x, file_id.data(), weight.data(), file_id.size());
    if (can_share)
        shared.emplace(key, made.id);
    return made;
}

void Refiner::split_tetra(const std::vector<Node> &v, int level)
{
    static const int edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    std::vector<Node> m;
    for (const auto &e : edge)
        m.push_back(middle({&v[(size_t)e[0]], &v[(size_t)e[1]]}));
    split(Shape::tetra, {v[0], m[0], m[1], m[2]}, level);
    split(Shape::tetra, {m[0], v[1], m[3], m[4]}, level);
    split(Shape::tetra, {m[1], m[3], v[2], m[5]}, level);
    split(Shape::tetra, {m[2], m[4], m[5], v[3]}, level);
    // Opposite middles are the diagonal's ends; the other four go around it.
    static const int around[3][6] = {{0, 5, 1, 2, 4, 3}, {1, 4, 0, 2, 5, 3}, {2, 3, 0, 1, 5, 4}};
    int best = 0;
    double shortest = HUGE_VAL;
    for (int d = 0; d < 3; d++) {
        const double *a = out.at(m[(size_t)around[d][0]].id), *b = out.at(m[(size_t)around[d][1]].id);
        const double length = std::hypot(std::hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
        if (length < shortest) {
            shortest = length;
            best = d;
        }
    }
    const bool positive = tet_volume6(v[0].p, v[1].p, v[2].p, v[3].p) > 0;
    for (int i = 0; i < 4; i++) {
        const Node &a = m[(size_t)around[best][0]], &b = m[(size_t)around[best][1]];
        const Node &c = m[(size_t)around[best][2 + i]], &d = m[(size_t)around[best][2 + (i + 1) % 4]];
        if ((tet_volume6(a.p, b.p, c.p, d.p) > 0) == positive)
            split(Shape::tetra, {a, b, c, d}, level);
        else
            split(Shape::tetra, {a, b, d, c}, level);
    }
}

void Refiner::split_pyramid(const std::vector<Node> &v, int level)
{
    std::vector<Node> side, up;
    for (size_t i = 0; i < 4; i++) {
        side.push_back(middle({&v[i], &v[(i + 1) % 4]}));
        up.push_back(middle({&v[i], &v[4]}));
    }
    const Node centre = middle({&v[0], &v[1], &v[2], &v[3]});
    for (size_t i = 0; i < 4; i++)
        split(Shape::pyramid, {v[i], side[i], centre, side[(i + 3) % 4], up[i]}, level);
    split(Shape::pyramid, {up[0], up[1], up[2], up[3], v[4]}, level);
    split(Shape::pyramid, {up[0], up[3], up[2], up[1], centre}, level);
    for (size_t i = 0; i < 4; i++)
        split(Shape::tetra, {side[i], up[(i + 1) % 4], centre, up[i]}, level);
}

void Refiner::split_wedge(const std::vector<Node> &v, int level)
{
    static const int tri[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
    std::vector<Node> layer[3];
    for (size_t i = 0; i < 3; i++) {
        layer[0].push_back(v[i]);
        layer[1].push_back(middle({&v[i], &v[i + 3]}));
        layer[2].push_back(v[i + 3]);
    }
    for (size_t i = 0; i < 3; i++) {
        const size_t j = (i + 1) % 3;
        layer[0].push_back(middle({&v[i], &v[j]}));
        layer[1].push_back(middle({&v[i], &v[j], &v[i + 3], &v[j + 3]}));
        layer[2].push_back(middle({&v[i + 3], &v[j + 3]}));
    }
    for (int l = 0; l < 2; l++)
        for (const auto &t : tri)
            split(Shape::wedge,
                  {layer[l][(size_t)t[0]], layer[l][(size_t)t[1]], layer[l][(size_t)t[2]], layer[l + 1][(size_t)t[0]],
                   layer[l + 1][(size_t)t[1]], layer[l + 1][(size_t)t[2]]},
                  level);
}

void Refiner::split_hexahedron(const std::vector<Node> &v, int level)
{
    // A 3 x 3 x 3 lattice; a coordinate of 1 lies between the corners of 0 and 2.
    static const int at[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    std::vector<Node> lattice;
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            for (int i = 0; i < 3; i++) {
                const int want[3] = {i, j, k};
                std::vector<const Node *> parents;
                for (size_t c = 0; c < 8; c++) {
                    bool near = true;
                    for (int a = 0; a < 3; a++)
                        near = near && (want[a] == 1 || want[a] == 2 * at[c][a]);
                    if (near)
                        parents.push_back(&v[c]);
                }
                lattice.push_back(parents.size() == 1 ? *parents[0] : middle(parents));
            }
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++)
            for (int i = 0; i < 2; i++) {
                std::vector<Node> part;
                for (const auto &c : at)
                    part.push_back(lattice[(size_t)((i + c[0]) + 3 * ((j + c[1]) + 3 * (k + c[2])))]);
                split(Shape::hexahedron, part, level);
            }
}

void Refiner::split(Shape part, const std::vector<Node> &node, int level)
{
    if (level == levels) {
        int32_t id[8];
        for (size_t i = 0; i < node.size(); i++)
            id[i] = node[i].id;
        split_cell(out, cell_id, part, id);
        return;
    }
    switch (part) {
    case Shape::tetra:
        split_tetra(node, level + 1);
        break;
    case Shape::pyramid:
        split_pyramid(node, level + 1);
        break;
    case Shape::wedge:
        split_wedge(node, level + 1);
        break;
    default:
        split_hexahedron(node, level + 1);
        break;
    }
}

void Refiner::add(int64_t id, const CellType &type, vtkCell *vtk_cell, size_t first_point)
{
    static const int as_hexahedron[8] = {0, 1, 3, 2, 4, 5, 7, 6};
    static const double pyramid[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
    cell_id = id;
    cell = vtk_cell;
    shape = type.shape == Shape::voxel ? Shape::hexahedron : type.shape;
    const size_t n = (size_t)cell->GetNumberOfPoints();
    file_id.resize(n);
    weight.resize(n);
    for (size_t i = 0; i < n; i++)
        file_id[i] = (int32_t)(first_point + (size_t)cell->GetPointId((int)i));
    const double *parametric = cell->GetParametricCoords();
    const int corners = corner_count(type.shape);
    if (!parametric || (int)n < corners)
        throw Refusal("cell " + std::to_string(id) + ", a " + type.name + ", cannot be refined; leave out --refine");
    std::vector<Node> node((size_t)corners);
    for (int i = 0; i < corners; i++) {
        const int from = type.shape == Shape::voxel ? as_hexahedron[i] : i;
        node[(size_t)i].id = file_id[(size_t)from];
        for (int k = 0; k < 3; k++)
            node[(size_t)i].p[k] = shape == Shape::pyramid ? pyramid[i][k] : parametric[3 * from + k];
    }
    split(shape, node, 0);
}

} // namespace tetcast
