/* kuhn.c: the unit cube, cut by a Kuhn lattice whose vertices are moved at random; those of the boundary move within
 * it. The field is linear, so that a mesh represents it exactly at every size. */
#include "blocks.h"

static bool keep_all(int i, int j, int k)
{
    (void)i, (void)j, (void)k;
    return true;
}

static const tc_blocks cube = {{1, 1, 1}, {{0, 1}, {0, 1}, {0, 1}}, keep_all};

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    return tc_blocks_build(out, &cube, n_cells, seed, err);
}

static double field(const double *p)
{
    return (p[0] + 2 * p[1] + 3 * p[2]) / 6;
}

static double chord(const double *origin, const double *direction, size_t n_cells)
{
    (void)n_cells;
    return tc_blocks_chord(&cube, origin, direction);
}

const tc_synth_generator tc_synth_kuhn = {48000, build, field, chord, TC_SYNTH_SOUND | TC_SYNTH_CONVEX, 0};
