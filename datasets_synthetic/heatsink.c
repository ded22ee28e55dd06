/* heatsink.c: a base plate with twelve fins, each cut across three times: 48 plates, many gaps for a ray to cross.
 * The size follows the heat sink of Weiler et al. 2003, table 2 (121 668 tets). The field is the temperature of a fin
 * with an adiabatic tip, cosh(m (H - z)) / cosh(m H) (Incropera and DeWitt, table 3.4), over a warm spot in the base.
 */
#include "blocks.h"

#include <math.h>

static const double base_height = 0.12, fin_height = 0.78;

/* Fins and gaps alternate, along x narrow and along y wide. */
static bool keep(int i, int j, int k)
{
    return k == 0 || (i % 2 == 0 && j % 2 == 0);
}

static void shape(tc_blocks *b)
{
    static const double fin_gap[2] = {0.05, 0.06}, plate_cut[2] = {0.28, 0.06};
    const double base_fin[2] = {base_height, fin_height};
    tc_blocks_set_axis(b, 0, 23, fin_gap, 2);
    tc_blocks_set_axis(b, 1, 7, plate_cut, 2);
    tc_blocks_set_axis(b, 2, 2, base_fin, 2);
    b->keep = keep;
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_blocks b;
    shape(&b);
    return tc_blocks_build(out, &b, n_cells, seed, err);
}

/* Degrees above the air: about 75 in the middle of the base, about 10 at the tips of the outer fins. */
static double field(const double *p)
{
    const double m = 2.2, dx = p[0] - 0.63, dy = p[1] - 0.65;
    double spot = 0.4 + 0.6 * exp(-2.5 * (dx * dx + dy * dy));
    double above = fmax(0, p[2] - base_height);
    return 75 * spot * cosh(m * (fin_height - above)) / cosh(m * fin_height);
}

static double chord(const double *origin, const double *direction, size_t n_cells)
{
    (void)n_cells;
    tc_blocks b;
    shape(&b);
    return tc_blocks_chord(&b, origin, direction);
}

const tc_synth_generator tc_synth_heatsink = {121668, build, field, chord, TC_SYNTH_SOUND, 0};
