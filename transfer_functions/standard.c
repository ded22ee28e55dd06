/* standard.c: the functions that errors and times are measured with, declared once for studies, tests and docs.
 * Between them they hold what is hard on integration along a segment: nothing (smooth), knots within a cell, a peak far
 * narrower than the change along a cell, and steps at which a cell turns opaque. */
#include "transfer_functions/transfer.h"

#include "core/memory.h"

#include <stdlib.h>
#include <string.h>

/* Knots over x in [0, 1]; attenuation per unit distance. */
static const tc_knot knots12[] = {
    {0.00, 0.05, 0.03, 0.53, 0.00}, {0.07, 0.30, 0.01, 0.64, 0.10}, {0.16, 0.49, 0.01, 0.66, 0.00},
    {0.25, 0.65, 0.13, 0.58, 0.50}, {0.33, 0.20, 0.60, 0.90, 0.10}, {0.42, 0.82, 0.30, 0.44, 0.00},
    {0.50, 0.90, 0.42, 0.36, 0.80}, {0.61, 0.10, 0.80, 0.40, 0.20}, {0.70, 0.97, 0.56, 0.26, 0.00},
    {0.79, 0.99, 0.70, 0.17, 1.20}, {0.90, 0.30, 0.30, 1.00, 0.30}, {1.00, 0.94, 0.98, 0.13, 2.00},
};
/* A tent 1/500 of the range wide on a thin ground. */
static const tc_knot spike[] = {
    {0.000, 0.23, 0.30, 0.75, 0.01}, {0.429, 0.55, 0.69, 1.00, 0.02}, {0.430, 1.00, 0.85, 0.10, 30.0},
    {0.431, 0.87, 0.87, 0.87, 0.02}, {1.000, 0.71, 0.02, 0.15, 0.10},
};
/* Steps up to 20 per unit distance: a cell of edge U lets 2e-9 of the light through. */
static const tc_knot steps[] = {
    {0.00, 0.23, 0.30, 0.75, 0.02}, {0.25, 0.23, 0.30, 0.75, 0.02}, {0.25, 0.10, 0.65, 0.85, 20.0},
    {0.32, 0.10, 0.65, 0.85, 20.0}, {0.32, 0.85, 0.85, 0.80, 0.05}, {0.45, 0.85, 0.85, 0.80, 0.05},
    {0.45, 0.95, 0.75, 0.15, 20.0}, {0.55, 0.95, 0.75, 0.15, 20.0}, {0.55, 0.95, 0.60, 0.45, 0.10},
    {0.80, 0.95, 0.60, 0.45, 0.10}, {0.80, 0.71, 0.02, 0.15, 20.0}, {1.00, 0.71, 0.02, 0.15, 20.0},
};

static const struct {
    const tc_knot *knot; /* NULL: the function of tc_transfer_create without options */
    size_t n;
} shape[] = {
    {NULL, 0},
    {knots12, sizeof knots12 / sizeof *knots12},
    {spike, sizeof spike / sizeof *spike},
    {steps, sizeof steps / sizeof *steps},
};

static const tc_standard_function standard[] = {
    {"smooth", "Cool to Warm, opacity rising linearly from 0 to 0.3"},
    {"knots12", "12 knots of changing colour, opacity up and down between 0 and 2"},
    {"spike", "opacity 30 within 1/500 of the range, next to nothing elsewhere"},
    {"steps", "steps between next to nothing and opacity 20"},
};
enum { N_STANDARD = sizeof standard / sizeof *standard, MOST_KNOTS = 12 };
_Static_assert(sizeof knots12 <= MOST_KNOTS * sizeof(tc_knot) && sizeof spike <= MOST_KNOTS * sizeof(tc_knot) &&
                   sizeof steps <= MOST_KNOTS * sizeof(tc_knot),
               "every function must fit MOST_KNOTS");

const tc_standard_function *tc_transfer_standard_list(size_t *n)
{
    *n = N_STANDARD;
    return standard;
}

tc_status tc_transfer_standard(tc_transfer **out, const char *name, const double range[2], tc_error *err)
{
    *out = NULL;
    size_t k = 0;
    while (k < N_STANDARD && strcmp(standard[k].name, name) != 0)
        k++;
    if (k == N_STANDARD)
        return tc_fail(err, TC_E_ARG, "there is no standard function '%s'; there are smooth, knots12, spike and steps",
                       name);
    const tc_transfer_options options = {.data_range = {range[0], range[1]}};
    tc_transfer *smooth = NULL;
    tc_status status = tc_transfer_create(&smooth, &options, err);
    if (status != TC_OK || !shape[k].knot) {
        *out = smooth;
        return status;
    }
    double span[2]; /* of smooth: where the range is one value or none, it is laid around */
    tc_transfer_span(span, smooth);
    tc_transfer_destroy(&smooth);
    tc_knot knot[MOST_KNOTS];
    for (size_t i = 0; i < shape[k].n; i++) {
        knot[i] = shape[k].knot[i];
        knot[i].s = span[0] * (1 - knot[i].s) + span[1] * knot[i].s;
    }
    status = tc_transfer_from_knots(out, knot, shape[k].n, err);
    if (status == TC_OK) {
        char *copy = tc_strdup(name);
        if (!copy) {
            tc_transfer_destroy(out);
            return tc_fail_memory(err, "a function's name", strlen(name) + 1, 1);
        }
        free((*out)->name);
        (*out)->name = copy;
    }
    return status;
}
