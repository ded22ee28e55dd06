/* density_emitter.c: colour emitted in proportion to attenuation (Williams and Max 1992): what the integrators do by
 * themselves. */
#include "gpu/effects/effects.h"

#include <stdio.h>

static bool wanted(char *why, const tc_effect_scene *scene)
{
    bool is = scene->look->model == TC_MODEL_DENSITY_EMITTER;
    snprintf(why, TC_EFFECT_WHY, "%s", is ? "the model that nothing else was asked for" : "another model");
    return is;
}

const tc_effect tc_effect_density_emitter = {
    .name = "density-emitter",
    .what = "light emitted in proportion to attenuation, and absorbed",
    .model = true,
    .wanted = wanted,
};
