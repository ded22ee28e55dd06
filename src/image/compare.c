/* compare.c: the difference of two images, in float, before any quantisation. */
#include "image/image.h"

#include <math.h>
#include <string.h>

/* |a - b|; infinite where either is not a number or where an infinity meets anything else. */
static double difference(float a, float b)
{
    if (a == b)
        return 0;
    double d = fabs((double)a - (double)b);
    return isnan(d) ? INFINITY : d;
}

static bool covered(const float *p)
{
    return p[0] != 0 || p[1] != 0 || p[2] != 0 || p[3] != 0;
}

/* The k-th smallest (from 0) of all channel differences over covered pixels, as float. The bits of non-negative floats
 * are ordered like the floats: three counts of 11, 11 and 10 bits find the value without sorting or storing. */
static float order_statistic(const tc_image *a, const tc_image *b, size_t k)
{
    static const int shift[3] = {21, 10, 0}, width[3] = {11, 11, 10};
    size_t pixels = (size_t)a->width * (size_t)a->height, count[1 << 11];
    uint32_t prefix = 0, known = 0; /* the bits found so far, and their mask */
    for (int digit = 0; digit < 3; digit++) {
        uint32_t mask = (1u << width[digit]) - 1;
        memset(count, 0, sizeof count);
        for (size_t i = 0; i < pixels; i++) {
            const float *p = a->rgba + 4 * i, *q = b->rgba + 4 * i;
            for (int c = 0; c < 4 && (c > 0 || covered(p) || covered(q)); c++) {
                float d = (float)difference(p[c], q[c]);
                uint32_t bits;
                memcpy(&bits, &d, sizeof bits);
                if ((bits & known) == prefix)
                    count[bits >> shift[digit] & mask]++;
            }
        }
        uint32_t bucket = 0;
        while (bucket < mask && k >= count[bucket])
            k -= count[bucket++];
        prefix |= bucket << shift[digit];
        known |= mask << shift[digit];
    }
    float value;
    memcpy(&value, &prefix, sizeof value);
    return value;
}

tc_status tc_image_compare(tc_compare_result *out, const tc_image *a, const tc_image *b, tc_error *err)
{
    *out = (tc_compare_result){0};
    if (!a || !b || !a->rgba || !b->rgba)
        return tc_fail(err, TC_E_ARG, "two images are needed for a comparison");
    if (a->width != b->width || a->height != b->height)
        return tc_fail(err, TC_E_ARG, "the images differ in size: %d x %d and %d x %d", a->width, a->height, b->width,
                       b->height);
    double sum = 0, squares = 0;
    out->pixels = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < out->pixels; i++) {
        const float *p = a->rgba + 4 * i, *q = b->rgba + 4 * i;
        double worst = 0;
        if (!covered(p) && !covered(q))
            continue;
        for (int c = 0; c < 4; c++) {
            double d = difference(p[c], q[c]);
            sum += d;
            squares += d * d;
            worst = d > worst ? d : worst;
        }
        out->covered++;
        out->differing += worst > 1.0 / 255;
        if (worst > out->max_abs) {
            out->max_abs = worst;
            out->worst_x = (int)(i % (size_t)a->width);
            out->worst_y = (int)(i / (size_t)a->width);
        }
    }
    if (out->covered > 0) {
        size_t n = 4 * out->covered, k = n - 1 - n / 1000; /* n/1000 values may be larger */
        out->mean_abs = sum / (double)n;
        out->rms = sqrt(squares / (double)n);
        out->p999_abs = out->max_abs > 0 ? order_statistic(a, b, k) : 0;
    }
    return TC_OK;
}
