/* effect_data.c: which array is shown, and at which time. */
#include "window/effect_data.h"

#include "window/loader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define TC_DATA_KEY "tc-effect-data"
enum { TC_COMPONENTS_MOST = 32 };

typedef struct tc_effect_data {
    tc_session *session;
    GtkWidget *field, *field_line, *time, *time_line, *time_label;
    GArray *choice;    /* of tc_field_choice, as the drop-down lists them */
    const tc_mesh *of; /* that they were listed of; only compared */
    guint later;       /* the source that will read the step */
    bool filling;
} tc_effect_data;

typedef struct tc_field_choice {
    char *field; /* as --field takes it */
    tc_association association;
} tc_field_choice;

static void tc_choice_clear(gpointer data)
{
    g_free(((tc_field_choice *)data)->field);
}

static void tc_field_add(tc_effect_data *data, GtkStringList *list, const tc_array_info *array, const char *component)
{
    const bool cells = array->association == TC_CELL_DATA;
    tc_field_choice choice = {.field =
                                  *component ? g_strdup_printf("%s:%s", array->name, component) : g_strdup(array->name),
                              .association = array->association};
    char *shown = g_strdup_printf("%s%s", choice.field, cells ? " (cells)" : "");
    gtk_string_list_append(list, shown);
    g_array_append_val(data->choice, choice);
    g_free(shown);
}

static void tc_fields_list(tc_effect_data *data, const tc_source *source)
{
    GtkStringList *list = gtk_string_list_new(NULL);
    g_array_set_size(data->choice, 0);
    for (size_t i = 0; source && i < source->n_array; i++) {
        const tc_array_info *array = &source->array[i];
        tc_field_add(data, list, array, array->components > 1 ? "magnitude" : "");
        for (int c = 0; array->components > 1 && c < array->components && c < TC_COMPONENTS_MOST; c++) {
            char component[16];
            snprintf(component, sizeof component, "%d", c);
            tc_field_add(data, list, array, component);
        }
    }
    gtk_drop_down_set_model(GTK_DROP_DOWN(data->field), G_LIST_MODEL(list));
    g_object_unref(list);
}

static void tc_time_say(tc_effect_data *data, const tc_source *source, int step)
{
    char text[80] = "";
    if (source && step >= 0 && (size_t)step < source->n_time)
        snprintf(text, sizeof text, "%d: %.6g", step, source->time[step]);
    gtk_label_set_text(GTK_LABEL(data->time_label), text);
    gtk_accessible_update_property(GTK_ACCESSIBLE(data->time), GTK_ACCESSIBLE_PROPERTY_VALUE_TEXT, text, -1);
}

void tc_effect_data_fill(GtkWidget *widget)
{
    tc_effect_data *data = g_object_get_data(G_OBJECT(widget), TC_DATA_KEY);
    tc_session *session = data->session;
    const tc_mesh *mesh = session->run.mesh;
    const tc_source *source = mesh ? tc_mesh_source(mesh) : NULL;
    const bool times = source && source->n_time > 1;
    data->filling = true;
    tc_fields_list(data, source);
    guint at = GTK_INVALID_LIST_POSITION;
    for (guint i = 0; source && source->field && i < data->choice->len; i++) {
        const tc_field_choice *choice = &g_array_index(data->choice, tc_field_choice, i);
        if (!strcmp(choice->field, source->field) && choice->association == session->run.report.association)
            at = i;
    }
    gtk_drop_down_set_selected(GTK_DROP_DOWN(data->field), at);
    gtk_widget_set_visible(data->field_line, data->choice->len > 0);
    gtk_widget_set_visible(data->time_line, times);
    if (times) {
        gtk_range_set_range(GTK_RANGE(data->time), 0, (double)source->n_time - 1);
        if (!data->later)
            gtk_range_set_value(GTK_RANGE(data->time), source->step);
        tc_time_say(data, source, source->step);
    }
    gtk_widget_set_sensitive(data->field_line, !session->busy);
    data->filling = false;
}

static void tc_field_chosen(GObject *drop_down, GParamSpec *spec, gpointer user)
{
    (void)spec;
    tc_effect_data *data = user;
    const guint at = gtk_drop_down_get_selected(GTK_DROP_DOWN(drop_down));
    if (data->filling || at >= data->choice->len)
        return;
    const tc_field_choice *choice = &g_array_index(data->choice, tc_field_choice, at);
    tc_loader_field(data->session, choice->field, choice->association);
}

/* One step is read at a time: the slider's place when that is done is the next. */
static gboolean tc_step_read(gpointer user)
{
    tc_effect_data *data = user;
    tc_session *session = data->session;
    const tc_source *source = session->run.mesh ? tc_mesh_source(session->run.mesh) : NULL;
    const int step = (int)lround(gtk_range_get_value(GTK_RANGE(data->time)));
    if (session->busy)
        return G_SOURCE_CONTINUE;
    data->later = 0;
    if (source && step != source->step)
        tc_loader_step(session, step);
    return G_SOURCE_REMOVE;
}

static void tc_time_moved(GtkRange *range, gpointer user)
{
    enum { LATER_MS = 60 };
    tc_effect_data *data = user;
    const tc_source *source = data->session->run.mesh ? tc_mesh_source(data->session->run.mesh) : NULL;
    if (data->filling)
        return;
    tc_time_say(data, source, (int)lround(gtk_range_get_value(range)));
    if (!data->later)
        data->later = g_timeout_add(LATER_MS, tc_step_read, data);
}

static void tc_data_free(gpointer user)
{
    tc_effect_data *data = user;
    if (data->later)
        g_source_remove(data->later);
    g_array_unref(data->choice);
    g_free(data);
}

static GtkWidget *tc_line(GtkWidget *box, const char *title, GtkWidget *widget)
{
    GtkWidget *line = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 8), *label = gtk_label_new(title);
    gtk_label_set_xalign(GTK_LABEL(label), 0);
    gtk_widget_set_size_request(label, 126, -1);
    gtk_widget_set_hexpand(widget, TRUE);
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, title, -1);
    gtk_box_append(GTK_BOX(line), label);
    gtk_box_append(GTK_BOX(line), widget);
    gtk_box_append(GTK_BOX(box), line);
    return line;
}

GtkWidget *tc_effect_data_new(tc_session *session)
{
    tc_effect_data *data = g_new0(tc_effect_data, 1);
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 4);
    *data = (tc_effect_data){.session = session,
                             .field = gtk_drop_down_new(NULL, NULL),
                             .time = gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, 0, 1, 1),
                             .time_label = gtk_label_new(NULL),
                             .choice = g_array_new(FALSE, FALSE, sizeof(tc_field_choice))};
    g_array_set_clear_func(data->choice, tc_choice_clear);
    g_object_set_data_full(G_OBJECT(box), TC_DATA_KEY, data, tc_data_free);
    data->field_line = tc_line(box, "Field", data->field);
    data->time_line = tc_line(box, "Time", data->time);
    gtk_scale_set_draw_value(GTK_SCALE(data->time), FALSE);
    gtk_range_set_round_digits(GTK_RANGE(data->time), 0);
    gtk_box_append(GTK_BOX(data->time_line), data->time_label);
    g_signal_connect(data->field, "notify::selected", G_CALLBACK(tc_field_chosen), data);
    g_signal_connect(data->time, "value-changed", G_CALLBACK(tc_time_moved), data);
    tc_effect_data_fill(box);
    return box;
}
