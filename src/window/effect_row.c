/* effect_row.c: one option of a picture as a line of the panel. */
#include "window/effect_row.h"

#include <math.h>
#include <string.h>

/* ---------------------------------------------------------------------------------------------------------- frame */

static void tc_row_free(gpointer data)
{
    tc_effect_row *row = data;
    if (row->later)
        g_source_remove(row->later);
    g_free(row->own);
    g_free(row);
}

/* What --help says, as a tip. */
static char *tc_row_tip(const tc_option *option)
{
    return g_strdup_printf("%s\n(%s%s%s)", option->help, option->name, option->value ? " " : "",
                           option->value ? option->value : "");
}

tc_effect_row *tc_effect_row_frame(tc_effect_hub *hub, const tc_control *control)
{
    tc_effect_row *row = g_new0(tc_effect_row, 1);
    *row = (tc_effect_row){.hub = hub,
                           .control = *control,
                           .box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 2),
                           .line = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 8),
                           .label = gtk_label_new(control->title),
                           .wrong = gtk_label_new(NULL)};
    char *tip = tc_row_tip(control->option);
    gtk_widget_set_tooltip_text(row->line, tip);
    g_free(tip);
    gtk_label_set_xalign(GTK_LABEL(row->label), 0);
    gtk_widget_set_size_request(row->label, 126, -1);
    gtk_label_set_xalign(GTK_LABEL(row->wrong), 0);
    gtk_label_set_wrap(GTK_LABEL(row->wrong), TRUE);
    gtk_label_set_max_width_chars(GTK_LABEL(row->wrong), 40);
    gtk_widget_add_css_class(row->wrong, "error");
    gtk_widget_set_visible(row->wrong, FALSE);
    gtk_box_append(GTK_BOX(row->line), row->label);
    gtk_box_append(GTK_BOX(row->box), row->line);
    gtk_box_append(GTK_BOX(row->box), row->wrong);
    g_object_set_data_full(G_OBJECT(row->box), "tc-row", row, tc_row_free);
    return row;
}

void tc_effect_row_put(tc_effect_row *row, GtkWidget *widget, bool below)
{
    if (below)
        gtk_box_insert_child_after(GTK_BOX(row->box), widget, row->line);
    else
        gtk_box_append(GTK_BOX(row->line), widget);
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, row->control.title,
                                   GTK_ACCESSIBLE_PROPERTY_DESCRIPTION, row->control.option->help, -1);
}

bool tc_effect_row_set(tc_effect_row *row, const char *option, const char *text)
{
    row->failed = !tc_effect_set(row->hub, option, text);
    gtk_label_set_text(GTK_LABEL(row->wrong), row->failed ? row->hub->session->said : "");
    gtk_widget_set_visible(row->wrong, row->failed);
    return !row->failed;
}

static gboolean tc_row_apply(gpointer user)
{
    tc_effect_row *row = user;
    row->later = 0;
    row->apply(row);
    return G_SOURCE_REMOVE;
}

void tc_effect_row_later(tc_effect_row *row)
{
    if (!row->filling && !row->later)
        row->later = g_idle_add(tc_row_apply, row);
}

void tc_effect_row_fill(tc_effect_row *row)
{
    gtk_widget_set_sensitive(row->line, tc_effect_can(row->hub, row->control.option->name));
    if (row->failed || row->later) /* the user's is shown until it can be, or is changed */
        return;
    row->filling = true;
    row->fill(row);
    row->filling = false;
}

/* --------------------------------------------------------------------------------------------------------- values */

char *tc_effect_number_text(double value)
{
    char number[G_ASCII_DTOSTR_BUF_SIZE];
    return g_strdup(g_ascii_formatd(number, sizeof number, "%.9g", value));
}

bool tc_effect_color_read(GdkRGBA *out, const char *text)
{
    double value[4] = {0, 0, 0, 1};
    int n = 0;
    if (!text || !tc_parse_reals(value, &n, 4, text) || n < 3)
        return false;
    *out = (GdkRGBA){(float)value[0], (float)value[1], (float)value[2], (float)value[3]};
    return true;
}

