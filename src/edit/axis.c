/* axis.c: places along an axis, and marks at round numbers. A mark's number is an integer times a power of ten until it
 * is written, so that 0.3 is "0.3" and lies where the double 0.3 lies. */
#include "edit/axis.h"

#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

double tc_axis_place(const tc_axis *axis, double value)
{
    if (!axis->log)
        return value / axis->top;
    double least = axis->top * pow(10, -axis->decades);
    if (!(value >= least)) /* NaN stays NaN */
        return axis->foot * (value / least);
    double place = axis->foot + (1 - axis->foot) * (1 + log10(value / axis->top) / axis->decades);
    return place > axis->foot ? place : axis->foot;
}

double tc_axis_value(const tc_axis *axis, double place)
{
    if (!axis->log)
        return place * axis->top;
    if (!(place > axis->foot))
        return axis->top * pow(10, -axis->decades) * (place / axis->foot);
    return axis->top * pow(10, axis->decades * ((place - axis->foot) / (1 - axis->foot) - 1));
}

/* What marks are put on: the opacity axis, or a range. */
typedef struct tc_scale {
    const tc_axis *axis; /* NULL: a range */
    double lo, hi;       /* of the values that are marked */
    bool log;
} tc_scale;

static double tc_scale_place(const tc_scale *scale, double value)
{
    double place = scale->axis  ? tc_axis_place(scale->axis, value)
                   : scale->log ? (log(value) - log(scale->lo)) / (log(scale->hi) - log(scale->lo))
                                : (value / 2 - scale->lo / 2) / (scale->hi / 2 - scale->lo / 2);
    return place < 0 ? 0 : place > 1 ? 1 : place;
}

/* m 10^e: rounded once, whatever e is; the text has no decimal point that a locale could ask for. */
static double tc_round_value(int64_t m, int e)
{
    char text[48];
    snprintf(text, sizeof text, "%" PRId64 "e%d", m, e);
    return strtod(text, NULL);
}

/* Writes m 10^e, |m| < 10^16: plain from 0.0001 to a million, else as 2.5e-7. */
static void tc_round_write(char out[24], int64_t m, int e)
{
    if (m == 0) {
        strcpy(out, "0");
        return;
    }
    for (; m % 10 == 0; m /= 10)
        e++;
    char digit[24];
    int n = snprintf(digit, sizeof digit, "%" PRId64, m < 0 ? -m : m);
    int power = n - 1 + e; /* of the first digit */
    const char *sign = m < 0 ? "-" : "";
    if (power < -4 || power >= 6)
        snprintf(out, 24, "%s%c%s%.15se%d", sign, digit[0], n > 1 ? "." : "", digit + 1, power);
    else if (power < 0)
        snprintf(out, 24, "%s0.%.*s%.16s", sign, -power - 1, "000", digit);
    else if (n <= power + 1)
        snprintf(out, 24, "%s%.6s%.*s", sign, digit, power + 1 - n, "00000");
    else
        snprintf(out, 24, "%s%.*s.%.15s", sign, power + 1, digit, digit + power + 1);
}

/* A list of marks that is being filled; n goes on counting where it is full. */
typedef struct tc_marks {
    tc_axis_tick *out;
    size_t capacity, n;
} tc_marks;

static void tc_marks_add(tc_marks *marks, const tc_scale *scale, int64_t m, int e, bool label)
{
    if (marks->n < marks->capacity) {
        tc_axis_tick *tick = &marks->out[marks->n];
        tick->place = tc_scale_place(scale, tc_round_value(m, e));
        tick->label[0] = 0;
        if (label)
            tc_round_write(tick->label, m, e);
    }
    marks->n++;
}

