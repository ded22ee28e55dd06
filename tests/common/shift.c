/* shift.c: moves a ray a little. */
#include "shift.h"

#include "core/vec.h"

void ray_shift(double moved[3], const double origin[3], const double direction[3], double by, int side)
{
    static const int to[RAY_SIDES][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    double axis[3] = {0, 0, 0}, u[3], v[3];
    axis[fabs(direction[0]) < 0.6 ? 0 : 1] = 1;
    tc_vec_cross(u, direction, axis);
    tc_vec_normalize(u);
    tc_vec_cross(v, u, direction);
    tc_vec_mul_add(moved, origin, to[side][0] * by, u);
    tc_vec_mul_add(moved, moved, to[side][1] * by, v);
}
