/* invariants.c: renders a case and judges it by what must hold of every picture. */
#include "invariants.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "tests/common/sane.h"
#include "tests/common/shift.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void hard_fail(hard_result *r, const char *format, ...)
{
    size_t used = strlen(r->failure);
    va_list arguments;
    if (used > 0 && used + 3 < sizeof r->failure)
        used += (size_t)snprintf(r->failure + used, sizeof r->failure - used, "; ");
    va_start(arguments, format);
    vsnprintf(r->failure + used, sizeof r->failure - used, format, arguments);
    va_end(arguments);
}

void hard_picture_finish(hard_picture *p)
{
    tc_image_destroy(&p->image);
    free(p->audit);
    memset(p, 0, sizeof *p);
}

/* ------------------------------------------------------------------------------------------------ one ray by force */

typedef struct ray {
    double X, Y, origin[3], direction[3], range[2];
} ray;

static ray ray_of(const tc_rays *rays, size_t pixel)
{
    ray r = {.X = (double)(pixel % (size_t)rays->width) + 0.5,
             .Y = rays->height - (double)(pixel / (size_t)rays->width) - 0.5};
    tc_rays_pixel(r.origin, r.direction, rays, r.X, r.Y);
    tc_rays_range(r.range, rays, r.X, r.Y);
    return r;
}

/* Of RAY_SHIFT. */
#define NEAR_SIDE 0x1p-6

typedef struct probe {
    size_t pixel;
    hard_walk walk;
    double all, real; /* errors of the walk's lengths, in diagonals; how far they lie outside of those beside the ray */
    double walk_real; /* the same against exact arithmetic on the floats that the walk sees */
    bool thin;        /* its true length is not asked for */
    bool wrong, jumps, failed;
} probe;

typedef struct force {
    const hard_mesh *mesh;
    const hard_picture *picture;
    tc_frame frame;
    bool exact;
    probe *probe;
} force;

/* The ray's true lengths in the mesh, as the walk sums them. */
static tc_status true_lengths(double *all, double *real, const hard_mesh *m, const ray *r, int worker)
{
    hard_chord chord;
    tc_status status = hard_judge_chord(&chord, m->judge, r->origin, r->direction, r->range[0], r->range[1], worker);
    *real = chord.real;
    *all = chord.all;
    if (m->report.convex || m->report.n_imaginary > 0) /* nothing is left out of the hull, and nothing is there twice */
        *all = chord.hull;
    return status;
}

