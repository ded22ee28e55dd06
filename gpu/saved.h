/* saved.h: the GL state of a host that the renderer touches, kept and put back. */
#ifndef TC_GPU_SAVED_H
#define TC_GPU_SAVED_H

#include "gpu/gl.h"

enum { TC_SAVED_UNITS = 31, TC_SAVED_IMAGES = 16, TC_SAVED_SWITCHES = 23, TC_SAVED_STORES = 12, TC_SAVED_INDEXED = 2 };

typedef struct tc_gl_saved {
    GLint draw_framebuffer, read_framebuffer, program, vertex_array, active_texture, renderbuffer, texture_buffer;
    GLint viewport[4], scissor_box[4];
    GLint unit_2d[TC_SAVED_UNITS], unit_1d[TC_SAVED_UNITS], unit_3d[TC_SAVED_UNITS], unit_buffer[TC_SAVED_UNITS],
        unit_sampler[TC_SAVED_UNITS];
    GLint array_buffer, pack_buffer, unpack_buffer;
    struct { /* atomic counters, shader storage: the general binding, and binding 0 with its range */
        GLint buffer, bound;
        GLint64 start, size;
    } indexed[TC_SAVED_INDEXED];
    GLint depth_func, blend_src_rgb, blend_dst_rgb, blend_src_alpha, blend_dst_alpha, blend_equation_rgb,
        blend_equation_alpha, polygon_mode[2];
    GLint store[TC_SAVED_STORES]; /* of saved.c's list */
    GLfloat depth_range[2];
    GLint image[TC_SAVED_IMAGES], image_level[TC_SAVED_IMAGES], image_layer[TC_SAVED_IMAGES],
        image_access[TC_SAVED_IMAGES], image_format[TC_SAVED_IMAGES];
    GLboolean image_layered[TC_SAVED_IMAGES];
    GLboolean depth_mask, color_mask[4];
    GLboolean enabled[TC_SAVED_SWITCHES]; /* of saved.c's list */
} tc_gl_saved;

/* Keeps the state and sets what the renderer expects (no samplers bound, every switch off, pixel storage as in a new
 * context, …). GL errors of the host's that are pending are dropped, or they would be taken for ours. */
void tc_gl_save(tc_gl_saved *saved, const tc_gl *gl);
/* Puts it back; in the same context. */
void tc_gl_restore(const tc_gl_saved *saved, const tc_gl *gl);

#endif
