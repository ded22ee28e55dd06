/* scene_file.c: a scene file is read as options: what a key may be and what its value means is said by the option's
 * row. */
#define _GNU_SOURCE
#include "cli/scene/scene_file.h"
#include "cli/nearest.h"
#include "cli/scene/scene_lines.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

enum { TC_SCENE_BYTES = 16 << 20 };

/* clang-format off */
static const tc_scene_key tc_key[] = {
    {"", "field", "--field", TC_PATH_NONE, TC_KEY_PICTURE},
    {"", "cell_data", "--cell-data", TC_PATH_NONE, TC_KEY_PICTURE},
    {"", "point_data", "--point-data", TC_PATH_NONE, TC_KEY_PICTURE},
    {"", "time", "--time", TC_PATH_NONE, TC_KEY_PICTURE},
    {"", "step", "--step", TC_PATH_NONE, TC_KEY_PICTURE},
    {"", "refine", "--refine", TC_PATH_NONE, TC_KEY_PICTURE},
    {"", "reentry", "--reentry", TC_PATH_NONE, TC_KEY_PICTURE},
    {"", "seed", "--seed", TC_PATH_NONE, TC_KEY_PICTURE},
    {"", "idle_limit", "--idle-limit", TC_PATH_NONE, TC_KEY_RUN},
    {"", "cache", "--cache", TC_PATH_NONE, TC_KEY_RUN},
    {"", "paraview", "--paraview", TC_PATH_FILE, TC_KEY_RUN},
    {"", "cache_file", "--cache-file", TC_PATH_FILE, TC_KEY_RUN},
    {"camera", "position", "--camera-position", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "focal_point", "--focal-point", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "view_up", "--view-up", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "view_angle", "--view-angle", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "parallel", "--parallel", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "parallel_scale", "--parallel-scale", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "azimuth", "--azimuth", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "elevation", "--elevation", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "roll", "--roll", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "zoom", "--zoom", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "clipping_range", "--clipping-range", TC_PATH_NONE, TC_KEY_PICTURE},
    {"camera", "window_center", "--window-center", TC_PATH_NONE, TC_KEY_PICTURE},
    {"transfer_function", "color_map", "--color-map", TC_PATH_MAYBE, TC_KEY_PICTURE},
    {"transfer_function", "preset", "--preset", TC_PATH_NONE, TC_KEY_PICTURE},
    {"transfer_function", "opacity", "--opacity", TC_PATH_MAYBE, TC_KEY_PICTURE},
    {"transfer_function", "range", "--range", TC_PATH_NONE, TC_KEY_PICTURE},
    {"transfer_function", "unit_distance", "--unit-distance", TC_PATH_NONE, TC_KEY_PICTURE},
    {"transfer_function", "nan_color", "--nan-color", TC_PATH_NONE, TC_KEY_PICTURE},
    {"transfer_function", "log", "--log", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "model", "--model", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "iso", "--iso", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "iso_color", "--iso-color", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "iso_opacity", "--iso-opacity", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "color_field", "--color-field", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "color_range", "--color-range", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "categories", "--categories", TC_PATH_MAYBE, TC_KEY_PICTURE},
    {"effects", "shade", "--shade", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "light", "--light", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "ambient", "--ambient", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "diffuse", "--diffuse", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "specular", "--specular", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "specular_power", "--specular-power", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "one_sided", "--one-sided", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "shade_magnitude", "--shade-magnitude", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "clip", "--clip", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "clip_box", "--clip-box", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "select", "--select", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "blocks", "--blocks", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "outline", "--outline", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "wireframe", "--wireframe", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "surface", "--surface", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "geometry", "--geometry", TC_PATH_OPACITY, TC_KEY_PICTURE},
    {"effects", "geometry_color", "--geometry-color", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "line_color", "--line-color", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "surface_color", "--surface-color", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "title", "--title", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "color_bar", "--color-bar", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "color_bar_place", "--color-bar-place", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "color_bar_opacity", "--color-bar-opacity", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "axes", "--axes", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "triad", "--triad", TC_PATH_NONE, TC_KEY_PICTURE},
    {"effects", "text_size", "--text-size", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "integrator", "--integrator", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "table_size", "--table-size", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "table_format", "--table-format", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "integral_order", "--integral-order", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "integral_split", "--integral-split", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "opacity_stop", "--opacity-stop", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "samples", "--samples", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "state_format", "--state-format", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "gl", "--gl", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "driver", "--driver", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "stepper", "--stepper", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "steps_per_pass", "--steps-per-pass", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "z_update_every", "--z-update-every", TC_PATH_NONE, TC_KEY_PICTURE},
    {"method", "threads", "--threads", TC_PATH_NONE, TC_KEY_RUN},
    {"method", "error", "--error", TC_PATH_NONE, TC_KEY_RUN},
    {"method", "frame_time", "--frame-time", TC_PATH_NONE, TC_KEY_RUN},
    {"method", "no_cache", "--no-cache", TC_PATH_NONE, TC_KEY_RUN},
    {"output", "file", "--output", TC_PATH_FILE, TC_KEY_RUN},
    {"output", "size", "--size", TC_PATH_NONE, TC_KEY_PICTURE},
    {"output", "background", "--background", TC_PATH_NONE, TC_KEY_PICTURE},
    {"output", "png_level", "--png-level", TC_PATH_NONE, TC_KEY_PICTURE},
    {"output", "jpeg_quality", "--jpeg-quality", TC_PATH_NONE, TC_KEY_PICTURE},
    {"output", "bits", "--bits", TC_PATH_NONE, TC_KEY_PICTURE},
    {"output", "depth", "--depth", TC_PATH_NONE, TC_KEY_RUN},
    {"output", "value", "--value", TC_PATH_NONE, TC_KEY_RUN},
    {"output", "stereo", "--stereo", TC_PATH_NONE, TC_KEY_PICTURE},
    {"output", "eye_angle", "--eye-angle", TC_PATH_NONE, TC_KEY_PICTURE},
    {"output", "verify", "--verify", TC_PATH_NONE, TC_KEY_RUN},
    {"output", "error_image", "--error-image", TC_PATH_FILE, TC_KEY_RUN},
    {"output", "repeat", "--repeat", TC_PATH_NONE, TC_KEY_RUN},
    {"output", "count", "--count", TC_PATH_NONE, TC_KEY_RUN},
    {"output", "audit", "--audit", TC_PATH_NONE, TC_KEY_RUN},
    {"output", "stats", "--stats", TC_PATH_FILE, TC_KEY_RUN},
    {"", "frames", "--frames", TC_PATH_NONE, TC_KEY_BATCH},
    {"", "memory", "--memory", TC_PATH_NONE, TC_KEY_BATCH},
    {"", "views", "--views", TC_PATH_NONE, TC_KEY_BATCH},
    {"", "times", "--times", TC_PATH_NONE, TC_KEY_BATCH},
    {"camera", "over", "--camera-over", TC_PATH_NONE, TC_KEY_BATCH},
    {"transfer_function", "range_over", "--range-over", TC_PATH_NONE, TC_KEY_BATCH},
    {"transfer_function", "unit_over", "--unit-over", TC_PATH_NONE, TC_KEY_BATCH},
    {"output", "cinema", "--cinema", TC_PATH_NONE, TC_KEY_BATCH},
    {"output", "video", "--video", TC_PATH_FILE, TC_KEY_BATCH},
    {"output", "fps", "--fps", TC_PATH_NONE, TC_KEY_BATCH},
    {"", "shell", NULL, TC_PATH_NONE, TC_KEY_RUN},
};
/* clang-format on */
enum { TC_N_KEY = sizeof tc_key / sizeof *tc_key };

