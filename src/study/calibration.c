/* calibration.c: what was measured of a mesh with a transfer function, kept from run to run in a small file.
 * A file is named by a hash of its key and holds the key, so that two keys of one hash are told apart. */
#define _GNU_SOURCE
#include "study/calibration.h"

#include "core/file.h"
#include "core/memory.h"

#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { FORMAT = 2, PATH_SIZE = 4096 };

/* ----------------------------------------------------------------------------------------------------------- key */

static uint64_t mix(uint64_t h, uint64_t word)
{
    h = (h ^ word) * 0x9e3779b97f4a7c15u;
    return h ^ h >> 29;
}

static uint64_t hash_bytes(uint64_t h, const void *data, size_t bytes)
{
    const unsigned char *at = data;
    uint64_t word = 0;
    h = mix(h, bytes);
    for (; bytes >= sizeof word; at += sizeof word, bytes -= sizeof word) {
        memcpy(&word, at, sizeof word);
        h = mix(h, word);
    }
    word = 0;
    memcpy(&word, at, bytes);
    return mix(mix(h, word), 0x5bd1e995u);
}

char *tc_calibration_key(const tc_mesh *mesh, const tc_transfer *tf, double unit, const char *renderer,
                         const tc_render_options *fixed)
{
    size_t n_scalar = mesh->association == TC_CELL_DATA ? mesh->n_tet : mesh->n_vertex;
    uint64_t shape = hash_bytes(1, mesh->vertex, mesh->n_vertex * 3 * sizeof(double)), values = 2, knots = 3;
    shape = hash_bytes(shape, mesh->tet, (mesh->n_tet + mesh->n_imaginary) * 4 * sizeof(int32_t));
    shape = mix(mix(shape, mesh->n_imaginary), (uint64_t)mesh->report.reentry);
    if (mesh->scalar)
        values = hash_bytes(values, mesh->scalar, n_scalar * sizeof(double));
    values = mix(values, (uint64_t)mesh->association);
    for (size_t i = 0; i < tf->n; i++) {
        const double row[5] = {tf->knot[i].s, tf->knot[i].r, tf->knot[i].g, tf->knot[i].b, tf->knot[i].a};
        knots = hash_bytes(knots, row, sizeof row);
    }
    char *key = NULL, nan[128] = "none";
    const double *c = fixed->nan_color;
    const int *size = fixed->table_size;
    if (fixed->has_nan_color)
        snprintf(nan, sizeof nan, "%.17g,%.17g,%.17g,%.17g", c[0], c[1], c[2], c[3]);
    int length = asprintf(
        &key,
        "format %d, tetcast %s, mesh %016llx, values %016llx, function %016llx, unit %.17g, nan %s, renderer %s, "
        "integrator %d, order %d, split %.17g, table %dx%dx%d-%d, stop %.17g, state %d, stepper %d%s",
        FORMAT, tc_version(), (unsigned long long)shape, (unsigned long long)values, (unsigned long long)knots, unit,
        nan, renderer, (int)fixed->integrator, fixed->integral_order, fixed->integral_split, size[0], size[1], size[2],
        (int)fixed->table_format, fixed->opacity_stop, (int)fixed->state_format, (int)fixed->stepper,
        fixed->samples == TC_SAMPLES_ADAPTIVE ? ", adaptive" : ""); /* it errs by more than its rays */
    return length < 0 ? NULL : key;
}

uint64_t tc_calibration_view(const tc_camera *camera, const tc_render_options *options)
{
    const double camera_words[] = {camera->position[0],      camera->position[1],     camera->position[2],
                                   camera->focal_point[0],   camera->focal_point[1],  camera->focal_point[2],
                                   camera->view_up[0],       camera->view_up[1],      camera->view_up[2],
                                   camera->view_angle,       camera->parallel_scale,  camera->parallel ? 1 : 0,
                                   camera->clip_near,        camera->clip_far,        (double)options->samples,
                                   camera->window_center[0], camera->window_center[1]};
    const int picture[] = {options->width,          options->height,      options->steps_per_pass,
                           options->z_update_every, options->whole_width, options->whole_height,
                           options->part_x,         options->part_y};
    uint64_t view = hash_bytes(hash_bytes(4, camera_words, sizeof camera_words), picture, sizeof picture);
    return view ? view : 1;
}

/* ---------------------------------------------------------------------------------------------------------- file */

void tc_calibration_folder(char *out, size_t capacity, const char *folder)
{
    const char *own = folder ? folder : getenv("TETCAST_CACHE");
    const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int length = 0;
    *out = 0;
    if (folder || (own && *own))
        length = snprintf(out, capacity, "%s", own);
    else if (cache && *cache == '/') /* the specification: relative ones are to be ignored */
        length = snprintf(out, capacity, "%s/tetcast", cache);
    else if (home && *home == '/')
        length = snprintf(out, capacity, "%s/.cache/tetcast", home);
    if (length < 0 || (size_t)length >= capacity)
        *out = 0;
}

/* "" where there is no folder. */
static void file_of(char out[PATH_SIZE], const char *folder, const char *key)
{
    char base[PATH_SIZE - 32];
    *out = 0;
    tc_calibration_folder(base, sizeof base, folder);
    if (*base)
        snprintf(out, PATH_SIZE, "%s/%016llx.json", base, (unsigned long long)hash_bytes(5, key, strlen(key)));
}

