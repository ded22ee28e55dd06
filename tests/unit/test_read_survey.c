/* What a step's mesh will be like, told without making it (tc_mesh_survey). */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "read_files.h"

#include <math.h>

static bool same_number(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* The survey against what reading and preparing the step gives. *last: a mesh of another step, or NULL; then of this.
 */
static void must_be_the_mesh(const tc_survey *survey, tc_mesh **last, const char *path, const tc_read_options *options)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    tc_read_options keeping = *options;
    keeping.keep_reader = true;
    tc_status status;
    if (!*last) {
        status = tc_mesh_read(&mesh, path, &keeping, NULL, &err);
    } else if ((status = tc_mesh_read_values(&mesh, *last, path, options, NULL, &err)) == TC_OK) {
        mesh = *last;
        *last = NULL;
    } else if (status == TC_E_MOVED) {
        status = TC_OK;
    }
    tc_mesh_destroy(last);
    if (!status)
        status = tc_mesh_prepare(mesh, &(tc_prepare_options){.reentry = TC_REENTRY_PEEL}, NULL, &err);
    if (status) {
        if (!survey->status)
            fail_msg("surveyed, but: %s", err.text);
        tc_mesh_destroy(&mesh);
        return;
    }
    if (survey->status)
        fail_msg("%s, step %d: %s", path, options->step, survey->why);
    tc_mesh_report r;
    tc_mesh_get_report(&r, mesh);
    const size_t n = r.association == TC_CELL_DATA ? r.n_tet : r.n_vertex;
    const double *range = survey->range;
    const bool any = r.nonfinite_scalars < n;
    if (any ? range[0] != r.scalar_range[0] || range[1] != r.scalar_range[1] : !(range[0] > range[1]))
        fail_msg("%s, step %d, array %s: range %.17g to %.17g, not %.17g to %.17g", path, options->step,
                 options->field ? options->field : "(first)", range[0], range[1], r.scalar_range[0], r.scalar_range[1]);
    for (int k = 0; k < 6; k++)
        if (survey->bounds[k] != r.bounds[k])
            fail_msg("%s, step %d: bound %d is %.17g, not %.17g", path, options->step, k, survey->bounds[k],
                     r.bounds[k]);
    assert_int_equal(survey->source_cells, r.source_cells);
    const tc_source *source = tc_mesh_source(mesh);
    assert_true(same_number(survey->time, source->step >= 0 ? source->time[source->step] : NAN));
    *last = mesh;
}

static void must_be_that_mesh(const tc_survey *survey, const char *path, const tc_read_options *options)
{
    tc_mesh *mesh = NULL;
    must_be_the_mesh(survey, &mesh, path, options);
    tc_mesh_destroy(&mesh);
}

enum { STEPS_MOST = 64, ARRAYS_MOST = 3 };

