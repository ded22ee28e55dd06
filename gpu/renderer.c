/* renderer.c: keeps mesh, transfer function, state and programs in a GL context and renders frames from them. */
#include "gpu/renderer.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "gpu/audit.h"
#include "gpu/effect.h"
#include "gpu/first_hit.h"
#include "gpu/kept.h"
#include "gpu/pass.h"
#include "gpu/picture.h"
#include "gpu/transfer_gpu.h"
#include "gpu/watch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    AUTO_STEPS_SOFTWARE = 512, /* where a pass costs next to nothing: most rays end in the first */
    AUTO_STEPS_HARDWARE = 64,
    AUTO_STEPS_NO_PASSES = 4096, /* where rays are walked to their ends: more than most make, in less than seconds */
    SOFTWARE_ROUNDS = 60000,     /* of loops in one invocation, within llvmpipe's limit */
    SPLIT_MOST = 256,            /* integrate_integral.glsl's */
    ROUNDS_BESIDE = 100,         /* a step's own, besides those of integrate_exact.glsl for each piece */
    ROUNDS_PLAIN = 3,            /* a step's own where there are no others: it may leave every loop of march.glsl */
    AUTO_Z_SMALL = 4 /* for few steps a pass; Weiler et al. 2003, 5.2, found 14 best: 3 to 6 % more fragments here */
};

static const double OPACITY_STOP = 0.999, OPACITY_STOP_EXACT = 0.9999;
static const double OPAQUE = 1e30; /* attenuation of the colour of missing values: more would not fit a float */

struct tc_gpu_renderer {
    tc_context *context;
    tc_program_cache *programs;
    GLuint vertex_array[2]; /* empty; first hits */
    GLuint hit_buffer, entry_counter, march_counter;
    int threads;

    uint64_t mesh_serial, scalar_serial; /* of what is uploaded; 0: nothing */
    bool planes;                         /* and for which stepper */
    tc_gpu_mesh mesh;
    float *face_corner; /* kept from the pack for proposing first hits */
    tc_pack_extent extent;
    double center[3], scale, scalar_lo, scalar_hi, ms_pack;

    tc_transfer_gpu transfer;
    tc_effect_store effects;
    tc_kept kept;
    tc_effects last; /* of the last picture; n 0: there is none */
    tc_state state;
    tc_proposals proposals;
    int drawn[4]; /* part of the result that is not empty */
    bool audited; /* the state holds the audit of a whole picture */
    int64_t *fragments;
};

tc_status tc_gpu_renderer_create(tc_gpu_renderer **out, const char *name, tc_get_proc get_proc, int threads,
                                 const tc_log *log, tc_error *err)
{
    *out = NULL;
    tc_gpu_renderer *r = tc_calloc(1, sizeof *r);
    if (!r)
        return tc_fail_memory(err, "a renderer", 1, sizeof *r);
    r->threads = threads;
    tc_status status =
        get_proc ? tc_context_create_host(&r->context, get_proc, err) : tc_context_create(&r->context, name, log, err);
    if (status == TC_OK)
        status = tc_program_cache_create(&r->programs, &r->context->gl, err);
    if (status == TC_OK) {
        r->context->gl.GenVertexArrays(2, r->vertex_array);
        r->context->gl.GenBuffers(1, &r->hit_buffer);
        r->context->gl.GenBuffers(1, &r->entry_counter);
        r->context->gl.GenBuffers(1, &r->march_counter);
    }
    if (status != TC_OK) {
        tc_gpu_renderer_destroy(&r);
        return status;
    }
    *out = r;
    return TC_OK;
}

