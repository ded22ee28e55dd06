/* presets.c: the list of colour maps. */
#include "window/presets.h"

#include "edit/map_list.h"
#include "window/plot.h"

#include <string.h>

#define TC_PRESETS_KEY "tc-presets"
enum { TC_STRIP_WIDTH = 120, TC_STRIP_HEIGHT = 22 };

/* ---------------------------------------------------------------------------------------------------------- items */

/* One map as the list's models want it; it holds what the map is of. */
static GObject *tc_map_item_new(GBytes *list, const tc_map_entry *entry)
{
    GObject *item = g_object_new(G_TYPE_OBJECT, NULL);
    g_object_set_data_full(item, "list", g_bytes_ref(list), (GDestroyNotify)g_bytes_unref);
    g_object_set_data(item, "entry", (gpointer)entry);
    return item;
}

static const tc_map_entry *tc_map_of(gpointer item)
{
    return g_object_get_data(item, "entry");
}

/* ---------------------------------------------------------------------------------------------------------- panel */

typedef struct tc_presets {
    tc_session *session;
    GtkWidget *box, *search, *view;
    GListStore *store;
    GtkCustomFilter *filter;
    GtkSingleSelection *selection;
    char *searched;     /* what the list shows; NULL: all */
    GCancellable *gone; /* what is being read is not wanted any more */
} tc_presets;

static void tc_map_take(tc_presets *panel, const tc_map_entry *entry)
{
    tc_document *document;
    tc_error err = {0};
    tc_status status = tc_document_copy(&document, panel->session->document, &err);
    if (status == TC_OK)
        status = tc_document_take_preset(document, entry->text, NULL, &err);
    if (status) {
        tc_document_destroy(&document);
        tc_session_say(panel->session, "%s", err.text);
        return;
    }
    tc_session_take(panel->session, document, "take a colour map");
}

/* The map that the function is of is the one that is marked; none, where the list does not show it. */
static void tc_presets_mark(void *user, unsigned changes)
{
    tc_presets *panel = user;
    GListModel *shown = G_LIST_MODEL(panel->selection);
    const char *name = panel->session->document->name;
    if (!(changes & (TC_CHANGE_FUNCTION | TC_CHANGE_DATA)) || (panel->searched && *panel->searched))
        return;
    guint at = 0, n = g_list_model_get_n_items(shown);
    for (bool found = false; at < n && !found; at += !found) {
        GObject *item = g_list_model_get_item(shown, at);
        found = name && g_ascii_strcasecmp(tc_map_of(item)->name, name) == 0;
        g_object_unref(item);
    }
    const guint mark = at < n ? at : GTK_INVALID_LIST_POSITION;
    if (mark != gtk_single_selection_get_selected(panel->selection))
        gtk_single_selection_set_selected(panel->selection, mark);
}

static void tc_presets_activate(GtkListView *view, guint position, gpointer user)
{
    (void)view;
    tc_presets *panel = user;
    GObject *item = g_list_model_get_item(G_LIST_MODEL(panel->selection), position);
    if (item)
        tc_map_take(panel, tc_map_of(item));
    g_clear_object(&item);
}

static void tc_presets_search_changed(GtkSearchEntry *entry, gpointer user)
{
    tc_presets *panel = user;
    g_free(panel->searched);
    panel->searched = g_strdup(gtk_editable_get_text(GTK_EDITABLE(entry)));
    gtk_filter_changed(GTK_FILTER(panel->filter), GTK_FILTER_CHANGE_DIFFERENT);
    if (g_list_model_get_n_items(G_LIST_MODEL(panel->selection)) > 0)
        gtk_single_selection_set_selected(panel->selection, 0);
}

/* Enter in the search takes the first map that it finds, also where it has not told yet of what was typed last. */
static void tc_presets_search_enter(GtkSearchEntry *entry, gpointer user)
{
    tc_presets *panel = user;
    if (strcmp(panel->searched ? panel->searched : "", gtk_editable_get_text(GTK_EDITABLE(entry))) != 0)
        tc_presets_search_changed(entry, user);
    const guint at = gtk_single_selection_get_selected(panel->selection);
    if (at != GTK_INVALID_LIST_POSITION)
        tc_presets_activate(NULL, at, panel);
}

