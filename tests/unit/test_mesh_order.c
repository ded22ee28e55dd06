/* test_mesh_order.c: the Hilbert curve, the sort by keys, and what follows a mesh when it is reordered. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh/order.h"
#include "mesh/sort.h"
#include "mesh_shapes.h"

/* All 8^3 cells of the 2^21 cube's coarse corner, by their place on the curve. */
static void consecutive_places_on_the_curve_share_a_face(void **state)
{
    (void)state;
    enum { N = 8 };
    int cell[N * N * N][3];
    bool taken[N * N * N] = {false};
    for (int x = 0; x < N; x++)
        for (int y = 0; y < N; y++)
            for (int z = 0; z < N; z++) {
                uint64_t at = tc_hilbert((uint32_t)x, (uint32_t)y, (uint32_t)z);
                assert_true(at < N * N * N); /* a corner cube of 2^k cells is the curve's first part */
                assert_false(taken[at]);
                taken[at] = true;
                cell[at][0] = x, cell[at][1] = y, cell[at][2] = z;
            }
    for (int i = 1; i < N * N * N; i++) {
        int distance = 0;
        for (int k = 0; k < 3; k++)
            distance += abs(cell[i][k] - cell[i - 1][k]);
        assert_int_equal(distance, 1);
    }
}

static void the_curve_uses_all_21_bits_of_each_axis(void **state)
{
    (void)state;
    const uint32_t top = (1u << 21) - 1;
    for (int axis = 0; axis < 3; axis++)
        for (int bit = 0; bit < 21; bit++) {
            uint32_t c[3] = {top / 3, top / 5, top / 7};
            uint64_t before = tc_hilbert(c[0], c[1], c[2]);
            c[axis] ^= 1u << bit;
            assert_true(tc_hilbert(c[0], c[1], c[2]) != before);
            assert_true(tc_hilbert(c[0], c[1], c[2]) >> 63 == 0);
        }
}

/* Keys of full width, of few values, all in one bin but for some, all equal. */
static uint64_t key_of(int kind, uint32_t i, uint64_t random)
{
    switch (kind) {
    case 0:
        return i % 3 ? random >> 1 : random >> 58;
    case 1:
        return random >> 60;
    case 2:
        return i % 5000 ? random >> 45 : random >> 1;
    default:
        return 12345;
    }
}

static void keys_are_unsorted_or_equal_ones_change_places(void **state)
{
    (void)state;
    static const size_t count[] = {0, 1, 2, 25, 5000, 70000};
    uint64_t *key = malloc(70000 * sizeof *key), *copy = malloc(70000 * sizeof *copy), r = 7;
    uint32_t *id = malloc(70000 * sizeof *id);
    assert_true(key && copy && id);
    for (int round = 0; round < 6 * 4 * 2; round++) {
        const size_t n = count[round % 6];
        for (uint32_t i = 0; i < n; i++) {
            r = r * 6364136223846793005u + 1442695040888963407u;
            key[i] = copy[i] = key_of(round / 6 % 4, i, r);
            id[i] = i;
        }
        assert_int_equal(tc_sort_keys(key, id, n, round < 24 ? 1 : 5, NULL), TC_OK);
        for (size_t i = 0; i < n; i++) {
            assert_true(copy[id[i]] == key[i]);
            if (i > 0)
                assert_true(key[i - 1] < key[i] || (key[i - 1] == key[i] && id[i - 1] < id[i]));
        }
    }
    free(key);
    free(copy);
    free(id);
}

static double field(const double *p)
{
    return p[0] + 100 * p[1] + 10000 * p[2];
}

