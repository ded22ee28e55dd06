/* test_read_fields.c: arrays of every type, blocks, pieces and files over time, written here. */
#define _GNU_SOURCE

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "read_files.h"

#include <math.h>

/* One hexahedron at x = left; values are those of the DataArray elements given. */
static const char *write_box(const char *name, double left, const char *point_data, const char *cell_data)
{
    static grid g;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 8; i++)
        add_point(&g, left + (i & 1), i >> 1 & 1, i >> 2);
    add_cell(&g, 11, 8, (int[]){0, 1, 2, 3, 4, 5, 6, 7});
    const char *path = scratch(name);
    write_vtu(path, &g, point_data, cell_data);
    return path;
}

static const char *base_of(const char *path)
{
    return strrchr(path, '/') + 1;
}

static double first_value(const char *path, const tc_read_options *options)
{
    tc_mesh *m = read_path(path, options);
    const double v = m->scalar[0];
    tc_mesh_destroy(&m);
    return v;
}

static void test_array_types_are_misread(void **state)
{
    (void)state;
    static const char *const types[] = {"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                        "UInt32", "Int64", "UInt64", "Float32", "Float64"};
    for (size_t i = 0; i < sizeof types / sizeof *types; i++) {
        char data[512];
        snprintf(data, sizeof data, "<DataArray type=\"%s\" Name=\"a\" format=\"ascii\">0 1 2 3 4 5 6 100</DataArray>",
                 types[i]);
        const char *path = write_box("types.vtu", 0, data, "");
        tc_mesh *m = read_path(path, NULL);
        unlink(path);
        double sum = 0;
        for (size_t v = 0; v < m->n_vertex; v++)
            sum += m->scalar[v];
        assert_int_equal(m->n_vertex, 8);
        assert_true(sum == 121);
        assert_true(m->source->array[0].lo == 0 && m->source->array[0].hi == 100);
        tc_mesh_destroy(&m);
    }
}

/* Base 64 of n bytes, at most 64. */
static size_t base64(char *out, const unsigned char *bytes, size_t n)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t length = 0;
    for (size_t i = 0; i < n; i += 3) {
        const unsigned b =
            (unsigned)bytes[i] << 16 | (i + 1 < n ? (unsigned)bytes[i + 1] << 8 : 0) | (i + 2 < n ? bytes[i + 2] : 0);
        for (int k = 0; k < 4; k++)
            out[length++] = i + (size_t)k > n ? '=' : digit[b >> (18 - 6 * k) & 63];
    }
    out[length] = 0;
    return length;
}

/* Eight values as VTK's inline binary: the byte count, then the values, each in base 64. */
static const char *binary_values(const double *value)
{
    static char text[256];
    const unsigned char count[4] = {64, 0, 0, 0};
    unsigned char bytes[64];
    memcpy(bytes, value, sizeof bytes);
    base64(text + base64(text, count, 4), bytes, 64);
    return text;
}

static void test_not_a_number_spoils_the_range(void **state)
{
    (void)state;
    /* VTK reads no NaN from text. */
    double some[8] = {NAN, 1, 2, 3, 4, 5, 6, INFINITY}, none[8] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
    char data[2048];
    snprintf(data, sizeof data, "<DataArray type=\"Float64\" Name=\"a\" format=\"binary\">%s</DataArray>",
             binary_values(some));
    snprintf(data + strlen(data), sizeof data - strlen(data),
             "<DataArray type=\"Float64\" Name=\"none\" format=\"binary\">%s</DataArray>", binary_values(none));
    const char *path = write_box("nan.vtu", 0, data, "");
    tc_mesh *m = read_path(path, NULL);
    unlink(path);
    size_t bad = 0;
    for (size_t v = 0; v < m->n_vertex; v++)
        bad += isnan(m->scalar[v]) != 0;
    assert_int_equal(bad, 1);
    assert_true(m->source->array[0].lo == 1 && m->source->array[0].hi == 6);
    assert_true(m->source->array[1].lo > m->source->array[1].hi);
    tc_mesh_destroy(&m);
}

