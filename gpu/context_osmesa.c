/* context_osmesa.c: Mesa's off-screen context: the CPU renders, no display, no driver. */
#include "gpu/context.h"

#include "core/memory.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

/* The part of OSMesa's interface that is needed (osmesa.h would pull in GL/gl.h). */
typedef struct osmesa_context *OSMesaContext;
enum {
    OSMESA_RGBA = GL_RGBA,
    OSMESA_FORMAT = 0x22,
    OSMESA_DEPTH_BITS = 0x30,
    OSMESA_STENCIL_BITS = 0x31,
    OSMESA_ACCUM_BITS = 0x32,
    OSMESA_PROFILE = 0x33,
    OSMESA_CORE_PROFILE = 0x34,
    OSMESA_CONTEXT_MAJOR_VERSION = 0x36,
    OSMESA_CONTEXT_MINOR_VERSION = 0x37
};

typedef struct osmesa_state {
    void *library;
    OSMesaContext (*create)(const int *attributes, OSMesaContext share);
    void (*destroy)(OSMesaContext context);
    GLboolean (*make_current)(OSMesaContext context, void *buffer, GLenum type, GLsizei width, GLsizei height);
    void *(*get_proc)(const char *name);
    OSMesaContext context;
    unsigned char buffer[4 * 4]; /* OSMesa wants a window; drawing goes to framebuffer objects */
} osmesa_state;

static bool load(osmesa_state *s, const char *name, void *function)
{
    void *p = dlsym(s->library, name);
    memcpy(function, &p, sizeof p);
    return p != NULL;
}

static tc_status osmesa_make_current(tc_context *context, tc_error *err)
{
    osmesa_state *s = context->state;
    if (!s->make_current(s->context, s->buffer, GL_UNSIGNED_BYTE, 1, 1))
        return tc_fail(err, TC_E_GL, "OSMesa refused to make its context current");
    return TC_OK;
}

static tc_status osmesa_create(tc_context *context, tc_error *err)
{
    static const char *const names[] = {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
    osmesa_state *s = tc_calloc(1, sizeof *s);
    if (!s)
        return tc_fail_memory(err, "an OSMesa context", 1, sizeof *s);
    context->state = s;
    for (size_t i = 0; i < sizeof names / sizeof *names && !s->library; i++)
        s->library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL);
    if (!s->library)
        return tc_fail(err, TC_E_GL, "libOSMesa.so.8 is not installed (Debian: libosmesa6)");
    if (!load(s, "OSMesaCreateContextAttribs", &s->create) || !load(s, "OSMesaDestroyContext", &s->destroy) ||
        !load(s, "OSMesaMakeCurrent", &s->make_current) || !load(s, "OSMesaGetProcAddress", &s->get_proc))
        return tc_fail(err, TC_E_GL, "libOSMesa is too old: OSMesaCreateContextAttribs is missing (Mesa 12 or later)");
    for (int minor = 5; minor >= 3 && !s->context; minor -= 2) {
        const int attributes[] = {OSMESA_FORMAT,
                                  OSMESA_RGBA,
                                  OSMESA_DEPTH_BITS,
                                  0,
                                  OSMESA_STENCIL_BITS,
                                  0,
                                  OSMESA_ACCUM_BITS,
                                  0,
                                  OSMESA_PROFILE,
                                  OSMESA_CORE_PROFILE,
                                  OSMESA_CONTEXT_MAJOR_VERSION,
                                  4,
                                  OSMESA_CONTEXT_MINOR_VERSION,
                                  minor,
                                  0};
        s->context = s->create(attributes, NULL);
    }
    if (!s->context)
        return tc_fail(err, TC_E_GL, "OSMesa offers no OpenGL 4.3 core context");
    context->get_proc = s->get_proc;
    tc_status status = osmesa_make_current(context, err); /* a debug context needs no flag here */
    return status == TC_OK ? tc_gl_load(&context->gl, s->get_proc, err) : status;
}

static void osmesa_release(tc_context *context)
{
    osmesa_state *s = context->state;
    s->make_current(NULL, NULL, 0, 0, 0);
}

static void osmesa_finish(tc_context *context)
{
    osmesa_state *s = context->state;
    if (!s)
        return;
    if (s->context)
        s->destroy(s->context);
    /* The library stays loaded: Mesa's threads and LLVM do not survive a dlclose. */
    free(s);
    context->state = NULL;
}

const tc_context_kind tc_context_osmesa = {"osmesa", osmesa_create, osmesa_make_current, osmesa_release, osmesa_finish};
