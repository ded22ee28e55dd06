/* color_bar.h: colours and range: the colour points on a strip, the range within the data, and what belongs to both. */
#ifndef TC_WINDOW_COLOR_BAR_H
#define TC_WINDOW_COLOR_BAR_H

#include <gtk/gtk.h>

#include "window/session.h"

/* The widget, floating; it edits the session's document and listens. Its scalar axis is that of a curve (curve.h) of
 * the same width above it. The session lives longer. */
GtkWidget *tc_color_bar_new(tc_session *session);

#endif
