/* candidate.c: the settings that --error and --frame-time choose from, and the rules of choosing. */
#include "study/candidate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Cheapest first by what is expected; what decides is measured. Tables are for those who ask for them: at one error
 * running integrals were always faster (docs/accuracy.md). */
static const tc_candidate ways[] = {
    {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 1},
    {.integrator = TC_INTEGRATOR_INTEGRAL},
    {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2},
    {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2, .split = 0.5},
    {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2, .split = 0.25},
    {.integrator = TC_INTEGRATOR_INTEGRAL, .order = 2, .split = 0.1},
    {.integrator = TC_INTEGRATOR_EXACT},
    {.integrator = TC_INTEGRATOR_TABLE, .table = {128, 128, 256}, .format = TC_TABLE_8},
    {.integrator = TC_INTEGRATOR_TABLE, .table = {128, 128, 256}, .format = TC_TABLE_16F},
    {.integrator = TC_INTEGRATOR_TABLE, .table = {128, 128, 256}, .format = TC_TABLE_32F},
    {.integrator = TC_INTEGRATOR_TABLE, .table = {256, 256, 256}, .format = TC_TABLE_16F},
};
static const double stops[] = {0.99, 0.995, 0.998, 0.999, 0.9995, 0.9999, 0.99999, 1};

/* Row `way` with what fixed decides in it taken out. False: fixed asks for another integrator. */
static bool way_for(tc_candidate *out, const tc_candidate *way, const tc_render_options *fixed)
{
    *out = *way;
    if (fixed->integrator == TC_INTEGRATOR_AUTO ? way->integrator == TC_INTEGRATOR_TABLE
                                                : way->integrator != fixed->integrator)
        return false;
    /* An order or a split that is fixed speaks of running integrals. */
    bool running = fixed->integral_order > 0 || fixed->integral_split > 0;
    if (running && fixed->integrator == TC_INTEGRATOR_AUTO && way->integrator != TC_INTEGRATOR_INTEGRAL)
        return false;
    if (fixed->integral_order > 0 && out->order > 0) {
        if (out->order != fixed->integral_order && !(out->order == 2 && out->split > 0))
            return false; /* order 1 may be split, too */
        out->order = 0;
    }
    if (fixed->integral_split > 0)
        out->split = 0;
    if (fixed->table_size[0] > 0)
        memset(out->table, 0, sizeof out->table);
    if (fixed->table_format != TC_TABLE_AUTO)
        out->format = TC_TABLE_AUTO;
    return true;
}

static bool same_way(const tc_candidate *a, const tc_candidate *b)
{
    return a->integrator == b->integrator && a->order == b->order && a->split == b->split && a->format == b->format &&
           !memcmp(a->table, b->table, sizeof a->table);
}

size_t tc_candidate_list(tc_candidate out[TC_CANDIDATE_MAX], const tc_render_options *fixed)
{
    size_t n = 0;
    int group = 0;
    for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
        tc_candidate way;
        bool there = false;
        if (!way_for(&way, &ways[i], fixed))
            continue;
        for (size_t k = 0; k < n; k++)
            there = there || same_way(&way, &out[k]);
        if (there)
            continue;
        way.group = group++;
        way.error = way.ms = NAN;
        for (size_t s = 0; s < sizeof stops / sizeof *stops && n < TC_CANDIDATE_MAX; s++) {
            if (fixed->opacity_stop > 0 && s > 0)
                break;
            way.stop = fixed->opacity_stop > 0 ? fmin(fixed->opacity_stop, 1) : stops[s];
            out[n++] = way;
        }
    }
    return n;
}

void tc_candidate_apply(tc_render_options *options, const tc_candidate *c)
{
    options->integrator = c->integrator;
    if (c->order > 0)
        options->integral_order = c->order;
    if (c->split > 0)
        options->integral_split = c->split;
    if (c->table[0] > 0)
        memcpy(options->table_size, c->table, sizeof options->table_size);
    if (c->format != TC_TABLE_AUTO)
        options->table_format = c->format;
    options->opacity_stop = c->stop;
}

