/* emission.c: light without matter: what is emitted reaches the eye whole, and is added to what lies behind (Max 1995).
 */
#include "gpu/effects/effects.h"

#include "gpu/pass.h"

#include <stdio.h>

static bool wanted(char *why, const tc_effect_scene *scene)
{
    snprintf(why, TC_EFFECT_WHY, "the model that was asked for");
    return scene->look->model == TC_MODEL_EMISSION;
}

/* Nothing is absorbed: no piece need be cut for its depth. */
static void define(char *out, size_t capacity, const tc_effect_scene *scene)
{
    (void)scene;
    snprintf(out, capacity, "#undef PIECES_DENSE\n");
}

/* No ray is opaque. */
static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)state;
    (void)scene;
    tc_pass_float(job->gl, program, "transmittance_stop", -1);
}

const tc_effect tc_effect_emission = {
    .name = "emission",
    .what = "light emitted in proportion to attenuation, and not absorbed",
    .shaders = "effects/emission.glsl",
    .needs = TC_NEEDS_PIECES,
    .model = true,
    .wanted = wanted,
    .define = define,
    .bind = bind,
};
