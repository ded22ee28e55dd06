// split_polyhedron.cpp: one polyhedron, convex or not, into tets that fill exactly its volume.
//
// Each face is cut into triangles by a rule that both of its cells share. Then, in this order: a cone from one of the
// polyhedron's own vertices, a cone from a point of its kernel (the intersection of the triangles' half-spaces, found
// by clipping a box), and for polyhedra that are not star-shaped ears: tets with two or three triangles on the surface
// are cut off one after another until the rest is star-shaped; where none is free a point is put inside. What does not
// fill the polyhedron's volume is refused.
#include "split_polyhedron.h"

#include "polyhedron_body.h"

#include <algorithm>

namespace tetcast
{

using namespace polyhedron;

static bool peel(Body &body, unsigned order)
{
    constexpr int most_roofs = 4;
    int roofs = 0;
    while (!body.surface.empty()) {
        if (cone_from_vertex(body) || cone_from_kernel(body))
            return true;
        if (cut_tip(body) || cut_ear(body, order))
            continue;
        if (roofs++ == most_roofs || !add_roof(body))
            return false;
    }
    return true;
}

static double tets_volume6(const Body &body)
{
    double sum = 0;
    for (const std::array<int, 4> &t : body.tet)
        sum += volume6(body.x[t[0]], body.x[t[1]], body.x[t[2]], body.x[t[3]]);
    return sum;
}

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
    for (unsigned order = 0; order < in.attempts; order++) {
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
