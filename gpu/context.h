/* context.h: ways to get a GL context without a display. A constant table, best first; each is opened with dlopen, so
 * that a machine without it can say so and use another. */
#ifndef TC_GPU_CONTEXT_H
#define TC_GPU_CONTEXT_H

#include "gpu/gl.h"

typedef struct tc_context tc_context;

/* One kind of context. `create` makes it current and fills context->gl and get_proc; `missing` text goes to err. */
typedef struct tc_context_kind {
    const char *name;
    tc_status (*create)(tc_context *context, tc_error *err);
    tc_status (*make_current)(tc_context *context, tc_error *err);
    void (*release)(tc_context *context); /* current on no thread any more */
    void (*finish)(tc_context *context);
} tc_context_kind;

struct tc_context {
    const tc_context_kind *kind;
    tc_gl gl;
    bool software;        /* the renderer runs on the CPU */
    bool debug;           /* create asks for a debug context */
    bool hardware_only;   /* create need not try what is known to be software */
    tc_get_proc get_proc; /* set by create */
    void *state;          /* of the kind */
};

extern const tc_context_kind tc_context_osmesa, tc_context_egl;

/* Kinds of this build, best first; NULL ends the list. */
const tc_context_kind *const *tc_context_kinds(void);

/* name: "auto" (a hardware EGL, else OSMesa, else a software EGL; says to log why one was refused) or a kind's name.
 * Where the environment says TETCAST_GL_DEBUG=1 it is a debug context, watched (watch.h).
 * Errors: TC_E_ARG (unknown name: lists them), TC_E_GL (none works: says why, each). */
tc_status tc_context_create(tc_context **out, const char *name, const tc_log *log, tc_error *err);
/* A context that the host owns and has made current; its make_current does nothing; it is left as it is, so not watched. */
tc_status tc_context_create_host(tc_context **out, tc_get_proc get_proc, tc_error *err);
tc_status tc_context_make_current(tc_context *context, tc_error *err);
/* Takes it from the calling thread, so that another one can make it current. */
void tc_context_release(tc_context *context);
void tc_context_destroy(tc_context **context);

#endif
