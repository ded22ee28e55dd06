/* hand.h: a hand for tests of widgets: a window over a session with a small mesh, pointer and keys by xdotool. */
#ifndef TC_TEST_HAND_H
#define TC_TEST_HAND_H

#include <gtk/gtk.h>

#include "window/session.h"

typedef struct tc_hand {
    tc_session session;
    GtkWidget *window;
    tc_document *start; /* as it was opened */
} tc_hand;

/* Opens INPUT, waits until it is read, shows content (floating) in a window. Fails the test where it cannot. */
void tc_hand_open(tc_hand *hand, const char *input);
void tc_hand_show(tc_hand *hand, GtkWidget *content, int width, int height);
void tc_hand_close(tc_hand *hand);
/* The document is again as it was opened, as one more step. */
void tc_hand_fresh(tc_hand *hand);

/* Words of xdotool, as of printf; waits until it has ended and the window has done what came of it. */
void tc_hand_act(tc_hand *hand, const char *format, ...) G_GNUC_PRINTF(2, 3);
/* Presses at one place of a widget, goes to another by way of their middle, lets go. */
void tc_hand_drag(tc_hand *hand, GtkWidget *widget, double x0, double y0, double x1, double y1);
/* The same without letting go. */
void tc_hand_press(tc_hand *hand, GtkWidget *widget, double x0, double y0, double x1, double y1);
void tc_hand_click(tc_hand *hand, GtkWidget *widget, double x, double y, int times);
/* A place of a widget on the screen, or at its edge. */
void tc_hand_place(int out[2], tc_hand *hand, GtkWidget *widget, double x, double y);
/* The widget of that type, the index-th from the top; NULL: there is none. */
GtkWidget *tc_hand_find(GtkWidget *from, GType type, int index);

#endif