/* Every step of one array (or the first and the last) in one survey. */
static void survey_array(const char *path, const char *field, tc_association association, int n_step, bool all)
{
    static tc_survey out[STEPS_MOST];
    int step[STEPS_MOST] = {0}, n = 0;
    for (int i = 0; i < n_step && n < STEPS_MOST; i++)
        if (all || i == 0 || i == n_step - 1)
            step[n++] = i;
    tc_read_options options = {.field = field, .association = association, .has_step = true};
    tc_error err = {0};
    if (tc_mesh_survey(out, step, (size_t)n, path, &options, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_mesh *mesh = NULL;
    for (int i = 0; i < n; i++) {
        options.step = step[i];
        must_be_the_mesh(&out[i], &mesh, path, &options);
    }
    tc_mesh_destroy(&mesh);
}

/* The file's first array, some of its others, and a component of one that has several. False: it is not read at all. */
static bool survey_file(const char *path, bool all)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    if (tc_mesh_read(&mesh, path, NULL, NULL, &err) != TC_OK) {
        tc_survey out;
        assert_int_not_equal(tc_mesh_survey(&out, NULL, 1, path, NULL, NULL, &err), TC_OK);
        assert_int_not_equal(out.status, TC_OK);
        return false;
    }
    const tc_source *source = tc_mesh_source(mesh);
    const int n_step = source->n_time ? (int)source->n_time : 1;
    survey_array(path, NULL, TC_ANY_DATA, n_step, all);
    bool component = false;
    for (size_t i = 0, n = 0; i < source->n_array && n < ARRAYS_MOST; i++, n++) {
        const tc_array_info *array = &source->array[i];
        if (array->components == 0)
            continue;
        survey_array(path, array->name, array->association, n_step, all);
        if (array->components > 1 && !component) {
            char text[256];
            snprintf(text, sizeof text, "%s:1", array->name);
            survey_array(path, text, array->association, n_step, false);
            component = true;
        }
    }
    tc_mesh_destroy(&mesh);
    return true;
}

static const char *const vol = TC_SHARED_DATA "/vol";

static void a_survey_of_a_real_file_is_not_its_mesh(void **state)
{
    (void)state;
    static const char *const name[] = {"CylinderLinear.vtk",
                                       "Hexahedron.vtu",
                                       "QuadraticPyramid.vtu",
                                       "QuadraticTetra.vtu",
                                       "QuadraticWedge.vtu",
                                       "Tetrahedron.vtu",
                                       "TriQuadraticHexahedron.vtu",
                                       "VTKCellTypes.vtk",
                                       "Wedge.vtu",
                                       "box-noglom.ex2",
                                       "can.vtu",
                                       "can_series/can_0.hdf",
                                       "disk_out_ref.ex2",
                                       "disk_out_ref.vtu",
                                       "ensight_elements/elements.case",
                                       "fire_ug.vtu",
                                       "hexa.vtk",
                                       "multi_material_cylinder_plate.vtk",
                                       "notch_disp.vtu",
                                       "notch_stress_fixed.vtk",
                                       "patch_antenna.vtu",
                                       "simple-cube-multi-element-order1.e",
                                       "sqnz_s.adf.cgns",
                                       "tetraMesh.vtk",
                                       "uGridEx.vtk",
                                       "vox8_binary.vtk"};
    if (access(vol, R_OK) != 0)
        skip();
    int n = 0;
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        char path[600];
        snprintf(path, sizeof path, "%s/%s", vol, name[i]);
        n += access(path, R_OK) == 0 && survey_file(path, false);
    }
    assert_true(n > 20);
}

/* Displaced points in each step; and a case whose folder is read on. */
static void a_later_step_is_surveyed_as_the_first(void **state)
{
    (void)state;
    char path[600];
    if (access(vol, R_OK) != 0)
        skip();
    snprintf(path, sizeof path, "%s/mug.e", vol);
    assert_true(survey_file(path, true));
    snprintf(path, sizeof path, "%s/openfoam_cavity/case.foam", vol);
    assert_true(survey_file(path, true));
}

/* ------------------------------------------------------------------------------------------ files of our own */

/* A cube from [x, y, z] on, its points added. */
static void add_cube(grid *g, double x, double y, double z)
{
    int id[8];
    for (int i = 0; i < 8; i++)
        id[i] = add_point(g, x + (i % 4 == 1 || i % 4 == 2), y + (i % 4 > 1), z + i / 4);
    add_cell(g, 12, 8, id);
}

/* A file of g whose points and cells have values from a row of odd numbers; value[i] at point i where given. The
 * vectors V have length 1 at each point, so that they are shorter at any other. */
static void write_valued(const char *path, const grid *g, const double *value)
{
    static char points[65536], cells[65536];
    int n = snprintf(points, sizeof points, "<DataArray type=\"Float64\" Name=\"P\" format=\"ascii\">");
    for (int i = 0; i < g->n_point; i++)
        n += snprintf(points + n, sizeof points - (size_t)n, "%.17g ", value ? value[i] : sin(7.0 * i));
    n += snprintf(points + n, sizeof points - (size_t)n,
                  "</DataArray><DataArray type=\"Float64\" Name=\"V\" NumberOfComponents=\"3\" format=\"ascii\">");
    for (int i = 0; i < g->n_point; i++)
        n += snprintf(points + n, sizeof points - (size_t)n, "%.17g %.17g 0 ", cos(2.0 * i), sin(2.0 * i));
    snprintf(points + n, sizeof points - (size_t)n, "</DataArray>");
    n = snprintf(cells, sizeof cells, "<DataArray type=\"Float64\" Name=\"C\" format=\"ascii\">");
    for (int i = 0; i < g->n_cell; i++)
        n += snprintf(cells + n, sizeof cells - (size_t)n, "%.17g ", cos(5.0 * i));
    snprintf(cells + n, sizeof cells - (size_t)n, "</DataArray>");
    write_vtu(path, g, points, cells);
}

