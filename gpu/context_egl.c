/* context_egl.c: EGL without a surface: a GPU's device first, then Mesa's surfaceless platform. */
#include "gpu/context.h"

#include "core/memory.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_DEVICES = 16 };

typedef struct egl_state {
    void *library;
    void *(*get_proc)(const char *name);
    EGLBoolean (*initialize)(EGLDisplay, EGLint *, EGLint *);
    EGLBoolean (*bind_api)(EGLenum);
    EGLBoolean (*choose_config)(EGLDisplay, const EGLint *, EGLConfig *, EGLint, EGLint *);
    EGLContext (*create_context)(EGLDisplay, EGLConfig, EGLContext, const EGLint *);
    EGLBoolean (*destroy_context)(EGLDisplay, EGLContext);
    EGLBoolean (*make_current)(EGLDisplay, EGLSurface, EGLSurface, EGLContext);
    EGLContext (*get_current)(void);
    const char *(*query_string)(EGLDisplay, EGLint);
    PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display;
    PFNEGLQUERYDEVICESEXTPROC query_devices;
    PFNEGLQUERYDEVICESTRINGEXTPROC query_device_string;
    EGLDisplay display;
    EGLContext context;
} egl_state;

static bool load(egl_state *s, const char *name, void *function)
{
    void *p = dlsym(s->library, name);
    memcpy(function, &p, sizeof p);
    return p != NULL;
}

static void load_extension(egl_state *s, const char *name, void *function)
{
    void *p = s->get_proc(name);
    memcpy(function, &p, sizeof p);
}

/* Destroys our context. The display stays initialised: there is one a device in the whole process, which other
 * renderers and the host may use too, and eglTerminate would end theirs. */
static void close_display(egl_state *s)
{
    if (s->context != EGL_NO_CONTEXT) {
        if (s->get_current() == s->context)
            s->make_current(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        s->destroy_context(s->display, s->context);
    }
    s->context = EGL_NO_CONTEXT;
    s->display = EGL_NO_DISPLAY;
}

/* The API is that of the calling thread, which need not be the one that made the context. What is current goes first:
 * EGL does nothing for a context that it believes to be current, but which OSMesa took away without its knowing: both
 * may be of one Mesa. */
static tc_status egl_make_current(tc_context *context, tc_error *err)
{
    egl_state *s = context->state;
    s->bind_api(EGL_OPENGL_API);
    s->make_current(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (!s->make_current(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, s->context))
        return tc_fail(err, TC_E_GL, "EGL refused to make a context without a surface current");
    return TC_OK;
}

/* Opens a 4.5 (else 4.3) core context on a display; closes it again when that fails. */
static tc_status open_display(tc_context *context, EGLDisplay display, tc_error *err)
{
    egl_state *s = context->state;
    if (display == EGL_NO_DISPLAY || !s->initialize(display, NULL, NULL))
        return tc_fail(err, TC_E_GL, "EGL cannot open this display");
    s->display = display;
    const EGLint config_attributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                        EGL_NONE};
    EGLConfig config = NULL;
    EGLint n = 0;
    if (!s->choose_config(display, config_attributes, &config, 1, &n) || n < 1)
        config = NULL; /* EGL_KHR_no_config_context */
    s->bind_api(EGL_OPENGL_API);
    for (int minor = 5; minor >= 3 && s->context == EGL_NO_CONTEXT; minor -= 2) {
        EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               4,
                               EGL_CONTEXT_MINOR_VERSION,
                               minor,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               context->debug ? EGL_CONTEXT_OPENGL_DEBUG : EGL_NONE,
                               EGL_TRUE,
                               EGL_NONE};
        s->context = s->create_context(display, config, EGL_NO_CONTEXT, attributes);
        if (s->context == EGL_NO_CONTEXT && context->debug) { /* before EGL 1.5 there is no such attribute */
            attributes[6] = EGL_NONE;
            s->context = s->create_context(display, config, EGL_NO_CONTEXT, attributes);
        }
    }
    tc_status status = TC_OK;
    if (s->context == EGL_NO_CONTEXT)
        status = tc_fail(err, TC_E_GL, "EGL offers no OpenGL 4.3 core context on this device");
    if (status == TC_OK)
        status = egl_make_current(context, err);
    if (status == TC_OK)
        status = tc_gl_load(&context->gl, s->get_proc, err);
    if (status != TC_OK)
        close_display(s);
    return status;
}

