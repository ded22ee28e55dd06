/* color_strip.c: see color_strip.h. A drag begins anew from the document as it was at every move. */
#include "window/color_strip.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "window/plot.h"

#define TC_STRIP_DATA "tetcast-color-strip"
enum { TC_STRIP_BAND = 20, TC_STRIP_HEIGHT = 40, TC_STRIP_HALF = 6 };

typedef struct tc_strip {
    tc_session *session;
    GtkWidget *area, *popover, *scalar_entry;
    size_t focus;
    bool telling, keys_grabbed;
    bool hot;
    size_t hot_index;
    bool dragging, moved, toggles, was_selected;
    size_t drag_index;
    double begin_x;
    tc_document *before;
    guint32 press_time;
    double press_x;
    GtkWidget *chooser; /* NULL: none is open */
    tc_document *chooser_before;
} tc_strip;

static void tc_strip_describe(tc_strip *strip)
{
    const tc_document *d = strip->session->document;
    const tc_edit_color *c = &d->color[strip->focus < d->n_color ? strip->focus : 0];
    char scalar[32], text[160];
    snprintf(text, sizeof text, "Colour %zu of %zu%s: scalar %s, red %.0f, green %.0f, blue %.0f percent",
             strip->focus + 1, d->n_color, c->selected ? ", selected" : "",
             tc_plot_number(scalar, tc_document_scalar(d, c->x), 6), 100 * c->rgb[0], 100 * c->rgb[1], 100 * c->rgb[2]);
    gtk_accessible_update_property(GTK_ACCESSIBLE(strip->area), GTK_ACCESSIBLE_PROPERTY_VALUE_MIN, d->range[0],
                                   GTK_ACCESSIBLE_PROPERTY_VALUE_MAX, d->range[1], GTK_ACCESSIBLE_PROPERTY_VALUE_NOW,
                                   tc_document_scalar(d, c->x), GTK_ACCESSIBLE_PROPERTY_VALUE_TEXT, text, -1);
}

static void tc_strip_told(tc_strip *strip, const char *what)
{
    strip->telling = true;
    tc_session_edited(strip->session, what);
    strip->telling = false;
    const size_t n = strip->session->document->n_color;
    strip->focus = strip->focus < n ? strip->focus : n - 1;
    tc_strip_describe(strip);
    gtk_widget_queue_draw(strip->area);
}

static void tc_strip_select(tc_strip *strip, size_t index)
{
    tc_document *d = strip->session->document;
    for (size_t i = 0; i < d->n_color; i++)
        d->color[i].selected = i == index;
    strip->focus = index < d->n_color ? index : strip->focus;
    tc_strip_told(strip, NULL);
}

/* --------------------------------------------------------------------------------------------------------- picture */

static void tc_strip_draw(GtkDrawingArea *area, cairo_t *cr, int width, int height, gpointer user)
{
    (void)area, (void)height;
    const tc_strip *strip = user;
    const tc_document *d = strip->session->document;
    tc_plot_colors colors;
    tc_plot_colors_get(&colors, strip->area);
    const double left = tc_plot_x(width, 0), right = tc_plot_x(width, 1);
    cairo_pattern_t *gradient = tc_plot_gradient(d, width, 1);
    cairo_rectangle(cr, left, 1, right - left, TC_STRIP_BAND);
    cairo_set_source(cr, gradient);
    cairo_fill(cr);
    cairo_pattern_destroy(gradient);
    const bool focused = gtk_widget_has_focus(strip->area);
    cairo_rectangle(cr, left + 0.5, 1.5, right - left - 1, TC_STRIP_BAND - 1);
    tc_plot_ink(cr, focused ? &colors.accent : &colors.ink, 0.6);
    cairo_set_line_width(cr, 1);
    cairo_stroke(cr);
    for (size_t i = 0; i < d->n_color; i++) {
        const tc_edit_color *c = &d->color[i];
        const double x = tc_plot_x(width, c->x), r = TC_STRIP_HALF + (strip->hot && strip->hot_index == i ? 1 : 0);
        cairo_move_to(cr, x, TC_STRIP_BAND - 3);
        cairo_line_to(cr, x + r, TC_STRIP_BAND + 5);
        cairo_line_to(cr, x + r, TC_STRIP_BAND + 15);
        cairo_line_to(cr, x - r, TC_STRIP_BAND + 15);
        cairo_line_to(cr, x - r, TC_STRIP_BAND + 5);
        cairo_close_path(cr);
        cairo_set_source_rgb(cr, c->rgb[0], c->rgb[1], c->rgb[2]);
        cairo_fill_preserve(cr);
        tc_plot_ink(cr, c->selected ? &colors.accent : &colors.ink, 1);
        cairo_set_line_width(cr, c->selected ? 3 : 1.2);
        cairo_stroke(cr);
        if (focused && i == strip->focus) {
            cairo_rectangle(cr, x - r - 3, TC_STRIP_BAND - 5, 2 * r + 6, 24);
            tc_plot_ink(cr, &colors.accent, 1);
            cairo_set_line_width(cr, 1.5);
            cairo_stroke(cr);
        }
    }
}

