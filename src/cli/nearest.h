/* nearest.h: the known name that a mistyped one most likely means. */
#ifndef TC_CLI_NEAREST_H
#define TC_CLI_NEAREST_H

#include <stddef.h>

/* Edit distance (insert, delete, replace, swap neighbours) of two names; only their first 63 bytes count. */
unsigned tc_name_distance(const char *a, const char *b);

/* A search: start with {name, NULL, 0}, offer every known name, read best (NULL when none was offered). */
typedef struct tc_nearest {
    const char *name, *best;
    unsigned distance;
} tc_nearest;
void tc_nearest_offer(tc_nearest *search, const char *known);

#endif
