/* layout.h: where everything of a figure goes, before a pixel is drawn.
 *
 * Parts are laid out one after the other: title, colour bar, triad, axes; each keeps out of what is there already. */
#ifndef TC_FIGURE_LAYOUT_H
#define TC_FIGURE_LAYOUT_H

#include "figure/fill.h"
#include "figure/ticks.h"

struct tc_rays;

typedef enum tc_item_kind { TC_ITEM_LINE = 0, TC_ITEM_TEXT = 1, TC_ITEM_STRIP = 2 } tc_item_kind;

enum { TC_ITEM_TEXT_SIZE = 512, TC_LAYOUT_MAX = 256 };

typedef struct tc_item {
    tc_item_kind kind;
    tc_box box; /* of a text's ink; of a strip, in whole pixels; of a line its two ends */
    char text[TC_ITEM_TEXT_SIZE];
    double em, x, y;     /* of a text: size, start of its baseline */
    bool turned;         /* written upwards */
    double width;        /* of a line */
    int hue;             /* 0: the ink's; 1 … 3: that of x, y, z */
    bool lying, opacity; /* of a strip: runs to the right, not up; shows opacity, too */
} tc_item;

typedef struct tc_layout {
    int width, height;
    double em, line, gap, margin; /* letters; a line's width, whole; from a line to its text; to the picture's edge */
    double top;                   /* of what is below the title */
    int n, n_front;               /* items; of them, those in front of the axes' */
    tc_item item[TC_LAYOUT_MAX];
    int n_taken;
    tc_box taken[8]; /* rectangles of whole parts, that axes keep out of */
    const tc_figure *figure;
    const tc_log *log;
} tc_layout;

/* figure must be valid. Errors: TC_E_ARG (the camera). */
tc_status tc_layout_make(tc_layout *out, const tc_figure *figure, int width, int height, const tc_log *log,
                         tc_error *err);
/* Errors: TC_E_ARG: a figure that tc_figure_draw refuses. bounds: that they are no box, if needed. */
tc_status tc_figure_check(const tc_figure *figure, tc_error *err);
tc_status tc_figure_check_box(const double *bounds, tc_error *err);
/* The scalars that the bar spans. */
void tc_layout_range(double range[2], const tc_figure *figure);

/* ----------------------------------------------------------------------- for the files that lay out a part each */

tc_item *tc_layout_line(tc_layout *l, double x0, double y0, double x1, double y1);
/* Adds a text whose ink is centred at (x, y), as the letters of that size are. NULL: it would leave the picture, or
 * meet a text or a part that is there. */
tc_item *tc_layout_text(tc_layout *l, const char *text, double em, double x, double y, bool turned);
/* Half the width and height of a text so centred. */
void tc_layout_half(double half[2], const char *text, double em, bool turned);
/* A copy of text that is at most so many pixels long: smaller, down to 0.7 em, then cut. Gives its em; 0: no room. */
double tc_layout_fit(char *out, const char *text, double em, double room);
void tc_layout_take(tc_layout *l, double x0, double y0, double x1, double y1);
/* Does box leave the picture, or meet a text or a part? */
bool tc_layout_blocked(const tc_layout *l, const tc_box *box);
/* Pixels of a point, y down; false: it is not before the eye, or far outside of the picture. */
bool tc_layout_project(double out[2], const struct tc_rays *rays, const double *p);
void tc_layout_bar(tc_layout *l);
tc_status tc_layout_triad(tc_layout *l, tc_error *err);
tc_status tc_layout_axes(tc_layout *l, tc_error *err);

#endif
