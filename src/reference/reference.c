/* reference.c: makes the reference caster and renders whole images with it. */
#include "reference/reference.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "reference/look.h"
#include "reference/trace.h"
#include "scene/samples.h"

#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Boxes are widened by this (the mesh's half diagonal is about 1): it covers the float rounding of trace.c's slabs. */
static const float PAD = 4e-6f;

/* A tet with four distinct, finite corners that exist. */
static bool usable(const tc_mesh *mesh, size_t tet)
{
    const int32_t *id = &mesh->tet[4 * tet];
    for (int i = 0; i < 4; i++) {
        if (id[i] < 0 || (size_t)id[i] >= mesh->n_vertex)
            return false;
        const double *x = &mesh->vertex[3 * (size_t)id[i]];
        if (!isfinite(x[0]) || !isfinite(x[1]) || !isfinite(x[2]))
            return false;
        for (int j = 0; j < i; j++)
            if (id[i] == id[j])
                return false;
    }
    return true;
}

static void order_two(int32_t *a, int32_t *b)
{
    if (*a > *b) {
        int32_t t = *a;
        *a = *b, *b = t;
    }
}

/* Centre and scale from the usable tets' corners. */
static void measure(tc_reference *r, const uint32_t *id, size_t n)
{
    double lo[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, hi[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 4; k++) {
            const double *x = &r->mesh->vertex[3 * (size_t)r->mesh->tet[4 * (size_t)id[i] + k]];
            for (int a = 0; a < 3; a++)
                lo[a] = fmin(lo[a], x[a]), hi[a] = fmax(hi[a], x[a]);
        }
    double half[3] = {0, 0, 0}, largest = 0;
    for (int a = 0; a < 3 && n; a++) {
        r->center[a] = 0.5 * lo[a] + 0.5 * hi[a];
        half[a] = 0.5 * hi[a] - 0.5 * lo[a];
        largest = fmax(largest, half[a]);
    }
    r->scale = 1;
    if (largest > 0) { /* sqrt(3) < 2: the half diagonal ends up in [0.25, 0.87) */
        int exponent;
        frexp(largest, &exponent);
        r->scale = ldexp(1, -(exponent < -1000 ? -1000 : exponent) - 1);
    }
    for (int a = 0; a < 3; a++)
        half[a] *= r->scale;
    r->half_diagonal = tc_vec_length(half);
}

typedef struct boxes {
    tc_reference *reference;
    const uint32_t *id;
    tc_bvh_box *box;
} boxes;

static void make_vertices(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    tc_reference *r = context;
    for (size_t i = begin; i < end; i++)
        for (int a = 0; a < 3; a++)
            r->vertex[3 * i + a] = (r->mesh->vertex[3 * i + a] - r->center[a]) * r->scale;
}

static void make_boxes(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    boxes *c = context;
    for (size_t i = begin; i < end; i++)
        for (int a = 0; a < 3; a++) {
            double lo = DBL_MAX, hi = -DBL_MAX;
            for (int k = 0; k < 4; k++) {
                double x = c->reference->vertex[3 * (size_t)c->reference->mesh->tet[4 * (size_t)c->id[i] + k] + a];
                lo = fmin(lo, x), hi = fmax(hi, x);
            }
            c->box[i].lo[a] = (float)lo - PAD;
            c->box[i].hi[a] = (float)hi + PAD;
        }
}

tc_status tc_reference_create(tc_reference **out, const tc_mesh *mesh, int threads, tc_error *err)
{
    *out = NULL;
    if (!mesh)
        return tc_fail(err, TC_E_ARG, "the reference caster was given no mesh");
    if (mesh->n_tet >= (size_t)1 << 31)
        return tc_fail(err, TC_E_ARG, "the reference caster takes fewer than 2^31 tets; this mesh has %zu",
                       mesh->n_tet);
    tc_status status = TC_E_MEMORY;
    size_t n = 0;
    tc_reference *r = tc_calloc(1, sizeof *r);
    uint32_t *id = tc_alloc(mesh->n_tet, sizeof *id);
    tc_bvh_box *box = NULL;
    if (!r || !id)
        goto done;
    r->mesh = mesh;
    for (size_t i = 0; i < mesh->n_tet; i++)
        if (usable(mesh, i))
            id[n++] = (uint32_t)i;
    measure(r, id, n);

    r->scratch = tc_calloc(TC_REFERENCE_WORKERS, sizeof *r->scratch);
    r->vertex = tc_alloc(mesh->n_vertex, 3 * sizeof *r->vertex);
    r->tet = tc_alloc(n, sizeof *r->tet);
    box = tc_alloc(n, sizeof *box);
    if (!r->scratch || !r->vertex || !r->tet || !box)
        goto done;
    tc_parallel_for(mesh->n_vertex, 65536, threads, make_vertices, r);
    tc_parallel_for(n, 65536, threads, make_boxes, &(boxes){r, id, box});
    status = tc_bvh_build(&r->bvh, box, n, threads, err);
    if (status != TC_OK)
        goto done;
    for (size_t i = 0; i < n; i++) {
        uint32_t tet = id[r->bvh.order[i]];
        r->bvh.order[i] = tet;
        int32_t *t = r->tet[i];
        memcpy(t, &mesh->tet[4 * (size_t)tet], sizeof r->tet[i]);
        order_two(&t[0], &t[1]), order_two(&t[2], &t[3]), order_two(&t[0], &t[2]), order_two(&t[1], &t[3]);
        order_two(&t[1], &t[2]);
    }
done:
    free(box);
    free(id);
    if (status != TC_OK) {
        tc_reference_destroy(&r);
        if (status == TC_E_MEMORY)
            tc_fail_memory(err, "the reference caster", mesh->n_tet, 128);
    }
    *out = r;
    return status;
}

void tc_reference_destroy(tc_reference **reference)
{
    tc_reference *r = *reference;
    if (!r)
        return;
    tc_reference_set_look(r, NULL, NULL);
    for (int i = 0; r->scratch && i < TC_REFERENCE_WORKERS; i++) {
        free(r->scratch[i].hit);
        free(r->scratch[i].meeting);
    }
    free(r->scratch);
    free(r->vertex);
    free(r->tet);
    tc_bvh_finish(&r->bvh);
    free(r);
    *reference = NULL;
}

void tc_reference_set_nan_color(tc_reference *reference, const double *color)
{
    reference->has_nan_color = color != NULL;
    if (color)
        memcpy(reference->nan_color, color, sizeof reference->nan_color);
}

tc_status tc_reference_trace(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                             const double origin[3], const double direction[3], const double range[2], int worker)
{
    if (worker < 0 || worker >= TC_REFERENCE_WORKERS || !(unit > 0))
        return TC_E_ARG;
    tc_line line;
    tc_line_init(&line, reference, origin, direction, range);
    return tc_line_trace(out, reference, tf, unit, &line, 0, worker);
}

void tc_reference_set_samples(tc_reference *reference, int samples)
{
    reference->samples = samples;
}

/* The mean of edge x edge rays; spread: the largest difference of a channel among them. */
static tc_status trace_grid(double *out, double *spread, int edge, const tc_reference *r, const tc_transfer *tf,
                            double unit, const tc_rays *rays, const double middle[2], int worker)
{
    double least[4] = {INFINITY, INFINITY, INFINITY, INFINITY}, most[4] = {0}, sum[4] = {0};
    for (int k = 0; k < edge * edge; k++) {
        double origin[3], direction[3], range[2];
        double X = middle[0] + tc_samples_offset(k % edge, edge), Y = middle[1] + tc_samples_offset(k / edge, edge);
        tc_reference_ray ray;
        tc_rays_pixel(origin, direction, rays, X, Y);
        tc_rays_range(range, rays, X, Y);
        tc_status status = tc_reference_trace(&ray, r, tf, unit, origin, direction, range, worker);
        if (status != TC_OK)
            return status;
        tc_look_depth(ray.rgba, r, rays, origin, direction);
        for (int c = 0; c < 4; c++) {
            sum[c] += ray.rgba[c];
            least[c] = fmin(least[c], ray.rgba[c]);
            most[c] = fmax(most[c], ray.rgba[c]);
        }
    }
    *spread = 0;
    for (int c = 0; c < 4; c++) {
        out[c] = sum[c] / (edge * edge);
        *spread = fmax(*spread, most[c] - least[c]);
    }
    return TC_OK;
}

tc_status tc_reference_pixel(double *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                             const tc_rays *rays, double X, double Y, int worker)
{
    const double middle[2] = {X, Y};
    double spread;
    int edge = tc_samples_edge(reference->samples);
    tc_status status = trace_grid(out, &spread, edge, reference, tf, unit, rays, middle, worker);
    if (status == TC_OK && reference->samples == TC_SAMPLES_ADAPTIVE && spread > TC_SAMPLES_SPREAD)
        status = trace_grid(out, &spread, tc_samples_edge(16), reference, tf, unit, rays, middle, worker);
    return status;
}

typedef struct render {
    const tc_image *image;
    const tc_reference *reference;
    const tc_transfer *tf;
    const tc_rays *rays;
    const tc_log *log;
    double unit;
    atomic_int done, memory_out;
} render;

static void render_rows(void *context, size_t begin, size_t end, int worker)
{
    render *c = context;
    for (size_t row = begin; row < end; row++) {
        for (int x = 0; x < c->image->width; x++) {
            double rgba[4], X = x + 0.5, Y = c->image->height - (double)row - 0.5;
            if (tc_reference_pixel(rgba, c->reference, c->tf, c->unit, c->rays, X, Y, worker) != TC_OK) {
                atomic_store(&c->memory_out, 1);
                return;
            }
            float *pixel = &c->image->rgba[4 * (row * (size_t)c->image->width + (size_t)x)];
            for (int i = 0; i < 4; i++)
                pixel[i] = (float)rgba[i];
        }
        int done = atomic_fetch_add(&c->done, 1) + 1;
        if (worker == 0) /* the thread that called */
            tc_progress(c->log, "reference", (double)done / c->image->height);
    }
}

tc_status tc_reference_render(tc_image *image, const tc_reference *reference, const tc_transfer *tf, double unit,
                              const tc_rays *rays, int threads, const tc_log *log, tc_error *err)
{
    if (image->width != rays->width || image->height != rays->height)
        return tc_fail(err, TC_E_ARG, "the image has %d x %d pixels but the camera was set up for %d x %d",
                       image->width, image->height, rays->width, rays->height);
    if (!(unit > 0))
        return tc_fail(err, TC_E_ARG, "the unit distance %g must be positive", unit);
    render c = {.image = image, .reference = reference, .tf = tf, .rays = rays, .log = log, .unit = unit};
    atomic_init(&c.done, 0);
    atomic_init(&c.memory_out, 0);
    tc_parallel_for((size_t)image->height, 1, threads, render_rows, &c);
    if (atomic_load(&c.memory_out))
        return tc_fail(err, TC_E_MEMORY, "out of memory while the reference caster collected the segments of a ray");
    tc_progress(log, "reference", 1);
    return TC_OK;
}
