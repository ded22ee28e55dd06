/* render_options.c: the options of `render` as one table, and the checks that need no mesh. */
#include "cli/picture/render_options.h"
#include "cli/commands.h"
#include "cli/picture/bands_size.h"
#include "cli/picture/stereo_options.h"
#include "cli/json_out.h"
#include "cli/picture/numbers.h"
#include "cli/scene/paraview.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#define TC_SIZE_MAX 32768
#define TC_PIXELS_MAX (1 << 30)
#define AT(member) .at = offsetof(tc_render_command, member)
#define HAS(member) .has = offsetof(tc_render_command, member) + 1

static const tc_choice tc_integrator_choice[] = {
    {"auto", TC_INTEGRATOR_AUTO, false},
    {"table", TC_INTEGRATOR_TABLE, false},
    {"integral", TC_INTEGRATOR_INTEGRAL, false},
    {"exact", TC_INTEGRATOR_EXACT, false},
    {NULL, 0, false},
};
static const tc_choice tc_samples_choice[] = {
    {"1", 1, false}, {"4", 4, false}, {"16", 16, false}, {"adaptive", TC_SAMPLES_ADAPTIVE, false}, {NULL, 0, false},
};
static const tc_choice tc_state_choice[] = {
    {"auto", TC_STATE_AUTO, false}, {"16f", TC_STATE_16F, false}, {"32f", TC_STATE_32F, false}, {NULL, 0, false},
};
static const tc_choice tc_format_choice[] = {
    {"auto", TC_TABLE_AUTO, false}, {"8", TC_TABLE_8, false}, {"16f", TC_TABLE_16F, false},
    {"32f", TC_TABLE_32F, false},   {NULL, 0, false},
};
static const tc_choice tc_gl_choice[] = {
    {"auto", 0, false},
    {"osmesa", 1, false},
    {"egl", 2, false},
    {NULL, 0, false},
};
static const tc_choice tc_driver_choice[] = {
    {"auto", 0, false}, {"pingpong", 1, false}, {"compute", 2, false}, {"reference", 3, false}, {NULL, 0, false},
};
static const tc_choice tc_stepper_choice[] = {
    {"signs", TC_STEPPER_SIGNS, false},
    {"planes", TC_STEPPER_PLANES, false},
    {NULL, 0, false},
};
static const tc_choice tc_auto_choice[] = {
    {"auto", 0, false},
    {NULL, 0, false},
};
static const tc_choice tc_lock_choice[] = {
    {"auto", 0, false},
    {"never", -1, false},
    {NULL, 0, false},
};

bool tc_size_parse(void *field, const char *text, char *why)
{
    int width, height;
    char rest;
    if (strspn(text, "0123456789x") != strlen(text) || sscanf(text, "%6dx%6d%c", &width, &height, &rest) != 2)
        return false;
    if (width < 1 || height < 1 || width > TC_SIZE_MAX || height > TC_SIZE_MAX) {
        snprintf(why, 64, "each from 1 to %d", TC_SIZE_MAX);
        return false;
    }
    if ((long long)width * height > TC_PIXELS_MAX) {
        snprintf(why, 64, "at most %d pixels in all", TC_PIXELS_MAX);
        return false;
    }
    *(tc_size *)field = (tc_size){width, height};
    return true;
}

/* --time T or --time Tms; field is the whole tc_render_command. */
static bool tc_time_parse(void *field, const char *text, char *why)
{
    tc_render_command *out = field;
    size_t length = strlen(text);
    char number[64];
    double value;
    bool budget = length > 2 && !strcmp(text + length - 2, "ms");
    if (length >= sizeof number)
        return false;
    snprintf(number, sizeof number, "%.*s", (int)(budget ? length - 2 : length), text);
    if (!tc_parse_real(&value, number))
        return false;
    if (budget && !(value > 0)) {
        snprintf(why, 64, "milliseconds above 0");
        return false;
    }
    if (budget) {
        out->frame_time = value;
    } else {
        out->source.time = value;
        out->source.has_time = true;
    }
    return true;
}

/* --step N or --step FROM:TO; field is the whole tc_render_command. */
static bool tc_step_parse(void *field, const char *text, char *why)
{
    tc_render_command *out = field;
    if (!strchr(text, ':')) {
        out->steps.there = false;
        out->source.has_step = tc_parse_int(&out->source.step, text);
        return out->source.has_step;
    }
    if (!tc_step_range_parse(&out->steps, text, why))
        return false;
    out->source.has_step = true;
    out->source.step = out->steps.has_from ? out->steps.from : 0;
    return true;
}

