/* camera.h: from ParaView's camera to rays. GLM does the matrices behind this C header (camera_glm.cpp). */
#ifndef TC_SCENE_CAMERA_H
#define TC_SCENE_CAMERA_H

#include "core/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The rays of an image, affine in the pixel. Pixel (x, y), y counted from the BOTTOM, has its centre at
 * (X, Y) = (x + 0.5, y + 0.5):
 *   perspective: ray = eye + t * normalize(direction + X*direction_dx + Y*direction_dy), t >= 0
 *   parallel:    ray = (origin + X*origin_dx + Y*origin_dy) + t * direction, any t; origin lies in the focal plane
 * clip: world → clip space, column-major as GL, whose x, y agree with the pixels. Its z row is zero, so that GL clips by
 * w > 0 alone (w is the distance along the view, 1 in parallel) and no near or far plane cuts the mesh.
 * In perspective origin = eye and origin_dx = origin_dy = 0; in parallel eye is the camera's position, for depth alone. */
typedef struct tc_rays {
    bool parallel;
    double eye[3];
    double origin[3], origin_dx[3], origin_dy[3];
    double direction[3], direction_dx[3], direction_dy[3]; /* parallel: unit direction, dx = dy = 0 */
    double clip[16];
    int width, height;
} tc_rays;

/* Errors: TC_E_ARG, naming the value: eye = focal point, angle outside (0, 180), scale <= 0, not finite, size < 1.
 * A view-up parallel to the view (to 1e-9) is replaced by (-z, x, y), as VTK's ResetCamera does, or by an axis. */
tc_status tc_rays_from_camera(tc_rays *out, const tc_camera *camera, int width, int height, tc_error *err);

/* One pixel's ray: origin [3] and unit direction [3] in world coordinates. */
void tc_rays_pixel(double *origin, double *direction, const tc_rays *rays, double X, double Y);

#ifdef __cplusplus
}
#endif
#endif
