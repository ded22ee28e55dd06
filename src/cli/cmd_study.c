/* cmd_study.c: `tetcast study`: what accuracy costs in time. */
#define _GNU_SOURCE
#include "cli/commands.h"
#include "cli/gnuplot.h"
#include "cli/input_cache.h"
#include "cli/json_out.h"
#include "cli/picture/render_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { TC_STUDY_FUNCTIONS = 5 };

typedef struct tc_study_command {
    const char *input, *folder;
    char default_folder[512];
    tc_input_options source;
    tc_size size;
    const char *color_map, *preset, *opacity, *functions, *knobs;
    double range[2];
    bool has_range, log, list, json, restart, no_plots;
    double unit_distance;
    const char *gl;
    int gl_choice, views, frames;
    uint64_t verify, seed;
} tc_study_command;

/* Functions to study: standard ones, or "given" by options. */
typedef struct tc_study_names {
    int n;
    const char *name[TC_STUDY_FUNCTIONS];
    char text[TC_STUDY_FUNCTIONS][32];
} tc_study_names;

static const char tc_standard_given[] = "given";
static const char *const tc_study_builtin[] = {"synth:heatsink", "synth:bluntfin", "synth:kuhn", "synth:ball"};

static const tc_choice tc_gl_choice[] = {{"auto", 0, false}, {"osmesa", 1, false}, {"egl", 2, false}, {NULL, 0, false}};

#define AT(member) .at = offsetof(tc_study_command, member)
#define HAS(member) .has = offsetof(tc_study_command, member) + 1
/* clang-format off */
static const tc_option tc_study_option[] = {
    {.help = "Study"},
    {"--out", 'o', "FOLDER", "results; the same command goes on where it stopped; default INPUT's name + -study, or study", TC_OPTION_TEXT, AT(folder)},
    {"--restart", 0, NULL, "drop the results that the folder holds", TC_OPTION_FLAG, AT(restart)},
    {"--knobs", 0, "LIST", "comma-separated knobs and settings; default all (--list)", TC_OPTION_TEXT, AT(knobs)},
    {"--functions", 0, "LIST", "of smooth, knots12, spike, steps; default all, or none with --color-map or --opacity", TC_OPTION_TEXT, AT(functions)},
    {"--views", 0, "N", "directions to look from; default 8", TC_OPTION_INT, AT(views), .low = 1, .high = 10000},
    {"--size", 0, "WxH", "pixels; default 256x256", TC_OPTION_CUSTOM, AT(size), .parse = tc_size_parse},
    {"--frames", 0, "N", "frames timed of each setting in each view; default 5", TC_OPTION_INT, AT(frames), .low = 1, .high = 1000},
    {"--verify", 0, "N", "pixels of each view compared with the reference; default all", TC_OPTION_U64, AT(verify), .low = 1, .high = 1e18},
    {"--no-plots", 0, NULL, "write the plots' data and scripts, but do not run gnuplot", TC_OPTION_FLAG, AT(no_plots)},
    {"--list", 0, NULL, "name knobs, settings and functions on stdout, and end", TC_OPTION_FLAG, AT(list)},
    {"--json", 0, NULL, "the list as JSON", TC_OPTION_FLAG, AT(json)},
    {.help = "Data"},
    TC_INPUT_FIELD_ROWS(tc_study_command, source),
    TC_INPUT_GAP_ROW(tc_study_command, source),
    TC_INPUT_CACHE_ROWS(tc_study_command, source),
    {.help = "Transfer function"},
    {"--color-map", 0, "NAME|FILE", "a built-in map, or a ParaView preset (.json, .xml)", TC_OPTION_TEXT, AT(color_map)},
    {"--preset", 0, "NAME", "which map of a file that holds several; default the first", TC_OPTION_TEXT, AT(preset)},
    {"--opacity", 0, "FILE|S:A,…|linear|geom|sigmoid", "attenuation per unit distance", TC_OPTION_TEXT, AT(opacity)},
    {"--range", 0, "LO,HI", "scalars that the functions span; default the field's range", TC_OPTION_REALS, AT(range), HAS(has_range), .n = 2},
    {"--log", 0, NULL, "lay the map of --color-map over the logarithm of the scalar", TC_OPTION_FLAG, AT(log)},
    {"--unit-distance", 0, "U", "length over which opacity acts; default bounds diagonal / cbrt(cells)", TC_OPTION_REAL, AT(unit_distance), .low = 0, .high = 1e300, .open = true},
    {.help = "Where"},
    {"--gl", 0, "auto|osmesa|egl", "how to get an OpenGL context", TC_OPTION_CHOICE, AT(gl_choice), .choice = tc_gl_choice},
    TC_INPUT_THREADS_ROW(tc_study_command, source),
    {"--seed", 0, "S", "of the pixels of --verify and of synthetic datasets; default 1", TC_OPTION_U64, AT(seed)},
};
/* clang-format on */

