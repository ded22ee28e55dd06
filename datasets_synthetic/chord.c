/* chord.c: clips a line by planes (Cyrus and Beck 1978). */
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
