/* Another step or field on a mesh that was read (tc_mesh_read_values), and fields beside it (tc_field_read). */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh/field.h"
#include "read_files.h"

#include <math.h>
#include <sys/resource.h>

/* Two cubes and a tet on top; shift moves the last point. */
static void make_grid(grid *g, double shift)
{
    memset(g, 0, sizeof *g);
    for (int i = 0; i < 12; i++)
        add_point(g, i / 4, i % 4 == 1 || i % 4 == 2, i % 4 > 1);
    add_point(g, 0.5, 0.5, 2 + shift);
    add_cell(g, 12, 8, (const int[]){0, 4, 5, 1, 3, 7, 6, 2});
    add_cell(g, 12, 8, (const int[]){4, 8, 9, 5, 7, 11, 10, 6});
    add_cell(g, 10, 4, (const int[]){2, 3, 7, 12});
}

/* A file of that grid, whose point array P is `base` plus 1 a point and whose cell array C is `base` times 10 plus 1 a
 * cell. */
static void write_step(const char *path, const grid *g, double base)
{
    char points[2048], cells[1024];
    int n = snprintf(points, sizeof points, "<DataArray type=\"Float64\" Name=\"P\" format=\"ascii\">");
    for (int i = 0; i < g->n_point; i++)
        n += snprintf(points + n, sizeof points - (size_t)n, "%g ", base + i);
    snprintf(points + n, sizeof points - (size_t)n, "</DataArray>");
    n = snprintf(cells, sizeof cells, "<DataArray type=\"Float64\" Name=\"C\" format=\"ascii\">");
    for (int i = 0; i < g->n_cell; i++)
        n += snprintf(cells + n, sizeof cells - (size_t)n, "%g ", 10 * base + i);
    snprintf(cells + n, sizeof cells - (size_t)n, "</DataArray>");
    write_vtu(path, g, points, cells);
}

typedef struct files {
    char step[4][512], list[512]; /* the last step's mesh has moved */
} files;

static int set_up(void **state)
{
    static files f;
    static grid g;
    static const char *const name[4] = {"step0.vtu", "step1.vtu", "step2.vtu", "step3.vtu"};
    for (int i = 0; i < 4; i++) {
        snprintf(f.step[i], sizeof f.step[i], "%s", scratch(name[i]));
        make_grid(&g, i == 3 ? 0.125 : 0);
        write_step(f.step[i], &g, 100 * i);
    }
    snprintf(f.list, sizeof f.list, "%s", scratch("steps.pvd"));
    FILE *file = fopen(f.list, "wb");
    assert_non_null(file);
    fprintf(file, "<VTKFile type=\"Collection\"><Collection>\n");
    for (int i = 0; i < 4; i++)
        fprintf(file, "<DataSet timestep=\"%g\" file=\"%s\"/>\n", 0.5 * i, f.step[i]);
    fprintf(file, "</Collection></VTKFile>\n");
    assert_int_equal(fclose(file), 0);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    files *f = *state;
    for (int i = 0; i < 4; i++)
        unlink(f->step[i]);
    unlink(f->list);
    return 0;
}

static tc_read_options step_of(const char *field, int step)
{
    return (tc_read_options){.field = field, .has_step = true, .step = step};
}

static tc_mesh *read_prepared(const char *path, tc_read_options options, bool keep)
{
    options.keep_reader = keep;
    tc_mesh *mesh = read_path(path, &options);
    prepared(mesh);
    return mesh;
}

static void must_be_alike(const tc_mesh *a, const tc_mesh *b)
{
    const size_t n = a->association == TC_CELL_DATA ? a->n_tet : a->n_vertex;
    assert_int_equal(a->n_vertex, b->n_vertex);
    assert_int_equal(a->n_tet, b->n_tet);
    assert_memory_equal(a->vertex, b->vertex, 3 * a->n_vertex * sizeof *a->vertex);
    assert_memory_equal(a->tet, b->tet, 4 * a->n_tet * sizeof *a->tet);
    assert_int_equal(a->association, b->association);
    assert_memory_equal(a->scalar, b->scalar, n * sizeof *a->scalar);
    assert_string_equal(a->field_name, b->field_name);
    assert_memory_equal(a->report.scalar_range, b->report.scalar_range, sizeof a->report.scalar_range);
    assert_string_equal(a->source->field, b->source->field);
    assert_int_equal(a->source->step, b->source->step);
    assert_int_equal(a->source->n_time, b->source->n_time);
    assert_int_equal(a->source->n_array, b->source->n_array);
}

