/* view_draw.h: draws a picture's layers into the current framebuffer. */
#ifndef TC_WINDOW_VIEW_DRAW_H
#define TC_WINDOW_VIEW_DRAW_H

#include "window/renderer.h"

typedef struct tc_view_draw {
    unsigned program, vertex_array, sampler[2]; /* nearest, linear */
    int stretch;                                /* place of the uniform */
    tc_layer figure;                            /* over the picture */
} tc_view_draw;

/* In the context that draws, current. False, and why [256]: GL refused. */
bool tc_view_draw_init(tc_view_draw *draw, char why[256]);
void tc_view_draw_finish(tc_view_draw *draw);
/* What is drawn over all pictures from now on, the first row at the bottom; NULL: nothing. */
void tc_view_draw_figure(tc_view_draw *draw, const tc_image *image);
/* Over background, opaque; width x height are the framebuffer's. */
void tc_view_draw_layers(const tc_view_draw *draw, const tc_shown *shown, const float background[3], int width,
                         int height);

#endif
