/* host_gl.c: addresses of OpenGL's functions in the context that GTK made. Which of the two libraries has a current
 * context is asked of those that are loaded already: GTK opened the one that it took. */
#include "window/host_gl.h"

#include <dlfcn.h>
#include <stddef.h>

typedef void *current_function(void);
typedef void *proc_function(const char *name);

static proc_function *proc;

static bool take(const char *library, const char *current, const char *address)
{
    void *handle = dlopen(library, RTLD_NOW | RTLD_NOLOAD);
    if (!handle)
        return false;
    current_function *now;
    *(void **)&now = dlsym(handle, current);
    if (!now || !now())
        return false;
    *(void **)&proc = dlsym(handle, address);
    return proc != NULL;
}

bool tc_host_gl_ready(void)
{
    return proc || take("libEGL.so.1", "eglGetCurrentContext", "eglGetProcAddress") ||
           take("libGLX.so.0", "glXGetCurrentContext", "glXGetProcAddressARB") ||
           take("libGL.so.1", "glXGetCurrentContext", "glXGetProcAddressARB");
}

void *tc_host_proc_address(const char *name)
{
    return proc ? proc(name) : NULL;
}
