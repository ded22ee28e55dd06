/* curve.c: the opacity curve as a widget: tools above, the plot below, the popover in which values are typed. */
#include "window/curve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "window/curve_state.h"
#include "window/loader.h"
#include "window/plot.h"

#define TC_CURVE_DATA "tetcast-curve"

void tc_curve_describe(tc_curve *curve)
{
    const tc_document *d = curve->session->document;
    const tc_edit_point *p = &d->point[curve->focus < d->n_point ? curve->focus : 0];
    char scalar[32], opacity[32], text[160];
    snprintf(text, sizeof text, "Point %zu of %zu%s: scalar %s, opacity %s", curve->focus + 1, d->n_point,
             p->selected ? ", selected" : "", tc_plot_number(scalar, tc_document_scalar(d, p->x), 6),
             tc_plot_number(opacity, p->a, 6));
    gtk_accessible_update_property(GTK_ACCESSIBLE(curve->area), GTK_ACCESSIBLE_PROPERTY_VALUE_MIN, 0.0,
                                   GTK_ACCESSIBLE_PROPERTY_VALUE_MAX, fmax(curve->axis.top, p->a),
                                   GTK_ACCESSIBLE_PROPERTY_VALUE_NOW, p->a, GTK_ACCESSIBLE_PROPERTY_VALUE_TEXT, text,
                                   -1);
}

void tc_curve_tool_set(tc_curve *curve, tc_curve_tool tool)
{
    curve->tool = tool;
    gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(curve->tool_button[tool]), true);
    gtk_widget_queue_draw(curve->area);
}

/* ---------------------------------------------------------------------------------------------------- popover */

static void tc_values_typed(GtkWidget *widget, gpointer user)
{
    (void)widget;
    tc_curve *curve = user;
    tc_document *d = curve->session->document;
    double scalar = 0, opacity = 0, went[2];
    const bool has_scalar = tc_plot_number_read(&scalar, gtk_editable_get_text(GTK_EDITABLE(curve->scalar_entry)));
    const bool has_opacity = tc_plot_number_read(&opacity, gtk_editable_get_text(GTK_EDITABLE(curve->opacity_entry)));
    if (!has_scalar || !has_opacity || opacity < 0 || curve->focus >= d->n_point) {
        gtk_widget_error_bell(curve->area);
        gtk_widget_grab_focus(has_scalar ? curve->opacity_entry : curve->scalar_entry);
        return;
    }
    const size_t index = curve->focus;
    tc_curve_select(curve, index);
    const tc_edit_point *p = &d->point[index];
    /* What was not touched stays as exact as it was. */
    char shown[32];
    tc_plot_number(shown, tc_document_scalar(d, p->x), 9);
    const bool same_x = !strcmp(shown, gtk_editable_get_text(GTK_EDITABLE(curve->scalar_entry)));
    const double x = same_x ? p->x : fmin(fmax(tc_document_place(d, scalar), 0), 1);
    tc_document_move(went, d, x - p->x, opacity - p->a);
    gtk_popover_popdown(GTK_POPOVER(curve->popover));
    tc_curve_told(curve, "set point");
    tc_curve_fit(curve, false);
    gtk_widget_grab_focus(curve->area);
}

static GtkWidget *tc_value_entry(tc_curve *curve, GtkGrid *grid, int row, const char *name)
{
    GtkWidget *label = gtk_label_new(name), *entry = gtk_entry_new();
    gtk_widget_set_halign(label, GTK_ALIGN_END);
    gtk_editable_set_width_chars(GTK_EDITABLE(entry), 14);
    tc_plot_label(entry, name, NULL);
    gtk_grid_attach(grid, label, 0, row, 1, 1);
    gtk_grid_attach(grid, entry, 1, row, 1, 1);
    g_signal_connect(entry, "activate", G_CALLBACK(tc_values_typed), curve);
    return entry;
}

static void tc_popover_build(tc_curve *curve)
{
    GtkWidget *grid = gtk_grid_new();
    gtk_grid_set_row_spacing(GTK_GRID(grid), 6);
    gtk_grid_set_column_spacing(GTK_GRID(grid), 6);
    curve->scalar_entry = tc_value_entry(curve, GTK_GRID(grid), 0, "Scalar");
    curve->opacity_entry = tc_value_entry(curve, GTK_GRID(grid), 1, "Opacity");
    curve->popover = gtk_popover_new();
    gtk_popover_set_child(GTK_POPOVER(curve->popover), grid);
    gtk_widget_set_parent(curve->popover, curve->area);
}

