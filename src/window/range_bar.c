/* range_bar.c: see range_bar.h. What it shows stays where it is while something is dragged. */
#include "window/range_bar.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "edit/columns.h"
#include "window/plot.h"

#define TC_RANGE_DATA "tetcast-range-bar"
enum { TC_RANGE_HEIGHT = 34, TC_RANGE_NEAR = 8 };

typedef enum tc_range_part { TC_RANGE_NONE = -1, TC_RANGE_LOW = 0, TC_RANGE_HIGH, TC_RANGE_ALL } tc_range_part;

typedef struct tc_range_bar {
    tc_session *session;
    GtkWidget *area;
    tc_document extent; /* its range and log alone: what the bar shows */
    tc_range_part hot, drag, focus;
    bool moved, telling, keys_grabbed;
    double begin_x, begin[2]; /* begin: the range then */
} tc_range_bar;

bool tc_range_set(tc_session *session, double lo, double hi, const char *what)
{
    tc_document *d = session->document;
    if (lo > hi) {
        const double swap = lo;
        lo = hi;
        hi = swap;
    }
    if (d->log && !(hi > 0)) {
        tc_session_say(session, "the range %.6g to %.6g has nothing above 0: turn the logarithmic scale off", lo, hi);
        return false;
    }
    if (d->log && !(lo > 0))
        lo = 1e-4 * hi; /* as ParaView has it */
    if (!isfinite(lo) || !isfinite(hi) || !(hi - lo > 1e-12 * fmax(fabs(lo), fabs(hi))) || !isfinite(hi - lo)) {
        tc_session_say(session, "the range %.6g to %.6g is empty: its upper end must be above its lower one", lo, hi);
        return false;
    }
    d->range[0] = lo;
    d->range[1] = hi;
    tc_session_edited(session, what);
    return true;
}

/* All scalars of the data and all of the range, and a little beside them. */
static void tc_extent_fit(tc_range_bar *bar)
{
    const tc_session *s = bar->session;
    const tc_document *d = s->document;
    double lo = d->range[0], hi = d->range[1];
    const double *data = s->histogram ? s->histogram->range : s->run.mesh ? s->run.report.scalar_range : d->range;
    if (data[0] <= data[1]) {
        hi = fmax(hi, data[1]);
        lo = fmin(lo, !d->log || data[0] > 0 ? data[0] : lo);
    }
    bar->extent.log = d->log;
    if (d->log) {
        const double pad = pow(hi / lo, 0.04);
        bar->extent.range[0] = lo / pad;
        bar->extent.range[1] = hi * pad;
    } else {
        bar->extent.range[0] = lo - 0.04 * (hi - lo);
        bar->extent.range[1] = hi + 0.04 * (hi - lo);
    }
}

static double tc_range_x(const tc_range_bar *bar, double scalar)
{
    return tc_plot_x(gtk_widget_get_width(bar->area), tc_document_place(&bar->extent, scalar));
}

static void tc_range_describe(tc_range_bar *bar)
{
    const tc_document *d = bar->session->document;
    static const char *const part[] = {"lower end", "upper end", "all of it"};
    char lo[32], hi[32], text[160];
    snprintf(text, sizeof text, "%s to %s; arrow keys move %s", tc_plot_number(lo, d->range[0], 6),
             tc_plot_number(hi, d->range[1], 6), part[bar->focus]);
    gtk_accessible_update_property(GTK_ACCESSIBLE(bar->area), GTK_ACCESSIBLE_PROPERTY_VALUE_MIN, bar->extent.range[0],
                                   GTK_ACCESSIBLE_PROPERTY_VALUE_MAX, bar->extent.range[1],
                                   GTK_ACCESSIBLE_PROPERTY_VALUE_NOW, d->range[bar->focus == TC_RANGE_HIGH],
                                   GTK_ACCESSIBLE_PROPERTY_VALUE_TEXT, text, -1);
}

/* --------------------------------------------------------------------------------------------------------- picture */

static void tc_range_histogram(cairo_t *cr, const tc_range_bar *bar, int width, const tc_plot_colors *colors)
{
    const tc_histogram *histogram = bar->session->histogram;
    const double left = tc_plot_x(width, 0), right = tc_plot_x(width, 1);
    const size_t n = (size_t)fmax(right - left, 1);
    double *column = histogram ? malloc(n * sizeof *column) : NULL;
    if (!column)
        return;
    const double most = tc_columns_count(column, n, histogram, &bar->extent);
    for (size_t i = 0; i < n; i++) {
        const double h = (TC_RANGE_HEIGHT - 6) * tc_columns_height(histogram, column[i], most, true);
        cairo_rectangle(cr, left + (double)i, TC_RANGE_HEIGHT - 3 - h, 1, h);
    }
    tc_plot_ink(cr, &colors->ink, 0.3);
    cairo_fill(cr);
    free(column);
}

