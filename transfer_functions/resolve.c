/* resolve.c: from a colour map and an opacity curve to the knots of a piecewise linear function.
 * Both are cut where they may have a corner; between cuts lines are as long as they may be near the curve. */
#include "transfer_functions/resolve.h"

#include "core/memory.h"
#include "transfer_functions/color_space.h"
#include "transfer_functions/place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double tolerance = 0.8e-4;
static const double top = 0.3; /* largest attenuation of the named curves */

typedef struct knots {
    tc_knot *knot;
    size_t n, capacity;
    bool failed;
} knots;

/* A stretch of s without a corner inside. Between points `color` and color + 1 (opacity alike); -1: before the first,
 * n - 1: behind the last. */
typedef struct place {
    long color, opacity;
    double middle; /* an s in the stretch, to know the side of a midpoint */
} place;

typedef struct job {
    const tc_resolve_input *in;
    const tc_color_point *color; /* map's points, or the longer list that CIEDE2000 makes */
    size_t n_color;
    tc_color_space space;
    double *color_s, *opacity_s; /* scalars of the points */
    double scale;                /* attenuation's tolerance is tolerance * scale */
    knots out;
} job;

/* ------------------------------------------------------------------------------------------------------ places */

static double scalar_of(const tc_resolve_input *in, double u)
{
    if (u <= 0 || u >= 1)
        return in->range[u >= 1];
    if (in->log)
        return exp(log(in->range[0]) + u * (log(in->range[1]) - log(in->range[0])));
    return in->range[0] * (1 - u) + in->range[1] * u;
}

static double place_of(const tc_resolve_input *in, double s)
{
    if (in->log)
        return (log(s) - log(in->range[0])) / (log(in->range[1]) - log(in->range[0]));
    return tc_place(s, in->range[0], in->range[1]);
}

/* Fraction of the way of s between a and b, straight or by logarithms. */
static double fraction(const job *j, double s, double a, double b, bool logarithmic)
{
    if (!(b > a))
        return 0;
    const double t =
        logarithmic && j->in->log ? (log(s) - log(a)) / (log(b) - log(a)) : tc_place(s, a, b);
    return fmax(0, fmin(1, t));
}

/* Scalar at fraction t between two points. */
static double between(const job *j, double t, double a, double b, bool logarithmic)
{
    return logarithmic && j->in->log ? exp(log(a) + t * (log(b) - log(a))) : a + t * (b - a);
}

/* Index of the last of s [n] (ascending) at or below x, -1: none. */
static long find(const double *s, size_t n, double x)
{
    size_t lo = 0, hi = n;
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (s[middle] <= x)
            lo = middle + 1;
        else
            hi = middle;
    }
    return (long)lo - 1;
}

/* ------------------------------------------------------------------------------------------------------- values */

/* A step at the midpoint is decided by the stretch, not by rounding at its end. */
static double held(double t, double t_middle, double midpoint, double sharpness)
{
    return sharpness > 0.99 ? (t_middle < midpoint ? 0 : 1) : t;
}

static void color_at(double out[3], const job *j, const place *p, double s)
{
    const long i = p->color, last = (long)j->n_color - 1;
    if (i < 0 || i >= last) {
        memcpy(out, j->color[i < 0 ? 0 : last].rgb, 3 * sizeof *out);
        return;
    }
    const tc_color_point *a = &j->color[i], *b = a + 1;
    double t = fraction(j, s, j->color_s[i], j->color_s[i + 1], true);
    const double t_middle = fraction(j, p->middle, j->color_s[i], j->color_s[i + 1], true);
    t = held(t, t_middle, a->midpoint, a->sharpness);
    tc_color_interpolate(out, j->space, j->in->map->hsv_wrap, a->rgb, b->rgb, t, a->midpoint, a->sharpness);
}

static double opacity_at(const job *j, const place *p, double s)
{
    const tc_resolve_input *in = j->in;
    if (in->kind == TC_OPACITY_GEOM || in->kind == TC_OPACITY_SIGMOID) {
        const double u = s <= in->range[0] ? 0 : s >= in->range[1] ? 1 : place_of(in, s);
        return in->kind == TC_OPACITY_GEOM ? top * pow(1e-6 / 255, 1 - u) : top / (1 + exp(-20 * (u - 0.5)));
    }
    const long i = p->opacity, last = (long)in->n_opacity - 1;
    if (last < 0)
        return 0;
    if (i < 0 || i >= last)
        return in->opacity[i < 0 ? 0 : last].a;
    const tc_opacity_point *a = &in->opacity[i], *b = a + 1;
    const bool relative = in->kind == TC_OPACITY_POINTS;
    const double t = fraction(j, s, j->opacity_s[i], j->opacity_s[i + 1], relative);
    const double t_middle = fraction(j, p->middle, j->opacity_s[i], j->opacity_s[i + 1], relative);
    return tc_curve_interpolate(a->a, b->a, held(t, t_middle, a->midpoint, a->sharpness), a->midpoint, a->sharpness);
}

