/* test_read_damage.c: what a reader does with numbers that cannot be: not finite, out of range, negative, huge. Files
 * are legacy VTK in binary, since VTK reads no NaN from text. */
#define _GNU_SOURCE

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "read_files.h"

#include <ctype.h>
#include <math.h>

/* Two tets with a common face; a value for each point. */
typedef struct small {
    double point[5][3], value[5];
    int32_t cell[10];                   /* 4 a b c d, twice */
    long long n_point, n_cell, n_value; /* as the file says */
    const char *name;                   /* of the array */
} small;

static small sound(void)
{
    return (small){.point = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}},
                   .value = {1, 2, 3, 4, 5},
                   .cell = {4, 0, 1, 2, 3, 4, 1, 2, 3, 4},
                   .n_point = 5,
                   .n_cell = 2,
                   .n_value = 5,
                   .name = "heat"};
}

static void put(FILE *f, const void *value, size_t bytes)
{
    for (size_t i = bytes; i-- > 0;) /* big-endian */
        fputc(((const unsigned char *)value)[i], f);
}

static const char *write_small(const small *s)
{
    const char *path = scratch("damage.vtk");
    const int32_t type = 10;
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fprintf(f, "# vtk DataFile Version 3.0\nsmall\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS %lld double\n",
            s->n_point);
    for (int i = 0; i < 15; i++)
        put(f, &s->point[0][0] + i, sizeof(double));
    fprintf(f, "\nCELLS %lld %lld\n", s->n_cell, 5 * s->n_cell);
    for (int i = 0; i < 10; i++)
        put(f, &s->cell[i], sizeof(int32_t));
    fprintf(f, "\nCELL_TYPES 2\n");
    put(f, &type, sizeof type);
    put(f, &type, sizeof type);
    fprintf(f, "\nPOINT_DATA %lld\nSCALARS %s double 1\nLOOKUP_TABLE default\n", s->n_value, s->name);
    for (int i = 0; i < 5; i++)
        put(f, &s->value[i], sizeof(double));
    assert_int_equal(fclose(f), 0);
    return path;
}

static tc_mesh_report read_small(const small *s)
{
    const char *path = write_small(s);
    const tc_prepare_options options = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    tc_mesh_report report;
    tc_error err = {0};
    tc_mesh *mesh = read_path(path, NULL);
    unlink(path);
    if (tc_mesh_prepare(mesh, &options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_mesh_get_report(&report, mesh);
    tc_mesh_destroy(&mesh);
    return report;
}

static void check_sentence(const char *text)
{
    assert_non_null(strstr(text, "damage.vtk"));
    for (const char *c = text; *c; c++)
        assert_false(iscntrl((unsigned char)*c));
}

static const char *refused(const small *s)
{
    const char *path = write_small(s), *text = refusal_of(path, NULL);
    unlink(path);
    check_sentence(text);
    return text;
}

static void test_sound_file_is_refused(void **state)
{
    (void)state;
    const small s = sound();
    const tc_mesh_report r = read_small(&s);
    assert_int_equal(r.n_tet, 2);
    assert_int_equal(r.dropped_nonfinite, 0);
    assert_int_equal(r.nonfinite_scalars, 0);
    assert_true(r.scalar_range[0] == 1 && r.scalar_range[1] == 5);
}

static void test_cells_with_infinite_points_stay(void **state)
{
    (void)state;
    const double wrong[] = {NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < 3; i++) {
        small s = sound();
        s.point[4][i] = wrong[i];
        const tc_mesh_report r = read_small(&s);
        assert_int_equal(r.n_tet, 1);
        assert_int_equal(r.dropped_nonfinite, 1);
        assert_true(r.bounds[0] == 0 && r.bounds[1] == 1 && r.volume > 0 && isfinite(r.volume));
    }
}

static void test_values_that_are_not_finite_go_uncounted(void **state)
{
    (void)state;
    small s = sound();
    s.value[1] = NAN;
    s.value[4] = -INFINITY;
    const tc_mesh_report r = read_small(&s);
    assert_int_equal(r.n_tet, 2);
    assert_int_equal(r.nonfinite_scalars, 2);
    assert_true(r.scalar_range[0] == 1 && r.scalar_range[1] == 4);
}

static void test_points_that_are_not_there_are_read(void **state)
{
    (void)state;
    const int32_t wrong[] = {5, -1, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < 4; i++) {
        char number[32];
        small s = sound();
        s.cell[8] = wrong[i];
        snprintf(number, sizeof number, "point %d", (int)wrong[i]);
        const char *text = refused(&s);
        assert_non_null(strstr(text, "cell 1"));
        assert_non_null(strstr(text, number));
    }
}

static void test_counts_that_cannot_be_are_believed(void **state)
{
    (void)state;
    const long long wrong[] = {-1, -5000000000, 6, 2000000000, 4000000000000};
    for (size_t i = 0; i < 5; i++)
        for (int which = 0; which < 2; which++) {
            small s = sound();
            tc_mesh *mesh = NULL;
            tc_error err = {0};
            *(which ? &s.n_cell : &s.n_point) = wrong[i];
            const char *path = write_small(&s);
            const tc_status status = tc_mesh_read(&mesh, path, NULL, NULL, &err);
            unlink(path);
            assert_null(mesh);
            assert_true(status == TC_E_FILE || status == TC_E_WORKER); /* VTK may die of it: then that is told */
            check_sentence(err.text);
        }
}

static void test_names_from_a_file_reach_the_terminal(void **state)
{
    (void)state;
    small s = sound();
    tc_read_options options = {.field = "cold"};
    s.name = "h\033[31m\302\233eat"; /* an escape sequence, and a C1 control character in UTF-8 */
    const char *path = write_small(&s), *text = refusal_of(path, &options);
    unlink(path);
    assert_non_null(strstr(text, "eat"));
    check_sentence(text);
    assert_null(strstr(text, "\302\233"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sound_file_is_refused),
        cmocka_unit_test(test_cells_with_infinite_points_stay),
        cmocka_unit_test(test_values_that_are_not_finite_go_uncounted),
        cmocka_unit_test(test_points_that_are_not_there_are_read),
        cmocka_unit_test(test_counts_that_cannot_be_are_believed),
        cmocka_unit_test(test_names_from_a_file_reach_the_terminal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