static void tc_range_handle(cairo_t *cr, double x, bool bright, const tc_plot_colors *colors)
{
    cairo_rectangle(cr, floor(x) - 2.5, 1.5, 5, TC_RANGE_HEIGHT - 3);
    tc_plot_ink(cr, bright ? &colors->accent : &colors->paper, 1);
    cairo_fill_preserve(cr);
    tc_plot_ink(cr, &colors->ink, 1);
    cairo_set_line_width(cr, 1);
    cairo_stroke(cr);
}

static void tc_range_draw(GtkDrawingArea *area, cairo_t *cr, int width, int height, gpointer user)
{
    (void)area, (void)height;
    const tc_range_bar *bar = user;
    const tc_document *d = bar->session->document;
    tc_plot_colors colors;
    tc_plot_colors_get(&colors, bar->area);
    const double left = tc_plot_x(width, 0), right = tc_plot_x(width, 1);
    const double lo = fmin(fmax(tc_range_x(bar, d->range[0]), left - 8), right);
    const double hi = fmax(fmin(tc_range_x(bar, d->range[1]), right + 8), left);
    cairo_rectangle(cr, left, 3, right - left, TC_RANGE_HEIGHT - 6);
    tc_plot_ink(cr, &colors.paper, 1);
    cairo_fill(cr);
    /* The map within its range. */
    cairo_pattern_t *gradient =
        cairo_pattern_create_linear(tc_range_x(bar, d->range[0]), 0, tc_range_x(bar, d->range[1]), 0);
    for (int i = 0; i <= 48; i++) {
        double rgb[3];
        tc_document_color(rgb, d, i / 48.0);
        cairo_pattern_add_color_stop_rgb(gradient, i / 48.0, rgb[0], rgb[1], rgb[2]);
    }
    cairo_rectangle(cr, lo, 3, hi - lo, TC_RANGE_HEIGHT - 6);
    cairo_set_source(cr, gradient);
    cairo_fill(cr);
    cairo_pattern_destroy(gradient);
    tc_range_histogram(cr, bar, width, &colors);
    const bool focused = gtk_widget_has_focus(bar->area);
    cairo_rectangle(cr, left + 0.5, 3.5, right - left - 1, TC_RANGE_HEIGHT - 7);
    tc_plot_ink(cr, focused ? &colors.accent : &colors.ink, 0.6);
    cairo_set_line_width(cr, 1);
    cairo_stroke(cr);
    const tc_range_part part = bar->drag != TC_RANGE_NONE  ? bar->drag
                               : bar->hot != TC_RANGE_NONE ? bar->hot
                               : focused                   ? bar->focus
                                                           : TC_RANGE_NONE;
    tc_range_handle(cr, lo, part == TC_RANGE_LOW || part == TC_RANGE_ALL, &colors);
    tc_range_handle(cr, hi, part == TC_RANGE_HIGH || part == TC_RANGE_ALL, &colors);
}

/* ----------------------------------------------------------------------------------------------------------- edits */

static tc_range_part tc_range_under(const tc_range_bar *bar, double x)
{
    const double *range = bar->session->document->range;
    const double lo = tc_range_x(bar, range[0]), hi = tc_range_x(bar, range[1]);
    const double to_lo = fabs(x - lo), to_hi = fabs(x - hi);
    if (fmin(to_lo, to_hi) < TC_RANGE_NEAR)
        return to_lo < to_hi || (to_lo == to_hi && x < lo) ? TC_RANGE_LOW : TC_RANGE_HIGH;
    return x > lo && x < hi ? TC_RANGE_ALL : TC_RANGE_NONE;
}

static void tc_range_told(tc_range_bar *bar, const char *what)
{
    bar->telling = true;
    tc_session_edited(bar->session, what);
    bar->telling = false;
    tc_range_describe(bar);
    gtk_widget_queue_draw(bar->area);
}

/* From a range, part goes along by places of the bar. */
static void tc_range_shift(tc_range_bar *bar, const double from[2], tc_range_part part, double dx)
{
    tc_document *d = bar->session->document;
    const tc_document *e = &bar->extent;
    const double least = 0.002; /* of the bar */
    double place[2] = {tc_document_place(e, from[0]), tc_document_place(e, from[1])};
    if (part == TC_RANGE_LOW)
        place[0] = fmin(place[0] + dx, place[1] - least);
    else if (part == TC_RANGE_HIGH)
        place[1] = fmax(place[1] + dx, place[0] + least);
    else {
        place[0] += dx;
        place[1] += dx;
    }
    /* What did not move stays as exact as it was. */
    const double lo = part == TC_RANGE_HIGH ? from[0] : tc_document_scalar(e, place[0]);
    const double hi = part == TC_RANGE_LOW ? from[1] : tc_document_scalar(e, place[1]);
    if (!isfinite(lo) || !isfinite(hi) || !(lo < hi) || (d->log && !(lo > 0)))
        return;
    d->range[0] = lo;
    d->range[1] = hi;
    tc_range_told(bar, "move range");
}

