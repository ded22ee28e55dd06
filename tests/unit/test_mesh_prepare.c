/* test_mesh_prepare.c: creating, repairing, linking and ordering hand-made meshes. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh_shapes.h"

static void a_single_tet_has_four_boundary_faces(void **state)
{
    (void)state;
    shape s = {0};
    for (int i = 0; i < 4; i++)
        shape_vertex(&s, i == 1, i == 2, i == 3);
    shape_tet(&s, 0, 1, 2, 3);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.n_tet, 1);
    assert_int_equal(r.n_boundary_face, 4);
    assert_int_equal(r.n_component, 1);
    assert_int_equal(r.reoriented, 0);
    assert_true(fabs(r.volume - 1.0 / 6) < 1e-15);
    assert_true(fabs(r.longest_edge - sqrt(2)) < 1e-15);
    tc_mesh_destroy(&m);
    assert_null(m);
    shape_finish(&s);
}

static void a_kuhn_grid_is_linked_whole(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {7, 5, 6};
    shape_grid(&s, n, NULL);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_PEEL);
    shape_check_promises(m);
    assert_int_equal(r.n_tet, 6 * 7 * 5 * 6);
    assert_int_equal(r.n_vertex, 8 * 6 * 7);
    assert_int_equal(r.n_boundary_face, 4 * (7 * 5 + 5 * 6 + 6 * 7));
    assert_int_equal(r.n_component, 1);
    assert_int_equal(r.reoriented, 3 * 7 * 5 * 6);
    assert_int_equal(r.unlinked_faces, 0);
    assert_true(fabs(r.volume - 7 * 5 * 6) < 1e-10);
    for (size_t t = 0; t < m->n_tet; t++)
        assert_true(shape_volume6(m, m->tet + 4 * t) > 0);
    tc_mesh_destroy(&m);
    shape_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_single_tet_has_four_boundary_faces),
        cmocka_unit_test(a_kuhn_grid_is_linked_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
