/* plot.h: what the opacity curve and the colour bar draw and read alike: one scalar axis above the other, colours of
 * the theme, texts and numbers. */
#ifndef TC_WINDOW_PLOT_H
#define TC_WINDOW_PLOT_H

#include <gtk/gtk.h>

#include "window/session.h"

/* Margins in pixels: places 0 and 1 of the scalar lie at the same x in all of them. */
enum { TC_PLOT_LEFT = 56, TC_PLOT_RIGHT = 18 };

/* The theme's; ink: text and lines; paper: what shows the data; accent: what is selected. */
typedef struct tc_plot_colors {
    GdkRGBA ink, paper, accent;
    bool dark;
} tc_plot_colors;

void tc_plot_colors_get(tc_plot_colors *out, GtkWidget *widget);
/* A source of that colour, its opacity times alpha. */
void tc_plot_ink(cairo_t *cr, const GdkRGBA *color, double alpha);
/* Pixels from places of the scalar in a widget of that width, and back. */
double tc_plot_x(int width, double place);
double tc_plot_place(int width, double x);

/* A line of text in the widget's font, a size smaller; at (x, y) lies what align says: 0 its left or top, 0.5 its
 * middle, 1 its right or bottom end. Gives its width. */
double tc_plot_text(cairo_t *cr, GtkWidget *widget, const char *text, double x, double y, double align_x,
                    double align_y);
/* Marks and numbers of the scalar axis under y. */
void tc_plot_scalar_axis(cairo_t *cr, GtkWidget *widget, const tc_document *document, int width, double y);
/* A gradient of the document's colours over its range, at that opacity. Destroy it. */
cairo_pattern_t *tc_plot_gradient(const tc_document *document, int width, double alpha);
/* A number as it is shown, digits of them at most; the decimal point is a point. Gives out. */
char *tc_plot_number(char out[32], double value, int digits);
/* From a text that is a number, whole; a comma may be its point. False: it is none, *out stays. */
bool tc_plot_number_read(double *out, const char *text);

/* The document becomes as another; it stays where it is. False: memory is out, it is as it was. */
bool tc_plot_restore(tc_document *document, const tc_document *as);
/* Whoever listens as that user is told no more. */
void tc_plot_unlisten(tc_session *session, const void *user);
/* What a widget is called by screen readers, and under the pointer. */
void tc_plot_label(GtkWidget *widget, const char *label, const char *tip);
/* A cursor by its CSS name, if it is not that already. */
void tc_plot_cursor(GtkWidget *widget, const char *name);

#endif