void tc_gpu_renderer_destroy(tc_gpu_renderer **renderer)
{
    tc_gpu_renderer *r = *renderer;
    if (!r)
        return;
    if (r->context && tc_context_make_current(r->context, NULL) == TC_OK) {
        const tc_gl *gl = &r->context->gl;
        tc_gpu_mesh_finish(&r->mesh, gl);
        tc_transfer_gpu_finish(&r->transfer, gl);
        tc_effect_store_finish(&r->effects, gl);
        tc_kept_clear(&r->kept, gl);
        tc_state_finish(&r->state, gl);
        tc_program_cache_destroy(&r->programs);
        gl->DeleteVertexArrays(2, r->vertex_array);
        gl->DeleteBuffers(1, &r->hit_buffer);
        gl->DeleteBuffers(1, &r->entry_counter);
        gl->DeleteBuffers(1, &r->march_counter);
    }
    tc_context_destroy(&r->context);
    tc_proposals_finish(&r->proposals);
    free(r->face_corner);
    free(r->fragments);
    free(r);
    *renderer = NULL;
}

void tc_gpu_renderer_release(tc_gpu_renderer *renderer)
{
    tc_context_release(renderer->context);
}

void tc_gpu_renderer_keep(tc_gpu_renderer *renderer, size_t bytes, bool at_once)
{
    renderer->kept.most = bytes;
    renderer->kept.at_once = at_once;
}

tc_status tc_gpu_renderer_forget(tc_gpu_renderer *renderer, tc_error *err)
{
    tc_status status = tc_context_make_current(renderer->context, err);
    if (status == TC_OK)
        tc_kept_clear(&renderer->kept, &renderer->context->gl);
    return status;
}

const tc_context *tc_gpu_renderer_context(const tc_gpu_renderer *renderer)
{
    return renderer->context;
}

static void take_values(tc_gpu_renderer *r, const tc_mesh *mesh, const tc_pack *pack)
{
    r->extent = pack->extent;
    r->scalar_lo = pack->scalar_lo;
    r->scalar_hi = pack->scalar_hi;
    r->mesh_serial = mesh->serial;
    r->scalar_serial = mesh->scalar_serial;
}

/* New values on the mesh that is there. */
static tc_status update_values(tc_gpu_renderer *r, const tc_mesh *mesh, tc_render_stats *stats, tc_error *err)
{
    tc_pack pack;
    size_t bytes = 0;
    r->mesh_serial = r->scalar_serial = 0; /* on failure all is uploaded anew */
    tc_status status = tc_pack_scalars(&pack, mesh, r->threads, err);
    if (status == TC_OK)
        status = tc_gpu_mesh_values(&r->mesh, &bytes, &r->context->gl, &pack, err);
    if (status == TC_OK) {
        take_values(r, mesh, &pack);
        stats->ms_pack = pack.ms;
        stats->ms_upload = r->mesh.ms;
        stats->gpu_bytes_sent = (double)bytes;
    }
    tc_pack_finish(&pack);
    return status;
}

static tc_status ensure_mesh(tc_gpu_renderer *r, const tc_mesh *mesh, bool planes, tc_render_stats *stats,
                             tc_error *err)
{
    const tc_gl *gl = &r->context->gl;
    stats->gpu_bytes_sent = 0;
    if (r->mesh_serial == mesh->serial && r->scalar_serial == mesh->scalar_serial && r->planes == planes)
        return TC_OK;
    if (r->mesh_serial == mesh->serial && !planes && !r->planes)
        return update_values(r, mesh, stats, err);
    tc_gpu_mesh_finish(&r->mesh, gl);
    r->mesh_serial = r->scalar_serial = 0;
    tc_pack pack;
    tc_status status = tc_pack_build(&pack, mesh, r->threads, err);
    if (status != TC_OK)
        return status;
    tc_pack_planes table1 = {0};
    if (planes)
        status = tc_pack_planes_build(&table1, mesh, &pack, err);
    if (status == TC_OK)
        status = tc_gpu_mesh_upload(&r->mesh, gl, &pack, planes ? &table1 : NULL, err);
    if (status == TC_OK) {
        r->planes = planes;
        memcpy(r->center, pack.center, sizeof r->center);
        r->scale = pack.scale;
        take_values(r, mesh, &pack);
        free(r->face_corner);
        r->face_corner = pack.face_corner;
        pack.face_corner = NULL;
        stats->ms_pack = pack.ms + table1.ms;
        stats->ms_upload = r->mesh.ms;
        stats->gpu_bytes_sent = (double)tc_gpu_mesh_bytes(&r->mesh);
    }
    tc_pack_planes_finish(&table1);
    tc_pack_finish(&pack);
    return status;
}

