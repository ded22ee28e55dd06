/* camera.h: from ParaView's camera to rays. GLM does the matrices behind this C header (camera_glm.cpp). */
#ifndef TC_SCENE_CAMERA_H
#define TC_SCENE_CAMERA_H

#include "core/status.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The rays of an image, affine in the pixel. Pixel (x, y) of the whole picture, y counted from the BOTTOM, has its centre at
 * (X, Y) = (x + 0.5, y + 0.5):
 *   perspective: ray = eye + t * normalize(direction + X*direction_dx + Y*direction_dy), t >= 0
 *   parallel:    ray = (origin + X*origin_dx + Y*origin_dy) + t * direction; origin lies in the focal plane
 * Only what lies between the distances near and far before the eye's plane, measured along axis, is seen: in parallel
 * projection, too, nothing behind the camera is (as in VTK, whose clipping range begins at the camera).
 * clip: world → clip space, column-major as GL, whose x, y agree with the pixels. Its z row is zero, so that GL clips
 * by w > 0 alone (w is the distance along the view, 1 in parallel) and no near or far plane cuts the mesh. In
 * perspective origin = eye and origin_dx = origin_dy = 0; in parallel eye is the camera's position, for depth alone.
 * The image may be a part of the picture: its pixel (x, y) is then (x + part_x, y + part_y) of the whole. Its rays are computed
 * from the whole's numbers, so that they have the same bits in every part. */
typedef struct tc_rays {
    bool parallel;
    double eye[3];
    double origin[3], origin_dx[3], origin_dy[3];
    double direction[3], direction_dx[3], direction_dy[3]; /* parallel: unit direction, dx = dy = 0 */
    double axis[3];   /* unit direction of projection; dot(direction of a pixel, not normalised, axis) = 1 */
    double near, far; /* 0 and INFINITY: all that is before the eye */
    double clip[16];              /* of the image */
    double whole_clip[16];        /* of the whole picture */
    int width, height;            /* of the image */
    int whole_width, whole_height;
    int part_x, part_y;           /* the image's left lower pixel in the whole picture */
} tc_rays;

/* Errors: TC_E_ARG, naming the value: eye = focal point, angle outside (0, 180), scale <= 0, clip_near < 0, clip_far <=
 * clip_near (both 0: no clipping), not finite, size < 1. The image is the whole picture.
 * window_center as vtkCamera::SetWindowCenter: x / w, y / h in the picture's middle, w and h half its extent.
 * A view-up parallel to the view (to 1e-9) is replaced by (-z, x, y), as VTK's ResetCamera does, or, where that is
 * parallel too, by the coordinate axis farthest from the view. */
tc_status tc_rays_from_camera(tc_rays *out, const tc_camera *camera, int width, int height, tc_error *err);

/* The rays of a part of the image of rays: width x height pixels, of which the left UPPER one is (x, y) from its left upper one.
 * It must lie within it. out may be rays. */
void tc_rays_part(tc_rays *out, const tc_rays *rays, int x, int y, int width, int height);

/* The same view, but the ray of each pixel is that of the place (x, y) pixels from it, in tc_rays' coordinates: the
 * image's clip space moves along. By (0, 0) no bit changes. out may be rays. */
void tc_rays_shift(tc_rays *out, const tc_rays *rays, double x, double y);

/* One pixel's ray: origin [3] and unit direction [3] in world coordinates. (X, Y) is a place in the image, here and below. */
void tc_rays_pixel(double *origin, double *direction, const tc_rays *rays, double X, double Y);
/* The part of that ray that is seen: range [2], distances from its origin. In parallel range[0] may be below 0: the
 * origin lies in the focal plane. range[1] is INFINITY where nothing bounds it. */
void tc_rays_range(double *range, const tc_rays *rays, double X, double Y);

#ifdef __cplusplus
}
#endif
#endif
