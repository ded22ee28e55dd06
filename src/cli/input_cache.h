/* input_cache.h: --cache and --cache-file: a prepared mesh is kept in a file and found again. */
#ifndef TC_CLI_INPUT_CACHE_H
#define TC_CLI_INPUT_CACHE_H

#include "cli/input.h"
#include "cli/json_out.h"

enum { TC_CACHE_PATH = 4096 };

/* What opening an INPUT took. */
typedef struct tc_input_seen {
    double ms_read;                      /* NAN: nothing was read but a cache file */
    char cache[TC_CACHE_PATH];           /* the cache file; "": none is in use */
    bool hit;                            /* the mesh came from it */
    char why[1024];                      /* if not: why; "": there was none yet */
    double ms_cache_load, ms_cache_save; /* with their keys; NAN: not done */
} tc_input_seen;

/* Gives INPUT's mesh, prepared: from the cache file where one is asked for and holds it, else read and prepared, and then
 * kept in that file. A cache that cannot be used or written is a warning at most. -1 to go on, else the exit code of an
 * error that was printed: *out is then NULL, or the mesh that could not be prepared. */
int tc_input_open(tc_mesh **out, tc_input_seen *seen, const tc_input_options *options, const char *input, tc_talk *talk);

/* "cache" of the statistics: {"file", "hit", "why"?, "load_ms"?, "save_ms"?}; NULL where none is in use. New reference. */
json_t *tc_input_cache_json(const tc_input_seen *seen);

#endif
