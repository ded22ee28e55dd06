/* curve_state.h: what the parts of the opacity curve share: curve.c (the widget), curve_draw.c, curve_edit.c (of the
 * document), curve_input.c (pointer), curve_keys.c. */
#ifndef TC_WINDOW_CURVE_STATE_H
#define TC_WINDOW_CURVE_STATE_H

#include <gtk/gtk.h>

#include "edit/axis.h"
#include "window/session.h"

/* Margins above and below the plot; beside it those of plot.h. */
enum { TC_CURVE_ABOVE = 12, TC_CURVE_BELOW = 26, TC_CURVE_HANDLE = 6 };

typedef enum tc_curve_tool {
    TC_TOOL_SELECT = 0,
    TC_TOOL_FREEHAND,
    TC_TOOL_GAUSSIAN,
    TC_TOOL_TRAPEZOID,
    TC_TOOL_STEP,
    TC_TOOLS
} tc_curve_tool;

/* What lies under the pointer, and what a drag moves. */
typedef enum tc_curve_part {
    TC_PART_NOTHING = 0,
    TC_PART_POINT,    /* of that index */
    TC_PART_MIDDLE,   /* the midpoint of the piece that begins at index */
    TC_PART_LINE,     /* the curve itself */
    TC_PART_TOP,      /* the label at the top of the opacity axis */
    TC_PART_RUBBER,   /* of drags alone: a rectangle that selects */
    TC_PART_FREEHAND, /* … a line */
    TC_PART_SHAPE     /* … a stretch */
} tc_curve_part;

typedef struct tc_curve {
    tc_session *session;
    GtkWidget *box, *area, *tool_button[TC_TOOLS], *axis_button, *count_button, *volume_button, *top_entry;
    GtkWidget *popover, *scalar_entry, *opacity_entry;
    tc_axis axis;
    bool log_counts;
    tc_curve_tool tool;
    size_t focus; /* the point of the keyboard */
    bool telling; /* what is told is this widget's own change */

    bool hovered; /* the pointer is in it */
    double pointer[2];
    tc_curve_part hot;
    size_t hot_index;

    tc_curve_part drag;
    size_t drag_index;
    double drag_begin[2], drag_top;
    bool drag_moved, drag_grabbed, drag_toggles, drag_was_selected;
    bool press_added; /* the last press made a point: another one at once is not a double click on it */
    double press_at[2];
    guint32 press_time;
    tc_document *before; /* as the drag began */
    size_t n_line;       /* columns of the freehand line */
    double *line;        /* [n_line] places on the opacity axis; NaN: not drawn */
    double line_at[2];

    size_t n_mark;
    double *mark, picked;
    bool keys_grabbed; /* an arrow key is held */
} tc_curve;

/* The plot's edges in the area, as of plot.h. */
typedef struct tc_curve_frame {
    int width, height;
    double left, right, top, bottom;
} tc_curve_frame;
void tc_curve_frame_get(tc_curve_frame *out, const tc_curve *curve);
double tc_curve_y(const tc_curve *curve, const tc_curve_frame *frame, double opacity);
double tc_curve_opacity(const tc_curve *curve, const tc_curve_frame *frame, double y);
/* Where the handle of the piece that begins at a point is; false: it has none (a step, too narrow, the last). */
bool tc_curve_middle(double out[2], const tc_curve *curve, const tc_curve_frame *frame, size_t piece);

void tc_curve_draw(GtkDrawingArea *area, cairo_t *cr, int width, int height, gpointer curve);

/* curve_edit.c. Tells of an edit of the document (what: as of tc_session_edited; NULL: a selection). */
void tc_curve_told(tc_curve *curve, const char *what);
/* Only this point is selected, and has the keyboard. Tells. */
void tc_curve_select(tc_curve *curve, size_t index);
/* Moves what is selected by a share of the scalar axis and by a share of the opacity axis, as that point goes along it:
 * a logarithmic axis scales the others by the same factor. */
void tc_curve_shift(tc_curve *curve, double dx, double dy, size_t index);
/* Adds to midpoint and sharpness of the piece that begins at a point. */
void tc_curve_bend(tc_curve *curve, size_t piece, double midpoint, double sharpness);
/* Replaces the curve where the line has places on the opacity axis: n columns even over the scalar axis, NaN: none.
 * False: nothing was done. */
bool tc_curve_freehand(tc_curve *curve, const double *line, size_t n);
/* The shape of the tool from place to place, of a height on the document as it is; its points are selected. Tells. */
void tc_curve_shape(tc_curve *curve, double from, double to, double height);
/* The axis grows to reach over all points; shrink: also where all of them lie low on it. */
void tc_curve_fit(tc_curve *curve, bool shrink);
void tc_curve_top_set(tc_curve *curve, double top);

/* curve.c */
void tc_curve_tool_set(tc_curve *curve, tc_curve_tool tool);
/* Asks for scalar and opacity of the point that has the keyboard. */
void tc_curve_ask(tc_curve *curve);
/* Tells screen readers of the point that has the keyboard. */
void tc_curve_describe(tc_curve *curve);

void tc_curve_pointer_attach(tc_curve *curve);
void tc_curve_keys_attach(tc_curve *curve);
/* What is dragged goes back to where it was; forget: stays as it is. */
void tc_curve_drag_cancel(tc_curve *curve);
void tc_curve_drag_forget(tc_curve *curve);

#endif
