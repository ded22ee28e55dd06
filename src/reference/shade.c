/* shade.c: ambient, diffuse and specular light (Blinn 1977), as tc_shade defines it. */
#include "reference/shade.h"

#include "core/vec.h"

#include <math.h>

/* A sum of two opposite unit vectors is this long by rounding alone. */
static const double NOTHING = 1e-12;

tc_lit tc_lit_none(void)
{
    return (tc_lit){.gain = {1, 1, 1}};
}

tc_lit tc_lit_mix(const tc_lit *a, const tc_lit *b, double weight)
{
    tc_lit out;
    for (int c = 0; c < 3; c++) {
        out.gain[c] = weight * a->gain[c] + (1 - weight) * b->gain[c];
        out.glow[c] = weight * a->glow[c] + (1 - weight) * b->glow[c];
    }
    return out;
}

void tc_lit_color(double out[3], const tc_lit *lit, const double color[3])
{
    for (int c = 0; c < 3; c++)
        out[c] = lit->gain[c] * color[c] + lit->glow[c];
}

tc_lit tc_lit_by(const tc_shade *shade, const double normal[3], const double eye[3], bool one_sided)
{
    static const tc_light white = {.head = true, .color = {1, 1, 1}};
    const tc_light *light = shade->n_light ? shade->light : &white;
    tc_lit out = {.gain = {shade->ambient, shade->ambient, shade->ambient}};
    double n[3];
    tc_vec_copy(n, normal);
    tc_vec_normalize(n);
    if (!one_sided && tc_vec_dot(n, eye) < 0)
        for (int i = 0; i < 3; i++)
            n[i] = -n[i];
    for (int k = 0; k < (shade->n_light ? shade->n_light : 1); k++) {
        double to[3], half[3];
        tc_vec_copy(to, light[k].head ? eye : light[k].direction);
        tc_vec_normalize(to);
        double facing = tc_vec_dot(n, to);
        if (!(facing > 0))
            continue;
        tc_vec_add(half, to, eye);
        double shine = 0;
        if (tc_vec_normalize(half) > NOTHING)
            shine = pow(fmax(tc_vec_dot(n, half), 0), shade->power);
        for (int c = 0; c < 3; c++) {
            out.gain[c] += shade->diffuse * light[k].color[c] * facing;
            out.glow[c] += shade->specular * light[k].color[c] * shine;
        }
    }
    return out;
}
