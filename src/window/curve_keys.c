/* curve_keys.c: the keyboard on the opacity curve: all that the pointer can do. */
#include "window/curve_state.h"

#include <math.h>

#include "window/plot.h"

/* Arrow keys: small and large steps as shares of the axes. */
#define TC_KEY_SMALL 0.002
#define TC_KEY_LARGE 0.02
#define TC_KEY_OPACITY 2.5 /* … of the opacity axis, which is shorter */

static bool tc_key_arrow(int way[2], guint key)
{
    way[0] = way[1] = 0;
    switch (key) {
    case GDK_KEY_Left:
    case GDK_KEY_KP_Left:
        way[0] = -1;
        return true;
    case GDK_KEY_Right:
    case GDK_KEY_KP_Right:
        way[0] = 1;
        return true;
    case GDK_KEY_Up:
    case GDK_KEY_KP_Up:
        way[1] = 1;
        return true;
    case GDK_KEY_Down:
    case GDK_KEY_KP_Down:
        way[1] = -1;
        return true;
    default:
        return false;
    }
}

static void tc_keys_release(tc_curve *curve)
{
    if (!curve->keys_grabbed)
        return;
    curve->keys_grabbed = false;
    tc_session_release(curve->session);
    tc_curve_fit(curve, false);
}

/* While an arrow is held all its steps are one. */
static void tc_keys_grab(tc_curve *curve)
{
    if (curve->keys_grabbed)
        return;
    curve->keys_grabbed = true;
    tc_session_grab(curve->session);
}

static void tc_focus_to(tc_curve *curve, size_t index, bool alone)
{
    if (alone) {
        tc_curve_select(curve, index);
        return;
    }
    curve->focus = index;
    tc_curve_describe(curve);
    gtk_widget_queue_draw(curve->area);
}

static bool tc_press_arrow(tc_curve *curve, const int way[2], GdkModifierType state)
{
    tc_document *d = curve->session->document;
    const double step = state & GDK_SHIFT_MASK ? TC_KEY_LARGE : TC_KEY_SMALL;
    if (state & GDK_CONTROL_MASK) {
        if (way[0] > 0 && curve->focus + 1 < d->n_point)
            tc_focus_to(curve, curve->focus + 1, false);
        if (way[0] < 0 && curve->focus > 0)
            tc_focus_to(curve, curve->focus - 1, false);
        return true;
    }
    if (state & GDK_ALT_MASK) {
        tc_keys_grab(curve);
        tc_curve_bend(curve, curve->focus, way[0] * 5 * step, way[1] * 5 * step);
        tc_curve_told(curve, "move midpoint");
        return true;
    }
    size_t selected = d->n_point;
    for (size_t i = 0; i < d->n_point; i++)
        if (d->point[i].selected && (selected == d->n_point || i == curve->focus))
            selected = i;
    if (selected == d->n_point) {
        tc_curve_select(curve, curve->focus);
        selected = curve->focus;
    }
    tc_keys_grab(curve);
    tc_curve_shift(curve, way[0] * step, way[1] * step * TC_KEY_OPACITY, selected);
    tc_curve_told(curve, "move points");
    return true;
}

static void tc_add_after(tc_curve *curve)
{
    tc_document *d = curve->session->document;
    const size_t i = curve->focus + 1 < d->n_point ? curve->focus : d->n_point - 2;
    const double x = 0.5 * (d->point[i].x + d->point[i + 1].x);
    tc_error err = {0};
    size_t index = 0;
    if (tc_document_add_point(d, &index, x, tc_document_opacity(d, x), &err))
        return;
    curve->focus = index;
    tc_curve_told(curve, "add point");
}

static void tc_select_all(tc_curve *curve, bool selected)
{
    tc_document *d = curve->session->document;
    for (size_t i = 0; i < d->n_point; i++)
        d->point[i].selected = selected;
    tc_curve_told(curve, NULL);
}

/* A shape by the keyboard: over what is selected, or about the point that has the keyboard. */
static void tc_place_shape(tc_curve *curve)
{
    const tc_document *d = curve->session->document;
    double from = INFINITY, to = -INFINITY, height = 0;
    for (size_t i = 0; i < d->n_point; i++)
        if (d->point[i].selected) {
            from = fmin(from, d->point[i].x);
            to = fmax(to, d->point[i].x);
            height = fmax(height, d->point[i].a);
        }
    if (!(to - from > 0.01)) {
        const double x = d->point[curve->focus].x;
        from = fmin(fmax(x - 0.1, 0), 0.8);
        to = from + 0.2;
    }
    if (!(height > 0))
        height = tc_axis_value(&curve->axis, 0.5);
    tc_curve_shape(curve, from, to, height);
    tc_curve_tool_set(curve, TC_TOOL_SELECT);
}

