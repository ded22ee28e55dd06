/* segment.c: ray integrals over short segments between given scalars.
 * Weiler et al. 2003, equations 3 and 4: extinction is integrated in closed form, emission by its moments over optical
 * depth (five-point Gauss-Legendre per linear piece, exact for the polynomials of degree 8 that occur). */
#include "transfer_functions/segment.h"

#include "core/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double series_limit = 1.0 / 16; /* optical depth up to which the series is used: C off by < d^5/120 */
static const double depth_limit = 1e12;
static const double opaque = 1e-10;    /* what lies behind so little transparency is left out */
static const double node_snap = 1e-13; /* knots so near a node (in x) count as at it */

/* ------------------------------------------------------------------------------------------------------ moments */

static void piece_moments(tc_moments *out, const double near[4], const double far[4], double width)
{
    static const double place[5] = {0.046910077030668004, 0.23076534494715845, 0.5, 0.76923465505284155,
                                    0.953089922969332};
    static const double weight[5] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
                                     0.11846344252809454};
    memset(out, 0, sizeof *out);
    const double rise = far[3] - near[3];
    for (int g = 0; g < 5; g++) {
        const double u = place[g], tau = near[3] + u * rise;
        const double depth = width * u * (near[3] + 0.5 * u * rise);
        for (int c = 0; c < 3; c++) {
            const double emitted = width * weight[g] * tau * (near[c] + u * (far[c] - near[c]));
            out->emission[0][c] += emitted;
            out->emission[1][c] += emitted * depth;
            out->emission[2][c] += emitted * depth * depth * (1.0 / 2);
            out->emission[3][c] += emitted * depth * depth * depth * (1.0 / 6);
        }
    }
    out->depth = 0.5 * width * (near[3] + far[3]);
}

/* a followed by b, seen from a's near end. */
static inline void join(tc_moments *a, const tc_moments *b)
{
    const double p1 = a->depth, p2 = 0.5 * p1 * p1, p3 = p1 * p2 * (1.0 / 3);
    for (int c = 0; c < 3; c++) {
        const double e0 = b->emission[0][c], e1 = b->emission[1][c], e2 = b->emission[2][c], e3 = b->emission[3][c];
        a->emission[0][c] += e0;
        a->emission[1][c] += e1 + p1 * e0;
        a->emission[2][c] += e2 + p1 * e1 + p2 * e0;
        a->emission[3][c] += e3 + p1 * e2 + p2 * e1 + p3 * e0;
    }
    a->depth += b->depth;
}

static inline double series(const tc_moments *m, double rate, int c)
{
    return rate *
           (m->emission[0][c] - rate * (m->emission[1][c] - rate * (m->emission[2][c] - rate * m->emission[3][c])));
}

/* -------------------------------------------------------------------------------------------------------- build */

static void value_between(double out[4], const tc_knot *a, const tc_knot *b, double t, double length)
{
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    out[0] = a->r + t * (b->r - a->r);
    out[1] = a->g + t * (b->g - a->g);
    out[2] = a->b + t * (b->b - a->b);
    out[3] = fmin(length * (a->a + t * (b->a - a->a)), depth_limit);
}

/* Value at x on the linear piece that ends at knot `knot`; knots' x in kx. */
static void value_at(double out[4], const tc_transfer *tf, const double *kx, size_t knot, double x, double length)
{
    const size_t a = knot > 0 ? knot - 1 : 0, b = knot < tf->n ? knot : tf->n - 1;
    value_between(out, &tf->knot[a], &tf->knot[b], kx[b] > kx[a] ? (x - kx[a]) / (kx[b] - kx[a]) : 0, length);
}

static void add_piece(tc_segments *s, const tc_transfer *tf, const double *kx, size_t knot, double x0, double x1,
                      double length)
{
    tc_segment_piece *piece = &s->piece[s->n_piece++];
    piece->x[0] = x0;
    piece->x[1] = x1;
    value_at(piece->value[0], tf, kx, knot, x0, length);
    value_at(piece->value[1], tf, kx, knot, x1, length);
}

