/* begin.c: making a renderer on a thread of its own, while its caller reads a mesh. */
#include "api/driver.h"

#include "core/memory.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

/* What was said meanwhile; the caller's log is called on the caller's thread only. */
typedef struct line {
    struct line *next;
    tc_level level;
    char text[];
} line;

struct tc_renderer_start {
    tc_renderer_options options;
    pthread_t thread;
    bool threaded;
    tc_renderer *renderer;
    tc_status status;
    tc_error err;
    line *first, **last;
};

static void keep_line(void *user, tc_level level, const char *text)
{
    tc_renderer_start *s = user;
    size_t n = strlen(text) + 1;
    line *l = malloc(sizeof *l + n);
    if (!l)
        return;
    *l = (line){NULL, level};
    memcpy(l->text, text, n);
    *s->last = l;
    s->last = &l->next;
}

static void *make(void *argument)
{
    tc_renderer_start *s = argument;
    const tc_log log = {.message = keep_line, .user = s};
    s->status = tc_renderer_create(&s->renderer, &s->options, &log, &s->err);
    if (s->status == TC_OK && s->renderer->gpu)
        tc_gpu_renderer_release(s->renderer->gpu);
    return NULL;
}

tc_status tc_renderer_begin(tc_renderer_start **out, const tc_renderer_options *options, tc_error *err)
{
    *out = NULL;
    if (options && options->get_proc_address)
        return tc_fail(err, TC_E_ARG, "tc_renderer_begin: a host's context is current on one thread; use tc_renderer_create");
    tc_renderer_start *s = tc_calloc(1, sizeof *s);
    if (!s)
        return tc_fail_memory(err, "a renderer", 1, sizeof *s);
    if (options)
        s->options = *options;
    s->last = &s->first;
    s->threaded = pthread_create(&s->thread, NULL, make, s) == 0;
    *out = s;
    return TC_OK;
}

tc_status tc_renderer_end(tc_renderer **out, tc_renderer_start **start, const tc_log *log, tc_error *err)
{
    tc_renderer_start *s = start ? *start : NULL;
    if (out)
        *out = NULL;
    if (!s)
        return tc_fail(err, TC_E_ARG, "tc_renderer_end: there is no start");
    if (s->threaded)
        pthread_join(s->thread, NULL);
    else if (out)
        make(s);
    else
        s->status = TC_E_CANCEL;
    for (line *l = s->first, *next; l; l = next) {
        next = l->next;
        tc_say(log, l->level, "%s", l->text);
        free(l);
    }
    tc_status status = s->status;
    if (status != TC_OK && err)
        *err = s->err;
    if (status == TC_OK && out)
        *out = s->renderer;
    else if (status == TC_OK)
        tc_renderer_destroy(&s->renderer);
    free(s);
    *start = NULL;
    return out ? status : TC_OK;
}
