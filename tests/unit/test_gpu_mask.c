/* test_gpu_mask.c: the bits of cells, judged cell by cell from what a selection or a function is. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/pack_mask.h"
#include "mesh/field.h"
#include "transfer_make.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A mesh with values from a short list, so that many lie on knots and ends of ranges, or with any. */
static tc_mesh *make_mesh(size_t n_cells, tc_association association, const double *list, int n_list, uint64_t seed)
{
    tc_mesh *mesh;
    tc_error err = {0};
    if (tc_synth_create(&mesh, "kuhn", n_cells, 3, &err) != TC_OK ||
        tc_mesh_prepare(mesh, &(tc_prepare_options){.reentry = TC_REENTRY_PEEL}, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    const size_t n = association == TC_CELL_DATA ? mesh->n_tet_source : mesh->n_vertex_source;
    double *value = malloc(n * sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < n; i++) {
        /* mostly one of the list for a run of points, so that some cells lie within a short range */
        const double any = random01(&seed);
        value[i] = any < 0.1 ? list[(size_t)(random01(&seed) * n_list)] : i > 0 ? value[i - 1] : list[0];
    }
    assert_int_equal(tc_mesh_set_scalar(mesh, value, association, &err), TC_OK);
    free(value);
    return mesh;
}

static bool bit(const uint32_t *mask, size_t i)
{
    return mask[i >> 5] >> (i & 31) & 1;
}

/* Of one thread and of several the same, and nothing beyond the last cell. Frees both. */
static void check_both(uint32_t *mask, uint32_t *other, size_t n)
{
    assert_memory_equal(mask, other, (n + 31) / 32 * sizeof *mask);
    if (n & 31)
        assert_int_equal(mask[n >> 5] >> (n & 31), 0);
    free(mask);
    free(other);
}

/* ------------------------------------------------------------------------------------------------ selection */

static bool lies_in(const double *range, double x)
{
    return isfinite(x) && range[0] <= x && x <= range[1];
}

static bool is_kept(const tc_mesh *mesh, const tc_select *select, size_t cell)
{
    const double *value = select->field ? select->field->value : mesh->scalar;
    const bool of_cells = (select->field ? select->field->association : mesh->association) == TC_CELL_DATA;
    for (int r = 0; r < select->n_range; r++) {
        int in = 0;
        for (int k = 0; k < 4; k++)
            in += lies_in(select->range[r], of_cells ? value[cell] : value[mesh->tet[4 * cell + (size_t)k]]);
        if (in == 4)
            return true;
    }
    return false;
}

/* Gives how many are kept. */
static size_t check_select(const tc_mesh *mesh, const tc_select *select, size_t n)
{
    size_t kept = 0, again = 0, count = 0;
    uint32_t *mask = NULL, *other = NULL;
    tc_error err = {0};
    if (tc_pack_mask_select(&mask, &kept, mesh, select, n, 1, &err) != TC_OK ||
        tc_pack_mask_select(&other, &again, mesh, select, n, 3, &err) != TC_OK)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < mesh->n_tet; i++) {
        bool keep = true;
        for (size_t k = 0; k < n; k++)
            keep = keep && is_kept(mesh, &select[k], i);
        if (bit(mask, i) != keep)
            fail_msg("cell %zu is %s", i, keep ? "not kept" : "kept");
        count += keep;
    }
    assert_int_equal(kept, count);
    check_both(mask, other, mesh->n_tet);
    return count;
}

static const double list[] = {0, 1, 2, 3, 4, 5, 6, 7, 2.5, NAN, INFINITY, -INFINITY};
enum { N_LIST = sizeof list / sizeof *list };

static void a_selection_keeps_other_cells(void **state)
{
    (void)state;
    /* 2 … 3 and 2.5 … 5 overlap, but are not 2 … 5 */
    static const double several[][2] = {{2.5, 5}, {2, 3}, {7, 7}, {-INFINITY, 0.5}, {6.25, 6.5}, {4, 4}};
    static const double one[][2] = {{1, 6}}, all[][2] = {{-INFINITY, INFINITY}}, none[][2] = {{8, 9}};
    for (int association = TC_POINT_DATA; association <= TC_CELL_DATA; association++) {
        tc_mesh *mesh = make_mesh(6 * 21 * 21 * 21, (tc_association)association, list, N_LIST, 7);
        assert_true(mesh->n_tet & 31); /* the last word is not full */
        const size_t n = mesh->n_tet_source > mesh->n_vertex_source ? mesh->n_tet_source : mesh->n_vertex_source;
        double *value = malloc(n * sizeof *value);
        assert_non_null(value);
        tc_field *field[2];
        for (size_t i = 0; i < n; i++)
            value[i] = (double)(i * 7 / n); /* parts */
        assert_int_equal(tc_field_create(&field[0], mesh, value, TC_CELL_DATA, "part", NULL), TC_OK);
        assert_int_equal(tc_field_create(&field[1], mesh, value, TC_POINT_DATA, "part", NULL), TC_OK);
        const tc_select by[] = {{NULL, 6, several}, {field[0], 6, several}, {field[1], 6, several}, {NULL, 1, one},
                                {field[1], 1, one}, {NULL, 1, all},         {NULL, 1, none}};
        for (size_t i = 0; i < 5; i++) {
            const size_t kept = check_select(mesh, &by[i], 1);
            assert_true(kept > 0 && kept < mesh->n_tet);
        }
        const size_t both = check_select(mesh, by, 2);
        assert_true(both > 0 && both < check_select(mesh, by, 1));
        check_select(mesh, by, 5);
        assert_int_equal(check_select(mesh, by, 0), mesh->n_tet);
        assert_int_equal(check_select(mesh, by + 5, 1), mesh->n_tet - mesh->report.nonfinite_cells);
        assert_int_equal(check_select(mesh, by + 6, 1), 0);
        free(value);
        tc_field_destroy(&field[0]);
        tc_field_destroy(&field[1]);
        tc_mesh_destroy(&mesh);
    }
}

/* --------------------------------------------------------------------------------------------- empty space */

/* Attenuation at s on the side of larger (1) or lesser (-1) scalars, knot by knot. */
static double beside(const tc_transfer *tf, double s, int side)
{
    const tc_knot *k = tf->knot;
    double a = k[0].a;
    for (size_t i = 0; i < tf->n; i++) {
        if (k[i].s < s || (k[i].s == s && (side > 0 || i == 0 || k[i - 1].s < s)))
            a = k[i].a;
        if (i + 1 < tf->n && k[i].s < s && s < k[i + 1].s)
            return k[i].a > 0 || k[i + 1].a > 0; /* in between, where any of them is */
    }
    if (side < 0 && k[0].s == s)
        return k[0].a;
    return a;
}

static bool is_clear(const tc_transfer *tf, double lo, double hi)
{
    if (!isfinite(lo) || !isfinite(hi) || beside(tf, lo, -1) > 0 || beside(tf, lo, 1) > 0 || beside(tf, hi, -1) > 0 ||
        beside(tf, hi, 1) > 0)
        return false;
    for (size_t i = 0; i < tf->n; i++)
        if (lo <= tf->knot[i].s && tf->knot[i].s <= hi && tf->knot[i].a > 0)
            return false;
    return true;
}

static size_t check_empty(const tc_mesh *mesh, const tc_transfer *tf)
{
    size_t n_empty = 0, again = 0, count = 0;
    uint32_t *mask = NULL, *other = NULL;
    tc_error err = {0};
    if (tc_pack_mask_empty(&mask, &n_empty, mesh, tf, 1, &err) != TC_OK ||
        tc_pack_mask_empty(&other, &again, mesh, tf, 3, &err) != TC_OK)
        fail_msg("%s", err.text);
    for (size_t i = 0; i < mesh->n_tet; i++) {
        double lo = INFINITY, hi = -INFINITY;
        for (int k = 0; k < 4; k++) {
            const double x =
                mesh->association == TC_CELL_DATA ? mesh->scalar[i] : mesh->scalar[mesh->tet[4 * i + (size_t)k]];
            lo = isfinite(x) ? fmin(lo, x) : NAN;
            hi = isfinite(x) ? fmax(hi, x) : NAN;
            if (isnan(lo))
                break;
        }
        const bool clear = is_clear(tf, lo, hi);
        if (bit(mask, i) != clear)
            fail_msg("cell %zu, %.17g to %.17g: %s", i, lo, hi, clear ? "not told empty" : "told empty");
        count += clear;
    }
    assert_int_equal(n_empty, count);
    check_both(mask, other, mesh->n_tet);
    return count;
}

static void a_cell_that_absorbs_is_empty(void **state)
{
    (void)state;
    static const tc_knot ramp[] = {{0, 0, 0, 0, 0}, {2, 0, 0, 0, 0}, {3, 0, 0, 0, 1}, {4, 0, 0, 0, 0}, {7, 0, 0, 0, 0}},
                         steps[] = {{1, 0, 0, 0, 5}, {1, 0, 0, 0, 0}, {2.5, 0, 0, 0, 0}, {2.5, 0, 0, 0, 1},
                                    {4, 0, 0, 0, 1}, {4, 0, 0, 0, 0}, {6, 0, 0, 0, 0},   {6, 0, 0, 0, 2}},
                         outside[] = {{2, 0, 0, 0, 1}, {3, 0, 0, 0, 0}, {4, 0, 0, 0, 0}, {5, 0, 0, 0, 1}},
                         touch[] = {{-1, 0, 0, 0, 0}, {2, 0, 0, 0, 0}, {2, 0, 0, 0, 1}, {5, 0, 0, 0, 1},
                                    {6, 0, 0, 0, 0},  {6, 0, 0, 0, 1}, {7, 0, 0, 0, 0}},
                         far[] = {{100, 0, 0, 0, 0}, {200, 0, 0, 0, 1}};
    const struct {
        const tc_knot *knot;
        size_t n;
    } function[] = {{ramp, 5}, {steps, 8}, {outside, 4}, {touch, 7}, {far, 2}};
    for (int association = TC_POINT_DATA; association <= TC_CELL_DATA; association++) {
        tc_mesh *mesh = make_mesh(30000, (tc_association)association, list, N_LIST, 11);
        for (size_t i = 0; i < 5; i++) {
            tc_transfer *tf = make(function[i].knot, function[i].n);
            const size_t n = check_empty(mesh, tf);
            assert_true(n > 0 && n < mesh->n_tet);
            tc_transfer_destroy(&tf);
        }
        static const tc_knot zero[] = {{3, 0, 0, 0, 0}}, full[] = {{3, 0, 0, 0, 1}};
        tc_transfer *tf = make(zero, 1);
        assert_int_equal(check_empty(mesh, tf), mesh->n_tet - mesh->report.nonfinite_cells);
        tc_transfer_destroy(&tf);
        tf = make(full, 1);
        assert_int_equal(check_empty(mesh, tf), 0);
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

/* Many knots, more than the lookup table has places in all, and more than one in a place. */
static void a_lookup_differs_from_a_search(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int turn = 0; turn < 6; turn++) {
        enum { N = 2500, N_VALUE = 3000 };
        static tc_knot knot[N];
        static double value[N_VALUE];
        const double scale = turn < 3 ? 1 : turn == 3 ? 0x1p-1060 : turn == 4 ? 1.5e308 : 1e-12;
        const double offset = turn == 5 ? 1 : turn == 4 ? -0.75e308 : 0;
        const int n = turn == 0 ? 40 : turn == 1 ? 600 : N;
        double s = 0;
        for (int i = 0; i < n; i++) {
            if (random01(&seed) < 0.8)
                s = ((double)i + random01(&seed)) / n;
            if (i > 0 && offset + s * scale < knot[i - 1].s)
                s = 1;
            const bool same = i % 5 != 0 || random01(&seed) < 0.5; /* runs of equal kind */
            const double a = i > 0 && same ? knot[i - 1].a : random01(&seed) < 0.5 ? 0 : 0.5;
            knot[i] = (tc_knot){.s = offset + s * scale, .a = a};
            assert_true(i == 0 || knot[i].s >= knot[i - 1].s);
        }
        for (int i = 0; i < N_VALUE; i++) { /* at knots, right beside them, anywhere */
            const double at = knot[(size_t)(random01(&seed) * n)].s, kind = random01(&seed);
            value[i] = kind < 0.2   ? at
                       : kind < 0.4 ? nextafter(at, -INFINITY)
                       : kind < 0.6 ? nextafter(at, INFINITY)
                                    : offset + random01(&seed) * scale;
        }
        tc_transfer *tf = make(knot, (size_t)n);
        tc_mesh *mesh = make_mesh(20000, turn % 2 ? TC_CELL_DATA : TC_POINT_DATA, value, N_VALUE, 3 + (uint64_t)turn);
        const size_t n_empty = check_empty(mesh, tf);
        assert_true(n_empty < mesh->n_tet && (n_empty > 0 || mesh->association == TC_POINT_DATA));
        tc_mesh_destroy(&mesh);
        tc_transfer_destroy(&tf);
    }
}

static void values_that_are_all_one_are_misplaced(void **state)
{
    (void)state;
    static const double three[] = {3};
    static const tc_knot clear[] = {{0, 0, 0, 0, 0}, {3, 0, 0, 0, 0}, {4, 0, 0, 0, 1}},
                         step[] = {{0, 0, 0, 0, 0}, {3, 0, 0, 0, 0}, {3, 0, 0, 0, 1}};
    tc_mesh *mesh = make_mesh(1000, TC_POINT_DATA, three, 1, 1);
    tc_transfer *tf = make(clear, 3);
    assert_int_equal(check_empty(mesh, tf), mesh->n_tet);
    tc_transfer_destroy(&tf);
    tf = make(step, 3);
    assert_int_equal(check_empty(mesh, tf), 0);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_selection_keeps_other_cells),
        cmocka_unit_test(a_cell_that_absorbs_is_empty),
        cmocka_unit_test(a_lookup_differs_from_a_search),
        cmocka_unit_test(values_that_are_all_one_are_misplaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