void tc_curve_ask(tc_curve *curve)
{
    const tc_document *d = curve->session->document;
    if (curve->focus >= d->n_point)
        return;
    const tc_edit_point *p = &d->point[curve->focus];
    tc_curve_frame f;
    tc_curve_frame_get(&f, curve);
    char number[32];
    gtk_editable_set_text(GTK_EDITABLE(curve->scalar_entry), tc_plot_number(number, tc_document_scalar(d, p->x), 9));
    gtk_editable_set_text(GTK_EDITABLE(curve->opacity_entry), tc_plot_number(number, p->a, 9));
    /* The ends stay at the ends of the range. */
    gtk_widget_set_sensitive(curve->scalar_entry, curve->focus > 0 && curve->focus + 1 < d->n_point);
    const GdkRectangle at = {(int)tc_plot_x(f.width, p->x) - 4, (int)fmax(tc_curve_y(curve, &f, p->a), f.top) - 4, 8,
                             8};
    gtk_popover_set_pointing_to(GTK_POPOVER(curve->popover), &at);
    gtk_popover_popup(GTK_POPOVER(curve->popover));
    gtk_widget_grab_focus(curve->opacity_entry);
}

/* ------------------------------------------------------------------------------------------------------ tools */

/* Icons, in a square of 16. */
static void tc_icon_draw(GtkDrawingArea *area, cairo_t *cr, int width, int height, gpointer user)
{
    GdkRGBA ink;
    gtk_style_context_get_color(gtk_widget_get_style_context(GTK_WIDGET(area)), &ink);
    cairo_translate(cr, 0.5 * width - 8, 0.5 * height - 8);
    tc_plot_ink(cr, &ink, 1);
    cairo_set_line_width(cr, 1.6);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    switch ((tc_curve_tool)GPOINTER_TO_INT(user)) {
    case TC_TOOL_SELECT:
        cairo_move_to(cr, 1, 13);
        cairo_line_to(cr, 8, 5);
        cairo_line_to(cr, 15, 10);
        cairo_stroke(cr);
        cairo_arc(cr, 8, 5, 2.6, 0, 2 * G_PI);
        cairo_fill(cr);
        break;
    case TC_TOOL_FREEHAND:
        cairo_move_to(cr, 1, 12);
        cairo_curve_to(cr, 4, -2, 7, 4, 8, 8);
        cairo_curve_to(cr, 9, 13, 12, 14, 15, 3);
        cairo_stroke(cr);
        break;
    case TC_TOOL_GAUSSIAN:
        cairo_move_to(cr, 1, 14);
        cairo_curve_to(cr, 6, 14, 5, 2, 8, 2);
        cairo_curve_to(cr, 11, 2, 10, 14, 15, 14);
        cairo_stroke(cr);
        break;
    case TC_TOOL_TRAPEZOID:
        cairo_move_to(cr, 1, 14);
        cairo_line_to(cr, 5, 3);
        cairo_line_to(cr, 11, 3);
        cairo_line_to(cr, 15, 14);
        cairo_stroke(cr);
        break;
    default:
        cairo_move_to(cr, 1, 14);
        cairo_line_to(cr, 4, 14);
        cairo_line_to(cr, 4, 3);
        cairo_line_to(cr, 12, 3);
        cairo_line_to(cr, 12, 14);
        cairo_line_to(cr, 15, 14);
        cairo_stroke(cr);
        break;
    }
}

static void tc_tool_toggled(GtkToggleButton *button, gpointer user)
{
    tc_curve *curve = user;
    for (int i = 0; i < TC_TOOLS; i++)
        if (curve->tool_button[i] == GTK_WIDGET(button) && gtk_toggle_button_get_active(button))
            curve->tool = (tc_curve_tool)i;
}

static void tc_axis_toggled(GtkCheckButton *button, gpointer user)
{
    tc_curve *curve = user;
    tc_curve_drag_cancel(curve);
    curve->axis.log = gtk_check_button_get_active(button);
    gtk_widget_queue_draw(curve->area);
}

