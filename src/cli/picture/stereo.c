/* stereo.c: pictures for two eyes. */
#include "cli/picture/stereo.h"
#include "cli/picture/render_figure.h"
#include "cli/picture/render_write.h"
#include "cli/picture/stats_sum.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------------------- cameras */

static double tc_length(const double *a)
{
    return hypot(hypot(a[0], a[1]), a[2]);
}

/* out = a x b as a unit vector; false: there is none. */
static bool tc_unit_cross(double *out, const double *a, const double *b)
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    const double length = tc_length(out);
    for (int i = 0; i < 3; i++)
        out[i] /= length;
    return length > 1e-9 * tc_length(a) * tc_length(b);
}

/* The view's unit right and up; false: it has no direction. A view-up along the view is replaced as tc_render does. */
static bool tc_view_axes(double *right, double *up, double *distance, const tc_camera *camera)
{
    const double *v = camera->view_up, turned[3] = {-v[2], v[0], v[1]};
    double forward[3];
    for (int i = 0; i < 3; i++)
        forward[i] = camera->focal_point[i] - camera->position[i];
    *distance = tc_length(forward);
    if (!(*distance > 0) || !isfinite(*distance))
        return false;
    return (tc_unit_cross(right, forward, v) || tc_unit_cross(right, forward, turned)) &&
           tc_unit_cross(up, right, forward);
}

