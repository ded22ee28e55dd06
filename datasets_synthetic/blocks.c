/* blocks.c: unions of axis-aligned boxes, divided by a jittered Kuhn lattice. */
#include "blocks.h"

#include "chord.h"
#include "core/memory.h"
#include "lattice.h"

#include <math.h>
#include <stdlib.h>

void tc_blocks_set_axis(tc_blocks *blocks, int axis, int n, const double *width, int n_width)
{
    blocks->n[axis] = n;
    blocks->plane[axis][0] = 0;
    for (int i = 0; i < n; i++)
        blocks->plane[axis][i + 1] = blocks->plane[axis][i] + width[i % n_width];
}

static double divisions(const tc_blocks *blocks, int axis, int block, double h)
{
    return fmax(1, round((blocks->plane[axis][block + 1] - blocks->plane[axis][block]) / h));
}

static double count_tets(const void *context, double h)
{
    const tc_blocks *b = context;
    double count = 0;
    for (int k = 0; k < b->n[2]; k++)
        for (int j = 0; j < b->n[1]; j++)
            for (int i = 0; i < b->n[0]; i++)
                if (b->keep(i, j, k))
                    count += divisions(b, 0, i, h) * divisions(b, 1, j, h) * divisions(b, 2, k, h);
    return 6 * count;
}

typedef struct grid {
    const tc_blocks *blocks;
    uint64_t seed;
    size_t n[3];
    int *block[3]; /* [axis][n] block of a cube */
    double *x[3];  /* [axis][n + 1] undisturbed coordinate of a vertex */
} grid;

static bool grid_keep(const void *context, const size_t *cube)
{
    const grid *g = context;
    return g->blocks->keep(g->block[0][cube[0]], g->block[1][cube[1]], g->block[2][cube[2]]);
}

/* The cube on the given sides (bit a: above along axis a) of a vertex is inside the shape. */
static bool inside(const grid *g, const size_t *vertex, int side)
{
    size_t cube[3];
    for (int a = 0; a < 3; a++) {
        if (!(side >> a & 1) && vertex[a] == 0)
            return false;
        cube[a] = vertex[a] - !(side >> a & 1);
        if (cube[a] == g->n[a])
            return false;
    }
    return grid_keep(g, cube);
}

/* Moving the vertex along the axis leaves the shape as it is: no boundary face at it is perpendicular to the axis. */
static bool may_move(const grid *g, const size_t *vertex, int axis)
{
    for (int side = 0; side < 8; side++)
        if (!(side >> axis & 1) && inside(g, vertex, side) != inside(g, vertex, side | 1 << axis))
            return false;
    return true;
}

static void grid_place(const void *context, double *out, const size_t *vertex)
{
    const grid *g = context;
    uint64_t index = vertex[0] + (uint64_t)(g->n[0] + 1) * (vertex[1] + (uint64_t)(g->n[1] + 1) * vertex[2]);
    for (int a = 0; a < 3; a++) {
        const double *x = g->x[a] + vertex[a];
        out[a] = x[0];
        if (may_move(g, vertex, a))
            out[a] += 0.15 * fmin(x[0] - x[-1], x[1] - x[0]) * tc_synth_noise(g->seed, 3 * index + (uint64_t)a);
    }
}

static tc_status grid_axis(grid *g, int axis, double h, tc_error *err)
{
    const tc_blocks *b = g->blocks;
    double total = 0;
    for (int i = 0; i < b->n[axis]; i++)
        total += divisions(b, axis, i, h);
    if (total > INT32_MAX)
        return tc_fail(err, TC_E_ARG, "%.0f divisions along an axis are too many; ask for fewer cells", total);
    size_t n = g->n[axis] = (size_t)total, at = 0;
    g->block[axis] = tc_alloc(n, sizeof *g->block[axis]);
    g->x[axis] = tc_alloc(n + 1, sizeof *g->x[axis]);
    if (!g->block[axis] || !g->x[axis])
        return tc_fail_memory(err, "the lattice", n + 1, sizeof *g->x[axis]);
    for (int i = 0; i < b->n[axis]; i++) {
        double lo = b->plane[axis][i], hi = b->plane[axis][i + 1];
        size_t m = (size_t)divisions(b, axis, i, h);
        for (size_t d = 0; d < m; d++, at++) {
            g->block[axis][at] = i;
            g->x[axis][at] = lo + (hi - lo) * ((double)d / (double)m);
        }
    }
    g->x[axis][n] = b->plane[axis][b->n[axis]];
    return TC_OK;
}

tc_status tc_blocks_build(tc_synth_soup *out, const tc_blocks *blocks, size_t n_cells, uint64_t seed, tc_error *err)
{
    double longest = 0;
    for (int a = 0; a < 3; a++)
        longest = fmax(longest, blocks->plane[a][blocks->n[a]]);
    double h = tc_synth_fit(count_tets, blocks, n_cells, 2 * longest);
    grid g = {.blocks = blocks, .seed = seed};
    tc_status status = TC_OK;
    for (int a = 0; a < 3 && !status; a++)
        status = grid_axis(&g, a, h, err);
    if (!status) {
        tc_lattice lattice = {{g.n[0], g.n[1], g.n[2]}, false, grid_keep, grid_place, &g, TC_SPLIT_KUHN};
        status = tc_lattice_build(out, &lattice, err);
    }
    for (int a = 0; a < 3; a++) {
        free(g.block[a]);
        free(g.x[a]);
    }
    return status;
}

double tc_blocks_chord(const tc_blocks *blocks, const double *origin, const double *direction)
{
    double length = 0;
    for (int k = 0; k < blocks->n[2]; k++)
        for (int j = 0; j < blocks->n[1]; j++)
            for (int i = 0; i < blocks->n[0]; i++) {
                if (!blocks->keep(i, j, k))
                    continue;
                const double lo[3] = {blocks->plane[0][i], blocks->plane[1][j], blocks->plane[2][k]};
                const double hi[3] = {blocks->plane[0][i + 1], blocks->plane[1][j + 1], blocks->plane[2][k + 1]};
                length += tc_chord_box(lo, hi, origin, direction);
            }
    return length;
}
