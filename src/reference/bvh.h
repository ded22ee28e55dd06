/* bvh.h: a bounding volume hierarchy over small boxes, for queries along a line. */
#ifndef TC_REFERENCE_BVH_H
#define TC_REFERENCE_BVH_H

#include "core/status.h"

typedef struct tc_bvh_box {
    float lo[3], hi[3];
} tc_bvh_box;

/* count = 0: the children are nodes first and first + 1; else a leaf: items order[first .. first + count). */
typedef struct tc_bvh_node {
    tc_bvh_box box;
    uint32_t first, count;
} tc_bvh_node;

typedef struct tc_bvh {
    size_t n_node;
    tc_bvh_node *node; /* root: node 0 */
    size_t n_item;
    uint32_t *order; /* [n_item] item ids in leaf order */
} tc_bvh;

/* A traversal's stack holds at most this many nodes. */
enum { TC_BVH_STACK = 128 };

/* Binned surface-area heuristic (Wald 2007), leaves of at most 4.
 *   box [n], n < 2^31, borrowed for the call. n = 0 gives an empty hierarchy. The order depends on box alone; the
 * nodes' places may differ from run to run, their boxes do not. Errors: TC_E_MEMORY. Cost: O(n log n), threaded over
 * subtrees; 64 B/item, mostly untouched, given back at the end. */
tc_status tc_bvh_build(tc_bvh *out, const tc_bvh_box *box, size_t n, int threads, tc_error *err);
void tc_bvh_finish(tc_bvh *bvh);

#endif
