/* curve_input.c: the pointer on the opacity curve: what lies under it, and drags. A drag begins anew from the document
 * as it was at every move, so that going back takes it back. */
#include "window/curve_state.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "window/plot.h"

#define TC_CURVE_NEAR 9.0  /* pixels */
#define TC_CURVE_SLACK 3.0 /* that a click may move */

static double tc_distance(const double a[2], double x, double y)
{
    return hypot(a[0] - x, a[1] - y);
}

static bool tc_is_inside(const tc_curve_frame *f, double x, double y)
{
    return x >= f->left && x <= f->right && y >= f->top && y <= f->bottom;
}

/* Of points at one place, those of a step, the left one is taken from the left. */
static bool tc_find_point(size_t *index, const tc_curve *curve, const tc_curve_frame *f, double x, double y)
{
    const tc_document *d = curve->session->document;
    double best = TC_CURVE_NEAR;
    bool found = false;
    for (size_t i = 0; i < d->n_point; i++) {
        const double at[2] = {tc_plot_x(f->width, d->point[i].x), fmax(tc_curve_y(curve, f, d->point[i].a), f->top)};
        const double distance = tc_distance(at, x, y);
        if (distance < best || (found && distance <= best && x >= at[0])) {
            best = distance;
            *index = i;
            found = true;
        }
    }
    return found;
}

/* How far the curve is from (x, y), over and beside it. */
static double tc_curve_distance(const tc_curve *curve, const tc_curve_frame *f, double x, double y)
{
    double least = INFINITY;
    const tc_document *d = curve->session->document;
    double before = NAN;
    for (int dx = -6; dx <= 6; dx++) {
        const double place = tc_plot_place(f->width, x + dx);
        if (place < 0 || place > 1)
            continue;
        const double at = tc_curve_y(curve, f, tc_document_opacity(d, place));
        const double lo = isnan(before) ? at : fmin(at, before), hi = isnan(before) ? at : fmax(at, before);
        least = fmin(least, hypot(dx, y < lo ? lo - y : y > hi ? y - hi : 0));
        before = at;
    }
    return least;
}

static tc_curve_part tc_part_under(size_t *index, const tc_curve *curve, double x, double y)
{
    tc_curve_frame f;
    tc_curve_frame_get(&f, curve);
    *index = 0;
    if (x < f.left - 2 && y < f.top + 12)
        return TC_PART_TOP;
    if (curve->tool == TC_TOOL_FREEHAND && tc_is_inside(&f, x, y))
        return TC_PART_FREEHAND;
    if (curve->tool != TC_TOOL_SELECT && tc_is_inside(&f, x, y))
        return TC_PART_SHAPE;
    if (tc_find_point(index, curve, &f, x, y))
        return TC_PART_POINT;
    double at[2];
    for (size_t i = 0; i < curve->session->document->n_point; i++)
        if (tc_curve_middle(at, curve, &f, i) && tc_distance(at, x, y) < TC_CURVE_NEAR - 1) {
            *index = i;
            return TC_PART_MIDDLE;
        }
    if (x >= f.left && x <= f.right && tc_curve_distance(curve, &f, x, y) < 6)
        return TC_PART_LINE;
    return TC_PART_NOTHING;
}

static const char *tc_part_cursor(const tc_curve *curve, tc_curve_part part, size_t index)
{
    switch (part) {
    case TC_PART_POINT:
        return index == 0 || index + 1 == curve->session->document->n_point ? "ns-resize" : "move";
    case TC_PART_MIDDLE:
        return "all-scroll";
    case TC_PART_LINE:
        return "copy";
    case TC_PART_TOP:
        return "ns-resize";
    case TC_PART_FREEHAND:
    case TC_PART_SHAPE:
    case TC_PART_RUBBER:
        return "crosshair";
    default:
        return "default";
    }
}

