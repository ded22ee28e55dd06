/* views_read.c: "views" of a scene from JSON. */
#define _GNU_SOURCE
#include "cli/batch/names.h"
#include "cli/batch/view_keys.h"
#include "cli/batch/views.h"
#include "cli/nearest.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What is read, and how errors name it. */
typedef struct tc_reader {
    tc_views *out;
    const char *called;
    tc_talk *talk;
} tc_reader;

static int tc_out_of_memory(tc_talk *talk)
{
    tc_talk_error(talk, "memory ran out");
    return TC_EXIT_FAILED;
}

/* A list of cameras, or of a path's keys. */
static int tc_cameras_take(const tc_reader *r, const json_t *list, bool path)
{
    tc_views *out = r->out;
    const size_t n = json_array_size(list), least = path ? 2 : 1;
    if (n < least || n > TC_VIEWS_MOST) {
        tc_talk_error(r->talk, "%s takes a list of %zu to %d cameras", out->called, least, TC_VIEWS_MOST);
        return TC_EXIT_FAILED;
    }
    out->key = calloc(n, sizeof *out->key);
    out->name = path ? NULL : calloc(n, sizeof *out->name);
    if (!out->key || (!path && !out->name))
        return tc_out_of_memory(r->talk);
    out->n_key = n;
    out->n_name = path ? 0 : n;
    int code = -1;
    for (size_t i = 0; i < n && code < 0; i++) {
        char *where = NULL;
        if (asprintf(&where, "%s[%zu]", out->called, i) < 0)
            return tc_out_of_memory(r->talk);
        code = tc_view_keys_read(&out->key[i], path ? NULL : &out->name[i], json_array_get(list, i), where, r->talk);
        free(where);
    }
    return code;
}

/* ---------------------------------------------------------------------------------------------------------- forms */

/* A whole number from 1 up. */
static int tc_count_take(const tc_reader *r, size_t *out, const json_t *value, const char *key)
{
    const json_int_t n = json_integer_value(value);
    if (!json_is_integer(value) || n < 1 || n > TC_VIEWS_MOST) {
        tc_talk_error(r->talk, "%s.%s takes a whole number from 1 to %d", r->called, key, TC_VIEWS_MOST);
        return TC_EXIT_FAILED;
    }
    *out = (size_t)n;
    return -1;
}

/* An angle that may be left out. */
static int tc_angle_take(const tc_reader *r, double *out, const json_t *json, const char *key)
{
    const json_t *value = json_object_get(json, key);
    if (value && !json_is_number(value)) {
        tc_talk_error(r->talk, "%s.%s takes a number of degrees", r->called, key);
        return TC_EXIT_FAILED;
    }
    if (value)
        *out = json_number_value(value);
    return -1;
}

/* n angles from … to; turn: the end is left out where it is the beginning again. The caller frees them. */
static int tc_angles_spread(const tc_reader *r, double **out, size_t n, double from, double to, bool turn)
{
    *out = malloc(n * sizeof **out);
    if (!*out)
        return tc_out_of_memory(r->talk);
    const bool again = turn && to != from && fmod(to - from, 360) == 0;
    const size_t parts = again ? n : n > 1 ? n - 1 : 1;
    for (size_t i = 0; i < n; i++)
        (*out)[i] = from + (to - from) * (double)i / (double)parts;
    return -1;
}

/* Refuses a key that object has beside those of known (NULL at the end). */
static int tc_keys_check(const tc_reader *r, const json_t *object, const char *const *known, const char *where)
{
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)object, key, value)
    {
        tc_nearest search = {.name = key};
        bool found = false;
        for (size_t i = 0; known[i]; i++) {
            tc_nearest_offer(&search, known[i]);
            found = found || !strcmp(known[i], key);
        }
        if (!found) {
            tc_talk_error(r->talk, "%s%s has no key '%s'; the nearest is '%s'", r->called, where, key, search.best);
            return TC_EXIT_FAILED;
        }
    }
    return -1;
}

