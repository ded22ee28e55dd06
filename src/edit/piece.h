/* piece.h: the curve between two points of a vtkPiecewiseFunction: midpoint, sharpness, and what they become where it
 * is cut. */
#ifndef TC_EDIT_PIECE_H
#define TC_EDIT_PIECE_H

/* Midpoint: where, from 0 to 1, the curve has the mean of its ends; sharpness: 0 two lines, above 0.99 a step. */
typedef struct tc_bend {
    double midpoint, sharpness;
} tc_bend;

/* The value at t (0 to 1) of the way from a to b. It stays between the two. */
double tc_piece_value(double a, double b, double t, tc_bend bend);
/* The bend with which a curve from the piece's value at `from` to that at `to` (0 <= from < to <= 1) is nearest to the
 * part between them, in the mean square; what goes along with a shift of its ends is not looked at. Cost: some hundred
 * values at 65 places. */
tc_bend tc_piece_part(double a, double b, tc_bend bend, double from, double to);

#endif
