/* axis.h: from values to places along an axis of the editor and back, linear or logarithmic with 0 at its foot. */
#ifndef TC_EDIT_AXIS_H
#define TC_EDIT_AXIS_H

#include <stdbool.h>
#include <stddef.h>

/* The opacity axis. log: places are even in the logarithm from top down to top / 10^decades, below which a stretch of `foot` of the
 * axis falls linearly to 0, so that 0 is on it and every value above has a place of its own. */
typedef struct tc_axis {
    double top;     /* the value at place 1 */
    bool log;
    double decades; /* 5 */
    double foot;    /* 0.06 */
} tc_axis;

/* Between value (0 … top and beyond) and place (0 … 1 and beyond); each other's inverses to 1e-12. */
double tc_axis_place(const tc_axis *axis, double value);
double tc_axis_value(const tc_axis *axis, double place);

/* One mark of an axis. */
typedef struct tc_axis_tick {
    double place;
    char label[24]; /* "" of a small one */
} tc_axis_tick;

/* Marks into out [capacity], their number as result: labels at some `labels` of them at most, at round values (1, 2, 2.5, 5 times a power
 * of ten; powers of ten on a logarithmic axis, and 0 at its foot). */
size_t tc_axis_ticks(tc_axis_tick *out, size_t capacity, const tc_axis *axis, int labels);
/* The same of the scalar axis: lo to hi, logarithmic over the whole of it where log is set. */
size_t tc_range_ticks(tc_axis_tick *out, size_t capacity, double lo, double hi, bool log, int labels);

#endif
