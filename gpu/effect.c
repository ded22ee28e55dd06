/* effect.c: which effects a picture calls for, and what follows from that. */
#include "gpu/effect.h"

#include "core/memory.h"
#include "gpu/pass.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Adds the names of a list with spaces that are not in out yet. */
static void add_names(char *out, size_t capacity, const char *list)
{
    for (const char *p = list; *p; p += strspn(p, " ")) {
        size_t length = strcspn(p, " "), n = strlen(out);
        bool there = false;
        for (const char *q = out; *q && !there; q += strspn(q, " ")) {
            size_t other = strcspn(q, " ");
            there = other == length && strncmp(p, q, length) == 0;
            q += other;
        }
        if (!there)
            snprintf(out + n, capacity - n, "%s%.*s", n ? " " : "", (int)length, p);
        p += length;
    }
}

static tc_status check(const tc_effects *e, tc_error *err)
{
    for (int i = 0; i < e->n; i++) {
        const tc_effect *row = e->row[i];
        for (int k = 0; k < e->n; k++) {
            char name[64];
            snprintf(name, sizeof name, " %s ", e->row[k]->name);
            if (row->excludes && strstr(row->excludes, name))
                return tc_fail(err, TC_E_ARG, "%s (%s) and %s (%s) exclude each other; leave one of them out",
                               row->name, e->why[i], e->row[k]->name, e->why[k]);
        }
        if ((row->needs & TC_NEEDS_POINTS) && e->scene.mesh->association == TC_CELL_DATA)
            return tc_fail(err, TC_E_ARG, "%s (%s) needs values of points, but the field's are of cells", row->name,
                           e->why[i]);
        if ((row->needs & TC_NEEDS_SIGNS) && e->scene.options->stepper == TC_STEPPER_PLANES)
            return tc_fail(err, TC_E_ARG,
                           "the stepper 'planes' is there to be compared with, and knows no %s (%s); use 'signs'",
                           row->name, e->why[i]);
        if ((row->needs & TC_NEEDS_STATE_32F) && e->scene.options->state_format == TC_STATE_16F)
            return tc_fail(err, TC_E_ARG, "%s (%s) needs the state format 32f, but 16f was asked for", row->name,
                           e->why[i]);
        tc_integrator asked = e->scene.options->integrator;
        if ((row->needs & TC_NEEDS_SUMS) && asked == TC_INTEGRATOR_TABLE)
            return tc_fail(err, TC_E_ARG,
                           "%s (%s) needs the integrator 'integral' or 'exact', but 'table' was asked for", row->name,
                           e->why[i]);
        if ((row->needs & TC_NEEDS_PIECES) && asked != TC_INTEGRATOR_AUTO && asked != TC_INTEGRATOR_EXACT)
            return tc_fail(err, TC_E_ARG, "%s (%s) needs the integrator 'exact', but '%s' was asked for", row->name,
                           e->why[i], asked == TC_INTEGRATOR_TABLE ? "table" : "integral");
    }
    return TC_OK;
}

static bool is_left_out(const tc_effect *row, const char *without)
{
    char name[64];
    snprintf(name, sizeof name, " %s ", row->name);
    return without && strstr(without, name);
}

/* What the row at this place keeps for wanted; NULL: nothing, for it needs nothing or there is no memory for it. */
static void *memo_of(tc_effect_store *store, int place)
{
    size_t bytes = tc_effect_table[place]->memo_bytes;
    if (!store || bytes == 0)
        return NULL;
    if (!store->memo[place])
        store->memo[place] = tc_calloc(1, bytes);
    return store->memo[place];
}

tc_status tc_effects_choose(tc_effects *out, tc_effect_store *store, const tc_effect_scene *scene, tc_error *err)
{
    memset(out, 0, sizeof *out);
    out->scene = *scene;
    for (int i = 0; tc_effect_table[i]; i++) {
        const tc_effect *row = tc_effect_table[i];
        int k = out->n;
        out->scene.memo = memo_of(store, i);
        if (!row->wanted(out->why[k], &out->scene)) {
            snprintf(out->why_not[i], sizeof out->why_not[i], "%s", row->model ? "another model" : out->why[k]);
            continue;
        }
        if (is_left_out(row, scene->options->without)) {
            snprintf(out->why_not[i], sizeof out->why_not[i], "left out, as was asked for");
            if (row->model) { /* what is left is the walk */
                out->needs |= TC_NEEDS_NO_FUNCTION;
                out->integrator = "effects/integrate_none.glsl";
            }
            continue;
        }
        out->row[k] = row;
        out->place[k] = i;
        out->needs |= row->needs;
        if (row->integrator)
            out->integrator = row->integrator;
        if (row->shaders)
            add_names(out->shaders, sizeof out->shaders, row->shaders);
        size_t n = strlen(out->defines);
        if (row->define)
            row->define(out->defines + n, sizeof out->defines - n, scene);
        out->rounds += row->rounds ? row->rounds(scene) : 0;
        out->nonfinite = out->nonfinite || (row->nonfinite && row->nonfinite(scene));
        out->n++;
    }
    out->scene.memo = NULL;
    return check(out, err);
}

