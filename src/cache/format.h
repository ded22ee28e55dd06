/* format.h: the layout of a cache file.
 *
 * A head, then parts without gaps: description (counts, report, what the file held), vertex, tet, neighbour, scalar,
 * vertex_of_source, tet_of_source, each as it lies in memory. Each part has its hash in the head, the head its own at its
 * end: nothing of a file that was cut short or damaged is used. */
#ifndef TC_CACHE_FORMAT_H
#define TC_CACHE_FORMAT_H

#include "core/hash.h"

/* To be raised with every change of the layout, or of what tc_mesh_read or tc_mesh_prepare make of a file. */
#define TC_CACHE_FORMAT 2
#define TC_CACHE_MAGIC "tccache\n"
#define TC_CACHE_ORDER 0x01020304u /* reads otherwise on a machine of another byte order */

enum { TC_CACHE_PARTS = 7 };

typedef struct tc_cache_head {
    char magic[8];
    uint32_t format, order;
    tc_cache_key key;
    uint64_t bytes[TC_CACHE_PARTS];
    tc_hash hash[TC_CACHE_PARTS];
    tc_hash own; /* of all before it */
} tc_cache_head;

#endif
