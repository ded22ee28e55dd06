/* cap.c: caps: a vertex close to the middle of the opposite face. Every tet of a jittered Kuhn lattice is cut into four
 * around a point just above one of its faces. */
#include "box.h"
#include "chord.h"
#include "soup.h"

/* One cap and the three tets above it, for a cap as high as 1/aspect of its tet. */
static void divide(tc_builder *b, const tc_synth_soup *from, const int32_t *v, double aspect)
{
    double p[3];
    for (int a = 0; a < 3; a++) {
        const double *x = from->vertex + a;
        double middle = (x[3 * v[1]] + x[3 * v[2]] + x[3 * v[3]]) / 3;
        p[a] = middle + (x[3 * v[0]] - middle) / aspect;
    }
    int32_t m = tc_builder_vertex(b, p[0], p[1], p[2]);
    tc_builder_tet(b, m, v[1], v[2], v[3]);
    tc_builder_tet(b, v[0], m, v[2], v[3]);
    tc_builder_tet(b, v[0], v[1], m, v[3]);
    tc_builder_tet(b, v[0], v[1], v[2], m);
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, double aspect, tc_error *err)
{
    tc_synth_soup coarse = {0};
    tc_box box = tc_box_unit(n_cells / 4, 1, seed);
    tc_status status = tc_box_build(&coarse, &box, err);
    tc_builder b = {.soup = out};
    for (size_t v = 0; v < coarse.n_vertex && !status; v++)
        tc_builder_vertex(&b, coarse.vertex[3 * v], coarse.vertex[3 * v + 1], coarse.vertex[3 * v + 2]);
    for (size_t t = 0; t < coarse.n_tet && !status && !b.failure; t++)
        divide(&b, &coarse, coarse.tet + 4 * t, aspect);
    tc_synth_soup_finish(&coarse);
    return status ? status : tc_builder_done(&b, err);
}

enum { promises = (TC_SYNTH_SOUND | TC_SYNTH_CONVEX) & ~TC_SYNTH_SHAPELY };

#define CAP(id, aspect)                                                                                                \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        return build(out, n_cells, seed, aspect, err);                                                                 \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {12288, build_##id, tc_field_linear, tc_chord_unit_cube, promises, 0};

CAP(cap_1e3, 1e3)
CAP(cap_1e5, 1e5)
CAP(cap_1e8, 1e8)
