/* ahead.c: reads a step's values on a thread of its own while the caller goes on with the mesh (tc_mesh_ahead_begin).
 *
 * Who has what: begin takes the reader out of the mesh, the thread uses it, and whoever joins the thread puts it back:
 * the end, a call that needs the reader (tc_read_wait), or tc_mesh_destroy. So nothing is used by two threads at once,
 * and there is no lock. Of the mesh the thread reads only where its points came from, which stays while the mesh does.
 */
#define _GNU_SOURCE
#include "read.h"

#include "core/memory.h"

#include <math.h>
#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>

/* What was said on the thread, in its order. */
typedef struct said {
    bool is_progress;
    tc_level level;
    double fraction;
    char *text;
} said;

struct tc_mesh_ahead {
    tc_mesh *mesh; /* whose values are read; NULL: it is gone */
    char *path, *field;
    tc_read_options options; /* field is ours */
    bool prepare;
    tc_prepare_options how;
    uint64_t known;                  /* hash of mesh */
    const int32_t *vertex_of_source; /* of mesh; NULL: none of its points were merged */
    size_t n_source;

    bool threaded, joined;
    pthread_t thread;

    tc_worker *reader; /* until it is joined */
    tc_status status;
    tc_error err;
    tc_reply reply; /* values for mesh */
    double ms;
    tc_mesh *moved; /* or this mesh */
    int step;
    said *said;
    size_t n_said, room;
};

/* ------------------------------------------------------------------------------------------ talk */

/* What finds no memory is not told. Of progress in a row only the last is kept. */
static void keep(tc_mesh_ahead *a, said what, const char *text)
{
    what.text = tc_strdup(text);
    if (!what.text)
        return;
    if (what.is_progress && a->n_said > 0 && a->said[a->n_said - 1].is_progress) {
        free(a->said[--a->n_said].text);
    } else if (a->n_said == a->room) {
        const size_t room = 2 * a->room + 8;
        said *more = tc_realloc(a->said, room, sizeof *more);
        if (!more) {
            free(what.text);
            return;
        }
        a->said = more;
        a->room = room;
    }
    a->said[a->n_said++] = what;
}

static void keep_message(void *user, tc_level level, const char *text)
{
    keep(user, (said){.level = level}, text);
}

static void keep_progress(void *user, const char *what, double fraction)
{
    keep(user, (said){.is_progress = true, .fraction = fraction}, what);
}

static void tell(const tc_mesh_ahead *a, const tc_log *log)
{
    for (size_t i = 0; i < a->n_said; i++)
        if (a->said[i].is_progress)
            tc_progress(log, a->said[i].text, a->said[i].fraction);
        else
            tc_say(log, a->said[i].level, "%s", a->said[i].text);
}

/* ------------------------------------------------------------------------------------------ work */

/* Have points that were merged, since their values were equal, equal values again?
 * Errors: TC_E_MESH (they have not), TC_E_MEMORY. */
static tc_status check_merged(const tc_mesh_ahead *a, tc_error *err)
{
    const double *value;
    tc_association association;
    if (!a->vertex_of_source || !tc_reply_array(&a->reply, "scalar", TC_F64) ||
        json_integer_value(json_object_get(a->reply.json, "association")) == TC_CELL_DATA)
        return TC_OK;
    tc_status status = tc_read_values_of(&value, &association, &a->reply, a->n_source, 0, err);
    if (status)
        return status;
    int32_t *first = tc_alloc(a->n_source, sizeof *first);
    if (!first)
        return tc_fail_memory(err, "new values", a->n_source, sizeof *first);
    memset(first, 0xff, a->n_source * sizeof *first);
    for (size_t s = 0; s < a->n_source && !status; s++) {
        const int32_t v = a->vertex_of_source[s];
        if (v < 0)
            continue;
        if (first[v] < 0) {
            first[v] = (int32_t)s;
            continue;
        }
        const double x = value[first[v]], y = value[s];
        if (x != y && !(isnan(x) && isnan(y)))
            status = TC_E_MESH;
    }
    free(first);
    return status;
}

/* The mesh of a reply with points and cells, in a->moved; prepared where that was asked for. */
static tc_status make_moved(tc_mesh_ahead *a, const tc_reply *reply, double ms, const tc_log *log, tc_error *err)
{
    a->step = tc_read_step(reply);
    tc_status status = tc_read_make_mesh(&a->moved, a->path, reply, ms, err);
    if (status || !a->prepare)
        return status;
    status = tc_mesh_prepare(a->moved, &a->how, log, err);
    if (status) {
        tc_mesh_destroy(&a->moved);
        tc_fail_prefix(err, status, "step %d of %s: ", a->step, a->path);
    }
    return status;
}

/* Values that do not fit, since merged points differ, need a mesh of their own. */
static tc_status ask_anew(tc_mesh_ahead *a, tc_worker **reader, const tc_log *log, tc_error *err)
{
    double ms;
    tc_reply reply;
    tc_reply_finish(&a->reply);
    tc_status status = tc_read_ask(&reply, &ms, reader, a->path, &a->options, true, 0, log, err);
    if (!status)
        status = make_moved(a, &reply, a->ms + ms, log, err);
    tc_reply_finish(&reply);
    return status;
}

