/* synth.h: synthetic datasets whose shapes and fields are known in closed form.
 *
 * A generator fills a soup of vertices and tets; synth.c samples its field at the vertices and makes a tc_mesh of it.
 * All meshes are conforming and all tets positive (dot(cross(b-a, c-a), d-a) > 0), for every size and seed. */
#ifndef TC_DATASETS_SYNTHETIC_SYNTH_H
#define TC_DATASETS_SYNTHETIC_SYNTH_H

#include "core/status.h"

/* Vertices and tets on their way into a tc_mesh; free with tc_synth_soup_finish. */
typedef struct tc_synth_soup {
    size_t n_vertex, n_tet;
    double *vertex; /* [n_vertex][3], owned */
    int32_t *tet;   /* [n_tet][4], owned */
} tc_synth_soup;

typedef struct tc_synth_generator {
    size_t default_cells;
    /* About n_cells tets into *out (zeroed by the caller, who frees it also after an error). n_cells is 1..2e9, seed
     * moves vertices and never the shape. Errors: TC_E_MEMORY; TC_E_ARG when 32-bit ids are too few. */
    tc_status (*build)(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err);
    /* The analytic field at point [3]; also what the mesh carries as point data. */
    double (*field)(const double *point);
    /* Length of the whole line origin [3] + t direction [3] (unit length, t of either sign) within the very polyhedron
     * that build makes for n_cells: exact, not the smooth shape that a ball or a cylinder approximates. NAN when memory
     * runs out. NULL: not known. A line that lies in a face of the boundary is on no particular side. */
    double (*chord)(const double *origin, const double *direction, size_t n_cells);
} tc_synth_generator;

/* The generator of that name, or NULL. The name is one of tc_synth_list's. */
const tc_synth_generator *tc_synth_find(const char *name);

void tc_synth_soup_finish(tc_synth_soup *soup);
/* Room for the given counts; checks that ids fit in 32 bits. Errors: TC_E_ARG, TC_E_MEMORY. */
tc_status tc_synth_soup_reserve(tc_synth_soup *soup, size_t n_vertex, size_t n_tet, tc_error *err);

/* A number in [-1, 1) that depends on its arguments alone (splitmix64 of Steele, Lea and Flood 2014). */
double tc_synth_noise(uint64_t seed, uint64_t index);

/* The step h in (0, h_max] whose count(context, h) is nearest to n_cells; count must not grow with h. */
double tc_synth_fit(double (*count)(const void *context, double h), const void *context, size_t n_cells, double h_max);

extern const tc_synth_generator tc_synth_kuhn, tc_synth_heatsink, tc_synth_comb, tc_synth_ball, tc_synth_shells,
    tc_synth_cylinder, tc_synth_bluntfin, tc_synth_spiral, tc_synth_torusknot, tc_synth_tet, tc_synth_two;

#endif
