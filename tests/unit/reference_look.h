/* reference_look.h: looks and rays for the reference caster's tests. */
#ifndef TC_TESTS_UNIT_REFERENCE_LOOK_H
#define TC_TESTS_UNIT_REFERENCE_LOOK_H

#include "test_reference_fixture.h"

static const double OUTSIDE[3] = {3.1, -2.3, 4.7};

static inline void look_of(tc_reference *r, const tc_look *look)
{
    tc_error err;
    if (tc_reference_set_look(r, look, &err) != TC_OK)
        fail_msg("%s", err.text);
}

/* A ray from OUTSIDE to somewhere in or beside the unit cube; t: where it is in the cube. False: nowhere. */
static inline bool random_ray(double d[3], double t[2], uint64_t *seed)
{
    double p[3];
    for (int i = 0; i < 3; i++)
        p[i] = uniform(seed, -0.2, 1.2);
    tc_vec_sub(d, p, OUTSIDE);
    tc_vec_normalize(d);
    t[0] = 0, t[1] = INFINITY;
    for (int i = 0; i < 3; i++) {
        double a = -OUTSIDE[i] / d[i], b = (1 - OUTSIDE[i]) / d[i];
        t[0] = fmax(t[0], fmin(a, b)), t[1] = fmin(t[1], fmax(a, b));
    }
    return t[0] < t[1];
}

/* a + b . x at OUTSIDE + t d */
static inline double scalar_on(const double d[3], double t, double a, double bx, double by, double bz)
{
    return a + bx * (OUTSIDE[0] + t * d[0]) + by * (OUTSIDE[1] + t * d[1]) + bz * (OUTSIDE[2] + t * d[2]);
}

/* Leaves of part what lies where n . x >= offset. */
static inline void keep_side(double part[2], const double d[3], const double n[3], double offset)
{
    double away = offset - tc_vec_dot(n, OUTSIDE), rise = tc_vec_dot(n, d);
    if (rise > 0)
        part[0] = fmax(part[0], away / rise);
    else
        part[1] = fmin(part[1], away / rise);
}

/* Premultiplied colours, front to back. */
typedef struct stack {
    double rgba[4], clear;
} stack;

static inline void stack_add(stack *s, const double color[3], double alpha)
{
    for (int c = 0; c < 3; c++)
        s->rgba[c] += s->clear * alpha * color[c];
    s->rgba[3] += s->clear * alpha;
    s->clear *= 1 - alpha;
}

#endif