static bool tc_strip_find(size_t *index, const tc_strip *strip, double x, double y)
{
    const tc_document *d = strip->session->document;
    const int width = gtk_widget_get_width(strip->area);
    double best = TC_STRIP_HALF + 2;
    bool found = false;
    if (y < TC_STRIP_BAND - 4)
        return false;
    for (size_t i = 0; i < d->n_color; i++) {
        const double at = tc_plot_x(width, d->color[i].x), distance = fabs(at - x);
        if (distance < best || (found && distance <= best && x >= at)) {
            best = distance;
            *index = i;
            found = true;
        }
    }
    return found;
}

/* --------------------------------------------------------------------------------------------------------- chooser */

static void tc_chooser_live(GObject *chooser, GParamSpec *spec, gpointer user)
{
    (void)spec;
    tc_strip *strip = user;
    tc_document *d = strip->session->document;
    GdkRGBA rgba;
    gtk_color_chooser_get_rgba(GTK_COLOR_CHOOSER(chooser), &rgba);
    for (size_t i = 0; i < d->n_color; i++)
        if (d->color[i].selected) {
            d->color[i].rgb[0] = rgba.red;
            d->color[i].rgb[1] = rgba.green;
            d->color[i].rgb[2] = rgba.blue;
        }
    tc_strip_told(strip, "choose colour");
}

static void tc_chooser_end(tc_strip *strip)
{
    if (strip->chooser) {
        GtkWidget *chooser = strip->chooser;
        strip->chooser = NULL;
        g_signal_handlers_disconnect_by_data(chooser, strip);
        gtk_window_destroy(GTK_WINDOW(chooser));
        tc_session_release(strip->session);
    }
    tc_document_destroy(&strip->chooser_before);
}

static void tc_chooser_answered(GtkDialog *dialog, int response, gpointer user)
{
    tc_strip *strip = user;
    if (response == GTK_RESPONSE_OK)
        tc_chooser_live(G_OBJECT(dialog), NULL, strip);
    else if (strip->chooser_before && tc_plot_restore(strip->session->document, strip->chooser_before))
        tc_strip_told(strip, "choose colour");
    tc_chooser_end(strip);
}

static void tc_strip_choose(tc_strip *strip)
{
    const tc_document *d = strip->session->document;
    GtkRoot *root = gtk_widget_get_root(strip->area);
    tc_error err = {0};
    if (strip->chooser || strip->focus >= d->n_color || tc_document_copy(&strip->chooser_before, d, &err))
        return;
    if (!d->color[strip->focus].selected)
        tc_strip_select(strip, strip->focus);
    const double *rgb = d->color[strip->focus].rgb;
    const GdkRGBA rgba = {(float)rgb[0], (float)rgb[1], (float)rgb[2], 1};
    strip->chooser = gtk_color_chooser_dialog_new("Colour", GTK_IS_WINDOW(root) ? GTK_WINDOW(root) : NULL);
    gtk_window_set_modal(GTK_WINDOW(strip->chooser), true);
    gtk_color_chooser_set_use_alpha(GTK_COLOR_CHOOSER(strip->chooser), false);
    gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(strip->chooser), &rgba);
    g_object_set(strip->chooser, "show-editor", true, NULL);
    g_signal_connect(strip->chooser, "notify::rgba", G_CALLBACK(tc_chooser_live), strip);
    g_signal_connect(strip->chooser, "response", G_CALLBACK(tc_chooser_answered), strip);
    /* All that is tried is one step; the picture may become fine between. */
    tc_session_grab(strip->session);
    strip->session->moving = false;
    gtk_window_present(GTK_WINDOW(strip->chooser));
}

