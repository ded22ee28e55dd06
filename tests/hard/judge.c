/* judge.c: brute force: one ray against every cell (docs/architecture.md, "Stepper").
 *
 * All vertices are projected; of each cell the six signs of the crosses of its projected vertices tell which of its
 * faces hold the ray. Signs are exact: products of floats are exact in double, products of doubles are compared with
 * what rounding hid (Dekker 1971). A zero is decided as if the ray stood at (e, e^2) beside its place (Edelsbrunner and
 * Mücke 1990), coincident points by their ids.
 *
 * To be compiled without contraction (-ffp-contract=off): the float frame must come out as in gpu/shaders/ray.glsl. */
#include "judge.h"

#include "core/memory.h"
#include "core/vec.h"
#include "mesh/adjacency.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WORKERS = 256 };
/* Depths this near to a clipping plane's, in half diagonals, may be on either side of it in float. */
static const double DOUBT = 1e-5;

/* The part of the line in one cell. */
typedef struct span {
    double z0, z1;
} span;

typedef struct found {
    uint32_t cell;
    uint8_t mask, outward; /* faces that hold the ray; of them those wound counter-clockwise seen from outside */
    bool seen;
} found;

typedef struct scratch {
    double (*p)[3]; /* [n_vertex] x, y across the ray, z along it */
    int32_t *mark;  /* [n_cell] place in found, -1 */
    found *found;
    span *span;
    size_t n, capacity;
} scratch;

struct hard_judge {
    const tc_mesh *mesh;
    size_t n_cell, blind;
    float *vertex; /* [n_vertex][4] as packed */
    double center[3], scale;
    scratch worker[WORKERS];
};

tc_status hard_judge_create(hard_judge **out, const tc_mesh *mesh, tc_error *err)
{
    *out = NULL;
    tc_pack pack;
    tc_status status = tc_pack_build(&pack, mesh, 0, err);
    if (status != TC_OK)
        return status;
    hard_judge *j = tc_calloc(1, sizeof *j);
    if (j) {
        j->mesh = mesh;
        j->n_cell = mesh->n_tet + mesh->n_imaginary;
        j->blind = SIZE_MAX;
        j->vertex = pack.vertex;
        pack.vertex = NULL;
        tc_vec_copy(j->center, pack.center);
        j->scale = pack.scale;
    }
    tc_pack_finish(&pack);
    *out = j;
    return j ? TC_OK : tc_fail_memory(err, "the judge", 1, sizeof *j);
}

void hard_judge_destroy(hard_judge **judge)
{
    if (!*judge)
        return;
    for (int i = 0; i < WORKERS; i++) {
        scratch *s = &(*judge)->worker[i];
        free(s->p);
        free(s->mark);
        free(s->found);
        free(s->span);
    }
    free((*judge)->vertex);
    free(*judge);
    *judge = NULL;
}

void hard_judge_blind(hard_judge *judge, size_t cell)
{
    judge->blind = cell;
}

void hard_judge_frame(tc_frame *out, const hard_judge *judge, const tc_rays *rays)
{
    tc_frame_build(out, rays, judge->center, judge->scale);
}

static scratch *open_scratch(hard_judge *j, int worker)
{
    scratch *s = &j->worker[worker];
    s->n = 0;
    if (!s->p)
        s->p = tc_alloc(j->mesh->n_vertex, sizeof *s->p);
    if (!s->mark) {
        s->mark = tc_alloc(j->n_cell, sizeof *s->mark);
        if (s->mark)
            memset(s->mark, 0xff, j->n_cell * sizeof *s->mark);
    }
    return s->p && s->mark ? s : NULL;
}

/* ------------------------------------------------------------------------------------------------------ signs */

/* Sign of the cross of two projected vertices, i's id below j's; never 0. */
static int sign_below(const double *a, const double *b)
{
    double m = a[0] * b[1], n = a[1] * b[0];
    if (m != n)
        return m > n ? 1 : -1; /* rounding is monotone */
    double hidden = fma(a[0], b[1], -m) - fma(a[1], b[0], -n);
    if (hidden != 0)
        return hidden > 0 ? 1 : -1;
    if (a[1] != b[1])
        return a[1] > b[1] ? 1 : -1;
    if (a[0] != b[0])
        return b[0] > a[0] ? 1 : -1;
    return 1;
}

