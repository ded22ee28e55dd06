/* transfer.h: the piecewise linear transfer function and what integrators make of it.
 *
 * After creation a function is nothing but knots: s ascending, colour and attenuation linear in s between them. Colour
 * spaces that are not linear (Lab, Msh "Diverging", HSV, CIEDE2000 …) and log ranges are resolved into enough knots at
 * creation (largest deviation of any channel 1e-4). Emission is tau(s) c(s): per unit distance tau colour is added
 * (density emitter, Williams and Max 1992; Weiler et al. 2003, eq. 3 and 4). */
#ifndef TC_TRANSFER_FUNCTIONS_TRANSFER_H
#define TC_TRANSFER_FUNCTIONS_TRANSFER_H

#include "core/status.h"

struct tc_transfer {
    size_t n;
    tc_knot *knot; /* [n], n >= 1, s non-decreasing; outside the end knots' values hold */
    char *name;
    double nan_color[4];
    uint64_t serial; /* changes when the knots do */
    /* What it was made from, kept for writing it back as a preset: see preset.h. */
    struct tc_preset *preset;
};

/* Value at s: *out gets r, g, b, a. At a step (two knots at s) the right one holds. */
void tc_transfer_evaluate(double out[4], const tc_transfer *tf, double s);
/* The scalars that the table or integrals must span: first and last knot; widened where they coincide. */
void tc_transfer_span(double out[2], const tc_transfer *tf);

#endif
