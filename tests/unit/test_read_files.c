/* test_read_files.c: real files give the cells, steps and ranges they are known to hold (skipped where they are
 * absent). */
#define _GNU_SOURCE

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "read_files.h"

#include <math.h>

#define DATA TC_SHARED_DATA "/"

static void need(const char *path)
{
    if (access(path, R_OK) != 0)
        skip();
}

static size_t count_of_type(const tc_mesh *m, const char *type)
{
    for (size_t i = 0; i < m->source->n_cell_type; i++)
        if (strcmp(m->source->cell_type[i].type, type) == 0)
            return m->source->cell_type[i].count;
    return 0;
}

static const tc_array_info *array_named(const tc_mesh *m, const char *name, tc_association association)
{
    for (size_t i = 0; i < m->source->n_array; i++)
        if (strcmp(m->source->array[i].name, name) == 0 && m->source->array[i].association == association)
            return &m->source->array[i];
    return NULL;
}

typedef struct known_file {
    const char *path, *format;
    size_t n_point, n_solid;
    const char *type; /* one of its cell types … */
    size_t n_type;    /* … and how many */
    size_t n_tet;     /* 0: not known beforehand */
    size_t n_component;
    size_t n_time;
} known_file;

/* Counts: shared/data/README.md, and for boundaries that the tets must match each other on every inner face. */
static const known_file known[] = {
    {DATA "bluntfin_tets.vtu", "VTK XML unstructured grid", 40921, 187318, "tetra", 187318, 187318, 1, 0},
    {DATA "combustor_tets.vtu", "VTK XML unstructured grid", 47025, 215040, "tetra", 215040, 215040, 0, 0},
    {DATA "vol/disk_out_ref.ex2", "Exodus II", 8499, 7472, "hexahedron", 7472, 5 * 7472, 1, 1},
    {DATA "vol/disk_out_ref.vtu", "VTK XML unstructured grid", 8499, 7472, "hexahedron", 7472, 5 * 7472, 1, 1},
    {DATA "vol/can.vtu", "VTK XML unstructured grid", 6724, 4800, "hexahedron", 4800, 0, 0, 0},
    {DATA "vol/can_series/can_0.hdf", "VTKHDF", 6724, 4800, "hexahedron", 4800, 24000, 1, 0},
    {DATA "vol/mug.e", "Exodus II", 3954, 2476, "hexahedron", 2476, 5 * 2476, 1, 21},
    {DATA "vol/fire_ug.vtu", "VTK XML unstructured grid", 12323, 10462, "hexahedron", 10462, 0, 1, 0},
    {DATA "vol/simple-cube-multi-element-order1.e", "Exodus II", 719, 1322, "pyramid", 750, 0, 4, 0},
    {DATA "vol/notch_stress_fixed.vtk", "legacy VTK", 3537, 2192, "wedge", 4, 0, 1, 0},
    {DATA "vol/notch_disp.vtu", "VTK XML unstructured grid", 12717, 2192, "quadratic_hexahedron", 2188, 0, 1, 0},
    {DATA "vol/patch_antenna.vtu", "VTK XML unstructured grid", 1464, 3997, "tetra", 3997, 3997, 1, 1},
    {DATA "vol/multi_material_cylinder_plate.vtk", "legacy VTK", 2101, 10440, "tetra", 10440, 10440, 1, 0},
    {DATA "vol/tetraMesh.vtk", "legacy VTK", 55, 160, "tetra", 160, 160, 1, 0},
    {DATA "vol/hexa.vtk", "legacy VTK", 12167, 10648, "hexahedron", 10648, 5 * 10648, 1, 0},
    {DATA "vol/vox8_binary.vtk", "legacy VTK", 27, 8, "voxel", 8, 40, 1, 0},
    {DATA "vol/sqnz_s.adf.cgns", "CGNS", 15228, 11264, "hexahedron", 11264, 5 * 11264, 1, 1},
    {DATA "vol/openfoam_cavity/case.foam", "OpenFOAM", 882, 400, "hexahedron", 400, 2000, 1, 6},
    {DATA "vol/openfoam_cavity", "OpenFOAM", 882, 400, "hexahedron", 400, 2000, 1, 6},
    {DATA "vol/plot3d/bluntfinxyz.bin", "PLOT3D", 40960, 37479, "hexahedron", 37479, 0, 1, 1},
    {DATA "vol/plot3d/combq.bin", "PLOT3D", 47025, 43008, "hexahedron", 43008, 0, 1, 1},
    {DATA "vol/ensight_elements/elements.case", "EnSight", 112, 8, "quadratic_pyramid", 1, 0, 8, 0},
    {DATA "vol/QuadraticTetra.vtu", "VTK XML unstructured grid", 189, 96, "quadratic_tetra", 96, 96, 1, 0},
    {DATA "vol/QuadraticPyramid.vtu", "VTK XML unstructured grid", 153, 48, "quadratic_pyramid", 48, 96, 1, 0},
    {DATA "vol/QuadraticWedge.vtu", "VTK XML unstructured grid", 93, 16, "quadratic_wedge", 16, 48, 1, 0},
    {DATA "vol/TriQuadraticHexahedron.vtu", "VTK XML unstructured grid", 117, 7, "triquadratic_hexahedron", 7, 35, 1,
     0},
    {DATA "vol/Hexahedron.vtu", "VTK XML unstructured grid", 26, 7, "hexahedron", 7, 35, 1, 0},
    {DATA "vol/Tetrahedron.vtu", "VTK XML unstructured grid", 35, 96, "tetra", 96, 96, 1, 0},
    {DATA "vol/Wedge.vtu", "VTK XML unstructured grid", 27, 16, "wedge", 16, 48, 1, 0},
    {DATA "vol/CylinderLinear.vtk", "legacy VTK", 465, 1522, "tetra", 1522, 1522, 1, 0},
    {DATA "vol/VTKCellTypes.vtk", "legacy VTK", 27, 3, NULL, 0, 0, 0, 0},
    {DATA "vol/uGridEx.vtk", "legacy VTK", 27, 4, NULL, 0, 0, 0, 0},
    {DATA "vol/box-noglom.ex2", "Exodus II", 27, 40, "tetra", 40, 40, 1, 1},
};