/* -------------------------------------------------------------------------------------------------------- asked */

static int tc_study_functions_add(tc_study_names *out, const char *name, size_t length, tc_talk *talk)
{
    size_t n;
    const tc_standard_function *standard = tc_transfer_standard_list(&n);
    for (size_t i = 0; i < n; i++) {
        if (strlen(standard[i].name) != length || memcmp(standard[i].name, name, length) != 0)
            continue;
        for (int k = 0; k < out->n; k++)
            if (!strcmp(out->name[k], standard[i].name))
                return -1;
        out->name[out->n++] = standard[i].name;
        return -1;
    }
    tc_talk_error(talk, "--functions takes smooth, knots12, spike and steps, not '%.*s'", (int)length, name);
    return TC_EXIT_USAGE;
}

static int tc_study_functions(tc_study_names *out, const tc_study_command *options, tc_talk *talk)
{
    size_t n;
    const tc_standard_function *standard = tc_transfer_standard_list(&n);
    bool given = options->color_map || options->opacity;
    int code = -1;
    out->n = 0;
    if (given)
        out->name[out->n++] = tc_standard_given;
    for (size_t i = 0; i < n && !given && !options->functions; i++)
        out->name[out->n++] = standard[i].name;
    for (const char *at = options->functions; at && code < 0;) {
        size_t length = strcspn(at, ",");
        code = tc_study_functions_add(out, at, length, talk);
        at = at[length] ? at + length + 1 : NULL;
    }
    return code;
}

static int tc_study_read(tc_study_command *out, tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    int n_argument;
    *out = (tc_study_command){.size = {256, 256}, .views = 8, .frames = 5, .seed = 1};
    int code = tc_options_parse(out, &out->input, &n_argument, talk, command, argc, argv);
    if (code >= 0)
        return code;
    out->gl = tc_gl_choice[out->gl_choice].name;
    out->source.seed = out->seed;
    if (n_argument == 0)
        out->input = NULL;
    if (!out->folder && out->input) {
        char stem[480];
        tc_input_stem(stem, sizeof stem, out->input);
        snprintf(out->default_folder, sizeof out->default_folder, "%s-study", stem);
        out->folder = out->default_folder;
    } else if (!out->folder) {
        out->folder = "study";
    }
    if (out->has_range && !(out->range[0] < out->range[1])) {
        tc_talk_error(talk, "--range takes LO,HI with LO below HI, not %g,%g", out->range[0], out->range[1]);
        return TC_EXIT_USAGE;
    }
    if (out->preset && !out->color_map) {
        tc_talk_error(talk, "--preset names a map of a file: give the file with --color-map");
        return TC_EXIT_USAGE;
    }
    if (out->log && !out->color_map && !out->opacity) {
        tc_talk_error(talk, "--log lays a map of --color-map or --opacity over a logarithm: give one of them");
        return TC_EXIT_USAGE;
    }
    return tc_input_check(&out->source, talk);
}

static void tc_study_list_text(void)
{
    size_t n;
    const tc_study_setting *setting = tc_study_settings(&n);
    printf("%-11s %-17s %s\n", "KNOB", "SETTING", "WHAT");
    for (size_t i = 0; i < n; i++)
        printf("%-11s %-17s %s\n", setting[i].knob, setting[i].name, setting[i].what);
    const tc_standard_function *function = tc_transfer_standard_list(&n);
    printf("\n%-11s %s\n", "FUNCTION", "WHAT");
    for (size_t i = 0; i < n; i++)
        printf("%-11s %s\n", function[i].name, function[i].what);
}

static int tc_study_list_json(tc_talk *talk)
{
    size_t n;
    json_t *root = json_object(), *settings = json_array(), *functions = json_array();
    const tc_study_setting *setting = tc_study_settings(&n);
    for (size_t i = 0; i < n; i++)
        json_array_append_new(settings, json_pack("{s:s, s:s, s:s}", "knob", setting[i].knob, "name", setting[i].name,
                                                  "what", setting[i].what));
    const tc_standard_function *function = tc_transfer_standard_list(&n);
    for (size_t i = 0; i < n; i++)
        json_array_append_new(functions, json_pack("{s:s, s:s}", "name", function[i].name, "what", function[i].what));
    json_object_set_new(root, "settings", settings);
    json_object_set_new(root, "functions", functions);
    int code = tc_json_write(root, "-", talk);
    json_decref(root);
    return code < 0 ? TC_EXIT_DONE : code;
}

