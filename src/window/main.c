/* main.c: tetcast-edit, the program that `tetcast edit` becomes: one window over one session. */
#include "cli/commands.h"
#include "window/host_gl.h"
#include "window/loader.h"
#include "window/window.h"

#include <glib-unix.h>

typedef struct program {
    tc_session session;
    GtkWindow *window;  /* NULL: not yet, or gone */
    GtkWidget *content; /* of it, held */
    int code;           /* exit code; -1: all went well */
} program;

/* What could not be read at all leaves nothing to show: the sentence was printed. */
static void heard(void *user, unsigned changes)
{
    program *p = user;
    if (!(changes & TC_CHANGE_BUSY) || p->session.busy || p->session.run.mesh || !p->window)
        return;
    p->code = p->session.code;
    gtk_window_destroy(p->window);
    p->window = NULL;
}

/* Ended from outside: in order, so that traces are whole. */
static gboolean told_to_end(gpointer user)
{
    for (GList *list; (list = gtk_application_get_windows(user)) != NULL;)
        gtk_window_destroy(list->data);
    return G_SOURCE_REMOVE;
}

static void activate(GtkApplication *application, gpointer user)
{
    program *p = user;
    GtkWindow *window = tc_window_new(application, &p->session);
    p->content = g_object_ref(tc_window_content(window));
    if (*tc_window_refused(window)) {
        tc_talk_error(&p->session.talk, "%s", tc_window_refused(window));
        p->code = TC_EXIT_FAILED;
        gtk_window_destroy(window);
        return;
    }
    tc_loader_start(&p->session);
    p->window = window;
    tc_session_listen(&p->session, heard, p);
}

/* Is there OpenGL for pictures? -1, or the exit code of an error that was printed. */
static int gl_check(tc_talk *talk)
{
    char why[512];
    bool software;
    if (!tc_host_gl_try(gdk_display_get_default(), &software, why)) {
        tc_talk_error(
            talk,
            "a window needs OpenGL 4.3, which this display does not give (%s); update the driver of the GPU or "
            "install Mesa's (libgl1-mesa-dri); tetcast render makes pictures without a display",
            why);
        return TC_EXIT_FAILED;
    }
    if (software) /* widgets drawn with it would take the time of the pictures */
        g_setenv("GSK_RENDERER", "cairo", FALSE);
    return -1;
}

int main(int argc, char **argv)
{
    program p = {.code = -1};
    int code = tc_session_open(&p.session, &tc_command_edit, argc, argv);
    if (code >= 0)
        return tc_talk_finish(&p.session.talk, code);
    g_set_prgname("tetcast-edit");
    if (!gtk_init_check()) {
        tc_talk_error(&p.session.talk,
                      "the display could not be opened: see DISPLAY or WAYLAND_DISPLAY, or run it under "
                      "xvfb-run (tetcast render makes pictures without one)");
        tc_session_close(&p.session);
        return TC_EXIT_FAILED;
    }
    code = gl_check(&p.session.talk);
    if (code >= 0) {
        tc_session_close(&p.session);
        return tc_talk_finish(&p.session.talk, code);
    }
    GtkApplication *application = gtk_application_new("org.tetcast.edit", G_APPLICATION_NON_UNIQUE);
    g_signal_connect(application, "activate", G_CALLBACK(activate), &p);
    g_unix_signal_add(SIGTERM, told_to_end, application);
    g_unix_signal_add(SIGINT, told_to_end, application);
    g_application_run(G_APPLICATION(application), 1, argv);
    g_clear_object(&p.content);
    g_object_unref(application);
    const bool loading = p.session.busy; /* by a thread that goes with the program */
    code = loading ? -1 : tc_session_close(&p.session);
    p.code = p.code < 0 ? code : p.code;
    return tc_talk_finish(&p.session.talk, p.code < 0 ? TC_EXIT_DONE : p.code);
}
