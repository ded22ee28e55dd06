/* effect_surfaces.c: isosurfaces, each with its value, colour and opacity. */
#include "window/effect_row.h"

#include <math.h>
#include <string.h>

/* One surface, as its line shows it. */
typedef struct tc_surface_line {
    GtkWidget *box;
    GtkAdjustment *value, *opacity;
    GtkWidget *color;
    bool own_color; /* else the map's */
} tc_surface_line;

typedef struct tc_surfaces {
    GtkWidget *list;
    int n;
    tc_surface_line line[TC_LOOK_MANY];
} tc_surfaces;

static void tc_surfaces_apply(tc_effect_row *row)
{
    const tc_surfaces *own = row->own;
    GString *value = g_string_new(NULL), *color = g_string_new(NULL), *opacity = g_string_new(NULL);
    bool colored = false, clear = false;
    for (int i = 0; i < own->n; i++) {
        const tc_surface_line *line = &own->line[i];
        const char *comma = i ? "," : "", *semicolon = i ? ";" : "";
        GdkRGBA rgba;
        gtk_color_chooser_get_rgba(GTK_COLOR_CHOOSER(line->color), &rgba);
        char *v = tc_effect_number_text(gtk_adjustment_get_value(line->value)), *c = tc_effect_color_text(&rgba),
             *a = tc_effect_number_text(gtk_adjustment_get_value(line->opacity));
        g_string_append_printf(value, "%s%s", comma, v);
        g_string_append_printf(color, "%s%s", semicolon, c);
        g_string_append_printf(opacity, "%s%s", comma, a);
        colored = colored || line->own_color;
        clear = clear || gtk_adjustment_get_value(line->opacity) < 1;
        g_free(v);
        g_free(c);
        g_free(a);
    }
    /* Lists of another length than that of the values cannot be: they go first, and come again after. */
    char *before = tc_effect_text(row->hub->session, "--iso");
    int commas[2] = {0, 0};
    for (const char *at = before ? before : ""; *at; at++)
        commas[0] += *at == ',';
    for (const char *at = value->str; *at; at++)
        commas[1] += *at == ',';
    const bool same = before && own->n > 0 && commas[0] == commas[1];
    bool good = true;
    static const char *const list[2] = {"--iso-color", "--iso-opacity"};
    for (int k = 0; k < 2 && !same && good; k++) {
        char *has = tc_effect_text(row->hub->session, list[k]);
        good = !has || tc_effect_row_set(row, list[k], NULL);
        g_free(has);
    }
    good = good && tc_effect_row_set(row, "--iso", own->n ? value->str : NULL);
    const bool wanted[2] = {own->n && colored, own->n && clear};
    const char *text[2] = {color->str, opacity->str};
    for (int k = 0; k < 2 && good; k++) {
        char *has = tc_effect_text(row->hub->session, list[k]);
        if (g_strcmp0(has, wanted[k] ? text[k] : NULL) != 0)
            good = tc_effect_row_set(row, list[k], wanted[k] ? text[k] : NULL);
        g_free(has);
    }
    g_free(before);
    g_string_free(value, TRUE);
    g_string_free(color, TRUE);
    g_string_free(opacity, TRUE);
}

/* The map's colour there. */
static GdkRGBA tc_map_color(const tc_session *session, double value)
{
    double rgb[3];
    const double x = tc_document_place(session->document, value);
    tc_document_color(rgb, session->document, isfinite(x) ? fmax(0, fmin(1, x)) : 0);
    return (GdkRGBA){(float)rgb[0], (float)rgb[1], (float)rgb[2], 1};
}

static tc_surface_line *tc_line_of(tc_effect_row *row, gpointer widget)
{
    tc_surfaces *own = row->own;
    const gpointer at = g_object_get_data(G_OBJECT(widget), "line");
    for (int i = 0; i < own->n; i++)
        if (own->line[i].box == at)
            return &own->line[i];
    return NULL;
}

static void tc_surface_moved(GtkAdjustment *adjustment, gpointer user)
{
    tc_effect_row *row = user;
    tc_surface_line *line = tc_line_of(row, adjustment);
    if (row->filling || !line)
        return;
    if (!line->own_color && adjustment == line->value) {
        const GdkRGBA color = tc_map_color(row->hub->session, gtk_adjustment_get_value(adjustment));
        row->filling = true;
        gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(line->color), &color);
        row->filling = false;
    }
    tc_effect_moves(row->hub);
    tc_effect_row_later(row);
}

