/* trace.c: events are put into blocks of memory and become JSON when the trace is closed, each for itself, so that
 * their text is never in memory as a whole. */
#define _GNU_SOURCE
#include "edit/trace.h"
#include "edit/fail.h"

#include <errno.h>
#include <fcntl.h>
#include <jansson.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

typedef struct tc_event {
    const char *what, *key;
    double begin_ms, end_ms; /* a mark's end is NaN */
    double value;
    unsigned id, thread;
} tc_event;

enum { TC_EVENTS = 1024 };

typedef struct tc_events {
    struct tc_events *next;
    size_t n;
    tc_event event[TC_EVENTS];
} tc_events;

struct tc_trace {
    char *path;           /* NULL: nothing is kept */
    pthread_mutex_t lock; /* of all that follows */
    tc_events *first, *last;
    size_t lost;
    size_t n_thread, thread_room;
    pthread_t *thread; /* in the order in which they came */
};

/* ------------------------------------------------------------------------------------------ the file */

/* A file on its way. */
typedef struct tc_draft {
    FILE *stream;
    char *target, *part; /* where it will be; where it is: NULL, a device, which is written to directly */
} tc_draft;

static void tc_draft_drop(tc_draft *draft)
{
    if (draft->stream)
        fclose(draft->stream);
    if (draft->part)
        unlink(draft->part);
    free(draft->part);
    free(draft->target);
    *draft = (tc_draft){0};
}

static tc_status tc_draft_failed(tc_draft *draft, const char *path, int code, tc_error *err)
{
    tc_draft_drop(draft);
    const char *remedy = code == ENOSPC || code == EDQUOT  ? "make room, or name another folder"
                         : code == ENOENT                  ? "make its folder first"
                         : code == EISDIR                  ? "give the name of a file in it"
                         : code == EACCES || code == EROFS ? "name a folder that you may write to"
                                                           : "name another file";
    return tc_edit_fail(err, TC_E_FILE, "%s could not be written: %s; %s", path, strerror(code), remedy);
}

static tc_status tc_draft_open(tc_draft *out, const char *path, tc_error *err)
{
    *out = (tc_draft){0};
    struct stat info;
    const bool there = stat(path, &info) == 0;
    if (there && S_ISDIR(info.st_mode))
        return tc_draft_failed(out, path, EISDIR, err);
    if (there && !S_ISREG(info.st_mode)) {
        out->stream = fopen(path, "we");
        return out->stream ? TC_OK : tc_draft_failed(out, path, errno, err);
    }
    out->target = there ? realpath(path, NULL) : strdup(path); /* a link keeps pointing to its file */
    if (!out->target)
        return tc_draft_failed(out, path, errno, err);
    int fd = -1;
    for (int i = 0; fd < 0 && i < 100; i++) {
        free(out->part);
        if (asprintf(&out->part, "%s.%ld-%d.tmp", out->target, (long)getpid(), i) < 0) {
            out->part = NULL;
            return tc_draft_failed(out, path, ENOMEM, err);
        }
        fd = open(out->part, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd < 0 && errno != EEXIST)
            break;
    }
    out->stream = fd < 0 ? NULL : fdopen(fd, "w");
    if (!out->stream) {
        const int code = errno;
        if (fd < 0) { /* it is not ours, or not there */
            free(out->part);
            out->part = NULL;
        } else
            close(fd);
        return tc_draft_failed(out, path, code, err);
    }
    if (there)
        (void)!fchmod(fd, info.st_mode & 07777);
    return TC_OK;
}

