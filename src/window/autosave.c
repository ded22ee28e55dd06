/* autosave.c: keeping a window's work, and getting back what a crash left. */
#include "window/autosave.h"

#include "edit/recovery.h"
#include "window/loader.h"
#include "window/plot.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

enum { TC_REST_MS = 2000 };

typedef struct tc_autosave {
    GtkWindow *window;
    tc_session *session;
    tc_recovery *own, *left; /* this window's; what a crash left, while it is not decided */
    bool told;               /* that nothing can be kept */
    bool wanted, opened;     /* left is to be opened as soon as nothing is read; is being read */
    guint resting, offering; /* sources; 0: none */
} tc_autosave;

/* ---------------------------------------------------------------------------------------------------------- keeping */

static void tc_keep(tc_autosave *a)
{
    tc_error err = {0};
    char *folder = a->own ? NULL : tc_recovery_folder();
    tc_status status = TC_OK;
    if (!a->own && folder)
        status = tc_recovery_open(&a->own, folder, &err);
    free(folder);
    char *text = a->own && a->session->run.mesh ? tc_session_scene(a->session) : NULL;
    if (text)
        status = tc_recovery_save(a->own, text, &err);
    free(text);
    if (status && !a->told)
        tc_session_say(a->session, "%s", err.text);
    a->told = status != TC_OK; /* once */
}

static gboolean tc_rested(gpointer user)
{
    tc_autosave *a = user;
    if (a->session->moving || a->session->busy)
        return G_SOURCE_CONTINUE;
    a->resting = 0;
    tc_keep(a);
    return G_SOURCE_REMOVE;
}

/* -------------------------------------------------------------------------------------------------------- offering */

/* Opens what was left; its file stays until this window has kept it itself. */
static void tc_left_open(tc_autosave *a)
{
    char name[] = "edit";
    char *path = g_strdup(tc_recovery_path(a->left));
    char *argv[] = {name, path, NULL};
    a->wanted = false;
    const bool good = tc_session_reopen(a->session, 2, argv) && tc_loader_start(a->session);
    g_free(path);
    a->opened = good;
    if (!good) /* it is offered again at the next start */
        tc_recovery_close(&a->left, true);
}

static void tc_answered(GtkDialog *dialog, int answer, gpointer user)
{
    tc_autosave *a = user;
    gtk_window_destroy(GTK_WINDOW(dialog));
    if (answer == GTK_RESPONSE_ACCEPT && a->session->busy)
        a->wanted = true;
    else if (answer == GTK_RESPONSE_ACCEPT)
        tc_left_open(a);
    else
        tc_recovery_close(&a->left, answer != GTK_RESPONSE_REJECT);
}

/* What the scene is of, as people read it; g_malloc. */
static char *tc_left_data(const char *path)
{
    json_t *scene = json_load_file(path, 0, NULL);
    const char *data = json_string_value(json_object_get(scene, "data"));
    char *name = data ? g_path_get_basename(data) : g_strdup("data that it does not name");
    json_decref(scene);
    return name;
}

static gboolean tc_offer(gpointer user)
{
    tc_autosave *a = user;
    a->offering = 0;
    char *folder = tc_recovery_folder();
    if (folder)
        tc_recovery_claim(&a->left, folder, NULL);
    free(folder);
    if (!a->left)
        return G_SOURCE_REMOVE;
    GDateTime *time = g_date_time_new_from_unix_local(tc_recovery_time(a->left));
    char *when = time ? g_date_time_format(time, "%x %X") : NULL, *data = tc_left_data(tc_recovery_path(a->left));
    GtkWidget *dialog =
        gtk_message_dialog_new(a->window, GTK_DIALOG_MODAL | GTK_DIALOG_DESTROY_WITH_PARENT, GTK_MESSAGE_QUESTION,
                               GTK_BUTTONS_NONE, "Recover the work of a window that was not closed?");
    gtk_message_dialog_format_secondary_text(GTK_MESSAGE_DIALOG(dialog), "It showed %s and was last changed %s.", data,
                                             when ? when : "before");
    gtk_dialog_add_buttons(GTK_DIALOG(dialog), "_Discard", GTK_RESPONSE_REJECT, "_Later", GTK_RESPONSE_CANCEL,
                           "_Recover", GTK_RESPONSE_ACCEPT, NULL);
    gtk_dialog_set_default_response(GTK_DIALOG(dialog), GTK_RESPONSE_ACCEPT);
    g_signal_connect(dialog, "response", G_CALLBACK(tc_answered), a);
    gtk_window_present(GTK_WINDOW(dialog));
    g_free(when);
    g_free(data);
    if (time)
        g_date_time_unref(time);
    return G_SOURCE_REMOVE;
}

/* ----------------------------------------------------------------------------------------------------------- whole */

static void tc_heard(void *user, unsigned changes)
{
    tc_autosave *a = user;
    if (changes & TC_CHANGE_DATA && a->opened) { /* it is there again, and is kept as this window's */
        tc_keep(a);
        tc_recovery_close(&a->left, !(a->own && tc_recovery_time(a->own)));
        a->opened = false;
    } else if (changes & TC_CHANGE_BUSY && a->opened && !a->session->busy) { /* its data cannot be read now */
        tc_recovery_close(&a->left, true);
        a->opened = false;
    } else if (changes & TC_CHANGE_BUSY && a->wanted && !a->session->busy) {
        tc_left_open(a);
    }
    if (!(changes & (TC_CHANGE_FUNCTION | TC_CHANGE_CAMERA | TC_CHANGE_LOOK | TC_CHANGE_DATA)))
        return;
    if (a->resting)
        g_source_remove(a->resting);
    a->resting = g_timeout_add(TC_REST_MS, tc_rested, a);
}

static void tc_autosave_end(GtkWidget *window, gpointer user)
{
    (void)window;
    tc_autosave *a = user;
    tc_plot_unlisten(a->session, a);
    if (a->resting)
        g_source_remove(a->resting);
    if (a->offering)
        g_source_remove(a->offering);
    tc_recovery_close(&a->own, false);
    tc_recovery_close(&a->left, true);
    g_free(a);
}

void tc_autosave_attach(GtkWindow *window, tc_session *session)
{
    tc_autosave *a = g_new0(tc_autosave, 1);
    *a = (tc_autosave){.window = window, .session = session};
    a->offering = g_timeout_add(300, tc_offer, a);
    tc_session_listen(session, tc_heard, a);
    g_signal_connect(window, "destroy", G_CALLBACK(tc_autosave_end), a);
}