char *tc_effect_color_text(const GdkRGBA *color)
{
    const double value[3] = {(double)color->red, (double)color->green, (double)color->blue};
    char *part[4] = {NULL};
    for (int i = 0; i < 3; i++) {
        char number[G_ASCII_DTOSTR_BUF_SIZE];
        part[i] = g_strdup(g_ascii_formatd(number, sizeof number, "%.4g", value[i]));
    }
    char *text = g_strjoinv(",", part);
    for (int i = 0; i < 3; i++)
        g_free(part[i]);
    return text;
}

GtkWidget *tc_effect_slider(GtkAdjustment *adjustment, const char *name)
{
    GtkWidget *scale = gtk_scale_new(GTK_ORIENTATION_HORIZONTAL, adjustment);
    gtk_scale_set_draw_value(GTK_SCALE(scale), FALSE);
    gtk_widget_set_hexpand(scale, TRUE);
    gtk_widget_set_size_request(scale, 90, -1);
    gtk_accessible_update_property(GTK_ACCESSIBLE(scale), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
    return scale;
}

/* ------------------------------------------------------------------------------------------------ choices, flags */

static void tc_choice_apply(tc_effect_row *row)
{
    const guint at = gtk_drop_down_get_selected(GTK_DROP_DOWN(row->widget));
    if (at != GTK_INVALID_LIST_POSITION)
        tc_effect_row_set(row, row->control.option->name, at ? row->control.option->choice[at].name : NULL);
}

static void tc_choice_fill(tc_effect_row *row)
{
    char *text = tc_effect_text(row->hub->session, row->control.option->name);
    guint at = 0;
    for (guint i = 0; text && row->control.option->choice[i].name; i++)
        if (!strcmp(row->control.option->choice[i].name, text))
            at = i;
    gtk_drop_down_set_selected(GTK_DROP_DOWN(row->widget), at);
    g_free(text);
}

static void tc_row_changed(GObject *widget, GParamSpec *spec, gpointer user)
{
    (void)widget;
    (void)spec;
    tc_effect_row_later(user);
}

static void tc_choice_make(tc_effect_row *row)
{
    GtkStringList *list = gtk_string_list_new(NULL);
    for (const tc_choice *choice = row->control.option->choice; choice->name && !choice->later; choice++)
        gtk_string_list_append(list, choice->name);
    row->widget = gtk_drop_down_new(G_LIST_MODEL(list), NULL);
    gtk_widget_set_hexpand(row->widget, TRUE);
    g_signal_connect(row->widget, "notify::selected", G_CALLBACK(tc_row_changed), row);
    row->apply = tc_choice_apply;
    row->fill = tc_choice_fill;
}

static void tc_flag_apply(tc_effect_row *row)
{
    const bool on = gtk_switch_get_active(GTK_SWITCH(row->widget));
    tc_effect_row_set(row, row->control.option->name, on ? "on" : NULL);
}

static void tc_flag_fill(tc_effect_row *row)
{
    char *text = tc_effect_text(row->hub->session, row->control.option->name);
    gtk_switch_set_active(GTK_SWITCH(row->widget), text && strcmp(text, "off") != 0);
    g_free(text);
}

static GtkWidget *tc_switch_new(tc_effect_row *row)
{
    GtkWidget *on = gtk_switch_new();
    gtk_widget_set_valign(on, GTK_ALIGN_CENTER);
    g_signal_connect(on, "notify::active", G_CALLBACK(tc_row_changed), row);
    return on;
}

static void tc_flag_make(tc_effect_row *row)
{
    row->widget = tc_switch_new(row);
    row->apply = tc_flag_apply;
    row->fill = tc_flag_fill;
}

/* -------------------------------------------------------------------------------------------------------- numbers */

static double tc_slider_value(const tc_effect_row *row)
{
    const double at = gtk_range_get_value(GTK_RANGE(row->widget));
    return row->control.log ? exp(at) : at;
}

static bool tc_is_on(const tc_effect_row *row)
{
    return !row->second || gtk_switch_get_active(GTK_SWITCH(row->second));
}

static void tc_slider_apply(tc_effect_row *row)
{
    char *text = tc_is_on(row) ? tc_effect_number_text(tc_slider_value(row)) : NULL;
    char *base = tc_effect_number_text(row->control.value);
    const bool is_default = text && !row->second && !strcmp(text, base);
    tc_effect_row_set(row, row->control.option->name, is_default ? NULL : text);
    if (row->second)
        gtk_widget_set_sensitive(row->widget, tc_is_on(row));
    g_free(text);
    g_free(base);
}

static void tc_slider_fill(tc_effect_row *row)
{
    char *text = tc_effect_text(row->hub->session, row->control.option->name);
    double value = row->control.value;
    const bool given = text && strcmp(text, "off") != 0 && tc_parse_real(&value, text);
    if (row->second) {
        gtk_switch_set_active(GTK_SWITCH(row->second), given);
        gtk_widget_set_sensitive(row->widget, given);
    }
    if (given || !row->second) /* off: where it was */
        gtk_range_set_value(GTK_RANGE(row->widget), row->control.log ? log(fmax(value, row->control.low)) : value);
    g_free(text);
}

static void tc_slider_moved(GtkRange *range, gpointer user)
{
    (void)range;
    tc_effect_row *row = user;
    if (row->filling)
        return;
    tc_effect_moves(row->hub);
    tc_effect_row_later(row);
}

static char *tc_slider_format(GtkScale *scale, double value, gpointer user)
{
    (void)scale;
    const tc_effect_row *row = user;
    return g_strdup_printf("%.3g", row->control.log ? exp(value) : value);
}

static void tc_slider_make(tc_effect_row *row)
{
    const tc_control *c = &row->control;
    const double low = c->log ? log(c->low) : c->low, high = c->log ? log(c->high) : c->high;
    const double at = c->log ? log(fmax(c->value, c->low)) : c->value;
    row->widget =
        tc_effect_slider(gtk_adjustment_new(at, low, high, (high - low) / 100, (high - low) / 10, 0), c->title);
    gtk_scale_set_draw_value(GTK_SCALE(row->widget), TRUE);
    gtk_scale_set_value_pos(GTK_SCALE(row->widget), GTK_POS_RIGHT);
    gtk_range_set_round_digits(GTK_RANGE(row->widget), -1);
    gtk_scale_set_format_value_func(GTK_SCALE(row->widget), tc_slider_format, row, NULL);
    g_signal_connect(row->widget, "value-changed", G_CALLBACK(tc_slider_moved), row);
    if (c->kind == TC_CONTROL_SWITCHED)
        row->second = tc_switch_new(row);
    row->apply = tc_slider_apply;
    row->fill = tc_slider_fill;
}

/* ----------------------------------------------------------------------------------------------------------- text */

/* Values of an option that may be given again stand behind semicolons in one entry. */
static void tc_text_apply(tc_effect_row *row)
{
    const char *text = gtk_editable_get_text(GTK_EDITABLE(row->widget));
    tc_effect_row_set(row, row->control.option->name, *text ? text : NULL);
}

static void tc_text_fill(tc_effect_row *row)
{
    char *text = tc_effect_text(row->hub->session, row->control.option->name);
    gtk_editable_set_text(GTK_EDITABLE(row->widget), text ? g_strdelimit(text, "\n", ';') : "");
    g_free(text);
}

static void tc_text_entered(GtkEntry *entry, gpointer user)
{
    (void)entry;
    tc_effect_row *row = user;
    tc_text_apply(row);
}

/* What was typed holds also when the keyboard goes elsewhere. */
static void tc_text_left(GtkEventControllerFocus *focus, gpointer user)
{
    (void)focus;
    tc_effect_row *row = user;
    char *text = tc_effect_text(row->hub->session, row->control.option->name);
    const char *typed = gtk_editable_get_text(GTK_EDITABLE(row->widget));
    if (strcmp(typed, text ? g_strdelimit(text, "\n", ';') : "") != 0)
        tc_text_apply(row);
    g_free(text);
}

static void tc_text_make(tc_effect_row *row)
{
    row->widget = gtk_entry_new();
    gtk_widget_set_hexpand(row->widget, TRUE);
    gtk_editable_set_width_chars(GTK_EDITABLE(row->widget), 8);
    gtk_entry_set_placeholder_text(GTK_ENTRY(row->widget), row->control.option->value);
    g_signal_connect(row->widget, "activate", G_CALLBACK(tc_text_entered), row);
    GtkEventController *focus = gtk_event_controller_focus_new();
    g_signal_connect(focus, "leave", G_CALLBACK(tc_text_left), row);
    gtk_widget_add_controller(row->widget, focus);
    row->apply = tc_text_apply;
    row->fill = tc_text_fill;
}

/* --------------------------------------------------------------------------------------------------------- colour */

static void tc_color_apply(tc_effect_row *row)
{
    GdkRGBA color;
    gtk_color_chooser_get_rgba(GTK_COLOR_CHOOSER(row->widget), &color);
    char *text = gtk_switch_get_active(GTK_SWITCH(row->second)) ? tc_effect_color_text(&color) : NULL;
    tc_effect_row_set(row, row->control.option->name, text);
    gtk_widget_set_sensitive(row->widget, text != NULL);
    g_free(text);
}

static void tc_color_fill(tc_effect_row *row)
{
    char *text = tc_effect_text(row->hub->session, row->control.option->name);
    GdkRGBA color;
    const bool given = tc_effect_color_read(&color, text);
    gtk_switch_set_active(GTK_SWITCH(row->second), given);
    gtk_widget_set_sensitive(row->widget, given);
    if (given)
        gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(row->widget), &color);
    g_free(text);
}

