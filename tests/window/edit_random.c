/* edit_random.c: the whole window under pointer and keys that mean nothing: edit_random INPUT EVENTS SEED. Presses,
 * drags, turns of the wheel and keys, by xdotool, over all widgets but those that open files or end the program. Then
 * all is undone, which is to give the function of the beginning, and done again, which is to give that of the end.
 * Memory is not to grow by itself. Prints what was done; exit 0: all was as it is to be; 1: not so, with a sentence;
 * 77: it cannot be tried here. */
#define _GNU_SOURCE
#include "cli/commands.h"
#include "window/loader.h"
#include "window/window.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum {
    TICK_MS = 8,    /* from one act to the next */
    SETTLE_MS = 10, /* from one look at whether all is at rest to the next */
    SETTLE_MOST = 30000 / SETTLE_MS,
    SAMPLE = 50,   /* acts from one look at the memory to the next */
    JUDGED = 5000, /* events from which on memory is judged */
    MOST_SAMPLES = 4096
};

typedef struct program {
    tc_session session;
    GtkApplication *application;
    GtkWindow *window;
    FILE *hand; /* to xdotool, a line an act */
    uint64_t chance;
    long events, sent, acts;
    int waited;
    bool begun, ended;
    tc_document *first, *last; /* functions of the beginning and of the end */
    size_t n_rss;
    double rss[MOST_SAMPLES]; /* MiB */
    int faults;
} program;

static void fault(program *p, const char *format, ...) G_GNUC_PRINTF(2, 3);
static void fault(program *p, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    p->faults++;
    fputs("edit_random: ", stderr);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
    va_end(list);
}

/* ---------------------------------------------------------------------------------------------------------- chance */

/* xorshift64* (Vigna 2016). */
static unsigned below(program *p, unsigned n)
{
    p->chance ^= p->chance >> 12;
    p->chance ^= p->chance << 25;
    p->chance ^= p->chance >> 27;
    return (unsigned)((p->chance * 0x2545F4914F6CDD1DULL) >> 33) % n;
}

static double resident(void)
{
    long pages = 0, all;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file) {
        if (fscanf(file, "%ld %ld", &all, &pages) != 2)
            pages = 0;
        fclose(file);
    }
    return (double)pages * (double)sysconf(_SC_PAGESIZE) / (1 << 20);
}

/* ---------------------------------------------------------------------------------------------------------- places */

/* Middle of a widget on the screen, and how far it goes to each side. The display has no window manager: windows are at
 * its corner. False: it is not to be seen. */
static bool place(int at[2], int half[2], GtkWidget *widget)
{
    GtkNative *native = gtk_widget_get_native(widget);
    GdkSurface *surface = native ? gtk_native_get_surface(native) : NULL;
    const int width = gtk_widget_get_width(widget), height = gtk_widget_get_height(widget);
    double x, y, shift[2];
    if (!surface || width < 4 || height < 4 ||
        !gtk_widget_translate_coordinates(widget, GTK_WIDGET(native), width / 2.0, height / 2.0, &x, &y))
        return false;
    gtk_native_get_surface_transform(native, &shift[0], &shift[1]);
    x += shift[0];
    y += shift[1];
    for (; GDK_IS_POPUP(surface); surface = gdk_popup_get_parent(GDK_POPUP(surface))) {
        x += gdk_popup_get_position_x(GDK_POPUP(surface));
        y += gdk_popup_get_position_y(GDK_POPUP(surface));
    }
    at[0] = (int)x;
    at[1] = (int)y;
    half[0] = width / 2;
    half[1] = height / 2;
    return true;
}

/* Widgets that take keys or are drawn by hand, which count more. */
static void widgets_find(GPtrArray *out, GtkWidget *widget)
{
    if (!gtk_widget_get_mapped(widget))
        return;
    const bool by_hand = GTK_IS_DRAWING_AREA(widget) || GTK_IS_GL_AREA(widget);
    if (gtk_widget_get_focusable(widget) && gtk_widget_is_sensitive(widget))
        for (int i = 0; i < (by_hand ? 12 : 1); i++)
            g_ptr_array_add(out, widget);
    for (GtkWidget *child = gtk_widget_get_first_child(widget); child; child = gtk_widget_get_next_sibling(child))
        widgets_find(out, child);
}

