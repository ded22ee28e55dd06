/* trace.c: finds every tet that one ray meets, sorts the parts by entry depth and integrates.
 *
 * Each tet is judged alone, from its four vertices. They are projected along the ray; the ray passes a face when the
 * origin lies in the projected triangle. The cross products of the projected points decide it, their signs exact
 * (Dekker 1971 for the product's error), and a zero is decided by moving the ray by (e, e^2), e -> 0 (Edelsbrunner and
 * Mücke 1990), then by vertex id. The ids are taken ascending, so two tets decide about a common face alike and compute
 * the same depth there, to the last bit: no gap, no overlap, whatever vertex, edge or face the ray runs through. A tet
 * then has no or two faces that the ray passes. Depth and scalar are convex combinations of the face's corners: no
 * volume, no plane and no division by a small determinant. */
#include "reference/trace.h"

#include "core/memory.h"
#include "core/vec.h"
#include "reference/look.h"
#include "reference/segment.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A ray through a point of the box comes this near its centre (the boxes are padded). */
static const double REACH = 1.00001;
/* Rounding of a projected coordinate, in the scaled unit; depths less certain than DOUBT move the ray by ASIDE. */
static const double ROUNDING = 4e-16, DOUBT = 1e-8, ASIDE = 0x1p-40;

void tc_line_init(tc_line *out, const tc_reference *reference, const double origin[3], const double direction[3],
                  const double range[2])
{
    double o[3];
    for (int i = 0; i < 3; i++)
        o[i] = (origin[i] - reference->center[i]) * reference->scale;
    tc_vec_copy(out->d, direction);
    tc_vec_normalize(out->d);
    double t = -tc_vec_dot(o, out->d);
    tc_vec_mul_add(out->base, o, t, out->d);
    out->start = t;
    out->t_min = range[0] * reference->scale - t;
    out->t_max = range[1] * reference->scale - t;
    out->unsure = out->rounding = out->data = 0;
    out->draw = 0;
    out->whole = false;

    int k = 0;
    for (int i = 1; i < 3; i++)
        if (fabs(out->d[i]) < fabs(out->d[k]))
            k = i;
    double axis[3] = {k == 0, k == 1, k == 2};
    tc_vec_cross(out->u, axis, out->d);
    tc_vec_normalize(out->u);
    tc_vec_cross(out->v, out->d, out->u);
}

/* Projected corner. */
typedef struct corner {
    double x, y;
} corner;

/* A number in [-1, 1] that depends on its arguments alone (murmur3's finalizer, Appleby). */
static double noise(uint32_t draw, uint32_t id, uint32_t axis)
{
    uint32_t h = draw * 0x9e3779b9u + id * 4u + axis;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return (double)(h ^ h >> 16) / 2147483647.5 - 1;
}

/* A vertex as seen from the line's base, the same for every tet. */
static void place(double q[3], const double *vertex, const tc_line *line, uint32_t id)
{
    tc_vec_sub(q, vertex, line->base);
    if (line->rounding > 0)
        for (uint32_t k = 0; k < 3; k++)
            q[k] += line->rounding * noise(line->draw, id, k);
}

/* Cross product of a and b where its rounded products are equal: what the rounding hid, and its sign (never 0). a has
 * the smaller vertex id. */
static double hidden_cross(int *sign, corner a, corner b)
{
    double p = a.x * b.y, q = a.y * b.x;
    double c = fma(a.x, b.y, -p) - fma(a.y, b.x, -q);
    double decide = c;
    if (decide == 0)
        decide = a.y - b.y;
    if (decide == 0)
        decide = b.x - a.x;
    *sign = decide < 0 ? -1 : 1; /* the two coincide: by id */
    return c;
}

static double cross(int *sign, corner a, corner b)
{
    double c = a.x * b.y - a.y * b.x; /* rounding is monotone: a difference that is not 0 has the true sign */
    if (c == 0)
        return hidden_cross(sign, a, b);
    *sign = c < 0 ? -1 : 1;
    return c;
}

