/* octa.h: balls and shells made of an octahedral lattice.
 *
 * The points with |i| + |j| + |k| <= n, cut into tets of the A3 lattice alike in all octants (mirror images of each
 * other), are moved along their rays from |i| + |j| + |k| = level to the sphere of that level's radius. Between two
 * levels l and l + 1 lie 8 (3 l (l + 1) + 1) tets, none of which crosses a level, so any set of layers is a mesh. */
#ifndef TC_DATASETS_SYNTHETIC_OCTA_H
#define TC_DATASETS_SYNTHETIC_OCTA_H

#include "synth.h"

typedef struct tc_octa {
    int n_shell;     /* 1..4 */
    double r[4][2];  /* inner and outer radius of each shell, ascending; an inner radius of 0 makes a ball */
    int level[4][2]; /* their levels; set by tc_octa_resolve */
    double grid;     /* above 0: vertices stay on the lattice of this spacing, unmoved, and r is grid * level */
} tc_octa;

/* Chooses the levels for about n_cells tets. */
void tc_octa_resolve(tc_octa *octa, size_t n_cells);
/* The mesh; inner vertices are moved a little. Errors: TC_E_MEMORY, TC_E_ARG. */
tc_status tc_octa_build(tc_synth_soup *out, const tc_octa *octa, uint64_t seed, tc_error *err);
/* Length of the line within the polyhedra (each level is convex). Cost: O(triangles of all surfaces). */
double tc_octa_chord(const tc_octa *octa, const double *origin, const double *direction);

#endif
