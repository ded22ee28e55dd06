// polyhedron_ears.cpp: tets that can be cut off a polyhedron which no point sees whole.
#include "polyhedron_body.h"

#include <algorithm>
#include <map>
#include <utility>

namespace tetcast
{
namespace polyhedron
{

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
static bool segment_meets(const Vec &p, const Vec &q, const Vec &a, const Vec &b, const Vec &c, double slack)
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
static bool segment_runs_in(const Vec &p, const Vec &q, const Vec &a, const Vec &b, double slack)
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
static bool ear_is_free(const Body &body, const Ear &ear)
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
static std::vector<Ear> list_ears(const Body &body, unsigned order)
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

static void remove_ear(Body &body, const Ear &ear)
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

bool cut_ear(Body &body, unsigned order)
{
    for (const Ear &ear : list_ears(body, order))
        if (ear_is_free(body, ear)) {
            remove_ear(body, ear);
            return true;
        }
    return false;
}

// A vertex with three triangles is a tet of its own, unless it points inwards or something is in it.
bool cut_tip(Body &body)
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
static double clearance(const Body &body, const Vec &x, const Vec &direction, size_t own)
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
        if (s > 0 && s < nearest && in_triangle(a, b, c, y, normal))
            nearest = s;
    }
    return nearest;
}

// May the tet of triangle t and the point p (the last in body.x) be filled? Its edges must not meet the surface, no
// vertex may lie in it, no edge may come through its new faces.
static bool roof_is_free(const Body &body, const Triangle &t, int p)
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

} // namespace polyhedron
} // namespace tetcast
