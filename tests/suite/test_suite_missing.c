/* test_suite_missing.c: values and coordinates that are not finite: transparent, or of one colour and attenuation;
 * against closed forms, then the reference. */
#include "suite.h"

#include "core/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48, N = 8, S = N + 1, N_VERTEX = S * S * S, N_TET = 6 * N * N * N };

/* A cube of N^3 unit cubes, each of six tets (Kuhn 1960), scalar 1 + x + y / 2 + z / 4 with both associations. With a
 * notch, the cubes 3 <= x < 5, y >= 4 are missing: rays cross a gap. */
typedef struct grid {
    double vertex[N_VERTEX][3], point[N_VERTEX], cell[N_TET];
    int32_t tet[N_TET][4];
    size_t n_tet;
} grid;

static double field(const double *p)
{
    return 1 + p[0] + p[1] / 2 + p[2] / 4;
}

static grid *make_grid(bool notch)
{
    static const int path[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    const int step[3] = {1, S, S * S};
    grid *g = calloc(1, sizeof *g);
    assert_non_null(g);
    for (int i = 0; i < N_VERTEX; i++) {
        double *p = g->vertex[i];
        p[0] = i % S, p[1] = i / S % S, p[2] = i / (S * S);
        g->point[i] = field(p);
        if (p[0] == N || p[1] == N || p[2] == N || (notch && p[0] >= 3 && p[0] < 5 && p[1] >= 4))
            continue;
        for (int q = 0; q < 6; q++, g->n_tet++) {
            int32_t *t = g->tet[g->n_tet];
            t[0] = i;
            for (int a = 0; a < 3; a++)
                t[a + 1] = t[a] + step[path[q][a]];
            g->cell[g->n_tet] = field(p);
        }
    }
    return g;
}

/* Values within 2.3 of the middle become unknown; of a cell, where its first corner is. */
static void hollow(grid *g)
{
    static const double unknown[3] = {NAN, INFINITY, -INFINITY}, middle[3] = {3.7, 4.2, 4.4};
    for (int i = 0; i < N_VERTEX; i++) {
        double to[3];
        tc_vec_sub(to, g->vertex[i], middle);
        if (tc_vec_length(to) < 2.3)
            g->point[i] = unknown[i % 3];
    }
    for (size_t t = 0; t < g->n_tet; t++)
        if (!isfinite(g->point[g->tet[t][0]]))
            g->cell[t] = unknown[t % 3];
}

static tc_mesh *mesh_of(const grid *g, tc_association association, tc_reentry reentry)
{
    const tc_mesh_arrays arrays = {.n_vertex = N_VERTEX,
                                   .vertex = g->vertex[0],
                                   .n_tet = g->n_tet,
                                   .tet = g->tet[0],
                                   .scalar = association == TC_CELL_DATA ? g->cell : g->point,
                                   .association = association,
                                   .field_name = "field"};
    return suite_mesh(&arrays, reentry);
}

static tc_transfer *colors(double attenuation)
{
    const tc_knot knot[] = {
        {0, 1, 0.2, 0.1, attenuation}, {8, 0.3, 1, 0.2, attenuation}, {15, 0.2, 0.1, 1, attenuation}};
    return suite_function(knot, 3);
}

static tc_render_options options_of(bool table, const double *nan_color)
{
    tc_render_options options = suite_options(SIZE, SIZE);
    options.unit_distance = 1;
    options.opacity_stop = 1;
    if (table)
        options.integrator = TC_INTEGRATOR_TABLE, options.table_format = TC_TABLE_32F;
    options.has_nan_color = nan_color != NULL;
    if (nan_color)
        memcpy(options.nan_color, nan_color, sizeof options.nan_color);
    return options;
}

/* ---------------------------------------------------------------------------------------------------- closed form */

static void a_layer_of_missing_values_is_not_what_its_length_says(void **state)
{
    (void)state;
    static const double violet[4] = {0.6, 0.1, 0.9, 0.7}, wall[4] = {0.5, 0.5, 0.25, 1e300}, clear[4] = {1, 1, 1, 0};
    grid *g = make_grid(false);
    for (size_t t = 0; t < g->n_tet; t++) {
        double z = g->vertex[g->tet[t][0]][2];
        g->cell[t] = z >= 3 && z < 5 ? NAN : 1;
    }
    tc_mesh *mesh = mesh_of(g, TC_CELL_DATA, TC_REENTRY_AUTO);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    assert_int_equal(report.nonfinite_cells, N_TET / 4);
    assert_int_equal(report.nonfinite_scalars, N_TET / 4);
    tc_transfer *tf = colors(0.2);
    /* Along z: 3 units, 2 units unknown, 3 units. */
    const tc_camera camera = {.position = {4, 4, 20},
                              .focal_point = {4, 4, 4},
                              .view_up = {0, 1, 0},
                              .parallel = true,
                              .parallel_scale = 3.7};
    const double known = exp(-0.2 * 3);
    for (int way = 0; way < 8; way++) {
        const double *color = way < 2 ? NULL : way < 4 ? violet : way < 6 ? wall : clear;
        const tc_render_options options = options_of(way % 2, color);
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        double hidden = color ? exp(-2 * fmin(color[3], 1e30)) : 1, worst = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            worst = fmax(worst, fabs((double)image->rgba[4 * i + 3] - (1 - known * known * hidden)));
            for (int c = 0; c < 3; c++) {
                double own = (c == 0 ? 1 - 0.7 / 8 : c == 1 ? 0.3 : 0.1125) * (1 - known); /* the function at 1 */
                double value = own + known * (1 - hidden) * (color ? color[c] : 0) + known * hidden * own;
                worst = fmax(worst, fabs((double)image->rgba[4 * i + c] - value));
            }
        }
        suite_say("layer, way %d: error %.1e", way, worst);
        assert_true(worst < (way % 2 ? 5e-4 : 1e-5));
        tc_image_destroy(&image);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    free(g);
}

/* ------------------------------------------------------------------------------------------------------ reference */

static void a_region_of_missing_values_looks_different(void **state)
{
    (void)state;
    static const double violet[4] = {0.6, 0.1, 0.9, 0.7};
    static const double from[][3] = {{-9, 13, 17}, {3.9, 4.1, 4.3}, {4, 6.5, 4.2}}; /* outside, within, in the notch */
    grid *g = make_grid(true);
    hollow(g);
    tc_transfer *tf = colors(0.15);
    for (int way = 0; way < 4; way++) {
        tc_association association = way & 1 ? TC_CELL_DATA : TC_POINT_DATA;
        tc_mesh *mesh = mesh_of(g, association, way & 2 ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        size_t cells = 0;
        for (size_t t = 0; t < g->n_tet; t++) {
            bool known = isfinite(g->cell[t]);
            if (association == TC_POINT_DATA) {
                const int32_t *v = g->tet[t];
                known = isfinite(g->point[v[0]] + g->point[v[1]]) && isfinite(g->point[v[2]] + g->point[v[3]]);
            }
            cells += !known;
        }
        tc_mesh_report report;
        tc_mesh_get_report(&report, mesh);
        assert_int_equal(report.nonfinite_cells, cells);
        assert_true(cells > 100 && cells < g->n_tet / 2);
        for (int e = 0; e < 3; e++)
            for (int k = 0; k < 4; k += way & 2 ? 3 : 1) {
                char what[80];
                snprintf(what, sizeof what, "missing %s%s, eye %d, %s, %s", way & 1 ? "cells" : "points",
                         way & 2 ? ", peeled" : "", e, k & 1 ? "violet" : "transparent", k & 2 ? "table" : "integral");
                tc_camera camera = {.position = {from[e][0], from[e][1], from[e][2]},
                                    .focal_point = {4.2, 4.1, 3.8},
                                    .view_up = {0, 1, 0},
                                    .view_angle = e ? 90 : 30};
                if (k == 3)
                    camera.clip_near = e ? 0.7 : 17.3, camera.clip_far = e ? 2.9 : 21.9;
                const tc_render_options options = options_of(k & 2, k & 1 ? violet : NULL);
                tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
                suite_verify(what, (k & 2 ? 2 : 1) * SUITE_HALF_STEP, SIZE_MAX, image, mesh, tf, &camera, &options);
                tc_image_destroy(&image);
            }
        tc_mesh_destroy(&mesh);
    }
    tc_transfer_destroy(&tf);
    free(g);
}

static void nothing_known_is_not_empty_or_not_of_one_colour(void **state)
{
    (void)state;
    static const double violet[4] = {0.6, 0.1, 0.9, 0.3};
    grid *g = make_grid(false);
    for (int i = 0; i < N_VERTEX; i++)
        g->point[i] = i % 2 ? NAN : INFINITY;
    tc_mesh *mesh = mesh_of(g, TC_POINT_DATA, TC_REENTRY_AUTO);
    tc_transfer *tf = colors(0.5);
    tc_camera camera = suite_camera(mesh, 0.3, 0.4, 1, false);
    for (int way = 0; way < 4; way++) {
        const tc_render_options options = options_of(way % 2, way < 2 ? NULL : violet);
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        double most = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            const float *p = image->rgba + 4 * i;
            most = fmax(most, (double)p[3]);
            for (int c = 0; c < 3; c++)
                assert_true(fabs((double)p[c] - (double)p[3] * violet[c]) < 1e-5);
        }
        assert_true(way < 2 ? most == 0 : most > 0.8);
        tc_image_destroy(&image);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    free(g);
}

static void a_colour_for_missing_values_changes_whole_data(void **state)
{
    (void)state;
    static const double violet[4] = {0.6, 0.1, 0.9, 0.7};
    grid *g = make_grid(true);
    tc_mesh *mesh = mesh_of(g, TC_POINT_DATA, TC_REENTRY_AUTO);
    tc_transfer *tf = colors(0.15);
    tc_camera camera = suite_camera(mesh, 0.3, 0.4, 1, false);
    const tc_render_options plain = options_of(false, NULL), with = options_of(false, violet);
    tc_image *a = suite_render(NULL, mesh, tf, &camera, &plain), *b = suite_render(NULL, mesh, tf, &camera, &with);
    assert_memory_equal(a->rgba, b->rgba, sizeof(float) * 4 * SIZE * SIZE);
    tc_image_destroy(&a);
    tc_image_destroy(&b);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    free(g);
}

static void a_point_nowhere_takes_more_than_its_cells_along(void **state)
{
    (void)state;
    /* Three inner vertices, each of 24 cells, lose a coordinate: what is left is a mesh with cavities. */
    static const double lost[3] = {NAN, INFINITY, -INFINITY};
    static const int at[3][3] = {{2, 3, 4}, {3, 3, 4}, {6, 2, 5}};
    grid *whole = make_grid(false), *g = make_grid(false), *left = make_grid(false);
    bool gone[N_VERTEX] = {false};
    for (int i = 0; i < 3; i++) {
        int v = at[i][0] + S * at[i][1] + S * S * at[i][2];
        g->vertex[v][i] = lost[i];
        gone[v] = true;
    }
    left->n_tet = 0;
    for (size_t t = 0; t < whole->n_tet; t++) {
        const int32_t *v = whole->tet[t];
        if (!gone[v[0]] && !gone[v[1]] && !gone[v[2]] && !gone[v[3]])
            memcpy(left->tet[left->n_tet++], v, sizeof left->tet[0]);
    }
    tc_transfer *tf = colors(0.15);
    for (int way = 0; way < 2; way++) {
        tc_reentry reentry = way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY;
        tc_mesh *broken = mesh_of(g, TC_POINT_DATA, reentry), *good = mesh_of(left, TC_POINT_DATA, reentry);
        tc_mesh_report r;
        tc_mesh_get_report(&r, broken);
        assert_int_equal(r.dropped_nonfinite, whole->n_tet - left->n_tet);
        assert_int_equal(r.n_tet, left->n_tet);
        assert_int_equal(r.unused_vertices, 3);
        assert_int_equal(r.nonfinite_cells, 0);
        tc_camera camera = suite_camera(good, 0.3, 0.4, 1, false);
        const tc_render_options options = options_of(false, NULL);
        tc_image *a = suite_render(NULL, broken, tf, &camera, &options);
        suite_verify("without points that are nowhere", SUITE_HALF_STEP, SIZE_MAX, a, good, tf, &camera, &options);
        tc_image_destroy(&a);
        tc_mesh_destroy(&broken);
        tc_mesh_destroy(&good);
    }
    tc_transfer_destroy(&tf);
    free(whole);
    free(g);
    free(left);
}

static void wrong_colours_for_missing_values_are_taken(void **state)
{
    (void)state;
    static const double wrong[][4] = {{-0.1, 0, 0, 1}, {0, 1.1, 0, 1},      {0, 0, NAN, 1},
                                      {0, 0, 0, -1},   {0, 0, 0, INFINITY}, {0, 0, 0, NAN}};
    grid *g = make_grid(false);
    tc_mesh *mesh = mesh_of(g, TC_POINT_DATA, TC_REENTRY_AUTO);
    tc_transfer *tf = colors(0.15);
    tc_camera camera = suite_camera(mesh, 0, 0, 1, false);
    tc_renderer *renderer;
    const tc_renderer_options make = {.driver = "reference"}; /* the checks come before any driver */
    assert_int_equal(tc_renderer_create(&renderer, &make, NULL, NULL), TC_OK);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        const tc_render_options options = options_of(false, wrong[i]);
        tc_image *image;
        tc_error err = {0};
        assert_int_equal(tc_render(&image, NULL, renderer, mesh, tf, &camera, &options, NULL, &err), TC_E_ARG);
        assert_null(image);
        assert_non_null(strstr(err.text, "missing values"));
    }
    tc_renderer_destroy(&renderer);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    free(g);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_layer_of_missing_values_is_not_what_its_length_says),
        cmocka_unit_test(a_region_of_missing_values_looks_different),
        cmocka_unit_test(nothing_known_is_not_empty_or_not_of_one_colour),
        cmocka_unit_test(a_colour_for_missing_values_changes_whole_data),
        cmocka_unit_test(a_point_nowhere_takes_more_than_its_cells_along),
        cmocka_unit_test(wrong_colours_for_missing_values_are_taken),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