static void tc_color_make(tc_effect_row *row)
{
    const GdkRGBA white = {1, 1, 1, 1};
    row->widget = gtk_color_button_new_with_rgba(&white);
    gtk_color_button_set_modal(GTK_COLOR_BUTTON(row->widget), TRUE);
    gtk_widget_set_hexpand(row->widget, TRUE);
    row->second = tc_switch_new(row);
    g_signal_connect(row->widget, "notify::rgba", G_CALLBACK(tc_row_changed), row);
    row->apply = tc_color_apply;
    row->fill = tc_color_fill;
}

/* --------------------------------------------------------------------------------------------------------- arrays */

static void tc_array_apply(tc_effect_row *row)
{
    GtkStringObject *item = gtk_drop_down_get_selected_item(GTK_DROP_DOWN(row->widget));
    const bool none = gtk_drop_down_get_selected(GTK_DROP_DOWN(row->widget)) == 0;
    if (item)
        tc_effect_row_set(row, row->control.option->name, none ? NULL : gtk_string_object_get_string(item));
}

static void tc_array_fill(tc_effect_row *row)
{
    const tc_source *source = row->hub->session->run.mesh ? tc_mesh_source(row->hub->session->run.mesh) : NULL;
    char *text = tc_effect_text(row->hub->session, row->control.option->name);
    GtkStringList *list = gtk_string_list_new(NULL);
    guint at = 0;
    gtk_string_list_append(list, "none");
    for (size_t i = 0; source && i < source->n_array; i++) {
        gtk_string_list_append(list, source->array[i].name);
        if (text && !strcmp(text, source->array[i].name))
            at = g_list_model_get_n_items(G_LIST_MODEL(list)) - 1;
    }
    if (text && at == 0) { /* with a component */
        gtk_string_list_append(list, text);
        at = g_list_model_get_n_items(G_LIST_MODEL(list)) - 1;
    }
    gtk_drop_down_set_model(GTK_DROP_DOWN(row->widget), G_LIST_MODEL(list));
    gtk_drop_down_set_selected(GTK_DROP_DOWN(row->widget), at);
    g_object_unref(list);
    g_free(text);
}

