/* cycle.c: visibility cycles (Williams 1992, figure 4): tets that do not touch, each over the next one at one end and
 * below the one before at the other, so that no order from front to back exists along z. */
#include "box.h"
#include "chord.h"
#include "soup.h"

#include <math.h>

static const double rise = 0.35, width = 0.6;

static size_t count(size_t n_cells)
{
    return n_cells < 3 ? 3 : n_cells;
}

/* Bar i lies along side i of a regular polygon around the z axis, longer than the side at both ends, and rises along
 * it; corners [4][3]: a low edge across its beginning, an upright edge at its end. */
static void bar(double corner[4][3], size_t i, size_t n)
{
    const double step = 2 * 3.14159265358979323846 / (double)n, angle = step * (double)i;
    const double along[2] = {-sin(angle), cos(angle)}, out[2] = {cos(angle), sin(angle)};
    const double half = 1.5 * tan(step / 2), w = width / (double)n;
    for (int c = 0; c < 4; c++) {
        double t = c < 2 ? -half : half;
        double r = 1 + (c == 0 ? -w : c == 1 ? w : 0);
        corner[c][0] = r * out[0] + t * along[0];
        corner[c][1] = r * out[1] + t * along[1];
        corner[c][2] = c < 2 ? 0 : c == 2 ? rise - 0.03 : rise + 0.03;
    }
}

static tc_status build(tc_synth_soup *out, size_t n, tc_error *err)
{
    tc_builder b = {.soup = out};
    for (size_t i = 0; i < n && !b.failure; i++) {
        double p[4][3];
        int32_t v[4];
        bar(p, i, n);
        for (int c = 0; c < 4; c++)
            v[c] = tc_builder_vertex(&b, p[c][0], p[c][1], p[c][2]);
        tc_builder_tet(&b, v[0], v[1], v[2], v[3]);
    }
    return tc_builder_done(&b, err);
}

static double chord(const double *o, const double *d, size_t n)
{
    double length = 0;
    for (size_t i = 0; i < n; i++) {
        double p[4][3];
        bar(p, i, n);
        length += tc_chord_tet(p[0], p[1], p[2], p[3], o, d);
    }
    return length;
}

static tc_status build_three(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)n_cells, (void)seed;
    return build(out, 3, err);
}

static double chord_three(const double *o, const double *d, size_t n_cells)
{
    (void)n_cells;
    return chord(o, d, 3);
}

static tc_status build_ring(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)seed;
    return build(out, count(n_cells), err);
}

static double chord_ring(const double *o, const double *d, size_t n_cells)
{
    return chord(o, d, count(n_cells));
}

enum { promises = TC_SYNTH_POSITIVE | TC_SYNTH_CONFORMING };

const tc_synth_generator tc_synth_cycle = {3, build_three, tc_field_linear, chord_three, promises, 0};
const tc_synth_generator tc_synth_cycle_ring = {12, build_ring, tc_field_linear, chord_ring, promises | TC_SYNTH_SIZED,
                                                0};
