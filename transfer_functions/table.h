/* table.h: the three-dimensional pre-integrated density-emitter table, built incrementally.
 * Weiler et al. 2003, section 4, equations 3 to 6 and figure 6. */
#ifndef TC_TRANSFER_FUNCTIONS_TABLE_H
#define TC_TRANSFER_FUNCTIONS_TABLE_H

#include "transfer_functions/transfer.h"

typedef struct tc_table_options {
    int size[3];            /* entries along s_front, s_back, length; each >= 2 */
    double span[2];         /* scalar at the first and last s entry (both ends are entries) */
    double length_max;      /* length of the last entry, in unit distances: a * length is optical depth */
    tc_table_format format; /* 8, 16F or 32F (AUTO: 16F) */
    bool entry_by_entry; /* each entry integrated on its own, same samples per delta-l: the slow way, for comparison */
    int threads;         /* 0: all cores */
} tc_table_options;

/* rgba [size[2]][size[1]][size[0]][4] in the format's type (uint8_t, IEEE half as uint16_t, float): associated colour
 * and opacity; entry k along length is length_max * k / (size[2]-1), so slice 0 is zero. s_front runs fastest. */
typedef struct tc_table {
    void *rgba;
    size_t bytes;
    tc_table_format format;
    int size[3];
    double span[2], length_max;
    double ms;
    double base_error; /* stated accuracy of the base slice's quadrature */
} tc_table;

/* Scalars outside span are not known to the table: give a span that holds the field's range as well as the knots, or
 * clamp both ends. Errors: TC_E_ARG, TC_E_MEMORY. Cost: O(size product) time, threaded over s_back; scratch of 16 bytes
 * times s_front * (s_front log2(length) + s_back + length/2 per thread). */
tc_status tc_table_build(tc_table *out, const tc_transfer *tf, const tc_table_options *options, tc_error *err);
void tc_table_finish(tc_table *table);

#endif
