/* chord.h: pieces of lines. */
#ifndef TC_DATASETS_SYNTHETIC_CHORD_H
#define TC_DATASETS_SYNTHETIC_CHORD_H

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

#endif
