/* compute.h: the ray caster in a compute shader: the state of a ray stays in registers from its entry to its end. */
#ifndef TC_GPU_COMPUTE_H
#define TC_GPU_COMPUTE_H

#include "gpu/job.h"

extern const tc_gl_driver tc_driver_compute;

#endif
