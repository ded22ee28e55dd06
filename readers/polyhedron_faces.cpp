// polyhedron_faces.cpp: faces of a polyhedron: turned outwards, cut into triangles.
#include "polyhedron_body.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tetcast
{
namespace polyhedron
{

// Is the fan from polygon[at] good: no triangle turned against the polygon's normal?
static bool fan_is_good(const std::vector<Vec> &x, const std::vector<int> &polygon, size_t at, const Vec &normal)
{
    const size_t n = polygon.size();
    const double slack = -1e-9 * dot(normal, normal);
    for (size_t i = 1; i + 1 < n; i++) {
        const Vec &a = x[polygon[at]], &b = x[polygon[(at + i) % n]], &c = x[polygon[(at + i + 1) % n]];
        if (dot(cross(b - a, c - a), normal) < slack)
            return false;
    }
    return true;
}

// Ears in a fixed order: the first good one from the polygon's start. False when none is left.
static bool cut_ears(std::vector<Triangle> &out, const std::vector<Vec> &x, std::vector<int> polygon, const Vec &normal)
{
    while (polygon.size() > 3) {
        const size_t n = polygon.size();
        size_t ear = n;
        for (size_t i = 0; i < n && ear == n; i++) {
            const int a = polygon[(i + n - 1) % n], b = polygon[i], c = polygon[(i + 1) % n];
            if (dot(cross(x[b] - x[a], x[c] - x[a]), normal) <= 0)
                continue;
            bool good = true;
            for (int p : polygon)
                if (p != a && p != b && p != c && in_triangle(x[a], x[b], x[c], x[p], normal))
                    good = false;
            if (good)
                ear = i;
        }
        if (ear == n)
            return false;
        out.push_back({polygon[(ear + n - 1) % n], polygon[ear], polygon[(ear + 1) % n]});
        polygon.erase(polygon.begin() + (std::ptrdiff_t)ear);
    }
    out.push_back({polygon[0], polygon[1], polygon[2]});
    return true;
}

// Triangles of one face. The polygon is first brought to a normal form (start at the lowest rank, go on towards the
// lower of its two neighbours), in which both cells see the same numbers in the same order; then turned back.
void cut_face(std::vector<Triangle> &out, const std::vector<Vec> &x, const std::vector<int> &rank,
              std::vector<int> polygon)
{
    const size_t n = polygon.size();
    size_t start = 0;
    for (size_t i = 1; i < n; i++)
        if (rank[polygon[i]] < rank[polygon[start]])
            start = i;
    std::rotate(polygon.begin(), polygon.begin() + (std::ptrdiff_t)start, polygon.end());
    const bool turned = rank[polygon[n - 1]] < rank[polygon[1]];
    if (turned)
        std::reverse(polygon.begin() + 1, polygon.end());

    std::vector<Triangle> made;
    Vec normal = {0, 0, 0};
    for (size_t i = 1; i + 1 < n; i++)
        normal = normal + cross(x[polygon[i]] - x[polygon[0]], x[polygon[i + 1]] - x[polygon[0]]);
    size_t from = n;
    std::vector<size_t> order(n);
    for (size_t i = 0; i < n; i++)
        order[i] = i;
    std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return rank[polygon[a]] < rank[polygon[b]]; });
    for (size_t i : order) {
        if (fan_is_good(x, polygon, i, normal)) {
            from = i;
            break;
        }
    }
    if (from == n && !cut_ears(made, x, polygon, normal)) {
        made.clear();
        from = 0;
    }
    if (from < n)
        for (size_t i = 1; i + 1 < n; i++)
            made.push_back({polygon[from], polygon[(from + i) % n], polygon[(from + i + 1) % n]});
    for (Triangle &t : made) {
        if (turned)
            std::swap(t[1], t[2]);
        out.push_back(t);
    }
}

// Turns all faces outwards. False when an edge does not have two faces, or they cannot be turned alike.
bool orient(std::vector<std::vector<int>> &face, const std::vector<Vec> &x)
{
    struct Side {
        size_t face;
        bool up;
    };
    std::map<std::pair<int, int>, std::vector<Side>> edge;
    for (size_t f = 0; f < face.size(); f++)
        for (size_t i = 0; i < face[f].size(); i++) {
            const int a = face[f][i], b = face[f][(i + 1) % face[f].size()];
            edge[{std::min(a, b), std::max(a, b)}].push_back({f, a < b});
        }
    for (const auto &e : edge)
        if (e.second.size() != 2 || e.second[0].face == e.second[1].face)
            return false;
    std::vector<int> flip(face.size(), -1);
    for (size_t seed = 0; seed < face.size(); seed++) {
        if (flip[seed] >= 0)
            continue;
        if (seed > 0)
            return false; // two shells: a cavity, not one polyhedron
        flip[seed] = 0;
        std::vector<size_t> stack = {seed};
        while (!stack.empty()) {
            const size_t f = stack.back();
            stack.pop_back();
            for (size_t i = 0; i < face[f].size(); i++) {
                const int a = face[f][i], b = face[f][(i + 1) % face[f].size()];
                const std::vector<Side> &side = edge[{std::min(a, b), std::max(a, b)}];
                const Side &mine = side[0].face == f ? side[0] : side[1];
                const Side &other = side[0].face == f ? side[1] : side[0];
                const int want = mine.up == other.up ? 1 - flip[f] : flip[f];
                if (flip[other.face] < 0) {
                    flip[other.face] = want;
                    stack.push_back(other.face);
                } else if (flip[other.face] != want) {
                    return false;
                }
            }
        }
    }
    double volume = 0;
    for (size_t f = 0; f < face.size(); f++) {
        if (flip[f])
            std::reverse(face[f].begin(), face[f].end());
        for (size_t i = 1; i + 1 < face[f].size(); i++)
            volume += volume6(x[face[0][0]], x[face[f][0]], x[face[f][i]], x[face[f][i + 1]]);
    }
    if (volume < 0)
        for (std::vector<int> &f : face)
            std::reverse(f.begin(), f.end());
    return true;
}

} // namespace polyhedron
} // namespace tetcast