/* --------------------------------------------------------------------------------------------------------- popover */

static void tc_strip_typed(GtkWidget *entry, gpointer user)
{
    tc_strip *strip = user;
    tc_document *d = strip->session->document;
    double scalar;
    if (!tc_plot_number_read(&scalar, gtk_editable_get_text(GTK_EDITABLE(entry))) || strip->focus >= d->n_color) {
        gtk_widget_error_bell(entry);
        return;
    }
    tc_strip_select(strip, strip->focus);
    tc_document_move_colors(d, fmin(fmax(tc_document_place(d, scalar), 0), 1) - d->color[strip->focus].x);
    gtk_popover_popdown(GTK_POPOVER(strip->popover));
    tc_strip_told(strip, "set colour");
    gtk_widget_grab_focus(strip->area);
}

static void tc_strip_ask(tc_strip *strip)
{
    const tc_document *d = strip->session->document;
    if (strip->focus == 0 || strip->focus + 1 >= d->n_color) {
        gtk_widget_error_bell(strip->area); /* the ends stay at the ends of the range */
        return;
    }
    const tc_edit_color *c = &d->color[strip->focus];
    char number[32];
    gtk_editable_set_text(GTK_EDITABLE(strip->scalar_entry), tc_plot_number(number, tc_document_scalar(d, c->x), 9));
    const GdkRectangle at = {(int)tc_plot_x(gtk_widget_get_width(strip->area), c->x) - 4, TC_STRIP_BAND, 8, 16};
    gtk_popover_set_pointing_to(GTK_POPOVER(strip->popover), &at);
    gtk_popover_popup(GTK_POPOVER(strip->popover));
    gtk_widget_grab_focus(strip->scalar_entry);
}

static void tc_strip_popover_build(tc_strip *strip)
{
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    strip->scalar_entry = gtk_entry_new();
    gtk_editable_set_width_chars(GTK_EDITABLE(strip->scalar_entry), 14);
    tc_plot_label(strip->scalar_entry, "Scalar of the colour", NULL);
    g_signal_connect(strip->scalar_entry, "activate", G_CALLBACK(tc_strip_typed), strip);
    gtk_box_append(GTK_BOX(row), gtk_label_new("Scalar"));
    gtk_box_append(GTK_BOX(row), strip->scalar_entry);
    strip->popover = gtk_popover_new();
    gtk_popover_set_child(GTK_POPOVER(strip->popover), row);
    gtk_widget_set_parent(strip->popover, strip->area);
}

/* --------------------------------------------------------------------------------------------------------- pointer */

static void tc_strip_finish(tc_strip *strip)
{
    const bool grabbed = strip->dragging && strip->moved;
    strip->dragging = false;
    tc_document_destroy(&strip->before);
    if (grabbed)
        tc_session_release(strip->session);
    gtk_widget_queue_draw(strip->area);
}

static void tc_strip_cancel(tc_strip *strip)
{
    if (!strip->dragging)
        return;
    if (strip->moved && strip->before && tc_plot_restore(strip->session->document, strip->before))
        tc_strip_told(strip, "move colours");
    tc_strip_finish(strip);
}

static void tc_strip_add(tc_strip *strip, double place)
{
    tc_document *d = strip->session->document;
    tc_error err = {0};
    double rgb[3];
    size_t index = 0;
    tc_document_color(rgb, d, place);
    if (tc_document_add_color(d, &index, place, rgb, &err)) {
        tc_session_say(strip->session, "%s", err.text);
        return;
    }
    strip->focus = index;
    tc_strip_told(strip, "add colour");
}