static int tc_orbit_take(const tc_reader *r, const json_t *json)
{
    static const char *const known[] = {"orbit", "elevation", "from", "to", "names", "along", NULL};
    tc_views *out = r->out;
    const json_t *orbit = json_object_get(json, "orbit");
    out->kind = TC_VIEWS_ORBIT;
    out->to = 360;
    int code = tc_keys_check(r, json, known, "");
    code = code < 0 ? tc_angle_take(r, &out->from, json, "from") : code;
    code = code < 0 ? tc_angle_take(r, &out->to, json, "to") : code;
    code = code < 0 ? tc_angle_take(r, &out->elevation, json, "elevation") : code;
    if (code >= 0)
        return code;
    if (out->along && json_is_true(orbit))
        return -1;
    if (out->along) {
        tc_talk_error(r->talk, "%s.orbit takes true beside \"along\": \"time\": there are as many views as steps",
                      r->called);
        return TC_EXIT_FAILED;
    }
    code = tc_count_take(r, &out->n_phi, orbit, "orbit");
    code = code < 0 ? tc_angles_spread(r, &out->phi, out->n_phi, out->from, out->to, true) : code;
    out->n_theta = 1;
    return code < 0 ? tc_angles_spread(r, &out->theta, 1, out->elevation, out->elevation, false) : code;
}

/* One of a grid's: a list, a range, a count, or NULL for 0. */
static int tc_grid_angles_take(const tc_reader *r, double **out, size_t *n, const json_t *json, const char *key)
{
    const bool phi = !strcmp(key, "phi");
    const json_t *value = json_object_get(json, key);
    *n = 1;
    if (!value)
        return tc_angles_spread(r, out, 1, 0, 0, false);
    if (json_is_object(value)) {
        static const char *const known[] = {"from", "to", "count", NULL};
        const json_t *from = json_object_get(value, "from"), *to = json_object_get(value, "to");
        char where[16], count[24];
        snprintf(where, sizeof where, ".%s", key);
        snprintf(count, sizeof count, "%s.count", key);
        int code = tc_keys_check(r, value, known, where);
        if (code < 0 && (!json_is_number(from) || !json_is_number(to))) {
            tc_talk_error(r->talk, "%s.%s takes {\"from\": degrees, \"to\": degrees, \"count\": N}", r->called, key);
            code = TC_EXIT_FAILED;
        }
        code = code < 0 ? tc_count_take(r, n, json_object_get(value, "count"), count) : code;
        return code < 0 ? tc_angles_spread(r, out, *n, json_number_value(from), json_number_value(to), phi) : code;
    }
    if (json_is_array(value)) {
        bool good = json_array_size(value) > 0 && json_array_size(value) <= TC_VIEWS_MOST;
        *n = json_array_size(value);
        *out = good ? malloc(*n * sizeof **out) : NULL;
        if (good && !*out)
            return tc_out_of_memory(r->talk);
        for (size_t i = 0; i < *n && good; i++) {
            good = json_is_number(json_array_get(value, i));
            (*out)[i] = json_number_value(json_array_get(value, i));
        }
        if (good)
            return -1;
        tc_talk_error(r->talk, "%s.%s takes a list of 1 to %d numbers of degrees", r->called, key, TC_VIEWS_MOST);
        return TC_EXIT_FAILED;
    }
    if (!json_is_integer(value)) {
        tc_talk_error(r->talk, "%s.%s takes a list of degrees, {\"from\": …, \"to\": …, \"count\": N}, or how many",
                      r->called, key);
        return TC_EXIT_FAILED;
    }
    int code = tc_count_take(r, n, value, key);
    if (code >= 0)
        return code;
    if (phi)
        return tc_angles_spread(r, out, *n, 0, 360, true);
    return tc_angles_spread(r, out, *n, *n > 1 ? -90 : 0, *n > 1 ? 90 : 0, false);
}

static int tc_grid_take(const tc_reader *r, const json_t *json)
{
    static const char *const known[] = {"phi", "theta", "names", "along", NULL};
    tc_views *out = r->out;
    out->kind = TC_VIEWS_GRID;
    int code = tc_keys_check(r, json, known, "");
    if (code < 0 && out->along) {
        tc_talk_error(r->talk, "%s.along does not go with phi and theta: take an orbit or a path", r->called);
        code = TC_EXIT_FAILED;
    }
    code = code < 0 ? tc_grid_angles_take(r, &out->phi, &out->n_phi, json, "phi") : code;
    return code < 0 ? tc_grid_angles_take(r, &out->theta, &out->n_theta, json, "theta") : code;
}

