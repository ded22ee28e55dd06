/* shells.c: three shells one in another, none touching the next, around a cavity: three parts, two of them unreachable
 * from outside without crossing another. */
#include "octa.h"

#include <math.h>

static tc_octa shape(size_t n_cells)
{
    tc_octa octa = {.n_shell = 3, .r = {{0.2, 0.4}, {0.5, 0.7}, {0.8, 1}}};
    tc_octa_resolve(&octa, n_cells);
    return octa;
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_octa octa = shape(n_cells);
    return tc_octa_build(out, &octa, seed, err);
}

static double field(const double *p)
{
    double r = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    return r + 0.3 * p[0] * p[1];
}

static double chord(const double *origin, const double *direction, size_t n_cells)
{
    tc_octa octa = shape(n_cells);
    return tc_octa_chord(&octa, origin, direction);
}

const tc_synth_generator tc_synth_shells = {50000, build, field, chord, TC_SYNTH_SOUND, 0};
