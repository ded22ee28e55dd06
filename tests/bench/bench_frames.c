/* bench_frames: frame times of several ways to draw one mesh, frame by frame in turn, so that whatever else the machine
 * does falls on all of them. JSON on stdout.
 *
 * Usage: bench_frames INPUT [--field NAME] [--cell-data] [--reentry auto|convexify|peel] [--size N] [--threads N]
 *                     [--azimuths A,B,…] [--elevation E] [--frames F] [--apart] [--lanes] VARIANT...
 * INPUT: a file or synth:NAME[:CELLS]. VARIANT: NAME[,KEY=VALUE]… with the keys shaders (a folder for TETCAST_SHADERS),
 * driver, stepper, integrator, steps-per-pass, z-update-every, opacity-stop. Variants that differ in shaders, driver,
 * stepper or integrator have a renderer each; --apart: one at a time, for meshes of which memory holds one copy only,
 * view by view and not in turn.
 *
 * Of each variant and view: medians over F frames after one to warm up (two in the first view); then one frame that
 * counts steps and fragments.
 * Instructions and cycles are those of all threads in user space per frame, the reading back of the picture among them;
 * absent where the machine does not count. --lanes: "lanes" of the first variant is the share of lanes with a cell to
 * step through, where groups of 4 x 2 pixels go on until the last of them is done, as llvmpipe's with registers of
 * eight floats. A variant whose frame fails has "failed" with the reason: it may lose rays.
 */
#define _POSIX_C_SOURCE 200809L
#include "bench_counters.h"
#include "bench_scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VARIANTS_MOST = 64, VIEWS_MOST = 64, FRAMES_MOST = 256 };

typedef struct variant {
    char text[512];
    const char *name, *shaders, *driver;
    tc_render_options options;
    tc_renderer *renderer; /* shared with the variant `owner` */
    int owner;
    json_t *json, *views;
    double ms_first; /* wall time of the first frame: pack, upload, tables, compiling */
    double frame[FRAMES_MOST], first_hit[FRAMES_MOST], march[FRAMES_MOST];
    double instructions, cycles;
    bool failed;
} variant;

typedef struct bench {
    bench_scene scene;
    tc_transfer *tf;
    const char *input, *field;
    tc_association association;
    tc_reentry reentry;
    int size, threads, frames, n_view, n_variant;
    double view[VIEWS_MOST], elevation;
    bool apart, lanes;
    bench_counters counters;
    variant variant[VARIANTS_MOST];
} bench;

static void usage(const char *what, const char *text)
{
    fprintf(stderr, "bench_frames: %s '%s'; the first lines of bench_frames.c say what there is\n", what, text);
    exit(2);
}

static void parse_variant(variant *v, const bench *b, const char *text)
{
    memset(v, 0, sizeof *v);
    if (strlen(text) >= sizeof v->text)
        usage("too long", text);
    memcpy(v->text, text, strlen(text) + 1);
    tc_render_defaults(&v->options);
    v->options.width = v->options.height = b->size;
    v->driver = "auto";
    v->shaders = "";
    char *save = NULL;
    v->name = strtok_r(v->text, ",", &save);
    if (!v->name)
        usage("a variant without name", text);
    for (char *pair = strtok_r(NULL, ",", &save); pair; pair = strtok_r(NULL, ",", &save)) {
        char *value = strchr(pair, '=');
        if (!value)
            usage("not KEY=VALUE:", pair);
        *value++ = 0;
        if (!strcmp(pair, "shaders"))
            v->shaders = value;
        else if (!strcmp(pair, "driver"))
            v->driver = value;
        else if (!strcmp(pair, "stepper"))
            v->options.stepper = !strcmp(value, "planes") ? TC_STEPPER_PLANES : TC_STEPPER_SIGNS;
        else if (!strcmp(pair, "integrator"))
            v->options.integrator = !strcmp(value, "table")      ? TC_INTEGRATOR_TABLE
                                    : !strcmp(value, "integral") ? TC_INTEGRATOR_INTEGRAL
                                    : !strcmp(value, "exact")    ? TC_INTEGRATOR_EXACT
                                                                 : TC_INTEGRATOR_AUTO;
        else if (!strcmp(pair, "steps-per-pass"))
            v->options.steps_per_pass = atoi(value);
        else if (!strcmp(pair, "z-update-every"))
            v->options.z_update_every = !strcmp(value, "never") ? -1 : atoi(value);
        else if (!strcmp(pair, "opacity-stop"))
            v->options.opacity_stop = atof(value);
        else
            usage("no key", pair);
    }
}