static bool tc_background_parse(void *field, const char *text, char *why)
{
    double value[4] = {0, 0, 0, 1};
    int n = 0;
    tc_background out = {.there = strcmp(text, "transparent") != 0};
    if (out.there) {
        if (!tc_parse_reals(value, &n, 4, text) || n < 3)
            return false;
        for (int i = 0; i < n; i++)
            if (value[i] < 0 || value[i] > 1) {
                snprintf(why, 64, "each from 0 to 1");
                return false;
            }
        for (int i = 0; i < 3; i++)
            out.rgba[i] = (float)(value[i] * value[3]);
        out.rgba[3] = (float)value[3];
    }
    *(tc_background *)field = out;
    return true;
}

static bool tc_nan_color_parse(void *field, const char *text, char *why)
{
    tc_nan_color out = {.there = true, .rgba = {0, 0, 0, 1}};
    int n = 0;
    if (!tc_parse_reals(out.rgba, &n, 4, text) || n < 3)
        return false;
    for (int i = 0; i < n; i++)
        if (out.rgba[i] < 0 || (i < 3 && out.rgba[i] > 1)) {
            snprintf(why, 64, "R, G and B each from 0 to 1, A not below 0");
            return false;
        }
    *(tc_nan_color *)field = out;
    return true;
}

static bool tc_table_size_parse(void *field, const char *text, char *why)
{
    int size[3];
    char rest;
    if (strspn(text, "0123456789,") != strlen(text) ||
        sscanf(text, "%6d,%6d,%6d%c", &size[0], &size[1], &size[2], &rest) != 3)
        return false;
    for (int i = 0; i < 3; i++)
        if (size[i] < 2 || size[i] > 1024) {
            snprintf(why, 64, "each from 2 to 1024");
            return false;
        }
    memcpy(field, size, sizeof size);
    return true;
}

