/* batch_scene.c: a scene of many pictures is read as one scene for each field and transfer function: what is a list in it is
 * replaced by each of its elements in turn, and the options of render do the rest. */
#define _GNU_SOURCE
#include "cli/batch/batch_scene.h"
#include "cli/commands.h"
#include "cli/scene/paraview.h"
#include "cli/scene/scene_lines.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int tc_no_memory(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* Says what is wrong with a key of the scene's outermost object. */
static int tc_refuse(const tc_batch_scene *s, const char *key, tc_talk *talk, const char *what)
{
    tc_talk_error(talk, "%s:%d: %s %s", s->path, tc_json_line(s->text, "", key), key, what);
    return TC_EXIT_FAILED;
}

/* The scene as JSON: of the file, or of a dataset or a ParaView state alone. */
static int tc_json_take(tc_batch_scene *out, const char *input, tc_talk *talk)
{
    if (tc_input_is_scene(input)) {
        out->path = strdup(input);
        if (!out->path || !tc_scene_folder(&out->folder, input))
            return tc_no_memory(talk);
        return tc_scene_load(&out->json, &out->text, input, talk);
    }
    out->json = json_object();
    json_t *data = NULL, *views = NULL;
    if (tc_input_is_paraview(input)) {
        const int code = tc_paraview_many(&data, &views, input, talk);
        json_decref(views);
        if (code >= 0)
            return code;
        json_object_set_new(out->json, "paraview", json_string(input));
    }
    json_object_set_new(out->json, "data", data ? data : json_string(input));
    out->text = json_dumps(out->json, JSON_COMPACT);
    return out->text && json_object_get(out->json, "data") ? -1 : tc_no_memory(talk);
}

/* Where the scene has no views, the path of the camera of the ParaView state that lies under it: the command line's, else
 * the scene's own. */
static int tc_state_take(tc_batch_scene *out, const char *state, tc_talk *talk)
{
    const char *own = json_string_value(json_object_get(out->json, "paraview"));
    const bool has_data = json_object_get(out->json, "data"), has_views = json_object_get(out->json, "views");
    char *led = state ? strdup(state) : own ? tc_scene_path_from(out->folder, own) : NULL;
    json_t *data = NULL, *views = NULL;
    if ((!state && !own) || (has_data && has_views)) {
        free(led);
        return -1;
    }
    int code = led ? tc_paraview_many(has_data ? NULL : &data, &views, led, talk) : tc_no_memory(talk);
    if (views && !has_views)
        json_object_set(out->json, "views", views);
    if (data) {
        json_object_set(out->json, "data", data);
        out->data_whole = true;
    }
    json_decref(views);
    json_decref(data);
    free(led);
    return code;
}

/* A path that says the same from every folder; from malloc. */
static char *tc_absolute(const char *path)
{
    char *whole = NULL, *folder;
    if (tc_input_is_synthetic(path) || *path == '/')
        return strdup(path);
    whole = realpath(path, NULL);
    if (whole)
        return whole;
    folder = getcwd(NULL, 0);
    if (!folder || asprintf(&whole, "%s/%s", folder, path) < 0)
        whole = NULL;
    free(folder);
    return whole;
}

/* What the file says where it is a list: [n] elements, borrowed; else the one value, which may be NULL. */
static size_t tc_list_of(const json_t **first, const json_t *value)
{
    *first = value;
    return json_is_array(value) ? json_array_size(value) : 1;
}

static const json_t *tc_element(const json_t *value, size_t i)
{
    return json_is_array(value) ? json_array_get(value, i) : value;
}

static int tc_lists_check(const tc_batch_scene *s, const json_t *field, const json_t *function, tc_talk *talk)
{
    for (size_t i = 0; json_is_array(field) && i < json_array_size(field); i++)
        if (!json_is_string(json_array_get(field, i)))
            return tc_refuse(s, "field", talk, "takes a text, or a list of texts");
    for (size_t i = 0; json_is_array(function) && i < json_array_size(function); i++) {
        const json_t *one = json_array_get(function, i), *name = json_object_get(one, "name");
        if (!json_is_object(one) || (name && !json_is_string(name)))
            return tc_refuse(s, "transfer_function", talk,
                             "takes an object, or a list of objects, each of which may have a \"name\"");
    }
    if (json_is_array(field) && json_array_size(field) == 0)
        return tc_refuse(s, "field", talk, "is an empty list: name a field, or leave it out");
    if (json_is_array(function) && json_array_size(function) == 0)
        return tc_refuse(s, "transfer_function", talk, "is an empty list: give a function, or leave it out");
    return -1;
}

/* The scene of one look: NULL when memory ran out. */
static json_t *tc_look_json(const tc_batch_scene *s, const json_t *field, const json_t *function, const char *data)
{
    json_t *json = json_copy(s->json);
    static const char *const ours[] = {"views", "times"};
    for (size_t i = 0; json && i < sizeof ours / sizeof *ours; i++)
        json_object_del(json, ours[i]);
    if (!json || json_object_set_new(json, "data", json_string(data)) != 0)
        goto fail;
    if (field && json_object_set(json, "field", (json_t *)field) != 0)
        goto fail;
    if (function && json_is_object(function)) {
        json_t *one = json_copy((json_t *)function);
        json_object_del(one, "name");
        if (json_object_set_new(json, "transfer_function", one) != 0)
            goto fail;
    }
    return json;
fail:
    json_decref(json);
    return NULL;
}

