/* test_suite_eye.c: eyes on vertices, edges and faces, in cells and gaps, clipping planes and parallel projection from
 * within the mesh: against closed forms, then the reference. */
#include "suite.h"

#include "core/vec.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 72, N = 4 };

/* A cube of N^3 unit cubes, each of six tets (Kuhn 1960), scalar 1 + 2x + 3y + 5z; as cell data that of the cube's
 * number. With a slot, the cubes 1 <= x < 2, y >= 2 are missing. */
static tc_mesh *grid(tc_association association, tc_reentry reentry, bool slot)
{
    enum { S = N + 1 };
    static const int path[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    static double vertex[S * S * S][3], points[S * S * S], cells[6 * N * N * N];
    static int32_t tet[6 * N * N * N][4];
    const int step[3] = {1, S, S * S};
    int t = 0;
    for (int i = 0; i < S * S * S; i++) {
        double *p = vertex[i];
        p[0] = i % S, p[1] = i / S % S, p[2] = i / (S * S);
        points[i] = 1 + 2 * p[0] + 3 * p[1] + 5 * p[2];
        if (p[0] == N || p[1] == N || p[2] == N || (slot && p[0] == 1 && p[1] >= 2))
            continue;
        for (int q = 0; q < 6; q++, t++) {
            cells[t] = (t / 6 * 7) % 41;
            tet[t][0] = i;
            for (int a = 0; a < 3; a++)
                tet[t][a + 1] = tet[t][a] + step[path[q][a]];
        }
    }
    const tc_mesh_arrays arrays = {.n_vertex = S * S * S,
                                   .vertex = vertex[0],
                                   .n_tet = (size_t)t,
                                   .tet = tet[0],
                                   .scalar = association == TC_CELL_DATA ? cells : points,
                                   .association = association,
                                   .field_name = "field"};
    return suite_mesh(&arrays, reentry);
}

static tc_mesh *cube(tc_association association, tc_reentry reentry)
{
    return grid(association, reentry, false);
}

static tc_camera look(const double *from, const double *to, double angle)
{
    return (tc_camera){.position = {from[0], from[1], from[2]},
                       .focal_point = {to[0], to[1], to[2]},
                       .view_up = {0, 1, 0},
                       .view_angle = angle,
                       .parallel_scale = 3};
}

static void check(const char *what, const tc_mesh *mesh, const tc_camera *camera, bool table)
{
    tc_transfer *tf = suite_benchmark(mesh);
    tc_render_options options = suite_options(SIZE, SIZE);
    if (table)
        options.integrator = TC_INTEGRATOR_TABLE, options.table_format = TC_TABLE_32F;
    suite_check(what, mesh, tf, camera, &options);
    tc_transfer_destroy(&tf);
}

/* ---------------------------------------------------------------------------------------------------------- eyes */

static void eye_on_a_vertex_edge_or_face_sees_something_else(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double at[3];
    } eyes[] = {
        {"a vertex", {2, 2, 2}},
        {"an edge", {2.5, 2, 2}},
        {"a diagonal edge", {2.5, 2.5, 2}},
        {"a long diagonal", {2.5, 2.5, 2.5}},
        {"a face", {2.6, 2.3, 2}},
        {"an oblique face", {2.3, 2.3, 2.7}},
        {"a cell", {2.6, 2.3, 2.1}},
        {"a corner", {0, 0, 0}},
        {"the hull's edge", {1.5, 0, 0}},
        {"the hull's vertex", {2, 0, 3}},
        {"the hull's face", {1.4, 0, 2.7}},
        {"the slot's corner", {2, 4, 4}},
        {"the slot's wall", {1, 3, 2}},
        {"the slot's floor", {1.3, 2, 2.6}},
        {"the slot's middle", {1.5, 3.1, 1.9}},
    };
    static const double ways[][3] = {{1, 0, 0}, {0, 0, -1}, {1, 1, 0}, {1, 1, 1}, {0.3, -0.7, 0.2}};
    static const char *const meshes[] = {"cube", "slot, convexified", "slot, peeled"};
    for (int m = 0; m < 3; m++) {
        tc_mesh *mesh = grid(TC_POINT_DATA, m == 2 ? TC_REENTRY_PEEL : m ? TC_REENTRY_CONVEXIFY : TC_REENTRY_AUTO, m);
        for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++)
            for (size_t w = (e + (size_t)m) % 2; w < sizeof ways / sizeof *ways; w += 2) {
                double to[3];
                tc_vec_add(to, eyes[e].at, ways[w]);
                char what[80];
                snprintf(what, sizeof what, "%s, eye on %s, way %zu", meshes[m], eyes[e].name, w);
                /* An even number of pixels: no ray along the axis itself, of which nobody can tell in what cell it is.
                 */
                tc_camera camera = look(eyes[e].at, to, w % 2 ? 70 : 125);
                check(what, mesh, &camera, false);
            }
        tc_mesh_destroy(&mesh);
    }
}

