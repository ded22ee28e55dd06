/* segment.h: ray integrals over short segments between given scalars (Weiler et al. 2003, equations 3 and 4).
 *
 * The scalar runs over x in [0, 1]; all segments have one length, laid into the extinction beforehand. Between cuts
 * (knots and nodes) extinction and colour are linear. A stretch of scalar is known by its moments; a segment that
 * crosses it with `rate` = 1 / |x_back - x_front| has optical depth rate * depth, and its colour is the series C = rate
 * * sum over m of (-rate)^m emission[m],  cut after m = 3 where the optical depth is at most 1/16 and split there
 * otherwise. */
#ifndef TC_TRANSFER_FUNCTIONS_SEGMENT_H
#define TC_TRANSFER_FUNCTIONS_SEGMENT_H

#include "transfer_functions/transfer.h"

enum { TC_MOMENTS = 4 };

/* With T(x) the extinction integrated from the stretch's near end to x:
 * depth = T(far end), emission[m] = integral of tau c T^m / m! dx. All are >= 0, so joining loses no digits. */
typedef struct tc_moments {
    double depth, emission[TC_MOMENTS][3];
} tc_moments;

/* A linear piece: x and (r, g, b, tau * length) at its two ends. */
typedef struct tc_segment_piece {
    double x[2], value[2][4];
} tc_segment_piece;

typedef struct tc_segments {
    size_t n_node;
    double *x;               /* [n_node] ascending, x[0] = 0, x[n_node-1] = 1 */
    double (*node)[4];       /* [n_node] tau r, tau g, tau b, tau (times length), at a step the mean of both sides */
    size_t *first;           /* [n_node] piece that starts at a node; [n_node-1] is n_piece */
    tc_segment_piece *piece; /* [n_piece] */
    size_t n_piece;
    tc_moments *up, *down; /* [n_node-1] of each cell between nodes, seen from below and from above */
} tc_segments;

/* Segments of one length over span with nodes at x [n_node] (copied). Errors: TC_E_MEMORY. Cost: O(n_node + knots).
 * Optical depths beyond 1e12 count as 1e12. */
tc_status tc_segments_build(tc_segments *out, const tc_transfer *tf, const double span[2], double length,
                            const double *x, size_t n_node, tc_error *err);
void tc_segments_finish(tc_segments *segments);

/* Colour and opacity from node `front` to every node: out [n_node][4]. *error grows to the largest truncation error of
 * the series (an upper bound). Cost: O(n_node) while the optical depth stays below 1/16. */
void tc_segments_row(double (*out)[4], double *error, const tc_segments *segments, size_t front);

/* A segment whose length is the share l of the built one, as a series in l for small optical depth:
 *   colour / opacity = mean + term[0] l + term[1] l^2 + term[2] l^3 + …,   mean = emission / extinction
 * depth is its optical depth at l = 1. All are 0 where there is no extinction. */
typedef struct tc_segment_series {
    double depth, mean[3], term[3][3];
} tc_segment_series;

/* From node `front` to every node: out [n_node]. Cut where the terms are below (depth l)^4 / 720. Cost: O(n_node). */
void tc_segments_series(tc_segment_series *out, const tc_segments *segments, size_t front);

/* Colour and opacity of one segment between any two x. *hint: any value < n_piece; keeps the place for the next call.
 */
void tc_segments_between(double out[4], const tc_segments *segments, double front, double back, size_t *hint);
/* The same for the share `part` of the built length. */
void tc_segments_short(double out[4], const tc_segments *segments, double front, double back, double part,
                       size_t *hint);

#endif
