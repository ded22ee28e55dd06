/* test_scene_geometry.c: outline, wireframe and surface of meshes whose boundaries are known; what is wrong with a
 * geometry. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh_shapes.h"
#include "scene/geometry.h"

static bool not_the_middle(int i, int j, int k)
{
    return i != 1 || j != 1 || k != 1;
}

/* A grid of n cells, or the cells of keep; gaps filled. */
static tc_mesh *grid_mesh(int n, bool (*keep)(int, int, int), tc_reentry reentry)
{
    shape s = {0};
    shape_grid(&s, (const int[3]){n, n, n}, keep);
    tc_mesh *mesh = shape_mesh(&s, NULL, TC_POINT_DATA);
    shape_finish(&s);
    shape_prepare(mesh, reentry);
    return mesh;
}

static tc_geometry part_of(const tc_mesh *mesh, tc_mesh_part part)
{
    tc_geometry g;
    tc_error err = {0};
    if (tc_geometry_from_mesh(&g, mesh, part, &err) != TC_OK)
        fail_msg("%s", err.text);
    char why[256];
    assert_null(tc_geometry_wrong(why, sizeof why, &g));
    assert_true(g.opacity == 1 && g.width == 1 && g.color[0] == 0 && g.color[1] == 0 && g.color[2] == 0);
    return g;
}

static const double *at(const tc_geometry *g, int32_t id)
{
    return g->vertex + 3 * (size_t)id;
}

/* Lines that run along one axis only, of which each (place and direction) is there once. */
static void check_lines_once(const tc_geometry *g)
{
    for (size_t i = 0; i < g->n_line; i++)
        for (size_t j = 0; j < i; j++) {
            const double *a = at(g, g->line[2 * i]), *b = at(g, g->line[2 * i + 1]);
            const double *c = at(g, g->line[2 * j]), *d = at(g, g->line[2 * j + 1]);
            assert_false(memcmp(a, c, 24) == 0 && memcmp(b, d, 24) == 0);
            assert_false(memcmp(a, d, 24) == 0 && memcmp(b, c, 24) == 0);
        }
}

static void test_outline_is_not_the_box(void **state)
{
    (void)state;
    tc_mesh *mesh = grid_mesh(3, NULL, TC_REENTRY_PEEL);
    tc_geometry g = part_of(mesh, TC_PART_OUTLINE);
    assert_int_equal(g.n_vertex, 8);
    assert_int_equal(g.n_line, 12);
    assert_int_equal(g.n_triangle, 0);
    assert_false(g.lit);
    for (size_t i = 0; i < 12; i++) {
        int differs = 0;
        for (int k = 0; k < 3; k++) {
            const double a = at(&g, g.line[2 * i])[k], b = at(&g, g.line[2 * i + 1])[k];
            assert_true((a == 0 || a == 3) && (b == 0 || b == 3));
            differs += a != b;
        }
        assert_int_equal(differs, 1);
    }
    check_lines_once(&g);
    tc_geometry_finish(&g);
    assert_null(g.vertex);
    tc_geometry_finish(&g);
    tc_mesh_destroy(&mesh);
}

/* Signed volume that triangles around a solid enclose. */
static double enclosed(const tc_geometry *g)
{
    double six = 0;
    for (size_t i = 0; i < g->n_triangle; i++) {
        const double *a = at(g, g->triangle[3 * i]), *b = at(g, g->triangle[3 * i + 1]),
                     *c = at(g, g->triangle[3 * i + 2]);
        six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0]);
    }
    return six / 6;
}

static void test_surface_does_not_enclose_the_real_tets(void **state)
{
    (void)state;
    /* A cube, and one with a hollow that imaginary cells fill: 12 triangles more, its volume less. */
    for (int hollow = 0; hollow < 2; hollow++) {
        tc_mesh *mesh = grid_mesh(3, hollow ? not_the_middle : NULL, hollow ? TC_REENTRY_CONVEXIFY : TC_REENTRY_PEEL);
        assert_true(hollow == (mesh->n_imaginary > 0));
        tc_geometry g = part_of(mesh, TC_PART_SURFACE);
        assert_int_equal(g.n_triangle, hollow ? 108 + 12 : 108);
        assert_int_equal(g.n_vertex, hollow ? 64 : 56);
        assert_int_equal(g.n_line, 0);
        assert_true(g.lit);
        assert_true(fabs(enclosed(&g) - (hollow ? 26 : 27)) < 1e-12);
        tc_geometry_finish(&g);
        tc_mesh_destroy(&mesh);
    }
}

