/* watch.h: GL's debug output (KHR_debug, core in 4.3) as errors. For developers: a context of our own is watched where
 * the environment says TETCAST_GL_DEBUG=1; otherwise gl->watch is NULL and nothing is asked of GL. */
#ifndef TC_GPU_WATCH_H
#define TC_GPU_WATCH_H

#include "gpu/gl.h"

/* TETCAST_GL_DEBUG is set, and to something else than 0. */
bool tc_gl_watch_wanted(void);
/* Listens to the debug output of the context that is current, whose functions gl holds, in the calling thread and at
 * once. Errors: TC_E_GL (no debug output: names the function), TC_E_MEMORY. */
tc_status tc_gl_watch_begin(tc_gl *gl, tc_get_proc get_proc, tc_error *err);
/* Frees what tc_gl_watch_begin made. The context is gone, or never current again. */
void tc_gl_watch_end(tc_gl *gl);

/* TC_E_GL with the first message since the last check that is an error, undefined behaviour, deprecated, not portable
 * or of high severity. GL's other messages are no errors. `what` says what was being done. For tc_gl_check. */
tc_status tc_gl_watch_check(const tc_gl *gl, const char *what, tc_error *err);
/* Gives the messages about performance since the last call to log: the first one, and how many there were. */
void tc_gl_watch_say(const tc_gl *gl, const tc_log *log);

#endif
