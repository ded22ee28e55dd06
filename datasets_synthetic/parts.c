/* parts.c: boxes that touch in a vertex, along an edge, or not at all, and boxes with cavities. */
#include "blocks.h"
#include "box.h"

static bool keep_vertex(int i, int j, int k)
{
    return i == j && j == k;
}

static bool keep_edge(int i, int j, int k)
{
    (void)k;
    return i == j;
}

/* Every other cube: each touches its neighbours along its edges and in its vertices only. */
static bool keep_board(int i, int j, int k)
{
    return (i + j + k) % 2 == 0;
}

static bool keep_apart(int i, int j, int k)
{
    return i % 2 == 0 && j % 2 == 0 && k % 2 == 0;
}

static bool keep_cavities(int i, int j, int k)
{
    return !(i % 2 == 1 && j % 2 == 1 && k % 2 == 1);
}

/* Boxes one in another: full, empty, full, empty, full. */
static bool keep_nested(int i, int j, int k)
{
    int depth = 4;
    const int at[3] = {i, j, k};
    for (int a = 0; a < 3; a++) {
        depth = at[a] < depth ? at[a] : depth;
        depth = 8 - at[a] < depth ? 8 - at[a] : depth;
    }
    return depth % 2 == 0;
}

static void shape(tc_blocks *b, int n, bool (*keep)(int i, int j, int k))
{
    static const double one[1] = {1};
    for (int a = 0; a < 3; a++)
        tc_blocks_set_axis(b, a, n, one, 1);
    b->keep = keep;
}

static tc_status build(tc_synth_soup *out, size_t n_cells, uint64_t seed, int n, bool (*keep)(int i, int j, int k),
                       tc_error *err)
{
    tc_blocks b;
    shape(&b, n, keep);
    return tc_blocks_build(out, &b, n_cells, seed, err);
}

static double chord(const double *o, const double *d, int n, bool (*keep)(int i, int j, int k))
{
    tc_blocks b;
    shape(&b, n, keep);
    return tc_blocks_chord(&b, o, d);
}

/* Each box has at least one cube along each axis, and whole numbers of them. */
enum { promises = TC_SYNTH_SOUND & ~TC_SYNTH_SIZED };

#define PARTS(id, cells, n, keep)                                                                                      \
    static tc_status build_##id(tc_synth_soup *out, size_t n_cells, uint64_t seed, tc_error *err)                      \
    {                                                                                                                  \
        return build(out, n_cells, seed, n, keep, err);                                                                \
    }                                                                                                                  \
    static double chord_##id(const double *o, const double *d, size_t n_cells)                                         \
    {                                                                                                                  \
        (void)n_cells;                                                                                                 \
        return chord(o, d, n, keep);                                                                                   \
    }                                                                                                                  \
    const tc_synth_generator tc_synth_##id = {cells, build_##id, tc_field_linear, chord_##id, promises, 0};

PARTS(touch_vertex, 6000, 2, keep_vertex)
PARTS(touch_edge, 6000, 2, keep_edge)
PARTS(checkerboard, 12288, 4, keep_board)
PARTS(disjoint, 10368, 5, keep_apart)
PARTS(cavities, 5616, 5, keep_cavities)
PARTS(cavity_nested, 20000, 9, keep_nested)
