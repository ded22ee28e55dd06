/* history.h: undo and redo without end: each state that was reached, and a name for what was done. */
#ifndef TC_EDIT_HISTORY_H
#define TC_EDIT_HISTORY_H

#include "edit/document.h"

typedef struct tc_history tc_history;

/* Begins with a state. Errors: TC_E_MEMORY. */
tc_status tc_history_create(tc_history **out, const tc_document *begin, tc_error *err);
void tc_history_destroy(tc_history **history);
/* A new state, copied; what was undone is forgotten. what: "move points", for menus; static memory. gesture: not 0: together with the
 * last push of the same number it is one step (a drag). A state that equals the one at hand adds nothing. Errors: TC_E_MEMORY. */
tc_status tc_history_push(tc_history *history, const tc_document *state, const char *what, unsigned gesture, tc_error *err);
/* The state before, after; NULL: there is none. Borrowed until the next call. */
const tc_document *tc_history_undo(tc_history *history);
const tc_document *tc_history_redo(tc_history *history);
/* What undo, redo would take back or bring; NULL: nothing. */
const char *tc_history_undo_what(const tc_history *history);
const char *tc_history_redo_what(const tc_history *history);
size_t tc_history_bytes(const tc_history *history);

#endif
