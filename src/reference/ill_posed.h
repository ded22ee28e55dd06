/* ill_posed.h: does a ray's colour hang on what rounding decides? Inside the room. */
#ifndef TC_REFERENCE_ILL_POSED_H
#define TC_REFERENCE_ILL_POSED_H

#include "reference/trace.h"

/* A reference colour that moves by more than this says nothing; nor is a smaller error looked at. */
#define TC_ILL_POSED_MOVE (1.0 / 1020)

/* Largest difference of a channel, [4] each. */
double tc_color_distance(const double *a, const double *b);

/* Moves the line in every way that a picture may not know of, and gives the largest change of its colour.
 *   range  width of the scalars' range
 *   rgba   [4] the line's colour
 *   enough no move is looked for once the change exceeds this
 * Errors: as tc_line_trace. Cost: up to 19 rays. */
tc_status tc_line_sway(double *out, const tc_reference *reference, const tc_transfer *tf, double unit, double range,
                       const tc_line *line, const double *rgba, double enough, int worker);

#endif