/* ------------------------------------------------------------------------------------------------------- the run */

/* What rows are told to. */
typedef struct tc_study_seen {
    tc_talk *talk;
    int64_t lost; /* rays, by settings that must not lose any */
} tc_study_seen;

static bool tc_study_row_seen(void *user, const tc_study_row *row)
{
    tc_study_seen *seen = user;
    tc_talk *talk = seen->talk;
    if (row->note[0] && strcmp(row->setting, "planes") != 0)
        tc_talk_detail(talk, "%s, %s, view %d, %s: %s", row->scene, row->function, row->view, row->setting, row->note);
    if (row->rays_lost > 0 && strcmp(row->setting, "planes") != 0)
        seen->lost += row->rays_lost;
    if (row->rays_lost > 0 && strcmp(row->setting, "planes") != 0)
        tc_talk_detail(talk, "%s, %s, view %d: %lld rays were lost by the setting %s", row->scene, row->function,
                       row->view, (long long)row->rays_lost, row->setting);
    return true;
}

/* Size and time of a file, so that results of what it held before are not taken for its own. */
static void tc_study_put_file(FILE *stream, const char *path)
{
    struct stat file;
    if (path && stat(path, &file) == 0)
        fprintf(stream, "file %lld %lld.%09ld\n", (long long)file.st_size, (long long)file.st_mtim.tv_sec,
                file.st_mtim.tv_nsec);
}

