/* empty.c: cells in which nothing is seen are stepped through without integration, where nearly all are such: rays that
 * run in step wait for each other, and where some integrate all do.
 *
 * A bit a cell says whether it lies deep in empty space: it is transparent over the whole range of its scalars, and so
 * are the cells DEPTH faces around it. Rays that are neighbours make their steps through cells that are near each
 * other: what lies deep for one does so for most. */
#include "gpu/effects/mask.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "gpu/pack_mask.h"
#include "transfer_functions/transfer.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DEPTH = 3, CHUNK = 512 }; /* CHUNK: words of a mask, one thread's at a time */
/* Of a mesh's cells. On llvmpipe, with a share of 0.89 a frame took 0.58 and 1.04 times the cycles that it takes
 * without (Blunt Fin, two views), 0.75 and 1.01 (Combustor), with 0.93 0.91, with 0.97 and 0.99 0.64; with less than
 * 0.8 up to 1.5. */
static const double SHARE_LEAST = 0.88;

/* How many cells lie deep in empty space, and of which mesh, values and function: serials. */
typedef struct empty_count {
    uint64_t mesh, scalar, function;
    size_t n;
} empty_count;

typedef struct empty_space {
    tc_texture_buffer mask;
    empty_count made_of;
} empty_space;

typedef struct erosion {
    uint32_t *out;
    const uint32_t *in;
    const tc_mesh *mesh;
} erosion;

static bool is_set(const uint32_t *mask, size_t cell)
{
    return mask[cell >> 5] >> (cell & 31) & 1;
}

/* Takes out the cells beside those that are not in. What lies behind the boundary, or in gaps, takes out none. */
static void erode_range(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const erosion *j = context;
    const size_t n = j->mesh->n_tet;
    for (size_t word = begin; word < end; word++) {
        uint32_t left = 0;
        for (size_t cell = 32 * word; cell < n && cell < 32 * word + 32; cell++) {
            bool all = is_set(j->in, cell);
            for (size_t face = 0; face < 4 && all; face++) {
                const int32_t other = j->mesh->neighbour[4 * cell + face];
                all = other < 0 || (size_t)other >= n || is_set(j->in, (size_t)other);
            }
            left |= (uint32_t)all << (cell & 31);
        }
        j->out[word] = left;
    }
}

static size_t count_set(const uint32_t *mask, size_t n)
{
    size_t sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += is_set(mask, i);
    return sum;
}

/* *out gets the mask and *n how many cells are in it; NULL and fewer than that where they are too few. */
static tc_status make_mask(uint32_t **out, size_t *n, const tc_effect_scene *scene, tc_error *err)
{
    const tc_mesh *mesh = scene->mesh;
    const size_t words = (mesh->n_tet + 31) / 32;
    uint32_t *mask = NULL, *other = NULL;
    *out = NULL;
    tc_status status = tc_pack_mask_empty(&mask, n, mesh, scene->transfer, scene->threads, err);
    if (status != TC_OK || (double)*n < SHARE_LEAST * (double)mesh->n_tet) {
        free(mask);
        return status;
    }
    other = tc_alloc(words, sizeof *other);
    if (!other) {
        free(mask);
        return tc_fail_memory(err, "a mask of empty cells", words, sizeof *other);
    }
    for (int i = 0; i < DEPTH; i++) {
        erosion j = {.out = other, .in = mask, .mesh = mesh};
        tc_parallel_for(words, CHUNK, scene->threads, erode_range, &j);
        uint32_t *swap = mask;
        mask = other;
        other = swap;
    }
    free(other);
    *n = count_set(mask, mesh->n_tet);
    *out = mask;
    return TC_OK;
}

/* Is there a stretch of the data's range that is transparent? */
static bool has_gap(const tc_transfer *tf, const double range[2])
{
    const tc_knot *first = tf->knot, *last = tf->knot + tf->n - 1;
    if ((first->a == 0 && first->s > range[0]) || (last->a == 0 && last->s < range[1]))
        return true;
    for (const tc_knot *k = first; k < last; k++)
        if (k[0].a == 0 && k[1].a == 0 && k[0].s < range[1] && k[1].s > range[0] && k[0].s < k[1].s)
            return true;
    return false;
}

