/* piece.c: interpolation as in vtkPiecewiseFunction: t is bent so that 1/2 comes at the midpoint; a sharpness s between
 * turns the line into a cubic Hermite curve whose place is raised to the power 1 + 10 s on either side of 1/2 and whose
 * slopes fall with s. */
#include "edit/piece.h"

#include <math.h>
#include <stdbool.h>

enum { SAMPLES = 65, GRID = 16 };

/* Below 0.01 VTK has lines. */
static bool is_straight(tc_bend bend)
{
    return bend.sharpness < 0.01;
}

double tc_piece_value(double a, double b, double t, tc_bend bend)
{
    const double middle = fmax(0.00001, fmin(0.99999, bend.midpoint)), s = bend.sharpness;
    t = t < middle ? 0.5 * t / middle : 0.5 + 0.5 * (t - middle) / (1 - middle);
    if (s > 0.99)
        return t < 0.5 ? a : b;
    if (is_straight(bend))
        return fmax(fmin(a, b), fmin(fmax(a, b), a * (1 - t) + b * t));
    if (t < 0.5)
        t = 0.5 * pow(2 * t, 1 + 10 * s);
    else if (t > 0.5)
        t = 1 - 0.5 * pow(2 * (1 - t), 1 + 10 * s);
    const double rise = t * t * (3 - 2 * t), slope = (1 - s) * (b - a);
    const double value = a * (1 - rise) + b * rise + slope * t * (1 - t) * (1 - 2 * t);
    return fmax(fmin(a, b), fmin(fmax(a, b), value));
}

/* Sum of squares between a curve of that bend and samples, of a curve from 0 to 1. */
static double misfit(const double y[SAMPLES], tc_bend bend)
{
    double sum = 0;
    for (int k = 1; k < SAMPLES - 1; k++) {
        const double off = tc_piece_value(0, 1, (double)k / (SAMPLES - 1), bend) - y[k];
        sum += off * off;
    }
    return sum;
}

static void take_better(tc_bend *best, double *least, const double y[SAMPLES], tc_bend bend)
{
    bend.midpoint = fmax(0, fmin(1, bend.midpoint));
    bend.sharpness = fmax(0, fmin(1, bend.sharpness));
    const double off = misfit(y, bend);
    if (off < *least) {
        *least = off;
        *best = bend;
    }
}

/* Where the samples, which ascend, come to 1/2. */
static double crossing(const double y[SAMPLES])
{
    int k = 1;
    while (k < SAMPLES - 1 && y[k] < 0.5)
        k++;
    const double rise = y[k] - y[k - 1];
    return (k - 1 + (rise > 0 ? fmax(0, fmin(1, (0.5 - y[k - 1]) / rise)) : 0)) / (SAMPLES - 1);
}

tc_bend tc_piece_part(double a, double b, tc_bend bend, double from, double to)
{
    const tc_bend line = {0.5, 0};
    const double low = tc_piece_value(0, 1, from, bend), rise = tc_piece_value(0, 1, to, bend) - low;
    if (!(rise > 0) || a == b || (is_straight(bend) && bend.midpoint == 0.5))
        return line;
    double y[SAMPLES], least = INFINITY;
    for (int k = 0; k < SAMPLES; k++)
        y[k] = (tc_piece_value(0, 1, from + (to - from) * k / (SAMPLES - 1), bend) - low) / rise;
    tc_bend best = line;
    take_better(&best, &least, y, line);
    const double middle[2] = {(bend.midpoint - from) / (to - from), crossing(y)}; /* a step's place is the first */
    for (int m = 0; m < 2; m++)
        take_better(&best, &least, y, (tc_bend){middle[m], bend.sharpness});
    for (int m = 0; m <= GRID; m++)
        for (int s = 0; s <= GRID; s++)
            take_better(&best, &least, y, (tc_bend){(double)m / GRID, (double)s / GRID});
    for (double step = 0.5 / GRID; step > 1e-5 && least > 1e-12;) {
        const double before = least;
        for (int way = 0; way < 8; way++) {
            const double along[8] = {1, -1, 0, 0, 1, 1, -1, -1}, up[8] = {0, 0, 1, -1, 1, -1, 1, -1};
            take_better(&best, &least, y,
                        (tc_bend){best.midpoint + along[way] * step, best.sharpness + up[way] * step});
        }
        if (!(least < before))
            step *= 0.5;
    }
    return best;
}
