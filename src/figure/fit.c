/* fit.c: moves a camera so that a box, with its axes' labels, is where a figure's title and colour bar leave room. */
#include "core/memory.h"
#include "core/vec.h"
#include "figure/layout.h"
#include "scene/camera.h"

#include <math.h>
#include <stdlib.h>

/* What title and bar leave of the picture, and the labels of axes of that. */
static void free_room(tc_box *out, const tc_layout *l)
{
    *out = (tc_box){l->margin, l->top, l->width - l->margin, l->height - l->margin};
    for (int i = 0; i < l->n; i++) {
        const tc_item *strip = &l->item[i];
        if (strip->kind != TC_ITEM_STRIP)
            continue;
        double clear = l->margin + l->line;
        if (l->figure->bar == TC_BAR_RIGHT)
            out->x1 = fmin(out->x1, strip->box.x0 - clear);
        else if (l->figure->bar == TC_BAR_LEFT)
            out->x0 = fmax(out->x0, strip->box.x1 + clear);
        else
            out->y1 = fmin(out->y1, strip->box.y0 - clear);
    }
    if (l->figure->axes) { /* labels, and titles beyond them */
        double sides = fmin(4 * l->em, 0.15 * (out->x1 - out->x0));
        out->x0 += sides, out->x1 -= sides;
        out->y1 -= fmin(3.2 * l->em, 0.2 * (out->y1 - out->y0));
    }
}

/* Pixels that the box covers; false: a part of it is behind the eye. */
static bool covered(tc_box *out, const tc_rays *rays, const double *bounds)
{
    *out = (tc_box){INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (int c = 0; c < 8; c++) {
        double p[3] = {bounds[c & 1], bounds[2 + (c >> 1 & 1)], bounds[4 + (c >> 2)]}, q[2];
        if (!tc_layout_project(q, rays, p))
            return false;
        out->x0 = fmin(out->x0, q[0]), out->x1 = fmax(out->x1, q[0]);
        out->y0 = fmin(out->y0, q[1]), out->y1 = fmax(out->y1, q[1]);
    }
    return true;
}

/* Moves eye and focal point by that much along the view's right and up. */
static void pan(tc_camera *camera, const tc_rays *rays, double right, double down)
{
    double arm[3];
    tc_vec_sub(arm, camera->focal_point, camera->position);
    double scale = rays->parallel ? 1 : tc_vec_length(arm);
    const double *dx = rays->parallel ? rays->origin_dx : rays->direction_dx;
    const double *dy = rays->parallel ? rays->origin_dy : rays->direction_dy;
    double *moved[] = {camera->position, camera->focal_point};
    for (int i = 0; i < 2; i++) {
        tc_vec_mul_add(moved[i], moved[i], -right * scale, dx);
        tc_vec_mul_add(moved[i], moved[i], down * scale, dy);
    }
}

static void nearer(tc_camera *camera, double factor)
{
    double arm[3];
    tc_vec_sub(arm, camera->position, camera->focal_point);
    if (camera->parallel)
        camera->parallel_scale /= factor;
    else
        tc_vec_mul_add(camera->position, camera->focal_point, 1 / factor, arm);
}

tc_status tc_figure_fit(tc_camera *camera, const tc_figure *figure, const double *bounds, int width, int height,
                        tc_error *err)
{
    tc_figure f = *figure;
    f.camera = camera;
    f.bounds = bounds;
    tc_rays rays;
    tc_status status = tc_figure_check(&f, err);
    if (status == TC_OK)
        status = tc_figure_check_box(bounds, err);
    if (status == TC_OK)
        status = tc_rays_from_camera(&rays, camera, width, height, err);
    if (status != TC_OK)
        return status;
    tc_layout *layout = tc_alloc(1, sizeof *layout);
    if (!layout)
        return tc_fail_memory(err, "a figure", 1, sizeof *layout);
    tc_box room, box;
    f.axes = false; /* their place is what is looked for */
    status = tc_layout_make(layout, &f, width, height, NULL, err);
    f.axes = figure->axes;
    free_room(&room, layout);
    free(layout);
    if (3 * (room.x1 - room.x0) < width || 3 * (room.y1 - room.y0) < height)
        return status; /* nothing is to be seen in less */

    tc_camera moved = *camera;
    for (int i = 0; i < 60 && status == TC_OK; i++) {
        status = tc_rays_from_camera(&rays, &moved, width, height, err);
        if (status != TC_OK)
            break;
        if (!covered(&box, &rays, bounds)) {
            nearer(&moved, 0.5);
            continue;
        }
        double factor = fmin((room.x1 - room.x0) / (box.x1 - box.x0), (room.y1 - room.y0) / (box.y1 - box.y0));
        double right = 0.5 * (room.x0 + room.x1 - box.x0 - box.x1), down = 0.5 * (room.y0 + room.y1 - box.y0 - box.y1);
        if (fabs(right) + fabs(down) < 0.05 && !(fabs(factor - 1) > 1e-4))
            break;
        pan(&moved, &rays, right, down);
        if (isfinite(factor)) /* a point has no size */
            nearer(&moved, fmin(fmax(factor, 0.5), 2));
    }
    if (status == TC_OK)
        *camera = moved;
    return status;
}
