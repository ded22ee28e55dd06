/* memory.h: allocation with checked sizes. */
#ifndef TC_CORE_MEMORY_H
#define TC_CORE_MEMORY_H

#include "core/status.h"

/* n*size bytes, not zeroed / zeroed; NULL on overflow or when memory is out. n = 0 gives a valid pointer. free() ends it. */
void *tc_alloc(size_t n, size_t size);
void *tc_calloc(size_t n, size_t size);
/* Grows or shrinks; on failure NULL and p stays valid. */
void *tc_realloc(void *p, size_t n, size_t size);
char *tc_strdup(const char *text); /* NULL for NULL */
/* "out of memory: WHAT needs N bytes" as TC_E_MEMORY. */
tc_status tc_fail_memory(tc_error *err, const char *what, size_t n, size_t size);

#endif