static tc_status ensure_state(tc_gpu_renderer *r, const tc_render_options *options, bool peeling, tc_error *err)
{
    tc_state *s = &r->state;
    if (tc_state_fits(s, options, peeling))
        return TC_OK;
    tc_state_finish(s, &r->context->gl);
    r->drawn[0] = r->drawn[1] = 0; /* a new result holds anything */
    r->drawn[2] = options->width;
    r->drawn[3] = options->height;
    return tc_state_create(s, &r->context->gl, options, peeling, err);
}

/* Steps per pass and z-update interval where the caller left them to us. */
static void choose_passes(tc_job *job, const tc_render_options *options)
{
    job->steps_per_pass = options->steps_per_pass > 0 ? options->steps_per_pass
                          : !job->driver->locks       ? AUTO_STEPS_NO_PASSES
                          : job->software             ? AUTO_STEPS_SOFTWARE
                                                      : AUTO_STEPS_HARDWARE;
    bool pieces = job->integrator == TC_INTEGRATOR_EXACT || job->hard > 0;
    if (job->software) {
        /* A segment may cross every piece, or be cut into the most parts; loops are cut after 65535 rounds in all. */
        double rounds = pieces           ? (double)job->n_piece + ROUNDS_BESIDE
                        : job->split > 0 ? SPLIT_MOST + ROUNDS_BESIDE
                                         : ROUNDS_PLAIN;
        rounds += job->effects->rounds;
        int most = (int)(SOFTWARE_ROUNDS / rounds);
        job->steps_per_pass = job->steps_per_pass < most ? job->steps_per_pass : most > 1 ? most : 1;
    }
    int every = options->z_update_every;
    if (every == 0)
        every = job->steps_per_pass >= 8 ? 2 : AUTO_Z_SMALL;
    job->z_update_every = every < 0 ? -1 : (every + 1) / 2 * 2;
}

tc_status tc_gpu_audit(tc_audit_ray *out, tc_gpu_renderer *r, tc_error *err)
{
    if (!r->audited)
        return tc_fail(err, TC_E_ARG, "there is no audited picture; make one with tc_render_options.audit");
    tc_status status = tc_context_make_current(r->context, err);
    return status == TC_OK ? tc_audit_read(out, &r->state, &r->context->gl, r->scale, r->drawn, err) : status;
}

/* Sums up the audit of a picture. */
static tc_status count_broken(tc_render_stats *stats, tc_gpu_renderer *r, tc_error *err)
{
    size_t n = (size_t)r->state.width * (size_t)r->state.height;
    tc_audit_ray *ray = tc_alloc(n, sizeof *ray);
    if (!ray)
        return tc_fail_memory(err, "the audit", n, sizeof *ray);
    tc_status status = tc_audit_read(ray, &r->state, &r->context->gl, r->scale, r->drawn, err);
    stats->audit_broken = 0;
    for (size_t i = 0; i < n && status == TC_OK; i++)
        stats->audit_broken += ray[i].broken;
    free(ray);
    return status;
}

static void add_size(tc_explained_size *list, int *n, const char *name, double bytes)
{
    if (*n >= TC_EXPLAINED_MOST || !(bytes > 0))
        return;
    snprintf(list[*n].name, sizeof list[*n].name, "%s", name);
    list[(*n)++].bytes = bytes;
}