void tc_candidate_key(char out[TC_CANDIDATE_TEXT], const tc_candidate *c)
{
    if (c->integrator == TC_INTEGRATOR_TABLE)
        snprintf(out, TC_CANDIDATE_TEXT, "table-%dx%dx%d-%d-%.9g", c->table[0], c->table[1], c->table[2],
                 (int)c->format, c->stop);
    else if (c->integrator == TC_INTEGRATOR_EXACT)
        snprintf(out, TC_CANDIDATE_TEXT, "exact-%.9g", c->stop);
    else
        snprintf(out, TC_CANDIDATE_TEXT, "integral-%d-%.9g-%.9g", c->order, c->split, c->stop);
}

void tc_candidate_text(char out[TC_CANDIDATE_TEXT], const tc_candidate *c, const tc_render_options *options)
{
    tc_render_options o = *options;
    char way[88], stop[32];
    tc_candidate_apply(&o, c);
    if (c->integrator == TC_INTEGRATOR_TABLE)
        snprintf(way, sizeof way, "table of %dx%dx%d, %d bits a channel", o.table_size[0] > 0 ? o.table_size[0] : 128,
                 o.table_size[0] > 0 ? o.table_size[1] : 128, o.table_size[0] > 0 ? o.table_size[2] : 256,
                 o.table_format == TC_TABLE_AUTO ? 16 : (int)o.table_format);
    else if (c->integrator == TC_INTEGRATOR_EXACT)
        snprintf(way, sizeof way, "exact, piece by piece of the function");
    else if (o.integral_split > 0)
        snprintf(way, sizeof way, "running integrals of %s order, split at %.4g",
                 o.integral_order == 1 ? "first" : "second", o.integral_split);
    else if (o.integral_order == 0)
        snprintf(way, sizeof way, "running integrals, hard segments piece by piece");
    else
        snprintf(way, sizeof way, "running integrals of %s order", o.integral_order == 1 ? "first" : "second");
    if (c->stop < 1)
        snprintf(stop, sizeof stop, "opacity stop %.7g", c->stop);
    else
        snprintf(stop, sizeof stop, "no opacity stop");
    snprintf(out, TC_CANDIDATE_TEXT, "%s, %s", way, stop);
}

/* ------------------------------------------------------------------------------------------------------- choosing */

size_t tc_candidate_frugal(size_t *index, const tc_candidate *candidate, size_t n, double limit)
{
    size_t m = 0;
    for (size_t i = 0; i < n; i++)
        if (candidate[i].error <= limit && (m == 0 || candidate[index[m - 1]].group != candidate[i].group))
            index[m++] = i;
    return m;
}

size_t tc_candidate_cheapest(const tc_candidate *candidate, const size_t *index, size_t m)
{
    double least = INFINITY;
    for (size_t k = 0; k < m; k++)
        least = fmin(least, candidate[index[k]].ms); /* NAN: the other */
    size_t best = index[0];
    bool found = false;
    for (size_t k = 0; k < m; k++) {
        const tc_candidate *c = &candidate[index[k]];
        if (c->ms <= least * (1 + TC_TIME_SAME) && (!found || c->error < candidate[best].error)) {
            best = index[k];
            found = true;
        }
    }
    return best;
}

size_t tc_candidate_best(const tc_candidate *candidate, size_t n)
{
    size_t best = n;
    for (size_t i = 0; i < n; i++)
        if (isfinite(candidate[i].error) &&
            (best == n || candidate[i].error < candidate[best].error ||
             (candidate[i].error == candidate[best].error && candidate[i].stop < candidate[best].stop)))
            best = i;
    return best;
}

size_t tc_candidate_ladder(size_t *index, const tc_candidate *candidate, size_t n, int group)
{
    size_t m = 0;
    for (size_t i = 0; i < n; i++)
        if (candidate[i].group == group && isfinite(candidate[i].error) &&
            (m == 0 || candidate[i].error < candidate[index[m - 1]].error))
            index[m++] = i;
    return m;
}
