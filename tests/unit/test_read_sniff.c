/* test_read_sniff.c: files are told by their content, and what is not read says what to do. */
#define _GNU_SOURCE

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "read_files.h"

#include "readers/plot3d_layout.h"
#include "readers/sniff.h"

static void check_format(const char *path, const char *head, size_t n, tc_format format, const char *kind)
{
    tc_sniffed s;
    tc_error err = {0};
    if (tc_sniff_head(&s, path, (const unsigned char *)head, n, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_int_equal(s.format, format);
    assert_string_equal(s.kind, kind);
}

static void test_content_is_told_by_name(void **state)
{
    (void)state;
#define HEAD(text) text, sizeof(text) - 1
    /* Every name here lies. */
    check_format("a.ply", HEAD("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">"), TC_FORMAT_VTK_XML,
                 "UnstructuredGrid");
    check_format("a.vtk", HEAD("<VTKFile version='1' type = 'PUnstructuredGrid' >"), TC_FORMAT_VTK_XML,
                 "PUnstructuredGrid");
    check_format("a.vtu", HEAD("<VTKFile type=\"Collection\">"), TC_FORMAT_PVD, "Collection");
    check_format("a.vtu", HEAD("# vtk DataFile Version 2.0\nx\nASCII\nDATASET unstructured_grid\n"),
                 TC_FORMAT_VTK_LEGACY, "UNSTRUCTURED_GRID");
    check_format("a.vtu", HEAD("\x89HDF\r\n\x1a\n.......VTKHDF..."), TC_FORMAT_VTKHDF, "");
    check_format("a.vtu", HEAD("\x89HDF\r\n\x1a\n.......CGNSLibraryVersion"), TC_FORMAT_CGNS, "HDF5");
    check_format("a.vtu", HEAD("\x89HDF\r\n\x1a\n..num_el_blk..."), TC_FORMAT_EXODUS, "netCDF-4");
    check_format("a.vtu", HEAD("CDF\001....len_string....num_el_blk"), TC_FORMAT_EXODUS, "netCDF-3");
    check_format("a.vtu", HEAD("@(#)ADF Database Version A02011>"), TC_FORMAT_CGNS, "ADF");
    check_format("a.txt", HEAD("{ \"file-series-version\" : \"1.0\" }"), TC_FORMAT_SERIES, "");
    check_format("a.txt", HEAD("# c\nFORMAT\ntype: ensight gold\nGEOMETRY\nmodel: a.geo\n"), TC_FORMAT_ENSIGHT, "");
    check_format("controlDict", HEAD("FoamFile\n{\n    version 2.0;\n"), TC_FORMAT_OPENFOAM, "");
    check_format("a.bin", HEAD("\001\002\003\004"), TC_FORMAT_UNKNOWN, "");
}

static void check_refusal(const char *path, const char *text, const char *part)
{
    tc_sniffed s;
    tc_error err = {0};
    const char *file = scratch(path);
    write_text(file, text);
    assert_int_equal(tc_sniff_file(&s, file, &err), TC_E_FILE);
    if (!strstr(err.text, part) || !strstr(err.text, file))
        fail_msg("'%s' does not name the file and '%s'", err.text, part);
    unlink(file);
}

static void test_foreign_formats_name_no_way_out(void **state)
{
    (void)state;
    check_refusal("a.msh", "$MeshFormat\n4.1 0 8\n", "meshio convert");
    check_refusal("b.vtu", "$MeshFormat\n4.1 0 8\n", "Gmsh");
    check_refusal("a.xdmf", "<?xml version=\"1.0\" ?>\n<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n<Xdmf>", "XDMF");
    check_refusal("a.inp", "*Heading\nx\n*Node\n", "Abaqus");
    check_refusal("c.inp", "** comment\n", "Abaqus");
    check_refusal("a.bdf", "$ Nastran\nBEGIN BULK\n", "Nastran");
    check_refusal("a.med", "whatever", "meshio convert");
    check_refusal("a.cdb", "/PREP7\n", "ANSYS");
    check_refusal("a.gz", "\x1f\x8b\x08", "unpack");
    check_refusal("a.stl", "solid x\nfacet", "surface");
    check_refusal("a.vtp", "<VTKFile type=\"PolyData\">", "surface");
    check_refusal("b.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n", "surface");
    check_refusal("a.html", "<!DOCTYPE html><html>", "web page");
    check_refusal("c.vtu", "version https://git-lfs.github.com/spec/v1\n", "git lfs pull");
    check_refusal("d.vtu", "not xml at all", "damaged or misnamed");
    check_refusal("e.vtu", "", "empty");
    check_refusal("f.vtu", "<?xml version=\"1.0\"?>\n<VTKFile ty", "first tag");
    check_refusal("a.sos", "FORMAT\ntype: master_server gold\nSERVERS\n# ensight\n", ".case");
    check_refusal("a.unheard", "lorem ipsum", "known here");
    check_refusal("a.json", "[{\"Name\": \"x\", \"RGBPoints\": [0, 1, 1, 1]}]", "--color-map");
    check_refusal("a.xml", "<ColorMap name=\"x\"/>", "--color-map");
    check_refusal("a.foam", "", "constant/polyMesh");
    check_refusal("U", "FoamFile\n{\n    version 2.0;\n", "folder of the case");
    check_refusal("a.geo", "EnSight Gold\na\nnode id assign\nelement id assign\npart\n", "give the .case file");
    check_refusal("a.geo", "Point(1) = {0, 0, 0, 1};\n", "gmsh -3");
    tc_sniffed s;
    tc_error err;
    assert_int_equal(tc_sniff_file(&s, TC_BUILD_DIR, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "constant/polyMesh"));
    assert_int_equal(tc_sniff_file(&s, "/dev/null", &err), TC_E_FILE);
    assert_int_equal(tc_sniff_file(&s, "/nowhere/at/all", &err), TC_E_FILE);
}

static void test_parts_of_a_case_do_not_name_the_case(void **state)
{
    (void)state;
    static const char *const made[] = {"", "/constant", "/constant/polyMesh", "/0"};
    char folder[600], path[700];
    tc_sniffed s;
    tc_error err = {0};
    snprintf(folder, sizeof folder, "%s", scratch("foam"));
    for (size_t i = 0; i < sizeof made / sizeof *made; i++) {
        snprintf(path, sizeof path, "%s%s", folder, made[i]);
        assert_int_equal(mkdir(path, 0700), 0);
    }
    snprintf(path, sizeof path, "%s/0/U", folder);
    write_text(path, "FoamFile\n{\n    version 2.0;\n");
    char *real = realpath(folder, NULL), want[700];
    assert_non_null(real);
    snprintf(want, sizeof want, "give the folder of the case: %s", real);
    free(real);
    assert_int_equal(tc_sniff_file(&s, path, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, want));
    unlink(path);
    *strrchr(path, '/') = 0; /* a folder within */
    assert_int_equal(tc_sniff_file(&s, path, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, want));
    for (size_t i = sizeof made / sizeof *made; i-- > 0;) {
        snprintf(path, sizeof path, "%s%s", folder, made[i]);
        assert_int_equal(rmdir(path), 0);
    }

    const char *geometry = scratch("e.geo"), *beside = scratch("e.case");
    write_text(geometry, "EnSight Gold\na\nnode id assign\nelement id assign\npart\n");
    write_text(beside, "FORMAT\ntype: ensight gold\n");
    assert_int_equal(tc_sniff_file(&s, geometry, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, beside));
    unlink(geometry);
    unlink(beside);
}

/* ------------------------------------------------------------------------------------------ PLOT3D */

static void put(FILE *f, uint32_t v, bool big)
{
    for (int i = 0; i < 4; i++)
        fputc((int)(v >> (big ? 24 - 8 * i : 8 * i) & 255), f);
}

static const char *write_plot3d(const char *name, const tc_plot3d_layout *l, size_t padding)
{
    const char *path = scratch(name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    const bool big = l->big_endian, count = l->byte_counts;
    if (l->multi_grid) {
        if (count)
            put(f, 4, big);
        put(f, (uint32_t)l->n_grid, big);
        if (count)
            put(f, 4, big);
    }
    if (count)
        put(f, 12 * (uint32_t)l->n_grid, big);
    for (size_t g = 0; g < l->n_grid; g++)
        for (int k = 0; k < 3; k++)
            put(f, (uint32_t)(3 + k + (int)g), big);
    if (count)
        put(f, 12 * (uint32_t)l->n_grid, big);
    for (size_t g = 0; g < l->n_grid; g++) {
        size_t n = (3 + g) * (4 + g) * (5 + g), bytes = 0;
        const size_t real = l->double_precision ? 8 : 4;
        if (l->kind == TC_PLOT3D_XYZ)
            bytes = 3 * n * real + (l->iblank ? 4 * n : 0) + (count ? 8 : 0);
        else
            bytes = 4 * real + 5 * n * real + (count ? 16 : 0);
        for (size_t i = 0; i < bytes; i++)
            fputc(0, f);
    }
    for (size_t i = 0; i < padding; i++)
        fputc(0, f);
    assert_int_equal(fclose(f), 0);
    return path;
}

static void test_plot3d_layouts_are_confused(void **state)
{
    (void)state;
    for (unsigned code = 0; code < 64; code++) {
        tc_plot3d_layout want = {.kind = code & 32 ? TC_PLOT3D_Q : TC_PLOT3D_XYZ,
                                 .big_endian = code & 1,
                                 .byte_counts = code & 2,
                                 .multi_grid = code & 4,
                                 .iblank = code & 8,
                                 .double_precision = code & 16,
                                 .n_grid = code & 4 ? 3 : 1};
        if (want.kind == TC_PLOT3D_Q && want.iblank)
            continue;
        const char *path = write_plot3d("layout.bin", &want, 0);
        tc_plot3d_layout got;
        assert_int_equal(tc_plot3d_layout_of(&got, path, NULL), TC_OK);
        unlink(path);
        assert_int_equal(got.kind, want.kind);
        assert_int_equal(got.big_endian, want.big_endian);
        assert_int_equal(got.byte_counts, want.byte_counts);
        assert_int_equal(got.multi_grid, want.multi_grid);
        assert_int_equal(got.iblank, want.iblank);
        assert_int_equal(got.double_precision, want.double_precision);
        assert_int_equal(got.n_grid, want.n_grid);
        assert_int_equal(got.n_point, code & 4 ? 60 + 120 + 210 : 60);
    }
    const char *path = scratch("layout.bin");
    write_text(path, "some text that is no grid at all");
    tc_plot3d_layout none;
    assert_int_equal(tc_plot3d_layout_of(&none, path, NULL), TC_OK);
    assert_int_equal(none.kind, TC_PLOT3D_NONE);
    unlink(path);
}

static void test_plot3d_partners_are_not_found(void **state)
{
    (void)state;
    const tc_plot3d_layout xyz = {.kind = TC_PLOT3D_XYZ, .big_endian = true, .n_grid = 1, .n_point = 60};
    tc_plot3d_layout q = xyz;
    q.kind = TC_PLOT3D_Q;
    char grid_path[512], q_path[512], found[512];
    snprintf(grid_path, sizeof grid_path, "%s", write_plot3d("boxxyz.bin", &xyz, 0));
    assert_false(tc_plot3d_partner(found, sizeof found, grid_path, &xyz));
    snprintf(q_path, sizeof q_path, "%s", write_plot3d("boxq.bin", &q, 0));
    assert_true(tc_plot3d_partner(found, sizeof found, grid_path, &xyz));
    assert_string_equal(found, q_path);
    assert_true(tc_plot3d_partner(found, sizeof found, q_path, &q));
    assert_string_equal(found, grid_path);
    unlink(grid_path);
    unlink(q_path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_content_is_told_by_name),
        cmocka_unit_test(test_foreign_formats_name_no_way_out),
        cmocka_unit_test(test_parts_of_a_case_do_not_name_the_case),
        cmocka_unit_test(test_plot3d_layouts_are_confused),
        cmocka_unit_test(test_plot3d_partners_are_not_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