/* A place to press at: within some widget, or anywhere in the window. */
static void choose(program *p, int at[2])
{
    int half[2];
    GPtrArray *all = g_ptr_array_new();
    GListModel *windows = gtk_window_get_toplevels();
    for (guint i = 0; i < g_list_model_get_n_items(windows); i++) {
        GtkWidget *window = g_list_model_get_item(windows, i);
        widgets_find(all, window);
        g_object_unref(window);
    }
    if (all->len > 0 && below(p, 5) > 0 && place(at, half, all->pdata[below(p, all->len)])) {
        for (int i = 0; i < 2; i++)
            at[i] += (int)below(p, (unsigned)(2 * half[i])) - half[i];
    } else {
        at[0] = (int)below(p, (unsigned)gtk_widget_get_width(GTK_WIDGET(p->window)) + 1);
        at[1] = (int)below(p, (unsigned)gtk_widget_get_height(GTK_WIDGET(p->window)) + 1);
    }
    at[0] = MAX(at[0], 0);
    at[1] = MAX(at[1], 0);
    g_ptr_array_unref(all);
}

/* ------------------------------------------------------------------------------------------------------------ acts */

static void say(program *p, int events, const char *format, ...) G_GNUC_PRINTF(3, 4);
static void say(program *p, int events, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vfprintf(p->hand, format, list);
    fputc('\n', p->hand);
    va_end(list);
    p->sent += events;
}

static int aside(program *p, int at, int far)
{
    const int to = at + (int)below(p, 2 * (unsigned)far + 1) - far;
    return MAX(to, 0);
}

static void drag(program *p)
{
    static const char *const held[] = {"shift", "ctrl", "alt"};
    const char *hold = below(p, 6) ? NULL : held[below(p, 3)];
    const unsigned button = below(p, 4) ? 1 : 1 + below(p, 3);
    const unsigned n = below(p, 8), far = 1 + below(p, 300);
    int at[2];
    choose(p, at);
    if (hold)
        say(p, 1, "keydown %s", hold);
    say(p, 2, "mousemove %d %d\nmousedown %u", at[0], at[1], button);
    for (unsigned i = 0; i < n; i++) {
        for (int k = 0; k < 2; k++)
            at[k] = aside(p, at[k], (int)far);
        say(p, 1, "mousemove %d %d", at[0], at[1]);
    }
    if (!below(p, 8))
        say(p, 1, "key --delay 0 Escape");
    say(p, 1, "mouseup %u", button);
    if (hold)
        say(p, 1, "keyup %s", hold);
}

static void click(program *p)
{
    const unsigned button = below(p, 8) ? 1 : 3, times = 1 + !below(p, 4);
    int at[2];
    choose(p, at);
    say(p, 1, "mousemove %d %d", at[0], at[1]);
    for (unsigned i = 0; i < times; i++)
        say(p, 2, "mousedown %u\nmouseup %u", button, button);
}

static void wheel(program *p)
{
    int at[2];
    choose(p, at);
    say(p, 1, "mousemove %d %d", at[0], at[1]);
    for (unsigned i = 1 + below(p, 3), button = 4 + below(p, 2); i > 0; i--)
        say(p, 2, "mousedown %u\nmouseup %u", button, button);
}

static void press(program *p)
{
    static const char *const key[] = {"ctrl+z",    "ctrl+z",
                                      "ctrl+y",    "ctrl+shift+z",
                                      "Tab",       "Tab",
                                      "Tab",       "shift+Tab",
                                      "Delete",    "Return",
                                      "space",     "BackSpace",
                                      "Left",      "Right",
                                      "Up",        "Down",
                                      "Escape",    "Home",
                                      "End",       "Prior",
                                      "Next",      "shift+Left",
                                      "ctrl+Left", "shift+Up",
                                      "ctrl+a",    "plus",
                                      "minus",     "x",
                                      "Y",         "r",
                                      "p",         "ctrl+c",
                                      "ctrl+v",    "ctrl+shift+c",
                                      "alt+Up",    "F1",
                                      "F10",       "l",
                                      "g",         "Insert"};
    for (unsigned n = 1 + below(p, 4); n > 0; n--)
        say(p, 1, "key --delay 0 %s", key[below(p, G_N_ELEMENTS(key))]);
}

static void type(program *p)
{
    static const char *const word[] = {"1",      "2",     "3", "5",     "7",     "9", "0",
                                       "period", "minus", "e", "comma", "colon", "a"};
    say(p, 1, "key --delay 0 ctrl+a");
    for (unsigned n = 1 + below(p, 4); n > 0; n--)
        say(p, 1, "key --delay 0 %s", word[below(p, G_N_ELEMENTS(word))]);
    say(p, 1, "key --delay 0 %s", below(p, 3) ? "Return" : "Tab");
}

/* Where X has no window manager, keys go to no window once a dialog is closed: to the one above all others. */
static void focus(void)
{
    GListModel *windows = gtk_window_get_toplevels();
    GtkWindow *top = NULL;
    for (guint i = 0; i < g_list_model_get_n_items(windows); i++) {
        GtkWindow *window = g_list_model_get_item(windows, i);
        if (gtk_widget_get_mapped(GTK_WIDGET(window)) && (!top || gtk_window_get_modal(window)))
            top = window;
        g_object_unref(window);
    }
    if (top)
        gtk_window_present(top);
}

