/* backends.c: tries every context and driver of this build. */
#include "api/driver.h"

#include "gpu/context.h"

#include <stdio.h>

tc_status tc_backends(tc_backend_info *out, size_t capacity, size_t *n, tc_error *err)
{
    *n = 0;
    bool any_gl = false;
    for (const tc_context_kind *const *kind = tc_context_kinds(); *kind; kind++) {
        if (*n >= capacity)
            return tc_fail(err, TC_E_ARG, "%zu back ends do not fit; give more room", *n + 1);
        tc_backend_info *info = &out[(*n)++];
        *info = (tc_backend_info){.kind = "context", .name = (*kind)->name};
        tc_context *context = NULL;
        tc_error why = {0};
        info->works = tc_context_create(&context, (*kind)->name, NULL, &why) == TC_OK;
        if (info->works)
            snprintf(info->why, sizeof info->why, "%s, OpenGL %d.%d", context->gl.renderer, context->gl.major,
                     context->gl.minor);
        else
            snprintf(info->why, sizeof info->why, "%.250s", why.text);
        any_gl = any_gl || info->works;
        tc_context_destroy(&context);
    }
    for (const tc_driver *driver = tc_drivers; driver->name; driver++) {
        if (*n >= capacity)
            return tc_fail(err, TC_E_ARG, "%zu back ends do not fit; give more room", *n + 1);
        tc_backend_info *info = &out[(*n)++];
        *info = (tc_backend_info){.kind = "driver", .name = driver->name, .works = !driver->gl || any_gl};
        snprintf(info->why, sizeof info->why, "%s", info->works ? driver->what : "needs a GL context");
    }
    return TC_OK;
}