const tc_scene_key *tc_scene_keys(size_t *n)
{
    *n = TC_N_KEY;
    return tc_key;
}

/* What a scene is read with. */
typedef struct tc_scene_reader {
    tc_scene *out;
    const char *text, *name, *folder;
    int element; /* of the list of transfer functions; -1: there is one */
    const tc_command *command;
    tc_talk *talk;
} tc_scene_reader;

static int tc_out_of_memory(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* ---------------------------------------------------------------------------------------------------------- names */

/* A section as the file has it: "transfer_function[1]" where there is a list of them. */
static const char *tc_section_name(char room[64], const tc_scene_reader *r, const char *section)
{
    if (r->element < 0 || strcmp(section, "transfer_function") != 0)
        return section;
    snprintf(room, 64, "%s[%d]", section, r->element);
    return room;
}

/* The place of a key as errors name it; the caller frees it. */
static char *tc_called(const tc_scene_reader *r, const char *section, const char *key)
{
    char *text = NULL, room[64], line[24] = "";
    section = tc_section_name(room, r, section);
    if (r->text)
        snprintf(line, sizeof line, ":%d", tc_json_line(r->text, section, key));
    if (asprintf(&text, "%s%s: %s%s%s", r->name, line, section, *section ? "." : "", key) < 0)
        return NULL;
    return text;
}

static bool tc_is_section(const char *name)
{
    for (size_t i = 0; i < TC_N_KEY; i++)
        if (*tc_key[i].section && !strcmp(tc_key[i].section, name))
            return true;
    return false;
}

static const tc_scene_key *tc_key_find(const char *section, const char *key)
{
    for (size_t i = 0; i < TC_N_KEY; i++)
        if (!strcmp(tc_key[i].section, section) && !strcmp(tc_key[i].key, key))
            return &tc_key[i];
    return NULL;
}

static int tc_refuse_key(const tc_scene_reader *r, const char *section, const char *key)
{
    tc_nearest search = {.name = key};
    const char *elsewhere = NULL;
    char room[64];
    const char *shown = tc_section_name(room, r, section);
    int line = r->text ? tc_json_line(r->text, shown, key) : 0;
    for (size_t i = 0; i < TC_N_KEY; i++) {
        const tc_scene_key *k = &tc_key[i];
        if (!strcmp(k->section, section)) {
            if (k->option)
                tc_nearest_offer(&search, k->key);
        } else if (!strcmp(k->key, key)) {
            elsewhere = *k->section ? k->section : "the scene itself";
        }
        if (!*section && *k->section)
            tc_nearest_offer(&search, k->section);
    }
    if (!*section)
        tc_nearest_offer(&search, "data");
    if (elsewhere)
        tc_talk_error(r->talk, "%s:%d: %s has no key '%s': it belongs into %s", r->name, line,
                      *section ? shown : "the scene", key, elsewhere);
    else
        tc_talk_error(r->talk, "%s:%d: %s has no key '%s'; the nearest is '%s'", r->name, line,
                      *section ? shown : "the scene", key, search.best);
    return TC_EXIT_FAILED;
}

/* --------------------------------------------------------------------------------------------------------- values */

static bool tc_put_number(FILE *stream, const json_t *value)
{
    if (json_is_integer(value))
        fprintf(stream, "%lld", (long long)json_integer_value(value));
    else if (json_is_real(value))
        fprintf(stream, "%.17g", json_real_value(value));
    return json_is_number(value);
}

/* An array's elements, numbers and texts, with `between`; arrays in it have their own with `within`. */
static bool tc_put_array(FILE *stream, const json_t *array, char between, char within)
{
    size_t n = json_array_size(array);
    bool good = n > 0;
    for (size_t i = 0; i < n && good; i++) {
        const json_t *value = json_array_get(array, i);
        if (i > 0)
            fputc(between, stream);
        if (json_is_string(value))
            good = fputs(json_string_value(value), stream) >= 0;
        else if (json_is_array(value))
            good = within && tc_put_array(stream, value, within, 0);
        else
            good = tc_put_number(stream, value);
    }
    return good;
}

/* An array as an option's text: numbers by commas, rows of them and texts by semicolons. */
static bool tc_put_list(FILE *stream, const json_t *array, const tc_option *option)
{
    const json_t *first = json_array_get(array, 0);
    if (!strcmp(option->name, "--opacity"))
        return tc_put_array(stream, array, ',', ':');
    if (!strcmp(option->name, "--geometry"))
        return tc_put_array(stream, array, ',', 0);
    if (!strcmp(option->name, "--size"))
        return tc_put_array(stream, array, 'x', 0);
    if (!strcmp(option->name, "--blocks") || !first || json_is_number(first))
        return tc_put_array(stream, array, ',', 0);
    return tc_put_array(stream, array, ';', ',');
}

/* Is it a colour map in full, as {"RGBPoints": …} or a list of such? */
static bool tc_is_preset(const tc_option *option, const json_t *value)
{
    return !strcmp(option->name, "--color-map") &&
           (json_is_object(value) || json_is_object(json_array_get(value, 0)));
}

/* May an option's value be of this JSON type? */
static bool tc_type_fits(const tc_option *option, const json_t *value)
{
    const bool number = json_is_number(value), text = json_is_string(value), list = json_is_array(value);
    switch (option->kind) {
    case TC_OPTION_FLAG:
        return json_is_boolean(value);
    case TC_OPTION_TEXT:
        return text || (list && (!strcmp(option->name, "--opacity") || !strcmp(option->name, "--categories"))) ||
               tc_is_preset(option, value);
    case TC_OPTION_CHOICE:
        return text || json_is_integer(value);
    case TC_OPTION_INT:
        return json_is_integer(value) || (text && option->choice);
    case TC_OPTION_U64:
        return json_is_integer(value) || text;
    case TC_OPTION_REAL:
        return number || (text && option->choice) || (option->optional && json_is_boolean(value));
    case TC_OPTION_REALS:
        return list || text;
    default:
        return text || number || list;
    }
}

static const char *tc_type_wanted(const tc_option *option)
{
    switch (option->kind) {
    case TC_OPTION_FLAG:
        return "true or false";
    case TC_OPTION_INT:
    case TC_OPTION_U64:
        return "a whole number";
    case TC_OPTION_REAL:
        return option->optional ? "a number, true or false" : "a number";
    case TC_OPTION_REALS:
        return "a list of numbers";
    case TC_OPTION_TEXT:
        return strcmp(option->name, "--color-map") ? "a text" : "a text or a preset {\"RGBPoints\": …}";
    case TC_OPTION_CHOICE:
        return "a text";
    default:
        return "a text, a number or a list of them";
    }
}

static const char *tc_type_name(const json_t *value)
{
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        return "an object";
    case JSON_ARRAY:
        return json_array_size(value) > 0 ? "a list" : "an empty list";
    case JSON_STRING:
        return "a text";
    case JSON_INTEGER:
    case JSON_REAL:
        return "a number";
    case JSON_NULL:
        return "null";
    default:
        return json_is_true(value) ? "true" : "false";
    }
}

