/* prism.h: upright shapes over a strip between two plane curves: the cylinder with a hole, the blunt fin, the spiral.
 */
#ifndef TC_DATASETS_SYNTHETIC_PRISM_H
#define TC_DATASETS_SYNTHETIC_PRISM_H

#include "synth.h"

typedef struct tc_prism {
    double length[3]; /* typical lengths along the strip, across it and up: their ratios give those of the divisions */
    size_t n_min;     /* least number of divisions along the strip */
    bool wrap;        /* the strip closes on itself */
    /* Where the inner and the outer curve are at u; wrap: of period 1, else u in [0, 1]. With increasing u the outer
     * curve lies on the left. */
    void (*curve)(double *inner, double *outer, double u);
    double (*across)(double t); /* 0..1 to 0..1, growing: spacing from the inner to the outer curve */
    double (*up)(double t);     /* 0..1 to z, growing */
} tc_prism;

/* About n_cells tets. The curves become polygons; vertices are moved by up to 0.1 of a division within them. Errors:
 * TC_E_MEMORY, TC_E_ARG. */
tc_status tc_prism_build(tc_synth_soup *out, const tc_prism *prism, size_t n_cells, uint64_t seed, tc_error *err);

/* Length of the line within that polyhedron; NAN when memory runs out. */
double tc_prism_chord(const tc_prism *prism, const double *origin, const double *direction, size_t n_cells);

#endif
