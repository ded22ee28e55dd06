/* color_space.h: interpolation between two colours in ParaView's colour spaces, as vtkColorTransferFunction does it. */
#ifndef TC_TRANSFER_FUNCTIONS_COLOR_SPACE_H
#define TC_TRANSFER_FUNCTIONS_COLOR_SPACE_H

#include "transfer_functions/preset.h"

void tc_color_rgb_to_lab(double lab[3], const double rgb[3]);
void tc_color_lab_to_rgb(double rgb[3], const double lab[3]);

/* Colour at t in [0, 1] between a and b. midpoint in [0, 1] and sharpness in [0, 1] bend the way: at `midpoint` the
 * middle is reached; sharpness > 0.99 makes a step there, < 0.01 a straight way. TC_SPACE_CIEDE2000 counts as RGB here:
 * its points come from tc_color_path. TC_SPACE_STEP: b. Cost: O(1). */
void tc_color_interpolate(double out[3], tc_color_space space, bool hsv_wrap, const double a[3], const double b[3],
                          double t, double midpoint, double sharpness);

/* The same for a number (vtkPiecewiseFunction). */
double tc_curve_interpolate(double a, double b, double t, double midpoint, double sharpness);

/* Perceived difference CIEDE2000 of two Lab colours. */
double tc_color_difference(const double lab_a[3], const double lab_b[3]);

/* Shortest way by CIEDE2000 between a and b over a grid of 17^3 colours (Zeyen et al. 2018): point [*n] gets colours
 * and, as x, the fraction of the way in [0, 1]; owned by the caller (free). The ends are the grid colours nearest to a
 * and b. Errors: TC_E_MEMORY. Cost: some 10 ms. */
tc_status tc_color_path(tc_color_point **point, size_t *n, const double a[3], const double b[3], tc_error *err);

#endif