/* ---------------------------------------------------------------------------------------------------------- paths */

/* path, if it is not absolute, from the folder; NULL: memory ran out. */
char *tc_scene_path_from(const char *folder, const char *path)
{
    char *text = NULL;
    if (!folder || !*folder || *path == '/')
        return strdup(path);
    return asprintf(&text, "%s/%s", folder, path) < 0 ? NULL : text;
}

static bool tc_is_file(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

/* Is it a built-in map, or a kind of opacity? These come before files of their name. */
static bool tc_is_name(const char *text)
{
    static const char *const curve[] = {"linear", "geom", "sigmoid"};
    size_t n;
    const char *const *map = tc_transfer_builtin(&n);
    for (size_t i = 0; i < n; i++)
        if (!strcasecmp(map[i], text))
            return true;
    for (size_t i = 0; i < sizeof curve / sizeof *curve; i++)
        if (!strcasecmp(curve[i], text))
            return true;
    return false;
}

bool tc_names_file(const char *text)
{
    return !tc_is_name(text) && tc_is_file(text);
}

/* The text of an option, its path led from the scene's folder; takes text over. */
static char *tc_path_lead(const tc_scene_reader *r, tc_scene_path kind, char *text)
{
    if (!text || kind == TC_PATH_NONE || (kind == TC_PATH_FILE && !strcmp(text, "-")))
        return text;
    char *led = tc_scene_path_from(r->folder, text);
    if (kind == TC_PATH_MAYBE && led && (tc_is_name(text) || !tc_is_file(led))) {
        free(led);
        return text;
    }
    free(text);
    return led;
}

/* ---------------------------------------------------------------------------------------------------------- items */

/* Takes called and text over. */
static int tc_item_add(const tc_scene_reader *r, const tc_option *option, char *called, char *text)
{
    tc_scene *out = r->out;
    tc_scene_item *more = called ? realloc(out->item, (out->n + 1) * sizeof *more) : NULL;
    if (!more) {
        free(called);
        free(text);
        return tc_out_of_memory(r->talk);
    }
    out->item = more;
    out->item[out->n++] = (tc_scene_item){option, called, text};
    return -1;
}

/* The text of a value that fits; NULL: it is an empty list or holds what no list takes, or memory ran out. */
static char *tc_value_text(const json_t *value, const tc_option *option)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream)
        return NULL;
    bool good = true;
    if (tc_is_preset(option, value))
        good = json_dumpf(value, stream, JSON_COMPACT | JSON_REAL_PRECISION(17)) == 0;
    else if (json_is_boolean(value))
        fputs(json_is_true(value) ? "on" : "off", stream);
    else if (json_is_string(value))
        fputs(json_string_value(value), stream);
    else if (json_is_array(value))
        good = tc_put_list(stream, value, option);
    else
        good = tc_put_number(stream, value);
    good = fclose(stream) == 0 && good;
    if (!good) {
        free(text);
        text = NULL;
    }
    return text;
}

