/* file.h: files that appear whole or not at all. */
#ifndef TC_CORE_FILE_H
#define TC_CORE_FILE_H

#include "core/status.h"

/* Writes bytes to path: beside it under a temporary name, then renamed, so that a reader never sees half a file and a
 * failure leaves what was there. A symbolic link is followed; a device or a pipe is written to directly; an existing
 * file keeps its mode. Errors: TC_E_FILE naming path, reason and remedy. */
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
