/* drift.h: the three-dimensional table of what running integrals leave out of a segment's colour.
 *
 * The colour of a segment over its opacity lies between the colours it meets. For no length it is the mean
 *   K0 = ∫ tau c dx / ∫ tau dx,
 * which running integrals give (means.h); the longer the segment, the more it takes from its front. The table holds
 * that drift, K - K0, over front scalar, back scalar and length. It vanishes with the length and where nothing is
 * absorbed, so it is smooth where colour and opacity are not, and what is left of it by interpolation counts by the
 * segment's opacity.
 *
 * Lengths are those of a floating-point number, in units of length_max / tc_drift_length(last entry): entries up to
 * 2 octave lie 1 apart, the next `octave` ones 2, then 4, … */
#ifndef TC_TRANSFER_FUNCTIONS_DRIFT_H
#define TC_TRANSFER_FUNCTIONS_DRIFT_H

#include "transfer_functions/table.h"

/* Entries in an octave of a length axis of n entries: a power of two. */
int tc_drift_octave(int n);
/* Length of an entry, in units; 0 for entry 0, at most 2^9 octave. */
double tc_drift_length(int entry, int octave);

/* rgba [size[2]][size[1]][size[0]][4]: K - K0 by channel; the fourth is 0.
 * s_front runs fastest. options->format: 16F or 32F (AUTO: 16F); entry_by_entry: each entry integrated on its own,
 * sampled length_max / (size[2]-1) apart. base_error: the largest term left out of the base slices' series.
 * Errors: TC_E_ARG, TC_E_MEMORY. Cost: O(size product) time, threaded over octave of them; scratch of 72 bytes
 * times s_front * s_back, and 40 per thread. Where a segment of length_max has optical depth d, about
 * log2(16 d / 2^octaves) slices more than the table has are computed per `octave` entries. */
tc_status tc_drift_build(tc_table *out, const tc_transfer *tf, const tc_table_options *options, tc_error *err);

#endif