static void test_names_with_colons_are_cut(void **state)
{
    (void)state;
    const char *path = write_box("colon.vtu", 0,
                                 "<DataArray type=\"Float64\" Name=\"a:1\" NumberOfComponents=\"2\" format=\"ascii\">"
                                 "3 4 3 4 3 4 3 4 3 4 3 4 3 4 3 4</DataArray>",
                                 "<DataArray type=\"Float64\" Name=\"cells\" format=\"ascii\">9</DataArray>");
    const tc_read_options whole = {.field = "a:1"}, part = {.field = "a:1:0"}, magnitude = {.field = "a:1:magnitude"},
                          cell = {.association = TC_CELL_DATA};
    assert_true(first_value(path, &whole) == 5);
    assert_true(first_value(path, &part) == 3);
    assert_true(first_value(path, &magnitude) == 5);
    assert_true(first_value(path, &cell) == 9);
    unlink(path);
}

static void test_cell_values_land_on_other_tets(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 12; i++)
        add_point(&g, i % 3, i / 3 % 2, i / 6);
    add_cell(&g, 5, 3, (int[]){0, 1, 3}); /* left out, but it has a value too */
    add_cell(&g, 11, 8, (int[]){0, 1, 3, 4, 6, 7, 9, 10});
    add_cell(&g, 11, 8, (int[]){1, 2, 4, 5, 7, 8, 10, 11});
    const char *path = scratch("cells.vtu");
    write_vtu(path, &g, "", "<DataArray type=\"Float64\" Name=\"c\" format=\"ascii\">-1 10 20</DataArray>");
    tc_mesh *m = read_path(path, NULL);
    unlink(path);
    assert_int_equal(m->association, TC_CELL_DATA);
    for (size_t t = 0; t < m->n_tet; t++) {
        double x = 0;
        for (int k = 0; k < 4; k++)
            x += m->vertex[3 * (size_t)m->tet[4 * t + (size_t)k]] / 4;
        assert_true(m->scalar[t] == (x < 1 ? 10 : 20));
    }
    tc_mesh_destroy(&m);
}

static void test_files_over_time_are_confused(void **state)
{
    (void)state;
    char path[3][512], list[2048];
    for (int i = 0; i < 3; i++) {
        char data[256], name[32];
        const int v = i ? 2 : 0; /* seams are joined where both sides agree */
        snprintf(data, sizeof data,
                 "<DataArray type=\"Float64\" Name=\"a\" format=\"ascii\">%d %d %d %d %d %d %d %d</DataArray>", v, v, v,
                 v, v, v, v, v);
        snprintf(name, sizeof name, "step%d.vtu", i);
        snprintf(path[i], sizeof path[i], "%s", write_box(name, i, data, ""));
    }
    const tc_read_options first = {.field = "a"}, last = {.has_step = true, .step = -1},
                          at = {.has_time = true, .time = 1.9}, beyond = {.has_step = true, .step = 9};
    /* Steps in no order; the last one has two files. */
    snprintf(list, sizeof list,
             "<VTKFile type=\"Collection\" version=\"0.1\"><Collection>"
             "<DataSet timestep=\"2\" part=\"0\" file=\"%s\"/><DataSet timestep=\"0.5\" file=\"%s\"/>"
             "<DataSet timestep=\"2\" part=\"1\" file=\"%s\"/></Collection></VTKFile>",
             base_of(path[1]), base_of(path[0]), base_of(path[2]));
    const char *pvd = scratch("list.pvd");
    write_text(pvd, list);
    assert_true(first_value(pvd, &first) == 0);
    assert_true(first_value(pvd, &at) == 0);
    tc_mesh *m = read_path(pvd, &last);
    assert_int_equal(m->source->n_time, 2);
    assert_int_equal(m->source->step, 1);
    assert_int_equal(m->source->n_cell, 2);
    assert_int_equal(m->n_tet, 10);
    const tc_mesh_report r = prepared(m);
    assert_int_equal(r.n_component, 1); /* the parts' common points were joined, and their cuts match */
    assert_int_equal(r.n_boundary_face, 20);
    tc_mesh_destroy(&m);
    assert_non_null(strstr(refusal_of(pvd, &beyond), "2 time steps"));

    snprintf(list, sizeof list,
             "{\"file-series-version\": \"1.0\", \"files\": [{\"name\": \"%s\", \"time\": 1}, {\"name\": \"%s\", "
             "\"time\": 3}]}",
             base_of(path[0]), base_of(path[2]));
    const char *series = scratch("list.vtu.series");
    write_text(series, list);
    assert_true(first_value(series, &last) == 2);
    assert_true(first_value(series, &at) == 0);
    unlink(path[2]);
    assert_non_null(strstr(refusal_of(series, &last), base_of(path[2])));
    write_text(series, "{\"file-series-version\": \"1.0\", \"files\": [}");
    assert_non_null(strstr(refusal_of(series, NULL), "line 1"));
    write_text(series, "{\"file-series-version\": \"1.0\"}");
    assert_non_null(strstr(refusal_of(series, NULL), "no files"));
    unlink(series);
    unlink(pvd);
    unlink(path[0]);
    unlink(path[1]);
}

