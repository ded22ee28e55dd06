/* test_synth_vtu.c: the VTU writer: what it wrote is decoded here by the file's own header. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "mesh/mesh.h"

#include <dirent.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[] = "/tmp/tc_vtu_XXXXXX";
static char path[64];

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/a.vtu", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(path);
    return rmdir(folder);
}

static char *read_file(size_t *n)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    fseek(f, 0, SEEK_END);
    *n = (size_t)ftell(f);
    rewind(f);
    char *text = malloc(*n + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, *n, f), *n);
    text[*n] = 0;
    fclose(f);
    return text;
}

/* The block that the named array's offset points to, and its size from the block's own header. */
static const char *block(const char *file, size_t n, const char *name, uint64_t *bytes)
{
    char key[64];
    snprintf(key, sizeof key, " Name=\"%s\"", name);
    const char *at = strstr(file, key);
    if (!at)
        fail_msg("no array %s in the file", name);
    at = strstr(at, "offset=\"");
    assert_non_null(at);
    unsigned long long offset = strtoull(at + 8, NULL, 10);
    const char *start = strstr(file, "<AppendedData encoding=\"raw\">");
    assert_non_null(start);
    start = strchr(start, '_') + 1 + offset;
    assert_true(start + sizeof *bytes <= file + n);
    memcpy(bytes, start, sizeof *bytes);
    start += sizeof *bytes;
    assert_true(start + *bytes <= file + n);
    return start;
}

static void assert_block(const char *file, size_t n, const char *name, const void *data, size_t bytes)
{
    uint64_t found;
    const char *b = block(file, n, name, &found);
    assert_int_equal(found, bytes);
    assert_memory_equal(b, data, bytes);
}

static void write_mesh(const tc_mesh *mesh)
{
    tc_error err = {0};
    if (tc_mesh_write_vtu(mesh, path, &err))
        fail_msg("%s", err.text);
}

static void the_file_does_not_hold_the_mesh(void **state)
{
    (void)state;
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    assert_int_equal(tc_synth_create(&mesh, "kuhn", 30000, 3, &err), TC_OK); /* more cells than one chunk */
    write_mesh(mesh);
    size_t n;
    char *file = read_file(&n), counts[96];
    snprintf(counts, sizeof counts, "<Piece NumberOfPoints=\"%zu\" NumberOfCells=\"%zu\">", mesh->n_vertex,
             mesh->n_tet);
    assert_non_null(strstr(file, counts));
    assert_non_null(strstr(file, "header_type=\"UInt64\""));
    assert_block(file, n, "Points", mesh->vertex, mesh->n_vertex * 24);
    assert_block(file, n, "connectivity", mesh->tet, mesh->n_tet * 16);
    assert_block(file, n, "field", mesh->scalar, mesh->n_vertex * 8);
    uint64_t bytes;
    const char *b = block(file, n, "offsets", &bytes);
    assert_int_equal(bytes, 8 * mesh->n_tet);
    for (size_t i = 0; i < mesh->n_tet; i++) {
        int64_t end;
        memcpy(&end, b + 8 * i, 8);
        assert_int_equal(end, 4 * (i + 1));
    }
    b = block(file, n, "types", &bytes);
    assert_int_equal(bytes, mesh->n_tet);
    for (size_t i = 0; i < mesh->n_tet; i++)
        assert_int_equal(b[i], 10);
    assert_string_equal(b + bytes, "\n</AppendedData>\n</VTKFile>\n"); /* the last block: nothing follows */
    free(file);
    tc_mesh_destroy(&mesh);
}

/* One real tet, one imaginary one that uses a Steiner point. */
static double vertices[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 9, 9, 9};
static int32_t tets[8] = {0, 1, 2, 3, 1, 2, 3, 4};
static double values[5] = {1, 2, 3, 4, 5};

static tc_mesh small_mesh(tc_association association, char *name)
{
    tc_mesh mesh = {.n_vertex = 5, .vertex = vertices, .n_tet = 1, .n_imaginary = 1, .tet = tets};
    mesh.report.n_steiner = 1;
    mesh.scalar = values;
    mesh.association = association;
    mesh.field_name = name;
    return mesh;
}

static void imaginary_tets_and_their_points_are_written(void **state)
{
    (void)state;
    tc_mesh mesh = small_mesh(TC_POINT_DATA, "f");
    write_mesh(&mesh);
    size_t n;
    char *file = read_file(&n);
    assert_non_null(strstr(file, "NumberOfPoints=\"4\" NumberOfCells=\"1\""));
    assert_block(file, n, "Points", vertices, 12 * 8);
    assert_block(file, n, "connectivity", tets, 16);
    assert_block(file, n, "f", values, 4 * 8);
    free(file);
}

static void cell_data_is_written_as_point_data(void **state)
{
    (void)state;
    tc_mesh mesh = small_mesh(TC_CELL_DATA, "f");
    write_mesh(&mesh);
    size_t n;
    char *file = read_file(&n);
    assert_non_null(strstr(file, "<CellData Scalars=\"f\">"));
    assert_non_null(strstr(file, "<PointData/>"));
    assert_block(file, n, "f", values, 8);
    assert_block(file, n, "Points", vertices, 12 * 8);
    free(file);
}

