/* ticks.c: steps as by P. Heckbert, Nice Numbers for Graph Labels (Graphics Gems, 1990), inside of the range, with 2.5.
 */
#include "figure/ticks.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const SUPERSCRIPT[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};

/* As "−1.25" or "−1.25×10⁻⁵" with that many digits after the point. Minus and power are signs of their own. */
static void write_number(char *out, double value, int decimals, bool scientific, bool mantissa)
{
    char plain[400], *p = out, *end = out + TC_TICK_TEXT - 1;
    snprintf(plain, sizeof plain, scientific ? "%.*e" : "%.*f", decimals, value == 0 ? 0.0 : value);
    char *e = scientific ? strchr(plain, 'e') : NULL;
    int power = 0;
    if (e) {
        sscanf(e + 1, "%d", &power);
        *e = 0;
    }
    char text[450];
    int length = 0;
    for (const char *s = plain; *s; s++)
        length += snprintf(text + length, sizeof text - (size_t)length, *s == '-' ? "−" : "%c", *s);
    if (e && value != 0) {
        if (!mantissa) /* 10⁵, not 1×10⁵ */
            length = snprintf(text, sizeof text, "%s10", value < 0 ? "−" : "");
        else
            length += snprintf(text + length, sizeof text - (size_t)length, "×10");
        char digits[12];
        snprintf(digits, sizeof digits, "%d", power);
        for (const char *s = digits; *s; s++)
            length +=
                snprintf(text + length, sizeof text - (size_t)length, "%s", *s == '-' ? "⁻" : SUPERSCRIPT[*s - '0']);
    } else if (e) {
        length = snprintf(text, sizeof text, "0");
    }
    for (const char *s = text; *s && p < end; s++)
        *p++ = *s;
    *p = 0;
}

/* Digits after the point that value needs, of %e or %f, at most 17, to be right to a millionth of scale. */
static int decimals_of(double value, double scale, bool scientific)
{
    for (int d = 0; d < 17; d++) {
        char text[400];
        double read;
        snprintf(text, sizeof text, scientific ? "%.*e" : "%.*f", d, value);
        if (sscanf(text, "%lf", &read) == 1 && fabs(read - value) <= 1e-6 * scale)
            return d;
    }
    return 17;
}

static bool is_power(double value)
{
    double power = log10(value);
    return fabs(power - round(power)) < 1e-9;
}

/* Texts of all values: one form, and one number of digits. scale: that of their differences; 0: each by itself. */
static void write_all(tc_ticks *t, double scale)
{
    double largest = 0, least = DBL_MAX;
    for (int i = 0; i < t->n; i++) {
        double a = fabs(t->value[i]);
        largest = fmax(largest, a);
        least = a > 0 ? fmin(least, a) : least;
    }
    /* Up to six figures before the point, up to four noughts behind it. */
    bool scientific = largest >= 1e6 || (largest > 0 && (scale > 0 ? scale < 1e-5 && largest < 1e-2 : least < 1e-4));
    int decimals = 0;
    for (int i = 0; i < t->n; i++) {
        int d = decimals_of(t->value[i], scale > 0 ? scale : fabs(t->value[i]), scientific);
        decimals = scale > 0 && d < decimals ? decimals : d;
        if (!(scale > 0))
            write_number(t->text[i], t->value[i], d, scientific, !is_power(t->value[i]));
    }
    for (int i = 0; i < t->n && scale > 0; i++)
        write_number(t->text[i], t->value[i], decimals, scientific, true);
}

void tc_ticks_write(char *out, double value)
{
    tc_ticks one = {.n = 1, .value = {value}};
    write_all(&one, 0);
    memcpy(out, one.text[0], sizeof one.text[0]);
}

