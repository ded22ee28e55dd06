/* sort.h: items by 64-bit keys. */
#ifndef TC_MESH_SORT_H
#define TC_MESH_SORT_H

#include "core/status.h"

/* Sorts key [n] ascending and carries id [n] along; stable, so that the result does not depend on the threads (0: all cores).
 * Errors: TC_E_MEMORY (12 B an item of scratch). Cost: O(n) by radix. */
tc_status tc_sort_keys(uint64_t *key, uint32_t *id, size_t n, int threads, tc_error *err);

#endif
