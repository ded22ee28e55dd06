/* bcc.c: the body-centred cubic lattice: cubes with a vertex in their middle. Around each edge between two middles lie
 * four equal tets, one for each edge of the square between the cubes; squares of the boundary are cut in two. */
#include "box.h"
#include "chord.h"
#include "soup.h"

static int32_t corner(size_t n, const size_t *v)
{
    return (int32_t)(v[0] + (n + 1) * (v[1] + (n + 1) * v[2]));
}

static int32_t middle(size_t n, const size_t *c)
{
    return (int32_t)((n + 1) * (n + 1) * (n + 1) + c[0] + n * (c[1] + n * c[2]));
}

/* The tets across the square of cube c that is perpendicular to an axis; upper: on its upper side. */
static void square(tc_builder *b, size_t n, const size_t *c, int axis, bool upper)
{
    int u = (axis + 1) % 3, v = (axis + 2) % 3;
    int32_t q[4]; /* counter-clockwise seen from the axis' upper end */
    for (int i = 0; i < 4; i++) {
        size_t p[3] = {c[0], c[1], c[2]};
        p[axis] += upper;
        p[u] += i == 1 || i == 2;
        p[v] += i >= 2;
        q[i] = corner(n, p);
    }
    int32_t here = middle(n, c);
    if (upper && c[axis] + 1 < n) {
        size_t next[3] = {c[0], c[1], c[2]};
        next[axis]++;
        for (int i = 0; i < 4; i++)
            tc_builder_tet(b, here, q[i], q[(i + 1) % 4], middle(n, next));
    } else if (upper || c[axis] == 0) {
        tc_builder_tet_turned(b, q[0], q[2], q[1], here, !upper);
        tc_builder_tet_turned(b, q[0], q[3], q[2], here, !upper);
    }
}

static tc_status build(tc_synth_soup *out, size_t n_cells, double spacing, tc_error *err)
{
    size_t n = tc_box_side(n_cells, 12, 1), v[3];
    tc_builder b = {.soup = out};
    for (size_t half = 0; half < 2; half++) /* corners, then middles */
        for (v[2] = 0; v[2] <= n - half; v[2]++)
            for (v[1] = 0; v[1] <= n - half; v[1]++)
                for (v[0] = 0; v[0] <= n - half && !b.failure; v[0]++)
                    tc_builder_vertex(&b, ((double)v[0] + 0.5 * (double)half) * spacing,
                                      ((double)v[1] + 0.5 * (double)half) * spacing,
                                      ((double)v[2] + 0.5 * (double)half) * spacing);
    for (v[2] = 0; v[2] < n; v[2]++)
        for (v[1] = 0; v[1] < n; v[1]++)
            for (v[0] = 0; v[0] < n && !b.failure; v[0]++)
                for (int axis = 0; axis < 3; axis++) {
                    square(&b, n, v, axis, false);
                    square(&b, n, v, axis, true);
                }
    return tc_builder_done(&b, err);
}

static double chord(const double *o, const double *d, size_t n_cells, double spacing)
{
    double side = (double)tc_box_side(n_cells, 12, 1) * spacing;
    const double lo[3] = {0, 0, 0}, hi[3] = {side, side, side};
    return tc_chord_box(lo, hi, o, d);
}

enum { promises = (TC_SYNTH_SOUND | TC_SYNTH_CONVEX) & ~TC_SYNTH_SEEDED };

#define BCC(id, cells, spacing)                                                                                        \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        (void)seed;                                                                                                    \
        return build(out, n_cells, spacing, err);                                                                      \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        return chord(o, d, n_cells, spacing);                                                                          \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {cells, build_##id, tc_field_linear, chord_##id, promises, 0};

BCC(grid_bcc, 49152, 0x1p-4)
BCC(grid_bcc_tenth, 12000, 0.1)
