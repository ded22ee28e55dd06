/* view_figure.h: title, colour bar and axes over the window's picture, as `render` draws them over its own. */
#ifndef TC_WINDOW_VIEW_FIGURE_H
#define TC_WINDOW_VIEW_FIGURE_H

#include "window/session.h"

/* Does the session ask for any of them? */
bool tc_view_figure_asked(const tc_session *session);
/* They alone, over nothing, of that size, premultiplied, the first row at the bottom: rgba of the image, which is the
 * caller's. NULL: nothing is asked for, or it cannot be drawn. background: what the picture lies over, by which letters
 * are dark or light. Cost: some ms. */
tc_image *tc_view_figure_make(const tc_session *session, int width, int height, const float background[3]);

#endif