static void values_and_maps_follow_reordered_vertices(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {9, 4, 6};
    shape_grid(&s, n, NULL);
    double *scalar = malloc(s.n_vertex * sizeof *scalar);
    assert_non_null(scalar);
    for (size_t v = 0; v < s.n_vertex; v++)
        scalar[v] = field(s.vertex + 3 * v);
    tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
    shape_prepare(m, TC_REENTRY_PEEL);
    bool moved = false;
    for (size_t v = 0; v < s.n_vertex; v++) {
        int32_t w = m->vertex_of_source[v];
        moved = moved || w != (int32_t)v;
        assert_memory_equal(m->vertex + 3 * (size_t)w, s.vertex + 3 * v, 3 * sizeof(double));
        assert_true(m->scalar[w] == scalar[v]);
    }
    assert_true(moved);
    for (size_t t = 0; t < s.n_tet; t++) { /* the same four vertices, in some order */
        int32_t u = m->tet_of_source[t];
        for (int i = 0; i < 4; i++) {
            int32_t v = m->vertex_of_source[s.tet[4 * t + (size_t)i]];
            int hits = 0;
            for (int j = 0; j < 4; j++)
                hits += m->tet[4 * (size_t)u + (size_t)j] == v;
            assert_int_equal(hits, 1);
        }
    }
    free(scalar);
    tc_mesh_destroy(&m);
    shape_finish(&s);
}

static void cell_values_follow_reordered_cells(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {5, 6, 3};
    shape_grid(&s, n, NULL);
    double *scalar = malloc(s.n_tet * sizeof *scalar);
    assert_non_null(scalar);
    for (size_t t = 0; t < s.n_tet; t++)
        scalar[t] = (double)t;
    tc_mesh *m = shape_mesh(&s, scalar, TC_CELL_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    assert_int_equal(r.association, TC_CELL_DATA);
    for (size_t t = 0; t < s.n_tet; t++)
        assert_true(m->scalar[m->tet_of_source[t]] == (double)t);
    free(scalar);
    tc_mesh_destroy(&m);
    shape_finish(&s);
}

static void neighbours_in_space_are_near_in_memory(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {16, 16, 16};
    shape_grid(&s, n, NULL);
    /* scatter the cells first: i -> 7919 i mod n_tet is a permutation, as 7919 is prime and does not divide it */
    int32_t *tet = malloc(s.n_tet * 4 * sizeof *tet);
    assert_non_null(tet);
    for (size_t t = 0; t < s.n_tet; t++)
        memcpy(tet + 4 * (t * 7919 % s.n_tet), s.tet + 4 * t, 4 * sizeof *tet);
    free(s.tet);
    s.tet = tet;
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    shape_prepare(m, TC_REENTRY_PEEL);
    size_t near = 0, links = 0;
    for (size_t i = 0; i < 4 * m->n_tet; i++) {
        if (m->neighbour[i] < 0)
            continue;
        links++;
        near += labs((long)m->neighbour[i] - (long)(i / 4)) < 64;
    }
    assert_true(near > links * 7 / 10);
    tc_mesh_destroy(&m);
    shape_finish(&s);
}

static void a_flat_or_tiny_mesh_can_be_ordered(void **state)
{
    (void)state;
    const double scale[4][3] = {{1, 1, 0}, {1e-320, 1e-320, 1e-320}, {1e307, 1e307, 1e307}, {0, 0, 0}};
    for (int i = 0; i < 4; i++) {
        shape s = {0};
        const int n[3] = {2, 2, 2};
        shape_grid(&s, n, NULL);
        double *scalar = malloc(s.n_vertex * sizeof *scalar);
        assert_non_null(scalar);
        for (size_t v = 0; v < s.n_vertex; v++) {
            for (int k = 0; k < 3; k++)
                s.vertex[3 * v + (size_t)k] *= scale[i][k];
            scalar[v] = (double)v; /* so that coincident points stay apart */
        }
        tc_mesh *m = shape_mesh(&s, scalar, TC_POINT_DATA);
        tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
        assert_int_equal(r.n_tet, 48);
        assert_int_equal(r.zero_volume, scale[i][2] == 0 ? 48 : 0);
        shape_check_promises(m);
        free(scalar);
        tc_mesh_destroy(&m);
        shape_finish(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(consecutive_places_on_the_curve_share_a_face),
        cmocka_unit_test(the_curve_uses_all_21_bits_of_each_axis),
        cmocka_unit_test(keys_are_unsorted_or_equal_ones_change_places),
        cmocka_unit_test(values_and_maps_follow_reordered_vertices),
        cmocka_unit_test(cell_values_follow_reordered_cells),
        cmocka_unit_test(neighbours_in_space_are_near_in_memory),
        cmocka_unit_test(a_flat_or_tiny_mesh_can_be_ordered),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
