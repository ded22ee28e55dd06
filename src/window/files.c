/* files.c: what the window opens and saves. */
#define _POSIX_C_SOURCE 200809L
#include "window/files.h"

#include "window/autosave.h"
#include "window/file_kind.h"
#include "window/help.h"
#include "window/loader.h"
#include "window/picture_job.h"
#include "window/presets.h"

#include <stdlib.h>
#include <string.h>

typedef struct tc_files {
    GtkWindow *window;
    tc_session *session;
    GFile *folder; /* of the last file; NULL: none yet */
} tc_files;

/* --------------------------------------------------------------------------------------------------------- opening */

void tc_files_open(GtkWindow *window, tc_session *session, const char *path)
{
    char name[] = "edit";
    char *copy = g_strdup(path);
    char *argv[] = {name, copy, NULL};
    GtkWidget *presets = tc_presets_in(window);
    if (tc_file_kind_of(path) == TC_FILE_PRESET && presets)
        tc_presets_add(presets, path, true);
    else if (tc_session_reopen(session, 2, argv))
        tc_loader_start(session);
    g_free(copy);
}

static void tc_folder_keep(tc_files *files, GFile *file)
{
    g_clear_object(&files->folder);
    files->folder = g_file_get_parent(file);
}

static void tc_open_chosen(GtkNativeDialog *dialog, int response, gpointer user)
{
    tc_files *files = user;
    GFile *file = response == GTK_RESPONSE_ACCEPT ? gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog)) : NULL;
    char *path = file ? g_file_get_path(file) : NULL;
    if (path) {
        tc_folder_keep(files, file);
        tc_files_open(files->window, files->session, path);
    }
    g_free(path);
    g_clear_object(&file);
    g_object_unref(dialog);
}

static GtkFileChooserNative *tc_chooser(tc_files *files, const char *title, GtkFileChooserAction action,
                                        const char *accept, GCallback chosen)
{
    GtkFileChooserNative *dialog = gtk_file_chooser_native_new(title, files->window, action, accept, "_Cancel");
    if (files->folder)
        gtk_file_chooser_set_current_folder(GTK_FILE_CHOOSER(dialog), files->folder, NULL);
    gtk_native_dialog_set_modal(GTK_NATIVE_DIALOG(dialog), TRUE);
    g_signal_connect(dialog, "response", chosen, files);
    return dialog;
}

static void tc_filter_add(GtkFileChooserNative *dialog, const char *name, const char *const *pattern)
{
    GtkFileFilter *filter = gtk_file_filter_new();
    gtk_file_filter_set_name(filter, name);
    for (; *pattern; pattern++)
        gtk_file_filter_add_pattern(filter, *pattern);
    gtk_file_chooser_add_filter(GTK_FILE_CHOOSER(dialog), filter);
    g_object_unref(filter);
}

