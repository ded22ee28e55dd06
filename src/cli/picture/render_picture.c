/* render_picture.c: from a prepared mesh to one picture in a file. */
#include "cli/picture/render_picture.h"
#include "cli/picture/bands.h"
#include "cli/picture/bands_size.h"
#include "cli/picture/look_build.h"
#include "cli/picture/numbers.h"
#include "cli/picture/render_choose.h"
#include "cli/picture/render_verify.h"
#include "cli/picture/render_view.h"
#include "cli/picture/render_write.h"
#include "cli/picture/stereo.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define TC_VISIBLE (0.5 / 255) /* opacity below which an 8-bit picture stays empty */

int tc_frames_make(tc_frames *out, const tc_render_command *options, tc_talk *talk)
{
    size_t n = (size_t)options->repeat;
    *out = (tc_frames){
        .make = {.gl = options->gl,
                 .driver = options->driver,
                 .threads = options->source.threads,
                 .keep_bytes = options->keep_bytes,
                 .keep_at_once = true},
        .frame = calloc(n, 4 * sizeof(double)),
    };
    if (!out->frame) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    out->first_hit = out->frame + n;
    out->march = out->first_hit + n;
    out->readback = out->march + n;
    if (tc_input_is_synthetic(options->input) || access(options->input, R_OK) == 0) {
        tc_renderer_begin(&out->start, &out->make, NULL); /* what fails here is done, and told, when it is needed */
        if (!tc_bands_asked(options) && tc_image_writer_create(&out->writer, NULL) == TC_OK)
            tc_image_writer_expect(out->writer, options->output, NULL);
    }
    return -1;
}

void tc_frames_finish(tc_frames *frames)
{
    if (frames->start)
        tc_renderer_end(NULL, &frames->start, NULL, NULL);
    tc_renderer_destroy(&frames->renderer);
    tc_image_writer_destroy(&frames->writer);
    free(frames->frame);
    frames->frame = NULL;
}

/* One frame into run->image. -1, or an exit code; a lost ray is an error after its numbers are kept in *stats. Rays
 * that the paper's arithmetic loses are what it is there to show: the run goes on to its end. */
static int tc_frame(tc_render_run *run, tc_render_stats *stats, tc_renderer *renderer, bool count, tc_talk *talk)
{
    tc_error err = {0};
    tc_render_options render = run->render;
    render.count = count;
    render.audit = count && run->options->audit;
    tc_image_destroy(&run->image);
    tc_status status =
        tc_render(&run->image, stats, renderer, run->mesh, run->tf, &run->camera, &render, &talk->log, &err);
    if (status == TC_E_LOST && render.stepper == TC_STEPPER_PLANES) {
        run->lost = err;
        return -1;
    }
    return status ? tc_talk_status(talk, status, &err) : -1;
}

/* The frames to time, after one to warm up when --repeat was given; then the counted one. */
static int tc_frames_run(tc_render_run *run, tc_frames *frames, tc_talk *talk)
{
    const tc_render_command *options = run->options;
    size_t n = (size_t)options->repeat;
    bool count = options->count || options->audit || options->stats || options->has_verify || run->chosen;
    int code = tc_frame(run, &run->first, frames->renderer, false, talk);
    run->count = run->first;
    if (code >= 0)
        return code;
    for (size_t i = 0; i < n; i++) {
        tc_render_stats stats = run->first;
        if (options->has_repeat) {
            code = tc_frame(run, &stats, frames->renderer, false, talk);
            run->count = stats;
            if (code >= 0)
                return code;
            if (talk->log.progress)
                talk->log.progress(talk->log.user, "frames", (double)(i + 1) / (double)n);
        }
        frames->frame[i] = stats.ms_frame;
        frames->first_hit[i] = stats.ms_first_hit;
        frames->march[i] = stats.ms_march;
        frames->readback[i] = stats.ms_readback;
    }
    run->frames = (int)n;
    tc_spread_of(&run->frame, frames->frame, n);
    tc_spread_of(&run->first_hit, frames->first_hit, n);
    tc_spread_of(&run->march, frames->march, n);
    tc_spread_of(&run->readback, frames->readback, n);
    if (!count || (!strcmp(run->first.driver, "reference") && !options->audit)) /* it counts in every frame */
        return -1;
    code = tc_frame(run, &run->count, frames->renderer, true, talk);
    run->counted = code < 0;
    if (code >= 0 || !options->audit)
        return code;
    run->broken = run->count.audit_broken > 0;
    if (!run->broken)
        tc_talk_say(talk, "audit: in all %lld visited cells exactly two faces held the ray",
                    (long long)run->count.steps);
    return -1;
}