static int sign_of(const scratch *s, int32_t i, int32_t j)
{
    return i < j ? sign_below(s->p[i], s->p[j]) : -sign_below(s->p[j], s->p[i]);
}

/* No face can hold the ray: all four vertices lie on one side of it. */
static bool apart(const scratch *s, const int32_t *tet)
{
    const double *a = s->p[tet[0]], *b = s->p[tet[1]], *c = s->p[tet[2]], *d = s->p[tet[3]];
    for (int k = 0; k < 2; k++)
        if ((a[k] > 0 && b[k] > 0 && c[k] > 0 && d[k] > 0) || (a[k] < 0 && b[k] < 0 && c[k] < 0 && d[k] < 0))
            return true;
    return false;
}

/* The faces of a cell that hold the ray, and which of them are wound counter-clockwise around it. */
static found judge_cell(const scratch *s, const int32_t *tet)
{
    int sign[4][4];
    for (int i = 0; i < 4; i++)
        for (int j = i + 1; j < 4; j++) {
            sign[i][j] = sign_of(s, tet[i], tet[j]);
            sign[j][i] = -sign[i][j];
        }
    found f = {0};
    for (int face = 0; face < 4; face++) {
        const uint8_t *v = tc_tet_face[face];
        int ab = sign[v[0]][v[1]], bc = sign[v[1]][v[2]], ca = sign[v[2]][v[0]];
        if (ab != bc || bc != ca)
            continue;
        f.mask |= (uint8_t)(1 << face);
        if (ab > 0)
            f.outward |= (uint8_t)(1 << face);
    }
    return f;
}

/* Depth at which the ray meets a face: a convex combination of its corners'. */
static double depth_at(const scratch *s, const int32_t *tet, int face)
{
    const uint8_t *v = tc_tet_face[face];
    const double *a = s->p[tet[v[0]]], *b = s->p[tet[v[1]]], *c = s->p[tet[v[2]]];
    const double w[3] = {fabs(b[0] * c[1] - b[1] * c[0]), fabs(c[0] * a[1] - c[1] * a[0]),
                         fabs(a[0] * b[1] - a[1] * b[0])};
    double sum = w[0] + w[1] + w[2];
    double z = sum > 0 ? (w[0] * a[2] + w[1] * b[2] + w[2] * c[2]) / sum : (a[2] + b[2] + c[2]) / 3;
    return fmin(fmax(z, fmin(a[2], fmin(b[2], c[2]))), fmax(a[2], fmax(b[2], c[2])));
}

