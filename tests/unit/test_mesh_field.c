/* test_mesh_field.c: values beside a mesh's scalar end up where its own would. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh/field.h"
#include "mesh_shapes.h"

static const int size[3] = {3, 2, 2};

static bool keep_some(int i, int j, int k)
{
    return i + j + k != 2; /* not convex: gaps, and points that nobody uses */
}

/* A grid with a tet that repeats a vertex, so that cells are dropped, too. */
static void make_shape(shape *s)
{
    shape_grid(s, size, keep_some);
    shape_tet(s, 0, 0, 1, 2);
    shape_tet(s, 1, 0, 4, 17); /* anywhere */
}

static double plane(const double *x)
{
    return 3 * x[0] - 2 * x[1] + 7 * x[2];
}

/* Values of points and cells that tell where they are. */
static double *point_values(const shape *s)
{
    double *value = malloc(s->n_vertex * sizeof *value);
    assert_non_null(value);
    for (size_t i = 0; i < s->n_vertex; i++)
        value[i] = plane(s->vertex + 3 * i);
    return value;
}

static double at_center(const double *vertex, const int32_t *tet)
{
    double sum = 0;
    for (int k = 0; k < 4; k++)
        sum += plane(vertex + 3 * (size_t)tet[k]) / 4;
    return sum;
}

static double *cell_values(const shape *s)
{
    double *value = malloc(s->n_tet * sizeof *value);
    assert_non_null(value);
    for (size_t t = 0; t < s->n_tet; t++)
        value[t] = at_center(s->vertex, s->tet + 4 * t);
    return value;
}

static tc_field *field_of(const tc_mesh *mesh, const double *value, tc_association association, const char *name)
{
    tc_field *field = NULL;
    tc_error err = {0};
    if (tc_field_create(&field, mesh, value, association, name, &err) != TC_OK)
        fail_msg("%s", err.text);
    return field;
}

static void values_go_to_other_points_or_cells(void **state)
{
    (void)state;
    shape s = {0};
    make_shape(&s);
    double *point = point_values(&s), *cell = cell_values(&s);
    tc_mesh *mesh = shape_mesh(&s, NULL, TC_POINT_DATA);
    shape_prepare(mesh, TC_REENTRY_PEEL);
    assert_true(mesh->n_vertex < s.n_vertex && mesh->n_tet < s.n_tet);
    const uint64_t before = mesh->scalar_serial;
    tc_field *a = field_of(mesh, point, TC_POINT_DATA, "where"), *b = field_of(mesh, cell, TC_CELL_DATA, NULL);
    assert_int_equal(a->n, mesh->n_vertex);
    assert_int_equal(b->n, mesh->n_tet);
    double lo = INFINITY, hi = -INFINITY;
    for (size_t i = 0; i < mesh->n_vertex; i++) {
        assert_true(a->value[i] == plane(mesh->vertex + 3 * i));
        assert_true(mesh->scalar[i] == 0); /* its own values stay */
        lo = fmin(lo, a->value[i]);
        hi = fmax(hi, a->value[i]);
    }
    for (size_t t = 0; t < mesh->n_tet; t++)
        assert_true(fabs(b->value[t] - at_center(mesh->vertex, mesh->tet + 4 * t)) < 1e-12);
    assert_true(mesh->scalar_serial == before && a->mesh_serial == mesh->serial && b->mesh_serial == mesh->serial);
    assert_true(a->serial != b->serial);
    double range[2];
    tc_association association;
    const char *name;
    tc_field_info(range, &association, &name, a);
    assert_true(range[0] == lo && range[1] == hi);
    assert_int_equal(association, TC_POINT_DATA);
    assert_string_equal(name, "where");
    tc_field_info(range, &association, &name, b);
    assert_int_equal(association, TC_CELL_DATA);
    assert_null(name);
    tc_field_info(range, NULL, NULL, a);
    tc_field_destroy(&a);
    tc_field_destroy(&b);
    assert_null(a);
    tc_field_destroy(NULL);
    tc_mesh_destroy(&mesh);
    free(point);
    free(cell);
    shape_finish(&s);
}