/* Cuts [0, 1] at nodes and knots. */
static void cut(tc_segments *s, const tc_transfer *tf, const double *kx, double length)
{
    size_t knot = 0; /* first knot beyond the place */
    while (knot < tf->n && kx[knot] <= node_snap)
        knot++;
    for (size_t i = 0; i + 1 < s->n_node; i++) {
        s->first[i] = s->n_piece;
        double at = s->x[i];
        for (; knot < tf->n && kx[knot] < s->x[i + 1] - node_snap; knot++)
            if (kx[knot] > at) {
                add_piece(s, tf, kx, knot, at, kx[knot], length);
                at = kx[knot];
            }
        add_piece(s, tf, kx, knot, at, s->x[i + 1], length);
        while (knot < tf->n && kx[knot] <= s->x[i + 1] + node_snap)
            knot++;
    }
    s->first[s->n_node - 1] = s->n_piece;
}

static void emit(double out[4], const double value[4])
{
    for (int c = 0; c < 3; c++)
        out[c] = value[3] * value[c];
    out[3] = value[3];
}

static void fill_nodes(tc_segments *s, const tc_transfer *tf, const double *kx, double length)
{
    size_t low = 0, high = 0; /* first knot at, and beyond, the node */
    for (size_t i = 0; i < s->n_node; i++) {
        while (low < tf->n && kx[low] < s->x[i] - node_snap)
            low++;
        high = high > low ? high : low;
        while (high < tf->n && kx[high] <= s->x[i] + node_snap)
            high++;
        double value[4], left[4], right[4];
        value_at(value, tf, kx, low, s->x[i], length);
        emit(left, value);
        value_at(value, tf, kx, high, s->x[i], length);
        emit(right, value);
        for (int c = 0; c < 4; c++)
            s->node[i][c] = left[c] + 0.5 * (right[c] - left[c]);
    }
}

static void fill_cells(tc_segments *s)
{
    for (size_t i = 0; i + 1 < s->n_node; i++) {
        memset(&s->up[i], 0, sizeof s->up[i]);
        memset(&s->down[i], 0, sizeof s->down[i]);
        for (size_t p = s->first[i]; p < s->first[i + 1]; p++) {
            tc_moments m;
            piece_moments(&m, s->piece[p].value[0], s->piece[p].value[1], s->piece[p].x[1] - s->piece[p].x[0]);
            join(&s->up[i], &m);
        }
        for (size_t p = s->first[i + 1]; p-- > s->first[i];) {
            tc_moments m;
            piece_moments(&m, s->piece[p].value[1], s->piece[p].value[0], s->piece[p].x[1] - s->piece[p].x[0]);
            join(&s->down[i], &m);
        }
        s->down[i].depth = s->up[i].depth; /* to the last bit, so that opacity is symmetric */
    }
}

tc_status tc_segments_build(tc_segments *out, const tc_transfer *tf, const double span[2], double length,
                            const double *x, size_t n_node, tc_error *err)
{
    memset(out, 0, sizeof *out);
    double *kx = tc_alloc(tf->n, sizeof *kx);
    out->x = tc_alloc(n_node, sizeof *out->x);
    out->node = tc_alloc(n_node, sizeof *out->node);
    out->first = tc_alloc(n_node, sizeof *out->first);
    out->piece = tc_alloc(n_node + tf->n, sizeof *out->piece);
    out->up = tc_alloc(n_node, sizeof *out->up);
    out->down = tc_alloc(n_node, sizeof *out->down);
    if (!kx || !out->x || !out->node || !out->first || !out->piece || !out->up || !out->down) {
        free(kx);
        tc_segments_finish(out);
        return tc_fail_memory(err, "segment integrals", n_node + tf->n, sizeof *out->piece + 2 * sizeof *out->up);
    }
    for (size_t i = 0; i < tf->n; i++)
        kx[i] = fmax(-1e200, fmin(1e200, (tf->knot[i].s - span[0]) / (span[1] - span[0])));
    memcpy(out->x, x, n_node * sizeof *x);
    out->n_node = n_node;
    cut(out, tf, kx, length);
    fill_nodes(out, tf, kx, length);
    fill_cells(out);
    free(kx);
    return TC_OK;
}

void tc_segments_finish(tc_segments *segments)
{
    free(segments->x);
    free(segments->node);
    free(segments->first);
    free(segments->piece);
    free(segments->up);
    free(segments->down);
    memset(segments, 0, sizeof *segments);
}

