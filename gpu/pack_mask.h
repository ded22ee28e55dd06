/* pack_mask.h: a bit for each real cell, for the GPU. No GL call in it.
 *
 * A mask is uint32_t words, (n_tet + 31) / 32 of them, at least one; cell i is bit i & 31 of word i >> 5; bits beyond
 * the last cell are 0. The caller frees it with free(). threads: 0, all cores; results do not depend on them. */
#ifndef TC_GPU_PACK_MASK_H
#define TC_GPU_PACK_MASK_H

#include "mesh/mesh.h"

/* Which cells all of select [n] keep (tc_select in tetcast_look.h); n = 0: all.
 *   kept  their number; may be NULL
 * The mesh must be prepared, select what tc_look_wrong lets pass. Errors: TC_E_MEMORY.
 * Cost: for each of select 4 to 7 ns a cell on one core; with many ranges it grows by their logarithm. */
tc_status tc_pack_mask_select(uint32_t **out, size_t *kept, const tc_mesh *mesh, const tc_select *select, size_t n,
                              int threads, tc_error *err);

/* Which cells are transparent under a function: for every scalar from the least to the greatest that a cell holds (with
 * cell data for the one) its attenuation is 0, at a step on both sides. Nothing but attenuation is looked at:
 * isosurfaces and models that do not use it may well find something there. A cell of which a value is not finite is not
 * among them: it has no range, and may have a colour of its own (nan_color). n_empty  their number; may be NULL The
 * mesh must be prepared. Errors: TC_E_MEMORY. Cost: some 2 ns a cell on one core, 4 B a vertex while it runs. */
tc_status tc_pack_mask_empty(uint32_t **out, size_t *n_empty, const tc_mesh *mesh, const tc_transfer *transfer,
                             int threads, tc_error *err);

#endif
