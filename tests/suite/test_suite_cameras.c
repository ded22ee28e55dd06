/* test_suite_cameras.c: eyes and images out of the ordinary, against the reference. */
#include "suite.h"

#include "core/vec.h"

#include <stdio.h>
#include <stdlib.h>

enum { SIZE = 88 };

static tc_camera look(double px, double py, double pz, double fx, double fy, double fz, double angle)
{
    return (tc_camera){
        .position = {px, py, pz}, .focal_point = {fx, fy, fz}, .view_up = {0, 1, 0}, .view_angle = angle};
}

static void check_eyes(const tc_mesh *mesh, const char *name, const tc_camera *camera, size_t n)
{
    tc_transfer *tf = suite_benchmark(mesh);
    const tc_render_options options = suite_options(SIZE, SIZE);
    for (size_t i = 0; i < n; i++) {
        char what[64];
        snprintf(what, sizeof what, "%s, eye %zu", name, i);
        suite_check(what, mesh, tf, &camera[i], &options);
    }
    tc_transfer_destroy(&tf);
}

static void eye_inside_the_mesh_sees_something_else(void **state)
{
    (void)state;
    const tc_camera in_cube[] = {
        look(0.5, 0.5, 0.5, 1, 0.7, 0.2, 60),       look(0.31, 0.62, 0.47, 0.3, 0.6, 3, 100),
        look(0.01, 0.02, 0.99, 0.5, 0.5, 0.5, 170), look(0, 0, 0, 1, 1, 1, 60), /* in a vertex */
        look(0.5, 0.5, 1, 0.5, 0.5, 0, 90),                                     /* in a boundary face */
        look(0.5, 0.5, 1, 0.5, 0.5, 2, 90),                                     /* … looking out: nothing */
    };
    tc_mesh *mesh = suite_synth("kuhn", 6000, TC_REENTRY_AUTO);
    check_eyes(mesh, "in the cube", in_cube, sizeof in_cube / sizeof *in_cube);
    tc_mesh_destroy(&mesh);
}

/* A bar 6 long and 0.2 wide, along x from -3 to 3, six tets a cube: an eye past its end is outside its sphere, but the
 * eye's plane may cut it, and the lines of its rays meet it behind the eye. */
static tc_mesh *bar(void)
{
    enum { N = 30 };
    static double vertex[(N + 1) * 4][3], scalar[(N + 1) * 4];
    static int32_t tet[N * 6][4];
    for (int i = 0; i <= N; i++)
        for (int c = 0; c < 4; c++) {
            double *x = vertex[4 * i + c];
            x[0] = -3 + 6.0 * i / N;
            x[1] = c & 1 ? 0.1 : -0.1;
            x[2] = c & 2 ? 0.1 : -0.1;
            scalar[4 * i + c] = x[0] + x[1];
        }
    static const int path[6][2] = {{1, 2}, {1, 4}, {2, 1}, {2, 4}, {4, 1}, {4, 2}}; /* bits: 1 y, 2 z, 4 x */
    for (int i = 0; i < N; i++)
        for (int k = 0; k < 6; k++) {
            const int corner[4] = {0, path[k][0], path[k][0] | path[k][1], 7};
            for (int v = 0; v < 4; v++)
                tet[6 * i + k][v] = 4 * (i + (corner[v] >> 2)) + (corner[v] & 3);
        }
    const tc_mesh_arrays arrays = {.n_vertex = (N + 1) * 4,
                                   .vertex = vertex[0],
                                   .n_tet = N * 6,
                                   .tet = tet[0],
                                   .scalar = scalar,
                                   .association = TC_POINT_DATA};
    return suite_mesh(&arrays, TC_REENTRY_AUTO);
}

static void what_lies_behind_the_eye_is_seen(void **state)
{
    (void)state;
    const tc_camera past_the_end[] = {
        look(3.1, 0.02, 0.03, 3.1, 1, 0.3, 40),  look(3.1, 0.02, 0.03, 3.2, -1, 0.2, 120),
        look(3.1, 0.02, 0.03, 4, 1, 0.3, 150),   look(3.3, 0.3, 0.1, 3.2, 0.1, 1, 100),
        look(3.1, 0.02, 0.03, 2, 0.3, 0.1, 160), look(7, 0.1, 0.2, 6.5, 3, 0.3, 140),
        look(0.1, 0.3, 9, 0.1, 20, -60, 178.5),
    };
    tc_mesh *mesh = bar();
    check_eyes(mesh, "past the end of a bar", past_the_end, sizeof past_the_end / sizeof *past_the_end);
    tc_mesh_destroy(&mesh);
}

