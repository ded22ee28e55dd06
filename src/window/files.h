/* files.h: what the window opens and saves: the menu, its keys, and files that are dropped onto it. */
#ifndef TC_WINDOW_FILES_H
#define TC_WINDOW_FILES_H

#include <gtk/gtk.h>

#include "window/session.h"

/* Adds a menu to the window's title bar (a GtkHeaderBar), the actions and keys behind it, a target for dropped files,
 * the page of all keys, and autosaving. The window is of a GtkApplication; the session lives longer than both. */
void tc_files_attach(GtkWindow *window, tc_session *session);
/* Opens data, a scene, a picture (the scene in its metadata) or a file of presets, of which the first map is taken.
 * What cannot be is said, and changes nothing. */
void tc_files_open(GtkWindow *window, tc_session *session, const char *path);

#endif