static void tc_open_action(GSimpleAction *action, GVariant *parameter, gpointer user)
{
    static const char *const all[] = {"*", NULL}, *const scene[] = {"*.json", "*.pvsm", "*.pvcc", NULL},
                             *const picture[] = {"*.png", "*.exr", "*.tif", "*.tiff", "*.jpg", "*.jpeg", NULL},
                             *const preset[] = {"*.json", "*.xml", NULL};
    (void)action;
    (void)parameter;
    GtkFileChooserNative *dialog = tc_chooser(user, "Open data, a scene, a picture or a preset",
                                              GTK_FILE_CHOOSER_ACTION_OPEN, "_Open", G_CALLBACK(tc_open_chosen));
    tc_filter_add(dialog, "All files", all);
    tc_filter_add(dialog, "Scenes", scene);
    tc_filter_add(dialog, "Pictures with a scene", picture);
    tc_filter_add(dialog, "Colour maps (ParaView presets)", preset);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

/* ---------------------------------------------------------------------------------------------------------- saving */

static bool tc_text_write(tc_files *files, const char *path, const char *text)
{
    GError *error = NULL;
    char *line = g_strdup_printf("%s%s", text, g_str_has_suffix(text, "\n") ? "" : "\n");
    const bool good = g_file_set_contents_full(path, line, -1, G_FILE_SET_CONTENTS_CONSISTENT, 0666, &error);
    if (good)
        tc_session_say(files->session, "wrote %s", path);
    else
        tc_session_say(files->session, "%s cannot be written: %s; choose a folder that is writable and has room", path,
                       error->message);
    g_clear_error(&error);
    g_free(line);
    return good;
}

/* The preset bears the file's name, so that ParaView tells it from the map that it began with. */
static void tc_preset_save(tc_files *files, const char *path)
{
    tc_document *named;
    tc_error err = {0};
    char *base = g_path_get_basename(path), *dot = strrchr(base, '.'), *text = NULL;
    if (dot && dot != base)
        *dot = 0;
    if (tc_document_copy(&named, files->session->document, &err)) {
        tc_session_say(files->session, "%s", err.text);
        g_free(base);
        return;
    }
    free(named->name);
    named->name = strdup(base);
    if (named->name)
        text = tc_document_text(named, false);
    if (text)
        tc_text_write(files, path, text);
    else
        tc_session_say(files->session, "memory ran out");
    free(text);
    tc_document_destroy(&named);
    g_free(base);
}

static void tc_scene_save(tc_files *files, const char *path)
{
    char *text = tc_session_scene(files->session); /* says why not */
    if (text)
        tc_text_write(files, path, text);
    free(text);
}

/* A picture that is being made, for longer than the window may be there. */
typedef struct tc_saving {
    tc_picture_job *job;
    tc_session *session;
    GtkWindow *window; /* NULL: closed meanwhile */
    GApplication *application;
    char *path, why[1024];
    gint64 begin_us;
} tc_saving;

static void tc_saving_run(GTask *task, gpointer source, gpointer data, GCancellable *cancellable)
{
    (void)source;
    (void)cancellable;
    tc_saving *saving = data;
    g_task_return_boolean(task, tc_picture_job_run(saving->job, saving->why));
}

static void tc_saving_done(GObject *source, GAsyncResult *result, gpointer user)
{
    (void)source;
    tc_saving *saving = user;
    const bool good = g_task_propagate_boolean(G_TASK(result), NULL);
    const double s = (double)(g_get_monotonic_time() - saving->begin_us) / 1e6;
    if (saving->window && good)
        tc_session_say(saving->session, "wrote %s in %.1f s", saving->path, s);
    else if (saving->window)
        tc_session_say(saving->session, "%s", saving->why);
    if (saving->window)
        g_object_remove_weak_pointer(G_OBJECT(saving->window), (gpointer *)&saving->window);
    tc_picture_job_free(saving->job);
    g_application_release(saving->application);
    g_object_unref(saving->application);
    g_free(saving->path);
    g_free(saving);
}

static void tc_picture_save(tc_files *files, const char *path)
{
    tc_picture_job *job = tc_picture_job_new(files->session, path);
    if (!job)
        return;
    tc_saving *saving = g_new0(tc_saving, 1);
    *saving = (tc_saving){.job = job,
                          .session = files->session,
                          .window = files->window,
                          .application = g_object_ref(G_APPLICATION(gtk_window_get_application(files->window))),
                          .path = g_strdup(path),
                          .begin_us = g_get_monotonic_time()};
    g_application_hold(saving->application); /* the picture is made whole, whatever happens to the window */
    g_object_add_weak_pointer(G_OBJECT(files->window), (gpointer *)&saving->window);
    tc_session_say(files->session, "writing %s …", path);
    GTask *task = g_task_new(NULL, NULL, tc_saving_done, saving);
    g_task_set_task_data(task, saving, NULL);
    g_task_run_in_thread(task, tc_saving_run);
    g_object_unref(task);
}

typedef struct tc_save_kind {
    const char *action, *title, *end; /* end: the extension that a name without one gets */
    void (*save)(tc_files *files, const char *path);
    const char *what;
    const char *pattern[7];
} tc_save_kind;

static const tc_save_kind tc_save[] = {
    {"save-preset", "Save the function as a ParaView preset", ".json", tc_preset_save, "ParaView presets", {"*.json"}},
    {"save-scene", "Save the scene", ".json", tc_scene_save, "Scenes", {"*.json"}},
    {"save-picture",
     "Save the picture",
     ".png",
     tc_picture_save,
     "Pictures",
     {"*.png", "*.exr", "*.tif", "*.tiff", "*.jpg", "*.jpeg"}},
};

static void tc_save_chosen(GtkNativeDialog *dialog, int response, gpointer user)
{
    tc_files *files = user;
    const tc_save_kind *kind = g_object_get_data(G_OBJECT(dialog), "kind");
    GFile *file = response == GTK_RESPONSE_ACCEPT ? gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog)) : NULL;
    char *path = file ? g_file_get_path(file) : NULL;
    char *base = path ? g_path_get_basename(path) : NULL;
    if (path && !strchr(base, '.')) {
        char *whole = g_strconcat(path, kind->end, NULL);
        g_free(path);
        path = whole;
        if (g_file_test(path, G_FILE_TEST_EXISTS)) { /* nobody was asked whether it may be written over */
            tc_session_say(files->session, "%s is there already: give its whole name to write it over", path);
            g_clear_pointer(&path, g_free);
        }
    }
    if (path) {
        tc_folder_keep(files, file);
        kind->save(files, path);
    }
    g_free(base);
    g_free(path);
    g_clear_object(&file);
    g_object_unref(dialog);
}

