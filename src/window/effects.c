/* effects.c: the panel of what a picture shows beside the function. */
#include "window/effects.h"

#include "window/effect_data.h"
#include "window/effect_row.h"
#include "window/plot.h"

#include <string.h>

#define TC_EFFECTS_KEY "tc-effects"

typedef struct tc_effects {
    tc_effect_hub hub;
    GtkWidget *data;
    GPtrArray *row; /* of tc_effect_row */
} tc_effects;

/* Options of the picture that the table of looks has not. */
static const char *const tc_picture_options[] = {"--background", "--samples", "--integrator", "--opacity-stop",
                                                 "--size"};

static void tc_effects_fill(tc_effects *panel)
{
    for (guint i = 0; i < panel->row->len; i++)
        tc_effect_row_fill(g_ptr_array_index(panel->row, i));
}

static void tc_effects_heard(void *user, unsigned changes)
{
    tc_effects *panel = user;
    if (changes & (TC_CHANGE_DATA | TC_CHANGE_BUSY))
        tc_effect_data_fill(panel->data);
    if (changes & (TC_CHANGE_DATA | TC_CHANGE_LOOK))
        tc_effects_fill(panel);
    else if (changes & TC_CHANGE_FUNCTION) /* surfaces have the map's colours */
        for (guint i = 0; i < panel->row->len; i++) {
            tc_effect_row *row = g_ptr_array_index(panel->row, i);
            if (row->control.kind == TC_CONTROL_SURFACES)
                tc_effect_row_fill(row);
        }
}

/* A part of the panel that folds. */
static GtkWidget *tc_section(GtkWidget *box, const char *title, bool open)
{
    GtkWidget *expander = gtk_expander_new(title), *rows = gtk_box_new(GTK_ORIENTATION_VERTICAL, 4);
    gtk_widget_set_margin_start(rows, 12);
    gtk_widget_set_margin_top(rows, 4);
    gtk_widget_set_margin_bottom(rows, 8);
    gtk_expander_set_expanded(GTK_EXPANDER(expander), open);
    gtk_expander_set_child(GTK_EXPANDER(expander), rows);
    gtk_box_append(GTK_BOX(box), expander);
    return rows;
}

static void tc_effects_row(tc_effects *panel, GtkWidget *section, const tc_option *option)
{
    tc_effect_row *row = tc_effect_row_new(&panel->hub, option);
    if (!row)
        return;
    gtk_box_append(GTK_BOX(section), row->box);
    g_ptr_array_add(panel->row, row);
}

/* The wheel scrolls the panel, and turns no slider that comes under it. */
static gboolean tc_effects_wheel(GtkEventControllerScroll *wheel, double dx, double dy, gpointer user)
{
    enum { NOTCH = 48 }; /* pixels */
    (void)dx;
    GtkAdjustment *at = gtk_scrolled_window_get_vadjustment(user);
    const bool notches = gtk_event_controller_scroll_get_unit(wheel) == GDK_SCROLL_UNIT_WHEEL;
    gtk_adjustment_set_value(at, gtk_adjustment_get_value(at) + dy * (notches ? NOTCH : 1));
    return TRUE;
}

static void tc_effects_destroyed(GtkWidget *widget, gpointer user)
{
    (void)widget;
    tc_effects *panel = user;
    tc_plot_unlisten(panel->hub.session, panel);
    if (panel->hub.resting) /* nothing is held any more */
        g_source_remove(panel->hub.resting);
    panel->hub.resting = 0;
}

static void tc_effects_free(gpointer data)
{
    tc_effects *panel = data;
    g_ptr_array_unref(panel->row);
    tc_effect_hub_finish(&panel->hub);
    g_free(panel);
}

GtkWidget *tc_effects_new(tc_session *session)
{
    tc_effects *panel = g_new0(tc_effects, 1);
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 4), *section = NULL;
    tc_effect_hub_init(&panel->hub, session);
    panel->row = g_ptr_array_new();
    g_object_set_data_full(G_OBJECT(box), TC_EFFECTS_KEY, panel, tc_effects_free);
    panel->data = tc_effect_data_new(session);
    gtk_box_append(GTK_BOX(box), panel->data);
    for (size_t i = 0; i < TC_N_LOOK_OPTION; i++) {
        const bool figure = !strcmp(tc_look_option[i].help, "Figure");
        if (!tc_look_option[i].name)
            section =
                tc_section(box, figure ? "Figure (over pictures that are saved)" : tc_look_option[i].help, i == 0);
        else
            tc_effects_row(panel, section, &tc_look_option[i]);
    }
    section = tc_section(box, "Picture", false);
    for (size_t k = 0; k < sizeof tc_picture_options / sizeof *tc_picture_options; k++)
        for (size_t i = 0; i < TC_N_RENDER_OPTION; i++)
            if (tc_render_option[i].name && !strcmp(tc_render_option[i].name, tc_picture_options[k]))
                tc_effects_row(panel, section, &tc_render_option[i]);
    gtk_widget_set_margin_start(box, 6);
    gtk_widget_set_margin_end(box, 12);
    tc_effects_fill(panel);
    tc_session_listen(session, tc_effects_heard, panel);
    g_signal_connect(box, "destroy", G_CALLBACK(tc_effects_destroyed), panel);

    GtkWidget *scroll = gtk_scrolled_window_new();
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scroll), GTK_POLICY_NEVER, GTK_POLICY_AUTOMATIC);
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scroll), box);
    gtk_widget_set_vexpand(scroll, TRUE);
    GtkEventController *wheel = gtk_event_controller_scroll_new(GTK_EVENT_CONTROLLER_SCROLL_VERTICAL);
    gtk_event_controller_set_propagation_phase(wheel, GTK_PHASE_CAPTURE);
    g_signal_connect(wheel, "scroll", G_CALLBACK(tc_effects_wheel), scroll);
    gtk_widget_add_controller(scroll, wheel);
    return scroll;
}