static void test_real_files_lose_cells(void **state)
{
    (void)state;
    need(DATA "vol");
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        const known_file *k = &known[i];
        const tc_read_options options = {.field = NULL};
        tc_mesh *m = read_path(k->path, &options);
        const tc_source *s = m->source;
        assert_string_equal(s->path, k->path);
        assert_string_equal(s->format, k->format);
        assert_int_equal(s->n_point, k->n_point);
        assert_int_equal(m->report.source_cells, k->n_solid);
        assert_int_equal(s->n_time, k->n_time);
        assert_int_equal(s->step, k->n_time ? 0 : -1);
        if (k->type)
            assert_int_equal(count_of_type(m, k->type), k->n_type);
        if (k->n_tet)
            assert_int_equal(m->n_tet, k->n_tet);
        size_t cells = 0;
        for (size_t c = 0; c < s->n_cell_type; c++)
            cells += s->cell_type[c].count;
        assert_int_equal(cells, s->n_cell);
        assert_int_equal(s->dropped_cells, s->n_cell - k->n_solid);
        assert_true(mesh_volume(m) > 0);
        assert_true(s->helper_peak_bytes > 0 && s->ms_read > 0);
        if (k->n_component && k->n_point < 20000) { /* the large ones cost seconds here */
            const tc_mesh_report r = prepared(m);
            assert_int_equal(r.n_component, k->n_component);
            assert_int_equal(r.unlinked_faces, 0);
            assert_int_equal(r.reoriented, m->file.turned); /* the reader left no other one */
        }
        tc_mesh_destroy(&m);
    }
}

