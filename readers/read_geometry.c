/* read_geometry.c: tc_geometry_read: asks the helper program tetcast-read for the triangles and lines of a file.
 *
 * Request: {"do": "surface", "path"}. Result: {"notes": []} and the arrays vertex (f64), triangle (i32), line (i32). */
#include "core/memory.h"
#include "core/worker.h"

#include <stdlib.h>
#include <string.h>

/* A copy of a reply's array; count in items of `corners` numbers. NULL with TC_OK: there are none. */
static tc_status take(void **out, size_t *count, const tc_reply *reply, const char *name, tc_array_type type,
                      size_t corners, size_t size, tc_error *err)
{
    const tc_array *array = tc_reply_array(reply, name, type);
    *out = NULL;
    *count = 0;
    if (!array || array->count % corners)
        return tc_fail(err, TC_E_WORKER, "tetcast-read gave an answer without %s; is it of another version?", name);
    if (!array->count)
        return TC_OK;
    *out = tc_alloc(array->count, size);
    if (!*out)
        return tc_fail_memory(err, "a surface", array->count, size);
    memcpy(*out, array->data, array->count * size);
    *count = array->count / corners;
    return TC_OK;
}

static tc_status take_all(tc_geometry *out, const tc_reply *reply, tc_error *err)
{
    void *vertex = NULL, *triangle = NULL, *line = NULL;
    tc_geometry g = {.opacity = 1, .width = 1, .lit = true};
    tc_status status = take(&vertex, &g.n_vertex, reply, "vertex", TC_F64, 3, sizeof(double), err);
    if (!status)
        status = take(&triangle, &g.n_triangle, reply, "triangle", TC_I32, 3, sizeof(int32_t), err);
    if (!status)
        status = take(&line, &g.n_line, reply, "line", TC_I32, 2, sizeof(int32_t), err);
    g.vertex = vertex;
    g.triangle = triangle;
    g.line = line;
    for (size_t i = 0; !status && i < 3 * g.n_triangle + 2 * g.n_line; i++) {
        const int32_t id = i < 3 * g.n_triangle ? g.triangle[i] : g.line[i - 3 * g.n_triangle];
        if (id < 0 || (size_t)id >= g.n_vertex)
            status = tc_fail(err, TC_E_WORKER, "tetcast-read gave vertex %d of %zu; is it of another version?", (int)id,
                             g.n_vertex);
    }
    if (status) {
        free(vertex);
        free(triangle);
        free(line);
        return status;
    }
    *out = g;
    return TC_OK;
}

tc_status tc_geometry_read(tc_geometry *out, const char *path, const tc_log *log, tc_error *err)
{
    if (!out)
        return tc_fail(err, TC_E_ARG, "tc_geometry_read: out is NULL");
    *out = (tc_geometry){0};
    if (!path)
        return tc_fail(err, TC_E_ARG, "tc_geometry_read: path is NULL");
    const tc_worker_limits limits = {.idle_s = 60, .memory_bytes = TC_WORKER_MACHINE};
    tc_worker *worker = NULL;
    tc_reply reply = {0};
    json_t *request = json_object(), *name = json_string(path);
    tc_status status = TC_OK;
    if (!name)
        status = tc_fail(err, TC_E_FILE, "the name of file %s is not UTF-8; rename it", path);
    else if (json_object_set_new(request, "do", json_string("surface")) ||
             json_object_set(request, "path", name)) /* fails for a request that is NULL, too */
        status = tc_fail_memory(err, "a request", 1, 256);
    if (!status)
        status = tc_worker_start(&worker, "tetcast-read", &limits, err);
    if (!status) {
        status = tc_worker_call(&reply, worker, request, NULL, 0, log, err);
        if (status == TC_E_WORKER)
            tc_fail_prefix(err, status, "%s could not be read, it is probably damaged: ", path);
    }
    if (!status)
        status = take_all(out, &reply, err);
    const json_t *notes = status ? NULL : json_object_get(reply.json, "notes");
    for (size_t i = 0; i < json_array_size(notes); i++)
        tc_say(log, TC_WARNING, "%s: %s", path, json_string_value(json_array_get(notes, i)));
    tc_reply_finish(&reply);
    tc_worker_stop(&worker);
    json_decref(name);
    json_decref(request);
    return status;
}
