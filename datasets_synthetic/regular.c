/* regular.c: lattices that are not jittered: vertices, edges and faces of the cells lie exactly on one another's
 * planes, and on the rays of a camera that looks along an axis. Spacing is a power of two (every coordinate and every
 * difference is exact) or a tenth (none is). The mesh grows with n_cells, its spacing does not. */
#include "box.h"
#include "chord.h"
#include "octa.h"

#include <math.h>

static tc_status build_box(tc_synth_soup *out, size_t n_cells, tc_split split, double spacing, tc_error *err)
{
    size_t n = tc_box_side(n_cells, split == TC_SPLIT_FIVE ? 5 : 6, 1);
    double side = (double)n * spacing;
    tc_box box = {{0, 0, 0}, {side, side, side}, {n, n, n}, 0, 0, split};
    return tc_box_build(out, &box, err);
}

static double chord_box(const double *o, const double *d, size_t n_cells, double tets_per_cube, double spacing)
{
    double side = (double)tc_box_side(n_cells, tets_per_cube, 1) * spacing;
    const double lo[3] = {0, 0, 0}, hi[3] = {side, side, side};
    return tc_chord_box(lo, hi, o, d);
}

static tc_octa octahedron(size_t n_cells, double spacing)
{
    int n = (int)fmax(1, round(cbrt((double)n_cells / 8)));
    return (tc_octa){1, {{0, n * spacing}}, {{0, n}}, spacing};
}

static tc_status build_octahedron(tc_synth_soup *out, size_t n_cells, double spacing, tc_error *err)
{
    tc_octa octa = octahedron(n_cells, spacing);
    return tc_octa_build(out, &octa, 0, err);
}

static double chord_octahedron(const double *o, const double *d, size_t n_cells, double spacing)
{
    double r = octahedron(n_cells, spacing).r[0][1];
    tc_span span = tc_span_whole();
    for (int octant = 0; octant < 8; octant++) {
        const double x[3] = {octant & 1 ? -r : r, 0, 0}, y[3] = {0, octant & 2 ? -r : r, 0};
        const double z[3] = {0, 0, octant & 4 ? -r : r};
        bool mirrored = (octant & 1) ^ (octant >> 1 & 1) ^ (octant >> 2);
        tc_span_clip(&span, o, d, x, mirrored ? z : y, mirrored ? y : z);
    }
    return tc_span_length(span);
}

enum { promises = (TC_SYNTH_SOUND | TC_SYNTH_CONVEX) & ~TC_SYNTH_SEEDED };

#define BOX(id, cells, split, tets_per_cube, spacing)                                                                  \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        (void)seed;                                                                                                    \
        return build_box(out, n_cells, split, spacing, err);                                                           \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        return chord_box(o, d, n_cells, tets_per_cube, spacing);                                                       \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {cells, build_##id, tc_field_linear, chord_##id, promises, 0};

BOX(grid_kuhn, 24576, TC_SPLIT_KUHN, 6, 0x1p-4)
BOX(grid_kuhn_tenth, 6000, TC_SPLIT_KUHN, 6, 0.1)
BOX(grid_five, 20480, TC_SPLIT_FIVE, 5, 0x1p-4)
BOX(grid_five_tenth, 5000, TC_SPLIT_FIVE, 5, 0.1)

#define OCTAHEDRON(id, cells, spacing)                                                                                 \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        (void)seed;                                                                                                    \
        return build_octahedron(out, n_cells, spacing, err);                                                           \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        return chord_octahedron(o, d, n_cells, spacing);                                                               \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {cells, build_##id, tc_field_linear, chord_##id, promises, 0};

OCTAHEDRON(grid_octahedral, 32768, 0x1p-4)
OCTAHEDRON(grid_octahedral_tenth, 8000, 0.1)
