/* view_keys.h: one camera of a scene's views, or a key of a path, from JSON. */
#ifndef TC_CLI_BATCH_VIEW_KEYS_H
#define TC_CLI_BATCH_VIEW_KEYS_H

#include "cli/batch/views.h"

/* Adds what json says to *out, which must be all zeros before. name: gets the camera's, which the caller frees, or
 * stays; NULL: it is a path's key, which has a time instead. where: how errors name it, as "views[2]". -1, or the exit
 * code of an error that was printed: it names the key, and of an unknown one the nearest. */
int tc_view_keys_read(tc_view_keys *out, char **name, const json_t *json, const char *where, tc_talk *talk);

#endif
