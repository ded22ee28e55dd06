/* first_hit.h: finds where each ray enters the mesh: boundary faces, drawn (Weiler et al. 2003, 3.1; design: "First
 * hit"). With peeling, one call finds each ray's next entry. */
#ifndef TC_GPU_FIRST_HIT_H
#define TC_GPU_FIRST_HIT_H

#include "gpu/job.h"

/* tc_job_defines, and SAMPLE_MASK where only marked pixels have a ray. */
void tc_first_hit_defines(char *out, size_t capacity, const tc_job *job);
/* Compiles the program. Errors: TC_E_GL. */
tc_status tc_first_hit_compile(const tc_job *job, tc_error *err);
/* Writes walk and at of state set 0: the entry of each ray, cell -1 where there is none. layer 0: the first entry;
 * layer > 0 (peeling): the next after the one found by layer - 1. Errors: TC_E_GL. */
tc_status tc_first_hit(const tc_job *job, int layer, tc_error *err);
/* Behind the first layer, without peeling: the number of entries of all rays, whether the first of theirs or not. Waits
 * for the GL. */
int64_t tc_first_hit_entries(const tc_job *job);
/* Behind the first layer: the rays that have an entry. Binds framebuffers. Waits for the GL. Errors: TC_E_GL. */
tc_status tc_first_hit_rays(int64_t *rays, const tc_job *job, tc_error *err);
/* Of n corners proposed, how many lie on the GPU at a time. */
size_t tc_first_hit_corners(size_t n);

#endif
