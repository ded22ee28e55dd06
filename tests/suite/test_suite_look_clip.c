/* test_suite_look_clip.c: planes and a box cut cells and rays where they are, and no others. */
#include "look.h"

enum { WIDTH = 72, HEIGHT = 64 };

static double ramp(const double *x)
{
    return x[0] + 0.3 * x[1] - 0.2 * x[2];
}

static const double KAPPA = 3; /* per unit length */
static const tc_knot fog[1] = {{0, 0.8, 0.6, 0.4, 1}};
static const struct view {
    double direction[3];
    bool parallel;
} views[] = {{{0.3, 0.5, 1}, false}, {{1, 0.2, 0.1}, true}, {{0, 0, 1}, true}, {{-0.7, 0.3, -0.4}, false}};
enum { N_VIEW = sizeof views / sizeof *views };

/* Alpha of constant matter in what planes keep of the box, pixel by pixel, but for rays that a shift of the planes by a
 * float's rounding would change. */
static void check_constant(const char *what, const tc_look *look, const tc_plane *plane, int n)
{
    tc_mesh *mesh = look_box(5, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 1);
    double worst = 0;
    size_t seen = 0;
    for (int v = 0; v < N_VIEW; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 1 / KAPPA;
        options.opacity_stop = 1;
        options.look = look;
        for (int steps = 0; steps <= 3; steps += 3) {
            options.steps_per_pass = steps;
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                double origin[3], direction[3], t[2];
                suite_ray(origin, direction, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
                seen += look_chord(t, origin, direction, plane, n);
                double error = fabs(image->rgba[4 * i + 3] - (1 - exp(-KAPPA * (t[1] - t[0]))));
                worst = fmax(worst, error);
            }
            tc_image_destroy(&image);
        }
    }
    suite_say("%s: alpha of what is kept is off by %.2g at most", what, worst);
    assert_true(seen > 100);
    assert_true(worst < 2e-5);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void a_plane_cuts_elsewhere(void **state)
{
    (void)state;
    const tc_plane plane[3] = {{{1, 0, 0}, 0.37}, {{-0.3, 0.5, -0.8}, -0.4}, {{0, -2, 0}, -1.2}};
    const tc_look look = {.n_plane = 1, .plane = plane};
    check_constant("one plane", &look, plane, 1);
    const tc_look more = {.n_plane = 3, .plane = plane};
    check_constant("three planes", &more, plane, 3);
}

static void a_box_cuts_elsewhere(void **state)
{
    (void)state;
    const tc_plane plane[7] = {{{1, 0, 0}, 0.1},   {{-1, 0, 0}, -0.55}, {{0, 1, 0}, 0.3}, {{0, -1, 0}, -2},
                               {{0, 0, 1}, -1e20}, {{0, 0, -1}, -0.9},  {{1, 1, 1}, 1.05}};
    const tc_look look = {.has_box = true, .box = {0.1, 0.55, 0.3, 2, -1e20, 0.9}};
    check_constant("a box", &look, plane, 6);
    const tc_look both = {.has_box = true, .box = {0.1, 0.55, 0.3, 2, -1e20, 0.9}, .n_plane = 1, .plane = plane + 6};
    check_constant("a box and a plane", &both, plane, 7);
}

static void nothing_that_is_kept_is_shown(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(3, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 1);
    tc_camera camera = suite_camera(mesh, 0.2, 0.3, 1, false);
    const tc_plane plane = {{0, 1, 0}, 1.5};
    const tc_look look = {.n_plane = 1, .plane = &plane};
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.look = &look;
    tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
    for (int i = 0; i < 4 * WIDTH * HEIGHT; i++)
        assert_true(image->rgba[i] == 0);
    tc_image_destroy(&image);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* The scalar where a cell is cut is that of the cut. */
static void a_cut_face_has_another_scalar(void **state)
{
    (void)state;
    static const tc_knot steep[3] = {{-0.2, 0, 0, 1, 0}, {0.5, 0, 1, 0, 0.6}, {1.3, 1, 0, 0, 2}};
    tc_mesh *mesh = look_box(4, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(steep, 3);
    const tc_plane plane[2] = {{{1, 0.2, 0.4}, 0.45}, {{-1, 0.3, 0}, -0.8}};
    const tc_look look = {.n_plane = 2, .plane = plane};
    for (int v = 0; v < N_VIEW; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.2;
        options.look = &look;
        suite_check("two planes in a ramp", mesh, tf, &camera, &options);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void a_plain_scene_knows_of_planes(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(3, ramp, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 1);
    tc_camera camera = suite_camera(mesh, 0.2, 0.3, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    const tc_look nothing = {.model = TC_MODEL_DENSITY_EMITTER};
    tc_render_stats plain, asked;
    tc_image *a = suite_render(&plain, mesh, tf, &camera, &options);
    options.look = &nothing;
    tc_image *b = suite_render(&asked, mesh, tf, &camera, &options);
    assert_true(suite_difference(a, b) == 0);
    if (suite_is_gpu()) {
        assert_string_equal(plain.effects, "density-emitter");
        assert_string_equal(asked.effects, "density-emitter");
        assert_true(asked.gpu_bytes_other == plain.gpu_bytes_other && asked.passes == plain.passes);
    }
    tc_image_destroy(&a);
    tc_image_destroy(&b);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_cuts_elsewhere),        cmocka_unit_test(a_box_cuts_elsewhere),
        cmocka_unit_test(nothing_that_is_kept_is_shown), cmocka_unit_test(a_cut_face_has_another_scalar),
        cmocka_unit_test(a_plain_scene_knows_of_planes),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
