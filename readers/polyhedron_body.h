// polyhedron_body.h: a polyhedron while tets are taken from it, and the ways to take them; used by split_polyhedron.cpp
// only.
#ifndef TC_READERS_POLYHEDRON_BODY_H
#define TC_READERS_POLYHEDRON_BODY_H

#include <array>
#include <cmath>
#include <vector>

namespace tetcast
{
namespace polyhedron
{

using Vec = std::array<double, 3>;
using Triangle = std::array<int, 3>;

inline Vec operator-(const Vec &a, const Vec &b)
{
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec operator+(const Vec &a, const Vec &b)
{
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec operator*(double s, const Vec &a)
{
    return {s * a[0], s * a[1], s * a[2]};
}
inline double dot(const Vec &a, const Vec &b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec cross(const Vec &a, const Vec &b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vec &a)
{
    return std::sqrt(dot(a, a));
}
inline double volume6(const Vec &a, const Vec &b, const Vec &c, const Vec &d)
{
    return dot(cross(b - a, c - a), d - a);
}

// Is p, which lies in the plane of the triangle, in it? normal gives the side it is seen from.
inline bool in_triangle(const Vec &a, const Vec &b, const Vec &c, const Vec &p, const Vec &normal)
{
    return dot(cross(b - a, p - a), normal) >= 0 && dot(cross(c - b, p - b), normal) >= 0 &&
           dot(cross(a - c, p - c), normal) >= 0;
}

struct Body {
    std::vector<Vec> x;            // grows by added points
    std::vector<Triangle> surface; // outwards
    std::vector<std::array<int, 4>> tet;
    double size3; // volume scale: what is below 1e-10 of it is rounding
};

// Volume of (p, triangle); positive when the triangle looks away from p.
inline double cone_volume(const Body &body, const Vec &p, const Triangle &t)
{
    return volume6(p, body.x[t[0]], body.x[t[1]], body.x[t[2]]);
}

inline bool has(const Triangle &t, int v)
{
    return t[0] == v || t[1] == v || t[2] == v;
}

// Turns all faces outwards. False when an edge does not have two faces, when they cannot be turned alike, or when they
// make more than one shell.
bool orient(std::vector<std::vector<int>> &face, const std::vector<Vec> &x);
// Appends the triangles of one face. They depend on the points and their ranks, not on the side it is seen from.
void cut_face(std::vector<Triangle> &out, const std::vector<Vec> &x, const std::vector<int> &rank,
              std::vector<int> polygon);

// Fills all that is left from one of its vertices, or from a point inside that sees every triangle. False: not
// possible.
bool cone_from_vertex(Body &body);
bool cone_from_kernel(Body &body);

// Cuts off one tet with two triangles on the surface, or with three. order (0, 1, …) varies which. False: none is free.
bool cut_ear(Body &body, unsigned order);
bool cut_tip(Body &body);
// Puts a point inside, where it sees most of the surface, and fills the tet below one triangle. False: none is free.
bool add_roof(Body &body);

} // namespace polyhedron
} // namespace tetcast
#endif
