/* view_keys.c: one camera of a scene's views, or a key of a path, from JSON. */
#define _GNU_SOURCE
#include "cli/batch/view_keys.h"
#include "cli/nearest.h"
#include "cli/options.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TC_AT(member) offsetof(tc_view_keys, member)

/* A key of a camera: n numbers from low to high (low == high: any), n 0: true or false. */
typedef struct tc_camera_key {
    const char *name;
    unsigned bit;
    size_t at;
    int n;
    double low, high;
    bool open; /* low itself is not allowed */
} tc_camera_key;

static const tc_camera_key tc_camera_keys[] = {
    {"position", TC_VIEW_POSITION, TC_AT(position), 3, 0, 0, false},
    {"focal_point", TC_VIEW_FOCAL_POINT, TC_AT(focal_point), 3, 0, 0, false},
    {"view_up", TC_VIEW_UP, TC_AT(view_up), 3, 0, 0, false},
    {"view_angle", TC_VIEW_ANGLE, TC_AT(view_angle), 1, 0, 179.999, true},
    {"parallel", TC_VIEW_PARALLEL, TC_AT(parallel), 0, 0, 0, false},
    {"parallel_scale", TC_VIEW_SCALE, TC_AT(parallel_scale), 1, 0, 1e300, true},
    {"azimuth", TC_VIEW_AZIMUTH, TC_AT(azimuth), 1, 0, 0, false},
    {"elevation", TC_VIEW_ELEVATION, TC_AT(elevation), 1, 0, 0, false},
    {"roll", TC_VIEW_ROLL, TC_AT(roll), 1, 0, 0, false},
    {"zoom", TC_VIEW_ZOOM, TC_AT(zoom), 1, 0, 1e300, true},
    {"clipping_range", TC_VIEW_CLIPPING, TC_AT(clipping_range), 2, 0, 0, false},
    {"window_center", TC_VIEW_WINDOW, TC_AT(window_center), 2, 0, 0, false},
    {"direction", TC_VIEW_DIRECTION, TC_AT(direction), 3, 0, 0, false},
    {"time", TC_VIEW_TIME, TC_AT(time), 1, 0, 1, false}, /* of a path's */
};
enum { TC_CAMERA_KEYS = sizeof tc_camera_keys / sizeof *tc_camera_keys };

static const char *tc_wanted(char room[96], const tc_camera_key *key)
{
    if (key->n == 0)
        return "true or false";
    if (key->n > 1)
        snprintf(room, 96, "a list of %d numbers", key->n);
    else if (key->low == key->high)
        snprintf(room, 96, "a number");
    else if (key->high >= 1e300)
        snprintf(room, 96, "a number above %g", key->low);
    else
        snprintf(room, 96, "a number %s %g and at most %g", key->open ? "above" : "not below", key->low, key->high);
    return room;
}

/* n numbers: a number where n is 1, else a list of them, or their text as an option has it. */
static bool tc_numbers_take(double *out, int n, const json_t *value)
{
    int count = 0;
    if (json_is_string(value) && n > 1)
        return tc_parse_reals(out, &count, n, json_string_value(value)) && count == n;
    if (n > 1 && json_array_size(value) != (size_t)n)
        return false;
    for (int i = 0; i < n; i++) {
        const json_t *one = n > 1 ? json_array_get(value, (size_t)i) : value;
        if (!json_is_number(one))
            return false;
        out[i] = json_number_value(one);
    }
    return true;
}

static int tc_camera_value_take(tc_view_keys *out, const tc_camera_key *key, const json_t *value, const char *where,
                                tc_talk *talk)
{
    char room[96], *field = (char *)out + key->at;
    bool good = key->n == 0 ? json_is_boolean(value) : tc_numbers_take((double *)field, key->n, value);
    if (good && key->n == 0)
        out->parallel = json_is_true(value);
    if (good && key->low < key->high) {
        const double number = *(double *)field;
        good = number <= key->high && (key->open ? number > key->low : number >= key->low);
    }
    if (!good) {
        tc_talk_error(talk, "%s.%s takes %s", where, key->name, tc_wanted(room, key));
        return TC_EXIT_FAILED;
    }
    out->has |= key->bit;
    return -1;
}

static bool tc_is_zero(const double v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* What goes wrong between a camera's keys. */
static int tc_camera_check(const tc_view_keys *keys, const char *where, tc_talk *talk)
{
    if ((keys->has & TC_VIEW_UP) && tc_is_zero(keys->view_up))
        tc_talk_error(talk, "%s.view_up takes a direction, not 0,0,0", where);
    else if ((keys->has & TC_VIEW_DIRECTION) && tc_is_zero(keys->direction))
        tc_talk_error(talk, "%s.direction takes a direction, not 0,0,0", where);
    else if ((keys->has & TC_VIEW_POSITION) && (keys->has & TC_VIEW_FOCAL_POINT) &&
             !memcmp(keys->position, keys->focal_point, sizeof keys->position))
        tc_talk_error(talk, "%s: position and focal_point are the same point, so there is no direction to look", where);
    else if ((keys->has & TC_VIEW_DIRECTION) && (keys->has & TC_VIEW_POSITION))
        tc_talk_error(talk, "%s has both position and direction: leave one out", where);
    else if ((keys->has & TC_VIEW_CLIPPING) &&
             !(keys->clipping_range[0] >= 0 && keys->clipping_range[0] < keys->clipping_range[1]))
        tc_talk_error(talk, "%s.clipping_range takes [near, far] with near not below 0 and far beyond near, not %g, %g",
                      where, keys->clipping_range[0], keys->clipping_range[1]);
    else
        return -1;
    return TC_EXIT_FAILED;
}

int tc_view_keys_read(tc_view_keys *out, char **name, const json_t *json, const char *where, tc_talk *talk)
{
    const char *key;
    json_t *value;
    if (!json_is_object(json)) {
        tc_talk_error(talk, "%s takes a camera {\"position\": [x, y, z], …}", where);
        return TC_EXIT_FAILED;
    }
    json_object_foreach((json_t *)json, key, value)
    {
        tc_nearest search = {.name = key};
        const tc_camera_key *found = NULL;
        if (name && !strcmp(key, "name")) {
            const char *text = json_string_value(value);
            if (!text || !*text) {
                tc_talk_error(talk, "%s.name takes a text", where);
                return TC_EXIT_FAILED;
            }
            *name = strdup(text);
            if (!*name) {
                tc_talk_error(talk, "memory ran out");
                return TC_EXIT_FAILED;
            }
            continue;
        }
        if (name)
            tc_nearest_offer(&search, "name");
        for (size_t i = 0; i < TC_CAMERA_KEYS; i++) {
            if (name && tc_camera_keys[i].bit == TC_VIEW_TIME)
                continue;
            tc_nearest_offer(&search, tc_camera_keys[i].name);
            if (!strcmp(tc_camera_keys[i].name, key))
                found = &tc_camera_keys[i];
        }
        if (!found) {
            tc_talk_error(talk, "%s has no key '%s'; the nearest is '%s'", where, key, search.best);
            return TC_EXIT_FAILED;
        }
        int code = tc_camera_value_take(out, found, value, where, talk);
        if (code >= 0)
            return code;
    }
    return tc_camera_check(out, where, talk);
}
