/* renderer.h: the thread that makes the window's pictures, in a GL context of its own that shares textures with the one
 * that shows them. What is asked for last is made; coarse first while something moves, then finer in parts until it is
 * at full size (edit/schedule.h). The main thread waits for none of it. */
#ifndef TC_WINDOW_RENDERER_H
#define TC_WINDOW_RENDERER_H

#include "window/session.h"

#include <gtk/gtk.h>

typedef struct tc_pictures tc_pictures;

/* A layer of a picture: a texture of premultiplied colours, its first row at the bottom. */
typedef struct tc_layer {
    unsigned texture;  /* 0: none */
    int width, height; /* of the picture in it, which covers all of the view */
    double stretch;    /* it is so many times as wide as the view, for its height; its middle is the view's */
    int rows;          /* that are there, from the top */
} tc_layer;

/* A picture as far as it is made. */
typedef struct tc_shown {
    tc_layer whole, over;  /* whole, or none; above it rows of a finer one, or none */
    unsigned id;           /* of the change that it shows; 0: nothing was made yet */
    int divide;            /* of whole: 1 is full size */
    bool last;             /* at rest: nothing finer follows */
    double ms;             /* that whole took */
    tc_render_stats stats; /* of the last rendering; its fragments_per_pass are not kept */
    bool checked;          /* the picture at rest was compared with the reference: */
    double error; /* at most 1 in 100 of its pixels errs by more, in a channel, at 95 % confidence; NAN: not checked */
} tc_shown;

/* context: shares with the one that shows; it is the thread's from now on. arrived is called on the main thread when
 * there is something new. Errors: TC_E_MEMORY. */
tc_status tc_pictures_create(tc_pictures **out, GdkGLContext *context, tc_trace *trace, void (*arrived)(void *user),
                             void *user, tc_error *err);
/* Ends the thread after the part that it is at, and frees the textures. */
void tc_pictures_destroy(tc_pictures **pictures);

/* The session's picture as it is now, in so many pixels; what was asked for before is given up. id: of the change, not
 * 0. moving: coarse is enough. */
void tc_pictures_ask(tc_pictures *pictures, const tc_session *session, int width, int height, bool moving, unsigned id);
/* What there is; its textures last until the next call. From the thread that shows, the context current. */
void tc_pictures_show(tc_pictures *pictures, tc_shown *out);
/* What was shown last is painted: the next picture may be begun. */
void tc_pictures_painted(tc_pictures *pictures);
/* The last sentence of an error; "": there was none since. [1024] */
void tc_pictures_error(tc_pictures *pictures, char out[1024]);

#endif
