/* chord.h: pieces of lines. */
#ifndef TC_DATASETS_SYNTHETIC_CHORD_H
#define TC_DATASETS_SYNTHETIC_CHORD_H

#include <stddef.h>

/* The part [t0, t1] of a line that is left; empty when t1 <= t0. */
typedef struct tc_span {
    double t0, t1;
} tc_span;

/* The whole line. */
tc_span tc_span_whole(void);
double tc_span_length(tc_span span);
/* Keeps what lies behind the plane through a, b, c, whose outward side sees them counter-clockwise. */
void tc_span_clip(tc_span *span, const double *origin, const double *direction, const double *a, const double *b,
                  const double *c);

/* Length of the line within the box. A line that lies in a face of it is inside where that face is a lower one and
 * outside where it is an upper one, so that of two boxes that touch one counts it. */
double tc_chord_box(const double lo[3], const double hi[3], const double *origin, const double *direction);
/* The same for [0, 1]^3, whatever n_cells is: tc_synth_generator.chord of everything that is a unit cube. */
double tc_chord_unit_cube(const double *origin, const double *direction, size_t n_cells);
/* Length of the line within a tet of positive volume. */
double tc_chord_tet(const double *a, const double *b, const double *c, const double *d, const double *origin,
                    const double *direction);

#endif