static void tc_range_finish(tc_range_bar *bar)
{
    if (bar->drag == TC_RANGE_NONE)
        return;
    bar->drag = TC_RANGE_NONE;
    if (bar->moved)
        tc_session_release(bar->session);
    tc_extent_fit(bar);
    gtk_widget_queue_draw(bar->area);
}

static void tc_range_cancel(tc_range_bar *bar)
{
    if (bar->drag != TC_RANGE_NONE && bar->moved)
        tc_range_shift(bar, bar->begin, TC_RANGE_ALL, 0);
    tc_range_finish(bar);
}

/* --------------------------------------------------------------------------------------------------------- pointer */

static void tc_range_pressed(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    (void)y;
    tc_range_bar *bar = user;
    tc_range_cancel(bar);
    gtk_gesture_set_state(GTK_GESTURE(gesture), GTK_EVENT_SEQUENCE_CLAIMED);
    gtk_widget_grab_focus(bar->area);
    bar->drag = tc_range_under(bar, x);
    if (bar->drag != TC_RANGE_NONE)
        bar->focus = bar->drag;
    bar->moved = false;
    bar->begin_x = x;
    bar->begin[0] = bar->session->document->range[0];
    bar->begin[1] = bar->session->document->range[1];
}

static void tc_range_dragged(GtkGestureDrag *gesture, double dx, double dy, gpointer user)
{
    (void)gesture, (void)dy;
    tc_range_bar *bar = user;
    if (bar->drag == TC_RANGE_NONE || (!bar->moved && fabs(dx) < 3))
        return;
    if (!bar->moved)
        tc_session_grab(bar->session);
    bar->moved = true;
    const int width = gtk_widget_get_width(bar->area);
    tc_range_shift(bar, bar->begin, bar->drag,
                   tc_plot_place(width, bar->begin_x + dx) - tc_plot_place(width, bar->begin_x));
}

static void tc_range_released(GtkGestureDrag *gesture, double dx, double dy, gpointer user)
{
    (void)gesture, (void)dx, (void)dy;
    tc_range_finish(user);
}

static void tc_range_cancelled(GtkGesture *gesture, GdkEventSequence *sequence, gpointer user)
{
    (void)gesture, (void)sequence;
    tc_range_cancel(user);
}

static void tc_range_hover(GtkEventControllerMotion *motion, double x, double y, gpointer user)
{
    (void)motion, (void)y;
    tc_range_bar *bar = user;
    if (bar->drag == TC_RANGE_NONE)
        bar->hot = tc_range_under(bar, x);
    const tc_range_part part = bar->drag != TC_RANGE_NONE ? bar->drag : bar->hot;
    tc_plot_cursor(bar->area, part == TC_RANGE_NONE  ? "default"
                              : part == TC_RANGE_ALL ? (bar->drag == part ? "grabbing" : "grab")
                                                     : "ew-resize");
    gtk_widget_queue_draw(bar->area);
}

static void tc_range_left(GtkEventControllerMotion *motion, gpointer user)
{
    (void)motion;
    tc_range_bar *bar = user;
    bar->hot = TC_RANGE_NONE;
    gtk_widget_queue_draw(bar->area);
}

/* ------------------------------------------------------------------------------------------------------------ keys */

static void tc_range_keys_release(tc_range_bar *bar)
{
    if (!bar->keys_grabbed)
        return;
    bar->keys_grabbed = false;
    tc_session_release(bar->session);
    tc_extent_fit(bar);
    gtk_widget_queue_draw(bar->area);
}

static gboolean tc_range_key(GtkEventControllerKey *keys, guint key, guint code, GdkModifierType state, gpointer user)
{
    (void)keys, (void)code;
    tc_range_bar *bar = user;
    const double step = state & GDK_SHIFT_MASK ? 0.05 : 0.005;
    switch (key) {
    case GDK_KEY_Tab:
    case GDK_KEY_ISO_Left_Tab: {
        const int next = (int)bar->focus + (key == GDK_KEY_Tab ? 1 : -1);
        if (state & GDK_CONTROL_MASK || next < TC_RANGE_LOW || next > TC_RANGE_ALL)
            return false;
        bar->focus = (tc_range_part)next;
        tc_range_describe(bar);
        gtk_widget_queue_draw(bar->area);
        return true;
    }
    case GDK_KEY_Left:
    case GDK_KEY_KP_Left:
    case GDK_KEY_Right:
    case GDK_KEY_KP_Right: {
        if (bar->drag != TC_RANGE_NONE)
            return true;
        if (!bar->keys_grabbed)
            tc_session_grab(bar->session);
        bar->keys_grabbed = true;
        const double from[2] = {bar->session->document->range[0], bar->session->document->range[1]};
        tc_range_shift(bar, from, bar->focus, key == GDK_KEY_Left || key == GDK_KEY_KP_Left ? -step : step);
        return true;
    }
    case GDK_KEY_Escape:
        if (bar->drag == TC_RANGE_NONE)
            return false;
        tc_range_cancel(bar);
        return true;
    default:
        return false;
    }
}

