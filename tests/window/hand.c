/* hand.c: see hand.h. */
#include "hand.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <unistd.h>
#include <cmocka.h>

#include "cli/commands.h"
#include "window/loader.h"

/* What the window does in so much time. */
static void wait_ms(int ms)
{
    const gint64 end = g_get_monotonic_time() + 1000 * ms;
    while (g_get_monotonic_time() < end) {
        if (!g_main_context_iteration(NULL, false))
            g_usleep(2000);
    }
}

void tc_hand_open(tc_hand *hand, const char *input)
{
    static char name[] = "edit", file[64];
    static char *argv[] = {name, file, NULL};
    g_strlcpy(file, input, sizeof file);
    *hand = (tc_hand){0};
    assert_int_equal(tc_session_open(&hand->session, &tc_command_edit, 2, argv), -1);
    assert_true(tc_loader_start(&hand->session));
    for (int i = 0; i < 3000 && hand->session.busy; i++)
        wait_ms(10);
    assert_non_null(hand->session.run.mesh);
    assert_non_null(hand->session.histogram);
    tc_error err;
    assert_int_equal(tc_document_copy(&hand->start, hand->session.document, &err), TC_OK);
}

void tc_hand_show(tc_hand *hand, GtkWidget *content, int width, int height)
{
    hand->window = gtk_window_new();
    gtk_window_set_decorated(GTK_WINDOW(hand->window), false);
    gtk_window_set_default_size(GTK_WINDOW(hand->window), width, height);
    gtk_window_set_child(GTK_WINDOW(hand->window), content);
    gtk_window_present(GTK_WINDOW(hand->window));
    for (int i = 0; i < 300 && gtk_widget_get_width(content) < 100; i++)
        wait_ms(20);
    wait_ms(300);
    tc_hand_act(hand, "search --sync --onlyvisible --pid %d windowfocus", (int)getpid());
}

void tc_hand_close(tc_hand *hand)
{
    gtk_window_destroy(GTK_WINDOW(hand->window));
    wait_ms(100);
    tc_document_destroy(&hand->start);
    tc_session_close(&hand->session);
}

void tc_hand_fresh(tc_hand *hand)
{
    tc_document *copy = NULL;
    tc_error err;
    assert_int_equal(tc_document_copy(&copy, hand->start, &err), TC_OK);
    tc_session_take(&hand->session, copy, "begin");
    wait_ms(450); /* a press now is no second click */
}

static void ended(GPid pid, gint status, gpointer user)
{
    int *code = user;
    *code = status;
    g_spawn_close_pid(pid);
}

void tc_hand_act(tc_hand *hand, const char *format, ...)
{
    (void)hand;
    va_list list;
    va_start(list, format);
    char *words = g_strdup_vprintf(format, list), *line = g_strdup_printf("xdotool %s", words), **argv = NULL;
    va_end(list);
    GPid pid;
    int code = -1;
    assert_true(g_shell_parse_argv(line, NULL, &argv, NULL));
    assert_true(g_spawn_async(NULL, argv, NULL,
                              G_SPAWN_SEARCH_PATH | G_SPAWN_DO_NOT_REAP_CHILD | G_SPAWN_STDOUT_TO_DEV_NULL, NULL, NULL,
                              &pid, NULL));
    g_child_watch_add(pid, ended, &code);
    for (int i = 0; i < 6000 && code < 0; i++)
        wait_ms(5);
    assert_int_equal(code, 0);
    wait_ms(60);
    g_strfreev(argv);
    g_free(line);
    g_free(words);
}

void tc_hand_place(int out[2], tc_hand *hand, GtkWidget *widget, double x, double y)
{
    double at[2], shift[2];
    assert_true(gtk_widget_translate_coordinates(widget, hand->window, x, y, &at[0], &at[1]));
    gtk_native_get_surface_transform(GTK_NATIVE(hand->window), &shift[0], &shift[1]);
    for (int i = 0; i < 2; i++)
        out[i] = (int)lround(fmax(at[i] + shift[i], 0));
}

static void move(tc_hand *hand, GtkWidget *widget, const double from[2], const double to[2], const char *then)
{
    int a[2], b[2];
    tc_hand_place(a, hand, widget, from[0], from[1]);
    tc_hand_place(b, hand, widget, to[0], to[1]);
    tc_hand_act(
        hand,
        "mousemove %d %d sleep 0.03 mousedown 1 sleep 0.03 mousemove %d %d sleep 0.03 mousemove %d %d sleep 0.03 %s",
        a[0], a[1], (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, b[0], b[1], then);
}

void tc_hand_press(tc_hand *hand, GtkWidget *widget, double x0, double y0, double x1, double y1)
{
    move(hand, widget, (double[2]){x0, y0}, (double[2]){x1, y1}, "");
}

void tc_hand_drag(tc_hand *hand, GtkWidget *widget, double x0, double y0, double x1, double y1)
{
    move(hand, widget, (double[2]){x0, y0}, (double[2]){x1, y1}, "mouseup 1");
}

void tc_hand_click(tc_hand *hand, GtkWidget *widget, double x, double y, int times)
{
    int a[2];
    tc_hand_place(a, hand, widget, x, y);
    tc_hand_act(hand, "mousemove %d %d sleep 0.05 click --repeat %d --delay 60 1", a[0], a[1], times);
}

static GtkWidget *find(GtkWidget *from, GType type, int *left)
{
    if (g_type_is_a(G_OBJECT_TYPE(from), type) && (*left)-- == 0)
        return from;
    for (GtkWidget *child = gtk_widget_get_first_child(from); child; child = gtk_widget_get_next_sibling(child)) {
        GtkWidget *found = find(child, type, left);
        if (found)
            return found;
    }
    return NULL;
}

GtkWidget *tc_hand_find(GtkWidget *from, GType type, int index)
{
    int left = index;
    return find(from, type, &left);
}