tc_status tc_gpu_explain(tc_explanation *out, const tc_gpu_renderer *r, tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (r->last.n == 0)
        return tc_fail(err, TC_E_ARG, "there is no picture to explain; render one first");
    const char *name;
    size_t bytes;
    for (int i = 0; tc_effect_table[i] && i < TC_EXPLAINED_MOST; i++) {
        const tc_effect *row = tc_effect_table[i];
        tc_explained_effect *e = &out->effect[out->n_effect++];
        int k = 0;
        while (k < r->last.n && r->last.place[k] != i)
            k++;
        e->in_force = k < r->last.n;
        e->what = row->what;
        e->model = row->model;
        e->gpu_bytes = e->in_force ? r->last.bytes[k] : 0;
        snprintf(e->name, sizeof e->name, "%s", row->name);
        snprintf(e->why, sizeof e->why, "%s", e->in_force ? r->last.why[k] : r->last.why_not[i]);
    }
    const tc_gpu_mesh *m = &r->mesh;
    const tc_gpu_transfer *t = &r->transfer.textures;
    add_size(out->texture, &out->n_texture, "cells", (double)m->cells.bytes);
    add_size(out->texture, &out->n_texture, "planes of the cells",
             (double)(m->planes_vertices.bytes + m->planes_normals.bytes + m->planes_neighbours.bytes +
                      m->planes_scalars.bytes));
    add_size(out->texture, &out->n_texture, "vertices", (double)m->vertices.bytes);
    add_size(out->texture, &out->n_texture, "values of cells", (double)m->cell_scalar.bytes);
    add_size(out->texture, &out->n_texture, "boundary faces", (double)m->faces.bytes);
    if (!(r->last.needs & TC_NEEDS_NO_FUNCTION))
        add_size(out->texture, &out->n_texture, "transfer function", (double)t->bytes);
    add_size(out->texture, &out->n_texture, "rays and picture", (double)r->state.bytes);
    for (int i = 0; tc_effect_table[i]; i++) {
        int k = 0;
        while (k < r->last.n && r->last.place[k] != i)
            k++;
        add_size(out->texture, &out->n_texture, tc_effect_table[i]->name,
                 k < r->last.n ? r->last.bytes[k] : r->effects.bytes[i]);
    }
    for (size_t k = 0; tc_program_cache_used(&name, &bytes, r->programs, k); k++)
        add_size(out->program, &out->n_program, name, (double)bytes);
    return TC_OK;
}

static void fill_stats(tc_render_stats *stats, const tc_gpu_renderer *r, const tc_job *job, const tc_job_result *result)
{
    snprintf(stats->context, sizeof stats->context, "%s", r->context->kind->name);
    snprintf(stats->gl_renderer, sizeof stats->gl_renderer, "%s", r->context->gl.renderer);
    snprintf(stats->gl_version, sizeof stats->gl_version, "%d.%d", r->context->gl.major, r->context->gl.minor);
    snprintf(stats->driver, sizeof stats->driver, "%s", job->driver->name);
    snprintf(stats->stepper, sizeof stats->stepper, "%s", job->planes ? "planes" : "signs");
    snprintf(stats->integrator, sizeof stats->integrator, "%s",
             job->integrator == TC_INTEGRATOR_TABLE   ? "table"
             : job->integrator == TC_INTEGRATOR_EXACT ? "exact"
                                                      : "integral");
    stats->integral_order = job->integrator == TC_INTEGRATOR_INTEGRAL ? job->order : -1;
    stats->opacity_stop = job->transmittance_stop < 0 ? 1 : 1 - job->transmittance_stop;
    stats->state_bits = r->state.color_bits;
    stats->gpu_bytes_mesh =
        (double)(r->mesh.cells.bytes + r->mesh.vertices.bytes + r->mesh.planes_vertices.bytes +
                 r->mesh.planes_normals.bytes + r->mesh.planes_neighbours.bytes + r->mesh.planes_scalars.bytes);
    stats->gpu_bytes_other = (double)(r->mesh.faces.bytes + r->mesh.cell_scalar.bytes +
                                      tc_first_hit_corners(r->proposals.n) * sizeof *r->proposals.corner);
    stats->gpu_bytes_table = (double)r->transfer.textures.bytes;
    stats->gpu_bytes_state = (double)r->state.bytes;
    stats->bytes_kept = (double)r->kept.bytes;
    stats->kept = job->kept != NULL;
    stats->steps_per_pass = job->steps_per_pass;
    stats->z_update_every = job->driver->locks ? job->z_update_every : -1;
    stats->passes = result->passes;
    stats->z_updates = job->driver->locks ? result->z_updates : -1;
    stats->layers = result->layers;
    stats->rays = result->rays;
    stats->rays_lost = result->rays_lost;
    tc_effects_names(stats->effects, sizeof stats->effects, job->effects);
    stats->ms_first_hit = result->ms_first_hit;
    stats->ms_march = result->ms_march;
}

