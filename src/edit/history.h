/* history.h: undo and redo without end: each state that was reached, and a name for what was done. */
#ifndef TC_EDIT_HISTORY_H
#define TC_EDIT_HISTORY_H

#include "edit/document.h"

typedef struct tc_history tc_history;

/* Begins with a state. Errors: TC_E_MEMORY; *out is NULL then. Cost of a history: two copies of a state at the most,
 * and for each step what it changed, before and after: some 250 bytes where one point moved, whatever else the function
 * holds. */
tc_status tc_history_create(tc_history **out, const tc_document *begin, tc_error *err);
void tc_history_destroy(tc_history **history);
/* A new state, copied; what was undone is forgotten. what: "move points", for menus; static memory. gesture: not 0:
 * together with the last push of the same number it is one step (a drag), named as that one, unless there was an undo
 * or redo between; where it leads back to where it began there is no step. A state that equals the one at hand adds
 * nothing. Errors: TC_E_MEMORY; the history is as it was. Cost: O(state). */
tc_status tc_history_push(tc_history *history, const tc_document *state, const char *what, unsigned gesture,
                          tc_error *err);
/* The state before, after, bit by bit as it was pushed; NULL: there is none. Borrowed until the next call; not to be
 * destroyed. */
const tc_document *tc_history_undo(tc_history *history);
const tc_document *tc_history_redo(tc_history *history);
/* What undo, redo would take back or bring; NULL: nothing. */
const char *tc_history_undo_what(const tc_history *history);
const char *tc_history_redo_what(const tc_history *history);
/* All the memory that it holds. Cost: O(steps). */
size_t tc_history_bytes(const tc_history *history);

#endif