/* The folder of path and those above it that are missing. */
static bool make_folders(const char *path)
{
    char part[PATH_SIZE];
    snprintf(part, sizeof part, "%s", path);
    for (char *slash = strchr(part + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        if (mkdir(part, 0700) != 0 && errno != EEXIST && errno != EISDIR && errno != EROFS && errno != EACCES)
            return false;
        *slash = '/';
    }
    return true;
}

/* A number of 0 or more; NAN where there is none. */
static double number_at(const json_t *object, const char *name)
{
    const json_t *value = json_object_get(object, name);
    double number = json_is_number(value) ? json_number_value(value) : NAN;
    return number >= 0 ? number : NAN;
}

/* NULL, or what is wrong with it. */
static const char *take(tc_calibration *out, tc_candidate *copy, size_t n, const json_t *json, const char *key)
{
    const char *text = json_string_value(json_object_get(json, "key"));
    const char *view = json_string_value(json_object_get(json, "view"));
    const json_t *all = json_object_get(json, "candidates");
    if (!text)
        return "it holds no key";
    if (strcmp(text, key) != 0)
        return "it is of another mesh, function or version";
    double rays = number_at(json, "rays"), ms = number_at(json, "ms"), ratio = number_at(json, "ratio");
    if (!(rays >= 1 && rays < 1e15) || !(ms >= 0) || !(ratio >= 1) || !json_is_object(all))
        return "it is damaged";
    *out = (tc_calibration){.rays = (size_t)rays, .ms = ms, .ratio = ratio};
    if (view)
        out->view = strtoull(view, NULL, 16);
    bool any = false;
    for (size_t i = 0; i < n; i++) {
        char name[TC_CANDIDATE_TEXT];
        tc_candidate_key(name, &copy[i]);
        const json_t *one = json_object_get(all, name);
        copy[i].error = json_is_null(json_object_get(one, "error")) ? INFINITY : number_at(one, "error");
        copy[i].ms = out->view ? number_at(one, "ms") : NAN;
        if (isnan(copy[i].error))
            return "it lacks a setting";
        any = any || isfinite(copy[i].error);
    }
    return any ? NULL : "it is damaged";
}

bool tc_calibration_load(tc_calibration *out, tc_candidate *candidate, size_t n, const char *folder, const char *key,
                         const tc_log *log)
{
    char path[PATH_SIZE];
    file_of(path, folder, key);
    if (!*path) {
        tc_say(log, TC_DEBUG, "no folder for calibrations: neither TETCAST_CACHE, XDG_CACHE_HOME nor HOME names one");
        return false;
    }
    void *data = NULL;
    size_t bytes = 0;
    tc_error err = {0};
    if (tc_file_read(&data, &bytes, path, &err) != TC_OK) {
        tc_say(log, TC_DEBUG, "no calibration is kept: %s", err.text);
        return false;
    }
    json_t *json = json_loadb(data, bytes, 0, NULL);
    tc_candidate copy[TC_CANDIDATE_MAX];
    tc_calibration read = {0};
    memcpy(copy, candidate, n * sizeof *copy);
    const char *wrong = json ? take(&read, copy, n, json, key) : "it is no JSON";
    if (wrong) {
        tc_say(log, TC_DEBUG, "%s is ignored: %s", path, wrong);
    } else {
        memcpy(candidate, copy, n * sizeof *copy);
        *out = read;
        tc_say(log, TC_DEBUG, "calibration taken from %s", path);
    }
    json_decref(json);
    free(data);
    return !wrong;
}

void tc_calibration_store(const tc_calibration *calibration, const tc_candidate *candidate, size_t n,
                          const char *folder, const char *key, const tc_log *log)
{
    char path[PATH_SIZE], view[24];
    file_of(path, folder, key);
    if (!*path)
        return;
    json_t *json = json_object(), *all = json_object();
    snprintf(view, sizeof view, "%016llx", (unsigned long long)calibration->view);
    json_object_set_new(json, "key", json_string(key));
    json_object_set_new(json, "rays", json_integer((json_int_t)calibration->rays));
    json_object_set_new(json, "ms", json_real(calibration->ms));
    json_object_set_new(json, "ratio", json_real(calibration->ratio));
    if (calibration->view)
        json_object_set_new(json, "view", json_string(view));
    for (size_t i = 0; i < n; i++) {
        char name[TC_CANDIDATE_TEXT];
        json_t *one = json_object();
        tc_candidate_key(name, &candidate[i]);
        json_object_set_new(one, "error", isfinite(candidate[i].error) ? json_real(candidate[i].error) : json_null());
        if (isfinite(candidate[i].ms))
            json_object_set_new(one, "ms", json_real(candidate[i].ms));
        json_object_set_new(all, name, one);
    }
    json_object_set_new(json, "candidates", all);
    char *text = json_dumps(json, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    json_decref(json);
    tc_error err = {0};
    if (!text)
        return;
    if (!make_folders(path) || tc_file_replace(path, text, strlen(text), &err) != TC_OK)
        tc_say(log, TC_DEBUG, "the calibration is not kept: %s", *err.text ? err.text : path);
    else
        tc_say(log, TC_DEBUG, "calibration kept in %s", path);
    free(text);
}