static int tc_picture_write(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv)
{
    tc_error err = {0};
    tc_picture_file file[3] = {{0}}; /* what is beside the picture, then the picture */
    const char *path = run->options->output;
    int n = 0, code = tc_picture_dress(run, talk);
    tc_picture_file own = {0};
    if (code < 0)
        code = tc_picture_file_make(&own, run, path, argc, argv, talk);
    if (code < 0)
        code = tc_numbers_make(file, &n, &own, run, frames->renderer, path, talk);
    file[n++] = own;
    double start = tc_talk_clock_s();
    tc_status status = TC_OK;
    for (int i = 0; i < n && code < 0 && status == TC_OK; i++)
        status = tc_picture_file_write(&file[i], frames->writer, &talk->log, &err);
    run->ms_write = 1e3 * (tc_talk_clock_s() - start);
    for (int i = 0; i < n; i++)
        tc_picture_file_finish(&file[i]);
    return status ? tc_talk_status(talk, status, &err) : code;
}

/* The largest channel, of light without opacity too. */
static double tc_image_light(const tc_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height * 4;
    float peak = 0;
    for (size_t i = 0; i < n; i++)
        peak = image->rgba[i] > peak ? image->rgba[i] : peak;
    return (double)peak;
}

/* Why a picture with a look is empty, where the function's opacity or the mesh's place cannot tell; NULL: they do. */
static const char *tc_look_empty_reason(const tc_look *look)
{
    if (look && (look->n_plane > 0 || look->has_box || look->n_select > 0))
        return "clipping or selection may leave nothing to see: change --clip, --clip-box, --select or --blocks";
    if (look && look->model == TC_MODEL_SURFACES)
        return "no ray meets a surface: give --iso values that the scalar takes (tetcast info tells its range)";
    if (look && (look->model == TC_MODEL_MAXIMUM || look->model == TC_MODEL_MINIMUM || look->model == TC_MODEL_AVERAGE))
        return "no ray meets a cell whose values are finite: change the camera, or leave its options out";
    return NULL;
}

double tc_picture_peak(const tc_render_run *run, const tc_image *image)
{
    const tc_look *look = run->render.look;
    return look && look->model == TC_MODEL_EMISSION ? tc_image_light(image) : (double)tc_image_peak(image);
}

/* Is some pixel opaque enough? Sought from the middle on, where it is found at once. */
static bool tc_is_seen(const tc_image *image)
{
    const size_t n = (size_t)image->width * (size_t)image->height, half = n / 2;
    for (size_t i = half; i < n; i++)
        if (image->rgba[4 * i + 3] >= (float)TC_VISIBLE)
            return true;
    for (size_t i = 0; i < half; i++)
        if (image->rgba[4 * i + 3] >= (float)TC_VISIBLE)
            return true;
    return false;
}

bool tc_picture_is_empty(char *why, size_t capacity, const tc_render_run *run)
{
    const tc_look *look = run->render.look;
    *why = 0;
    if (!(look && look->model == TC_MODEL_EMISSION) && tc_is_seen(run->image))
        return false;
    return tc_peak_is_empty(why, capacity, run, tc_picture_peak(run, run->image));
}

