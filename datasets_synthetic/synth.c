/* synth.c: the list of synthetic datasets, and the way from a generator to a mesh. */
#include "synth.h"

#include "core/memory.h"
#include "core/room.h"
#include "soup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ROW(id, name, what, field) {name, what, field},
static const tc_synth_info info[] = {TC_SYNTH_ROWS(ROW)};
#undef ROW
#define ROW(id, name, what, field) &tc_synth_##id,
static const tc_synth_generator *const generator[] = {TC_SYNTH_ROWS(ROW)};
#undef ROW
#define ROW(id, name, what, field) +1
enum { N_PLAIN = 0 TC_SYNTH_PLAIN_ROWS(ROW) };
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
    for (size_t i = 0; i < N_PLAIN; i++) {
        size_t used = strlen(list);
        snprintf(list + used, sizeof list - used, "%s, ", info[i].name);
    }
    return tc_fail(err, TC_E_ARG,
                   "there is no synthetic dataset '%s'; there are %sand %d hard cases, from %s to %s (tc_synth_list, "
                   "tetcast synth --list)",
                   name, list, N_GENERATOR - N_PLAIN, info[N_PLAIN].name, info[N_GENERATOR - 1].name);
}

/* Gives the soup the generator's field at its vertices, unless it has values of its own or there is no field. */
static tc_status sample(tc_synth_soup *soup, const tc_synth_generator *g, tc_error *err)
{
    if (soup->scalar || !g->field)
        return TC_OK;
    tc_status status = tc_soup_values(soup, TC_POINT_DATA, err);
    for (size_t i = 0; i < soup->n_vertex && !status; i++)
        soup->scalar[i] = g->field(soup->vertex + 3 * i);
    return status;
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
    /* four vertices a tet, at least 4.5 tets for each three doubles and a value, and the mesh copies them */
    tc_status status = tc_room_check(n_cells * 2 * (16 + 32 * 2 / 9), err, "making %zu cells", n_cells);
    if (status)
        goto done;
    status = g->build(&soup, n_cells ? n_cells : g->default_cells, seed, err);
    if (status)
        goto done;
    status = sample(&soup, g, err);
    if (status)
        goto done;
    tc_mesh_arrays arrays = {soup.n_vertex, soup.vertex, soup.n_tet, soup.tet, soup.scalar, soup.association, "field"};
    if (!soup.scalar)
        arrays.field_name = NULL;
    status = tc_mesh_create(out, &arrays, err);
done:
    tc_synth_soup_finish(&soup);
    return status;
}

void tc_synth_soup_finish(tc_synth_soup *soup)
{
    free(soup->vertex);
    free(soup->tet);
    free(soup->scalar);
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
