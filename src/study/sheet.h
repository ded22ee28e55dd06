/* sheet.h: a sheet of panels as a gnuplot script that draws it twice, as SVG and as PNG. */
#ifndef TC_STUDY_SHEET_H
#define TC_STUDY_SHEET_H

#include "study/rows.h"

enum { TC_SHEET_COLOURS = 8, TC_SHEET_MARKS = 160, TC_SHEET_ENTRIES = 20 };
/* Told apart by the colour-blind (Okabe and Ito 2008); the first is black, none is yellow. */
extern const char *const tc_sheet_colour[TC_SHEET_COLOURS];

typedef struct tc_axis {
    const char *label;
    double lo, hi;
    bool log;
    const char *tics; /* as after gnuplot's `set xtics`, NULL: its own */
} tc_axis;

typedef struct tc_sheet {
    tc_text data, body;
    int width, height, columns, rows, panel; /* panel: the next one */
    int legend;                              /* its height */
    /* of the panel that is being drawn, in pixels from the lower left */
    double left, right, bottom, top;
    tc_axis x, y;
    size_t n_mark; /* what labels keep clear of: points and labels, as boxes in pixels */
    double mark[TC_SHEET_MARKS][4];
} tc_sheet;

/* title is drawn above all panels; the legend will have n entries. */
void tc_sheet_begin(tc_sheet *sheet, const char *title, int panels, size_t entries);
/* Widest range of values, for an axis: whole decades where log, else from 0. */
void tc_axis_fit(tc_axis *axis, const double *value, size_t n);
/* Begins a panel; what follows is added to sheet->body, ending in `plot …`. */
void tc_sheet_panel(tc_sheet *sheet, const char *title, const tc_axis *x, const tc_axis *y);
/* A point that labels keep clear of. */
void tc_sheet_mark(tc_sheet *sheet, double x, double y);
/* A label beside a point, where it is free, with a line to the point where that is not next to it; a gnuplot `set
 * label`. Comes before the panel's `plot`. */
void tc_sheet_label(tc_sheet *sheet, double x, double y, const char *text, const char *colour);
/* One entry of the legend: a line (width and dash as gnuplot's lw and dt; width 0: none) and a point (0: none). */
typedef struct tc_entry {
    const char *title, *colour;
    double width;
    int dash, point;
} tc_entry;
/* Below all panels, after the last one. */
void tc_sheet_legend(tc_sheet *sheet, const tc_entry *entry, size_t n);
/* The whole script, which writes stem.svg and stem.png. Frees the sheet. */
void tc_sheet_end(tc_text *out, tc_sheet *sheet, const char *stem);

#endif
