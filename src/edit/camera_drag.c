/* camera_drag.c: from moves of a pointer to cameras. */
#include "edit/camera_drag.h"

#include <math.h>
#include <string.h>

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double *out, const double *a, const double *b)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double unit(double *v)
{
    const double length = sqrt(dot(v, v));
    for (int i = 0; i < 3 && length > 0; i++)
        v[i] /= length;
    return length;
}

/* v about a unit axis (Rodrigues). */
static void turn(double *v, const double *axis, double degrees)
{
    const double angle = degrees * acos(-1.0) / 180, c = cos(angle), s = sin(angle), along = dot(axis, v) * (1 - c);
    double side[3];
    cross(side, axis, v);
    for (int i = 0; i < 3; i++)
        v[i] = v[i] * c + side[i] * s + axis[i] * along;
}

/* Units ahead, right and up of the view; gives the focal point's distance. */
static double frame(double ahead[3], double right[3], double up[3], const tc_camera *camera)
{
    for (int i = 0; i < 3; i++)
        ahead[i] = camera->focal_point[i] - camera->position[i];
    const double distance = unit(ahead);
    cross(right, ahead, camera->view_up);
    if (!(unit(right) > 1e-12)) { /* up is along the view: any other does */
        const double other[3] = {fabs(ahead[0]) < 0.5, fabs(ahead[0]) >= 0.5, 0};
        cross(right, ahead, other);
        unit(right);
    }
    cross(up, right, ahead);
    return distance;
}

/* Half the view's height at the focal point. */
static double half_height(const tc_camera *camera, double distance)
{
    return camera->parallel ? camera->parallel_scale : distance * tan(camera->view_angle * acos(-1.0) / 360);
}

void tc_camera_orbit(tc_camera *camera, double right_degrees, double upward)
{
    double ahead[3], right[3], up[3];
    const double distance = frame(ahead, right, up, camera);
    if (!(distance > 0))
        return;
    turn(ahead, up, right_degrees);
    turn(right, up, right_degrees);
    turn(ahead, right, -upward);
    turn(up, right, -upward);
    for (int i = 0; i < 3; i++)
        camera->position[i] = camera->focal_point[i] - distance * ahead[i];
    memcpy(camera->view_up, up, sizeof up);
}

void tc_camera_pan(tc_camera *camera, double x, double y, int height)
{
    double ahead[3], right[3], up[3];
    const double scale = 2 * half_height(camera, frame(ahead, right, up, camera)) / (height > 0 ? height : 1);
    for (int i = 0; i < 3; i++) {
        const double go = (-x * right[i] + y * up[i]) * scale;
        camera->position[i] += go;
        camera->focal_point[i] += go;
    }
}

void tc_camera_approach(tc_camera *camera, double factor, double x, double y, int width, int height)
{
    double ahead[3], right[3], up[3];
    const double distance = frame(ahead, right, up, camera);
    if (!(factor > 0) || !isfinite(factor))
        return;
    if (isfinite(x) && isfinite(y)) /* what is there is to stay: the middle goes towards it */
        tc_camera_pan(camera, (width / 2.0 - x) * (1 - 1 / factor), (height / 2.0 - y) * (1 - 1 / factor), height);
    if (camera->parallel)
        camera->parallel_scale /= factor;
    else
        for (int i = 0; i < 3; i++)
            camera->position[i] = camera->focal_point[i] - distance / factor * ahead[i];
}

void tc_camera_twist(tc_camera *camera, double from_x, double from_y, double to_x, double to_y, int width, int height)
{
    double ahead[3], right[3], up[3];
    const double from = atan2(from_y - height / 2.0, from_x - width / 2.0);
    const double to = atan2(to_y - height / 2.0, to_x - width / 2.0);
    frame(ahead, right, up, camera);
    turn(up, ahead, -remainder(to - from, 2 * acos(-1.0)) * 180 / acos(-1.0));
    memcpy(camera->view_up, up, sizeof up);
}

void tc_camera_stand(tc_camera *camera, int axis, bool negative, const double *bounds, double aspect)
{
    double direction[3] = {0, 0, 0};
    const double up[3] = {0, axis == 2, axis != 2};
    const tc_camera before = *camera;
    direction[axis] = negative ? -1 : 1;
    tc_camera_reset(camera, bounds, direction, up, camera->view_angle, aspect);
    camera->clip_near = before.clip_near;
    camera->clip_far = before.clip_far;
}
