/* color_bar.c: see color_bar.h: the strip, the range bar, and the controls below them. */
#include "window/color_bar.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "window/color_strip.h"
#include "window/plot.h"
#include "window/range_bar.h"
#include "window/range_visible.h"

#define TC_BAR_DATA "tetcast-color-bar"
#define TC_BAR_DECADES 3.0 /* of the unit distance, to both sides of the mesh's own */

typedef struct tc_color_bar {
    tc_session *session;
    GtkWidget *box, *range[2], *log, *percent, *space, *nan, *nan_color, *nan_opacity;
    GtkWidget *distance, *distance_entry, *distance_default;
    bool showing; /* controls are set to what the document is: nothing is to be edited */
    bool distance_held;
} tc_color_bar;

/* The mesh's own; 1 while there is none. */
static double tc_bar_unit(const tc_color_bar *bar)
{
    return bar->session->run.mesh ? tc_default_unit_distance(bar->session->run.mesh) : 1;
}

static void tc_entry_show(GtkWidget *entry, double value, int digits)
{
    char number[32];
    tc_plot_number(number, value, digits);
    if (g_strcmp0(gtk_editable_get_text(GTK_EDITABLE(entry)), number))
        gtk_editable_set_text(GTK_EDITABLE(entry), number);
}

static void tc_bar_show(tc_color_bar *bar)
{
    const tc_document *d = bar->session->document;
    const double unit = tc_bar_unit(bar), distance = d->unit_distance > 0 ? d->unit_distance : unit;
    bar->showing = true;
    for (int i = 0; i < 2; i++)
        tc_entry_show(bar->range[i], d->range[i], 7);
    gtk_check_button_set_active(GTK_CHECK_BUTTON(bar->log), d->log);
    gtk_drop_down_set_selected(GTK_DROP_DOWN(bar->space), (guint)d->space);
    gtk_check_button_set_active(GTK_CHECK_BUTTON(bar->nan), d->has_nan_color);
    const GdkRGBA rgba = {(float)d->nan_color[0], (float)d->nan_color[1], (float)d->nan_color[2], 1};
    gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(bar->nan_color), &rgba);
    tc_entry_show(bar->nan_opacity, d->nan_color[3], 4);
    gtk_widget_set_sensitive(bar->nan_color, d->has_nan_color);
    gtk_widget_set_sensitive(bar->nan_opacity, d->has_nan_color);
    gtk_range_set_value(GTK_RANGE(bar->distance), log10(distance / unit));
    tc_entry_show(bar->distance_entry, distance, 4);
    gtk_widget_set_sensitive(bar->distance_default, d->unit_distance > 0);
    bar->showing = false;
}

/* ----------------------------------------------------------------------------------------------------------- range */

static void tc_bar_range_typed(GtkWidget *entry, gpointer user)
{
    tc_color_bar *bar = user;
    double end[2];
    bool right = true;
    for (int i = 0; i < 2; i++) {
        end[i] = bar->session->document->range[i];
        /* The one that was not typed in stays as exact as it was. */
        if (bar->range[i] == entry)
            right = tc_plot_number_read(&end[i], gtk_editable_get_text(GTK_EDITABLE(entry)));
    }
    if (!right)
        gtk_widget_error_bell(entry);
    else if (bar->session->document->log && !(end[0] > 0))
        tc_session_say(bar->session, "a logarithmic scale begins above 0: type a larger number, or turn it off");
    else if (end[0] > end[1])
        tc_session_say(bar->session, "the range's lower end must be below its upper end");
    else
        tc_range_set(bar->session, end[0], end[1], "set range");
    tc_bar_show(bar);
}

static void tc_bar_from_data(GtkButton *button, gpointer user)
{
    (void)button;
    tc_session *session = ((tc_color_bar *)user)->session;
    if (!session->histogram && !session->run.mesh)
        tc_session_say(session, "no data are there yet: wait until they are read");
    else {
        const double *range = session->run.mesh ? session->run.report.scalar_range : session->histogram->range;
        tc_range_set(session, range[0], range[1], "range of data");
    }
}

static void tc_bar_from_visible(GtkButton *button, gpointer user)
{
    (void)button;
    tc_color_bar *bar = user;
    tc_range_visible(bar->session, bar->box);
}