static void eye_in_a_gap_or_fin_of_the_heat_sink_sees_something_else(void **state)
{
    (void)state;
    /* Fins of width 0.05, gaps of 0.06 along x; the base is 0.12 high. */
    const tc_camera in_sink[] = {
        look(0.08, 0.5, 0.5, 1, 0.6, 0.4, 70),    /* in a gap, across the fins */
        look(0.635, 0.65, 0.7, 0.64, 0.6, 0, 90), /* between two fins, down on the base */
        look(0.025, 0.1, 0.5, 1, 0.4, 0.3, 70),   /* in a fin */
        look(0.6, 0.6, 0.05, 0.6, 0.7, 1, 120),   /* in the base, up through the fins */
        look(0.08, 0.31, 0.4, 0.08, 2, 0.4, 60),  /* along a gap */
        look(0.6, 0.6, 1.2, 0.6, 0.61, 0, 100),   /* outside, near */
    };
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 10000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        check_eyes(mesh, way ? "peeled heat sink" : "convexified heat sink", in_sink, sizeof in_sink / sizeof *in_sink);
        tc_mesh_destroy(&mesh);
    }
}

static void eye_in_the_cavity_of_the_shells_sees_something_else(void **state)
{
    (void)state;
    const tc_camera in_shells[] = {
        look(0, 0, 0, 1, 0.3, 0.2, 90),      /* in the cavity */
        look(0.45, 0, 0.02, -1, 0, 0.1, 80), /* between two shells */
        look(0.6, 0.01, 0, -1, 0.2, 0, 80),  /* in a shell */
    };
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("shells", 6000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        check_eyes(mesh, way ? "peeled shells" : "convexified shells", in_shells, sizeof in_shells / sizeof *in_shells);
        tc_mesh_destroy(&mesh);
    }
}

