/* render_verify.c: --verify and --error-image: how wrong the picture is, in words and as an image. */
#define _GNU_SOURCE
#include "cli/picture/render_verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* One colour for each power of ten of the error, of even steps of lightness. */
static const struct {
    float rgb[3];
    const char *name;
} tc_ramp[] = {{{0.02f, 0.02f, 0.06f}, "black"}, {{0.14f, 0.10f, 0.42f}, "indigo"}, {{0.47f, 0.12f, 0.56f}, "purple"},
               {{0.84f, 0.25f, 0.35f}, "red"},   {{0.96f, 0.50f, 0.15f}, "orange"}, {{0.99f, 0.80f, 0.30f}, "yellow"},
               {{1.00f, 1.00f, 1.00f}, "white"}};
enum { TC_RAMP = sizeof tc_ramp / sizeof *tc_ramp, TC_RAMP_LOW = -7 };
/* Nowhere on the ramp. */
static const float tc_ill_posed_rgb[3] = {0, 0.85f, 0.75f}, tc_unseen_rgb[3] = {0.5f, 0.5f, 0.5f};

void tc_error_color(float *rgb, double error)
{
    double at = error > 0 ? log10(error) - TC_RAMP_LOW : 0; /* NaN: 0 */
    at = fmin(fmax(at, 0), TC_RAMP - 1);
    int i = at < TC_RAMP - 2 ? (int)at : TC_RAMP - 2;
    float t = (float)(at - i);
    for (int c = 0; c < 3; c++)
        rgb[c] = tc_ramp[i].rgb[c] + t * (tc_ramp[i + 1].rgb[c] - tc_ramp[i].rgb[c]);
}

void tc_error_paint(tc_image *errors)
{
    size_t n = (size_t)errors->width * (size_t)errors->height;
    for (size_t i = 0; i < n; i++) {
        float *p = errors->rgba + 4 * i;
        if (p[3] == 1)
            tc_error_color(p, fmax(fmax((double)p[0], (double)p[1]), (double)p[2]));
        else
            memcpy(p, p[3] > 0 ? tc_ill_posed_rgb : tc_unseen_rgb, sizeof tc_unseen_rgb);
        p[3] = 1;
    }
}

bool tc_error_is_painted(const char *path)
{
    static const char *const raw[] = {".exr", ".tif", ".tiff"};
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof raw / sizeof *raw; i++)
        if (!strcasecmp(dot, raw[i]))
            return false;
    return true;
}

void tc_error_legend(char *out, size_t capacity, bool painted)
{
    if (!painted) {
        snprintf(out, capacity,
                 "absolute errors against the reference: r, g, b: of these channels, or of alpha where that is larger; "
                 "alpha: 1 looked at, 0.5 ill-posed, 0 not looked at");
        return;
    }
    int at = snprintf(out, capacity, "largest absolute error of a channel against the reference, logarithmic: ");
    for (int i = 0; i < TC_RAMP && at >= 0 && (size_t)at < capacity; i++)
        at += snprintf(out + at, capacity - (size_t)at, "%s 1e%d%s, ", tc_ramp[i].name, i + TC_RAMP_LOW,
                       i == 0             ? " and less"
                       : i == TC_RAMP - 1 ? " and more"
                                          : "");
    if (at >= 0 && (size_t)at < capacity)
        snprintf(out + at, capacity - (size_t)at, "turquoise ill-posed, grey not looked at");
}

double tc_round_up(double value)
{
    if (!(value > 0) || !isfinite(value))
        return value;
    double unit = pow(10, floor(log10(value)) - 1);
    return ceil(value / unit * (1 - 1e-12)) * unit;
}

void tc_confidence_text(char *out, size_t capacity, const tc_verify_result *v)
{
    *out = 0;
    if (!(v->pixels < v->n_all) || !isfinite(v->unseen_share))
        return;
    if (v->unseen_share >= 1)
        snprintf(out, capacity, "too few of the %zu pixels were looked at to say anything about the others", v->n_all);
    else
        snprintf(out, capacity, "with %g %% confidence at most %.2g %% of the other pixels err by more than %.2g",
                 100 * v->confidence, tc_round_up(100 * v->unseen_share), tc_round_up(v->max_abs_error));
}

int tc_verify_run(tc_render_run *run, tc_talk *talk)
{
    tc_error err = {0};
    const tc_render_command *options = run->options;
    size_t n = options->verify < SIZE_MAX ? (size_t)options->verify : SIZE_MAX;
    tc_status status = tc_verify_image(&run->verify, options->error_image ? &run->errors : NULL, run->image, n,
                                       options->seed, run->mesh, run->tf, &run->camera, &run->render, &talk->log, &err);
    if (status)
        return tc_talk_status(talk, status, &err);
    run->verified = true;
    run->verify.rays_lost = run->count.rays_lost; /* of the picture that was verified */
    const tc_verify_result *v = &run->verify;
    char sentence[192];
    tc_talk_say(talk,
                "verify: %s%zu pixels, max error %.3g, 99.9 %% below %.3g, mean %.3g (half an 8-bit step is 0.00196)",
                v->pixels == v->n_all ? "all " : "", v->pixels, v->max_abs_error, v->p999_abs_error, v->mean_abs_error);
    tc_confidence_text(sentence, sizeof sentence, v);
    if (*sentence)
        tc_talk_say(talk, "verify: %s", sentence);
    if (v->ill_posed)
        tc_talk_say(talk, "verify: %zu ill-posed rays are left out (worst error %.3g)", v->ill_posed,
                    v->worst_error_ill_posed);
    return -1;
}

int tc_error_image_write(tc_render_run *run, tc_talk *talk, int argc, char **argv)
{
    const char *path = run->options->error_image;
    bool painted = tc_error_is_painted(path);
    char legend[512];
    tc_error err = {0};
    tc_meta meta;
    tc_error_legend(legend, sizeof legend, painted);
    if (painted)
        tc_error_paint(run->errors);
    tc_meta_make(&meta, run, argc, argv);
    tc_meta_add(&meta, "tetcast:error_image", strdup(legend));
    tc_status status = tc_image_write(run->errors, path, meta.pair, meta.n, &talk->log, &err);
    tc_meta_finish(&meta);
    if (status)
        return tc_talk_status(talk, status, &err);
    tc_talk_say(talk, "wrote the errors to %s", strcmp(path, "-") ? path : "stdout");
    return -1;
}