static tc_knot knot_at(const job *j, const place *p, double s)
{
    double rgb[3];
    color_at(rgb, j, p, s);
    return (tc_knot){.s = s, .r = rgb[0], .g = rgb[1], .b = rgb[2], .a = opacity_at(j, p, s)};
}

/* -------------------------------------------------------------------------------------------------------- knots */

static bool same(const tc_knot *a, const tc_knot *b)
{
    const double bit = 1e-12;
    return a->s == b->s && fabs(a->r - b->r) < bit && fabs(a->g - b->g) < bit && fabs(a->b - b->b) < bit &&
           fabs(a->a - b->a) < bit * fmax(1, fabs(a->a));
}

static void put(knots *out, const tc_knot *knot)
{
    if (out->failed || (out->n > 0 && same(&out->knot[out->n - 1], knot)))
        return;
    if (out->n == out->capacity) {
        const size_t capacity = out->capacity ? 2 * out->capacity : 64;
        tc_knot *grown = tc_realloc(out->knot, capacity, sizeof *grown);
        if (!grown) {
            out->failed = true;
            return;
        }
        out->knot = grown;
        out->capacity = capacity;
    }
    out->knot[out->n++] = *knot;
}

/* How far the line from a to b is from the curve between, as a share of what it may be. */
static double bend(const job *j, const place *p, const tc_knot *a, const tc_knot *b)
{
    double most = 0;
    for (int i = 1; i < 8; i++) {
        const double s = a->s + (b->s - a->s) * i / 8, t = i / 8.0;
        if (s <= a->s || s >= b->s)
            continue;
        const tc_knot k = knot_at(j, p, s);
        most = fmax(most, fabs(a->r + t * (b->r - a->r) - k.r));
        most = fmax(most, fabs(a->g + t * (b->g - a->g) - k.g));
        most = fmax(most, fabs(a->b + t * (b->b - a->b) - k.b));
        most = fmax(most, fabs(a->a + t * (b->a - a->a) - k.a) / j->scale);
    }
    return most / tolerance;
}

/* Knots strictly inside (a, b), as few as lines as long as they may be need. A line of length h is off by h^2 times the
 * curvature, or by h where the curve has a corner, or ever by the same at a jump, after all: there lengths are halved,
 * until doubles end. */
static void divide(job *j, const place *p, const tc_knot *a, const tc_knot *b)
{
    enum { TRIES = 4 }; /* for a longer line than one that fits */
    tc_knot from = *a;
    double length = b->s - a->s;
    while (from.s < b->s && !j->out.failed) {
        const double left = b->s - from.s;
        double fits = 0, off = INFINITY; /* lengths that are not too long, and too long */
        tc_knot end = *b;
        for (int tries = 0; fits == 0 || tries < TRIES; tries++) {
            length = fmin(length, left);
            const tc_knot to = length < left ? knot_at(j, p, from.s + length) : *b;
            const double share = to.s > from.s ? bend(j, p, &from, &to) : 0;
            if (share <= 1) {
                fits = length;
                end = to.s > from.s ? to : knot_at(j, p, nextafter(from.s, b->s));
            } else {
                off = length;
            }
            length *= tries > TRIES && fits == 0 ? 0.5 : fmax(0.5, fmin(2, 0.99 / sqrt(fmax(share, 1e-9))));
            if (fits == left || length < 1.03 * fits)
                break;
            if (length >= off)
                length = 0.5 * (fits + off);
        }
        if (end.s >= b->s)
            return;
        put(&j->out, &end);
        from = end;
        length = fits;
    }
}

static int compare(const void *a, const void *b)
{
    double x, y;
    memcpy(&x, a, sizeof x);
    memcpy(&y, b, sizeof y);
    return (x > y) - (x < y);
}

/* All s where a corner may be, ascending, each once. */
static size_t collect_cuts(double *cut, const job *j)
{
    const tc_resolve_input *in = j->in;
    size_t n = 0;
    for (size_t i = 0; i < j->n_color; i++) {
        cut[n++] = j->color_s[i];
        const tc_color_point *p = &j->color[i];
        if (i + 1 < j->n_color && (p->midpoint != 0.5 || p->sharpness > 0 || j->space == TC_SPACE_DIVERGING))
            cut[n++] = between(j, p->midpoint, j->color_s[i], j->color_s[i + 1], true);
    }
    for (size_t i = 0; i < in->n_opacity; i++) {
        cut[n++] = j->opacity_s[i];
        const tc_opacity_point *p = &in->opacity[i];
        if (i + 1 < in->n_opacity && (p->midpoint != 0.5 || p->sharpness > 0))
            cut[n++] = between(j, p->midpoint, j->opacity_s[i], j->opacity_s[i + 1], in->kind == TC_OPACITY_POINTS);
    }
    cut[n++] = in->range[0];
    cut[n++] = in->range[1];
    if (in->kind == TC_OPACITY_SIGMOID)
        cut[n++] = scalar_of(in, 0.5);
    qsort(cut, n, sizeof *cut, compare);
    size_t kept = 1;
    for (size_t i = 1; i < n; i++)
        if (cut[i] != cut[kept - 1])
            cut[kept++] = cut[i];
    return kept;
}

