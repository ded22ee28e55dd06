/* bands.c: pictures in bands. A band has the picture's whole width; where that is more than a GL texture has, it is put
 * together of tiles. Parts have the rays of the whole picture, bit by bit, so that no seam can show. All parts are of one
 * size, so that the rays' state is made once (the old one's memory is not free before a new one is used): where the rows do
 * not divide, a band has one that is the next one's first, too. Where rays are counted, each is made once alone. */
#include "cli/picture/bands.h"
#include "cli/picture/bands_size.h"
#include "cli/picture/render_figure.h"
#include "cli/picture/stats_sum.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    TC_BAND_PIXELS = TC_ONCE_PIXELS,
    TC_PREVIEW = 256 /* the longer side of the small picture that the ink is chosen by */
};

typedef struct tc_bands {
    tc_render_run *run;
    tc_renderer *renderer;
    tc_talk *talk;
    tc_image *band;          /* the one at hand */
    tc_image_stream *stream; /* from the first band on */
    double peak, ms_write;
    bool exact; /* no row and no column is made twice */
} tc_bands;

/* Part i of n of a length, `*from` … `*to`; gives how much is rendered from *from on, which is the same for all parts unless
 * exact. */
static int tc_part_of(int *from, int *to, int length, int i, int n, bool exact)
{
    *from = (int)((long long)length * i / n);
    *to = (int)((long long)length * (i + 1) / n);
    return exact ? *to - *from : (length + n - 1) / n;
}

/* ------------------------------------------------------------------------------------------------------- rendering */

/* Renders a part. Later parts would say again what the first one said. -1, or an exit code; a lost ray is an error
 * after its numbers are in the sum. */
static int tc_part_render(tc_image **out, tc_bands *b, const int rect[4], bool count, bool first)
{
    tc_render_run *run = b->run;
    const tc_log silent = {0};
    tc_error err = {0};
    tc_render_stats stats;
    tc_render_options render = run->render;
    render.whole_width = render.width;
    render.whole_height = render.height;
    render.part_x = rect[0], render.part_y = rect[1];
    render.width = rect[2], render.height = rect[3];
    render.count = count;
    render.audit = count && run->options->audit;
    const tc_log log = {.message = b->talk->log.message, .user = b->talk->log.user};
    tc_status status =
        tc_render(out, &stats, b->renderer, run->mesh, run->tf, &run->camera, &render, first ? &log : &silent, &err);
    if (status == TC_OK || status == TC_E_LOST)
        tc_stats_sum_add(count ? &run->count : &run->first, &stats, first);
    if (status == TC_E_LOST && render.stepper == TC_STEPPER_PLANES) {
        run->lost = err;
        return -1;
    }
    return status ? tc_talk_status(b->talk, status, &err) : -1;
}

/* Renders the band of `rows` rows from row y on: into b->band, or, to count alone, into nothing. */
static int tc_band_render(tc_bands *b, int y, int rows, bool count)
{
    const int width = b->run->render.width, tiles = (width + TC_ONCE_SIDE - 1) / TC_ONCE_SIDE;
    tc_error err = {0};
    int code = -1;
    tc_image_destroy(&b->band);
    if (tiles > 1 && !count) {
        tc_status status = tc_image_create(&b->band, width, rows, &err);
        if (status != TC_OK)
            return tc_talk_status(b->talk, status, &err);
    }
    for (int i = 0; i < tiles && code < 0; i++) {
        int from, to;
        const int columns = tc_part_of(&from, &to, width, i, tiles, b->exact || count);
        tc_image *tile = NULL;
        code = tc_part_render(&tile, b, (const int[]){from, y, columns, rows}, count, y == 0 && i == 0);
        if (code < 0 && !count && tiles == 1) {
            b->band = tile;
            tile = NULL;
        }
        for (int row = 0; code < 0 && !count && tiles > 1 && row < rows; row++)
            memcpy(b->band->rgba + 4 * ((size_t)row * (size_t)width + (size_t)from),
                   tile->rgba + 4 * (size_t)row * (size_t)tile->width, 4 * sizeof *tile->rgba * (size_t)(to - from));
        tc_image_destroy(&tile);
    }
    return code;
}

/* Title, bar and axes are as dark or light in all bands: by a small picture of the whole. */
static int tc_ink_find(tc_bands *b)
{
    tc_render_run *run = b->run;
    const tc_log silent = {0};
    tc_render_options small = run->render;
    tc_image *image = NULL;
    tc_error err = {0};
    const double scale = (double)TC_PREVIEW / fmax(small.width, small.height);
    small.width = (int)fmax(1, round(scale * small.width));
    small.height = (int)fmax(1, round(scale * small.height));
    tc_status status = tc_render(&image, NULL, b->renderer, run->mesh, run->tf, &run->camera, &small, &silent, &err);
    if (status == TC_OK || (status == TC_E_LOST && image)) {
        if (run->options->background.there)
            tc_image_background(image, run->options->background.rgba);
        run->ink = tc_figure_ink(image);
        status = TC_OK;
    }
    tc_image_destroy(&image);
    return status ? tc_talk_status(b->talk, status, &err) : -1;
}

