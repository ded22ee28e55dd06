/* edit_make.h: documents of the transfer-function window to try things with, made at random, and what is true of each.
 * Include after cmocka. */
#ifndef TC_TESTS_UNIT_EDIT_MAKE_H
#define TC_TESTS_UNIT_EDIT_MAKE_H

#include "edit/document.h"

#include <math.h>
#include <stdint.h>

/* cmocka's own comparison is of floats. */
#define assert_near(a, b, most) assert_true(fabs((a) - (b)) <= (most))

static inline double random01(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 11) * 0x1p-53;
}

static inline size_t random_below(uint64_t *state, size_t n)
{
    return (size_t)(random01(state) * (double)n);
}

static inline tc_document *create(double lo, double hi)
{
    tc_document *document;
    tc_error err = {0};
    if (tc_document_create(&document, (const double[2]){lo, hi}, &err) != TC_OK)
        fail_msg("%s", err.text);
    return document;
}

static inline tc_document *copy(const tc_document *document)
{
    tc_document *other;
    assert_int_equal(tc_document_copy(&other, document, NULL), TC_OK);
    return other;
}

static inline void take(tc_document *document, const char *text, const char *name)
{
    tc_error err = {0};
    if (tc_document_take_preset(document, text, name, &err) != TC_OK)
        fail_msg("%s", err.text);
}

static inline tc_transfer *function(const tc_document *document)
{
    tc_transfer *tf;
    tc_error err = {0};
    if (tc_document_function(&tf, document, &err) != TC_OK)
        fail_msg("%s", err.text);
    return tf;
}

static inline void check(const tc_document *d)
{
    assert_non_null(d->name);
    assert_true(d->n_point >= 2 && d->n_color >= 2);
    assert_true(d->point[0].x == 0 && d->point[d->n_point - 1].x == 1);
    assert_true(d->color[0].x == 0 && d->color[d->n_color - 1].x == 1);
    for (size_t i = 0; i < d->n_point; i++) {
        const tc_edit_point *p = &d->point[i];
        assert_true(i == 0 || p->x >= p[-1].x);
        assert_true(p->a >= 0 && isfinite(p->a));
        assert_true(p->midpoint >= 0 && p->midpoint <= 1 && p->sharpness >= 0 && p->sharpness <= 1);
    }
    for (size_t i = 0; i < d->n_color; i++) {
        assert_true(i == 0 || d->color[i].x >= d->color[i - 1].x);
        for (int c = 0; c < 3; c++)
            assert_true(d->color[i].rgb[c] >= 0 && d->color[i].rgb[c] <= 1);
    }
}

static inline double random_place(uint64_t *seed)
{
    const double places[] = {0, 1, 0.5, 0.25};
    return random01(seed) < 0.2 ? places[random_below(seed, 4)] : random01(seed);
}

