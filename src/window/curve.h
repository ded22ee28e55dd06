/* curve.h: the opacity curve over the histogram: points, their midpoints and sharpness, shapes and freehand lines, on a
 * linear or logarithmic axis. */
#ifndef TC_WINDOW_CURVE_H
#define TC_WINDOW_CURVE_H

#include <gtk/gtk.h>

#include "window/session.h"

/* The widget, floating; it edits the session's document and listens. The session lives longer. */
GtkWidget *tc_curve_new(tc_session *session);

/* Marks scalars on the axis (those that a ray meets; copied), picked larger; NaN: none is. n 0: none are marked. */
void tc_curve_mark(GtkWidget *curve, const double *scalar, size_t n, double picked);

#endif
