/* effect_set.h: options set from controls: with those that depend on them, coarsely while a slider moves. */
#ifndef TC_WINDOW_EFFECT_SET_H
#define TC_WINDOW_EFFECT_SET_H

#include <gtk/gtk.h>

#include "window/session.h"

/* Where the controls of one panel meet. */
typedef struct tc_effect_hub {
    tc_session *session;
    GHashTable *kept; /* texts of options that had to go with one that they need, for when it comes again */
    guint resting;    /* the source that lets go of what moves; 0: nothing does */
} tc_effect_hub;

void tc_effect_hub_init(tc_effect_hub *hub, tc_session *session);
void tc_effect_hub_finish(tc_effect_hub *hub);

/* tc_session_set, and with it: what cannot be without the option goes along, and comes again when it does. False: as of
 * tc_session_set. */
bool tc_effect_set(tc_effect_hub *hub, const char *option, const char *text);
/* An option that needs others: is one of them given? One that needs none can always be set. */
bool tc_effect_can(const tc_effect_hub *hub, const char *option);
/* What is given of an option; of several, lines. From g_malloc; NULL: nothing. */
char *tc_effect_text(const tc_session *session, const char *option);
/* A slider moves: pictures are coarse until a moment after the last call. */
void tc_effect_moves(tc_effect_hub *hub);

#endif
