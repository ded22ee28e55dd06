/* camera.c: ParaView's camera: reset, azimuth, elevation, roll, zoom, and the rays of its image.
 * The meaning is VTK 9.1's: vtkRenderer::ResetCamera, vtkCamera::Azimuth, Elevation, Roll, Zoom. */
#include "scene/camera.h"

#include "core/vec.h"
#include "scene/glm_shim.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;
/* vtkCamera::SetViewAngle's limits. */
static const double ANGLE_MIN = 1e-8, ANGLE_MAX = 179.9;

static bool finite3(const double *a)
{
    return isfinite(a[0]) && isfinite(a[1]) && isfinite(a[2]);
}

static double largest(const double *a)
{
    return fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
}

/* Length of a, safe for any magnitude. */
static double length(const double *a)
{
    double m = largest(a);
    if (!(m > 0) || isinf(m))
        return m;
    double b[3] = {a[0] / m, a[1] / m, a[2] / m};
    return m * tc_vec_length(b);
}

/* out = a / |a|; false when a is zero or not finite. */
static bool unit(double *out, const double *a)
{
    double m = largest(a);
    if (!(m > 0) || !finite3(a))
        return false;
    for (int i = 0; i < 3; i++)
        out[i] = a[i] / m;
    tc_vec_normalize(out);
    return true;
}

/* The coordinate axis farthest from n. */
static void other_axis(double *out, const double *n)
{
    int k = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(n[i]) < fabs(n[k]))
            k = i;
    for (int i = 0; i < 3; i++)
        out[i] = i == k ? 1.0 : 0.0;
}

/* Replaces up (unit) when it is parallel to normal (unit): |up . normal| > limit. ResetCamera's rule (-z, x, y) first;
 * it maps (1, -1, 1) to its own opposite, then another axis. */
static void replace_up(double *up, const double *normal, double limit)
{
    if (fabs(tc_vec_dot(up, normal)) <= limit)
        return;
    double other[3] = {-up[2], up[0], up[1]};
    if (fabs(tc_vec_dot(other, normal)) > limit)
        other_axis(other, normal);
    tc_vec_copy(up, other);
}

/* The camera's unit direction of projection and a unit up that is not parallel to it; false: there is no direction. */
static bool view_axes(double *forward, double *up, const tc_camera *camera)
{
    double d[3];
    tc_vec_sub(d, camera->focal_point, camera->position);
    if (!unit(forward, d))
        return false;
    if (!unit(up, camera->view_up))
        other_axis(up, forward);
    double cross[3];
    tc_vec_cross(cross, up, forward);
    if (tc_vec_length(cross) < 1e-9)
        replace_up(up, forward, 0.999);
    return true;
}

void tc_camera_reset(tc_camera *camera, const double *bounds, const double *direction, const double *up,
                     double view_angle, double aspect)
{
    double center[3], half[3], normal[3] = {0, 0, 1}, view_up[3] = {0, 1, 0};
    bool valid = true;
    for (int i = 0; i < 3; i++) {
        double lo = bounds[2 * i], hi = bounds[2 * i + 1];
        valid = valid && isfinite(lo) && isfinite(hi) && lo <= hi;
        center[i] = 0.5 * lo + 0.5 * hi;
        half[i] = 0.5 * hi - 0.5 * lo;
    }
    if (!valid)
        memset(center, 0, sizeof center), memset(half, 0, sizeof half);
    unit(normal, direction);
    unit(view_up, up);
    if (!(view_angle > 0 && view_angle < 180))
        view_angle = 30;
    if (!(aspect > 0) || isinf(aspect))
        aspect = 1;

    /* A point gets the squared diagonal 1. Below some 60 units in the last place of the centre no eye could be told
     * from the focal point. */
    double radius = length(half);
    if (radius == 0)
        radius = 0.5;
    radius = fmax(radius, 64 * DBL_EPSILON * largest(center));
    double angle = view_angle * PI / 180, scale = radius;
    if (aspect < 1) {
        angle = 2 * atan(tan(0.5 * angle) * aspect);
        scale /= aspect;
    }
    double distance = radius / sin(0.5 * angle);
    if (isinf(distance))
        distance = DBL_MAX / 4;

    replace_up(view_up, normal, 0.999);
    tc_vec_copy(camera->focal_point, center);
    tc_vec_mul_add(camera->position, center, distance, normal);
    tc_vec_copy(camera->view_up, view_up);
    camera->view_angle = view_angle;
    camera->parallel_scale = scale;
    camera->clip_near = camera->clip_far = 0;
    camera->window_center[0] = camera->window_center[1] = 0;
}

/* Turns the position about the focal point. */
static void turn_position(tc_camera *camera, double degrees, const double *axis)
{
    double arm[3];
    tc_vec_sub(arm, camera->position, camera->focal_point);
    tc_glm_turn(arm, arm, degrees, axis);
    tc_vec_add(camera->position, camera->focal_point, arm);
}

