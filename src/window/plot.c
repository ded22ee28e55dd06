/* plot.c: see plot.h. */
#include "window/plot.h"

#include <math.h>
#include <string.h>

#include "edit/axis.h"

enum { TC_PLOT_TICKS = 64 };

static void tc_color_lookup(GdkRGBA *out, GtkStyleContext *style, const char *name, const char *otherwise)
{
    if (!gtk_style_context_lookup_color(style, name, out))
        gdk_rgba_parse(out, otherwise);
}

void tc_plot_colors_get(tc_plot_colors *out, GtkWidget *widget)
{
    GtkStyleContext *style = gtk_widget_get_style_context(widget);
    gtk_style_context_get_color(style, &out->ink);
    out->dark = 0.3 * out->ink.red + 0.59 * out->ink.green + 0.11 * out->ink.blue > 0.5;
    tc_color_lookup(&out->paper, style, "theme_base_color", out->dark ? "#2d2d2d" : "#ffffff");
    tc_color_lookup(&out->accent, style, "theme_selected_bg_color", "#3584e4");
}

void tc_plot_ink(cairo_t *cr, const GdkRGBA *color, double alpha)
{
    cairo_set_source_rgba(cr, color->red, color->green, color->blue, color->alpha * alpha);
}

double tc_plot_x(int width, double place)
{
    return TC_PLOT_LEFT + place * fmax(width - TC_PLOT_LEFT - TC_PLOT_RIGHT, 1);
}

double tc_plot_place(int width, double x)
{
    return (x - TC_PLOT_LEFT) / fmax(width - TC_PLOT_LEFT - TC_PLOT_RIGHT, 1);
}

double tc_plot_text(cairo_t *cr, GtkWidget *widget, const char *text, double x, double y, double align_x,
                    double align_y)
{
    PangoLayout *layout = gtk_widget_create_pango_layout(widget, text);
    PangoAttrList *attributes = pango_attr_list_new();
    pango_attr_list_insert(attributes, pango_attr_scale_new(PANGO_SCALE_SMALL));
    pango_layout_set_attributes(layout, attributes);
    pango_attr_list_unref(attributes);
    int w = 0, h = 0;
    pango_layout_get_pixel_size(layout, &w, &h);
    cairo_move_to(cr, x - align_x * w, y - align_y * h);
    pango_cairo_show_layout(cr, layout);
    g_object_unref(layout);
    return w;
}

void tc_plot_scalar_axis(cairo_t *cr, GtkWidget *widget, const tc_document *document, int width, double y)
{
    tc_plot_colors colors;
    tc_plot_colors_get(&colors, widget);
    tc_axis_tick tick[TC_PLOT_TICKS];
    const int labels = (int)fmax((width - TC_PLOT_LEFT - TC_PLOT_RIGHT) / 70.0, 2);
    const size_t n = tc_range_ticks(tick, TC_PLOT_TICKS, document->range[0], document->range[1], document->log, labels);
    cairo_set_line_width(cr, 1);
    for (size_t i = 0; i < n; i++) {
        const double x = tc_plot_x(width, tick[i].place);
        tc_plot_ink(cr, &colors.ink, 0.6);
        cairo_move_to(cr, floor(x) + 0.5, y);
        cairo_line_to(cr, floor(x) + 0.5, y + (tick[i].label[0] ? 5 : 3));
        cairo_stroke(cr);
        tc_plot_ink(cr, &colors.ink, 0.9);
        if (tick[i].label[0])
            tc_plot_text(cr, widget, tick[i].label, x, y + 5, 0.5, 0);
    }
}

cairo_pattern_t *tc_plot_gradient(const tc_document *document, int width, double alpha)
{
    cairo_pattern_t *pattern = cairo_pattern_create_linear(tc_plot_x(width, 0), 0, tc_plot_x(width, 1), 0);
    const int n = 192;
    for (int i = 0; i <= n; i++) {
        double rgb[3];
        const double x = (double)i / n;
        tc_document_color(rgb, document, x);
        cairo_pattern_add_color_stop_rgba(pattern, x, rgb[0], rgb[1], rgb[2], alpha);
    }
    return pattern;
}

char *tc_plot_number(char out[32], double value, int digits)
{
    char format[8] = "%.6g";
    if (digits > 0 && digits < 18)
        g_snprintf(format, sizeof format, "%%.%dg", digits);
    return g_ascii_formatd(out, 32, format, value);
}

bool tc_plot_number_read(double *out, const char *text)
{
    char *copy = g_strstrip(g_strdup(text)), *end = NULL;
    for (char *c = copy; *c; c++)
        if (*c == ',')
            *c = '.';
    const double value = g_ascii_strtod(copy, &end);
    const bool right = end != copy && *end == 0 && isfinite(value);
    g_free(copy);
    if (right)
        *out = value;
    return right;
}

bool tc_plot_restore(tc_document *document, const tc_document *as)
{
    tc_document *copy = NULL;
    tc_error err = {0};
    if (tc_document_copy(&copy, as, &err))
        return false;
    tc_document old = *document;
    old.kept = copy->kept;
    copy->kept = document->kept; /* which looks itself whether the colours are the same */
    *document = *copy;
    *copy = old;
    tc_document_destroy(&copy);
    return true;
}

void tc_plot_unlisten(tc_session *session, const void *user)
{
    size_t kept = 0;
    for (size_t i = 0; i < session->n_listener; i++)
        if (session->listener[i].user != user)
            session->listener[kept++] = session->listener[i];
    session->n_listener = kept;
}

void tc_plot_label(GtkWidget *widget, const char *label, const char *tip)
{
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, label, -1);
    if (tip)
        gtk_widget_set_tooltip_text(widget, tip);
}

void tc_plot_cursor(GtkWidget *widget, const char *name)
{
    GdkCursor *now = gtk_widget_get_cursor(widget);
    if (!now || g_strcmp0(gdk_cursor_get_name(now), name))
        gtk_widget_set_cursor_from_name(widget, name);
}
