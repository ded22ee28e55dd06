/* serve.h: the helper's side of worker.h: a C interface that the C++ helper programs are written against.
 *
 *   int main(int argc, char **argv) { return tc_serve_main(argc, argv, "tetcast-read", handle, NULL); }
 */
#ifndef TC_CORE_SERVE_H
#define TC_CORE_SERVE_H

#include "core/worker.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tc_serve tc_serve;

/* Strings for json_* must be UTF-8; tc_wire_string (core/wire.h) makes a JSON string of any bytes. The tc_serve_*
 * functions below take any bytes, and belong to the thread that runs the request. What a helper prints on its standard
 * output or error is kept by the library; the last line goes into the error sentence when the helper dies. */

/* One request: json with "do", its arrays (borrowed). Ends with exactly one tc_serve_result or tc_serve_error; when it
 * returns without, an error is sent for it. C++ exceptions must not leave it. */
typedef void tc_serve_function(void *context, tc_serve *serve, json_t *request, const tc_array *array, size_t n_array);

/* Serves until the socket closes. Run by hand (no descriptor 3) it prints what it is and gives 2. */
int tc_serve_main(int argc, char **argv, const char *name, tc_serve_function *handle, void *context);

void tc_serve_progress(tc_serve *serve, const char *what, double fraction); /* throttled; also the sign of life */
void tc_serve_say(tc_serve *serve, tc_level level, const char *text);
void tc_serve_error(tc_serve *serve, const char *text);
/* result is borrowed ("reply", "arrays", "peak_bytes" are set in it). */
void tc_serve_result(tc_serve *serve, json_t *result, const tc_array *array, size_t n_array);

#ifdef __cplusplus
}
#endif
#endif