static void tc_array_make(tc_effect_row *row)
{
    row->widget = gtk_drop_down_new(NULL, NULL);
    gtk_widget_set_hexpand(row->widget, TRUE);
    g_signal_connect(row->widget, "notify::selected", G_CALLBACK(tc_row_changed), row);
    row->apply = tc_array_apply;
    row->fill = tc_array_fill;
}

/* ---------------------------------------------------------------------------------------------------------- files */

static void tc_files_fill(tc_effect_row *row)
{
    char *text = tc_effect_text(row->hub->session, row->control.option->name);
    int n = 0;
    for (const char *at = text; at && *at; at = strchr(at, '\n') ? strchr(at, '\n') + 1 : NULL)
        n++;
    char *label = n == 1 ? g_path_get_basename(text) : g_strdup_printf("%d files", n);
    gtk_label_set_text(GTK_LABEL(row->widget), n ? label : "none");
    gtk_widget_set_tooltip_text(row->widget, text);
    gtk_widget_set_sensitive(row->second, n > 0);
    g_free(label);
    g_free(text);
}

static void tc_files_none(GtkButton *button, gpointer user)
{
    (void)button;
    tc_effect_row *row = user;
    tc_effect_row_set(row, row->control.option->name, NULL);
}

static void tc_files_chosen(GtkNativeDialog *dialog, int response, gpointer user)
{
    tc_effect_row *row = user;
    GFile *file = response == GTK_RESPONSE_ACCEPT ? gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog)) : NULL;
    char *path = file ? g_file_get_path(file) : NULL;
    if (path) {
        char *before = tc_effect_text(row->hub->session, row->control.option->name);
        char *all = before ? g_strdup_printf("%s\n%s", before, path) : g_strdup(path);
        tc_effect_row_set(row, row->control.option->name, all);
        g_free(all);
        g_free(before);
    }
    g_free(path);
    g_clear_object(&file);
    g_object_unref(dialog);
}

