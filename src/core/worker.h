/* worker.h: runs a helper program and talks to it (docs/architecture.md, "Helper programs").
 *
 * A helper is a separate executable (tetcast-read, tetcast-convexify, tetcast-image). The two sides talk over a
 * SOCK_SEQPACKET-free byte stream (socketpair AF_UNIX, SOCK_STREAM) that is the helper's descriptor 3. Each message is
 * a frame: u32 magic, u32 length of the JSON text, u32 number of descriptors (0 or 1), then the text; a descriptor
 * (memfd, or an unlinked temporary file) travels with SCM_RIGHTS and holds all arrays of the message one after another.
 * The JSON of a message with arrays has "arrays": [{"name": …, "type": "f64|f32|i32|i64|u8", "count": N, "offset": B}].
 * A request has "do". Replies have "reply": "progress" {"what","fraction"}, "say" {"level","text"}, "error" {"text"} or
 * "result" (the last one; anything else it likes, plus "peak_bytes": peak resident memory of the helper).
 * The library side knows the helper only through this file; the helper side is wire.h + serve.h. */
#ifndef TC_CORE_WORKER_H
#define TC_CORE_WORKER_H

#include "core/status.h"

#include <jansson.h>

typedef struct tc_worker tc_worker;

typedef enum tc_array_type { TC_F64, TC_F32, TC_I32, TC_I64, TC_U8 } tc_array_type;

/* One array of a message, borrowed when sent, pointing into the reply's mapping when received. */
typedef struct tc_array {
    const char *name;
    tc_array_type type;
    size_t count; /* elements */
    const void *data;
} tc_array;

/* As memory_bytes: seven eighths of the memory of the machine (or, where that is less, of what Linux's control groups,
 * version 2, allow the program), so that a damaged count in a file does not push everything else out. */
#define TC_WORKER_MACHINE SIZE_MAX

typedef struct tc_worker_limits {
    double total_s;       /* a request may take this long; 0: no limit */
    double idle_s;        /* … without a message; 0: no limit */
    size_t memory_bytes;  /* RLIMIT_AS of the helper, set by itself; 0: none; ignored in sanitizer builds */
} tc_worker_limits;

typedef struct tc_reply {
    json_t *json;        /* the "result" message; owned */
    size_t n_array;
    tc_array *array;     /* owned; data lies in map */
    void *map;           /* private, writable mapping; owned */
    size_t map_bytes;
    size_t peak_bytes;   /* of the helper */
} tc_reply;

/* Starts helper `name` ("tetcast-read"): $TETCAST_HELPERS, then ../libexec/tetcast and . beside the library (dladdr) and
 * the executable, then the build tree. Errors: TC_E_WORKER, naming the program and the places searched. */
tc_status tc_worker_start(tc_worker **out, const char *name, const tc_worker_limits *limits, tc_error *err);
/* Sends a request and waits for its result; progress and talk go to log. The helper serves any number of requests.
 * Errors: TC_E_FILE with the helper's own sentence ("error" reply; the helper lives on), TC_E_WORKER when it died
 * ("tetcast-convexify ended with signal 11 …"), exceeded a limit ("… made no progress for 60 s and was stopped") or broke
 * the protocol; it is then reaped and cannot be used again. TC_E_MEMORY. */
tc_status tc_worker_call(tc_reply *out, tc_worker *worker, json_t *request /* borrowed */, const tc_array *array,
                         size_t n_array, const tc_log *log, tc_error *err);
void tc_worker_stop(tc_worker **worker); /* closes the socket, waits, kills if needed */

/* The array of that name and type, or NULL. */
const tc_array *tc_reply_array(const tc_reply *reply, const char *name, tc_array_type type);
void tc_reply_finish(tc_reply *reply);

/* Peak resident bytes over all helpers so far. */
size_t tc_worker_peak_bytes(void);

#endif
