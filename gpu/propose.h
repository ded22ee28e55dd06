/* propose.h: which pixels may hold an entry into the mesh: boundary faces as enlarged screen polygons. No GL call in
 * it. */
#ifndef TC_GPU_PROPOSE_H
#define TC_GPU_PROPOSE_H

#include "gpu/frame.h"

/* One corner of a proposed triangle: place in clip space (w = 1) and the face it belongs to. */
typedef struct tc_proposal {
    float x, y;
    int32_t face;
} tc_proposal;

typedef struct tc_proposals {
    tc_proposal *corner; /* [n], three a triangle; faces ascending */
    size_t n, capacity;
    int rect[4]; /* pixels that hold every proposal: x, y (from the bottom), width, height; empty: width 0 */
} tc_proposals;

/* Proposes every pixel whose ray may enter through a face: each face that may look at the eye, a little
 * enlarged.
 * Faces that clearly look away or lie behind the eye are left out; the exact decision is first_hit.frag's.
 *   corner [n_face][3][3]: places of the faces' corners as packed, borrowed
 * Errors: TC_E_MEMORY. Cost: about 30 ns a face. */
tc_status tc_propose(tc_proposals *out, const tc_frame *frame, int width, int height, const float *corner,
                     size_t n_face, tc_error *err);
void tc_proposals_finish(tc_proposals *proposals);

#endif
