/* notch.c: gaps between two facets that meet at a very small angle: a box with a cut that is wedge-shaped, and blades
 * that meet in one edge. TetGen 1.5.0 can loop on facets closer than about 0.1 degrees. */
#include "box.h"
#include "chord.h"
#include "soup.h"

#include <math.h>
#include <string.h>

static const double degree = 3.14159265358979323846 / 180;

/* Half of the box [-1, 1] x [0, 1] x [-1, 1], above or below the cut, which starts at x = 0 and opens towards +x. */
typedef struct half {
    size_t n;     /* cubes along y and z; twice as many along x */
    double slope; /* of the cut's sides */
    bool lower;
} half;

static void place(const void *context, double *out, const size_t *v)
{
    const half *h = context;
    double up = (double)v[2] / (double)h->n, x = (double)v[0] / (double)h->n - 1;
    double side = x > 0 ? h->slope * x : 0;
    out[0] = x;
    out[1] = (double)v[1] / (double)h->n;
    out[2] = h->lower ? -1 + up * (1 - side) : side + up * (1 - side);
    if (h->lower && v[2] == h->n)
        out[2] = -side;
    if (!h->lower && v[2] == h->n)
        out[2] = 1;
}

static tc_status build(tc_synth_soup *out, size_t n_cells, double angle, tc_error *err)
{
    half h = {tc_box_side(n_cells, 24, 1), tan(angle / 2 * degree), false};
    tc_lattice lattice = {{2 * h.n, h.n, h.n}, false, NULL, place, &h, TC_SPLIT_KUHN};
    tc_synth_soup lower = {0};
    tc_status status = tc_lattice_build(out, &lattice, err);
    h.lower = true;
    if (!status)
        status = tc_lattice_build(&lower, &lattice, err);
    if (!status)
        status = tc_soup_append(out, &lower, err);
    tc_synth_soup_finish(&lower);
    return status ? status : tc_soup_weld(out, err);
}

/* The box less the wedge. */
static double chord(const double *o, const double *d, double angle)
{
    static const double lo[3] = {-1, 0, -1}, hi[3] = {1, 1, 1};
    double slope = tan(angle / 2 * degree);
    const double edge[2][3] = {{0, 0, 0}, {0, 1, 0}}, end[2][3] = {{1, 0, slope}, {1, 0, -slope}};
    const double right[3][3] = {{1, 0, 0}, {1, 1, 0}, {1, 0, 1}};
    const double front[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, rear[3][3] = {{0, 1, 0}, {0, 1, 1}, {1, 1, 0}};
    tc_span cut = tc_span_whole();
    tc_span_clip(&cut, o, d, edge[0], end[0], edge[1]);
    tc_span_clip(&cut, o, d, edge[0], edge[1], end[1]);
    tc_span_clip(&cut, o, d, right[0], right[1], right[2]);
    tc_span_clip(&cut, o, d, front[0], front[1], front[2]);
    tc_span_clip(&cut, o, d, rear[0], rear[1], rear[2]);
    return tc_chord_box(lo, hi, o, d) - tc_span_length(cut);
}

enum { notch = TC_SYNTH_POSITIVE | TC_SYNTH_CONFORMING | TC_SYNTH_SIZED };

#define NOTCH(id, angle)                                                                                               \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        (void)seed;                                                                                                    \
        return build(out, n_cells, angle, err);                                                                        \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        (void)n_cells;                                                                                                 \
        return chord(o, d, angle);                                                                                     \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {5184, build_##id, tc_field_linear, chord_##id, notch, 0};

NOTCH(notch_5e_2, 0.05)
NOTCH(notch_1e_3, 1e-3)
NOTCH(notch_1e_6, 1e-6)

/* Blades: tets around an edge from (0, 0, 0) to (0, 0, 1), a gap of 0.05 degrees between each and the next. */
static void rim(double *out, double angle)
{
    out[0] = cos(angle), out[1] = sin(angle), out[2] = 0.5;
}

static size_t blades(size_t n_cells)
{
    return n_cells < 3 ? 3 : n_cells > 3600 ? 3600 : n_cells;
}

static void blade(double p[4][3], size_t i, size_t n)
{
    double step = 360 * degree / (double)n;
    memset(p, 0, 4 * sizeof *p);
    p[3][2] = 1;
    rim(p[1], step * (double)i);
    rim(p[2], step * (double)(i + 1) - 0.05 * degree);
}

static tc_status build_blades(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)seed;
    size_t n = blades(n_cells);
    tc_builder b = {.soup = out};
    tc_builder_vertex(&b, 0, 0, 0);
    tc_builder_vertex(&b, 0, 0, 1);
    for (size_t i = 0; i < n && !b.failure; i++) {
        double p[4][3];
        blade(p, i, n);
        int32_t v[2];
        for (int k = 0; k < 2; k++)
            v[k] = tc_builder_vertex(&b, p[k + 1][0], p[k + 1][1], p[k + 1][2]);
        tc_builder_tet(&b, 0, v[0], v[1], 1);
    }
    return tc_builder_done(&b, err);
}

static double chord_blades(const double *o, const double *d, size_t n_cells)
{
    double length = 0;
    size_t n = blades(n_cells);
    for (size_t i = 0; i < n; i++) {
        double p[4][3];
        blade(p, i, n);
        length += tc_chord_tet(p[0], p[1], p[2], p[3], o, d);
    }
    return length;
}

const tc_synth_generator tc_synth_blades = {
    60, build_blades, tc_field_linear, chord_blades, TC_SYNTH_POSITIVE | TC_SYNTH_CONFORMING, 0};