static void eye_in_a_gap_or_a_cavity_sees_something_else(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        double at[3], to[3];
    } eyes[] = {
        {"comb", {0.13, 0.8, 0.4}, {1, 0.7, 0.5}}, /* between or in teeth */
        {"comb", {0.5, 0.9, 0.5}, {0.2, 0, 0.4}},    {"comb", {0.3, 0.6, 0.5}, {0.3, 0.6, 2}},
        {"shells", {0.01, 0.02, 0}, {1, 0.4, 0.2}}, /* the inmost cavity */
        {"shells", {0.4, 0.1, 0}, {-1, 0, 0.1}},     {"spiral", {0, 0, 0.02}, {1, 0.2, 0.1}},
        {"spiral", {0.5, 0.2, 0.1}, {-1, 0.3, 0.1}}, {"torusknot", {0, 0, 0}, {1, 0.3, 0}},
    };
    for (int way = 0; way < 2; way++)
        for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++) {
            tc_mesh *mesh = suite_synth(eyes[e].name, 4000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
            char what[64];
            snprintf(what, sizeof what, "%s, eye %zu%s", eyes[e].name, e, way ? ", peeled" : "");
            tc_camera camera = look(eyes[e].at, eyes[e].to, 80);
            check(what, mesh, &camera, false);
            camera.clip_near = 0.21, camera.clip_far = 0.9;
            check("… clipped", mesh, &camera, false);
            tc_mesh_destroy(&mesh);
        }
}

/* ------------------------------------------------------------------------------------------------------ clipping */

/* Attenuation 0.3 everywhere: what a pixel must show is a length alone. */
static tc_transfer *flat(void)
{
    static const tc_knot knot[] = {{0, 0.8, 0.6, 0.2, 0.3}, {100, 0.8, 0.6, 0.2, 0.3}};
    return suite_function(knot, 2);
}

/* Part of the ray in the cube and between two depths along the view. */
static double chord(const tc_camera *camera, int x, int y, double near, double far)
{
    double o[3], d[3], forward[3], from[3], t0, t1;
    suite_ray(o, d, camera, SIZE, SIZE, x, y);
    tc_vec_sub(forward, camera->focal_point, camera->position);
    tc_vec_normalize(forward);
    tc_vec_sub(from, o, camera->position);
    t0 = (near - tc_vec_dot(from, forward)) / tc_vec_dot(d, forward);
    t1 = (far - tc_vec_dot(from, forward)) / tc_vec_dot(d, forward);
    for (int k = 0; k < 3; k++) {
        if (d[k] == 0 && (o[k] < 0 || o[k] > N))
            return 0;
        if (d[k] == 0)
            continue;
        double a = -o[k] / d[k], b = (N - o[k]) / d[k];
        t0 = fmax(t0, fmin(a, b));
        t1 = fmin(t1, fmax(a, b));
    }
    return fmax(t1 - t0, 0);
}

static void expect_chords(const char *what, const tc_mesh *mesh, const tc_camera *camera, bool table)
{
    tc_transfer *tf = flat();
    tc_render_options options = suite_options(SIZE, SIZE);
    options.unit_distance = 1;
    options.opacity_stop = 1;
    if (table)
        options.integrator = TC_INTEGRATOR_TABLE, options.table_format = TC_TABLE_32F;
    tc_image *image = suite_render(NULL, mesh, tf, camera, &options);
    double worst = 0, far = camera->clip_far > 0 ? camera->clip_far : 1e9;
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            double alpha = -expm1(-0.3 * chord(camera, x, y, camera->clip_near, far));
            worst = fmax(worst, fabs((double)image->rgba[4 * (y * SIZE + x) + 3] - alpha));
        }
    suite_say("%s: %s to %g: error of alpha %.1e", what, camera->parallel ? "parallel" : "perspective",
              camera->clip_far, worst);
    assert_true(worst <= (table ? 5e-4 : 1e-5));
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
}

static void clipped_chords_are_not_between_the_planes(void **state)
{
    (void)state;
    static const double ranges[][2] = {{0, 0}, {0, 5.7}, {4.3, 30}, {4.1, 5.3}, {5, 5.0001}, {0, 1000}, {1e-6, 1e3}};
    static const double from[][3] = {{-2.2, 3.1, 7.3}, {2.2, 1.9, 1.7}, {6, 5.5, -3.2}, {2, 2, 7}};
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = cube(TC_POINT_DATA, way ? TC_REENTRY_PEEL : TC_REENTRY_AUTO);
        for (int e = 0; e < 4; e++)
            for (size_t r = (size_t)way; r < sizeof ranges / sizeof *ranges; r += 1 + (size_t)way) {
                const double to[3] = {e == 1 ? 4 : 2.05, 1.9, 2.1};
                tc_camera camera = look(from[e], to, 40);
                camera.parallel = (r + (size_t)e) % 2;
                camera.clip_near = ranges[r][0];
                camera.clip_far = ranges[r][1];
                expect_chords(way ? "peeled" : "cube", mesh, &camera, r % 3 == 2);
            }
        tc_mesh_destroy(&mesh);
    }
}

