/* Steps that are read on a thread while the mesh is in use (tc_mesh_ahead_begin, tc_mesh_ahead_end). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh/field.h"
#include "read_files.h"

#include <math.h>

/* A hexahedron with a tet on top; shift moves the last point. */
static void make_grid(grid *g, double shift)
{
    memset(g, 0, sizeof *g);
    for (int i = 0; i < 8; i++)
        add_point(g, i / 4, i % 4 == 1 || i % 4 == 2, i % 4 > 1);
    add_point(g, 0.5, 0.5, 2 + shift);
    add_cell(g, 12, 8, (const int[]){0, 4, 5, 1, 3, 7, 6, 2});
    add_cell(g, 10, 4, (const int[]){2, 3, 7, 8});
}

/* A file of that grid, whose point array P is `base` plus 1 a point and whose cell array C is minus `base` plus 1 a
 * cell. */
static void write_step(const char *path, const grid *g, double base)
{
    char points[1024], cells[512];
    int n = snprintf(points, sizeof points, "<DataArray type=\"Float64\" Name=\"P\" format=\"ascii\">");
    for (int i = 0; i < g->n_point; i++)
        n += snprintf(points + n, sizeof points - (size_t)n, "%g ", base + i);
    snprintf(points + n, sizeof points - (size_t)n, "</DataArray>");
    n = snprintf(cells, sizeof cells, "<DataArray type=\"Float64\" Name=\"C\" format=\"ascii\">");
    for (int i = 0; i < g->n_cell; i++)
        n += snprintf(cells + n, sizeof cells - (size_t)n, "%g ", i - base);
    snprintf(cells + n, sizeof cells - (size_t)n, "</DataArray>");
    write_vtu(path, g, points, cells);
}

enum { STEPS = 6, MOVED = 4, DAMAGED = 2 }; /* from MOVED on the mesh is another; DAMAGED is cut short */

typedef struct files {
    char step[STEPS][512], list[512];
} files;

static int set_up(void **state)
{
    static files f;
    static grid g;
    for (int i = 0; i < STEPS; i++) {
        char name[32];
        snprintf(name, sizeof name, "ahead%d.vtu", i);
        snprintf(f.step[i], sizeof f.step[i], "%s", scratch(name));
        make_grid(&g, i >= MOVED ? 0.25 : 0);
        write_step(f.step[i], &g, 100 * i);
    }
    assert_int_equal(truncate(f.step[DAMAGED], 500), 0);
    snprintf(f.list, sizeof f.list, "%s", scratch("ahead.pvd"));
    FILE *file = fopen(f.list, "wb");
    assert_non_null(file);
    fprintf(file, "<VTKFile type=\"Collection\"><Collection>\n");
    for (int i = 0; i < STEPS; i++)
        fprintf(file, "<DataSet timestep=\"%g\" file=\"%s\"/>\n", 0.5 * i, f.step[i]);
    fprintf(file, "</Collection></VTKFile>\n");
    assert_int_equal(fclose(file), 0);
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    files *f = *state;
    for (int i = 0; i < STEPS; i++)
        unlink(f->step[i]);
    unlink(f->list);
    return 0;
}

static tc_read_options step_of(const char *field, int step)
{
    return (tc_read_options){.field = field, .has_step = true, .step = step};
}

static tc_mesh *read_prepared(const char *path, tc_read_options options)
{
    options.keep_reader = true;
    tc_mesh *mesh = read_path(path, &options);
    prepared(mesh);
    return mesh;
}

