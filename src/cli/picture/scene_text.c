/* scene_text.c: the scene that makes a picture again, as its metadata hold it: what was given, and in place of what was
 * chosen or found by itself (camera, range, unit distance, step, way through gaps, driver) what was in force. Files by
 * their whole path. */
#define _GNU_SOURCE
#include "cli/picture/look_build.h"
#include "cli/picture/render_choose.h"
#include "cli/picture/stereo_options.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A number as JSON writes it shortest. */
static json_t *tc_number(double value)
{
    return fabs(value) < 1e15 && value == floor(value) && !(value == 0 && signbit(value))
               ? json_integer((json_int_t)value)
               : json_real(value);
}

static json_t *tc_numbers(const double *value, int n)
{
    json_t *list = json_array();
    for (int i = 0; i < n; i++)
        json_array_append_new(list, tc_number(value[i]));
    return list;
}

/* As a text of the scene; what is not UTF-8 cannot be told. */
static json_t *tc_text(const char *text)
{
    json_t *holder = json_object(), *string;
    tc_json_text(holder, "", text);
    string = json_incref(json_object_get(holder, ""));
    json_decref(holder);
    return string ? string : json_string("");
}

/* The whole path of a file that is there, else the text as it is. */
static json_t *tc_whole_path(const char *text)
{
    char *whole = strcmp(text, "-") ? realpath(text, NULL) : NULL;
    json_t *string = tc_text(whole ? whole : text);
    free(whole);
    return string;
}

/* FILE[,OPACITY] */
static json_t *tc_whole_path_of(const char *text)
{
    double opacity;
    const char *comma = strrchr(text, ',');
    if (!comma || !tc_parse_real(&opacity, comma + 1))
        return tc_whole_path(text);
    char *file = strndup(text, (size_t)(comma - text)), *both = NULL;
    char *whole = file ? realpath(file, NULL) : NULL;
    if (whole && asprintf(&both, "%s%s", whole, comma) < 0)
        both = NULL;
    json_t *string = tc_text(both ? both : text);
    free(file);
    free(whole);
    free(both);
    return string;
}

static json_t *tc_given_json(const tc_given *given, tc_scene_path path)
{
    enum { MOST = 64 };
    const tc_option *option = given->option;
    const char *text = given->text;
    double value[MOST];
    int n = 0;
    if (!text)
        return json_true();
    if (option->kind == TC_OPTION_FLAG)
        return json_boolean(strcmp(text, "off") != 0);
    if (option->optional && !strcmp(text, "off"))
        return json_false();
    if (path == TC_PATH_OPACITY)
        return tc_whole_path_of(text);
    if (path == TC_PATH_FILE || (path == TC_PATH_MAYBE && tc_names_file(text))) /* else a name: "linear", "Viridis" */
        return tc_whole_path(text);
    if (option->kind == TC_OPTION_U64 && strlen(text) > 15) /* more digits than a double has */
        return tc_text(text);
    if (path != TC_PATH_NONE || option->kind == TC_OPTION_TEXT || option->kind == TC_OPTION_CHOICE || option->repeat ||
        !tc_parse_reals(value, &n, MOST, text))
        return tc_text(text);
    return n == 1 && option->kind != TC_OPTION_REALS && option->kind != TC_OPTION_CUSTOM ? tc_number(value[0])
                                                                                         : tc_numbers(value, n);
}

/* Sets a key of a section, which is made when it is needed. */
static void tc_put(json_t *scene, const char *section, const char *key, json_t *value)
{
    json_t *holder = scene;
    if (*section) {
        holder = json_object_get(scene, section);
        if (!holder) {
            holder = json_object();
            json_object_set_new(scene, section, holder);
        }
    }
    json_object_set_new(holder, key, value);
}

/* Is it said by what was in force, not by what was given? */
static bool tc_is_found(const tc_render_run *run, const tc_scene_key *key)
{
    static const char *const found[] = {"--field", "--cell-data", "--point-data",    "--time",
                                        "--step",  "--reentry",   "--range",         "--driver",
                                        "--gl",    "--size",      "--unit-distance", "--color-range",
                                        "--stereo", "--eye-angle"};
    static const char *const chosen[] = {"--integrator", "--integral-order", "--integral-split", "--opacity-stop"};
    if (!strcmp(key->section, "camera"))
        return true;
    for (size_t i = 0; i < sizeof found / sizeof *found; i++)
        if (!strcmp(key->option, found[i]))
            return true;
    for (size_t i = 0; i < sizeof chosen / sizeof *chosen && run->chosen; i++)
        if (!strcmp(key->option, chosen[i]))
            return true;
    return false;
}

static void tc_given_put(json_t *scene, const tc_render_run *run)
{
    size_t n_key;
    const tc_scene_key *key = tc_scene_keys(&n_key);
    const tc_given_list *given = &run->options->given;
    for (size_t k = 0; k < n_key; k++) {
        json_t *list = NULL;
        if (!key[k].option || key[k].role != TC_KEY_PICTURE || tc_is_found(run, &key[k]))
            continue;
        for (size_t i = 0; i < given->n; i++) {
            const tc_given *one = &given->item[i];
            if (strcmp(one->option->name, key[k].option) != 0)
                continue;
            json_t *value = tc_given_json(one, key[k].path);
            if (!one->option->repeat) {
                tc_put(scene, key[k].section, key[k].key, value);
                continue;
            }
            if (!list) {
                list = json_array();
                tc_put(scene, key[k].section, key[k].key, list);
            }
            json_array_append_new(list, value);
        }
    }
}

