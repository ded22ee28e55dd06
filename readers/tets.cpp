// tets.cpp: the tets under construction.
#include "tets.h"

#include <utility>

namespace tetcast
{

double tet_volume6(const double *a, const double *b, const double *c, const double *d)
{
    const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    const double wx = d[0] - a[0], wy = d[1] - a[1], wz = d[2] - a[2];
    return (uy * vz - uz * vy) * wx + (uz * vx - ux * vz) * wy + (ux * vy - uy * vx) * wz;
}

int32_t Tets::add_point(const double *x, const int32_t *id, const double *w, size_t n)
{
    if (n_point() >= (size_t)INT32_MAX)
        throw Refusal("splitting the cells gives more than 2147483647 points, the most a mesh can hold");
    const int32_t made = (int32_t)n_point();
    point.insert(point.end(), x, x + 3);
    rank.push_back(made);
    weight_id.insert(weight_id.end(), id, id + n);
    weight.insert(weight.end(), w, w + n);
    weight_first.push_back(weight_id.size());
    return made;
}

void Tets::add_tet(int64_t cell_id, int32_t a, int32_t b, int32_t c, int32_t d)
{
    if (a == b || a == c || a == d || b == c || b == d || c == d)
        return;
    if (cell.size() >= (size_t)INT32_MAX)
        throw Refusal("splitting the cells gives more than 2147483647 tets, the most a mesh can hold");
    if (tet_volume6(at(a), at(b), at(c), at(d)) < 0)
        std::swap(c, d);
    const int32_t made[4] = {a, b, c, d};
    tet.insert(tet.end(), made, made + 4);
    cell.push_back(cell_id);
}

} // namespace tetcast