static void test_blocks_are_lost(void **state)
{
    (void)state;
    char left[512], right[512], list[2048];
    snprintf(left, sizeof left, "%s",
             write_box("left.vtu", 0,
                       "<DataArray type=\"Float64\" Name=\"a\" format=\"ascii\">1 1 1 1 1 1 1 1</DataArray>", ""));
    snprintf(right, sizeof right, "%s", write_box("right.vtu", 1, "", ""));
    snprintf(list, sizeof list,
             "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\"><vtkMultiBlockDataSet>"
             "<Block index=\"0\"><DataSet index=\"0\" file=\"%s\"/></Block><DataSet index=\"1\" file=\"%s\"/>"
             "</vtkMultiBlockDataSet></VTKFile>",
             base_of(left), base_of(right));
    const char *vtm = scratch("blocks.vtm");
    write_text(vtm, list);
    const tc_read_options options = {.field = "a"};
    tc_mesh *m = read_path(vtm, &options);
    assert_int_equal(m->source->n_cell, 2);
    assert_int_equal(m->source->n_point, 16);
    size_t ones = 0, nans = 0;
    for (size_t v = 0; v < m->n_vertex; v++) {
        ones += m->scalar[v] == 1;
        nans += isnan(m->scalar[v]) != 0;
    }
    assert_int_equal(ones, 8);
    assert_int_equal(nans, 8);
    assert_true(has_note(m, "missing in 1 of 2 blocks"));
    tc_mesh_destroy(&m);
    snprintf(list, sizeof list,
             "<VTKFile type=\"PUnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\"><PUnstructuredGrid "
             "GhostLevel=\"0\">"
             "<PPoints><PDataArray type=\"Float64\" NumberOfComponents=\"3\"/></PPoints>"
             "<Piece Source=\"%s\"/><Piece Source=\"%s\"/></PUnstructuredGrid></VTKFile>",
             base_of(left), base_of(right));
    const char *pvtu = scratch("pieces.pvtu");
    write_text(pvtu, list);
    m = read_path(pvtu, NULL);
    assert_int_equal(m->source->n_cell, 2);
    assert_null(m->source->field);
    assert_int_equal(prepared(m).n_component, 1);
    tc_mesh_destroy(&m);
    unlink(vtm);
    unlink(pvtu);
    unlink(left);
    unlink(right);
}

static const tc_array_info *last_array(const tc_mesh *m)
{
    return m->source->n_array ? &m->source->array[m->source->n_array - 1] : NULL;
}

/* Each tet's value must be `left` where x < 1, else `right`. */
static void assert_blocks(const tc_mesh *m, double left, double right)
{
    assert_int_equal(m->association, TC_CELL_DATA);
    assert_int_equal(m->n_tet, 10);
    for (size_t t = 0; t < m->n_tet; t++) {
        double x = 0;
        for (int k = 0; k < 4; k++)
            x += m->vertex[3 * (size_t)m->tet[4 * t + (size_t)k]] / 4;
        assert_true(m->scalar[t] == (x < 1 ? left : right));
    }
}

