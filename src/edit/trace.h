/* trace.h: what happened when, as a file that chrome://tracing and Perfetto show (Trace Event Format, "X" and "i"
 * events). */
#ifndef TC_EDIT_TRACE_H
#define TC_EDIT_TRACE_H

#include "tetcast.h"

typedef struct tc_trace tc_trace;

/* path NULL: a trace that keeps nothing, so that callers need not ask. Else nothing is at path before the trace is
 * closed, but that a file can be made beside it is tried. Events are kept in memory, 56 bytes each. Errors:
 * TC_E_MEMORY, TC_E_FILE; *out is NULL then. */
tc_status tc_trace_open(tc_trace **out, const char *path, tc_error *err);
/* Does it keep anything? */
bool tc_trace_keeps(const tc_trace *trace);
/* Milliseconds of a monotonic clock. */
double tc_trace_now(void);
/* From any thread. what, key: static texts; key NULL: no value; a value that is not finite is left out. id: what
 * belongs to one change has one number; 0: none. Where memory runs out events are lost, and the file says how many.
 * Cost: some 50 ns. */
void tc_trace_span(tc_trace *trace, const char *what, double begin_ms, double end_ms, unsigned id, const char *key,
                   double value);
void tc_trace_mark(tc_trace *trace, const char *what, unsigned id, const char *key, double value);
/* Writes the file, whole or not at all, and frees the trace, whatever happens; no other thread may still use it. Times
 * are in microseconds of tc_trace_now's clock, threads are numbered as they came. Errors: TC_E_FILE, TC_E_MEMORY. */
tc_status tc_trace_close(tc_trace **trace, tc_error *err);

#endif
