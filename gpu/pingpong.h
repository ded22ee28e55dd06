/* pingpong.h: the multi-pass ray caster with two sets of textures (Weiler et al. 2003, 3.4, 5.1 and 5.2). */
#ifndef TC_GPU_PINGPONG_H
#define TC_GPU_PINGPONG_H

#include "gpu/job.h"

extern const tc_gl_driver tc_driver_pingpong;

#endif
