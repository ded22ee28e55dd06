/* spiral.c: a rolled sheet of three turns: every ray across it crosses six gaps, and its boundary is one piece. */
#include "prism.h"

#include <math.h>

static const double turns = 3, first = 0.35, pitch = 0.3, thickness = 0.12, height = 1.2;
static const double pi = 3.14159265358979323846;

/* Clockwise from above while it widens, so that outside is on the left. */
static void curve(double *inner, double *outer, double u)
{
    double c = cos(2 * pi * turns * u), s = -sin(2 * pi * turns * u), r = first + pitch * turns * u;
    inner[0] = (r - thickness / 2) * c, inner[1] = (r - thickness / 2) * s;
    outer[0] = (r + thickness / 2) * c, outer[1] = (r + thickness / 2) * s;
}

static double across(double t)
{
    return t;
}

static double up(double t)
{
    return height * t;
}

static const tc_prism sheet = {{15, 0.12, 1.2}, 36, false, curve, across, up};

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    return tc_prism_build(out, &sheet, n_cells, seed, err);
}

static double field(const double *p)
{
    return sqrt(p[0] * p[0] + p[1] * p[1]) + 0.25 * sin(4 * p[2]);
}

static double chord(const double *origin, const double *direction, size_t n_cells)
{
    return tc_prism_chord(&sheet, origin, direction, n_cells);
}

const tc_synth_generator tc_synth_spiral = {40000, build, field, chord, TC_SYNTH_SOUND, 0};
