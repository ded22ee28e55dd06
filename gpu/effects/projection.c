/* projection.c: models that make one number of a ray, of which the picture shows the function's colour: the largest
 * scalar that it meets, the least, the mean over its length. Rays gather numbers; the function is looked at once a ray,
 * where colours are made of them (projection.glsl), as it is: not thinned, and none of its integrals are made. */
#include "gpu/effects/effects.h"

#include "gpu/march.h"
#include "gpu/pass.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct projection {
    tc_gpu_transfer textures; /* pieces */
    size_t n_piece;
    uint64_t serial; /* of the function that they are made of; 0: none */
    double scalar[2];
} projection;

static bool wanted(char *why, const tc_effect_scene *scene, tc_model model)
{
    snprintf(why, TC_EFFECT_WHY, "the model that was asked for");
    return scene->look->model == model;
}

static void finish(void *state, const tc_gl *gl)
{
    projection *p = state;
    tc_gpu_transfer_finish(&p->textures, gl);
    p->serial = 0;
}

static tc_status update(void *state, size_t *bytes, const tc_effect_scene *scene, const tc_gl *gl, tc_error *err)
{
    projection *p = state;
    tc_status status = TC_OK;
    if (p->serial != scene->transfer->serial || memcmp(p->scalar, scene->scalar, sizeof p->scalar) != 0) {
        finish(p, gl);
        tc_pieces pieces;
        double span[2] = {scene->scalar[0], scene->scalar[1]};
        if (!(span[1] > span[0])) /* one value, packed as 0: any width that a double tells apart from it */
            span[1] = fmin(span[0] + fmax(1, 1e-3 * fabs(span[0])), DBL_MAX);
        if (!(span[1] > span[0]))
            span[0] = nextafter(span[0], 0);
        status = tc_pieces_build(&pieces, scene->transfer, span, err);
        if (status != TC_OK)
            return status;
        status = tc_gpu_pieces_upload(&p->textures, gl, &pieces, err);
        p->n_piece = pieces.n;
        tc_pieces_finish(&pieces);
        p->serial = status == TC_OK ? scene->transfer->serial : 0;
        memcpy(p->scalar, scene->scalar, sizeof p->scalar);
    }
    *bytes = p->textures.bytes;
    return status;
}

static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)scene;
    const projection *p = state;
    tc_job own = *job;
    own.transfer = &p->textures;
    own.n_piece = (int)p->n_piece;
    tc_march_bind_pieces(&own, program);
    /* Of the march: no ray is opaque, and unit distances, however odd, matter for nothing. */
    tc_pass_float(job->gl, program, "transmittance_stop", -1);
    tc_pass_float(job->gl, program, "length_unit", 1);
}

static bool maximum_wanted(char *why, const tc_effect_scene *scene)
{
    return wanted(why, scene, TC_MODEL_MAXIMUM);
}

static bool minimum_wanted(char *why, const tc_effect_scene *scene)
{
    return wanted(why, scene, TC_MODEL_MINIMUM);
}

static bool average_wanted(char *why, const tc_effect_scene *scene)
{
    return wanted(why, scene, TC_MODEL_AVERAGE);
}

/* Ends of pieces have two values, equal where nothing steps. */
static void define(char *out, size_t capacity, const tc_effect_scene *scene)
{
    snprintf(out, capacity, "#define TF_STEPS\n%s",
             scene->look->model == TC_MODEL_MINIMUM ? "#define PROJECT_LEAST\n" : "");
}

enum { NEEDS = TC_NEEDS_NO_FUNCTION | TC_NEEDS_STATE_32F };

const tc_effect tc_effect_maximum = {
    .name = "maximum",
    .what = "the largest scalar that a ray meets",
    .shaders = "effects/projection.glsl",
    .integrator = "effects/integrate_extremum.glsl",
    .needs = NEEDS,
    .model = true,
    .wanted = maximum_wanted,
    .define = define,
    .state_bytes = sizeof(projection),
    .update = update,
    .finish = finish,
    .bind = bind,
};

const tc_effect tc_effect_minimum = {
    .name = "minimum",
    .what = "the least scalar that a ray meets",
    .shaders = "effects/projection.glsl",
    .integrator = "effects/integrate_extremum.glsl",
    .needs = NEEDS,
    .model = true,
    .wanted = minimum_wanted,
    .define = define,
    .state_bytes = sizeof(projection),
    .update = update,
    .finish = finish,
    .bind = bind,
};

const tc_effect tc_effect_average = {
    .name = "average",
    .what = "the mean of the scalar over a ray's length in the mesh",
    .shaders = "effects/projection.glsl",
    .integrator = "effects/integrate_average.glsl",
    .needs = NEEDS,
    .model = true,
    .wanted = average_wanted,
    .define = define,
    .state_bytes = sizeof(projection),
    .update = update,
    .finish = finish,
    .bind = bind,
};