/* Mean of three values with weights >= 0, kept within them. */
static double blend(const double w[3], double total, double a, double b, double c)
{
    double x = total > 0 ? (w[0] * a + w[1] * b + w[2] * c) / total : (a + b + c) / 3;
    return fmin(fmax(x, fmin(a, fmin(b, c))), fmax(a, fmax(b, c)));
}

/* Depth and scalar where the ray passes face i < j < k, whose crosses are given. The result bounds the error of the
 * depth that the rounding of the projection brings. */
static double pass_face(double *t, double *s, const corner p[4], const double z[4], const double value[4], int i, int j,
                        int k, double ij, double jk, double ik)
{
    const double w[3] = {fabs(jk), fabs(ik), fabs(ij)};
    double total = w[0] + w[1] + w[2];
    *t = blend(w, total, z[i], z[j], z[k]);
    *s = blend(w, total, value[i], value[j], value[k]);
    double deep = fmax(z[i], fmax(z[j], z[k])) - fmin(z[i], fmin(z[j], z[k]));
    double rim = fabs(p[i].x) + fabs(p[i].y) + fabs(p[j].x) + fabs(p[j].y) + fabs(p[k].x) + fabs(p[k].y);
    double error = ROUNDING * 2 * rim * deep;
    return error < DOUBT * total ? 0 : fmin(error / total, deep);
}

/* Scalar at depth t of a part of some length. */
static double scalar_at(const tc_hit *hit, double t)
{
    double w = (t - hit->t0) / (hit->t1 - hit->t0);
    return w < 0.5 ? hit->s0 + w * (hit->s1 - hit->s0) : hit->s1 + (1 - w) * (hit->s0 - hit->s1);
}

/* Leaves what lies between t_min and t_max; false: nothing. */
static bool cut(tc_hit *hit, double t_min, double t_max)
{
    if (!(hit->t1 > t_min && hit->t0 < t_max))
        return false;
    const tc_hit whole = *hit;
    if (hit->t0 < t_min)
        hit->t0 = t_min, hit->s0 = scalar_at(&whole, t_min);
    if (hit->t1 > t_max)
        hit->t1 = t_max, hit->s1 = scalar_at(&whole, t_max);
    return hit->t0 < hit->t1;
}

/* The part of the ray in tet number item; false: none. *worst is raised to the error of its depths. */
static bool clip(tc_hit *hit, double *worst, const tc_reference *reference, const tc_line *line, uint32_t item,
                 double shift)
{
    const int32_t *id = reference->tet[item];
    double q[4][3];
    corner p[4];
    for (int i = 0; i < 4; i++) {
        place(q[i], &reference->vertex[3 * (size_t)id[i]], line, (uint32_t)id[i]);
        p[i] = (corner){tc_vec_dot(q[i], line->u), tc_vec_dot(q[i], line->v)};
    }
    /* Both bounds strict: a ray through the rim still needs its signs. */
    if ((p[0].x > 0 && p[1].x > 0 && p[2].x > 0 && p[3].x > 0) ||
        (p[0].x < 0 && p[1].x < 0 && p[2].x < 0 && p[3].x < 0) ||
        (p[0].y > 0 && p[1].y > 0 && p[2].y > 0 && p[3].y > 0) ||
        (p[0].y < 0 && p[1].y < 0 && p[2].y < 0 && p[3].y < 0))
        return false;
    int s01, s02, s03, s12, s13, s23;
    double c01 = cross(&s01, p[0], p[1]), c12 = cross(&s12, p[1], p[2]), c02 = cross(&s02, p[0], p[2]);
    double c03 = cross(&s03, p[0], p[3]), c13 = cross(&s13, p[1], p[3]), c23 = cross(&s23, p[2], p[3]);
    bool f012 = s01 == s12 && s12 != s02, f013 = s01 == s13 && s13 != s03;
    bool f023 = s02 == s23 && s23 != s03, f123 = s12 == s23 && s23 != s13;
    if (f012 + f013 + f023 + f123 < 2)
        return false;

    const tc_mesh *mesh = reference->mesh;
    uint32_t tet = reference->bvh.order[item];
    double z[4], value[4], t[4], s[4];
    for (int i = 0; i < 4; i++) {
        z[i] = tc_vec_dot(q[i], line->d);
        value[i] = !mesh->scalar ? 0 : mesh->association == TC_CELL_DATA ? mesh->scalar[tet] : mesh->scalar[id[i]];
        value[i] += shift;
    }
    int n = 0;
    uint8_t opposite[4];
    double doubt = 0;
    if (f012)
        doubt = fmax(doubt, pass_face(&t[n], &s[n], p, z, value, 0, 1, 2, c01, c12, c02)), opposite[n++] = 3;
    if (f013)
        doubt = fmax(doubt, pass_face(&t[n], &s[n], p, z, value, 0, 1, 3, c01, c13, c03)), opposite[n++] = 2;
    if (f023)
        doubt = fmax(doubt, pass_face(&t[n], &s[n], p, z, value, 0, 2, 3, c02, c23, c03)), opposite[n++] = 1;
    if (f123)
        doubt = fmax(doubt, pass_face(&t[n], &s[n], p, z, value, 1, 2, 3, c12, c23, c13)), opposite[n++] = 0;
    *worst = fmax(*worst, doubt);
    int first = t[0] <= t[1] ? 0 : 1;
    *hit = (tc_hit){t[first], t[1 - first], s[first], s[1 - first], tet, opposite[first], opposite[1 - first], 0, 0};
    hit->left = (hit->in >= 2 ? s01 : hit->in == 1 ? s02 : s12) > 0;
    for (int i = 0; i < 4; i++)
        if (!isfinite(value[i]))
            hit->s0 = hit->s1 = NAN; /* a value that is not known: see reference.h */
    return line->whole || (hit->t0 < hit->t1 && cut(hit, line->t_min, line->t_max));
}

