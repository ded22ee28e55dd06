/* absorption.c: matter without light: the density emitter with colours that are all the same (Max 1995): black as a
 * shadow, or white as what an X-ray plate, on which more matter leaves more light, shows. */
#include "gpu/effects/effects.h"

#include <stdio.h>

static bool wanted(char *why, const tc_effect_scene *scene, tc_model model)
{
    snprintf(why, TC_EFFECT_WHY, "the model that was asked for");
    return scene->look->model == model;
}

static void fill(tc_knot *knot, double value)
{
    knot->r = knot->g = knot->b = value;
}

static bool absorption_wanted(char *why, const tc_effect_scene *scene)
{
    return wanted(why, scene, TC_MODEL_ABSORPTION);
}

static void absorption_knot(tc_knot *knot, const tc_effect_scene *scene)
{
    (void)scene;
    fill(knot, 0);
}

static bool xray_wanted(char *why, const tc_effect_scene *scene)
{
    return wanted(why, scene, TC_MODEL_XRAY);
}

static void xray_knot(tc_knot *knot, const tc_effect_scene *scene)
{
    (void)scene;
    fill(knot, 1);
}

const tc_effect tc_effect_absorption = {
    .name = "absorption",
    .what = "light absorbed, none emitted: the function's colours are black",
    .model = true,
    .wanted = absorption_wanted,
    .knot = absorption_knot,
};

const tc_effect tc_effect_xray = {
    .name = "xray",
    .what = "matter as on an X-ray plate: the function's colours are white",
    .model = true,
    .wanted = xray_wanted,
    .knot = xray_knot,
};
