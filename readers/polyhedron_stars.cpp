// polyhedron_stars.cpp: polyhedra that can be seen whole from one point.
#include "polyhedron_body.h"

#include <algorithm>

namespace tetcast
{
namespace polyhedron
{

bool cone_from_vertex(Body &body)
{
    std::vector<int> candidate;
    for (const Triangle &t : body.surface)
        candidate.insert(candidate.end(), t.begin(), t.end());
    std::sort(candidate.begin(), candidate.end());
    candidate.erase(std::unique(candidate.begin(), candidate.end()), candidate.end());
    for (int v : candidate) {
        bool good = true;
        for (const Triangle &t : body.surface)
            if (!has(t, v) && cone_volume(body, body.x[v], t) < -1e-12 * body.size3) {
                good = false;
                break;
            }
        if (!good)
            continue;
        for (const Triangle &t : body.surface)
            if (!has(t, v))
                body.tet.push_back({v, t[0], t[1], t[2]});
        return true;
    }
    return false;
}

// Cuts a convex solid, given by its polygons, with the half-space dot(normal, x) <= offset.
static void clip(std::vector<std::vector<Vec>> &solid, const Vec &normal, double offset, double tolerance)
{
    // Planes that cut nothing off leave the solid as it is, and with it the number of its points.
    bool cuts = false;
    for (const std::vector<Vec> &polygon : solid)
        for (const Vec &p : polygon)
            cuts = cuts || dot(normal, p) - offset > tolerance;
    if (!cuts)
        return;
    std::vector<std::vector<Vec>> result;
    std::vector<Vec> rim;
    for (const std::vector<Vec> &polygon : solid) {
        std::vector<Vec> kept;
        for (size_t i = 0; i < polygon.size(); i++) {
            const Vec &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const double da = dot(normal, a) - offset, db = dot(normal, b) - offset;
            if (da <= 0)
                kept.push_back(a);
            if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
                const Vec p = a + (da / (da - db)) * (b - a);
                kept.push_back(p);
                rim.push_back(p);
            } else if (da == 0) {
                rim.push_back(a);
            }
        }
        if (kept.size() >= 3)
            result.push_back(kept);
    }
    if (rim.size() >= 3) {
        Vec centre = {0, 0, 0};
        for (const Vec &p : rim)
            centre = centre + (1.0 / (double)rim.size()) * p;
        const Vec u = std::fabs(normal[0]) < 0.6 ? cross(normal, Vec{1, 0, 0}) : cross(normal, Vec{0, 1, 0});
        const Vec w = cross(normal, u);
        std::sort(rim.begin(), rim.end(), [&](const Vec &a, const Vec &b) {
            return std::atan2(dot(w, a - centre), dot(u, a - centre)) <
                   std::atan2(dot(w, b - centre), dot(u, b - centre));
        });
        rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
        result.push_back(rim);
    }
    solid.swap(result);
}

// A point that sees every triangle from inside, or false.
static bool kernel_point(Vec &out, const Body &body)
{
    Vec low = body.x[body.surface[0][0]], high = low, centre = {0, 0, 0};
    double corners = 0;
    for (const Triangle &t : body.surface)
        for (int v : t) {
            for (int k = 0; k < 3; k++) {
                low[k] = std::min(low[k], body.x[v][k]);
                high[k] = std::max(high[k], body.x[v][k]);
            }
            centre = centre + body.x[v];
            corners++;
        }
    const auto sees_all = [&](const Vec &p) {
        for (const Triangle &t : body.surface)
            if (!(cone_volume(body, p, t) > 1e-12 * body.size3))
                return false;
        return true;
    };
    out = (1.0 / corners) * centre;
    if (sees_all(out))
        return true;
    const auto corner = [&](int i) {
        return Vec{i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]};
    };
    std::vector<std::vector<Vec>> solid;
    for (const std::array<int, 4> &f :
         {std::array<int, 4>{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}})
        solid.push_back({corner(f[0]), corner(f[1]), corner(f[2]), corner(f[3])});
    for (const Triangle &t : body.surface) {
        const Vec normal = cross(body.x[t[1]] - body.x[t[0]], body.x[t[2]] - body.x[t[0]]);
        if (length(normal) > 0)
            clip(solid, (1.0 / length(normal)) * normal, dot(normal, body.x[t[0]]) / length(normal),
                 1e-12 * length(high - low));
    }
    if (solid.empty())
        return false;
    double n = 0;
    centre = {0, 0, 0};
    for (const std::vector<Vec> &polygon : solid)
        for (const Vec &p : polygon) {
            centre = centre + p;
            n++;
        }
    out = (1.0 / n) * centre;
    return sees_all(out);
}

bool cone_from_kernel(Body &body)
{
    Vec p;
    if (!kernel_point(p, body))
        return false;
    const int v = (int)body.x.size();
    body.x.push_back(p);
    for (const Triangle &t : body.surface)
        body.tet.push_back({v, t[0], t[1], t[2]});
    return true;
}

} // namespace polyhedron
} // namespace tetcast
