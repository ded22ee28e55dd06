/* prism.c: upright shapes over a strip between two plane curves, divided by a Kuhn lattice that follows the curves. */
#include "prism.h"

#include "core/memory.h"
#include "lattice.h"

#include <math.h>
#include <stdlib.h>

static double divisions(const tc_prism *prism, int axis, double h)
{
    return fmax(axis == 0 ? (double)prism->n_min : 1, round(prism->length[axis] / h));
}

static double count_tets(const void *context, double h)
{
    return 6 * divisions(context, 0, h) * divisions(context, 1, h) * divisions(context, 2, h);
}

static void resolve(size_t *n, const tc_prism *prism, size_t n_cells)
{
    double longest = fmax(prism->length[0], fmax(prism->length[1], prism->length[2]));
    double h = tc_synth_fit(count_tets, prism, n_cells, 2 * longest);
    for (int a = 0; a < 3; a++)
        n[a] = (size_t)divisions(prism, a, h);
}

typedef struct strip {
    const tc_prism *prism;
    size_t n[3];
    uint64_t seed;
} strip;

static void place(const void *context, double *out, const size_t *vertex)
{
    const strip *s = context;
    const tc_prism *prism = s->prism;
    bool end[3]; /* at either end of the axis */
    double t[3], inner[2], outer[2];
    uint64_t index = vertex[0] + (uint64_t)(s->n[0] + 1) * (vertex[1] + (uint64_t)(s->n[1] + 1) * vertex[2]);
    for (int a = 0; a < 3; a++)
        end[a] = (vertex[a] == 0 || vertex[a] == s->n[a]) && !(a == 0 && prism->wrap);
    for (int a = 0; a < 3; a++) {
        t[a] = (double)vertex[a];
        if (!end[a] && !(a == 0 && end[1])) /* corners of the polygons stay */
            t[a] += 0.1 * tc_synth_noise(s->seed, 3 * index + (uint64_t)a);
        t[a] /= (double)s->n[a];
    }
    prism->curve(inner, outer, t[0]);
    double k = prism->across(t[1]);
    out[0] = inner[0] + k * (outer[0] - inner[0]);
    out[1] = inner[1] + k * (outer[1] - inner[1]);
    out[2] = prism->up(t[2]);
}

tc_status tc_prism_build(tc_synth_soup *out, const tc_prism *prism, size_t n_cells, uint64_t seed, tc_error *err)
{
    strip s = {.prism = prism, .seed = seed};
    resolve(s.n, prism, n_cells);
    tc_lattice lattice = {{s.n[0], s.n[1], s.n[2]}, prism->wrap, NULL, place, &s, TC_SPLIT_KUHN};
    return tc_lattice_build(out, &lattice, err);
}

/* Where a line crosses the outline, seen from above. */
typedef struct crossings {
    const double *origin, *direction;
    size_t n;
    double *t;
} crossings;

/* Half open: a corner on the line belongs to its left side, so a closed outline is crossed an even number of times. */
static void cross_edge(crossings *c, const double *p, const double *q)
{
    const double *o = c->origin, *d = c->direction;
    double side_p = d[0] * (p[1] - o[1]) - d[1] * (p[0] - o[0]);
    double side_q = d[0] * (q[1] - o[1]) - d[1] * (q[0] - o[0]);
    if ((side_p >= 0) == (side_q >= 0))
        return;
    double k = side_p / (side_p - side_q);
    double x = p[0] + k * (q[0] - p[0]) - o[0], y = p[1] + k * (q[1] - p[1]) - o[1];
    c->t[c->n++] = (x * d[0] + y * d[1]) / (d[0] * d[0] + d[1] * d[1]);
}

/* All edges of the outline's polygon; without wrap its two ends are closed by straight lines. */
static void cross_outline(crossings *c, const tc_prism *prism, size_t n)
{
    double inner[2][2], outer[2][2];
    prism->curve(inner[0], outer[0], 0);
    if (!prism->wrap)
        cross_edge(c, inner[0], outer[0]);
    for (size_t i = 0; i < n; i++) {
        size_t from = i % 2, to = 1 - from;
        bool last = prism->wrap && i + 1 == n; /* the very corners that the loop began with */
        prism->curve(inner[to], outer[to], last ? 0 : (double)(i + 1) / (double)n);
        cross_edge(c, inner[from], inner[to]);
        cross_edge(c, outer[from], outer[to]);
    }
    if (!prism->wrap)
        cross_edge(c, inner[n % 2], outer[n % 2]);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double tc_prism_chord(const tc_prism *prism, const double *origin, const double *direction, size_t n_cells)
{
    size_t n[3];
    resolve(n, prism, n_cells);
    crossings c = {origin, direction, 0, tc_alloc(2 * n[0] + 2, sizeof *c.t)};
    if (!c.t)
        return NAN;
    const double sideways[3] = {1, 0, 0};
    bool upright = direction[0] == 0 && direction[1] == 0;
    if (upright)
        c.direction = sideways; /* an odd number of crossings ahead: inside */
    cross_outline(&c, prism, n[0]);
    double bottom = prism->up(0), top = prism->up(1), length = 0, t0 = -HUGE_VAL, t1 = HUGE_VAL;
    if (direction[2] != 0) {
        double a = (bottom - origin[2]) / direction[2], b = (top - origin[2]) / direction[2];
        t0 = fmin(a, b);
        t1 = fmax(a, b);
    } else if (origin[2] < bottom || origin[2] > top) {
        t1 = -HUGE_VAL;
    }
    qsort(c.t, c.n, sizeof *c.t, compare_doubles);
    for (size_t i = 0; i + 1 < c.n; i += 2) {
        if (upright && c.t[i] <= 0 && c.t[i + 1] > 0)
            length = t1 - t0;
        else if (!upright)
            length += fmax(0, fmin(t1, c.t[i + 1]) - fmax(t0, c.t[i]));
    }
    free(c.t);
    return length;
}
