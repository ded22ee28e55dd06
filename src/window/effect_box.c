/* effect_box.c: a box that the data are clipped to, by sliders within their bounds. */
#include "window/effect_row.h"

#include <math.h>

typedef struct tc_clip_box {
    GtkAdjustment *end[6]; /* xmin xmax ymin ymax zmin zmax */
} tc_clip_box;

static void tc_box_apply(tc_effect_row *row)
{
    const tc_clip_box *own = row->own;
    if (!gtk_switch_get_active(GTK_SWITCH(row->second))) {
        tc_effect_row_set(row, row->control.option->name, NULL);
        return;
    }
    char *part[7] = {NULL};
    for (int i = 0; i < 6; i++)
        part[i] = tc_effect_number_text(gtk_adjustment_get_value(own->end[i]));
    char *text = g_strjoinv(",", part);
    tc_effect_row_set(row, row->control.option->name, text);
    for (int i = 0; i < 6; i++)
        g_free(part[i]);
    g_free(text);
}

/* An end that is pushed against the other one takes it along. */
static void tc_box_moved(GtkAdjustment *adjustment, gpointer user)
{
    tc_effect_row *row = user;
    const tc_clip_box *own = row->own;
    if (row->filling)
        return;
    for (int i = 0; i < 6; i += 2) {
        const double lower = gtk_adjustment_get_lower(own->end[i]), upper = gtk_adjustment_get_upper(own->end[i]);
        const double low = gtk_adjustment_get_value(own->end[i]), high = gtk_adjustment_get_value(own->end[i + 1]);
        const double least = 0.005 * (upper - lower);
        row->filling = true;
        if (adjustment == own->end[i] && high < low + least) {
            gtk_adjustment_set_value(own->end[i + 1], low + least);
            if (low + least > upper)
                gtk_adjustment_set_value(own->end[i], upper - least);
        }
        if (adjustment == own->end[i + 1] && low > high - least) {
            gtk_adjustment_set_value(own->end[i], high - least);
            if (high - least < lower)
                gtk_adjustment_set_value(own->end[i + 1], lower + least);
        }
        row->filling = false;
    }
    gtk_switch_set_active(GTK_SWITCH(row->second), TRUE);
    tc_effect_moves(row->hub);
    tc_effect_row_later(row);
}

static void tc_box_switched(GObject *widget, GParamSpec *spec, gpointer user)
{
    (void)widget;
    (void)spec;
    tc_effect_row_later(user);
}

static void tc_box_fill(tc_effect_row *row)
{
    const tc_clip_box *own = row->own;
    const tc_session *session = row->hub->session;
    const bool given = session->options.look.has_clip_box;
    for (int i = 0; i < 6; i++) {
        const double *bounds = session->run.report.bounds + i / 2 * 2;
        const double width = bounds[1] - bounds[0], value = given ? session->options.look.clip_box[i] : bounds[i % 2];
        if (!session->run.mesh)
            continue;
        const double shown = gtk_adjustment_get_value(own->end[i]);
        const bool same = given && gtk_adjustment_get_upper(own->end[i]) > 0 && fabs(shown - value) <= 1e-5 * width;
        gtk_adjustment_configure(own->end[i], same ? shown : value, fmin(bounds[0], value), fmax(bounds[1], value),
                                 width / 100, width / 10, 0);
    }
    gtk_switch_set_active(GTK_SWITCH(row->second), given);
}

static char *tc_box_format(GtkScale *scale, double value, gpointer user)
{
    (void)scale;
    (void)user;
    return g_strdup_printf("%.4g", value);
}

tc_effect_row *tc_effect_box_new(tc_effect_hub *hub, const tc_control *control)
{
    static const char *const axis[3] = {"x", "y", "z"}, *const end[2] = {"from", "to"};
    tc_effect_row *row = tc_effect_row_frame(hub, control);
    tc_clip_box *own = g_new0(tc_clip_box, 1);
    GtkWidget *grid = gtk_grid_new();
    row->own = own;
    row->second = gtk_switch_new();
    row->apply = tc_box_apply;
    row->fill = tc_box_fill;
    gtk_grid_set_column_spacing(GTK_GRID(grid), 6);
    for (int i = 0; i < 6; i++) {
        char name[48];
        g_snprintf(name, sizeof name, "Box in %s, %s", axis[i / 2], end[i % 2]);
        own->end[i] = gtk_adjustment_new(i % 2, 0, 1, 0.01, 0.1, 0);
        GtkWidget *slider = tc_effect_slider(own->end[i], name);
        gtk_scale_set_draw_value(GTK_SCALE(slider), TRUE);
        gtk_scale_set_value_pos(GTK_SCALE(slider), GTK_POS_RIGHT);
        gtk_scale_set_format_value_func(GTK_SCALE(slider), tc_box_format, NULL, NULL);
        gtk_range_set_round_digits(GTK_RANGE(slider), -1);
        gtk_widget_set_tooltip_text(slider, name);
        if (i % 2 == 0)
            gtk_grid_attach(GTK_GRID(grid), gtk_label_new(axis[i / 2]), 0, i / 2, 1, 1);
        gtk_grid_attach(GTK_GRID(grid), slider, 1 + i % 2, i / 2, 1, 1);
        g_signal_connect(own->end[i], "value-changed", G_CALLBACK(tc_box_moved), row);
    }
    gtk_widget_set_halign(row->second, GTK_ALIGN_END);
    gtk_widget_set_hexpand(row->second, TRUE);
    gtk_accessible_update_property(GTK_ACCESSIBLE(row->second), GTK_ACCESSIBLE_PROPERTY_LABEL, control->title, -1);
    g_signal_connect(row->second, "notify::active", G_CALLBACK(tc_box_switched), row);
    gtk_box_append(GTK_BOX(row->line), row->second);
    row->widget = grid;
    tc_effect_row_put(row, grid, true);
    return row;
}
