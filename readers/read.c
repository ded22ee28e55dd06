/* read.c: tc_mesh_read: asks the helper program tetcast-read for one step of a file and makes a mesh of its arrays;
 * tc_mesh_read_values: takes the values alone where the mesh is there already; tc_field_read: makes a field of them.
 *
 * Request: {"do": "read", "path", "field"?, "association": 0..2, "time"?, "step"?, "refine", "all_ranges", "keep",
 * "mesh"?}: keep: more requests follow, so what tells whether the mesh is the same may be kept; mesh: leave vertex, tet
 * and cell out where mesh_hash comes out as this.
 * Result: {"mesh_hash": 16 hexadecimal digits, "same_mesh": were arrays left out?, "format", "reader", "field"?,
 * "association"?, "points", "cells", "solid_cells", "dropped_cells",
 * "degenerate", "turned", "unused_points", "merged_points", "linearised", "refine", "step", "times": [], "offered":
 * [{"name", "association", "components", "ranged", "lo"?, "hi"?}], "blocks": [{"number", "name"?}], "cell_types": [{"type", "dimension", "count"}],
 * "notes": []} and the arrays vertex (f64), tet (i32), cell (i64: the file's cell of each tet), scalar (f64; absent
 * without a field). */
#define _GNU_SOURCE

#include "read.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "mesh/field.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TC_HASH_TEXT = 17 }; /* characters of a hash, with the end */

/* ------------------------------------------------------------------------------------------ request */