static void values_are_not_those_of_the_step_read_anew(void **state)
{
    const files *f = *state;
    static const struct {
        const char *field;
        int step;
    } next[] = {{"P", 1}, {"C", 1}, {"C", 2}, {"P", 2}, {"P", 0}, {NULL, 1}, {"C", -4}};
    for (int keep = 0; keep < 2; keep++) {
        tc_mesh *mesh = read_prepared(f->list, step_of("P", 0), keep);
        for (size_t i = 0; i < sizeof next / sizeof *next; i++) {
            const tc_read_options options = step_of(next[i].field, next[i].step);
            const uint64_t serial = mesh->serial, values = mesh->scalar_serial;
            tc_mesh *moved = (tc_mesh *)&moved;
            tc_error err = {0};
            if (tc_mesh_read_values(&moved, mesh, f->list, &options, NULL, &err) != TC_OK)
                fail_msg("%s", err.text);
            assert_null(moved);
            assert_true(mesh->serial == serial && mesh->scalar_serial != values);
            tc_mesh *fresh = read_prepared(f->list, options, false);
            must_be_alike(mesh, fresh);
            tc_mesh_destroy(&fresh);
        }
        tc_mesh_destroy(&mesh);
    }
}

static void another_file_of_the_same_mesh_is_refused(void **state)
{
    const files *f = *state;
    tc_mesh *mesh = read_prepared(f->step[0], (tc_read_options){.field = "P"}, true);
    const tc_read_options options = {.field = "C"};
    assert_int_equal(tc_mesh_read_values(NULL, mesh, f->step[2], &options, NULL, NULL), TC_OK);
    tc_mesh *fresh = read_prepared(f->step[2], options, false);
    must_be_alike(mesh, fresh);
    assert_string_equal(mesh->source->path, f->step[2]);
    tc_mesh_destroy(&fresh);
    tc_mesh_destroy(&mesh);
}

static void a_moved_mesh_is_not_told(void **state)
{
    const files *f = *state;
    const tc_read_options last = step_of("P", 3), second = step_of("P", 1);
    tc_mesh *mesh = read_prepared(f->list, step_of("P", 0), true), *moved = NULL;
    tc_error err = {0};
    assert_int_equal(tc_mesh_read_values(NULL, mesh, f->list, &last, NULL, &err), TC_E_MOVED);
    assert_non_null(strstr(err.text, "step 3"));
    assert_int_equal(mesh->source->step, 0);
    assert_true(mesh->report.scalar_range[0] < 50);
    assert_int_equal(tc_mesh_read_values(&moved, mesh, f->list, &last, NULL, &err), TC_E_MOVED);
    assert_non_null(moved);
    assert_false(moved->prepared);
    assert_true(moved->reader && !mesh->reader); /* goes on with the mesh that is read next */
    prepared(moved);
    tc_mesh *fresh = read_prepared(f->list, last, false);
    must_be_alike(moved, fresh);
    tc_mesh_destroy(&fresh);
    /* both go on: the old one gets another reader */
    tc_mesh *again = NULL;
    assert_int_equal(tc_mesh_read_values(NULL, mesh, f->list, &second, NULL, &err), TC_OK);
    assert_int_equal(tc_mesh_read_values(&again, moved, f->list, &second, NULL, &err), TC_E_MOVED);
    prepared(again);
    must_be_alike(again, mesh);
    tc_mesh_destroy(&again);
    tc_mesh_destroy(&moved);
    tc_mesh_destroy(&mesh);
}

/* Equal coordinates and other cells; and one point at two places in the list. */
static void other_cells_are_taken_for_the_same(void **state)
{
    const files *f = *state;
    static grid g;
    make_grid(&g, 0);
    g.id[g.n_id - 1] = 11; /* the tet on top goes elsewhere */
    const char *path = scratch("cells.vtu");
    write_step(path, &g, 0);
    tc_mesh *mesh = read_prepared(f->step[0], (tc_read_options){.field = "P"}, true);
    assert_int_equal(tc_mesh_read_values(NULL, mesh, path, NULL, NULL, NULL), TC_E_MOVED);
    unlink(path);
    tc_mesh_destroy(&mesh);
}

