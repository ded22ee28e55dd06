/* seam.c: points that lie on one another along a plane through a unit cube, each side with its own. Points with equal
 * values are merged; where the values jump the two sides stay apart, and the boundary touches itself: nowhere, all over
 * the plane, in a patch inside (a crack), or in one that reaches the surface (a slit). And: points shared, but the
 * squares of the two sides cut differently; a ring cut open; two parts with an edge at the same place. */
#include "box.h"
#include "chord.h"
#include "soup.h"

#include <math.h>

/* The cubes of half a unit cube; there are twice as many along y and z. */
static size_t half_side(size_t n_cells)
{
    return tc_box_side(n_cells, 48, 2);
}

static tc_box half(size_t n_cells, uint64_t seed, bool upper)
{
    size_t n = half_side(n_cells);
    tc_box box = {{0, 0, 0}, {0.5, 1, 1}, {n, 2 * n, 2 * n}, 0.15, seed, TC_SPLIT_KUHN};
    if (upper)
        box.lo[0] = 0.5, box.hi[0] = 1, box.seed = ~seed;
    return box;
}

/* Two boxes, each with points of its own; where raise (NULL: nowhere) is above 0 the second one's values are higher. */
static tc_status build_two(tc_synth_soup *out, const tc_box *lower, const tc_box *upper,
                           double (*raise)(const double *p), tc_error *err)
{
    tc_synth_soup more = {0};
    tc_status status = tc_box_build(out, lower, err);
    size_t first = out->n_vertex;
    if (!status)
        status = tc_box_build(&more, upper, err);
    if (!status)
        status = tc_soup_append(out, &more, err);
    tc_synth_soup_finish(&more);
    if (!status && raise)
        status = tc_soup_values(out, TC_POINT_DATA, err);
    for (size_t v = 0; v < out->n_vertex && !status && raise; v++) {
        const double *p = out->vertex + 3 * v;
        out->scalar[v] = tc_field_linear(p) + (v >= first ? raise(p) : 0);
    }
    return status;
}

static double everywhere(const double *p)
{
    (void)p;
    return 0.25;
}

static double in_crack(const double *p)
{
    return fmax(0, 0.25 - fmax(fabs(p[1] - 0.5), fabs(p[2] - 0.5)));
}

static double in_slit(const double *p)
{
    return fmax(0, 0.75 - p[1]);
}

#define HALVES(id, raise, promises, defects)                                                                           \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        tc_box lower = half(n_cells, seed, false), upper = half(n_cells, seed, true);                                  \
        return build_two(out, &lower, &upper, raise, err);                                                             \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {6000, build_##id, tc_field_linear, tc_chord_unit_cube, promises, defects};

enum { apart = TC_SYNTH_SOUND & ~TC_SYNTH_CONFORMING };

HALVES(seam, NULL, apart | TC_SYNTH_CONVEX, TC_SYNTH_TOUCHING_FACES | TC_SYNTH_DUPLICATE_POINTS)
HALVES(seam_jump, everywhere, apart, TC_SYNTH_TOUCHING_FACES)
HALVES(crack, in_crack, apart, TC_SYNTH_TOUCHING_FACES | TC_SYNTH_DUPLICATE_POINTS)
HALVES(slit, in_slit, apart, TC_SYNTH_TOUCHING_FACES | TC_SYNTH_DUPLICATE_POINTS)

/* Squares of the seam: all diagonals alike below, alternating above. */
static tc_status build_mismatch(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_box lower = half(n_cells, seed, false), upper = half(n_cells, seed, true);
    upper.split = TC_SPLIT_FIVE;
    tc_status status = build_two(out, &lower, &upper, NULL, err);
    return status ? status : tc_soup_weld(out, err);
}

const tc_synth_generator tc_synth_seam_mismatch = {6000,  build_mismatch,         tc_field_linear, tc_chord_unit_cube,
                                                   apart, TC_SYNTH_TOUCHING_FACES};

/* Two square columns along z that have one edge at the same place, each with points and values of its own. */
static tc_status build_columns(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    size_t n = tc_box_side(n_cells, 24, 2);
    tc_box lower = {{0, 0, 0}, {0.5, 0.5, 1}, {n, n, 2 * n}, 0.15, seed, TC_SPLIT_KUHN}, upper = lower;
    upper.lo[0] = upper.lo[1] = 0.5, upper.hi[0] = upper.hi[1] = 1;
    return build_two(out, &lower, &upper, everywhere, err);
}

static double chord_columns(const double *o, const double *d, size_t n_cells)
{
    (void)n_cells;
    static const double lo[2][3] = {{0, 0, 0}, {0.5, 0.5, 0}}, hi[2][3] = {{0.5, 0.5, 1}, {1, 1, 1}};
    return tc_chord_box(lo[0], hi[0], o, d) + tc_chord_box(lo[1], hi[1], o, d);
}

const tc_synth_generator tc_synth_touch_edge_apart = {6000,          build_columns,  tc_field_linear,
                                                      chord_columns, TC_SYNTH_SOUND, 0};

/* A ring of square section whose two ends lie on each other. */
typedef struct ring {
    size_t around, across;
} ring;

static ring divide_ring(size_t n_cells)
{
    size_t n = tc_box_side(n_cells, 6 * 8, 1);
    return (ring){8 * n > 5 ? 8 * n : 5, n};
}

static void on_circle(double *out, size_t i, size_t n, double radius)
{
    double angle = -2 * 3.14159265358979323846 * (double)(i % n) / (double)n; /* axes: around, out, up */
    out[0] = radius * cos(angle), out[1] = radius * sin(angle);
}

static void place_ring(const void *context, double *out, const size_t *v)
{
    const ring *r = context;
    on_circle(out, v[0], r->around, 1 + (double)v[1] / (double)r->across);
    out[2] = (double)v[2] / (double)r->across;
}

static tc_status build_ring(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)seed;
    ring r = divide_ring(n_cells);
    tc_lattice lattice = {{r.around, r.across, r.across}, false, NULL, place_ring, &r, TC_SPLIT_KUHN};
    tc_status status = tc_lattice_build(out, &lattice, err);
    if (!status)
        status = tc_soup_values(out, TC_POINT_DATA, err);
    for (size_t v = 0; v < out->n_vertex && !status; v++)
        out->scalar[v] = (double)(v % (r.around + 1)) / (double)r.around + 0.3 * out->vertex[3 * v + 2];
    return status;
}

/* Outer prism less inner prism. */
static double chord_ring(const double *o, const double *d, size_t n_cells)
{
    ring r = divide_ring(n_cells);
    const double lower[3][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, upper[3][3] = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    double length[2];
    for (int k = 0; k < 2; k++) {
        tc_span span = tc_span_whole();
        for (size_t i = 0; i < r.around; i++) {
            double p[3] = {0, 0, 0}, q[3] = {0, 0, 0}, up[3];
            on_circle(p, i, r.around, k + 1);
            on_circle(q, i + 1, r.around, k + 1);
            up[0] = p[0], up[1] = p[1], up[2] = 1;
            tc_span_clip(&span, o, d, p, up, q);
        }
        tc_span_clip(&span, o, d, lower[0], lower[1], lower[2]);
        tc_span_clip(&span, o, d, upper[0], upper[1], upper[2]);
        length[k] = tc_span_length(span);
    }
    return length[1] - length[0];
}

const tc_synth_generator tc_synth_slit_ring = {
    6000, build_ring, NULL, chord_ring, TC_SYNTH_POSITIVE | TC_SYNTH_SHAPELY | TC_SYNTH_SIZED, TC_SYNTH_TOUCHING_FACES};
