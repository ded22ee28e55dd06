/* pieces.h: a transfer function as its linear pieces, for integrating a segment piece by piece
 * (gpu/shaders/pieces.glsl).
 *
 * Over x = (s - span[0]) / (span[1] - span[0]). Piece i reaches from end[i].x to end[i + 1].x, ascending, and runs
 * linearly from end[i].above to end[i + 1].below; the first and the last are constant and reach to -/+ TC_PIECE_FAR, so
 * every x lies in a piece. At a step an end has two values: pieces too narrow for float to tell their ends apart are left
 * out. */
#ifndef TC_TRANSFER_FUNCTIONS_PIECES_H
#define TC_TRANSFER_FUNCTIONS_PIECES_H

#include "transfer_functions/transfer.h"

#define TC_PIECE_FAR 1.0e30f

/* Where two pieces meet. Values are r, g, b, attenuation. */
typedef struct tc_piece_end {
    float x, pad[3];
    float below[4], above[4];
} tc_piece_end;

typedef struct tc_pieces {
    size_t n;          /* pieces, 2 at least */
    tc_piece_end *end; /* [n + 1], owned */
    bool steps;        /* some end has two values */
} tc_pieces;

/* The pieces that meet [0, 1] in x, and one on each side. span[1] > span[0]. Errors: TC_E_ARG, TC_E_MEMORY.
 * Cost: O(knots). */
tc_status tc_pieces_build(tc_pieces *out, const tc_transfer *tf, const double span[2], tc_error *err);
void tc_pieces_finish(tc_pieces *pieces);

#endif