static void tc_counts_toggled(GtkCheckButton *button, gpointer user)
{
    tc_curve *curve = user;
    curve->log_counts = gtk_check_button_get_active(button);
    gtk_widget_queue_draw(curve->area);
}

static void tc_volume_toggled(GtkCheckButton *button, gpointer user)
{
    tc_curve *curve = user;
    const bool by_volume = gtk_check_button_get_active(button);
    if (curve->session->by_volume == by_volume)
        return;
    curve->session->by_volume = by_volume;
    tc_loader_histogram(curve->session);
}

static void tc_top_typed(GtkWidget *entry, gpointer user)
{
    tc_curve *curve = user;
    double top = 0;
    if (tc_plot_number_read(&top, gtk_editable_get_text(GTK_EDITABLE(entry))) && top > 0)
        tc_curve_top_set(curve, top);
    else {
        gtk_widget_error_bell(entry);
        tc_curve_top_set(curve, curve->axis.top);
    }
}

static GtkWidget *tc_checks_build(tc_curve *curve)
{
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    curve->axis_button = gtk_check_button_new_with_label("Log opacity");
    tc_plot_label(curve->axis_button, "Logarithmic opacity axis", "Logarithmic opacity axis, with 0 at its foot");
    g_signal_connect(curve->axis_button, "toggled", G_CALLBACK(tc_axis_toggled), curve);
    gtk_box_append(GTK_BOX(row), curve->axis_button);

    curve->count_button = gtk_check_button_new_with_label("Log counts");
    gtk_check_button_set_active(GTK_CHECK_BUTTON(curve->count_button), curve->log_counts);
    tc_plot_label(curve->count_button, "Logarithmic counts of the histogram", "Logarithmic counts of the histogram");
    g_signal_connect(curve->count_button, "toggled", G_CALLBACK(tc_counts_toggled), curve);
    gtk_box_append(GTK_BOX(row), curve->count_button);

    curve->volume_button = gtk_check_button_new_with_label("By volume");
    gtk_check_button_set_active(GTK_CHECK_BUTTON(curve->volume_button), curve->session->by_volume);
    tc_plot_label(curve->volume_button, "Histogram by volume", "Values count by the volume of their cells");
    g_signal_connect(curve->volume_button, "toggled", G_CALLBACK(tc_volume_toggled), curve);
    gtk_box_append(GTK_BOX(row), curve->volume_button);
    return row;
}

static GtkWidget *tc_tools_build(tc_curve *curve)
{
    static const char *const name[TC_TOOLS] = {"Select and move", "Draw freehand", "Gaussian", "Trapezoid", "Step"};
    static const char *const tip[TC_TOOLS] = {
        "Move points, click on the curve for a new one",
        "Draw the curve by hand",
        "Drag over a stretch for a Gaussian; Enter places it over the selected points",
        "Drag over a stretch for a trapezoid; Enter places it over the selected points",
        "Drag over a stretch for a step; Enter places it over the selected points",
    };
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6), *group = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 0);
    gtk_widget_add_css_class(group, "linked");
    for (int i = 0; i < TC_TOOLS; i++) {
        GtkWidget *button = gtk_toggle_button_new(), *icon = gtk_drawing_area_new();
        gtk_drawing_area_set_content_width(GTK_DRAWING_AREA(icon), 16);
        gtk_drawing_area_set_content_height(GTK_DRAWING_AREA(icon), 16);
        gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(icon), tc_icon_draw, GINT_TO_POINTER(i), NULL);
        gtk_button_set_child(GTK_BUTTON(button), icon);
        tc_plot_label(button, name[i], tip[i]);
        if (i > 0)
            gtk_toggle_button_set_group(GTK_TOGGLE_BUTTON(button), GTK_TOGGLE_BUTTON(curve->tool_button[0]));
        curve->tool_button[i] = button;
        g_signal_connect(button, "toggled", G_CALLBACK(tc_tool_toggled), curve);
        gtk_box_append(GTK_BOX(group), button);
    }
    gtk_box_append(GTK_BOX(row), group);

    GtkWidget *label = gtk_label_new("Top");
    gtk_widget_set_hexpand(label, true);
    gtk_widget_set_halign(label, GTK_ALIGN_END);
    gtk_box_append(GTK_BOX(row), label);
    curve->top_entry = gtk_entry_new();
    gtk_editable_set_width_chars(GTK_EDITABLE(curve->top_entry), 6);
    gtk_editable_set_max_width_chars(GTK_EDITABLE(curve->top_entry), 8);
    tc_plot_label(curve->top_entry, "Top of the opacity axis",
                  "Top of the opacity axis; or drag its label in the plot");
    g_signal_connect(curve->top_entry, "activate", G_CALLBACK(tc_top_typed), curve);
    gtk_box_append(GTK_BOX(row), curve->top_entry);
    return row;
}