/* All cells that the ray passes; counts the broken ones. */
static tc_status find_cells(scratch *s, uint32_t *broken, const hard_judge *j)
{
    *broken = 0;
    for (size_t t = 0; t < j->n_cell; t++) {
        const int32_t *tet = j->mesh->tet + 4 * t;
        if (apart(s, tet) || t == j->blind)
            continue;
        found f = judge_cell(s, tet);
        int n = __builtin_popcount(f.mask);
        if (n == 0)
            continue;
        if (n != 2 || __builtin_popcount(f.outward) != 1) {
            ++*broken;
            continue;
        }
        if (s->n == s->capacity) {
            size_t capacity = s->capacity ? 2 * s->capacity : 1024;
            found *more = tc_realloc(s->found, capacity, sizeof *more);
            s->found = more ? more : s->found;
            span *spans = tc_realloc(s->span, capacity, sizeof *spans);
            s->span = spans ? spans : s->span;
            if (!more || !spans)
                return TC_E_MEMORY;
            s->capacity = capacity;
        }
        f.cell = (uint32_t)t;
        s->found[s->n++] = f;
    }
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------------------- walk */

/* The ray of a pixel in float, as the shaders make it. */
typedef struct float_ray {
    float o[3], u[3], v[3], d[3], near, far; /* near, far: depths of the planes that clip */
} float_ray;

static void divide(float *a, float by)
{
    for (int k = 0; k < 3; k++)
        a[k] /= by;
}

static float length3(const float *a)
{
    return sqrtf(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

static void cross3(float *out, const float *a, const float *b)
{
    for (int k = 0; k < 3; k++) {
        int l = (k + 1) % 3, m = (k + 2) % 3;
        out[k] = a[l] * b[m] - a[m] * b[l];
    }
}

static float_ray make_ray(const tc_frame *f, double X, double Y)
{
    float_ray r;
    float up[3];
    for (int k = 0; k < 3; k++) {
        r.o[k] = (float)(f->point[k] + X * f->point_dx[k] + Y * f->point_dy[k]);
        r.d[k] = (float)(f->direction[k] + X * f->direction_dx[k] + Y * f->direction_dy[k]);
        up[k] = (float)f->up[k];
    }
    float length_d = length3(r.d);
    divide(r.d, length_d);
    cross3(r.u, r.d, up);
    divide(r.u, length3(r.u));
    cross3(r.v, r.u, r.d);
    r.near = (float)f->near_t * length_d;
    r.far = (float)f->far_t * length_d;
    return r;
}

static void project_floats(scratch *s, const hard_judge *j, const float_ray *ray)
{
    for (size_t i = 0; i < j->mesh->n_vertex; i++) {
        const float *x = j->vertex + 4 * i;
        float r[3] = {x[0] - ray->o[0], x[1] - ray->o[1], x[2] - ray->o[2]};
        s->p[i][0] = r[0] * ray->u[0] + r[1] * ray->u[1] + r[2] * ray->u[2];
        s->p[i][1] = r[0] * ray->v[0] + r[1] * ray->v[1] + r[2] * ray->v[2];
        s->p[i][2] = r[0] * ray->d[0] + r[1] * ray->d[1] + r[2] * ray->d[2];
    }
}

static int other_face(uint8_t mask, int face)
{
    return __builtin_ctz(mask & ~(1u << face));
}

/* The part of the line that is seen. */
typedef struct seen {
    bool ahead;      /* entries before `from` are none; a walk ends at `to` */
    double from, to; /* segments are cut there */
} seen;

static seen seen_of(const tc_frame *f, const float_ray *ray)
{
    return (seen){f->ahead, f->clip_near || f->ahead ? (double)ray->near : -INFINITY,
                  f->clip_far ? (double)ray->far : INFINITY};
}

/* Follows the path that begins at `face` of found cell k; true if the picture shows it. */
static bool follow(hard_walk *out, scratch *s, const hard_judge *j, const seen *range, size_t k, int face)
{
    const tc_mesh *m = j->mesh;
    double entry = depth_at(s, m->tet + 4 * (size_t)s->found[k].cell, face), z = entry;
    bool shown = !(range->ahead && entry < range->from) && entry < range->to;
    out->doubt += (range->ahead && fabs(entry - range->from) < DOUBT) || fabs(entry - range->to) < DOUBT;
    for (bool walking = shown;;) {
        found *f = &s->found[k];
        size_t cell = f->cell;
        f->seen = true;
        int exit = other_face(f->mask, face);
        double next = fmax(z, depth_at(s, m->tet + 4 * cell, exit));
        if (walking) {
            double length = fmax(fmin(next, range->to) - fmax(z, range->from), 0);
            out->cells++;
            out->hash += tc_audit_hash((uint32_t)cell);
            out->length += length;
            out->length_real += cell < m->n_tet ? length : 0;
            out->doubt += fabs(next - range->to) < DOUBT;
            walking = next <= range->to;
        } else {
            out->unseen++;
        }
        z = next;
        int32_t neighbour = m->neighbour[4 * cell + (size_t)exit];
        if (neighbour < 0)
            return shown;
        if (s->mark[neighbour] < 0 || s->found[s->mark[neighbour]].seen) {
            out->broken++; /* the path ends inside, or meets itself */
            return shown;
        }
        k = (size_t)s->mark[neighbour];
        for (face = 0; face < 4; face++)
            if (m->neighbour[4 * (size_t)neighbour + (size_t)face] == (int32_t)cell && (s->found[k].mask >> face & 1))
                break;
        if (face == 4) {
            out->broken++;
            return shown;
        }
    }
}

tc_status hard_judge_walk(hard_walk *out, hard_judge *judge, const tc_frame *frame, double X, double Y, int worker)
{
    memset(out, 0, sizeof *out);
    scratch *s = open_scratch(judge, worker);
    if (!s)
        return TC_E_MEMORY;
    if (frame->hidden)
        return TC_OK;
    const tc_mesh *m = judge->mesh;
    float_ray ray = make_ray(frame, X, Y);
    seen range = seen_of(frame, &ray);
    project_floats(s, judge, &ray);
    tc_status status = find_cells(s, &out->broken, judge);
    if (status != TC_OK)
        return status;
    for (size_t i = 0; i < s->n; i++)
        s->mark[s->found[i].cell] = (int32_t)i;
    for (size_t i = 0; i < s->n; i++)
        for (int face = 0; face < 4; face++)
            if ((s->found[i].outward >> face & 1) && m->neighbour[4 * (size_t)s->found[i].cell + (size_t)face] < 0)
                out->layers += follow(out, s, judge, &range, i, face);
    for (size_t i = 0; i < s->n; i++) {
        out->cycle += !s->found[i].seen;
        s->mark[s->found[i].cell] = -1;
    }
    out->length /= judge->scale;
    out->length_real /= judge->scale;
    return TC_OK;
}

/* ------------------------------------------------------------------------------------------------------ chord */

static int by_entry(const void *a, const void *b)
{
    double x = ((const span *)a)->z0, y = ((const span *)b)->z0;
    return x < y ? -1 : x > y;
}

/* Length of the union of n spans, which get sorted. */
static double union_of(span *s, size_t n)
{
    double length = 0, to = -INFINITY;
    if (n > 0)
        qsort(s, n, sizeof *s, by_entry);
    for (size_t i = 0; i < n; i++) {
        double from = fmax(s[i].z0, to);
        if (s[i].z1 > from) {
            length += s[i].z1 - from;
            to = s[i].z1;
        }
    }
    return length;
}

tc_status hard_judge_chord(hard_chord *out, hard_judge *judge, const double origin[3], const double direction[3],
                           double t_min, double t_max, int worker)
{
    memset(out, 0, sizeof *out);
    scratch *s = open_scratch(judge, worker);
    if (!s)
        return TC_E_MEMORY;
    const tc_mesh *m = judge->mesh;
    /* The line's point nearest the centre, and an orthonormal frame. */
    double base[3], u[3], v[3], axis[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++)
        base[k] = (origin[k] - judge->center[k]) * judge->scale;
    double to_base = -tc_vec_dot(base, direction);
    tc_vec_mul_add(base, base, to_base, direction);
    axis[fabs(direction[0]) < 0.6 ? 0 : 1] = 1;
    tc_vec_cross(u, direction, axis);
    tc_vec_normalize(u);
    tc_vec_cross(v, u, direction);
    for (size_t i = 0; i < m->n_vertex; i++) {
        double r[3];
        for (int k = 0; k < 3; k++)
            r[k] = (m->vertex[3 * i + (size_t)k] - judge->center[k]) * judge->scale - base[k];
        s->p[i][0] = tc_vec_dot(r, u);
        s->p[i][1] = tc_vec_dot(r, v);
        s->p[i][2] = tc_vec_dot(r, direction);
    }
    uint32_t broken;
    tc_status status = find_cells(s, &broken, judge);
    if (status != TC_OK)
        return status;
    double lo = t_min * judge->scale - to_base, hi = t_max * judge->scale - to_base;
    double first = INFINITY, last = -INFINITY;
    size_t n_span = 0;
    for (size_t i = 0; i < s->n; i++) {
        size_t cell = s->found[i].cell;
        const int32_t *tet = m->tet + 4 * cell;
        int face = __builtin_ctz(s->found[i].mask);
        double a = depth_at(s, tet, face), b = depth_at(s, tet, other_face(s->found[i].mask, face));
        double z0 = fmax(fmin(a, b), lo), z1 = fmin(fmax(a, b), hi);
        if (!(z1 > z0))
            continue;
        first = fmin(first, z0);
        last = fmax(last, z1);
        out->all += z1 - z0;
        if (cell < m->n_tet) {
            out->real += z1 - z0;
            s->span[n_span++] = (span){z0, z1};
        }
    }
    out->covered = union_of(s->span, n_span) / judge->scale;
    out->hull = last > first ? (last - first) / judge->scale : 0;
    out->all /= judge->scale;
    out->real /= judge->scale;
    return TC_OK;
}