static void tc_hover(tc_curve *curve, double x, double y)
{
    curve->hovered = true;
    curve->pointer[0] = x;
    curve->pointer[1] = y;
    curve->hot = tc_part_under(&curve->hot_index, curve, x, y);
    const bool drag = curve->drag != TC_PART_NOTHING;
    tc_plot_cursor(curve->area,
                   tc_part_cursor(curve, drag ? curve->drag : curve->hot, drag ? curve->drag_index : curve->hot_index));
    gtk_widget_queue_draw(curve->area);
}

static void tc_curve_moved(GtkEventControllerMotion *motion, double x, double y, gpointer user)
{
    (void)motion;
    tc_hover(user, x, y);
}

static void tc_curve_left(GtkEventControllerMotion *motion, gpointer user)
{
    (void)motion;
    tc_curve *curve = user;
    curve->hovered = false;
    if (!curve->drag)
        curve->hot = TC_PART_NOTHING;
    gtk_widget_queue_draw(curve->area);
}

/* The hand is on something from the first move on, so that a click alone makes no coarse picture. */
static void tc_drag_grab(tc_curve *curve)
{
    if (!curve->drag_grabbed && curve->drag != TC_PART_RUBBER && curve->drag != TC_PART_TOP)
        tc_session_grab(curve->session);
    else if (!curve->drag_grabbed)
        return;
    curve->drag_grabbed = true;
}

static void tc_drag_points(tc_curve *curve, const tc_curve_frame *f, double x, double y)
{
    tc_document *d = curve->session->document;
    if (curve->drag_index >= d->n_point)
        return;
    const double dx = (x - curve->drag_begin[0]) / (f->right - f->left);
    const double dy = (curve->drag_begin[1] - y) / (f->bottom - f->top);
    tc_curve_shift(curve, dx, dy, curve->drag_index);
    tc_curve_told(curve, "move points");
}

static void tc_drag_middle(tc_curve *curve, const tc_curve_frame *f, double x, double y)
{
    tc_document *d = curve->session->document;
    const size_t i = curve->drag_index;
    if (i + 1 >= d->n_point)
        return;
    const double width = (d->point[i + 1].x - d->point[i].x) * (f->right - f->left);
    tc_curve_bend(curve, i, (x - curve->drag_begin[0]) / fmax(width, 1),
                  (curve->drag_begin[1] - y) / (0.6 * (f->bottom - f->top)));
    tc_curve_told(curve, "move midpoint");
}

static void tc_drag_rubber(tc_curve *curve, const tc_curve_frame *f, double x, double y)
{
    tc_document *d = curve->session->document;
    if (curve->before->n_point != d->n_point)
        return;
    const double lo[2] = {fmin(x, curve->drag_begin[0]), fmin(y, curve->drag_begin[1])};
    const double hi[2] = {fmax(x, curve->drag_begin[0]), fmax(y, curve->drag_begin[1])};
    bool changed = false;
    for (size_t i = 0; i < d->n_point; i++) {
        const double px = tc_plot_x(f->width, d->point[i].x), py = tc_curve_y(curve, f, d->point[i].a);
        const bool in = px >= lo[0] && px <= hi[0] && py >= lo[1] && py <= hi[1];
        const bool selected = in || (curve->drag_toggles && curve->before->point[i].selected);
        changed = changed || selected != d->point[i].selected;
        d->point[i].selected = selected;
    }
    if (changed)
        tc_curve_told(curve, NULL);
}

/* The line from where the pointer was; where it passes again, the later holds. */
static void tc_draw_line(tc_curve *curve, const tc_curve_frame *f, double x, double y)
{
    const double x0 = fmin(fmax(curve->line_at[0], f->left), f->right), x1 = fmin(fmax(x, f->left), f->right);
    const double y0 = curve->line_at[1];
    const long from = lround(fmin(x0, x1) - f->left), to = lround(fmax(x0, x1) - f->left);
    for (long i = from; i <= to && i < (long)curve->n_line; i++) {
        const double t = x1 == x0 ? 1 : (f->left + (double)i - x0) / (x1 - x0);
        const double at = y0 + fmin(fmax(t, 0), 1) * (y - y0);
        curve->line[i] = fmin(fmax((f->bottom - at) / (f->bottom - f->top), 0), 1);
    }
    curve->line_at[0] = x;
    curve->line_at[1] = y;
}

