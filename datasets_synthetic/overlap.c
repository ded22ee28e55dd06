/* overlap.c: cells that lie in one another: two grids through each other; two grids of one cube, cut differently; and a
 * cube whose inner vertices have moved so far that cells are inverted where they lie. */
#include "box.h"
#include "chord.h"
#include "core/vec.h"
#include "soup.h"

/* The second grid is a unit cube, turned, and moved by this. */
static const double moved[3] = {0.3, 0.2, 0.4};

static tc_status build_grids(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_synth_soup more = {0};
    tc_box box = tc_box_unit(n_cells / 2, 1, seed);
    tc_status status = tc_box_build(out, &box, err);
    if (!status)
        status = tc_box_build(&more, &box, err);
    for (size_t v = 0; v < more.n_vertex && !status; v++) {
        double p[3];
        tc_point_turn(p, more.vertex + 3 * v);
        tc_vec_add(more.vertex + 3 * v, p, moved);
    }
    if (!status)
        status = tc_soup_append(out, &more, err);
    tc_synth_soup_finish(&more);
    return status;
}

static double chord_grids(const double *o, const double *d, size_t n_cells)
{
    double from[3], back_o[3], back_d[3];
    tc_vec_sub(from, o, moved);
    tc_point_turn_back(back_o, from);
    tc_point_turn_back(back_d, d);
    return tc_chord_unit_cube(o, d, n_cells) + tc_chord_unit_cube(back_o, back_d, n_cells);
}

static tc_status build_coincident(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_synth_soup more = {0};
    size_t n = tc_box_side(n_cells, 11, 1);
    tc_box kuhn = {{0, 0, 0}, {1, 1, 1}, {n, n, n}, 0.15, seed, TC_SPLIT_KUHN}, five = kuhn;
    five.split = TC_SPLIT_FIVE;
    five.seed = ~seed;
    tc_status status = tc_box_build(out, &kuhn, err);
    if (!status)
        status = tc_box_build(&more, &five, err);
    if (!status)
        status = tc_soup_append(out, &more, err);
    tc_synth_soup_finish(&more);
    return status;
}

static double chord_coincident(const double *o, const double *d, size_t n_cells)
{
    return 2 * tc_chord_unit_cube(o, d, n_cells);
}

static tc_status build_tangled(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_box box = tc_box_unit(n_cells, 3, seed);
    box.jitter = 0.8;
    return tc_box_build(out, &box, err);
}

enum { grid = TC_SYNTH_SOUND & ~TC_SYNTH_CONFORMING };

const tc_synth_generator tc_synth_overlap_grids = {12000,       build_grids, tc_field_linear,
                                                   chord_grids, grid,        TC_SYNTH_OVERLAPPING};
const tc_synth_generator tc_synth_overlap_coincident = {11000,
                                                        build_coincident,
                                                        tc_field_linear,
                                                        chord_coincident,
                                                        grid,
                                                        TC_SYNTH_OVERLAPPING | TC_SYNTH_TOUCHING_FACES |
                                                            TC_SYNTH_DUPLICATE_POINTS | TC_SYNTH_SHARED_FACES};
const tc_synth_generator tc_synth_tangled = {6000,
                                             build_tangled,
                                             tc_field_linear,
                                             NULL,
                                             TC_SYNTH_SIZED | TC_SYNTH_SEEDED,
                                             TC_SYNTH_INVERTED | TC_SYNTH_OVERLAPPING | TC_SYNTH_SHARED_FACES};
