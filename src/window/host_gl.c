/* host_gl.c: addresses of OpenGL's functions in the context that GTK made. Which of the two libraries has a current
 * context is asked of those that are loaded already: GTK opened the one that it took. */
#include "window/host_gl.h"

#include <dlfcn.h>
#include <epoxy/gl.h>
#include <string.h>

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

bool tc_host_gl_try(GdkDisplay *display, bool *software, char why[512])
{
    GError *error = NULL;
    GdkGLContext *context = gdk_display_create_gl_context(display, &error);
    *software = false;
    if (context) {
        gdk_gl_context_set_required_version(context, 4, 3);
        if (!gdk_gl_context_realize(context, &error))
            g_clear_object(&context);
    }
    if (!context) {
        g_snprintf(why, 512, "%s", error ? error->message : "it gave no context");
        g_clear_error(&error);
        return false;
    }
    gdk_gl_context_make_current(context);
    const char *renderer = (const char *)glGetString(GL_RENDERER);
    *software = renderer && (strstr(renderer, "llvmpipe") || strstr(renderer, "softpipe") || strstr(renderer, "SWR"));
    const int version = epoxy_gl_version();
    const bool good = version >= 43;
    if (!good)
        g_snprintf(why, 512, "it has OpenGL %d.%d", version / 10, version % 10);
    gdk_gl_context_clear_current();
    g_object_unref(context);
    return good;
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
