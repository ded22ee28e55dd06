/* shapes.c: curves of opacity by their few numbers, and from a line that was drawn by hand.
 * Thinning: U. Ramer 1972; D. Douglas and T. Peucker 1973, with the distance along a, since the curve is a function of
 * x. */
#include "edit/document.h"

#include <math.h>

/* The bell over t in [-1, 1], 0 at both ends: 3 standard deviations each way. */
static double bell(double t)
{
    const double end = exp(-4.5);
    return (exp(-4.5 * t * t) - end) / (1 - end);
}

static tc_edit_point point_at(double x, double a)
{
    return (tc_edit_point){.x = x, .a = fmax(0, a), .midpoint = 0.5};
}

size_t tc_shape_gaussian(tc_edit_point *out, size_t capacity, double from, double to, double height, double floor)
{
    /* Places at which lines are off by about the same everywhere: as dense as the root of the second derivative. */
    enum { HALF = 10, STEPS = 4096 };
    if (capacity < 2 * HALF + 1)
        return 0;
    double sum[STEPS + 1] = {0};
    for (int i = 0; i < STEPS; i++) {
        const double t = (i + 0.5) / STEPS, z = 3 * t;
        sum[i + 1] = sum[i] + sqrt(fabs(z * z - 1) * exp(-0.5 * z * z));
    }
    const double middle = 0.5 * from + 0.5 * to, half = 0.5 * to - 0.5 * from;
    for (int k = 0, i = 0; k <= HALF; k++) {
        const double wanted = sum[STEPS] * k / HALF;
        while (i < STEPS - 1 && sum[i + 1] < wanted)
            i++;
        const double t = k == HALF ? 1 : (i + (wanted - sum[i]) / (sum[i + 1] - sum[i])) / STEPS;
        const double a = floor + (height - floor) * bell(t);
        out[HALF - k] = point_at(k == HALF ? from : middle - half * t, a);
        out[HALF + k] = point_at(k == HALF ? to : middle + half * t, a);
    }
    return 2 * HALF + 1;
}

size_t tc_shape_trapezoid(tc_edit_point *out, size_t capacity, double from, double to, double share, double height,
                          double floor)
{
    const double part = share > 0 ? fmin(share, 1) : 0;
    const size_t n = part > 0 ? 4 : 3;
    if (capacity < n)
        return 0;
    const double middle = 0.5 * from + 0.5 * to, half = part * (0.5 * to - 0.5 * from);
    out[0] = point_at(from, floor);
    out[1] = point_at(part < 1 ? middle - half : from, height);
    if (n == 4)
        out[2] = point_at(part < 1 ? middle + half : to, height);
    out[n - 1] = point_at(to, floor);
    return n;
}

size_t tc_shape_step(tc_edit_point *out, size_t capacity, double from, double to, double height, double floor)
{
    return tc_shape_trapezoid(out, capacity, from, to, 1, height, floor);
}

/* The last of those at i's place. */
static size_t last_there(const double *x, size_t i, size_t n)
{
    while (i + 1 < n && x[i + 1] == x[i])
        i++;
    return i;
}

/* Of what is between i and j, what is furthest from their line, and further than error; i: nothing is. */
static size_t furthest(const double *x, const double *a, size_t i, size_t j, double error)
{
    size_t found = i;
    for (size_t k = i + 1; k < j; k++) {
        const double t = (x[k] - x[i]) / (x[j] - x[i]);
        const double off = fabs(fmax(0, a[k]) - (fmax(0, a[i]) * (1 - t) + fmax(0, a[j]) * t));
        if (off > error && x[k + 1] > x[k]) { /* else a later one is at its place */
            error = off;
            found = k;
        }
    }
    return found;
}

size_t tc_shape_freehand(tc_edit_point *out, size_t capacity, const double *x, const double *a, size_t n, double error)
{
    if (n == 0 || capacity == 0)
        return 0;
    size_t i = last_there(x, 0, n), kept = 0, waiting = 0;
    out[kept++] = point_at(x[i], a[i]);
    if (i == n - 1)
        return kept;
    /* Ends of what is still to be looked at wait, as indices, at the end of out: each will be a point. */
    if (kept + waiting >= capacity)
        return 0;
    out[capacity - ++waiting].x = (double)(n - 1);
    while (waiting > 0) {
        const size_t j = (size_t)out[capacity - waiting].x, k = furthest(x, a, i, j, error);
        if (k == i) {
            waiting--;
            out[kept++] = point_at(x[j], a[j]);
            i = j;
        } else if (kept + waiting >= capacity) {
            return 0;
        } else {
            out[capacity - ++waiting].x = (double)k;
        }
    }
    return kept;
}