/* clang-format off */
const tc_option tc_render_option[TC_N_RENDER_OPTION] = {
    {.help = "Data"},
    TC_INPUT_ARRAY_ROWS(tc_render_command, source),
    {"--time", 0, "T", "the step at or before this time; a number that ends in ms is --frame-time", TC_OPTION_CUSTOM, .at = 0, .parse = tc_time_parse},
    {"--step", 0, "N|FROM:TO[:STRIDE]", "the step by number, from 0; negative counts from the end; FROM:TO: a picture of each, both ends too, either may be left out", TC_OPTION_CUSTOM, .at = 0, .parse = tc_step_parse},
    TC_INPUT_READER_ROWS(tc_render_command, source),
    TC_INPUT_GAP_ROW(tc_render_command, source),
    TC_INPUT_CACHE_ROWS(tc_render_command, source),
    {"--paraview", 0, "FILE", "camera, field, transfer function, size and background from a ParaView state (.pvsm), or a camera file (.pvcc); other options stand before it", TC_OPTION_TEXT, AT(paraview)},
    {.help = "Picture"},
    {"--output", 'o', "FILE", "png, exr, tif or jpg by extension; - for PNG on stdout; default INPUT's name + .png, here; several steps: {step:04d} or {time:.3f} in it, else _0012 before the extension", TC_OPTION_TEXT, AT(output)},
    {"--size", 0, "WxH", "pixels, up to 32768x32768; default 512x512", TC_OPTION_CUSTOM, AT(size), .parse = tc_size_parse},
    {"--background", 0, "R,G,B[,A]|transparent", "0 to 1 each; default transparent", TC_OPTION_CUSTOM, AT(background), .parse = tc_background_parse},
    TC_OUTPUT_ROWS(tc_render_command, out),
    {.help = "Camera (default: the whole mesh in view from +z)"},
    {"--camera-position", 0, "X,Y,Z", "the eye", TC_OPTION_REALS, AT(position), HAS(has_position), .n = 3},
    {"--focal-point", 0, "X,Y,Z", "where it looks; default the mesh's centre", TC_OPTION_REALS, AT(focal_point), HAS(has_focal_point), .n = 3},
    {"--view-up", 0, "X,Y,Z", "what is up; default 0,1,0", TC_OPTION_REALS, AT(view_up), HAS(has_view_up), .n = 3},
    {"--view-angle", 0, "DEG", "vertical opening; default 30", TC_OPTION_REAL, AT(view_angle), .low = 0, .high = 179.999, .open = true},
    {"--parallel", 0, NULL, "parallel projection, the whole mesh in view", TC_OPTION_FLAG, AT(parallel)},
    {"--parallel-scale", 0, "S", "parallel projection; half the view's height in the mesh's unit", TC_OPTION_REAL, AT(parallel_scale), HAS(has_parallel_scale), .low = 0, .high = 1e300, .open = true},
    {"--azimuth", 0, "DEG", "then turn the eye about the view-up", TC_OPTION_REAL, AT(azimuth)},
    {"--elevation", 0, "DEG", "then raise the eye", TC_OPTION_REAL, AT(elevation)},
    {"--roll", 0, "DEG", "then turn about the view direction", TC_OPTION_REAL, AT(roll)},
    {"--zoom", 0, "F", "then divide the view angle or scale; default 1", TC_OPTION_REAL, AT(zoom), .low = 0, .high = 1e300, .open = true},
    {"--clipping-range", 0, "NEAR,FAR", "show only what lies between these distances from the eye, along the view", TC_OPTION_REALS, AT(clipping_range), HAS(has_clipping_range), .n = 2},
    {"--window-center", 0, "X,Y", "show in the middle what is so many half widths right of and half heights above where it looks; default 0,0", TC_OPTION_REALS, AT(window_center), .n = 2},
    {.help = "Transfer function"},
    {"--color-map", 0, "NAME|FILE", "a built-in map, a ParaView preset (.json, .xml), or the text of one; default Cool to Warm", TC_OPTION_TEXT, AT(color_map)},
    {"--preset", 0, "NAME", "which map of a file that holds several; default the first", TC_OPTION_TEXT, AT(preset)},
    {"--opacity", 0, "FILE|S:A,…|linear|geom|sigmoid", "attenuation per unit distance; default the preset's own, else linear from 0 to 0.3", TC_OPTION_TEXT, AT(opacity)},
    {"--range", 0, "LO,HI", "scalars that the map spans; default the field's range", TC_OPTION_REALS, AT(range), HAS(has_range), .n = 2},
    {"--unit-distance", 0, "U", "length over which opacity acts; default bounds diagonal / cbrt(cells)", TC_OPTION_REAL, AT(unit_distance), .low = 0, .high = 1e300, .open = true},
    {"--nan-color", 0, "R,G,B[,A]", "show cells with a value that is not finite, with attenuation A (1) per unit distance", TC_OPTION_CUSTOM, AT(nan_color), .parse = tc_nan_color_parse},
    {"--log", 0, NULL, "lay the map over the logarithm of the scalar", TC_OPTION_FLAG, AT(log)},
    {.kind = TC_OPTION_ALSO},
    {.help = "Method"},
    {"--integrator", 0, "auto|table|integral|exact", "pre-integrated table of the 2003 paper, running integrals, or piece by piece of the function", TC_OPTION_CHOICE, AT(integrator), .choice = tc_integrator_choice},
    {"--table-size", 0, "S,S,L", "of the table: front and back scalar, length; default 128,128,256", TC_OPTION_CUSTOM, AT(table_size), .parse = tc_table_size_parse},
    {"--table-format", 0, "auto|8|16f|32f", "bits a channel of the table", TC_OPTION_CHOICE, AT(table_format), .choice = tc_format_choice},
    {"--integral-order", 0, "auto|1|2", "running integrals: one colour a segment, or with its drift", TC_OPTION_INT, AT(integral_order), .low = 1, .high = 2, .choice = tc_auto_choice},
    {"--integral-split", 0, "T|auto", "running integrals: cut segments to this optical depth", TC_OPTION_REAL, AT(integral_split), .low = 0, .high = 1e9, .open = true, .choice = tc_auto_choice},
    {"--opacity-stop", 0, "A", "end a ray at this opacity; 1: never; default 0.999, with --integrator exact 0.9999", TC_OPTION_REAL, AT(opacity_stop), .low = 0, .high = 1, .open = true},
    {"--samples", 0, "1|4|16|adaptive", "rays a pixel; adaptive: 4, and 16 where these differ", TC_OPTION_CHOICE, AT(samples), .choice = tc_samples_choice},
    {"--state-format", 0, "auto|16f|32f", "bits a channel of what rays carry from pass to pass", TC_OPTION_CHOICE, AT(state_format), .choice = tc_state_choice},
    {"--gl", 0, "auto|osmesa|egl", "how to get an OpenGL context", TC_OPTION_CHOICE, AT(gl_choice), .choice = tc_gl_choice},
    {"--driver", 0, "auto|pingpong|compute|reference", "multi-pass fragment shader, compute shader, or double precision on the CPU", TC_OPTION_CHOICE, AT(driver_choice), .choice = tc_driver_choice},
    {"--stepper", 0, "signs|planes", "how a ray leaves a cell: exact signs, or, to compare, the paper's plane equations, which lose rays", TC_OPTION_CHOICE, AT(stepper), .choice = tc_stepper_choice},
    {"--steps-per-pass", 0, "K|auto", "cells a ray crosses in one pass", TC_OPTION_INT, AT(steps_per_pass), .low = 1, .high = 65536, .choice = tc_auto_choice},
    {"--z-update-every", 0, "N|auto|never", "passes between locks of finished rays by the depth test", TC_OPTION_INT, AT(z_update_every), .low = 1, .high = 65536, .choice = tc_lock_choice},
    TC_INPUT_THREADS_ROW(tc_render_command, source),
    {.help = "Accuracy or time instead of knobs"},
    {"--error", 0, "E", "the cheapest setting whose error stays below E, of 1; measured for this mesh and function, and checked in the picture", TC_OPTION_REAL, AT(error), .low = 0, .high = 1, .open = true},
    {"--frame-time", 0, "MS", "the most accurate setting that makes a frame within so many milliseconds", TC_OPTION_REAL, AT(frame_time), .low = 0, .high = 1e9, .open = true},
    {"--no-cache", 0, NULL, "for --error and --frame-time: measure anew, keep nothing", TC_OPTION_FLAG, AT(no_cache)},
    {.help = "Measuring"},
    {"--verify", 0, "N", "trace N pixels again in double precision and report the error", TC_OPTION_U64, AT(verify), HAS(has_verify), .low = 1, .high = 1e18},
    {"--error-image", 0, "FILE", "write the error of each pixel; of all, unless --verify says how many; .exr and .tif: as floats", TC_OPTION_TEXT, AT(error_image)},
    {"--repeat", 0, "N", "render N frames after one to warm up; times are medians", TC_OPTION_INT, AT(repeat), HAS(has_repeat), .low = 1, .high = 1000000},
    {"--count", 0, NULL, "count steps and fragments in one extra frame; on with --stats and --verify", TC_OPTION_FLAG, AT(count)},
    {"--audit", 0, NULL, "let the walk check itself in the counted frame: exactly two faces of a visited cell hold the ray", TC_OPTION_FLAG, AT(audit)},
    {"--stats", 0, "FILE", "write what was measured as JSON; - for stdout", TC_OPTION_TEXT, AT(stats)},
    {"--seed", 0, "S", "of the pixels of --verify and of synthetic datasets; default 1", TC_OPTION_U64, AT(seed)},
    {"--shell", .kind = TC_OPTION_LATER},
};
/* clang-format on */
_Static_assert(sizeof tc_render_option == TC_N_RENDER_OPTION * sizeof *tc_render_option, "rows of the table");

