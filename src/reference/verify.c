/* verify.c: compares pixels of a picture with the reference. */
#include "reference/reference.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "reference/trace.h"

#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* A reference colour that moves by more than this under a shift of 2^-22 says nothing; nor is a smaller error looked
 * at. */
static const double MOVES = 1.0 / 1020, SHIFT = 1.0 / 4194304;

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

typedef struct check {
    const tc_image *image;
    const tc_reference *reference;
    const tc_transfer *tf;
    const tc_rays *rays;
    const tc_log *log;
    double unit, range;
    size_t n;
    const uint32_t *pixel; /* [n]; NULL: all */
    double *error;         /* [n][4] */
    bool *ill_posed;       /* [n] */
    atomic_size_t done;
    atomic_int failed;
} check;

static double distance(const double a[4], const double b[4])
{
    double m = 0;
    for (int i = 0; i < 4; i++)
        m = fmax(m, fabs(a[i] - b[i]));
    return m;
}

/* What the picture may not know: the judge asks the reference again with each of these moves. */
enum { SIDES = 8, DATA = SIDES, APART = DATA + 2, TURNS = APART + 2, ROUNDED = TURNS + 3, MOVES_N = ROUNDED + 4 };

/* Move k of a line; *data is what to add to every scalar.
 *   SIDES    the ray goes by SHIFT of the diagonal to the four sides, along u and v, and to the four corners between
 * them: a ray at a corner of the hull may stay in the mesh, or out of it, on all four sides DATA     the data move by
 * SHIFT of their range APART    overlapping parts of the mesh move against each other along the ray by up to SHIFT of
 * the diagonal TURNS    a ray that lies in a face or runs through an edge or a vertex is on no particular side of it;
 * the trace takes one, by a move of no length along u and v, and is asked for the others by turning these ROUNDED  each
 * vertex moves by itself by up to a quarter of SHIFT, as rounding to float moves it: what a thin plate shows hangs on
 * its thickness, which no move of the whole tells */
static tc_line move_line(double *data, const check *c, const tc_line *line, int k)
{
    static const double side[SIDES][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}};
    const double by = SHIFT * 2 * c->reference->half_diagonal;
    tc_line moved = *line;
    *data = 0;
    if (k < DATA) {
        tc_vec_mul_add(moved.base, line->base, by * side[k][0], line->u);
        tc_vec_mul_add(moved.base, moved.base, by * side[k][1], line->v);
    } else if (k < APART) {
        *data = k % 2 ? -SHIFT * c->range : SHIFT * c->range;
    } else if (k < TURNS) {
        moved.unsure = k % 2 ? -by : by;
    } else if (k < ROUNDED) {
        static const double turn[3][2] = {{0, 1}, {-1, 0}, {0, -1}};
        const double *t = turn[k - TURNS];
        for (int i = 0; i < 3; i++) {
            moved.u[i] = t[0] * line->u[i] + t[1] * line->v[i];
            moved.v[i] = t[0] * line->v[i] - t[1] * line->u[i];
        }
    } else {
        moved.rounding = 0.25 * by;
        moved.draw = (uint32_t)k;
    }
    return moved;
}

static tc_status judge(bool *ill, const check *c, const tc_line *line, const tc_reference_ray *ray, int worker)
{
    *ill = false;
    for (int k = 0; k < MOVES_N && !*ill; k++) {
        double data;
        tc_line moved = move_line(&data, c, line, k);
        tc_reference_ray other;
        tc_status status = tc_line_trace(&other, c->reference, c->tf, c->unit, &moved, data, worker);
        if (status != TC_OK)
            return status;
        *ill = distance(other.rgba, ray->rgba) > MOVES;
    }
    return TC_OK;
}

static tc_status check_pixel(const check *c, size_t k, int worker)
{
    size_t at = c->pixel ? c->pixel[k] : k, width = (size_t)c->image->width;
    double X = (double)(at % width) + 0.5, Y = (double)c->image->height - (double)(at / width) - 0.5;
    double origin[3], direction[3], range[2];
    tc_rays_pixel(origin, direction, c->rays, X, Y);
    tc_rays_range(range, c->rays, X, Y);
    tc_line line;
    tc_line_init(&line, c->reference, origin, direction, range);
    tc_reference_ray ray;
    tc_status status = tc_line_trace(&ray, c->reference, c->tf, c->unit, &line, 0, worker);
    if (status != TC_OK)
        return status;
    double worst = 0;
    bool finite = true;
    for (int i = 0; i < 4; i++) {
        double value = c->image->rgba[4 * at + (size_t)i], e = fabs(value - ray.rgba[i]);
        finite = finite && isfinite(value);
        c->error[4 * k + (size_t)i] = isfinite(value) ? e : FLT_MAX;
        worst = fmax(worst, c->error[4 * k + (size_t)i]);
    }
    c->ill_posed[k] = false;
    if (worst > MOVES && finite)
        return judge(&c->ill_posed[k], c, &line, &ray, worker);
    return TC_OK;
}

