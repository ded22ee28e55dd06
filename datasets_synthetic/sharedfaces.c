/* sharedfaces.c: faces that belong to two tets on one side, or to three tets. */
#include "box.h"
#include "chord.h"
#include "soup.h"

#include <math.h>

/* Two tets over one face, with different tips, standing on a grid of places. */
static const double corner[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.2, 1}, {0.7, 0.4, 0.6}};

static size_t places(size_t n_cells)
{
    return (size_t)fmax(1, round(sqrt((double)n_cells / 2)));
}

static tc_status build_one_side(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)seed;
    size_t n = places(n_cells);
    tc_builder b = {.soup = out};
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n && !b.failure; i++) {
            int32_t v[5];
            for (int k = 0; k < 5; k++)
                v[k] = tc_builder_vertex(&b, corner[k][0] + 1.25 * (double)i, corner[k][1] + 1.25 * (double)j,
                                         corner[k][2]);
            tc_builder_tet(&b, v[0], v[1], v[2], v[3]);
            tc_builder_tet(&b, v[0], v[1], v[2], v[4]);
        }
    return tc_builder_done(&b, err);
}

static double chord_one_side(const double *o, const double *d, size_t n_cells)
{
    size_t n = places(n_cells);
    double length = 0;
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++) {
            const double at[3] = {o[0] - 1.25 * (double)i, o[1] - 1.25 * (double)j, o[2]};
            length += tc_chord_tet(corner[0], corner[1], corner[2], corner[3], at, d);
            length += tc_chord_tet(corner[0], corner[1], corner[2], corner[4], at, d);
        }
    return length;
}

/* In a cube, a third tet on one face of every fortieth cell, half as high as that cell. */
static tc_status build_three(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    tc_box box = tc_box_unit(n_cells, 2, seed);
    tc_status status = tc_box_build(out, &box, err);
    tc_builder b = {.soup = out};
    size_t n = out->n_tet;
    for (size_t t = 7; t < n && !status && !b.failure; t += 40) {
        const int32_t v[4] = {out->tet[4 * t], out->tet[4 * t + 1], out->tet[4 * t + 2], out->tet[4 * t + 3]};
        double p[3];
        for (int a = 0; a < 3; a++) {
            const double *x = out->vertex + a;
            p[a] = (x[3 * v[1]] + x[3 * v[2]] + x[3 * v[3]] + 3 * x[3 * v[0]]) / 6;
        }
        int32_t tip = tc_builder_vertex(&b, p[0], p[1], p[2]);
        tc_builder_tet(&b, tip, v[1], v[2], v[3]);
    }
    return status ? status : tc_builder_done(&b, err);
}

const tc_synth_generator tc_synth_one_side = {200,
                                              build_one_side,
                                              tc_field_linear,
                                              chord_one_side,
                                              TC_SYNTH_POSITIVE | TC_SYNTH_SHAPELY | TC_SYNTH_SIZED,
                                              TC_SYNTH_SHARED_FACES | TC_SYNTH_OVERLAPPING};
const tc_synth_generator tc_synth_three_cells = {6000,
                                                 build_three,
                                                 tc_field_linear,
                                                 NULL,
                                                 TC_SYNTH_SOUND & ~TC_SYNTH_CONFORMING,
                                                 TC_SYNTH_SHARED_FACES | TC_SYNTH_OVERLAPPING};
