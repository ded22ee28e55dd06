/* nearflat.c: boundaries that are flat up to rounding, or nearly: a cube turned by one radian, a face whose vertices
 * are off by a unit in the last place, and dents that are deeper than a double's rounding but not than a float's. */
#include "box.h"
#include "chord.h"
#include "soup.h"

#include <math.h>

static tc_status build_turned(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_box box = tc_box_unit(n_cells, 1, seed);
    tc_status status = tc_box_build(out, &box, err);
    for (size_t v = 0; v < out->n_vertex && !status; v++) {
        const double p[3] = {out->vertex[3 * v], out->vertex[3 * v + 1], out->vertex[3 * v + 2]};
        tc_point_turn(out->vertex + 3 * v, p);
    }
    return status;
}

static double chord_turned(const double *o, const double *d, size_t n_cells)
{
    double back_o[3], back_d[3];
    tc_point_turn_back(back_o, o);
    tc_point_turn_back(back_d, d);
    return tc_chord_unit_cube(back_o, back_d, n_cells);
}

/* The vertices inside the upper face of a unit cube, moved by depth times noise; depth 0: by a unit in the last place.
 */
static tc_status build_uneven(tc_synth_soup *out, size_t n_cells, uint64_t seed, double depth, tc_error *err)
{
    tc_box box = tc_box_unit(n_cells, 3, seed);
    tc_status status = tc_box_build(out, &box, err);
    for (size_t v = 0; v < out->n_vertex && !status; v++) {
        double *p = out->vertex + 3 * v, noise = tc_synth_noise(~seed, v);
        if (p[2] != 1 || p[0] == 0 || p[0] == 1 || p[1] == 0 || p[1] == 1)
            continue;
        if (depth > 0)
            p[2] = 1 + depth * noise;
        else
            p[2] = nextafter(1, noise < 0 ? 0 : 2);
    }
    return status;
}

#define UNEVEN(id, depth, chord, promises)                                                                             \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        return build_uneven(out, n_cells, seed, depth, err);                                                           \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {6000, build_##id, tc_field_linear, chord, promises, 0};

const tc_synth_generator tc_synth_turned_cube = {
    6000, build_turned, tc_field_linear, chord_turned, TC_SYNTH_SOUND | TC_SYNTH_CONVEX, 0};
UNEVEN(uneven_ulp, 0, tc_chord_unit_cube, TC_SYNTH_SOUND | TC_SYNTH_CONVEX)
UNEVEN(uneven_1e_10, 1e-10, NULL, TC_SYNTH_SOUND)
UNEVEN(uneven_1e_7, 1e-7, NULL, TC_SYNTH_SOUND)
