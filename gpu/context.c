/* context.c: choosing a GL context. */
#include "gpu/context.h"

#include "core/memory.h"
#include "gpu/watch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const tc_context_kind *const kinds[] = {&tc_context_egl, &tc_context_osmesa, NULL};

const tc_context_kind *const *tc_context_kinds(void)
{
    return kinds;
}

static bool is_software(const char *renderer)
{
    if (tc_gl_setting("TETCAST_GL_HARDWARE")) /* for tests: what GPUs are given, given to a software renderer */
        return false;
    return strstr(renderer, "llvmpipe") || strstr(renderer, "softpipe") || strstr(renderer, "swrast") ||
           strstr(renderer, "Software");
}

static void finish(tc_context *context)
{
    context->kind->finish(context);
    tc_gl_watch_end(&context->gl);
}

static tc_status try_kind(tc_context *context, const tc_context_kind *kind, bool hardware_only, tc_error *err)
{
    memset(context, 0, sizeof *context);
    context->kind = kind;
    context->hardware_only = hardware_only;
    context->debug = tc_gl_watch_wanted();
    tc_status status = kind->create(context, err);
    if (status == TC_OK && context->debug)
        status = tc_gl_watch_begin(&context->gl, context->get_proc, err);
    if (status != TC_OK) {
        finish(context);
        return status;
    }
    context->software = is_software(context->gl.renderer);
    return TC_OK;
}

static tc_status create_auto(tc_context *context, const tc_log *log, tc_error *err)
{
    tc_error why_egl = {0}, why_osmesa = {0};
    if (try_kind(context, &tc_context_egl, true, &why_egl) == TC_OK) {
        if (!context->software)
            return TC_OK;
        tc_say(log, TC_DEBUG, "context egl: %s is a software renderer; osmesa is tried first", context->gl.renderer);
        finish(context);
        snprintf(why_egl.text, sizeof why_egl.text, "software renderer");
    } else {
        tc_say(log, TC_DEBUG, "context egl: %s", why_egl.text);
    }
    if (try_kind(context, &tc_context_osmesa, false, &why_osmesa) == TC_OK)
        return TC_OK;
    tc_say(log, TC_DEBUG, "context osmesa: %s", why_osmesa.text);
    if (try_kind(context, &tc_context_egl, false, &why_egl) == TC_OK)
        return TC_OK;
    return tc_fail(err, TC_E_GL, "no GL context can be made: egl: %.300s; osmesa: %.300s", why_egl.text,
                   why_osmesa.text);
}

tc_status tc_context_create(tc_context **out, const char *name, const tc_log *log, tc_error *err)
{
    *out = NULL;
    tc_context *context = tc_calloc(1, sizeof *context);
    if (!context)
        return tc_fail_memory(err, "a GL context", 1, sizeof *context);
    tc_status status = TC_OK;
    if (!name || strcmp(name, "auto") == 0) {
        status = create_auto(context, log, err);
    } else {
        const tc_context_kind *const *kind = kinds;
        while (*kind && strcmp((*kind)->name, name) != 0)
            kind++;
        if (*kind)
            status = try_kind(context, *kind, false, err);
        else
            status = tc_fail(err, TC_E_ARG, "unknown GL context '%s'; there are auto, osmesa and egl", name);
    }
    if (status != TC_OK) {
        free(context);
        return status;
    }
    tc_say(log, TC_DEBUG, "context %s: %s, GL %s", context->kind->name, context->gl.renderer, context->gl.version);
    *out = context;
    return TC_OK;
}

static tc_status host_create(tc_context *context, tc_error *err)
{
    (void)context;
    (void)err;
    return TC_OK;
}

static tc_status host_make_current(tc_context *context, tc_error *err)
{
    (void)context;
    (void)err;
    return TC_OK;
}

static void host_release(tc_context *context)
{
    (void)context;
}

static void host_finish(tc_context *context)
{
    (void)context;
}

static const tc_context_kind host_kind = {"host", host_create, host_make_current, host_release, host_finish};

tc_status tc_context_create_host(tc_context **out, tc_get_proc get_proc, tc_error *err)
{
    *out = NULL;
    tc_context *context = tc_calloc(1, sizeof *context);
    if (!context)
        return tc_fail_memory(err, "a GL context", 1, sizeof *context);
    context->kind = &host_kind;
    tc_status status = tc_gl_load(&context->gl, get_proc, err);
    if (status != TC_OK) {
        free(context);
        return status;
    }
    context->software = is_software(context->gl.renderer);
    *out = context;
    return TC_OK;
}

tc_status tc_context_make_current(tc_context *context, tc_error *err)
{
    return context->kind->make_current(context, err);
}

void tc_context_release(tc_context *context)
{
    context->kind->release(context);
}

void tc_context_destroy(tc_context **context)
{
    if (!*context)
        return;
    finish(*context);
    free(*context);
    *context = NULL;
}
