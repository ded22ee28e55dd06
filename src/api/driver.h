/* driver.h: the ways to make a picture, as a constant table (design: "Drivers"). */
#ifndef TC_API_DRIVER_H
#define TC_API_DRIVER_H

#include "gpu/renderer.h"
#include "gpu/saved.h"
#include "reference/reference.h"

/* A renderer is a driver with its state. */
struct tc_renderer {
    const struct tc_driver *driver;
    int threads;
    tc_gpu_renderer *gpu; /* pingpong, compute */
    bool host;            /* gpu lives in a context that the host owns */
    tc_reference *reference;
    uint64_t reference_serial; /* of the mesh that reference stands for */
};

typedef struct tc_driver {
    const char *name, *what; /* what: in a few words */
    const tc_gl_driver *gl;  /* NULL: it needs no GL */
    /* Fails where the driver cannot run here; err says why. */
    tc_status (*create)(tc_renderer *renderer, const tc_renderer_options *options, const tc_log *log, tc_error *err);
    /* One frame into image (made by the caller); frame->options is checked. */
    tc_status (*render)(tc_image *image, tc_render_stats *stats, tc_renderer *renderer, const tc_gpu_frame *frame,
                        tc_error *err);
    void (*finish)(tc_renderer *renderer);
} tc_driver;

/* The drivers of this build, best first; `auto` takes the first that can be created, but compute in place of pingpong
 * where the GL is not software: there few units may run fragment shaders. NULL name ends the table. */
extern const tc_driver tc_drivers[];

/* Checks what every driver relies on and fills unit and rays. Errors: TC_E_ARG. */
tc_status tc_render_resolve(double *unit, tc_rays *rays, const tc_mesh *mesh, const tc_transfer *tf,
                            const tc_camera *camera, const tc_render_options *options, tc_error *err);

#endif