static void test_wireframe_repeats_or_lacks_an_edge(void **state)
{
    (void)state;
    for (int hollow = 0; hollow < 2; hollow++) {
        tc_mesh *mesh = grid_mesh(3, hollow ? not_the_middle : NULL, TC_REENTRY_PEEL);
        tc_geometry g = part_of(mesh, TC_PART_WIREFRAME);
        /* Euler: V - E + F = 2 of each closed surface. */
        assert_int_equal(g.n_line, hollow ? 56 + 108 - 2 + 8 + 12 - 2 : 56 + 108 - 2);
        assert_int_equal(g.n_triangle, 0);
        assert_false(g.lit);
        check_lines_once(&g);
        tc_geometry_finish(&g);
        tc_mesh_destroy(&mesh);
    }
}

static void test_parts_that_are_none_are_made(void **state)
{
    (void)state;
    shape s = {0};
    shape_grid(&s, (const int[3]){1, 1, 1}, NULL);
    tc_mesh *mesh = shape_mesh(&s, NULL, TC_POINT_DATA);
    shape_finish(&s);
    tc_geometry g;
    tc_error err = {0};
    assert_int_equal(tc_geometry_from_mesh(&g, mesh, TC_PART_SURFACE, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "tc_mesh_prepare"));
    shape_prepare(mesh, TC_REENTRY_PEEL);
    assert_int_equal(tc_geometry_from_mesh(&g, mesh, (tc_mesh_part)3, &err), TC_E_ARG);
    assert_null(g.vertex);
    assert_int_equal(tc_geometry_from_mesh(&g, NULL, TC_PART_SURFACE, &err), TC_E_ARG);
    assert_int_equal(tc_geometry_from_mesh(NULL, mesh, TC_PART_SURFACE, &err), TC_E_ARG);
    tc_mesh_destroy(&mesh);
}

static void check_wrong(const tc_geometry *g, const char *part)
{
    char why[256] = "";
    const char *text = tc_geometry_wrong(why, sizeof why, g);
    assert_non_null(text);
    if (!strstr(text, part))
        fail_msg("\"%s\" does not say \"%s\"", text, part);
}

static void test_geometry_that_cannot_be_drawn_passes(void **state)
{
    (void)state;
    double vertex[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    int32_t triangle[3] = {0, 1, 2}, line[4] = {0, 1, 1, 2};
    const tc_geometry good = {.n_vertex = 3,
                              .n_triangle = 1,
                              .n_line = 2,
                              .vertex = vertex,
                              .triangle = triangle,
                              .line = line,
                              .opacity = 1,
                              .width = 1};
    char why[256];
    assert_null(tc_geometry_wrong(why, sizeof why, &good));
    tc_geometry g = good;
    g.width = 0;
    check_wrong(&g, "0 pixels");
    g = good;
    g.color[1] = NAN;
    check_wrong(&g, "colour");
    g = good;
    g.opacity = 1.5;
    check_wrong(&g, "opacity 1.5");
    g = good;
    g.line = NULL;
    check_wrong(&g, "does not hold");
    triangle[1] = 3;
    check_wrong(&good, "triangle 0 of a geometry refers to vertex 3");
    triangle[1] = 1;
    line[3] = -1;
    check_wrong(&good, "line 1 of a geometry refers to vertex -1");
    line[3] = 2;
    vertex[5] = INFINITY;
    check_wrong(&good, "vertex 1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_outline_is_not_the_box),
        cmocka_unit_test(test_surface_does_not_enclose_the_real_tets),
        cmocka_unit_test(test_wireframe_repeats_or_lacks_an_edge),
        cmocka_unit_test(test_parts_that_are_none_are_made),
        cmocka_unit_test(test_geometry_that_cannot_be_drawn_passes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
