/* pieces.h: a transfer function as its linear pieces, for integrating a segment piece by piece
 * (gpu/shaders/integrate_exact.glsl).
 *
 * Over x = (s - span[0]) / (span[1] - span[0]). Piece i reaches from x_i to x_{i+1} = its `to`, ascending; the first
 * and the last are constant and reach to -/+ TC_PIECE_FAR, so every x lies in a piece. A step is where two pieces meet
 * with different values: pieces too narrow for float to tell their ends apart are left out. */
#ifndef TC_TRANSFER_FUNCTIONS_PIECES_H
#define TC_TRANSFER_FUNCTIONS_PIECES_H

#include "transfer_functions/transfer.h"

#define TC_PIECE_FAR 1.0e30f

typedef struct tc_piece {
    float from, to, pad[2];
    float value[4]; /* r, g, b, attenuation at from */
    float slope[4]; /* of them, per x */
} tc_piece;

typedef struct tc_pieces {
    size_t n;        /* 2 at least */
    tc_piece *piece; /* [n], owned */
} tc_pieces;

/* The pieces that meet [0, 1] in x, and one on each side. span[1] > span[0]. Errors: TC_E_ARG, TC_E_MEMORY.
 * Cost: O(knots). */
tc_status tc_pieces_build(tc_pieces *out, const tc_transfer *tf, const double span[2], tc_error *err);
void tc_pieces_finish(tc_pieces *pieces);

#endif
