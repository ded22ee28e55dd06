/* box.c: one axis-aligned box, divided by a lattice. */
#include "box.h"

#include <math.h>

double tc_field_linear(const double *p)
{
    return (p[0] + 2 * p[1] + 3 * p[2]) / 6;
}

size_t tc_box_side(size_t n_cells, double tets_per_cube, size_t n_least)
{
    size_t n = (size_t)round(cbrt((double)n_cells / tets_per_cube));
    return n > n_least ? n : n_least;
}

tc_box tc_box_unit(size_t n_cells, size_t n_least, uint64_t seed)
{
    size_t n = tc_box_side(n_cells, 6, n_least);
    return (tc_box){{0, 0, 0}, {1, 1, 1}, {n, n, n}, 0.15, seed, TC_SPLIT_KUHN};
}

static void place(const void *context, double *out, const size_t *v)
{
    const tc_box *b = context;
    uint64_t index = v[0] + (uint64_t)(b->n[0] + 1) * (v[1] + (uint64_t)(b->n[1] + 1) * v[2]);
    bool inner = true;
    for (int a = 0; a < 3; a++) {
        inner = inner && v[a] > 0 && v[a] < b->n[a];
        out[a] = v[a] == b->n[a] ? b->hi[a] : b->lo[a] + (b->hi[a] - b->lo[a]) * ((double)v[a] / (double)b->n[a]);
    }
    for (int a = 0; a < 3 && inner && b->jitter > 0; a++)
        out[a] +=
            b->jitter * (b->hi[a] - b->lo[a]) / (double)b->n[a] * tc_synth_noise(b->seed, 3 * index + (uint64_t)a);
}

tc_status tc_box_build(tc_synth_soup *out, const tc_box *box, tc_error *err)
{
    tc_lattice lattice = {{box->n[0], box->n[1], box->n[2]}, false, NULL, place, box, box->split};
    return tc_lattice_build(out, &lattice, err);
}