static void tc_drag_freehand(tc_curve *curve, const tc_curve_frame *f, double x, double y)
{
    tc_draw_line(curve, f, x, y);
    if (!tc_plot_restore(curve->session->document, curve->before) ||
        !tc_curve_freehand(curve, curve->line, curve->n_line))
        return;
    tc_curve_told(curve, "draw freehand");
}

static void tc_drag_shape(tc_curve *curve, const tc_curve_frame *f, double x, double y)
{
    const double from = tc_plot_place(f->width, fmin(x, curve->drag_begin[0]));
    const double to = tc_plot_place(f->width, fmax(x, curve->drag_begin[0]));
    if (!tc_plot_restore(curve->session->document, curve->before))
        return;
    tc_curve_shape(curve, from, to, tc_curve_opacity(curve, f, y));
}

static void tc_drag_to(tc_curve *curve, double x, double y)
{
    tc_curve_frame f;
    tc_curve_frame_get(&f, curve);
    tc_drag_grab(curve);
    switch (curve->drag) {
    case TC_PART_POINT:
        if (tc_plot_restore(curve->session->document, curve->before))
            tc_drag_points(curve, &f, x, y);
        break;
    case TC_PART_MIDDLE:
        if (tc_plot_restore(curve->session->document, curve->before))
            tc_drag_middle(curve, &f, x, y);
        break;
    case TC_PART_RUBBER:
        tc_drag_rubber(curve, &f, x, y);
        break;
    case TC_PART_TOP: { /* a decade in 120 pixels, by round numbers */
        const double top = curve->drag_top * pow(10, (curve->drag_begin[1] - y) / 120);
        const double unit = pow(10, floor(log10(top)) - 1);
        tc_curve_top_set(curve, round(top / unit) * unit);
        break;
    }
    case TC_PART_FREEHAND:
        tc_drag_freehand(curve, &f, x, y);
        break;
    case TC_PART_SHAPE:
        tc_drag_shape(curve, &f, x, y);
        break;
    default:
        break;
    }
}

static void tc_drag_finish(tc_curve *curve)
{
    const bool grabbed = curve->drag_grabbed;
    tc_document_destroy(&curve->before);
    free(curve->line);
    curve->line = NULL;
    curve->n_line = 0;
    curve->drag = TC_PART_NOTHING;
    curve->drag_grabbed = false;
    if (grabbed)
        tc_session_release(curve->session);
    gtk_widget_queue_draw(curve->area);
}

void tc_curve_drag_cancel(tc_curve *curve)
{
    if (curve->drag == TC_PART_NOTHING)
        return;
    if (curve->drag == TC_PART_TOP)
        tc_curve_top_set(curve, curve->drag_top);
    else if (curve->before && tc_plot_restore(curve->session->document, curve->before))
        tc_curve_told(curve, curve->drag_grabbed ? "cancel" : NULL);
    tc_drag_finish(curve);
}

void tc_curve_drag_forget(tc_curve *curve)
{
    if (curve->drag != TC_PART_NOTHING)
        tc_drag_finish(curve);
}

/* A press on a point: it is selected alone, unless it is one of several; with Shift or Ctrl it joins or leaves them. */
static void tc_press_point(tc_curve *curve, size_t index, bool toggles)
{
    tc_document *d = curve->session->document;
    curve->drag_was_selected = d->point[index].selected;
    curve->focus = index;
    if (toggles)
        d->point[index].selected = !d->point[index].selected;
    else if (!d->point[index].selected) {
        tc_curve_select(curve, index);
        return;
    }
    tc_curve_told(curve, NULL);
}

