/* backend.h: the back end that a test program is told to use: a driver in a context, or the reference. */
#ifndef TC_TESTS_COMMON_BACKEND_H
#define TC_TESTS_COMMON_BACKEND_H

#include "tetcast.h"

enum { BACKEND_SKIPPED = 77 }; /* ctest's SKIP_RETURN_CODE */

/* "osmesa", "egl" (the driver pingpong), "osmesa-compute", "egl-compute" or "reference". */
bool backend_known(const char *name);
/* How to make a renderer of that name, which must be known. */
tc_renderer_options backend_options(const char *name);
/* Makes a renderer of that name. Gives 0, or what the program is to end with: BACKEND_SKIPPED where the context is
 * missing, 1 where one that is installed cannot be used; says why on stdout. */
int backend_open(tc_renderer **out, const char *name);

#endif
