/* cmd_render.c: `tetcast render`: one image of a mesh, or one of each of several steps. */
#include "cli/render_choose.h"
#include "cli/render_picture.h"
#include "cli/render_sequence.h"
#include "cli/render_setup.h"

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

static int tc_render_one(const tc_render_command *options, tc_talk *talk, int argc, char **argv)
{
    tc_frames frames;
    tc_render_run run = {0};
    int code = tc_frames_make(&frames, options, talk);
    if (code < 0)
        code = tc_render_open(&run, options, talk);
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
