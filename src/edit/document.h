/* document.h: what the transfer-function window edits: colours and opacity over a range of the scalar, as ParaView's
 * presets have them. It lies on the unit interval: x = 0 is the range's lower end, 1 its upper one, logarithmic places
 * between them where log is set. Pictures are made of its text, by tetcast.h, so that what is saved is what was seen.
 */
#ifndef TC_EDIT_DOCUMENT_H
#define TC_EDIT_DOCUMENT_H

#include "tetcast.h"

/* ParaView's interpolation of colours. */
typedef enum tc_edit_space {
    TC_EDIT_RGB = 0,
    TC_EDIT_HSV,
    TC_EDIT_LAB,
    TC_EDIT_DIVERGING,
    TC_EDIT_CIEDE2000,
    TC_EDIT_STEP,
    TC_EDIT_SPACES
} tc_edit_space;

/* As vtkPiecewiseFunction: midpoint (0 to 1) and sharpness (0 linear, 1 a step) are of the piece that begins here. */
typedef struct tc_edit_point {
    double x, a; /* attenuation per unit distance, 0 and more */
    double midpoint, sharpness;
    bool selected; /* not part of the function: two documents that differ in it alone are the same */
} tc_edit_point;

typedef struct tc_edit_color {
    double x, rgb[3]; /* display space, 0 to 1 */
    bool selected;
} tc_edit_color;

typedef struct tc_document {
    char *name; /* of the map */
    tc_edit_space space;
    bool hsv_wrap; /* of TC_EDIT_HSV: hue takes the short way over red */
    size_t n_point, n_color;
    tc_edit_point
        *point; /* [n_point], 2 at least, x not descending; the first at 0, the last at 1; two at one x are a step */
    tc_edit_color *color; /* [n_color], likewise */
    double range[2];      /* lower < upper; log: both above 0 */
    bool log;
    double unit_distance;        /* 0: the mesh's default */
    bool has_nan_color;          /* cells with missing values are shown, as --nan-color shows them */
    double nan_color[4];         /* r, g, b, attenuation per unit distance; r, g, b are the map's NanColor */
    struct tc_edit_colors *kept; /* tc_document_color's, not part of the function; NULL: each call makes them anew */
} tc_document;

/* "Cool to Warm", opacity linear from 0 to 0.3. Errors: TC_E_MEMORY; *out is NULL then. */
tc_status tc_document_create(tc_document **out, const double range[2], tc_error *err);
tc_status tc_document_copy(tc_document **out, const tc_document *document, tc_error *err);
void tc_document_destroy(tc_document **document);
/* Are both the same function? Names and selections are not looked at. */
bool tc_document_equal(const tc_document *a, const tc_document *b);

/* From the text of a ParaView preset (JSON), or the name of a built-in map, or what else tc_transfer_options.color_map
 * takes: of its maps that of the name, NULL: the first that can be used. Colours and NanColor, and opacity where it has
 * some; what it lies over becomes the unit interval, and the document's range, and whether missing values are shown,
 * stay. IndexedColors become steps. Errors: TC_E_FILE, TC_E_ARG (names what is wrong), TC_E_MEMORY; the document is as
 * it was. */
tc_status tc_document_take_preset(tc_document *document, const char *text, const char *name, tc_error *err);
/* From a function that there is no preset of (a scene's knots): its knots, steps as two points at one place, without
 * those on the line between their neighbours. What they lie over becomes the unit interval, by logarithms where log is
 * set and they are above 0: set log, and the range to the first and the last knot, to have that function. Errors:
 * TC_E_MEMORY; likewise. */
tc_status tc_document_take_knots(tc_document *document, const tc_transfer *tf, tc_error *err);

/* As ParaView writes presets (an array of one map), over the range (log: its points lie in it by logarithms, and
 * UseLogScale says so) or, unit set, over the unit interval. From malloc; NULL when memory is out. It can be read again
 * by tc_document_take_preset, by ParaView, and as the colour map of tetcast's options. */
char *tc_document_text(const tc_document *document, bool unit);
/* The function as `render` would make it: of that text, over the range. Errors: as tc_transfer_create. */
tc_status tc_document_function(tc_transfer **out, const tc_document *document, tc_error *err);

/* Between place and scalar, also outside of the range. A scalar that log cannot have gives -INFINITY. */
double tc_document_scalar(const tc_document *document, double x);
double tc_document_place(const tc_document *document, double scalar);
/* The attenuation at a place, by the curve (the right one at a step). Cost: a search and a power. */
double tc_document_opacity(const tc_document *document, double x);
/* The colour there, as the library interpolates it (1e-4). The first call after colours or their space changed asks the
 * library and keeps its answer with the document: one document is not for two threads at a time. Memory out: the
 * nearest point's. */
void tc_document_color(double rgb[3], const tc_document *document, double x);

/* Edits; all keep the order and the ends. Indices are those of after the call.
 * move: points that are selected go along by the same; none passes its unselected neighbours, a stays at 0 or above,
 * ends keep their x. Gives what it really went. */
void tc_document_move(double went[2], tc_document *document, double dx, double da);
/* The same with a factor, 0 or more, on a, for a logarithmic axis: points at 0 stay. */
void tc_document_scale(tc_document *document, double dx, double factor);
/* A new point, alone selected; midpoint and sharpness of the piece that it divides are taken so that the curve changes
 * as little as may be. At 0 it comes after the first, at 1 before the last. Errors: TC_E_MEMORY; the document is as it
 * was. */
tc_status tc_document_add_point(tc_document *document, size_t *index, double x, double a, tc_error *err);
tc_status tc_document_add_color(tc_document *document, size_t *index, double x, const double rgb[3], tc_error *err);
void tc_document_delete_points(tc_document *document); /* those that are selected; ends stay */
void tc_document_delete_colors(tc_document *document);
void tc_document_move_colors(tc_document *document, double dx); /* those that are selected */
/* The curve between places from and to is replaced by these points (x ascending, within); what lies outside stays as it
 * is, with steps at the ends where it must. Errors: TC_E_MEMORY; the document is as it was. */
tc_status tc_document_replace(tc_document *document, double from, double to, const tc_edit_point *point, size_t n,
                              tc_error *err);

/* Shapes: points into out [capacity], their number as result (0: capacity is too small; 32 is enough for all but
 * freehand). Height between from and to, floor at their sides; for tc_document_replace. gaussian: 3 standard deviations
 * each way, 0.5 % of its height at most off the bell. */
size_t tc_shape_gaussian(tc_edit_point *out, size_t capacity, double from, double to, double height, double floor);
/* share: of the way that is at height, in the middle; 0 a tent, 1 a step. */
size_t tc_shape_trapezoid(tc_edit_point *out, size_t capacity, double from, double to, double share, double height,
                          double floor);
/* Up at from, down at to. */
size_t tc_shape_step(tc_edit_point *out, size_t capacity, double from, double to, double height, double floor);
/* A freehand line of n places and attenuations, x ascending, thinned to what stays within error of it (Ramer 1972,
 * Douglas and Peucker 1973); places that come twice keep the last. Cost: O(n log n), O(n^2) at worst. */
size_t tc_shape_freehand(tc_edit_point *out, size_t capacity, const double *x, const double *a, size_t n, double error);

#endif
