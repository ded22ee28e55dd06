/* fan.c: thousands of tets around one vertex, or around one edge. */
#include "box.h"
#include "chord.h"
#include "cubeskin.h"
#include "soup.h"

#include <math.h>

/* A cube whose tets all have its middle as a vertex. */
static tc_status build_vertex(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)seed;
    tc_cubeskin skin;
    tc_status status = tc_cubeskin_build(&skin, (size_t)fmax(1, round(sqrt((double)n_cells / 12))), err);
    tc_builder b = {.soup = out};
    int32_t middle = tc_builder_vertex(&b, 0, 0, 0);
    for (size_t v = 0; v < skin.n_vertex && !status && !b.failure; v++)
        tc_builder_vertex(&b, skin.vertex[3 * v], skin.vertex[3 * v + 1], skin.vertex[3 * v + 2]);
    for (size_t f = 0; f < skin.n_face && !status && !b.failure; f++)
        tc_builder_tet(&b, middle, skin.face[3 * f] + 1, skin.face[3 * f + 1] + 1, skin.face[3 * f + 2] + 1);
    tc_cubeskin_finish(&skin);
    return status ? status : tc_builder_done(&b, err);
}

static size_t sides(size_t n_cells)
{
    return n_cells < 3 ? 3 : n_cells;
}

/* Corner i of a regular polygon; the first one again at the end. */
static void rim(double *out, size_t i, size_t n)
{
    double angle = 2 * 3.14159265358979323846 * (double)(i % n) / (double)n;
    out[0] = cos(angle), out[1] = sin(angle), out[2] = 0;
}

static const double top[3] = {0, 0, 1}, bottom[3] = {0, 0, -1};

/* Two pyramids base to base over a regular polygon; all tets share the edge between their tips. */
static tc_status build_edge(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)seed;
    size_t n = sides(n_cells);
    tc_builder b = {.soup = out};
    tc_builder_vertex(&b, bottom[0], bottom[1], bottom[2]);
    tc_builder_vertex(&b, top[0], top[1], top[2]);
    for (size_t i = 0; i < n && !b.failure; i++) {
        double p[3];
        rim(p, i, n);
        tc_builder_vertex(&b, p[0], p[1], p[2]);
    }
    for (size_t i = 0; i < n && !b.failure; i++)
        tc_builder_tet(&b, 0, (int32_t)(2 + i), (int32_t)(2 + (i + 1) % n), 1);
    return tc_builder_done(&b, err);
}

static double chord_edge(const double *o, const double *d, size_t n_cells)
{
    size_t n = sides(n_cells);
    tc_span span = tc_span_whole();
    for (size_t i = 0; i < n; i++) {
        double p[3], q[3];
        rim(p, i, n);
        rim(q, i + 1, n);
        tc_span_clip(&span, o, d, p, q, top);
        tc_span_clip(&span, o, d, q, p, bottom);
    }
    return tc_span_length(span);
}

enum { promises = TC_SYNTH_POSITIVE | TC_SYNTH_CONFORMING | TC_SYNTH_CONVEX | TC_SYNTH_SIZED };

const tc_synth_generator tc_synth_vertex_fan = {10092, build_vertex, tc_field_linear, tc_cubeskin_chord, promises, 0};
const tc_synth_generator tc_synth_edge_fan = {10000, build_edge, tc_field_linear, chord_edge, promises, 0};
