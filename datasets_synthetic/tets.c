/* tets.c: the smallest meshes: one tet, and two that share a face. They have one size and no seed. */
#include "chord.h"
#include "synth.h"

#include <string.h>

static const double vertex[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
static const int32_t tet[2][4] = {{0, 1, 2, 3}, {4, 1, 3, 2}};

static tc_status build(tc_synth_soup *out, size_t n_tet, tc_error *err)
{
    tc_status status = tc_synth_soup_reserve(out, 3 + n_tet, n_tet, err);
    if (status)
        return status;
    memcpy(out->vertex, vertex, (3 + n_tet) * sizeof *vertex);
    memcpy(out->tet, tet, n_tet * sizeof *tet);
    return TC_OK;
}

static tc_status build_tet(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)n_cells, (void)seed;
    return build(out, 1, err);
}

static tc_status build_two(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)n_cells, (void)seed;
    return build(out, 2, err);
}

static double field(const double *p)
{
    return 0.1 + 0.2 * p[0] + 0.3 * p[1] + 0.4 * p[2];
}

static double chord(const double *origin, const double *direction, int n_tet)
{
    double length = 0;
    for (int t = 0; t < n_tet; t++)
        length +=
            tc_chord_tet(vertex[tet[t][0]], vertex[tet[t][1]], vertex[tet[t][2]], vertex[tet[t][3]], origin, direction);
    return length;
}

static double chord_tet(const double *origin, const double *direction, size_t n_cells)
{
    (void)n_cells;
    return chord(origin, direction, 1);
}

static double chord_two(const double *origin, const double *direction, size_t n_cells)
{
    (void)n_cells;
    return chord(origin, direction, 2);
}

enum { promises = TC_SYNTH_POSITIVE | TC_SYNTH_SHAPELY | TC_SYNTH_CONFORMING | TC_SYNTH_CONVEX };

const tc_synth_generator tc_synth_tet = {1, build_tet, field, chord_tet, promises, 0};
const tc_synth_generator tc_synth_two = {2, build_two, field, chord_two, promises, 0};
