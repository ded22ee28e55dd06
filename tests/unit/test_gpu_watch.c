/* test_gpu_watch.c: GL's debug output as errors (TETCAST_GL_DEBUG). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/context.h"
#include "gpu/watch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"osmesa", "egl"};

/* NULL where it is missing. */
static tc_context *open_context(const char *name, const char *debug)
{
    tc_context *context = NULL;
    tc_error err = {0};
    setenv("TETCAST_GL_DEBUG", debug, 1);
    tc_status status = tc_context_create(&context, name, NULL, &err);
    setenv("TETCAST_GL_DEBUG", "0", 1);
    if (status != TC_OK)
        printf("    %s: %s\n", name, err.text);
    return context;
}

/* A call that GL refuses; what glGetError would tell is taken away. */
static GLenum call_wrongly(const tc_gl *gl)
{
    gl->BindTexture(GL_TRIANGLES, 0);
    return gl->GetError();
}

static void a_wrong_call_is_not_heard(void **state)
{
    (void)state;
    bool any = false;
    for (int i = 0; i < 2; i++) {
        tc_context *context = open_context(names[i], "1");
        if (!context)
            continue;
        any = true;
        const tc_gl *gl = &context->gl;
        assert_non_null(gl->watch);
        tc_error err = {0};
        if (tc_gl_check(gl, "starting", &err) != TC_OK)
            fail_msg("%s: %s", names[i], err.text);
        assert_int_equal(call_wrongly(gl), GL_INVALID_ENUM);
        assert_int_equal(tc_gl_check(gl, "trying", &err), TC_E_GL);
        printf("    %s: %s\n", names[i], err.text);
        assert_non_null(strstr(err.text, "while trying: error: "));
        assert_int_equal(tc_gl_check(gl, "trying", NULL), TC_OK); /* told once */
        gl->BindTexture(GL_TRIANGLES, 0);                         /* with GL's error pending */
        call_wrongly(gl);
        call_wrongly(gl);
        assert_int_equal(tc_gl_check(gl, "trying again", &err), TC_E_GL);
        assert_non_null(strstr(err.text, "while trying again: error: "));
        assert_non_null(strstr(err.text, "(and 2 more)"));
        assert_int_equal(tc_gl_check(gl, "trying", NULL), TC_OK);
        tc_context_destroy(&context);
    }
    if (!any)
        skip();
}

static void a_context_is_watched_unasked(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        tc_context *context = open_context(names[i % 2], i < 2 ? "0" : "");
        if (!context)
            continue;
        assert_null(context->gl.watch);
        assert_false(context->gl.IsEnabled(GL_DEBUG_OUTPUT));
        call_wrongly(&context->gl);
        assert_int_equal(tc_gl_check(&context->gl, "trying", NULL), TC_OK);
        tc_context_destroy(&context);
    }
}

static void count_message(void *user, tc_level level, const char *text)
{
    if (level == TC_DEBUG && strcmp(text, "GL: performance: slow (of 2)") == 0)
        ++*(int *)user;
}

static void a_kind_of_message_is_taken_wrongly(void **state)
{
    (void)state;
    static const struct {
        GLenum type, severity;
        const char *said; /* NULL: no error */
    } messages[] = {
        {GL_DEBUG_TYPE_ERROR, GL_DEBUG_SEVERITY_LOW, "error: slow"},
        {GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR, GL_DEBUG_SEVERITY_MEDIUM, "undefined behaviour: slow"},
        {GL_DEBUG_TYPE_PORTABILITY, GL_DEBUG_SEVERITY_LOW, "not portable: slow"},
        {GL_DEBUG_TYPE_DEPRECATED_BEHAVIOR, GL_DEBUG_SEVERITY_LOW, "deprecated: slow"},
        {GL_DEBUG_TYPE_OTHER, GL_DEBUG_SEVERITY_HIGH, "message: slow"},
        {GL_DEBUG_TYPE_OTHER, GL_DEBUG_SEVERITY_MEDIUM, NULL},
        {GL_DEBUG_TYPE_OTHER, GL_DEBUG_SEVERITY_NOTIFICATION, NULL},
        {GL_DEBUG_TYPE_PERFORMANCE, GL_DEBUG_SEVERITY_LOW, NULL},
        {GL_DEBUG_TYPE_PERFORMANCE, GL_DEBUG_SEVERITY_MEDIUM, NULL},
    };
    for (int i = 0; i < 2; i++) {
        tc_context *context = open_context(names[i], "1");
        if (!context)
            continue;
        PFNGLDEBUGMESSAGEINSERTPROC insert;
        void *p = context->get_proc("glDebugMessageInsert");
        memcpy(&insert, &p, sizeof p);
        for (size_t k = 0; k < sizeof messages / sizeof *messages; k++) {
            tc_error err = {0};
            insert(GL_DEBUG_SOURCE_APPLICATION, messages[k].type, 1, messages[k].severity, -1, "slow\n");
            tc_status status = tc_gl_check(&context->gl, "inserting", &err);
            if (status != (messages[k].said ? TC_E_GL : TC_OK))
                fail_msg("%s, message %zu: status %d", names[i], k, (int)status);
            if (messages[k].said && !strstr(err.text, messages[k].said))
                fail_msg("%s, message %zu: %s", names[i], k, err.text);
        }
        int said = 0;
        const tc_log log = {.message = count_message, .user = &said};
        tc_gl_watch_say(&context->gl, &log);
        tc_gl_watch_say(&context->gl, &log); /* and not again */
        assert_int_equal(said, 1);
        tc_context_destroy(&context);
    }
}

static void a_context_is_blamed_for_another(void **state)
{
    (void)state;
    tc_context *a = open_context("osmesa", "1"), *b = open_context("osmesa", "1");
    if (!a || !b)
        skip();
    call_wrongly(&b->gl);
    assert_int_equal(tc_context_make_current(a, NULL), TC_OK);
    assert_int_equal(tc_gl_check(&a->gl, "a", NULL), TC_OK);
    tc_context_destroy(&a);
    assert_int_equal(tc_context_make_current(b, NULL), TC_OK);
    assert_int_equal(tc_gl_check(&b->gl, "b", NULL), TC_E_GL);
    tc_context_destroy(&b);
}

static void a_hosts_context_is_changed(void **state)
{
    (void)state;
    tc_context *host = open_context("osmesa", "0"), *context = NULL;
    if (!host)
        skip();
    setenv("TETCAST_GL_DEBUG", "1", 1);
    assert_int_equal(tc_context_create_host(&context, host->get_proc, NULL), TC_OK);
    setenv("TETCAST_GL_DEBUG", "0", 1);
    assert_null(context->gl.watch);
    assert_false(host->gl.IsEnabled(GL_DEBUG_OUTPUT));
    tc_context_destroy(&context);
    tc_context_destroy(&host);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wrong_call_is_not_heard),
        cmocka_unit_test(a_context_is_watched_unasked),
        cmocka_unit_test(a_kind_of_message_is_taken_wrongly),
        cmocka_unit_test(a_context_is_blamed_for_another),
        cmocka_unit_test(a_hosts_context_is_changed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