static void tc_surface_colored(GObject *button, GParamSpec *spec, gpointer user)
{
    (void)spec;
    tc_effect_row *row = user;
    tc_surface_line *line = tc_line_of(row, button);
    if (row->filling || !line)
        return;
    line->own_color = true;
    tc_effect_row_later(row);
}

static void tc_surface_remove(tc_effect_row *row, int at)
{
    tc_surfaces *own = row->own;
    gtk_box_remove(GTK_BOX(own->list), own->line[at].box);
    memmove(&own->line[at], &own->line[at + 1], (size_t)(own->n - at - 1) * sizeof *own->line);
    own->n--;
}

static void tc_surface_removed(GtkButton *button, gpointer user)
{
    tc_effect_row *row = user;
    tc_surfaces *own = row->own;
    const tc_surface_line *line = tc_line_of(row, button);
    if (!line)
        return;
    tc_surface_remove(row, (int)(line - own->line));
    tc_effect_row_later(row);
}

static void tc_surface_add(tc_effect_row *row, double value, double opacity, const GdkRGBA *color)
{
    tc_surfaces *own = row->own;
    const tc_session *session = row->hub->session;
    const double *range = session->run.mesh ? session->run.report.scalar_range : session->document->range;
    const double low = fmin(range[0], value), high = fmax(range[1], value), width = high > low ? high - low : 1;
    tc_surface_line *line = &own->line[own->n];
    const GdkRGBA shown = color ? *color : tc_map_color(session, value);
    *line = (tc_surface_line){.box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 4),
                              .value = gtk_adjustment_new(value, low, high, width / 200, width / 20, 0),
                              .opacity = gtk_adjustment_new(opacity, 0, 1, 0.01, 0.1, 0),
                              .color = gtk_color_button_new_with_rgba(&shown),
                              .own_color = color != NULL};
    const int digits = (int)fmax(0, fmin(12, 4 - floor(log10(width))));
    GtkWidget *typed = gtk_spin_button_new(line->value, width / 200, (guint)digits),
              *slider = tc_effect_slider(line->value, "Value of the surface"),
              *clear = tc_effect_slider(line->opacity, "Opacity of the surface"),
              *away = gtk_button_new_from_icon_name("list-remove-symbolic");
    gtk_editable_set_width_chars(GTK_EDITABLE(typed), 7);
    gtk_widget_set_size_request(clear, 60, -1);
    gtk_widget_set_hexpand(clear, FALSE);
    gtk_widget_set_tooltip_text(typed, "Value of the surface");
    gtk_widget_set_tooltip_text(slider, "Value of the surface");
    gtk_widget_set_tooltip_text(clear, "Opacity of the surface");
    gtk_widget_set_tooltip_text(line->color, "Colour of the surface; the map's until one is chosen");
    gtk_widget_set_tooltip_text(away, "Remove the surface");
    gtk_accessible_update_property(GTK_ACCESSIBLE(typed), GTK_ACCESSIBLE_PROPERTY_LABEL, "Value of the surface", -1);
    gtk_accessible_update_property(GTK_ACCESSIBLE(away), GTK_ACCESSIBLE_PROPERTY_LABEL, "Remove the surface", -1);
    gtk_accessible_update_property(GTK_ACCESSIBLE(line->color), GTK_ACCESSIBLE_PROPERTY_LABEL, "Colour of the surface",
                                   -1);
    GtkWidget *const part[] = {typed, slider, line->color, clear, away};
    for (size_t i = 0; i < sizeof part / sizeof *part; i++)
        gtk_box_append(GTK_BOX(line->box), part[i]);
    const gpointer tagged[] = {line->value, line->opacity, line->color, away};
    for (size_t i = 0; i < sizeof tagged / sizeof *tagged; i++)
        g_object_set_data(G_OBJECT(tagged[i]), "line", line->box);
    g_signal_connect(line->value, "value-changed", G_CALLBACK(tc_surface_moved), row);
    g_signal_connect(line->opacity, "value-changed", G_CALLBACK(tc_surface_moved), row);
    g_signal_connect(line->color, "notify::rgba", G_CALLBACK(tc_surface_colored), row);
    g_signal_connect(away, "clicked", G_CALLBACK(tc_surface_removed), row);
    gtk_box_append(GTK_BOX(own->list), line->box);
    own->n++;
}

