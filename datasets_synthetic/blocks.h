/* blocks.h: unions of axis-aligned boxes: three sets of planes cut space into blocks, of which some are kept.
 * The cube, the heat sink and the comb are such shapes. */
#ifndef TC_DATASETS_SYNTHETIC_BLOCKS_H
#define TC_DATASETS_SYNTHETIC_BLOCKS_H

#include "synth.h"

enum { TC_BLOCKS_MAX = 128 };

typedef struct tc_blocks {
    int n[3];                           /* blocks along each axis, 1..TC_BLOCKS_MAX */
    double plane[3][TC_BLOCKS_MAX + 1]; /* [axis][n + 1], ascending */
    bool (*keep)(int i, int j, int k);
} tc_blocks;

/* Sets n[axis] and its planes: widths taken in turn from width [n_width], starting at 0. */
void tc_blocks_set_axis(tc_blocks *blocks, int axis, int n, const double *width, int n_width);

/* About n_cells tets: all blocks are divided with one step as nearly as whole numbers allow, and every vertex is moved
 * by up to 0.15 of the local step along those axes along which the shape stays as it is. Tets stay positive: with edge
 * vectors I + E (in steps) each row of |E| sums to at most 0.9 < 1. Errors: TC_E_MEMORY, TC_E_ARG. */
tc_status tc_blocks_build(tc_synth_soup *out, const tc_blocks *blocks, size_t n_cells, uint64_t seed, tc_error *err);

/* Length of the line within the kept blocks; direction has unit length. */
double tc_blocks_chord(const tc_blocks *blocks, const double *origin, const double *direction);

#endif
