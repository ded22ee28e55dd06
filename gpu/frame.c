/* frame.c: the rays of an image in mesh space (design: "Ray frame").
 *
 * The origin of a ray's frame is the point where it meets the plane through the mesh's centre across the view, so that
 * coordinates stay small however far the eye is; the eye itself when it is nearer than two half diagonals. */
#include "gpu/frame.h"

#include "core/vec.h"

#include <string.h>

static const double EYE_NEAR = 2.0;      /* half diagonals */
static const double SPHERE = 1.0 + 1e-6; /* holds the mesh: its half diagonal is 1 */

static void to_mesh_space(double *out, const double *p, const double *center, double scale)
{
    for (int k = 0; k < 3; k++)
        out[k] = (p[k] - center[k]) * scale;
}

/* clip * (scale, center): the product is made in double and rounded once. */
static void clip_matrix(float *out, const double *clip, const double *center, double scale)
{
    for (int row = 0; row < 4; row++) {
        double at_center = clip[12 + row];
        for (int k = 0; k < 3; k++) {
            out[4 * k + row] = (float)(clip[4 * k + row] / scale);
            at_center += clip[4 * k + row] * center[k];
        }
        out[12 + row] = (float)at_center;
    }
}

/* Makes clip coordinates of order one: the homogeneous matrix may have any scale. */
static void scale_clip(float *clip)
{
    float largest = 0;
    for (int i = 0; i < 4; i++) {
        float w = clip[4 * i + 3];
        largest = fmaxf(largest, fabsf(w));
    }
    for (int i = 0; i < 16 && largest > 0; i++)
        clip[i] /= largest;
}

/* What is seen, and what of it the mesh calls for: its centre lies `ahead` of the eye's plane, the rays' origins eye_t
 * directions. */
static void set_range(tc_frame *out, const tc_rays *rays, double ahead, double eye_t, double scale)
{
    double forward = tc_vec_dot(out->direction, rays->axis), near = rays->near * scale, far = rays->far * scale;
    out->near_t = near / forward - eye_t;
    out->far_t = far / forward - eye_t;
    out->hidden = ahead < near - SPHERE || ahead > far + SPHERE;
    bool cut = ahead <= near + SPHERE;
    /* With the eye outside the mesh's sphere a line's part in the hull lies before the eye or behind it. */
    out->ahead = cut && near == 0 && !rays->parallel && !out->eye_inside;
    out->clip_near = cut && !out->ahead;
    out->clip_far = ahead >= far - SPHERE;
}

void tc_frame_build(tc_frame *out, const tc_rays *rays, const double center[3], double scale)
{
    memset(out, 0, sizeof *out);
    clip_matrix(out->clip, rays->clip, center, scale);
    scale_clip(out->clip);
    clip_matrix(out->whole_clip, rays->whole_clip, center, scale);
    scale_clip(out->whole_clip);
    out->part[0] = rays->part_x, out->part[1] = rays->part_y;
    out->whole_size[0] = rays->whole_width, out->whole_size[1] = rays->whole_height;

    const double *axis = rays->axis;
    double eye[3];
    to_mesh_space(eye, rays->eye, center, scale);
    double ahead = -tc_vec_dot(eye, axis), eye_t = 0; /* of the mesh's centre; of the origin, in directions */
    tc_vec_copy(out->direction, rays->direction);
    tc_vec_copy(out->direction_dx, rays->direction_dx);
    tc_vec_copy(out->direction_dy, rays->direction_dy);
    if (rays->parallel) {
        double origin[3];
        to_mesh_space(origin, rays->origin, center, scale);
        for (int k = 0; k < 3; k++) {
            out->point[k] = origin[k];
            out->point_dx[k] = rays->origin_dx[k] * scale;
            out->point_dy[k] = rays->origin_dy[k] * scale;
        }
        tc_vec_mul_add(out->point, out->point, -tc_vec_dot(out->point, axis), axis);
        eye_t = ahead;
        tc_vec_cross(out->up, out->point_dx, axis);
        if (tc_vec_dot(out->up, out->point_dy) < 0)
            for (int k = 0; k < 3; k++)
                out->up[k] = -out->up[k];
    } else {
        double distance = tc_vec_length(eye);
        out->eye_inside = distance < SPHERE;
        tc_vec_copy(out->point, eye);
        if (distance >= EYE_NEAR) {
            /* dot(direction, axis) is the same for every pixel, so the point is affine in the pixel. */
            eye_t = ahead / tc_vec_dot(out->direction, axis);
            tc_vec_mul_add(out->point, eye, eye_t, out->direction);
            for (int k = 0; k < 3; k++) {
                out->point_dx[k] = eye_t * out->direction_dx[k];
                out->point_dy[k] = eye_t * out->direction_dy[k];
            }
        }
        tc_vec_copy(out->up, out->direction_dy);
    }
    tc_vec_normalize(out->up);
    set_range(out, rays, ahead, eye_t, scale);
}
