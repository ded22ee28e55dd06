/* render.c: tc_renderer and tc_render: validates once, then hands over to a driver. */
#include "api/driver.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "gpu/compute.h"
#include "gpu/pingpong.h"
#include "scene/look.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_SIZE = 65536, MAX_STEPS_PER_PASS = 1 << 20, MAX_TABLE = 1024, MAX_Z_EVERY = 65536 };

void tc_render_defaults(tc_render_options *options)
{
    memset(options, 0, sizeof *options);
    options->width = options->height = 512;
}

/* Is the picture whole, or a part that lies within a whole one? */
static tc_status check_part(const tc_render_options *o, tc_error *err)
{
    if (o->whole_width == 0 && o->whole_height == 0 && o->part_x == 0 && o->part_y == 0)
        return TC_OK;
    if (o->whole_width < 1 || o->whole_height < 1 || o->whole_width > MAX_SIZE || o->whole_height > MAX_SIZE)
        return tc_fail(err, TC_E_ARG,
                       "a whole picture of %dx%d pixels has no parts; use 1 to %d each way, or 0 for whole and part",
                       o->whole_width, o->whole_height, MAX_SIZE);
    if (o->part_x < 0 || o->part_y < 0 || o->part_x > o->whole_width - o->width ||
        o->part_y > o->whole_height - o->height)
        return tc_fail(err, TC_E_ARG, "a part of %dx%d pixels at %d,%d does not lie within a picture of %dx%d",
                       o->width, o->height, o->part_x, o->part_y, o->whole_width, o->whole_height);
    return TC_OK;
}