static void widen(double range[2], double value)
{
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

static double outside(double value, const double range[2])
{
    return fmax(fmax(range[0] - value, value - range[1]), 0);
}

/* A ray whose length jumps beside it must have one between those of its sides; in many thin cells these differ from
 * their limits by more than the bound, so nearer sides are asked as well. */
static void judge_ray(const force *f, probe *p, int worker)
{
    const hard_mesh *m = f->mesh;
    const ray r = ray_of(&f->picture->rays, p->pixel);
    const tc_audit_ray *audit = &f->picture->audit[p->pixel];
    double all, real;
    p->failed = hard_judge_walk(&p->walk, m->judge, &f->frame, r.X, r.Y, worker) != TC_OK ||
                true_lengths(&all, &real, m, &r, worker) != TC_OK;
    if (p->failed)
        return;
    p->wrong = f->exact && p->walk.doubt == 0 && (p->walk.cells != audit->cells || p->walk.hash != audit->hash);
    if (f->exact && p->walk.doubt == 0 && !p->wrong)
        p->walk_real = fabs(audit->length_real - p->walk.length_real) / m->diagonal;
    if (p->thin)
        return;
    p->all = fabs(audit->length - all) / m->diagonal;
    p->real = fabs(audit->length_real - real) / m->diagonal;
    if (fmax(p->all, p->real) <= HARD_LENGTH)
        return;
    double most_all[2] = {all, all}, most_real[2] = {real, real};
    for (int k = 0; k < 2 * RAY_SIDES && !p->failed; k++) {
        ray beside = r;
        if (k == RAY_SIDES)
            p->jumps = fmax(most_all[1] - most_all[0], most_real[1] - most_real[0]) > 0.5 * HARD_LENGTH * m->diagonal;
        if (k >= RAY_SIDES && !p->jumps)
            break;
        ray_shift(beside.origin, r.origin, r.direction, (k < RAY_SIDES ? 1 : NEAR_SIDE) * RAY_SHIFT * m->diagonal,
                  k % RAY_SIDES);
        p->failed = true_lengths(&all, &real, m, &beside, worker) != TC_OK;
        widen(most_all, all);
        widen(most_real, real);
    }
    if (p->jumps) {
        p->all = outside(audit->length, most_all) / m->diagonal;
        p->real = outside(audit->length_real, most_real) / m->diagonal;
    }
}

static void judge_range(void *context, size_t begin, size_t end, int worker)
{
    force *f = context;
    for (size_t i = begin; i < end; i++)
        judge_ray(f, &f->probe[i], worker);
}

/* One of n pixels, `step` apart from `first` on; with `hit`, one whose ray meets the mesh, if such can be found. */
static size_t choose(const hard_picture *p, uint64_t *state, size_t first, size_t step, size_t n, bool hit)
{
    size_t pixel = first;
    for (int i = 0; i < (hit ? 200 : 1); i++) {
        *state = *state * 6364136223846793005u + 1442695040888963407u;
        pixel = first + step * (size_t)((*state >> 20) % n);
        if (p->audit[pixel].cells > 0)
            break;
    }
    return pixel;
}

enum { LINE = 8, MIDDLE_MOST = 1 + 2 * LINE };

/* What most views are made for: the middle pixel, and some of the middle row and column (none of one pixel's). out
 * [MIDDLE_MOST]; gives their number. */
static size_t choose_middle(probe *out, const hard_picture *p, uint64_t *state)
{
    size_t width = (size_t)p->image->width, height = (size_t)p->image->height, n = 0;
    size_t row = height / 2 * width, column = width / 2;
    out[n++].pixel = row + column;
    for (int i = 0; i < LINE && width > 1; i++)
        out[n++].pixel = choose(p, state, row, 1, width, true);
    for (int i = 0; i < LINE && height > 1; i++)
        out[n++].pixel = choose(p, state, column, width, height, true);
    return n;
}

/* Invariants 1 and 2: of random pixels three in four meet the mesh if they can. The middle ones lie in vertices, edges
 * and faces on purpose, where true lengths jump: they are judged by the walk's cells and its own length alone. */
static void judge_by_force(hard_result *r, const hard_bench *bench, const hard_mesh *mesh, const hard_view *view,
                           const hard_picture *picture)
{
    size_t n = bench->judged, pixels = (size_t)picture->image->width * (size_t)picture->image->height;
    force f = {.mesh = mesh, .picture = picture, .exact = bench->exact};
    n = n < pixels ? n : pixels;
    f.probe = tc_calloc(n + MIDDLE_MOST, sizeof *f.probe);
    if (!f.probe) {
        hard_fail(r, "out of memory");
        return;
    }
    hard_judge_frame(&f.frame, mesh->judge, &picture->rays);
    uint64_t state = 12345;
    for (size_t i = 0; i < n; i++) {
        f.probe[i].pixel = choose(picture, &state, 0, 1, pixels, i % 4 != 0);
        f.probe[i].thin = view->grazing;
    }
    for (size_t n_middle = choose_middle(f.probe + n, picture, &state); n_middle > 0; n_middle--)
        f.probe[n++].thin = true;
    tc_parallel_for(n, 4, 0, judge_range, &f);
    const probe *wrong = NULL;
    size_t broken = 0, failed = 0;
    for (size_t i = 0; i < n; i++) {
        const probe *p = &f.probe[i];
        failed += p->failed;
        r->judged++;
        r->lengths += !p->thin;
        r->doubtful += p->walk.doubt > 0;
        r->cycles += p->walk.cycle > 0;
        broken += p->walk.broken > 0;
        r->wrong += p->wrong;
        wrong = p->wrong ? p : wrong;
        r->jumps += p->jumps;
        r->walk_error = fmax(r->walk_error, p->walk_real);
        r->length_error = fmax(r->length_error, p->all);
        r->real_error = fmax(r->real_error, p->real);
    }
    size_t width = (size_t)picture->image->width;
    if (failed)
        hard_fail(r, "out of memory");
    if (wrong)
        hard_fail(r,
                  "%zu of %zu rays do not visit the cells of brute force; at pixel %zu, %zu it visits %u instead of %u",
                  r->wrong, n, wrong->pixel % width, wrong->pixel / width, picture->audit[wrong->pixel].cells,
                  wrong->walk.cells);
    if (broken)
        hard_fail(r, "brute force finds other than 0 or 2 faces on %zu rays", broken);
    if (!(r->length_error <= HARD_LENGTH))
        hard_fail(r, "a ray's length is wrong by %.2e diagonals", r->length_error);
    if (!(r->walk_error <= HARD_WALK))
        hard_fail(r, "a ray's length in real cells is %.2e diagonals from that of exact weights", r->walk_error);
    if (!(r->real_error <= HARD_LENGTH))
        hard_fail(r, "a ray's length in real cells is wrong by %.2e diagonals", r->real_error);
    free(f.probe);
}

/* --------------------------------------------------------------------------------------------- closed form, reference
 */

/* Invariant 3: a tenth of the pixels, 64 at least. */
static void judge_by_chord(hard_result *r, const hard_mesh *mesh, const hard_picture *picture,
                           const hard_function *function, double bound)
{
    size_t n = (size_t)picture->image->width * (size_t)picture->image->height, every = n < 640 ? 1 : n / 640;
    double per_length = function->kappa / mesh->unit;
    for (size_t i = 0; i < n; i += every) {
        const ray at = ray_of(&picture->rays, i);
        double alpha = -expm1(-per_length * mesh->generator->chord(at.origin, at.direction, mesh->n_cells));
        double error = fabs(picture->image->rgba[4 * i + 3] - alpha);
        bool ill = false;
        for (int k = 0; k < RAY_SIDES && error > bound && !ill; k++) {
            double moved[3];
            ray_shift(moved, at.origin, at.direction, RAY_SHIFT * mesh->diagonal, k);
            double there = -expm1(-per_length * mesh->generator->chord(moved, at.direction, mesh->n_cells));
            ill = fabs(there - alpha) > 0.5 * bound;
        }
        r->chords++;
        r->ill_chord += ill;
        if (!ill)
            r->alpha_error = fmax(r->alpha_error, error);
    }
    if (!(r->alpha_error <= bound))
        hard_fail(r, "alpha is wrong by %.2e over an analytic chord", r->alpha_error);
}

/* Invariant 7. */
static void judge_by_reference(hard_result *r, const hard_mesh *mesh, const hard_picture *picture,
                               const hard_function *function, size_t n)
{
    tc_verify_result v;
    tc_error err = {0};
    tc_status status = tc_reference_verify(&v, NULL, picture->image, n, 1, mesh->reference, function->tf, mesh->unit,
                                           &picture->rays, 0, NULL, &err);
    if (status != TC_OK) {
        hard_fail(r, "%s", err.text);
        return;
    }
    r->pixels = v.pixels;
    r->ill_posed = v.ill_posed;
    r->picture_error = v.max_abs_error;
    if (!(v.max_abs_error <= HARD_PICTURE))
        hard_fail(r, "pixel %d, %d is wrong by %.2e", v.worst_x, v.worst_y, v.max_abs_error);
}

/* ------------------------------------------------------------------------------------------------------- the picture
 */

static void write_picture(const hard_bench *bench, const hard_result *r, const tc_image *image)
{
    char path[512];
    tc_error err;
    snprintf(path, sizeof path, "%s/%s, %s, %s%s%s.png", bench->write, r->mesh, r->view, r->function,
             r->relation[0] ? ", " : "", r->relation);
    if (tc_image_write(image, path, NULL, 0, NULL, &err) != TC_OK)
        fprintf(stderr, "%s\n", err.text);
}

/* Renders with the audit and fills out; false where there is no picture to judge. */
static bool make_picture(hard_picture *out, hard_result *r, const hard_bench *bench, tc_renderer *renderer,
                         const hard_mesh *mesh, const hard_view *view, const hard_function *function,
                         tc_integrator integrator)
{
    tc_error err = {0};
    tc_render_stats stats;
    tc_render_options *o = &out->options;
    tc_render_defaults(o);
    o->width = view->width;
    o->height = view->height;
    o->integrator = integrator;
    o->unit_distance = mesh->unit;
    o->opacity_stop = 1; /* walks go to the end: what they did can be told */
    o->audit = bench->gpu;
    tc_status status = tc_rays_from_camera(&out->rays, &view->camera, view->width, view->height, &err);
    if (status == TC_OK)
        status = tc_render(&out->image, &stats, renderer, mesh->mesh, function->tf, &view->camera, o, NULL, &err);
    if (status != TC_OK)
        hard_fail(r, "%s", err.text);
    if (!out->image)
        return false;
    size_t n = (size_t)o->width * (size_t)o->height;
    r->rays = stats.rays > 0 ? stats.rays : 0;
    r->lost = stats.rays_lost;
    r->broken = stats.audit_broken > 0 ? stats.audit_broken : 0;
    if (r->lost != 0)
        hard_fail(r, "%lld rays were lost", (long long)r->lost);
    if (r->broken != 0)
        hard_fail(r, "%lld cells were visited of which other than two faces held the ray", (long long)r->broken);
    if (bench->gpu) {
        out->audit = tc_alloc(n, sizeof *out->audit);
        if (!out->audit || tc_render_audit(out->audit, renderer, &err) != TC_OK) {
            hard_fail(r, "%s", out->audit ? err.text : "out of memory");
            return false;
        }
        return true;
    }
    for (size_t i = 0; i < n; i++)
        r->rays += out->image->rgba[4 * i + 3] > 0; /* the reference counts none: those that absorb something */
    return true;
}

/* Once more with a table of floats: nothing in it is rounded much (invariant 10). */
static void judge_float_table(hard_result *r, const hard_picture *picture, tc_renderer *renderer, const hard_mesh *mesh,
                              const hard_view *view, const hard_function *function)
{
    tc_error err = {0};
    tc_image *image = NULL;
    tc_render_options o = picture->options;
    char what[160];
    o.table_format = TC_TABLE_32F;
    o.table_size[0] = o.table_size[1] = o.table_size[2] = 64;
    o.audit = false;
    if (tc_render(&image, NULL, renderer, mesh->mesh, function->tf, &view->camera, &o, NULL, &err) != TC_OK)
        hard_fail(r, "with a table of floats: %s", err.text);
    else if (!picture_is_sane(what, sizeof what, image, function->tf, NULL, HARD_EXCESS))
        hard_fail(r, "with a table of floats: %s", what);
    tc_image_destroy(&image);
}

void hard_judge_case(hard_picture *out, hard_result *r, const hard_bench *bench, tc_renderer *renderer,
                     const hard_mesh *mesh, const hard_view *view, const hard_function *function,
                     tc_integrator integrator)
{
    hard_picture own;
    hard_picture *p = out ? out : &own;
    memset(p, 0, sizeof *p);
    snprintf(r->mesh, sizeof r->mesh, "%s", mesh->name);
    snprintf(r->view, sizeof r->view, "%s", view->name);
    snprintf(r->function, sizeof r->function, "%s", function->name);
    bool table = integrator == TC_INTEGRATOR_TABLE;
    if (make_picture(p, r, bench, renderer, mesh, view, function, integrator)) {
        char what[160];
        if (!picture_is_sane(what, sizeof what, p->image, function->tf, NULL, table ? HARD_EXCESS_HALF : HARD_EXCESS))
            hard_fail(r, "%s", what);
        if (bench->gpu && table)
            judge_float_table(r, p, renderer, mesh, view, function);
        if (bench->gpu)
            judge_by_force(r, bench, mesh, view, p);
        if (function->kappa >= 0 && view->whole && !view->grazing && mesh->kind == HARD_PLAIN && mesh->generator->chord)
            judge_by_chord(r, mesh, p, function, table ? HARD_ALPHA_TABLE : HARD_ALPHA_INTEGRAL);
        if (!table && !view->grazing)
            judge_by_reference(r, mesh, p, function, bench->verified);
    }
    if (bench->write && p->image)
        write_picture(bench, r, p->image);
    if (!out)
        hard_picture_finish(p);
}

/* ------------------------------------------------------------------------------------------------------- two pictures
 */

void hard_compare(hard_result *r, const hard_picture *a, const hard_picture *b, bool mirrored, const hard_mesh *mesh,
                  const hard_function *function)
{
    size_t width = (size_t)a->image->width, n = width * (size_t)a->image->height, other = 0;
    for (size_t i = 0; i < n; i++) {
        size_t k = mirrored ? i - i % width + (width - 1 - i % width) : i;
        const float *p = a->image->rgba + 4 * i, *q = b->image->rgba + 4 * k;
        double difference = 0;
        for (int c = mirrored ? 3 : 0; c < 4; c++)
            difference = fmax(difference, fabs((double)p[c] - (double)q[c]));
        r->compared++;
        if (difference <= HARD_PICTURE)
            r->difference = fmax(r->difference, difference);
        else
            other++;
    }
    if (other == 0)
        return;
    /* Rays whose colour is not well-posed may differ: both pictures are asked everywhere. A mirrored one is compared in
     * alpha, which the other direction's reference knows. */
    hard_result whole = {.rays = 0};
    judge_by_reference(&whole, mesh, a, function, SIZE_MAX);
    size_t ill = whole.ill_posed;
    if (!mirrored) {
        hard_picture moved = *b;
        moved.rays = a->rays;
        judge_by_reference(&whole, mesh, &moved, function, SIZE_MAX);
        ill += whole.ill_posed;
    }
    r->ill_compared += other;
    if (whole.failure[0] || other > ill)
        hard_fail(r, "%zu pixels differ by more than %.1e, %zu of them ill-posed%s%s", other, HARD_PICTURE, ill,
                  whole.failure[0] ? "; " : "", whole.failure);
}