static int tc_refuse_type(const tc_scene_reader *r, const char *section, const char *key, const char *wanted,
                          const json_t *value)
{
    char *called = tc_called(r, section, key);
    if (!called)
        return tc_out_of_memory(r->talk);
    tc_talk_error(r->talk, "%s takes %s, not %s", called, wanted, tc_type_name(value));
    free(called);
    return TC_EXIT_FAILED;
}

/* What stands for several pictures, where one is made. */
static int tc_refuse_many(const tc_scene_reader *r, const char *section, const char *key)
{
    char *called = tc_called(r, section, key);
    if (!called)
        return tc_out_of_memory(r->talk);
    tc_talk_error(r->talk, "%s stands for several pictures, which tetcast batch makes: use that, or leave it out", called);
    free(called);
    return TC_EXIT_FAILED;
}

static int tc_option_take(const tc_scene_reader *r, const tc_scene_key *k, const json_t *value)
{
    char *called = NULL;
    if (!k->option) {
        called = tc_called(r, k->section, k->key);
        if (called)
            tc_talk_error(r->talk, "%s is not in this version (%s): leave it out", called, tc_version());
        free(called);
        return called ? TC_EXIT_FAILED : tc_out_of_memory(r->talk);
    }
    const tc_option *option = tc_command_option(r->command, k->option);
    if (!option && k->role == TC_KEY_BATCH && strcmp(k->key, "views") != 0)
        return -1; /* a scene of many pictures may be rendered as one */
    if (!option && k->role == TC_KEY_BATCH)
        return tc_refuse_many(r, k->section, k->key);
    if (!option)
        return tc_refuse_key(r, k->section, k->key);
    if (json_is_array(value) && !*k->section && !strcmp(k->key, "field"))
        return tc_refuse_many(r, k->section, k->key);
    if (!tc_type_fits(option, value))
        return tc_refuse_type(r, k->section, k->key, tc_type_wanted(option), value);
    const json_t *first = json_is_array(value) ? json_array_get(value, 0) : NULL;
    if (option->repeat &&
        json_is_string(json_is_array(first) ? json_array_get(first, 0) : first)) { /* each its own, whatever is in it */
        int code = -1;
        for (size_t i = 0; i < json_array_size(value) && code < 0; i++) {
            const json_t *one = json_array_get(value, i);
            char *text = json_is_string(one)  ? strdup(json_string_value(one))
                         : json_is_array(one) ? tc_value_text(one, option)
                                              : NULL;
            if (!text)
                return tc_refuse_type(r, k->section, k->key, "a text, or a list of texts alone", one);
            code = tc_item_add(r, option, tc_called(r, k->section, k->key), tc_path_lead(r, k->path, text));
        }
        return code;
    }
    const bool without = option->optional && json_is_true(value);
    char *text = without ? NULL : tc_value_text(value, option);
    if (!text && !without)
        return tc_refuse_type(r, k->section, k->key, tc_type_wanted(option), value);
    return tc_item_add(r, option, tc_called(r, k->section, k->key), tc_path_lead(r, k->path, text));
}

