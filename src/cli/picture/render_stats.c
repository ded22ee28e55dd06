/* render_stats.c: the --stats JSON of a render. Every number that was not measured is absent, never 0. */
#include "cli/picture/look_build.h"
#include "cli/picture/render_choose.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int tc_double_order(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void tc_spread_of(tc_spread *out, double *value, size_t n)
{
    size_t good = 0;
    for (size_t i = 0; i < n; i++)
        if (isfinite(value[i]) && value[i] >= 0)
            value[good++] = value[i];
    *out = (tc_spread){NAN, NAN, NAN};
    if (!good)
        return;
    qsort(value, good, sizeof *value, tc_double_order);
    out->low = value[0];
    out->high = value[good - 1];
    out->median = good % 2 ? value[good / 2] : 0.5 * (value[good / 2 - 1] + value[good / 2]);
}

static json_t *tc_gl_json(const tc_render_run *run)
{
    json_t *gl = json_object();
    tc_json_text(gl, "context", run->first.context);
    tc_json_text(gl, "renderer", run->first.gl_renderer);
    tc_json_text(gl, "version", run->first.gl_version);
    return gl;
}

static void tc_json_bytes(json_t *object, const char *key, double value)
{
    if (value >= 0 && isfinite(value))
        tc_json_count(object, key, (uint64_t)value);
}

static json_t *tc_mesh_json(const tc_render_run *run)
{
    json_t *mesh = json_object();
    const tc_mesh_report *report = &run->report;
    const tc_render_stats *stats = &run->first;
    const tc_source *source = tc_mesh_source(run->mesh);
    size_t dropped = report->dropped_degenerate + report->dropped_nonfinite + report->dropped_duplicate;
    tc_json_count(mesh, "points", report->n_vertex);
    tc_json_count(mesh, "tets", report->n_tet);
    tc_json_count(mesh, "imaginary_tets", report->n_imaginary);
    tc_json_count(mesh, "dropped_cells", dropped + (source ? source->dropped_cells : 0));
    tc_json_count(mesh, "dropped_nonfinite", report->dropped_nonfinite);
    tc_json_count(mesh, "nonfinite_cells", report->nonfinite_cells);
    json_object_set_new(mesh, "convex", json_boolean(report->convex));
    tc_json_text(mesh, "reentry", tc_reentry_name(report->reentry));
    tc_json_text(mesh, "reentry_why", report->reentry_why);
    tc_json_bytes(mesh, "gpu_bytes", stats->gpu_bytes_mesh);
    tc_json_measured(mesh, "gpu_bytes_per_tet", stats->gpu_bytes_mesh / (double)(report->n_tet + report->n_imaginary));
    tc_json_bytes(mesh, "gpu_bytes_other", stats->gpu_bytes_other);
    tc_json_bytes(mesh, "gpu_bytes_table", stats->gpu_bytes_table);
    tc_json_bytes(mesh, "gpu_bytes_state", stats->gpu_bytes_state);
    tc_json_bytes(mesh, "gpu_bytes_sent", stats->gpu_bytes_sent);
    return mesh;
}

static json_t *tc_time_json(const tc_render_run *run)
{
    json_t *time = json_object();
    const tc_mesh_report *report = &run->report;
    tc_json_measured(time, "read", run->ms_read);
    tc_json_measured(time, "check", report->ms_check);
    tc_json_measured(time, "adjacency", report->ms_adjacency);
    tc_json_measured(time, "order", report->ms_order);
    tc_json_measured(time, "convexify", report->ms_convexify);
    tc_json_measured(time, "pack", run->first.ms_pack);
    tc_json_measured(time, "upload", run->first.ms_upload);
    tc_json_measured(time, "table", run->first.ms_table);
    tc_json_measured(time, "compile", run->first.ms_compile);
    tc_json_measured(time, "first_hit", run->first_hit.median);
    tc_json_measured(time, "march", run->march.median);
    tc_json_measured(time, "frame", run->frame.median);
    if (run->options->has_repeat) {
        tc_json_measured(time, "frame_min", run->frame.low);
        tc_json_measured(time, "frame_max", run->frame.high);
    }
    tc_json_measured(time, "readback", run->readback.median);
    tc_json_measured(time, "write", run->ms_write);
    tc_json_measured(time, "total", run->ms_total);
    return time;
}

