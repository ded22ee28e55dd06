/* clip.c: planes and a box that keep a convex part of space: the part of each ray that lies in it. */
#include "gpu/effects/effects.h"

#include "core/memory.h"
#include "core/vec.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static int count(const tc_look *look)
{
    return look->n_plane + (look->has_box ? 6 : 0);
}

static bool wanted(char *why, const tc_effect_scene *scene)
{
    const tc_look *look = scene->look;
    if (look->n_plane > 0)
        snprintf(why, TC_EFFECT_WHY, "%d plane%s%s", look->n_plane, look->n_plane == 1 ? "" : "s",
                 look->has_box ? " and a box" : "");
    else
        snprintf(why, TC_EFFECT_WHY, "%s", look->has_box ? "a box" : "no planes, no box");
    return count(look) > 0;
}

static void define(char *out, size_t capacity, const tc_effect_scene *scene)
{
    snprintf(out, capacity, "#define CLIP_PLANES %d\n", count(scene->look));
}

/* normal . x >= offset, in packed space, with a normal of length 1. */
static void pack_plane(GLfloat out[4], const double normal[3], double offset, const tc_effect_scene *scene)
{
    double length = tc_vec_length(normal);
    for (int k = 0; k < 3; k++)
        out[k] = (GLfloat)(normal[k] / length);
    double at = (offset - tc_vec_dot(normal, scene->center)) / length * scene->scale;
    out[3] = (GLfloat)fmin(fmax(at, -1e30), 1e30);
}

static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)state;
    const tc_look *look = scene->look;
    GLint location = job->gl->GetUniformLocation(program, "clip_plane");
    if (location < 0)
        return;
    for (int i = 0; i < count(look); i++) {
        GLfloat plane[4];
        if (i < look->n_plane) {
            pack_plane(plane, look->plane[i].normal, look->plane[i].offset, scene);
        } else {
            int side = i - look->n_plane;
            double normal[3] = {0, 0, 0}, sign = side % 2 == 0 ? 1 : -1;
            normal[side / 2] = sign;
            pack_plane(plane, normal, sign * look->box[side], scene);
        }
        job->gl->Uniform4fv(location + i, 1, plane);
    }
}

const tc_effect tc_effect_clip = {
    .name = "clip",
    .what = "the part of space that planes and a box keep",
    .shaders = "effects/clip.glsl",
    .needs = TC_NEEDS_RANGE,
    .wanted = wanted,
    .define = define,
    .bind = bind,
};