static void merged_points_have_the_value_of_another_but_the_first(void **state)
{
    (void)state;
    shape s = {0};
    for (int twin = 0; twin < 2; twin++) { /* two tets, whose points are all there twice or once */
        shape_vertex(&s, 0, 0, 0);
        shape_vertex(&s, 1, 0, 0);
        shape_vertex(&s, 0, 1, 0);
        shape_vertex(&s, 0, 0, twin ? -1 : 1);
    }
    shape_tet(&s, 0, 1, 2, 3);
    shape_tet(&s, 4, 5, 6, 7);
    tc_mesh *mesh = shape_mesh(&s, NULL, TC_POINT_DATA);
    assert_int_equal(shape_prepare(mesh, TC_REENTRY_PEEL).merged_vertices, 3);
    const double value[8] = {10, 11, 12, 13, 20, NAN, 22, 23};
    tc_field *field = field_of(mesh, value, TC_POINT_DATA, NULL);
    for (int k = 0; k < 8; k++)
        assert_true(field->value[mesh->vertex_of_source[k]] == (k < 4 || k == 7 ? value[k] : value[k - 4]));
    assert_true(field->range[0] == 10 && field->range[1] == 23);
    tc_field_destroy(&field);
    tc_mesh_destroy(&mesh);
    shape_finish(&s);
}

static void what_is_not_finite_is_in_the_range(void **state)
{
    (void)state;
    shape s = {0};
    make_shape(&s);
    double *point = point_values(&s);
    tc_mesh *mesh = shape_mesh(&s, NULL, TC_POINT_DATA);
    shape_prepare(mesh, TC_REENTRY_PEEL);
    for (size_t i = 0; i < s.n_vertex; i++)
        point[i] = i % 3 == 0 ? NAN : i % 3 == 1 ? INFINITY : 5 + (double)(i % 2);
    tc_field *field = field_of(mesh, point, TC_POINT_DATA, NULL);
    assert_true(field->range[0] == 5 && field->range[1] == 6);
    tc_field_destroy(&field);
    for (size_t i = 0; i < s.n_vertex; i++)
        point[i] = -INFINITY;
    field = field_of(mesh, point, TC_POINT_DATA, NULL);
    assert_true(field->range[0] == 0 && field->range[1] == 0);
    tc_field_destroy(&field);
    tc_mesh_destroy(&mesh);
    free(point);
    shape_finish(&s);
}

/* Points of imaginary tets are behind the mesh's own, and nobody's. */
static void steiner_points_are_in_the_range(void **state)
{
    (void)state;
    shape s = {0};
    make_shape(&s);
    double *point = point_values(&s);
    tc_mesh *mesh = shape_mesh(&s, NULL, TC_POINT_DATA);
    shape_prepare(mesh, TC_REENTRY_PEEL);
    for (size_t i = 0; i < s.n_vertex; i++)
        point[i] = 4;
    mesh->vertex = realloc(mesh->vertex, (mesh->n_vertex + 1) * 3 * sizeof *mesh->vertex);
    assert_non_null(mesh->vertex);
    memset(mesh->vertex + 3 * mesh->n_vertex, 0, 3 * sizeof *mesh->vertex);
    mesh->n_vertex++;
    mesh->report.n_steiner++;
    tc_field *field = field_of(mesh, point, TC_POINT_DATA, NULL);
    assert_int_equal(field->n, mesh->n_vertex);
    assert_true(field->value[field->n - 1] == 0);
    assert_true(field->range[0] == 4 && field->range[1] == 4);
    tc_field_destroy(&field);
    tc_mesh_destroy(&mesh);
    free(point);
    shape_finish(&s);
}

static void nonsense_is_taken(void **state)
{
    (void)state;
    shape s = {0};
    make_shape(&s);
    double *point = point_values(&s);
    tc_mesh *mesh = shape_mesh(&s, NULL, TC_POINT_DATA);
    tc_field *field = (tc_field *)&field;
    tc_error err = {0};
    assert_int_equal(tc_field_create(&field, mesh, point, TC_POINT_DATA, NULL, &err), TC_E_ARG);
    assert_null(field);
    assert_non_null(strstr(err.text, "tc_mesh_prepare"));
    shape_prepare(mesh, TC_REENTRY_PEEL);
    assert_int_equal(tc_field_create(&field, mesh, point, TC_ANY_DATA, NULL, &err), TC_E_ARG);
    assert_int_equal(tc_field_create(&field, mesh, NULL, TC_POINT_DATA, NULL, &err), TC_E_ARG);
    assert_int_equal(tc_field_create(&field, NULL, point, TC_POINT_DATA, NULL, &err), TC_E_ARG);
    assert_int_equal(tc_field_create(NULL, mesh, point, TC_POINT_DATA, NULL, &err), TC_E_ARG);
    assert_null(field);
    tc_mesh_destroy(&mesh);
    free(point);
    shape_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_go_to_other_points_or_cells),
        cmocka_unit_test(merged_points_have_the_value_of_another_but_the_first),
        cmocka_unit_test(what_is_not_finite_is_in_the_range),
        cmocka_unit_test(steiner_points_are_in_the_range),
        cmocka_unit_test(nonsense_is_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