static void tc_strip_pressed(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    tc_strip *strip = user;
    GtkEventController *controller = GTK_EVENT_CONTROLLER(gesture);
    tc_document *d = strip->session->document;
    tc_error err = {0};
    tc_strip_cancel(strip);
    gtk_gesture_set_state(GTK_GESTURE(gesture), GTK_EVENT_SEQUENCE_CLAIMED);
    gtk_widget_grab_focus(strip->area);
    int within = 400;
    g_object_get(gtk_widget_get_settings(strip->area), "gtk-double-click-time", &within, NULL);
    const guint32 time = gtk_event_controller_get_current_event_time(controller);
    const bool again = time - strip->press_time < (guint32)within && fabs(x - strip->press_x) < 5;
    strip->press_time = again ? 0 : time;
    strip->press_x = x;
    const GdkModifierType state = gtk_event_controller_get_current_event_state(controller);
    strip->toggles = (state & (GDK_SHIFT_MASK | GDK_CONTROL_MASK)) != 0;
    size_t index = 0;
    if (!tc_strip_find(&index, strip, x, y)) {
        const double place = tc_plot_place(gtk_widget_get_width(strip->area), x);
        if (again && place > 0 && place < 1)
            tc_strip_add(strip, place);
        else if (!strip->toggles)
            tc_strip_select(strip, d->n_color); /* none */
        return;
    }
    strip->focus = index;
    if (again) {
        tc_strip_choose(strip);
        return;
    }
    strip->was_selected = d->color[index].selected;
    if (strip->toggles) {
        d->color[index].selected = !d->color[index].selected;
        tc_strip_told(strip, NULL);
    } else if (!strip->was_selected)
        tc_strip_select(strip, index);
    strip->dragging = tc_document_copy(&strip->before, d, &err) == TC_OK;
    strip->moved = false;
    strip->drag_index = index;
    strip->begin_x = x;
}

static void tc_strip_dragged(GtkGestureDrag *gesture, double dx, double dy, gpointer user)
{
    (void)gesture, (void)dy;
    tc_strip *strip = user;
    if (!strip->dragging || (!strip->moved && fabs(dx) < 3))
        return;
    if (!strip->moved)
        tc_session_grab(strip->session);
    strip->moved = true;
    if (!tc_plot_restore(strip->session->document, strip->before))
        return;
    const int width = gtk_widget_get_width(strip->area);
    tc_document_move_colors(strip->session->document,
                            tc_plot_place(width, strip->begin_x + dx) - tc_plot_place(width, strip->begin_x));
    tc_strip_told(strip, "move colours");
}

static void tc_strip_released(GtkGestureDrag *gesture, double dx, double dy, gpointer user)
{
    (void)gesture, (void)dx, (void)dy;
    tc_strip *strip = user;
    if (!strip->dragging)
        return;
    if (!strip->moved && strip->was_selected && !strip->toggles)
        tc_strip_select(strip, strip->drag_index);
    tc_strip_finish(strip);
}

static void tc_strip_cancelled(GtkGesture *gesture, GdkEventSequence *sequence, gpointer user)
{
    (void)gesture, (void)sequence;
    tc_strip_cancel(user);
}

static void tc_strip_hover(GtkEventControllerMotion *motion, double x, double y, gpointer user)
{
    (void)motion;
    tc_strip *strip = user;
    const size_t n = strip->session->document->n_color;
    strip->hot = tc_strip_find(&strip->hot_index, strip, x, y);
    const bool end = strip->hot && (strip->hot_index == 0 || strip->hot_index + 1 == n);
    const double place = tc_plot_place(gtk_widget_get_width(strip->area), x);
    tc_plot_cursor(strip->area, end                        ? "pointer"
                                : strip->hot               ? "ew-resize"
                                : place >= 0 && place <= 1 ? "copy"
                                                           : "default");
    gtk_widget_queue_draw(strip->area);
}