tc_status tc_render_resolve(double *unit, tc_rays *rays, const tc_mesh *mesh, const tc_transfer *tf,
                            const tc_camera *camera, const tc_render_options *options, tc_error *err)
{
    if (!mesh || !tf || !camera || !options)
        return tc_fail(err, TC_E_ARG, "a mesh, a transfer function, a camera and options are needed");
    if (!mesh->prepared)
        return tc_fail(err, TC_E_ARG, "the mesh was not prepared; call tc_mesh_prepare first");
    if (options->width < 1 || options->height < 1 || options->width > MAX_SIZE || options->height > MAX_SIZE)
        return tc_fail(err, TC_E_ARG, "an image of %dx%d pixels cannot be made; use 1 to %d each way", options->width,
                       options->height, MAX_SIZE);
    tc_status status = check_part(options, err);
    if (status != TC_OK)
        return status;
    if (!(options->opacity_stop >= 0))
        return tc_fail(err, TC_E_ARG, "opacity stop %g must not be below 0 (0: chosen; 1: rays never stop early)",
                       options->opacity_stop);
    if (options->unit_distance < 0 || !isfinite(options->unit_distance))
        return tc_fail(err, TC_E_ARG, "unit distance %g must be a positive length", options->unit_distance);
    if (options->steps_per_pass < 0 || options->steps_per_pass > MAX_STEPS_PER_PASS)
        return tc_fail(err, TC_E_ARG, "%d steps per pass are out of range; use 1 to %d", options->steps_per_pass,
                       MAX_STEPS_PER_PASS);
    for (int k = 0; k < 3; k++)
        if (options->table_size[k] != 0 && (options->table_size[k] < 2 || options->table_size[k] > MAX_TABLE))
            return tc_fail(err, TC_E_ARG, "a table %d entries wide cannot be made; use 2 to %d", options->table_size[k],
                           MAX_TABLE);
    if (options->z_update_every < -1 || options->z_update_every > MAX_Z_EVERY)
        return tc_fail(
            err, TC_E_ARG,
            "z-updates every %d passes are out of range; use 1 to %d, 0 (chosen by the renderer) or -1 (never)",
            options->z_update_every, MAX_Z_EVERY);
    switch ((int)options->integrator) {
    case TC_INTEGRATOR_AUTO:
    case TC_INTEGRATOR_TABLE:
    case TC_INTEGRATOR_INTEGRAL:
    case TC_INTEGRATOR_EXACT:
        break;
    default:
        return tc_fail(err, TC_E_ARG,
                       "integrator %d is unknown; there are %d (auto), %d (table), %d (integral) and %d (exact)",
                       (int)options->integrator, TC_INTEGRATOR_AUTO, TC_INTEGRATOR_TABLE, TC_INTEGRATOR_INTEGRAL,
                       TC_INTEGRATOR_EXACT);
    }
    if (options->integral_order < 0 || options->integral_order > 2)
        return tc_fail(err, TC_E_ARG, "running integrals have no order %d; take 1, 2 or 0 (chosen)",
                       options->integral_order);
    if (!(options->integral_split >= 0))
        return tc_fail(err, TC_E_ARG,
                       "segments cannot be split at an optical depth of %g; it must be above 0 (0: chosen)",
                       options->integral_split);
    switch (options->samples) {
    case 0:
    case 1:
    case 4:
    case 16:
    case TC_SAMPLES_ADAPTIVE:
        break;
    default:
        return tc_fail(err, TC_E_ARG, "a pixel cannot have %d rays; take 1, 4, 16 or %d (adaptive)", options->samples,
                       TC_SAMPLES_ADAPTIVE);
    }
    if (options->look && options->look->model == TC_MODEL_DEPTH && options->samples != 0 && options->samples != 1)
        return tc_fail(err, TC_E_ARG,
                       "depth is of one ray a pixel, since a mean of depths is the depth of nothing; take 1 for "
                       "samples, or another model");
    if (options->audit && options->samples != 0 && options->samples != 1)
        return tc_fail(err, TC_E_ARG, "an audit is of one ray a pixel; take 1 for samples, or leave the audit out");
    switch ((int)options->state_format) {
    case TC_STATE_AUTO:
    case TC_STATE_16F:
    case TC_STATE_32F:
        break;
    default:
        return tc_fail(err, TC_E_ARG, "state format %d is unknown; there are %d (auto), %d and %d bits a channel",
                       (int)options->state_format, TC_STATE_AUTO, TC_STATE_16F, TC_STATE_32F);
    }
    switch ((int)options->table_format) {
    case TC_TABLE_AUTO:
    case TC_TABLE_8:
    case TC_TABLE_16F:
    case TC_TABLE_32F:
        break;
    default:
        return tc_fail(err, TC_E_ARG, "table format %d is unknown; there are %d (auto), %d, %d and %d bits a channel",
                       (int)options->table_format, TC_TABLE_AUTO, TC_TABLE_8, TC_TABLE_16F, TC_TABLE_32F);
    }
    switch ((int)options->stepper) {
    case TC_STEPPER_SIGNS:
    case TC_STEPPER_PLANES:
        break;
    default:
        return tc_fail(err, TC_E_ARG, "stepper %d is unknown; there are %d (signs) and %d (planes)",
                       (int)options->stepper, TC_STEPPER_SIGNS, TC_STEPPER_PLANES);
    }
    const double *nan = options->nan_color;
    for (int k = 0; k < 4 && options->has_nan_color; k++)
        if (!(nan[k] >= 0) || !isfinite(nan[k]) || (k < 3 && nan[k] > 1))
            return tc_fail(err, TC_E_ARG,
                           "the colour of missing values, %g %g %g with attenuation %g, is no colour; use 0 to 1 for "
                           "each of r, g and b, and a finite attenuation of 0 or more",
                           nan[0], nan[1], nan[2], nan[3]);
    char why[sizeof err->text];
    if (options->look && tc_look_wrong(why, sizeof why, options->look, mesh))
        return tc_fail(err, TC_E_ARG, "%s", why);
    *unit = options->unit_distance > 0 ? options->unit_distance : tc_default_unit_distance(mesh);
    if (options->whole_width == 0)
        return tc_rays_from_camera(rays, camera, options->width, options->height, err);
    status = tc_rays_from_camera(rays, camera, options->whole_width, options->whole_height, err);
    if (status == TC_OK)
        tc_rays_part(rays, rays, options->part_x, options->part_y, options->width, options->height);
    return status;
}