/* Multiples of step in [lo, hi]; counts all, keeps TC_TICKS_MAX. The ends hold to a billionth of the step. */
static int multiples(double *value, double lo, double hi, double step)
{
    double first = ceil(lo / step - 1e-9), last = floor(hi / step + 1e-9);
    if (!(last - first < 1e6) || fabs(first) > 9e15 || fabs(last) > 9e15)
        return 1 << 20;
    int n = (int)(last - first) + 1;
    for (int i = 0; i < n && i < TC_TICKS_MAX; i++)
        value[i] = fmin(fmax((first + i) * step, lo), hi);
    return n;
}

/* step = mantissa × 10^power without the rounding of a negative power. */
static double step_of(double mantissa, int power)
{
    return power >= 0 ? mantissa * pow(10, power) : mantissa / pow(10, -power);
}

static void linear(tc_ticks *t, double lo, double hi, int most)
{
    static const double mantissa[] = {1, 2, 2.5, 5};
    int power = (int)floor(log10((hi - lo) / most)) - 1;
    for (int i = 0; i < 16; i++) {
        double step = step_of(mantissa[i % 4], power + i / 4);
        int n = step > 0 ? multiples(t->value, lo, hi, step) : 1 << 20;
        if (n > most)
            continue;
        t->n = n;
        write_all(t, step);
        return;
    }
}

static bool is_apart(const tc_ticks *t)
{
    for (int i = 0; i + 1 < t->n; i++)
        if (!strcmp(t->text[i], t->text[i + 1]))
            return false;
    return t->n > 0;
}

/* Powers of ten with the mantissas of a set, within the range. */
static int decades(double *value, double lo, double hi, const int *mantissa, int n_mantissa, int stride)
{
    int n = 0, first = (int)floor(log10(lo)) - 1, last = (int)ceil(log10(hi)) + 1;
    for (int p = first; p <= last; p++)
        for (int i = 0; i < n_mantissa; i++) {
            double v = step_of(mantissa[i], p);
            if (((p % stride) + stride) % stride != 0 || v < lo * (1 - 1e-12) || v > hi * (1 + 1e-12))
                continue;
            if (n < TC_TICKS_MAX)
                value[n] = fmin(fmax(v, lo), hi);
            n++;
        }
    return n;
}

static bool logarithmic(tc_ticks *t, double lo, double hi, int most)
{
    static const int set[] = {1, 2, 5}, halves[] = {1, 3};
    int least = most < 7 ? 2 : 4;
    if (hi / lo < 2.5)
        return false;
    t->n = decades(t->value, lo, hi, set, 3, 1);
    if (t->n > most)
        t->n = decades(t->value, lo, hi, halves, 2, 1);
    int stride = 1;
    for (; t->n > most; stride++)
        t->n = decades(t->value, lo, hi, set, 1, stride);
    if (t->n < least)
        return false;
    write_all(t, 0);
    if (log10(hi / lo) > 7 || stride > 2)
        return true;
    for (int p = (int)floor(log10(lo)); p <= (int)ceil(log10(hi)); p++)
        for (int m = 1; m <= 9; m++) {
            double v = step_of(m, p);
            bool labelled = false;
            for (int i = 0; i < t->n; i++)
                labelled = labelled || fabs(t->value[i] - v) <= 1e-9 * v;
            if (v > lo && v < hi && !labelled && t->n_minor < TC_TICKS_MINOR_MAX)
                t->minor[t->n_minor++] = v;
        }
    return true;
}

void tc_ticks_make(tc_ticks *out, double lo, double hi, bool log, int most)
{
    memset(out, 0, sizeof *out);
    most = most < 2 ? 2 : most > TC_TICKS_MAX ? TC_TICKS_MAX : most;
    double size = fmax(fabs(lo), fabs(hi));
    if (hi - lo > 1e-12 * size && hi - lo < DBL_MAX / 16 && hi - lo > DBL_MIN * 1e6) {
        if (log && logarithmic(out, lo, hi, most))
            return;
        memset(out, 0, sizeof *out);
        linear(out, lo, hi, most);
        if (is_apart(out))
            return;
    }
    memset(out, 0, sizeof *out);
    out->n = 1;
    out->value[0] = lo + 0.5 * (hi - lo);
    write_all(out, size > 0 ? 1e-3 * size : 1);
}
