/* memory.c: allocation with checked sizes. */
#include "core/memory.h"

#include <stdlib.h>
#include <string.h>

static bool product(size_t *out, size_t n, size_t size)
{
    if (__builtin_mul_overflow(n, size, out))
        return false;
    if (*out == 0)
        *out = 1;
    return true;
}

void *tc_alloc(size_t n, size_t size)
{
    size_t bytes;
    return product(&bytes, n, size) ? malloc(bytes) : NULL;
}

void *tc_calloc(size_t n, size_t size)
{
    size_t bytes;
    return product(&bytes, n, size) ? calloc(1, bytes) : NULL;
}

void *tc_realloc(void *p, size_t n, size_t size)
{
    size_t bytes;
    return product(&bytes, n, size) ? realloc(p, bytes) : NULL;
}

char *tc_strdup(const char *text)
{
    if (!text)
        return NULL;
    size_t n = strlen(text) + 1;
    char *copy = tc_alloc(n, 1);
    if (copy)
        memcpy(copy, text, n);
    return copy;
}

tc_status tc_fail_memory(tc_error *err, const char *what, size_t n, size_t size)
{
    return tc_fail(err, TC_E_MEMORY, "out of memory: %s needs %.1f MiB; close other programs or use a smaller mesh", what,
                   (double)n * (double)size / 1048576.0);
}
