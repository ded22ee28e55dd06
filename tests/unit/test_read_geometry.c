/* test_read_geometry.c: triangles and lines of surfaces in every format that is read, and of files that are damaged. */
#define _GNU_SOURCE

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "read_files.h"

#include <ctype.h>
#include <math.h>

static char said[512]; /* the last warning */

static void keep_message(void *user, tc_level level, const char *text)
{
    (void)user;
    if (level == TC_WARNING)
        snprintf(said, sizeof said, "%s", text);
}

static tc_geometry read_geometry(const char *path)
{
    const tc_log log = {.message = keep_message};
    tc_geometry g;
    tc_error err = {0};
    said[0] = 0;
    if (tc_geometry_read(&g, path, &log, &err) != TC_OK)
        fail_msg("%s", err.text);
    unlink(path);
    for (size_t i = 0; i < 3 * g.n_triangle; i++)
        assert_true(g.triangle[i] >= 0 && (size_t)g.triangle[i] < g.n_vertex);
    for (size_t i = 0; i < 2 * g.n_line; i++)
        assert_true(g.line[i] >= 0 && (size_t)g.line[i] < g.n_vertex);
    assert_true(g.opacity == 1 && g.width == 1 && g.lit);
    return g;
}

static tc_geometry read_text(const char *name, const char *text)
{
    const char *path = scratch(name);
    write_text(path, text);
    return read_geometry(path);
}

static const char *refused_path(const char *path, const char *name, bool may_die)
{
    static tc_error err;
    tc_geometry g;
    memset(&err, 0, sizeof err);
    const tc_status status = tc_geometry_read(&g, path, NULL, &err);
    if (status != TC_E_FILE && !(may_die && status == TC_E_WORKER)) /* VTK may die of it: then that is told */
        fail_msg("%s: %d, %s, %zu vertices, %zu triangles, %zu lines", name, status, err.text, g.n_vertex, g.n_triangle,
                 g.n_line);
    assert_true(g.vertex == NULL && g.triangle == NULL && g.line == NULL);
    assert_non_null(strstr(err.text, name));
    for (const char *c = err.text; *c; c++)
        assert_false(iscntrl((unsigned char)*c));
    return err.text;
}

static const char *refused(const char *name, const char *text)
{
    const char *path = scratch(name);
    write_text(path, text);
    const char *sentence = refused_path(path, name, true);
    unlink(path);
    return sentence;
}

/* Sum of the triangles' areas. */
static double area(const tc_geometry *g)
{
    double sum = 0;
    for (size_t i = 0; i < g->n_triangle; i++) {
        double u[3], v[3];
        for (int k = 0; k < 3; k++) {
            const double a = g->vertex[3 * g->triangle[3 * i] + k];
            u[k] = g->vertex[3 * g->triangle[3 * i + 1] + k] - a;
            v[k] = g->vertex[3 * g->triangle[3 * i + 2] + k] - a;
        }
        sum += 0.5 * sqrt(pow(u[1] * v[2] - u[2] * v[1], 2) + pow(u[2] * v[0] - u[0] * v[2], 2) +
                          pow(u[0] * v[1] - u[1] * v[0], 2));
    }
    return sum;
}

static double length(const tc_geometry *g)
{
    double sum = 0;
    for (size_t i = 0; i < g->n_line; i++) {
        double square = 0;
        for (int k = 0; k < 3; k++)
            square += pow(g->vertex[3 * g->line[2 * i] + k] - g->vertex[3 * g->line[2 * i + 1] + k], 2);
        sum += sqrt(square);
    }
    return sum;
}

static void check(tc_geometry g, size_t n_vertex, size_t n_triangle, size_t n_line, double triangles, double lines)
{
    assert_int_equal(g.n_vertex, n_vertex);
    assert_int_equal(g.n_triangle, n_triangle);
    assert_int_equal(g.n_line, n_line);
    assert_true(fabs(area(&g) - triangles) < 1e-6);
    assert_true(fabs(length(&g) - lines) < 1e-6);
    tc_geometry_finish(&g);
}

