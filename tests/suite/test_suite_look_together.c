/* test_suite_look_together.c: effects that are right by themselves and wrong together: with missing values, with light
 * on a second field's colours, with more layers than are sorted. */
#include "look.h"

#include <stdlib.h>
#include <string.h>

enum {
    WIDTH = 72,
    HEIGHT = 64,
    SIDE = 5,
    POINTS = (SIDE + 1) * (SIDE + 1) * (SIDE + 1),
    TETS = 6 * SIDE * SIDE * SIDE
};

static double hole(const double *x) /* no value at the point in the middle of a side */
{
    return fabs(x[0] - 0.6) + fabs(x[1] - 0.4) + fabs(x[2] - 0.6) < 0.1 ? NAN : x[0] + 0.4 * x[1];
}

static double slope(const double *x)
{
    return x[0] + 0.4 * x[1] * x[1];
}

static const tc_knot knots[3] = {{0, 0, 0.2, 1, 0.1}, {0.5, 0.9, 1, 0, 0.4}, {1.4, 1, 0.1, 0.3, 1}};
static const double directions[2][3] = {{0.4, 0.3, 1}, {-1, 0.2, -0.3}};

static void check(const char *what, const tc_mesh *mesh, const tc_transfer *tf, const tc_look *look, bool nan_color)
{
    for (int v = 0; v < 2; v++) {
        tc_camera camera = suite_camera(mesh, directions[v][0], directions[v][1], directions[v][2], v == 1);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.2;
        options.look = look;
        options.has_nan_color = nan_color;
        memcpy(options.nan_color, (const double[4]){1, 0, 1, 0.7}, sizeof options.nan_color);
        options.steps_per_pass = v == 1 ? 3 : 0;
        suite_check(what, mesh, tf, &camera, &options);
    }
}

