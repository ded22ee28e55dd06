/* geometry.c: triangles and lines, in depth order with the volume and with each other; or, where the model makes one
 * colour of a whole ray, which is nowhere, before it. */
#include "gpu/effects/effects.h"

#include "gpu/effects/light.h"
#include "gpu/layers.h"
#include "gpu/pass.h"

#include <math.h>
#include <stdio.h>

enum { UNIT_HEADS = TC_UNIT_EFFECT_LAYERS, UNIT_NODES, UNIT_AT };

typedef struct state {
    tc_gpu_geometry buffers;
    tc_layers layers;
} state;

static bool projects(const tc_look *look)
{
    return look->model == TC_MODEL_MAXIMUM || look->model == TC_MODEL_MINIMUM || look->model == TC_MODEL_AVERAGE;
}

static bool is_there(char *why, const tc_effect_scene *scene)
{
    size_t triangles = 0, lines = 0;
    for (int i = 0; i < scene->look->n_geometry; i++)
        if (tc_layers_seen(&scene->look->geometry[i])) {
            triangles += scene->look->geometry[i].n_triangle;
            lines += scene->look->geometry[i].n_line;
        }
    snprintf(why, TC_EFFECT_WHY, "%zu triangles and %zu lines", triangles, lines);
    return triangles + lines > 0;
}

static bool wanted(char *why, const tc_effect_scene *scene)
{
    return is_there(why, scene) && !projects(scene->look);
}

static bool wanted_before(char *why, const tc_effect_scene *scene)
{
    return is_there(why, scene) && projects(scene->look);
}

static tc_layers_scene layers_scene(const state *s, const tc_effect_scene *scene)
{
    return (tc_layers_scene){&s->buffers, scene->look->geometry, &scene->look->shade};
}

/* Lists grow with what frames show. */
static size_t held(const void *kept)
{
    const state *s = kept;
    return tc_gpu_geometry_bytes(&s->buffers) + s->layers.bytes;
}

static tc_status update(void *kept, size_t *bytes, const tc_effect_scene *scene, const tc_gl *gl, tc_error *err)
{
    state *s = kept;
    tc_status status = tc_gpu_geometry_update(&s->buffers, gl, scene->look->geometry, scene->look->n_geometry,
                                              scene->center, scene->scale, err);
    *bytes = held(s);
    return status;
}

static tc_status compile(void *kept, const tc_effect_scene *scene, const tc_job *job, tc_error *err)
{
    const tc_layers_scene layers = layers_scene(kept, scene);
    return tc_layers_compile(&layers, job, err);
}

static tc_status frame(void *kept, const tc_effect_scene *scene, const tc_job *job, tc_error *err)
{
    state *s = kept;
    const tc_layers_scene layers = layers_scene(s, scene);
    return tc_layers_draw(&s->layers, &layers, job, err);
}

static void finish(void *kept, const tc_gl *gl)
{
    state *s = kept;
    tc_gpu_geometry_finish(&s->buffers, gl);
    tc_layers_finish(&s->layers, gl);
}

static void bind(const void *kept, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)scene;
    const state *s = kept;
    const tc_gl *gl = job->gl;
    if (gl->GetUniformLocation(program, "layer_heads") < 0)
        return;
    tc_pass_texture(gl, program, "layer_heads", UNIT_HEADS, GL_TEXTURE_2D, s->layers.heads);
    tc_pass_texture(gl, program, "layer_nodes", UNIT_NODES, GL_TEXTURE_BUFFER, s->layers.nodes.texture);
    if (gl->GetUniformLocation(program, "layer_at") >= 0) /* what makes colours of what rays gathered */
        tc_pass_texture(gl, program, "layer_at", UNIT_AT, GL_TEXTURE_2D, job->state->set[job->last].at);
}

static void brighten(double most[3], const tc_effect_scene *scene)
{
    const tc_look *look = scene->look;
    for (int i = 0; i < look->n_geometry; i++) {
        const tc_geometry *g = &look->geometry[i];
        double color[3] = {g->color[0], g->color[1], g->color[2]};
        if (g->lit && look->shade.gradient != TC_GRADIENT_NONE)
            tc_light_brighten(color, &look->shade);
        for (int k = 0; k < 3; k++)
            most[k] = fmax(most[k], color[k]);
    }
}

const tc_effect tc_effect_geometry = {
    .name = "geometry",
    .what = "triangles and lines in the picture",
    .shaders = "effects/surface.glsl effects/parts.glsl effects/geometry.glsl",
    .needs = TC_NEEDS_PIECES | TC_NEEDS_WAY,
    .wanted = wanted,
    .state_bytes = sizeof(state),
    .update = update,
    .compile = compile,
    .frame = frame,
    .held = held,
    .finish = finish,
    .bind = bind,
    .brighten = brighten,
};

const tc_effect tc_effect_geometry_before = {
    .name = "geometry-before",
    .what = "triangles and lines before what the model makes of the whole ray",
    .shaders = "effects/geometry_before.glsl",
    .wanted = wanted_before,
    .state_bytes = sizeof(state),
    .update = update,
    .compile = compile,
    .frame = frame,
    .held = held,
    .finish = finish,
    .bind = bind,
};