static void test_blocks_have_other_numbers(void **state)
{
    (void)state;
    static const char values[] = "<DataArray type=\"Float64\" Name=\"a\" format=\"ascii\">1 1 1 1 1 1 1 1</DataArray>";
    static const char own[] = "<DataArray type=\"Int32\" Name=\"BlockId\" format=\"ascii\">7</DataArray>";
    const tc_read_options numbers = {.field = "vtkCompositeIndex"}, a = {.field = "a"}, any = {.all_ranges = true},
                          cell = {.association = TC_CELL_DATA}, point = {.field = "vtkCompositeIndex",
                                                                         .association = TC_POINT_DATA};
    char left[512], right[512], list[2048];
    snprintf(left, sizeof left, "%s", write_box("left.vtu", 0, values, ""));
    snprintf(right, sizeof right, "%s", write_box("right.vtu", 1, values, ""));
    snprintf(list, sizeof list,
             "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\"><vtkMultiBlockDataSet>"
             "<Block index=\"0\"><DataSet index=\"0\" name=\"port\" file=\"%s\"/></Block><DataSet index=\"1\"/>"
             "<DataSet index=\"2\" file=\"%s\"/></vtkMultiBlockDataSet></VTKFile>",
             base_of(left), base_of(right));
    const char *vtm = scratch("numbers.vtm");
    write_text(vtm, list);
    tc_mesh *m = read_path(vtm, &numbers); /* root 0, block 1, its box 2, an empty one 3 */
    assert_string_equal(m->source->field, "vtkCompositeIndex");
    assert_blocks(m, 2, 4);
    assert_string_equal(last_array(m)->name, "vtkCompositeIndex");
    assert_true(last_array(m)->lo == 2 && last_array(m)->hi == 4);
    assert_int_equal(m->source->n_block, 2);
    assert_int_equal(m->source->block[0].number, 2);
    assert_string_equal(m->source->block[0].name, "port");
    assert_int_equal(m->source->block[1].number, 4);
    assert_null(m->source->block[1].name);
    tc_error err = {0}; /* and as a field of a mesh, and as its new values */
    assert_int_equal(tc_mesh_read_values(NULL, m, vtm, &a, NULL, &err), TC_OK);
    assert_true(m->association == TC_POINT_DATA && m->scalar[0] == 1);
    assert_true(isnan(last_array(m)->lo));
    prepared(m);
    tc_field *field = NULL;
    assert_int_equal(tc_field_read(&field, m, vtm, &numbers, NULL, &err), TC_OK);
    double range[2];
    tc_association association;
    tc_field_info(range, &association, NULL, field);
    assert_true(range[0] == 2 && range[1] == 4 && association == TC_CELL_DATA);
    tc_field_destroy(&field);
    tc_mesh_destroy(&m);
    assert_non_null(strstr(refusal_of(vtm, &point), "has no point array"));

    write_box("left.vtu", 0, "", ""); /* numbers are never what is shown by default */
    write_box("right.vtu", 1, "", "");
    m = read_path(vtm, &any);
    assert_null(m->source->field);
    assert_int_equal(m->source->n_array, 1);
    tc_mesh_destroy(&m);
    assert_non_null(strstr(refusal_of(vtm, &cell), "has no cell array"));

    write_box("right.vtu", 1, values, own); /* nor are there others beside the file's own */
    m = read_path(vtm, &any);
    assert_string_equal(last_array(m)->name, "BlockId");
    assert_int_equal(m->source->n_block, 0);
    tc_mesh_destroy(&m);
    assert_non_null(strstr(refusal_of(vtm, &numbers), "cell arrays BlockId"));
    unlink(vtm);
    write_box("right.vtu", 1, values, "");

    const char *one = scratch("one.pvd"); /* several files of one step are as many blocks */
    snprintf(list, sizeof list,
             "<VTKFile type=\"Collection\" version=\"0.1\"><Collection><DataSet timestep=\"0\" part=\"0\" file=\"%s\"/>"
             "<DataSet timestep=\"0\" part=\"1\" file=\"%s\"/></Collection></VTKFile>",
             base_of(left), base_of(right));
    write_text(one, list);
    m = read_path(one, &numbers);
    assert_blocks(m, 1, 2);
    tc_mesh_destroy(&m);
    unlink(one);
    m = read_path(right, &any); /* one block needs no number */
    assert_int_equal(m->source->n_block, 0);
    assert_string_equal(last_array(m)->name, "a");
    tc_mesh_destroy(&m);
    unlink(left);
    unlink(right);
}

