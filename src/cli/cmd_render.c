/* cmd_render.c: `tetcast render`: one image of a mesh, or one of each of several steps. */
#include "cli/picture/render_choose.h"
#include "cli/picture/render_picture.h"
#include "cli/picture/render_sequence.h"
#include "cli/picture/render_setup.h"

#include <math.h>
#include <stdio.h>

static int tc_stats_write(tc_render_run *run, tc_talk *talk)
{
    run->ms_total = 1e3 * (tc_talk_clock_s() - talk->start_s);
    json_t *json = tc_render_stats_json(run);
    if (!json) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    int code = tc_json_write(json, run->options->stats, talk);
    json_decref(json);
    return code;
}

/* From a prepared mesh to files. */
static int tc_render_do(tc_render_run *run, tc_frames *frames, tc_talk *talk, int argc, char **argv)
{
    int code = tc_render_ready(frames, talk);
    if (code >= 0)
        return code;
    code = tc_render_picture(run, frames, talk, argc, argv);
    if (run->options->stats && run->measured) {
        int wrote = tc_stats_write(run, talk);
        code = code < 0 ? wrote : code;
    }
    return code < 0 ? tc_render_end(run, talk) : code;
}

/* The names of one step's picture and image of errors. */
typedef struct tc_step_files {
    char name[2][1024];
} tc_step_files;

/* Names that have {step} or {time} get the number and time of the step that --step or --time asked for. */
static int tc_step_files_fill(tc_render_command *out, tc_step_files *files, const tc_render_command *asked, int step,
                              double time, tc_talk *talk)
{
    const struct {
        const char *option, *path, **out;
    } file[] = {{"--output", asked->output, &out->output}, {"--error-image", asked->error_image, &out->error_image}};
    for (int i = 0; i < 2; i++) {
        const char *path = file[i].path;
        char why[256];
        if (!path || path == asked->default_output || !(asked->source.has_step || asked->source.has_time) ||
            !tc_step_is_in_name(path))
            continue;
        if (!tc_step_name(files->name[i], sizeof files->name[i], path, step, isfinite(time) ? time : 0, why,
                          sizeof why)) {
            tc_talk_error(talk, "%s %s: %s", file[i].option, path, why);
            return TC_EXIT_USAGE;
        }
        *file[i].out = files->name[i];
    }
    return -1;
}

/* After that: each file its own, none the input, in folders that are there. */
static int tc_step_files_check(const tc_render_command *options, const tc_step_files *files, tc_talk *talk)
{
    const char *const other[] = {options->input, options->scene_path, options->stats, options->error_image,
                                 options->output};
    const char *const path[2] = {options->output, options->error_image};
    for (int i = 0; i < 2; i++) {
        if (path[i] != files->name[i])
            continue;
        for (size_t k = 0; k < sizeof other / sizeof *other; k++)
            if (other[k] && other[k] != path[i] && tc_same_file(other[k], path[i])) {
                tc_talk_error(talk, "%s is %s: give %s another name", path[i],
                              k < 2 ? "the input and would be written over" : "the name of two files",
                              i == 0 ? "--output" : "--error-image");
                return TC_EXIT_USAGE;
            }
        int code = tc_output_check(path[i], talk);
        if (code >= 0)
            return code;
    }
    return -1;
}

static int tc_render_one(const tc_render_command *asked, tc_talk *talk, int argc, char **argv)
{
    tc_frames frames = {0};
    tc_render_run run = {0};
    tc_step_files files;
    tc_render_command options = *asked;
    int code = tc_step_files_fill(&options, &files, asked, 0, 0, talk); /* a wrong one is told before INPUT is read */
    if (code < 0)
        code = tc_frames_make(&frames, &options, talk);
    if (code < 0)
        code = tc_render_open(&run, &options, talk);
    const tc_source *source = code < 0 ? tc_mesh_source(run.mesh) : NULL;
    if (source) {
        const int step = source->step > 0 ? source->step : 0;
        code = tc_step_files_fill(&options, &files, asked, step, source->n_time > 0 ? source->time[step] : 0, talk);
    }
    if (code < 0)
        code = tc_step_files_check(&options, &files, talk);
    if (code < 0)
        code = tc_render_do(&run, &frames, talk, argc, argv);
    tc_frames_finish(&frames);
    tc_render_close(&run);
    return code;
}

/* Does the command make one frame of a picture, and keep nothing for another? */
static bool tc_render_is_once(const tc_render_command *o)
{
    bool again = o->steps.there || o->has_repeat || o->source.cache || o->source.cache_file;
    bool measured = o->count || o->audit || o->stats || o->has_verify || tc_choice_asked(o);
    return !again && !measured && o->samples <= 1 && o->samples >= 0 && o->stepper == TC_STEPPER_SIGNS;
}

int tc_render_run_command(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    tc_render_command options;
    int code = tc_render_command_read(&options, talk, command, argc, argv);
    if (code < 0 && tc_render_is_once(&options))
        options.source.once_pixels = (size_t)options.size.width * (size_t)options.size.height;
    if (code < 0)
        code = options.steps.there ? tc_render_sequence(&options, talk, argc, argv)
                                   : tc_render_one(&options, talk, argc, argv);
    tc_render_command_finish(&options);
    return code < 0 ? TC_EXIT_DONE : code;
}