static tc_mesh_ahead *begin(tc_mesh *mesh, const char *path, const tc_read_options *options,
                            const tc_prepare_options *prepare)
{
    tc_mesh_ahead *ahead = NULL;
    tc_error err = {0};
    if (tc_mesh_ahead_begin(&ahead, mesh, path, options, prepare, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_non_null(ahead);
    return ahead;
}

static void must_be_alike(const tc_mesh *a, const tc_mesh *b)
{
    const size_t n = a->association == TC_CELL_DATA ? a->n_tet : a->n_vertex;
    assert_int_equal(a->prepared, b->prepared);
    assert_int_equal(a->n_vertex, b->n_vertex);
    assert_int_equal(a->n_tet, b->n_tet);
    assert_memory_equal(a->vertex, b->vertex, 3 * a->n_vertex * sizeof *a->vertex);
    assert_memory_equal(a->tet, b->tet, 4 * a->n_tet * sizeof *a->tet);
    assert_int_equal(a->association, b->association);
    assert_memory_equal(a->scalar, b->scalar, n * sizeof *a->scalar);
    assert_string_equal(a->field_name, b->field_name);
    assert_memory_equal(a->report.scalar_range, b->report.scalar_range, sizeof a->report.scalar_range);
    assert_string_equal(a->source->field, b->source->field);
    assert_string_equal(a->source->path, b->source->path);
    assert_int_equal(a->source->step, b->source->step);
    assert_int_equal(a->source->n_time, b->source->n_time);
}

/* The name of the array and of the file may be gone as soon as begin is back. */
static void values_read_ahead_are_not_those_of_the_step(void **state)
{
    const files *f = *state;
    static const struct {
        const char *field;
        int step;
    } next[] = {{"P", 1}, {"C", 1}, {"C", 3}, {"P", 0}, {NULL, 3}, {"C", -6}};
    tc_mesh *mesh = read_prepared(f->list, step_of("P", 0));
    for (size_t i = 0; i < sizeof next / sizeof *next; i++) {
        char path[512], field[8] = "";
        snprintf(path, sizeof path, "%s", f->list);
        snprintf(field, sizeof field, "%s", next[i].field ? next[i].field : "");
        const tc_read_options options = step_of(next[i].field ? field : NULL, next[i].step);
        tc_mesh *before = read_prepared(f->list, step_of(mesh->field_name, mesh->source->step));
        const uint64_t serial = mesh->serial, values = mesh->scalar_serial;
        tc_mesh_ahead *ahead = begin(mesh, path, &options, NULL);
        memset(path, '!', sizeof path);
        memset(field, '!', sizeof field);
        must_be_alike(mesh, before); /* until the end */
        tc_mesh_destroy(&before);
        tc_mesh *moved = (tc_mesh *)&moved;
        tc_error err = {0};
        if (tc_mesh_ahead_end(&moved, mesh, &ahead, NULL, &err) != TC_OK)
            fail_msg("%s", err.text);
        assert_null(ahead);
        assert_null(moved);
        assert_true(mesh->serial == serial && mesh->scalar_serial != values);
        tc_mesh *fresh = read_prepared(f->list, step_of(next[i].field, next[i].step));
        must_be_alike(mesh, fresh);
        tc_mesh_destroy(&fresh);
    }
    assert_true(mesh->reader && !mesh->ahead);
    tc_mesh_destroy(&mesh);
}

/* A series whose steps are files: each begin names another one. */
static void another_file_is_not_read_ahead(void **state)
{
    const files *f = *state;
    tc_mesh *mesh = read_prepared(f->step[0], (tc_read_options){.field = "P"});
    const tc_read_options options = {.field = "P"};
    static const int next[] = {1, 3, 0};
    for (int i = 0; i < 3; i++) {
        tc_mesh_ahead *ahead = begin(mesh, f->step[next[i]], &options, NULL);
        assert_int_equal(tc_mesh_ahead_end(NULL, mesh, &ahead, NULL, NULL), TC_OK);
        assert_string_equal(mesh->source->path, f->step[next[i]]);
        assert_true(mesh->report.scalar_range[0] == 100 * next[i]);
    }
    tc_mesh_destroy(&mesh);
}

static void a_moved_mesh_is_not_read_or_prepared_ahead(void **state)
{
    const files *f = *state;
    const tc_prepare_options how = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    const tc_read_options far = step_of("P", MOVED), further = step_of("P", MOVED + 1);
    for (int prepare = 0; prepare < 2; prepare++) {
        tc_mesh *mesh = read_prepared(f->list, step_of("P", 0)), *moved = NULL;
        tc_error err = {0};
        tc_mesh_ahead *ahead = begin(mesh, f->list, &far, prepare ? &how : NULL);
        assert_int_equal(tc_mesh_ahead_end(&moved, mesh, &ahead, NULL, &err), TC_E_MOVED);
        assert_non_null(strstr(err.text, "step 4"));
        assert_non_null(moved);
        assert_int_equal(moved->prepared, prepare);
        assert_int_equal(mesh->source->step, 0);
        assert_true(moved->reader && !mesh->reader);
        tc_mesh_destroy(&mesh);
        if (!prepare)
            prepared(moved);
        tc_mesh *fresh = read_prepared(f->list, far);
        must_be_alike(moved, fresh);
        tc_mesh_destroy(&fresh);
        ahead = begin(moved, f->list, &further, &how); /* the next step has the points of this one */
        assert_int_equal(tc_mesh_ahead_end(&mesh, moved, &ahead, NULL, &err), TC_OK);
        assert_null(mesh);
        assert_int_equal(moved->source->step, MOVED + 1);
        assert_true(moved->report.scalar_range[0] == 100 * (MOVED + 1));
        tc_mesh_destroy(&moved);
    }
}

/* Who does not want the moved mesh gets the error alone. */
static void a_moved_mesh_that_is_not_wanted_leaks(void **state)
{
    const files *f = *state;
    const tc_prepare_options how = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    const tc_read_options far = step_of("P", MOVED), near = step_of("P", 1);
    tc_mesh *mesh = read_prepared(f->list, step_of("P", 0));
    tc_mesh_ahead *ahead = begin(mesh, f->list, &far, &how);
    assert_int_equal(tc_mesh_ahead_end(NULL, mesh, &ahead, NULL, NULL), TC_E_MOVED);
    ahead = begin(mesh, f->list, &near, &how);
    assert_int_equal(tc_mesh_ahead_end(NULL, mesh, &ahead, NULL, NULL), TC_OK);
    assert_int_equal(mesh->source->step, 1);
    tc_mesh_destroy(&mesh);
}

/* Points at one place were merged for equal values; in the step that is read ahead they differ. */
static void a_seam_that_opens_ahead_keeps_one_value(void **state)
{
    (void)state;
    static grid g;
    make_grid(&g, 0);
    const int twin = add_point(&g, g.point[7][0], g.point[7][1], g.point[7][2]);
    g.id[g.n_id - 2] = twin;
    const char *closed = scratch("closed.vtu"), *open = scratch("open.vtu");
    const char *array = "<DataArray type=\"Float64\" Name=\"P\" format=\"ascii\">0 0 0 0 0 0 0 5 1 %d</DataArray>";
    char text[256];
    snprintf(text, sizeof text, array, 5);
    write_vtu(closed, &g, text, "");
    snprintf(text, sizeof text, array, 6);
    write_vtu(open, &g, text, "");
    const tc_prepare_options how = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    for (int late = 0; late < 3; late++) {
        tc_mesh *mesh = read_path(closed, &(tc_read_options){.keep_reader = true}), *moved = NULL;
        if (late < 2)
            prepared(mesh);
        tc_mesh_ahead *ahead = begin(mesh, open, NULL, &how);
        if (late == 2) /* they are merged meanwhile */
            prepared(mesh);
        assert_int_equal(mesh->report.merged_vertices, 1);
        if (late == 1) { /* after the reader is back */
            tc_field *field = NULL;
            assert_int_equal(tc_field_read(&field, mesh, closed, NULL, NULL, NULL), TC_OK);
            tc_field_destroy(&field);
        }
        assert_int_equal(tc_mesh_ahead_end(&moved, mesh, &ahead, NULL, NULL), TC_E_MOVED);
        assert_true(moved->prepared);
        assert_int_equal(moved->report.merged_vertices, 0);
        assert_true(mesh->report.scalar_range[1] == 5 && moved->report.scalar_range[1] == 6);
        ahead = begin(moved, closed, NULL, NULL);
        assert_int_equal(tc_mesh_ahead_end(NULL, moved, &ahead, NULL, NULL), TC_OK);
        assert_true(moved->report.scalar_range[1] == 5);
        tc_mesh_destroy(&moved);
        tc_mesh_destroy(&mesh);
    }
    unlink(closed);
    unlink(open);
}

/* What needs the reader waits for it, and the values that are ahead stay what they are. */
static void a_field_read_meanwhile_disturbs_the_step_ahead(void **state)
{
    const files *f = *state;
    const tc_read_options next = step_of("P", 3), other = step_of("C", 1), last = step_of("P", 1);
    tc_mesh *mesh = read_prepared(f->list, step_of("P", 0));
    tc_mesh_ahead *ahead = begin(mesh, f->list, &next, NULL);
    tc_field *field = NULL;
    tc_error err = {0};
    if (tc_field_read(&field, mesh, f->list, &other, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_true(field->range[0] == -100 && field->range[1] == -99);
    assert_int_equal(mesh->source->step, 0);
    assert_int_equal(tc_mesh_ahead_end(NULL, mesh, &ahead, NULL, &err), TC_OK);
    assert_true(mesh->report.scalar_range[0] == 300);
    tc_field_destroy(&field);
    ahead = begin(mesh, f->list, &next, NULL);
    assert_int_equal(tc_mesh_read_values(NULL, mesh, f->list, &last, NULL, &err), TC_OK);
    assert_int_equal(mesh->source->step, 1);
    assert_int_equal(tc_mesh_ahead_end(NULL, mesh, &ahead, NULL, &err), TC_OK);
    assert_int_equal(mesh->source->step, 3);
    tc_mesh_destroy(&mesh);
}

/* Not wanted; the mesh then takes other steps, by the reader that it had. */
static void a_step_that_is_not_wanted_holds_the_mesh(void **state)
{
    const files *f = *state;
    const tc_prepare_options how = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    const tc_read_options next = step_of("P", 3), far = step_of("P", MOVED), none = step_of("nothing", 1);
    tc_mesh *mesh = read_prepared(f->list, step_of("P", 0));
    const uint64_t values = mesh->scalar_serial;
    const tc_read_options *const all[] = {&next, &far, &none};
    for (size_t i = 0; i < 3; i++) {
        tc_mesh_ahead *ahead = begin(mesh, f->list, all[i], &how);
        tc_mesh *moved = (tc_mesh *)&moved;
        assert_int_equal(tc_mesh_ahead_end(&moved, NULL, &ahead, NULL, NULL), TC_OK);
        assert_null(ahead);
        assert_null(moved);
        assert_true(mesh->scalar_serial == values && mesh->reader);
    }
    assert_int_equal(tc_mesh_read_values(NULL, mesh, f->list, &next, NULL, NULL), TC_OK);
    assert_int_equal(mesh->source->step, 3);
    /* the mesh may be gone before the end that cancels */
    tc_mesh_ahead *ahead = begin(mesh, f->list, &far, &how);
    tc_mesh_destroy(&mesh);
    assert_int_equal(tc_mesh_ahead_end(NULL, NULL, &ahead, NULL, NULL), TC_OK);
}

static void a_bad_step_stops_those_after_it(void **state)
{
    const files *f = *state;
    char gone[512];
    snprintf(gone, sizeof gone, "%s", scratch("gone.vtu"));
    tc_mesh *mesh = read_prepared(f->step[0], (tc_read_options){.field = "P"}), *moved = NULL;
    const tc_read_options options = {.field = "P"}, none = {.field = "nothing"};
    const struct {
        const char *path;
        const tc_read_options *options;
        const char *says;
    } bad[] = {{gone, &options, gone}, {f->step[DAMAGED], &options, f->step[DAMAGED]}, {f->step[1], &none, "nothing"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const uint64_t values = mesh->scalar_serial;
        tc_error err = {0};
        tc_mesh_ahead *ahead = begin(mesh, bad[i].path, bad[i].options, NULL);
        assert_int_equal(tc_mesh_ahead_end(&moved, mesh, &ahead, NULL, &err), TC_E_FILE);
        assert_null(ahead);
        assert_null(moved);
        assert_non_null(strstr(err.text, bad[i].says));
        assert_null(strchr(err.text, '\n'));
        assert_true(mesh->scalar_serial == values);
        ahead = begin(mesh, f->step[3], &options, NULL);
        assert_int_equal(tc_mesh_ahead_end(&moved, mesh, &ahead, NULL, &err), TC_OK);
        assert_true(mesh->report.scalar_range[0] == 300);
        ahead = begin(mesh, f->step[1], &options, NULL);
        assert_int_equal(tc_mesh_ahead_end(&moved, mesh, &ahead, NULL, &err), TC_OK);
        assert_true(mesh->report.scalar_range[0] == 100);
    }
    tc_mesh_destroy(&mesh);
}

/* A mesh that moves to where nothing can be prepared: none of its cells has finite points. */
static void a_failure_to_prepare_gives_a_mesh(void **state)
{
    const files *f = *state;
    const char *path = scratch("infinite.vtk");
    FILE *file = fopen(path, "wb"); /* binary: VTK reads no "inf" as text */
    assert_non_null(file);
    fprintf(file, "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n");
    static const unsigned char inf[8] = {0x7f, 0xf0}, one[8] = {0x3f, 0xf0}, zero[8] = {0};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            fwrite(k == 0 ? inf : i == k ? one : zero, 8, 1, file);
    fprintf(file, "\nCELLS 1 5\n");
    static const unsigned char cell[20] = {0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
    fwrite(cell, sizeof cell, 1, file);
    fprintf(file, "\nCELL_TYPES 1\n");
    static const unsigned char type[4] = {0, 0, 0, 10};
    fwrite(type, sizeof type, 1, file);
    fprintf(file, "\nPOINT_DATA 4\nSCALARS P double 1\nLOOKUP_TABLE default\n");
    for (int i = 0; i < 4; i++)
        fwrite(one, 8, 1, file);
    fprintf(file, "\n");
    assert_int_equal(fclose(file), 0);
    const tc_prepare_options how = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    const tc_read_options options = {.field = "P"};
    tc_mesh *mesh = read_prepared(f->step[0], options), *moved = NULL;
    tc_error err = {0};
    tc_mesh_ahead *ahead = begin(mesh, path, &options, &how);
    assert_int_equal(tc_mesh_ahead_end(&moved, mesh, &ahead, NULL, &err), TC_E_MESH);
    assert_null(moved);
    assert_non_null(strstr(err.text, path));
    assert_non_null(strstr(err.text, "not finite"));
    ahead = begin(mesh, f->step[1], &options, &how);
    assert_int_equal(tc_mesh_ahead_end(&moved, mesh, &ahead, NULL, &err), TC_OK);
    tc_mesh_destroy(&mesh);
    unlink(path);
}

static void what_cannot_begin_begins(void **state)
{
    const files *f = *state;
    static const double vertex[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const int32_t tet[4] = {0, 1, 2, 3};
    const tc_mesh_arrays arrays = {.n_vertex = 4, .vertex = vertex, .n_tet = 1, .tet = tet};
    tc_mesh *own = NULL;
    assert_int_equal(tc_mesh_create(&own, &arrays, NULL), TC_OK);
    tc_mesh *mesh = read_prepared(f->step[0], (tc_read_options){.field = "P"});
    tc_mesh_ahead *ahead = (tc_mesh_ahead *)&ahead, *second = NULL;
    assert_int_equal(tc_mesh_ahead_begin(&ahead, own, f->step[0], NULL, NULL, NULL), TC_E_ARG);
    assert_null(ahead);
    assert_int_equal(tc_mesh_ahead_begin(&ahead, NULL, f->step[0], NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_ahead_begin(NULL, mesh, f->step[0], NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_ahead_begin(&ahead, mesh, NULL, NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_ahead_begin(&ahead, mesh, f->step[0], &(tc_read_options){.refine = 7}, NULL, NULL),
                     TC_E_ARG);
    assert_int_equal(tc_mesh_ahead_end(NULL, mesh, NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_ahead_end(NULL, mesh, &ahead, NULL, NULL), TC_E_ARG);
    ahead = begin(mesh, f->step[1], NULL, NULL);
    assert_int_equal(tc_mesh_ahead_begin(&second, mesh, f->step[3], NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_ahead_end(NULL, own, &ahead, NULL, NULL), TC_E_ARG); /* of another mesh */
    assert_null(ahead);
    ahead = begin(mesh, f->step[1], NULL, NULL);
    assert_int_equal(tc_mesh_ahead_end(NULL, mesh, &ahead, NULL, NULL), TC_OK);
    tc_mesh_destroy(&mesh);
    tc_mesh_destroy(&own);
}

typedef struct heard {
    int messages, progress;
    bool open;
} heard;

static void hear(void *user, tc_level level, const char *text)
{
    heard *h = user;
    (void)level;
    (void)text;
    assert_true(h->open);
    h->messages++;
}

static void hear_progress(void *user, const char *what, double fraction)
{
    heard *h = user;
    (void)what;
    (void)fraction;
    assert_true(h->open);
    h->progress++;
}

/* Two cells on one side of a face: what preparing says. */
static void what_was_said_ahead_is_lost(void **state)
{
    const files *f = *state;
    static grid g;
    make_grid(&g, 0);
    const int apex = add_point(&g, 0.5, 0.5, 3);
    add_cell(&g, 10, 4, (const int[]){2, 3, 7, apex});
    char path[512];
    snprintf(path, sizeof path, "%s", scratch("overlap.vtu"));
    write_step(path, &g, 7);
    const tc_prepare_options how = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    const tc_read_options options = {.field = "P"};
    tc_mesh *mesh = read_prepared(f->step[0], options), *moved = NULL;
    heard h = {0};
    const tc_log log = {hear, hear_progress, &h};
    tc_mesh_ahead *ahead = begin(mesh, path, &options, &how);
    h.open = true;
    assert_int_equal(tc_mesh_ahead_end(&moved, mesh, &ahead, &log, NULL), TC_E_MOVED);
    assert_int_equal(h.messages, 1);
    assert_true(h.progress >= 1);
    tc_mesh_destroy(&moved);
    tc_mesh_destroy(&mesh);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(values_read_ahead_are_not_those_of_the_step),
        cmocka_unit_test(another_file_is_not_read_ahead),
        cmocka_unit_test(a_moved_mesh_is_not_read_or_prepared_ahead),
        cmocka_unit_test(a_moved_mesh_that_is_not_wanted_leaks),
        cmocka_unit_test(a_seam_that_opens_ahead_keeps_one_value),
        cmocka_unit_test(a_field_read_meanwhile_disturbs_the_step_ahead),
        cmocka_unit_test(a_step_that_is_not_wanted_holds_the_mesh),
        cmocka_unit_test(a_bad_step_stops_those_after_it),
        cmocka_unit_test(a_failure_to_prepare_gives_a_mesh),
        cmocka_unit_test(what_cannot_begin_begins),
        cmocka_unit_test(what_was_said_ahead_is_lost),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
