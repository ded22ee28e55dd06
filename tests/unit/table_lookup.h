/* table_lookup.h: entries of a table as a texture gives them, and functions that tables must hold. After cmocka. */
#ifndef TC_TESTS_UNIT_TABLE_LOOKUP_H
#define TC_TESTS_UNIT_TABLE_LOOKUP_H

#include "transfer_functions/table.h"
#include "transfer_make.h"

#include <math.h>
#include <stdlib.h>

/* Entry of a table of floats. */
static inline const float *entry(const tc_table *table, int front, int back, int k)
{
    return (const float *)table->rgba +
           4 * ((size_t)front + (size_t)table->size[0] * ((size_t)back + (size_t)table->size[1] * (size_t)k));
}

/* Channel c of a table of floats, linear between entries; place: in entries from 0, along each axis. */
static inline double between_entries(const tc_table *table, const double place[3], int c)
{
    int low[3];
    double t[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        low[i] = (int)floor(place[i]);
        low[i] = low[i] > table->size[i] - 2 ? table->size[i] - 2 : low[i];
        t[i] = place[i] - low[i];
    }
    for (int corner = 0; corner < 8; corner++) {
        const int d[3] = {corner & 1, corner >> 1 & 1, corner >> 2};
        double weight = 1;
        for (int i = 0; i < 3; i++)
            weight *= d[i] ? t[i] : 1 - t[i];
        sum += weight * entry(table, low[0] + d[0], low[1] + d[1], low[2] + d[2])[c];
    }
    return sum;
}

/* The value of finite half bits. */
static inline float half_value(uint16_t h)
{
    const int exponent = h >> 10 & 31, mantissa = h & 1023;
    const float v = exponent == 0 ? ldexpf((float)mantissa, -24) : ldexpf((float)(mantissa + 1024), exponent - 25);
    return h & 0x8000 ? -v : v;
}

/* Extinction that no float holds, none at all, and one knot: 1 / 2^c in channel c, extinction 2. */
static const struct {
    tc_knot knot[4];
    size_t n;
} extremes[] = {{{{0, 1, 0, 0, 0}, {0.5, 1, 1, 1, 1e300}, {0.5, 1, 1, 1, 0}, {1, 0, 0, 1, 1e5}}, 4},
                {{{0, 1, 1, 1, 0}, {1, 1, 1, 1, 0}}, 2},
                {{{0.3, 1, 0.5, 0.25, 2}}, 1}};
enum { HUGE_EXTINCTION, NO_EXTINCTION, ONE_KNOT, EXTREMES };

/* n knots of random colour and extinction, evenly from 0 to 1; the caller's to free. */
static inline tc_knot *random_knots(int n)
{
    tc_knot *knot = malloc((size_t)n * sizeof *knot);
    uint64_t seed = 11;
    assert_non_null(knot);
    for (int i = 0; i < n; i++)
        knot[i] = (tc_knot){i / (n - 1.0), random01(&seed), random01(&seed), random01(&seed), random01(&seed)};
    return knot;
}

#endif
