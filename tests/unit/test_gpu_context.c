/* test_gpu_context.c: the table of contexts, and what is said where a library is missing. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/context.h"

#include <dlfcn.h>
#include <string.h>

/* dlopen of this program: libraries whose name holds `hidden` are not there. The others are asked for with the dynamic
 * linker's own function, which RTLD_NEXT finds behind this one. */
static const char *hidden;

void *dlopen(const char *name, int mode)
{
    static void *(*next)(const char *, int);
    if (!next) {
        void *p = dlsym((void *)-1L /* RTLD_NEXT */, "dlopen");
        memcpy(&next, &p, sizeof next);
    }
    if (hidden && name && (strcmp(hidden, "all") == 0 || strstr(name, hidden)))
        return NULL;
    return next(name, mode);
}

static void an_unknown_context_is_not_named(void **state)
{
    (void)state;
    tc_context *context = NULL;
    tc_error err = {0};
    assert_int_equal(tc_context_create(&context, "glut", NULL, &err), TC_E_ARG);
    assert_null(context);
    assert_non_null(strstr(err.text, "'glut'"));
    for (const tc_context_kind *const *kind = tc_context_kinds(); *kind; kind++)
        assert_non_null(strstr(err.text, (*kind)->name));
}

static void a_missing_library_is_not_named(void **state)
{
    (void)state;
    static const struct {
        const char *context, *library, *package;
    } missing[] = {{"osmesa", "OSMesa", "libosmesa6"}, {"egl", "EGL", "libegl1"}};
    for (int i = 0; i < 2; i++) {
        tc_context *context = NULL;
        tc_error err = {0};
        hidden = missing[i].library;
        tc_status status = tc_context_create(&context, missing[i].context, NULL, &err);
        hidden = NULL;
        assert_int_equal(status, TC_E_GL);
        assert_null(context);
        assert_non_null(strstr(err.text, missing[i].library));
        if (!strstr(err.text, missing[i].package))
            fail_msg("no word of the package %s: %s", missing[i].package, err.text);
    }
}

static void auto_does_not_say_why_each_is_missing(void **state)
{
    (void)state;
    tc_context *context = NULL;
    tc_error err = {0};
    hidden = "all";
    tc_status status = tc_context_create(&context, "auto", NULL, &err);
    hidden = NULL;
    assert_int_equal(status, TC_E_GL);
    assert_null(context);
    assert_non_null(strstr(err.text, "libOSMesa"));
    assert_non_null(strstr(err.text, "libEGL"));
}

static void a_missing_library_stops_auto_from_using_the_other(void **state)
{
    (void)state;
    static const char *const missing[] = {"EGL", "OSMesa"}, *const other[] = {"osmesa", "egl"};
    for (int i = 0; i < 2; i++) {
        tc_context *context = NULL;
        if (tc_context_create(&context, other[i], NULL, NULL) != TC_OK)
            continue; /* not here */
        tc_context_destroy(&context);
        hidden = missing[i];
        tc_status status = tc_context_create(&context, "auto", NULL, NULL);
        hidden = NULL;
        assert_int_equal(status, TC_OK);
        assert_string_equal(context->kind->name, other[i]);
        assert_true(context->gl.major * 10 + context->gl.minor >= 43);
        tc_context_destroy(&context);
        assert_null(context);
    }
}

static void two_contexts_cannot_live_beside_each_other(void **state)
{
    (void)state;
    tc_context *a = NULL, *b = NULL;
    if (tc_context_create(&a, "auto", NULL, NULL) != TC_OK || tc_context_create(&b, "auto", NULL, NULL) != TC_OK)
        skip(); /* no GL here */
    GLuint name[2];
    assert_int_equal(tc_context_make_current(a, NULL), TC_OK);
    a->gl.GenBuffers(2, name);
    assert_int_equal(tc_context_make_current(b, NULL), TC_OK);
    b->gl.GenBuffers(1, name);
    assert_int_equal(tc_gl_check(&b->gl, "b", NULL), TC_OK);
    tc_context_destroy(&b);
    assert_int_equal(tc_context_make_current(a, NULL), TC_OK);
    a->gl.DeleteBuffers(2, name);
    assert_int_equal(tc_gl_check(&a->gl, "a", NULL), TC_OK);
    tc_context_destroy(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_unknown_context_is_not_named),
        cmocka_unit_test(a_missing_library_is_not_named),
        cmocka_unit_test(auto_does_not_say_why_each_is_missing),
        cmocka_unit_test(a_missing_library_stops_auto_from_using_the_other),
        cmocka_unit_test(two_contexts_cannot_live_beside_each_other),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
