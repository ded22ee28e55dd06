/* audit.c: what the walk noted about itself (march.glsl, AUDIT). */
#include "gpu/audit.h"

#include "core/memory.h"

#include <stdlib.h>
#include <string.h>

static float float_of_bits(uint32_t bits)
{
    float f;
    memcpy(&f, &bits, sizeof f);
    return f;
}

tc_status tc_audit_read(tc_audit_ray *out, const tc_state *s, const tc_gl *gl, double scale, const int rect[4],
                        tc_error *err)
{
    if (!s->auditing)
        return tc_fail(err, TC_E_ARG, "the last picture was not audited; render it with tc_render_options.audit");
    size_t pixels = (size_t)s->width * (size_t)s->height;
    memset(out, 0, pixels * sizeof *out);
    uint32_t *steps = tc_alloc(pixels, sizeof *steps), *audit = tc_alloc(pixels, 4 * sizeof *audit);
    if (!steps || !audit) {
        free(steps);
        free(audit);
        return tc_fail_memory(err, "the audit", pixels, 5 * sizeof *steps);
    }
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->BindTexture(GL_TEXTURE_2D, s->set[0].steps);
    gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, steps);
    gl->BindTexture(GL_TEXTURE_2D, s->set[0].audit);
    gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RGBA_INTEGER, GL_UNSIGNED_INT, audit);
    for (int y = rect[1]; y < rect[1] + rect[3]; y++) {
        for (int x = rect[0]; x < rect[0] + rect[2]; x++) {
            size_t from = (size_t)y * (size_t)s->width + (size_t)x;
            const uint32_t *a = audit + 4 * from;
            tc_audit_ray *ray = out + (size_t)(s->height - 1 - y) * (size_t)s->width + (size_t)x;
            ray->length = (float)(float_of_bits(a[0]) / scale);
            ray->length_real = (float)(float_of_bits(a[1]) / scale);
            ray->hash = a[2];
            ray->broken = a[3];
            ray->cells = steps[from];
        }
    }
    free(steps);
    free(audit);
    return tc_gl_check(gl, "reading the audit back", err);
}

tc_status tc_audit_steps(tc_render_stats *stats, const tc_state *s, const tc_gl *gl, tc_error *err)
{
    size_t n = (size_t)s->width * (size_t)s->height;
    uint32_t *steps = tc_alloc(n, sizeof *steps);
    if (!steps)
        return tc_fail_memory(err, "the counted steps", n, sizeof *steps);
    gl->BindTexture(GL_TEXTURE_2D, s->set[0].steps);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->GetTexImage(GL_TEXTURE_2D, 0, GL_RED_INTEGER, GL_UNSIGNED_INT, steps);
    for (size_t i = 0; i < n; i++) {
        stats->steps += steps[i];
        if (steps[i] > stats->steps_max)
            stats->steps_max = steps[i];
    }
    free(steps);
    return TC_OK;
}