int tc_stereo_cameras(tc_camera out[2], const tc_camera *camera, double eye_angle, double aspect)
{
    const double half = eye_angle * acos(-1.0) / 360;
    double right[3], up[3], distance;
    out[0] = out[1] = *camera;
    if (!tc_view_axes(right, up, &distance, camera))
        return -1;
    for (int eye = 0; eye < 2; eye++) {
        const double side = eye ? 1 : -1, shift = side * distance * (camera->parallel ? sin(half) : tan(half));
        tc_camera *c = &out[eye];
        for (int i = 0; i < 3; i++) {
            if (camera->parallel)
                c->position[i] = camera->focal_point[i] + cos(half) * (camera->position[i] - camera->focal_point[i]);
            else
                c->focal_point[i] += shift * right[i];
            c->position[i] += shift * right[i];
            c->view_up[i] = up[i];
        }
        if (!camera->parallel)
            c->window_center[0] -= side * tan(half) / (tan(camera->view_angle * acos(-1.0) / 360) * aspect);
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------------ one of two */

static void tc_put_rows(tc_image *out, int x, int y, const tc_image *in)
{
    for (int row = 0; row < in->height; row++)
        memcpy(out->rgba + 4 * ((size_t)(y + row) * (size_t)out->width + (size_t)x),
               in->rgba + 4 * (size_t)row * (size_t)in->width, 4 * sizeof *in->rgba * (size_t)in->width);
}

tc_status tc_stereo_combine(tc_image **out, const tc_image *left, const tc_image *right, tc_stereo kind, tc_error *err)
{
    const int w = left->width, h = left->height;
    *out = NULL;
    if (right->width != w || right->height != h || kind < TC_STEREO_SIDE_BY_SIDE || kind > TC_STEREO_ANAGLYPH) {
        if (err) {
            err->code = TC_E_ARG;
            snprintf(err->text, sizeof err->text,
                     "pictures of %dx%d and %dx%d pixels cannot be put together as stereo of kind %d", w, h,
                     right->width, right->height, (int)kind);
        }
        return TC_E_ARG;
    }
    const bool beside = kind == TC_STEREO_SIDE_BY_SIDE, below = kind == TC_STEREO_TOP_BOTTOM;
    tc_status status = tc_image_create(out, beside ? 2 * w : w, below ? 2 * h : h, err);
    if (status != TC_OK)
        return status;
    if (beside || below) {
        tc_put_rows(*out, 0, 0, left);
        tc_put_rows(*out, beside ? w : 0, below ? h : 0, right);
        return TC_OK;
    }
    const size_t n = (size_t)w * (size_t)h;
    for (size_t i = 0; i < n; i++) {
        const float *l = left->rgba + 4 * i, *r = right->rgba + 4 * i;
        float *to = (*out)->rgba + 4 * i;
        to[0] = l[0], to[1] = r[1], to[2] = r[2];
        to[3] = l[3] > r[3] ? l[3] : r[3];
    }
    return TC_OK;
}

/* -------------------------------------------------------------------------------------------------------- pictures */

/* Adds what one eye's picture took to the sum of both. */
static void tc_eye_add(tc_render_run *sum, const tc_render_run *eye, bool first)
{
    tc_stats_sum_add(&sum->first, &eye->first, first);
    tc_stats_sum_add(&sum->count, &eye->count, first);
    sum->ms_write = first || isnan(sum->ms_write) ? eye->ms_write : sum->ms_write + eye->ms_write;
    sum->counted = eye->counted;
    sum->broken = eye->broken || (!first && sum->broken);
    if (eye->lost.code)
        sum->lost = eye->lost;
    sum->frames = 1;
    tc_spread_of(&sum->frame, (double[]){sum->first.ms_frame}, 1);
    tc_spread_of(&sum->first_hit, (double[]){sum->first.ms_first_hit}, 1);
    tc_spread_of(&sum->march, (double[]){sum->first.ms_march}, 1);
    tc_spread_of(&sum->readback, (double[]){sum->first.ms_readback}, 1);
}

/* Two files, each with its own camera in its metadata. */
static int tc_pair_picture(tc_render_run *run, const tc_camera camera[2], tc_frames *frames, tc_talk *talk, int argc,
                           char **argv)
{
    char name[8192];
    int code = -1;
    for (int eye = 0; eye < 2 && code < 0; eye++) {
        tc_render_command options = *run->options;
        tc_render_run one = *run;
        tc_stereo_name(name, sizeof name, run->options->output, eye);
        options.output = name;
        options.out.stereo = TC_STEREO_NONE;
        one.options = &options;
        one.camera = camera[eye];
        code = tc_render_picture(&one, frames, talk, argc, argv);
        tc_eye_add(run, &one, eye == 0);
        tc_image_destroy(&one.image);
    }
    return code;
}

/* Background under an eye's picture, title, bar and axes over it, in the ink of the first. */
static int tc_eye_dress(tc_render_run *one, tc_ink *ink, tc_talk *talk)
{
    tc_error err = {0};
    tc_figure figure;
    if (one->options->background.there)
        tc_image_background(one->image, one->options->background.rgba);
    if (!tc_render_figure(&figure, one))
        return -1;
    *ink = figure.ink = *ink == TC_INK_AUTO ? tc_figure_ink(one->image) : *ink;
    tc_status status = tc_figure_draw(one->image, &figure, &talk->log, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

static int tc_combined_write(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv)
{
    tc_error err = {0};
    tc_picture_file file = {0};
    run->render.width = run->image->width;
    run->render.height = run->image->height;
    int code = tc_picture_file_make(&file, run, run->options->output, argc, argv, talk);
    const double start = tc_talk_clock_s();
    tc_status status = code < 0 ? tc_picture_file_write(&file, frames->writer, &talk->log, &err) : TC_OK;
    run->ms_write = 1e3 * (tc_talk_clock_s() - start);
    tc_picture_file_finish(&file);
    return status ? tc_talk_status(talk, status, &err) : code;
}

/* Both eyes' pictures in one file, with the camera between them in its metadata. */
static int tc_combined_picture(tc_render_run *run, const tc_camera camera[2], tc_frames *frames, tc_talk *talk,
                               int argc, char **argv)
{
    tc_image *image[2] = {NULL, NULL};
    tc_ink ink = run->ink;
    tc_error err = {0};
    double peak = 0;
    char why[640];
    int code = -1;
    for (int eye = 0; eye < 2 && code < 0; eye++) {
        tc_render_run one = *run;
        one.camera = camera[eye];
        code = tc_picture_render(&one, frames, talk);
        tc_eye_add(run, &one, eye == 0);
        if (code < 0) {
            peak = fmax(peak, tc_picture_peak(&one, one.image));
            code = tc_eye_dress(&one, &ink, talk);
        }
        image[eye] = one.image;
    }
    if (code < 0 && tc_peak_is_empty(why, sizeof why, run, peak))
        tc_talk_always(talk, "%s", why);
    tc_status status = TC_OK;
    if (code < 0)
        status = tc_stereo_combine(&run->image, image[0], image[1], (tc_stereo)run->options->out.stereo, &err);
    tc_image_destroy(&image[0]);
    tc_image_destroy(&image[1]);
    if (status != TC_OK)
        return tc_talk_status(talk, status, &err);
    return code < 0 ? tc_combined_write(run, frames, talk, argc, argv) : code;
}

int tc_stereo_picture(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv)
{
    const tc_render_command *options = run->options;
    tc_camera camera[2];
    tc_stereo_cameras(camera, &run->camera, options->out.eye_angle, /* without a direction tc_render says so */
                      (double)options->size.width / options->size.height);
    int code = options->out.stereo == TC_STEREO_PAIR ? tc_pair_picture(run, camera, frames, talk, argc, argv)
                                                     : tc_combined_picture(run, camera, frames, talk, argc, argv);
    run->measured = code < 0 || run->count.rays_lost > 0;
    return code;
}
