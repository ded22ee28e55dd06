/* shade.c: light on the volume and on isosurfaces, by gradients of cells or of vertices. */
#include "core/vec.h"
#include "gpu/effects/effects.h"
#include "gpu/effects/light.h"
#include "gpu/pack_gradient.h"
#include "gpu/pass.h"
#include "scene/look.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool is_smooth(const tc_effect_scene *scene)
{
    return scene->look->shade.gradient == TC_GRADIENT_VERTEX;
}

/* ---------------------------------------------------------------------------------------------------- gradients */

typedef struct gradients {
    uint64_t mesh_serial, scalar_serial; /* of what they were made of */
    tc_gradient kind;
    tc_texture_buffer texture;
} gradients;

static bool gradient_wanted(char *why, const tc_effect_scene *scene)
{
    bool is = tc_look_lights_volume(scene->look) || tc_look_lights_surfaces(scene->look);
    snprintf(why, TC_EFFECT_WHY, "%s",
             !is                ? "no light"
             : is_smooth(scene) ? "light falls by those of vertices"
                                : "light falls by those of cells");
    return is;
}

static void gradient_define(char *out, size_t capacity, const tc_effect_scene *scene)
{
    snprintf(out, capacity, "%s#define SHADE_ONE_SIDED %s\n", is_smooth(scene) ? "#define GRADIENT_VERTEX\n" : "",
             scene->look->shade.one_sided ? "true" : "false");
}

static tc_status gradient_update(void *state, size_t *bytes, const tc_effect_scene *scene, const tc_gl *gl,
                                 tc_error *err)
{
    gradients *g = state;
    const tc_mesh *mesh = scene->mesh;
    tc_gradient kind = scene->look->shade.gradient;
    if (g->mesh_serial != mesh->serial || g->scalar_serial != mesh->scalar_serial || g->kind != kind) {
        tc_texture_buffer_finish(&g->texture, gl);
        g->mesh_serial = g->scalar_serial = 0;
        float *packed;
        size_t n = kind == TC_GRADIENT_VERTEX ? mesh->n_vertex : mesh->n_tet;
        const tc_pack_units units = {scene->scale, scene->scalar[0], scene->scalar[1]};
        tc_status status = tc_pack_gradient(&packed, mesh, kind, &units, scene->threads, err);
        if (status == TC_OK)
            status =
                tc_texture_buffer_upload(&g->texture, gl, packed, n, 16, GL_RGBA32F, "uploading the gradients", err);
        free(packed);
        if (status != TC_OK)
            return status;
        g->mesh_serial = mesh->serial;
        g->scalar_serial = mesh->scalar_serial;
        g->kind = kind;
    }
    *bytes = g->texture.bytes;
    return TC_OK;
}

static void gradient_finish(void *state, const tc_gl *gl)
{
    tc_texture_buffer_finish(&((gradients *)state)->texture, gl);
}

static void gradient_bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)scene;
    const gradients *g = state;
    tc_effect_fetch(job, program, "gradients", TC_UNIT_EFFECT_SHADE, GL_RGBA32F, g->texture.texture);
}

const tc_effect tc_effect_gradient = {
    .name = "gradients",
    .what = "the scalar's gradient at the ends of a ray's part in a cell",
    .shaders = "effects/parts.glsl effects/shade_gradient.glsl",
    .needs = TC_NEEDS_SUMS | TC_NEEDS_SIGNS,
    .wanted = gradient_wanted,
    .define = gradient_define,
    .state_bytes = sizeof(gradients),
    .update = gradient_update,
    .finish = gradient_finish,
    .bind = gradient_bind,
};

/* ------------------------------------------------------------------------------------------------------- volume */

static bool shade_wanted(char *why, const tc_effect_scene *scene)
{
    bool is = tc_look_lights_volume(scene->look);
    snprintf(why, TC_EFFECT_WHY, "the volume is %slit", is ? "" : "not ");
    return is;
}

static void shade_bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)state;
    const double *b = scene->mesh->report.bounds;
    const double across[3] = {b[1] - b[0], b[3] - b[2], b[5] - b[4]};
    /* R / D in packed space, where the range is 1. */
    tc_pass_float(job->gl, program, "shade_soft",
                  fmin(scene->look->shade.magnitude / (tc_vec_length(across) * scene->scale), 1e30));
}

static void shade_brighten(double most[3], const tc_effect_scene *scene)
{
    tc_light_brighten(most, &scene->look->shade);
}

const tc_effect tc_effect_shade = {
    .name = "shade",
    .what = "light on what a ray gathers in each cell",
    .shaders = "effects/shade.glsl",
    .wanted = shade_wanted,
    .bind = shade_bind,
    .brighten = shade_brighten,
    .lights = true,
};

/* -------------------------------------------------------------------------------------------------- isosurfaces */

static bool iso_wanted(char *why, const tc_effect_scene *scene)
{
    bool is = tc_look_lights_surfaces(scene->look);
    snprintf(why, TC_EFFECT_WHY, "isosurfaces are %slit", is ? "" : "not ");
    return is;
}

const tc_effect tc_effect_shade_iso = {
    .name = "shade-isosurfaces",
    .what = "light on isosurfaces where the ray crosses them",
    .shaders = "effects/shade_iso.glsl",
    .wanted = iso_wanted,
    .brighten = shade_brighten,
    .lights = true,
};
