/* ticks.h: round numbers in a range, and how they are written. */
#ifndef TC_FIGURE_TICKS_H
#define TC_FIGURE_TICKS_H

#include "core/status.h"

enum { TC_TICKS_MAX = 12, TC_TICK_TEXT = 48, TC_TICKS_MINOR_MAX = 64 };

typedef struct tc_ticks {
    int n;
    double value[TC_TICKS_MAX];            /* ascending, within the range */
    char text[TC_TICKS_MAX][TC_TICK_TEXT]; /* UTF-8, of one form; no two alike */
    int n_minor;
    double minor[TC_TICKS_MINOR_MAX]; /* without text: 2 … 9 within a decade */
} tc_ticks;

/* Multiples of 1, 2, 2.5 or 5 times a power of ten in [lo, hi] (log: also of mantissas 1, 2, 5 in each decade, or every
 * so many decades), as many as there may be up to `most`, 2 … TC_TICKS_MAX. With most = 7 there are 4 to 7, but where
 * doubles between lo and hi are too few. lo = hi, or nearly so: that one value. lo > 0 with log. */
void tc_ticks_make(tc_ticks *out, double lo, double hi, bool log, int most);

/* One number by itself, written alike; out [TC_TICK_TEXT]. */
void tc_ticks_write(char *out, double value);

#endif