/* Points at one place are merged where their values are equal; a step where they differ needs a mesh of its own. */
static void a_seam_that_opens_keeps_one_value(void **state)
{
    (void)state;
    static grid g;
    make_grid(&g, 0);
    const int twin = add_point(&g, g.point[7][0], g.point[7][1], g.point[7][2]);
    g.id[g.n_id - 2] = twin;
    const char *closed = scratch("closed.vtu"), *open = scratch("open.vtu");
    write_vtu(closed, &g,
              "<DataArray type=\"Float64\" Name=\"P\" format=\"ascii\">0 0 0 0 0 0 0 5 0 0 0 0 1 5</DataArray>", "");
    write_vtu(open, &g,
              "<DataArray type=\"Float64\" Name=\"P\" format=\"ascii\">0 0 0 0 0 0 0 5 0 0 0 0 1 6</DataArray>", "");
    tc_mesh *mesh = read_prepared(closed, (tc_read_options){0}, true), *moved = NULL;
    assert_int_equal(mesh->report.merged_vertices, 1);
    assert_int_equal(tc_mesh_read_values(&moved, mesh, open, NULL, NULL, NULL), TC_E_MOVED);
    assert_int_equal(prepared(moved).merged_vertices, 0);
    assert_true(mesh->report.scalar_range[1] == 5 && moved->report.scalar_range[1] == 6);
    tc_mesh_destroy(&moved);
    tc_mesh_destroy(&mesh);
    unlink(closed);
    unlink(open);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) /* they need address space themselves */
/* An answer that finds no memory ends the reader; the mesh gets another one. */
static void a_reader_that_was_put_down_is_asked_again(void **state)
{
    const files *f = *state;
    tc_mesh *mesh = read_prepared(f->list, step_of("P", 0), true);
    const tc_read_options second = step_of("P", 1);
    tc_error err = {0};
    struct rlimit before;
    assert_non_null(mesh->reader);
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    const struct rlimit none = {.rlim_cur = 1, .rlim_max = before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_AS, &none), 0);
    const tc_status status = tc_mesh_read_values(NULL, mesh, f->list, &second, NULL, &err);
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    assert_int_equal(status, TC_E_MEMORY);
    assert_null(mesh->reader);
    assert_int_equal(mesh->source->step, 0);
    assert_int_equal(tc_mesh_read_values(NULL, mesh, f->list, &second, NULL, &err), TC_OK);
    tc_mesh_destroy(&mesh);
}
#endif

static void a_failure_changes_the_mesh(void **state)
{
    const files *f = *state;
    tc_mesh *mesh = read_prepared(f->list, step_of("P", 1), true), *moved = NULL;
    const tc_read_options none = step_of("nothing", 1), beyond = step_of("P", 9);
    const uint64_t values = mesh->scalar_serial;
    tc_error err = {0};
    assert_int_equal(tc_mesh_read_values(&moved, mesh, f->list, &none, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "nothing"));
    assert_int_equal(tc_mesh_read_values(&moved, mesh, f->list, &beyond, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "no step 9"));
    assert_null(moved);
    assert_true(mesh->scalar_serial == values);
    assert_int_equal(mesh->source->step, 1);
    const tc_read_options good = step_of("P", 2); /* the reader lives on */
    assert_int_equal(tc_mesh_read_values(&moved, mesh, f->list, &good, NULL, &err), TC_OK);
    assert_true(mesh->report.scalar_range[0] == 200);
    tc_mesh_destroy(&mesh);
}

