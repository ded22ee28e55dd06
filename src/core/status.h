/* status.h: making and passing errors.
 * tc_status and tc_error are in tetcast.h; these are the tools of those who fill them. */
#ifndef TC_CORE_STATUS_H
#define TC_CORE_STATUS_H

#include "tetcast.h"

#if defined(__GNUC__)
#define TC_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define TC_PRINTF(f, a)
#endif

/* Fills *err (NULL allowed) with a printf sentence and gives code back: `return tc_fail(err, TC_E_ARG, "…", …);`
 * Here and below, control characters (of names and words from files) become '?' or blanks: it stays one line. */
tc_status tc_fail(tc_error *err, tc_status code, const char *format, ...) TC_PRINTF(3, 4);
/* Puts a prefix before the sentence that is there. Gives err's code back (code when err is NULL). */
tc_status tc_fail_prefix(tc_error *err, tc_status code, const char *format, ...) TC_PRINTF(3, 4);

/* Sends one printf line to log (NULL allowed, as are its functions). */
void tc_say(const tc_log *log, tc_level level, const char *format, ...) TC_PRINTF(3, 4);
void tc_progress(const tc_log *log, const char *what, double fraction);

#endif
