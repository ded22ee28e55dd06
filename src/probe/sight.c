/* sight.c: a camera's clip space for a picture of any aspect. */
#include "probe/sight.h"

#include "core/vec.h"
#include "scene/camera.h"

#include <math.h>

tc_status tc_sight_init(tc_sight *out, const tc_camera *camera, double aspect, tc_error *err)
{
    tc_rays rays;
    if (!(aspect > 0) || !isfinite(aspect))
        return tc_fail(err, TC_E_ARG,
                       "an aspect of %g is of no picture; give its width / height, which is above 0 and finite",
                       aspect);
    tc_status status = tc_rays_from_camera(&rays, camera, 1, 1, err);
    if (status != TC_OK)
        return status;
    for (int k = 0; k < 4; k++) {
        const double *column = &rays.clip[4 * k];
        out->y[k] = column[1];
        out->w[k] = column[3];
        /* The picture gets aspect times as wide about the direction of projection, which lies at -window_center; then
         * that is put to its place, which is counted in halves of the width. */
        const double c = camera->window_center[0];
        out->x[k] = (column[0] + c * column[3]) / aspect - c * column[3];
        out->depth[k] = k < 3 ? rays.axis[k] : -tc_vec_dot(rays.axis, rays.eye);
    }
    out->near = rays.near, out->far = rays.far;
    return TC_OK;
}
