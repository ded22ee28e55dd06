/* surfaces.c: the model that shows surfaces alone: nothing is integrated between them, and no function is uploaded. */
#include "gpu/effects/effects.h"

#include <stdio.h>

static bool wanted(char *why, const tc_effect_scene *scene)
{
    snprintf(why, TC_EFFECT_WHY, "the model that was asked for");
    return scene->look->model == TC_MODEL_SURFACES;
}

const tc_effect tc_effect_surfaces = {
    .name = "surfaces",
    .what = "surfaces alone, nothing between them",
    .shaders = "",
    .integrator = "effects/integrate_none.glsl",
    .needs = TC_NEEDS_NO_FUNCTION,
    .model = true,
    .wanted = wanted,
};
