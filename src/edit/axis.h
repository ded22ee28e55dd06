/* axis.h: from values to places along an axis of the editor and back, linear or logarithmic with 0 at its foot; and
 * round numbers to mark it with. Nothing here depends on the locale. */
#ifndef TC_EDIT_AXIS_H
#define TC_EDIT_AXIS_H

#include <stdbool.h>
#include <stddef.h>

/* The opacity axis. log: places are even in the logarithm from top down to top / 10^decades, below which a stretch of
 * `foot` of the axis falls linearly to 0, so that 0 is on it and every value above has a place of its own. */
typedef struct tc_axis {
    double top;     /* the value at place 1; above 0 */
    bool log;
    double decades; /* 5; above 0 */
    double foot;    /* 0.06; above 0, below 1 */
} tc_axis;

/* Between value (0 … top and beyond) and place (0 … 1 and beyond); each other's inverses to 1e-12 of the value, or of
 * top where that is larger and the axis linear. */
double tc_axis_place(const tc_axis *axis, double value);
double tc_axis_value(const tc_axis *axis, double place);

/* One mark of an axis. */
typedef struct tc_axis_tick {
    double place;
    char label[24]; /* "0.25", "1e-5", as it can be typed; "" of a small one */
} tc_axis_tick;

/* Marks into out [capacity], by place, their number as result: at most `labels` with a label, at round values (1, 2,
 * 2.5, 5 times a power of ten), small ones between them. On a logarithmic axis at powers of ten, with 2 and 5 times
 * them where there is room, or every so many of them where there is not, and 0 at its foot. Small ones are left out
 * where capacity is too small; 0: labels or capacity is, or the axis is none. */
size_t tc_axis_ticks(tc_axis_tick *out, size_t capacity, const tc_axis *axis, int labels);
/* The same of the scalar axis: lo to hi, logarithmic over the whole of it where log is set (round values as on a linear
 * one where it is too short for powers of ten). 0 also: lo < hi does not hold, log and lo <= 0, or too few doubles lie
 * between them. */
size_t tc_range_ticks(tc_axis_tick *out, size_t capacity, double lo, double hi, bool log, int labels);

#endif
