/* frame.c: one frame of a batch. */
#define _POSIX_C_SOURCE 200809L
#include "cli/batch/frame.h"
#include "cli/batch/folder.h"
#include "cli/picture/bands_size.h"
#include "cli/picture/numbers.h"
#include "cli/picture/render_figure.h"
#include "cli/picture/stereo.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { TC_WAITING_PIXELS = 1 << 24 }; /* a larger picture does not wait to be written: it is made in bands */

static int tc_no_memory(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* The command that a picture names: what makes it what it is, not how the run went. */
int tc_frame_kit_make(tc_frame_kit *k)
{
    const tc_given_list *given = &k->scene->look[0].picture.given;
    size_t n_key;
    const tc_scene_key *key = tc_scene_keys(&n_key);
    k->argument[k->n_argument++] = strdup("batch");
    k->argument[k->n_argument++] = strdup(k->scene->path ? k->scene->path : k->scene->series.path[0]);
    for (size_t i = 0; i < given->n && k->n_argument + 2 < TC_FRAME_ARGUMENTS; i++) {
        bool kept = false;
        const char *name = given->item[i].option->name;
        for (size_t j = 0; j < n_key; j++)
            kept = kept || (key[j].option && key[j].role == TC_KEY_PICTURE && !strcmp(key[j].option, name));
        if (!kept || given->item[i].called != name)
            continue;
        k->argument[k->n_argument++] = strdup(name);
        k->argument[k->n_argument++] = strdup(given->item[i].text ? given->item[i].text : "");
    }
    for (int i = 0; i < k->n_argument; i++)
        if (!k->argument[i])
            return tc_no_memory(k->talk);
    return -1;
}

void tc_frame_kit_finish(tc_frame_kit *k)
{
    for (int i = 0; i < k->n_argument; i++)
        free(k->argument[i]);
    k->n_argument = 0;
    tc_frames_finish(&k->renderer);
}

/* The title with its placeholders filled, in the options and among what was given, so that the picture made again has it.
 * title [1024]. */
static void tc_title_fill(tc_render_command *options, tc_given_list *given, char *title, const tc_name_values *values)
{
    char why[256];
    if (!options->look.title || !tc_name_uses(options->look.title, why, sizeof why) ||
        !tc_name_make(title, 1024, options->look.title, values, why, sizeof why))
        return;
    for (size_t i = 0; i < given->n; i++)
        if (!strcmp(given->item[i].option->name, "--title"))
            given->item[i].text = title;
    options->look.title = title;
}

/* Adds the files of a picture that was rendered, those beside it first. */
static int tc_files_add(tc_frame_kit *k, tc_frame_files *out, tc_render_run *run, const char *path)
{
    tc_picture_file own = {0};
    int n = 0, code = tc_picture_dress(run, k->talk);
    if (code < 0)
        code = tc_picture_file_make(&own, run, path, k->n_argument, k->argument, k->talk);
    if (code < 0)
        code = tc_numbers_make(out->file + out->n, &n, &own, run, k->renderer.renderer, path, k->talk);
    for (int i = 0; i < n && code < 0; i++) { /* they are known again by the same text */
        char *copy = strdup(run->frame_text);
        code = copy ? -1 : tc_no_memory(k->talk);
        tc_meta_add(&out->file[out->n + i].meta, "tetcast:frame", copy);
    }
    out->n += n;
    out->file[out->n++] = own;
    return code < 0 ? tc_folders_make(path, k->talk) : code;
}

static void tc_empty_note(tc_frame_kit *k, const tc_render_run *run, size_t number)
{
    char why[640];
    if (!tc_picture_is_empty(why, sizeof why, run))
        return;
    if (k->empty++ == 0)
        snprintf(k->empty_why, sizeof k->empty_why, "%.300s: %s", k->frames->frame[number].file, why);
}

/* One eye's picture, or the only one. */
static int tc_eye_make(tc_frame_kit *k, tc_frame_files *files, tc_render_run *run, size_t number, const char *path)
{
    int code = tc_picture_render(run, &k->renderer, k->talk);
    if (code < 0) {
        tc_empty_note(k, run, number);
        code = tc_files_add(k, files, run, path);
    }
    tc_image_destroy(&run->image);
    return code;
}

/* Two pictures, the left eye's last: it stands for the frame. */
static int tc_pair_make(tc_frame_kit *k, tc_frame_files *files, const tc_render_run *base, size_t number)
{
    const tc_size size = base->options->size;
    tc_camera camera[2];
    int code = -1;
    tc_stereo_cameras(camera, &base->camera, base->options->out.eye_angle, (double)size.width / size.height);
    for (int eye = 1; eye >= 0 && code < 0; eye--) {
        tc_render_command options = *base->options;
        tc_render_run run = *base;
        char *path = tc_batch_eye_file(k->frames, k->base, k->scene, number, eye);
        if (!path)
            return tc_no_memory(k->talk);
        options.out.stereo = TC_STEREO_NONE;
        run.options = &options;
        run.camera = camera[eye];
        code = tc_eye_make(k, files, &run, number, path);
        free(path);
    }
    return code;
}

/* A picture that is written while it is made. */
static int tc_whole_make(tc_frame_kit *k, tc_written *written, tc_render_run *run, size_t number)
{
    struct stat info;
    const char *file = k->frames->frame[number].file;
    tc_render_command options = *run->options;
    options.output = file;
    run->options = &options;
    int code = tc_folders_make(file, k->talk);
    if (code < 0)
        code = tc_render_picture(run, &k->renderer, k->talk, k->n_argument, k->argument);
    *written = (tc_written){.frame = number, .ms = run->ms_write};
    if (code < 0 && stat(file, &info) == 0)
        written->bytes = (size_t)info.st_size;
    tc_image_destroy(&run->image);
    return code;
}

int tc_frame_make(tc_frame_files *files, tc_written *written, tc_frame_kit *k, const tc_render_run *base, size_t number)
{
    char title[1024];
    const tc_plan_frame place = tc_plan_frame_at(&k->frames->plan, number);
    const size_t view = tc_batch_view_of(k->frames, &place);
    const tc_batch_command *look = &k->scene->look[place.field * k->scene->n_function + place.function];
    const tc_name_values values = tc_batch_values(k->frames, k->base, k->scene, number);
    tc_render_run run = *base;
    tc_render_command options = *base->options;
    tc_given_list given = {.n = options.given.n, .item = malloc((options.given.n + 1) * sizeof *given.item)};
    char *text = tc_batch_frame_text(k->frames, k->base, k->scene, number, k->data);
    int code = given.item && text ? -1 : tc_no_memory(k->talk);
    *files = (tc_frame_files){.frame = number};
    if (code < 0) {
        memcpy(given.item, options.given.item, options.given.n * sizeof *given.item);
        options.given = given;
        tc_title_fill(&options, &given, title, &values);
    }
    run.options = &options;
    run.frame_text = text;
    run.camera = k->frames->view[view].camera;
    if (code < 0 && tc_camera_over(look) == TC_OVER_STEP)
        code = tc_batch_view_camera(&run.camera, k->frames, k->scene, view, run.report.bounds, k->talk);
    if (code < 0 && tc_view_is_free(&k->scene->views, view))
        code = tc_render_figure_fit(&run, k->talk);
    const bool large = (int64_t)options.size.width * options.size.height > TC_WAITING_PIXELS && tc_bands_asked(&options);
    if (code < 0)
        code = options.out.stereo == TC_STEREO_PAIR             ? tc_pair_make(k, files, &run, number)
               : options.out.stereo != TC_STEREO_NONE || large ? tc_whole_make(k, written, &run, number)
                                                                : tc_eye_make(k, files, &run, number,
                                                                              k->frames->frame[number].file);
    if (code >= 0)
        tc_frame_files_finish(files);
    free(given.item);
    free(text);
    return code;
}
