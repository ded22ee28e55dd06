/* view.h: the picture, as a widget: shows what the thread of renderer.h makes, and moves the camera.
 * Left drag turns, middle or Shift shifts, right or wheel draws near, Ctrl rolls; keys: arrows turn (Shift: shift; Ctrl
 * left, right: roll), + and - draw near, r begins again, x y z and X Y Z look from these sides, p probes what is under
 * the pointer. */
#ifndef TC_WINDOW_VIEW_H
#define TC_WINDOW_VIEW_H

#include "window/renderer.h"

GtkWidget *tc_view_new(tc_session *session);
/* changed is called after a new picture was painted, or was found to err by so much. One listener. */
void tc_view_listen(GtkWidget *view, void (*changed)(void *user, const tc_shown *shown), void *user);
/* probed is called with what the ray under the pointer meets; NULL: none is probed any more. One listener. */
void tc_view_listen_probe(GtkWidget *view, void (*probed)(void *user, const tc_probe *probe), void *user);
/* Why there is no picture; "": there is one, or will be. Borrowed. */
const char *tc_view_refused(GtkWidget *view);
bool tc_view_is_probing(GtkWidget *view);
void tc_view_probe(GtkWidget *view, bool on);

#endif
