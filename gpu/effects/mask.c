/* mask.c: bits of cells on the GPU. */
#include "gpu/effects/mask.h"

#include "core/memory.h"

#include <stdlib.h>
#include <string.h>

tc_status tc_effect_mask_upload(tc_texture_buffer *out, const tc_gl *gl, const uint32_t *mask, size_t n,
                                size_t n_imaginary, tc_error *err)
{
    size_t words = (n + 31) / 32, all = (n + n_imaginary + 31) / 32;
    tc_texture_buffer_finish(out, gl);
    uint32_t *bits = tc_calloc(all, sizeof *bits);
    if (!bits)
        return tc_fail_memory(err, "a mask of cells", all, sizeof *bits);
    memcpy(bits, mask, words * sizeof *bits);
    tc_status status =
        tc_texture_buffer_upload(out, gl, bits, all, sizeof *bits, GL_R32I, "uploading a mask of cells", err);
    free(bits);
    return status;
}

void tc_effect_mask_bind(const tc_texture_buffer *mask, const tc_job *job, GLuint program, const char *name,
                         GLuint unit)
{
    tc_effect_fetch(job, program, name, unit, GL_R32I, mask->texture);
}
