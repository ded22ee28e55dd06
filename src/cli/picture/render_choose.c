/* render_choose.c: --error and --frame-time: settings by what they give instead of by name. */
#include "cli/picture/render_choose.h"
#include "cli/picture/render_verify.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int tc_choice_make(tc_render_run *run, tc_renderer *renderer, tc_talk *talk)
{
    const tc_render_command *options = run->options;
    const tc_choose_request request = {.error = options->error,
                                       .frame_ms = options->frame_time,
                                       .verify = options->has_verify ? (size_t)options->verify : 0,
                                       .seed = options->seed,
                                       .threads = options->source.threads,
                                       .no_cache = options->no_cache};
    tc_error err = {0};
    tc_status status =
        tc_choose(&run->render, &run->choice, renderer, run->mesh, run->tf, &run->camera, &request, &talk->log, &err);
    if (status) {
        char text[sizeof err.text];
        snprintf(text, sizeof text, "%s", err.text);
        snprintf(err.text, sizeof err.text, "%.200s: %.800s", options->input, text);
        return tc_talk_status(talk, status, &err);
    }
    run->chosen = true;
    tc_talk_say(talk, "%s", run->choice.why);
    return -1;
}

void tc_choice_take_verify(tc_render_run *run, tc_talk *talk)
{
    const tc_choose_report *choice = &run->choice;
    if (!run->chosen || run->verified)
        return;
    run->verify = choice->verify;
    run->verify.rays_lost = run->count.rays_lost;
    run->verified = true;
    char share[200];
    tc_confidence_text(share, sizeof share, &run->verify);
    tc_talk_say(talk, "verify: %zu pixels, max error %.3g%s%s", choice->verify.pixels, choice->verify.max_abs_error,
                *share ? "; " : "", share);
    if (choice->suspects)
        tc_talk_say(talk,
                    "verify: of all pixels, the %zu that differ most from the most accurate setting: max error %.3g",
                    choice->suspects, choice->suspect_error);
}

int tc_choice_judge(const tc_render_run *run, tc_talk *talk)
{
    double asked = run->options->error;
    if (!run->chosen || !(asked > 0) || !run->verified || run->verify.max_abs_error <= asked)
        return -1;
    tc_talk_error(talk,
                  "%s: the picture errs by %.3g, more than the %.3g that were asked for, though it did not when its "
                  "setting was chosen; the renderer does not give the same picture twice: take --driver reference",
                  run->options->input, run->verify.max_abs_error, asked);
    return TC_EXIT_FAILED;
}

json_t *tc_choice_json(const tc_render_run *run)
{
    const tc_choose_report *choice = &run->choice;
    if (!run->chosen)
        return NULL;
    json_t *json = json_object();
    if (run->options->error > 0)
        tc_json_real(json, "asked_error", run->options->error);
    if (run->options->frame_time > 0) {
        tc_json_real(json, "asked_frame_ms", run->options->frame_time);
        json_object_set_new(json, "in_time", json_boolean(choice->in_time));
        tc_json_real(json, "margin", choice->margin);
    }
    tc_json_text(json, "setting", choice->setting);
    tc_json_text(json, "why", choice->why);
    tc_json_measured(json, "error", choice->error);
    tc_json_measured(json, "calibrated_error", choice->calibrated_error);
    tc_json_measured(json, "frame_ms", choice->ms);
    if (choice->suspects) {
        tc_json_count(json, "suspects", choice->suspects);
        tc_json_measured(json, "suspect_error", choice->suspect_error);
    }
    if (choice->candidates > 0) {
        json_object_set_new(json, "cached", json_boolean(choice->cached));
        tc_json_count(json, "candidates", (uint64_t)choice->candidates);
        tc_json_count(json, "calibration_rays", choice->rays);
        tc_json_measured(json, "calibration_ms", choice->ms_calibrate);
    }
    tc_json_count(json, "tried", (uint64_t)choice->tried);
    tc_json_text(json, "best_setting", choice->best_setting);
    tc_json_measured(json, "best_error", choice->best_error);
    tc_json_measured(json, "best_frame_ms", choice->best_ms);
    return json;
}