void tc_camera_azimuth(tc_camera *camera, double degrees)
{
    double axis[3];
    if (isfinite(degrees) && unit(axis, camera->view_up))
        turn_position(camera, degrees, axis);
}

void tc_camera_elevation(tc_camera *camera, double degrees)
{
    double forward[3], up[3], axis[3];
    if (!isfinite(degrees) || !view_axes(forward, up, camera))
        return;
    tc_vec_cross(axis, up, forward); /* minus the view's right */
    turn_position(camera, degrees, axis);
}

void tc_camera_roll(tc_camera *camera, double degrees)
{
    double forward[3], up[3];
    if (!isfinite(degrees) || !view_axes(forward, up, camera))
        return;
    tc_glm_turn(up, up, degrees, forward);
    unit(camera->view_up, up);
}

void tc_camera_zoom(tc_camera *camera, double factor)
{
    if (!(factor > 0) || isinf(factor))
        return;
    if (camera->parallel)
        camera->parallel_scale /= factor;
    else
        camera->view_angle = fmin(fmax(camera->view_angle / factor, ANGLE_MIN), ANGLE_MAX);
}

static tc_status check(const tc_camera *c, int width, int height, tc_error *err)
{
    if (width < 1 || height < 1)
        return tc_fail(err, TC_E_ARG, "an image of %d x %d pixels cannot be made; both must be at least 1", width,
                       height);
    if (!finite3(c->position))
        return tc_fail(err, TC_E_ARG, "the camera's position (%g, %g, %g) is not finite", c->position[0],
                       c->position[1], c->position[2]);
    if (!finite3(c->focal_point))
        return tc_fail(err, TC_E_ARG, "the camera's focal point (%g, %g, %g) is not finite", c->focal_point[0],
                       c->focal_point[1], c->focal_point[2]);
    if (!finite3(c->view_up) || largest(c->view_up) == 0)
        return tc_fail(err, TC_E_ARG, "the camera's view-up (%g, %g, %g) is no direction; give a finite, non-zero one",
                       c->view_up[0], c->view_up[1], c->view_up[2]);
    if (!c->parallel && !(c->view_angle > 0 && c->view_angle < 180))
        return tc_fail(err, TC_E_ARG, "the view angle of %g degrees is outside (0, 180)", c->view_angle);
    if (c->parallel && !(c->parallel_scale > 0 && isfinite(c->parallel_scale)))
        return tc_fail(err, TC_E_ARG, "the parallel scale %g must be positive and finite", c->parallel_scale);
    bool clipped = c->clip_near != 0 || c->clip_far != 0;
    if (clipped && !(c->clip_near >= 0 && isfinite(c->clip_near)))
        return tc_fail(
            err, TC_E_ARG,
            "the near clipping distance %g must be finite and not below 0; it is measured from the eye along "
            "the view",
            c->clip_near);
    if (clipped && !(c->clip_far > c->clip_near && isfinite(c->clip_far)))
        return tc_fail(err, TC_E_ARG,
                       "the far clipping distance %g must be finite and beyond the near one, %g (both 0: no clipping)",
                       c->clip_far, c->clip_near);
    if (!isfinite(c->window_center[0]) || !isfinite(c->window_center[1]))
        return tc_fail(err, TC_E_ARG, "the window centre (%g, %g) is not finite; 0, 0 is straight ahead",
                       c->window_center[0], c->window_center[1]);
    return TC_OK;
}