static void tc_save_action(GSimpleAction *action, GVariant *parameter, gpointer user)
{
    (void)parameter;
    tc_files *files = user;
    const char *name = g_action_get_name(G_ACTION(action));
    for (size_t i = 0; i < G_N_ELEMENTS(tc_save); i++) {
        const tc_save_kind *kind = &tc_save[i];
        char stem[480];
        if (strcmp(kind->action, name) != 0)
            continue;
        GtkFileChooserNative *dialog =
            tc_chooser(files, kind->title, GTK_FILE_CHOOSER_ACTION_SAVE, "_Save", G_CALLBACK(tc_save_chosen));
        g_object_set_data(G_OBJECT(dialog), "kind", (gpointer)kind);
        tc_filter_add(dialog, kind->what, kind->pattern);
        tc_input_stem(stem, sizeof stem, files->session->options.input);
        char *proposal = g_strconcat(stem, kind->end, NULL);
        gtk_file_chooser_set_current_name(GTK_FILE_CHOOSER(dialog), proposal);
        g_free(proposal);
        gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
    }
}

static void tc_copy_action(GSimpleAction *action, GVariant *parameter, gpointer user)
{
    (void)action;
    (void)parameter;
    tc_files *files = user;
    char *text = tc_session_command(files->session); /* says why not */
    if (!text)
        return;
    gdk_clipboard_set_text(gtk_widget_get_clipboard(GTK_WIDGET(files->window)), text);
    tc_session_say(files->session, "the command line of this picture is in the clipboard");
    free(text);
}

static void tc_close_action(GSimpleAction *action, GVariant *parameter, gpointer user)
{
    (void)action;
    (void)parameter;
    gtk_window_close(((tc_files *)user)->window);
}

/* -------------------------------------------------------------------------------------------------------- dropping */

static gboolean tc_dropped(GtkDropTarget *target, const GValue *value, double x, double y, gpointer user)
{
    (void)target;
    (void)x;
    (void)y;
    tc_files *files = user;
    GFile *file = NULL;
    if (G_VALUE_HOLDS(value, GDK_TYPE_FILE_LIST)) {
        const GSList *list = g_value_get_boxed(value);
        if (list && list->next)
            tc_session_say(files->session, "of several files the first is opened");
        file = list ? list->data : NULL;
    } else if (G_VALUE_HOLDS(value, G_TYPE_FILE)) {
        file = g_value_get_object(value);
    }
    char *path = file ? g_file_get_path(file) : NULL;
    if (!path)
        return FALSE;
    tc_files_open(files->window, files->session, path);
    g_free(path);
    return TRUE;
}