static bool push(tc_scratch *scratch, size_t n, const tc_hit *hit)
{
    if (n == scratch->capacity) {
        size_t capacity = n ? 2 * n : 256;
        tc_hit *more = tc_realloc(scratch->hit, capacity, sizeof *more);
        if (!more)
            return false;
        scratch->hit = more;
        scratch->capacity = capacity;
    }
    scratch->hit[n] = *hit;
    return true;
}

/* The line in float, for boxes only: their padding covers its rounding. */
typedef struct slab {
    float base[3], inverse[3];
    float t_min, t_max;
} slab;

/* Entry into the box; FLT_MAX: it is missed. */
static float enter(const slab *s, const tc_bvh_box *b)
{
    float t0 = s->t_min, t1 = s->t_max;
    for (int i = 0; i < 3; i++) {
        float a = (b->lo[i] - s->base[i]) * s->inverse[i], c = (b->hi[i] - s->base[i]) * s->inverse[i];
        float low = a < c ? a : c, high = a < c ? c : a;
        t0 = low > t0 ? low : t0;
        t1 = high < t1 ? high : t1;
    }
    return t0 <= t1 ? t0 : FLT_MAX;
}

/* Collects the hits of one ray; *n gets their number, *worst the largest error of a depth (0: all below DOUBT). */
static bool collect(size_t *n, double *worst, tc_scratch *scratch, const tc_reference *reference, const tc_line *line,
                    double shift)
{
    *n = 0;
    *worst = 0;
    if (reference->bvh.n_node == 0 || tc_vec_dot(line->base, line->base) > REACH * REACH)
        return true;
    slab s;
    for (int i = 0; i < 3; i++) {
        double d = fabs(line->d[i]) < 1e-20 ? copysign(1e-20, line->d[i]) : line->d[i];
        s.base[i] = (float)line->base[i];
        s.inverse[i] = (float)(1 / d);
    }
    /* Hits lie within 1 of the base; a margin for the rounding of both ends. */
    s.t_min = (float)fmin(fmax(line->t_min, -2), 2) - 1e-5f;
    s.t_max = (float)fmin(fmax(line->t_max, -2), 2) + 1e-5f;
    const tc_bvh_node *node = reference->bvh.node;
    uint32_t stack[TC_BVH_STACK];
    int top = 0;
    if (enter(&s, &node[0].box) < FLT_MAX)
        stack[top++] = 0;
    while (top > 0) {
        const tc_bvh_node *at = &node[stack[--top]];
        for (uint32_t i = 0; i < at->count; i++) {
            tc_hit hit;
            if (clip(&hit, worst, reference, line, at->first + i, shift) && !push(scratch, (*n)++, &hit))
                return false;
        }
        if (at->count)
            continue;
        float t0 = enter(&s, &node[at->first].box), t1 = enter(&s, &node[at->first + 1].box);
        uint32_t near_child = at->first + (t1 < t0);
        if (fmaxf(t0, t1) < FLT_MAX)
            stack[top++] = at->first + !(t1 < t0);
        if (fminf(t0, t1) < FLT_MAX)
            stack[top++] = near_child;
    }
    return true;
}

