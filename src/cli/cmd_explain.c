/* cmd_explain.c: `tetcast explain`: what a picture calls for and why, with bytes, programs and passes; with --measure
 * what each part of it costs. */
#include "cli/commands.h"
#include "cli/picture/explain_measure.h"
#include "cli/picture/render_choose.h"
#include "cli/picture/render_setup.h"

#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *tc_sizes_json(const tc_explained_size *size, int n, const char *unit)
{
    json_t *list = json_array();
    for (int i = 0; i < n; i++) {
        json_t *row = json_object();
        tc_json_text(row, "name", size[i].name);
        tc_json_real(row, unit, size[i].bytes);
        json_array_append_new(list, row);
    }
    return list;
}

/* Why this integrator: what the plan says, else who asked for it. */
static const char *tc_integrator_why(const tc_render_run *run, const tc_render_stats *stats)
{
    static const char *const name[] = {
        [TC_INTEGRATOR_TABLE] = "table", [TC_INTEGRATOR_INTEGRAL] = "integral", [TC_INTEGRATOR_EXACT] = "exact"};
    const size_t asked = (size_t)run->render.integrator;
    if (*stats->integrator_why)
        return stats->integrator_why;
    if (asked >= sizeof name / sizeof *name || !name[asked] || strcmp(name[asked], stats->integrator) != 0)
        return "the model takes no other";
    return run->chosen ? "chosen for the error or the frame time that was asked for" : "as --integrator asks";
}

static json_t *tc_explain_json(const tc_explanation *e, const tc_render_run *run, const tc_render_stats *stats,
                               const tc_shares *parts)
{
    json_t *out = json_object(), *effects = json_array(), *passes = json_object();
    for (int i = 0; i < e->n_effect; i++) {
        const tc_explained_effect *effect = &e->effect[i];
        json_t *row = json_object();
        tc_json_text(row, "name", effect->name);
        tc_json_text(row, "what", effect->what);
        json_object_set_new(row, "in_force", json_boolean(effect->in_force));
        tc_json_text(row, "why", effect->why);
        if (effect->in_force)
            tc_json_real(row, "gpu_bytes", effect->gpu_bytes);
        json_array_append_new(effects, row);
    }
    json_object_set_new(out, "effects", effects);
    tc_json_count(passes, "first_hits", (uint64_t)(stats->layers > 0 ? stats->layers : 1));
    tc_json_count(passes, "march", (uint64_t)(stats->passes > 0 ? stats->passes : 0));
    if (stats->z_updates >= 0)
        tc_json_count(passes, "z_updates", (uint64_t)stats->z_updates);
    json_object_set_new(out, "passes", passes);
    json_object_set_new(out, "textures", tc_sizes_json(e->texture, e->n_texture, "bytes"));
    json_object_set_new(out, "programs", tc_sizes_json(e->program, e->n_program, "text_bytes"));
    tc_json_text(out, "integrator", stats->integrator);
    tc_json_text(out, "integrator_why", tc_integrator_why(run, stats));
    if (run->chosen)
        json_object_set_new(out, "choice", tc_choice_json(run));
    if (parts->n > 0) {
        json_t *list = json_array();
        for (int i = 0; i < parts->n; i++) {
            json_t *row = json_object();
            tc_json_text(row, "name", parts->part[i].name);
            tc_json_real(row, "ms", parts->part[i].ms);
            json_array_append_new(list, row);
        }
        json_object_set_new(out, "parts", list);
        tc_json_real(out, "sum_ms", parts->sum);
        tc_json_real(out, "frame_ms", parts->frame);
    }
    return out;
}

static void tc_sizes_print(const char *title, const tc_explained_size *size, int n)
{
    double sum = 0;
    printf("%s\n", title);
    for (int i = 0; i < n; i++) {
        printf("  %-24s %12.0f\n", size[i].name, size[i].bytes);
        sum += size[i].bytes;
    }
    printf("  %-24s %12.0f\n", "in all", sum);
}

static void tc_explain_print(const tc_explanation *e, const tc_render_run *run, const tc_render_stats *stats,
                             const tc_shares *parts)
{
    printf("in force\n");
    for (int i = 0; i < e->n_effect; i++)
        if (e->effect[i].in_force)
            printf("  %-18s %s; %s\n", e->effect[i].name, e->effect[i].why, e->effect[i].what);
    printf("not called for\n");
    for (int i = 0; i < e->n_effect; i++)
        if (!e->effect[i].in_force)
            printf("  %-18s %s\n", e->effect[i].name, e->effect[i].why);
    printf("integrator\n  %-18s %s\n", stats->integrator, tc_integrator_why(run, stats));
    if (run->chosen)
        printf("chosen\n  %s\n", run->choice.why);
    printf("passes\n  %-24s %12d\n  %-24s %12d\n", "first hits", stats->layers > 0 ? stats->layers : 1, "march",
           stats->passes > 0 ? stats->passes : 0);
    if (stats->z_updates >= 0)
        printf("  %-24s %12d\n", "locks of finished rays", stats->z_updates);
    tc_sizes_print("textures, bytes", e->texture, e->n_texture);
    tc_sizes_print("programs, bytes of text", e->program, e->n_program);
    if (parts->n == 0)
        return;
    printf("milliseconds, each by leaving it out\n");
    for (int i = 0; i < parts->n; i++)
        printf("  %-24s %12.2f\n", parts->part[i].name, parts->part[i].ms);
    printf("  %-24s %12.2f\n  %-24s %12.2f\n", "in all", parts->sum, "a frame", parts->frame);
}

