/* presets.h: colour maps to choose from: the built-in ones and those of preset files, each seen by a strip of its
 * colours. */
#ifndef TC_WINDOW_PRESETS_H
#define TC_WINDOW_PRESETS_H

#include <gtk/gtk.h>

#include "window/session.h"

/* The widget, floating: a search entry over a list. Enter and double click take a map into the session's document, as
 * one step. The session lives longer. */
GtkWidget *tc_presets_new(tc_session *session);

/* Reads a file of presets on a thread and adds its maps; take: the first of them is taken. What goes wrong is told by
 * tc_session_say. A file that is there already is read anew. */
void tc_presets_add(GtkWidget *presets, const char *path, bool take);
/* The one in this window; NULL: it has none. */
GtkWidget *tc_presets_in(GtkWindow *window);

#endif