static void survey_grid(const grid *g, const double *value)
{
    const char *path = scratch("survey.vtu");
    write_valued(path, g, value);
    assert_true(survey_file(path, true));
    unlink(path);
}

/* Points of no cell, and of a triangle beside the 3-D cells: both far off, with large values. */
static void points_that_no_solid_cell_uses_count(void **state)
{
    (void)state;
    static grid g;
    static double value[16];
    memset(&g, 0, sizeof g);
    add_point(&g, 50, 50, 50);
    add_cube(&g, 0, 0, 0);
    add_cell(&g, 5, 3, (const int[]){0, 1, 2});
    for (int i = 0; i < 9; i++)
        value[i] = i == 0 ? 1e6 : -i;
    survey_grid(&g, value);
}

/* Cells that lose corners or get points when they are cut: folded, collapsed, at one place with others, polyhedra. */
static void cells_that_change_their_points_are_taken_by_their_corners(void **state)
{
    (void)state;
    static grid g;
    static double value[64];
    memset(&g, 0, sizeof g);
    add_cube(&g, 0, 0, 0);
    add_cube(&g, 3, 0, 0);
    memcpy(g.point[14], (const double[]){3.2, 0.1, 0.1}, sizeof g.point[14]); /* a corner through the opposite ones */
    survey_grid(&g, NULL);

    memset(&g, 0, sizeof g);
    add_cube(&g, 0, 0, 0);
    add_cell(&g, 10, 4, (const int[]){0, 1, 1, 2}); /* nothing is left of it */
    const int far = add_point(&g, 9, 9, 9);
    add_cell(&g, 10, 4, (const int[]){far, 1, 2, 1});
    survey_grid(&g, NULL);

    /* a tet whose first two points lie in one place: of equal values it vanishes, with the far point that it alone has
     */
    for (int equal = 0; equal < 2; equal++) {
        memset(&g, 0, sizeof g);
        add_cube(&g, 0, 0, 0);
        const int twin = add_point(&g, 0, 0, 0), alone = add_point(&g, 0, 0, 7);
        add_cell(&g, 10, 4, (const int[]){0, twin, 1, alone});
        for (int i = 0; i < g.n_point; i++)
            value[i] = i;
        value[twin] = equal ? 0 : 1;
        survey_grid(&g, value);
    }

    memset(&g, 0, sizeof g);
    for (int i = 0; i < 8; i++)
        add_point(&g, i % 4 == 1 || i % 4 == 2, i % 4 > 1, i / 4);
    add_polyhedron(
        &g, (const int[]){6, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7, 4, 0, 1, 5, 4, 4, 1, 2, 6, 5, 4, 2, 3, 7, 6, 4, 3, 0, 4, 7});
    survey_grid(&g, NULL);

    memset(&g, 0, sizeof g); /* one face is missing: left out, with another cell beside it */
    for (int i = 0; i < 8; i++)
        add_point(&g, i % 4 == 1 || i % 4 == 2, i % 4 > 1, i / 4);
    add_polyhedron(&g, (const int[]){5, 4, 0, 3, 2, 1, 4, 4, 5, 6, 7, 4, 0, 1, 5, 4, 4, 1, 2, 6, 5, 4, 2, 3, 7, 6});
    add_cube(&g, 5, 5, 5);
    survey_grid(&g, NULL);
}

