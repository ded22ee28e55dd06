/* catalogue.c: the crossing of meshes, views and functions. */
#include "catalogue.h"

#include <stdio.h>
#include <string.h>

/* Views and functions that relations are tried with: whole lines in perspective and in parallel, and all colours. */
enum { VIEW_FRONT = 0, VIEW_OBLIQUE = 2, FUNCTION_CONSTANT = 1, FUNCTION_SMOOTH = 2, FUNCTION_OPAQUE = 3 };

enum { CELLS_BLADES = 400, CELLS_SHORT = 1500, CELLS_LONG = 8000, CELLS_HUGE = 10000000 };

static size_t generators(void)
{
    size_t n;
    tc_synth_list(&n);
    return n;
}

size_t hard_catalogue_meshes(bool long_run)
{
    return generators() + long_run;
}

const char *hard_catalogue_mesh(size_t index)
{
    size_t n;
    const tc_synth_info *info = tc_synth_list(&n);
    return index < n ? info[index].name : "kuhn";
}

size_t hard_catalogue_cells(size_t index, bool long_run)
{
    if (index < generators() && strcmp(hard_catalogue_mesh(index), "blades") == 0)
        return CELLS_BLADES; /* each is a layer to peel */
    return index >= generators() ? CELLS_HUGE : long_run ? CELLS_LONG : CELLS_SHORT;
}

/* An eye in a face or vertex with cells that are opaque in 1e-6 of their length says nothing: what is seen is decided
 * by less than rounding. It gets the next function. */
static hard_case plain(size_t view, size_t function)
{
    hard_case c = {view % hard_view_count(), function % hard_function_count(), 0, TC_INTEGRATOR_INTEGRAL};
    if (c.function == FUNCTION_OPAQUE && strncmp(hard_view_name(c.view), "eye ", 4) == 0)
        c.function++;
    return c;
}

/* The view's number; views past the last: there is none of that name. */
static size_t view_named(const char *name)
{
    size_t v = 0;
    while (v < hard_view_count() && strcmp(hard_view_name(v), name) != 0)
        v++;
    return v;
}

static bool has_cavity(const char *mesh)
{
    return !strcmp(mesh, "shells") || !strcmp(mesh, "cavities") || !strcmp(mesh, "cavity-nested");
}

static size_t short_cases(hard_case *out, size_t index, bool gpu)
{
    size_t n = 0, views = hard_view_count() - 2; /* the last is large, the one before it seldom tells */
    for (size_t k = 0; k < 3; k++) {
        out[n] = plain((3 * index + k) % views, 5 * index + 7 * k + 2);
        out[n++].integrator = k == 1 ? TC_INTEGRATOR_AUTO : TC_INTEGRATOR_INTEGRAL;
    }
    out[n] = plain(index % 2 ? VIEW_FRONT : VIEW_OBLIQUE, FUNCTION_CONSTANT);
    out[n++].integrator = gpu && index % 4 == 0 ? TC_INTEGRATOR_TABLE : TC_INTEGRATOR_INTEGRAL;
    out[n] = plain(index % 2 ? VIEW_OBLIQUE : VIEW_FRONT, FUNCTION_SMOOTH);
    out[n++].relation = 1 + (int)(index % (HARD_RELATIONS - 1));
    if (has_cavity(hard_catalogue_mesh(index))) /* the turns above seldom meet */
        out[n++] = plain(view_named("eye in a cavity"), FUNCTION_SMOOTH);
    return n;
}

static size_t long_cases(hard_case *out, size_t index, bool gpu)
{
    size_t n = 0;
    for (size_t v = 0; v < hard_view_count(); v++)
        if (!hard_view_is_large(v) || (gpu && index % 8 == 0))
            out[n++] = plain(v, index + v);
    for (size_t f = 0; f < hard_function_count(); f++) {
        out[n] = plain((index + f) % 3, f);
        out[n++].integrator = (index + f) % 2 ? TC_INTEGRATOR_AUTO : TC_INTEGRATOR_INTEGRAL;
    }
    for (size_t v = 0; v < 3 && gpu; v++) {
        out[n] = plain(v, FUNCTION_CONSTANT);
        out[n++].integrator = TC_INTEGRATOR_TABLE;
    }
    for (int r = 1; r < HARD_RELATIONS; r++)
        for (size_t k = 0; k < 2; k++) {
            out[n] = plain(k ? VIEW_FRONT : VIEW_OBLIQUE, FUNCTION_SMOOTH);
            out[n++].relation = r;
        }
    return n;
}

static size_t huge_cases(hard_case *out)
{
    size_t n = 0;
    for (size_t v = 0; v < hard_view_count(); v += 4)
        out[n++] = plain(v, v / 4);
    return n;
}

size_t hard_catalogue_cases(hard_case *out, size_t index, bool long_run, bool gpu)
{
    size_t n = index >= generators() ? huge_cases(out)
               : long_run            ? long_cases(out, index, gpu)
                                     : short_cases(out, index, gpu);
    for (size_t i = 0; i < n; i++)
        if (out[i].relation == HARD_REVERSED)
            out[i].view = VIEW_OBLIQUE; /* perspective rays have no common other side */
    return n;
}

void hard_case_name(char *out, size_t capacity, size_t index, const hard_case *c)
{
    snprintf(out, capacity, "%s%s; %s; %s%s%s%s", hard_catalogue_mesh(index),
             index >= generators() ? " of 1e7 cells" : "", hard_view_name(c->view), hard_function_name(c->function),
             c->relation ? "; " : "", c->relation ? hard_relation_name(c->relation) : "",
             c->integrator == TC_INTEGRATOR_TABLE  ? "; table"
             : c->integrator == TC_INTEGRATOR_AUTO ? "; default"
                                                   : "");
}