static void tc_strip_left(GtkEventControllerMotion *motion, gpointer user)
{
    (void)motion;
    tc_strip *strip = user;
    strip->hot = false;
    gtk_widget_queue_draw(strip->area);
}

/* ------------------------------------------------------------------------------------------------------------ keys */

static void tc_strip_keys_release(tc_strip *strip)
{
    if (strip->keys_grabbed)
        tc_session_release(strip->session);
    strip->keys_grabbed = false;
}

static void tc_strip_shift(tc_strip *strip, double dx)
{
    tc_document *d = strip->session->document;
    bool any = false;
    for (size_t i = 0; i < d->n_color; i++)
        any = any || d->color[i].selected;
    if (!any)
        tc_strip_select(strip, strip->focus);
    if (!strip->keys_grabbed)
        tc_session_grab(strip->session);
    strip->keys_grabbed = true;
    tc_document_move_colors(d, dx);
    tc_strip_told(strip, "move colours");
}

static gboolean tc_strip_key(GtkEventControllerKey *keys, guint key, guint code, GdkModifierType state, gpointer user)
{
    (void)keys, (void)code;
    tc_strip *strip = user;
    tc_document *d = strip->session->document;
    const bool control = (state & GDK_CONTROL_MASK) != 0;
    const double step = state & GDK_SHIFT_MASK ? 0.02 : 0.002;
    switch (key) {
    case GDK_KEY_Tab:
        if (control || strip->focus + 1 >= d->n_color)
            return false;
        tc_strip_select(strip, strip->focus + 1);
        return true;
    case GDK_KEY_ISO_Left_Tab:
        if (control || strip->focus == 0)
            return false;
        tc_strip_select(strip, strip->focus - 1);
        return true;
    case GDK_KEY_Home:
        tc_strip_select(strip, 0);
        return true;
    case GDK_KEY_End:
        tc_strip_select(strip, d->n_color - 1);
        return true;
    case GDK_KEY_Left:
    case GDK_KEY_KP_Left:
        tc_strip_shift(strip, -step);
        return true;
    case GDK_KEY_Right:
    case GDK_KEY_KP_Right:
        tc_strip_shift(strip, step);
        return true;
    case GDK_KEY_Delete:
    case GDK_KEY_KP_Delete:
    case GDK_KEY_BackSpace:
        tc_document_delete_colors(d);
        tc_strip_told(strip, "delete colours");
        return true;
    case GDK_KEY_Insert:
    case GDK_KEY_plus:
    case GDK_KEY_KP_Add: {
        const size_t i = strip->focus + 1 < d->n_color ? strip->focus : d->n_color - 2;
        tc_strip_add(strip, 0.5 * (d->color[i].x + d->color[i + 1].x));
        return true;
    }
    case GDK_KEY_space:
        d->color[strip->focus].selected = !d->color[strip->focus].selected;
        tc_strip_told(strip, NULL);
        return true;
    case GDK_KEY_a:
        if (!control)
            return false;
        for (size_t i = 0; i < d->n_color; i++)
            d->color[i].selected = true;
        tc_strip_told(strip, NULL);
        return true;
    case GDK_KEY_Escape:
        if (strip->dragging)
            tc_strip_cancel(strip);
        else
            tc_strip_select(strip, d->n_color);
        return true;
    case GDK_KEY_F2:
        tc_strip_ask(strip);
        return true;
    case GDK_KEY_Return:
    case GDK_KEY_KP_Enter:
        tc_strip_choose(strip);
        return true;
    default:
        return false;
    }
}

static void tc_strip_key_up(GtkEventControllerKey *keys, guint key, guint code, GdkModifierType state, gpointer user)
{
    (void)keys, (void)code, (void)state;
    if (key == GDK_KEY_Left || key == GDK_KEY_Right || key == GDK_KEY_KP_Left || key == GDK_KEY_KP_Right)
        tc_strip_keys_release(user);
}

static void tc_strip_focused(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    tc_strip *strip = user;
    tc_strip_describe(strip);
    gtk_widget_queue_draw(strip->area);
}