/* Background under the band, title, bar and axes over it. */
static int tc_band_dress(tc_bands *b, int y)
{
    tc_render_run *run = b->run;
    const tc_log silent = {0};
    tc_error err = {0};
    tc_figure figure;
    const double peak = tc_picture_peak(run, b->band);
    b->peak = fmax(b->peak, peak);
    if (run->options->background.there)
        tc_image_background(b->band, run->options->background.rgba);
    if (!tc_render_figure(&figure, run))
        return -1;
    if (figure.ink == TC_INK_AUTO) {
        int code = tc_ink_find(b);
        if (code >= 0)
            return code;
        figure.ink = run->ink;
    }
    figure.whole_width = run->render.width;
    figure.whole_height = run->render.height;
    figure.part_y = y;
    tc_status status = tc_figure_draw(b->band, &figure, y == 0 ? &b->talk->log : &silent, &err);
    return status ? tc_talk_status(b->talk, status, &err) : -1;
}

/* --------------------------------------------------------------------------------------------------------- writing */

static tc_status tc_bands_open(tc_bands *b, int argc, char **argv, tc_error *err)
{
    tc_render_run *run = b->run;
    const tc_render_command *o = run->options;
    const tc_image_encoding encoding = tc_output_encoding(&o->out, o->output);
    const tc_log log = {.message = b->talk->log.message, .user = b->talk->log.user};
    tc_meta meta;
    tc_meta_make(&meta, run, argc, argv);
    tc_status status = tc_image_stream_open(&b->stream, o->output, run->render.width, run->render.height,
                                            o->background.there && o->background.rgba[3] >= 1, &encoding, meta.pair,
                                            meta.n, &log, err);
    tc_meta_finish(&meta);
    return status;
}

static int tc_band_write(tc_bands *b, int argc, char **argv)
{
    tc_error err = {0};
    const double start = tc_talk_clock_s();
    tc_status status = b->stream ? TC_OK : tc_bands_open(b, argc, argv, &err);
    if (status == TC_OK)
        status = tc_image_stream_rows(b->stream, b->band->rgba, b->band->height, &err);
    b->ms_write += 1e3 * (tc_talk_clock_s() - start);
    return status ? tc_talk_status(b->talk, status, &err) : -1;
}

/* All bands: rendered and written, or counted alone. */
static int tc_bands_run(tc_bands *b, bool count, int argc, char **argv)
{
    const tc_render_options *render = &b->run->render;
    const int most = TC_BAND_PIXELS / render->width, rows = most < TC_ONCE_SIDE ? most : TC_ONCE_SIDE;
    const int n = (render->height + rows - 1) / rows;
    int code = -1;
    for (int i = 0; i < n && code < 0; i++) {
        int from, to;
        const int made = tc_part_of(&from, &to, render->height, i, n, b->exact || count);
        code = tc_band_render(b, from, made, count);
        if (code < 0 && !count)
            b->band->height = to - from;
        if (i == 0 && !count)
            b->run->count = b->run->first; /* metadata ask for it */
        if (code < 0 && !count)
            code = tc_band_dress(b, from);
        if (code < 0 && !count)
            code = tc_band_write(b, argc, argv);
        if (b->talk->log.progress)
            b->talk->log.progress(b->talk->log.user, count ? "counting" : "rendering", (double)(i + 1) / n);
    }
    tc_image_destroy(&b->band);
    return code;
}

int tc_bands_picture(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv)
{
    const tc_render_command *o = run->options;
    const bool counted = o->count || o->audit || o->stats;
    tc_bands b = {.run = run,
                  .renderer = frames->renderer,
                  .talk = talk,
                  .exact = counted || run->render.stepper == TC_STEPPER_PLANES};
    tc_error err = {0};
    char why[640];
    const tc_ink ink = run->ink;
    int code = tc_bands_run(&b, false, argc, argv);
    run->count = run->first;
    if (code < 0 && counted && (strcmp(run->first.driver, "reference") != 0 || o->audit)) {
        code = tc_bands_run(&b, true, argc, argv);
        run->counted = code < 0;
    }
    if (run->lost.code) /* said for one band */
        snprintf(
            run->lost.text, sizeof run->lost.text,
            "%lld of %lld rays were lost by the stepper 'planes', the arithmetic of the paper, which is here to be "
            "compared with; the stepper 'signs' loses none",
            (long long)run->count.rays_lost, (long long)run->count.rays);
    const double start = tc_talk_clock_s();
    tc_status status = b.stream ? tc_image_stream_close(&b.stream, code < 0, &err) : TC_OK;
    if (code < 0 && status != TC_OK)
        code = tc_talk_status(talk, status, &err);
    run->ms_write = b.ms_write + 1e3 * (tc_talk_clock_s() - start);
    run->frames = 1;
    tc_spread_of(&run->frame, (double[]){run->first.ms_frame}, 1);
    tc_spread_of(&run->first_hit, (double[]){run->first.ms_first_hit}, 1);
    tc_spread_of(&run->march, (double[]){run->first.ms_march}, 1);
    tc_spread_of(&run->readback, (double[]){run->first.ms_readback}, 1);
    if (code < 0 && tc_peak_is_empty(why, sizeof why, run, b.peak))
        tc_talk_always(talk, "%s", why);
    if (code < 0 && o->audit) {
        run->broken = run->count.audit_broken > 0;
        if (!run->broken)
            tc_talk_say(talk, "audit: in all %lld visited cells exactly two faces held the ray",
                        (long long)run->count.steps);
    }
    run->measured = code < 0 || run->count.rays_lost > 0;
    run->ink = ink;
    return code;
}
