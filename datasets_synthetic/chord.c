/* chord.c: clips a line by planes (Cyrus and Beck 1978) and by boxes (Kay and Kajiya 1986). */
#include "chord.h"

#include "core/vec.h"

tc_span tc_span_whole(void)
{
    return (tc_span){-HUGE_VAL, HUGE_VAL};
}

double tc_span_length(tc_span span)
{
    return span.t1 > span.t0 ? span.t1 - span.t0 : 0;
}

void tc_span_clip(tc_span *span, const double *origin, const double *direction, const double *a, const double *b,
                  const double *c)
{
    double ab[3], ac[3], oa[3], normal[3];
    tc_vec_sub(ab, b, a);
    tc_vec_sub(ac, c, a);
    tc_vec_sub(oa, a, origin);
    tc_vec_cross(normal, ab, ac);
    double along = tc_vec_dot(normal, direction), to = tc_vec_dot(normal, oa);
    if (along > 0)
        span->t1 = fmin(span->t1, to / along);
    else if (along < 0)
        span->t0 = fmax(span->t0, to / along);
    else if (to < 0)
        span->t1 = -HUGE_VAL;
}

static void clip_slab(tc_span *span, double lo, double hi, double origin, double direction)
{
    if (direction == 0) {
        if (origin < lo || origin >= hi)
            span->t1 = -HUGE_VAL;
        return;
    }
    double a = (lo - origin) / direction, b = (hi - origin) / direction;
    span->t0 = fmax(span->t0, fmin(a, b));
    span->t1 = fmin(span->t1, fmax(a, b));
}

double tc_chord_box(const double lo[3], const double hi[3], const double *origin, const double *direction)
{
    tc_span span = tc_span_whole();
    for (int a = 0; a < 3; a++)
        clip_slab(&span, lo[a], hi[a], origin[a], direction[a]);
    return tc_span_length(span);
}

double tc_chord_unit_cube(const double *origin, const double *direction, size_t n_cells)
{
    (void)n_cells;
    static const double lo[3] = {0, 0, 0}, hi[3] = {1, 1, 1};
    return tc_chord_box(lo, hi, origin, direction);
}

double tc_chord_tet(const double *a, const double *b, const double *c, const double *d, const double *origin,
                    const double *direction)
{
    tc_span span = tc_span_whole();
    tc_span_clip(&span, origin, direction, b, c, d);
    tc_span_clip(&span, origin, direction, a, d, c);
    tc_span_clip(&span, origin, direction, a, b, d);
    tc_span_clip(&span, origin, direction, a, c, b);
    return tc_span_length(span);
}