/* The largest r, g, b of a function and, unless NULL, of the colour of missing values. */
static void find_most(double most[3], const tc_transfer *tf, const double *nan_color)
{
    for (int c = 0; c < 3; c++)
        most[c] = nan_color ? nan_color[c] : 0;
    for (size_t i = 0; i < tf->n; i++) {
        const double color[3] = {tf->knot[i].r, tf->knot[i].g, tf->knot[i].b};
        for (int c = 0; c < 3; c++)
            most[c] = fmax(most[c], color[c]);
    }
}

/* The picture again by peeling: rounding may fold a convex hull, so that a ray along its side enters it more than once.
 */
static tc_status peel_picture(tc_picture *picture, tc_gpu_renderer *r, tc_error *err)
{
    const tc_gl *gl = picture->job->gl;
    tc_say(picture->log, TC_DEBUG, "%lld further entries into the hull, where rounding folds it: the frame is peeled",
           (long long)picture->result.twice);
    picture->job->peel = true;
    gl->Disable(GL_SCISSOR_TEST);
    tc_status status = ensure_state(r, picture->options, true, err);
    if (status == TC_OK)
        status = tc_picture_compile(picture, err);
    return status == TC_OK ? tc_picture_make(picture, err) : status;
}

/* Is there nothing to see, whatever cells rays go through? Where steps are to be counted they are walked all the same. */
static bool shows_nothing(const tc_gpu_renderer *r, const tc_gpu_frame *frame)
{
    const tc_render_options *o = frame->options;
    const tc_look *look = o->look;
    const bool by_opacity = !look || look->model == TC_MODEL_DENSITY_EMITTER || look->model == TC_MODEL_EMISSION ||
                            look->model == TC_MODEL_ABSORPTION || look->model == TC_MODEL_XRAY;
    return by_opacity && (!look || (look->n_iso == 0 && look->n_geometry == 0)) && !o->count && !o->audit &&
           !o->has_nan_color && !o->without && o->stepper == TC_STEPPER_SIGNS &&
           tc_transfer_peak(frame->transfer, r->scalar_lo, r->scalar_hi) == 0;
}

/* What the picture calls for, and the function it is made with. */
static tc_status prepare_effects(tc_effects *out, const tc_transfer **function, tc_gpu_renderer *r,
                                 const tc_gpu_frame *frame, double length_unit, tc_error *err)
{
    static const tc_look plain = {0};
    const tc_effect_scene scene = {
        .mesh = frame->mesh,
        .transfer = frame->transfer,
        .options = frame->options,
        .look = frame->options->look ? frame->options->look : &plain,
        .center = {r->center[0], r->center[1], r->center[2]},
        .scale = r->scale,
        .scalar = {r->scalar_lo, r->scalar_hi},
        .length_unit = length_unit,
        .threads = r->threads,
        .clear = shows_nothing(r, frame),
    };
    tc_status status = tc_effects_choose(out, &r->effects, &scene, err);
    if (status == TC_OK)
        status = tc_effects_function(function, &r->effects, out, err);
    return status == TC_OK && !scene.clear ? tc_effects_update(out, &r->effects, &r->context->gl, err) : status;
}