tc_status tc_rays_from_camera(tc_rays *out, const tc_camera *camera, int width, int height, tc_error *err)
{
    tc_status status = check(camera, width, height, err);
    if (status != TC_OK)
        return status;
    double forward[3], up[3], view[16];
    if (!view_axes(forward, up, camera))
        return tc_fail(err, TC_E_ARG,
                       "the camera's position and focal point are both (%g, %g, %g), or too far apart for doubles; the "
                       "view has no direction",
                       camera->position[0], camera->position[1], camera->position[2]);
    tc_glm_view(view, forward, up);
    double right[3] = {view[0], view[4], view[8]}, above[3] = {view[1], view[5], view[9]};

    /* Half the view's height and width: at unit distance (perspective) or in the focal plane (parallel). */
    double h = camera->parallel ? camera->parallel_scale : tan(camera->view_angle * PI / 360);
    double w = h * ((double)width / height);
    const double *center = camera->window_center;
    if (!(w > 0) || isinf(w) || isinf(w * (fabs(center[0]) + 1)) || isinf(h * (fabs(center[1]) + 1)))
        return tc_fail(err, TC_E_ARG, "the view of %d x %d pixels at %s %g is beyond what doubles hold", width, height,
                       camera->parallel ? "parallel scale" : "view angle",
                       camera->parallel ? camera->parallel_scale : camera->view_angle);

    memset(out, 0, sizeof *out);
    out->parallel = camera->parallel;
    out->width = out->whole_width = width, out->height = out->whole_height = height;
    tc_vec_copy(out->eye, camera->position);
    tc_vec_copy(out->axis, forward);
    out->near = camera->clip_near;
    out->far = camera->clip_far > 0 ? camera->clip_far : INFINITY;
    double *corner = camera->parallel ? out->origin : out->direction;
    double *dx = camera->parallel ? out->origin_dx : out->direction_dx;
    double *dy = camera->parallel ? out->origin_dy : out->direction_dy;
    tc_vec_copy(corner, camera->parallel ? camera->focal_point : forward);
    tc_vec_mul_add(corner, corner, (center[0] - 1) * w, right);
    tc_vec_mul_add(corner, corner, (center[1] - 1) * h, above);
    for (int i = 0; i < 3; i++)
        dx[i] = 2 * w / width * right[i], dy[i] = 2 * h / height * above[i];
    tc_vec_copy(camera->parallel ? out->direction : out->origin, camera->parallel ? forward : camera->position);

    /* The z row stays zero: GL then clips by w > 0 alone and needs no near and far plane. */
    double projection[16] = {0};
    projection[0] = 1 / w, projection[5] = 1 / h;
    projection[camera->parallel ? 15 : 11] = camera->parallel ? 1 : -1;
    for (int k = 0; k < 2; k++) /* moves the middle: by w, which is -z in perspective */
        projection[(camera->parallel ? 12 : 8) + k] = camera->parallel ? -center[k] : center[k];
    tc_glm_clip(out->clip, projection, view, camera->parallel ? camera->focal_point : camera->position);
    memcpy(out->whole_clip, out->clip, sizeof out->whole_clip);
    return TC_OK;
}

void tc_rays_part(tc_rays *out, const tc_rays *rays, int x, int y, int width, int height)
{
    const int from_bottom = rays->height - y - height;
    *out = *rays;
    if (x == 0 && y == 0 && width == rays->width && height == rays->height)
        return;
    const double stretch[2] = {(double)rays->width / width, (double)rays->height / height};
    const double move[2] = {(rays->width - 2.0 * x - width) / width,
                            (rays->height - 2.0 * from_bottom - height) / height};
    for (int k = 0; k < 4; k++)
        for (int row = 0; row < 2; row++)
            out->clip[4 * k + row] = stretch[row] * rays->clip[4 * k + row] + move[row] * rays->clip[4 * k + 3];
    out->part_x += x, out->part_y += from_bottom;
    out->width = width, out->height = height;
}

void tc_rays_shift(tc_rays *out, const tc_rays *rays, double x, double y)
{
    *out = *rays;
    for (int i = 0; i < 3; i++) {
        out->origin[i] += x * rays->origin_dx[i] + y * rays->origin_dy[i];
        out->direction[i] += x * rays->direction_dx[i] + y * rays->direction_dy[i];
    }
    for (int k = 0; k < 4; k++) { /* a pixel is 2 / width wide in clip space, where w = 1 */
        out->clip[4 * k] -= 2 * x / rays->width * rays->clip[4 * k + 3];
        out->clip[4 * k + 1] -= 2 * y / rays->height * rays->clip[4 * k + 3];
        out->whole_clip[4 * k] -= 2 * x / rays->whole_width * rays->whole_clip[4 * k + 3];
        out->whole_clip[4 * k + 1] -= 2 * y / rays->whole_height * rays->whole_clip[4 * k + 3];
    }
}

void tc_rays_pixel(double *origin, double *direction, const tc_rays *rays, double X, double Y)
{
    double o[3], d[3];
    X += rays->part_x, Y += rays->part_y;
    for (int i = 0; i < 3; i++) {
        o[i] = rays->origin[i] + X * rays->origin_dx[i] + Y * rays->origin_dy[i];
        d[i] = rays->direction[i] + X * rays->direction_dx[i] + Y * rays->direction_dy[i];
    }
    tc_vec_copy(origin, rays->parallel ? o : rays->eye);
    tc_vec_normalize(d);
    tc_vec_copy(direction, d);
}

void tc_rays_range(double *range, const tc_rays *rays, double X, double Y)
{
    double from_plane[3] = {0, 0, 0}, d[3];
    X += rays->part_x, Y += rays->part_y;
    for (int i = 0; i < 3; i++) {
        d[i] = rays->direction[i] + X * rays->direction_dx[i] + Y * rays->direction_dy[i];
        if (rays->parallel)
            from_plane[i] = rays->origin[i] + X * rays->origin_dx[i] + Y * rays->origin_dy[i] - rays->eye[i];
    }
    tc_vec_normalize(d);
    double forward = tc_vec_dot(d, rays->axis); /* of one unit along the ray */
    double origin = tc_vec_dot(from_plane, rays->axis);
    range[0] = (rays->near - origin) / forward;
    range[1] = (rays->far - origin) / forward;
}