static bool tc_press_tab(tc_curve *curve, bool back)
{
    if (back ? curve->focus == 0 : curve->focus + 1 >= curve->session->document->n_point)
        return false; /* on to the next widget */
    tc_focus_to(curve, curve->focus + (back ? (size_t)-1 : 1), true);
    return true;
}

static void tc_escape(tc_curve *curve)
{
    if (curve->drag != TC_PART_NOTHING)
        tc_curve_drag_cancel(curve);
    else if (curve->tool != TC_TOOL_SELECT)
        tc_curve_tool_set(curve, TC_TOOL_SELECT);
    else
        tc_select_all(curve, false);
}

static gboolean tc_curve_key(GtkEventControllerKey *keys, guint key, guint code, GdkModifierType state, gpointer user)
{
    (void)keys, (void)code;
    tc_curve *curve = user;
    tc_document *d = curve->session->document;
    const bool control = (state & GDK_CONTROL_MASK) != 0;
    int way[2];
    if (key == GDK_KEY_Escape) {
        tc_escape(curve);
        return true;
    }
    if (curve->drag != TC_PART_NOTHING)
        return true;
    if (tc_key_arrow(way, key))
        return tc_press_arrow(curve, way, state);
    switch (key) {
    case GDK_KEY_Tab:
        return !control && tc_press_tab(curve, false);
    case GDK_KEY_ISO_Left_Tab:
        return !control && tc_press_tab(curve, true);
    case GDK_KEY_Home:
        tc_focus_to(curve, 0, !control);
        return true;
    case GDK_KEY_End:
        tc_focus_to(curve, d->n_point - 1, !control);
        return true;
    case GDK_KEY_Delete:
    case GDK_KEY_KP_Delete:
    case GDK_KEY_BackSpace:
        tc_document_delete_points(d);
        tc_curve_told(curve, "delete points");
        return true;
    case GDK_KEY_Insert:
    case GDK_KEY_plus:
    case GDK_KEY_KP_Add:
        tc_add_after(curve);
        return true;
    case GDK_KEY_space:
        d->point[curve->focus].selected = !d->point[curve->focus].selected;
        tc_curve_told(curve, NULL);
        return true;
    case GDK_KEY_a:
    case GDK_KEY_A:
        if (!control)
            return false;
        tc_select_all(curve, !(state & GDK_SHIFT_MASK));
        return true;
    case GDK_KEY_Return:
    case GDK_KEY_KP_Enter:
    case GDK_KEY_F2:
        if (curve->tool == TC_TOOL_SELECT || curve->tool == TC_TOOL_FREEHAND)
            tc_curve_ask(curve);
        else
            tc_place_shape(curve);
        return true;
    default:
        return false;
    }
}

static void tc_curve_key_up(GtkEventControllerKey *keys, guint key, guint code, GdkModifierType state, gpointer user)
{
    (void)keys, (void)code, (void)state;
    int way[2];
    if (tc_key_arrow(way, key))
        tc_keys_release(user);
}

static void tc_curve_focus(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    tc_curve *curve = user;
    tc_curve_describe(curve);
    gtk_widget_queue_draw(curve->area);
}

static void tc_curve_unfocus(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    tc_curve *curve = user;
    tc_keys_release(curve);
    gtk_widget_queue_draw(curve->area);
}

void tc_curve_keys_attach(tc_curve *curve)
{
    GtkEventController *keys = gtk_event_controller_key_new();
    g_signal_connect(keys, "key-pressed", G_CALLBACK(tc_curve_key), curve);
    g_signal_connect(keys, "key-released", G_CALLBACK(tc_curve_key_up), curve);
    gtk_widget_add_controller(curve->area, keys);
    GtkEventController *focus = gtk_event_controller_focus_new();
    g_signal_connect(focus, "enter", G_CALLBACK(tc_curve_focus), curve);
    g_signal_connect(focus, "leave", G_CALLBACK(tc_curve_unfocus), curve);
    gtk_widget_add_controller(curve->area, focus);
}