/* Adds a point; the drag that follows is one step with it. */
static bool tc_press_add(tc_curve *curve, double x, double opacity)
{
    tc_error err = {0};
    size_t index = 0;
    tc_session_grab(curve->session);
    curve->drag_grabbed = true;
    const double place = tc_plot_place(gtk_widget_get_width(curve->area), x);
    if (tc_document_add_point(curve->session->document, &index, fmin(fmax(place, 0), 1), opacity, &err))
        return false;
    curve->drag_index = curve->focus = index;
    tc_curve_told(curve, "add point");
    return true;
}

static bool tc_press_again(tc_curve *curve, tc_curve_part part, size_t index, double x, double y)
{
    tc_curve_frame f;
    tc_curve_frame_get(&f, curve);
    switch (part) {
    case TC_PART_POINT:
        tc_curve_select(curve, index);
        tc_curve_ask(curve);
        return true;
    case TC_PART_TOP:
        gtk_widget_grab_focus(curve->top_entry);
        return true;
    case TC_PART_MIDDLE:
        curve->session->document->point[index].midpoint = 0.5;
        curve->session->document->point[index].sharpness = 0;
        tc_curve_told(curve, "reset midpoint");
        return true;
    case TC_PART_NOTHING:
        if (!tc_is_inside(&f, x, y))
            return false;
        if (tc_press_add(curve, x, tc_curve_opacity(curve, &f, y)))
            curve->drag = TC_PART_POINT;
        return curve->drag != TC_PART_POINT;
    default:
        return false;
    }
}

/* Is it the second of two clicks at a place? */
static bool tc_is_second(tc_curve *curve, guint32 time, double x, double y)
{
    int within = 400;
    g_object_get(gtk_widget_get_settings(curve->area), "gtk-double-click-time", &within, NULL);
    const bool second =
        time - curve->press_time < (guint32)within && tc_distance(curve->press_at, x, y) < 5 && !curve->press_added;
    curve->press_time = second ? 0 : time;
    curve->press_at[0] = x;
    curve->press_at[1] = y;
    curve->press_added = false;
    return second;
}

static void tc_curve_pressed(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    tc_curve *curve = user;
    GtkEventController *controller = GTK_EVENT_CONTROLLER(gesture);
    tc_error err = {0};
    tc_curve_drag_cancel(curve);
    gtk_gesture_set_state(GTK_GESTURE(gesture), GTK_EVENT_SEQUENCE_CLAIMED);
    gtk_widget_grab_focus(curve->area);
    tc_hover(curve, x, y);
    const GdkModifierType state = gtk_event_controller_get_current_event_state(controller);
    const bool again = tc_is_second(curve, gtk_event_controller_get_current_event_time(controller), x, y);
    size_t index;
    const tc_curve_part part = tc_part_under(&index, curve, x, y);
    curve->drag_begin[0] = curve->line_at[0] = x;
    curve->drag_begin[1] = curve->line_at[1] = y;
    curve->drag_index = index;
    curve->drag_moved = false;
    curve->drag_top = curve->axis.top;
    curve->drag_toggles = (state & (GDK_SHIFT_MASK | GDK_CONTROL_MASK)) != 0;
    curve->drag = TC_PART_NOTHING;
    if (again && tc_press_again(curve, part, index, x, y)) {
        tc_drag_finish(curve);
        return;
    }
    if (curve->drag == TC_PART_NOTHING)
        curve->drag = part == TC_PART_NOTHING ? TC_PART_RUBBER : part;
    tc_curve_frame f;
    tc_curve_frame_get(&f, curve);
    if (curve->drag == TC_PART_POINT && !curve->drag_grabbed)
        tc_press_point(curve, index, curve->drag_toggles);
    if (curve->drag == TC_PART_LINE) {
        curve->drag = TC_PART_POINT;
        curve->press_added = true;
        if (!tc_press_add(curve, x, tc_document_opacity(curve->session->document, tc_plot_place(f.width, x))))
            curve->drag = TC_PART_NOTHING;
    }
    if (curve->drag == TC_PART_FREEHAND) {
        curve->n_line = (size_t)(f.right - f.left) + 1;
        curve->line = malloc(curve->n_line * sizeof *curve->line);
        for (size_t i = 0; curve->line && i < curve->n_line; i++)
            curve->line[i] = NAN;
    }
    if (curve->drag == TC_PART_NOTHING || tc_document_copy(&curve->before, curve->session->document, &err) ||
        (curve->drag == TC_PART_FREEHAND && !curve->line))
        tc_drag_finish(curve);
    gtk_widget_queue_draw(curve->area);
}

