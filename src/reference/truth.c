/* truth.c: the reference's colours of some pixels of one view, and pictures compared with them. */
#include "reference/truth.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "reference/ill_posed.h"
#include "reference/look.h"
#include "scene/samples.h"

#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_EDGE = 64, CHUNK = 64 };
static const double CONFIDENCE = 0.95;

/* What is known of a pixel. */
enum { NOT_ASKED, WELL_POSED, ILL_POSED };

struct tc_truth {
    const tc_reference *reference;
    const tc_transfer *tf;
    const tc_log *log;
    tc_rays rays;
    double unit, range; /* range: width of the scalars' */
    int edge, threads;  /* edge x edge rays a pixel */
    bool drawn, no_judge;
    double doubt;
    size_t n, n_all;
    uint32_t *pixel; /* [n] */
    double *color;   /* [n][4] */
    uint8_t *known;  /* [n] */
};

/* One step of SplitMix64 (Steele, Lea, Flood 2014). */
static uint64_t next_random(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* n of `of` numbers, ascending, without repetition (Knuth, TAOCP 3.4.2, algorithm S). */
static void sample(uint32_t *out, size_t n, size_t of, uint64_t seed)
{
    size_t taken = 0;
    for (size_t i = 0; i < of && taken < n; i++) {
        double u = (double)(next_random(&seed) >> 11) * 0x1p-53;
        if (u * (double)(of - i) < (double)(n - taken))
            out[taken++] = (uint32_t)i;
    }
}

/* Width of the range of the finite scalars. */
static double scalar_range(const tc_mesh *mesh)
{
    double lo = INFINITY, hi = -INFINITY;
    size_t n = !mesh->scalar ? 0 : mesh->association == TC_CELL_DATA ? mesh->n_tet : mesh->n_vertex;
    for (size_t i = 0; i < n; i++)
        if (isfinite(mesh->scalar[i]))
            lo = fmin(lo, mesh->scalar[i]), hi = fmax(hi, mesh->scalar[i]);
    return lo < hi ? hi - lo : 0;
}

/* -------------------------------------------------------------------------------------------------------- tracing */

/* One ray of a pixel. */
typedef struct pixel_ray {
    double origin[3], direction[3];
    tc_line line;
} pixel_ray;

/* Ray number `ray` of pixel k. */
static void find_ray(pixel_ray *out, const tc_truth *t, size_t k, int ray)
{
    size_t at = t->pixel[k], width = (size_t)t->rays.width;
    double X = (double)(at % width) + 0.5 + tc_samples_offset(ray % t->edge, t->edge);
    double Y = (double)t->rays.height - (double)(at / width) - 0.5 + tc_samples_offset(ray / t->edge, t->edge);
    double range[2];
    tc_rays_pixel(out->origin, out->direction, &t->rays, X, Y);
    tc_rays_range(range, &t->rays, X, Y);
    tc_line_init(&out->line, t->reference, out->origin, out->direction, range);
}

static tc_status trace_pixel(tc_truth *t, size_t k, int worker)
{
    int rays = t->edge * t->edge;
    double *color = t->color + 4 * k;
    for (int i = 0; i < rays; i++) {
        pixel_ray one;
        tc_reference_ray ray;
        find_ray(&one, t, k, i);
        tc_status status = tc_line_trace(&ray, t->reference, t->tf, t->unit, &one.line, 0, worker);
        if (status != TC_OK)
            return status;
        tc_look_depth(ray.rgba, t->reference, &t->rays, one.origin, one.direction);
        for (int c = 0; c < 4; c++)
            color[c] += ray.rgba[c];
    }
    for (int c = 0; c < 4; c++)
        color[c] /= rays;
    return TC_OK;
}

/* Asks whether pixel k is ill-posed. */
static tc_status judge_pixel(tc_truth *t, size_t k, int worker)
{
    int rays = t->edge * t->edge;
    double left = TC_ILL_POSED_MOVE * rays;
    for (int i = 0; i < rays && left >= 0; i++) {
        pixel_ray one;
        tc_reference_ray ray;
        double sway;
        find_ray(&one, t, k, i);
        tc_status status = tc_line_trace(&ray, t->reference, t->tf, t->unit, &one.line, 0, worker);
        if (status == TC_OK)
            status = tc_line_sway(&sway, t->reference, t->tf, t->unit, t->range, &one.line, ray.rgba, left, worker);
        if (status != TC_OK)
            return status;
        left -= sway;
    }
    t->known[k] = left < 0 ? ILL_POSED : WELL_POSED;
    return TC_OK;
}

/* The absolute errors of a pixel, by channel and the largest; finite: all channels of the picture are. */
typedef struct difference {
    double channel[4], worst;
    bool finite;
} difference;

static difference difference_of(const tc_truth *t, const tc_image *image, size_t k)
{
    const float *value = image->rgba + 4 * (size_t)t->pixel[k];
    difference d = {.finite = true};
    for (int c = 0; c < 4; c++) {
        d.channel[c] = isfinite(value[c]) ? fabs((double)value[c] - t->color[4 * k + (size_t)c]) : FLT_MAX;
        d.finite = d.finite && isfinite(value[c]);
        d.worst = fmax(d.worst, d.channel[c]);
    }
    return d;
}

/* Would the pixel not count if it is ill-posed? */
static bool doubtful(const tc_truth *t, const difference *d)
{
    return d->worst > t->doubt && d->finite;
}

/* A loop over pixels that may run out of memory. */
typedef struct walk {
    tc_truth *truth;
    const tc_image *image; /* to judge; NULL: to trace */
    atomic_size_t done;
    atomic_int failed;
} walk;

static void walk_range(void *context, size_t begin, size_t end, int worker)
{
    walk *w = context;
    tc_truth *t = w->truth;
    for (size_t k = begin; k < end; k++) {
        tc_status status = TC_OK;
        if (!w->image) {
            status = trace_pixel(t, k, worker);
        } else if (t->known[k] == NOT_ASKED) {
            difference d = difference_of(t, w->image, k);
            if (doubtful(t, &d))
                status = judge_pixel(t, k, worker);
        }
        if (status != TC_OK) {
            atomic_store(&w->failed, 1);
            return;
        }
    }
    size_t done = atomic_fetch_add(&w->done, end - begin) + end - begin;
    if (worker == 0)
        tc_progress(t->log, w->image ? "judge" : "trace", (double)done / (double)t->n);
}

static tc_status walk_all(tc_truth *truth, const tc_image *image, tc_error *err)
{
    walk w = {.truth = truth, .image = image};
    atomic_init(&w.done, 0);
    atomic_init(&w.failed, 0);
    tc_parallel_for(truth->n, CHUNK, truth->threads, walk_range, &w);
    if (atomic_load(&w.failed))
        return tc_fail(err, TC_E_MEMORY, "out of memory while the reference caster collected the segments of a ray");
    return TC_OK;
}

/* --------------------------------------------------------------------------------------------------- the truth itself
 */

static tc_status check_view(int *edge, const tc_truth_view *view, tc_error *err)
{
    const tc_rays *rays = view->rays;
    int samples = view->samples == TC_SAMPLES_ADAPTIVE ? 16 : view->samples ? view->samples : 1;
    if (!(view->unit > 0))
        return tc_fail(err, TC_E_ARG, "the unit distance %g must be positive", view->unit);
    size_t all = (size_t)rays->width * (size_t)rays->height;
    if (all > UINT32_MAX)
        return tc_fail(err, TC_E_ARG, "an image of %d x %d pixels is too large to be verified", rays->width,
                       rays->height);
    *edge = 1;
    while (*edge < MAX_EDGE && *edge * *edge < samples)
        ++*edge;
    if (*edge * *edge != samples)
        return tc_fail(err, TC_E_ARG, "the truth of a pixel cannot be of %d rays; take a square number up to %d",
                       view->samples, MAX_EDGE * MAX_EDGE);
    for (size_t k = 0; view->pixel && k < view->n; k++)
        if (view->pixel[k] >= all)
            return tc_fail(err, TC_E_ARG, "pixel %u is outside an image of %d x %d", (unsigned)view->pixel[k],
                           rays->width, rays->height);
    if (view->pixel && view->n > all)
        return tc_fail(err, TC_E_ARG, "%zu pixels were listed of an image that has %zu: some twice", view->n, all);
    return TC_OK;
}

tc_status tc_truth_create(tc_truth **out, const tc_truth_view *view, tc_error *err)
{
    int edge = 1;
    *out = NULL;
    tc_status status = check_view(&edge, view, err);
    if (status != TC_OK)
        return status;
    size_t all = (size_t)view->rays->width * (size_t)view->rays->height, n = view->n < all ? view->n : all;
    tc_truth *t = tc_calloc(1, sizeof *t);
    if (!t)
        return tc_fail_memory(err, "the comparison with the reference", 1, sizeof *t);
    *t = (tc_truth){.reference = view->reference,
                    .tf = view->tf,
                    .log = view->log,
                    .rays = *view->rays,
                    .unit = view->unit,
                    .range = scalar_range(view->reference->mesh),
                    .edge = edge,
                    .threads = view->threads,
                    .drawn = !view->pixel,
                    .no_judge = view->no_judge,
                    .doubt = view->doubt > 0 ? view->doubt : TC_ILL_POSED_MOVE,
                    .n = n,
                    .n_all = all,
                    .pixel = tc_alloc(n, sizeof *t->pixel),
                    .color = tc_calloc(n, 4 * sizeof *t->color),
                    .known = tc_calloc(n, sizeof *t->known)};
    if (!t->pixel || !t->color || !t->known)
        status = tc_fail_memory(err, "the comparison with the reference", n, 4 * sizeof *t->color + 5);
    if (status == TC_OK) {
        if (view->pixel)
            memcpy(t->pixel, view->pixel, n * sizeof *t->pixel);
        else
            sample(t->pixel, n, all, view->seed);
        status = walk_all(t, NULL, err);
    }
    if (status != TC_OK)
        tc_truth_destroy(&t);
    *out = t;
    return status;
}

void tc_truth_destroy(tc_truth **truth)
{
    if (!truth || !*truth)
        return;
    free((*truth)->pixel);
    free((*truth)->color);
    free((*truth)->known);
    free(*truth);
    *truth = NULL;
}

size_t tc_truth_count(const tc_truth *truth)
{
    return truth->n;
}

const uint32_t *tc_truth_pixels(const tc_truth *truth)
{
    return truth->pixel;
}

const double *tc_truth_color(const tc_truth *truth, size_t k)
{
    return truth->color + 4 * k;
}

/* ------------------------------------------------------------------------------------------------------ comparing */

/* An error that counts? Judging has been done. */
static bool counts(const tc_truth *t, size_t k, const difference *d)
{
    return t->known[k] != ILL_POSED || !doubtful(t, d);
}

/* The rank-th smallest (from 0) of all errors that count. The bits of doubles that are not negative are ordered like
 * the doubles: counting digits of 16 bits finds the value in four passes, without sorting or storing. */
static double order_statistic(const tc_truth *t, const tc_image *image, size_t rank, size_t *count)
{
    uint64_t prefix = 0, mask = 0;
    for (int shift = 48; shift >= 0; shift -= 16) {
        memset(count, 0, 65536 * sizeof *count);
        for (size_t k = 0; k < t->n; k++) {
            difference d = difference_of(t, image, k);
            if (!counts(t, k, &d))
                continue;
            for (int c = 0; c < 4; c++) {
                uint64_t bits;
                memcpy(&bits, &d.channel[c], sizeof bits);
                if ((bits & mask) == prefix)
                    count[bits >> shift & 0xffff]++;
            }
        }
        uint64_t digit = 0;
        while (digit < 0xffff && rank >= count[digit])
            rank -= count[digit++];
        prefix |= digit << shift;
        mask |= (uint64_t)0xffff << shift;
    }
    double value;
    memcpy(&value, &prefix, sizeof value);
    return value;
}

static void put_error(tc_image *errors, size_t at, const difference *d, bool counted)
{
    float *pixel = errors->rgba + 4 * at;
    for (int c = 0; c < 3; c++)
        pixel[c] = (float)fmax(d->channel[c], d->channel[3]);
    pixel[3] = counted ? 1 : 0.5f;
}

tc_status tc_truth_compare(tc_verify_result *out, tc_image *errors, tc_truth *truth, const tc_image *image,
                           tc_error *err)
{
    const tc_truth *t = truth;
    memset(out, 0, sizeof *out);
    if (image->width != t->rays.width || image->height != t->rays.height)
        return tc_fail(err, TC_E_ARG, "the image has %d x %d pixels but the camera was set up for %d x %d",
                       image->width, image->height, t->rays.width, t->rays.height);
    if (errors && (errors->width != image->width || errors->height != image->height))
        return tc_fail(err, TC_E_ARG, "the image of errors has %d x %d pixels, the picture %d x %d", errors->width,
                       errors->height, image->width, image->height);
    if (!t->no_judge) {
        tc_status status = walk_all(truth, image, err);
        if (status != TC_OK)
            return status;
    }
    if (errors)
        memset(errors->rgba, 0, 4 * t->n_all * sizeof *errors->rgba);
    size_t m = 0;
    double sum = 0;
    out->pixels = t->n;
    for (size_t k = 0; k < t->n; k++) {
        difference d = difference_of(t, image, k);
        bool counted = counts(t, k, &d);
        if (errors)
            put_error(errors, t->pixel[k], &d, counted);
        if (!counted) {
            out->ill_posed++;
            out->worst_error_ill_posed = fmax(out->worst_error_ill_posed, d.worst);
            continue;
        }
        if (m == 0 || d.worst > out->max_abs_error) {
            out->max_abs_error = d.worst;
            out->worst_x = (int)(t->pixel[k] % (size_t)image->width);
            out->worst_y = (int)(t->pixel[k] / (size_t)image->width);
        }
        for (int c = 0; c < 4; c++)
            sum += d.channel[c];
        m += 4;
    }
    out->n_all = t->n_all;
    out->confidence = CONFIDENCE;
    out->unseen_share =
        t->drawn || t->n == t->n_all ? tc_truth_unseen_share(t->n_all, t->n, out->ill_posed, CONFIDENCE) : NAN;
    if (m == 0)
        return TC_OK;
    out->mean_abs_error = sum / (double)m;
    size_t *count = tc_alloc(65536, sizeof *count);
    if (!count)
        return tc_fail_memory(err, "the comparison with the reference", 65536, sizeof *count);
    out->p999_abs_error = order_statistic(t, image, m - m / 1000 - 1, count);
    out->p9999_abs_error = order_statistic(t, image, m - m / 10000 - 1, count);
    free(count);
    return TC_OK;
}
