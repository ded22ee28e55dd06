/* file.h: files that appear whole or not at all. */
#ifndef TC_CORE_FILE_H
#define TC_CORE_FILE_H

#include "core/status.h"

/* A file on its way. Where the file system can (O_TMPFILE), it has no name until it is whole, so that nothing of it
 * stays when the process is killed; it then gets its target's name, or, where that is taken, the name
 * ".tetcast-NAME.tmp" beside it, and is renamed at once. Elsewhere (network file systems) it is written under that name
 * from the start. That name is a function of the target's alone (with a hash of NAME where it is too long), and who
 * writes has a lock on the file: what a killed process left there is taken over or removed by the next one that writes
 * the target; nobody else removes it. A second writer of one target at the same time takes
 * ".tetcast-PROCESS-TIME-N.tmp"; the last one that ends wins, and each file is whole. A symbolic link is followed; a
 * device or a pipe is written to directly; an existing file's mode is kept. */
typedef struct tc_file_draft {
    int fd;       /* to be written to, and read from unless direct; its owner is the draft */
    bool direct;  /* a device or a pipe: what is written is out */
    bool named;   /* it lies at part */
    bool replace; /* target was there at the start, with this mode */
    unsigned mode;
    char *path, *target, *part; /* as it was given; what a link led to; the name beside it. NULL path: no draft */
} tc_file_draft;

/* Begins a file; on failure *out is no draft. Errors: TC_E_FILE naming path, reason and remedy, TC_E_MEMORY. */
tc_status tc_file_draft_open(tc_file_draft *out, const char *path, tc_error *err);
/* The same as where the file system has no files without names; for tests. */
tc_status tc_file_draft_open_named(tc_file_draft *out, const char *path, tc_error *err);
/* The file appears under its name. Ends the draft, whatever happens. Errors: TC_E_FILE. */
tc_status tc_file_draft_keep(tc_file_draft *draft, tc_error *err);
/* Nothing of it stays; what was there stays. Nothing happens to what is no draft. */
void tc_file_draft_drop(tc_file_draft *draft);
/* Another program failed to write to fd: is there no room for more? Then says so as tc_file_write does (TC_E_FILE);
 * else TC_OK. Puts bytes at the end of the file, which is to be dropped. */
tc_status tc_file_draft_full(const tc_file_draft *draft, tc_error *err);

/* Writes bytes to path as a draft, so that a reader never sees half a file and a failure leaves what was there. Errors:
 * TC_E_FILE naming path, reason and remedy, TC_E_MEMORY. */
tc_status tc_file_replace(const char *path, const void *data, size_t bytes, tc_error *err);

/* The same of several pieces of memory, one after the other. */
typedef struct tc_file_part {
    const void *data; /* NULL where bytes is 0 */
    size_t bytes;
} tc_file_part;
tc_status tc_file_replace_parts(const char *path, const tc_file_part *part, size_t n, tc_error *err);

/* Writes all bytes to an open descriptor; `name` is for the error sentence. Errors: TC_E_FILE. */
tc_status tc_file_write(int fd, const void *data, size_t bytes, const char *name, tc_error *err);

/* Reads a whole file into *data (the caller frees it). Errors: TC_E_FILE, TC_E_MEMORY. */
tc_status tc_file_read(void **data, size_t *bytes, const char *path, tc_error *err);

#endif