static void a_mesh_that_was_not_read_takes_a_file(void **state)
{
    const files *f = *state;
    static const double vertex[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const int32_t tet[4] = {0, 1, 2, 3};
    const tc_mesh_arrays arrays = {.n_vertex = 4, .vertex = vertex, .n_tet = 1, .tet = tet};
    tc_mesh *mesh = NULL;
    assert_int_equal(tc_mesh_create(&mesh, &arrays, NULL), TC_OK);
    assert_int_equal(tc_mesh_read_values(NULL, mesh, f->step[0], NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_read_values(NULL, NULL, f->step[0], NULL, NULL, NULL), TC_E_ARG);
    tc_field *field = NULL;
    assert_int_equal(tc_field_read(&field, mesh, f->step[0], NULL, NULL, NULL), TC_E_ARG);
    tc_mesh_destroy(&mesh);
}

/* A mesh with values of its own, and the fields that a fresh mesh would have as its values. */
static void fields_are_not_the_values_of_the_step_read_anew(void **state)
{
    const files *f = *state;
    static const struct {
        const char *field;
        int step;
    } next[] = {{"C", 0}, {"P", 1}, {"C", 2}, {NULL, 1}};
    for (int keep = 0; keep < 2; keep++) {
        tc_mesh *mesh = read_prepared(f->list, step_of("P", 0), keep);
        tc_mesh *before = read_prepared(f->list, step_of("P", 0), false);
        const uint64_t serial = mesh->serial, values = mesh->scalar_serial;
        const tc_source *source = mesh->source;
        for (size_t i = 0; i < sizeof next / sizeof *next; i++) {
            const tc_read_options options = step_of(next[i].field, next[i].step);
            tc_field *field = NULL;
            tc_error err = {0};
            if (tc_field_read(&field, mesh, f->list, &options, NULL, &err) != TC_OK)
                fail_msg("%s", err.text);
            tc_mesh *fresh = read_prepared(f->list, options, false);
            assert_int_equal(field->association, fresh->association);
            assert_int_equal(field->n, fresh->association == TC_CELL_DATA ? fresh->n_tet : fresh->n_vertex);
            assert_memory_equal(field->value, fresh->scalar, field->n * sizeof *field->value);
            assert_memory_equal(field->range, fresh->report.scalar_range, sizeof field->range);
            assert_string_equal(field->name, fresh->field_name);
            tc_mesh_destroy(&fresh);
            tc_field_destroy(&field);
        }
        assert_true(mesh->reader != NULL); /* the next one is sooner there */
        assert_true(mesh->serial == serial && mesh->scalar_serial == values && mesh->source == source);
        must_be_alike(mesh, before);
        tc_mesh_destroy(&before);
        tc_mesh_destroy(&mesh);
    }
}

static void a_field_is_taken_from_where_it_does_not_fit(void **state)
{
    const files *f = *state;
    const tc_read_options last = step_of("P", 3), none = step_of("nothing", 0), good = step_of("C", 0);
    tc_mesh *mesh = read_path(f->list, &(tc_read_options){.field = "P", .has_step = true});
    tc_field *field = (tc_field *)&field;
    tc_error err = {0};
    assert_int_equal(tc_field_read(&field, mesh, f->list, &good, NULL, &err), TC_E_ARG);
    assert_null(field);
    assert_non_null(strstr(err.text, "tc_mesh_prepare"));
    prepared(mesh);
    assert_int_equal(tc_field_read(&field, mesh, f->list, &last, NULL, &err), TC_E_MOVED);
    assert_non_null(strstr(err.text, "step 3"));
    assert_int_equal(tc_field_read(&field, mesh, f->list, &none, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "nothing"));
    assert_null(field);
    assert_int_equal(tc_field_read(&field, mesh, f->list, &good, NULL, &err), TC_OK);
    tc_field_destroy(&field);
    tc_mesh_destroy(&mesh);
}

static void a_file_without_arrays_gives_a_field(void **state)
{
    (void)state;
    static grid g;
    make_grid(&g, 0);
    const char *path = scratch("bare.vtu");
    write_vtu(path, &g, "", "");
    tc_mesh *mesh = read_prepared(path, (tc_read_options){0}, true);
    tc_field *field = NULL;
    tc_error err = {0};
    assert_int_equal(tc_field_read(&field, mesh, path, NULL, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "no array"));
    assert_null(field);
    unlink(path);
    tc_mesh_destroy(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_are_not_those_of_the_step_read_anew),
        cmocka_unit_test(another_file_of_the_same_mesh_is_refused),
        cmocka_unit_test(a_moved_mesh_is_not_told),
        cmocka_unit_test(other_cells_are_taken_for_the_same),
        cmocka_unit_test(a_seam_that_opens_keeps_one_value),
        cmocka_unit_test(a_failure_changes_the_mesh),
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
        cmocka_unit_test(a_reader_that_was_put_down_is_asked_again),
#endif
        cmocka_unit_test(a_mesh_that_was_not_read_takes_a_file),
        cmocka_unit_test(fields_are_not_the_values_of_the_step_read_anew),
        cmocka_unit_test(a_field_is_taken_from_where_it_does_not_fit),
        cmocka_unit_test(a_file_without_arrays_gives_a_field),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
