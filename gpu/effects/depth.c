/* depth.c: no picture but numbers: where rays have a given opacity, and the scalar there. */
#include "gpu/effects/effects.h"

#include "gpu/pass.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

static double opacity_of(const tc_look *look)
{
    return look->depth_opacity > 0 ? look->depth_opacity : 0.5;
}

static bool wanted(char *why, const tc_effect_scene *scene)
{
    const bool is = scene->look->model == TC_MODEL_DEPTH;
    if (is)
        snprintf(why, TC_EFFECT_WHY, "the model that was asked for, of opacity %g", opacity_of(scene->look));
    else
        snprintf(why, TC_EFFECT_WHY, "another model");
    return is;
}

/* Optical depth of a piece is a sum, however deep it is: no piece need be cut for it. */
static void define(char *out, size_t capacity, const tc_effect_scene *scene)
{
    snprintf(out, capacity, "#undef PIECES_DENSE\n%s", scene->look->n_geometry > 0 ? "#define DEPTH_LAYERS\n" : "");
}

/* Knots that only the colours need are not crossed. */
static void knot(tc_knot *knot, const tc_effect_scene *scene)
{
    (void)scene;
    knot->r = knot->g = knot->b = 0;
}

static double in_float(double x)
{
    return fmin(fmax(x, -FLT_MAX), FLT_MAX);
}

static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)state;
    const double depth = -log1p(-fmin(opacity_of(scene->look), 1 - 1e-16));
    const double rest = depth - (double)(float)depth;
    if (job->gl->GetUniformLocation(program, "depth_wanted") < 0)
        return; /* what makes a picture of it where there is no geometry */
    tc_pass_frame(job->gl, program, job->frame);
    tc_pass_vec2(job->gl, program, "depth_wanted", depth, rest);
    tc_pass_vec2(job->gl, program, "depth_range", in_float(scene->scalar[0]), in_float(scene->scalar[1]));
    tc_pass_vec4(job->gl, program, "depth_view", job->view);
}

const tc_effect tc_effect_depth = {
    .name = "depth",
    .what = "how far away, and at which scalar, a ray has an opacity",
    .shaders = "effects/depth.glsl",
    .needs = TC_NEEDS_PIECES | TC_NEEDS_STATE_32F | TC_NEEDS_NUMBERS,
    .model = true,
    .wanted = wanted,
    .define = define,
    .knot = knot,
    .bind = bind,
};