static int tc_data_take(const tc_scene_reader *r, const json_t *value)
{
    const char *data = json_string_value(value);
    if (json_is_array(value))
        return tc_refuse_many(r, "", "data");
    if (!data || !*data)
        return tc_refuse_type(r, "", "data", "the name of a file, or synth:NAME[:CELLS]", value);
    r->out->data = !strncmp(data, "synth:", 6) ? strdup(data) : tc_scene_path_from(r->folder, data);
    return r->out->data ? -1 : tc_out_of_memory(r->talk);
}

static int tc_section_take(const tc_scene_reader *r, const char *section, json_t *object)
{
    const char *key;
    json_t *value;
    int code = -1;
    json_object_foreach(object, key, value)
    {
        const tc_scene_key *k = tc_key_find(section, key);
        if (k)
            code = tc_option_take(r, k, value);
        else if (*section || (!tc_is_section(key) && strcmp(key, "data") != 0))
            code = tc_refuse_key(r, section, key);
        else if (!strcmp(key, "data"))
            code = tc_data_take(r, value);
        else if (json_is_array(value) && !strcmp(key, "transfer_function"))
            code = tc_refuse_many(r, "", key);
        else if (!json_is_object(value))
            code = tc_refuse_type(r, "", key, "an object {\"key\": value, …}", value);
        else
            code = tc_section_take(r, key, value);
        if (code >= 0)
            break;
    }
    return code;
}

