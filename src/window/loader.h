/* loader.h: reads and prepares data on a thread, and hands them to the session on the main thread. */
#ifndef TC_WINDOW_LOADER_H
#define TC_WINDOW_LOADER_H

#include "window/session.h"

/* Begins to read what the session's options name; the session is busy until it has been told that the data are there,
 * or why they are not (said), when all is as it was. One at a time; false, and the sentence in said: it could not
 * begin. */
bool tc_loader_start(tc_session *session);
/* The same with another array (NAME, NAME:COMPONENT, NAME:magnitude), or step of the file. */
bool tc_loader_field(tc_session *session, const char *field, tc_association association);
bool tc_loader_step(tc_session *session, int step);
/* Counts the values anew, weighted as by_volume says, on a thread; TC_CHANGE_SELECTION is told when it is done. */
void tc_loader_histogram(tc_session *session);

#endif