/* --------------------------------------------------------------------------------------------------------- the end */

static void memory_judge(program *p)
{
    double half[2] = {0, 0};
    for (size_t i = 0; i < p->n_rss; i++)
        half[2 * i >= p->n_rss] = fmax(half[2 * i >= p->n_rss], p->rss[i]);
    printf("edit_random: %ld events in %ld acts; memory %.0f MiB at most in the first half, %.0f MiB in the second (x "
           "%.3f)\n",
           p->sent, p->acts, half[0], half[1], half[1] / half[0]);
    if (p->sent >= JUDGED) {
        printf("edit_random: memory in tenths of the way, MiB:");
        for (size_t i = 0; i < 10; i++)
            printf(" %.0f", p->rss[i * p->n_rss / 10]);
        printf("\n");
    }
    /* What is kept of walks, 256 MiB at most, comes and goes with the picture: what grows stays above it. */
    double least = INFINITY;
    for (size_t i = p->n_rss - p->n_rss / 4; i < p->n_rss; i++)
        least = fmin(least, p->rss[i]);
    if (p->sent >= JUDGED && least > 1.1 * half[0] + 128)
        fault(p, "memory grew: %.0f MiB at most in the first half, %.0f at least in the last quarter", half[0], least);
}

/* All undone, done again, undone. */
static void history_judge(program *p)
{
    tc_session *s = &p->session;
    tc_error err;
    size_t undone = 0, again = 0;
    if (tc_document_copy(&p->last, s->document, &err)) {
        fault(p, "%s", err.text);
        return;
    }
    for (; tc_history_undo_what(s->history); undone++)
        tc_session_undo(s);
    if (!tc_document_equal(s->document, p->first))
        fault(p, "%zu steps undone do not give the function of the beginning", undone);
    for (; again < undone && tc_history_redo_what(s->history); again++)
        tc_session_redo(s);
    if (again < undone)
        fault(p, "of %zu steps that were undone %zu could be done again", undone, again);
    else if (!tc_document_equal(s->document, p->last))
        fault(p, "%zu steps done again do not give the function of the end", again);
    while (tc_history_undo_what(s->history))
        tc_session_undo(s);
    if (!tc_document_equal(s->document, p->first))
        fault(p, "undone twice they do not give the function of the beginning");
    printf("edit_random: %zu steps undone, %zu done again, %zu bytes of history\n", undone, again,
           tc_history_bytes(s->history));
}

/* Once nothing is read or held any more. */
static gboolean settle(gpointer user)
{
    program *p = user;
    const bool busy = p->session.busy || p->session.gesture || p->session.moving;
    if (++p->waited < 100 || (busy && p->waited < SETTLE_MOST))
        return G_SOURCE_CONTINUE;
    if (p->session.gesture || p->session.moving)
        fault(p, "no button is pressed, but the session still knows of a hand");
    memory_judge(p);
    if (p->session.gesture == 0)
        history_judge(p);
    p->ended = true;
    gtk_window_destroy(p->window);
    return G_SOURCE_REMOVE;
}

/* ----------------------------------------------------------------------------------------------------------- begin */

static gboolean act(gpointer user)
{
    program *p = user;
    if (p->sent >= p->events) {
        say(p, 0, "mouseup 1\nmouseup 2\nmouseup 3\nkeyup shift\nkeyup ctrl\nkeyup alt");
        for (int i = 0; i < 4; i++)
            say(p, 0, "key --delay 0 Escape");
        fflush(p->hand);
        g_timeout_add(SETTLE_MS, settle, p);
        return G_SOURCE_REMOVE;
    }
    if (p->acts % 10 == 0) {
        say(p, 2, "key --delay 0 Escape\nkey --delay 0 Escape"); /* no dialog stays long */
        focus();
    }
    if (p->acts++ % SAMPLE == 0 && p->n_rss < MOST_SAMPLES)
        p->rss[p->n_rss++] = resident();
    const unsigned what = below(p, 16);
    if (what < 8)
        drag(p);
    else if (what < 11)
        click(p);
    else if (what < 12)
        wheel(p);
    else if (what < 14)
        press(p);
    else
        type(p);
    if (fflush(p->hand)) {
        fault(p, "xdotool has ended");
        p->events = 0;
    }
    return G_SOURCE_CONTINUE;
}

