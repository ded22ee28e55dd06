// split_polyhedron.cpp: one polyhedron, convex or not, into tets that fill exactly its volume.
//
// Each face is cut into triangles by a rule that both of its cells share. Then, in this order: a cone from one of the
// polyhedron's own vertices, a cone from a point of its kernel (the intersection of the triangles' half-spaces, found
// by clipping a box), and for polyhedra that are not star-shaped ears: tets with two or three triangles on the surface
// are cut off one after another until the rest is star-shaped. What does not fill the polyhedron's volume is refused.
#include "split_polyhedron.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tetcast
{

namespace
{

using Vec = std::array<double, 3>;
using Triangle = std::array<int, 3>;

Vec operator-(const Vec &a, const Vec &b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vec operator+(const Vec &a, const Vec &b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Vec operator*(double s, const Vec &a)
{
    return {s * a[0], s * a[1], s * a[2]};
}
double dot(const Vec &a, const Vec &b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Vec cross(const Vec &a, const Vec &b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vec &a)
{
    return std::sqrt(dot(a, a));
}
double volume6(const Vec &a, const Vec &b, const Vec &c, const Vec &d)
{
    return dot(cross(b - a, c - a), d - a);
}

// ------------------------------------------------------------------------------------------------ faces to triangles

// Is the fan from polygon[at] good: no triangle turned against the polygon's normal?
bool fan_is_good(const std::vector<Vec> &x, const std::vector<int> &polygon, size_t at, const Vec &normal)
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

bool inside_ear(const Vec &a, const Vec &b, const Vec &c, const Vec &p, const Vec &normal)
{
    return dot(cross(b - a, p - a), normal) >= 0 && dot(cross(c - b, p - b), normal) >= 0 &&
           dot(cross(a - c, p - c), normal) >= 0;
}

// Ears in a fixed order: the first good one from the polygon's start. False when none is left.
bool cut_ears(std::vector<Triangle> &out, const std::vector<Vec> &x, std::vector<int> polygon, const Vec &normal)
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
                if (p != a && p != b && p != c && inside_ear(x[a], x[b], x[c], x[p], normal))
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

// ------------------------------------------------------------------------------------------------ star-shaped ones

struct Body {
    std::vector<Vec> x;            // grows by added points
    std::vector<Triangle> surface; // outwards
    std::vector<std::array<int, 4>> tet;
    double size3; // volume scale: what is below 1e-10 of it is rounding
};

// Volume of (p, triangle); positive when the triangle looks away from p.
double cone_volume(const Body &body, const Vec &p, const Triangle &t)
{
    return volume6(p, body.x[t[0]], body.x[t[1]], body.x[t[2]]);
}

bool has(const Triangle &t, int v)
{
    return t[0] == v || t[1] == v || t[2] == v;
}

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
void clip(std::vector<std::vector<Vec>> &solid, const Vec &normal, double offset, double tolerance)
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
bool kernel_point(Vec &out, const Body &body)
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

// ------------------------------------------------------------------------------------------------ ears

// The coordinate planes that an almost flat figure is looked at in: without the largest component of its normal.
struct Flat {
    int u, v;
    explicit Flat(const Vec &normal)
    {
        const double n[3] = {std::fabs(normal[0]), std::fabs(normal[1]), std::fabs(normal[2])};
        const int drop = n[0] >= n[1] && n[0] >= n[2] ? 0 : n[1] >= n[2] ? 1 : 2;
        u = (drop + 1) % 3;
        v = (drop + 2) % 3;
    }
    double turn(const Vec &a, const Vec &b, const Vec &c) const
    {
        return (b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]);
    }
    bool cross(const Vec &p, const Vec &q, const Vec &a, const Vec &b) const
    {
        const double pa = turn(p, q, a), pb = turn(p, q, b), ap = turn(a, b, p), aq = turn(a, b, q);
        if (pa == 0 && pb == 0 && ap == 0 && aq == 0) { // on one line: do they overlap?
            const int k = std::fabs(q[u] - p[u]) > std::fabs(q[v] - p[v]) ? u : v;
            return std::max(std::min(p[k], q[k]), std::min(a[k], b[k])) <=
                   std::min(std::max(p[k], q[k]), std::max(a[k], b[k]));
        }
        return pa * pb <= 0 && ap * aq <= 0;
    }
    bool inside(const Vec &p, const Vec &a, const Vec &b, const Vec &c) const
    {
        const double s0 = turn(a, b, p), s1 = turn(b, c, p), s2 = turn(c, a, p);
        return (s0 >= 0 && s1 >= 0 && s2 >= 0) || (s0 <= 0 && s1 <= 0 && s2 <= 0);
    }
};

// Does the segment pq meet the triangle abc, or come within rounding of it? They share no vertex.
bool segment_meets(const Vec &p, const Vec &q, const Vec &a, const Vec &b, const Vec &c, double slack)
{
    const double vp = volume6(a, b, c, p), vq = volume6(a, b, c, q);
    if ((vp > slack && vq > slack) || (vp < -slack && vq < -slack))
        return false;
    if (std::fabs(vp) <= slack && std::fabs(vq) <= slack) {
        const Flat flat(cross(b - a, c - a));
        return flat.inside(p, a, b, c) || flat.cross(p, q, a, b) || flat.cross(p, q, b, c) || flat.cross(p, q, c, a);
    }
    const double s0 = volume6(p, q, a, b), s1 = volume6(p, q, b, c), s2 = volume6(p, q, c, a);
    return (s0 >= -slack && s1 >= -slack && s2 >= -slack) || (s0 <= slack && s1 <= slack && s2 <= slack);
}

// Does the segment from p to q run along the triangle (p, a, b), in its plane and between its sides?
bool segment_runs_in(const Vec &p, const Vec &q, const Vec &a, const Vec &b, double slack)
{
    if (std::fabs(volume6(p, a, b, q)) > slack)
        return false;
    const Flat flat(cross(a - p, b - p));
    const double whole = flat.turn(p, a, b), from_a = flat.turn(p, a, q), to_b = flat.turn(p, q, b);
    return whole > 0 ? from_a >= 0 && to_b >= 0 : from_a <= 0 && to_b <= 0;
}

struct Ear {
    int v[4]; // the shared edge v[0] v[1], then the two far vertices
    double badness;
};

// May the tet (v) be cut off? Its edge v[2] v[3] must be new and meet nothing, no vertex may lie in it, no edge may
// come through its two new faces.
bool ear_is_free(const Body &body, const Ear &ear)
{
    const int *v = ear.v;
    const Vec &a = body.x[v[0]], &b = body.x[v[1]], &c = body.x[v[2]], &d = body.x[v[3]];
    const double slack = 1e-11 * body.size3;
    for (const Triangle &t : body.surface) {
        if (has(t, v[2]) && has(t, v[3]))
            return false;
        for (int k = 0; k < 3; k++) {
            const int p = t[k];
            if (p == v[0] || p == v[1] || p == v[2] || p == v[3])
                continue;
            const Vec &y = body.x[p];
            if (volume6(a, b, c, y) <= slack && volume6(a, d, b, y) <= slack && volume6(b, d, c, y) <= slack &&
                volume6(a, c, d, y) <= slack)
                return false;
        }
        const bool at_c = has(t, v[2]), at_d = has(t, v[3]);
        if (!at_c && !at_d && segment_meets(c, d, body.x[t[0]], body.x[t[1]], body.x[t[2]], slack))
            return false;
        const bool own = has(t, v[0]) && has(t, v[1]);
        for (int k = 0; k < 3 && (at_c || at_d) && !own; k++)
            if ((t[k] == v[2] && segment_runs_in(c, d, body.x[t[(k + 1) % 3]], body.x[t[(k + 2) % 3]], slack)) ||
                (t[k] == v[3] && segment_runs_in(d, c, body.x[t[(k + 1) % 3]], body.x[t[(k + 2) % 3]], slack)))
                return false;
        for (int k = 0; k < 3; k++) {
            const int p = t[k], q = t[(k + 1) % 3];
            const bool own_p = p == v[0] || p == v[1] || p == v[2] || p == v[3];
            const bool own_q = q == v[0] || q == v[1] || q == v[2] || q == v[3];
            if (own_p && own_q)
                continue;
            // An edge that starts at one end of the ear's edge may leave through the new face opposite to it.
            const Vec &x = body.x[p], &y = body.x[q];
            if (p != v[0] && q != v[0] && p != v[2] && q != v[2] && p != v[3] && q != v[3] &&
                segment_meets(x, y, c, d, a, slack))
                return false;
            if (p != v[1] && q != v[1] && p != v[2] && q != v[2] && p != v[3] && q != v[3] &&
                segment_meets(x, y, c, d, b, slack))
                return false;
        }
    }
    return true;
}

// All edges at which the surface is convex, best ear first. order varies the choice between attempts.
std::vector<Ear> list_ears(const Body &body, unsigned order)
{
    std::map<std::pair<int, int>, int> far; // directed edge -> third vertex
    for (const Triangle &t : body.surface)
        for (int k = 0; k < 3; k++)
            far[{t[k], t[(k + 1) % 3]}] = t[(k + 2) % 3];
    std::vector<Ear> ears;
    for (const auto &e : far) {
        const int a = e.first.first, b = e.first.second, c = e.second;
        const auto back = far.find({b, a});
        if (a > b || back == far.end())
            continue;
        const int d = back->second;
        if (c == d)
            continue;
        // Triangles (a, b, c) and (b, a, d) look outwards: d lies behind the first where the edge is convex.
        const double volume = -volume6(body.x[a], body.x[b], body.x[c], body.x[d]);
        if (!(volume > 1e-10 * body.size3))
            continue;
        double longest = 0;
        for (int p : {a, b, c, d})
            for (int q : {a, b, c, d})
                longest = std::max(longest, length(body.x[p] - body.x[q]));
        double badness = longest * longest * longest / volume;
        if (order % 4 == 1)
            badness = volume;
        else if (order % 4 == 2)
            badness = -volume;
        else if (order % 4 == 3)
            badness = (double)(((unsigned)(a * 7919 + b * 104729) * (order * 2654435761u)) >> 8);
        ears.push_back({{a, b, c, d}, badness});
    }
    std::sort(ears.begin(), ears.end(), [](const Ear &p, const Ear &q) { return p.badness < q.badness; });
    return ears;
}

void remove_ear(Body &body, const Ear &ear)
{
    const int a = ear.v[0], b = ear.v[1], c = ear.v[2], d = ear.v[3];
    const auto same = [](const Triangle &t, int p, int q, int r) { return has(t, p) && has(t, q) && has(t, r); };
    body.surface.erase(std::remove_if(body.surface.begin(), body.surface.end(),
                                      [&](const Triangle &t) { return same(t, a, b, c) || same(t, a, b, d); }),
                       body.surface.end());
    body.surface.push_back({a, d, c});
    body.surface.push_back({b, c, d});
    body.tet.push_back({a, b, d, c});
}

// A vertex with three triangles is a tet of its own, unless it points inwards or something is in it.
bool remove_tip(Body &body)
{
    std::map<int, std::vector<size_t>> around;
    for (size_t i = 0; i < body.surface.size(); i++)
        for (int v : body.surface[i])
            around[v].push_back(i);
    for (const auto &entry : around) {
        if (entry.second.size() != 3)
            continue;
        const int tip = entry.first;
        Triangle t = body.surface[entry.second[0]];
        while (t[0] != tip)
            std::rotate(t.begin(), t.begin() + 1, t.end());
        int third = -1;
        for (size_t i : entry.second)
            for (int v : body.surface[i])
                if (v != tip && v != t[1] && v != t[2])
                    third = v;
        if (third < 0)
            continue;
        // (tip, p, q) looks outwards, so the third vertex lies behind it where the tip is convex.
        const int p = t[1], q = t[2];
        if (!(volume6(body.x[tip], body.x[q], body.x[p], body.x[third]) > 1e-10 * body.size3))
            continue;
        bool free = true;
        for (const auto &other : around) {
            const int v = other.first;
            if (v == tip || v == p || v == q || v == third)
                continue;
            const Vec &y = body.x[v], &o = body.x[tip], &a = body.x[p], &b = body.x[q], &c = body.x[third];
            const double slack = 1e-11 * body.size3;
            if (volume6(o, a, b, y) <= slack && volume6(o, b, c, y) <= slack && volume6(o, c, a, y) <= slack &&
                volume6(a, c, b, y) <= slack)
                free = false;
        }
        const int base[3] = {p, q, third};
        for (const Triangle &s : body.surface)
            for (int k = 0; k < 3 && free && !has(s, tip); k++) {
                const int from = s[k], to = s[(k + 1) % 3];
                int own_from = -1, own_to = -1;
                for (int e = 0; e < 3; e++) {
                    own_from = base[e] == from ? e : own_from;
                    own_to = base[e] == to ? e : own_to;
                }
                const double slack = 1e-11 * body.size3;
                const Vec &x = body.x[from], &y = body.x[to];
                if (own_from < 0 && own_to < 0)
                    free = !segment_meets(x, y, body.x[p], body.x[q], body.x[third], slack);
                else if (own_from >= 0 && own_to < 0)
                    free = !segment_runs_in(x, y, body.x[base[(own_from + 1) % 3]], body.x[base[(own_from + 2) % 3]],
                                            slack);
                else if (own_from < 0)
                    free =
                        !segment_runs_in(y, x, body.x[base[(own_to + 1) % 3]], body.x[base[(own_to + 2) % 3]], slack);
            }
        const auto flat = [&](const Triangle &s) { return has(s, p) && has(s, q) && has(s, third); };
        if (!free || std::any_of(body.surface.begin(), body.surface.end(), flat))
            continue;
        body.surface.erase(
            std::remove_if(body.surface.begin(), body.surface.end(), [&](const Triangle &s) { return has(s, tip); }),
            body.surface.end());
        body.surface.push_back({p, q, third});
        body.tet.push_back({tip, q, p, third});
        return true;
    }
    return false;
}

// How far the surface is from x along direction (not counting what is at x itself); infinite when it is not hit.
double clearance(const Body &body, const Vec &x, const Vec &direction, size_t own)
{
    double nearest = HUGE_VAL;
    for (size_t i = 0; i < body.surface.size(); i++) {
        const Triangle &t = body.surface[i];
        const Vec &a = body.x[t[0]], &b = body.x[t[1]], &c = body.x[t[2]];
        const Vec normal = cross(b - a, c - a);
        const double along = dot(direction, normal);
        if (i == own || along == 0)
            continue;
        const double s = dot(a - x, normal) / along;
        const Vec y = x + s * direction;
        if (s > 0 && s < nearest && inside_ear(a, b, c, y, normal))
            nearest = s;
    }
    return nearest;
}

// May the tet of triangle t and the point p (the last in body.x) be filled? Its edges must not meet the surface, no
// vertex may lie in it, no edge may come through its new faces.
bool roof_is_free(const Body &body, const Triangle &t, int p)
{
    const Vec &a = body.x[t[0]], &b = body.x[t[1]], &c = body.x[t[2]], &top = body.x[p];
    const double slack = 1e-11 * body.size3;
    for (const Triangle &s : body.surface) {
        for (int k = 0; k < 3; k++) {
            const int v = s[k], w = s[(k + 1) % 3];
            if (!has(s, t[k]) && segment_meets(top, body.x[t[k]], body.x[s[0]], body.x[s[1]], body.x[s[2]], slack))
                return false;
            if (has(t, v) && has(t, w))
                continue;
            for (int e = 0; e < 3; e++) { // from a corner of t through the face opposite to it
                const int far = t[e] == v ? w : t[e] == w ? v : -1;
                if (far >= 0 && segment_meets(body.x[t[e]], body.x[far], top, body.x[t[(e + 1) % 3]],
                                              body.x[t[(e + 2) % 3]], slack))
                    return false;
            }
            if (has(t, v))
                continue;
            const Vec &y = body.x[v];
            if (volume6(a, b, c, y) <= slack && volume6(a, b, top, y) >= -slack && volume6(b, c, top, y) >= -slack &&
                volume6(c, a, top, y) >= -slack)
                return false;
            for (int e = 0; e < 3 && !has(t, w); e++)
                if (segment_meets(y, body.x[w], top, body.x[t[e]], body.x[t[(e + 1) % 3]], slack))
                    return false;
        }
    }
    return true;
}

// When no ear is free: a point inside, put where it sees most of the surface, takes one triangle's place.
bool add_roof(Body &body)
{
    size_t best = body.surface.size(), best_seen = 0;
    Vec best_point = {0, 0, 0};
    for (size_t i = 0; i < body.surface.size(); i++) {
        const Triangle t = body.surface[i];
        const Vec normal = cross(body.x[t[1]] - body.x[t[0]], body.x[t[2]] - body.x[t[0]]);
        if (!(length(normal) > 0))
            continue;
        const Vec centre = (1.0 / 3) * (body.x[t[0]] + body.x[t[1]] + body.x[t[2]]);
        const Vec inwards = (-1.0 / length(normal)) * normal;
        const double room = clearance(body, centre, inwards, i);
        for (double part : {0.5, 0.25, 0.1}) {
            const Vec p = centre + (part * room) * inwards;
            size_t seen = 0;
            for (const Triangle &s : body.surface)
                seen += cone_volume(body, p, s) > 0;
            if (!(room < HUGE_VAL) || seen <= best_seen)
                continue;
            body.x.push_back(p);
            if (cone_volume(body, p, t) > 1e-10 * body.size3 && roof_is_free(body, t, (int)body.x.size() - 1)) {
                best = i;
                best_seen = seen;
                best_point = p;
            }
            body.x.pop_back();
        }
    }
    if (best == body.surface.size())
        return false;
    const Triangle t = body.surface[best];
    const int p = (int)body.x.size();
    body.x.push_back(best_point);
    body.surface.erase(body.surface.begin() + (std::ptrdiff_t)best);
    for (int k = 0; k < 3; k++)
        body.surface.push_back({t[k], t[(k + 1) % 3], p});
    body.tet.push_back({p, t[0], t[1], t[2]});
    return true;
}

bool peel(Body &body, unsigned order)
{
    constexpr int most_roofs = 4;
    int roofs = 0;
    while (!body.surface.empty()) {
        if (cone_from_vertex(body) || cone_from_kernel(body))
            return true;
        if (remove_tip(body))
            continue;
        bool cut = false;
        for (const Ear &ear : list_ears(body, order)) {
            if (ear_is_free(body, ear)) {
                remove_ear(body, ear);
                cut = true;
                break;
            }
        }
        if (!cut && (roofs++ == most_roofs || !add_roof(body)))
            return false;
    }
    return true;
}

double tets_volume6(const Body &body)
{
    double sum = 0;
    for (const std::array<int, 4> &t : body.tet)
        sum += volume6(body.x[t[0]], body.x[t[1]], body.x[t[2]], body.x[t[3]]);
    return sum;
}

} // namespace

PolyhedronResult split_polyhedron(PolyhedronTets &out, const Polyhedron &in)
{
    out.tet.clear();
    out.added.clear();
    std::vector<std::vector<int>> face = in.face;
    if (face.size() < 4 || !orient(face, in.point))
        return PolyhedronResult::open;
    Body whole;
    whole.x = in.point;
    for (const std::vector<int> &f : face)
        cut_face(whole.surface, in.point, in.rank, f);
    double volume = 0;
    double diagonal = 0;
    const Vec origin = in.point[face[0][0]];
    for (const Triangle &t : whole.surface)
        volume += volume6(origin, whole.x[t[0]], whole.x[t[1]], whole.x[t[2]]);
    for (const Vec &p : in.point)
        diagonal = std::max(diagonal, length(p - origin));
    if (!(std::fabs(volume) <= diagonal * diagonal * diagonal * 100)) // NaN coordinates
        return PolyhedronResult::failed;
    whole.size3 = std::fabs(volume);
    constexpr unsigned attempts = 48;
    for (unsigned order = 0; order < attempts; order++) {
        Body body = whole;
        if (!peel(body, order) || std::fabs(tets_volume6(body) - volume) > 1e-8 * std::fabs(volume))
            continue;
        out.tet = body.tet;
        out.added.assign(body.x.begin() + (std::ptrdiff_t)in.point.size(), body.x.end());
        return PolyhedronResult::ok;
    }
    return PolyhedronResult::failed;
}

} // namespace tetcast