static void parse(bench *b, int argc, char **argv)
{
    *b = (bench){.size = 512, .frames = 5, .n_view = 1};
    static const char *const with_value[] = {"--field",    "--reentry",   "--size",   "--threads",
                                             "--azimuths", "--elevation", "--frames", NULL};
    const char *text[VARIANTS_MOST];
    for (int i = 1; i < argc; i++) {
        const char *value = NULL;
        for (int k = 0; with_value[k]; k++)
            if (!strcmp(argv[i], with_value[k]) && !(value = i + 1 < argc ? argv[i + 1] : NULL))
                usage("no value for", argv[i]);
        if (value)
            i++;
        const char *name = argv[value ? i - 1 : i];
        if (!strcmp(name, "--field"))
            b->field = value;
        else if (!strcmp(name, "--reentry"))
            b->reentry = !strcmp(value, "peel")        ? TC_REENTRY_PEEL
                         : !strcmp(value, "convexify") ? TC_REENTRY_CONVEXIFY
                                                       : TC_REENTRY_AUTO;
        else if (!strcmp(name, "--size"))
            b->size = atoi(value);
        else if (!strcmp(name, "--threads"))
            b->threads = atoi(value);
        else if (!strcmp(name, "--elevation"))
            b->elevation = atof(value);
        else if (!strcmp(name, "--frames"))
            b->frames = atoi(value);
        else if (!strcmp(name, "--azimuths"))
            for (b->n_view = 0; *value && b->n_view < VIEWS_MOST; value += *value == ',') {
                char *end;
                b->view[b->n_view++] = strtod(value, &end);
                if (end == value)
                    usage("no number:", value);
                value = end;
            }
        else if (!strcmp(name, "--cell-data"))
            b->association = TC_CELL_DATA;
        else if (!strcmp(name, "--apart"))
            b->apart = true;
        else if (!strcmp(name, "--lanes"))
            b->lanes = true;
        else if (name[0] == '-')
            usage("no option", name);
        else if (!b->input)
            b->input = name;
        else if (b->n_variant < VARIANTS_MOST)
            text[b->n_variant++] = name;
        else
            usage("one variant too many:", name);
    }
    if (!b->input || b->n_variant == 0)
        usage("INPUT or VARIANT is missing behind", argv[0]);
    if (b->frames < 1 || b->frames > FRAMES_MOST || b->n_view < 1 || b->size < 1)
        usage("no sensible --frames, --azimuths or --size in", argv[0]);
    for (int i = 0; i < b->n_variant; i++)
        parse_variant(&b->variant[i], b, text[i]);
}

static void use_shaders(const variant *v)
{
    if (*v->shaders)
        setenv("TETCAST_SHADERS", v->shaders, 1);
    else
        unsetenv("TETCAST_SHADERS");
}

/* A renderer of its own, or that of an earlier variant it can share. */
static void open_renderer(bench *b, int i)
{
    variant *v = &b->variant[i];
    tc_error err = {0};
    v->owner = i;
    for (int k = 0; k < i && !b->apart && v->owner == i; k++) {
        const variant *other = &b->variant[k];
        if (!strcmp(other->shaders, v->shaders) && !strcmp(other->driver, v->driver) &&
            other->options.integrator == v->options.integrator && other->options.stepper == v->options.stepper &&
            other->owner == k)
            v->owner = k;
    }
    v->renderer = b->variant[v->owner].renderer;
    if (v->owner != i)
        return;
    const tc_renderer_options options = {.driver = v->driver, .threads = b->threads};
    bench_check(tc_renderer_create(&v->renderer, &options, NULL, &err), v->name, &err);
}

static void close_renderer(bench *b, int i)
{
    if (b->variant[i].owner == i)
        tc_renderer_destroy(&b->variant[i].renderer);
    b->variant[i].renderer = NULL;
}

