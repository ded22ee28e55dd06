/* vec.h: three-vectors of doubles. */
#ifndef TC_CORE_VEC_H
#define TC_CORE_VEC_H

#include <math.h>

static inline void tc_vec_copy(double *o, const double *a) { o[0] = a[0], o[1] = a[1], o[2] = a[2]; }
static inline void tc_vec_add(double *o, const double *a, const double *b)
{
    o[0] = a[0] + b[0], o[1] = a[1] + b[1], o[2] = a[2] + b[2];
}
static inline void tc_vec_sub(double *o, const double *a, const double *b)
{
    o[0] = a[0] - b[0], o[1] = a[1] - b[1], o[2] = a[2] - b[2];
}
static inline void tc_vec_mul_add(double *o, const double *a, double k, const double *b) /* o = a + k b */
{
    o[0] = a[0] + k * b[0], o[1] = a[1] + k * b[1], o[2] = a[2] + k * b[2];
}
static inline double tc_vec_dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static inline void tc_vec_cross(double *o, const double *a, const double *b) /* o may not be a or b */
{
    o[0] = a[1] * b[2] - a[2] * b[1], o[1] = a[2] * b[0] - a[0] * b[2], o[2] = a[0] * b[1] - a[1] * b[0];
}
static inline double tc_vec_length(const double *a) { return sqrt(tc_vec_dot(a, a)); }
static inline double tc_vec_normalize(double *a) /* gives the former length; a zero vector stays */
{
    double l = tc_vec_length(a);
    if (l > 0)
        a[0] /= l, a[1] /= l, a[2] /= l;
    return l;
}

#endif