static void tc_data_put(json_t *scene, const tc_render_run *run)
{
    const char *input = run->options->input;
    const tc_source *source = tc_mesh_source(run->mesh);
    tc_put(scene, "", "data", source ? tc_whole_path(input) : tc_text(input));
    if (source && source->field && *source->field) {
        tc_put(scene, "", "field", tc_text(source->field));
        tc_put(scene, "", run->report.association == TC_CELL_DATA ? "cell_data" : "point_data", json_true());
    }
    if (source && source->step >= 0 && source->n_time > 0)
        tc_put(scene, "", "step", json_integer(source->step));
    tc_put(scene, "", "reentry", json_string(tc_reentry_name(run->report.reentry)));
}

static void tc_camera_put(json_t *scene, const tc_camera *camera)
{
    const double clip[2] = {camera->clip_near, camera->clip_far};
    tc_put(scene, "camera", "position", tc_numbers(camera->position, 3));
    tc_put(scene, "camera", "focal_point", tc_numbers(camera->focal_point, 3));
    tc_put(scene, "camera", "view_up", tc_numbers(camera->view_up, 3));
    tc_put(scene, "camera", "view_angle", tc_number(camera->view_angle));
    if (camera->parallel)
        tc_put(scene, "camera", "parallel_scale", tc_number(camera->parallel_scale));
    if (camera->clip_far > 0)
        tc_put(scene, "camera", "clipping_range", tc_numbers(clip, 2));
    if (camera->window_center[0] != 0 || camera->window_center[1] != 0)
        tc_put(scene, "camera", "window_center", tc_numbers(camera->window_center, 2));
}

static void tc_function_put(json_t *scene, const tc_render_run *run)
{
    const tc_look_options *look = &run->options->look;
    const double *range = run->range, *color = run->look ? run->look->color_range : NULL;
    if (range[0] < range[1] && !(look->categories && !look->color_field))
        tc_put(scene, "transfer_function", "range", tc_numbers(range, 2));
    if (look->color_field && !look->categories && color && color[0] < color[1])
        tc_put(scene, "effects", "color_range", tc_numbers(color, 2));
    tc_put(scene, "transfer_function", "unit_distance", tc_number(tc_run_unit_distance(run)));
}

static void tc_method_put(json_t *scene, const tc_render_run *run)
{
    static const char *const name[] = {
        [TC_INTEGRATOR_AUTO] = "auto",
        [TC_INTEGRATOR_TABLE] = "table",
        [TC_INTEGRATOR_INTEGRAL] = "integral",
        [TC_INTEGRATOR_EXACT] = "exact",
    };
    const tc_render_options *render = &run->render;
    const double size[2] = {run->options->size.width, run->options->size.height};
    if (run->chosen) {
        tc_put(scene, "method", "integrator", json_string(name[render->integrator]));
        if (render->integral_order > 0)
            tc_put(scene, "method", "integral_order", json_integer(render->integral_order));
        if (render->integral_split > 0)
            tc_put(scene, "method", "integral_split", tc_number(render->integral_split));
        if (render->opacity_stop > 0)
            tc_put(scene, "method", "opacity_stop", tc_number(render->opacity_stop));
        if (render->table_size[0] > 0)
            tc_put(scene, "method", "table_size",
                   json_pack("[iii]", render->table_size[0], render->table_size[1], render->table_size[2]));
        if (render->table_format != TC_TABLE_AUTO)
            tc_put(scene, "method", "table_format",
                   json_string(render->table_format == TC_TABLE_8     ? "8"
                               : render->table_format == TC_TABLE_16F ? "16f"
                                                                      : "32f"));
    }
    if (*run->first.driver)
        tc_put(scene, "method", "driver", json_string(run->first.driver));
    if (*run->first.context)
        tc_put(scene, "method", "gl", json_string(run->first.context));
    tc_put(scene, "output", "size", tc_numbers(size, 2));
    if (run->options->out.stereo > TC_STEREO_PAIR) { /* a picture of a pair is one of its eye's camera */
        tc_put(scene, "output", "stereo", json_string(tc_stereo_choice[run->options->out.stereo].name));
        tc_put(scene, "output", "eye_angle", tc_number(run->options->out.eye_angle));
    }
}

char *tc_scene_text(const tc_render_run *run)
{
    json_t *scene = json_object();
    tc_data_put(scene, run);
    tc_given_put(scene, run);
    tc_camera_put(scene, &run->camera);
    tc_function_put(scene, run);
    tc_method_put(scene, run);
    char *text = json_dumps(scene, JSON_COMPACT | JSON_SORT_KEYS | JSON_REAL_PRECISION(17));
    json_decref(scene);
    return text;
}
