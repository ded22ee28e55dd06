/* color_field.c: colour by one field, opacity by another. */
#include "gpu/effects/effects.h"

#include "core/memory.h"
#include "gpu/pass.h"
#include "mesh/field.h"
#include "transfer_functions/pieces.h"
#include "transfer_functions/place.h"
#include "transfer_functions/thin.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double THIN = 4.9e-4; /* of a colour: a quarter of 1/510 */

typedef struct colors {
    tc_texture_buffer values, pieces;
    uint64_t field, function; /* serials of what is there; 0: nothing */
    tc_integrator integrator; /* that was asked for */
    int n_piece;
    double map[2];
} colors;

static bool wanted(char *why, const tc_effect_scene *scene)
{
    const tc_field *field = scene->look->color_field;
    if (field)
        snprintf(why, TC_EFFECT_WHY, "colour by %s", field->name ? field->name : "a second field");
    else
        snprintf(why, TC_EFFECT_WHY, "no second field");
    return field != NULL;
}

static void define(char *out, size_t capacity, const tc_effect_scene *scene)
{
    snprintf(out, capacity, "%s",
             scene->look->color_field->association == TC_POINT_DATA ? "#define COLOR_POINTS\n" : "");
}

static int rounds(const tc_effect_scene *scene)
{
    return (int)(scene->look->color_function->n < 30000 ? scene->look->color_function->n : 30000);
}

static bool nonfinite(const tc_effect_scene *scene)
{
    return !scene->look->color_field->finite;
}

/* Of the picture's own function the attenuation alone is looked at: knots of its colours would be crossed for nothing.
 */
static void knot(tc_knot *knot, const tc_effect_scene *scene)
{
    (void)scene;
    knot->r = knot->g = knot->b = 0;
}

static tc_status upload_values(colors *c, const tc_field *field, const tc_gl *gl, tc_error *err)
{
    float *value = tc_alloc(field->n, sizeof *value);
    if (!value)
        return tc_fail_memory(err, "the values to colour by", field->n, sizeof *value);
    for (size_t i = 0; i < field->n; i++)
        value[i] = isfinite(field->value[i]) ? (float)tc_place(field->value[i], field->range[0], field->range[1]) : NAN;
    tc_status status = tc_texture_buffer_upload(&c->values, gl, value, field->n, sizeof *value, GL_R32F,
                                                "uploading the values to colour by", err);
    free(value);
    return status;
}

/* The function with fewer knots, where not all of them were asked for; its attenuation is not looked at. */
static tc_status thin_function(tc_transfer **out, const tc_effect_scene *scene, tc_error *err)
{
    const tc_transfer *tf = scene->look->color_function;
    tc_knot *knots = tc_alloc(tf->n, sizeof *knots);
    tc_transfer *clear = NULL;
    if (!knots)
        return tc_fail_memory(err, "the function to colour by", tf->n, sizeof *knots);
    memcpy(knots, tf->knot, tf->n * sizeof *knots);
    for (size_t i = 0; i < tf->n; i++)
        knots[i].a = 0;
    tc_status status = tc_transfer_from_knots(&clear, knots, tf->n, err);
    if (status == TC_OK)
        status = tc_transfer_thin(out, clear, scene->options->integrator == TC_INTEGRATOR_EXACT ? 0 : THIN, err);
    tc_transfer_destroy(&clear);
    free(knots);
    return status;
}

