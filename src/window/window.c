/* window.c: what lies where in the window, and its status line. */
#include "window/window.h"
#include "window/color_bar.h"
#include "window/curve.h"
#include "window/effects.h"
#include "window/files.h"
#include "window/plot.h"
#include "window/presets.h"
#include "window/pulse.h"
#include "window/view.h"

#include <math.h>
#include <stdio.h>

typedef struct window {
    GtkWindow *window;
    tc_session *session;
    GtkWidget *content, *view, *curve, *progress, *said, *speed, *error;
} window;

static window *window_of(GtkWindow *widget)
{
    return g_object_get_data(G_OBJECT(widget), "tc-window");
}

/* ----------------------------------------------------------------------------------------------------------- status */

/* The next number above of one digit. */
static double rounded_up(double value)
{
    const double digit = value > 0 ? pow(10, floor(log10(value))) : 1;
    return ceil(value / digit * (1 - 1e-12)) * digit;
}

static void picture_changed(void *user, const tc_shown *shown)
{
    window *w = user;
    char text[128];
    if (shown->last && !shown->over.texture)
        snprintf(text, sizeof text, "%.0f ms", shown->ms);
    else
        snprintf(text, sizeof text, "%.0f ms at 1/%d", shown->ms, shown->divide);
    gtk_label_set_text(GTK_LABEL(w->speed), text);
    if (shown->last && shown->checked && isfinite(shown->error))
        snprintf(text, sizeof text, "error ≤ %.1g (99 %% of pixels)", rounded_up(shown->error));
    else if (shown->last && shown->checked)
        snprintf(text, sizeof text, "not checked");
    else if (shown->last)
        snprintf(text, sizeof text, "checking …");
    else
        *text = 0;
    gtk_label_set_text(GTK_LABEL(w->error), text);
}

static void title_make(window *w)
{
    const tc_session *s = w->session;
    char text[512];
    const char *input = s->options.input, *slash = strrchr(input, '/');
    const char *field = s->run.mesh ? tc_run_field(&s->run) : "";
    snprintf(text, sizeof text, "%s%s%s", slash ? slash + 1 : input, *field ? " · " : "", field);
    gtk_window_set_title(w->window, text);
}

static void heard(void *user, unsigned changes)
{
    window *w = user;
    const tc_session *s = w->session;
    if (changes & (TC_CHANGE_SAID | TC_CHANGE_BUSY)) {
        gtk_label_set_text(GTK_LABEL(w->said), s->busy ? s->progress.what : s->said);
        gtk_widget_set_tooltip_text(w->said, s->busy ? NULL : s->said);
    }
    if (changes & TC_CHANGE_BUSY) {
        gtk_widget_set_visible(w->progress, s->busy);
        if (s->busy && s->progress.fraction >= 0)
            gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(w->progress), fmin(s->progress.fraction, 1));
        else if (s->busy)
            gtk_progress_bar_pulse(GTK_PROGRESS_BAR(w->progress));
    }
    if (changes & TC_CHANGE_DATA)
        title_make(w);
    if (changes & TC_CHANGE_HISTORY) {
        GActionMap *map = G_ACTION_MAP(w->window);
        g_simple_action_set_enabled(G_SIMPLE_ACTION(g_action_map_lookup_action(map, "undo")),
                                    tc_history_undo_what(s->history) != NULL);
        g_simple_action_set_enabled(G_SIMPLE_ACTION(g_action_map_lookup_action(map, "redo")),
                                    tc_history_redo_what(s->history) != NULL);
    }
}

/* ---------------------------------------------------------------------------------------------------------- actions */

static void undo(GSimpleAction *action, GVariant *parameter, gpointer user)
{
    (void)action;
    (void)parameter;
    tc_session_undo(((window *)user)->session);
}

static void redo(GSimpleAction *action, GVariant *parameter, gpointer user)
{
    (void)action;
    (void)parameter;
    tc_session_redo(((window *)user)->session);
}