static void tc_bar_from_percentile(GtkButton *button, gpointer user)
{
    (void)button;
    tc_color_bar *bar = user;
    const tc_histogram *histogram = bar->session->histogram;
    const double share = gtk_spin_button_get_value(GTK_SPIN_BUTTON(bar->percent)) / 100;
    if (!histogram)
        tc_session_say(bar->session, "no histogram is there yet: wait until the data are read");
    else
        tc_range_set(bar->session, tc_histogram_percentile(histogram, share),
                     tc_histogram_percentile(histogram, 1 - share), "range by percentile");
}

static void tc_bar_log_toggled(GtkCheckButton *button, gpointer user)
{
    tc_color_bar *bar = user;
    tc_document *d = bar->session->document;
    if (bar->showing)
        return;
    d->log = gtk_check_button_get_active(button);
    if (!tc_range_set(bar->session, d->range[0], d->range[1], d->log ? "logarithmic scale" : "linear scale"))
        d->log = false;
    tc_bar_show(bar);
}

/* ---------------------------------------------------------------------------------------------------------- colours */

static void tc_bar_space_chosen(GtkDropDown *drop, GParamSpec *spec, gpointer user)
{
    (void)spec;
    tc_color_bar *bar = user;
    const guint space = gtk_drop_down_get_selected(drop);
    if (bar->showing || space >= TC_EDIT_SPACES || bar->session->document->space == (tc_edit_space)space)
        return;
    bar->session->document->space = (tc_edit_space)space;
    tc_session_edited(bar->session, "colour space");
}

static void tc_bar_nan_toggled(GtkCheckButton *button, gpointer user)
{
    tc_color_bar *bar = user;
    tc_document *d = bar->session->document;
    if (bar->showing)
        return;
    d->has_nan_color = gtk_check_button_get_active(button);
    tc_session_edited(bar->session, "colour of missing values");
}

static void tc_bar_nan_chosen(GtkColorButton *button, gpointer user)
{
    tc_color_bar *bar = user;
    tc_document *d = bar->session->document;
    GdkRGBA rgba;
    if (bar->showing)
        return;
    gtk_color_chooser_get_rgba(GTK_COLOR_CHOOSER(button), &rgba);
    d->nan_color[0] = rgba.red;
    d->nan_color[1] = rgba.green;
    d->nan_color[2] = rgba.blue;
    tc_session_edited(bar->session, "colour of missing values");
}

static void tc_bar_nan_typed(GtkWidget *entry, gpointer user)
{
    tc_color_bar *bar = user;
    double opacity = 0;
    if (tc_plot_number_read(&opacity, gtk_editable_get_text(GTK_EDITABLE(entry))) && opacity >= 0) {
        bar->session->document->nan_color[3] = opacity;
        tc_session_edited(bar->session, "opacity of missing values");
    } else
        gtk_widget_error_bell(entry);
    tc_bar_show(bar);
}

/* --------------------------------------------------------------------------------------------------- unit distance */

static void tc_bar_distance_moved(GtkRange *range, gpointer user)
{
    tc_color_bar *bar = user;
    if (bar->showing)
        return;
    bar->session->document->unit_distance = tc_bar_unit(bar) * pow(10, gtk_range_get_value(range));
    tc_session_edited(bar->session, "unit distance");
}

/* The slider's own gesture has the press: only its events are seen here. */
static gboolean tc_bar_distance_event(GtkEventControllerLegacy *legacy, GdkEvent *event, gpointer user)
{
    (void)legacy;
    tc_color_bar *bar = user;
    const GdkEventType type = gdk_event_get_event_type(event);
    if (type == GDK_BUTTON_PRESS && !bar->distance_held) {
        bar->distance_held = true;
        tc_session_grab(bar->session);
    } else if ((type == GDK_BUTTON_RELEASE || type == GDK_GRAB_BROKEN) && bar->distance_held) {
        bar->distance_held = false;
        tc_session_release(bar->session);
    }
    return false;
}

static void tc_bar_distance_typed(GtkWidget *entry, gpointer user)
{
    tc_color_bar *bar = user;
    double distance = 0;
    if (tc_plot_number_read(&distance, gtk_editable_get_text(GTK_EDITABLE(entry))) && distance > 0) {
        bar->session->document->unit_distance = distance;
        tc_session_edited(bar->session, "unit distance");
    } else
        gtk_widget_error_bell(entry);
    tc_bar_show(bar);
}

static void tc_bar_distance_reset(GtkButton *button, gpointer user)
{
    (void)button;
    tc_color_bar *bar = user;
    bar->session->document->unit_distance = 0;
    tc_session_edited(bar->session, "unit distance");
}

