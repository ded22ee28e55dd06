/* table_frame.h: what every build of a table over front scalar, back scalar and length rests on: its arguments checked,
 * its memory, the places of its entries, its rows stored in its format, and the slow way to an entry. What the entries
 * hold and how one comes from others is each builder's (table.c, drift.c). */
#ifndef TC_TRANSFER_FUNCTIONS_TABLE_FRAME_H
#define TC_TRANSFER_FUNCTIONS_TABLE_FRAME_H

#include "transfer_functions/segment.h"
#include "transfer_functions/table.h"

typedef float tc_quad __attribute__((vector_size(16))); /* the four floats of an entry */

typedef struct tc_table_frame {
    const tc_table_options *options; /* borrowed for the build */
    tc_table *table;                 /* the caller's */
    size_t n_front, n_back, n_length;
    int threads;
    size_t n_node;               /* the entries along both scalar axes in one ascending list, each place once */
    double *x;                   /* [n_node] place, 0 to 1 */
    int *node_front, *node_back; /* [n_node] entry along s_front, s_back, or -1 */
    size_t *front_node;          /* [n_front] node of an entry */
    tc_segments segments;        /* over these nodes; built by the builder, of the length it needs */
    double start;                /* ms */
} tc_table_frame;

/* Gives *out its shape and memory, all else than the slice of length 0 unset, and fills the frame but for its segments.
 * tc_table_frame_end follows, whatever this returns.
 * Errors: TC_E_ARG for what no table can have, TC_E_MEMORY. Cost: O(n_front n_back) time; 24 bytes an entry of either
 * scalar axis. */
tc_status tc_table_frame_begin(tc_table_frame *frame, tc_table *out, const tc_transfer *tf,
                               const tc_table_options *options, tc_error *err);
/* Frees what the frame owns, its segments among it. The table gets its time, or, unless status is TC_OK, is emptied.
 * Returns status. */
tc_status tc_table_frame_end(tc_table_frame *frame, tc_status status);

/* Rounds row [n_front] to the table's format, to [slice][back] there. In 8 bits values are 0 to 1, in half floats at
 * most 65504. Thread-safe for different rows. */
void tc_table_frame_store(const tc_table_frame *frame, size_t slice, size_t back, const tc_quad *row);

/* Colour and opacity of the segment from x[0] to x[1], put together from n equally long parts, front to back. Each
 * is integrated on its own and has the share `part` of the built length. *hint as for tc_segments_short. */
void tc_table_frame_march(double out[4], const tc_table_frame *frame, const double x[2], int n, double part,
                          size_t *hint);

#endif