tc_status tc_gpu_render(tc_render_stats *stats, tc_gpu_renderer *r, const tc_gpu_frame *frame, tc_error *err)
{
    r->audited = false;
    r->last.n = 0;
    tc_program_cache_mark(r->programs);
    tc_status status = tc_context_make_current(r->context, err);
    if (status != TC_OK)
        return status;
    const tc_gl *gl = &r->context->gl;
    const tc_mesh *mesh = frame->mesh;
    const tc_render_options *options = frame->options;
    bool peel = mesh->report.reentry == TC_REENTRY_PEEL;
    double compile_before = tc_program_cache_ms(r->programs);
    gl->BindVertexArray(r->vertex_array[0]);
    gl->Disable(GL_BLEND);
    gl->Disable(GL_SCISSOR_TEST);
    gl->Disable(GL_CULL_FACE);
    gl->ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->DepthRange(0, 1);

    bool planes = options->stepper == TC_STEPPER_PLANES;
    status = ensure_mesh(r, mesh, planes, stats, err);
    if (status == TC_OK)
        status = ensure_state(r, options, peel, err);
    if (status == TC_OK && gl->poison)
        tc_state_poison(&r->state, gl);
    tc_job job = {.gl = gl, .programs = r->programs, .state = &r->state, .mesh = &r->mesh};
    job.driver = frame->driver;
    job.length_unit = fmin(1 / (r->scale * frame->unit_distance), 1e30); /* a float, and its products */
    tc_effects effects;
    const tc_transfer *function = frame->transfer;
    if (status == TC_OK)
        status = prepare_effects(&effects, &function, r, frame, job.length_unit, err);
    if (status == TC_OK) {
        job.effects = &effects;
        job.cell_data = r->mesh.cell_scalar.texture != 0;
        const tc_transfer_gpu_request request = {
            .transfer = function,
            .options = options,
            .scalar = {r->scalar_lo, r->scalar_hi},
            .length_max = mesh->report.longest_edge * r->scale * job.length_unit,
            .extent = &r->extent,
            .length_unit = job.length_unit,
            .cell_data = job.cell_data,
            .pieces_only = (effects.needs & TC_NEEDS_PIECES) != 0,
            .numbers = (effects.needs & TC_NEEDS_NUMBERS) != 0,
            .threads = r->threads,
        };
        job.integrator = TC_INTEGRATOR_EXACT;
        if (!(effects.needs & TC_NEEDS_NO_FUNCTION))
            status = tc_transfer_gpu_ensure(&r->transfer, &job, &request, gl, stats, err);
    }
    if (status != TC_OK)
        return status;

    job.transfer = &r->transfer.textures;
    job.has_imaginary = mesh->n_imaginary > 0;
    job.peel = peel;
    job.nonfinite = mesh->report.nonfinite_scalars > 0 || effects.nonfinite;
    job.has_nan_color = job.nonfinite && options->has_nan_color;
    memcpy(job.nan_color, options->nan_color, sizeof job.nan_color);
    tc_effects_nan_color(job.nan_color, &effects);
    job.nan_color[3] = fmin(job.nan_color[3], OPAQUE);
    find_most(job.most, function, job.has_nan_color ? job.nan_color : NULL);
    tc_effects_brighten(job.most, &effects);
    double stop = options->opacity_stop > 0                    ? options->opacity_stop
                  : options->integrator == TC_INTEGRATOR_EXACT ? OPACITY_STOP_EXACT
                                                               : OPACITY_STOP;
    job.transmittance_stop = effects.needs & TC_NEEDS_NUMBERS ? 0 : stop >= 1 ? -1 : 1 - stop;
    job.count = options->count || options->audit;
    job.clear = effects.scene.clear;
    job.audit = options->audit;
    job.planes = planes;
    job.longest = mesh->report.longest_edge * r->scale;
    job.software = r->context->software;
    choose_passes(&job, options);

    job.proposals = &r->proposals;
    job.screen_array = r->vertex_array[0];
    job.hit_array = r->vertex_array[1];
    job.hit_buffer = r->hit_buffer;
    job.entry_counter = r->entry_counter;
    job.march_counter = r->march_counter;

    tc_picture picture = {.job = &job,
                          .rays = frame->rays,
                          .options = options,
                          .log = frame->log,
                          .center = r->center,
                          .scale = r->scale,
                          .face_corner = r->face_corner,
                          .proposals = &r->proposals,
                          .kept = &r->kept,
                          .mesh_serial = r->mesh_serial,
                          .scalar_serial = r->scalar_serial,
                          .threads = r->threads,
                          .drawn = r->drawn,
                          .stats = stats};
    status = tc_picture_compile(&picture, err);
    if (status != TC_OK)
        return status;
    double start = tc_now_ms();
    status = tc_picture_make(&picture, err);
    if (status == TC_OK && picture.result.twice > 0)
        status = peel_picture(&picture, r, err);
    stats->ms_frame = tc_now_ms() - start - picture.ms_aside;
    gl->Disable(GL_SCISSOR_TEST);
    stats->ms_compile = tc_program_cache_ms(r->programs) - compile_before;
    tc_gl_watch_say(gl, frame->log);
    r->last = effects;
    const tc_job_result result = picture.result;
    if (status == TC_OK)
        fill_stats(stats, r, &job, &result);
    if (status == TC_OK)
        stats->gpu_bytes_other += tc_effects_bytes(&effects);
    if (status == TC_OK && job.count) {
        free(r->fragments);
        r->fragments = result.fragments;
        stats->fragments_per_pass = r->fragments;
        stats->n_fragments_per_pass = result.fragments ? (size_t)result.passes : 0;
    } else {
        free(result.fragments);
    }
    if (status == TC_OK && job.audit && !planes) /* planes are not said to hold the ray */
        status = count_broken(stats, r, err);
    r->audited = status == TC_OK && job.audit;
    if (status == TC_OK && result.rays_lost > 0 && planes)
        status =
            tc_fail(err, TC_E_LOST,
                    "%lld of %lld rays were lost by the stepper 'planes', the arithmetic of the paper, which is here "
                    "to be compared with; the stepper 'signs' loses none",
                    (long long)result.rays_lost, (long long)result.rays);
    else if (status == TC_OK && result.rays_lost > 0)
        status =
            tc_fail(err, TC_E_LOST, "%lld of %lld rays were lost; the picture is not to be trusted, please report it",
                    (long long)result.rays_lost, (long long)result.rays);
    return status;
}