const tc_command tc_command_render = {
    .name = "render",
    .arguments = "INPUT",
    .what = "One image of a mesh.",
    .about = "INPUT is a file with three-dimensional cells (VTK, Exodus II, EnSight, OpenFOAM, CGNS, PLOT3D and more), "
             "or synth:NAME[:CELLS], a synthetic dataset (tetcast synth --list); or a scene file (.json), whose keys are "
             "these options; or a picture that tetcast render wrote, to make it again. Options given here come first; "
             "--FLAG=off turns one off that a scene has on.",
    .option = tc_render_option,
    .n_option = TC_N_RENDER_OPTION,
    .also = tc_look_option,
    .n_also = TC_N_LOOK_OPTION,
    .also_at = offsetof(tc_render_command, look),
    .given = offsetof(tc_render_command, given) + 1,
    .least = 1,
    .most = 1,
    .run = tc_render_run_command,
};

/* ------------------------------------------------------------------------------------------------------- checks */

bool tc_choice_asked(const tc_render_command *options)
{
    return options->error > 0 || options->frame_time > 0;
}

int tc_output_kind_check(const char *path, tc_talk *talk)
{
    static const char *const known[] = {".png", ".exr", ".tif", ".tiff", ".jpg", ".jpeg"};
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    if (!strcmp(path, "-"))
        return -1;
    if (dot && (!slash || dot > slash))
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            if (!strcasecmp(dot, known[i]))
                return -1;
    tc_talk_error(talk, "%s: the extension tells the format; use .png, .exr, .tif or .jpg", path);
    return TC_EXIT_USAGE;
}

/* Ends what a scene was to be blamed for: its wrong value is failed work. Gives the exit code. */
static int tc_blame_end(int code, tc_talk *talk)
{
    const bool failed = talk->from && code == TC_EXIT_USAGE;
    talk->from = NULL;
    return failed ? TC_EXIT_FAILED : code;
}

