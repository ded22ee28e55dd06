/* test_cache_file.c: prepared meshes in files: what comes back is what was saved, and nothing else ever does. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "cache/format.h"
#include "core/file.h"
#include "mesh/field.h"
#include "read_files.h"

#include <fcntl.h>
#include <math.h>
#include <time.h>

/* Two tets with a gap, a triangle that is left out, a point of no cell; two arrays. */
static const char text[] = "# vtk DataFile Version 3.0\n"
                           "two tets\n"
                           "ASCII\n"
                           "DATASET UNSTRUCTURED_GRID\n"
                           "POINTS 9 double\n"
                           "0 0 0  1 0 0  0 1 0  0 0 1  5 0 0  6 0 0  5 1 0  5 0 1  9 9 9\n"
                           "CELLS 3 14\n"
                           "4 0 1 2 3\n"
                           "4 4 5 6 7\n"
                           "3 0 1 2\n"
                           "CELL_TYPES 3\n"
                           "10 10 5\n"
                           "POINT_DATA 9\n"
                           "SCALARS heat double 1\n"
                           "LOOKUP_TABLE default\n"
                           "0 1 2 3 4 5 6 7 8\n"
                           "SCALARS cold double 1\n"
                           "LOOKUP_TABLE default\n"
                           "9 8 7 6 5 4 3 2 1\n";
static const tc_read_options heat = {.field = "heat"};
static const tc_prepare_options peel = {.reentry = TC_REENTRY_PEEL};
static char folder[400], mesh_path[450], cache_path[460];

static tc_cache_key key_of(const char *path, const tc_read_options *read, const tc_prepare_options *prepare)
{
    tc_cache_key key;
    tc_error err = {0};
    if (tc_cache_key_make(&key, path, read, prepare, &err) != TC_OK)
        fail_msg("%s", err.text);
    return key;
}

static bool same(tc_cache_key a, tc_cache_key b)
{
    return a.word[0] == b.word[0] && a.word[1] == b.word[1];
}

static tc_status load(tc_mesh **out, const tc_cache_key *key, tc_error *err)
{
    tc_status status = tc_mesh_load(out, cache_path, key, mesh_path, 2, NULL, err);
    assert_true((status == TC_OK) == (*out != NULL));
    return status;
}

static void refused(const tc_cache_key *key, const char *why)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    assert_int_equal(load(&mesh, key, &err), TC_E_FILE);
    if (!strstr(err.text, why))
        fail_msg("'%s' does not say '%s'", err.text, why);
}

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "%s", scratch("cache"));
    mkdir(folder, 0777);
    snprintf(mesh_path, sizeof mesh_path, "%s/two.vtk", folder);
    snprintf(cache_path, sizeof cache_path, "%s/two.vtk.tccache", folder);
    write_text(mesh_path, text);
    return 0;
}

static int drop_folder(void **state)
{
    char command[500];
    (void)state;
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static tc_mesh *read_and_save(const tc_cache_key *key)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    tc_status status = tc_mesh_read(&mesh, mesh_path, &heat, NULL, &err);
    if (status == TC_OK)
        status = tc_mesh_prepare(mesh, &peel, NULL, &err);
    if (status == TC_OK)
        status = tc_mesh_save(mesh, cache_path, key, 2, &err);
    if (status != TC_OK)
        fail_msg("%s", err.text);
    return mesh;
}

/* ------------------------------------------------------------------------------------------------------ the file */

