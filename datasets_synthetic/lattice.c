/* lattice.c: hexahedral lattices split into tets.
 * Kuhn, "Some combinatorial lemmas in topology", 1960: one tet per order in which the three axes are walked. */
#include "lattice.h"

#include "core/memory.h"

#include <stdlib.h>

/* Corners of the six tets, as bits (1: +axis 0, 2: +axis 1, 4: +axis 2); the odd orders have two corners swapped so
 * that all are positive. */
static const unsigned char kuhn_tet[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                             {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 6, 4, 7}};

/* The same for five tets: cubes whose indices add up to an even number, then the others. */
static const unsigned char five_tet[2][5][4] = {
    {{0, 3, 6, 5}, {1, 3, 0, 5}, {2, 0, 3, 6}, {4, 6, 5, 0}, {7, 5, 6, 3}},
    {{1, 2, 4, 7}, {0, 1, 2, 4}, {3, 2, 1, 7}, {5, 4, 7, 1}, {6, 7, 4, 2}},
};

static size_t tets_per_cube(const tc_lattice *lattice)
{
    return lattice->split == TC_SPLIT_FIVE ? 5 : 6;
}

static const unsigned char *tet_corners(const tc_lattice *lattice, const size_t *cube, size_t t)
{
    return lattice->split == TC_SPLIT_FIVE ? five_tet[(cube[0] + cube[1] + cube[2]) & 1][t] : kuhn_tet[t];
}

typedef struct walk {
    const tc_lattice *lattice;
    size_t nv[3]; /* vertices along each axis */
} walk;

static size_t vertex_index(const walk *w, size_t i, size_t j, size_t k)
{
    if (w->lattice->wrap && i == w->nv[0])
        i = 0;
    return i + w->nv[0] * (j + w->nv[1] * k);
}

static void cube_corners(size_t *out, const walk *w, const size_t *c)
{
    for (int b = 0; b < 8; b++)
        out[b] = vertex_index(w, c[0] + (size_t)(b & 1), c[1] + (size_t)(b >> 1 & 1), c[2] + (size_t)(b >> 2));
}

static bool kept(const tc_lattice *lattice, const size_t *c)
{
    return !lattice->keep || lattice->keep(lattice->context, c);
}

/* Calls for each kept cube: marks its corners (id not NULL: writes its tets). Gives the number of kept cubes. */
static size_t for_kept_cubes(const walk *w, int32_t *mark, int32_t *tet)
{
    const tc_lattice *lattice = w->lattice;
    size_t n = 0, c[3], corner[8];
    for (c[2] = 0; c[2] < lattice->n[2]; c[2]++)
        for (c[1] = 0; c[1] < lattice->n[1]; c[1]++)
            for (c[0] = 0; c[0] < lattice->n[0]; c[0]++) {
                if (!kept(lattice, c))
                    continue;
                n++;
                cube_corners(corner, w, c);
                if (!tet) {
                    for (int b = 0; b < 8; b++)
                        mark[corner[b]] = 0;
                    continue;
                }
                for (size_t t = 0; t < tets_per_cube(lattice); t++)
                    for (int v = 0; v < 4; v++)
                        *tet++ = mark[corner[tet_corners(lattice, c, t)[v]]];
            }
    return n;
}

tc_status tc_lattice_build(tc_synth_soup *out, const tc_lattice *lattice, tc_error *err)
{
    walk w = {lattice, {lattice->n[0] + !lattice->wrap, lattice->n[1] + 1, lattice->n[2] + 1}};
    size_t n_lattice;
    if (__builtin_mul_overflow(w.nv[0], w.nv[1], &n_lattice) || __builtin_mul_overflow(n_lattice, w.nv[2], &n_lattice))
        return tc_fail(err, TC_E_ARG, "a lattice of %zu x %zu x %zu cubes is too large; ask for fewer cells",
                       lattice->n[0], lattice->n[1], lattice->n[2]);
    int32_t *id = tc_alloc(n_lattice, sizeof *id);
    if (!id)
        return tc_fail_memory(err, "the lattice", n_lattice, sizeof *id);
    for (size_t i = 0; i < n_lattice; i++)
        id[i] = -1;
    size_t n_cube = for_kept_cubes(&w, id, NULL), n_vertex = 0;
    for (size_t i = 0; i < n_lattice; i++)
        n_vertex += id[i] == 0;
    tc_status status = tc_synth_soup_reserve(out, n_vertex, tets_per_cube(lattice) * n_cube, err);
    if (status)
        goto done;

    size_t v[3], at = 0;
    int32_t next = 0;
    for (v[2] = 0; v[2] < w.nv[2]; v[2]++)
        for (v[1] = 0; v[1] < w.nv[1]; v[1]++)
            for (v[0] = 0; v[0] < w.nv[0]; v[0]++, at++)
                if (id[at] == 0) {
                    id[at] = next;
                    lattice->place(lattice->context, out->vertex + 3 * (size_t)next, v);
                    next++;
                }
    for_kept_cubes(&w, id, out->tet);
done:
    free(id);
    return status;
}