/* What the results depend on besides the study's own options. */
static int tc_study_request(char **out, const tc_study_command *o, tc_talk *talk)
{
    char *real = o->input && strncmp(o->input, "synth:", 6) ? realpath(o->input, NULL) : NULL;
    size_t size = 0;
    FILE *stream = open_memstream(out, &size);
    if (!stream) {
        free(real);
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    const tc_input_options *s = &o->source;
    tc_study_put_file(stream, real);
    tc_study_put_file(stream, o->color_map);
    tc_study_put_file(stream, o->opacity);
    fprintf(stream, "input %s\nfield %s\nassociation %s\n",
            real       ? real
            : o->input ? o->input
                       : "built-in",
            s->field ? s->field : "",
            s->cell_data    ? "cell"
            : s->point_data ? "point"
                            : "");
    if (s->has_time)
        fprintf(stream, "time %.17g\n", s->time);
    if (s->has_step)
        fprintf(stream, "step %d\n", s->step);
    fprintf(stream, "refine %d\nreentry %s\n", s->refine, tc_reentry_name((tc_reentry)s->reentry));
    if (o->has_range)
        fprintf(stream, "range %.17g,%.17g\n", o->range[0], o->range[1]);
    if (o->color_map || o->opacity)
        fprintf(stream, "color map %s\npreset %s\nopacity %s\nlog %d\n", o->color_map ? o->color_map : "",
                o->preset ? o->preset : "", o->opacity ? o->opacity : "", o->log);
    free(real);
    if (fclose(stream) != 0) {
        tc_talk_error(talk, "memory ran out");
        return TC_EXIT_FAILED;
    }
    return -1;
}

static int tc_study_transfer(tc_transfer **out, const char *name, const tc_study_command *o, const tc_mesh *mesh,
                             tc_talk *talk)
{
    tc_error err = {0};
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    double range[2] = {report.scalar_range[0], report.scalar_range[1]};
    if (o->has_range)
        memcpy(range, o->range, sizeof range);
    if (strcmp(name, tc_standard_given) != 0) {
        tc_status status = tc_transfer_standard(out, name, range, &err);
        return status ? tc_talk_status(talk, status, &err) : -1;
    }
    const tc_transfer_options make = {.color_map = o->color_map,
                                      .preset = o->preset,
                                      .opacity = o->opacity,
                                      .has_range = o->has_range,
                                      .range = {range[0], range[1]},
                                      .data_range = {report.scalar_range[0], report.scalar_range[1]},
                                      .log = o->log};
    tc_status status = tc_transfer_create(out, &make, &err);
    return status ? tc_talk_status(talk, status, &err) : -1;
}

/* One input with every function; not even read where all is measured. */
static int tc_study_input(tc_study *study, const char *input, const tc_study_command *options,
                          const tc_study_names *functions, tc_talk *talk)
{
    char scene[480];
    tc_input_seen seen;
    tc_mesh *mesh = NULL;
    int code = -1;
    bool missing = false;
    tc_input_stem(scene, sizeof scene, input);
    for (int f = 0; f < functions->n; f++)
        missing = missing || !tc_study_has(study, scene, functions->name[f]);
    if (missing)
        code = tc_input_open(&mesh, &seen, &options->source, input, talk);
    for (int f = 0; missing && f < functions->n && code < 0; f++) {
        tc_error err = {0};
        tc_transfer *tf = NULL;
        code = tc_study_transfer(&tf, functions->name[f], options, mesh, talk);
        if (code < 0) {
            tc_status status = tc_study_scene(study, scene, mesh, functions->name[f], tf, &err);
            code = status ? tc_talk_status(talk, status, &err) : -1;
        }
        tc_transfer_destroy(&tf);
    }
    tc_mesh_destroy(&mesh);
    return code;
}

static int tc_study_write(tc_study *study, const tc_study_command *options, tc_talk *talk)
{
    tc_error err = {0};
    size_t n = 0;
    tc_status status = tc_study_report(study, &n, &err);
    if (status)
        return tc_talk_status(talk, status, &err);
    int drawn = 0;
    if (!options->no_plots)
        for (size_t i = 0; i < n && drawn == (int)i; i++)
            drawn += tc_gnuplot_run(options->folder, tc_study_plot(study, i), talk);
    tc_talk_say(talk, "wrote %s: results.csv, summary.csv, study.json, %d of %zu plots", options->folder, drawn, n);
    return -1;
}

static int tc_study_do(const tc_study_command *options, const tc_study_names *functions, char *request, tc_talk *talk)
{
    tc_error err = {0};
    tc_study *study = NULL;
    tc_study_seen seen = {talk, 0};
    size_t n_input = options->input ? 1 : sizeof tc_study_builtin / sizeof *tc_study_builtin;
    const tc_study_options open = {.folder = options->folder,
                                   .restart = options->restart,
                                   .request = request,
                                   .knobs = options->knobs,
                                   .width = options->size.width,
                                   .height = options->size.height,
                                   .views = options->views,
                                   .frames = options->frames,
                                   .verify = (size_t)options->verify,
                                   .seed = options->seed,
                                   .unit_distance = options->unit_distance,
                                   .gl = options->gl,
                                   .threads = options->source.threads,
                                   .n_scene = (int)n_input * functions->n,
                                   .row = tc_study_row_seen,
                                   .user = &seen};
    tc_status status = tc_study_open(&study, &open, &talk->log, &err);
    int code = status ? tc_talk_status(talk, status, &err) : -1;
    for (size_t i = 0; i < n_input && code < 0; i++)
        code = tc_study_input(study, options->input ? options->input : tc_study_builtin[i], options, functions, talk);
    if (code < 0)
        code = tc_study_write(study, options, talk);
    if (code < 0 && seen.lost > 0) {
        tc_talk_error(talk,
                      "%lld rays were lost by other settings than planes (%s/results.csv says where); please report it",
                      (long long)seen.lost, options->folder);
        code = TC_EXIT_FAILED;
    }
    tc_study_close(&study);
    return code;
}

static int tc_study_run(tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    tc_study_command options;
    tc_study_names functions = {0};
    char *request = NULL;
    int code = tc_study_read(&options, talk, command, argc, argv);
    if (code >= 0)
        return code;
    if (options.json && options.list)
        return tc_study_list_json(talk);
    if (options.list) {
        tc_study_list_text();
        return TC_EXIT_DONE;
    }
    code = tc_study_functions(&functions, &options, talk);
    if (code < 0)
        code = tc_study_request(&request, &options, talk);
    if (code < 0)
        code = tc_study_do(&options, &functions, request, talk);
    free(request);
    return code < 0 ? TC_EXIT_DONE : code;
}

const tc_command tc_command_study = {
    .name = "study",
    .arguments = "[INPUT]",
    .what = "Accuracy against time, knob by knob.",
    .about =
        "Renders INPUT (a file or synth:NAME[:CELLS]; without one, four synthetic datasets) from several directions "
        "under every setting of every knob, times it, compares every pixel with the double-precision reference, and "
        "writes tables and plots.",
    .option = tc_study_option,
    .n_option = sizeof tc_study_option / sizeof *tc_study_option,
    .least = 0,
    .most = 1,
    .run = tc_study_run,
};