tc_status tc_effects_function(const tc_transfer **out, tc_effect_store *store, const tc_effects *effects, tc_error *err)
{
    const tc_transfer *tf = effects->scene.transfer;
    *out = tf;
    int k = 0;
    while (k < effects->n && !effects->row[k]->knot)
        k++;
    if (k == effects->n)
        return TC_OK;
    if (!store->function || store->function_serial != tf->serial || store->function_place != effects->place[k]) {
        tc_transfer_destroy(&store->function);
        tc_knot *knot = tc_alloc(tf->n, sizeof *knot);
        if (!knot)
            return tc_fail_memory(err, "a transfer function", tf->n, sizeof *knot);
        memcpy(knot, tf->knot, tf->n * sizeof *knot);
        for (size_t i = 0; i < tf->n; i++)
            effects->row[k]->knot(&knot[i], &effects->scene);
        tc_status status = tc_transfer_from_knots(&store->function, knot, tf->n, err);
        free(knot);
        if (status != TC_OK)
            return status;
        store->function_serial = tf->serial;
        store->function_place = effects->place[k];
    }
    *out = store->function;
    return TC_OK;
}

static void drop(tc_effect_store *store, int place, const tc_gl *gl)
{
    if (!store->state[place])
        return;
    if (tc_effect_table[place]->finish)
        tc_effect_table[place]->finish(store->state[place], gl);
    free(store->state[place]);
    store->state[place] = NULL;
    store->bytes[place] = 0;
}

tc_status tc_effects_update(tc_effects *effects, tc_effect_store *store, const tc_gl *gl, tc_error *err)
{
    effects->store = store;
    for (int place = 0; tc_effect_table[place]; place++) {
        int k = 0;
        while (k < effects->n && effects->place[k] != place)
            k++;
        if (k == effects->n) {
            drop(store, place, gl);
            continue;
        }
        const tc_effect *row = effects->row[k];
        if (!row->update)
            continue;
        if (!store->state[place])
            store->state[place] = tc_calloc(1, row->state_bytes);
        if (!store->state[place])
            return tc_fail_memory(err, row->name, 1, row->state_bytes);
        size_t own = 0;
        tc_status status = row->update(store->state[place], &own, &effects->scene, gl, err);
        if (status != TC_OK) {
            drop(store, place, gl);
            return status;
        }
        effects->bytes[k] = store->bytes[place] = (double)own;
    }
    return TC_OK;
}

bool tc_effects_have_frame(const tc_effects *effects)
{
    for (int k = 0; k < effects->n; k++)
        if (effects->row[k]->frame)
            return true;
    return false;
}

bool tc_effects_are_plain(const tc_effects *e)
{
    return e->needs == 0 && !*e->shaders && !e->integrator && !tc_effects_have_frame(e);
}

tc_status tc_effects_compile(const tc_effects *effects, const tc_job *job, tc_error *err)
{
    tc_status status = TC_OK;
    for (int k = 0; k < effects->n && status == TC_OK; k++)
        if (effects->row[k]->compile)
            status = effects->row[k]->compile(effects->store->state[effects->place[k]], &effects->scene, job, err);
    return status;
}

tc_status tc_effects_frame(const tc_effects *effects, const tc_job *job, tc_error *err)
{
    tc_status status = TC_OK;
    for (int k = 0; k < effects->n && status == TC_OK; k++)
        if (effects->row[k]->frame)
            status = effects->row[k]->frame(effects->store->state[effects->place[k]], &effects->scene, job, err);
    return status;
}

double tc_effects_bytes(tc_effects *effects)
{
    double sum = 0;
    for (int k = 0; k < effects->n; k++) {
        if (effects->row[k]->held)
            effects->bytes[k] = (double)effects->row[k]->held(effects->store->state[effects->place[k]]);
        sum += effects->bytes[k];
    }
    return sum;
}

void tc_effect_fetch(const tc_job *job, GLuint program, const char *name, GLuint unit, GLenum format, GLuint texture)
{
    tc_pass_fetch(job->gl, program, name, job->software ? unit : TC_UNIT_EFFECT_TEXTURE + unit, format, texture,
                  job->software);
}

void tc_effects_bind(const tc_effects *effects, const tc_job *job, GLuint program)
{
    for (int k = 0; k < effects->n; k++)
        if (effects->row[k]->bind)
            effects->row[k]->bind(effects->store->state[effects->place[k]], &effects->scene, job, program);
}

void tc_effects_nan_color(double color[4], const tc_effects *effects)
{
    for (int k = 0; k < effects->n; k++) {
        tc_knot knot = {0, color[0], color[1], color[2], color[3]};
        if (!effects->row[k]->knot || !effects->row[k]->model)
            continue;
        effects->row[k]->knot(&knot, &effects->scene);
        color[0] = knot.r;
        color[1] = knot.g;
        color[2] = knot.b;
        color[3] = knot.a;
    }
}

void tc_effects_brighten(double most[3], const tc_effects *effects)
{
    for (int lights = 0; lights < 2; lights++)
        for (int k = 0; k < effects->n; k++)
            if (effects->row[k]->brighten && effects->row[k]->lights == (lights == 1))
                effects->row[k]->brighten(most, &effects->scene);
}

void tc_effects_names(char *out, size_t capacity, const tc_effects *effects)
{
    size_t n = 0;
    out[0] = 0;
    for (int k = 0; k < effects->n && n < capacity; k++)
        n += (size_t)snprintf(out + n, capacity - n, "%s%s", n ? ", " : "", effects->row[k]->name);
}

void tc_effect_store_finish(tc_effect_store *store, const tc_gl *gl)
{
    for (int place = 0; tc_effect_table[place]; place++) {
        drop(store, place, gl);
        free(store->memo[place]);
        store->memo[place] = NULL;
    }
    tc_transfer_destroy(&store->function);
}
