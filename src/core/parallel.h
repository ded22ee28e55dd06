/* parallel.h: loops over all cores, and a clock. */
#ifndef TC_CORE_PARALLEL_H
#define TC_CORE_PARALLEL_H

#include <stddef.h>

/* Works on items [begin, end); worker is 0..threads-1, for scratch of one's own. */
typedef void tc_range_function(void *context, size_t begin, size_t end, int worker);

/* Number of threads for a request (0: all cores this process may use); at least 1. */
int tc_threads(int request);
/* Calls body over [0, n) in chunks of `chunk` items, handed out in order, on `threads` threads (0: all cores).
 * Returns when all is done. Falls back to fewer threads when none can be started. */
void tc_parallel_for(size_t n, size_t chunk, int threads, tc_range_function *body, void *context);

/* Monotonic milliseconds. */
double tc_now_ms(void);

#endif