static void tc_strip_unfocused(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    tc_strip *strip = user;
    tc_strip_keys_release(strip);
    gtk_widget_queue_draw(strip->area);
}

/* ---------------------------------------------------------------------------------------------------------- widget */

static void tc_strip_heard(void *user, unsigned changes)
{
    tc_strip *strip = user;
    if (!(changes & (TC_CHANGE_FUNCTION | TC_CHANGE_SELECTION)))
        return;
    const size_t n = strip->session->document->n_color;
    if (!strip->telling && (changes & TC_CHANGE_FUNCTION) && strip->dragging)
        tc_strip_finish(strip); /* what it moved is gone */
    strip->focus = strip->focus < n ? strip->focus : n - 1;
    gtk_widget_queue_draw(strip->area);
}

static void tc_strip_gone(GtkWidget *area, gpointer user)
{
    (void)area;
    tc_strip *strip = user;
    tc_plot_unlisten(strip->session, strip);
    tc_chooser_end(strip);
    if (strip->popover)
        gtk_widget_unparent(strip->popover);
    strip->popover = NULL;
}

static void tc_strip_free(gpointer user)
{
    tc_strip *strip = user;
    tc_document_destroy(&strip->before);
    g_free(strip);
}

static void tc_strip_attach(tc_strip *strip)
{
    GtkGesture *drag = gtk_gesture_drag_new();
    gtk_gesture_single_set_button(GTK_GESTURE_SINGLE(drag), GDK_BUTTON_PRIMARY);
    g_signal_connect(drag, "drag-begin", G_CALLBACK(tc_strip_pressed), strip);
    g_signal_connect(drag, "drag-update", G_CALLBACK(tc_strip_dragged), strip);
    g_signal_connect(drag, "drag-end", G_CALLBACK(tc_strip_released), strip);
    g_signal_connect(drag, "cancel", G_CALLBACK(tc_strip_cancelled), strip);
    gtk_widget_add_controller(strip->area, GTK_EVENT_CONTROLLER(drag));
    GtkEventController *motion = gtk_event_controller_motion_new();
    g_signal_connect(motion, "motion", G_CALLBACK(tc_strip_hover), strip);
    g_signal_connect(motion, "leave", G_CALLBACK(tc_strip_left), strip);
    gtk_widget_add_controller(strip->area, motion);
    GtkEventController *keys = gtk_event_controller_key_new();
    g_signal_connect(keys, "key-pressed", G_CALLBACK(tc_strip_key), strip);
    g_signal_connect(keys, "key-released", G_CALLBACK(tc_strip_key_up), strip);
    gtk_widget_add_controller(strip->area, keys);
    GtkEventController *focus = gtk_event_controller_focus_new();
    g_signal_connect(focus, "enter", G_CALLBACK(tc_strip_focused), strip);
    g_signal_connect(focus, "leave", G_CALLBACK(tc_strip_unfocused), strip);
    gtk_widget_add_controller(strip->area, focus);
}

GtkWidget *tc_color_strip_new(tc_session *session)
{
    tc_strip *strip = g_new0(tc_strip, 1);
    strip->session = session;
    strip->area = g_object_new(GTK_TYPE_DRAWING_AREA, "accessible-role", GTK_ACCESSIBLE_ROLE_SLIDER, NULL);
    gtk_widget_set_focusable(strip->area, true);
    gtk_widget_set_hexpand(strip->area, true);
    gtk_drawing_area_set_content_height(GTK_DRAWING_AREA(strip->area), TC_STRIP_HEIGHT);
    gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(strip->area), tc_strip_draw, strip, NULL);
    tc_plot_label(strip->area, "Colours",
                  "Drag a colour; double click: on the strip a new one, on a colour its chooser");
    tc_strip_popover_build(strip);
    tc_strip_attach(strip);
    g_object_set_data_full(G_OBJECT(strip->area), TC_STRIP_DATA, strip, tc_strip_free);
    g_signal_connect(strip->area, "destroy", G_CALLBACK(tc_strip_gone), strip);
    tc_strip_describe(strip);
    tc_session_listen(session, tc_strip_heard, strip);
    return strip->area;
}