/* Gives each key of a path its time. */
static int tc_path_times_take(const tc_reader *r)
{
    tc_views *out = r->out;
    size_t timed = 0;
    const double parts = (double)(out->closed ? out->n_key : out->n_key - 1);
    for (size_t i = 0; i < out->n_key; i++)
        timed += (out->key[i].has & TC_VIEW_TIME) != 0;
    if (timed != 0 && timed != out->n_key) {
        tc_talk_error(r->talk, "%s: %zu of its %zu cameras have a time: give all of them one, or none", out->called,
                      timed, out->n_key);
        return TC_EXIT_FAILED;
    }
    for (size_t i = 0; i < out->n_key; i++) {
        if (timed == 0)
            out->key[i].time = (double)i / parts;
        if (i > 0 && !(out->key[i].time > out->key[i - 1].time)) {
            tc_talk_error(r->talk, "%s[%zu].time is %g, which is not after that of the camera before it, %g",
                          out->called, i, out->key[i].time, out->key[i - 1].time);
            return TC_EXIT_FAILED;
        }
    }
    if (out->closed && !(out->key[out->n_key - 1].time - out->key[0].time < 1)) {
        tc_talk_error(r->talk,
                      "%s is closed and its cameras' times go from 0 to 1, which leaves none for the way back: end "
                      "below 1",
                      out->called);
        return TC_EXIT_FAILED;
    }
    return -1;
}

static int tc_path_take(const tc_reader *r, const json_t *json)
{
    static const char *const known[] = {"path", "count", "closed", "names", "along", NULL};
    tc_views *out = r->out;
    const json_t *count = json_object_get(json, "count"), *closed = json_object_get(json, "closed");
    out->kind = TC_VIEWS_PATH;
    int code = tc_keys_check(r, json, known, "");
    if (code >= 0)
        return code;
    if (closed && !json_is_boolean(closed)) {
        tc_talk_error(r->talk, "%s.closed takes true or false", r->called);
        return TC_EXIT_FAILED;
    }
    out->closed = json_is_true(closed);
    if (out->along && count) {
        tc_talk_error(r->talk, "%s.count does not go with \"along\": \"time\": there are as many views as steps",
                      r->called);
        return TC_EXIT_FAILED;
    }
    code = out->along ? -1 : tc_count_take(r, &out->n, count, "count");
    code = code < 0 ? tc_cameras_take(r, json_object_get(json, "path"), true) : code;
    return code < 0 ? tc_path_times_take(r) : code;
}

static int tc_list_take(const tc_reader *r, const json_t *json, const json_t *cameras)
{
    static const char *const known[] = {"cameras", "along", NULL};
    r->out->kind = TC_VIEWS_LIST;
    int code = json_is_object(json) ? tc_keys_check(r, json, known, "") : -1;
    return code < 0 ? tc_cameras_take(r, cameras, false) : code;
}

/* ---------------------------------------------------------------------------------------------------------- names */