static inline void random_edit(tc_document *d, uint64_t *seed)
{
    const size_t n_point = d->n_point, n_color = d->n_color;
    double went[2];
    size_t index;
    switch (random_below(seed, 11)) {
    case 0: {
        const double x = random_place(seed), a = random01(seed) - 0.1;
        assert_int_equal(tc_document_add_point(d, &index, x, a, NULL), TC_OK);
        assert_int_equal(d->n_point, n_point + 1);
        assert_true(d->point[index].x == x && d->point[index].a == fmax(0, a));
        break;
    }
    case 1: {
        const double x = random_place(seed), rgb[3] = {random01(seed), random01(seed), 1.2 * random01(seed) - 0.1};
        assert_int_equal(tc_document_add_color(d, &index, x, rgb, NULL), TC_OK);
        assert_int_equal(d->n_color, n_color + 1);
        assert_true(d->color[index].x == x && d->color[index].rgb[0] == rgb[0]);
        break;
    }
    case 2:
        for (size_t i = 0; i < n_point; i++)
            d->point[i].selected = random01(seed) < 0.4;
        break;
    case 3:
        for (size_t i = 0; i < n_color; i++)
            d->color[i].selected = random01(seed) < 0.4;
        break;
    case 4:
        tc_document_move(went, d, random01(seed) - 0.5, random01(seed) - 0.5);
        break;
    case 5:
        tc_document_scale(d, random01(seed) - 0.5, 2 * random01(seed));
        break;
    case 6:
        tc_document_move_colors(d, random01(seed) - 0.5);
        break;
    case 7:
        if (n_point > 12)
            tc_document_delete_points(d);
        break;
    case 8:
        if (n_color > 8)
            tc_document_delete_colors(d);
        break;
    case 9: {
        tc_edit_point *p = &d->point[random_below(seed, n_point)];
        p->midpoint = random01(seed) < 0.3 ? 0.5 : random_place(seed);
        p->sharpness = random01(seed) < 0.3 ? 0 : random_place(seed);
        break;
    }
    default: {
        const double from = random_place(seed), to = random_place(seed), lo = fmin(from, to), hi = fmax(from, to);
        tc_edit_point point[32];
        const size_t kind = random_below(seed, 4), n = kind == 0 ? tc_shape_gaussian(point, 32, lo, hi, 0.8, 0)
                                                       : kind == 1
                                                           ? tc_shape_trapezoid(point, 32, lo, hi, 0.3, 0.5, 0.1)
                                                       : kind == 2 ? tc_shape_step(point, 32, lo, hi, 0.6, 0)
                                                                   : 0;
        assert_int_equal(tc_document_replace(d, from, to, point, n, NULL), TC_OK);
        break;
    }
    }
}

static inline tc_document *random_document(uint64_t *seed)
{
    const double lo = 20 * random01(seed) - 10;
    tc_document *d = create(lo, lo + 0.1 + 30 * random01(seed));
    if (random01(seed) < 0.3) {
        d->range[0] = 0.01 + random01(seed);
        d->range[1] = d->range[0] * (1.5 + 1000 * random01(seed));
        d->log = true;
    }
    const tc_edit_space space[] = {TC_EDIT_RGB, TC_EDIT_HSV, TC_EDIT_LAB, TC_EDIT_DIVERGING, TC_EDIT_STEP};
    d->space = space[random_below(seed, 5)]; /* CIEDE2000 is slow, and has a test of its own */
    d->hsv_wrap = random01(seed) < 0.5;
    d->has_nan_color = random01(seed) < 0.5;
    for (int c = 0; c < 4; c++)
        d->nan_color[c] = random01(seed);
    for (int i = 0; i < 40; i++)
        random_edit(d, seed);
    check(d);
    return d;
}

/* Largest difference of two functions at places over both. */
static inline double difference(const tc_transfer *a, const tc_transfer *b)
{
    size_t n, m;
    const tc_knot *p = tc_transfer_knots(a, &n), *q = tc_transfer_knots(b, &m);
    double most = n == m ? 0 : INFINITY;
    for (size_t i = 0; i < n && n == m; i++) {
        const double scale = fmax(1, fmax(fabs(p[i].s), fabs(q[i].s)));
        const double off[] = {(p[i].s - q[i].s) / scale, p[i].r - q[i].r, p[i].g - q[i].g, p[i].b - q[i].b,
                              p[i].a - q[i].a};
        for (int k = 0; k < 5; k++)
            most = fmax(most, fabs(off[k]));
    }
    return most;
}

/* Of knots, at s: from the left or from the right. */
static inline void evaluate(double out[4], const tc_transfer *tf, double s, bool left)
{
    size_t n, i = 0;
    const tc_knot *knot = tc_transfer_knots(tf, &n);
    while (i < n && (left ? knot[i].s < s : knot[i].s <= s))
        i++;
    const tc_knot *a = &knot[i > 0 ? i - 1 : 0], *b = &knot[i < n ? i : n - 1];
    const double t = b->s > a->s ? (s - a->s) / (b->s - a->s) : 0;
    out[0] = a->r + t * (b->r - a->r);
    out[1] = a->g + t * (b->g - a->g);
    out[2] = a->b + t * (b->b - a->b);
    out[3] = a->a + t * (b->a - a->a);
}

#endif
