/* probe.c: what a pixel's ray meets, and what a transfer function makes of it. */
#include "core/memory.h"
#include "core/vec.h"
#include "probe/line.h"
#include "probe/optical.h"
#include "scene/camera.h"

#include <math.h>
#include <stdlib.h>

static tc_status check(const tc_mesh *mesh, double unit, const tc_camera *camera, int width, int height, int x, int y,
                       tc_error *err)
{
    if (!mesh || !camera)
        return tc_fail(err, TC_E_ARG, "to probe a mesh, the mesh and a camera are needed");
    if (!mesh->prepared)
        return tc_fail(err, TC_E_ARG, "the mesh was not prepared; call tc_mesh_prepare first");
    if (!(unit >= 0) || !isfinite(unit))
        return tc_fail(err, TC_E_ARG, "unit distance %g must be a positive length (0: the mesh's default)", unit);
    if (width > 0 && height > 0 && (x < 0 || x >= width || y < 0 || y >= height))
        return tc_fail(err, TC_E_ARG, "pixel %d,%d does not lie within a picture of %dx%d", x, y, width, height);
    return TC_OK;
}

/* Distance from the eye's plane of an end of a part, which lies `back` before the line's origin in parallel projection.
 */
static double depth(const tc_line_part *part, int end, double back, const tc_rays *rays)
{
    return rays->parallel ? fmin(fmax(part->t[end] - back, rays->near), rays->far) : part->t[end];
}

/* Fills transmittance, opacity and picked. Until they are known transmittance holds sums of optical depths. */
static void see(tc_probe *probe, const tc_line_part *line, const tc_transfer *tf, double unit)
{
    double sum = 0;
    for (size_t i = 0; i < probe->n; i++) {
        if (!isnan(line[i].s[0]))
            sum += tc_optical_depth(tf, line[i].s[0], line[i].s[1], line[i].length / unit);
        probe->part[i].transmittance = sum;
    }
    probe->opacity = -expm1(-sum);
    const double half = -log1p(-0.5 * probe->opacity); /* optical depth at which half of it is reached */
    double before = 0;
    for (size_t i = 0; i < probe->n; i++) {
        tc_probe_part *p = &probe->part[i];
        const double upto = p->transmittance;
        if (isnan(probe->picked) && upto > before && (upto >= half || upto == sum)) {
            double share = tc_optical_place(tf, p->scalar[0], p->scalar[1], line[i].length / unit, half - before);
            probe->picked = p->depth[0] + share * line[i].length;
        }
        before = upto;
        p->transmittance = exp(-upto);
    }
}

tc_status tc_mesh_probe(tc_probe **out, const tc_mesh *mesh, const tc_transfer *tf, double unit_distance,
                        const tc_camera *camera, int width, int height, int x, int y, tc_error *err)
{
    if (!out)
        return tc_fail(err, TC_E_ARG, "no place to put what the ray meets");
    *out = NULL;
    tc_rays rays;
    tc_status status = check(mesh, unit_distance, camera, width, height, x, y, err);
    if (status == TC_OK)
        status = tc_rays_from_camera(&rays, camera, width, height, err);
    if (status != TC_OK)
        return status;

    double range[2], from[3], back = 0;
    const double X = x + 0.5, Y = (double)height - y - 0.5;
    tc_line_part *line = NULL;
    tc_probe *probe = tc_calloc(1, sizeof *probe);
    if (!probe)
        return tc_fail_memory(err, "what a ray meets", 1, sizeof *probe);
    probe->picked = NAN;
    tc_rays_pixel(from, probe->direction, &rays, X, Y);
    tc_rays_range(range, &rays, X, Y);
    if (rays.parallel) { /* the ray begins in the focal plane; depths are from the eye's, but no digit of it is to be
                            lost */
        double to_eye[3];
        tc_vec_sub(to_eye, rays.eye, from);
        back = tc_vec_dot(to_eye, rays.axis);
    }
    tc_vec_mul_add(probe->origin, from, back, probe->direction);
    status = tc_line_meet(&line, &probe->n, mesh, from, probe->direction, range, 0, err);
    if (status != TC_OK)
        goto done;
    probe->part = tc_alloc(probe->n, sizeof *probe->part);
    if (!probe->part) {
        status = tc_fail_memory(err, "what a ray meets", probe->n, sizeof *probe->part);
        goto done;
    }
    size_t n = 0;
    for (size_t i = 0; i < probe->n; i++) {
        const tc_probe_part part = {.depth = {depth(&line[i], 0, back, &rays), depth(&line[i], 1, back, &rays)},
                                    .scalar = {line[i].s[0], line[i].s[1]},
                                    .transmittance = 1};
        if (part.depth[0] < part.depth[1]) /* some are shorter than depths can tell */
            line[n] = line[i], probe->part[n++] = part;
    }
    probe->n = n;
    if (tf)
        see(probe, line, tf, unit_distance > 0 ? unit_distance : tc_default_unit_distance(mesh));
done:
    free(line);
    if (status != TC_OK)
        tc_probe_destroy(&probe);
    *out = probe;
    return status;
}

void tc_probe_destroy(tc_probe **probe)
{
    if (!probe || !*probe)
        return;
    free((*probe)->part);
    free(*probe);
    *probe = NULL;
}
