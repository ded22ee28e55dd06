/* bluntfin.c: flow around a blunt fin that stands on a wall, in a channel: a C-shaped grid like that of the blunt fin
 * of Hung and Buning 1985, which Weiler et al. 2003 use, with an analytic density in place of their solution. */
#include "prism.h"

#include <math.h>

static const double radius = 0.5;            /* of the fin's nose, whose centre is the origin; the fin points to -x */
static const double ahead = 3, beside = 2.5; /* half axes of the inflow boundary, and half the channel's width */
static const double behind = 4, height = 3;
static const double side = 0.3; /* share of the strip that follows either flat side */
static const double half_pi = 1.57079632679489661923;

/* From the end of the fin's right side around the nose to the end of its left side; outside is on the left. */
static void curve(double *inner, double *outer, double u)
{
    if (u < side || u > 1 - side) {
        double x = behind * (1 - (u < side ? u : 1 - u) / side), y = u < side ? -1 : 1;
        inner[0] = outer[0] = x;
        inner[1] = radius * y;
        outer[1] = beside * y;
        return;
    }
    double angle = half_pi * (2 * u - 1) / (1 - 2 * side), c = cos(angle), s = sin(angle);
    inner[0] = -radius * c, inner[1] = radius * s;
    outer[0] = -ahead * c, outer[1] = beside * s;
}

/* Denser towards the fin and towards the wall. */
static double across(double t)
{
    return expm1(1.5 * t) / expm1(1.5);
}

static double up(double t)
{
    return height * expm1(1.2 * t) / expm1(1.2);
}

static const tc_prism channel = {{13, 2.2, 3}, 12, false, curve, across, up};

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    return tc_prism_build(out, &channel, n_cells, seed, err);
}

/* Density over that of the free stream: a detached bow shock, which starts further ahead near the wall, compression at
 * the nose, expansion along the sides and a thin warm layer at the wall. */
static double field(const double *p)
{
    double ground = exp(-2.5 * p[2]);
    double shock = 0.22 * p[1] * p[1] - 1.0 - 0.9 * ground; /* x of the shock */
    double jump = 0.5 * (1 + tanh((p[0] - shock) / 0.12));
    double from_nose = sqrt(p[0] * p[0] + p[1] * p[1]) - radius;
    double compression = 2.4 * exp(-1.3 * from_nose) * exp(-0.8 * fmax(0, p[0] + radius));
    double wake = 0.55 * exp(-fabs(p[1])) * (1 - exp(-fmax(0, p[0])));
    return (1 + jump * (0.9 + compression) - wake) * (1 - 0.35 * exp(-12 * p[2]));
}

static double chord(const double *origin, const double *direction, size_t n_cells)
{
    return tc_prism_chord(&channel, origin, direction, n_cells);
}

const tc_synth_generator tc_synth_bluntfin = {190000, build, field, chord, TC_SYNTH_SOUND, 0};