/* The same, from beside the line if its depths are in doubt: the best of up to five places, which *line becomes. */
static bool collect_surely(size_t *n, tc_scratch *scratch, const tc_reference *reference, tc_line *line, double shift)
{
    double worst, least;
    if (!collect(n, &least, scratch, reference, line, shift))
        return false;
    if (least == 0)
        return true;
    tc_line best = *line, moved = *line;
    for (int k = 0; k < 4; k++) {
        double angle = 1 + 2.4 * k, by = k < 2 ? ASIDE : 16 * ASIDE; /* radians: no direction of a grid */
        tc_vec_mul_add(moved.base, line->base, by * cos(angle), line->u);
        tc_vec_mul_add(moved.base, moved.base, by * sin(angle), line->v);
        if (!collect(n, &worst, scratch, reference, &moved, shift))
            return false;
        if (worst < least)
            least = worst, best = moved;
        if (least == 0)
            break;
    }
    bool there = least == 0; /* the last place is the best */
    *line = best;
    return there || collect(n, &worst, scratch, reference, line, shift);
}

/* By entry, then exit, then cell: the same order however the hierarchy was built. */
static bool before(const tc_hit *a, const tc_hit *b)
{
    if (a->t0 != b->t0)
        return a->t0 < b->t0;
    return a->t1 != b->t1 ? a->t1 < b->t1 : a->tet < b->tet;
}

static int compare(const void *a, const void *b)
{
    return before(a, b) ? -1 : before(b, a) ? 1 : 0;
}

/* The hits come nearly sorted: insertion, until it has cost too much. */
static void sort(tc_hit *hit, size_t n)
{
    size_t moves = 0;
    for (size_t i = 1; i < n; i++) {
        tc_hit x = hit[i];
        size_t j = i;
        for (; j > 0 && before(&x, &hit[j - 1]); j--)
            hit[j] = hit[j - 1];
        hit[j] = x;
        moves += i - j;
        if (moves > 32 * n) {
            qsort(hit, n, sizeof *hit, compare);
            return;
        }
    }
}

/* The hits again, in the order that overlap.c defines; *line becomes the line that they were found with. */
static bool collect_overlapping(size_t *n, tc_scratch *scratch, const tc_reference *reference, tc_line *line,
                                double shift)
{
    const double t_min = line->t_min, t_max = line->t_max;
    line->whole = true;
    line->t_min = -INFINITY; /* runs begin where the ray enters them, seen or not */
    size_t m;
    if (!collect_surely(&m, scratch, reference, line, shift) ||
        !tc_hits_order(scratch->hit, m, reference, line->unsure))
        return false;
    *n = 0;
    for (size_t i = 0; i < m; i++) {
        tc_hit *hit = &scratch->hit[i];
        if (hit->t0 < hit->t1 && cut(hit, t_min, t_max))
            scratch->hit[(*n)++] = *hit;
    }
    return true;
}

/* The density emitter. */
static void gather(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                   const tc_hit *hit, size_t n)
{
    tc_segment_sum sum = {.rgba = {0, 0, 0, 0}, .clear = 1};
    for (size_t i = 0; i < n; i++) {
        const tc_hit *h = &hit[i];
        double length = (h->t1 - h->t0) / reference->scale;
        out->length += length;
        if (!(sum.clear > 1e-18)) /* what is behind cannot be told */
            continue;
        if (isfinite(h->s0) && isfinite(h->s1))
            tc_segment_add(&sum, tf, h->s0, h->s1, length / unit);
        else if (reference->has_nan_color)
            tc_segment_add_constant(&sum, reference->nan_color, length / unit);
    }
    for (int i = 0; i < 4; i++)
        out->rgba[i] = sum.rgba[i];
    out->segments = n;
}