static void a_mesh_without_field_gets_one(void **state)
{
    (void)state;
    tc_mesh mesh = small_mesh(TC_POINT_DATA, NULL);
    mesh.scalar = NULL;
    write_mesh(&mesh);
    size_t n;
    char *file = read_file(&n);
    assert_non_null(strstr(file, "<PointData/>"));
    assert_non_null(strstr(file, "<CellData/>"));
    assert_block(file, n, "Points", vertices, 12 * 8);
    free(file);
}

static void a_field_name_breaks_the_xml(void **state)
{
    (void)state;
    char name[] = "<p>\"&\n'ρ";
    tc_mesh mesh = small_mesh(TC_POINT_DATA, name);
    write_mesh(&mesh);
    size_t n;
    char *file = read_file(&n);
    assert_block(file, n, "&lt;p&gt;&quot;&amp;_'ρ", values, 4 * 8);
    free(file);
}

/* Files in the folder, and the size of the one that should be alone. */
static int count_files(void)
{
    int n = 0;
    DIR *d = opendir(folder);
    assert_non_null(d);
    for (struct dirent *e; (e = readdir(d));)
        n += e->d_name[0] != '.';
    closedir(d);
    return n;
}

static void a_failed_write_leaves_half_a_file_or_harms_the_old_one(void **state)
{
    (void)state;
    tc_mesh small = small_mesh(TC_POINT_DATA, "f"), *big = NULL;
    tc_error err = {0};
    write_mesh(&small);
    size_t n_before, n_after;
    char *before = read_file(&n_before);
    assert_int_equal(tc_synth_create(&big, "kuhn", 30000, 0, &err), TC_OK);

    struct rlimit full, tight;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &full), 0);
    tight = full;
    tight.rlim_cur = 100000;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
    tc_status status = tc_mesh_write_vtu(big, path, &err);
    setrlimit(RLIMIT_FSIZE, &full);
    assert_int_equal(status, TC_E_FILE);
    assert_non_null(strstr(err.text, path));

    char *after = read_file(&n_after);
    assert_int_equal(n_before, n_after);
    assert_memory_equal(before, after, n_before);
    assert_int_equal(count_files(), 1);
    free(before);
    free(after);
    tc_mesh_destroy(&big);
}

static void a_pipe_or_a_link_is_replaced(void **state)
{
    (void)state;
    tc_mesh mesh = small_mesh(TC_POINT_DATA, "f");
    tc_error err = {0};
    char link[64];
    struct stat s;
    write_mesh(&mesh);
    snprintf(link, sizeof link, "%s/link.vtu", folder);
    assert_int_equal(symlink("a.vtu", link), 0);
    int status = tc_mesh_write_vtu(&mesh, link, &err);
    int kind = lstat(link, &s) == 0 && S_ISLNK(s.st_mode);
    unlink(link);
    assert_int_equal(status, TC_OK);
    assert_true(kind);

    char pipe_name[64], got[64] = "";
    snprintf(pipe_name, sizeof pipe_name, "%s/pipe.vtu", folder);
    assert_int_equal(mkfifo(pipe_name, 0600), 0);
    int reader = open(pipe_name, O_RDONLY | O_NONBLOCK);
    status = tc_mesh_write_vtu(&mesh, pipe_name, &err); /* small enough for the pipe's buffer */
    kind = lstat(pipe_name, &s) == 0 && S_ISFIFO(s.st_mode);
    ssize_t n = read(reader, got, sizeof got - 1);
    close(reader);
    unlink(pipe_name);
    assert_int_equal(status, TC_OK);
    assert_true(kind);
    assert_true(n > 0);
    assert_memory_equal(got, "<?xml", 5);
}

static void a_bad_place_has_no_clear_error(void **state)
{
    (void)state;
    tc_mesh mesh = small_mesh(TC_POINT_DATA, "f");
    tc_error err = {0};
    assert_int_equal(tc_mesh_write_vtu(&mesh, folder, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "is a folder"));
    assert_int_equal(tc_mesh_write_vtu(&mesh, "/nowhere/at/all.vtu", &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "/nowhere/at/all.vtu"));
    assert_int_equal(tc_mesh_write_vtu(&mesh, "", &err), TC_E_ARG);
    assert_int_equal(tc_mesh_write_vtu(NULL, path, &err), TC_E_ARG);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_file_does_not_hold_the_mesh),
        cmocka_unit_test(imaginary_tets_and_their_points_are_written),
        cmocka_unit_test(cell_data_is_written_as_point_data),
        cmocka_unit_test(a_mesh_without_field_gets_one),
        cmocka_unit_test(a_field_name_breaks_the_xml),
        cmocka_unit_test(a_failed_write_leaves_half_a_file_or_harms_the_old_one),
        cmocka_unit_test(a_pipe_or_a_link_is_replaced),
        cmocka_unit_test(a_bad_place_has_no_clear_error),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
