/* pulse.c: how soon the window answers. */
#include "window/pulse.h"

#include <math.h>

/* BEAT_MS: something is due so often. HELD_MS: what is later than this is told. STRANGE_MS: an event that is later was
 * stamped by another clock. */
enum { BEAT_MS = 10, HELD_MS = 10, STRANGE_MS = 60000 };

typedef struct pulse {
    tc_trace *trace;
    GdkFrameClock *clock;
    GtkEventController *events;
    double due_ms, paint_ms;
    guint beat;
} pulse;

static gboolean beat(gpointer user)
{
    pulse *p = user;
    const double now = tc_trace_now();
    if (now - p->due_ms > HELD_MS)
        tc_trace_span(p->trace, "held", p->due_ms, now, 0, NULL, 0);
    p->due_ms = now + BEAT_MS;
    return G_SOURCE_CONTINUE;
}

static gboolean came(GtkEventControllerLegacy *controller, GdkEvent *event, gpointer user)
{
    pulse *p = user;
    (void)controller;
    switch (gdk_event_get_event_type(event)) {
    case GDK_MOTION_NOTIFY:
    case GDK_BUTTON_PRESS:
    case GDK_BUTTON_RELEASE:
    case GDK_KEY_PRESS:
    case GDK_KEY_RELEASE:
    case GDK_SCROLL:
        break;
    default:
        return FALSE;
    }
    const guint32 late = (guint32)(gint64)tc_trace_now() - gdk_event_get_time(event); /* both turn over at 2^32 ms */
    tc_trace_mark(p->trace, "event", 0, "late_ms", late < STRANGE_MS ? (double)late : NAN);
    return FALSE;
}

static void paint_begins(GdkFrameClock *clock, gpointer user)
{
    (void)clock;
    ((pulse *)user)->paint_ms = tc_trace_now();
}

static void paint_ends(GdkFrameClock *clock, gpointer user)
{
    pulse *p = user;
    (void)clock;
    if (p->paint_ms > 0)
        tc_trace_span(p->trace, "frame", p->paint_ms, tc_trace_now(), 0, NULL, 0);
    p->paint_ms = 0;
}

static void unrealized(GtkWidget *window, gpointer user)
{
    pulse *p = user;
    g_signal_handlers_disconnect_by_data(window, p);
    g_signal_handlers_disconnect_by_data(p->clock, p);
    gtk_widget_remove_controller(GTK_WIDGET(window), p->events);
    g_object_unref(p->clock);
    g_source_remove(p->beat);
    g_free(p);
}

void tc_pulse_attach(GtkWindow *window, tc_trace *trace)
{
    if (!tc_trace_keeps(trace))
        return;
    pulse *p = g_new0(pulse, 1);
    p->trace = trace;
    p->due_ms = tc_trace_now() + BEAT_MS;
    p->beat = g_timeout_add_full(G_PRIORITY_DEFAULT, BEAT_MS, beat, p, NULL);
    p->clock = g_object_ref(gtk_widget_get_frame_clock(GTK_WIDGET(window)));
    g_signal_connect(p->clock, "before-paint", G_CALLBACK(paint_begins), p);
    g_signal_connect(p->clock, "after-paint", G_CALLBACK(paint_ends), p);
    g_signal_connect(window, "unrealize", G_CALLBACK(unrealized), p);
    p->events = gtk_event_controller_legacy_new();
    gtk_event_controller_set_propagation_phase(p->events, GTK_PHASE_CAPTURE);
    g_signal_connect(p->events, "event", G_CALLBACK(came), p);
    gtk_widget_add_controller(GTK_WIDGET(window), p->events);
}
