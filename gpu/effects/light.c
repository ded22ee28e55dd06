/* light.c: ambient, diffuse and specular light (Blinn 1977), as tc_shade defines it. */
#include "gpu/effects/light.h"

#include "core/vec.h"
#include "gpu/effects/effects.h"
#include "gpu/pass.h"
#include "scene/look.h"

#include <math.h>
#include <stdio.h>

static const tc_light white = {.head = true, .color = {1, 1, 1}};

static int count(const tc_shade *shade)
{
    return shade->n_light ? shade->n_light : 1;
}

static const tc_light *light_at(const tc_shade *shade, int i)
{
    return shade->n_light ? &shade->light[i] : &white;
}

static bool is_grey(const tc_shade *shade)
{
    bool grey = true;
    for (int i = 0; i < count(shade); i++) {
        const double *c = light_at(shade, i)->color;
        grey = grey && c[0] == c[1] && c[1] == c[2];
    }
    return grey;
}

void tc_light_define(char *out, size_t capacity, const tc_shade *shade)
{
    bool head = count(shade) == 1 && light_at(shade, 0)->head;
    snprintf(out, capacity, "#define LIGHTS %d\n%s%s%s", count(shade), head ? "#define LIGHT_HEAD\n" : "",
             is_grey(shade) ? "#define LIGHT_GREY\n" : "", shade->specular > 0 ? "" : "#define LIGHT_MATT\n");
}

/* Of an array of colours, or of grey ones; location -1: of none. */
static void set_color(const tc_gl *gl, GLint location, int i, bool grey, double r, double g, double b)
{
    if (location >= 0 && grey)
        gl->Uniform1f(location + i, (GLfloat)r);
    else if (location >= 0)
        gl->Uniform3f(location + i, (GLfloat)r, (GLfloat)g, (GLfloat)b);
}

void tc_light_bind(const tc_gl *gl, GLuint program, const tc_shade *shade)
{
    bool grey = is_grey(shade);
    GLint diffuse = gl->GetUniformLocation(program, "light_diffuse");
    GLint specular = gl->GetUniformLocation(program, "light_specular");
    GLint to = gl->GetUniformLocation(program, "light_to");
    double a = shade->ambient, d = shade->diffuse, s = shade->specular;
    set_color(gl, gl->GetUniformLocation(program, "light_ambient"), 0, grey, a, a, a);
    tc_pass_float(gl, program, "light_power", shade->power);
    for (int i = 0; i < count(shade); i++) {
        const tc_light *light = light_at(shade, i);
        const double *c = light->color;
        set_color(gl, diffuse, i, grey, d * c[0], d * c[1], d * c[2]);
        set_color(gl, specular, i, grey, s * c[0], s * c[1], s * c[2]);
        double unit[3];
        tc_vec_copy(unit, light->direction);
        tc_vec_normalize(unit);
        const GLfloat way[4] = {(GLfloat)unit[0], (GLfloat)unit[1], (GLfloat)unit[2], light->head ? 1.0f : 0.0f};
        if (to >= 0)
            gl->Uniform4fv(to + i, 1, way);
    }
}

void tc_light_brighten(double most[3], const tc_shade *shade)
{
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (int i = 0; i < count(shade); i++)
            sum += light_at(shade, i)->color[k];
        most[k] = fmax(most[k], most[k] * (shade->ambient + shade->diffuse * sum) + shade->specular * sum);
    }
}

static bool wanted(char *why, const tc_effect_scene *scene)
{
    const tc_look *look = scene->look;
    bool volume = tc_look_lights_volume(look), surfaces = tc_look_lights_surfaces(look);
    int n = count(&look->shade);
    snprintf(why, TC_EFFECT_WHY, "%d light%s on %s%s%s", n, n == 1 ? "" : "s", volume ? "the volume" : "",
             volume && surfaces ? " and " : "", surfaces ? "isosurfaces" : "");
    if (!volume && !surfaces)
        snprintf(why, TC_EFFECT_WHY, "no light");
    return volume || surfaces;
}

static void define(char *out, size_t capacity, const tc_effect_scene *scene)
{
    tc_light_define(out, capacity, &scene->look->shade);
}

static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    (void)state;
    tc_light_bind(job->gl, program, &scene->look->shade);
}

const tc_effect tc_effect_light = {
    .name = "lights",
    .what = "ambient, diffuse and specular light",
    .shaders = "effects/light.glsl",
    .wanted = wanted,
    .define = define,
    .bind = bind,
};