static void actions_add(window *w, GtkApplication *application)
{
    static const GActionEntry entry[] = {{.name = "undo", .activate = undo}, {.name = "redo", .activate = redo}};
    static const char *const close_keys[] = {"<Control>w", "<Control>q", NULL};
    static const char *const undo_keys[] = {"<Control>z", NULL}, *const redo_keys[] = {"<Control><Shift>z",
                                                                                       "<Control>y", NULL};
    g_action_map_add_action_entries(G_ACTION_MAP(w->window), entry, G_N_ELEMENTS(entry), w);
    gtk_application_set_accels_for_action(application, "window.close", close_keys);
    gtk_application_set_accels_for_action(application, "win.undo", undo_keys);
    gtk_application_set_accels_for_action(application, "win.redo", redo_keys);
}

static GtkWidget *button_new(const char *icon, const char *what, const char *action)
{
    GtkWidget *button = gtk_button_new_from_icon_name(icon);
    gtk_actionable_set_action_name(GTK_ACTIONABLE(button), action);
    gtk_widget_set_tooltip_text(button, what);
    gtk_accessible_update_property(GTK_ACCESSIBLE(button), GTK_ACCESSIBLE_PROPERTY_LABEL, what, -1);
    return button;
}

/* ----------------------------------------------------------------------------------------------------------- layout */

static GtkWidget *status_new(window *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 18);
    w->said = gtk_label_new("");
    w->speed = gtk_label_new("");
    w->error = gtk_label_new("");
    gtk_label_set_ellipsize(GTK_LABEL(w->said), PANGO_ELLIPSIZE_END);
    gtk_label_set_xalign(GTK_LABEL(w->said), 0);
    gtk_widget_set_hexpand(w->said, TRUE);
    gtk_label_set_width_chars(GTK_LABEL(w->speed), 14);
    gtk_label_set_xalign(GTK_LABEL(w->speed), 1);
    gtk_widget_add_css_class(w->speed, "numeric");
    gtk_widget_add_css_class(w->error, "numeric");
    gtk_widget_set_tooltip_text(w->speed,
                                "Time that the last picture took; 1/n: at so much of its size, while something moves");
    gtk_widget_set_tooltip_text(w->error,
                                "Largest difference of a channel (0 to 1) from the double-precision reference");
    gtk_box_append(GTK_BOX(box), w->said);
    gtk_box_append(GTK_BOX(box), w->error);
    gtk_box_append(GTK_BOX(box), w->speed);
    gtk_widget_set_margin_start(box, 8);
    gtk_widget_set_margin_end(box, 8);
    gtk_widget_set_margin_top(box, 3);
    gtk_widget_set_margin_bottom(box, 3);
    return box;
}

static GtkWidget *picture_new(window *w)
{
    GtkWidget *overlay = gtk_overlay_new();
    w->view = tc_view_new(w->session);
    w->progress = gtk_progress_bar_new();
    gtk_widget_set_valign(w->progress, GTK_ALIGN_START);
    gtk_widget_set_visible(w->progress, FALSE);
    gtk_accessible_update_property(GTK_ACCESSIBLE(w->progress), GTK_ACCESSIBLE_PROPERTY_LABEL, "Reading data", -1);
    gtk_overlay_set_child(GTK_OVERLAY(overlay), w->view);
    gtk_overlay_add_overlay(GTK_OVERLAY(overlay), w->progress);
    tc_view_listen(w->view, picture_changed, w);
    return overlay;
}

/* The scalars that the ray under the pointer meets, on the curve's axis. */
static void probed(void *user, const tc_probe *probe)
{
    window *w = user;
    const size_t n = probe ? probe->n : 0;
    double *scalar = n ? g_new(double, 2 * n) : NULL, picked = NAN;
    size_t count = 0;
    for (size_t i = 0; i < n; i++) {
        const tc_probe_part *part = &probe->part[i];
        for (int k = 0; k < 2 && isfinite(part->scalar[0]); k++)
            scalar[count++] = part->scalar[k];
        if (probe->picked >= part->depth[0] && probe->picked <= part->depth[1]) {
            const double share = (probe->picked - part->depth[0]) / (part->depth[1] - part->depth[0]);
            picked = part->scalar[0] + share * (part->scalar[1] - part->scalar[0]);
        }
    }
    tc_curve_mark(w->curve, scalar, count, picked);
    g_free(scalar);
}

