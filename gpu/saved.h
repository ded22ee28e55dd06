/* saved.h: the GL state of a host that the renderer touches, kept and put back. */
#ifndef TC_GPU_SAVED_H
#define TC_GPU_SAVED_H

#include "gpu/gl.h"

enum { TC_SAVED_UNITS = 9 };

typedef struct tc_gl_saved {
    GLint draw_framebuffer, read_framebuffer, program, vertex_array, active_texture, renderbuffer, texture_buffer;
    GLint viewport[4], scissor_box[4];
    GLint unit_2d[TC_SAVED_UNITS], unit_1d[TC_SAVED_UNITS], unit_3d[TC_SAVED_UNITS], unit_buffer[TC_SAVED_UNITS],
        unit_sampler[TC_SAVED_UNITS];
    GLint depth_func, blend_src_rgb, blend_dst_rgb, blend_src_alpha, blend_dst_alpha, blend_equation, pack_alignment;
    GLboolean depth_mask, color_mask[4];
    GLboolean depth_test, blend, scissor, cull, stencil;
} tc_gl_saved;

/* Keeps the state and sets what the renderer expects (no samplers bound, no scissor, …). */
void tc_gl_save(tc_gl_saved *saved, const tc_gl *gl);
void tc_gl_restore(const tc_gl_saved *saved, const tc_gl *gl);

#endif
