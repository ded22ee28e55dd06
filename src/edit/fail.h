/* fail.h: errors of the model, as the library's: a code and a sentence. */
#ifndef TC_EDIT_FAIL_H
#define TC_EDIT_FAIL_H

#include "tetcast.h"

/* Fills err (NULL: nobody asks) and gives code. */
__attribute__((format(printf, 3, 4))) tc_status tc_edit_fail(tc_error *err, tc_status code, const char *format, ...);
/* malloc and realloc of n items of a size, checked for overflow; never of no byte. NULL: there is no room. */
void *tc_edit_room(void *old, size_t n, size_t size);
/* TC_E_MEMORY: there is no room for n of what. */
tc_status tc_edit_no_room(tc_error *err, const char *what, size_t n);

#endif
