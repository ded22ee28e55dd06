/* range_visible.h: the range of the scalars that the picture shows, found on a thread. */
#ifndef TC_WINDOW_RANGE_VISIBLE_H
#define TC_WINDOW_RANGE_VISIBLE_H

#include <gtk/gtk.h>

#include "window/session.h"

/* Lays the function over the finite scalars that lie in the session's picture, some time later; a sentence is said when
 * there are none. Nothing happens once the widget is gone, or when other data have come. */
void tc_range_visible(tc_session *session, GtkWidget *widget);

#endif