tc_status tc_line_trace(tc_reference_ray *out, const tc_reference *reference, const tc_transfer *tf, double unit,
                        const tc_line *line, double shift, int worker)
{
    *out = (tc_reference_ray){.length = 0};
    tc_scratch *scratch = &reference->scratch[worker];
    size_t n;
    tc_line part = *line;
    if (reference->look)
        tc_look_cut(&part, reference);
    tc_line walked = part;
    if (!collect_surely(&n, scratch, reference, &walked, shift))
        return TC_E_MEMORY;
    sort(scratch->hit, n);
    if (tc_hits_overlap(scratch->hit, n)) {
        walked = part;
        if (!collect_overlapping(&n, scratch, reference, &walked, shift))
            return TC_E_MEMORY;
    }
    if (reference->look)
        return tc_look_gather(out, reference, tf, unit, scratch->hit, n, line, &walked, worker);
    gather(out, reference, tf, unit, scratch->hit, n);
    return TC_OK;
}

/* -------------------------------------------------------------------------------------------- what a look asks for */

/* Weights of the corners of face i < j < k where the line passes it, and its depth there. */
static void weigh_face(double *t, double weight[4], const corner p[4], const double z[4], int i, int j, int k)
{
    int sign;
    const double w[3] = {fabs(cross(&sign, p[j], p[k])), fabs(cross(&sign, p[i], p[k])),
                         fabs(cross(&sign, p[i], p[j]))};
    double total = w[0] + w[1] + w[2];
    *t = blend(w, total, z[i], z[j], z[k]);
    memset(weight, 0, 4 * sizeof *weight);
    weight[i] = total > 0 ? w[0] / total : 1.0 / 3;
    weight[j] = total > 0 ? w[1] / total : 1.0 / 3;
    weight[k] = total > 0 ? w[2] / total : 1.0 / 3;
}

void tc_line_ends(tc_ends *out, const tc_reference *reference, const tc_line *line, const tc_hit *hit)
{
    static const int face[4][3] = {{1, 2, 3}, {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
    const int32_t *id = reference->mesh->tet + 4 * (size_t)hit->tet;
    for (int i = 0; i < 4; i++) {
        int j = i;
        for (; j > 0 && out->id[j - 1] > id[i]; j--)
            out->id[j] = out->id[j - 1];
        out->id[j] = id[i];
    }
    corner p[4];
    double z[4];
    for (int i = 0; i < 4; i++) {
        double q[3];
        place(q, &reference->vertex[3 * (size_t)out->id[i]], line, (uint32_t)out->id[i]);
        p[i] = (corner){tc_vec_dot(q, line->u), tc_vec_dot(q, line->v)};
        z[i] = tc_vec_dot(q, line->d);
    }
    const int *f = face[hit->in], *g = face[hit->out];
    weigh_face(&out->t[0], out->weight[0], p, z, f[0], f[1], f[2]);
    weigh_face(&out->t[1], out->weight[1], p, z, g[0], g[1], g[2]);
}

bool tc_line_triangle(double *t, const tc_line *line, const double *vertex, const int32_t id[3], uint32_t salt)
{
    corner p[3];
    double z[3];
    for (int i = 0; i < 3; i++) {
        double q[3];
        place(q, vertex + 3 * (size_t)id[i], line, (uint32_t)id[i] + 0x9e3779b9u * salt);
        p[i] = (corner){tc_vec_dot(q, line->u), tc_vec_dot(q, line->v)};
        z[i] = tc_vec_dot(q, line->d);
    }
    int s01, s02, s12;
    const double w[3] = {fabs(cross(&s12, p[1], p[2])), fabs(cross(&s02, p[0], p[2])), fabs(cross(&s01, p[0], p[1]))};
    *t = blend(w, w[0] + w[1] + w[2], z[0], z[1], z[2]);
    return s01 == s12 && s12 != s02;
}