/* Also where the camera's plane cuts the mesh, or leaves it behind: VTK shows what is before the camera. */
static void parallel_projection_shows_what_is_behind_the_camera(void **state)
{
    (void)state;
    static const double at[] = {-3, 0, 0.01, 1, 1.5, 2, 3.999, 4, 9};
    tc_mesh *mesh = cube(TC_POINT_DATA, TC_REENTRY_AUTO);
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        const double from[3] = {2.1, 1.8, at[i]}, to[3] = {2.1, 1.8, at[i] + 1};
        tc_camera camera = look(from, to, 30);
        camera.parallel = true;
        expect_chords("from z", mesh, &camera, false);
        tc_transfer *tf = flat();
        tc_render_options options = suite_options(SIZE, SIZE);
        options.unit_distance = 1;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        double seen = fmin(N, fmax(0, N - at[i]));
        assert_true(fabs((double)image->rgba[4 * (SIZE / 2 * SIZE + SIZE / 2) + 3] + expm1(-0.3 * seen)) < 1e-5);
        tc_image_destroy(&image);
        tc_transfer_destroy(&tf);
    }
    tc_mesh_destroy(&mesh);
}

static void clipped_fields_are_cut_elsewhere(void **state)
{
    (void)state;
    static const double from[][3] = {{-2.2, 3.1, 7.3}, {2.2, 1.9, 1.7}, {2, 2, 4}};
    const double to[3] = {2.4, 1.7, -1};
    for (int data = 0; data < 2; data++) {
        tc_mesh *mesh = cube(data ? TC_CELL_DATA : TC_POINT_DATA, TC_REENTRY_AUTO);
        for (int e = 0; e < 3; e++)
            for (int k = 0; k < 4; k++) {
                char what[64];
                snprintf(what, sizeof what, "clipped %s, eye %d.%d", data ? "cells" : "points", e, k);
                tc_camera camera = look(from[e], to, 60);
                camera.parallel = k % 2;
                camera.clip_near = k < 2 ? 0.37 : 0;
                camera.clip_far = 4.31 + k;
                check(what, mesh, &camera, k == 3);
            }
        tc_mesh_destroy(&mesh);
    }
}

static void a_range_that_holds_all_changes_the_picture(void **state)
{
    (void)state;
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 5000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        tc_transfer *tf = suite_benchmark(mesh);
        const tc_render_options options = suite_options(SIZE, SIZE);
        tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, way);
        tc_image *whole = suite_render(NULL, mesh, tf, &camera, &options), *empty;
        camera.clip_near = 1e-3, camera.clip_far = 1e3;
        tc_image *same = suite_render(NULL, mesh, tf, &camera, &options);
        assert_memory_equal(whole->rgba, same->rgba, sizeof(float) * 4 * SIZE * SIZE);
        for (int k = 0; k < 2; k++) { /* before the mesh, and beyond it */
            camera.clip_near = k ? 100 : 1e-3, camera.clip_far = k ? 200 : 2e-3;
            empty = suite_render(NULL, mesh, tf, &camera, &options);
            for (int i = 0; i < 4 * SIZE * SIZE; i++)
                assert_true(empty->rgba[i] == 0);
            tc_image_destroy(&empty);
        }
        tc_image_destroy(&whole);
        tc_image_destroy(&same);
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