static void eye_near_far_or_behind_sees_something_else(void **state)
{
    (void)state;
    static const char *const names[] = {"kuhn", "heatsink"};
    for (int i = 0; i < 2; i++) {
        tc_mesh *mesh = suite_synth(names[i], 8000, TC_REENTRY_AUTO);
        double diagonal = suite_diagonal(mesh);
        tc_camera camera[8];
        static const double distance[8] = {0.51, 0.7, 0.999, 1.001, 30, 1e3, 1e6, 1e6}; /* diagonals */
        for (int k = 0; k < 8; k++) {
            camera[k] = suite_camera(mesh, 0.4, 0.3 + 0.1 * k, 1, false);
            double to[3];
            tc_vec_sub(to, camera[k].position, camera[k].focal_point);
            tc_vec_normalize(to);
            if (k == 7) /* along an axis: rays within faces, or nearly */
                to[0] = to[1] = 0, to[2] = 1;
            tc_vec_mul_add(camera[k].position, camera[k].focal_point, distance[k] * diagonal, to);
            camera[k].view_angle = distance[k] < 1 ? 90 : 2 * atan(0.5 / distance[k]) * 180 / 3.14159265358979323846;
        }
        check_eyes(mesh, names[i], camera, 8);
        /* The whole mesh behind the eye. */
        tc_camera away = camera[3];
        for (int a = 0; a < 3; a++)
            away.focal_point[a] = 2 * away.position[a] - away.focal_point[a];
        tc_transfer *tf = suite_benchmark(mesh);
        const tc_render_options options = suite_options(64, 64);
        tc_image *image = suite_render(NULL, mesh, tf, &away, &options);
        for (int p = 0; p < 64 * 64 * 4; p++)
            assert_true(image->rgba[p] == 0);
        tc_image_destroy(&image);
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

static void wide_narrow_parallel_or_upright_views_are_wrong(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("comb", 5000, TC_REENTRY_AUTO);
    tc_camera camera[6];
    camera[0] = suite_camera(mesh, 0.3, 0.4, 1, false);
    tc_vec_sub(camera[0].view_up, camera[0].focal_point, camera[0].position); /* parallel to the view */
    camera[1] = suite_camera(mesh, 0.3, 0.4, 1, false);
    camera[1].view_angle = 0.01;
    camera[2] = suite_camera(mesh, 0.3, 0.4, 1, false);
    camera[2].view_angle = 170;
    camera[3] = suite_camera(mesh, 0, 0, 1, true);
    camera[4] = suite_camera(mesh, 1, 0, 0, true);
    camera[5] = suite_camera(mesh, 0, 1, 0, true);
    check_eyes(mesh, "comb", camera, 6);
    tc_mesh_destroy(&mesh);
}

/* A cube of n^3 unit cubes, each of six tets (Kuhn 1960); the field is linear. */
static tc_mesh *grid_cube(int n)
{
    static const int path[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    int s = n + 1;
    const int step[3] = {1, s, s * s};
    size_t n_vertex = (size_t)(s * s * s), n_tet = (size_t)(6 * n * n * n), t = 0;
    double *vertex = malloc(n_vertex * 3 * sizeof *vertex), *scalar = malloc(n_vertex * sizeof *scalar);
    int32_t *tet = malloc(n_tet * 4 * sizeof *tet);
    assert_true(vertex && scalar && tet);
    for (int i = 0; i < s * s * s; i++) {
        double *p = vertex + 3 * i;
        p[0] = i % s, p[1] = i / s % s, p[2] = i / (s * s);
        scalar[i] = p[0] + 2 * p[1] + 3 * p[2];
        if (p[0] == n || p[1] == n || p[2] == n)
            continue;
        for (int q = 0; q < 6; q++, t++) {
            tet[4 * t] = i;
            for (int a = 0; a < 3; a++)
                tet[4 * t + (size_t)a + 1] = tet[4 * t + (size_t)a] + step[path[q][a]];
        }
    }
    assert_int_equal(t, n_tet);
    const tc_mesh_arrays arrays = {n_vertex, vertex, n_tet, tet, scalar, TC_POINT_DATA, "linear"};
    tc_mesh *mesh = suite_mesh(&arrays, TC_REENTRY_AUTO);
    free(vertex);
    free(scalar);
    free(tet);
    return mesh;
}

/* The largest difference to the reference, apart from pixels whose ray runs within the cube's own sides: such a ray is
 * on no particular side. pitch: pixels are that far apart, and the middle one looks at the cube's centre. */
static double compare_grid(const tc_image *image, const tc_image *reference, double pitch, double half)
{
    double worst = 0;
    int width = image->width, middle = width / 2;
    for (int i = 0; i < width * image->height; i++) {
        double x = (i % width - middle) * pitch, y = (i / width - middle) * pitch;
        if (fabs(x) == half || fabs(y) == half)
            continue;
        for (int c = 0; c < 4; c++)
            worst = fmax(worst, fabs((double)image->rgba[4 * i + c] - (double)reference->rgba[4 * i + c]));
    }
    return worst;
}

static void rays_through_vertices_and_along_edges_are_lost(void **state)
{
    (void)state;
    enum { N = 8 };
    tc_mesh *mesh = grid_cube(N);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_renderer *truth;
    const tc_renderer_options by_cpu = {.driver = "reference"};
    assert_int_equal(tc_renderer_create(&truth, &by_cpu, NULL, NULL), TC_OK);
    /* Pixel centres at multiples of a half, a quarter: on every vertex, edge and face plane of the grid. */
    static const int sizes[2] = {33, 65};
    static const double pitch[2] = {0.5, 0.25};
    static const double from[5][3] = {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 1}, {0, -1, 0}};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 5; k++) {
            tc_camera camera = suite_camera(mesh, from[k][0], from[k][1], from[k][2], true);
            camera.parallel_scale = 0.5 * sizes[i] * pitch[i];
            const tc_render_options options = suite_options(sizes[i], sizes[i]);
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options), *expected;
            assert_int_equal(tc_render(&expected, NULL, truth, mesh, tf, &camera, &options, NULL, NULL), TC_OK);
            double error = compare_grid(image, expected, pitch[i], 0.5 * N);
            suite_say("grid from %g %g %g, %d pixels a side: max error %.2e", from[k][0], from[k][1], from[k][2],
                      sizes[i], error);
            assert_true(error <= SUITE_HALF_STEP);
            tc_image_destroy(&image);
            tc_image_destroy(&expected);
        }
    /* Perspective along a vertex's own axis: the middle ray runs along edges. */
    tc_camera camera = look(4, 4, 40, 4, 4, 4, 20);
    const tc_render_options options = suite_options(65, 65);
    suite_check("grid, middle ray along edges", mesh, tf, &camera, &options);
    tc_renderer_destroy(&truth);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void odd_image_sizes_are_wrong(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {333, 17}, {1024, 1}, {1, 200}, {3, 2}};
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 8000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        tc_transfer *tf = suite_benchmark(mesh);
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
            char what[64];
            snprintf(what, sizeof what, "%d x %d", sizes[i][0], sizes[i][1]);
            tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, i % 2);
            double wide = fmax(1, (double)sizes[i][0] / sizes[i][1]); /* the mesh fills the width */
            camera.view_angle /= wide;
            camera.parallel_scale /= wide;
            const tc_render_options options = suite_options(sizes[i][0], sizes[i][1]);
            suite_check(what, mesh, tf, &camera, &options);
        }
        tc_transfer_destroy(&tf);
        tc_mesh_destroy(&mesh);
    }
}