/* ---------------------------------------------------------------------------------------------------------- widget */

static GtkWidget *tc_bar_row(tc_color_bar *bar)
{
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    gtk_widget_set_margin_start(row, 8);
    gtk_widget_set_margin_end(row, 8);
    gtk_box_append(GTK_BOX(bar->box), row);
    return row;
}

/* Enter takes what was typed, and so does leaving the entry; Escape does not. */
static void tc_bar_entry_left(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    tc_bar_show(user);
}

static GtkWidget *tc_bar_entry(tc_color_bar *bar, GtkWidget *row, const char *name, const char *tip, int chars,
                               GCallback typed)
{
    GtkWidget *entry = gtk_entry_new();
    gtk_editable_set_width_chars(GTK_EDITABLE(entry), chars);
    gtk_editable_set_max_width_chars(GTK_EDITABLE(entry), chars + 6);
    tc_plot_label(entry, name, tip);
    g_signal_connect(entry, "activate", typed, bar);
    GtkEventController *focus = gtk_event_controller_focus_new();
    g_signal_connect(focus, "leave", G_CALLBACK(tc_bar_entry_left), bar);
    gtk_widget_add_controller(entry, focus);
    gtk_box_append(GTK_BOX(row), entry);
    return entry;
}

static void tc_bar_button(tc_color_bar *bar, GtkWidget *row, const char *text, const char *tip, GCallback clicked)
{
    GtkWidget *button = gtk_button_new_with_label(text);
    tc_plot_label(button, tip, tip);
    g_signal_connect(button, "clicked", clicked, bar);
    gtk_box_append(GTK_BOX(row), button);
}

static GtkWidget *tc_bar_check(tc_color_bar *bar, GtkWidget *row, const char *text, const char *tip, GCallback toggled)
{
    GtkWidget *check = gtk_check_button_new_with_label(text);
    tc_plot_label(check, text, tip);
    g_signal_connect(check, "toggled", toggled, bar);
    gtk_box_append(GTK_BOX(row), check);
    return check;
}

static void tc_bar_range_build(tc_color_bar *bar)
{
    GtkWidget *row = tc_bar_row(bar);
    gtk_box_append(GTK_BOX(row), gtk_label_new("Range"));
    bar->range[0] = tc_bar_entry(bar, row, "Lower end of the range", "Lower end of the range; Enter takes it", 9,
                                 G_CALLBACK(tc_bar_range_typed));
    gtk_box_append(GTK_BOX(row), gtk_label_new("to"));
    bar->range[1] = tc_bar_entry(bar, row, "Upper end of the range", "Upper end of the range; Enter takes it", 9,
                                 G_CALLBACK(tc_bar_range_typed));
    bar->log = tc_bar_check(bar, row, "Log scale", "Colours and opacity lie over the logarithm of the scalar",
                            G_CALLBACK(tc_bar_log_toggled));
    row = tc_bar_row(bar);
    gtk_box_append(GTK_BOX(row), gtk_label_new("From"));
    tc_bar_button(bar, row, "Data", "Range of all data", G_CALLBACK(tc_bar_from_data));
    tc_bar_button(bar, row, "Visible", "Range of the data in the picture", G_CALLBACK(tc_bar_from_visible));
    tc_bar_button(bar, row, "Percentile", "Range without this percentage of the data at either end",
                  G_CALLBACK(tc_bar_from_percentile));
    bar->percent = gtk_spin_button_new_with_range(0, 49, 0.5);
    gtk_spin_button_set_digits(GTK_SPIN_BUTTON(bar->percent), 1);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(bar->percent), 1);
    tc_plot_label(bar->percent, "Percentage of the data left out at either end", NULL);
    gtk_box_append(GTK_BOX(row), bar->percent);
    gtk_box_append(GTK_BOX(row), gtk_label_new("%"));
}

