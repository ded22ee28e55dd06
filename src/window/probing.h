/* probing.h: what the ray under the pointer meets, found on a thread: the last place that was asked for. */
#ifndef TC_WINDOW_PROBING_H
#define TC_WINDOW_PROBING_H

#include "window/session.h"

typedef struct tc_probing tc_probing;

/* probed is called on the main thread; NULL: nothing is there. The session lives longer. */
tc_probing *tc_probing_new(const tc_session *session, void (*probed)(void *user, const tc_probe *probe), void *user);
/* Asks for a pixel of the session's picture; a place outside of it: nothing is there. Returns at once. */
void tc_probing_ask(tc_probing *probing, int x, int y);
/* probed is not called any more. What is under way ends by itself. */
void tc_probing_free(tc_probing *probing);

#endif