static void walks_go_on_behind_the_far_plane(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        skip(); /* the reference does not walk */
    tc_mesh *mesh = cube(TC_POINT_DATA, TC_REENTRY_AUTO);
    tc_transfer *tf = flat();
    tc_render_options options = suite_options(SIZE, SIZE);
    options.opacity_stop = 1;
    options.count = true;
    const double from[3] = {2.1, 1.8, 12}, to[3] = {2.1, 1.8, 0};
    tc_camera camera = look(from, to, 20);
    tc_render_stats whole, half, none;
    tc_image *image = suite_render(&whole, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    camera.clip_near = 1, camera.clip_far = 10; /* the cube lies 8 to 12 before the eye */
    image = suite_render(&half, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    camera.clip_far = 7;
    image = suite_render(&none, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    suite_say("steps %lld, to the middle %lld, before the mesh %lld", (long long)whole.steps, (long long)half.steps,
              (long long)none.steps);
    assert_true(half.steps > whole.steps * 4 / 10 && half.steps < whole.steps * 6 / 10);
    assert_true(none.steps == 0 && none.rays == 0);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* --------------------------------------------------------------------------------------------------- odd cameras */

static void up_along_the_view_makes_another_picture_than_stated(void **state)
{
    (void)state;
    /* A view-up along the view is replaced by (-z, x, y); where that is along it, too, by the axis farthest from it. */
    static const double view[][3] = {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}, {1, -1, 1}, {0.3, 0.5, -0.8}};
    tc_mesh *mesh = cube(TC_POINT_DATA, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    const tc_render_options options = suite_options(SIZE, SIZE);
    for (size_t i = 0; i < sizeof view / sizeof *view; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double *v = view[i], middle[3] = {2, 2, 2};
            double from[3];
            tc_vec_mul_add(from, middle, -9, v);
            tc_camera camera = look(from, middle, 40);
            for (int k = 0; k < 3; k++)
                camera.view_up[k] = sign * v[k];
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
            suite_verify("up along the view", SUITE_HALF_STEP, SIZE_MAX, image, mesh, tf, &camera, &options);
            const double turned[3] = {-sign * v[2], sign * v[0], sign * v[1]}, x_axis[3] = {1, 0, 0};
            tc_vec_copy(camera.view_up, i == 3 ? x_axis : turned);
            tc_image *stated = suite_render(NULL, mesh, tf, &camera, &options);
            assert_true(suite_difference(image, stated) < 1e-5);
            tc_image_destroy(&image);
            tc_image_destroy(&stated);
        }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void extreme_angles_distances_or_sizes_are_wrong(void **state)
{
    (void)state;
    tc_mesh *mesh = cube(TC_POINT_DATA, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    static const double from[][3] = {{2.1, 1.9, 2.2}, {-7, 8, 9}, {2e6, 3e6, 6e6}};
    static const double angle[] = {0.01, 170, 4e-5};
    static const int size[][2] = {{SIZE, SIZE}, {1, 1}, {16384, 1}, {1, 4096}};
    const double middle[3] = {2, 2, 1.8};
    for (int e = 0; e < 3; e++)
        for (int a = 0; a < 3; a++)
            for (int s = 0; s < (a == e ? 4 : 2); s++) { /* the long ones once an eye */
                char what[80];
                tc_camera camera = look(from[e], middle, angle[a] / (s == 2 ? (angle[a] > 1 ? 40 : 4096) : 1));
                const tc_render_options options = suite_options(size[s][0], size[s][1]);
                snprintf(what, sizeof what, "eye %d, %g degrees, %d x %d", e, camera.view_angle, size[s][0],
                         size[s][1]);
                suite_check(what, mesh, tf, &camera, &options);
            }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void wrong_clipping_ranges_are_taken(void **state)
{
    (void)state;
    static const double wrong[][2] = {{-1, 2}, {2, 2}, {3, 1}, {2, 0}, {0, INFINITY}, {NAN, 2}, {1, NAN}};
    tc_mesh *mesh = cube(TC_POINT_DATA, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    const tc_render_options options = suite_options(SIZE, SIZE);
    tc_renderer *renderer;
    const tc_renderer_options make = {.driver = "reference"}; /* the checks come before any driver */
    assert_int_equal(tc_renderer_create(&renderer, &make, NULL, NULL), TC_OK);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        tc_camera camera = suite_camera(mesh, 0, 0, 1, i % 2);
        camera.clip_near = wrong[i][0], camera.clip_far = wrong[i][1];
        tc_image *image;
        tc_error err = {0};
        assert_int_equal(tc_render(&image, NULL, renderer, mesh, tf, &camera, &options, NULL, &err), TC_E_ARG);
        assert_null(image);
        assert_non_null(strstr(err.text, "clipping distance"));
    }
    tc_renderer_destroy(&renderer);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eye_on_a_vertex_edge_or_face_sees_something_else),
        cmocka_unit_test(eye_in_a_gap_or_a_cavity_sees_something_else),
        cmocka_unit_test(clipped_chords_are_not_between_the_planes),
        cmocka_unit_test(parallel_projection_shows_what_is_behind_the_camera),
        cmocka_unit_test(clipped_fields_are_cut_elsewhere),
        cmocka_unit_test(a_range_that_holds_all_changes_the_picture),
        cmocka_unit_test(walks_go_on_behind_the_far_plane),
        cmocka_unit_test(up_along_the_view_makes_another_picture_than_stated),
        cmocka_unit_test(extreme_angles_distances_or_sizes_are_wrong),
        cmocka_unit_test(wrong_clipping_ranges_are_taken),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