/* -------------------------------------------------------------------------------------------------- thick segments */

/* Front-to-back sum over stretches; stretches gather in `pending` while thin enough for the series. */
typedef struct march {
    double color[3], pass; /* pass: transparency so far */
    double rate, error;
    tc_moments pending;
} march;

static void march_flush(march *m)
{
    const double depth = m->rate * m->pending.depth;
    for (int c = 0; c < 3; c++)
        m->color[c] += m->pass * series(&m->pending, m->rate, c);
    m->error += m->pass * depth * depth * depth * depth * depth * (1.0 / 120);
    m->pass *= exp(-depth);
    memset(&m->pending, 0, sizeof m->pending);
}

/* Takes a stretch that is thin enough by itself; false when it is not. */
static bool march_take(march *m, const tc_moments *stretch)
{
    if (m->rate * stretch->depth > series_limit)
        return false;
    if (m->rate * (m->pending.depth + stretch->depth) > series_limit)
        march_flush(m);
    join(&m->pending, stretch);
    return true;
}

/* A linear piece, halved until its parts are thin. */
static void march_linear(march *m, const double near[4], const double far[4], double width)
{
    if (m->pass < opaque)
        return;
    tc_moments moments;
    piece_moments(&moments, near, far, width);
    if (march_take(m, &moments))
        return;
    double middle[4];
    for (int c = 0; c < 4; c++)
        middle[c] = 0.5 * (near[c] + far[c]);
    march_linear(m, near, middle, 0.5 * width);
    march_linear(m, middle, far, 0.5 * width);
}

static void march_cell(march *m, const tc_segments *s, size_t cell, bool up)
{
    if (march_take(m, up ? &s->up[cell] : &s->down[cell]))
        return;
    const size_t begin = s->first[cell], end = s->first[cell + 1];
    for (size_t i = begin; i < end; i++) {
        const tc_segment_piece *piece = &s->piece[up ? i : begin + end - 1 - i];
        march_linear(m, piece->value[!up], piece->value[up], piece->x[1] - piece->x[0]);
    }
}

/* ------------------------------------------------------------------------------------------------------ integrals */

static void thick(double out[4], double *error, const tc_segments *s, size_t front, size_t back, double rate)
{
    march m = {.pass = 1, .rate = rate};
    for (size_t i = front; i != back && m.pass >= opaque; i = front < back ? i + 1 : i - 1)
        march_cell(&m, s, front < back ? i : i - 1, front < back);
    march_flush(&m);
    for (int c = 0; c < 3; c++)
        out[c] = m.color[c];
    *error = fmax(*error, m.error + opaque);
}

/* tau c and tau along the whole segment: no change of scalar. */
static void constant(double out[4], const double emission[4])
{
    out[3] = -expm1(-emission[3]);
    for (int c = 0; c < 3; c++)
        out[c] = emission[3] > 0 ? emission[c] / emission[3] * out[3] : 0;
}

void tc_segments_row(double (*out)[4], double *error, const tc_segments *segments, size_t front)
{
    const tc_segments *s = segments;
    constant(out[front], s->node[front]);
    double thickest = 0; /* among those done by one series */
    for (int up = 0; up < 2; up++) {
        tc_moments sum;
        memset(&sum, 0, sizeof sum);
        for (size_t at = front; up ? at + 1 < s->n_node : at > 0;) {
            join(&sum, up ? &s->up[at] : &s->down[at - 1]);
            at = up ? at + 1 : at - 1;
            const double rate = 1 / fabs(s->x[at] - s->x[front]), depth = rate * sum.depth;
            out[at][3] = -expm1(-depth);
            if (depth <= series_limit) {
                for (int c = 0; c < 3; c++)
                    out[at][c] = series(&sum, rate, c);
                thickest = fmax(thickest, depth);
            } else
                thick(out[at], error, s, front, at, rate);
        }
    }
    *error = fmax(*error, thickest * thickest * thickest * thickest * thickest / 120);
}

