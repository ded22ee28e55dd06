/* axis.c: a regular prism of hexahedra around an axis, as flow solvers make them: the innermost hexahedra have a face
 * that has shrunk to an edge, so that some of their tets repeat a vertex. The others fit together as if those were not
 * there. */
#include "box.h"
#include "chord.h"

#include <math.h>

typedef struct grid {
    size_t around, out, up;
} grid;

static grid divide(size_t n_cells)
{
    size_t n = tc_box_side(n_cells, 6 * 3, 2);
    return (grid){3 * n, n, n};
}

static void on_circle(double *out, size_t i, size_t n, double radius)
{
    double angle = -2 * 3.14159265358979323846 * (double)(i % n) / (double)n; /* axes: around, out, up */
    out[0] = radius * cos(angle), out[1] = radius * sin(angle);
}

static void place(const void *context, double *out, const size_t *v)
{
    const grid *g = context;
    on_circle(out, v[0], g->around, (double)v[1] / (double)g->out);
    out[2] = (double)v[2] / (double)g->up;
}

/* One vertex on the axis at each height takes the part of all that lie there; the others are not used. */
static tc_status gather(tc_synth_soup *s, const grid *g, tc_error *err)
{
    tc_synth_soup old = *s;
    size_t per_layer = g->around * (g->out + 1), n_vertex = (g->up + 1) * (g->around * g->out + 1);
    *s = (tc_synth_soup){0};
    tc_status status = tc_synth_soup_reserve(s, n_vertex, old.n_tet, err);
    for (size_t v = 0; v < old.n_vertex && !status; v++) {
        size_t layer = v / per_layer, in = v % per_layer;
        size_t id = layer * (per_layer - g->around + 1) + (in < g->around ? 0 : in - g->around + 1);
        for (size_t k = 0; k < 3; k++)
            s->vertex[3 * id + k] = old.vertex[3 * v + k];
    }
    for (size_t i = 0; i < 4 * old.n_tet && !status; i++) {
        size_t v = (size_t)old.tet[i], layer = v / per_layer, in = v % per_layer;
        s->tet[i] = (int32_t)(layer * (per_layer - g->around + 1) + (in < g->around ? 0 : in - g->around + 1));
    }
    tc_synth_soup_finish(&old);
    return status;
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)
{
    (void)seed;
    grid g = divide(n_cells);
    tc_lattice lattice = {{g.around, g.out, g.up}, true, NULL, place, &g, TC_SPLIT_KUHN};
    tc_status status = tc_lattice_build(out, &lattice, err);
    return status ? status : gather(out, &g, err);
}

static double chord(const double *o, const double *d, size_t n_cells)
{
    grid g = divide(n_cells);
    tc_span span = tc_span_whole();
    for (size_t i = 0; i < g.around; i++) {
        double p[3] = {0, 0, 0}, q[3] = {0, 0, 0}, up[3];
        on_circle(p, i, g.around, 1);
        on_circle(q, i + 1, g.around, 1);
        up[0] = p[0], up[1] = p[1], up[2] = 1;
        tc_span_clip(&span, o, d, p, up, q);
    }
    const double lower[3][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}}, upper[3][3] = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    tc_span_clip(&span, o, d, lower[0], lower[1], lower[2]);
    tc_span_clip(&span, o, d, upper[0], upper[1], upper[2]);
    return tc_span_length(span);
}

const tc_synth_generator tc_synth_collapsed_axis = {
    9000, build, tc_field_linear, chord, TC_SYNTH_CONVEX | TC_SYNTH_SIZED, TC_SYNTH_DEGENERATE};