static void test_blunt_fin_arrays_are_wrong(void **state)
{
    (void)state;
    need(DATA "bluntfin_tets.vtu");
    const tc_read_options density = {.field = "Density", .all_ranges = true};
    tc_mesh *m = read_path(DATA "bluntfin_tets.vtu", &density);
    assert_string_equal(m->source->field, "Density");
    assert_string_equal(m->field_name, "Density");
    assert_int_equal(m->association, TC_POINT_DATA);
    assert_int_equal(m->source->n_array, 4);
    const tc_array_info *momentum = array_named(m, "Momentum", TC_POINT_DATA);
    assert_non_null(momentum);
    assert_int_equal(momentum->components, 3);
    assert_non_null(array_named(m, "StagnationEnergy", TC_POINT_DATA));
    assert_non_null(array_named(m, "Pressure", TC_POINT_DATA));
    double lo = INFINITY, hi = -INFINITY;
    for (size_t i = 0; i < m->n_vertex; i++) {
        lo = fmin(lo, m->scalar[i]);
        hi = fmax(hi, m->scalar[i]);
    }
    const tc_array_info *info = array_named(m, "Density", TC_POINT_DATA);
    assert_true(lo == info->lo && hi == info->hi && lo < hi);
    tc_mesh_destroy(&m);

    /* The same flow in its first form: the same points, the same values, the same volume. */
    const tc_read_options plot3d = {.field = "StagnationEnergy"};
    m = read_path(DATA "vol/plot3d/bluntfinq.bin", &plot3d);
    tc_mesh *tets = read_path(DATA "bluntfin_tets.vtu", &plot3d);
    const tc_array_info *a = array_named(m, "StagnationEnergy", TC_POINT_DATA);
    const tc_array_info *b = array_named(tets, "StagnationEnergy", TC_POINT_DATA);
    assert_true(a->lo == b->lo && a->hi == b->hi);
    assert_true(fabs(mesh_volume(m) / mesh_volume(tets) - 1) < 1e-6);
    /* Only the wanted array was read. */
    const tc_array_info *unread = array_named(tets, "Density", TC_POINT_DATA);
    assert_non_null(unread);
    assert_int_equal(unread->components, 0);
    assert_true(isnan(unread->lo) && isnan(unread->hi));
    tc_mesh_destroy(&m);
    tc_mesh_destroy(&tets);
}

static void test_vectors_are_not_magnitudes(void **state)
{
    (void)state;
    const char *path = DATA "vol/can.vtu";
    need(path);
    const char *fields[] = {"VEL:0", "VEL:Y", "VEL:2", "VEL", "VEL:magnitude"};
    tc_mesh *m[5];
    for (int i = 0; i < 5; i++) {
        const tc_read_options options = {.field = fields[i]};
        m[i] = read_path(path, &options);
    }
    for (size_t v = 0; v < m[0]->n_vertex; v++) {
        const double x = m[0]->scalar[v], y = m[1]->scalar[v], z = m[2]->scalar[v];
        const double length = sqrt(x * x + y * y + z * z);
        /* Points inside cells interpolate, so only nearly. */
        assert_true(fabs(m[3]->scalar[v] - length) <= 1e-9 * length);
        assert_true(m[3]->scalar[v] == m[4]->scalar[v]);
    }
    assert_string_equal(m[3]->source->field, "VEL:magnitude");
    assert_string_equal(m[1]->source->field, "VEL:Y");
    for (int i = 0; i < 5; i++)
        tc_mesh_destroy(&m[i]);
    const tc_read_options cell = {.field = "EQPS"};
    tc_mesh *c = read_path(path, &cell);
    assert_int_equal(c->association, TC_CELL_DATA);
    tc_mesh_destroy(&c);
    const tc_read_options bad = {.field = "VEL:3"};
    assert_non_null(strstr(refusal_of(path, &bad), "component"));
}

static void test_missing_arrays_are_not_listed(void **state)
{
    (void)state;
    need(DATA "vol/can.vtu");
    const tc_read_options options = {.field = "Nope"};
    const char *text = refusal_of(DATA "vol/can.vtu", &options);
    assert_non_null(strstr(text, "Nope"));
    assert_non_null(strstr(text, "DISPL"));
    assert_non_null(strstr(text, "cell arrays EQPS"));
    const tc_read_options wrong_kind = {.field = "EQPS", .association = TC_POINT_DATA};
    assert_non_null(strstr(refusal_of(DATA "vol/can.vtu", &wrong_kind), "point array"));
}

