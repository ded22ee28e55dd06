/* window.h: the window: the picture at the left, what makes it at the right, a line that says how it is below. */
#ifndef TC_WINDOW_WINDOW_H
#define TC_WINDOW_WINDOW_H

#include "window/session.h"

#include <gtk/gtk.h>

/* Opens the window over a session. The data are being read, or will be. */
GtkWindow *tc_window_new(GtkApplication *application, tc_session *session);
/* Why the window cannot show pictures at all; "": it can. Borrowed from window. */
const char *tc_window_refused(GtkWindow *window);
/* What is in it, borrowed. To be held until the main loop has ended: the display lets go of the widgets that pointer
 * and keyboard were at later than the window does, and they are to go before those that they lie in. */
GtkWidget *tc_window_content(GtkWindow *window);

#endif
