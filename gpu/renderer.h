/* renderer.h: a GL context with what is uploaded into it: mesh, transfer function, state, programs. Keeps what still
 * fits the next frame. */
#ifndef TC_GPU_RENDERER_H
#define TC_GPU_RENDERER_H

#include "gpu/context.h"
#include "gpu/job.h"

typedef struct tc_gpu_renderer tc_gpu_renderer;

/* One frame's inputs; all borrowed. options as the caller gave them, checked; where a zero
 * means "choose" the renderer chooses, but for unit_distance, which is here as a length above 0. */
typedef struct tc_gpu_frame {
    const tc_gl_driver *driver;
    const tc_mesh *mesh;
    const tc_transfer *transfer;
    const tc_rays *rays;
    const tc_render_options *options;
    double unit_distance;
    const tc_log *log;
} tc_gpu_frame;

/* name as in tc_context_create; get_proc not NULL: a context of the host's. */
tc_status tc_gpu_renderer_create(tc_gpu_renderer **out, const char *name, tc_get_proc get_proc, int threads,
                                 const tc_log *log, tc_error *err);
void tc_gpu_renderer_destroy(tc_gpu_renderer **renderer);
/* Takes its context from the calling thread, so that the next call may come from another one. */
void tc_gpu_renderer_release(tc_gpu_renderer *renderer);
/* How many bytes of walks may be kept (kept.h); 0, as at first: none. at_once: a view comes often. */
void tc_gpu_renderer_keep(tc_gpu_renderer *renderer, size_t bytes, bool at_once);
/* Frees what is kept. Errors: TC_E_GL. */
tc_status tc_gpu_renderer_forget(tc_gpu_renderer *renderer, tc_error *err);
const tc_context *tc_gpu_renderer_context(const tc_gpu_renderer *renderer);

/* Packs, uploads and compiles what changed, then renders; the result stays in a texture. Fills stats.
 * Errors: TC_E_GL, TC_E_MEMORY, TC_E_LOST (the picture is there). */
tc_status tc_gpu_render(tc_render_stats *stats, tc_gpu_renderer *renderer, const tc_gpu_frame *frame, tc_error *err);
/* The last result as an image, row 0 at the top. rgba [height][width][4], the caller's, zeros: where nothing was drawn it
 * stays as it is. */
tc_status tc_gpu_read(float *rgba, tc_render_stats *stats, tc_gpu_renderer *renderer, tc_error *err);
/* tc_render_explain. */
tc_status tc_gpu_explain(tc_explanation *out, const tc_gpu_renderer *renderer, tc_error *err);
/* tc_render_audit. */
tc_status tc_gpu_audit(tc_audit_ray *out, tc_gpu_renderer *renderer, tc_error *err);
/* The last result drawn over a framebuffer of the host's context. As tc_gpu_render and tc_gpu_read it changes GL state:
 * the caller puts the host's back (saved.h). Errors: TC_E_GL. */
tc_status tc_gpu_draw(tc_gpu_renderer *renderer, unsigned framebuffer, tc_error *err);

#endif