static double highest(const char *path, const tc_read_options *options, int step)
{
    tc_mesh *m = read_path(path, options);
    double hi = -INFINITY;
    const size_t n = m->association == TC_CELL_DATA ? m->n_tet : m->n_vertex;
    for (size_t i = 0; i < n; i++)
        hi = fmax(hi, m->scalar[i]);
    assert_int_equal(m->source->step, step);
    tc_mesh_destroy(&m);
    return hi;
}

static void test_time_steps_are_mixed_up(void **state)
{
    (void)state;
    const char *path = DATA "vol/mug.e";
    need(path);
    const tc_read_options first = {.field = "convected"}, last = {.field = "convected", .has_step = true, .step = -1},
                          number = {.field = "convected", .has_step = true, .step = 7},
                          at = {.field = "convected", .has_time = true, .time = 0.7},
                          between = {.field = "convected", .has_time = true, .time = 0.79},
                          early = {.field = "convected", .has_time = true, .time = -3},
                          late = {.field = "convected", .has_time = true, .time = 99},
                          beyond = {.field = "convected", .has_step = true, .step = 21};
    assert_true(highest(path, &first, 0) == 0);
    const double end = highest(path, &last, 20), middle = highest(path, &number, 7);
    assert_true(end == highest(path, &late, 20));
    assert_true(middle == highest(path, &at, 7));
    assert_true(middle == highest(path, &between, 7));
    assert_true(highest(path, &early, 0) == 0);
    assert_non_null(strstr(refusal_of(path, &beyond), "21 time steps"));
    const tc_read_options cavity_end = {.field = "p", .association = TC_CELL_DATA, .has_time = true, .time = 2.2};
    assert_true(highest(DATA "vol/openfoam_cavity", &cavity_end, 4) > 0);
}

/* A file whose blocks are of one cell type each: its tets with each block's number are those of that type. */
static void test_block_numbers_are_lost(void **state)
{
    (void)state;
    const char *path = DATA "vol/simple-cube-multi-element-order1.e";
    need(path);
    static const struct {
        const char *name, *type;
        size_t tets;
    } block[] = {{"hex8", "hexahedron", 5}, {"tet4", "tetra", 1}, {"wedge6", "wedge", 3}, {"pyramid5", "pyramid", 2}};
    const tc_read_options ids = {.field = "ObjectId"}, zones = {.field = "vtkCompositeIndex"}, other = {.field = "aux_elem"};
    tc_mesh *m = read_path(path, &ids);
    assert_int_equal(m->association, TC_CELL_DATA);
    assert_int_equal(m->source->n_block, 4);
    for (size_t b = 0; b < 4; b++) {
        size_t n = 0;
        for (size_t t = 0; t < m->n_tet; t++)
            n += m->scalar[t] == (double)(b + 1);
        assert_int_equal(n, block[b].tets * count_of_type(m, block[b].type));
        assert_int_equal(m->source->block[b].number, b + 1);
        assert_string_equal(m->source->block[b].name, block[b].name);
    }
    tc_mesh_destroy(&m);
    m = read_path(path, NULL);
    assert_null(m->source->field); /* it has no variable, and numbers are none */
    tc_mesh_destroy(&m);
    m = read_path(DATA "vol/mug.e", &other);
    const tc_array_info *last = &m->source->array[m->source->n_array - 1];
    assert_string_equal(last->name, "ObjectId");
    assert_int_equal(last->components, 0); /* not made */
    assert_int_equal(m->source->block[1].number, 76);
    tc_mesh_destroy(&m);
    m = read_path(DATA "vol/disk_out_ref.ex2", NULL);
    assert_null(array_named(m, "ObjectId", TC_CELL_DATA)); /* one block */
    tc_mesh_destroy(&m);
    m = read_path(DATA "vol/can_series/can_0.hdf", NULL);
    assert_non_null(array_named(m, "ObjectId", TC_CELL_DATA)); /* the file's own */
    assert_int_equal(m->source->n_block, 0);
    tc_mesh_destroy(&m);
    m = read_path(DATA "vol/sqnz_s.adf.cgns", &zones);
    last = array_named(m, "vtkCompositeIndex", TC_CELL_DATA);
    assert_true(last->lo == 2 && last->hi == 13);
    assert_int_equal(m->source->n_block, 12);
    assert_string_equal(m->source->block[0].name, "dom1_1_1_1");
    tc_mesh_destroy(&m);
}

