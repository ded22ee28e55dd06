/* cmd_batch.c: `tetcast batch`: all pictures of a scene. */
#include "cli/batch/batch_options.h"
#include "cli/batch/films.h"
#include "cli/batch/run.h"
#include "cli/batch/stop.h"
#include "cli/picture/render_setup.h"

#include <math.h>
#include <stdio.h>

/* What --dry-run lists: a line for each frame of this shard, and what all take. */
static void tc_frames_list(const tc_batch_frames *frames, const tc_batch_base *base, const tc_batch_scene *scene,
                           tc_report *report, tc_talk *talk)
{
    static const char *const name[] = {"other", "to do", "kept", "done", "failed"};
    const tc_size size = scene->look[0].picture.size;
    size_t n = 0;
    for (size_t i = 0; i < frames->plan.n; i++) {
        const tc_batch_frame *frame = &frames->frame[i];
        if (frame->state == TC_STATE_OTHER)
            continue;
        const tc_name_values values = tc_batch_values(frames, base, scene, i);
        n += frame->state == TC_STATE_TO_DO;
        if (report->json) {
            json_t *event = json_object();
            json_object_set_new(event, "frame", json_integer((json_int_t)i));
            tc_json_text(event, "file", frame->file);
            json_object_set_new(event, "step", json_integer(values.step));
            tc_json_real(event, "time", values.time);
            tc_json_real(event, "phi", values.phi);
            tc_json_real(event, "theta", values.theta);
            tc_json_text(event, "view", values.view);
            tc_json_text(event, "field", values.field);
            tc_json_text(event, "tf", values.tf);
            tc_json_text(event, "status", name[frame->state]);
            tc_report_event(report, "plan", event);
        } else {
            printf("%zu\t%s\tstep %d\ttime %.9g\t%s\t%s\t%s\t%s\n", i, frame->file, values.step, values.time, values.field,
                   values.tf, values.view, name[frame->state]);
        }
    }
    const double bytes = 4.0 * size.width * size.height;
    tc_talk_say(talk, "%zu frames to do, of %zu in all; each %.2f MiB of pixels before it is compressed, together %.1f MiB",
                n, frames->plan.n, bytes / 1048576, (double)n * bytes / 1048576);
}

static size_t tc_count(const tc_batch_frames *frames, tc_frame_state state)
{
    size_t n = 0;
    for (size_t i = 0; i < frames->plan.n; i++)
        n += frames->frame[i].state == (unsigned char)state;
    return n;
}

static void tc_start_tell(tc_report *report, const tc_batch_frames *frames, const tc_batch_base *base)
{
    json_t *event = json_object();
    json_object_set_new(event, "frames", json_integer((json_int_t)report->all));
    json_object_set_new(event, "steps", json_integer((json_int_t)frames->plan.n_step));
    json_object_set_new(event, "views", json_integer((json_int_t)frames->plan.n_view));
    json_object_set_new(event, "functions", json_integer((json_int_t)frames->plan.n_function));
    json_object_set_new(event, "fields", json_integer((json_int_t)frames->plan.n_field));
    tc_json_measured(event, "survey_ms", base->ms_survey);
    tc_report_event(report, "start", event);
}

/* Frames that were finished before are told of, and are in the catalogue. */
static int tc_kept_tell(const tc_batch_frames *frames, const tc_batch_base *base, tc_catalogue *catalogue,
                        const tc_batch_scene *scene, tc_report *report, tc_talk *talk)
{
    int code = -1;
    for (size_t i = 0; i < frames->plan.n && code < 0; i++) {
        if (frames->frame[i].state != TC_STATE_KEPT)
            continue;
        const tc_name_values values = tc_batch_values(frames, base, scene, i);
        tc_report_frame(report, TC_FRAME_KEPT, i, frames->frame[i].file, values.step, values.time, NULL, NAN, 0);
        code = tc_catalogue_add(catalogue, frames, base, scene, i, talk);
    }
    return code;
}

static int tc_batch_make(tc_batch_frames *frames, tc_batch_base *base, const tc_batch_scene *scene, tc_talk *talk)
{
    const tc_batch_command *look = &scene->look[0];
    tc_catalogue catalogue = {0};
    tc_report report;
    size_t stale = 0;
    int code = look->resume ? tc_batch_resume(frames, &stale, base, scene, talk) : -1;
    tc_report_begin(&report, talk, look->json, frames->plan.n - tc_count(frames, TC_STATE_OTHER));
    if (stale > 0)
        tc_talk_say(talk, "%zu file%s of another scene, of other data or damaged, and made anew", stale,
                    stale == 1 ? " is" : "s are");
    if (code < 0 && look->dry_run) {
        tc_frames_list(frames, base, scene, &report, talk);
        tc_report_finish(&report);
        return -1;
    }
    tc_stop_listen();
    tc_start_tell(&report, frames, base);
    if (code < 0)
        code = tc_catalogue_open(&catalogue, frames, scene, talk);
    if (code < 0)
        code = tc_kept_tell(frames, base, &catalogue, scene, &report, talk);
    if (code < 0 && tc_count(frames, TC_STATE_TO_DO) > 0)
        code = tc_batch_run(frames, base, &catalogue, scene, &report, talk);
    int saved = tc_catalogue_save(&catalogue, talk);
    code = code < 0 ? saved : code;
    if (code < 0)
        code = tc_films_make(frames, base, scene, &report, talk);
    tc_report_end(&report, tc_stop_asked());
    const bool whole = report.failed == 0 && !tc_stop_asked();
    tc_report_finish(&report);
    tc_catalogue_finish(&catalogue);
    return code < 0 && !whole ? TC_EXIT_FAILED : code;
}

int tc_batch_run_command(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    tc_batch_scene scene;
    tc_batch_base base = {0};
    tc_batch_frames frames = {0};
    (void)command;
    tc_stop_prepare();
    int code = tc_batch_scene_read(&scene, talk, argc, argv);
    for (size_t i = 0; i < scene.n_field * scene.n_function && code < 0; i++) /* not at each step anew */
        code = tc_render_function_check(&scene.look[i].picture, talk);
    if (code < 0 && (tc_is_given(&scene.look[0].picture.given, "--cache") ||
                     tc_is_given(&scene.look[0].picture.given, "--cache-file")))
        tc_talk_warning(talk, "a batch reads and writes no cache: --cache and --cache-file are left aside");
    if (code < 0)
        code = tc_batch_base_open(&base, &scene, talk);
    if (code < 0)
        code = tc_batch_plan(&frames, &base, &scene, talk);
    if (code < 0)
        code = tc_batch_base_survey(&base, &scene, frames.plan.step, frames.plan.n_step, talk);
    if (code < 0)
        code = tc_batch_frames_make(&frames, &base, &scene, talk);
    if (code < 0)
        code = tc_films_check(&frames, &base, &scene, talk);
    if (code < 0)
        code = tc_batch_make(&frames, &base, &scene, talk);
    tc_batch_frames_finish(&frames);
    tc_batch_base_finish(&base);
    tc_batch_scene_finish(&scene);
    return code < 0 ? TC_EXIT_DONE : code;
}