static void tc_files_add(GtkButton *button, gpointer user)
{
    (void)button;
    tc_effect_row *row = user;
    GtkFileChooserNative *dialog = gtk_file_chooser_native_new(
        "Add geometry", GTK_WINDOW(gtk_widget_get_root(row->box)), GTK_FILE_CHOOSER_ACTION_OPEN, "_Add", "_Cancel");
    g_signal_connect(dialog, "response", G_CALLBACK(tc_files_chosen), row);
    g_object_set_data_full(G_OBJECT(dialog), "row", g_object_ref(row->box), g_object_unref);
    gtk_native_dialog_set_modal(GTK_NATIVE_DIALOG(dialog), TRUE);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

static void tc_files_make(tc_effect_row *row)
{
    GtkWidget *add = gtk_button_new_with_label("Add…");
    row->widget = gtk_label_new("none");
    row->second = gtk_button_new_with_label("Remove all");
    gtk_widget_set_hexpand(row->widget, TRUE);
    gtk_label_set_xalign(GTK_LABEL(row->widget), 0);
    gtk_label_set_ellipsize(GTK_LABEL(row->widget), PANGO_ELLIPSIZE_MIDDLE);
    g_signal_connect(add, "clicked", G_CALLBACK(tc_files_add), row);
    g_signal_connect(row->second, "clicked", G_CALLBACK(tc_files_none), row);
    tc_effect_row_put(row, add, false);
    row->fill = tc_files_fill;
}

/* ---------------------------------------------------------------------------------------------------------- whole */

tc_effect_row *tc_effect_row_new(tc_effect_hub *hub, const tc_option *option)
{
    static void (*const make[])(tc_effect_row *) = {
        [TC_CONTROL_CHOICE] = tc_choice_make, [TC_CONTROL_FLAG] = tc_flag_make,
        [TC_CONTROL_SLIDER] = tc_slider_make, [TC_CONTROL_SWITCHED] = tc_slider_make,
        [TC_CONTROL_TEXT] = tc_text_make,     [TC_CONTROL_COLOR] = tc_color_make,
        [TC_CONTROL_ARRAY] = tc_array_make,   [TC_CONTROL_FILES] = tc_files_make,
    };
    tc_control control;
    tc_control_make(&control, option);
    if (control.kind == TC_CONTROL_NONE)
        return NULL;
    if (control.kind == TC_CONTROL_SURFACES)
        return tc_effect_surfaces_new(hub, &control);
    if (control.kind == TC_CONTROL_BOX)
        return tc_effect_box_new(hub, &control);
    tc_effect_row *row = tc_effect_row_frame(hub, &control);
    make[control.kind](row);
    tc_effect_row_put(row, row->widget, false);
    if (row->second) {
        gtk_accessible_update_property(GTK_ACCESSIBLE(row->second), GTK_ACCESSIBLE_PROPERTY_LABEL, control.title, -1);
        gtk_box_append(GTK_BOX(row->line), row->second);
    }
    return row;
}