static void walk(job *j, const double *cut, size_t n)
{
    place p = {.color = -1, .opacity = -1, .middle = cut[0]};
    tc_knot end = knot_at(j, &p, cut[0]);
    put(&j->out, &end);
    for (size_t i = 0; i + 1 < n; i++) {
        const double middle = cut[i] + 0.5 * (cut[i + 1] - cut[i]);
        p = (place){.color = find(j->color_s, j->n_color, cut[i]),
                    .opacity = find(j->opacity_s, j->in->n_opacity, cut[i]),
                    .middle = middle};
        const tc_knot start = knot_at(j, &p, cut[i]);
        end = knot_at(j, &p, cut[i + 1]);
        put(&j->out, &start);
        divide(j, &p, &start, &end);
        put(&j->out, &end);
    }
    p = (place){.color = (long)j->n_color - 1, .opacity = (long)j->in->n_opacity - 1, .middle = cut[n - 1]};
    end = knot_at(j, &p, cut[n - 1]);
    put(&j->out, &end);
}

/* ------------------------------------------------------------------------------------------------------ the whole */

/* Points of the ways over the CIEDE2000 grid, to be joined by straight lines. */
static tc_status expand_paths(tc_color_point **out, size_t *n, const tc_preset *map, tc_error *err)
{
    *out = NULL;
    *n = 0;
    for (size_t i = 0; i + 1 < map->n_color || i == 0; i++) {
        const tc_color_point *a = &map->color[i], *b = i + 1 < map->n_color ? a + 1 : a;
        tc_color_point *path;
        size_t count;
        const tc_status status = tc_color_path(&path, &count, a->rgb, b->rgb, err);
        tc_color_point *grown = status == TC_OK ? tc_realloc(*out, *n + count + 1, sizeof *grown) : NULL;
        if (!grown) {
            if (status == TC_OK)
                free(path);
            free(*out);
            *out = NULL;
            return status != TC_OK ? status : tc_fail_memory(err, "colour paths", *n + count, sizeof *grown);
        }
        *out = grown;
        for (size_t k = 0; k < count; k++) {
            grown[*n] = path[k];
            grown[(*n)++].x = a->x + path[k].x * (b->x - a->x);
        }
        if (count == 1) { /* both ends are one colour of the grid */
            grown[*n] = grown[*n - 1];
            grown[(*n)++].x = b->x;
        }
        free(path);
    }
    return TC_OK;
}

static void place_points(double *s, const tc_resolve_input *in, const double *x, size_t stride, size_t n)
{
    const double first = n ? x[0] : 0, last = n ? x[stride * (n - 1)] : 0;
    for (size_t i = 0; i < n; i++) {
        const double at = x[stride * i];
        s[i] = scalar_of(in, tc_place(at, first, last));
    }
}

tc_status tc_resolve(tc_knot **knot, size_t *n, const tc_resolve_input *input, tc_error *err)
{
    *knot = NULL;
    *n = 0;
    const tc_preset *map = input->map;
    job j = {.in = input, .color = map->color, .n_color = map->n_color, .space = map->space, .scale = 1};
    tc_color_point *path = NULL;
    if (map->space == TC_SPACE_CIEDE2000) {
        const tc_status status = expand_paths(&path, &j.n_color, map, err);
        if (status != TC_OK)
            return status;
        j.color = path;
        j.space = TC_SPACE_RGB;
    }
    const size_t cuts = 2 * (j.n_color + input->n_opacity) + 3;
    j.color_s = tc_alloc(j.n_color, sizeof *j.color_s);
    j.opacity_s = tc_alloc(input->n_opacity, sizeof *j.opacity_s);
    double *cut = tc_alloc(cuts, sizeof *cut);
    tc_status status = TC_OK;
    if (!j.color_s || !j.opacity_s || !cut) {
        status = tc_fail_memory(err, "a transfer function", cuts, 2 * sizeof *cut);
        goto done;
    }
    place_points(j.color_s, input, &j.color[0].x, sizeof *j.color / sizeof(double), j.n_color);
    for (size_t i = 0; i < input->n_opacity; i++) {
        j.opacity_s[i] = input->opacity[i].x;
        j.scale = fmax(j.scale, input->opacity[i].a);
    }
    if (input->kind == TC_OPACITY_POINTS && input->n_opacity > 0)
        place_points(j.opacity_s, input, &input->opacity[0].x, sizeof *input->opacity / sizeof(double),
                     input->n_opacity);
    walk(&j, cut, collect_cuts(cut, &j));
    if (j.out.failed) {
        status = tc_fail_memory(err, "a transfer function's knots", j.out.n, 2 * sizeof *j.out.knot);
        goto done;
    }
    *knot = j.out.knot;
    *n = j.out.n;
    j.out.knot = NULL;
done:
    free(j.out.knot);
    free(j.color_s);
    free(j.opacity_s);
    free(cut);
    free(path);
    return status;
}