/* One frame; false, and "failed" in the variant's JSON, where it could not be made. */
static bool draw(tc_render_stats *stats, bench *b, variant *v, const tc_camera *camera, bool count)
{
    tc_image *image = NULL;
    tc_error err = {0};
    tc_render_options options = v->options;
    options.count = count;
    use_shaders(v);
    double before[2], after[2];
    bench_counters_read(&b->counters, &before[0], &before[1]);
    double start = bench_now_ms();
    tc_status status = tc_render(&image, stats, v->renderer, b->scene.mesh, b->tf, camera, &options, NULL, &err);
    if (v->ms_first == 0)
        v->ms_first = bench_now_ms() - start;
    bench_counters_read(&b->counters, &after[0], &after[1]);
    if (!count) {
        v->instructions += after[0] - before[0];
        v->cycles += after[1] - before[1];
    }
    tc_image_destroy(&image);
    if (status != TC_OK && status != TC_E_LOST) { /* lost rays are counted */
        v->failed = true;
        json_object_set_new(v->json, "failed", json_string(err.text));
        return false;
    }
    return true;
}

static double fragments_of(const tc_render_stats *stats)
{
    double sum = 0;
    for (size_t i = 0; i < stats->n_fragments_per_pass; i++)
        sum += (double)stats->fragments_per_pass[i];
    return stats->n_fragments_per_pass ? sum : NAN;
}

static void describe(variant *v, const tc_render_stats *stats)
{
    json_object_set_new(v->json, "context", json_string(stats->context));
    json_object_set_new(v->json, "renderer", json_string(stats->gl_renderer));
    json_object_set_new(v->json, "driver", json_string(stats->driver));
    json_object_set_new(v->json, "integrator", json_string(stats->integrator));
    bench_set(v->json, "steps_per_pass", stats->steps_per_pass);
    bench_set(v->json, "first_ms", v->ms_first);
    bench_set(v->json, "pack_ms", stats->ms_pack);
    bench_set(v->json, "upload_ms", stats->ms_upload);
    bench_set(v->json, "table_ms", stats->ms_table);
    bench_set(v->json, "compile_ms", stats->ms_compile);
    bench_set(v->json, "gpu_bytes_mesh", stats->gpu_bytes_mesh);
    bench_set(v->json, "gpu_bytes_other", stats->gpu_bytes_other);
    bench_set(v->json, "gpu_bytes_table", stats->gpu_bytes_table);
    bench_set(v->json, "gpu_bytes_state", stats->gpu_bytes_state);
}

/* Steps over what groups of lanes take that go on until their last ray is done; NAN on a failure. */
static double busy_lanes(bench *b, variant *v, const tc_camera *camera)
{
    enum { WIDTH = 4, HEIGHT = 2 };
    int size = b->size;
    double steps = 0, lanes = 0;
    tc_image *image = NULL;
    tc_render_stats stats;
    tc_error err = {0};
    tc_render_options options = v->options;
    tc_audit_ray *ray = malloc((size_t)size * (size_t)size * sizeof *ray);
    options.audit = true;
    use_shaders(v);
    bool done = ray &&
                tc_render(&image, &stats, v->renderer, b->scene.mesh, b->tf, camera, &options, NULL, &err) == TC_OK &&
                tc_render_audit(ray, v->renderer, &err) == TC_OK;
    for (int y = 0; y < size && done; y += HEIGHT)
        for (int x = 0; x < size; x += WIDTH) {
            uint32_t most = 0;
            for (int j = y; j < y + HEIGHT && j < size; j++)
                for (int i = x; i < x + WIDTH && i < size; i++) {
                    uint32_t cells = ray[(size_t)j * (size_t)size + (size_t)i].cells;
                    most = cells > most ? cells : most;
                    steps += cells;
                }
            lanes += (double)most * WIDTH * HEIGHT;
        }
    tc_image_destroy(&image);
    free(ray);
    return done && lanes > 0 ? steps / lanes : NAN;
}

