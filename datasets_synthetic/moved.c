/* moved.c: other datasets at sizes from 1e-30 to 1e30 and 1e7 away from the origin; and boxes 1e4 times longer than
 * thick. */
#include "box.h"
#include "chord.h"

/* Point (or, with origin 0, direction) in the frame of the dataset that was moved. */
static void back(double *out, const double *p, double size, double origin)
{
    for (int a = 0; a < 3; a++)
        out[a] = (p[a] - origin) / size;
}

static tc_status build(tc_synth_soup *out, const tc_synth_generator *from, size_t n_cells, uint64_t seed, double size,
                       double origin, tc_error *err)
{
    tc_status status = from->build(out, n_cells, seed, err);
    for (size_t i = 0; i < 3 * out->n_vertex && !status; i++)
        out->vertex[i] = size * out->vertex[i] + origin;
    return status;
}

#define MOVED(id, from, cells, size, origin, promises)                                                                 \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        return build(out, &from, n_cells, seed, size, origin, err);                                                    \
    }                                                                                                                  \
    static double field_##id(const double *p)                                                                          \
    {                                                                                                                  \
        double q[3];                                                                                                   \
        back(q, p, size, origin);                                                                                      \
        return from.field(q);                                                                                          \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        double q[3];                                                                                                   \
        back(q, o, size, origin);                                                                                      \
        return size * from.chord(q, d, n_cells);                                                                       \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {cells, build_##id, field_##id, chord_##id, promises, 0};

enum { convex = TC_SYNTH_SOUND | TC_SYNTH_CONVEX };

MOVED(size_1e_30, tc_synth_kuhn, 6000, 1e-30, 0, convex)
MOVED(size_1e_20, tc_synth_kuhn, 6000, 1e-20, 0, convex)
MOVED(size_1e20, tc_synth_kuhn, 6000, 1e20, 0, convex)
MOVED(size_1e30, tc_synth_kuhn, 6000, 1e30, 0, convex)
MOVED(offset_1e7, tc_synth_kuhn, 6000, 1, 1e7, convex)
MOVED(comb_size_1e_30, tc_synth_comb, 30000, 1e-30, 0, TC_SYNTH_SOUND)
MOVED(comb_size_1e30, tc_synth_comb, 30000, 1e30, 0, TC_SYNTH_SOUND)
MOVED(comb_offset_1e7, tc_synth_comb, 30000, 1, 1e7, TC_SYNTH_SOUND)

static tc_status build_thin(tc_synth_soup *out, size_t n_cells, uint64_t seed, const double *size, tc_error *err)
{
    tc_box box = tc_box_unit(n_cells, 1, seed);
    for (int a = 0; a < 3; a++)
        box.hi[a] = size[a];
    return tc_box_build(out, &box, err);
}

enum { thin = (TC_SYNTH_SOUND | TC_SYNTH_CONVEX) & ~TC_SYNTH_SHAPELY };

#define THIN(id, x, y, z)                                                                                              \
    static const double size_##id[3] = {x, y, z};                                                                      \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        return build_thin(out, n_cells, seed, size_##id, err);                                                         \
    }                                                                                                                  \
    static double field_##id(const double *p)                                                                          \
    {                                                                                                                  \
        const double q[3] = {p[0] / x, p[1] / y, p[2] / z};                                                            \
        return tc_field_linear(q);                                                                                     \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        (void)n_cells;                                                                                                 \
        static const double lo[3] = {0, 0, 0};                                                                         \
        return tc_chord_box(lo, size_##id, o, d);                                                                      \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {6000, build_##id, field_##id, chord_##id, thin, 0};

THIN(rod_1e_4, 1, 1e-4, 1e-4)
THIN(plate_1e_4, 1, 1, 1e-4)