/* ----------------------------------------------------------------------------------------------------- widget */

static void tc_curve_heard(void *user, unsigned changes)
{
    tc_curve *curve = user;
    if (!(changes & (TC_CHANGE_FUNCTION | TC_CHANGE_SELECTION | TC_CHANGE_DATA)))
        return;
    if (!curve->telling && (changes & TC_CHANGE_FUNCTION)) {
        tc_curve_drag_forget(curve); /* what it moved is gone */
        if (!curve->session->moving)
            tc_curve_fit(curve, true);
    }
    if (curve->focus >= curve->session->document->n_point)
        curve->focus = curve->session->document->n_point - 1;
    gtk_widget_queue_draw(curve->area);
}

/* The area goes before its box. */
static void tc_curve_gone(GtkWidget *area, gpointer user)
{
    (void)area;
    tc_curve *curve = user;
    tc_plot_unlisten(curve->session, curve);
    if (curve->popover)
        gtk_widget_unparent(curve->popover);
    curve->popover = NULL;
}

static void tc_curve_free(gpointer user)
{
    tc_curve *curve = user;
    tc_document_destroy(&curve->before);
    free(curve->line);
    free(curve->mark);
    g_free(curve);
}

GtkWidget *tc_curve_new(tc_session *session)
{
    tc_curve *curve = g_new0(tc_curve, 1);
    curve->session = session;
    curve->axis = (tc_axis){.top = 1, .decades = 5, .foot = 0.06};
    curve->log_counts = true;
    curve->picked = NAN;
    curve->box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 4);
    curve->area = g_object_new(GTK_TYPE_DRAWING_AREA, "accessible-role", GTK_ACCESSIBLE_ROLE_SLIDER, NULL);
    gtk_box_append(GTK_BOX(curve->box), tc_tools_build(curve));
    gtk_box_append(GTK_BOX(curve->box), tc_checks_build(curve));
    gtk_box_append(GTK_BOX(curve->box), curve->area);
    gtk_widget_set_focusable(curve->area, true);
    gtk_widget_set_vexpand(curve->area, true);
    gtk_widget_set_hexpand(curve->area, true);
    gtk_drawing_area_set_content_width(GTK_DRAWING_AREA(curve->area), 360);
    gtk_drawing_area_set_content_height(GTK_DRAWING_AREA(curve->area), 200);
    gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(curve->area), tc_curve_draw, curve, NULL);
    tc_plot_label(curve->area, "Opacity curve", NULL);
    tc_popover_build(curve);
    tc_curve_pointer_attach(curve);
    tc_curve_keys_attach(curve);
    g_object_set_data_full(G_OBJECT(curve->box), TC_CURVE_DATA, curve, tc_curve_free);
    g_signal_connect(curve->area, "destroy", G_CALLBACK(tc_curve_gone), curve);
    tc_curve_tool_set(curve, TC_TOOL_SELECT);
    tc_curve_top_set(curve, 1);
    tc_curve_fit(curve, true);
    tc_curve_describe(curve);
    tc_session_listen(session, tc_curve_heard, curve);
    return curve->box;
}

void tc_curve_mark(GtkWidget *widget, const double *scalar, size_t n, double picked)
{
    tc_curve *curve = g_object_get_data(G_OBJECT(widget), TC_CURVE_DATA);
    g_return_if_fail(curve);
    double *copy = n ? malloc(n * sizeof *copy) : NULL;
    if (copy)
        memcpy(copy, scalar, n * sizeof *copy);
    free(curve->mark);
    curve->mark = copy;
    curve->n_mark = copy ? n : 0;
    curve->picked = picked;
    gtk_widget_queue_draw(curve->area);
}