/* Every linear type with its corners moved about; wedges and prisms among them, some of them upside down. */
static void a_type_of_cells_uses_other_points(void **state)
{
    (void)state;
    static const struct {
        int type, n;
        double x[12][3];
    } shape[] = {
        {10, 4, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
        {11, 8, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}},
        {12, 8, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}},
        {13, 6, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}}},
        {14, 5, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}}},
        {15,
         10,
         {{1, 0, 0},
          {0.3, 0.9, 0},
          {-0.8, 0.6, 0},
          {-0.8, -0.6, 0},
          {0.3, -0.9, 0},
          {1, 0, 1},
          {0.3, 0.9, 1},
          {-0.8, 0.6, 1},
          {-0.8, -0.6, 1},
          {0.3, -0.9, 1}}},
        {16,
         12,
         {{1, 0, 0},
          {0.5, 0.9, 0},
          {-0.5, 0.9, 0},
          {-1, 0, 0},
          {-0.5, -0.9, 0},
          {0.5, -0.9, 0},
          {1, 0, 1},
          {0.5, 0.9, 1},
          {-0.5, 0.9, 1},
          {-1, 0, 1},
          {-0.5, -0.9, 1},
          {0.5, -0.9, 1}}},
    };
    unsigned seed = 1;
    for (double noise = 0; noise < 3; noise = noise == 0 ? 0.1 : 3 * noise)
        for (int up = -1; up <= 1; up += 2) {
            static grid g;
            memset(&g, 0, sizeof g);
            for (size_t s = 0; s < sizeof shape / sizeof *shape; s++)
                for (int copy = 0; copy < 3; copy++) {
                    int id[12];
                    for (int i = 0; i < shape[s].n; i++) {
                        double x[3];
                        for (int k = 0; k < 3; k++) {
                            seed = seed * 1664525u + 1013904223u;
                            x[k] = shape[s].x[i][k] + noise * ((seed >> 8) / 16777216.0 - 0.5);
                        }
                        id[i] = add_point(&g, 4.0 * copy + x[0], 4.0 * (double)s + x[1], up * x[2]);
                    }
                    add_cell(&g, shape[s].type, shape[s].n, id);
                }
            survey_grid(&g, NULL);
        }
}

static void curved_cells_that_are_refined_are_surveyed_unrefined(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    static const double x[10][3] = {{0, 0, 0},     {1, 0, 0},      {0, 1, 0},      {0, 0, 1},     {0.5, -0.2, 0},
                                    {0.6, 0.6, 0}, {0, 0.5, -0.1}, {0, -0.1, 0.5}, {0.6, 0, 0.6}, {0, 0.6, 0.6}};
    int id[10];
    for (int i = 0; i < 10; i++)
        id[i] = add_point(&g, x[i][0], x[i][1], x[i][2]);
    add_cell(&g, 24, 10, id);
    char path[512];
    snprintf(path, sizeof path, "%s", scratch("curved.vtu"));
    write_valued(path, &g, NULL);
    for (int refine = 0; refine < 3; refine++) {
        const tc_read_options options = {.field = "P", .refine = refine};
        tc_survey out;
        assert_int_equal(tc_mesh_survey(&out, NULL, 1, path, &options, NULL, NULL), TC_OK);
        must_be_that_mesh(&out, path, &options);
        assert_true(refine == 0 ? out.bounds[2] == 0 : out.bounds[2] < 0); /* the curve goes beyond the corners */
    }
    unlink(path);
}

static void a_bad_step_ends_a_survey(void **state)
{
    (void)state;
    static grid g;
    char name[4][512], list[512];
    snprintf(list, sizeof list, "%s", scratch("survey.pvd"));
    FILE *file = fopen(list, "wb");
    assert_non_null(file);
    fprintf(file, "<VTKFile type=\"Collection\"><Collection>\n");
    for (int i = 0; i < 4; i++) {
        char text[32];
        snprintf(text, sizeof text, "survey%d.vtu", i);
        snprintf(name[i], sizeof name[i], "%s", scratch(text));
        memset(&g, 0, sizeof g);
        add_cube(&g, 0, 0, i);
        write_valued(name[i], &g, NULL);
        fprintf(file, "<DataSet timestep=\"%g\" file=\"%s\"/>\n", 0.5 * i, name[i]);
    }
    fprintf(file, "</Collection></VTKFile>\n");
    assert_int_equal(fclose(file), 0);
    unlink(name[1]);
    assert_int_equal(truncate(name[2], 600), 0);
    const int step[] = {0, 1, 2, 3, 9, -1};
    tc_survey out[6];
    tc_error err = {0};
    tc_read_options options = {.field = "P"};
    assert_int_equal(tc_mesh_survey(out, step, 6, list, &options, NULL, &err), TC_OK);
    for (int i = 0; i < 6; i++) {
        const bool good = i == 0 || i == 3 || i == 5;
        if (good) {
            options.has_step = true;
            options.step = step[i];
            must_be_that_mesh(&out[i], list, &options);
            continue;
        }
        assert_int_equal(out[i].status, TC_E_FILE);
        assert_non_null(strstr(out[i].why, i == 4 ? "no step 9" : ".pvd lists a file that is not read"));
        assert_true(out[i].source_cells == 0 && out[i].bounds[1] == 0);
    }
    assert_true(out[5].time == 1.5 && out[5].bounds[5] == 4);
    /* nothing can be read */
    const int none[] = {1, 2};
    assert_int_equal(tc_mesh_survey(out, none, 2, list, &options, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, name[1]));
    assert_int_equal(out[0].status, TC_E_FILE);
    for (int i = 0; i < 4; i++)
        unlink(name[i]);
    unlink(list);
    assert_int_equal(tc_mesh_survey(out, step, 6, list, &options, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, list));
}