/* A point that nothing uses; a strip of the unit square; an L of 3 squares, not convex; a line of two pieces; a vertex.
 */
#define LEGACY_POINTS                                                                                                  \
    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 13 double\n9 9 9  0 0 0  1 0 0  0 1 0  1 1 0\n"    \
    "0 0 5  2 0 5  2 1 5  1 1 5  1 2 5  0 2 5  0 0 7  3 4 7\n"

static void test_polygons_strips_or_lines_of_legacy_files_are_missed(void **state)
{
    (void)state;
    tc_geometry g =
        read_text("all.vtk", LEGACY_POINTS "VERTICES 1 2\n1 0\nLINES 1 4\n3 1 11 12\n"
                                           "POLYGONS 1 7\n6 5 6 7 8 9 10\nTRIANGLE_STRIPS 1 5\n4 1 2 3 4\n");
    /* A strip's triangles are all wound alike. */
    for (size_t i = 0; i < g.n_triangle; i++) {
        const double *a = g.vertex + 3 * g.triangle[3 * i], *b = g.vertex + 3 * g.triangle[3 * i + 1],
                     *c = g.vertex + 3 * g.triangle[3 * i + 2];
        assert_true((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0);
    }
    check(g, 12, 2 + 4, 2, 1 + 3, 7 + 5);
}

static void test_polydata_in_xml_is_missed(void **state)
{
    (void)state;
    check(
        read_text("a.vtp",
                  "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>\n"
                  "<Piece NumberOfPoints=\"4\" NumberOfVerts=\"0\" NumberOfLines=\"1\" NumberOfStrips=\"0\" "
                  "NumberOfPolys=\"1\">\n"
                  "<PointData><DataArray type=\"Float32\" Name=\"h\" format=\"ascii\">1 2 3 4</DataArray></PointData>\n"
                  "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 2 0 0 2 2 0 "
                  "0 2 0</DataArray></Points>\n"
                  "<Lines><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 2</DataArray>\n"
                  "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">2</DataArray></Lines>\n"
                  "<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>\n"
                  "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray></Polys>\n"
                  "</Piece></PolyData></VTKFile>\n"),
        4, 2, 1, 4, sqrt(8));
}

static void put_floats(FILE *f, const float *v, size_t n)
{
    assert_int_equal(fwrite(v, sizeof *v, n, f), n);
}

/* Of as many facets as `says`; two are there. Little-endian, as this is. */
static const char *write_binary_stl(uint32_t says)
{
    const float facet[2][12] = {{0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0}, {0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 1, 0}};
    const char *path = scratch("two.stl");
    const char head[80] = "solid or not", none[2] = "";
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(head, 1, 80, f), 80);
    assert_int_equal(fwrite(&says, 4, 1, f), 1);
    for (int i = 0; i < 2; i++) {
        put_floats(f, facet[i], 12);
        assert_int_equal(fwrite(none, 1, 2, f), 2);
    }
    assert_int_equal(fclose(f), 0);
    return path;
}

