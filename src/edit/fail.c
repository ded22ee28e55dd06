/* fail.c: errors of the model, and memory that may run out. */
#include "edit/fail.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

tc_status tc_edit_fail(tc_error *err, tc_status code, const char *format, ...)
{
    if (err) {
        va_list rest;
        va_start(rest, format);
        vsnprintf(err->text, sizeof err->text, format, rest);
        va_end(rest);
        err->code = code;
    }
    return code;
}

void *tc_edit_room(void *old, size_t n, size_t size)
{
    if (n == 0)
        n = 1;
    return size > SIZE_MAX / n ? NULL : realloc(old, n * size);
}

tc_status tc_edit_no_room(tc_error *err, const char *what, size_t n)
{
    return tc_edit_fail(err, TC_E_MEMORY, "memory ran out for %zu %s; close other programs and try again", n, what);
}