static char *tc_function_name(const json_t *functions, const json_t *one, size_t i)
{
    char *name = NULL;
    const char *given = json_string_value(json_object_get(one, "name"));
    if (given && *given)
        return strdup(given);
    if (!json_is_array(functions) || json_array_size(functions) == 1)
        return strdup("tf");
    return asprintf(&name, "tf%zu", i + 1) < 0 ? NULL : name;
}

static int tc_looks_take(tc_batch_scene *out, tc_talk *talk, int argc, char **argv)
{
    const json_t *field = json_object_get(out->json, "field");
    const json_t *function = json_object_get(out->json, "transfer_function"), *first;
    int code = tc_lists_check(out, field, function, talk);
    if (code >= 0)
        return code;
    out->n_field = tc_list_of(&first, field);
    out->n_function = tc_list_of(&first, function);
    out->field = calloc(out->n_field, sizeof *out->field);
    out->function = calloc(out->n_function, sizeof *out->function);
    out->look = calloc(out->n_field, out->n_function * sizeof *out->look);
    char *data = tc_absolute(out->series.path[0]);
    if (!out->field || !out->function || !out->look || !data) {
        free(data);
        return tc_no_memory(talk);
    }
    for (size_t i = 0; i < out->n_field && code < 0; i++)
        for (size_t k = 0; k < out->n_function && code < 0; k++) {
            tc_batch_command *look = &out->look[i * out->n_function + k];
            const json_t *one = tc_element(function, k);
            json_t *json = tc_look_json(out, tc_element(field, i), one, data);
            const tc_scene_at at = {json, json_is_array(function) ? (int)k : -1, out->text, out->folder, i + k > 0};
            code = json ? tc_batch_command_take(look, &at, talk, argc, argv) : tc_no_memory(talk);
            json_decref(json);
            if (i == 0 && code < 0 && !(out->function[k] = tc_function_name(function, one, k)))
                code = tc_no_memory(talk);
            if (code < 0 && k == 0 && !(out->field[i] = strdup(look->picture.source.field ? look->picture.source.field
                                                                                          : "")))
                code = tc_no_memory(talk);
            if (code < 0 && !out->path)
                look->picture.scene_path = NULL;
        }
    free(data);
    if (code < 0 && out->n_field > 1 && tc_is_of_line(&out->look[0].picture.given, "--field"))
        out->n_field = 1; /* the command line's stands for the list */
    return code;
}

/* The argument that is no option, and --paraview's, NULL: there is none; whatever else is wrong with the command line is
 * said, too. */
static int tc_input_take(const char **input, const char **state, tc_talk *talk, int argc, char **argv)
{
    tc_batch_command line = {0};
    int n_argument, code = tc_options_parse(&line, input, &n_argument, talk, &tc_command_batch, argc, argv);
    *state = line.picture.paraview;
    tc_batch_command_finish(&line);
    return code;
}

int tc_batch_scene_read(tc_batch_scene *out, tc_talk *talk, int argc, char **argv)
{
    const char *input, *state;
    *out = (tc_batch_scene){0};
    int code = tc_input_take(&input, &state, talk, argc, argv);
    if (code < 0)
        code = tc_json_take(out, input, talk);
    if (code < 0)
        code = tc_state_take(out, state, talk);
    if (code >= 0)
        return code;
    const json_t *data = json_object_get(out->json, "data"), *views = json_object_get(out->json, "views");
    if (!data)
        return tc_refuse(out, "data", talk, "is missing: add \"data\": \"FILE\"");
    if (!json_is_string(data) && !json_is_array(data))
        return tc_refuse(out, "data", talk, "takes the name of a file, a pattern, or a list of them");
    talk->from = out->path; /* before what is said of data and times; NULL: they are of the command line */
    code = tc_series_make(&out->series, data, json_object_get(out->json, "times"),
                          out->data_whole ? NULL : out->folder, talk);
    talk->from = NULL;
    if (code < 0 && views) {
        char called[512];
        snprintf(called, sizeof called, "%.400s:%d: views", out->path ? out->path : input,
                 tc_json_line(out->text, "", "views"));
        code = tc_views_read(&out->views, views, called, talk);
    }
    if (code < 0)
        code = tc_looks_take(out, talk, argc, argv);
    talk->from = NULL; /* what goes wrong from now on is not the scene's */
    return code;
}

void tc_batch_scene_finish(tc_batch_scene *s)
{
    for (size_t i = 0; s->look && i < s->n_field * s->n_function; i++)
        tc_batch_command_finish(&s->look[i]);
    for (size_t i = 0; s->field && i < s->n_field; i++)
        free(s->field[i]);
    for (size_t i = 0; s->function && i < s->n_function; i++)
        free(s->function[i]);
    free(s->field);
    free(s->function);
    free(s->look);
    tc_series_finish(&s->series);
    tc_views_finish(&s->views);
    json_decref(s->json);
    free(s->text);
    free(s->folder);
    free(s->path);
    *s = (tc_batch_scene){0};
}
