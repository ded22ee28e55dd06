/* numbers.c: depth, and the scalar there, as the model DEPTH gives them (tetcast_look.h). */
#define _GNU_SOURCE
#include "cli/picture/numbers.h"
#include "cli/picture/look_build.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char *tc_numbers_wrong(const tc_render_command *options)
{
    switch (options->look.model) {
    case TC_MODEL_MAXIMUM:
    case TC_MODEL_MINIMUM:
    case TC_MODEL_AVERAGE:
        return "with --model mip, minip and average nothing is opaque or clear, so there is no depth: leave --depth "
               "and --value out, or take another model";
    case TC_MODEL_EMISSION:
        return "with --model emission nothing is opaque, so there is no depth: leave --depth and --value out, or take "
               "another model";
    default:
        return NULL;
    }
}

static const char *tc_extension(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    return dot ? dot : path + strlen(path);
}

bool tc_depth_is_apart(const char *path)
{
    return strcasecmp(tc_extension(path), ".exr") != 0;
}

char *tc_numbers_path(const char *path, const char *kind)
{
    char *out = NULL;
    return asprintf(&out, "%.*s_%s.exr", (int)(tc_extension(path) - path), path, kind) < 0 ? NULL : out;
}

/* r is depth, g the scalar, a 1 where they are. NULL after an error was printed. */
static tc_image *tc_numbers_render(const tc_render_run *run, tc_renderer *renderer, tc_talk *talk)
{
    tc_error err = {0};
    tc_render_options render = run->render;
    tc_look look = run->render.look ? *run->render.look : (tc_look){0};
    tc_image *image = NULL;
    look.model = TC_MODEL_DEPTH;
    look.shade.gradient = TC_GRADIENT_NONE;
    look.color_field = NULL;
    look.color_function = NULL;
    render.look = &look;
    render.samples = 1;
    render.count = render.audit = false;
    tc_status status =
        tc_render(&image, NULL, renderer, run->mesh, run->tf, &run->camera, &render, &talk->log, &err);
    if (status == TC_OK)
        return image;
    tc_image_destroy(&image);
    tc_talk_status(talk, status, &err);
    return NULL;
}

/* One channel as a grey picture. */
static tc_image *tc_channel_image(const tc_image *numbers, int channel)
{
    tc_image *out = NULL;
    if (tc_image_create(&out, numbers->width, numbers->height, NULL) != TC_OK)
        return NULL;
    const size_t n = (size_t)numbers->width * (size_t)numbers->height;
    for (size_t i = 0; i < n; i++) {
        const float *from = numbers->rgba + 4 * i;
        float *to = out->rgba + 4 * i;
        to[0] = to[1] = to[2] = from[3] > 0 ? from[channel] : 0;
        to[3] = from[3];
    }
    return out;
}

/* Depth as a channel: beyond all where there is none. */
static float *tc_depth_plane(const tc_image *numbers)
{
    const size_t n = (size_t)numbers->width * (size_t)numbers->height;
    float *out = malloc(n * sizeof *out);
    for (size_t i = 0; out && i < n; i++)
        out[i] = numbers->rgba[4 * i + 3] > 0 ? numbers->rgba[4 * i] : FLT_MAX;
    return out;
}

static bool tc_channel_file(tc_picture_file *out, const tc_image *numbers, int channel, const char *path,
                            const char *kind)
{
    *out = (tc_picture_file){.path = tc_numbers_path(path, kind), .image = tc_channel_image(numbers, channel)};
    return out->path && out->image;
}

int tc_numbers_make(tc_picture_file *out, int *n, tc_picture_file *own, const tc_render_run *run, tc_renderer *renderer,
                    const char *path, tc_talk *talk)
{
    const tc_output_options *o = &run->options->out;
    bool good = true;
    *n = 0;
    if (!o->depth && !o->value)
        return -1;
    tc_image *numbers = tc_numbers_render(run, renderer, talk);
    if (!numbers)
        return TC_EXIT_FAILED;
    if (o->depth && !tc_depth_is_apart(path))
        good = (own->depth = tc_depth_plane(numbers)) != NULL;
    else if (o->depth)
        good = tc_channel_file(&out[(*n)++], numbers, 0, path, "depth");
    if (good && o->value)
        good = tc_channel_file(&out[(*n)++], numbers, 1, path, "value");
    tc_image_destroy(&numbers);
    if (good)
        return -1;
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}