static gboolean tc_presets_is_found(gpointer item, gpointer user)
{
    tc_presets *panel = user;
    return tc_map_matches(tc_map_of(item), gtk_editable_get_text(GTK_EDITABLE(panel->search)));
}

/* Down in the search goes into the list. */
static gboolean tc_presets_search_key(GtkEventControllerKey *controller, guint key, guint code, GdkModifierType state,
                                      gpointer user)
{
    (void)controller;
    (void)code;
    (void)state;
    tc_presets *panel = user;
    if (key != GDK_KEY_Down && key != GDK_KEY_KP_Down)
        return FALSE;
    return gtk_widget_child_focus(panel->view, GTK_DIR_TAB_FORWARD);
}

/* --------------------------------------------------------------------------------------------------------- rows */

/* The strip, and over its lower part what the map's own curve of opacity leaves of it. */
static void tc_strip_draw(GtkDrawingArea *area, cairo_t *cairo, int width, int height, gpointer user)
{
    (void)user;
    GObject *item = g_object_get_data(G_OBJECT(area), "item");
    if (!item || width < 1 || height < 1)
        return;
    const tc_map_entry *entry = tc_map_of(item);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, TC_MAP_STRIP, 1);
    unsigned char *row = cairo_image_surface_get_data(surface);
    for (int i = 0; row && i < TC_MAP_STRIP; i++) {
        const guint32 pixel =
            (guint32)entry->strip[i][0] << 16 | (guint32)entry->strip[i][1] << 8 | (guint32)entry->strip[i][2];
        memcpy(row + 4 * i, &pixel, sizeof pixel);
    }
    cairo_surface_mark_dirty(surface);
    cairo_save(cairo);
    cairo_scale(cairo, (double)width / TC_MAP_STRIP, height);
    cairo_set_source_surface(cairo, surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo), CAIRO_FILTER_NEAREST);
    cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);
    cairo_paint(cairo);
    cairo_restore(cairo);
    cairo_surface_destroy(surface);
    if (!entry->has_opacity)
        return;
    cairo_move_to(cairo, 0, height);
    for (int i = 0; i < TC_MAP_STRIP; i++)
        cairo_line_to(cairo, (i + 0.5) * width / TC_MAP_STRIP, height - 2 - (double)entry->opacity[i] * (height - 4));
    for (int pass = 0; pass < 2; pass++) { /* light on dark: seen on every colour */
        cairo_set_source_rgba(cairo, pass, pass, pass, pass ? 1 : 0.6);
        cairo_set_line_width(cairo, pass ? 1.25 : 3);
        cairo_stroke_preserve(cairo);
    }
    cairo_new_path(cairo);
}

static void tc_row_setup(GtkSignalListItemFactory *factory, GtkListItem *row, gpointer user)
{
    (void)factory;
    (void)user;
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 8), *strip = gtk_drawing_area_new(),
              *label = gtk_label_new(NULL);
    gtk_drawing_area_set_content_width(GTK_DRAWING_AREA(strip), TC_STRIP_WIDTH);
    gtk_drawing_area_set_content_height(GTK_DRAWING_AREA(strip), TC_STRIP_HEIGHT);
    gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(strip), tc_strip_draw, NULL, NULL);
    gtk_widget_set_valign(strip, GTK_ALIGN_CENTER);
    gtk_label_set_xalign(GTK_LABEL(label), 0);
    gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_END);
    gtk_widget_set_hexpand(label, TRUE);
    gtk_box_append(GTK_BOX(box), strip);
    gtk_box_append(GTK_BOX(box), label);
    gtk_list_item_set_child(row, box);
}

static void tc_row_bind(GtkSignalListItemFactory *factory, GtkListItem *row, gpointer user)
{
    (void)factory;
    (void)user;
    GtkWidget *box = gtk_list_item_get_child(row), *strip = gtk_widget_get_first_child(box),
              *label = gtk_widget_get_next_sibling(strip);
    GObject *item = gtk_list_item_get_item(row);
    const tc_map_entry *entry = tc_map_of(item);
    const char *file = entry->file;
    char *tip = g_strdup_printf("%s%s%s%s", entry->name, file ? "\n" : "", file ? file : "",
                                entry->has_opacity ? "\nwith a curve of opacity" : "");
    g_object_set_data_full(G_OBJECT(strip), "item", g_object_ref(item), g_object_unref);
    gtk_label_set_text(GTK_LABEL(label), entry->name);
    gtk_widget_set_tooltip_text(box, tip);
    gtk_accessible_update_property(GTK_ACCESSIBLE(box), GTK_ACCESSIBLE_PROPERTY_LABEL, entry->name, -1);
    gtk_widget_queue_draw(strip);
    g_free(tip);
}