static json_t *tc_march_json(const tc_render_run *run)
{
    json_t *march = json_object();
    const tc_render_stats *stats = &run->count;
    tc_json_text(march, "driver", stats->driver);
    tc_json_text(march, "stepper", stats->stepper);
    tc_json_text(march, "integrator", stats->integrator);
    tc_json_text(march, "integrator_why", stats->integrator_why);
    if (stats->integral_order > 0)
        tc_json_count(march, "integral_order", (uint64_t)stats->integral_order);
    if (stats->opacity_stop > 0)
        tc_json_real(march, "opacity_stop", stats->opacity_stop);
    if (stats->samples == TC_SAMPLES_ADAPTIVE)
        tc_json_text(march, "samples", "adaptive");
    else if (stats->samples > 0)
        tc_json_count(march, "samples", (uint64_t)stats->samples);
    tc_json_measured_count(march, "pixels_refined", stats->refined);
    if (stats->state_bits > 0)
        tc_json_count(march, "state_bits", (uint64_t)stats->state_bits);
    if (stats->steps_per_pass > 0)
        tc_json_count(march, "steps_per_pass", (uint64_t)stats->steps_per_pass);
    if (stats->z_update_every > 0)
        tc_json_count(march, "z_update_every", (uint64_t)stats->z_update_every);
    tc_json_measured_count(march, "passes", stats->passes);
    tc_json_measured_count(march, "z_updates", stats->z_updates);
    tc_json_measured_count(march, "layers", stats->layers);
    tc_json_measured_count(march, "rays", stats->rays);
    tc_json_measured_count(march, "rays_lost", stats->rays_lost);
    tc_json_measured_count(march, "cells_broken", stats->audit_broken);
    tc_json_measured_count(march, "steps", stats->steps);
    tc_json_measured_count(march, "steps_max", stats->steps_max);
    if (stats->steps >= 0 && stats->rays > 0)
        tc_json_real(march, "steps_per_ray", (double)stats->steps / (double)stats->rays);
    if (stats->steps >= 0 && run->march.median > 0)
        tc_json_real(march, "steps_per_second", (double)stats->steps / (1e-3 * run->march.median));
    if (stats->n_fragments_per_pass > 0 && stats->fragments_per_pass) {
        json_t *list = json_array();
        for (size_t i = 0; i < stats->n_fragments_per_pass; i++)
            json_array_append_new(list, json_integer((json_int_t)stats->fragments_per_pass[i]));
        json_object_set_new(march, "fragments_per_pass", list);
    }
    return march;
}

static json_t *tc_verify_json(const tc_verify_result *verify, uint64_t seed)
{
    json_t *out = json_object();
    tc_json_count(out, "pixels", verify->pixels);
    tc_json_count(out, "ill_posed", verify->ill_posed);
    tc_json_measured(out, "max_abs_error", verify->max_abs_error);
    tc_json_measured(out, "p9999_abs_error", verify->p9999_abs_error);
    tc_json_measured(out, "p999_abs_error", verify->p999_abs_error);
    tc_json_measured(out, "mean_abs_error", verify->mean_abs_error);
    if (verify->ill_posed > 0)
        tc_json_measured(out, "worst_error_ill_posed", verify->worst_error_ill_posed);
    tc_json_count(out, "pixels_all", verify->n_all);
    tc_json_measured(out, "confidence", verify->confidence);
    tc_json_measured(out, "unseen_share", verify->unseen_share);
    tc_json_measured_count(out, "rays_lost", verify->rays_lost);
    tc_json_count(out, "seed", seed);
    return out;
}

/* Puts part into object under key, or drops it when it has no entry. */
static void tc_json_part(json_t *object, const char *key, json_t *part)
{
    if (json_object_size(part) > 0)
        json_object_set_new(object, key, part);
    else
        json_decref(part);
}

