/* pulse.h: how soon the window answers, as its trace tells it: spans "held" (nothing was answered from when something
 * was due until then), spans "frame" (the window was painted), marks "event" (of pointer, keys and wheel, "late_ms":
 * from when the display took it until the window did; left out where the display's clock is another one). */
#ifndef TC_WINDOW_PULSE_H
#define TC_WINDOW_PULSE_H

#include "edit/trace.h"

#include <gtk/gtk.h>

/* For as long as the window is realized, which it must be. Nothing is done if the trace keeps nothing. */
void tc_pulse_attach(GtkWindow *window, tc_trace *trace);

#endif
