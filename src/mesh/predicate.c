/* predicate.c: the exact sign of a tet's volume.
 * The filter is a forward error bound of the 3x3 determinant of differences (as Shewchuk 1997, "Adaptive Precision
 * Floating-Point Arithmetic", eq. for orient3d: (7 + 56 u) u times the permanent; 1e-15 is above it), widened by a term
 * for underflow. The exact part writes every double as an integer times one common power of two and evaluates
 * the determinant in long integers, so neither overflow, underflow nor contraction to FMA can touch the sign. */
#include "mesh/predicate.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Coordinates span at most 2^1024 … 2^-1074: 2098 bits, their differences 2099, products of three 6297, sums of
 * six such products 6300 bits: 197 words. */
enum { MAX_WORDS = 208 };

typedef struct big {
    int sign; /* -1, 0, 1 */
    int n;    /* words in use; the last one is not 0 */
    uint32_t word[MAX_WORDS];
} big;

/* x = ± mantissa * 2^exponent with an odd mantissa; false for 0. */
static int split(double x, uint64_t *mantissa, int *exponent)
{
    int e;
    double m = frexp(fabs(x), &e);
    if (m == 0)
        return 0;
    uint64_t k = (uint64_t)ldexp(m, 53);
    e -= 53;
    while (!(k & 1))
        k >>= 1, e++;
    *mantissa = k, *exponent = e;
    return 1;
}

static void big_trim(big *o)
{
    while (o->n > 0 && o->word[o->n - 1] == 0)
        o->n--;
    if (o->n == 0)
        o->sign = 0;
}

/* o = x / 2^base */
static void big_from_double(big *o, double x, int base)
{
    uint64_t k;
    int e;
    o->n = 0, o->sign = 0;
    if (!split(x, &k, &e))
        return;
    int shift = e - base, first = shift / 32, bit = shift % 32;
    memset(o->word, 0, (size_t)(first + 3) * sizeof o->word[0]);
    uint64_t low = k << bit, high = bit ? k >> (64 - bit) : 0;
    o->word[first] = (uint32_t)low;
    o->word[first + 1] = (uint32_t)(low >> 32);
    o->word[first + 2] = (uint32_t)high;
    o->n = first + 3;
    o->sign = x < 0 ? -1 : 1;
    big_trim(o);
}

static int compare_magnitude(const big *a, const big *b)
{
    if (a->n != b->n)
        return a->n < b->n ? -1 : 1;
    for (int i = a->n - 1; i >= 0; i--)
        if (a->word[i] != b->word[i])
            return a->word[i] < b->word[i] ? -1 : 1;
    return 0;
}

/* o = a + sign * b; o may not be a or b */
static void big_add(big *o, const big *a, const big *b, int sign)
{
    int sb = b->sign * sign;
    if (sb == 0) {
        o->sign = a->sign, o->n = a->n;
        memcpy(o->word, a->word, (size_t)a->n * sizeof a->word[0]);
        return;
    }
    if (a->sign == 0) {
        o->sign = sb, o->n = b->n;
        memcpy(o->word, b->word, (size_t)b->n * sizeof b->word[0]);
        return;
    }
    const big *l = a, *s = b; /* larger and smaller magnitude */
    int order = compare_magnitude(a, b);
    o->sign = a->sign;
    if (order < 0)
        l = b, s = a, o->sign = sb;
    o->n = l->n;
    if (a->sign == sb) {
        uint64_t carry = 0;
        for (int i = 0; i < l->n; i++) {
            carry += (uint64_t)l->word[i] + (i < s->n ? s->word[i] : 0);
            o->word[i] = (uint32_t)carry;
            carry >>= 32;
        }
        if (carry)
            o->word[o->n++] = (uint32_t)carry;
    } else {
        int64_t borrow = 0;
        for (int i = 0; i < l->n; i++) {
            int64_t d = (int64_t)l->word[i] - (i < s->n ? s->word[i] : 0) - borrow;
            borrow = d < 0;
            o->word[i] = (uint32_t)d;
        }
    }
    big_trim(o);
}

/* o = a * b; o may not be a or b */
static void big_mul(big *o, const big *a, const big *b)
{
    o->sign = a->sign * b->sign;
    o->n = 0;
    if (o->sign == 0)
        return;
    o->n = a->n + b->n;
    memset(o->word, 0, (size_t)o->n * sizeof o->word[0]);
    for (int i = 0; i < a->n; i++) {
        uint64_t carry = 0;
        for (int j = 0; j < b->n; j++) {
            carry += (uint64_t)a->word[i] * b->word[j] + o->word[i + j];
            o->word[i + j] = (uint32_t)carry;
            carry >>= 32;
        }
        o->word[i + b->n] = (uint32_t)carry;
    }
    big_trim(o);
}

/* o = a*d - b*c */
static void big_minor(big *o, const big *a, const big *b, const big *c, const big *d)
{
    big p, q;
    big_mul(&p, a, d);
    big_mul(&q, b, c);
    big_add(o, &p, &q, -1);
}

int tc_orient3d_exact(const double *a, const double *b, const double *c, const double *d)
{
    const double *point[4] = {a, b, c, d};
    int base = INT_MAX;
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) {
            uint64_t mantissa;
            int e;
            if (split(point[i][k], &mantissa, &e) && e < base)
                base = e;
        }
    if (base == INT_MAX)
        return 0;
    big origin, x, row[3][3];
    for (int k = 0; k < 3; k++) {
        big_from_double(&origin, a[k], base);
        for (int i = 0; i < 3; i++) {
            big_from_double(&x, point[i + 1][k], base);
            big_add(&row[i][k], &x, &origin, -1);
        }
    }
    big minor, product, sum, total;
    big_minor(&minor, &row[0][1], &row[0][2], &row[1][1], &row[1][2]);
    big_mul(&total, &minor, &row[2][0]);
    big_minor(&minor, &row[0][2], &row[0][0], &row[1][2], &row[1][0]);
    big_mul(&product, &minor, &row[2][1]);
    big_add(&sum, &total, &product, 1);
    big_minor(&minor, &row[0][0], &row[0][1], &row[1][0], &row[1][1]);
    big_mul(&product, &minor, &row[2][2]);
    big_add(&total, &sum, &product, 1);
    return total.sign;
}

int tc_orient3d(const double *a, const double *b, const double *c, const double *d)
{
    double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    double wx = d[0] - a[0], wy = d[1] - a[1], wz = d[2] - a[2];
    double uyvz = uy * vz, uzvy = uz * vy, uzvx = uz * vx, uxvz = ux * vz, uxvy = ux * vy, uyvx = uy * vx;
    double det = wx * (uyvz - uzvy) + wy * (uzvx - uxvz) + wz * (uxvy - uyvx);
    double ax = fabs(wx), ay = fabs(wy), az = fabs(wz);
    double permanent = ax * (fabs(uyvz) + fabs(uzvy)) + ay * (fabs(uzvx) + fabs(uxvz)) + az * (fabs(uxvy) + fabs(uyvx));
    double bound = 1e-15 * permanent + 1e-200 * (1 + ax + ay + az);
    if (det > bound) /* false for NaN and for two infinities */
        return 1;
    if (-det > bound)
        return -1;
    return tc_orient3d_exact(a, b, c, d);
}
