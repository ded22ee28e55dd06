/* mask.h: bits of cells (gpu/pack_mask.h) on the GPU, for rows that tell cells apart. */
#ifndef TC_GPU_EFFECTS_MASK_H
#define TC_GPU_EFFECTS_MASK_H

#include "gpu/effect.h"

/* Uploads mask: a bit for each of n real cells, that of imaginary ones 0; frees what is there. Errors: TC_E_MEMORY,
 * TC_E_GL. */
tc_status tc_effect_mask_upload(tc_texture_buffer *out, const tc_gl *gl, const uint32_t *mask, size_t n,
                                size_t n_imaginary, tc_error *err);
/* Binds it to the image or, where there are textures, the texture that shaders declare with FETCH_INTS(unit, r32i). */
void tc_effect_mask_bind(const tc_texture_buffer *mask, const tc_job *job, GLuint program, const char *name,
                         GLuint unit);

#endif
