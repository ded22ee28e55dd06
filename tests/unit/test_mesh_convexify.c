/* test_mesh_convexify.c: imaginary cells between a mesh and its convex hull. Needs the helper tetcast-convexify. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh_shapes.h"

#include <stdio.h>

/* After convexification: promises, and the outside is the box of the real mesh. */
static void check_fills_box(const tc_mesh *m, const tc_mesh_report *r, double imaginary_volume)
{
    shape_check_promises(m);
    double volume = 0, outside = 0;
    for (size_t t = m->n_tet; t < m->n_tet + m->n_imaginary; t++)
        volume += shape_volume6(m, m->tet + 4 * t) / 6;
    assert_true(fabs(volume - imaginary_volume) < 1e-9);
    for (size_t t = 0; t < m->n_tet + m->n_imaginary; t++)
        for (int f = 0; f < 4; f++) {
            if (m->neighbour[4 * t + (size_t)f] >= 0)
                continue;
            bool flat = false;
            for (int k = 0; k < 6; k++) {
                bool on = true;
                for (int i = 0; i < 4; i++)
                    on = on &&
                         (i == f || m->vertex[3 * (size_t)m->tet[4 * t + (size_t)i] + (size_t)k / 2] == r->bounds[k]);
                flat = flat || on;
            }
            assert_true(flat);
            outside++;
        }
    assert_true(outside > 0);
}

static bool l_shape(int i, int j, int k)
{
    (void)k;
    return i < 2 || j < 2;
}

static void an_l_shape_gets_imaginary_cells_up_to_its_hull(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {4, 4, 2};
    shape_grid(&s, n, l_shape);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_CONVEXIFY);
    shape_check_promises(m);
    assert_int_equal(r.reentry, TC_REENTRY_CONVEXIFY);
    assert_false(r.convex);
    assert_true(r.n_imaginary > 0);
    tc_mesh_destroy(&m);
    shape_finish(&s);
}

static bool not_the_middle(int i, int j, int k)
{
    return i != 1 || j != 1 || k != 1;
}

static void a_cavity_is_filled(void **state)
{
    (void)state;
    shape s = {0};
    const int n[3] = {3, 3, 3};
    shape_grid(&s, n, not_the_middle);
    tc_mesh *m = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_mesh_report r = shape_prepare(m, TC_REENTRY_AUTO);
    assert_string_equal(r.reentry_why, "");
    assert_int_equal(r.reentry, TC_REENTRY_CONVEXIFY);
    assert_false(r.convex);
    check_fills_box(m, &r, 1);
    tc_mesh_destroy(&m);
    shape_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_l_shape_gets_imaginary_cells_up_to_its_hull),
        cmocka_unit_test(a_cavity_is_filled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
