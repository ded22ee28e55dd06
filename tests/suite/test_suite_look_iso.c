/* test_suite_look_iso.c: isosurfaces lie elsewhere, are missed or met twice, or are not in order with the volume. */
#include "look.h"

#include <string.h>

enum { WIDTH = 72, HEIGHT = 64 };

static double along_x(const double *x)
{
    return 2 + 3 * x[0];
}

static double hill(const double *x)
{
    double r = 0;
    for (int k = 0; k < 3; k++)
        r += (x[k] - 0.5) * (x[k] - 0.5);
    return sqrt(r) + 0.05 * sin(9 * x[0]) * cos(7 * x[1]);
}

static const struct view {
    double direction[3];
    bool parallel;
} views[] = {{{1, 0.3, 0.2}, false}, {{-1, 0.1, -0.3}, true}, {{0.9, 0.8, 0.1}, true}, {{-0.7, 0.3, -0.4}, false}};
enum { N_VIEW = sizeof views / sizeof *views };

static const double KAPPA = 1.5; /* per unit length */

/* Of black matter with white surfaces in it: what each lets through tells how far before it the ray entered. */
static void a_surface_lies_elsewhere(void **state)
{
    (void)state;
    static const tc_knot black[1] = {{0, 0, 0, 0, 1}};
    const tc_iso iso = {.value = 2 + 3 * 0.43, .opacity = 1, .has_color = true, .color = {1, 1, 1}};
    const tc_look look = {.n_iso = 1, .iso = &iso};
    tc_mesh *mesh = look_box(5, along_x, TC_POINT_DATA);
    tc_transfer *tf = suite_function(black, 1);
    double worst = 0;
    size_t seen = 0;
    for (int v = 0; v < N_VIEW; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 1 / KAPPA;
        options.look = &look;
        for (int steps = 0; steps <= 2; steps++) {
            options.steps_per_pass = steps;
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                double origin[3], direction[3], t[2];
                suite_ray(origin, direction, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
                if (!look_chord(t, origin, direction, NULL, 0))
                    continue;
                double at = (0.43 - origin[0]) / direction[0], red = image->rgba[4 * i];
                if (fmin(fabs(at - t[0]), fabs(t[1] - at)) < 1e-4)
                    continue; /* along the box's edge */
                seen++;
                if (at < t[0] || at > t[1]) {
                    assert_true(red == 0);
                    continue;
                }
                assert_true(red > 0 && image->rgba[4 * i + 3] > 0.9999);
                worst = fmax(worst, fabs(-log(red) / KAPPA - (at - t[0])));
            }
            tc_image_destroy(&image);
        }
    }
    suite_say("an isosurface lies at most %.2g of the box's side from its place, %zu rays", worst, seen);
    assert_true(seen > 5000);
    assert_true(worst < 1e-5);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static const tc_iso three[3] = {
    {.value = 2 + 3 * 0.7, .opacity = 0.5, .has_color = true, .color = {0, 0.9, 0.1}},
    {.value = 2 + 3 * 0.2, .opacity = 0.3, .has_color = true, .color = {1, 0.2, 0}},
    {.value = 2 + 3 * 0.55, .opacity = 0.8, .has_color = true, .color = {0.1, 0, 1}},
};

/* Surfaces x = const in constant matter, composited in the order of the ray. */
static void composite(double rgba[4], const double *color, double kappa, const double t[2], const double *origin,
                      const double *direction)
{
    int order[3] = {1, 2, 0}; /* by ascending x */
    double from = t[0], clear = 1;
    memset(rgba, 0, 4 * sizeof *rgba);
    for (int i = 0; i < 4; i++) {
        const tc_iso *iso = i == 3 ? NULL : &three[order[direction[0] > 0 ? i : 2 - i]];
        double to = iso ? ((iso->value - 2) / 3 - origin[0]) / direction[0] : t[1];
        if (to < t[0] || to > t[1])
            continue;
        double through = exp(-kappa * (to - from));
        for (int k = 0; k < 3; k++)
            rgba[k] += clear * color[k] * (1 - through) + (iso ? clear * through * iso->opacity * iso->color[k] : 0);
        clear *= through * (iso ? 1 - iso->opacity : 1);
        from = to;
    }
    rgba[3] = 1 - clear;
}

static void check_three(const char *what, tc_model model, double kappa)
{
    static const tc_knot fog[1] = {{0, 0.7, 0.5, 0.9, 1}};
    const tc_look look = {.model = model, .n_iso = 3, .iso = three};
    tc_mesh *mesh = look_box(3, along_x, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 1);
    double worst = 0;
    for (int v = 0; v < N_VIEW; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 1 / KAPPA;
        options.opacity_stop = 1;
        options.look = &look;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            double origin[3], direction[3], t[2], rgba[4];
            suite_ray(origin, direction, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
            if (!look_chord(t, origin, direction, NULL, 0))
                continue;
            bool edge = false;
            for (int k = 0; k < 3; k++) {
                double at = ((three[k].value - 2) / 3 - origin[0]) / direction[0];
                edge = edge || fmin(fabs(at - t[0]), fabs(t[1] - at)) < 1e-4;
            }
            composite(rgba, tf ? (const double[3]){0.7, 0.5, 0.9} : NULL, kappa, t, origin, direction);
            for (int k = 0; k < 4 && !edge; k++)
                worst = fmax(worst, fabs(rgba[k] - image->rgba[4 * i + k]));
        }
        tc_image_destroy(&image);
    }
    suite_say("%s: off by %.2g at most", what, worst);
    assert_true(worst < 3e-5);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void three_surfaces_are_out_of_order(void **state)
{
    (void)state;
    check_three("three surfaces in fog", TC_MODEL_DENSITY_EMITTER, KAPPA);
    check_three("three surfaces alone", TC_MODEL_SURFACES, 0);
}

/* A curved one, against the reference, in a volume whose function has knots of its own. */
static void curved_surfaces_differ_from_the_reference(void **state)
{
    (void)state;
    static const tc_knot knots[4] = {{0.1, 0, 0, 1, 0.2}, {0.3, 0, 1, 0, 0}, {0.5, 1, 0.4, 0, 0.3}, {0.9, 1, 1, 1, 0}};
    const tc_iso iso[3] = {{.value = 0.35, .opacity = 0.5},
                           {.value = 0.5, .opacity = 0.4, .has_color = true, .color = {1, 0, 0}},
                           {.value = 0.2, .opacity = 1}};
    tc_look look = {.n_iso = 3, .iso = iso};
    tc_mesh *mesh = look_box(7, hill, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, 4);
    for (int v = 0; v < N_VIEW; v++) {
        const double *d = views[v].direction;
        tc_camera camera = suite_camera(mesh, d[0], d[1], d[2], views[v].parallel);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.15;
        options.look = &look;
        options.steps_per_pass = v == 1 ? 7 : 0;
        look.model = v == 2 ? TC_MODEL_SURFACES : TC_MODEL_DENSITY_EMITTER;
        suite_check("curved isosurfaces", mesh, tf, &camera, &options);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* Surfaces without a colour of their own have the function's, also where a model changes that for the volume. */
static void surfaces_in_black_or_white_matter_lose_their_colours(void **state)
{
    (void)state;
    static const tc_knot knots[3] = {{0.1, 0.2, 0.9, 1, 0.2}, {0.4, 0.3, 1, 0.2, 0.1}, {0.9, 1, 0.1, 0, 0.3}};
    const tc_iso iso[2] = {{.value = 0.35, .opacity = 0.5}, {.value = 0.2, .opacity = 0.7}};
    tc_look look = {.n_iso = 2, .iso = iso};
    tc_mesh *mesh = look_box(5, hill, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, 3);
    tc_camera camera = suite_camera(mesh, 1, 0.3, 0.2, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.unit_distance = 0.15;
    options.look = &look;
    look.model = TC_MODEL_ABSORPTION;
    suite_check("surfaces in black matter", mesh, tf, &camera, &options);
    look.model = TC_MODEL_XRAY;
    suite_check("surfaces in white matter", mesh, tf, &camera, &options);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void a_model_without_a_volume_uploads_a_function(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        return;
    static const tc_knot fog[1] = {{0, 0.7, 0.5, 0.9, 1}};
    const tc_look look = {.model = TC_MODEL_SURFACES, .n_iso = 3, .iso = three};
    tc_mesh *mesh = look_box(3, along_x, TC_POINT_DATA);
    tc_transfer *tf = suite_function(fog, 1);
    tc_camera camera = suite_camera(mesh, 1, 0.2, 0.3, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.look = &look;
    tc_renderer *renderer = suite_renderer(NULL);
    tc_render_stats stats;
    tc_image *image = suite_render_by(&stats, renderer, mesh, tf, &camera, &options);
    assert_string_equal(stats.effects, "surfaces, isosurfaces");
    assert_true(stats.gpu_bytes_table == 0);
    tc_image_destroy(&image);
    tc_renderer_destroy(&renderer);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void values_of_cells_are_given_surfaces(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        return;
    const tc_look look = {.n_iso = 3, .iso = three};
    tc_mesh *mesh = look_box(3, along_x, TC_CELL_DATA);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_camera camera = suite_camera(mesh, 1, 0.2, 0.3, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.look = &look;
    tc_error err = {0};
    assert_int_equal(suite_try_render(mesh, tf, &camera, &options, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "isosurfaces"));
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_surface_lies_elsewhere),
        cmocka_unit_test(three_surfaces_are_out_of_order),
        cmocka_unit_test(curved_surfaces_differ_from_the_reference),
        cmocka_unit_test(surfaces_in_black_or_white_matter_lose_their_colours),
        cmocka_unit_test(a_model_without_a_volume_uploads_a_function),
        cmocka_unit_test(values_of_cells_are_given_surfaces),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