static void check_range(void *context, size_t begin, size_t end, int worker)
{
    check *c = context;
    for (size_t k = begin; k < end; k++)
        if (check_pixel(c, k, worker) != TC_OK) {
            atomic_store(&c->failed, 1);
            return;
        }
    size_t done = atomic_fetch_add(&c->done, end - begin) + end - begin;
    if (worker == 0)
        tc_progress(c->log, "verify", (double)done / (double)c->n);
}

/* Range of the finite scalars. */
static double scalar_range(const tc_mesh *mesh)
{
    double lo = INFINITY, hi = -INFINITY;
    size_t n = !mesh->scalar ? 0 : mesh->association == TC_CELL_DATA ? mesh->n_tet : mesh->n_vertex;
    for (size_t i = 0; i < n; i++)
        if (isfinite(mesh->scalar[i]))
            lo = fmin(lo, mesh->scalar[i]), hi = fmax(hi, mesh->scalar[i]);
    return lo < hi ? hi - lo : 0;
}

static void swap(double *a, double *b)
{
    double t = *a;
    *a = *b, *b = t;
}

/* The k-th smallest of x [n], which gets reordered (quickselect in three ways). */
static double select_kth(double *x, size_t n, size_t k)
{
    size_t begin = 0, end = n;
    while (end - begin > 1) {
        double pivot = x[begin + (end - begin) / 2];
        size_t less = begin, i = begin, more = end;
        while (i < more) {
            if (x[i] < pivot)
                swap(&x[less++], &x[i++]);
            else if (x[i] > pivot)
                swap(&x[--more], &x[i]);
            else
                i++;
        }
        if (k < less)
            end = less;
        else if (k >= more)
            begin = more;
        else
            break;
    }
    return x[k];
}

static void reduce(tc_verify_result *out, check *c)
{
    size_t m = 0;
    double sum = 0;
    out->pixels = c->n;
    for (size_t k = 0; k < c->n; k++) {
        size_t at = c->pixel ? c->pixel[k] : k;
        double e[4], worst = 0;
        memcpy(e, &c->error[4 * k], sizeof e);
        for (int i = 0; i < 4; i++)
            worst = fmax(worst, e[i]);
        if (c->ill_posed[k]) {
            out->ill_posed++;
            out->worst_error_ill_posed = fmax(out->worst_error_ill_posed, worst);
            continue;
        }
        if (m == 0 || worst > out->max_abs_error) {
            out->max_abs_error = worst;
            out->worst_x = (int)(at % (size_t)c->image->width);
            out->worst_y = (int)(at / (size_t)c->image->width);
        }
        for (int i = 0; i < 4; i++) {
            sum += e[i];
            c->error[m++] = e[i]; /* m <= 4 k: what is overwritten has been read */
        }
    }
    if (m == 0)
        return;
    out->mean_abs_error = sum / (double)m;
    size_t rank = m - m / 1000;
    out->p999_abs_error = select_kth(c->error, m, rank > 0 ? rank - 1 : 0);
}

tc_status tc_reference_verify(tc_verify_result *out, const tc_image *image, size_t n, uint64_t seed,
                              const tc_reference *reference, const tc_transfer *tf, double unit, const tc_rays *rays,
                              int threads, const tc_log *log, tc_error *err)
{
    memset(out, 0, sizeof *out);
    if (image->width != rays->width || image->height != rays->height)
        return tc_fail(err, TC_E_ARG, "the image has %d x %d pixels but the camera was set up for %d x %d",
                       image->width, image->height, rays->width, rays->height);
    if (!(unit > 0))
        return tc_fail(err, TC_E_ARG, "the unit distance %g must be positive", unit);
    size_t all = (size_t)image->width * (size_t)image->height;
    if (all > UINT32_MAX)
        return tc_fail(err, TC_E_ARG, "an image of %d x %d pixels is too large to be verified", image->width,
                       image->height);
    n = n < all ? n : all;
    if (n == 0)
        return TC_OK;
    tc_status status = TC_OK;
    uint32_t *pixel = n < all ? tc_alloc(n, sizeof *pixel) : NULL;
    double *error = tc_alloc(n, 4 * sizeof *error);
    bool *ill_posed = tc_calloc(n, sizeof *ill_posed);
    if ((n < all && !pixel) || !error || !ill_posed) {
        status = tc_fail_memory(err, "the comparison with the reference", n, 4 * sizeof *error);
        goto done;
    }
    if (pixel)
        sample(pixel, n, all, seed);
    check c = {.image = image,
               .reference = reference,
               .tf = tf,
               .rays = rays,
               .log = log,
               .unit = unit,
               .range = scalar_range(reference->mesh),
               .n = n,
               .pixel = pixel,
               .error = error,
               .ill_posed = ill_posed};
    atomic_init(&c.done, 0);
    atomic_init(&c.failed, 0);
    tc_parallel_for(n, 64, threads, check_range, &c);
    if (atomic_load(&c.failed)) {
        status = tc_fail(err, TC_E_MEMORY, "out of memory while the reference caster collected the segments of a ray");
        goto done;
    }
    reduce(out, &c);
    tc_progress(log, "verify", 1);
done:
    free(pixel);
    free(error);
    free(ill_posed);
    return status;
}
