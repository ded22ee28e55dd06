/* iso.c: isosurfaces, at the exact place within the cell, in order with the volume. */
#include "gpu/effects/effects.h"

#include "transfer_functions/place.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool wanted(char *why, const tc_effect_scene *scene)
{
    int n = scene->look->n_iso;
    if (n > 0)
        snprintf(why, TC_EFFECT_WHY, "%d isosurface%s", n, n == 1 ? "" : "s");
    else
        snprintf(why, TC_EFFECT_WHY, "no isosurface");
    return n > 0;
}

static void define(char *out, size_t capacity, const tc_effect_scene *scene)
{
    snprintf(out, capacity, "#define ISO %d\n", scene->look->n_iso);
}

static int rounds(const tc_effect_scene *scene)
{
    return scene->look->n_iso;
}

static int by_value(const void *a, const void *b)
{
    const tc_iso *p = a, *q = b;
    return (p->value > q->value) - (p->value < q->value);
}

static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)state;
    const tc_gl *gl = job->gl;
    int n = scene->look->n_iso;
    GLint value = gl->GetUniformLocation(program, "iso_value"), color = gl->GetUniformLocation(program, "iso_color");
    tc_iso iso[TC_ISO_MOST];
    if (value < 0)
        return;
    for (int i = 0; i < n; i++)
        iso[i] = scene->look->iso[i];
    qsort(iso, (size_t)n, sizeof *iso, by_value);
    bool range = scene->scalar[1] > scene->scalar[0]; /* data of one value cross nothing */
    for (int i = 0; i < n; i++) {
        double rgba[4];
        tc_transfer_evaluate(rgba, scene->transfer, iso[i].value);
        for (int k = 0; k < 3 && iso[i].has_color; k++)
            rgba[k] = iso[i].color[k];
        if (!iso[i].has_color && scene->look->color_field)
            rgba[0] = -1; /* color_field.glsl knows */
        gl->Uniform1f(value + i, (GLfloat)(range ? tc_place(iso[i].value, scene->scalar[0], scene->scalar[1]) : 2));
        const GLfloat shown[4] = {(GLfloat)rgba[0], (GLfloat)rgba[1], (GLfloat)rgba[2], (GLfloat)iso[i].opacity};
        gl->Uniform4fv(color + i, 1, shown);
    }
}

/* The function's colours may be others in a model that changes them. */
static void brighten(double most[3], const tc_effect_scene *scene)
{
    for (int i = 0; i < scene->look->n_iso; i++) {
        const tc_iso *iso = &scene->look->iso[i];
        double rgba[4];
        tc_transfer_evaluate(rgba, scene->transfer, iso->value);
        for (int k = 0; k < 3; k++)
            most[k] = fmax(most[k], iso->has_color ? iso->color[k] : rgba[k]);
    }
}

const tc_effect tc_effect_iso = {
    .name = "isosurfaces",
    .what = "surfaces on which the scalar has a value",
    .shaders = "effects/surface.glsl effects/parts.glsl effects/iso.glsl",
    .needs = TC_NEEDS_PIECES | TC_NEEDS_POINTS,
    .wanted = wanted,
    .define = define,
    .rounds = rounds,
    .bind = bind,
    .brighten = brighten,
};
