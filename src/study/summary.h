/* summary.h: settings over all views, and which of them are worth their time. */
#ifndef TC_STUDY_SUMMARY_H
#define TC_STUDY_SUMMARY_H

#include "study/rows.h"

/* One setting of one pair of mesh and function, over its views. */
typedef struct tc_sum {
    tc_study_row row;  /* times: median of medians, min, max; errors: max, but mean_error: mean over pixels; counts:
                          sums;  bytes: max; steps_per_ray: mean over rays */
    int views;         /* measured */
    double time_ratio; /* median over views of its median time by that of "default"; NAN */
    bool front;        /* nothing else measured by ray is as fast and errs less, or is faster and errs no more */
} tc_sum;

typedef struct tc_summary {
    size_t n;
    tc_sum *sum; /* [n], owned; in the order of first appearance of the pairs, then of settings */
} tc_summary;

/* From rows in any order. Errors: TC_E_MEMORY. */
tc_status tc_summary_build(tc_summary *out, const tc_study_row *row, size_t n, tc_error *err);
void tc_summary_finish(tc_summary *summary);

/* Median of value [n], which is reordered; the mean of the middle two when n is even; NAN of nothing. */
double tc_median(double *value, size_t n);
/* The k-th smallest with at least `share` of the values not above it (nearest rank); reordered; NAN of nothing. */
double tc_percentile(double *value, size_t n, double share);
/* front [n]: is no other point at most as far in both and less in one? NAN: never on it. */
void tc_front(bool *front, const double *time, const double *error, size_t n);

#endif