static void a_mesh_comes_back_as_it_was_saved(void **state)
{
    (void)state;
    const tc_cache_key key = key_of(mesh_path, &heat, &peel);
    tc_mesh *a = read_and_save(&key), *b = NULL;
    tc_error err = {0};
    assert_int_equal(load(&b, &key, &err), TC_OK);
    assert_int_equal(b->n_vertex, 8);
    assert_int_equal(b->n_tet, 2);
    assert_int_equal(b->n_vertex, a->n_vertex);
    assert_int_equal(b->n_tet, a->n_tet);
    assert_int_equal(b->n_imaginary, a->n_imaginary);
    assert_int_equal(b->n_vertex_source, a->n_vertex_source);
    assert_int_equal(b->n_tet_source, a->n_tet_source);
    assert_int_equal(b->association, TC_POINT_DATA);
    assert_memory_equal(b->vertex, a->vertex, a->n_vertex * 24);
    assert_memory_equal(b->scalar, a->scalar, a->n_vertex * 8);
    assert_memory_equal(b->tet, a->tet, a->n_tet * 16);
    assert_memory_equal(b->neighbour, a->neighbour, a->n_tet * 16);
    assert_memory_equal(b->vertex_of_source, a->vertex_of_source, a->n_vertex_source * 4);
    assert_memory_equal(b->tet_of_source, a->tet_of_source, a->n_tet_source * 4);
    assert_string_equal(b->field_name, a->field_name);
    assert_true(b->source_hash == a->source_hash && b->source_hash != 0);
    assert_true(b->serial != a->serial && b->serial != 0 && b->scalar_serial != a->scalar_serial);
    tc_mesh_report x, y;
    tc_mesh_get_report(&x, a);
    tc_mesh_get_report(&y, b);
    assert_true(isfinite(x.ms_check) && isnan(y.ms_check) && isnan(y.ms_order) && isnan(y.ms_adjacency));
    x.ms_check = x.ms_order = x.ms_adjacency = x.ms_convexify = NAN;
    y.ms_check = y.ms_order = y.ms_adjacency = y.ms_convexify = NAN;
    assert_memory_equal(&y, &x, sizeof x);
    const tc_source *s = tc_mesh_source(a), *t = tc_mesh_source(b);
    assert_string_equal(t->path, mesh_path);
    assert_string_equal(t->format, s->format);
    assert_string_equal(t->reader, s->reader);
    assert_string_equal(t->field, "heat");
    assert_int_equal(t->n_point, 9);
    assert_int_equal(t->n_array, s->n_array);
    assert_string_equal(t->array[0].name, s->array[0].name);
    assert_true(t->array[0].lo == s->array[0].lo && t->array[0].hi == s->array[0].hi);
    assert_int_equal(t->n_cell_type, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_string_equal(t->cell_type[i].type, s->cell_type[i].type);
        assert_int_equal(t->cell_type[i].count, s->cell_type[i].count);
        assert_int_equal(t->cell_type[i].dimension, s->cell_type[i].dimension);
    }
    assert_int_equal(t->dropped_cells, 1);
    assert_int_equal(t->step, s->step);
    assert_true(isnan(t->ms_read) && t->helper_peak_bytes == 0);

    /* New values find their way to the vertices of the file's points. */
    double value[8];
    for (int i = 0; i < 8; i++)
        value[i] = 10 * i;
    assert_int_equal(tc_mesh_set_scalar(a, value, TC_POINT_DATA, &err), TC_OK);
    assert_int_equal(tc_mesh_set_scalar(b, value, TC_POINT_DATA, &err), TC_OK);
    assert_memory_equal(b->scalar, a->scalar, a->n_vertex * 8);

    /* So do those of another field of the file, by the reader. */
    const tc_read_options cold = {.field = "cold"};
    assert_int_equal(tc_mesh_read_values(NULL, b, mesh_path, &cold, NULL, &err), TC_OK);
    for (size_t v = 0; v < b->n_vertex; v++)
        assert_true(b->scalar[v] == 9 - a->scalar[v] / 10);
    tc_mesh_destroy(&a);
    tc_mesh_destroy(&b);
}