/* ----------------------------------------------------------------------------------------- pingpong, compute */

static tc_status gl_create(tc_renderer *r, const tc_renderer_options *options, const tc_log *log, tc_error *err)
{
    r->host = options->get_proc_address != NULL;
    tc_status status =
        tc_gpu_renderer_create(&r->gpu, options->gl, options->get_proc_address, options->threads, log, err);
    if (status == TC_OK)
        tc_gpu_renderer_keep(r->gpu, options->keep_bytes, options->keep_at_once);
    return status;
}

static tc_status gl_render(tc_image *image, tc_render_stats *stats, tc_renderer *r, const tc_gpu_frame *frame,
                           tc_error *err)
{
    const tc_gl *gl = &tc_gpu_renderer_context(r->gpu)->gl;
    tc_gl_saved saved;
    if (r->host)
        tc_gl_save(&saved, gl);
    tc_status status = tc_gpu_render(stats, r->gpu, frame, err);
    if (status == TC_OK || status == TC_E_LOST) {
        tc_status read = tc_gpu_read(image->rgba, stats, r->gpu, status == TC_OK ? err : NULL);
        status = status == TC_OK ? read : status;
    }
    if (r->host)
        tc_gl_restore(&saved, gl);
    return status;
}

static void gl_finish(tc_renderer *r)
{
    tc_gpu_renderer_destroy(&r->gpu);
}

/* ------------------------------------------------------------------------------------------------- reference */

static tc_status reference_create(tc_renderer *r, const tc_renderer_options *options, const tc_log *log, tc_error *err)
{
    (void)r;
    (void)log;
    if (options->get_proc_address)
        return tc_fail(err, TC_E_ARG,
                       "the driver 'reference' renders on the CPU; it does not draw into a host's context");
    return TC_OK;
}

static tc_status reference_render(tc_image *image, tc_render_stats *stats, tc_renderer *r, const tc_gpu_frame *frame,
                                  tc_error *err)
{
    const tc_mesh *mesh = frame->mesh;
    tc_status status = TC_OK;
    if (!r->reference || r->reference_serial != mesh->serial) { /* new scalars need no new one */
        tc_reference_destroy(&r->reference);
        double start = tc_now_ms();
        status = tc_reference_create(&r->reference, mesh, r->threads, err);
        stats->ms_pack = tc_now_ms() - start;
        r->reference_serial = mesh->serial;
    }
    if (status != TC_OK)
        return status;
    double start = tc_now_ms();
    tc_reference_set_nan_color(r->reference, frame->options->has_nan_color ? frame->options->nan_color : NULL);
    tc_reference_set_samples(r->reference, frame->options->samples);
    status = tc_reference_set_look(r->reference, frame->options->look, err);
    if (status == TC_OK)
        status = tc_reference_render(image, r->reference, frame->transfer, frame->unit_distance, frame->rays,
                                     r->threads, frame->log, err);
    tc_reference_set_look(r->reference, NULL, NULL); /* it is the caller's, who may free it */
    stats->ms_frame = stats->ms_march = tc_now_ms() - start;
    stats->rays_lost = 0; /* every cell is asked for every ray: there is no walk to lose */
    snprintf(stats->driver, sizeof stats->driver, "reference");
    snprintf(stats->integrator, sizeof stats->integrator, "exact");
    return status;
}

static void reference_finish(tc_renderer *r)
{
    tc_reference_destroy(&r->reference);
}

const tc_driver tc_drivers[] = {
    {"pingpong", "OpenGL 4.3, multi-pass", &tc_driver_pingpong, gl_create, gl_render, gl_finish},
    {"compute", "OpenGL 4.3, compute shader", &tc_driver_compute, gl_create, gl_render, gl_finish},
    {"reference", "double precision on the CPU", NULL, reference_create, reference_render, reference_finish},
    {0},
};

