/* explain_measure.c: what each part of a frame costs, by leaving it out. */
#include "cli/picture/explain_measure.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 5, FRAMES = 3, CASES = TC_EXPLAINED_MOST + 2 };

/* Case k leaves out the last k of the effects in force; one more at the end is the whole picture again. */
typedef struct cases {
    int n, name[TC_EXPLAINED_MOST]; /* effects in force, the model first */
    char without[CASES][512];
    double ms[CASES][ROUNDS], first_hit[CASES][ROUNDS];
} cases;

static void find_cases(cases *c, const tc_explanation *e)
{
    for (int i = 0; i < e->n_effect; i++) /* one model is in force */
        if (e->effect[i].in_force && e->effect[i].model)
            c->name[c->n++] = i;
    for (int i = 0; i < e->n_effect; i++)
        if (e->effect[i].in_force && !e->effect[i].model)
            c->name[c->n++] = i;
    for (int k = 1; k <= c->n; k++)
        snprintf(c->without[k], sizeof c->without[k], "%.400s %s ", c->without[k - 1],
                 e->effect[c->name[c->n - k]].name);
}

static tc_status time_case(double *ms, double *first_hit, const char *without, tc_renderer *renderer,
                           const tc_render_run *run, const tc_log *log, tc_error *err)
{
    tc_render_options options = run->render;
    double frame[FRAMES], first[FRAMES];
    tc_spread spread;
    options.without = *without ? without : NULL;
    for (int i = -1; i < FRAMES; i++) { /* the first one uploads and compiles */
        tc_image *image;
        tc_render_stats stats;
        tc_status status = tc_render(&image, &stats, renderer, run->mesh, run->tf, &run->camera, &options, log, err);
        tc_image_destroy(&image);
        if (status != TC_OK)
            return status;
        if (i >= 0) {
            frame[i] = stats.ms_frame;
            first[i] = stats.ms_first_hit;
        }
    }
    tc_spread_of(&spread, frame, FRAMES);
    *ms = spread.median;
    tc_spread_of(&spread, first, FRAMES);
    *first_hit = spread.median;
    return TC_OK;
}

static double median(double *value)
{
    tc_spread spread;
    tc_spread_of(&spread, value, ROUNDS);
    return spread.median;
}

static void add_part(tc_shares *out, const char *name, double ms)
{
    tc_share *part = &out->part[out->n++];
    snprintf(part->name, sizeof part->name, "%s", name);
    part->ms = ms;
    out->sum += ms;
}

tc_status tc_shares_measure(tc_shares *out, const tc_explanation *explanation, tc_renderer *renderer,
                            const tc_render_run *run, const tc_log *log, tc_error *err)
{
    memset(out, 0, sizeof *out);
    cases *c = calloc(1, sizeof *c);
    if (!c)
        return TC_E_MEMORY;
    find_cases(c, explanation);
    tc_status status = TC_OK;
    for (int round = 0; round < ROUNDS && status == TC_OK; round++)
        for (int k = 0; k <= c->n + 1 && status == TC_OK; k++)
            status = time_case(&c->ms[k][round], &c->first_hit[k][round], k <= c->n ? c->without[k] : "", renderer, run,
                               log, err);
    if (status == TC_OK) {
        double ms[CASES];
        for (int k = 0; k <= c->n + 1; k++)
            ms[k] = median(c->ms[k]);
        double first = median(c->first_hit[c->n]);
        add_part(out, "first hits", first);
        add_part(out, "bare walk", ms[c->n] - first);
        for (int i = 0; i < c->n; i++)
            add_part(out, explanation->effect[c->name[i]].name, ms[c->n - 1 - i] - ms[c->n - i]);
        out->frame = ms[c->n + 1];
    }
    free(c);
    return status;
}
