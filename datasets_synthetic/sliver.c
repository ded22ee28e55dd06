/* sliver.c: slivers: four vertices around a square, nearly in one plane. A lattice of cubes, each cut into tets from
 * its middle; on a square between two cubes they use different diagonals, and the tet between these is the sliver.
 * Every second vertex around a square is raised by height. With height 0 these tets have no volume at all and only keep
 * the mesh conforming; turned, and raised by less than a float resolves, they are inverted as often as not when
 * vertices are rounded to float. */
#include "box.h"
#include "chord.h"
#include "core/vec.h"
#include "soup.h"

typedef struct cubes {
    size_t n;
    double height; /* of the slivers, as a share of a cube's side */
    bool turned;
    uint64_t seed; /* moves the middles */
} cubes;

static int32_t corner(size_t n, const size_t *v)
{
    return (int32_t)(v[0] + (n + 1) * (v[1] + (n + 1) * v[2]));
}

static int32_t middle(size_t n, const size_t *c)
{
    return (int32_t)((n + 1) * (n + 1) * (n + 1) + c[0] + n * (c[1] + n * c[2]));
}

static void add_vertex(tc_builder *b, const cubes *c, const double *at)
{
    double p[3];
    if (c->turned)
        tc_point_turn(p, at);
    else
        tc_vec_copy(p, at);
    tc_builder_vertex(b, p[0], p[1], p[2]);
}

static void add_corner(tc_builder *b, const cubes *c, const size_t *v)
{
    double p[3];
    for (int a = 0; a < 3; a++) {
        bool inner = v[a] > 0 && v[a] < c->n, odd = (v[(a + 1) % 3] + v[(a + 2) % 3]) & 1;
        p[a] = ((double)v[a] + (inner && odd ? c->height : 0)) / (double)c->n;
    }
    add_vertex(b, c, p);
}

static void add_middle(tc_builder *b, const cubes *c, const size_t *v)
{
    double p[3];
    uint64_t index = v[0] + (uint64_t)c->n * (v[1] + (uint64_t)c->n * v[2]);
    for (int a = 0; a < 3; a++)
        p[a] = ((double)v[a] + 0.5 + 0.15 * tc_synth_noise(c->seed, 3 * index + (uint64_t)a)) / (double)c->n;
    add_vertex(b, c, p);
}

/* The two tets of cube v on its square perpendicular to an axis, and the sliver above it. */
static void square(tc_builder *b, const cubes *c, const size_t *v, int axis, bool upper)
{
    int u = (axis + 1) % 3, w = (axis + 2) % 3;
    int32_t q[4]; /* counter-clockwise seen from the axis' upper end, an unraised vertex first */
    size_t odd = (v[u] + v[w]) & 1;
    for (size_t i = 0; i < 4; i++) {
        size_t p[3] = {v[0], v[1], v[2]}, k = (i + odd) % 4;
        p[axis] += upper;
        p[u] += k == 1 || k == 2;
        p[w] += k >= 2;
        q[i] = corner(c->n, p);
    }
    int32_t m = middle(c->n, v);
    if (upper) { /* below the square: the unraised diagonal */
        tc_builder_tet(b, q[0], q[2], q[1], m);
        tc_builder_tet(b, q[0], q[3], q[2], m);
        if (v[axis] + 1 < c->n)
            tc_builder_tet(b, q[0], q[1], q[2], q[3]);
    } else {
        tc_builder_tet(b, q[1], q[2], q[3], m);
        tc_builder_tet(b, q[1], q[3], q[0], m);
    }
}

static tc_status build(tc_synth_soup *out, const cubes *c, tc_error *err)
{
    size_t n = c->n, v[3];
    tc_builder b = {.soup = out};
    for (size_t half = 0; half < 2; half++) /* corners, then middles */
        for (v[2] = 0; v[2] <= n - half; v[2]++)
            for (v[1] = 0; v[1] <= n - half; v[1]++)
                for (v[0] = 0; v[0] <= n - half && !b.failure; v[0]++) {
                    if (half)
                        add_middle(&b, c, v);
                    else
                        add_corner(&b, c, v);
                }
    for (v[2] = 0; v[2] < n; v[2]++)
        for (v[1] = 0; v[1] < n; v[1]++)
            for (v[0] = 0; v[0] < n && !b.failure; v[0]++)
                for (int axis = 0; axis < 3; axis++) {
                    square(&b, c, v, axis, false);
                    square(&b, c, v, axis, true);
                }
    return tc_builder_done(&b, err);
}

static double chord_turned(const double *o, const double *d, size_t n_cells)
{
    double back_o[3], back_d[3];
    tc_point_turn_back(back_o, o);
    tc_point_turn_back(back_d, d);
    return tc_chord_unit_cube(back_o, back_d, n_cells);
}

enum {
    default_cells = 7488,
    sliver = (TC_SYNTH_SOUND | TC_SYNTH_CONVEX) & ~TC_SYNTH_SHAPELY,
    flat = sliver & ~TC_SYNTH_POSITIVE
};

#define SLIVER(id, height, turned, chord, promises, defects)                                                           \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        cubes c = {tc_box_side(n_cells, 15, 2), height, turned, seed};                                                 \
        return build(out, &c, err);                                                                                    \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {default_cells, build_##id, tc_field_linear, chord, promises, defects};

SLIVER(sliver_1e3, 1e-3, false, tc_chord_unit_cube, sliver, 0)
SLIVER(sliver_1e5, 1e-5, false, tc_chord_unit_cube, sliver, 0)
SLIVER(sliver_1e8, 1e-8, false, tc_chord_unit_cube, sliver, 0)
SLIVER(sliver_folded, 1e-8, true, chord_turned, sliver, TC_SYNTH_ROUNDS_INVERTED)
SLIVER(flat_cells, 0, false, tc_chord_unit_cube, flat, TC_SYNTH_FLAT)
