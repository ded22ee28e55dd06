/* functions.c: spikes, steps, enormous and tiny extinctions, and functions of no width. */
#include "functions.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What a function is laid over. */
typedef struct ground {
    double lo, range; /* of the scalars; range 0: all are one */
    double opaque;    /* the attenuation that makes a cell opaque in 1e-6 of its length */
    double depth;     /* the attenuation that gives the diagonal an optical depth of 1 */
} ground;

enum { MOST_KNOTS = 10000 };

/* Fills knots; gives their number. */
typedef size_t make_knots(tc_knot *knot, const ground *g);

static tc_knot at(const ground *g, double x, double r, double green, double b, double a)
{
    return (tc_knot){g->lo + x * g->range, r, green, b, a};
}

static size_t constant(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0, 0.9, 0.5, 0.2, 3 * g->depth);
    k[1] = at(g, 1, 0.9, 0.5, 0.2, 3 * g->depth);
    return 2;
}

static size_t smooth(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0, 0.1, 0.2, 0.9, 0);
    k[1] = at(g, 0.4, 0.9, 0.9, 0.8, 4 * g->depth);
    k[2] = at(g, 0.7, 0.9, 0.6, 0.1, g->depth);
    k[3] = at(g, 1, 0.8, 0.1, 0.1, 8 * g->depth);
    return 4;
}

static size_t enormous(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0, 0.1, 0.2, 0.9, g->opaque);
    k[1] = at(g, 0.5, 0.9, 0.9, 0.8, 2 * g->opaque);
    k[2] = at(g, 1, 0.8, 0.1, 0.1, g->opaque);
    return 3;
}

/* From nothing to enormous: what is seen is decided near the scalar where it begins. */
static size_t wall(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0, 0.1, 0.2, 0.9, 0);
    k[1] = at(g, 0.6, 0.2, 0.8, 0.3, 0);
    k[2] = at(g, 1, 0.8, 0.1, 0.1, g->opaque);
    return 3;
}

static size_t almost_none(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0, 0.1, 0.2, 0.9, 1e-7 * g->depth);
    k[1] = at(g, 1, 0.8, 0.1, 0.1, 1e-6 * g->depth);
    return 2;
}

static size_t nothing(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0, 0.1, 0.2, 0.9, 0);
    k[1] = at(g, 1, 0.8, 0.1, 0.1, 0);
    return 2;
}

/* A tent 1e-4 of the range wide. */
static size_t add_spike(tc_knot *k, const ground *g, double x, double a)
{
    k[0] = at(g, x - 0.5e-4, 0.2, 0.4, 0.9, 0);
    k[1] = at(g, x, 1, 0.8, 0.2, a);
    k[2] = at(g, x + 0.5e-4, 0.9, 0.3, 0.1, 0);
    return 3;
}

static size_t spike(tc_knot *k, const ground *g)
{
    return add_spike(k, g, 0.43, 3e4 * g->depth);
}

static size_t spikes(tc_knot *k, const ground *g)
{
    size_t n = 0;
    for (int i = 0; i < 9; i++)
        n += add_spike(k + n, g, 0.107 * i + 0.061, (1 + i) * 4e3 * g->depth);
    return n;
}

static size_t step(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0, 0.1, 0.3, 0.9, 0.5 * g->depth);
    k[1] = at(g, 0.5, 0.1, 0.3, 0.9, 0.5 * g->depth);
    k[2] = at(g, 0.5, 0.9, 0.2, 0.1, 6 * g->depth);
    k[3] = at(g, 1, 0.9, 0.2, 0.1, 6 * g->depth);
    return 4;
}

static size_t stairs(tc_knot *k, const ground *g)
{
    size_t n = 0;
    for (int i = 0; i < 12; i++)
        for (int end = 0; end < 2; end++)
            k[n++] = at(g, (i + end) / 12.0, i % 3 == 0, i % 3 == 1, i % 3 == 2, (i * 5 % 7) * g->depth);
    return n;
}

static size_t single_knot(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0.5, 0.3, 0.9, 0.5, 3 * g->depth);
    return 1;
}

/* Both ends at one scalar: a step and nothing else. */
static size_t no_width(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0.4, 0.2, 0.3, 0.9, g->depth);
    k[1] = at(g, 0.4, 0.9, 0.2, 0.1, 5 * g->depth);
    return 2;
}

/* All within 1e-9 of the range. */
static size_t hardly_width(tc_knot *k, const ground *g)
{
    k[0] = at(g, 0.4, 0.2, 0.3, 0.9, g->depth);
    k[1] = at(g, 0.4 + 1e-9, 0.9, 0.2, 0.1, 5 * g->depth);
    return 2;
}

/* The data lie outside of the knots. */
static size_t elsewhere(tc_knot *k, const ground *g)
{
    k[0] = at(g, 2, 0.2, 0.9, 0.4, 2 * g->depth);
    k[1] = at(g, 3, 0.9, 0.2, 0.1, 9 * g->depth);
    return 2;
}

