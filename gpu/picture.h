/* picture.h: a picture of one frame of rays, or of several: rays through the middles of pixels, or through each place
 * of a grid in them (src/scene/samples.h), frame after frame, so that memory does not grow with their number. */
#ifndef TC_GPU_PICTURE_H
#define TC_GPU_PICTURE_H

#include "gpu/job.h"

typedef struct tc_picture {
    tc_job *job; /* all but frame, masked and proposals, which are set here */
    const tc_rays *rays;
    const tc_render_options *options;
    const tc_log *log;
    const double *center; /* [3] of the pack */
    double scale;
    const float *face_corner;
    tc_proposals *proposals;
    struct tc_kept *kept; /* kept.h, of the mesh and values with these serials */
    uint64_t mesh_serial, scalar_serial;
    int threads;
    int *drawn; /* [4] the part of state.result that is not empty; becomes this picture's */

    tc_frame rays_now;      /* of the frame that is made, or was made last */
    tc_render_stats *stats; /* gets refined and, if counted, steps and steps_max */
    tc_job_result result;   /* sums over all frames; fragments: those of one frame after another */
    double ms_aside;        /* spent on reading counters, which is not rendering */
    int marked[4];          /* where the job is masked: the pixels that hold all marked ones */
} tc_picture;

/* Compiles all that the picture needs, so that its time holds no compiling. Errors: TC_E_GL. */
tc_status tc_picture_compile(tc_picture *picture, tc_error *err);
/* First hits, march and the sum, into state.result; leaves the scissor test on. Where result.twice is above 0 the
 * picture has to be made again, by peeling. picture->result.fragments is the caller's to free, on failure too.
 * Errors: TC_E_GL, TC_E_MEMORY. */
tc_status tc_picture_make(tc_picture *picture, tc_error *err);

#endif
