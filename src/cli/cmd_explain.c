/* cmd_explain.c: `tetcast explain`: what a picture calls for and why, with bytes, programs and passes; with --measure what each
 * part of it costs. */
#include "cli/commands.h"
#include "cli/explain_measure.h"
#include "cli/render_setup.h"

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

static json_t *tc_explain_json(const tc_explanation *e, const tc_render_stats *stats, const tc_shares *parts)
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
    tc_json_text(out, "integrator_why", stats->integrator_why);
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

static void tc_explain_print(const tc_explanation *e, const tc_render_stats *stats, const tc_shares *parts)
{
    printf("in force\n");
    for (int i = 0; i < e->n_effect; i++)
        if (e->effect[i].in_force)
            printf("  %-18s %s; %s\n", e->effect[i].name, e->effect[i].why, e->effect[i].what);
    printf("not called for\n");
    for (int i = 0; i < e->n_effect; i++)
        if (!e->effect[i].in_force)
            printf("  %-18s %s\n", e->effect[i].name, e->effect[i].why);
    printf("integrator\n  %-18s %s\n", stats->integrator, stats->integrator_why);
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
    const tc_renderer_options make = {
        .gl = options->gl, .driver = options->driver, .threads = options->source.threads};
    tc_renderer *renderer = NULL;
    tc_render_stats stats;
    tc_explanation *explanation = calloc(1, sizeof *explanation);
    tc_shares parts = {0};
    tc_error err = {0};
    tc_status status = explanation ? tc_renderer_create(&renderer, &make, &talk->log, &err) : TC_E_MEMORY;
    if (status == TC_OK)
        status = tc_render(&run->image, &stats, renderer, run->mesh, run->tf, &run->camera, &run->render, &talk->log, &err);
    if (status == TC_OK)
        status = tc_render_explain(explanation, renderer, &err);
    if (status == TC_OK && measure)
        status = tc_shares_measure(&parts, explanation, renderer, run, &talk->log, &err);
    tc_renderer_destroy(&renderer);
    int code = status == TC_OK ? -1 : tc_talk_status(talk, status, &err);
    if (code < 0 && as_json) {
        json_t *json = tc_explain_json(explanation, &stats, &parts);
        code = tc_json_write(json, "-", talk);
        json_decref(json);
    } else if (code < 0) {
        tc_explain_print(explanation, &stats, &parts);
    }
    free(explanation);
    return code;
}

/* Its own options, then those of render. */
enum { TC_EXPLAIN_OWN = 3, TC_EXPLAIN_ROWS = 256 };
static const tc_option tc_explain_option[TC_EXPLAIN_OWN] = {
    {.help = "Explanation"},
    {"--measure", 0, NULL, "milliseconds of each part of a frame, found by leaving it out", TC_OPTION_FLAG,
     .at = offsetof(tc_render_command, explain_measure)},
    {"--json", 0, NULL, "as JSON", TC_OPTION_FLAG, .at = offsetof(tc_render_command, explain_json)},
};

static int tc_explain_run(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    tc_option rows[TC_EXPLAIN_ROWS];
    tc_command whole = tc_command_render;
    size_t n = tc_command_render.n_option;
    if (n > TC_EXPLAIN_ROWS - TC_EXPLAIN_OWN)
        n = TC_EXPLAIN_ROWS - TC_EXPLAIN_OWN;
    memcpy(rows, tc_explain_option, sizeof tc_explain_option);
    memcpy(rows + TC_EXPLAIN_OWN, tc_command_render.option, n * sizeof *rows);
    whole.name = command->name;
    whole.what = command->what;
    whole.about = command->about;
    whole.option = rows;
    whole.n_option = TC_EXPLAIN_OWN + n;
    tc_render_command options;
    tc_render_run run = {0};
    int code = tc_picture_command_read(&options, talk, &whole, argc, argv);
    if (code < 0)
        code = tc_render_open(&run, &options, talk);
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
    .about = "INPUT and the options are those of render (tetcast render --help); no picture is written.",
    .option = tc_explain_option,
    .n_option = TC_EXPLAIN_OWN,
    .least = 1,
    .most = 1,
    .run = tc_explain_run,
};
