/* thin.h: a transfer function of fewer knots that hardly differs, for who pays by the knot. */
#ifndef TC_TRANSFER_FUNCTIONS_THIN_H
#define TC_TRANSFER_FUNCTIONS_THIN_H

#include "transfer_functions/transfer.h"

/* *out (tc_transfer_destroy) has knots of tf only, the first and the last among them. At the others it differs by at
 * most `tolerance` in each colour channel and by the share `tolerance` in attenuation. Errors: TC_E_ARG (tolerance < 0
 * or not a number), TC_E_MEMORY. Cost: O(knots) to O(128 knots). */
tc_status tc_transfer_thin(tc_transfer **out, const tc_transfer *tf, double tolerance, tc_error *err);

#endif