/* In the widest gap between those that are there and the range's ends. */
static void tc_surface_new(GtkButton *button, gpointer user)
{
    (void)button;
    tc_effect_row *row = user;
    tc_surfaces *own = row->own;
    const tc_session *session = row->hub->session;
    const double *range = session->run.mesh ? session->run.report.scalar_range : session->document->range;
    double best = range[0], widest = -1;
    for (int i = -1; i < own->n; i++) {
        const double from = i < 0 ? range[0] : gtk_adjustment_get_value(own->line[i].value);
        double to = range[1];
        for (int k = 0; k < own->n; k++) {
            const double value = gtk_adjustment_get_value(own->line[k].value);
            if (value > from && value < to)
                to = value;
        }
        if (to - from > widest) {
            widest = to - from;
            best = 0.5 * (from + to);
        }
    }
    if (own->n == TC_LOOK_MANY)
        return;
    tc_surface_add(row, best, 1, NULL);
    tc_effect_row_later(row);
}

static void tc_surfaces_fill(tc_effect_row *row)
{
    tc_surfaces *own = row->own;
    const tc_look_options *look = &row->hub->session->options.look;
    if (own->n == look->iso.n) { /* sliders that the user holds stay where they are */
        bool same = true;
        for (int i = 0; i < own->n && same; i++) {
            const double shown = gtk_adjustment_get_value(own->line[i].value);
            const int c = look->iso_opacity.n > 1 ? i : 0;
            const double opacity = look->iso_opacity.n ? look->iso_opacity.value[c] : 1;
            same = fabs(shown - look->iso.value[i]) <= 1e-5 * fabs(shown) + 1e-300 &&
                   fabs(gtk_adjustment_get_value(own->line[i].opacity) - opacity) < 1e-5 &&
                   own->line[i].own_color == (look->iso_color.n > 0);
        }
        for (int i = 0; i < own->n && same; i++) {
            const GdkRGBA color = tc_map_color(row->hub->session, gtk_adjustment_get_value(own->line[i].value));
            if (!own->line[i].own_color)
                gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(own->line[i].color), &color);
        }
        if (same)
            return;
    }
    while (own->n > 0)
        tc_surface_remove(row, own->n - 1);
    for (int i = 0; i < look->iso.n; i++) {
        const double *rgb = look->iso_color.n ? look->iso_color.rgb[look->iso_color.n > 1 ? i : 0] : NULL;
        const GdkRGBA color = {rgb ? (float)rgb[0] : 0, rgb ? (float)rgb[1] : 0, rgb ? (float)rgb[2] : 0, 1};
        const double opacity = look->iso_opacity.n ? look->iso_opacity.value[look->iso_opacity.n > 1 ? i : 0] : 1;
        tc_surface_add(row, look->iso.value[i], opacity, rgb ? &color : NULL);
    }
}

tc_effect_row *tc_effect_surfaces_new(tc_effect_hub *hub, const tc_control *control)
{
    tc_control titled = *control;
    g_strlcpy(titled.title, "Isosurfaces", sizeof titled.title);
    tc_effect_row *row = tc_effect_row_frame(hub, &titled);
    tc_surfaces *own = g_new0(tc_surfaces, 1);
    own->list = gtk_box_new(GTK_ORIENTATION_VERTICAL, 2);
    row->own = own;
    row->widget = gtk_button_new_with_label("Add a surface");
    row->apply = tc_surfaces_apply;
    row->fill = tc_surfaces_fill;
    gtk_widget_set_halign(row->widget, GTK_ALIGN_END);
    gtk_widget_set_hexpand(row->widget, TRUE);
    g_signal_connect(row->widget, "clicked", G_CALLBACK(tc_surface_new), row);
    tc_effect_row_put(row, own->list, true);
    gtk_box_append(GTK_BOX(row->line), row->widget);
    return row;
}
