// rank_points.cpp: the order of points that decides how quadrilaterals are cut.
#include "rank_points.h"

#include <cstring>

namespace tetcast
{

void rank_points(Tets &out)
{
    const size_t n = out.n_file_point;
    size_t capacity = 16;
    while (capacity < 2 * n)
        capacity *= 2;
    std::vector<int32_t> slot(capacity, -1);
    for (size_t i = 0; i < n; i++) {
        double x[3];
        uint64_t bits[3], hash = 0;
        for (int k = 0; k < 3; k++) {
            x[k] = out.point[3 * i + (size_t)k] + 0.0; // -0 and 0 are one place
            memcpy(&bits[k], &x[k], sizeof bits[k]);
            hash = (hash ^ bits[k]) * UINT64_C(0x9e3779b97f4a7c15);
            hash ^= hash >> 29;
        }
        size_t at = (size_t)(hash * UINT64_C(0xbf58476d1ce4e5b9) >> 20) & (capacity - 1);
        for (;; at = (at + 1) & (capacity - 1)) {
            const int32_t other = slot[at];
            if (other < 0) {
                slot[at] = (int32_t)i;
                break;
            }
            const double *y = out.at(other);
            if (y[0] == x[0] && y[1] == x[1] && y[2] == x[2]) {
                out.rank[i] = other;
                break;
            }
        }
    }
}

EdgeColours::EdgeColours(const Tets &tets) : parent(tets.n_file_point), odd(tets.n_file_point, 0)
{
    for (size_t i = 0; i < parent.size(); i++)
        parent[i] = (int32_t)i;
}

int32_t EdgeColours::root_of(int32_t v, uint8_t &parity)
{
    // Path halving: the grandparent becomes the parent.
    parity = 0;
    while (parent[(size_t)v] != v) {
        const int32_t p = parent[(size_t)v];
        odd[(size_t)v] ^= odd[(size_t)p];
        parent[(size_t)v] = parent[(size_t)p];
        parity ^= odd[(size_t)v];
        v = parent[(size_t)v];
    }
    return v;
}

void EdgeColours::add_cell(const Tets &tets, Shape shape, const int32_t *corner)
{
    if (shape != Shape::hexahedron && shape != Shape::voxel)
        return;
    for (const std::vector<int> &face : shape_faces(shape))
        for (size_t k = 0; k < 4; k++) {
            const int32_t a = tets.rank[(size_t)corner[face[k]]], b = tets.rank[(size_t)corner[face[(k + 1) % 4]]];
            uint8_t parity_a = 0, parity_b = 0;
            const int32_t root_a = root_of(a, parity_a), root_b = root_of(b, parity_b);
            if (root_a == root_b)
                continue;
            // The lower root stays: colours do not depend on the order of the cells.
            const int32_t low = root_a < root_b ? root_a : root_b, high = root_a < root_b ? root_b : root_a;
            parent[(size_t)high] = low;
            odd[(size_t)high] = (uint8_t)(parity_a ^ parity_b ^ 1);
        }
}

void EdgeColours::apply(Tets &tets)
{
    // Ranks so far are the numbers of first coinciding points.
    std::vector<int32_t> number(parent.size());
    int32_t next = 0;
    for (uint8_t colour = 0; colour < 2; colour++)
        for (size_t i = 0; i < parent.size(); i++) {
            uint8_t parity = 0;
            if (tets.rank[i] != (int32_t)i)
                continue;
            root_of((int32_t)i, parity);
            if (parity == colour)
                number[i] = next++;
        }
    for (size_t i = 0; i < parent.size(); i++)
        tets.rank[i] = number[(size_t)tets.rank[i]];
}

} // namespace tetcast
