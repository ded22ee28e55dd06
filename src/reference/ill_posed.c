/* ill_posed.c: moves a ray, the data and the mesh by what rounding may move them, and watches the colour. */
#include "reference/ill_posed.h"

#include "core/vec.h"

#include <math.h>

/* Of the diagonal, of the data's range. */
static const double SHIFT = 1.0 / 4194304;

/* What the picture may not know: the reference is asked again with each of these moves. */
enum { SIDES = 8, DATA = SIDES, APART = DATA + 2, TURNS = APART + 2, ROUNDED = TURNS + 3, MOVES_N = ROUNDED + 16 };

/* Move k of a line; *data is what to add to every scalar.
 *   SIDES    the ray goes by SHIFT of the diagonal to the four sides, along u and v, and to the four corners between
 *            them: a ray at a corner of the hull may stay in the mesh, or out of it, on all four sides
 *   DATA     the data move by SHIFT of their range, and those of a field for colour by SHIFT of theirs
 *   APART    overlapping parts of the mesh move against each other along the ray by up to SHIFT of the diagonal
 *   TURNS    a ray that lies in a face or runs through an edge or a vertex is on no particular side of it; the trace
 *            takes one, by a move of no length along u and v, and is asked for the others by turning these
 *   ROUNDED  each vertex moves by itself by up to a quarter of SHIFT, as rounding to float moves it: what a thin plate
 *            shows hangs on its thickness, which no move of the whole tells */
static tc_line move_line(double *data, const tc_reference *reference, double range, const tc_line *line, int k)
{
    static const double side[SIDES][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    const double by = SHIFT * 2 * reference->half_diagonal;
    tc_line moved = *line;
    *data = 0;
    if (k < DATA) {
        tc_vec_mul_add(moved.base, line->base, by * side[k][0], line->u);
        tc_vec_mul_add(moved.base, moved.base, by * side[k][1], line->v);
    } else if (k < APART) {
        *data = k % 2 ? -SHIFT * range : SHIFT * range;
        moved.data = k % 2 ? -SHIFT : SHIFT;
    } else if (k < TURNS) {
        moved.unsure = k % 2 ? -by : by;
    } else if (k < ROUNDED) {
        static const double turn[3][2] = {{0, 1}, {-1, 0}, {0, -1}};
        const double *t = turn[k - TURNS];
        for (int i = 0; i < 3; i++) {
            moved.u[i] = t[0] * line->u[i] + t[1] * line->v[i];
            moved.v[i] = t[0] * line->v[i] - t[1] * line->u[i];
        }
    } else {
        moved.rounding = 0.25 * by;
        moved.draw = (uint32_t)k;
    }
    return moved;
}

double tc_color_distance(const double *a, const double *b)
{
    double m = 0;
    for (int i = 0; i < 4; i++)
        m = fmax(m, fabs(a[i] - b[i]));
    return m;
}

tc_status tc_line_sway(double *out, const tc_reference *reference, const tc_transfer *tf, double unit, double range,
                       const tc_line *line, const double *rgba, double enough, int worker)
{
    *out = 0;
    for (int k = 0; k < MOVES_N && *out <= enough; k++) {
        double data;
        tc_line moved = move_line(&data, reference, range, line, k);
        tc_reference_ray other;
        tc_status status = tc_line_trace(&other, reference, tf, unit, &moved, data, worker);
        if (status != TC_OK)
            return status;
        *out = fmax(*out, tc_color_distance(other.rgba, rgba));
    }
    return TC_OK;
}