static tc_status egl_create(tc_context *context, tc_error *err)
{
    egl_state *s = tc_calloc(1, sizeof *s);
    if (!s)
        return tc_fail_memory(err, "an EGL context", 1, sizeof *s);
    context->state = s;
    s->display = EGL_NO_DISPLAY;
    s->context = EGL_NO_CONTEXT;
    s->library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!s->library)
        return tc_fail(err, TC_E_GL, "libEGL.so.1 is not installed (Debian: libegl1)");
    if (!load(s, "eglGetProcAddress", &s->get_proc) || !load(s, "eglInitialize", &s->initialize) ||
        !load(s, "eglBindAPI", &s->bind_api) || !load(s, "eglGetCurrentContext", &s->get_current) ||
        !load(s, "eglChooseConfig", &s->choose_config) || !load(s, "eglCreateContext", &s->create_context) ||
        !load(s, "eglDestroyContext", &s->destroy_context) || !load(s, "eglMakeCurrent", &s->make_current) ||
        !load(s, "eglQueryString", &s->query_string))
        return tc_fail(err, TC_E_GL, "libEGL.so.1 lacks functions of EGL 1.4");
    context->get_proc = s->get_proc;
    load_extension(s, "eglGetPlatformDisplayEXT", &s->get_platform_display);
    load_extension(s, "eglQueryDevicesEXT", &s->query_devices);
    load_extension(s, "eglQueryDeviceStringEXT", &s->query_device_string);
    if (!s->get_platform_display)
        return tc_fail(err, TC_E_GL, "EGL has no eglGetPlatformDisplayEXT: it cannot render without a display");

    EGLDeviceEXT devices[MAX_DEVICES];
    EGLint n = 0;
    if (s->query_devices && !s->query_devices(MAX_DEVICES, devices, &n))
        n = 0;
    /* To open a software device takes as long as to open a GPU, and where devices are listed all GPUs are. */
    const bool listed = context->hardware_only && n > 0;
    for (int software = 0; software < (listed ? 1 : 2); software++) /* hardware devices first */
        for (EGLint i = 0; i < n; i++) {
            const char *extensions = s->query_device_string ? s->query_device_string(devices[i], EGL_EXTENSIONS) : NULL;
            bool is_software = extensions && strstr(extensions, "EGL_MESA_device_software") != NULL;
            if (is_software == (software == 1) &&
                open_display(context, s->get_platform_display(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL), err) == TC_OK)
                return TC_OK;
        }
    if (listed)
        return tc_fail(err, TC_E_GL, "EGL offers no OpenGL 4.3 context on a GPU (%d devices listed)", (int)n);
    if (open_display(context, s->get_platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL), err) ==
        TC_OK)
        return TC_OK;
    return tc_fail(err, TC_E_GL, "EGL offers no OpenGL 4.3 context without a display (%d devices tried)", (int)n);
}

static void egl_release(tc_context *context)
{
    egl_state *s = context->state;
    s->bind_api(EGL_OPENGL_API);
    s->make_current(s->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

static void egl_finish(tc_context *context)
{
    egl_state *s = context->state;
    if (!s)
        return;
    close_display(s);
    free(s); /* the library stays loaded: drivers do not survive a dlclose */
    context->state = NULL;
}

const tc_context_kind tc_context_egl = {"egl", egl_create, egl_make_current, egl_release, egl_finish};
