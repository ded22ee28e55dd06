/* sight.h: which points lie in a camera's picture. */
#ifndef TC_PROBE_SIGHT_H
#define TC_PROBE_SIGHT_H

#include "core/status.h"

typedef struct tc_sight {
    double x[4], y[4], w[4]; /* a point's place in the picture is (x / w, y / w), -1 to 1 */
    double depth[4];         /* its distance before the eye's plane */
    double near, far;
} tc_sight;

/* aspect: of the picture, width / height. Errors: TC_E_ARG (aspect not positive and finite, the camera as of
 * tc_rays_from_camera). */
tc_status tc_sight_init(tc_sight *out, const tc_camera *camera, double aspect, tc_error *err);

static inline double tc_sight_row(const double row[4], const double p[3])
{
    return row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3];
}

/* Is p [3] before the eye, within the clipping range, and in the picture or on its rim? */
static inline bool tc_sight_sees(const tc_sight *sight, const double p[3])
{
    const double x = tc_sight_row(sight->x, p), y = tc_sight_row(sight->y, p), w = tc_sight_row(sight->w, p);
    const double depth = tc_sight_row(sight->depth, p);
    return depth > 0 && depth >= sight->near && depth <= sight->far && x >= -w && x <= w && y >= -w && y <= w;
}

#endif