/* Names of effects, as explain tells them, of a renderer that has no table of them: what the look calls for. */
static json_t *tc_look_effects(const tc_look *look)
{
    static const char *const model[] = {
        [TC_MODEL_DENSITY_EMITTER] = "density-emitter",
        [TC_MODEL_EMISSION] = "emission",
        [TC_MODEL_ABSORPTION] = "absorption",
        [TC_MODEL_XRAY] = "xray",
        [TC_MODEL_MAXIMUM] = "maximum",
        [TC_MODEL_MINIMUM] = "minimum",
        [TC_MODEL_AVERAGE] = "average",
        [TC_MODEL_SURFACES] = "surfaces",
        [TC_MODEL_DEPTH] = "depth",
    };
    static const tc_look plain = {0};
    look = look ? look : &plain;
    const bool lit = look->shade.gradient != TC_GRADIENT_NONE;
    const bool volume = lit && look->shade.volume && look->model == TC_MODEL_DENSITY_EMITTER;
    const bool surfaces = lit && look->shade.surfaces && look->n_iso > 0;
    const bool projection =
        look->model == TC_MODEL_MAXIMUM || look->model == TC_MODEL_MINIMUM || look->model == TC_MODEL_AVERAGE;
    const struct {
        bool there;
        const char *name;
    } effect[] = {{true, model[look->model]},
                  {look->n_select > 0, "select"},
                  {look->n_plane > 0 || look->has_box, "clip"},
                  {volume || surfaces, "lights"},
                  {volume || surfaces, "gradients"},
                  {volume, "shade"},
                  {look->n_iso > 0, "isosurfaces"},
                  {look->color_field != NULL, "color-field"},
                  {surfaces, "shade-isosurfaces"},
                  {look->n_geometry > 0, projection ? "geometry-before" : "geometry"}};
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof effect / sizeof *effect; i++)
        if (effect[i].there)
            json_array_append_new(list, json_string(effect[i].name));
    return list;
}

/* The effects in force. */
static json_t *tc_effects_json(const tc_render_run *run)
{
    if (!*run->first.effects)
        return tc_look_effects(run->render.look);
    json_t *list = json_array();
    for (const char *name = run->first.effects; *name;) {
        const size_t length = strcspn(name, ",");
        json_array_append_new(list, json_stringn(name, length));
        name += length;
        name += strspn(name, ", ");
    }
    return list;
}

json_t *tc_render_shared_json(const tc_render_run *run)
{
    json_t *out = json_object(), *image = json_object();
    tc_json_text(out, "tetcast", tc_version());
    tc_json_text(out, "input", run->options->input);
    tc_json_text(out, "field", tc_run_field(run));
    tc_json_real(out, "unit_distance", tc_run_unit_distance(run));
    tc_json_count(image, "width", (uint64_t)run->render.width);
    tc_json_count(image, "height", (uint64_t)run->render.height);
    tc_json_part(out, "image", image);
    tc_json_part(out, "gl", tc_gl_json(run));
    tc_json_part(out, "mesh", tc_mesh_json(run));
    json_object_set_new(out, "effects", tc_effects_json(run));
    return out;
}

/* What belongs to one picture. */
static void tc_picture_json(json_t *out, const tc_render_run *run)
{
    tc_json_part(out, "time_ms", tc_time_json(run));
    if (run->seen.cache[0])
        tc_json_part(out, "cache", tc_input_cache_json(&run->seen));
    tc_json_count(out, "frames", (uint64_t)run->frames);
    tc_json_part(out, "march", tc_march_json(run));
    if (run->chosen)
        tc_json_part(out, "choice", tc_choice_json(run));
    if (run->verified)
        tc_json_part(out, "verify", tc_verify_json(&run->verify, run->options->seed));
}

void tc_render_memory_json(json_t *out)
{
    json_t *memory = json_object();
    size_t self = 0, helper = 0;
    tc_memory_peak(&self, &helper);
    if (self > 0)
        tc_json_count(memory, "peak_bytes", self);
    if (helper > 0)
        tc_json_count(memory, "helper_peak_bytes", helper);
    tc_json_part(out, "memory", memory);
}

json_t *tc_render_stats_json(const tc_render_run *run)
{
    json_t *out = tc_render_shared_json(run);
    tc_picture_json(out, run);
    tc_render_memory_json(out);
    return out;
}

json_t *tc_render_step_json(const tc_render_run *run, int step, double time, bool set_up)
{
    json_t *out = json_object();
    json_object_set_new(out, "step", json_integer(step));
    tc_json_real(out, "time", time);
    tc_json_text(out, "output", run->options->output);
    tc_json_text(out, "set_up", set_up ? "mesh" : "values");
    json_object_set_new(out, "scalar_range", tc_json_reals(run->report.scalar_range, 2));
    tc_json_bytes(out, "gpu_bytes_sent", run->first.gpu_bytes_sent);
    if (set_up)
        tc_json_part(out, "mesh", tc_mesh_json(run));
    tc_picture_json(out, run);
    return out;
}
