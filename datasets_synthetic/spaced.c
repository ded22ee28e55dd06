/* spaced.c: the unit cube, cut by planes of very unequal distances into a Kuhn lattice. Where thick and thin layers
 * alternate along one axis, every tet in a thin layer has two vertices close together (a wedge); where they do along
 * two axes, the tets in the crossings are needles. Graded: distances from 1e-6 to about 1/5 along all three axes. */
#include "box.h"
#include "chord.h"
#include "core/memory.h"

#include <math.h>
#include <stdlib.h>

typedef struct planes {
    size_t n;
    double *x[3]; /* [n + 1] each, from 0 to 1 */
} planes;

/* Widths from 1 down to least, as a share of the widest, in some order. */
typedef double width_of(size_t i, size_t n, double least);

static double even(size_t i, size_t n, double least)
{
    (void)i, (void)n, (void)least;
    return 1;
}

static double alternating(size_t i, size_t n, double least)
{
    (void)n;
    return i % 2 ? least : 1;
}

static double geometric(size_t i, size_t n, double least)
{
    return n > 1 ? pow(least, (double)(n - 1 - i) / (double)(n - 1)) : 1;
}

static void set_planes(double *x, size_t n, width_of *width, double least)
{
    double total = 0, at = 0;
    for (size_t i = 0; i < n; i++)
        total += width(i, n, least);
    for (size_t i = 0; i < n; i++) {
        x[i] = at / total;
        at += width(i, n, least);
    }
    x[n] = 1;
}

static void place(const void *context, double *out, const size_t *v)
{
    const planes *p = context;
    for (int a = 0; a < 3; a++)
        out[a] = p->x[a][v[a]];
}

static tc_status build(tc_synth_soup *out, size_t n_cells, width_of *const width[3], double least, tc_error *err)
{
    size_t n = tc_box_side(n_cells, 6, 3);
    planes p = {.n = n};
    tc_status status = TC_OK;
    for (int a = 0; a < 3; a++) {
        p.x[a] = tc_alloc(n + 1, sizeof *p.x[a]);
        if (!p.x[a])
            status = tc_fail_memory(err, "the planes of a lattice", n + 1, sizeof *p.x[a]);
        else
            set_planes(p.x[a], n, width[a], least);
    }
    tc_lattice lattice = {{n, n, n}, false, NULL, place, &p, TC_SPLIT_KUHN};
    if (!status)
        status = tc_lattice_build(out, &lattice, err);
    for (int a = 0; a < 3; a++)
        free(p.x[a]);
    return status;
}

enum { promises = TC_SYNTH_POSITIVE | TC_SYNTH_CONFORMING | TC_SYNTH_CONVEX | TC_SYNTH_SIZED };

#define SPACED(id, cells, width_x, width_y, width_z, least)                                                            \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        static width_of *const width[3] = {width_x, width_y, width_z};                                                 \
        (void)seed;                                                                                                    \
        return build(out, n_cells, width, least, err);                                                                 \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {cells, build_##id, tc_field_linear, tc_chord_unit_cube, promises, 0};

SPACED(needle_1e3, 10368, alternating, alternating, even, 1e-3)
SPACED(needle_1e5, 10368, alternating, alternating, even, 1e-5)
SPACED(needle_1e8, 10368, alternating, alternating, even, 1e-8)
SPACED(wedge_1e3, 10368, even, alternating, even, 1e-3)
SPACED(wedge_1e5, 10368, even, alternating, even, 1e-5)
SPACED(wedge_1e8, 10368, even, alternating, even, 1e-8)
SPACED(graded_planes, 82944, geometric, geometric, geometric, 1e-6)
