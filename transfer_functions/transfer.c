/* transfer.c: the piecewise linear transfer function.
 * Emission tau(s) c(s), extinction tau(s): Weiler et al. 2003, equations 3 and 4. */
#include "transfer_functions/transfer.h"

#include "core/memory.h"
#include "transfer_functions/place.h"
#include "transfer_functions/preset.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* FNV-1a over the knots' bits (-0 as 0): equal functions have equal serials, so a table made for one serves the other.
 */
static uint64_t knots_serial(const tc_knot *knot, size_t n)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (size_t i = 0; i < n; i++) {
        const double value[5] = {knot[i].s, knot[i].r, knot[i].g, knot[i].b, knot[i].a};
        for (int k = 0; k < 5; k++) {
            const double plain = value[k] + 0.0;
            uint64_t bits;
            memcpy(&bits, &plain, sizeof bits);
            for (int byte = 0; byte < 8; byte++, bits >>= 8)
                hash = (hash ^ (bits & 0xff)) * UINT64_C(1099511628211);
        }
    }
    return hash;
}

static tc_status check_knots(const tc_knot *knot, size_t n, tc_error *err)
{
    if (!knot || n == 0)
        return tc_fail(err, TC_E_ARG, "a transfer function needs at least one knot");
    for (size_t i = 0; i < n; i++) {
        const tc_knot *k = &knot[i];
        if (!isfinite(k->s) || !isfinite(k->r) || !isfinite(k->g) || !isfinite(k->b) || !isfinite(k->a))
            return tc_fail(err, TC_E_ARG, "knot %zu of %zu of the transfer function is not finite", i, n);
        if (i > 0 && k->s < knot[i - 1].s)
            return tc_fail(err, TC_E_ARG,
                           "knot %zu of the transfer function lies at %g, before its predecessor at %g; "
                           "give the knots in ascending order",
                           i, k->s, knot[i - 1].s);
        const double rgb[3] = {k->r, k->g, k->b};
        for (int c = 0; c < 3; c++)
            if (rgb[c] < -1e-6 || rgb[c] > 1 + 1e-6)
                return tc_fail(err, TC_E_ARG, "knot %zu of the transfer function has %s = %g; colours lie in 0 to 1", i,
                               c == 0   ? "red"
                               : c == 1 ? "green"
                                        : "blue",
                               rgb[c]);
        if (k->a < 0)
            return tc_fail(err, TC_E_ARG,
                           "knot %zu of the transfer function has attenuation %g; it may not be "
                           "negative",
                           i, k->a);
    }
    return TC_OK;
}

static double clamp01(double v)
{
    return v < 0 ? 0 : v > 1 ? 1 : v;
}

tc_status tc_transfer_from_knots(tc_transfer **out, const tc_knot *knot, size_t n, tc_error *err)
{
    if (!out)
        return tc_fail(err, TC_E_ARG, "no place to put the transfer function");
    *out = NULL;
    const tc_status status = check_knots(knot, n, err);
    if (status != TC_OK)
        return status;
    tc_transfer *tf = tc_calloc(1, sizeof *tf);
    tc_knot *copy = tc_alloc(n, sizeof *copy);
    char *name = tc_strdup("knots");
    if (!tf || !copy || !name) {
        free(tf);
        free(copy);
        free(name);
        return tc_fail_memory(err, "the transfer function", n, sizeof *copy);
    }
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        /* Of several knots at one place only the outer two are ever seen. */
        if (i > 0 && i + 1 < n && knot[i - 1].s == knot[i].s && knot[i + 1].s == knot[i].s)
            continue;
        copy[kept] = knot[i];
        copy[kept].r = clamp01(knot[i].r);
        copy[kept].g = clamp01(knot[i].g);
        copy[kept].b = clamp01(knot[i].b);
        kept++;
    }
    tf->knot = copy;
    tf->n = kept;
    tf->name = name;
    tf->nan_color[0] = tf->nan_color[1] = 1;
    tf->serial = knots_serial(copy, kept);
    *out = tf;
    return TC_OK;
}

void tc_transfer_destroy(tc_transfer **tf)
{
    if (!tf || !*tf)
        return;
    free((*tf)->knot);
    free((*tf)->name);
    tc_preset_destroy(&(*tf)->preset);
    free(*tf);
    *tf = NULL;
}

const tc_knot *tc_transfer_knots(const tc_transfer *tf, size_t *n)
{
    if (n)
        *n = tf ? tf->n : 0;
    return tf ? tf->knot : NULL;
}

const char *tc_transfer_name(const tc_transfer *tf)
{
    return tf ? tf->name : NULL;
}

void tc_transfer_evaluate(double out[4], const tc_transfer *tf, double s)
{
    if (isnan(s)) {
        memcpy(out, tf->nan_color, sizeof tf->nan_color);
        return;
    }
    size_t lo = 0, hi = tf->n; /* first knot beyond s */
    while (lo < hi) {
        const size_t middle = lo + (hi - lo) / 2;
        if (tf->knot[middle].s <= s)
            lo = middle + 1;
        else
            hi = middle;
    }
    const tc_knot *a = &tf->knot[lo > 0 ? lo - 1 : 0], *b = &tf->knot[lo < tf->n ? lo : tf->n - 1];
    const double t = tc_place(s, a->s, b->s);
    out[0] = a->r + t * (b->r - a->r);
    out[1] = a->g + t * (b->g - a->g);
    out[2] = a->b + t * (b->b - a->b);
    out[3] = a->a + t * (b->a - a->a);
}

double tc_transfer_peak(const tc_transfer *tf, double lo, double hi)
{
    const tc_knot *first = tf->knot, *last = &tf->knot[tf->n - 1];
    double peak = 0;
    if (lo < first->s)
        peak = fmax(peak, first->a);
    if (hi > last->s)
        peak = fmax(peak, last->a);
    for (const tc_knot *k = first; k <= last; k++)
        if (k->s >= lo && k->s <= hi)
            peak = fmax(peak, k->a);
    for (const tc_knot *k = first; k < last; k++) {
        const double end[2] = {lo, hi};
        for (int e = 0; e < 2; e++)
            if (k[0].s < end[e] && end[e] < k[1].s)
                peak = fmax(peak, k[0].a + (k[1].a - k[0].a) * ((end[e] - k[0].s) / (k[1].s - k[0].s)));
    }
    return peak;
}

void tc_transfer_span(double out[2], const tc_transfer *tf)
{
    out[0] = tf->knot[0].s;
    out[1] = tf->knot[tf->n - 1].s;
    if (out[0] == out[1]) {
        const double widen = out[0] != 0 ? fabs(out[0]) / 1024 : 0.5;
        out[0] -= widen;
        out[1] += widen;
        if (!(out[0] < out[1])) { /* among the denormal numbers */
            out[0] = -0.5;
            out[1] = 0.5;
        }
    }
}