static void tc_bar_colors_build(tc_color_bar *bar)
{
    static const char *const space[TC_EDIT_SPACES + 1] = {
        [TC_EDIT_RGB] = "RGB",
        [TC_EDIT_HSV] = "HSV",
        [TC_EDIT_LAB] = "Lab",
        [TC_EDIT_DIVERGING] = "Diverging",
        [TC_EDIT_CIEDE2000] = "Lab/CIEDE2000",
        [TC_EDIT_STEP] = "Step",
    };
    GtkWidget *row = tc_bar_row(bar);
    gtk_box_append(GTK_BOX(row), gtk_label_new("Space"));
    bar->space = gtk_drop_down_new_from_strings(space);
    tc_plot_label(bar->space, "Colour space of interpolation", "Colour space in which colours are interpolated");
    g_signal_connect(bar->space, "notify::selected", G_CALLBACK(tc_bar_space_chosen), bar);
    gtk_box_append(GTK_BOX(row), bar->space);
    bar->nan = tc_bar_check(bar, row, "Missing values", "Cells with missing values are shown, in this colour",
                            G_CALLBACK(tc_bar_nan_toggled));
    bar->nan_color = gtk_color_button_new();
    gtk_color_chooser_set_use_alpha(GTK_COLOR_CHOOSER(bar->nan_color), false);
    tc_plot_label(bar->nan_color, "Colour of missing values", NULL);
    g_signal_connect(bar->nan_color, "color-set", G_CALLBACK(tc_bar_nan_chosen), bar);
    gtk_box_append(GTK_BOX(row), bar->nan_color);
    bar->nan_opacity =
        tc_bar_entry(bar, row, "Opacity of missing values",
                     "Opacity of missing values, per unit distance; Enter takes it", 4, G_CALLBACK(tc_bar_nan_typed));
}

static void tc_bar_distance_build(tc_color_bar *bar)
{
    GtkWidget *row = tc_bar_row(bar);
    gtk_box_append(GTK_BOX(row), gtk_label_new("Unit distance"));
    bar->distance = gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, -TC_BAR_DECADES, TC_BAR_DECADES, 0.05);
    gtk_scale_set_draw_value(GTK_SCALE(bar->distance), false);
    gtk_scale_add_mark(GTK_SCALE(bar->distance), 0, GTK_POS_BOTTOM, NULL);
    gtk_range_set_round_digits(GTK_RANGE(bar->distance), 3);
    gtk_widget_set_hexpand(bar->distance, true);
    tc_plot_label(bar->distance, "Unit distance, logarithmic", "The length over which opacity acts; logarithmic");
    g_signal_connect(bar->distance, "value-changed", G_CALLBACK(tc_bar_distance_moved), bar);
    GtkEventController *legacy = gtk_event_controller_legacy_new();
    gtk_event_controller_set_propagation_phase(legacy, GTK_PHASE_CAPTURE);
    g_signal_connect(legacy, "event", G_CALLBACK(tc_bar_distance_event), bar);
    gtk_widget_add_controller(bar->distance, legacy);
    gtk_box_append(GTK_BOX(row), bar->distance);
    bar->distance_entry = tc_bar_entry(bar, row, "Unit distance", "Unit distance, in the data's unit; Enter takes it",
                                       7, G_CALLBACK(tc_bar_distance_typed));
    bar->distance_default = gtk_button_new_with_label("Default");
    tc_plot_label(bar->distance_default, "Unit distance of the mesh", "The mesh's own: diagonal / cube root of cells");
    g_signal_connect(bar->distance_default, "clicked", G_CALLBACK(tc_bar_distance_reset), bar);
    gtk_box_append(GTK_BOX(row), bar->distance_default);
}

static void tc_bar_heard(void *user, unsigned changes)
{
    if (changes & (TC_CHANGE_FUNCTION | TC_CHANGE_DATA))
        tc_bar_show(user);
}

static void tc_bar_gone(GtkWidget *box, gpointer user)
{
    (void)box;
    tc_color_bar *bar = user;
    tc_plot_unlisten(bar->session, bar);
}

GtkWidget *tc_color_bar_new(tc_session *session)
{
    tc_color_bar *bar = g_new0(tc_color_bar, 1);
    bar->session = session;
    bar->box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 6);
    gtk_box_append(GTK_BOX(bar->box), tc_color_strip_new(session));
    gtk_box_append(GTK_BOX(bar->box), tc_range_bar_new(session));
    bar->showing = true; /* until all controls are there */
    tc_bar_range_build(bar);
    tc_bar_colors_build(bar);
    tc_bar_distance_build(bar);
    g_object_set_data_full(G_OBJECT(bar->box), TC_BAR_DATA, bar, g_free);
    g_signal_connect(bar->box, "destroy", G_CALLBACK(tc_bar_gone), bar);
    tc_bar_show(bar);
    tc_session_listen(session, tc_bar_heard, bar);
    return bar->box;
}