static GtkWidget *side_new(window *w)
{
    GtkWidget *paned = gtk_paned_new(GTK_ORIENTATION_VERTICAL);
    GtkWidget *above = gtk_box_new(GTK_ORIENTATION_VERTICAL, 4), *below = gtk_box_new(GTK_ORIENTATION_VERTICAL, 4);
    GtkWidget *stack = gtk_stack_new(), *switcher = gtk_stack_switcher_new();
    w->curve = tc_curve_new(w->session);
    gtk_widget_set_vexpand(w->curve, TRUE);
    gtk_box_append(GTK_BOX(above), w->curve);
    gtk_box_append(GTK_BOX(above), tc_color_bar_new(w->session));
    gtk_stack_add_titled(GTK_STACK(stack), tc_presets_new(w->session), "presets", "Colour maps");
    gtk_stack_add_titled(GTK_STACK(stack), tc_effects_new(w->session), "effects", "Effects and data");
    gtk_stack_switcher_set_stack(GTK_STACK_SWITCHER(switcher), GTK_STACK(stack));
    gtk_widget_set_vexpand(stack, TRUE);
    gtk_widget_set_halign(switcher, GTK_ALIGN_CENTER);
    gtk_widget_set_margin_top(switcher, 6);
    gtk_box_append(GTK_BOX(below), switcher);
    gtk_box_append(GTK_BOX(below), stack);
    gtk_paned_set_start_child(GTK_PANED(paned), above);
    gtk_paned_set_end_child(GTK_PANED(paned), below);
    gtk_paned_set_resize_start_child(GTK_PANED(paned), TRUE);
    gtk_paned_set_shrink_start_child(GTK_PANED(paned), FALSE);
    gtk_paned_set_shrink_end_child(GTK_PANED(paned), FALSE);
    gtk_widget_set_size_request(paned, 400, -1);
    gtk_widget_set_margin_start(paned, 12); /* the divider beside it takes what is pressed nearer to it */
    tc_view_listen_probe(w->view, probed, w);
    return paned;
}

static void gone(GtkWidget *widget, gpointer user)
{
    window *w = user;
    (void)widget;
    tc_plot_unlisten(w->session, w);
}

GtkWidget *tc_window_content(GtkWindow *widget)
{
    return window_of(widget)->content;
}

GtkWindow *tc_window_new(GtkApplication *application, tc_session *session)
{
    window *w = g_new0(window, 1);
    GtkWidget *widget = gtk_application_window_new(application), *header = gtk_header_bar_new();
    GtkWidget *paned = gtk_paned_new(GTK_ORIENTATION_HORIZONTAL), *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    w->window = GTK_WINDOW(widget);
    w->session = session;
    g_object_set_data_full(G_OBJECT(widget), "tc-window", w, g_free);
    gtk_window_set_default_size(w->window, 1260, 760);
    gtk_window_set_titlebar(w->window, header);
    gtk_header_bar_pack_start(GTK_HEADER_BAR(header), button_new("edit-undo-symbolic", "Undo", "win.undo"));
    gtk_header_bar_pack_start(GTK_HEADER_BAR(header), button_new("edit-redo-symbolic", "Redo", "win.redo"));
    actions_add(w, application);
    gtk_paned_set_start_child(GTK_PANED(paned), picture_new(w));
    gtk_paned_set_end_child(GTK_PANED(paned), side_new(w));
    gtk_paned_set_resize_start_child(GTK_PANED(paned), TRUE);
    gtk_paned_set_resize_end_child(GTK_PANED(paned), FALSE);
    gtk_paned_set_shrink_start_child(GTK_PANED(paned), FALSE);
    gtk_paned_set_shrink_end_child(GTK_PANED(paned), FALSE);
    gtk_widget_set_vexpand(paned, TRUE);
    gtk_box_append(GTK_BOX(box), paned);
    gtk_box_append(GTK_BOX(box), gtk_separator_new(GTK_ORIENTATION_HORIZONTAL));
    gtk_box_append(GTK_BOX(box), status_new(w));
    gtk_window_set_child(w->window, box);
    w->content = box;
    g_signal_connect(widget, "destroy", G_CALLBACK(gone), w);
    tc_session_listen(session, heard, w);
    title_make(w);
    heard(w, TC_CHANGE_HISTORY | TC_CHANGE_BUSY | TC_CHANGE_SAID);
    tc_files_attach(w->window, session);
    gtk_window_present(w->window);
    tc_pulse_attach(w->window, session->trace);
    return w->window;
}

const char *tc_window_refused(GtkWindow *widget)
{
    return tc_view_refused(window_of(widget)->view);
}
