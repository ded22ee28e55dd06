/* lattice.h: hexahedral lattices split into tets.
 *
 * TC_SPLIT_KUHN: every cube is cut into the six tets of the paths from its lowest to its highest corner (Kuhn 1960;
 * Freudenthal 1942). All cubes are cut alike, so neighbours agree on their common face, also where the lattice closes
 * on itself. TC_SPLIT_FIVE: a regular tet in the middle of the cube and one at each of the four corners it leaves,
 * cubes of even and odd i + j + k alternating. */
#ifndef TC_DATASETS_SYNTHETIC_LATTICE_H
#define TC_DATASETS_SYNTHETIC_LATTICE_H

#include "synth.h"

typedef enum tc_split { TC_SPLIT_KUHN = 0, TC_SPLIT_FIVE = 1 } tc_split;

typedef struct tc_lattice {
    size_t n[3]; /* cubes along each axis, at least 1; at least 3 (and an even number for TC_SPLIT_FIVE) along axis 0
                    when it wraps */
    bool wrap;   /* the last cube along axis 0 is followed by the first */
    bool (*keep)(const void *context, const size_t *cube); /* NULL: all cubes */
    /* Position out [3] of lattice vertex [3]; must keep the orientation of the lattice's axes. */
    void (*place)(const void *context, double *out, const size_t *vertex);
    const void *context;
    tc_split split;
} tc_lattice;

/* Tets of all kept cubes and the vertices they use, in lattice order. Errors: TC_E_MEMORY, TC_E_ARG (too many for
 * 32-bit ids). Cost: O(cubes), 4 B per lattice vertex of scratch. */
tc_status tc_lattice_build(tc_synth_soup *out, const tc_lattice *lattice, tc_error *err);

#endif
