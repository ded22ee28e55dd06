/* help.h: the page of all keys and of what the pointer does. */
#ifndef TC_WINDOW_HELP_H
#define TC_WINDOW_HELP_H

#include <gtk/gtk.h>

/* Gives the window its page (the action win.show-help-overlay). */
void tc_help_attach(GtkApplicationWindow *window);

#endif