/* Nothing that is pressed may open a dialog of files or end the program. */
static void harmless_make(program *p)
{
    static const char *const action[] = {"open", "save-preset", "save-scene", "save-picture", "close"};
    static const char *const none[] = {NULL};
    for (size_t i = 0; i < G_N_ELEMENTS(action); i++) {
        GAction *found = g_action_map_lookup_action(G_ACTION_MAP(p->window), action[i]);
        if (found)
            g_simple_action_set_enabled(G_SIMPLE_ACTION(found), FALSE);
        else
            fault(p, "the window has no action %s", action[i]);
    }
    gtk_application_set_accels_for_action(p->application, "window.close", none);
    GtkWidget *bar = gtk_window_get_titlebar(p->window);
    if (GTK_IS_HEADER_BAR(bar))
        gtk_header_bar_set_show_title_buttons(GTK_HEADER_BAR(bar), FALSE);
}

static gboolean closing(GtkWindow *window, gpointer user)
{
    (void)window;
    (void)user;
    return TRUE;
}

static void heard(void *user, unsigned changes)
{
    program *p = user;
    if (p->begun || p->session.busy || !(changes & TC_CHANGE_BUSY))
        return;
    p->begun = true;
    tc_error err;
    if (!p->session.run.mesh || tc_document_copy(&p->first, p->session.document, &err)) {
        fault(p, "the data could not be read: %s", p->session.said);
        gtk_window_destroy(p->window);
        return;
    }
    g_timeout_add(TICK_MS, act, p);
}

static void activate(GtkApplication *application, gpointer user)
{
    program *p = user;
    p->window = tc_window_new(application, &p->session);
    if (*tc_window_refused(p->window)) {
        fprintf(stderr, "edit_random: skipped: %s\n", tc_window_refused(p->window));
        p->faults = -1;
        gtk_window_destroy(p->window);
        return;
    }
    harmless_make(p);
    g_signal_connect(p->window, "close-request", G_CALLBACK(closing), NULL);
    tc_session_listen(&p->session, heard, p);
    tc_loader_start(&p->session);
}

static program all;

/* What GTK 4.8 says where it is not wronged: of a press that a dialog takes away, of popovers at a place that no screen
 * has, which get no room then, of its page of keys. */
static const char *const gtk_own[] = {"Broken accounting of active state", "gdk_monitor_get_geometry",
                                      "attempt to allocate", "(label) reported min width -4"};

/* What GTK complains about else is a fault. */
static GLogWriterOutput complaint(GLogLevelFlags level, const GLogField *field, gsize n, gpointer user)
{
    (void)user;
    const char *text = "", *domain = "";
    for (gsize i = 0; i < n; i++) {
        if (!strcmp(field[i].key, "MESSAGE"))
            text = field[i].value;
        if (!strcmp(field[i].key, "GLIB_DOMAIN"))
            domain = field[i].value;
    }
    for (size_t i = 0; i < G_N_ELEMENTS(gtk_own); i++)
        if (strstr(text, gtk_own[i]))
            return G_LOG_WRITER_HANDLED;
    if (level & (G_LOG_LEVEL_ERROR | G_LOG_LEVEL_CRITICAL | G_LOG_LEVEL_WARNING))
        fault(&all, "%s: %s", domain, text);
    return G_LOG_WRITER_HANDLED;
}

int main(int argc, char **argv)
{
    program *p = &all;
    if (argc != 4) {
        fputs("usage: edit_random INPUT EVENTS SEED\n", stderr);
        return 2;
    }
    char name[] = "edit";
    char *words[] = {name, argv[1], NULL};
    p->events = strtol(argv[2], NULL, 10);
    p->chance = 0x9E3779B97F4A7C15ULL ^ strtoull(argv[3], NULL, 10);
    if (tc_session_open(&p->session, &tc_command_edit, 2, words) >= 0)
        return 1;
    if (!gtk_init_check()) {
        fputs("edit_random: skipped: there is no display\n", stderr);
        tc_session_close(&p->session);
        return 77;
    }
    signal(SIGPIPE, SIG_IGN);
    p->hand = popen("xdotool - >/dev/null", "w");
    if (!p->hand)
        return 77;
    g_log_set_writer_func(complaint, NULL, NULL);
    p->application = gtk_application_new("org.tetcast.edit", G_APPLICATION_NON_UNIQUE);
    g_signal_connect(p->application, "activate", G_CALLBACK(activate), p);
    g_application_run(G_APPLICATION(p->application), 1, argv);
    g_object_unref(p->application);
    if (pclose(p->hand) != 0)
        fault(p, "xdotool failed");
    if (!p->ended && p->faults == 0)
        fault(p, "the window was closed before the end");
    tc_document_destroy(&p->first);
    tc_document_destroy(&p->last);
    tc_session_close(&p->session);
    return p->faults < 0 ? 77 : p->faults > 0;
}