static tc_status upload_function(colors *c, const tc_field *field, const tc_transfer *tf, const tc_gl *gl,
                                 tc_error *err)
{
    double span[2];
    tc_pieces pieces;
    tc_transfer_span(span, tf);
    double margin = span[1] > span[0] ? 0.25 * (span[1] - span[0]) : fmax(1, fabs(span[0]));
    span[0] -= margin; /* a step at an end lies inside */
    span[1] += margin;
    tc_status status = tc_pieces_build(&pieces, tf, span, err);
    if (status != TC_OK)
        return status;
    c->n_piece = (int)pieces.n;
    double lo = field->range[0], hi = field->range[1];
    c->map[1] = (lo - span[0]) / (span[1] - span[0]);
    c->map[0] = (hi - lo) / (span[1] - span[0]);
    float(*end)[4] = tc_alloc(2 * pieces.n, sizeof *end);
    if (!end)
        status = tc_fail_memory(err, "the function to colour by", 2 * pieces.n, sizeof *end);
    for (size_t i = 0; end && i < pieces.n; i++) {
        end[2 * i][0] = pieces.end[i].x;
        end[2 * i + 1][0] = pieces.end[i + 1].x;
        memcpy(end[2 * i] + 1, pieces.end[i].above, 3 * sizeof(float));
        memcpy(end[2 * i + 1] + 1, pieces.end[i + 1].below, 3 * sizeof(float));
    }
    if (end)
        status = tc_texture_buffer_upload(&c->pieces, gl, end, 2 * pieces.n, sizeof *end, GL_RGBA32F,
                                          "uploading the function to colour by", err);
    free(end);
    tc_pieces_finish(&pieces);
    return status;
}

static void finish(void *state, const tc_gl *gl)
{
    colors *c = state;
    tc_texture_buffer_finish(&c->values, gl);
    tc_texture_buffer_finish(&c->pieces, gl);
    c->field = c->function = 0;
}

static tc_status update(void *state, size_t *bytes, const tc_effect_scene *scene, const tc_gl *gl, tc_error *err)
{
    colors *c = state;
    const tc_field *field = scene->look->color_field;
    const tc_transfer *tf = scene->look->color_function;
    tc_status status = TC_OK;
    bool other = c->field != field->serial;
    if (other) {
        finish(c, gl);
        status = upload_values(c, field, gl, err);
    }
    if (status == TC_OK && (other || c->function != tf->serial || c->integrator != scene->options->integrator)) {
        tc_transfer *thin = NULL;
        tc_texture_buffer_finish(&c->pieces, gl);
        status = thin_function(&thin, scene, err);
        if (status == TC_OK)
            status = upload_function(c, field, thin, gl, err);
        tc_transfer_destroy(&thin);
    }
    c->field = status == TC_OK ? field->serial : 0;
    c->function = status == TC_OK ? tf->serial : 0;
    c->integrator = scene->options->integrator;
    *bytes = c->values.bytes + c->pieces.bytes;
    return status;
}

static void bind(const void *state, const tc_effect_scene *scene, const tc_job *job, GLuint program)
{
    const colors *c = state;
    const tc_gl *gl = job->gl;
    GLint last = gl->GetUniformLocation(program, "color_last");
    (void)scene;
    if (last < 0)
        return;
    int half = 1;
    while (2 * half < c->n_piece)
        half *= 2;
    tc_effect_fetch(job, program, "color_values", TC_UNIT_EFFECT_COLOR, GL_R32F, c->values.texture);
    tc_effect_fetch(job, program, "color_pieces", TC_UNIT_EFFECT_PIECES, GL_RGBA32F, c->pieces.texture);
    tc_pass_vec2(gl, program, "color_map", c->map[0], c->map[1]);
    tc_pass_int(gl, program, "color_last", c->n_piece - 1);
    tc_pass_int(gl, program, "color_half", half);
}

static void brighten(double most[3], const tc_effect_scene *scene)
{
    const tc_transfer *tf = scene->look->color_function;
    for (size_t i = 0; i < tf->n; i++) {
        const double color[3] = {tf->knot[i].r, tf->knot[i].g, tf->knot[i].b};
        for (int k = 0; k < 3; k++)
            most[k] = fmax(most[k], color[k]);
    }
}

const tc_effect tc_effect_color_field = {
    .name = "color-field",
    .what = "colour by another field than the one that absorbs",
    .shaders = "effects/parts.glsl effects/color_field.glsl",
    .excludes = " emission maximum minimum average ",
    .needs = TC_NEEDS_PIECES | TC_NEEDS_SIGNS,
    .wanted = wanted,
    .define = define,
    .rounds = rounds,
    .nonfinite = nonfinite,
    .knot = knot,
    .state_bytes = sizeof(colors),
    .update = update,
    .finish = finish,
    .bind = bind,
    .brighten = brighten,
};
