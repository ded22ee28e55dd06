/* locate.h: where helper programs are. */
#ifndef TC_CORE_LOCATE_H
#define TC_CORE_LOCATE_H

#include "core/status.h"

/* Finds an executable regular file `name`, in this order: the folders of $TETCAST_HELPERS (with ':' between them);
 * then, beside the library and beside the executable: ../libexec/tetcast, ../../libexec/tetcast, ../lib/tetcast,
 * tetcast, the folder itself, and its parent (the tests' place in the build tree). *path  absolute path; the caller
 * frees it Errors: TC_E_WORKER with the folders that were searched, TC_E_MEMORY. */
tc_status tc_locate_helper(char **path, const char *name, tc_error *err);

#endif
