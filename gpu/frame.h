/* frame.h: the rays of an image in mesh space: what the shaders' uniforms hold. No GL call in it. */
#ifndef TC_GPU_FRAME_H
#define TC_GPU_FRAME_H

#include "gpu/pack.h"
#include "scene/camera.h"

/* Design: "Ray frame". Mesh space has the bounding box's centre as origin and its half diagonal as unit. */
typedef struct tc_frame {
    double point[3], point_dx[3], point_dy[3];             /* frame origin of pixel (X, Y), affine */
    double direction[3], direction_dx[3], direction_dy[3]; /* not normalised */
    double up[3];                                          /* not parallel to any ray */
    double eye_t;    /* origin = eye + eye_t * direction; huge where no eye bounds the ray (parallel, or eye_inside) */
    float clip[16];  /* mesh space → clip space, column-major */
    bool eye_inside; /* the eye is in the mesh's sphere: rays start at depth 0 */
    bool behind;     /* the whole mesh lies behind the eye: nothing is seen */
} tc_frame;

/* center, scale: of the pack. */
void tc_frame_build(tc_frame *out, const tc_rays *rays, const double center[3], double scale);

#endif