/* Multiples of a step of 1, 2, 2.5 or 5 times a power of ten, the smallest that `labels` suffice for. */
static void tc_linear_marks(tc_marks *marks, const tc_scale *scale, size_t labels, bool small)
{
    static const struct {
        int step, part; /* in tenths of the power of ten: of labels, and of small marks */
    } round[] = {{10, 2}, {20, 5}, {25, 5}, {50, 10}};
    const double lo = scale->lo, hi = scale->hi;
    int e = (int)floor(log10(fmax((hi / 2 - lo / 2) / (double)labels * 2, 5e-324))) - 2; /* of the tenths */
    for (size_t i = 0;; i = (i + 1) % 4, e += i == 0) {
        const double step = tc_round_value(round[i].step, e), part = tc_round_value(round[i].part, e);
        if (!(part > 0) || fabs(lo / step) > 1e14 || fabs(hi / step) > 1e14) {
            if (step > fmax(fabs(lo), fabs(hi)))
                return;
            continue;
        }
        /* an end that is meant to be a multiple is one, whatever was rounded */
        const double shy = 1e-9;
        if (floor(hi / step + shy) - ceil(lo / step - shy) + 1 > (double)labels)
            continue;
        const int64_t first = (int64_t)ceil(lo / part - shy), last = (int64_t)floor(hi / part + shy);
        for (int64_t k = first; k <= last; k++) {
            const int64_t m = k * round[i].part;
            const bool label = m % round[i].step == 0;
            if (label || small)
                tc_marks_add(marks, scale, m, e, label);
        }
        return;
    }
}

/* Powers of ten in lo … hi, and what lies between them. */
static void tc_log_marks(tc_marks *marks, const tc_scale *scale, size_t labels, bool small)
{
    const double shy = 1e-9;
    const double lo = log10(scale->lo) - shy, hi = log10(scale->hi) + shy;
    const int first = (int)floor(lo), last = (int)floor(hi);
    size_t count[10] = {0}; /* of the numbers of that mantissa */
    for (int e = first; e <= last; e++)
        for (int m = 1; m < 10; m++)
            count[m] += log10(m) + e >= lo && log10(m) + e <= hi;
    const size_t fine = count[1] + count[2] + count[5];
    const bool more = fine <= labels; /* 2 and 5 have labels too */
    if (!scale->axis && count[1] < 2 && (!more || fine < 3)) {
        tc_linear_marks(marks, scale, labels, small);
        return;
    }
    const int stride = more ? 1 : (int)((count[1] + labels - 1) / labels);
    for (int e = first; e <= last; e++)
        for (int m = 1; m < 10; m++) {
            if (!(log10(m) + e >= lo && log10(m) + e <= hi))
                continue;
            const bool label = m == 1 ? e % stride == 0 : more && (m == 2 || m == 5);
            if (label || (small && (m == 1 || stride == 1)))
                tc_marks_add(marks, scale, m, e, label);
        }
}

static size_t tc_marks_make(tc_axis_tick *out, size_t capacity, const tc_scale *scale, int labels)
{
    if (labels < 1 || capacity < 1)
        return 0;
    const size_t most = (size_t)labels < capacity ? (size_t)labels : capacity;
    for (int small = 1; small >= 0; small--) {
        tc_marks marks = {.out = out, .capacity = capacity};
        const bool foot = scale->axis && scale->log;
        if (foot)
            tc_marks_add(&marks, scale, 0, 0, true);
        if (!foot || most > 1) {
            if (scale->log)
                tc_log_marks(&marks, scale, most - foot, small);
            else
                tc_linear_marks(&marks, scale, most, small);
        }
        if (marks.n <= capacity)
            return marks.n;
    }
    return 0; /* labels alone are never more than capacity */
}

size_t tc_axis_ticks(tc_axis_tick *out, size_t capacity, const tc_axis *axis, int labels)
{
    tc_scale scale = {.axis = axis, .hi = axis->top, .log = axis->log};
    if (axis->log)
        scale.lo = axis->top * pow(10, -axis->decades);
    if (!(axis->top > 0 && isfinite(axis->top)) ||
        (axis->log && !(scale.lo > 0 && scale.lo < axis->top && axis->foot > 0 && axis->foot < 1)))
        return 0;
    return tc_marks_make(out, capacity, &scale, labels);
}

size_t tc_range_ticks(tc_axis_tick *out, size_t capacity, double lo, double hi, bool log, int labels)
{
    if (!(lo < hi && isfinite(lo) && isfinite(hi)) || (log && !(lo > 0)))
        return 0;
    return tc_marks_make(out, capacity, &(tc_scale){.lo = lo, .hi = hi, .log = log}, labels);
}