static void test_structured_grids_are_refused(void **state)
{
    (void)state;
    const char *path = scratch("image.vtk");
    write_text(path, "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 3 2\nORIGIN 0 0 0\n"
                     "SPACING 1 1 1\nPOINT_DATA 18\nSCALARS s float 1\nLOOKUP_TABLE default\n"
                     "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17\n");
    tc_mesh *m = read_path(path, NULL);
    assert_int_equal(m->report.source_cells, 4);
    assert_int_equal(m->n_tet, 20);
    assert_true(fabs(mesh_volume(m) - 4) < 1e-14);
    tc_mesh_destroy(&m);
    write_text(path, "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 2 3 2\n"
                     "X_COORDINATES 2 float\n0 1\nY_COORDINATES 3 float\n0 1 3\nZ_COORDINATES 2 float\n0 5\n");
    m = read_path(path, NULL);
    assert_true(fabs(mesh_volume(m) - 15) < 1e-13);
    assert_null(m->source->field);
    tc_mesh_destroy(&m);
    write_text(path,
               "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS 2 2 2\nPOINTS 8 double\n"
               "0 0 0 1 0 0 0 1 0 1 1 0 0 0 1 1 0 1 0 1 1 1 1 1\n");
    m = read_path(path, NULL);
    assert_true(fabs(mesh_volume(m) - 1) < 1e-14);
    tc_mesh_destroy(&m);
    unlink(path);
}

static void test_broken_connectivity_is_followed(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    for (int i = 0; i < 4; i++)
        add_point(&g, i == 1, i == 2, i == 3);
    add_cell(&g, 10, 4, (int[]){0, 1, 2, 77});
    const char *path = scratch("broken.vtu");
    write_vtu(path, &g, "", "");
    assert_non_null(strstr(refusal_of(path, NULL), "point 77"));
    g.id[3] = -5;
    write_vtu(path, &g, "", "");
    assert_non_null(strstr(refusal_of(path, NULL), "point -5"));
    g.type[0] = 12; /* a hexahedron of four points */
    g.id[3] = 3;
    write_vtu(path, &g, "", "");
    assert_non_null(strstr(refusal_of(path, NULL), "4 points instead of 8"));
    g.type[0] = 5;
    write_vtu(path, &g, "", "");
    assert_non_null(strstr(refusal_of(path, NULL), "no 3-D cells"));
    unlink(path);
}

static void test_wrong_arguments_start_the_helper(void **state)
{
    (void)state;
    tc_mesh *m = NULL;
    tc_error err;
    const tc_read_options deep = {.refine = 9}, never = {.has_time = true, .time = NAN};
    assert_int_equal(tc_mesh_read(&m, "x.vtu", &deep, NULL, &err), TC_E_ARG);
    assert_int_equal(tc_mesh_read(&m, "x.vtu", &never, NULL, &err), TC_E_ARG);
    assert_int_equal(tc_mesh_read(&m, NULL, NULL, NULL, &err), TC_E_ARG);
    assert_non_null(strstr(refusal_of("/nowhere/x.vtu", NULL), "/nowhere/x.vtu"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_array_types_are_misread),          cmocka_unit_test(test_not_a_number_spoils_the_range),
        cmocka_unit_test(test_names_with_colons_are_cut),        cmocka_unit_test(test_cell_values_land_on_other_tets),
        cmocka_unit_test(test_files_over_time_are_confused),     cmocka_unit_test(test_blocks_are_lost),
        cmocka_unit_test(test_structured_grids_are_refused),     cmocka_unit_test(test_broken_connectivity_is_followed),
        cmocka_unit_test(test_wrong_arguments_start_the_helper), cmocka_unit_test(test_blocks_have_other_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
