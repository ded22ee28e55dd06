/* writers.h: threads that encode and write pictures while the next one is rendered. */
#ifndef TC_CLI_BATCH_WRITERS_H
#define TC_CLI_BATCH_WRITERS_H

#include "cli/picture/render_write.h"

enum { TC_FRAME_FILES = 6 };

/* The files of one frame, in the order in which they are written: the last one is there only when all are. */
typedef struct tc_frame_files {
    size_t frame;
    int n;
    tc_picture_file file[TC_FRAME_FILES];
} tc_frame_files;
void tc_frame_files_finish(tc_frame_files *files);

/* What became of one frame. */
typedef struct tc_written {
    size_t frame;
    tc_status status; /* of the first file that failed; the others were not written then */
    tc_error err;
    char warning[512]; /* the first that the library had; "": none */
    double ms;
    size_t bytes; /* of all files */
} tc_written;

typedef struct tc_writers tc_writers;

/* n threads, each with a writer of its own; at most `room` frames wait or are written at a time. NULL: memory or
 * threads ran out. */
tc_writers *tc_writers_start(int n, size_t room);
/* Hands a frame over, all of it; waits while there is no room. False: memory ran out, and the frame stays where it is.
 */
bool tc_writers_put(tc_writers *writers, tc_frame_files *files);
/* A frame that is done; wait: until one is. False: none is, or none is under way. */
bool tc_writers_take(tc_written *out, tc_writers *writers, bool wait);
/* Other room from now on; at least 1. */
void tc_writers_set_room(tc_writers *writers, size_t room);
/* Writes what waits, then ends the threads. What was not taken is lost. */
void tc_writers_stop(tc_writers **writers);

#endif