static void tc_curve_dragged(GtkGestureDrag *gesture, double dx, double dy, gpointer user)
{
    (void)gesture;
    tc_curve *curve = user;
    if (curve->drag == TC_PART_NOTHING || (!curve->drag_moved && hypot(dx, dy) < TC_CURVE_SLACK))
        return;
    curve->drag_moved = true;
    tc_drag_to(curve, curve->drag_begin[0] + dx, curve->drag_begin[1] + dy);
}

static void tc_curve_released(GtkGestureDrag *gesture, double dx, double dy, gpointer user)
{
    (void)gesture, (void)dx, (void)dy;
    tc_curve *curve = user;
    tc_document *d = curve->session->document;
    const tc_curve_part drag = curve->drag;
    if (drag == TC_PART_NOTHING)
        return;
    if (!curve->drag_moved && drag == TC_PART_POINT && !curve->drag_toggles && curve->drag_was_selected)
        tc_curve_select(curve, curve->drag_index); /* one of several: now alone */
    if (!curve->drag_moved && drag == TC_PART_RUBBER && !curve->drag_toggles) {
        for (size_t i = 0; i < d->n_point; i++)
            d->point[i].selected = false;
        tc_curve_told(curve, NULL);
    }
    if (!curve->drag_moved && drag == TC_PART_SHAPE) {
        tc_curve_frame f;
        tc_curve_frame_get(&f, curve);
        const double place = tc_plot_place(f.width, curve->drag_begin[0]);
        tc_curve_shape(curve, place - 0.08, place + 0.08, tc_curve_opacity(curve, &f, curve->drag_begin[1]));
    }
    tc_drag_finish(curve);
    if (drag == TC_PART_SHAPE)
        tc_curve_tool_set(curve, TC_TOOL_SELECT); /* so that its points can be moved */
    if (drag == TC_PART_POINT)
        tc_curve_fit(curve, false);
    curve->drag_was_selected = false;
    tc_hover(curve, curve->pointer[0], curve->pointer[1]);
}

static void tc_curve_cancelled(GtkGesture *gesture, GdkEventSequence *sequence, gpointer user)
{
    (void)gesture, (void)sequence;
    tc_curve_drag_cancel(user);
}

void tc_curve_pointer_attach(tc_curve *curve)
{
    GtkGesture *drag = gtk_gesture_drag_new();
    gtk_gesture_single_set_button(GTK_GESTURE_SINGLE(drag), GDK_BUTTON_PRIMARY);
    g_signal_connect(drag, "drag-begin", G_CALLBACK(tc_curve_pressed), curve);
    g_signal_connect(drag, "drag-update", G_CALLBACK(tc_curve_dragged), curve);
    g_signal_connect(drag, "drag-end", G_CALLBACK(tc_curve_released), curve);
    g_signal_connect(drag, "cancel", G_CALLBACK(tc_curve_cancelled), curve);
    gtk_widget_add_controller(curve->area, GTK_EVENT_CONTROLLER(drag));
    GtkEventController *motion = gtk_event_controller_motion_new();
    g_signal_connect(motion, "motion", G_CALLBACK(tc_curve_moved), curve);
    g_signal_connect(motion, "leave", G_CALLBACK(tc_curve_left), curve);
    gtk_widget_add_controller(curve->area, motion);
}