static void tc_range_key_up(GtkEventControllerKey *keys, guint key, guint code, GdkModifierType state, gpointer user)
{
    (void)keys, (void)code, (void)state;
    if (key == GDK_KEY_Left || key == GDK_KEY_Right || key == GDK_KEY_KP_Left || key == GDK_KEY_KP_Right)
        tc_range_keys_release(user);
}

static void tc_range_focused(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    tc_range_bar *bar = user;
    tc_range_describe(bar);
    gtk_widget_queue_draw(bar->area);
}

static void tc_range_unfocused(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    tc_range_bar *bar = user;
    tc_range_keys_release(bar);
    gtk_widget_queue_draw(bar->area);
}

/* ---------------------------------------------------------------------------------------------------------- widget */

static void tc_range_heard(void *user, unsigned changes)
{
    tc_range_bar *bar = user;
    if (!(changes & (TC_CHANGE_FUNCTION | TC_CHANGE_DATA)))
        return;
    if (!bar->telling) {
        tc_range_finish(bar); /* what it moved is gone */
        tc_extent_fit(bar);
    }
    gtk_widget_queue_draw(bar->area);
}

static void tc_range_gone(GtkWidget *area, gpointer user)
{
    (void)area;
    tc_range_bar *bar = user;
    tc_plot_unlisten(bar->session, bar);
}

static void tc_range_attach(tc_range_bar *bar)
{
    GtkGesture *drag = gtk_gesture_drag_new();
    gtk_gesture_single_set_button(GTK_GESTURE_SINGLE(drag), GDK_BUTTON_PRIMARY);
    g_signal_connect(drag, "drag-begin", G_CALLBACK(tc_range_pressed), bar);
    g_signal_connect(drag, "drag-update", G_CALLBACK(tc_range_dragged), bar);
    g_signal_connect(drag, "drag-end", G_CALLBACK(tc_range_released), bar);
    g_signal_connect(drag, "cancel", G_CALLBACK(tc_range_cancelled), bar);
    gtk_widget_add_controller(bar->area, GTK_EVENT_CONTROLLER(drag));
    GtkEventController *motion = gtk_event_controller_motion_new();
    g_signal_connect(motion, "motion", G_CALLBACK(tc_range_hover), bar);
    g_signal_connect(motion, "leave", G_CALLBACK(tc_range_left), bar);
    gtk_widget_add_controller(bar->area, motion);
    GtkEventController *keys = gtk_event_controller_key_new();
    g_signal_connect(keys, "key-pressed", G_CALLBACK(tc_range_key), bar);
    g_signal_connect(keys, "key-released", G_CALLBACK(tc_range_key_up), bar);
    gtk_widget_add_controller(bar->area, keys);
    GtkEventController *focus = gtk_event_controller_focus_new();
    g_signal_connect(focus, "enter", G_CALLBACK(tc_range_focused), bar);
    g_signal_connect(focus, "leave", G_CALLBACK(tc_range_unfocused), bar);
    gtk_widget_add_controller(bar->area, focus);
}

GtkWidget *tc_range_bar_new(tc_session *session)
{
    tc_range_bar *bar = g_new0(tc_range_bar, 1);
    bar->session = session;
    bar->hot = bar->drag = TC_RANGE_NONE;
    bar->focus = TC_RANGE_LOW;
    bar->area = g_object_new(GTK_TYPE_DRAWING_AREA, "accessible-role", GTK_ACCESSIBLE_ROLE_SLIDER, NULL);
    gtk_widget_set_focusable(bar->area, true);
    gtk_widget_set_hexpand(bar->area, true);
    gtk_drawing_area_set_content_height(GTK_DRAWING_AREA(bar->area), TC_RANGE_HEIGHT);
    gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(bar->area), tc_range_draw, bar, NULL);
    tc_plot_label(bar->area, "Range within the data",
                  "The range within all scalars of the data: drag its ends, or all of it");
    tc_range_attach(bar);
    g_object_set_data_full(G_OBJECT(bar->area), TC_RANGE_DATA, bar, g_free);
    g_signal_connect(bar->area, "destroy", G_CALLBACK(tc_range_gone), bar);
    tc_extent_fit(bar);
    tc_range_describe(bar);
    tc_session_listen(session, tc_range_heard, bar);
    return bar->area;
}