static void moved_and_scaled_scenes_look_different(void **state)
{
    (void)state;
    /* Invariant 5: offset 1e7, scales of 1e-30 and 1e30; the camera moves along. Scaling by powers of two is exact. */
    static const double vertex[8][3] = {{0, 0, 0}, {1, 0, 0},   {0, 1, 0}, {0, 0, 1},
                                        {1, 1, 1}, {1.5, 0, 1}, {2, 1, 0}, {1, 2, 0}};
    static const int32_t tet[3][4] = {{0, 1, 2, 3}, {1, 2, 3, 4}, {1, 4, 5, 6}};
    static const double scalar[8] = {0, 1, 2, 3, 0.5, 2, 1, 3};
    static const struct {
        double scale, offset;
    } moves[] = {{1, 0}, {1, 1e7}, {0x1p-100, 0}, {0x1p100, 0}};
    static const tc_knot knot[] = {{0, 1, 0, 0, 1}, {1.5, 0, 1, 0, 4}, {3, 0, 0, 1, 1}};
    tc_transfer *tf = suite_function(knot, 3);
    tc_image *first = NULL;
    for (int i = 0; i < 4; i++) {
        double moved[8][3];
        for (int k = 0; k < 24; k++)
            moved[k / 3][k % 3] = vertex[k / 3][k % 3] * moves[i].scale + moves[i].offset;
        const tc_mesh_arrays arrays = {8, &moved[0][0], 3, &tet[0][0], scalar, TC_POINT_DATA, "field"};
        tc_mesh *mesh = suite_mesh(&arrays, TC_REENTRY_AUTO);
        tc_camera camera = suite_camera(mesh, 0.5, 0.6, 1, false);
        const tc_render_options options = suite_options(SIZE, SIZE);
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        suite_verify("moved", SUITE_HALF_STEP, SIZE_MAX, image, mesh, tf, &camera, &options);
        if (first) {
            double difference = suite_difference(first, image);
            suite_say("scale %g, offset %g: difference %.2e", moves[i].scale, moves[i].offset, difference);
            assert_true(difference <= SUITE_HALF_STEP);
            tc_image_destroy(&image);
        } else {
            first = image;
        }
        tc_mesh_destroy(&mesh);
    }
    tc_image_destroy(&first);
    tc_transfer_destroy(&tf);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eye_inside_the_mesh_sees_something_else),
        cmocka_unit_test(eye_in_a_gap_or_fin_of_the_heat_sink_sees_something_else),
        cmocka_unit_test(eye_in_the_cavity_of_the_shells_sees_something_else),
        cmocka_unit_test(what_lies_behind_the_eye_is_seen),
        cmocka_unit_test(eye_near_far_or_behind_sees_something_else),
        cmocka_unit_test(wide_narrow_parallel_or_upright_views_are_wrong),
        cmocka_unit_test(rays_through_vertices_and_along_edges_are_lost),
        cmocka_unit_test(odd_image_sizes_are_wrong),
        cmocka_unit_test(moved_and_scaled_scenes_look_different),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
