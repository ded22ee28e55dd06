/* autosave.h: each change is kept after a moment of rest, and what a window that crashed had kept is offered at the
 * next start. */
#ifndef TC_WINDOW_AUTOSAVE_H
#define TC_WINDOW_AUTOSAVE_H

#include <gtk/gtk.h>

#include "window/session.h"

/* Keeps the session's scene in a file of edit/recovery.h until the window is destroyed, which removes it. */
void tc_autosave_attach(GtkWindow *window, tc_session *session);

#endif