/* (e0 - e1 l + e2 l^2 - e3 l^3) / (d - d^2 l/2 + d^3 l^2/6 - d^4 l^3/24), term by term. */
static void divide(tc_segment_series *out, const tc_moments *m, double rate)
{
    memset(out, 0, sizeof *out);
    const double d = rate * m->depth;
    if (!(d > 0))
        return;
    const double b1 = -d / 2, b2 = d * d / 6, b3 = -d * d * d / 24, r1 = -rate, r2 = rate * rate,
                 r3 = -rate * rate * rate;
    out->depth = d;
    for (int c = 0; c < 3; c++) {
        const double c0 = m->emission[0][c] / m->depth, c1 = r1 * m->emission[1][c] / m->depth - b1 * c0;
        const double c2 = r2 * m->emission[2][c] / m->depth - b1 * c1 - b2 * c0;
        out->mean[c] = c0;
        out->term[0][c] = c1;
        out->term[1][c] = c2;
        out->term[2][c] = r3 * m->emission[3][c] / m->depth - b1 * c2 - b2 * c1 - b3 * c0;
    }
}

void tc_segments_series(tc_segment_series *out, const tc_segments *segments, size_t front)
{
    const tc_segments *s = segments;
    memset(&out[front], 0, sizeof *out);
    out[front].depth = s->node[front][3];
    for (int c = 0; c < 3; c++)
        out[front].mean[c] = s->node[front][3] > 0 ? s->node[front][c] / s->node[front][3] : 0;
    for (int up = 0; up < 2; up++) {
        tc_moments sum;
        memset(&sum, 0, sizeof sum);
        for (size_t at = front; up ? at + 1 < s->n_node : at > 0;) {
            join(&sum, up ? &s->up[at] : &s->down[at - 1]);
            at = up ? at + 1 : at - 1;
            divide(&out[at], &sum, 1 / fabs(s->x[at] - s->x[front]));
        }
    }
}

void tc_segments_short(double out[4], const tc_segments *segments, double front, double back, double part, size_t *hint)
{
    const tc_segments *s = segments;
    const bool up = back > front;
    size_t p = *hint;
    while (p > 0 && (up ? s->piece[p].x[0] > front : s->piece[p].x[0] >= front))
        p--;
    while (p + 1 < s->n_piece && (up ? s->piece[p].x[1] <= front : s->piece[p].x[1] < front))
        p++;
    if (front == back) {
        const tc_segment_piece *piece = &s->piece[p];
        const double t = (front - piece->x[0]) / (piece->x[1] - piece->x[0]);
        double value[4], emission[4];
        for (int c = 0; c < 4; c++)
            value[c] = piece->value[0][c] + t * (piece->value[1][c] - piece->value[0][c]);
        value[3] *= part;
        emit(emission, value);
        constant(out, emission);
        *hint = p;
        return;
    }
    march m = {.pass = 1, .rate = part / fabs(back - front)};
    double depth = 0;
    for (;;) {
        const tc_segment_piece *piece = &s->piece[p];
        const double low = up ? fmax(front, piece->x[0]) : fmax(back, piece->x[0]);
        const double high = up ? fmin(back, piece->x[1]) : fmin(front, piece->x[1]);
        if (high > low) {
            const double scale = 1 / (piece->x[1] - piece->x[0]), a = (low - piece->x[0]) * scale,
                         b = (high - piece->x[0]) * scale;
            double value[2][4];
            for (int c = 0; c < 4; c++) {
                const double rise = piece->value[1][c] - piece->value[0][c];
                value[!up][c] = piece->value[0][c] + a * rise;
                value[up][c] = piece->value[0][c] + b * rise;
            }
            depth += 0.5 * (high - low) * (value[0][3] + value[1][3]);
            march_linear(&m, value[0], value[1], high - low);
        }
        if (up ? piece->x[1] >= back || p + 1 == s->n_piece : piece->x[0] <= back || p == 0)
            break;
        p = up ? p + 1 : p - 1;
    }
    *hint = p;
    march_flush(&m);
    for (int c = 0; c < 3; c++)
        out[c] = m.color[c];
    out[3] = -expm1(-m.rate * depth);
}

void tc_segments_between(double out[4], const tc_segments *segments, double front, double back, size_t *hint)
{
    tc_segments_short(out, segments, front, back, 1, hint);
}