/* ---------------------------------------------------------------------------------------------------------- whole */

int tc_scene_from_json(tc_scene *out, json_t *json, int element, const char *text, const char *name, const char *folder,
                  const tc_command *command, tc_talk *talk)
{
    const tc_scene_reader r = {out, text, name, folder, element, command, talk};
    *out = (tc_scene){0};
    int code = tc_section_take(&r, "", json);
    if (code >= 0)
        tc_scene_finish(out);
    return code;
}

/* The object in a text; NULL after an error was printed. */
static json_t *tc_object_load(const char *text, const char *name, tc_talk *talk)
{
    json_error_t error;
    const char *from = strncmp(text, "\xef\xbb\xbf", 3) ? text : text + 3;
    json_t *json = json_loads(from, JSON_REJECT_DUPLICATES, &error);
    if (!json) {
        tc_talk_error(talk, "%s:%d: this is no JSON: %s", name, error.line, error.text);
        return NULL;
    }
    if (json_is_object(json))
        return json;
    tc_talk_error(talk, "%s:1: a scene is an object {\"data\": …}, not %s", name, tc_type_name(json));
    json_decref(json);
    return NULL;
}

int tc_scene_parse(tc_scene *out, const char *text, const char *name, const char *folder, const tc_command *command,
                   tc_talk *talk)
{
    *out = (tc_scene){0};
    json_t *json = tc_object_load(text, name, talk);
    int code = json ? tc_scene_from_json(out, json, -1, text, name, folder, command, talk) : TC_EXIT_FAILED;
    json_decref(json);
    return code;
}