/* The reader is not there yet, and the order of the file's points is in the cache alone. */
static void a_mesh_that_comes_back_has_no_fields(void **state)
{
    (void)state;
    static const tc_read_options cold = {.field = "cold"};
    const tc_cache_key key = key_of(mesh_path, &heat, &peel);
    tc_mesh *a = read_and_save(&key), *b = NULL;
    tc_field *field = NULL;
    tc_error err = {0};
    tc_mesh_destroy(&a);
    assert_int_equal(load(&b, &key, &err), TC_OK);
    if (tc_field_read(&field, b, mesh_path, &cold, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_string_equal(b->field_name, "heat");
    assert_string_equal(field->name, "cold");
    assert_int_equal(field->n, 8);
    for (size_t i = 0; i < field->n; i++)
        assert_true(field->value[i] == 9 - b->scalar[i]);
    tc_field_destroy(&field);
    tc_mesh_destroy(&b);
}

/* Numbers and names of blocks come back, and the numbers of the cells as a field. */
static void blocks_that_come_back_have_no_names(void **state)
{
    (void)state;
    static const tc_cache_key key = {{1, 2}};
    static const tc_read_options numbers = {.field = "vtkCompositeIndex"};
    static grid g;
    char box[460], vtm[460], list[1024];
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 4; i++)
        add_point(&g, i == 1, i == 2, i == 3);
    add_cell(&g, 10, 4, (int[]){0, 1, 2, 3});
    snprintf(box, sizeof box, "%s/box.vtu", folder);
    snprintf(vtm, sizeof vtm, "%s/two.vtm", folder);
    snprintf(list, sizeof list,
             "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\"><vtkMultiBlockDataSet>"
             "<DataSet index=\"0\" name=\"a block\" file=\"box.vtu\"/><DataSet index=\"1\" file=\"box.vtu\"/>"
             "</vtkMultiBlockDataSet></VTKFile>");
    write_vtu(box, &g, "", "");
    write_text(vtm, list);
    tc_mesh *a = read_path(vtm, NULL), *b = NULL;
    tc_field *field = NULL;
    tc_error err = {0};
    prepared(a);
    assert_int_equal(tc_mesh_save(a, cache_path, &key, 1, &err), TC_OK);
    tc_mesh_destroy(&a);
    assert_int_equal(tc_mesh_load(&b, cache_path, &key, vtm, 1, NULL, &err), TC_OK);
    const tc_source *s = tc_mesh_source(b);
    assert_int_equal(s->n_block, 2);
    assert_int_equal(s->block[0].number, 1);
    assert_string_equal(s->block[0].name, "a block");
    assert_int_equal(s->block[1].number, 2);
    assert_null(s->block[1].name);
    assert_string_equal(s->cell_type[0].type, "tetra"); /* what follows them is in its place */
    assert_int_equal(s->cell_type[0].count, 2);
    if (tc_field_read(&field, b, vtm, &numbers, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_true(field->value[0] == 1);
    tc_field_destroy(&field);
    tc_mesh_destroy(&b);
}

static void a_damaged_byte_anywhere_is_found(void **state)
{
    (void)state;
    const tc_cache_key key = key_of(mesh_path, &heat, &peel);
    tc_mesh *mesh = read_and_save(&key);
    tc_error err = {0};
    void *data;
    size_t n;
    tc_mesh_destroy(&mesh);
    assert_int_equal(tc_file_read(&data, &n, cache_path, &err), TC_OK);
    assert_true(n > 1000 && n < 20000);
    int fd = open(cache_path, O_WRONLY | O_CLOEXEC);
    assert_true(fd >= 0);
    for (size_t i = 0; i < n; i++) {
        unsigned char byte = ((unsigned char *)data)[i] ^ (unsigned char)(1 << i % 8);
        assert_int_equal(pwrite(fd, &byte, 1, (off_t)i), 1);
        refused(&key, cache_path);
        assert_int_equal(pwrite(fd, (char *)data + i, 1, (off_t)i), 1);
    }
    assert_int_equal(load(&mesh, &key, &err), TC_OK); /* it is whole again */
    tc_mesh_destroy(&mesh);
    assert_int_equal(pwrite(fd, "more", 4, (off_t)n), 4);
    refused(&key, "damaged");
    for (size_t i = n; i-- > 0;) {
        assert_int_equal(ftruncate(fd, (off_t)i), 0);
        refused(&key, "damaged");
    }
    close(fd);
    unlink(cache_path);
    refused(&key, "cannot be read");
    free(data);
}

/* Puts a file's head right again after a change to it. */
static void seal(void *data)
{
    tc_cache_head *head = data;
    head->own = tc_hash_bytes(head, offsetof(tc_cache_head, own), TC_CACHE_FORMAT);
}

static void another_version_or_key_is_not_taken(void **state)
{
    (void)state;
    const tc_cache_key key = key_of(mesh_path, &heat, &peel);
    tc_cache_key other = key;
    tc_mesh *mesh = read_and_save(&key);
    tc_error err = {0};
    void *data;
    size_t n;
    tc_mesh_destroy(&mesh);
    other.word[1]++;
    refused(&other, "another content");
    assert_int_equal(tc_file_read(&data, &n, cache_path, &err), TC_OK);
    tc_cache_head *head = data;
    head->format++;
    seal(data);
    assert_int_equal(tc_file_replace(cache_path, data, n, &err), TC_OK);
    refused(&key, "another version");
    head->format--;
    head->order = 0x04030201;
    seal(data);
    assert_int_equal(tc_file_replace(cache_path, data, n, &err), TC_OK);
    refused(&key, "another version");
    head->order = TC_CACHE_ORDER;
    seal(data);
    assert_int_equal(tc_file_replace(cache_path, data, n, &err), TC_OK);
    assert_int_equal(load(&mesh, &key, &err), TC_OK);
    tc_mesh_destroy(&mesh);
    free(data);
}

/* Files that are whole, but wrong, as no version of this library writes them. */
static void a_vertex_that_is_not_there_is_not_believed(void **state)
{
    (void)state;
    const tc_cache_key key = key_of(mesh_path, &heat, &peel);
    tc_mesh *mesh = read_and_save(&key);
    tc_error err = {0};
    mesh->tet[5] = 8;
    assert_int_equal(tc_mesh_save(mesh, cache_path, &key, 1, &err), TC_OK);
    refused(&key, "not there");
    mesh->tet[5] = -1;
    assert_int_equal(tc_mesh_save(mesh, cache_path, &key, 1, &err), TC_OK);
    refused(&key, "not there");
    mesh->tet[5] = 7;
    mesh->neighbour[0] = 2;
    assert_int_equal(tc_mesh_save(mesh, cache_path, &key, 1, &err), TC_OK);
    refused(&key, "not there");
    mesh->neighbour[0] = -1;
    mesh->vertex_of_source[0] = 8;
    assert_int_equal(tc_mesh_save(mesh, cache_path, &key, 1, &err), TC_OK);
    refused(&key, "not there");
    tc_mesh_destroy(&mesh);
}

static void gaps_that_a_helper_failed_at_are_tried_again(void **state)
{
    (void)state;
    const tc_cache_key key = key_of(mesh_path, &heat, NULL);
    tc_mesh *mesh = read_and_save(&key), *back = NULL;
    tc_error err = {0};
    mesh->asked = TC_REENTRY_AUTO;
    mesh->gaps_may_do = true;
    assert_int_equal(tc_mesh_save(mesh, cache_path, &key, 1, &err), TC_OK);
    assert_int_equal(load(&back, &key, &err), TC_OK);
    assert_int_equal(back->asked, TC_REENTRY_PEEL); /* so that tc_mesh_prepare with AUTO has work to do */
    tc_mesh_destroy(&back);
    mesh->gaps_may_do = false;
    assert_int_equal(tc_mesh_save(mesh, cache_path, &key, 1, &err), TC_OK);
    assert_int_equal(load(&back, &key, &err), TC_OK);
    assert_int_equal(back->asked, TC_REENTRY_AUTO);
    tc_mesh_destroy(&back);
    tc_mesh_destroy(&mesh);
}

static void no_other_file_is_written_over(void **state)
{
    (void)state;
    const tc_cache_key key = key_of(mesh_path, &heat, &peel);
    tc_mesh *mesh = read_and_save(&key);
    tc_error err = {0};
    char path[450];
    void *data;
    size_t n;
    assert_int_equal(tc_mesh_save(mesh, mesh_path, &key, 1, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "is no cache file"));
    assert_int_equal(tc_file_read(&data, &n, mesh_path, &err), TC_OK);
    assert_int_equal(n, strlen(text));
    free(data);
    snprintf(path, sizeof path, "%s/kept", folder); /* a new name, and then a cache file without the ending */
    assert_int_equal(tc_mesh_save(mesh, path, &key, 1, &err), TC_OK);
    assert_int_equal(tc_mesh_save(mesh, path, &key, 1, &err), TC_OK);
    write_text(cache_path, "damaged from its first byte on");
    assert_int_equal(tc_mesh_save(mesh, cache_path, &key, 1, &err), TC_OK);
    snprintf(path, sizeof path, "%s/missing/kept", folder);
    assert_int_equal(tc_mesh_save(mesh, path, &key, 1, &err), TC_E_FILE);
    tc_mesh_destroy(&mesh);

    tc_mesh_arrays arrays = {.n_vertex = 0};
    assert_int_equal(tc_mesh_create(&mesh, &arrays, &err), TC_OK);
    assert_int_equal(tc_mesh_save(mesh, cache_path, &key, 1, &err), TC_E_ARG);
    tc_mesh_destroy(&mesh);
}

/* ------------------------------------------------------------------------------------------------------- the key */

static void content_and_settings_are_in_the_key(void **state)
{
    (void)state;
    const tc_cache_key key = key_of(mesh_path, &heat, &peel);
    const tc_read_options reads[] = {{.field = "cold"},
                                     {0},
                                     {.field = "heat", .association = TC_POINT_DATA},
                                     {.field = "heat", .has_time = true},
                                     {.field = "heat", .has_time = true, .time = 1e-300},
                                     {.field = "heat", .has_step = true},
                                     {.field = "heat", .has_step = true, .step = -1},
                                     {.field = "heat", .refine = 1},
                                     {.field = "heat", .all_ranges = true}};
    enum { N = sizeof reads / sizeof *reads };
    tc_cache_key other[N];
    assert_true(same(key, key_of(mesh_path, &heat, &peel)));
    for (int i = 0; i < N; i++) {
        other[i] = key_of(mesh_path, &reads[i], &peel);
        assert_false(same(key, other[i]));
        for (int j = 0; j < i; j++)
            assert_false(same(other[i], other[j]));
    }
    assert_false(same(key, key_of(mesh_path, &heat, NULL)));
    const tc_prepare_options once = {.once_pixels = 512 * 512};
    assert_false(same(key_of(mesh_path, &heat, NULL), key_of(mesh_path, &heat, &once)));
    /* What changes no result is not in it. */
    const tc_read_options patient = {.field = "heat", .idle_limit_s = 5};
    const tc_prepare_options threads = {.reentry = TC_REENTRY_PEEL, .threads = 1};
    assert_true(same(key, key_of(mesh_path, &patient, &threads)));

    /* One letter, with the old size and times. */
    struct stat before;
    char changed[sizeof text];
    memcpy(changed, text, sizeof text);
    *strstr(changed, "9 9 9") = '8';
    assert_int_equal(stat(mesh_path, &before), 0);
    write_text(mesh_path, changed);
    const struct timespec times[2] = {before.st_atim, before.st_mtim};
    assert_int_equal(utimensat(AT_FDCWD, mesh_path, times, 0), 0);
    assert_false(same(key, key_of(mesh_path, &heat, &peel)));
    write_text(mesh_path, text);
    assert_true(same(key, key_of(mesh_path, &heat, &peel)));
}

static void a_file_alone_does_not_depend_on_what_lies_beside_it(void **state)
{
    (void)state;
    char beside[450];
    const tc_cache_key key = key_of(mesh_path, &heat, &peel);
    snprintf(beside, sizeof beside, "%s/beside.dat", folder);
    write_text(beside, "anything");
    assert_true(same(key, key_of(mesh_path, &heat, &peel)));
    snprintf(beside, sizeof beside, "%s/copy.vtk", folder);
    write_text(beside, text);
    assert_true(same(key, key_of(beside, &heat, &peel)));
    static const char *const kinds[][2] = {
        {"<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">", "alone"},
        {"<VTKFile type='ImageData'>", "alone"},
        {"<VTKFile type=\"PUnstructuredGrid\">", ""},
        {"<VTKFile type=\"UnstructuredGridX\">", ""},
        {"<VTKFile type=\"vtkMultiBlockDataSet\">", ""},
        {"<VTKFile type=\"Collection\">", ""},
        {"CDF", ""},
        {"", ""},
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        char other[450];
        struct timespec nap = {.tv_nsec = 70000000};
        snprintf(beside, sizeof beside, "%s/kind.x", folder);
        snprintf(other, sizeof other, "%s/number%zu.dat", folder, i);
        write_text(beside, kinds[i][0]);
        nanosleep(&nap, NULL);
        const tc_cache_key before = key_of(beside, NULL, NULL);
        write_text(other, "a");
        nanosleep(&nap, NULL);
        if (same(before, key_of(beside, NULL, NULL)) != (kinds[i][1][0] != 0))
            fail_msg("%s", kinds[i][0]);
    }
}

/* A file of the dataset's folder; told the time of some seconds ago, so that the next change has another. */
static void put(const char *name, const char *content, int age)
{
    char path[500];
    struct timespec now[2];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    write_text(path, content);
    clock_gettime(CLOCK_REALTIME, &now[0]);
    now[0].tv_sec -= age;
    now[1] = now[0];
    assert_int_equal(utimensat(AT_FDCWD, path, now, 0), 0);
}

static tc_status try_key(tc_cache_key *out, const char *name, tc_error *err)
{
    char path[500];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return tc_cache_key_make(out, path, &heat, &peel, err);
}

static tc_cache_key key_after_rest(const char *name)
{
    tc_cache_key key;
    tc_error err = {0};
    const struct timespec nap = {.tv_nsec = 60000000};
    nanosleep(&nap, NULL);
    if (try_key(&key, name, &err) != TC_OK)
        fail_msg("%s", err.text);
    return key;
}

/* What makes meshes of files: the program that reads, and the module that it loads for some formats. */
static void another_build_of_the_reader_is_in_the_key(void **state)
{
    (void)state;
    static const char *const parts[] = {"tetcast-read", "tetcast-read-more.so"};
    const char *helpers = getenv("TETCAST_HELPERS");
    char *before = helpers ? strdup(helpers) : NULL, path[500];
    tc_cache_key key = key_of(mesh_path, &heat, &peel), next;
    assert_int_equal(setenv("TETCAST_HELPERS", folder, 1), 0);
    for (int i = 0; i < 2; i++)
        for (int build = 0; build < 2; build++) {
            put(parts[i], build ? "another build" : "one build", 100);
            snprintf(path, sizeof path, "%s/%s", folder, parts[i]);
            assert_int_equal(chmod(path, i == 0 ? 0755 : 0644), 0);
            next = key_of(mesh_path, &heat, &peel);
            if (same(key, next))
                fail_msg("%s, build %d", parts[i], build);
            assert_true(same(next, key_of(mesh_path, &heat, &peel)));
            key = next;
        }
    if (before)
        setenv("TETCAST_HELPERS", before, 1);
    else
        unsetenv("TETCAST_HELPERS");
    free(before);
}

static void every_file_of_a_dataset_is_in_the_key(void **state)
{
    (void)state;
    char path[500];
    tc_cache_key key, next;
    tc_error err = {0};
    snprintf(path, sizeof path, "%s/parts", folder);
    assert_int_equal(mkdir(path, 0777), 0);
    put("all.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: parts/all.geo\n", 100);
    put("parts/all.geo", "points", 100);
    put("parts/all.sca", "values", 100);
    key = key_after_rest("all.case");
    assert_true(same(key, key_after_rest("all.case")));
    put("parts/all.sca", "VALUES", 90); /* of one size */
    next = key_after_rest("all.case");
    assert_false(same(key, next));
    key = next;
    put("parts/all.sca", "VALUES.", 90);
    next = key_after_rest("all.case");
    assert_false(same(key, next));
    key = next;
    put("parts/new.sca", "more", 100);
    next = key_after_rest("all.case");
    assert_false(same(key, next));
    key = next;
    snprintf(path, sizeof path, "%s/parts/new.sca", folder);
    char moved[500];
    snprintf(moved, sizeof moved, "%s/parts/old.sca", folder);
    assert_int_equal(rename(path, moved), 0);
    next = key_after_rest("all.case");
    assert_false(same(key, next));
    key = next;
    /* Pictures of it, and the cache itself. */
    put("all.png", "a picture", 100);
    put("all.case.tccache", "a cache", 100);
    put("numbers.json", "{}", 100);
    put("parts/kept", TC_CACHE_MAGIC "and what a cache holds", 0);
    assert_int_equal(try_key(&next, "all.case", &err), TC_OK);
    assert_true(same(key, next));
    put("parts/kept", "tccache, but not quite", 100);
    assert_false(same(key, key_after_rest("all.case")));
    snprintf(path, sizeof path, "%s/parts/kept", folder);
    assert_int_equal(unlink(path), 0);
    assert_true(same(key, key_after_rest("all.case")));

    put("parts/all.sca", "VALUES!", 0); /* changed now: the next change may get the same time */
    assert_int_equal(try_key(&next, "all.case", &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "just now"));
    (void)key_after_rest("all.case");
}

static void a_dataset_that_names_files_elsewhere_has_no_key(void **state)
{
    (void)state;
    static const char *const elsewhere[] = {"model: /data/all.geo\n", "model: ../all.geo\n", "<D file=\"/data/a.vtu\"/>",
                                            "<D file='/a.vtu'/>", "x\n/data/a"};
    static const char *const within[] = {"model: parts/all.geo\n", "<D file=\"parts/a.vtu\" />", "</D>\n<E/>",
                                         "http://kitware.com", "a / b"};
    tc_cache_key key;
    tc_error err = {0};
    const struct timespec nap = {.tv_nsec = 60000000};
    for (size_t i = 0; i < 5; i++) {
        put("list.case", within[i], 100);
        (void)key_after_rest("list.case");
        put("list.case", elsewhere[i], 100);
        nanosleep(&nap, NULL);
        if (try_key(&key, "list.case", &err) != TC_E_FILE || !strstr(err.text, "outside"))
            fail_msg("%s: %s", elsewhere[i], err.text);
    }
    put("list.case", within[0], 100);
    put("inner.vtm", "<D file=\"/data/a.vtu\"/>", 100); /* a list in the list */
    nanosleep(&nap, NULL);
    assert_int_equal(try_key(&key, "list.case", &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "inner.vtm"));
    assert_int_equal(try_key(&key, "missing.case", &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "missing.case"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_mesh_comes_back_as_it_was_saved, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(a_mesh_that_comes_back_has_no_fields, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(blocks_that_come_back_have_no_names, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(a_damaged_byte_anywhere_is_found, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(another_version_or_key_is_not_taken, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(a_vertex_that_is_not_there_is_not_believed, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(gaps_that_a_helper_failed_at_are_tried_again, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(no_other_file_is_written_over, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(content_and_settings_are_in_the_key, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(a_file_alone_does_not_depend_on_what_lies_beside_it, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(another_build_of_the_reader_is_in_the_key, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(every_file_of_a_dataset_is_in_the_key, make_folder, drop_folder),
        cmocka_unit_test_setup_teardown(a_dataset_that_names_files_elsewhere_has_no_key, make_folder, drop_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
