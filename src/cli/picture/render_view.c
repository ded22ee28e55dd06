/* render_view.c: the camera of a command line, and why a picture is empty. */
#include "cli/picture/render_view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int tc_render_camera(tc_camera *out, const tc_render_command *options, const double bounds[6], tc_talk *talk)
{
    static const double from[3] = {0, 0, 1};
    static const double default_up[3] = {0, 1, 0};
    double aspect = (double)options->size.width / options->size.height;
    tc_camera_reset(out, bounds, from, options->has_view_up ? options->view_up : default_up, options->view_angle,
                    aspect);
    if (options->has_position)
        memcpy(out->position, options->position, sizeof out->position);
    if (options->has_focal_point)
        memcpy(out->focal_point, options->focal_point, sizeof out->focal_point);
    if (options->has_view_up) /* reset may have replaced an up that is parallel to +z */
        memcpy(out->view_up, options->view_up, sizeof out->view_up);
    out->view_angle = options->view_angle;
    out->parallel = options->parallel || options->has_parallel_scale;
    if (options->has_parallel_scale)
        out->parallel_scale = options->parallel_scale;
    if (!memcmp(out->position, out->focal_point, sizeof out->position)) {
        tc_talk_error(talk,
                      "the camera's position %g,%g,%g is also its focal point (the mesh's centre unless "
                      "--focal-point says otherwise), so there is no direction to look",
                      out->position[0], out->position[1], out->position[2]);
        return TC_EXIT_USAGE;
    }
    if (options->azimuth != 0)
        tc_camera_azimuth(out, options->azimuth);
    if (options->elevation != 0)
        tc_camera_elevation(out, options->elevation);
    if (options->roll != 0)
        tc_camera_roll(out, options->roll);
    if (options->zoom != 1)
        tc_camera_zoom(out, options->zoom);
    out->clip_near = options->has_clipping_range ? options->clipping_range[0] : 0;
    out->clip_far = options->has_clipping_range ? options->clipping_range[1] : 0;
    memcpy(out->window_center, options->window_center, sizeof out->window_center);
    return -1;
}

float tc_image_peak(const tc_image *image)
{
    size_t n = (size_t)image->width * (size_t)image->height;
    float peak = 0;
    for (size_t i = 0; i < n; i++)
        peak = image->rgba[4 * i + 3] > peak ? image->rgba[4 * i + 3] : peak;
    return peak;
}

static double tc_dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void tc_cross(double *out, const double *a, const double *b)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void tc_unit(double *v)
{
    double length = hypot(hypot(v[0], v[1]), v[2]);
    for (int i = 0; i < 3 && length > 0; i++)
        v[i] /= length;
}

/* The box's depths from the eye along the view (least, most), and whether all its corners lie beyond one side of it. */
static void tc_box_in_view(double depth[2], bool *aside, const double bounds[6], const tc_camera *camera,
                           const tc_size *size)
{
    double ahead[3], right[3], up[3];
    int beyond[4] = {0};
    for (int i = 0; i < 3; i++)
        ahead[i] = camera->focal_point[i] - camera->position[i];
    tc_unit(ahead);
    tc_cross(right, ahead, camera->view_up);
    tc_unit(right);
    tc_cross(up, right, ahead);
    double half = camera->parallel ? camera->parallel_scale : tan(camera->view_angle * acos(-1.0) / 360);
    double wide = half * size->width / size->height;
    const double *center = camera->window_center;
    depth[0] = INFINITY;
    depth[1] = -INFINITY;
    for (int corner = 0; corner < 8; corner++) {
        double x[3];
        for (int i = 0; i < 3; i++)
            x[i] = bounds[2 * i + (corner >> i & 1)] - camera->position[i];
        double z = tc_dot(x, ahead), h = camera->parallel ? 1 : z;
        depth[0] = fmin(depth[0], z);
        depth[1] = fmax(depth[1], z);
        beyond[0] += tc_dot(x, right) > (center[0] + 1) * wide * h;
        beyond[1] += tc_dot(x, right) < (center[0] - 1) * wide * h;
        beyond[2] += tc_dot(x, up) > (center[1] + 1) * half * h;
        beyond[3] += tc_dot(x, up) < (center[1] - 1) * half * h;
    }
    *aside = beyond[0] == 8 || beyond[1] == 8 || beyond[2] == 8 || beyond[3] == 8;
}

void tc_empty_reason(char *why, size_t capacity, const tc_mesh_report *report, const char *field, const tc_transfer *tf,
                     const double *nan_color, const tc_camera *camera, const tc_size *size)
{
    double lo = report->scalar_range[0], hi = report->scalar_range[1];
    const double *b = report->bounds;
    size_t n = 0;
    double depth[2];
    bool aside;
    const char *name = field && *field ? field : "the field";
    const tc_knot *knot = tc_transfer_knots(tf, &n);
    tc_box_in_view(depth, &aside, b, camera, size);
    bool missing = report->nonfinite_cells > 0 && report->nonfinite_cells >= report->n_tet;
    double peak = missing && nan_color ? nan_color[3] : tc_transfer_peak(tf, lo, hi);
    if (missing && nan_color && peak <= 0)
        snprintf(why, capacity,
                 "every cell has a value of %s that is not finite, and the attenuation A of --nan-color R,G,B,A is 0; "
                 "make it greater",
                 name);
    else if (missing && !nan_color)
        snprintf(why, capacity, "every cell has a value of %s that is not finite; --nan-color shows them", name);
    else if (peak <= 0)
        snprintf(why, capacity,
                 "the opacity is 0 for every value of %s (%g to %g; the transfer function spans %g to %g); change "
                 "--opacity or --range",
                 name, lo, hi, n ? knot[0].s : 0.0, n ? knot[n - 1].s : 0.0);
    else if (depth[1] <= 0)
        snprintf(why, capacity,
                 "the mesh (%g..%g, %g..%g, %g..%g) lies behind the camera at %g,%g,%g; change --camera-position or "
                 "--focal-point",
                 b[0], b[1], b[2], b[3], b[4], b[5], camera->position[0], camera->position[1], camera->position[2]);
    else if (camera->clip_far > 0 && (depth[1] <= camera->clip_near || depth[0] >= camera->clip_far))
        snprintf(why, capacity,
                 "the mesh lies %g to %g before the camera, outside the clipping range %g to %g; change "
                 "--clipping-range or leave it out",
                 depth[0], depth[1], camera->clip_near, camera->clip_far);
    else if (aside)
        snprintf(why, capacity,
                 "the mesh (%g..%g, %g..%g, %g..%g) lies outside the view; change the camera, or leave its options "
                 "out to see the whole mesh",
                 b[0], b[1], b[2], b[3], b[4], b[5]);
    else
        snprintf(why, capacity,
                 "the mesh is within the view, so it is smaller than a pixel, lies between the rays, or is too thin "
                 "for its opacity (%g at most); try --zoom, a larger --size or a smaller --unit-distance",
                 peak);
}