static bool tc_has_extension(const char *path, const char *const *known, size_t n)
{
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < n; i++)
        if (!strcasecmp(dot, known[i]))
            return true;
    return false;
}

bool tc_input_is_picture(const char *input)
{
    static const char *const known[] = {".png", ".exr", ".tif", ".tiff", ".jpg", ".jpeg"};
    return tc_has_extension(input, known, sizeof known / sizeof *known);
}

bool tc_input_is_scene(const char *input)
{
    static const char *const known[] = {".json"};
    return strncmp(input, "synth:", 6) != 0 && (tc_has_extension(input, known, 1) || tc_input_is_picture(input));
}

/* The whole of a file with a NUL behind it; NULL after an error was printed. */
static char *tc_text_read(const char *path, tc_talk *talk)
{
    struct stat info;
    FILE *stream = fopen(path, "rb");
    char *text = NULL;
    if (!stream || fstat(fileno(stream), &info) != 0) {
        tc_talk_error(talk, "%s cannot be read: %s%s", path, strerror(errno),
                      errno == ENOENT ? "; check the path" : "");
    } else if (!S_ISREG(info.st_mode) || info.st_size > TC_SCENE_BYTES) {
        tc_talk_error(talk, "%s is no scene: %s", path,
                      S_ISREG(info.st_mode) ? "it has more than 16 MiB" : "it is no file");
    } else if (!(text = malloc((size_t)info.st_size + 1))) {
        tc_out_of_memory(talk);
    } else {
        size_t n = fread(text, 1, (size_t)info.st_size, stream);
        text[n] = 0;
        if (strlen(text) < n) {
            tc_talk_error(talk, "%s is no scene: it holds a zero byte", path);
            free(text);
            text = NULL;
        }
    }
    if (stream)
        fclose(stream);
    return text;
}

static char *tc_picture_scene(const char *path, tc_talk *talk)
{
    tc_error err = {0};
    char *text = NULL;
    tc_status status = tc_image_read_text(&text, path, "tetcast:scene", &err);
    if (status)
        tc_talk_status(talk, status, &err);
    else if (!text)
        tc_talk_error(talk, "%s carries no scene: only a picture that tetcast render wrote can be made again", path);
    return text;
}

int tc_scene_load(json_t **json, char **text, const char *path, tc_talk *talk)
{
    *text = tc_input_is_picture(path) ? tc_picture_scene(path, talk) : tc_text_read(path, talk);
    *json = *text ? tc_object_load(*text, path, talk) : NULL;
    if (*json)
        return -1;
    free(*text);
    *text = NULL;
    return TC_EXIT_FAILED;
}

bool tc_scene_folder(char **folder, const char *path)
{
    const char *slash = tc_input_is_picture(path) ? NULL : strrchr(path, '/');
    *folder = slash ? strndup(path, slash == path ? 1 : (size_t)(slash - path)) : NULL;
    return !slash || *folder;
}

int tc_scene_read(tc_scene *out, const char *path, const tc_command *command, tc_talk *talk)
{
    json_t *json = NULL;
    char *text = NULL, *folder = NULL;
    *out = (tc_scene){0};
    int code = tc_scene_folder(&folder, path) ? -1 : tc_out_of_memory(talk);
    if (code < 0)
        code = tc_scene_load(&json, &text, path, talk);
    if (code < 0)
        code = tc_scene_from_json(out, json, -1, text, path, folder, command, talk);
    json_decref(json);
    free(folder);
    free(text);
    return code;
}

void tc_scene_finish(tc_scene *scene)
{
    for (size_t i = 0; i < scene->n; i++) {
        free(scene->item[i].called);
        free(scene->item[i].text);
    }
    free(scene->item);
    free(scene->data);
    *scene = (tc_scene){0};
}
