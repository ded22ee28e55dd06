/* effects.h: the panel of what a picture shows beside the function: data, model, isosurfaces, light, clipping,
 * geometry, figure. */
#ifndef TC_WINDOW_EFFECTS_H
#define TC_WINDOW_EFFECTS_H

#include <gtk/gtk.h>

#include "window/session.h"

/* The widget, floating; made from the tables of options, each of which it sets by tc_session_set, saying under the
 * control why one cannot be. The session lives longer. */
GtkWidget *tc_effects_new(tc_session *session);

#endif