static void what_is_not_finite_has_a_range(void **state)
{
    (void)state;
    static grid g;
    memset(&g, 0, sizeof g);
    add_cube(&g, 0, 0, 0);
    const char *path = scratch("nothing.vtk");
    FILE *file = fopen(path, "wb"); /* binary: VTK reads no "nan" as text */
    assert_non_null(file);
    fprintf(file, "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n");
    static const unsigned char nan[8] = {0x7f, 0xf8}, one[8] = {0x3f, 0xf0}, zero[8] = {0}, minus[8] = {0x80};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++)
            fwrite(i == k ? one : i == 3 ? minus : zero, 8, 1, file);
    fprintf(file, "\nCELLS 1 5\n");
    static const unsigned char cell[20] = {0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3};
    fwrite(cell, sizeof cell, 1, file);
    fprintf(file, "\nCELL_TYPES 1\n");
    static const unsigned char type[4] = {0, 0, 0, 10};
    fwrite(type, sizeof type, 1, file);
    fprintf(file, "\nPOINT_DATA 4\nSCALARS none double 1\nLOOKUP_TABLE default\n");
    for (int i = 0; i < 4; i++)
        fwrite(nan, 8, 1, file);
    fprintf(file, "\nSCALARS some double 1\nLOOKUP_TABLE default\n");
    for (int i = 0; i < 4; i++)
        fwrite(i == 1 ? nan : i == 2 ? minus : one, 8, 1, file);
    fprintf(file, "\n");
    assert_int_equal(fclose(file), 0);
    static const char *const field[] = {"none", "some"};
    for (int i = 0; i < 2; i++) {
        const tc_read_options options = {.field = field[i]};
        tc_survey out;
        tc_error err = {0};
        if (tc_mesh_survey(&out, NULL, 1, path, &options, NULL, &err) != TC_OK)
            fail_msg("%s", err.text);
        must_be_that_mesh(&out, path, &options);
        assert_true(i == 0 ? out.range[0] > out.range[1] : out.range[0] == 0 && out.range[1] == 1);
        assert_true(isnan(out.time));
    }
    unlink(path);
}

static void a_survey_of_nothing_is_made(void **state)
{
    (void)state;
    tc_survey out;
    assert_int_equal(tc_mesh_survey(NULL, NULL, 1, "x", NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_survey(&out, NULL, 1, NULL, NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_survey(&out, NULL, 2, "x", NULL, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_survey(&out, NULL, 1, "x", &(tc_read_options){.refine = -1}, NULL, NULL), TC_E_ARG);
    assert_int_equal(tc_mesh_survey(&out, (const int[]){0}, 0, "x", NULL, NULL, NULL), TC_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_survey_of_a_real_file_is_not_its_mesh),
        cmocka_unit_test(a_later_step_is_surveyed_as_the_first),
        cmocka_unit_test(points_that_no_solid_cell_uses_count),
        cmocka_unit_test(cells_that_change_their_points_are_taken_by_their_corners),
        cmocka_unit_test(a_type_of_cells_uses_other_points),
        cmocka_unit_test(curved_cells_that_are_refined_are_surveyed_unrefined),
        cmocka_unit_test(a_bad_step_ends_a_survey),
        cmocka_unit_test(what_is_not_finite_has_a_range),
        cmocka_unit_test(a_survey_of_nothing_is_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