static int tc_by_text(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* The "names" of an orbit, a grid or a path. */
static int tc_names_take(const tc_reader *r, const json_t *names)
{
    tc_views *out = r->out;
    if (out->along) {
        tc_talk_error(r->talk, "%s.names does not go with \"along\": \"time\"", r->called);
        return TC_EXIT_FAILED;
    }
    if (json_array_size(names) != out->n) {
        tc_talk_error(r->talk, "%s.names takes a list of as many texts as there are views, %zu", r->called, out->n);
        return TC_EXIT_FAILED;
    }
    out->name = calloc(out->n, sizeof *out->name);
    if (!out->name)
        return tc_out_of_memory(r->talk);
    out->n_name = out->n;
    for (size_t i = 0; i < out->n; i++) {
        const char *text = json_string_value(json_array_get(names, i));
        if (!text || !*text) {
            tc_talk_error(r->talk, "%s.names[%zu] takes a text", r->called, i);
            return TC_EXIT_FAILED;
        }
        out->name[i] = strdup(text);
        if (!out->name[i])
            return tc_out_of_memory(r->talk);
    }
    return -1;
}

/* Would pictures of two views have one name? */
static int tc_names_check(const tc_reader *r)
{
    const tc_views *views = r->out;
    const size_t n = views->n_name;
    char **safe = calloc(n + 1, sizeof *safe);
    int code = safe ? -1 : tc_out_of_memory(r->talk);
    for (size_t i = 0; i < n && code < 0; i++) {
        char name[256], text[256];
        tc_view_name(name, sizeof name, views, i);
        tc_name_safe(text, sizeof text, name);
        safe[i] = strdup(text);
        if (!safe[i])
            code = tc_out_of_memory(r->talk);
    }
    if (code < 0)
        qsort(safe, n, sizeof *safe, tc_by_text);
    for (size_t i = 1; i < n && code < 0; i++)
        if (!strcmp(safe[i], safe[i - 1])) {
            tc_talk_error(r->talk, "%s: two views are called '%s' in files' names: give each its own", r->called,
                          safe[i]);
            code = TC_EXIT_FAILED;
        }
    for (size_t i = 0; i < n && safe; i++)
        free(safe[i]);
    free(safe);
    return code;
}

/* ---------------------------------------------------------------------------------------------------------- whole */

static int tc_along_take(const tc_reader *r, const json_t *json)
{
    const json_t *along = json_object_get(json, "along");
    const char *text = json_string_value(along);
    r->out->along = along != NULL;
    if (!along || (text && !strcmp(text, "time")))
        return -1;
    tc_talk_error(r->talk, "%s.along takes \"time\"", r->called);
    return TC_EXIT_FAILED;
}

/* Which form an object is of: the key that stands for it; NULL after an error was printed. */
static const char *tc_form_find(const tc_reader *r, const json_t *json)
{
    static const char *const forms[] = {"cameras", "orbit", "path", "phi", "theta"};
    const char *found = NULL;
    for (size_t i = 0; i < 5; i++) {
        if (!json_object_get(json, forms[i]))
            continue;
        if (found && !(i == 4 && !strcmp(found, "phi"))) {
            tc_talk_error(r->talk, "%s has both %s and %s: take one", r->called, found, forms[i]);
            return NULL;
        }
        found = found ? found : forms[i];
    }
    if (!found) {
        const char *key = json_object_iter_key(json_object_iter((json_t *)json));
        tc_nearest search = {.name = key ? key : ""};
        for (size_t i = 0; i < 5; i++)
            tc_nearest_offer(&search, forms[i]);
        tc_talk_error(r->talk,
                      "%s takes a list of cameras, or an object with cameras, orbit, path, or phi and theta%s%s%s%s%s",
                      r->called, key ? ", not '" : "", key ? key : "", key ? "'; the nearest is '" : "",
                      key ? search.best : "", key ? "'" : "");
    }
    return found;
}

/* What stands in errors about cameras and steps: form "" for a list. */
static int tc_called_set(const tc_reader *r, const char *form)
{
    if (asprintf(&r->out->called, "%s%s%s", r->called, *form ? "." : "", form) >= 0)
        return -1;
    r->out->called = NULL;
    return tc_out_of_memory(r->talk);
}

int tc_views_read(tc_views *out, const json_t *json, const char *called, tc_talk *talk)
{
    const tc_reader r = {out, called, talk};
    *out = (tc_views){0};
    if (!json || json_is_null(json))
        return -1;
    const char *form = json_is_array(json) ? "" : json_is_object(json) ? tc_form_find(&r, json) : NULL;
    if (!form) {
        if (!json_is_object(json))
            tc_talk_error(talk, "%s takes a list of cameras, or an object with cameras, orbit, path, or phi and theta",
                          called);
        return TC_EXIT_FAILED;
    }
    int code = tc_called_set(&r, form);
    code = code < 0 && *form ? tc_along_take(&r, json) : code;
    if (code >= 0)
        return code;
    if (!*form || !strcmp(form, "cameras"))
        code = tc_list_take(&r, json, *form ? json_object_get(json, form) : json);
    else if (!strcmp(form, "orbit"))
        code = tc_orbit_take(&r, json);
    else if (!strcmp(form, "path"))
        code = tc_path_take(&r, json);
    else
        code = tc_grid_take(&r, json);
    if (code >= 0)
        return code;
    if (out->kind == TC_VIEWS_LIST)
        out->n = out->n_key;
    else if (out->kind != TC_VIEWS_PATH)
        out->n = out->n_phi * out->n_theta;
    if (out->n > TC_VIEWS_MOST) {
        tc_talk_error(talk, "%s has %zu views, and %d at most are allowed", called, out->n, TC_VIEWS_MOST);
        return TC_EXIT_FAILED;
    }
    const json_t *names = json_object_get(json, "names");
    code = names ? tc_names_take(&r, names) : -1;
    return code < 0 ? tc_names_check(&r) : code;
}

void tc_views_finish(tc_views *views)
{
    for (size_t i = 0; i < views->n_name; i++)
        free(views->name[i]);
    free(views->name);
    free(views->key);
    free(views->phi);
    free(views->theta);
    free(views->called);
    *views = (tc_views){0};
}
