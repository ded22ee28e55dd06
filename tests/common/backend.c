/* backend.c: renderers by name, and why one is missing. */
#include "backend.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

bool backend_known(const char *name)
{
    return strcmp(name, "osmesa") == 0 || strcmp(name, "egl") == 0 || strcmp(name, "reference") == 0;
}

static bool installed(const char *library)
{
    return dlopen(library, RTLD_NOW | RTLD_LOCAL) != NULL; /* stays open: Mesa does not survive a dlclose */
}

int backend_open(tc_renderer **out, const char *name)
{
    bool gpu = strcmp(name, "reference") != 0;
    const tc_renderer_options options = {.gl = gpu ? name : NULL, .driver = gpu ? "pingpong" : "reference"};
    tc_error err = {0};
    tc_status status = tc_renderer_create(out, &options, NULL, &err);
    if (status == TC_OK)
        return 0;
    printf("%s: %s\n", name, err.text);
    /* EGL may be installed and have no device; an OSMesa that is there must work. */
    if (status != TC_E_GL || (strcmp(name, "osmesa") == 0 && installed("libOSMesa.so.8")))
        return 1;
    printf("%s: skipped\n", name);
    return BACKEND_SKIPPED;
}