static void tc_drop_attach(tc_files *files)
{
    GType type[] = {GDK_TYPE_FILE_LIST, G_TYPE_FILE};
    GtkDropTarget *target = gtk_drop_target_new(G_TYPE_INVALID, GDK_ACTION_COPY);
    gtk_drop_target_set_gtypes(target, type, G_N_ELEMENTS(type));
    g_signal_connect(target, "drop", G_CALLBACK(tc_dropped), files);
    gtk_widget_add_controller(GTK_WIDGET(files->window), GTK_EVENT_CONTROLLER(target));
}

/* ----------------------------------------------------------------------------------------------------------- whole */

static const struct {
    const char *label, *action;
    const char *key[3];
    bool section; /* begins a part of the menu */
} tc_menu[] = {
    {"_Open…", "win.open", {"<Control>o"}, false},
    {"Save _preset…", "win.save-preset", {"<Control>s"}, true},
    {"Save s_cene…", "win.save-scene", {"<Control><Shift>s"}, false},
    {"Save p_icture…", "win.save-picture", {"<Control>e"}, false},
    {"Copy as command _line", "win.copy-command", {"<Control><Shift>c"}, false},
    {"_Keys", "win.show-help-overlay", {"F1", "<Control>question"}, true},
    {"Close _window", "win.close", {"<Control>w", "<Control>q"}, false},
};

static void tc_menu_attach(tc_files *files)
{
    GtkApplication *application = gtk_window_get_application(files->window);
    GMenu *menu = g_menu_new(), *section = NULL;
    for (size_t i = 0; i < G_N_ELEMENTS(tc_menu); i++) {
        if (!section || tc_menu[i].section) {
            g_clear_object(&section);
            section = g_menu_new();
            g_menu_append_section(menu, NULL, G_MENU_MODEL(section));
        }
        g_menu_append(section, tc_menu[i].label, tc_menu[i].action);
        gtk_application_set_accels_for_action(application, tc_menu[i].action, tc_menu[i].key);
    }
    g_clear_object(&section);
    GtkWidget *button = gtk_menu_button_new(), *bar = gtk_window_get_titlebar(files->window);
    gtk_menu_button_set_icon_name(GTK_MENU_BUTTON(button), "open-menu-symbolic");
    gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(button), G_MENU_MODEL(menu));
    gtk_menu_button_set_primary(GTK_MENU_BUTTON(button), TRUE); /* F10 */
    gtk_widget_set_tooltip_text(button, "Open and save");
    gtk_accessible_update_property(GTK_ACCESSIBLE(button), GTK_ACCESSIBLE_PROPERTY_LABEL, "Menu", -1);
    if (GTK_IS_HEADER_BAR(bar))
        gtk_header_bar_pack_end(GTK_HEADER_BAR(bar), button);
    g_object_unref(menu);
}

static void tc_files_free(gpointer data)
{
    tc_files *files = data;
    g_clear_object(&files->folder);
    g_free(files);
}

void tc_files_attach(GtkWindow *window, tc_session *session)
{
    static const GActionEntry entry[] = {
        {.name = "open", .activate = tc_open_action},         {.name = "save-preset", .activate = tc_save_action},
        {.name = "save-scene", .activate = tc_save_action},   {.name = "save-picture", .activate = tc_save_action},
        {.name = "copy-command", .activate = tc_copy_action}, {.name = "close", .activate = tc_close_action},
    };
    tc_files *files = g_new0(tc_files, 1);
    *files = (tc_files){.window = window, .session = session};
    g_object_set_data_full(G_OBJECT(window), "tc-files", files, tc_files_free);
    g_action_map_add_action_entries(G_ACTION_MAP(window), entry, G_N_ELEMENTS(entry), files);
    tc_help_attach(GTK_APPLICATION_WINDOW(window));
    tc_menu_attach(files);
    tc_drop_attach(files);
    tc_autosave_attach(window, session);
}
