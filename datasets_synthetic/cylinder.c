/* cylinder.c: an upright cylinder with a hole through it. */
#include "prism.h"

#include <math.h>

static const double inner_radius = 0.4, height = 2;
static const double pi = 3.14159265358979323846;

/* Clockwise from above, so that outside is on the left. */
static void curve(double *inner, double *outer, double u)
{
    double c = cos(2 * pi * u), s = -sin(2 * pi * u);
    inner[0] = inner_radius * c, inner[1] = inner_radius * s;
    outer[0] = c, outer[1] = s;
}

static double across(double t)
{
    return t;
}

static double up(double t)
{
    return height * t;
}

static const tc_prism cylinder = {{4.4, 0.6, 2}, 12, true, curve, across, up};

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    return tc_prism_build(out, &cylinder, n_cells, seed, err);
}

/* A wave that winds around the axis. */
static double field(const double *p)
{
    double r = sqrt(p[0] * p[0] + p[1] * p[1]);
    return 1 + (p[0] * cos(pi * p[2]) + p[1] * sin(pi * p[2])) * (1.4 - r);
}

static double chord(const double *origin, const double *direction, size_t n_cells)
{
    return tc_prism_chord(&cylinder, origin, direction, n_cells);
}

const tc_synth_generator tc_synth_cylinder = {200000, build, field, chord, TC_SYNTH_SOUND, 0};
