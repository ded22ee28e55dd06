/* views.c: where a study looks from. */
#include "study/study.h"

#include <math.h>

/* Oblique ones and ones next to an axis by turns, so that two views are one of each: along an axis many rays run in the
 * planes of faces. */
static const double list[][2] = {{30, 20}, {1, 1}, {135, -35}, {91, 2}, {200, 55}, {2, 88}, {251, -15}, {310, 35}};
enum { N_LIST = sizeof list / sizeof *list };

void tc_study_view(double *azimuth, double *elevation, int i)
{
    if (i < N_LIST) {
        *azimuth = list[i][0];
        *elevation = list[i][1];
        return;
    }
    /* additive recurrence by the plastic number: even at every length */
    double k = i - N_LIST + 1, a = fmod(0.7548776662466927 * k, 1), b = fmod(0.5698402909980532 * k, 1);
    *azimuth = 360 * a;
    *elevation = asin(2 * b - 1) * 180 / acos(-1.0);
    *elevation = fmax(-89, fmin(89, *elevation));
}

void tc_study_camera(tc_camera *out, const tc_mesh *mesh, const tc_study_options *options, double azimuth,
                     double elevation)
{
    static const double from[3] = {0, 0, 1}, up[3] = {0, 1, 0};
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    *out = (tc_camera){.parallel = false};
    tc_camera_reset(out, report.bounds, from, up, 30, (double)options->width / options->height);
    tc_camera_azimuth(out, azimuth);
    tc_camera_elevation(out, elevation);
}

void tc_study_base(tc_render_options *out, const tc_study_options *options)
{
    tc_render_defaults(out);
    out->width = options->width;
    out->height = options->height;
    out->unit_distance = options->unit_distance;
}
