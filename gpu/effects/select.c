/* select.c: cells that a selection does not keep are stepped through, as those of gaps are: a bit a cell says which.
 * Nothing else is packed or sent again. */
#include "gpu/effects/mask.h"

#include "core/hash.h"
#include "gpu/pack_mask.h"
#include "mesh/field.h"

#include <stdio.h>
#include <stdlib.h>

typedef struct selection {
    tc_texture_buffer mask;
    uint64_t key[2]; /* of what it was made of */
} selection;

/* Do these ranges keep all values of the mesh's own field? Of others nobody counted the values that are not finite. */
static bool keeps_all(const tc_select *select, const tc_mesh *mesh)
{
    const double *all = mesh->report.scalar_range;
    for (int k = 0; k < select->n_range && !select->field && mesh->report.nonfinite_scalars == 0; k++)
        if (select->range[k][0] <= all[0] && select->range[k][1] >= all[1])
            return true;
    return false;
}

static bool wanted(char *why, const tc_effect_scene *scene)
{
    const tc_look *look = scene->look;
    int n = 0;
    for (int i = 0; i < look->n_select; i++)
        n += keeps_all(&look->select[i], scene->mesh) ? 0 : 1;
    if (look->n_select == 0)
        snprintf(why, TC_EFFECT_WHY, "no selection");
    else if (n == 0)
        snprintf(why, TC_EFFECT_WHY, "the selection keeps all cells");
    else
        snprintf(why, TC_EFFECT_WHY, "cells are kept by %d condition%s", n, n == 1 ? "" : "s");
    return n > 0;
}

/* What the mask depends on. */
static tc_hash key_of(const tc_effect_scene *scene)
{
    const uint64_t serials[2] = {scene->mesh->serial, scene->mesh->scalar_serial};
    tc_hash key = tc_hash_bytes(serials, sizeof serials, 0);
    for (int i = 0; i < scene->look->n_select; i++) {
        const tc_select *select = &scene->look->select[i];
        const uint64_t own[4] = {key.word[0], key.word[1], select->field ? select->field->serial : 0,
                                 (uint64_t)select->n_range};
        key = tc_hash_bytes(own, sizeof own, 1);
        key = tc_hash_bytes(select->range, (size_t)select->n_range * sizeof *select->range, key.word[0] ^ key.word[1]);
    }
    return key;
}

static void finish(void *state, const tc_gl *gl)
{
    selection *s = state;
    tc_texture_buffer_finish(&s->mask, gl);
}

static tc_status update(void *state, size_t *bytes, const tc_effect_scene *scene, const tc_gl *gl, tc_error *err)
{
    selection *s = state;
    const tc_mesh *mesh = scene->mesh;
    const tc_hash key = key_of(scene);
    tc_status status = TC_OK;
    if (!s->mask.texture || s->key[0] != key.word[0] || s->key[1] != key.word[1]) {
        uint32_t *mask;
        finish(s, gl);
        status = tc_pack_mask_select(&mask, NULL, mesh, scene->look->select, (size_t)scene->look->n_select,
                                     scene->threads, err);
        if (status != TC_OK)
            return status;
        status = tc_effect_mask_upload(&s->mask, gl, mask, mesh->n_tet, mesh->n_imaginary, err);
        free(mask);
        s->key[0] = key.word[0];
        s->key[1] = key.word[1];
    }
    *bytes = s->mask.bytes;
    return status;
}

static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)scene;
    const selection *s = state;
    tc_effect_mask_bind(&s->mask, job, program, "select_mask", TC_UNIT_EFFECT_MASK);
}

const tc_effect tc_effect_select = {
    .name = "select",
    .what = "whole cells by their values, the others stepped through",
    .shaders = "effects/select.glsl",
    .needs = TC_NEEDS_SIGNS,
    .wanted = wanted,
    .state_bytes = sizeof(selection),
    .update = update,
    .finish = finish,
    .bind = bind,
};
