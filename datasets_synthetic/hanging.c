/* hanging.c: parts that lie on each other without sharing whole faces: hanging nodes where cells are half as large on
 * one side of a plane, or in a cube inside; and boxes stacked like bricks. */
#include "box.h"
#include "chord.h"
#include "soup.h"

/* Adds a box. */
static tc_status add_box(tc_synth_soup *out, const tc_box *box, tc_error *err)
{
    tc_synth_soup more = {0};
    tc_status status = tc_box_build(&more, box, err);
    if (!status)
        status = tc_soup_append(out, &more, err);
    tc_synth_soup_finish(&more);
    return status;
}

/* A unit cube, its upper half in cells of half the size; 6 (4 n^3 + 32 n^3) tets. */
static tc_status build_nodes(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    size_t n = tc_box_side(n_cells, 6 * 36, 1);
    tc_box lower = {{0, 0, 0}, {1, 1, 0.5}, {2 * n, 2 * n, n}, 0.15, seed, TC_SPLIT_KUHN};
    tc_box upper = {{0, 0, 0.5}, {1, 1, 1}, {4 * n, 4 * n, 2 * n}, 0.15, ~seed, TC_SPLIT_KUHN};
    tc_status status = add_box(out, &lower, err);
    if (!status)
        status = add_box(out, &upper, err);
    return status ? status : tc_soup_weld(out, err);
}

typedef struct patch {
    size_t n; /* cubes a side, of which the middle half is refined */
} patch;

static bool outside(const void *context, const size_t *cube)
{
    size_t n = ((const patch *)context)->n, inside = 0;
    for (int a = 0; a < 3; a++)
        inside += cube[a] >= n / 4 && cube[a] < n - n / 4;
    return inside < 3;
}

static void place(const void *context, double *out, const size_t *v)
{
    for (int a = 0; a < 3; a++)
        out[a] = (double)v[a] / (double)((const patch *)context)->n;
}

/* A unit cube, the middle of it in cells of half the size; 6 (56 n^3 + 64 n^3) tets. */
static tc_status build_patch(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    patch p = {4 * tc_box_side(n_cells, 6 * 120, 1)};
    tc_lattice lattice = {{p.n, p.n, p.n}, false, outside, place, &p, TC_SPLIT_KUHN};
    tc_box inner = {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}, {p.n, p.n, p.n}, 0.15, seed, TC_SPLIT_KUHN};
    tc_status status = tc_lattice_build(out, &lattice, err);
    if (!status)
        status = add_box(out, &inner, err);
    return status ? status : tc_soup_weld(out, err);
}

/* Where bricks lie: two in the lower layer, three of which two are halves in the upper one. */
static const double brick[5][2][3] = {{{0, 0, 0}, {1, 0.7, 0.5}},
                                      {{1, 0, 0}, {2, 0.7, 0.5}},
                                      {{0, 0, 0.5}, {0.45, 0.7, 1}},
                                      {{0.45, 0, 0.5}, {1.45, 0.7, 1}},
                                      {{1.45, 0, 0.5}, {2, 0.7, 1}}};

static tc_status build_bricks(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    size_t n = tc_box_side(n_cells, 6 * 5, 1);
    tc_status status = TC_OK;
    for (int i = 0; i < 5 && !status; i++) {
        tc_box box = {.n = {n, n, n}, .jitter = 0.15, .seed = seed + (uint64_t)i};
        for (int a = 0; a < 3; a++)
            box.lo[a] = brick[i][0][a], box.hi[a] = brick[i][1][a];
        status = add_box(out, &box, err);
    }
    return status;
}

static double chord_bricks(const double *o, const double *d, size_t n_cells)
{
    (void)n_cells;
    double length = 0;
    for (int i = 0; i < 5; i++)
        length += tc_chord_box(brick[i][0], brick[i][1], o, d);
    return length;
}

enum { nodes = TC_SYNTH_POSITIVE | TC_SYNTH_SHAPELY | TC_SYNTH_SEEDED, bricks = nodes | TC_SYNTH_SIZED };

const tc_synth_generator tc_synth_hanging_nodes = {
    13824, build_nodes, tc_field_linear, tc_chord_unit_cube, nodes, TC_SYNTH_TOUCHING_FACES};
const tc_synth_generator tc_synth_hanging_patch = {
    5760, build_patch, tc_field_linear, tc_chord_unit_cube, nodes, TC_SYNTH_TOUCHING_FACES};
const tc_synth_generator tc_synth_bricks = {
    6480, build_bricks, tc_field_linear, chord_bricks, bricks, TC_SYNTH_TOUCHING_FACES | TC_SYNTH_DUPLICATE_POINTS};
