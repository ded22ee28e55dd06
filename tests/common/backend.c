/* backend.c: renderers by name, and why one is missing. */
#include "backend.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    tc_renderer_options options;
} backends[] = {
    {"osmesa", {.gl = "osmesa", .driver = "pingpong"}},
    {"egl", {.gl = "egl", .driver = "pingpong"}},
    {"osmesa-compute", {.gl = "osmesa", .driver = "compute"}},
    {"egl-compute", {.gl = "egl", .driver = "compute"}},
    {"reference", {.driver = "reference"}},
};
enum { BACKENDS = sizeof backends / sizeof *backends };

static size_t find(const char *name)
{
    size_t i = 0;
    while (i < BACKENDS && strcmp(backends[i].name, name) != 0)
        i++;
    return i;
}

bool backend_known(const char *name)
{
    return find(name) < BACKENDS;
}

tc_renderer_options backend_options(const char *name)
{
    return backends[find(name)].options;
}

static bool installed(const char *library)
{
    return dlopen(library, RTLD_NOW | RTLD_LOCAL) != NULL; /* stays open: Mesa does not survive a dlclose */
}

int backend_open(tc_renderer **out, const char *name)
{
    const tc_renderer_options options = backend_options(name);
    tc_error err = {0};
    tc_status status = tc_renderer_create(out, &options, NULL, &err);
    if (status == TC_OK)
        return 0;
    printf("%s: %s\n", name, err.text);
    /* EGL may be installed and have no device; an OSMesa that is there must work. */
    if (status != TC_E_GL || (options.gl && strcmp(options.gl, "osmesa") == 0 && installed("libOSMesa.so.8")))
        return 1;
    printf("%s: skipped\n", name);
    return BACKEND_SKIPPED;
}