/* What a view has shown. */
static void summarise(variant *v, bench *b, double azimuth, const tc_camera *camera, const tc_render_stats *last)
{
    size_t n = (size_t)b->frames;
    json_t *view = json_object();
    json_object_set_new(view, "azimuth", json_real(azimuth));
    bench_set(view, "frame_ms", bench_median(v->frame, n));
    bench_set(view, "frame_min_ms", v->frame[0]);
    bench_set(view, "frame_max_ms", v->frame[n - 1]);
    bench_set(view, "first_hit_ms", bench_median(v->first_hit, n));
    bench_set(view, "march_ms", bench_median(v->march, n));
    bench_set(view, "instructions", v->instructions / (double)n);
    bench_set(view, "cycles", v->cycles / (double)n);
    bench_set(view, "passes", last->passes);
    bench_set(view, "layers", last->layers);
    bench_set(view, "rays", (double)last->rays);
    bench_set(view, "rays_lost", (double)last->rays_lost);
    tc_render_stats counted;
    if (draw(&counted, b, v, camera, true)) {
        bench_set(view, "steps", (double)counted.steps);
        bench_set(view, "steps_max", (double)counted.steps_max);
        bench_set(view, "fragments", fragments_of(&counted));
        if (b->lanes && v == b->variant)
            bench_set(view, "lanes", busy_lanes(b, v, camera));
    }
    json_array_append_new(v->views, view);
}

/* One view by variants [from, to), in turn. */
static void measure(bench *b, double azimuth, int from, int to)
{
    const tc_camera camera = bench_camera(&b->scene, azimuth, b->elevation);
    tc_render_stats last[VARIANTS_MOST];
    for (int i = from; i < to; i++) {
        variant *v = &b->variant[i];
        bool first = v->ms_first == 0;
        if (!v->failed && draw(&last[i], b, v, &camera, false) && first)
            describe(v, &last[i]);
        if (!v->failed && first) /* what a driver compiles at the second frame */
            draw(&last[i], b, v, &camera, false);
        v->instructions = v->cycles = 0;
    }
    for (int f = 0; f < b->frames; f++)
        for (int i = from; i < to; i++) {
            variant *v = &b->variant[i];
            if (v->failed || !draw(&last[i], b, v, &camera, false))
                continue;
            v->frame[f] = last[i].ms_frame;
            v->first_hit[f] = last[i].ms_first_hit;
            v->march[f] = last[i].ms_march;
        }
    for (int i = from; i < to; i++)
        if (!b->variant[i].failed)
            summarise(&b->variant[i], b, azimuth, &camera, &last[i]);
}

int main(int argc, char **argv)
{
    static bench b;
    parse(&b, argc, argv);
    bool counts = bench_counters_open(&b.counters);
    bench_scene_open(&b.scene, b.input, b.field, b.association, b.reentry, b.threads);
    b.tf = bench_transfer(&b.scene, 0.3);
    json_t *out = json_object(), *list = json_array();
    json_object_set_new(out, "input", json_string(b.input));
    json_object_set_new(out, "mesh", bench_mesh_json(&b.scene));
    json_object_set_new(out, "time_ms", bench_time_json(&b.scene));
    json_object_set_new(out, "size", json_integer(b.size));
    json_object_set_new(out, "frames", json_integer(b.frames));
    json_object_set_new(out, "counters", json_boolean(counts));
    for (int i = 0; i < b.n_variant; i++) {
        variant *v = &b.variant[i];
        v->json = json_object();
        v->views = json_array();
        json_object_set_new(v->json, "name", json_string(v->name));
        json_object_set_new(v->json, "views", v->views);
        json_array_append_new(list, v->json);
        if (!b.apart)
            open_renderer(&b, i);
    }
    for (int i = 0; i < b.n_variant && b.apart; i++) {
        open_renderer(&b, i);
        for (int k = 0; k < b.n_view; k++)
            measure(&b, b.view[k], i, i + 1);
        close_renderer(&b, i);
    }
    for (int k = 0; k < b.n_view && !b.apart; k++)
        measure(&b, b.view[k], 0, b.n_variant);
    for (int i = b.n_variant - 1; i >= 0 && !b.apart; i--)
        close_renderer(&b, i);
    json_object_set_new(out, "variants", list);
    size_t self = 0, helper = 0;
    tc_memory_peak(&self, &helper);
    json_object_set_new(out, "peak_bytes", json_integer((json_int_t)self));
    json_object_set_new(out, "helper_peak_bytes", json_integer((json_int_t)helper));
    int code = json_dumpf(out, stdout, JSON_INDENT(1)) == 0 && fflush(stdout) == 0 ? 0 : 1;
    json_decref(out);
    tc_transfer_destroy(&b.tf);
    bench_scene_close(&b.scene);
    bench_counters_close(&b.counters);
    return code;
}