static void test_inverted_cells_stay_inverted(void **state)
{
    (void)state;
    need(DATA "vol/fire_ug.vtu");
    tc_mesh *m = read_path(DATA "vol/fire_ug.vtu", NULL);
    assert_true(mesh_volume(m) > 0);
    assert_int_equal(prepared(m).reoriented, 10462);
    tc_mesh_destroy(&m);
    m = read_path(DATA "vol/tetraMesh.vtk", NULL);
    assert_int_equal(prepared(m).reoriented, 80);
    tc_mesh_destroy(&m);
    m = read_path(DATA "vol/patch_antenna.vtu", NULL);
    assert_int_equal(prepared(m).reoriented, m->report.source_cells);
    tc_mesh_destroy(&m);
}

static void test_refined_neighbours_come_apart(void **state)
{
    (void)state;
    need(DATA "vol");
    static const char *const paths[] = {DATA "vol/QuadraticTetra.vtu", DATA "vol/QuadraticPyramid.vtu",
                                        DATA "vol/QuadraticWedge.vtu", DATA "vol/TriQuadraticHexahedron.vtu",
                                        DATA "vol/notch_disp.vtu"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        const tc_read_options fine = {.refine = 1};
        tc_mesh *coarse = read_path(paths[i], NULL), *refined = read_path(paths[i], &fine);
        const tc_mesh_report a = prepared(coarse), b = prepared(refined);
        assert_int_equal(b.n_boundary_face, 4 * a.n_boundary_face);
        assert_int_equal(b.unlinked_faces, 0);
        assert_int_equal(b.n_component, a.n_component);
        tc_mesh_destroy(&coarse);
        tc_mesh_destroy(&refined);
    }
}

static void copy_head(const char *from, const char *to, double part)
{
    FILE *in = fopen(from, "rb");
    assert_non_null(in);
    struct stat st;
    assert_int_equal(fstat(fileno(in), &st), 0);
    const size_t n = (size_t)(part * (double)st.st_size);
    char *bytes = malloc(n + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, n, in), n);
    fclose(in);
    FILE *out = fopen(to, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(bytes, 1, n, out), n);
    assert_int_equal(fclose(out), 0);
    free(bytes);
}

static void test_files_cut_short_are_taken_for_whole(void **state)
{
    (void)state;
    need(DATA "vol");
    static const char *const paths[] = {"can.vtu",
                                        "fire_ug.vtu",
                                        "mug.e",
                                        "disk_out_ref.ex2",
                                        "can_series/can_0.hdf",
                                        "sqnz_s.adf.cgns",
                                        "plot3d/combxyz.bin",
                                        "patch_antenna.vtu",
                                        "CylinderLinear.vtk",
                                        "hexa.vtk",
                                        "notch_stress_fixed.vtk",
                                        "vox8_binary.vtk"};
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++)
        for (int percent = 10; percent < 100; percent += 40) {
            char from[512];
            snprintf(from, sizeof from, "%s%s", DATA "vol/", paths[i]);
            const char *slash = strrchr(from, '/');
            const char *cut = scratch(slash + 1);
            copy_head(from, cut, percent / 100.0);
            assert_non_null(strstr(refusal_of(cut, NULL), cut));
            unlink(cut);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_real_files_lose_cells),
        cmocka_unit_test(test_blunt_fin_arrays_are_wrong),
        cmocka_unit_test(test_vectors_are_not_magnitudes),
        cmocka_unit_test(test_missing_arrays_are_not_listed),
        cmocka_unit_test(test_time_steps_are_mixed_up),
        cmocka_unit_test(test_block_numbers_are_lost),
        cmocka_unit_test(test_inverted_cells_stay_inverted),
        cmocka_unit_test(test_refined_neighbours_come_apart),
        cmocka_unit_test(test_files_cut_short_are_taken_for_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