static void tc_row_unbind(GtkSignalListItemFactory *factory, GtkListItem *row, gpointer user)
{
    (void)factory;
    (void)user;
    g_object_set_data(G_OBJECT(gtk_widget_get_first_child(gtk_list_item_get_child(row))), "item", NULL);
}

/* -------------------------------------------------------------------------------------------------------- reading */

typedef struct tc_reading {
    char *path; /* NULL: the built-in maps */
    bool take;
} tc_reading;

static void tc_reading_free(gpointer data)
{
    tc_reading *reading = data;
    g_free(reading->path);
    g_free(reading);
}

static void tc_list_free(gpointer data)
{
    tc_map_list *list = data;
    tc_map_list_destroy(&list);
}

static void tc_reading_run(GTask *task, gpointer source, gpointer data, GCancellable *cancellable)
{
    (void)source;
    (void)cancellable;
    const tc_reading *reading = data;
    tc_map_list *list;
    tc_error err = {0};
    if (tc_map_list_read(&list, reading->path, &err))
        g_task_return_new_error(task, G_IO_ERROR, G_IO_ERROR_FAILED, "%s", err.text);
    else
        g_task_return_pointer(task, list, tc_list_free);
}

/* Takes out the maps of a file. */
static void tc_presets_drop(tc_presets *panel, const char *path)
{
    for (guint i = g_list_model_get_n_items(G_LIST_MODEL(panel->store)); i-- > 0;) {
        GObject *item = g_list_model_get_item(G_LIST_MODEL(panel->store), i);
        const bool of = !g_strcmp0(tc_map_of(item)->file, path);
        g_object_unref(item);
        if (of)
            g_list_store_remove(panel->store, i);
    }
}

static void tc_reading_done(GObject *source, GAsyncResult *result, gpointer user)
{
    (void)source;
    const tc_reading *reading = g_task_get_task_data(G_TASK(result));
    const bool gone = g_cancellable_is_cancelled(g_task_get_cancellable(G_TASK(result)));
    GError *error = NULL;
    tc_map_list *list = g_task_propagate_pointer(G_TASK(result), &error);
    if (gone) { /* user is, too */
        tc_list_free(list);
        g_clear_error(&error);
        return;
    }
    tc_presets *panel = user;
    if (!list) {
        tc_session_say(panel->session, "%s", error->message);
        g_clear_error(&error);
        return;
    }
    tc_presets_drop(panel, reading->path);
    GBytes *keep = g_bytes_new_with_free_func(list, sizeof *list, tc_list_free, list);
    for (size_t i = 0; i < list->n; i++) { /* files stand before the built-in maps, the last one first */
        GObject *item = tc_map_item_new(keep, &list->entry[i]);
        g_list_store_insert(panel->store,
                            reading->path ? (guint)i : g_list_model_get_n_items(G_LIST_MODEL(panel->store)), item);
        g_object_unref(item);
    }
    if (reading->path) {
        gtk_editable_set_text(GTK_EDITABLE(panel->search), "");
        gtk_single_selection_set_selected(panel->selection, 0);
        tc_session_say(panel->session, "%s: %zu colour map%s", reading->path, list->n, list->n == 1 ? "" : "s");
    }
    if (reading->take && list->n > 0)
        tc_map_take(panel, &list->entry[0]);
    else if (!reading->path)
        tc_presets_mark(panel, TC_CHANGE_FUNCTION);
    g_bytes_unref(keep);
}

static void tc_presets_read(tc_presets *panel, const char *path, bool take)
{
    tc_reading *reading = g_new0(tc_reading, 1);
    *reading = (tc_reading){.path = g_strdup(path), .take = take};
    GTask *task = g_task_new(NULL, panel->gone, tc_reading_done, panel);
    g_task_set_task_data(task, reading, tc_reading_free);
    g_task_set_check_cancellable(task, FALSE);
    g_task_run_in_thread(task, tc_reading_run);
    g_object_unref(task);
}