static void geometry_lies_behind_cells_without_a_value(void **state)
{
    (void)state;
    static const double corner[12] = {0, 0, 0.58, 1, 0, 0.62, 0, 1, 0.6, 1, 1, 0.59};
    static const int32_t triangle[6] = {0, 1, 2, 1, 2, 3};
    const tc_geometry sheet = {
        .n_vertex = 4, .n_triangle = 2, .vertex = corner, .triangle = triangle, .opacity = 0.8, .color = {0, 1, 0}};
    const tc_look look = {.n_geometry = 1, .geometry = &sheet};
    tc_mesh *mesh = look_box(SIDE, hole, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, 3);
    check("a sheet through a cell without a value", mesh, tf, &look, true);
    check("… that is not shown", mesh, tf, &look, false);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void surfaces_alone_show_cells_without_a_value(void **state)
{
    (void)state;
    const tc_iso iso = {.value = 0.7, .opacity = 0.6};
    const tc_look look = {.model = TC_MODEL_SURFACES, .n_iso = 1, .iso = &iso};
    tc_mesh *mesh = look_box(SIDE, hole, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, 3);
    check("surfaces alone, and missing values", mesh, tf, &look, true);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void light_falls_on_the_colour_of_missing_values(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(SIDE, hole, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, 3);
    for (int gradient = TC_GRADIENT_CELL; gradient <= TC_GRADIENT_VERTEX; gradient++) {
        tc_look look = {0};
        tc_shade_defaults(&look.shade);
        look.shade.gradient = (tc_gradient)gradient;
        look.shade.specular = 1;
        check("light, and missing values", mesh, tf, &look, true);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void light_on_a_second_field_is_cut_off(void **state)
{
    (void)state;
    static const tc_knot white[1] = {{0, 1, 1, 1, 0}}, black[2] = {{0, 0, 0, 0, 2}, {2, 0, 0, 0, 3}};
    tc_mesh *mesh = look_box(SIDE, slope, TC_POINT_DATA);
    tc_transfer *tf = suite_function(black, 2), *colors = suite_function(white, 1);
    double value[POINTS];
    for (int i = 0; i < POINTS; i++)
        value[i] = i % 3;
    tc_field *field = NULL;
    tc_error err = {0};
    assert_int_equal(tc_field_create(&field, mesh, value, TC_POINT_DATA, NULL, &err), TC_OK);
    tc_look look = {.color_field = field, .color_function = colors};
    tc_shade_defaults(&look.shade);
    look.shade.gradient = TC_GRADIENT_VERTEX;
    look.shade.ambient = 1;
    look.shade.specular = 2;
    check("light on a second field", mesh, tf, &look, false);
    tc_field_destroy(&field);
    tc_transfer_destroy(&colors);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void a_cell_without_a_colour_has_one(void **state)
{
    (void)state;
    static const tc_plane plane = {{1, 0.2, 0.4}, 0.55};
    tc_transfer *tf = suite_function(knots, 3);
    double value[TETS > POINTS ? TETS : POINTS];
    for (int kind = 0; kind < 4; kind++) { /* the second field, and the mesh's own, are of points or of cells */
        const bool cells = kind & 1;
        const int n = cells ? TETS : POINTS;
        tc_mesh *mesh = look_box(SIDE, kind & 2 ? slope : hole, kind & 2 ? TC_CELL_DATA : TC_POINT_DATA);
        for (int i = 0; i < n; i++)
            value[i] = i % 40 == 17 ? NAN : i % 40 == 29 ? INFINITY : i % 5 * 0.3;
        tc_field *field = NULL;
        tc_error err = {0};
        assert_int_equal(tc_field_create(&field, mesh, value, cells ? TC_CELL_DATA : TC_POINT_DATA, NULL, &err), TC_OK);
        const tc_look look = {.color_field = field, .color_function = tf},
                      cut = {.color_field = field, .color_function = tf, .n_plane = 1, .plane = &plane};
        check("a second field with missing values, shown", mesh, tf, &look, true);
        check("… and cut", mesh, tf, &cut, true);
        check("… and not shown", mesh, tf, &look, false);
        tc_field_destroy(&field);
        tc_mesh_destroy(&mesh);
    }
    tc_transfer_destroy(&tf);
}

/* Sheets one behind the other: as many as are said to be sorted are; of more the picture is refused. */
static void more_layers_than_are_sorted_are_shown(void **state)
{
    (void)state;
    enum { MOST = 4000 };
    if (!suite_is_gpu() || getenv("TETCAST_GL_HARDWARE")) /* GPUs make as many rounds as it takes */
        return;
    double(*corner)[3] = malloc(3 * MOST * sizeof *corner);
    int32_t *id = malloc(3 * MOST * sizeof *id);
    assert_true(corner && id);
    for (int i = 0; i < 3 * MOST; i++) {
        int sheet = i / 3, k = i % 3;
        double z = (double)((uint32_t)sheet * 2654435761u >> 8) / (1 << 24);
        memcpy(corner[i], (const double[3]){k == 1 ? 30 : -10, k == 2 ? 30 : -10, z}, sizeof corner[i]);
        id[i] = i;
    }
    tc_mesh *mesh = look_box(2, slope, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, 3);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, true);
    tc_render_options options = suite_options(3, 3);
    for (int n = 2400; n <= MOST; n += MOST - 2400) {
        tc_geometry sheets = {.n_vertex = 3 * (size_t)n,
                              .n_triangle = (size_t)n,
                              .vertex = corner[0],
                              .triangle = id,
                              .opacity = 0.002,
                              .color = {1, 1, 0}};
        const tc_look look = {.n_geometry = 1, .geometry = &sheets};
        tc_error err = {0};
        options.look = &look;
        tc_status status = suite_try_render(mesh, tf, &camera, &options, &err);
        if (status == TC_OK)
            suite_check("many sheets", mesh, tf, &camera, &options);
        else
            assert_non_null(strstr(err.text, "4000"));
        assert_true(n > 2400 || status == TC_OK);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    free(corner);
    free(id);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(geometry_lies_behind_cells_without_a_value),
        cmocka_unit_test(surfaces_alone_show_cells_without_a_value),
        cmocka_unit_test(light_falls_on_the_colour_of_missing_values),
        cmocka_unit_test(light_on_a_second_field_is_cut_off),
        cmocka_unit_test(a_cell_without_a_colour_has_one),
        cmocka_unit_test(more_layers_than_are_sorted_are_shown),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