/* Ends the draft, whatever happens. */
static tc_status tc_draft_keep(tc_draft *draft, const char *path, tc_error *err)
{
    errno = 0;
    bool good = !ferror(draft->stream) && fflush(draft->stream) == 0;
    int code = errno;
    good = fclose(draft->stream) == 0 && good;
    draft->stream = NULL;
    code = code ? code : errno;
    if (good && draft->part) {
        good = rename(draft->part, draft->target) == 0;
        code = errno;
        if (good) {
            free(draft->part);
            draft->part = NULL;
        }
    }
    if (!good)
        return tc_draft_failed(draft, path, code ? code : EIO, err);
    tc_draft_drop(draft);
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------ events */

tc_status tc_trace_open(tc_trace **out, const char *path, tc_error *err)
{
    *out = NULL;
    if (path) {
        tc_draft draft;
        tc_status status = tc_draft_open(&draft, path, err);
        if (status != TC_OK)
            return status;
        tc_draft_drop(&draft);
    }
    tc_trace *trace = calloc(1, sizeof *trace);
    if (trace && path)
        trace->path = strdup(path);
    if (!trace || (path && !trace->path) || pthread_mutex_init(&trace->lock, NULL) != 0) {
        if (trace)
            free(trace->path);
        free(trace);
        return tc_edit_fail(err, TC_E_MEMORY, "memory ran out before anything was traced: close other programs");
    }
    *out = trace;
    return TC_OK;
}

bool tc_trace_keeps(const tc_trace *trace)
{
    return trace && trace->path;
}

double tc_trace_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* The calling thread's number, from 1; 0: memory ran out. */
static unsigned tc_trace_thread(tc_trace *trace)
{
    const pthread_t self = pthread_self();
    for (size_t i = 0; i < trace->n_thread; i++)
        if (pthread_equal(trace->thread[i], self))
            return (unsigned)i + 1;
    if (trace->n_thread == trace->thread_room) {
        const size_t room = 2 * trace->thread_room + 4;
        pthread_t *thread = tc_edit_room(trace->thread, room, sizeof *thread);
        if (!thread)
            return 0;
        trace->thread = thread;
        trace->thread_room = room;
    }
    trace->thread[trace->n_thread++] = self;
    return (unsigned)trace->n_thread;
}

static void tc_trace_add(tc_trace *trace, tc_event event)
{
    pthread_mutex_lock(&trace->lock);
    event.thread = tc_trace_thread(trace);
    if (!trace->last || trace->last->n == TC_EVENTS) {
        tc_events *more = malloc(sizeof *more);
        if (more) {
            more->next = NULL;
            more->n = 0;
            if (trace->last)
                trace->last->next = more;
            else
                trace->first = more;
            trace->last = more;
        }
    }
    if (trace->last && trace->last->n < TC_EVENTS)
        trace->last->event[trace->last->n++] = event;
    else
        trace->lost++;
    pthread_mutex_unlock(&trace->lock);
}

void tc_trace_span(tc_trace *trace, const char *what, double begin_ms, double end_ms, unsigned id, const char *key,
                   double value)
{
    if (!trace->path)
        return;
    const double end = end_ms > begin_ms ? end_ms : begin_ms; /* never NaN: that is a mark's */
    tc_trace_add(trace, (tc_event){what, key, begin_ms, end, value, id, 0});
}

void tc_trace_mark(tc_trace *trace, const char *what, unsigned id, const char *key, double value)
{
    if (trace->path)
        tc_trace_add(trace, (tc_event){what, key, tc_trace_now(), NAN, value, id, 0});
}

/* ------------------------------------------------------------------------------------------ JSON */

/* False: memory ran out. */
static bool tc_event_put(const tc_event *event, bool first, FILE *stream)
{
    const bool span = !isnan(event->end_ms);
    json_t *args = json_object();
    bool good =
        args && (!event->id || json_object_set_new(args, "id", json_integer(event->id)) == 0) &&
        (!event->key || !isfinite(event->value) || json_object_set_new(args, event->key, json_real(event->value)) == 0);
    json_t *json = good ? json_pack("{ss ss sf sf sO si si}", "name", event->what, "ph", "X", "ts",
                                    1e3 * event->begin_ms, "dur", span ? 1e3 * (event->end_ms - event->begin_ms) : 0.0,
                                    "args", args, "pid", 1, "tid", (int)event->thread)
                        : NULL;
    if (json && !span) {
        json_object_del(json, "dur");
        good = json_object_set_new(json, "ph", json_string("i")) == 0 &&
               json_object_set_new(json, "s", json_string("t")) == 0;
    }
    char *text = json && good ? json_dumps(json, JSON_COMPACT | JSON_REAL_PRECISION(15)) : NULL;
    if (text)
        fprintf(stream, "%s\n%s", first ? "" : ",", text); /* whether it was written is asked at the end */
    free(text);
    json_decref(json);
    json_decref(args);
    return text;
}

/* False: memory ran out. */
static bool tc_trace_put(const tc_trace *trace, FILE *stream)
{
    fputs("{\"displayTimeUnit\":\"ms\",", stream);
    if (trace->lost)
        fprintf(stream, "\"lost\":%zu,", trace->lost);
    fputs("\"traceEvents\":[", stream);
    bool first = true;
    for (const tc_events *events = trace->first; events; events = events->next)
        for (size_t i = 0; i < events->n; i++, first = false)
            if (!tc_event_put(&events->event[i], first, stream))
                return false;
    fputs("\n]}\n", stream);
    return true;
}

tc_status tc_trace_close(tc_trace **trace, tc_error *err)
{
    tc_trace *t = *trace;
    *trace = NULL;
    if (!t)
        return TC_OK;
    tc_status status = TC_OK;
    if (t->path) {
        tc_draft draft;
        status = tc_draft_open(&draft, t->path, err);
        if (status == TC_OK && tc_trace_put(t, draft.stream))
            status = tc_draft_keep(&draft, t->path, err);
        else if (status == TC_OK) {
            tc_draft_drop(&draft);
            status = tc_edit_fail(err, TC_E_MEMORY,
                                  "%s was not written: memory ran out, or a name is not UTF-8; close "
                                  "other programs",
                                  t->path);
        }
    }
    while (t->first) {
        tc_events *next = t->first->next;
        free(t->first);
        t->first = next;
    }
    pthread_mutex_destroy(&t->lock);
    free(t->thread);
    free(t->path);
    free(t);
    return status;
}
