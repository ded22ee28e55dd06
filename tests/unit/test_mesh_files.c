/* test_mesh_files.c: meshes of real simulations, read by tetcast-read and prepared. Skipped where the data are absent.
 */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh_shapes.h"

#include <unistd.h>

static tc_mesh *read_file(const char *path)
{
    if (access(path, R_OK) != 0)
        skip();
    tc_mesh *m = NULL;
    tc_error err = {0};
    tc_read_options options = {0};
    if (tc_mesh_read(&m, path, &options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return m;
}

static double imaginary_volume(const tc_mesh *m)
{
    double sum = 0;
    for (size_t t = m->n_tet; t < m->n_tet + m->n_imaginary; t++) {
        double six = shape_volume6(m, m->tet + 4 * t);
        assert_true(six > -1e-12);
        sum += six / 6;
    }
    return sum;
}

/* The volume of what the open faces enclose: the hull's, when gaps are filled. */
static double enclosed_volume(const tc_mesh *m)
{
    static const uint8_t face[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    double sum = 0;
    for (size_t i = 0; i < 4 * (m->n_tet + m->n_imaginary); i++) {
        if (m->neighbour[i] >= 0)
            continue;
        const double *p[3];
        for (int c = 0; c < 3; c++)
            p[c] = m->vertex + 3 * (size_t)m->tet[i / 4 * 4 + face[i % 4][c]];
        sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
               p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sum / 6;
}

static void the_blunt_fin_is_filled_up_to_its_hull(void **state)
{
    (void)state;
    tc_mesh *m = read_file(TC_SHARED_DATA "/bluntfin_tets.vtu");
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_CONVEXIFY);
    shape_check_promises(m);
    assert_int_equal(r.n_tet, 187318);
    assert_int_equal(r.n_vertex, 40921);
    assert_int_equal(r.n_boundary_face, 13438);
    assert_int_equal(r.n_component, 1);
    assert_int_equal(r.dropped_degenerate + r.dropped_duplicate + r.unlinked_faces, 0);
    assert_int_equal(r.source_cells, 187318);
    assert_true(r.n_imaginary > 3400 && r.n_imaginary < 3700); /* the 2003 paper: 3534; TetGen 1.5.0: 3538 */
    double enclosed = enclosed_volume(m);
    assert_true(fabs(r.volume + imaginary_volume(m) - enclosed) < 1e-9 * enclosed);
    tc_mesh_report again = shape_prepare(m, TC_REENTRY_PEEL);
    assert_int_equal(again.n_imaginary, 0);
    assert_true(fabs(enclosed_volume(m) - r.volume) < 1e-9 * r.volume);
    tc_mesh_destroy(&m);
}

/* Two of its cells are folded over: each lies on one side with two neighbours, and the reason for peeling says so. */
static void folded_cells_of_the_combustor_are_told(void **state)
{
    (void)state;
    tc_mesh *m = read_file(TC_SHARED_DATA "/combustor_tets.vtu");
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_AUTO);
    shape_check_promises(m);
    assert_int_equal(r.n_tet, 215040);
    assert_int_equal(r.unlinked_faces, 4);
    assert_int_equal(r.reentry, TC_REENTRY_PEEL);
    assert_non_null(strstr(r.reentry_why, "two cells on one side"));
    tc_mesh_destroy(&m);
}

/* A mug in blocks: points that the file repeats where blocks meet are merged, and its hollow is filled. */
static void the_blocks_of_a_mug_are_joined(void **state)
{
    (void)state;
    tc_mesh *m = read_file(TC_SHARED_DATA "/vol/mug.e");
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_CONVEXIFY);
    shape_check_promises(m);
    assert_int_equal(r.n_component, 1);
    assert_true(r.merged_vertices > 0);
    assert_int_equal(r.unlinked_faces, 0);
    double enclosed = enclosed_volume(m);
    assert_true(fabs(r.volume + imaginary_volume(m) - enclosed) < 1e-9 * enclosed);
    assert_true(enclosed > 2 * r.volume);
    tc_mesh_destroy(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_blunt_fin_is_filled_up_to_its_hull),
        cmocka_unit_test(folded_cells_of_the_combustor_are_told),
        cmocka_unit_test(the_blocks_of_a_mug_are_joined),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