/* --------------------------------------------------------------------------------------------------- renderer */

/* Of the drivers with GL, which share all but the march: the one for the context at hand. `first` is the one that made
 * it. */
static const tc_driver *choose_gl(const tc_driver *first, const tc_renderer *r, const tc_log *log)
{
    const tc_context *context = tc_gpu_renderer_context(r->gpu);
    const tc_gl_driver *best = context->software ? &tc_driver_pingpong : &tc_driver_compute;
    for (const tc_driver *driver = tc_drivers; driver->name; driver++)
        if (driver->gl == best)
            first = driver;
    tc_say(log, TC_DEBUG, "driver %s: %s is %s renderer", first->name, context->gl.renderer,
           context->software ? "a software" : "no software");
    return first;
}

tc_status tc_renderer_create(tc_renderer **out, const tc_renderer_options *options, const tc_log *log, tc_error *err)
{
    static const tc_renderer_options defaults = {0};
    *out = NULL;
    if (!options)
        options = &defaults;
    tc_renderer *r = tc_calloc(1, sizeof *r);
    if (!r)
        return tc_fail_memory(err, "a renderer", 1, sizeof *r);
    r->threads = options->threads;
    bool any = !options->driver || strcmp(options->driver, "auto") == 0;
    tc_status status = TC_E_ARG;
    tc_error why = {0};
    const tc_driver *driver = tc_drivers;
    for (; driver->name; driver++) {
        if (!any && strcmp(driver->name, options->driver) != 0)
            continue;
        status = driver->create(r, options, log, &why);
        if (status == TC_OK || !any)
            break;
        if (options->get_proc_address || (options->gl && strcmp(options->gl, "auto") != 0))
            break; /* a GL was asked for: the CPU is no answer */
        tc_say(log, TC_WARNING, "driver %s cannot be used: %s", driver->name, why.text);
    }
    if (status == TC_OK) {
        r->driver = any && driver->gl ? choose_gl(driver, r, log) : driver;
        *out = r;
        return TC_OK;
    }
    free(r);
    if (!why.text[0])
        return tc_fail(err, TC_E_ARG, "unknown driver '%s'; there are auto, pingpong, compute and reference",
                       options->driver);
    return tc_fail(err, status, "%s", why.text);
}

void tc_renderer_destroy(tc_renderer **renderer)
{
    if (!*renderer)
        return;
    (*renderer)->driver->finish(*renderer);
    free(*renderer);
    *renderer = NULL;
}

void tc_renderer_keep(tc_renderer *renderer, size_t keep_bytes, bool keep_at_once)
{
    if (renderer->gpu)
        tc_gpu_renderer_keep(renderer->gpu, keep_bytes, keep_at_once);
}

void tc_renderer_forget(tc_renderer *renderer)
{
    if (renderer->gpu)
        tc_gpu_renderer_forget(renderer->gpu, NULL); /* without a context they are gone with it */
}

/* Everything not measured. */
static void clear_stats(tc_render_stats *stats)
{
    memset(stats, 0, sizeof *stats);
    stats->ms_pack = stats->ms_upload = stats->ms_table = stats->ms_compile = stats->ms_first_hit = stats->ms_march =
        stats->ms_frame = stats->ms_readback = -1;
    stats->gpu_bytes_mesh = stats->gpu_bytes_other = stats->gpu_bytes_table = stats->gpu_bytes_state = -1;
    stats->gpu_bytes_sent = -1;
    stats->steps_per_pass = stats->z_update_every = stats->passes = stats->z_updates = stats->layers = -1;
    stats->state_bits = -1;
    stats->refined = -1;
    stats->rays = stats->rays_lost = stats->steps = stats->steps_max = stats->audit_broken = -1;
}