void tc_presets_add(GtkWidget *presets, const char *path, bool take)
{
    tc_presets_read(g_object_get_data(G_OBJECT(presets), TC_PRESETS_KEY), path, take);
}

/* ---------------------------------------------------------------------------------------------------------- whole */

static void tc_presets_rooted(GObject *box, GParamSpec *spec, gpointer user)
{
    (void)spec;
    (void)user;
    GtkRoot *root = gtk_widget_get_root(GTK_WIDGET(box));
    if (root)
        g_object_set_data(G_OBJECT(root), TC_PRESETS_KEY, box);
}

GtkWidget *tc_presets_in(GtkWindow *window)
{
    return g_object_get_data(G_OBJECT(window), TC_PRESETS_KEY);
}

static void tc_presets_gone(GtkWidget *box, gpointer user)
{
    (void)box;
    tc_presets *panel = user;
    tc_plot_unlisten(panel->session, panel);
}

static void tc_presets_free(gpointer data)
{
    tc_presets *panel = data;
    g_cancellable_cancel(panel->gone);
    g_object_unref(panel->gone);
    g_free(panel->searched);
    g_free(panel);
}

GtkWidget *tc_presets_new(tc_session *session)
{
    tc_presets *panel = g_new0(tc_presets, 1);
    *panel = (tc_presets){.session = session,
                          .box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 6),
                          .search = gtk_search_entry_new(),
                          .store = g_list_store_new(G_TYPE_OBJECT),
                          .gone = g_cancellable_new()};
    g_object_set_data_full(G_OBJECT(panel->box), TC_PRESETS_KEY, panel, tc_presets_free);
    g_signal_connect(panel->box, "notify::root", G_CALLBACK(tc_presets_rooted), NULL);

    panel->filter = gtk_custom_filter_new(tc_presets_is_found, panel, NULL);
    GtkFilterListModel *found = gtk_filter_list_model_new(G_LIST_MODEL(panel->store), GTK_FILTER(panel->filter));
    panel->selection = gtk_single_selection_new(G_LIST_MODEL(found));
    gtk_single_selection_set_autoselect(panel->selection, FALSE);
    gtk_single_selection_set_can_unselect(panel->selection, TRUE);
    GtkListItemFactory *factory = gtk_signal_list_item_factory_new();
    g_signal_connect(factory, "setup", G_CALLBACK(tc_row_setup), NULL);
    g_signal_connect(factory, "bind", G_CALLBACK(tc_row_bind), NULL);
    g_signal_connect(factory, "unbind", G_CALLBACK(tc_row_unbind), NULL);
    panel->view = gtk_list_view_new(GTK_SELECTION_MODEL(panel->selection), factory);
    g_signal_connect(panel->view, "activate", G_CALLBACK(tc_presets_activate), panel);
    gtk_accessible_update_property(GTK_ACCESSIBLE(panel->view), GTK_ACCESSIBLE_PROPERTY_LABEL, "Colour maps", -1);

    gtk_accessible_update_property(GTK_ACCESSIBLE(panel->search), GTK_ACCESSIBLE_PROPERTY_LABEL,
                                   "Search in colour maps", -1);
    g_object_set(panel->search, "placeholder-text", "Search in colour maps", NULL);
    g_signal_connect(panel->search, "search-changed", G_CALLBACK(tc_presets_search_changed), panel);
    g_signal_connect(panel->search, "activate", G_CALLBACK(tc_presets_search_enter), panel);
    GtkEventController *key = gtk_event_controller_key_new();
    g_signal_connect(key, "key-pressed", G_CALLBACK(tc_presets_search_key), panel);
    gtk_widget_add_controller(panel->search, key);

    GtkWidget *scroll = gtk_scrolled_window_new();
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scroll), panel->view);
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scroll), GTK_POLICY_NEVER, GTK_POLICY_AUTOMATIC);
    gtk_scrolled_window_set_min_content_height(GTK_SCROLLED_WINDOW(scroll), 120);
    gtk_widget_set_vexpand(scroll, TRUE);
    gtk_box_append(GTK_BOX(panel->box), panel->search);
    gtk_box_append(GTK_BOX(panel->box), scroll);
    tc_presets_read(panel, NULL, false);
    tc_session_listen(session, tc_presets_mark, panel);
    g_signal_connect(panel->box, "destroy", G_CALLBACK(tc_presets_gone), panel);
    return panel->box;
}
