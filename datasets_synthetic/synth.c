/* synth.c: the list of synthetic datasets, and the way from a generator to a mesh. */
#include "synth.h"

#include "core/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One row a generator; the two tables below are in this order. */
#define GENERATORS                                                                                                     \
    ROW(kuhn, "unit cube, Kuhn lattice with jittered vertices; convex", "linear: (x + 2 y + 3 z) / 6")                 \
    ROW(ball, "ball of radius 1, octahedral lattice; convex", "r + 0.15 sin(6 z)")                                     \
    ROW(heatsink, "base plate with 48 fins, many re-entries", "temperature: cosh decay along the fins, warm spot")     \
    ROW(cylinder, "upright cylinder with a hole through it", "wave winding around the axis")                           \
    ROW(bluntfin, "channel around a blunt fin, C-shaped grid", "density: bow shock, compression at the nose, wake")    \
    ROW(comb, "spine with 40 teeth, 39 re-entries along it", "sin(3 x) cos(2 z) + y")                                  \
    ROW(shells, "three nested shells around a cavity", "r + 0.3 x y")                                                  \
    ROW(spiral, "rolled sheet of three turns", "r + 0.25 sin(4 z)")                                                    \
    ROW(torusknot, "square tube along a trefoil knot", "sin(3 angle) + z")                                             \
    ROW(tet, "one tet", "linear")                                                                                      \
    ROW(two, "two tets that share a face", "linear")

#define ROW(name, what, field) {#name, what, field},
static const tc_synth_info info[] = {GENERATORS};
#undef ROW
#define ROW(name, what, field) &tc_synth_##name,
static const tc_synth_generator *const generator[] = {GENERATORS};
#undef ROW

enum { N_GENERATOR = sizeof info / sizeof *info };

const tc_synth_info *tc_synth_list(size_t *n)
{
    *n = N_GENERATOR;
    return info;
}

const tc_synth_generator *tc_synth_find(const char *name)
{
    for (size_t i = 0; i < N_GENERATOR; i++)
        if (strcmp(info[i].name, name) == 0)
            return generator[i];
    return NULL;
}

static tc_status fail_unknown(const char *name, tc_error *err)
{
    char list[512] = "";
    for (size_t i = 0; i < N_GENERATOR; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "", info[i].name);
    }
    return tc_fail(err, TC_E_ARG, "there is no synthetic dataset '%s'; there are %s", name, list);
}

tc_status tc_synth_create(tc_mesh **out, const char *name, size_t n_cells, uint64_t seed, tc_error *err)
{
    *out = NULL;
    if (!name)
        return fail_unknown("", err);
    const tc_synth_generator *g = tc_synth_find(name);
    if (!g)
        return fail_unknown(name, err);
    if (n_cells > 2000000000)
        return tc_fail(err, TC_E_ARG, "%zu cells are too many for 32-bit ids; ask for at most 2000000000", n_cells);

    tc_synth_soup soup = {0};
    double *scalar = NULL;
    tc_status status = g->build(&soup, n_cells ? n_cells : g->default_cells, seed, err);
    if (status)
        goto done;
    scalar = tc_alloc(soup.n_vertex, sizeof *scalar);
    if (!scalar) {
        status = tc_fail_memory(err, "the synthetic field", soup.n_vertex, sizeof *scalar);
        goto done;
    }
    for (size_t i = 0; i < soup.n_vertex; i++)
        scalar[i] = g->field(soup.vertex + 3 * i);
    tc_mesh_arrays arrays = {soup.n_vertex, soup.vertex, soup.n_tet, soup.tet, scalar, TC_POINT_DATA, "field"};
    status = tc_mesh_create(out, &arrays, err);
done:
    free(scalar);
    tc_synth_soup_finish(&soup);
    return status;
}

void tc_synth_soup_finish(tc_synth_soup *soup)
{
    free(soup->vertex);
    free(soup->tet);
    memset(soup, 0, sizeof *soup);
}

tc_status tc_synth_soup_reserve(tc_synth_soup *soup, size_t n_vertex, size_t n_tet, tc_error *err)
{
    if (n_vertex > INT32_MAX || n_tet > INT32_MAX)
        return tc_fail(err, TC_E_ARG, "%zu tets with %zu vertices are too many for 32-bit ids; ask for fewer cells",
                       n_tet, n_vertex);
    soup->vertex = tc_alloc(n_vertex, 3 * sizeof *soup->vertex);
    if (!soup->vertex)
        return tc_fail_memory(err, "the vertices", n_vertex, 3 * sizeof *soup->vertex);
    soup->tet = tc_alloc(n_tet, 4 * sizeof *soup->tet);
    if (!soup->tet)
        return tc_fail_memory(err, "the tets", n_tet, 4 * sizeof *soup->tet);
    soup->n_vertex = n_vertex;
    soup->n_tet = n_tet;
    return TC_OK;
}

static uint64_t mix(uint64_t z)
{
    z += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

double tc_synth_noise(uint64_t seed, uint64_t index)
{
    return (double)(mix(mix(seed) ^ index) >> 11) * 0x1p-52 - 1;
}

double tc_synth_fit(double (*count)(const void *context, double h), const void *context, size_t n_cells, double h_max)
{
    double target = (double)n_cells, lo = h_max, hi = h_max; /* lo: too many cells; hi: few enough */
    while (count(context, lo) < target && lo > h_max * 1e-9)
        lo /= 2;
    for (int i = 0; i < 60; i++) {
        double middle = sqrt(lo * hi);
        if (count(context, middle) < target)
            hi = middle;
        else
            lo = middle;
    }
    return fabs(count(context, lo) - target) < fabs(count(context, hi) - target) ? lo : hi;
}