tc_status tc_render(tc_image **out, tc_render_stats *stats, tc_renderer *renderer, const tc_mesh *mesh,
                    const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options, const tc_log *log,
                    tc_error *err)
{
    tc_render_stats unused;
    if (!stats)
        stats = &unused;
    clear_stats(stats);
    *out = NULL;
    tc_rays rays;
    tc_gpu_frame frame = {
        .driver = renderer->driver->gl, .mesh = mesh, .transfer = tf, .rays = &rays, .options = options, .log = log};
    tc_status status = tc_render_resolve(&frame.unit_distance, &rays, mesh, tf, camera, options, err);
    if (status == TC_OK && options->stepper != TC_STEPPER_SIGNS && !renderer->gpu)
        status = tc_fail(err, TC_E_ARG,
                         "the driver '%s' does not walk from cell to cell: the stepper 'planes' needs the "
                         "driver 'pingpong' or 'compute'",
                         renderer->driver->name);
    if (status == TC_OK && options->audit && !renderer->gpu)
        status = tc_fail(err, TC_E_ARG,
                         "the driver '%s' does not walk from cell to cell: an audit needs the driver 'pingpong' "
                         "or 'compute'",
                         renderer->driver->name);
    if (status == TC_OK)
        status = tc_image_create(out, options->width, options->height, err);
    if (status != TC_OK)
        return status;
    stats->samples = options->samples ? options->samples : 1;
    status = renderer->driver->render(*out, stats, renderer, &frame, err);
    if (status != TC_OK && status != TC_E_LOST)
        tc_image_destroy(out);
    return status;
}

tc_status tc_render_explain(tc_explanation *out, tc_renderer *renderer, tc_error *err)
{
    if (!renderer->gpu)
        return tc_fail(err, TC_E_ARG,
                       "the driver '%s' has no programs, textures and passes to explain; use pingpong or compute",
                       renderer->driver->name);
    return tc_gpu_explain(out, renderer->gpu, err);
}

tc_status tc_render_audit(tc_audit_ray *out, tc_renderer *renderer, tc_error *err)
{
    if (!renderer->gpu)
        return tc_fail(err, TC_E_ARG, "the driver '%s' does not walk from cell to cell: there is nothing to audit",
                       renderer->driver->name);
    const tc_gl *gl = &tc_gpu_renderer_context(renderer->gpu)->gl;
    tc_gl_saved saved;
    if (renderer->host)
        tc_gl_save(&saved, gl);
    tc_status status = tc_gpu_audit(out, renderer->gpu, err);
    if (renderer->host)
        tc_gl_restore(&saved, gl);
    return status;
}

tc_status tc_render_gl(unsigned framebuffer, tc_render_stats *stats, tc_renderer *renderer, const tc_mesh *mesh,
                       const tc_transfer *tf, const tc_camera *camera, const tc_render_options *options,
                       const tc_log *log, tc_error *err)
{
    tc_render_stats unused;
    if (!stats)
        stats = &unused;
    clear_stats(stats);
    if (!renderer->gpu)
        return tc_fail(err, TC_E_ARG, "the driver '%s' does not draw into a GL context; use pingpong or compute",
                       renderer->driver->name);
    tc_rays rays;
    tc_gpu_frame frame = {
        .driver = renderer->driver->gl, .mesh = mesh, .transfer = tf, .rays = &rays, .options = options, .log = log};
    tc_status status = tc_render_resolve(&frame.unit_distance, &rays, mesh, tf, camera, options, err);
    if (status != TC_OK)
        return status;
    tc_gl_saved saved;
    tc_gl_save(&saved, &tc_gpu_renderer_context(renderer->gpu)->gl);
    stats->samples = options->samples ? options->samples : 1;
    status = tc_gpu_render(stats, renderer->gpu, &frame, err);
    if (status == TC_OK)
        status = tc_gpu_draw(renderer->gpu, framebuffer, err);
    tc_gl_restore(&saved, &tc_gpu_renderer_context(renderer->gpu)->gl);
    return status;
}
