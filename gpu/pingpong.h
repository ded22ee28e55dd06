/* pingpong.h: the multi-pass ray caster with two sets of float textures (Weiler et al. 2003, 3.4, 5.1 and 5.2). */
#ifndef TC_GPU_PINGPONG_H
#define TC_GPU_PINGPONG_H

#include "gpu/job.h"

/* Compiles what the frame will use, so that the frame's time holds no compiling. Errors: TC_E_GL. */
tc_status tc_pingpong_compile(const tc_job *job, tc_error *err);
/* First hit and march of one frame; leaves the final state in set 0. Errors: TC_E_GL, TC_E_MEMORY. Lost rays are
 * counted, not an error here. */
tc_status tc_pingpong_frame(tc_job_result *out, const tc_job *job, tc_error *err);

#endif
