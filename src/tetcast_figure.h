/* tetcast_figure.h: what a picture in a paper needs around its volume: colour bar, axes, title. Included by tetcast.h.
 *
 * A figure is drawn over a finished picture, its background included. Letters are the library's own outlines (DejaVu Sans:
 * Latin, Greek, Cyrillic, signs of mathematics), so that neither fonts nor libraries are needed and every machine draws
 * the same pixels. */
#ifndef TETCAST_FIGURE_H
#define TETCAST_FIGURE_H

#ifndef TETCAST_H
#error "include tetcast.h, which includes this file"
#endif

/* Where the colour bar is: upright at the right or left, or lying at the bottom. */
typedef enum tc_bar { TC_BAR_NONE = 0, TC_BAR_RIGHT = 1, TC_BAR_LEFT = 2, TC_BAR_BOTTOM = 3 } tc_bar;

/* Letters and lines. AUTO: measured, against the picture's outermost pixels over white. */
typedef enum tc_ink { TC_INK_AUTO = 0, TC_INK_DARK = 1, TC_INK_LIGHT = 2 } tc_ink;

/* All zeros draws nothing. Texts are UTF-8, borrowed for the call, NULL or "": none; those too long for their place are set
 * smaller, then cut with an ellipsis. */
typedef struct tc_figure {
    const char *title; /* above, in the middle */
    tc_ink ink;
    int whole_width, whole_height; /* of the picture that the image is a part of; 0: it is whole. Then ink must not be AUTO */
    int part_x, part_y;            /* the image's left upper pixel in it, from its left upper one */
    double text_size; /* of letters, in pixels (their em); 0: 1/44 of the picture's height, at least 10 */

    tc_bar bar;
    const tc_transfer *function; /* whose colours it shows; needed with bar */
    const char *bar_title;       /* the field's name and unit, along the bar */
    bool has_range;
    double range[2];      /* the scalars that it spans; has_range, else the function's first to last knot */
    bool log;             /* laid over log10; range above 0 */
    bool bar_opacity;     /* a second strip beside it: colours as opaque as the function's opacity, over a checkerboard */

    /* Values that stand for themselves, as material numbers: the bar is then as many equal bands, from the first to the last,
     * each in the function's colour at its value and labelled by its name (or by the number); range and log do not count. */
    size_t n_category;
    const double *category;           /* [n_category] */
    const char *const *category_name; /* [n_category], NULL: the numbers; a name may be NULL, too */

    bool triad;           /* the directions of x, y and z, in the lower left corner */
    bool axes;            /* ticks along three edges of the box on the outline of its projection */
    const double *bounds; /* [6] xmin xmax ymin ymax zmin zmax, of the box; needed with axes */
    const tc_camera *camera; /* that the picture was made with; needed with axes and triad */
    const char *axis_title[3]; /* NULL: "x", "y", "z" */
} tc_figure;

/* Draws figure over image, in place: letters and lines antialiased, in [0, 1]; under them, where something is behind, a soft
 * edge of the opposite ink. No text meets another one or the picture's edge. Of what does not fit: labels of axes are left out
 * silently, whole parts with a warning to log (NULL allowed), as is said of axes whose box is seen from inside.
 * Errors: TC_E_ARG (a needed part is missing, a range that is empty or not finite, a camera without direction: nothing is
 * drawn), TC_E_MEMORY. Cost: O(pixels that are drawn), some ms. Thread-safe. */
TC_API tc_status tc_figure_draw(tc_image *image, const tc_figure *figure, const tc_log *log, tc_error *err);

/* The ink that AUTO takes over a picture, its background included: DARK or LIGHT. For parts of one, that of a small picture of
 * the whole does. */
TC_API tc_ink tc_figure_ink(const tc_image *image);

/* Moves camera, without turning it, so that a box [6] is in the middle of what title and colour bar of the figure leave of a
 * picture of that size, with room for labels where the figure has axes; where these leave less than a third of its width or height, camera stays as
 * it is. figure->camera and bounds are not looked at.
 * Errors: TC_E_ARG, as tc_figure_draw. */
TC_API tc_status tc_figure_fit(tc_camera *camera, const tc_figure *figure, const double *bounds, int width, int height,
                               tc_error *err);

#endif