static int tc_explain_picture(tc_render_run *run, bool as_json, bool measure, tc_talk *talk)
{
    const tc_render_command *options = run->options;
    const tc_renderer_options make = {.gl = options->gl, .driver = options->driver, .threads = options->source.threads};
    tc_renderer *renderer = NULL;
    tc_render_stats stats;
    tc_explanation *explanation = calloc(1, sizeof *explanation);
    tc_shares parts = {0};
    tc_error err = {0};
    tc_status status = explanation ? tc_renderer_create(&renderer, &make, &talk->log, &err) : TC_E_MEMORY;
    int code = -1;
    if (status == TC_OK && tc_choice_asked(options))
        code = tc_choice_make(run, renderer, talk);
    if (status == TC_OK && code < 0)
        status =
            tc_render(&run->image, &stats, renderer, run->mesh, run->tf, &run->camera, &run->render, &talk->log, &err);
    if (status == TC_OK && code < 0)
        status = tc_render_explain(explanation, renderer, &err);
    if (status == TC_OK && code < 0 && measure)
        status = tc_shares_measure(&parts, explanation, renderer, run, &talk->log, &err);
    tc_renderer_destroy(&renderer);
    if (status != TC_OK)
        code = tc_talk_status(talk, status, &err);
    if (code < 0 && as_json) {
        json_t *json = tc_explain_json(explanation, run, &stats, &parts);
        code = tc_json_write(json, "-", talk);
        json_decref(json);
    } else if (code < 0) {
        tc_explain_print(explanation, run, &stats, &parts);
    }
    free(explanation);
    return code;
}

/* Options that a picture's file and its measurements have: they change nothing here. */
static void tc_idle_say(const tc_render_command *options, tc_talk *talk)
{
    static const char *const idle[] = {"--stats", "--verify", "--error-image", "--repeat", "--count", "--audit"};
    char names[128] = "";
    int n = 0;
    for (size_t i = 0; i < sizeof idle / sizeof *idle; i++) {
        const bool in_use = tc_choice_asked(options) && !strcmp(idle[i], "--verify"); /* the choice is checked there */
        if (in_use || !tc_is_given(&options->given, idle[i]))
            continue;
        const size_t length = strlen(names);
        snprintf(names + length, sizeof names - length, "%s%s", n++ ? ", " : "", idle[i]);
    }
    if (n > 0)
        tc_talk_warning(talk,
                        "explain writes no picture and measures none, so what tetcast render does with %s is left out",
                        names);
}

/* Of several steps the first is explained. -1, or the exit code of an error that was printed. */
static int tc_first_step_say(const tc_render_run *run, tc_talk *talk)
{
    const tc_render_command *options = run->options;
    const tc_source *source = tc_mesh_source(run->mesh);
    char why[160];
    int step = 0;
    if (!options->steps.there || !source)
        return -1;
    const size_t n = tc_step_range_list(&step, 1, &options->steps, source->n_time, why, sizeof why);
    if (n == 0) {
        tc_talk_error(talk, "%s %s", options->input, why);
        return TC_EXIT_FAILED;
    }
    if (n > 1)
        tc_talk_warning(talk, "step %d is explained, the first of %zu%s", step, n,
                        options->has_range ? "" : ", with the function over its own range instead of that of all");
    return -1;
}

/* Its own options, then those of render. */
static const tc_option tc_explain_option[] = {
    {.help = "Explanation"},
    {"--measure", 0, NULL, "milliseconds of each part of a frame, found by leaving it out", TC_OPTION_FLAG,
     .at = offsetof(tc_render_command, explain_measure)},
    {"--json", 0, NULL, "as JSON", TC_OPTION_FLAG, .at = offsetof(tc_render_command, explain_json)},
};

static int tc_explain_run(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    tc_render_command options;
    tc_render_run run = {0};
    int code = tc_picture_command_read(&options, talk, command, argc, argv);
    if (code < 0)
        code = tc_render_open(&run, &options, talk);
    if (code < 0)
        code = tc_first_step_say(&run, talk);
    if (code < 0)
        tc_idle_say(&options, talk);
    if (code < 0)
        code = tc_explain_picture(&run, options.explain_json, options.explain_measure, talk);
    tc_render_close(&run);
    tc_render_command_finish(&options);
    return code < 0 ? TC_EXIT_DONE : code;
}

const tc_command tc_command_explain = {
    .name = "explain",
    .arguments = "INPUT",
    .what = "What a picture calls for and why: effects, passes, textures, programs.",
    .about = "INPUT and the options are those of render; no picture is written.",
    .own = tc_explain_option,
    .n_own = sizeof tc_explain_option / sizeof *tc_explain_option,
    .option = tc_render_option,
    .n_option = TC_N_RENDER_OPTION,
    .also = tc_look_option,
    .n_also = TC_N_LOOK_OPTION,
    .also_at = offsetof(tc_render_command, look),
    .given = offsetof(tc_render_command, given) + 1,
    .least = 1,
    .most = 1,
    .run = tc_explain_run,
};
