/* effect_data.h: which array is shown, and at which time. */
#ifndef TC_WINDOW_EFFECT_DATA_H
#define TC_WINDOW_EFFECT_DATA_H

#include <gtk/gtk.h>

#include "window/session.h"

/* The widget, floating; it tells the loader. Shows what the session has when tc_effect_data_fill is called. */
GtkWidget *tc_effect_data_new(tc_session *session);
void tc_effect_data_fill(GtkWidget *data);

#endif
