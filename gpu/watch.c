/* watch.c: GL's debug output (KHR_debug, core in 4.3) as errors. */
#include "gpu/watch.h"

#include "core/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MESSAGE_BYTES = 512 };

struct tc_gl_watch {
    size_t wrong, slow; /* messages since they were last asked for */
    char first_wrong[MESSAGE_BYTES], first_slow[MESSAGE_BYTES];
};

bool tc_gl_watch_wanted(void)
{
    return tc_gl_setting("TETCAST_GL_DEBUG");
}

static const char *type_name(GLenum type)
{
    switch (type) {
    case GL_DEBUG_TYPE_ERROR:
        return "error";
    case GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR:
        return "undefined behaviour";
    case GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR:
        return "deprecated";
    case GL_DEBUG_TYPE_PORTABILITY:
        return "not portable";
    case GL_DEBUG_TYPE_PERFORMANCE:
        return "performance";
    default:
        return "message";
    }
}

static bool is_wrong(GLenum type, GLenum severity)
{
    return type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR ||
           type == GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR || type == GL_DEBUG_TYPE_PORTABILITY ||
           severity == GL_DEBUG_SEVERITY_HIGH;
}

/* Length as GL counts it, or -1 where the text ends with 0; without the line's end that some drivers add. */
static void keep(char out[MESSAGE_BYTES], GLenum type, GLsizei length, const GLchar *text)
{
    size_t n = length < 0 ? strlen(text) : (size_t)length;
    while (n > 0 && (text[n - 1] == '\n' || text[n - 1] == '\0'))
        n--;
    snprintf(out, MESSAGE_BYTES, "%s: %.*s", type_name(type), n < MESSAGE_BYTES ? (int)n : MESSAGE_BYTES, text);
}

static void APIENTRY hear(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length, const GLchar *text,
                          const void *user)
{
    (void)source;
    (void)id;
    tc_gl_watch *watch = (tc_gl_watch *)(uintptr_t)user; /* given as it is in tc_gl_watch_begin */
    if (is_wrong(type, severity)) {
        if (watch->wrong++ == 0)
            keep(watch->first_wrong, type, length, text);
    } else if (type == GL_DEBUG_TYPE_PERFORMANCE) {
        if (watch->slow++ == 0)
            keep(watch->first_slow, type, length, text);
    }
}

tc_status tc_gl_watch_begin(tc_gl *gl, tc_get_proc get_proc, tc_error *err)
{
    PFNGLDEBUGMESSAGECALLBACKPROC listen;
    PFNGLDEBUGMESSAGECONTROLPROC choose;
    void *p = get_proc("glDebugMessageCallback"), *q = get_proc("glDebugMessageControl");
    if (!p || !q)
        return tc_fail(err, TC_E_GL,
                       "%s has no glDebugMessageCallback or no glDebugMessageControl; unset "
                       "TETCAST_GL_DEBUG",
                       gl->renderer);
    memcpy(&listen, &p, sizeof p);
    memcpy(&choose, &q, sizeof q);
    tc_gl_watch *watch = tc_calloc(1, sizeof *watch);
    if (!watch)
        return tc_fail_memory(err, "GL's messages", 1, sizeof *watch);
    gl->watch = watch;
    gl->Enable(GL_DEBUG_OUTPUT);
    gl->Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS); /* in our thread, within the call that is wrong */
    choose(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, NULL, GL_TRUE);
    listen(hear, watch);
    return tc_gl_check(gl, "turning on GL's debug output", err);
}

void tc_gl_watch_end(tc_gl *gl)
{
    free(gl->watch);
    gl->watch = NULL;
}

tc_status tc_gl_watch_check(const tc_gl *gl, const char *what, tc_error *err)
{
    tc_gl_watch *watch = gl->watch;
    size_t n = watch->wrong;
    if (n == 0)
        return TC_OK;
    watch->wrong = 0;
    if (n == 1)
        return tc_fail(err, TC_E_GL, "GL says while %s: %s", what, watch->first_wrong);
    return tc_fail(err, TC_E_GL, "GL says while %s: %s (and %zu more)", what, watch->first_wrong, n - 1);
}

void tc_gl_watch_say(const tc_gl *gl, const tc_log *log)
{
    tc_gl_watch *watch = gl->watch;
    if (!watch || watch->slow == 0)
        return;
    tc_say(log, TC_DEBUG, "GL: %s (of %zu)", watch->first_slow, watch->slow);
    watch->slow = 0;
}
