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
    double near_t, far_t; /* what is seen lies between origin + near_t * direction and origin + far_t * direction */
    double part[2];       /* of the pixel (0, 0) in X, Y: the picture may be a part of one */
    float clip[16];       /* mesh space → clip space, column-major */
    float whole_clip[16]; /* the same of the whole picture, of whole_size [2] pixels */
    double whole_size[2];
    /* What of that the mesh's sphere calls for. The near plane is the eye's own where nothing is clipped. */
    bool clip_near;  /* the near plane cuts the mesh: walks start at the entry before it, and segments are cut */
    bool clip_far;   /* the far plane cuts the mesh: a walk ends there */
    bool ahead;      /* the eye is outside the mesh, but its plane may cut it: entries behind it are none */
    bool hidden;     /* the whole mesh lies before the near or beyond the far plane: nothing is seen */
    bool eye_inside; /* perspective, the eye in the mesh's sphere: lines enter behind it */
} tc_frame;

/* center, scale: of the pack. */
void tc_frame_build(tc_frame *out, const tc_rays *rays, const double center[3], double scale);

#endif
