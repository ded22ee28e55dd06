/* ball.c: a ball of radius 1: convex, with no face that is parallel to another by construction. */
#include "octa.h"

#include <math.h>

static tc_octa shape(size_t n_cells)
{
    tc_octa octa = {.n_shell = 1, .r = {{0, 1}}};
    tc_octa_resolve(&octa, n_cells);
    return octa;
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_octa octa = shape(n_cells);
    return tc_octa_build(out, &octa, seed, err);
}

/* Distance from the centre, in waves along z. */
static double field(const double *p)
{
    return sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) + 0.15 * sin(6 * p[2]);
}

static double chord(const double *origin, const double *direction, size_t n_cells)
{
    tc_octa octa = shape(n_cells);
    return tc_octa_chord(&octa, origin, direction);
}

const tc_synth_generator tc_synth_ball = {200000, build, field, chord, TC_SYNTH_SOUND | TC_SYNTH_CONVEX, 0};
