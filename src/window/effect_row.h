/* effect_row.h: one option of a picture as a line of the panel: its title, its control, and, where it cannot be, the
 * sentence that says why. */
#ifndef TC_WINDOW_EFFECT_ROW_H
#define TC_WINDOW_EFFECT_ROW_H

#include "window/control.h"
#include "window/effect_set.h"

typedef struct tc_effect_row tc_effect_row;
struct tc_effect_row {
    tc_effect_hub *hub;
    tc_control control;
    GtkWidget *box;                    /* all of it */
    GtkWidget *line, *label;           /* title and control; the title alone */
    GtkWidget *widget, *second;        /* the control; a second one beside it, NULL: none */
    GtkWidget *wrong;                  /* the sentence */
    bool filling;                      /* the control is being set, which is no change of the user's */
    bool failed;                       /* what the control shows could not be set */
    guint later;                       /* the source that will apply */
    void (*apply)(tc_effect_row *row); /* sets the option to what the control shows */
    void (*fill)(tc_effect_row *row);  /* shows what is set, and what the data allow */
    void *own;                         /* of the kind, freed by g_free with the row */
};

/* The row of an option, box floating, which owns it; NULL: the option has no control. hub lives longer. */
tc_effect_row *tc_effect_row_new(tc_effect_hub *hub, const tc_option *option);
/* Shows what is set now. */
void tc_effect_row_fill(tc_effect_row *row);

/* For the kinds of control. The frame of a row, without a control; widget goes in behind the title, or with `below`
 * under it. */
tc_effect_row *tc_effect_row_frame(tc_effect_hub *hub, const tc_control *control);
void tc_effect_row_put(tc_effect_row *row, GtkWidget *widget, bool below);
/* Sets the option, or that one, and shows whether it could be. */
bool tc_effect_row_set(tc_effect_row *row, const char *option, const char *text);
/* Applies when the events at hand are through, so that many of a slider are one. */
void tc_effect_row_later(tc_effect_row *row);
/* A slider for an adjustment, as wide as there is room, named to screen readers. */
GtkWidget *tc_effect_slider(GtkAdjustment *adjustment, const char *name);
/* The colour in a text "R,G,B", and back; g_malloc. */
bool tc_effect_color_read(GdkRGBA *out, const char *text);
char *tc_effect_color_text(const GdkRGBA *color);
/* A number as short as it can be read back to 9 digits, with a decimal point; g_malloc. */
char *tc_effect_number_text(double value);

/* The kinds that have files of their own. */
tc_effect_row *tc_effect_surfaces_new(tc_effect_hub *hub, const tc_control *control);
tc_effect_row *tc_effect_box_new(tc_effect_hub *hub, const tc_control *control);

#endif