/* What else looks at cells, or carries something from one to the next; NULL: nothing. */
static const char *looks_at_cells(const tc_effect_scene *scene)
{
    const tc_look *look = scene->look;
    const tc_model model = look->model;
    if (model != TC_MODEL_DENSITY_EMITTER && model != TC_MODEL_EMISSION && model != TC_MODEL_ABSORPTION &&
        model != TC_MODEL_XRAY && model != TC_MODEL_DEPTH)
        return "the model looks at all cells";
    if (look->n_iso > 0)
        return "isosurfaces may lie in transparent cells";
    if (look->n_geometry > 0)
        return "geometry may lie in transparent cells";
    if (look->color_field || (look->shade.volume && look->shade.gradient != TC_GRADIENT_NONE))
        return "other values are carried from cell to cell";
    return scene->options->stepper == TC_STEPPER_PLANES ? "the stepper is 'planes'" : NULL;
}

static empty_count key_of(const tc_effect_scene *scene)
{
    return (empty_count){scene->mesh->serial, scene->mesh->scalar_serial, scene->transfer->serial, 0};
}

static bool is_same(const empty_count *a, const empty_count *b)
{
    return a->mesh == b->mesh && a->scalar == b->scalar && a->function == b->function;
}

static bool wanted(char *why, const tc_effect_scene *scene)
{
    const tc_mesh *mesh = scene->mesh;
    const char *instead = looks_at_cells(scene);
    empty_count found = key_of(scene), *kept = scene->memo;
    if (!instead && scene->clear)
        instead = "the function shows none of the values, so that no ray is walked";
    if (!instead && !has_gap(scene->transfer, scene->scalar))
        instead = "the function is transparent nowhere";
    if (instead) {
        snprintf(why, TC_EFFECT_WHY, "%s", instead);
        return false;
    }
    if (kept && is_same(kept, &found)) {
        found = *kept;
    } else {
        uint32_t *mask;
        if (make_mask(&mask, &found.n, scene, NULL) != TC_OK)
            found.n = 0; /* no memory for what would only be faster */
        free(mask);
        if (kept)
            *kept = found;
    }
    const double share = mesh->n_tet > 0 ? (double)found.n / (double)mesh->n_tet : 0;
    snprintf(why, TC_EFFECT_WHY, "%.1f %% of the cells are transparent; at %.0f %% it pays", 100 * share,
             100 * SHARE_LEAST);
    return share >= SHARE_LEAST;
}

static int rounds(const tc_effect_scene *scene)
{
    (void)scene;
    return 1;
}

static void finish(void *state, const tc_gl *gl)
{
    empty_space *e = state;
    tc_texture_buffer_finish(&e->mask, gl);
}

static tc_status update(void *state, size_t *bytes, const tc_effect_scene *scene, const tc_gl *gl, tc_error *err)
{
    empty_space *e = state;
    const tc_mesh *mesh = scene->mesh;
    const empty_count key = key_of(scene);
    tc_status status = TC_OK;
    if (!e->mask.texture || !is_same(&e->made_of, &key)) {
        uint32_t *mask;
        size_t n;
        finish(e, gl);
        status = make_mask(&mask, &n, scene, err);
        if (status != TC_OK)
            return status;
        status = tc_effect_mask_upload(&e->mask, gl, mask, mesh->n_tet, mesh->n_imaginary, err);
        free(mask);
        e->made_of = key;
    }
    *bytes = e->mask.bytes;
    return status;
}

static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)scene;
    const empty_space *e = state;
    tc_effect_mask_bind(&e->mask, job, program, "empty_mask", TC_UNIT_EFFECT_EMPTY);
}

const tc_effect tc_effect_empty_space = {
    .name = "empty-space",
    .what = "cells in which nothing is seen, stepped through without integration",
    .shaders = "effects/empty.glsl",
    .wanted = wanted,
    .memo_bytes = sizeof(empty_count),
    .rounds = rounds,
    .state_bytes = sizeof(empty_space),
    .update = update,
    .finish = finish,
    .bind = bind,
};
