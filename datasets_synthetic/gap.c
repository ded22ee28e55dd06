/* gap.c: two boxes a hair apart, or a hair into each other, and two blocks hinged at an edge with a gap of less than
 * 0.1 degrees between them; the divisions of the two sides differ. TetGen 1.5.0 takes points as near as these for one,
 * loses facets, or crashes. */
#include "box.h"
#include "chord.h"
#include "soup.h"

#include <math.h>

/* Adds what a lattice makes. */
static tc_status add(tc_synth_soup *out, const tc_lattice *lattice, tc_error *err)
{
    tc_synth_soup more = {0};
    tc_status status = tc_lattice_build(&more, lattice, err);
    if (!status)
        status = tc_soup_append(out, &more, err);
    tc_synth_soup_finish(&more);
    return status;
}

static const double size[3] = {0.5, 1, 1};

/* Box `which` of the two; the second one begins gap behind the first one's end. */
static void corners(double lo[3], double hi[3], int which, double gap)
{
    for (int a = 0; a < 3; a++)
        lo[a] = which && a == 0 ? size[0] + gap : 0, hi[a] = lo[a] + size[a];
}

static tc_status build_gap(tc_synth_soup *out, size_t n_cells, uint64_t seed, double gap, tc_error *err)
{
    size_t n = tc_box_side(n_cells, 6 * (4 + 6.75), 1);
    tc_status status = TC_OK;
    for (int which = 0; which < 2 && !status; which++) {
        size_t m = which ? (3 * n + 1) / 2 : n;
        tc_box box = {.n = {m, which ? 2 * m : 2 * n, which ? 2 * m : 2 * n}, .jitter = 0.15, .seed = seed};
        tc_synth_soup more = {0};
        corners(box.lo, box.hi, which, gap);
        status = tc_box_build(&more, &box, err);
        if (!status)
            status = tc_soup_append(out, &more, err);
        tc_synth_soup_finish(&more);
    }
    return status;
}

static double chord_gap(const double *o, const double *d, double gap)
{
    double length = 0;
    for (int which = 0; which < 2; which++) {
        double lo[3], hi[3];
        corners(lo, hi, which, gap);
        length += tc_chord_box(lo, hi, o, d);
    }
    return length;
}

enum { parts = TC_SYNTH_POSITIVE | TC_SYNTH_SEEDED };

#define GAP(id, gap, promises, defects)                                                                                \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        return build_gap(out, n_cells, seed, gap, err);                                                                \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        (void)n_cells;                                                                                                 \
        return chord_gap(o, d, gap);                                                                                   \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {8256, build_##id, tc_field_linear, chord_##id, promises, defects};

GAP(gap_1e_4, 1e-4, parts | TC_SYNTH_CONFORMING, 0)
GAP(gap_1e_7, 1e-7, parts | TC_SYNTH_CONFORMING, 0)
GAP(gap_1e_12, 1e-12, parts | TC_SYNTH_CONFORMING, 0)
GAP(overlap_1e_7, -1e-7, parts, TC_SYNTH_OVERLAPPING)
GAP(overlap_1e_12, -1e-12, parts, TC_SYNTH_OVERLAPPING)

/* A block over the square [0, 1] x [0, 1], above a plane through the y axis that rises at an angle, or below its mirror
 * image. */
typedef struct leaf {
    size_t n[3];
    double slope;
    bool lower;
    double apart; /* how far the lower block's edge is from that of the upper one */
} leaf;

static void place(const void *context, double *out, const size_t *v)
{
    const leaf *l = context;
    double up = (double)v[2] / (double)l->n[2], x = (double)v[0] / (double)l->n[0], side = l->slope * x;
    out[0] = v[0] == 0 ? l->apart : x;
    out[1] = (double)(l->lower ? l->n[1] - v[1] : v[1]) / (double)l->n[1]; /* both keep the orientation of the axes */
    out[2] = v[2] == l->n[2] ? 1 : side + up * (1 - side);
    if (l->lower)
        out[2] = -out[2];
}

static tc_status build_hinge(tc_synth_soup *out, size_t n_cells, double slope, double apart, tc_error *err)
{
    size_t n = tc_box_side(n_cells, 6 * 3, 1);
    leaf upper = {{n, n, n}, slope, false, 0}, lower = {{2 * n, n, n}, slope, true, apart};
    tc_lattice lattice = {{n, n, n}, false, NULL, place, &upper, TC_SPLIT_KUHN};
    tc_status status = add(out, &lattice, err);
    lattice.n[0] = 2 * n;
    lattice.context = &lower;
    if (!status)
        status = add(out, &lattice, err);
    return status ? status : tc_soup_weld(out, err);
}

/* Two boxes less the wedge between the leaves. */
static double chord_hinge(const double *o, const double *d, double slope)
{
    static const double lo[3] = {0, 0, -1}, hi[3] = {1, 1, 1};
    const double edge[2][3] = {{0, 0, 0}, {0, 1, 0}}, end[2][3] = {{1, 0, slope}, {1, 0, -slope}};
    const double right[3][3] = {{1, 0, 0}, {1, 1, 0}, {1, 0, 1}};
    const double front[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, rear[3][3] = {{0, 1, 0}, {0, 1, 1}, {1, 1, 0}};
    tc_span cut = tc_span_whole();
    tc_span_clip(&cut, o, d, edge[0], end[0], edge[1]);
    tc_span_clip(&cut, o, d, edge[0], edge[1], end[1]);
    tc_span_clip(&cut, o, d, right[0], right[1], right[2]);
    tc_span_clip(&cut, o, d, front[0], front[1], front[2]);
    tc_span_clip(&cut, o, d, rear[0], rear[1], rear[2]);
    return tc_chord_box(lo, hi, o, d) - tc_span_length(cut);
}

static const double degree = 3.14159265358979323846 / 180;

#define HINGE(id, angle, apart)                                                                                        \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        (void)seed;                                                                                                    \
        return build_hinge(out, n_cells, tan(angle / 2 * degree), apart, err);                                         \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        (void)n_cells;                                                                                                 \
        return chord_hinge(o, d, tan(angle / 2 * degree));                                                             \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {                                                                         \
        9216, build_##id, tc_field_linear, chord_##id, TC_SYNTH_POSITIVE | TC_SYNTH_CONFORMING, 0};

HINGE(hinge_5e_2, 0.05, 0)
HINGE(hinge_apart, 1e-3, 1e-16)