static void test_stl_obj_or_ply_is_missed(void **state)
{
    (void)state;
    check(read_geometry(write_binary_stl(2)), 4, 2, 0, 1, 0);
    check(read_text("text.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 2 0 0\nvertex 0 2 0\n"
                                "endloop\nendfacet\nendsolid x\n"),
          3, 1, 0, 2, 0);
    check(read_text("a.obj", "# a square and a line\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 1 3\nf 1 2 3 4\nl 4 5\n"),
          5, 2, 1, 1, 3);
    check(read_text("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                             "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"),
          4, 2, 0, 1, 0);
}

static grid mixed(void)
{
    static grid g;
    memset(&g, 0, sizeof g);
    const double at[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {4, 0, 0}, {5, 0, 0}, {4, 1, 0}, {5, 1, 0}};
    for (size_t i = 0; i < 8; i++)
        add_point(&g, at[i][0], at[i][1], at[i][2]);
    add_cell(&g, 10, 4, (const int[]){0, 1, 2, 3});
    add_cell(&g, 8, 4, (const int[]){4, 5, 6, 7}); /* a pixel: its corners do not go around */
    add_cell(&g, 3, 2, (const int[]){0, 4});
    return g;
}

static void test_flat_cells_of_grids_are_missed(void **state)
{
    (void)state;
    grid g = mixed();
    const char *path = scratch("mixed.vtu");
    write_vtu(path, &g, "", "");
    check(read_geometry(path), 5, 2, 1, 1, 4);
    /* A quadratic triangle makes four, one of higher order the triangle of its corners. */
    g.n_cell = g.n_id = 0;
    add_cell(&g, 22, 6, (const int[]){0, 1, 2, 4, 5, 6});
    add_cell(&g, 69, 6, (const int[]){0, 1, 2, 4, 5, 6});
    write_vtu(path, &g, "", "");
    tc_geometry out = read_geometry(path);
    assert_int_equal(out.n_triangle, 5);
    assert_non_null(strstr(said, "1 cell of higher order"));
    tc_geometry_finish(&out);
}

static void test_a_file_without_a_surface_is_drawn(void **state)
{
    (void)state;
    grid g = mixed();
    g.n_cell = 1;
    g.n_id = 4;
    const char *path = scratch("solid.vtu");
    write_vtu(path, &g, "", "");
    const char *text = refused_path(path, "solid.vtu", false);
    unlink(path);
    assert_non_null(strstr(text, "no surface"));
    assert_non_null(strstr(text, "1 tetra"));
    assert_non_null(strstr(text, "Extract Surface"));
    assert_non_null(strstr(refused_path("/nowhere/x.stl", "x.stl", false), "cannot be opened"));
    assert_non_null(strstr(refused("empty.vtp", ""), "empty"));
    assert_non_null(strstr(refused("a.txt", "hello\n"), "no format that is known"));
    assert_non_null(strstr(refused("a.off", "OFF\n3 1 0\n"), "meshio convert"));
    const char *byu = refused("a.g", "1 3 1 3\n"); /* which meshio does not know */
    assert_non_null(strstr(byu, "ParaView"));
    assert_null(strstr(byu, "meshio"));
    assert_non_null(strstr(refused("points.vtk", LEGACY_POINTS "VERTICES 1 2\n1 0\n"), "1 vertex"));
    assert_non_null(strstr(refused("bare.vtk", LEGACY_POINTS), "no cells at all"));
}

static void test_damaged_lists_are_followed(void **state)
{
    (void)state;
    static const char *const wrong[] = {"13", "-1", "2147483647", "9000000000"};
    static const char *const kind[] = {"POLYGONS", "LINES", "TRIANGLE_STRIPS"};
    for (size_t k = 0; k < 3; k++)
        for (size_t i = 0; i < 4; i++) {
            char text[1024];
            snprintf(text, sizeof text, LEGACY_POINTS "%s 2 8\n3 1 2 3\n3 4 5 %s\n", kind[k], wrong[i]);
            const char *sentence = refused("damage.vtk", text);
            assert_true(strstr(sentence, "damaged") || strstr(sentence, "could not be read"));
        }
    grid g = mixed();
    g.id[7] = 8; /* of the pixel */
    const char *path = scratch("damage.vtu");
    write_vtu(path, &g, "", "");
    const char *text = refused_path(path, "damage.vtu", false);
    unlink(path);
    assert_non_null(strstr(text, "cell 1 refers to point 8"));
}

static void test_cells_with_too_few_points_are_asked_for_more(void **state)
{
    (void)state;
    grid g = mixed();
    g.n_cell = g.n_id = 0;
    add_cell(&g, 5, 3, (const int[]){0, 1, 2});
    static const int type[] = {5, 6, 7, 8, 9, 22, 23, 28, 34, 36, 35, 21, 61, 62, 63, 69, 70, 77};
    for (size_t i = 0; i < sizeof type / sizeof *type; i++)
        add_cell(&g, type[i], 2, (const int[]){0, 1});
    const char *path = scratch("short.vtu");
    write_vtu(path, &g, "", "");
    check(read_geometry(path), 3, 1, 0, 0.5, 0);
    assert_non_null(strstr(said, "18 lines and polygons have too few points"));
}

static void test_counts_that_cannot_be_are_believed(void **state)
{
    (void)state;
    static const char *const count[] = {"POLYGONS 4000000000000 16000000000000", "POLYGONS 1 4000000000000",
                                        "LINES 7 1", "TRIANGLE_STRIPS 4 -5"};
    for (size_t i = 0; i < sizeof count / sizeof *count; i++) {
        char text[1024];
        snprintf(text, sizeof text, LEGACY_POINTS "%s\n3 1 2 3\n", count[i]);
        const char *path = scratch("count.vtk");
        write_text(path, text);
        refused_path(path, "count.vtk", true);
        unlink(path);
    }
    const uint32_t facets[] = {0, 1, 3, 2000000000, UINT32_MAX};
    for (size_t i = 0; i < 5; i++) {
        const char *path = write_binary_stl(facets[i]);
        refused_path(path, "two.stl", true);
        unlink(path);
    }
}

static void put_big_endian(FILE *f, const void *value, size_t bytes)
{
    for (size_t i = bytes; i-- > 0;)
        fputc(((const unsigned char *)value)[i], f);
}

static void test_points_that_are_not_finite_are_drawn(void **state)
{
    (void)state;
    const double wrong[] = {NAN, INFINITY, -INFINITY};
    for (int i = 0; i < 4; i++) { /* the last: each triangle has one */
        const double place[5][3] = {{i == 3 ? NAN : 0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, wrong[i % 3], 0}};
        const int32_t cell[] = {3, 0, 1, 2, 3, 1, 3, 4, 3, 0, 4, 2};
        const char *path = scratch("nan.vtk");
        FILE *f = fopen(path, "wb");
        assert_non_null(f);
        fprintf(f, "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\nPOINTS 5 double\n");
        for (int k = 0; k < 15; k++)
            put_big_endian(f, &place[0][0] + k, sizeof(double));
        fprintf(f, "\nPOLYGONS 3 12\n");
        for (int k = 0; k < 12; k++)
            put_big_endian(f, cell + k, sizeof *cell);
        fprintf(f, "\n");
        assert_int_equal(fclose(f), 0);
        if (i == 3) {
            assert_non_null(strstr(refused_path(path, "nan.vtk", false), "not finite"));
            unlink(path);
            continue;
        }
        check(read_geometry(path), 3, 1, 0, 0.5, 0);
        assert_non_null(strstr(said, "2 triangles and lines with a point that is not finite were left out"));
    }
}

static void test_files_cut_short_are_taken_for_whole_ones(void **state)
{
    (void)state;
    static const char whole[] = LEGACY_POINTS "POLYGONS 1 7\n6 5 6 7 8 9 10\n";
    const size_t n = strlen(whole);
    for (size_t keep = 1; keep < n - 5; keep += n / 9) {
        char text[sizeof whole];
        snprintf(text, sizeof text, "%.*s", (int)keep, whole);
        const char *path = scratch("short.vtk");
        write_text(path, text);
        refused_path(path, "short.vtk", true);
        unlink(path);
    }
    refused("short.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n");
    refused("short.ply", "ply\nformat ascii 1.0\nelement vertex 4\n");
    refused("short.obj", "v 0 0 0\nv 1 0 0\n");
    refused("wrong.obj", "f 1 2 3\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_polygons_strips_or_lines_of_legacy_files_are_missed),
        cmocka_unit_test(test_polydata_in_xml_is_missed),
        cmocka_unit_test(test_stl_obj_or_ply_is_missed),
        cmocka_unit_test(test_flat_cells_of_grids_are_missed),
        cmocka_unit_test(test_a_file_without_a_surface_is_drawn),
        cmocka_unit_test(test_damaged_lists_are_followed),
        cmocka_unit_test(test_cells_with_too_few_points_are_asked_for_more),
        cmocka_unit_test(test_counts_that_cannot_be_are_believed),
        cmocka_unit_test(test_points_that_are_not_finite_are_drawn),
        cmocka_unit_test(test_files_cut_short_are_taken_for_whole_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
