/* state.h: the textures that carry rays from pass to pass: two sets for ping-pong (Weiler et al. 2003, 5.1, Table 1).
 */
#ifndef TC_GPU_STATE_H
#define TC_GPU_STATE_H

#include "gpu/gl.h"

/* The attachments of tc_state_set.framebuffer, as march.frag has them. */
enum { TC_STATE_WALK, TC_STATE_COLOR, TC_STATE_AT, TC_STATE_STEPS, TC_STATE_AUDIT, TC_STATE_TEXTURES };

typedef struct tc_state_set {
    GLuint walk;  /* RGBA32I: cell, face's vertices */
    GLuint color; /* RGBA32F or RGBA16F: colour, optical depth or transmittance */
    GLuint at;    /* RGBA32I: depth, scalar (bits of floats), the cell it comes from, 1; or 0 0 -1 0: where it enters */
    GLuint steps; /* R32UI, only when counting */
    GLuint audit; /* RGBA32UI: length and length in real cells (float bits), hash, broken; only when auditing */
    GLuint framebuffer; /* all of them, and the lock */
} tc_state_set;

typedef struct tc_state {
    int width, height;
    bool counting, auditing, peeling, adaptive;
    int color_bits; /* a channel of tc_state_set.color: 32 or 16 */
    tc_state_set set[2];
    GLuint lock;                       /* depth renderbuffer: near where the ray is finished */
    GLuint lock_framebuffer;           /* the lock alone */
    GLuint hit_depth;                  /* depth renderbuffer of the first hit */
    GLuint hit_framebuffer[2];         /* walk of set 0, key i when peeling */
    GLuint key[2];                     /* RG32I: previous and next entry, only when peeling */
    GLuint result, result_framebuffer; /* RGBA32F */
    /* Only when sampling adaptively: the most of each channel among a pixel's rays and minus the least (RGBA32F), and
     * which pixels get more (R8UI: 1; its framebuffer holds the result, too). */
    GLuint spread[2], spread_framebuffer, mask, mask_framebuffer;
    size_t bytes;
} tc_state;

/* Of options: width, height, count, audit (which counts as well), samples (whether adaptive: more rays need no more
 * memory), state_format. tc_state_fits: is the state the one that tc_state_create would make?
 * Errors: TC_E_ARG when the image exceeds the GL's limit, TC_E_MEMORY, TC_E_GL. */
tc_status tc_state_create(tc_state *out, const tc_gl *gl, const tc_render_options *options, bool peeling,
                          tc_error *err);
bool tc_state_fits(const tc_state *state, const tc_render_options *options, bool peeling);
void tc_state_finish(tc_state *state, const tc_gl *gl);
/* For tests: the worst that a frame can find. NaN in all that the last one left but the result, and everything locked.
 * Binds another framebuffer. Scissor test off. */
void tc_state_poison(const tc_state *state, const tc_gl *gl);

#endif