tc_status tc_read_request(json_t **out, const char *what, const char *path, const tc_read_options *options,
                          tc_error *err)
{
    json_t *request = json_object();
    int bad = !request;
    *out = NULL;
    bad |= json_object_set_new(request, "do", json_string(what));
    json_t *name = json_string(path);
    if (!name) {
        json_decref(request);
        return tc_fail(err, TC_E_FILE, "the name of file %s is not UTF-8; rename it", path);
    }
    bad |= json_object_set_new(request, "path", name);
    bad |= json_object_set_new(request, "association", json_integer(options->association));
    bad |= json_object_set_new(request, "refine", json_integer(options->refine));
    bad |= json_object_set_new(request, "all_ranges", json_boolean(options->all_ranges || !options->field));
    if (options->field) {
        json_t *field = json_string(options->field);
        if (!field) {
            json_decref(request);
            return tc_fail(err, TC_E_ARG, "the name of the array is not UTF-8");
        }
        bad |= json_object_set_new(request, "field", field);
    }
    if (options->has_time)
        bad |= json_object_set_new(request, "time", json_real(options->time));
    if (options->has_step)
        bad |= json_object_set_new(request, "step", json_integer(options->step));
    if (bad) {
        json_decref(request);
        return tc_fail_memory(err, "a request", 1, 256);
    }
    *out = request;
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------ source */

/* One block that strings and arrays are cut from; without a block it only counts. */
typedef struct arena {
    char *base;
    size_t used;
} arena;

static void *take(arena *a, size_t bytes)
{
    void *p = a->base ? a->base + a->used : NULL;
    a->used += (bytes + 15) & ~(size_t)15;
    return p;
}

static const char *take_text(arena *a, const char *text)
{
    if (!text)
        return NULL;
    const size_t n = strlen(text) + 1;
    char *p = take(a, n);
    if (p)
        memcpy(p, text, n);
    return p;
}

static size_t count_of(const json_t *json, const char *key)
{
    const json_int_t n = json_integer_value(json_object_get(json, key));
    return n > 0 ? (size_t)n : 0;
}

static const char *text_of(const json_t *json, const char *key)
{
    return json_string_value(json_object_get(json, key));
}

static void fill_arrays(tc_source *s, arena *a, const json_t *list)
{
    s->n_array = json_array_size(list);
    tc_array_info *info = take(a, s->n_array * sizeof *info);
    s->array = info;
    for (size_t i = 0; i < s->n_array; i++) {
        const json_t *row = json_array_get(list, i);
        const char *name = take_text(a, text_of(row, "name"));
        if (!info)
            continue;
        const json_t *lo = json_object_get(row, "lo"), *hi = json_object_get(row, "hi");
        const bool ranged = json_is_true(json_object_get(row, "ranged"));
        info[i].name = name;
        info[i].association = (tc_association)json_integer_value(json_object_get(row, "association"));
        info[i].components = (int)json_integer_value(json_object_get(row, "components"));
        info[i].lo = lo ? json_number_value(lo) : ranged ? INFINITY : NAN;
        info[i].hi = hi ? json_number_value(hi) : ranged ? -INFINITY : NAN;
    }
}

static void fill_blocks(tc_source *s, arena *a, const json_t *list)
{
    s->n_block = json_array_size(list);
    tc_block_info *info = take(a, s->n_block * sizeof *info);
    s->block = info;
    for (size_t i = 0; i < s->n_block; i++) {
        const json_t *row = json_array_get(list, i);
        const char *name = take_text(a, text_of(row, "name"));
        if (info)
            info[i] = (tc_block_info){json_integer_value(json_object_get(row, "number")), name};
    }
}

static void fill_cells(tc_source *s, arena *a, const json_t *list)
{
    s->n_cell_type = json_array_size(list);
    tc_cell_info *info = take(a, s->n_cell_type * sizeof *info);
    s->cell_type = info;
    for (size_t i = 0; i < s->n_cell_type; i++) {
        const json_t *row = json_array_get(list, i);
        const char *type = take_text(a, text_of(row, "type"));
        if (!info)
            continue;
        info[i].type = type;
        info[i].dimension = (int)json_integer_value(json_object_get(row, "dimension"));
        info[i].count = count_of(row, "count");
    }
}

static void fill_source(tc_source *s, arena *a, const char *path, const tc_reply *reply, double ms)
{
    const json_t *json = reply->json;
    memset(s, 0, sizeof *s);
    s->path = take_text(a, path);
    s->format = take_text(a, text_of(json, "format"));
    s->reader = take_text(a, text_of(json, "reader"));
    s->field = take_text(a, text_of(json, "field"));
    s->n_point = count_of(json, "points");
    s->n_cell = count_of(json, "cells");
    fill_arrays(s, a, json_object_get(json, "offered"));
    fill_blocks(s, a, json_object_get(json, "blocks"));
    fill_cells(s, a, json_object_get(json, "cell_types"));
    const json_t *times = json_object_get(json, "times");
    s->n_time = json_array_size(times);
    double *time = take(a, s->n_time * sizeof *time);
    for (size_t i = 0; time && i < s->n_time; i++)
        time[i] = json_number_value(json_array_get(times, i));
    s->time = time;
    s->step = (int)json_integer_value(json_object_get(json, "step"));
    s->dropped_cells = count_of(json, "dropped_cells");
    s->linearised = json_is_true(json_object_get(json, "linearised"));
    s->refine = (int)count_of(json, "refine");
    const json_t *notes = json_object_get(json, "notes");
    s->n_note = json_array_size(notes);
    const char **note = take(a, s->n_note * sizeof *note);
    for (size_t i = 0; i < s->n_note; i++) {
        const char *line = take_text(a, json_string_value(json_array_get(notes, i)));
        if (note)
            note[i] = line;
    }
    s->note = note;
    s->ms_read = ms;
    s->helper_peak_bytes = reply->peak_bytes;
}

/* *memory gets the one block that *out points into. */
static tc_status make_source(tc_source **out, void **memory, const char *path, const tc_reply *reply, double ms,
                             tc_error *err)
{
    arena measure = {NULL, 0};
    tc_source *source = tc_calloc(1, sizeof *source);
    if (!source)
        return tc_fail_memory(err, "the description of a file", 1, sizeof *source);
    fill_source(source, &measure, path, reply, ms);
    arena block = {tc_calloc(measure.used + 16, 1), 0};
    if (!block.base) {
        free(source);
        return tc_fail_memory(err, "the description of a file", measure.used, 1);
    }
    fill_source(source, &block, path, reply, ms);
    *out = source;
    *memory = block.base;
    return TC_OK;
}

static uint64_t hash_of(const tc_reply *reply)
{
    const char *text = text_of(reply->json, "mesh_hash");
    return text ? strtoull(text, NULL, 16) : 0;
}

/* ------------------------------------------------------------------------------------------ mesh */

bool tc_read_is_same(const tc_reply *reply)
{
    return json_is_true(json_object_get(reply->json, "same_mesh"));
}

int tc_read_step(const tc_reply *reply)
{
    return (int)json_integer_value(json_object_get(reply->json, "step"));
}

tc_status tc_read_values_of(const double **out, tc_association *association, const tc_reply *reply, size_t n_vertex,
                            size_t n_tet, tc_error *err)
{
    const tc_array *scalar = tc_reply_array(reply, "scalar", TC_F64);
    *out = NULL;
    *association = TC_POINT_DATA;
    if (!scalar)
        return TC_OK;
    const bool cell_data = json_integer_value(json_object_get(reply->json, "association")) == TC_CELL_DATA;
    const size_t want = cell_data ? n_tet : n_vertex;
    if (scalar->count != want)
        return tc_fail(err, TC_E_WORKER, "tetcast-read gave %zu values for %zu places; is it of another version?",
                       scalar->count, want);
    *out = scalar->data;
    *association = cell_data ? TC_CELL_DATA : TC_POINT_DATA;
    return TC_OK;
}

tc_status tc_read_make_mesh(tc_mesh **out, const char *path, const tc_reply *reply, double ms, tc_error *err)
{
    const tc_array *vertex = tc_reply_array(reply, "vertex", TC_F64);
    const tc_array *tet = tc_reply_array(reply, "tet", TC_I32);
    if (!vertex || !tet || vertex->count % 3 || tet->count % 4)
        return tc_fail(err, TC_E_WORKER,
                       "tetcast-read gave an answer without points or tets; is it of another version?");
    tc_mesh_arrays arrays = {.n_vertex = vertex->count / 3,
                             .vertex = vertex->data,
                             .n_tet = tet->count / 4,
                             .tet = tet->data,
                             .field_name = text_of(reply->json, "field")};
    tc_mesh *mesh = NULL;
    const double start = tc_now_ms();
    tc_status status = tc_read_values_of(&arrays.scalar, &arrays.association, reply, arrays.n_vertex, arrays.n_tet, err);
    if (!status)
        status = tc_mesh_create(&mesh, &arrays, err);
    if (!status)
        status = make_source(&mesh->source, &mesh->source_memory, path, reply, ms, err);
    if (status) {
        tc_mesh_destroy(&mesh);
        return status;
    }
    mesh->source->ms_read = ms + tc_now_ms() - start;
    mesh->source_hash = hash_of(reply);
    mesh->report.source_cells = count_of(reply->json, "solid_cells");
    mesh->file = (tc_file_repairs){.degenerate = count_of(reply->json, "degenerate"),
                                   .turned = count_of(reply->json, "turned"),
                                   .unused_points = count_of(reply->json, "unused_points"),
                                   .merged_points = count_of(reply->json, "merged_points")};
    *out = mesh;
    return TC_OK;
}

tc_status tc_read_take_values(tc_mesh *mesh, const char *path, const tc_reply *reply, double ms, tc_error *err)
{
    const double start = tc_now_ms();
    const double *scalar;
    tc_association association;
    double *none = NULL;
    tc_source *source = NULL;
    void *memory = NULL;
    const char *label = text_of(reply->json, "field");
    char *name = label ? strdup(label) : NULL;
    tc_status status = tc_read_values_of(&scalar, &association, reply, mesh->n_vertex_source, mesh->n_tet_source, err);
    if (!status && label && !name)
        status = tc_fail_memory(err, "the name of an array", strlen(label), 1);
    if (!status && !scalar) {
        none = tc_calloc(mesh->n_vertex_source, sizeof *none);
        scalar = none;
        if (!none)
            status = tc_fail_memory(err, "new values", mesh->n_vertex_source, sizeof *none);
    }
    if (!status)
        status = make_source(&source, &memory, path, reply, ms, err);
    if (!status)
        status = tc_mesh_set_scalar(mesh, scalar, association, err);
    free(none);
    if (status) {
        free(name);
        free(source);
        free(memory);
        return status;
    }
    free(mesh->field_name);
    free(mesh->source);
    free(mesh->source_memory);
    mesh->field_name = name;
    mesh->source = source;
    mesh->source_memory = memory;
    mesh->source->ms_read = ms + tc_now_ms() - start;
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------ calls */

tc_status tc_read_check(const tc_read_options *options, tc_error *err)
{
    if (options->refine < 0 || options->refine > 6)
        return tc_fail(err, TC_E_ARG, "refine %d is not in 0 to 6 (each level makes 8 times as many tets)",
                       options->refine);
    if (options->has_time && !isfinite(options->time))
        return tc_fail(err, TC_E_ARG, "the time to read is not a finite number");
    return TC_OK;
}

tc_status tc_read_call(tc_reply *reply, tc_worker **worker, json_t *request, const char *path,
                       const tc_read_options *options, const tc_log *log, tc_error *err)
{
    const tc_worker_limits limits = {.idle_s = options->idle_limit_s > 0 ? options->idle_limit_s : 60,
                                     .memory_bytes = TC_WORKER_MACHINE};
    *reply = (tc_reply){0};
    tc_status status = TC_OK;
    if (!*worker)
        status = tc_worker_start(worker, "tetcast-read", &limits, err);
    if (!status)
        status = tc_worker_call(reply, *worker, request, NULL, 0, log, err);
    if (status == TC_E_WORKER && *worker)
        tc_fail_prefix(err, status, "%s could not be read, it is probably damaged: ", path);
    if (status && status != TC_E_FILE)
        tc_worker_stop(worker);
    return status;
}

tc_status tc_read_ask(tc_reply *reply, double *ms, tc_worker **worker, const char *path,
                      const tc_read_options *options, bool keep, uint64_t known, const tc_log *log, tc_error *err)
{
    json_t *request;
    const double start = tc_now_ms();
    *reply = (tc_reply){0};
    tc_status status = tc_read_request(&request, "read", path, options, err);
    if (status)
        return status;
    int bad = json_object_set_new(request, "keep", json_boolean(keep));
    if (known) {
        char text[TC_HASH_TEXT];
        snprintf(text, sizeof text, "%016" PRIx64, known);
        bad |= json_object_set_new(request, "mesh", json_string(text));
    }
    status = bad ? tc_fail_memory(err, "a request", 1, 256)
                 : tc_read_call(reply, worker, request, path, options, log, err);
    json_decref(request);
    if (ms)
        *ms = tc_now_ms() - start;
    return status;
}

tc_status tc_mesh_read(tc_mesh **out, const char *path, const tc_read_options *options, const tc_log *log,
                       tc_error *err)
{
    static const tc_read_options defaults = {0};
    if (!out || !path)
        return tc_fail(err, TC_E_ARG, "tc_mesh_read: out or path is NULL");
    *out = NULL;
    if (!options)
        options = &defaults;
    tc_worker *worker = NULL;
    tc_reply reply = {0};
    tc_mesh *mesh = NULL;
    double ms;
    tc_status status = tc_read_check(options, err);
    if (!status)
        status = tc_read_ask(&reply, &ms, &worker, path, options, options->keep_reader, 0, log, err);
    if (!status)
        status = tc_read_make_mesh(&mesh, path, &reply, ms, err);
    tc_reply_finish(&reply);
    if (!status && options->keep_reader)
        mesh->reader = worker;
    else
        tc_worker_stop(&worker);
    *out = mesh;
    return status;
}

tc_status tc_read_fail_moved(const char *path, int step, tc_error *err)
{
    return tc_fail(err, TC_E_MOVED,
                   "%s: the points or cells of step %d are not those of the mesh that is to take its values; read and "
                   "prepare that step as a mesh of its own",
                   path, step);
}

void tc_read_wait(tc_mesh *mesh)
{
    if (mesh->ahead)
        mesh->ahead_wait(mesh->ahead);
}

/* The mesh of a reply whose points or cells are not those of `old`, with the reader that it had. */
static tc_status take_moved(tc_mesh **moved, tc_mesh *old, const char *path, const tc_reply *reply, double ms,
                            tc_error *err)
{
    tc_status status = moved ? tc_read_make_mesh(moved, path, reply, ms, err) : TC_OK;
    if (status)
        return status;
    if (moved) {
        (*moved)->reader = old->reader;
        old->reader = NULL;
    }
    return tc_read_fail_moved(path, tc_read_step(reply), err);
}

tc_status tc_mesh_read_values(tc_mesh **moved, tc_mesh *mesh, const char *path, const tc_read_options *options,
                              const tc_log *log, tc_error *err)
{
    static const tc_read_options defaults = {0};
    if (moved)
        *moved = NULL;
    if (!mesh || !path)
        return tc_fail(err, TC_E_ARG, "tc_mesh_read_values: mesh or path is NULL");
    if (!mesh->source)
        return tc_fail(err, TC_E_ARG,
                       "the mesh that is to take the values of %s was not read from a file; give its values to "
                       "tc_mesh_set_scalar",
                       path);
    if (!options)
        options = &defaults;
    tc_reply reply = {0};
    double ms;
    tc_read_wait(mesh);
    tc_status status = tc_read_check(options, err);
    if (!status)
        status = tc_read_ask(&reply, &ms, &mesh->reader, path, options, true, mesh->source_hash, log, err);
    if (!status && !tc_read_is_same(&reply))
        status = take_moved(moved, mesh, path, &reply, ms, err);
    else if (!status)
        status = tc_read_take_values(mesh, path, &reply, ms, err);
    tc_reply_finish(&reply);
    if (status != TC_E_MESH)
        return status;
    /* Points at one place were merged for equal values, which differ in this step: it needs a mesh of its own. */
    status = tc_read_ask(&reply, &ms, &mesh->reader, path, options, true, 0, log, err);
    if (!status)
        status = take_moved(moved, mesh, path, &reply, ms, err);
    tc_reply_finish(&reply);
    return status;
}

/* The values of a reply as a field of the mesh, which stays as it is. */
static tc_status make_field(tc_field **out, const tc_mesh *mesh, const char *path, const tc_reply *reply, tc_error *err)
{
    const double *value;
    tc_association association;
    if (!tc_read_is_same(reply))
        return tc_fail(
            err, TC_E_MOVED,
            "%s: the points or cells of step %d are not those of the mesh that is to have a field of it; take "
            "the mesh and the field of one step",
            path, tc_read_step(reply));
    tc_status status = tc_read_values_of(&value, &association, reply, mesh->n_vertex_source, mesh->n_tet_source, err);
    if (status)
        return status;
    if (!value)
        return tc_fail(err, TC_E_FILE, "%s has no array to make a field of; write point or cell data into it", path);
    return tc_field_create(out, mesh, value, association, text_of(reply->json, "field"), err);
}

tc_status tc_field_read(tc_field **out, tc_mesh *mesh, const char *path, const tc_read_options *options,
                        const tc_log *log, tc_error *err)
{
    static const tc_read_options defaults = {0};
    if (!out || !mesh || !path)
        return tc_fail(err, TC_E_ARG, "tc_field_read: out, mesh or path is NULL");
    *out = NULL;
    if (!mesh->source)
        return tc_fail(
            err, TC_E_ARG,
            "the mesh that is to have a field of %s was not read from a file; give the values to tc_field_create",
            path);
    if (!mesh->prepared)
        return tc_fail(err, TC_E_ARG, "a field is of a mesh in its order: call tc_mesh_prepare before %s is read",
                       path);
    if (!options)
        options = &defaults;
    tc_reply reply = {0};
    tc_read_wait(mesh);
    tc_status status = tc_read_check(options, err);
    if (!status)
        status = tc_read_ask(&reply, NULL, &mesh->reader, path, options, true, mesh->source_hash, log, err);
    if (!status)
        status = make_field(out, mesh, path, &reply, err);
    tc_reply_finish(&reply);
    return status;
}
