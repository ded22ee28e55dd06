/* comb.c: a spine with 40 thin teeth: a ray along the spine leaves the mesh and comes back 39 times. */
#include "blocks.h"

#include <math.h>

static bool keep(int i, int j, int k)
{
    (void)j;
    return k == 0 || i % 2 == 0;
}

static void shape(tc_blocks *b)
{
    static const double tooth_gap[2] = {0.02, 0.03}, depth[1] = {0.3}, spine_tooth[2] = {0.15, 0.75};
    tc_blocks_set_axis(b, 0, 79, tooth_gap, 2);
    tc_blocks_set_axis(b, 1, 1, depth, 1);
    tc_blocks_set_axis(b, 2, 2, spine_tooth, 2);
    b->keep = keep;
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_blocks b;
    shape(&b);
    return tc_blocks_build(out, &b, n_cells, seed, err);
}

static double field(const double *p)
{
    return sin(3 * p[0]) * cos(2 * p[2]) + p[1];
}

static double chord(const double *origin, const double *direction, size_t n_cells)
{
    (void)n_cells;
    tc_blocks b;
    shape(&b);
    return tc_blocks_chord(&b, origin, direction);
}

const tc_synth_generator tc_synth_comb = {30000, build, field, chord, TC_SYNTH_SOUND, 0};
