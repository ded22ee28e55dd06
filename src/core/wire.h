/* wire.h: the frames that worker.c and serve.c exchange; used by these two and by helper programs only.
 *
 * A frame is u32 magic, u32 length of the JSON text, u32 number of descriptors (0 or 1), all in the machine's byte
 * order, then the text. The descriptor travels with the frame's first byte and holds the arrays, each at a multiple of
 * 64 bytes. Nothing that comes in is believed: lengths are capped, offsets are checked against the mapping. */
#ifndef TC_CORE_WIRE_H
#define TC_CORE_WIRE_H

#include "core/worker.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The helper's end of the socket, and the variable that carries its memory limit in bytes. */
#define TC_WIRE_SOCKET 3
#define TC_WIRE_MEMORY "TETCAST_HELPER_MEMORY"

/* Bytes of one element. */
size_t tc_wire_type_size(tc_array_type type);

/* An empty file without a name, CLOEXEC: a memfd, else an unlinked file in $TMPDIR or /tmp. -1 and errno on failure. */
int tc_wire_file(void);

/* A JSON string of any bytes: what is not UTF-8 becomes '?'. NULL only when memory is out. */
json_t *tc_wire_string(const char *text);

/* Peak resident bytes of this process, 0 when the system does not say. Not getrusage, whose maximum a spawned helper
 * takes over from its parent. */
size_t tc_wire_peak_bytes(void);

/* A frame on its way out. */
typedef struct tc_wire_out {
    unsigned char *frame; /* [size]; owned */
    size_t size, sent;
    int fd; /* owned; -1: none */
} tc_wire_out;

/* Packs message (borrowed; "arrays" is set in a copy) and the arrays, which are copied once into a file without a name.
 * Errors: TC_E_MEMORY, TC_E_ARG (text that is too long). */
tc_status tc_wire_pack(tc_wire_out *out, json_t *message, const tc_array *array, size_t n_array, tc_error *err);

typedef enum tc_wire_state {
    TC_WIRE_DONE,   /* the frame is through */
    TC_WIRE_AGAIN,  /* MSG_DONTWAIT: call again when the socket is ready */
    TC_WIRE_CLOSED, /* the other side is gone */
    TC_WIRE_BROKEN  /* not a frame, or memory is out; err says which */
} tc_wire_state;

/* Sends what is left of the frame; flags as of sendmsg. Never raises SIGPIPE. */
tc_wire_state tc_wire_send(tc_wire_out *out, int socket, int flags, tc_error *err);
void tc_wire_out_finish(tc_wire_out *out);

/* A frame on its way in; zero-initialise with tc_wire_in_init. */
typedef struct tc_wire_in {
    uint32_t header[3];
    size_t have; /* bytes of header and text that are here */
    char *text;  /* [header[1]]; owned */
    int fd;      /* owned; -1: none */
} tc_wire_in;

void tc_wire_in_init(tc_wire_in *in);
/* Receives until one frame is complete. CLOSED in the midst of a frame fills err, too. */
tc_wire_state tc_wire_receive(tc_wire_in *in, int socket, int flags, tc_error *err);
/* Parses the complete frame, maps its arrays, and makes `in` ready for the next one. Errors: TC_E_WORKER (what is wrong
 * with it), TC_E_MEMORY. */
tc_status tc_wire_open(tc_reply *out, tc_wire_in *in, tc_error *err);
void tc_wire_in_finish(tc_wire_in *in);

#ifdef __cplusplus
}
#endif
#endif