static size_t decreasing(tc_knot *k, const ground *g)
{
    k[0] = at(g, 1, 0.2, 0.3, 0.9, g->depth);
    k[1] = at(g, 0, 0.9, 0.2, 0.1, 5 * g->depth);
    if (!(g->range > 0))
        k[1].s = k[0].s - 1;
    return 2;
}

static size_t ten_thousand(tc_knot *k, const ground *g)
{
    for (int i = 0; i < MOST_KNOTS; i++) {
        double x = i / (MOST_KNOTS - 1.0);
        k[i] = at(g, x, 0.5 + 0.5 * sin(40 * x), 0.5 + 0.5 * cos(23 * x), x,
                  (2 + 2 * tc_synth_noise(5, (uint64_t)i)) * g->depth);
    }
    return MOST_KNOTS;
}

static const struct {
    const char *name;
    make_knots *make; /* NULL: by tc_transfer_create */
    bool refused;
} functions[] = {
    {"Cool to Warm", NULL, false},
    {"constant", constant, false},
    {"smooth", smooth, false},
    {"opaque in 1e-6 of a cell", enormous, false},
    {"wall", wall, false},
    {"almost none", almost_none, false},
    {"none", nothing, false},
    {"spike of 1e-4", spike, false},
    {"nine spikes of 1e-4", spikes, false},
    {"step", step, false},
    {"twelve steps", stairs, false},
    {"one knot", single_knot, false},
    {"no width", no_width, false},
    {"width 1e-9", hardly_width, false},
    {"knots beside the data", elsewhere, false},
    {"10000 knots", ten_thousand, false},
    {"log over zeros, range given", NULL, false},
    {"log over zeros", NULL, true},
    {"decreasing knots", decreasing, true},
};
enum {
    N_FUNCTION = sizeof functions / sizeof *functions,
    COOL_TO_WARM = 0,
    CONSTANT = 1,
    LOG_RANGE = 16,
    LOG_ZERO = 17
};

size_t hard_function_count(void)
{
    return N_FUNCTION;
}

const char *hard_function_name(size_t index)
{
    return functions[index].name;
}

/* By name of a colour map, as the command line does. */
static tc_status make_by_name(hard_function *out, size_t index, const ground *g, tc_error *err)
{
    tc_transfer_options options = {.data_range = {g->lo, g->lo + g->range}, .opacity = "linear"};
    double top = fmax(fabs(g->lo), fabs(g->lo + g->range));
    if (index == LOG_ZERO) /* a range that reaches 0 has no logarithm */
        options = (tc_transfer_options){.data_range = {0, top > 0 ? top : 1}, .log = true};
    if (index == LOG_RANGE) { /* … but a given one has; what lies below takes its first value */
        top = top > 0 ? top : 1;
        options = (tc_transfer_options){.has_range = true, .range = {1e-4 * top, top}, .log = true};
    }
    return tc_transfer_create(&out->tf, &options, err);
}

/* The same function in the colour of its last knot. */
static tc_status make_plain(hard_function *f, tc_error *err)
{
    size_t n;
    const tc_knot *from = tc_transfer_knots(f->tf, &n);
    tc_knot *knot = calloc(n, sizeof *knot);
    if (!knot)
        return tc_fail(err, TC_E_MEMORY, "out of memory for knots");
    for (size_t i = 0; i < n; i++)
        knot[i] = (tc_knot){from[i].s, from[n - 1].r, from[n - 1].g, from[n - 1].b, from[i].a};
    tc_transfer_destroy(&f->tf);
    tc_status status = tc_transfer_from_knots(&f->tf, knot, n, err);
    free(knot);
    return status;
}

tc_status hard_function_make(hard_function *out, size_t index, const hard_mesh *mesh, tc_error *err)
{
    const double *range = mesh->report.scalar_range;
    ground g = {.lo = range[0], .range = range[1] - range[0]};
    g.depth = mesh->unit / mesh->diagonal;
    g.opaque = 7e6 * mesh->unit / (mesh->report.longest_edge > 0 ? mesh->report.longest_edge : mesh->diagonal);
    memset(out, 0, sizeof *out);
    out->name = functions[index].name;
    out->kappa = index == CONSTANT ? 3 * g.depth : -1;
    tc_status status;
    if (functions[index].make) {
        tc_knot *knot = calloc(MOST_KNOTS, sizeof *knot);
        if (!knot)
            return tc_fail(err, TC_E_MEMORY, "out of memory for knots");
        size_t n = functions[index].make(knot, &g);
        status = tc_transfer_from_knots(&out->tf, knot, n, &out->refused);
        free(knot);
    } else {
        status = make_by_name(out, index, &g, &out->refused);
    }
    if (functions[index].refused)
        return status != TC_OK ? TC_OK : tc_fail(err, TC_E_ARG, "the function '%s' is not refused", out->name);
    if (status == TC_OK && (mesh->generator->defects & TC_SYNTH_OVERLAPPING))
        status = make_plain(out, &out->refused);
    return status == TC_OK ? TC_OK : tc_fail(err, status, "the function '%s': %s", out->name, out->refused.text);
}

void hard_function_close(hard_function *f)
{
    tc_transfer_destroy(&f->tf);
}
