/* transfer_make.h: transfer functions of knots, and random numbers to try them with. Include after cmocka. */
#ifndef TC_TESTS_UNIT_TRANSFER_MAKE_H
#define TC_TESTS_UNIT_TRANSFER_MAKE_H

#include "transfer_functions/transfer.h"

/* tc_transfer_from_knots, or the test fails. */
static inline tc_transfer *make(const tc_knot *knot, size_t n)
{
    tc_transfer *tf = NULL;
    tc_error err = {0};
    if (tc_transfer_from_knots(&tf, knot, n, &err) != TC_OK)
        fail_msg("%s", err.text);
    return tf;
}

/* From 0 to below 1, uniform. */
static inline double random01(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 11) * 0x1p-53;
}

#endif
