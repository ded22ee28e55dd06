/* accumulate.h: from what rays gathered (state set tc_job.last) to the picture (tc_state.result): one ray a pixel as it is,
 * several added up where they are, so that memory does not grow with their number; and, sampling adaptively, which
 * pixels get more (src/scene/samples.h). All within the picture's rectangle of proposals, with the scissor test on. */
#ifndef TC_GPU_ACCUMULATE_H
#define TC_GPU_ACCUMULATE_H

#include "gpu/job.h"

/* Compiles what pictures of so many rays a pixel need. Errors: TC_E_GL. */
tc_status tc_accumulate_compile(const tc_job *job, int samples, tc_error *err);
/* Empties the picture within drawn [4] and, where there are such textures, the differences of rays. Leaves the scissor
 * test on. */
void tc_accumulate_begin(const tc_job *job, const int drawn[4]);
/* Adds the rays of a frame, each `share` of its pixel. share 1: they replace what is there. Errors: TC_E_GL. */
tc_status tc_accumulate_add(const tc_job *job, double share, tc_error *err);
/* Keeps by how much the rays of a pixel differ: a frame of the first grid. Errors: TC_E_GL. */
tc_status tc_accumulate_spread(const tc_job *job, bool first, tc_error *err);
/* Marks the pixels whose rays differ by more than TC_SAMPLES_SPREAD in a channel, in tc_state.mask, and empties
 * them in the picture. rect [4]: x, y (from the bottom), width, height of the pixels to look at; becomes those that
 * hold all that are marked, width 0 if none is. *n: how many they are. Errors: TC_E_GL, TC_E_MEMORY. Cost: one byte a
 * pixel of rect is read back. */
tc_status tc_accumulate_mark(int rect[4], int64_t *n, const tc_job *job, tc_error *err);

#endif
