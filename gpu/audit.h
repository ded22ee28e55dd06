/* audit.h: what the walk noted about itself, read back: tc_render_audit. */
#ifndef TC_GPU_AUDIT_H
#define TC_GPU_AUDIT_H

#include "gpu/state.h"

/* out [height][width], row 0 at the top; lengths in the mesh's unit.
 *   scale  half diagonals a unit of the mesh
 *   rect   [4] x, y, width, height: the pixels the last picture touched, row 0 at the bottom; others get zeros
 * Errors: TC_E_ARG when the state was made without auditing, TC_E_MEMORY, TC_E_GL. Cost: 20 bytes a pixel of scratch. */
tc_status tc_audit_read(tc_audit_ray *out, const tc_state *state, const tc_gl *gl, double scale, const int rect[4],
                        tc_error *err);
/* Adds the steps of a counted frame to stats->steps, and takes the longest ray's into stats->steps_max.
 * Errors: TC_E_MEMORY. Cost: 4 bytes a pixel of scratch. */
tc_status tc_audit_steps(tc_render_stats *stats, const tc_state *state, const tc_gl *gl, tc_error *err);

#endif
