/* color_strip.h: the colour points on a strip of the map. */
#ifndef TC_WINDOW_COLOR_STRIP_H
#define TC_WINDOW_COLOR_STRIP_H

#include <gtk/gtk.h>

#include "window/session.h"

GtkWidget *tc_color_strip_new(tc_session *session);

#endif