bool tc_peak_is_empty(char *why, size_t capacity, const tc_render_run *run, double peak)
{
    char reason[512];
    const tc_look *look = run->render.look;
    *why = 0;
    if (peak >= TC_VISIBLE)
        return false;
    if (peak > 0) {
        snprintf(why, capacity,
                 "the picture is all but empty: no pixel is more opaque than %.3g, less than half an 8-bit step; "
                 "raise --opacity or make --unit-distance smaller",
                 peak);
        return true;
    }
    const char *known = tc_look_empty_reason(look);
    if (!known)
        tc_empty_reason(reason, sizeof reason, &run->report, tc_run_field(run), run->tf,
                        run->options->nan_color.there ? run->render.nan_color : NULL, &run->camera,
                        &run->options->size);
    snprintf(why, capacity, "the picture is empty: %s", known ? known : reason);
    return true;
}

/* What was written, in words. */
static void tc_written(char *out, size_t capacity, const tc_render_command *options)
{
    char name[2][2048];
    snprintf(out, capacity, "%s", strcmp(options->output, "-") ? options->output : "stdout");
    if (options->out.stereo == TC_STEREO_PAIR && tc_stereo_name(name[0], sizeof name[0], options->output, 0) &&
        tc_stereo_name(name[1], sizeof name[1], options->output, 1))
        snprintf(out, capacity, "%s and %s", name[0], name[1]);
}

static void tc_render_summary(const tc_render_run *run, tc_talk *talk)
{
    char written[4200];
    const tc_render_stats *stats = &run->first;
    char frame[48] = "";
    if (run->report.reentry == TC_REENTRY_PEEL && *run->report.reentry_why &&
        !talk->verbose) /* verbose: said already */
        tc_talk_say(talk, "rays cross the mesh's gaps by peeling: %s", run->report.reentry_why);
    tc_written(written, sizeof written, run->options);
    if (isfinite(run->frame.median))
        snprintf(frame, sizeof frame, ", frame %.1f ms", run->frame.median);
    tc_talk_say(talk, "%zu tets, %zu imaginary; %s%s%s%s%s%s; wrote %s", run->report.n_tet, run->report.n_imaginary,
                stats->context, *stats->context ? " " : "", stats->driver, *stats->integrator ? ", " : "",
                stats->integrator, frame, written);
}

int tc_render_ready(tc_frames *frames, tc_talk *talk)
{
    tc_error err = {0};
    tc_status status = frames->start ? tc_renderer_end(&frames->renderer, &frames->start, &talk->log, &err)
                                     : tc_renderer_create(&frames->renderer, &frames->make, &talk->log, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

int tc_picture_render(tc_render_run *run, tc_frames *frames, tc_talk *talk)
{
    const tc_render_command *options = run->options;
    int code = tc_choice_asked(options) ? tc_choice_make(run, frames->renderer, talk) : -1;
    if (code < 0)
        code = tc_frames_run(run, frames, talk);
    if (code < 0 && options->has_verify)
        code = tc_verify_run(run, talk);
    if (code < 0)
        tc_choice_take_verify(run, talk);
    return code < 0 ? tc_choice_judge(run, talk) : code;
}

int tc_render_picture(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv)
{
    char why[640];
    if (run->options->out.stereo != TC_STEREO_NONE)
        return tc_stereo_picture(run, frames, talk, argc, argv);
    if (tc_bands_asked(run->options))
        return tc_bands_picture(run, frames, talk, argc, argv);
    int code = tc_picture_render(run, frames, talk);
    if (code < 0) {
        if (tc_picture_is_empty(why, sizeof why, run))
            tc_talk_always(talk, "%s", why);
        code = tc_picture_write(run, frames, talk, argc, argv);
    }
    if (code < 0 && run->errors)
        code = tc_error_image_write(run, talk, argc, argv);
    run->measured = code < 0 || run->count.rays_lost > 0; /* a lost ray is in the numbers, but makes no picture */
    return code;
}

int tc_render_end(const tc_render_run *run, tc_talk *talk)
{
    tc_render_summary(run, talk);
    if (run->lost.code)
        return tc_talk_status(talk, run->lost.code, &run->lost);
    if (!run->broken)
        return -1;
    tc_talk_error(talk, "%s: in %lld of %lld visited cells other than two faces held the ray; please report it",
                  run->options->input, (long long)run->count.audit_broken, (long long)run->count.steps);
    return TC_EXIT_FAILED;
}