static void *run(void *context)
{
    tc_mesh_ahead *a = context;
    const tc_log log = {keep_message, keep_progress, a};
    a->status = tc_read_ask(&a->reply, &a->ms, &a->reader, a->path, &a->options, true, a->known, &log, &a->err);
    if (a->status)
        return NULL;
    if (!tc_read_is_same(&a->reply)) {
        a->status = make_moved(a, &a->reply, a->ms, &log, &a->err);
        tc_reply_finish(&a->reply);
        return NULL;
    }
    a->status = check_merged(a, &a->err);
    if (a->status == TC_E_MESH)
        a->status = ask_anew(a, &a->reader, &log, &a->err);
    return NULL;
}

/* Signals are for the caller's threads. A system without another thread lets the caller wait. */
static void start(tc_mesh_ahead *a)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    a->threaded = pthread_create(&a->thread, NULL, run, a) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (!a->threaded)
        run(a);
}

/* Afterwards no thread but the caller's has anything of a, and the mesh has its reader again. */
static void wait_for(tc_mesh_ahead *a)
{
    if (a->joined)
        return;
    if (a->threaded)
        pthread_join(a->thread, NULL);
    a->joined = true;
    if (a->mesh)
        a->mesh->reader = a->reader;
    else
        tc_worker_stop(&a->reader);
    a->reader = NULL;
}

/* tc_mesh_destroy of the mesh. */
static void leave(tc_mesh_ahead *a)
{
    wait_for(a);
    a->mesh = NULL;
}

static void finish(tc_mesh_ahead *a)
{
    if (a->mesh)
        a->mesh->ahead = NULL;
    tc_reply_finish(&a->reply);
    tc_mesh_destroy(&a->moved);
    for (size_t i = 0; i < a->n_said; i++)
        free(a->said[i].text);
    free(a->said);
    free(a->path);
    free(a->field);
    free(a);
}

/* ------------------------------------------------------------------------------------------ calls */

tc_status tc_mesh_ahead_begin(tc_mesh_ahead **out, tc_mesh *mesh, const char *path, const tc_read_options *options,
                              const tc_prepare_options *prepare, tc_error *err)
{
    static const tc_read_options defaults = {0};
    if (!out || !mesh || !path)
        return tc_fail(err, TC_E_ARG, "tc_mesh_ahead_begin: out, mesh or path is NULL");
    *out = NULL;
    if (!mesh->source)
        return tc_fail(err, TC_E_ARG,
                       "the mesh that is to take the values of %s was not read from a file; give its values to "
                       "tc_mesh_set_scalar",
                       path);
    if (mesh->ahead)
        return tc_fail(err, TC_E_ARG, "%s cannot be read ahead while %s is: call tc_mesh_ahead_end first", path,
                       mesh->ahead->path);
    if (!options)
        options = &defaults;
    tc_status status = tc_read_check(options, err);
    if (status)
        return status;
    tc_mesh_ahead *a = tc_calloc(1, sizeof *a);
    if (!a)
        return tc_fail_memory(err, "reading ahead", 1, sizeof *a);
    a->path = tc_strdup(path);
    a->field = tc_strdup(options->field);
    a->options = *options;
    a->options.field = a->field;
    a->prepare = prepare != NULL;
    if (prepare)
        a->how = *prepare;
    if (!a->path || (options->field && !a->field)) {
        finish(a);
        return tc_fail_memory(err, "reading ahead", 1, strlen(path));
    }
    a->known = mesh->source_hash;
    a->vertex_of_source = mesh->report.merged_vertices > 0 ? mesh->vertex_of_source : NULL;
    a->n_source = mesh->n_vertex_source;
    a->mesh = mesh;
    a->reader = mesh->reader;
    mesh->reader = NULL;
    mesh->ahead = a;
    mesh->ahead_wait = wait_for;
    mesh->ahead_leave = leave;
    start(a);
    *out = a;
    return TC_OK;
}

/* Gives what was read to the mesh, or the mesh that was read to *moved. */
static tc_status hand_over(tc_mesh **moved, tc_mesh_ahead *a, const tc_log *log, tc_error *err)
{
    tc_mesh *mesh = a->mesh;
    tc_status status = TC_OK;
    if (!a->moved) {
        status = tc_read_take_values(mesh, a->path, &a->reply, a->ms, err);
        if (status != TC_E_MESH)
            return status;
        status = ask_anew(a, &mesh->reader, log, err); /* it was not prepared yet when it was looked at */
        if (status)
            return status;
    }
    if (moved) {
        *moved = a->moved;
        (*moved)->reader = mesh->reader;
        mesh->reader = NULL;
        a->moved = NULL;
    }
    return tc_read_fail_moved(a->path, a->step, err);
}

tc_status tc_mesh_ahead_end(tc_mesh **moved, tc_mesh *mesh, tc_mesh_ahead **ahead, const tc_log *log, tc_error *err)
{
    if (moved)
        *moved = NULL;
    if (!ahead || !*ahead)
        return tc_fail(err, TC_E_ARG, "tc_mesh_ahead_end: there is nothing that was begun");
    tc_mesh_ahead *a = *ahead;
    *ahead = NULL;
    wait_for(a);
    tc_status status = TC_OK;
    if (mesh) {
        tell(a, log);
        if (mesh != a->mesh)
            status = tc_fail(err, TC_E_ARG,
                             "%s was read ahead for another mesh than the one that is to take its values", a->path);
        else if (a->status)
            status = tc_fail(err, a->status, "%s", a->err.text);
        else
            status = hand_over(moved, a, log, err);
    }
    finish(a);
    return status;
}