static bool tc_is_output(const char *option)
{
    return !strcmp(option, "--output") || !strcmp(option, "--error-image") || !strcmp(option, "--stats");
}

static bool tc_equal3(const double *a, const double *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

bool tc_same_file(const char *a, const char *b)
{
    struct stat x, y;
    if (!strcmp(a, "-") || !strcmp(b, "-"))
        return false;
    if (stat(a, &x) == 0 && stat(b, &y) == 0)
        return S_ISREG(x.st_mode) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
    return !strcmp(a, b);
}

static int tc_refuse_output(const tc_given_list *given, const char *option, const char *path, const char *read,
                            tc_talk *talk)
{
    return tc_given_refuse(given, talk, option, read,
                           "%s is the file of %s and would be written over: give %s another name", path, read, option);
}

/* Is none of the files that other options name the one to be written? */
static int tc_output_read_check(const char *option, const char *path, const tc_render_command *out, tc_talk *talk)
{
    size_t n_key;
    const tc_scene_key *key = tc_scene_keys(&n_key);
    for (size_t i = 0; i < out->given.n; i++) {
        const tc_given *given = &out->given.item[i];
        for (size_t k = 0; k < n_key; k++) {
            if (!key[k].option || strcmp(key[k].option, given->option->name) != 0)
                continue;
            const bool other = key[k].path == TC_PATH_FILE && !tc_is_output(key[k].option);
            if ((other || (key[k].path == TC_PATH_MAYBE && tc_names_file(given->text))) && tc_same_file(given->text, path))
                return tc_refuse_output(&out->given, option, path, key[k].option, talk);
        }
    }
    for (int i = 0; i < out->look.geometry.n; i++) {
        char *read = tc_part_text(&out->look.geometry.file[i].file);
        const bool same = read && tc_same_file(read, path);
        free(read);
        if (same)
            return tc_refuse_output(&out->given, option, path, "--geometry", talk);
    }
    return -1;
}

/* The files to be written: each its own, none the input or another that is read, pictures with a known extension, in
 * folders that are there. */
static int tc_outputs_check(const tc_render_command *out, tc_talk *talk)
{
    const struct {
        const char *option, *path;
        bool picture;
    } file[] = {
        {"--output", out->output, true}, {"--error-image", out->error_image, true}, {"--stats", out->stats, false}};
    enum { N = sizeof file / sizeof *file };
    talk->from = NULL; /* each says by itself where it is from */
    for (int i = 0; i < N; i++)
        for (int j = 0; j < i && file[i].path; j++) {
            if (!file[j].path)
                continue;
            if (!strcmp(file[i].path, "-") && !strcmp(file[j].path, "-"))
                return tc_given_refuse(&out->given, talk, file[i].option, file[j].option,
                                       "%s - and %s - both want stdout: give one of them a file", file[j].option,
                                       file[i].option);
            if (tc_same_file(file[i].path, file[j].path))
                return tc_given_refuse(&out->given, talk, file[i].option, file[j].option,
                                       "%s and %s are one file, %s: give each its own", file[j].option, file[i].option,
                                       file[j].path);
        }
    for (int i = 0; i < N && out->steps.there; i++) {
        char name[8192], why[256];
        if (!file[i].path || !file[i].picture)
            continue;
        if (!strcmp(file[i].path, "-"))
            return tc_given_refuse(&out->given, talk, file[i].option, "--step",
                                   "%s - takes one picture, --step FROM:TO makes several: give a name", file[i].option);
        if (!tc_step_name(name, sizeof name, file[i].path, 0, 0, why, sizeof why))
            return tc_given_refuse(&out->given, talk, file[i].option, NULL, "%s %s: %s", file[i].option, file[i].path,
                                   why);
    }
    for (int i = 0; i < 2 * N; i++) {
        const char *input = i < N ? out->input : out->scene_path, *path = file[i % N].path;
        if (input && path && tc_same_file(input, path))
            return tc_given_refuse(&out->given, talk, file[i % N].option, NULL,
                                   "%s is the input and would be written over: give %s another name", input,
                                   file[i % N].option);
    }
    int code = -1;
    for (int i = 0; i < N && code < 0; i++)
        if (file[i].path)
            code = tc_output_read_check(file[i].option, file[i].path, out, talk);
    for (int i = 0; i < N && code < 0; i++) {
        talk->from = tc_scene_place(&out->given, file[i].option);
        if (file[i].path && file[i].picture)
            code = tc_output_kind_check(file[i].path, talk);
        char why[160] = "";
        if (code < 0 && i == 0 && file[i].path)
            tc_output_wrong(why, &out->out, file[i].path);
        if (*why) {
            tc_talk_error(talk, "%s: %s", file[i].path, why);
            code = TC_EXIT_USAGE;
        }
        if (code < 0 && file[i].path && !(out->steps.there && file[i].picture)) /* names of steps: render_sequence.c */
            code = i == 0 ? tc_stereo_output_check(out, talk) : tc_output_check(file[i].path, talk);
        code = tc_blame_end(code, talk);
    }
    return code;
}

static int tc_render_check(const tc_render_command *out, tc_talk *talk)
{
    static const double zero[3];
    const tc_given_list *given = &out->given;
    if (!tc_is_of_line(given, "--cell-data") && !tc_is_of_line(given, "--point-data"))
        talk->from = out->scene_path;
    int code = tc_blame_end(tc_input_check(&out->source, talk), talk);
    if (code >= 0)
        return code;
    if (out->has_range && !(out->range[0] < out->range[1]))
        return tc_given_refuse(given, talk, "--range", NULL, "--range takes LO,HI with LO below HI, not %g,%g",
                               out->range[0], out->range[1]);
    const double *clip = out->clipping_range;
    if (out->has_clipping_range && !(clip[0] >= 0 && clip[0] < clip[1]))
        return tc_given_refuse(given, talk, "--clipping-range", NULL,
                               "--clipping-range takes NEAR,FAR with NEAR not below 0 and FAR beyond NEAR, not %g,%g",
                               clip[0], clip[1]);
    if (out->has_view_up && tc_equal3(out->view_up, zero))
        return tc_given_refuse(given, talk, "--view-up", NULL, "--view-up takes a direction, not 0,0,0");
    if (out->has_position && out->has_focal_point && tc_equal3(out->position, out->focal_point))
        return tc_given_refuse(
            given, talk, "--camera-position", "--focal-point",
            "--camera-position and --focal-point are the same point, so there is no direction to look");
    if (out->stepper == TC_STEPPER_PLANES && !strcmp(out->driver, "reference"))
        return tc_given_refuse(
            given, talk, "--stepper", "--driver",
            "--stepper planes walks from cell to cell, which --driver reference does not: leave one out");
    if (out->stepper == TC_STEPPER_PLANES && tc_choice_asked(out))
        return tc_given_refuse(given, talk, "--stepper", out->error > 0 ? "--error" : "--frame-time",
                               "--stepper planes loses rays, so no error can be promised: leave out %s",
                               out->error > 0 ? "--error" : "--frame-time");
    if (out->stepper == TC_STEPPER_PLANES && out->audit)
        return tc_given_refuse(
            given, talk, "--audit", "--stepper",
            "--audit counts faces that hold the ray, which --stepper planes does not ask: leave one out");
    if (out->audit && out->samples != 1)
        return tc_given_refuse(given, talk, "--audit", "--samples",
                               "--audit is of one ray a pixel: leave it or --samples out");
    if (out->audit && !strcmp(out->driver, "reference"))
        return tc_given_refuse(
            given, talk, "--audit", "--driver",
            "--audit checks the walk from cell to cell, which --driver reference does not do: leave one out");
    const bool reference = !strcmp(out->driver, "reference");
    const char *judge = reference          ? "--driver"
                        : !out->has_verify ? "--error"
                        : out->error_image ? "--error-image"
                                           : "--verify";
    if ((out->look.outline || out->look.wireframe) && (reference || out->has_verify || out->error > 0)) {
        const char *lines = out->look.outline ? "--outline" : "--wireframe";
        return tc_given_refuse(given, talk, judge, lines, "%s%s draws no lines: leave %s out, or that option", judge,
                               reference ? " reference" : ", the reference that is compared with,", lines);
    }
    if ((out->out.depth || out->out.value) && tc_numbers_wrong(out))
        return tc_given_refuse(given, talk, out->out.depth ? "--depth" : "--value", "--model", "%s",
                               tc_numbers_wrong(out));
    if (out->preset && !out->color_map)
        return tc_given_refuse(given, talk, "--preset", NULL,
                               "--preset names a map of a file: give the file with --color-map");
    code = tc_stereo_check(out, talk);
    if (code < 0)
        code = tc_bands_check(out, talk);
    return code < 0 ? tc_look_options_check(&out->look, &out->given, talk) : code;
}

/* --------------------------------------------------------------------------------------------------------- scenes */

static void tc_render_command_defaults(tc_render_command *out)
{
    tc_render_options defaults;
    tc_render_defaults(&defaults);
    *out = (tc_render_command){
        .size = {512, 512},
        .out = {.png_level = -1, .eye_angle = 2},
        .view_up = {0, 1, 0},
        .view_angle = 30,
        .zoom = 1,
        .samples = 1,
        .table_format = (int)defaults.table_format,
        .repeat = 1,
        .seed = 1,
    };
    tc_look_options_defaults(&out->look);
}

/* Does what the command line gives stand for an option of the scene: the same one, or one that it follows from? */
static bool tc_is_overridden(const tc_render_command *line, const tc_scene *scene, const char *name)
{
    static const char *const follows[][2] = {
        {"--field", "--cell-data"},      {"--field", "--point-data"},        {"--field", "--range"},
        {"--cell-data", "--point-data"}, {"--point-data", "--cell-data"},    {"--color-field", "--color-range"},
        {"--color-map", "--preset"},     {"--color-map", "--categories"},    {"--categories", "--color-map"},
        {"--categories", "--preset"},    {"--categories", "--color-range"},  {"--iso", "--iso-color"},
        {"--iso", "--iso-opacity"},      {"--geometry", "--geometry-color"},
    };
    static const char *const of_map[] = {"--opacity", "--range", "--log"};
    if (tc_is_given(&line->given, name))
        return strcmp(name, "--time") != 0 || line->source.has_time;
    if (!strcmp(name, "--parallel-scale") && tc_is_put_off(&line->given, "--parallel"))
        return true;
    if ((!strcmp(name, "--parallel-scale") || !strcmp(name, "--parallel")) && tc_is_given(&line->given, "--view-angle"))
        return true;
    for (size_t i = 0; i < sizeof follows / sizeof *follows; i++)
        if (!strcmp(name, follows[i][1]) && tc_is_given(&line->given, follows[i][0]))
            return true;
    if (!strcmp(name, "--time") || !strcmp(name, "--step"))
        return line->source.has_time || line->source.has_step;
    bool second = line->look.color_field != NULL;
    for (size_t i = 0; i < scene->n; i++)
        second = second || !strcmp(scene->item[i].option->name, "--color-field");
    for (size_t i = 0; i < sizeof of_map / sizeof *of_map; i++)
        if (line->look.categories && !second && !strcmp(name, of_map[i]))
            return true;
    return false;
}

/* Sets a scene's options but those that lie under others: of the command line, or of a scene over this one. */
static int tc_scene_set(tc_render_command *out, const tc_scene *scene, const tc_render_command *over, tc_talk *talk,
                        const tc_command *command)
{
    int code = -1;
    for (size_t i = 0; i < scene->n && code < 0; i++) {
        const tc_scene_item *item = &scene->item[i];
        if (!tc_is_overridden(over, scene, item->option->name))
            code = tc_option_set(out, talk, command, item->option, item->called, item->text);
        if (code >= 0)
            code = TC_EXIT_FAILED; /* it is the file that is wrong */
    }
    return code;
}

/* A ParaView state under out's scene, which has been set: out begins anew with the state's options, then the scene's. */
static int tc_state_under(tc_render_command *out, const char *path, const tc_render_command *line, bool silent,
                          tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    const char *argument;
    int n_argument, code = tc_options_parse(out, &argument, &n_argument, talk, command, argc, argv);
    tc_render_command over = *out;
    tc_render_command_defaults(out);
    out->scene = over.scene;
    if (code < 0)
        code = tc_paraview_options(&out->state, path, !out->scene.data, silent, command, talk);
    if (code < 0)
        code = tc_scene_set(out, &out->state, &over, talk, command);
    if (code < 0)
        code = tc_scene_set(out, &out->scene, line, talk, command);
    tc_given_finish(&over.given);
    return code;
}

/* INPUT is a scene or a ParaView state, or --paraview gives a state: its options, then those of the command line over them.
 * Under a scene lies the state that it or the command line names, under a state that is --paraview's one that is INPUT. */
static int tc_scene_take(tc_render_command *out, const tc_scene_at *at, tc_talk *talk, const tc_command *command,
                         int argc, char **argv)
{
    tc_render_command line = *out;
    const bool is_scene = at || tc_input_is_scene(line.input);
    const bool is_state = !is_scene && tc_input_is_paraview(line.input);
    const bool silent = at && at->again;
    int n_argument, code;
    tc_render_command_defaults(out);
    if (!is_scene)
        code = tc_paraview_options(&out->scene, line.paraview ? line.paraview : line.input, !line.paraview, silent,
                                   command, talk);
    else if (at)
        code = tc_scene_from_json(&out->scene, at->json, at->element, at->text, line.input, at->folder, command, talk);
    else
        code = tc_scene_read(&out->scene, line.input, command, talk);
    if (code < 0)
        code = tc_scene_set(out, &out->scene, &line, talk, command);
    const char *state = is_scene ? (line.paraview ? line.paraview : out->paraview)
                        : is_state && line.paraview ? line.input
                                                    : NULL;
    if (code < 0 && state)
        code = tc_state_under(out, state, &line, silent, talk, command, argc, argv);
    tc_given_finish(&line.given);
    const char *data = out->scene.data ? out->scene.data : out->state.data;
    if (code < 0 && !data && is_scene) {
        tc_talk_error(talk, "%s names no data: add \"data\": \"FILE\"", line.input);
        code = TC_EXIT_FAILED;
    }
    if (code < 0)
        code = tc_options_parse(out, is_scene || is_state ? &out->scene_path : &out->input, &n_argument, talk, command,
                                argc, argv);
    if (is_scene || is_state)
        out->input = data;
    return code;
}

/* The picture's name where none is given: INPUT's, for a picture its data's. */
static void tc_default_output_make(tc_render_command *out)
{
    char stem[480];
    size_t n = 0;
    tc_input_stem(stem, sizeof stem,
                  out->scene_path && !tc_input_is_picture(out->scene_path) ? out->scene_path : out->input);
    for (const char *c = stem; *c && n + 8 < sizeof out->default_output; c++) {
        out->default_output[n++] = *c;
        if (out->steps.there && (*c == '{' || *c == '}')) /* no placeholder */
            out->default_output[n++] = *c;
    }
    snprintf(out->default_output + n, sizeof out->default_output - n, ".png");
    out->output = out->default_output;
}

/* Errors that come later are the scene's, where the command line changes none of its values but those of `output`. */
static void tc_scene_blame(const tc_render_command *out, tc_talk *talk)
{
    size_t n_key;
    const tc_scene_key *key = tc_scene_keys(&n_key);
    talk->from = out->scene_path;
    for (size_t k = 0; k < n_key; k++)
        if (key[k].role == TC_KEY_PICTURE && strcmp(key[k].section, "output") != 0 && tc_is_of_line(&out->given, key[k].option))
            talk->from = NULL;
}

int tc_picture_command_read(tc_render_command *out, tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    return tc_picture_command_take(out, NULL, talk, command, argc, argv);
}

int tc_picture_command_take(tc_render_command *out, const tc_scene_at *at, tc_talk *talk, const tc_command *command,
                            int argc, char **argv)
{
    int n_argument;
    talk->from = NULL;
    tc_render_command_defaults(out);
    int code = tc_options_parse(out, &out->input, &n_argument, talk, command, argc, argv);
    if (code < 0 && (at || out->paraview || tc_input_is_scene(out->input) || tc_input_is_paraview(out->input)))
        code = tc_scene_take(out, at, talk, command, argc, argv);
    if (code >= 0)
        return code;
    out->gl = tc_gl_choice[out->gl_choice].name;
    out->driver = tc_driver_choice[out->driver_choice].name;
    out->source.seed = out->seed;
    if (out->error_image && !out->has_verify) {
        out->has_verify = true;
        out->verify = UINT64_MAX;
    }
    if (out->look.model == TC_MODEL_EMISSION && !tc_is_given(&out->given, "--background"))
        out->background = (tc_background){.there = true, .rgba = {0, 0, 0, 1}}; /* light alone is seen on black */
    out->source.keep_reader = out->look.color_field || out->look.select.n > 0 || out->look.blocks.n > 0;
    code = tc_render_check(out, talk);
    if (code < 0)
        tc_scene_blame(out, talk);
    return code;
}

int tc_render_command_read(tc_render_command *out, tc_talk *talk, const tc_command *command, int argc, char **argv)
{
    int code = tc_picture_command_read(out, talk, command, argc, argv);
    if (code >= 0)
        return code;
    if (!out->output)
        tc_default_output_make(out);
    code = tc_outputs_check(out, talk);
    if (code < 0)
        tc_scene_blame(out, talk);
    return code;
}

void tc_render_command_finish(tc_render_command *command)
{
    tc_given_finish(&command->given);
    tc_scene_finish(&command->scene);
    tc_scene_finish(&command->state);
}