tc_status tc_gpu_read(float *rgba, tc_render_stats *stats, tc_gpu_renderer *r, tc_error *err)
{
    tc_status status = tc_context_make_current(r->context, err);
    if (status != TC_OK)
        return status;
    const tc_gl *gl = &r->context->gl;
    double start = tc_now_ms();
    const int width = r->state.width, height = r->state.height;
    const int all[4] = {0, 0, width, height}, *rect = gl->poison ? all : r->drawn; /* the rest of rgba is 0 */
    const size_t row = 4 * (size_t)width, row_drawn = 4 * (size_t)rect[2];
    float *drawn = rgba + (size_t)(height - rect[1] - rect[3]) * row + 4 * (size_t)rect[0];
    gl->BindFramebuffer(GL_FRAMEBUFFER, r->state.result_framebuffer);
    gl->ReadBuffer(GL_COLOR_ATTACHMENT0);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, width);
    gl->ReadPixels(rect[0], rect[1], rect[2], rect[3], GL_RGBA, GL_FLOAT, drawn);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, 0);
    for (int y = 0; y < rect[3] / 2; y++) { /* GL's row 0 is at the bottom */
        float *a = drawn + (size_t)y * row, *b = drawn + (size_t)(rect[3] - 1 - y) * row;
        for (size_t i = 0; i < row_drawn; i++) {
            float t = a[i];
            a[i] = b[i];
            b[i] = t;
        }
    }
    stats->ms_readback = tc_now_ms() - start;
    return tc_gl_check(gl, "reading the picture back", err);
}

tc_status tc_gpu_draw(tc_gpu_renderer *r, unsigned framebuffer, tc_error *err)
{
    const tc_gl *gl = &r->context->gl;
    const tc_program_source source = {"screen.vert", "copy.frag", "", NULL, NULL};
    GLuint program;
    tc_status status = tc_program_get(&program, r->programs, &source, err);
    if (status != TC_OK)
        return status;
    gl->BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    gl->Viewport(0, 0, r->state.width, r->state.height);
    gl->UseProgram(program);
    tc_pass_texture(gl, program, "picture", 0, GL_TEXTURE_2D, r->state.result);
    gl->Disable(GL_DEPTH_TEST);
    gl->Enable(GL_BLEND);
    gl->BlendEquation(GL_FUNC_ADD);
    gl->BlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    tc_pass_screen(gl);
    gl->Disable(GL_BLEND);
    return tc_gl_check(gl, "drawing into the host's framebuffer", err);
}
