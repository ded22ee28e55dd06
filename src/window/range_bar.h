/* range_bar.h: the function's range as a window within all scalars of the data: its ends are dragged, or all of it. */
#ifndef TC_WINDOW_RANGE_BAR_H
#define TC_WINDOW_RANGE_BAR_H

#include <gtk/gtk.h>

#include "window/session.h"

GtkWidget *tc_range_bar_new(tc_session *session);

/* Lays the function over lo to hi, in order; on a logarithmic scale what is not above 0 is left out. False, and a
 * sentence was said: there is no such range, and nothing was done. Tells (what: as of tc_session_edited). */
bool tc_range_set(tc_session *session, double lo, double hi, const char *what);

#endif
