/* test_suite_look_models.c: optical models beside the density emitter, against closed forms along the chords of a box,
 * then against the reference. */
#include "look.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 48, HEIGHT = 40, PIXELS = WIDTH * HEIGHT };

/* Linear in the cells of a box with an even number of cubes along z; from 0.05 to 0.95. */
static double tent(const double *x)
{
    return 0.05 + 1.8 * fabs(x[2] - 0.5);
}

/* Up and down from cell to cell. */
static double wave(const double *x)
{
    return 0.5 + 0.3 * sin(9 * x[0] + 4 * x[1]) * cos(7 * x[2] - 3 * x[1]) + 0.2 * x[0];
}

/* Clear in part, dense in part; the colour goes on where it is clear. */
static const tc_knot knots[] = {{0, 0.1, 0.9, 0.2, 0}, {0.3, 0.9, 0.5, 0.1, 0},   {0.5, 0.2, 0.3, 1, 0.3},
                                {0.7, 1, 0.8, 0.3, 3}, {0.9, 0.1, 0.4, 0.6, 0.2}, {1, 0.6, 0.2, 0.9, 0}};
enum { N_KNOT = sizeof knots / sizeof *knots };

static void function_at(double rgba[4], double s)
{
    size_t i = 0;
    while (i + 2 < N_KNOT && knots[i + 1].s < s)
        i++;
    const tc_knot *p = &knots[i], *q = p + 1;
    double f = fmin(fmax((s - p->s) / (q->s - p->s), 0), 1);
    const double a[4] = {p->r, p->g, p->b, p->a}, b[4] = {q->r, q->g, q->b, q->a};
    for (int k = 0; k < 4; k++)
        rgba[k] = a[k] + f * (b[k] - a[k]);
}

static const struct view {
    double direction[3];
    bool parallel, inside;
} views[] = {{{0.3, 0.5, 1}, false, false},
             {{1, 0.2, 0.1}, true, false},
             {{-0.7, 0.3, -0.4}, false, false},
             {{0.4, 0.2, 0.9}, false, true}};
enum { N_VIEW = sizeof views / sizeof *views };

static tc_camera camera_of(const tc_mesh *mesh, const struct view *view)
{
    tc_camera camera = suite_camera(mesh, view->direction[0], view->direction[1], view->direction[2], view->parallel);
    const double eye[3] = {0.43, 0.52, 0.61};
    for (int k = 0; k < 3 && view->inside; k++) {
        camera.position[k] = eye[k];
        camera.focal_point[k] = eye[k] - view->direction[k];
    }
    return camera;
}

/* Adds a stretch of that length over which the scalar runs linearly from one value to another: exactly, knot by knot.
 */
static void add_stretch(double light[3], double *depth, double from, double to, double length)
{
    double lo = fmin(from, to), hi = fmax(from, to);
    for (int i = 0; i + 1 < N_KNOT; i++) {
        double a = fmax(knots[i].s, lo), b = fmin(knots[i + 1].s, hi), l = length * (b - a) / (hi - lo), end[2][4];
        if (!(b > a))
            continue;
        function_at(end[0], a);
        function_at(end[1], b);
        *depth += l * 0.5 * (end[0][3] + end[1][3]);
        for (int k = 0; k < 3; k++) /* Simpson */
            light[k] +=
                l / 6 *
                (end[0][k] * end[0][3] + end[1][k] * end[1][3] + (end[0][k] + end[1][k]) * (end[0][3] + end[1][3]));
    }
}

/* What a model shows, of what a ray gathered. */
static void show(double rgba[4], tc_model model, double least, double most, double mean, double depth,
                 const double light[3])
{
    const double alpha = 1 - exp(-depth);
    switch (model) {
    case TC_MODEL_EMISSION:
        memcpy(rgba, light, 3 * sizeof *light);
        rgba[3] = 0;
        break;
    case TC_MODEL_ABSORPTION:
    case TC_MODEL_XRAY:
        rgba[0] = rgba[1] = rgba[2] = model == TC_MODEL_XRAY ? alpha : 0;
        rgba[3] = alpha;
        break;
    default:
        function_at(rgba, model == TC_MODEL_MAXIMUM ? most : model == TC_MODEL_MINIMUM ? least : mean);
        rgba[3] = 1;
    }
}

/* What a model shows of the tent between t[0] and t[1]. */
static void show_tent(double rgba[4], tc_model model, const double *origin, const double *direction, const double t[2],
                      double unit)
{
    double least = INFINITY, most = -INFINITY, sum = 0, depth = 0, light[3] = {0, 0, 0}, length = t[1] - t[0];
    memset(rgba, 0, 4 * sizeof *rgba);
    if (!(length > 0))
        return;
    double flat = direction[2] != 0 ? (0.5 - origin[2]) / direction[2] : t[0]; /* where the tent is least */
    const double place[3] = {t[0], fmin(fmax(flat, t[0]), t[1]), t[1]};
    double value[3];
    for (int i = 0; i < 3; i++) {
        const double at[3] = {0, 0, origin[2] + place[i] * direction[2]};
        value[i] = tent(at);
        least = fmin(least, value[i]);
        most = fmax(most, value[i]);
    }
    for (int i = 0; i < 2; i++) {
        double part = place[i + 1] - place[i];
        sum += part * 0.5 * (value[i] + value[i + 1]);
        add_stretch(light, &depth, value[i], value[i + 1], part / unit);
    }
    show(rgba, model, least, most, sum / length, depth, light);
}

/* The largest difference of a pixel from what is expected, but for rays that graze what is seen. */
static double check_model(tc_model model, const tc_plane *plane, int n_plane)
{
    tc_mesh *mesh = look_box(6, tent, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, N_KNOT);
    const tc_look look = {.model = model, .n_plane = n_plane, .plane = plane};
    double worst = 0;
    int seen = 0;
    for (int v = 0; v < N_VIEW; v++) {
        const tc_camera camera = camera_of(mesh, &views[v]);
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.unit_distance = 0.4;
        options.opacity_stop = 1;
        options.look = &look;
        static const int steps[3] = {0, 1, 7};
        for (int i = 0; i < (v == 0 ? 3 : 1); i++) {
            options.steps_per_pass = steps[i];
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
            for (int p = 0; p < PIXELS; p++) {
                double origin[3], direction[3], t[2], rgba[4];
                suite_ray(origin, direction, &camera, WIDTH, HEIGHT, p % WIDTH, p / WIDTH);
                look_chord(t, origin, direction, plane, n_plane);
                t[0] = views[v].inside ? fmax(t[0], 0) : t[0];
                if (t[1] - t[0] != 0 && t[1] - t[0] < 1e-3)
                    continue;
                show_tent(rgba, model, origin, direction, t, options.unit_distance);
                seen += t[1] > t[0];
                for (int k = 0; k < 4; k++)
                    worst = fmax(worst, fabs((double)image->rgba[4 * p + k] - rgba[k]));
            }
            tc_image_destroy(&image);
        }
    }
    assert_true(seen > PIXELS);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    return worst;
}

static const struct model {
    tc_model model;
    const char *name;
    double bound; /* of the largest and the least, exact to float: colours rise by 4 over the scalar's range */
} models[] = {{TC_MODEL_EMISSION, "emission", 1e-4}, {TC_MODEL_ABSORPTION, "absorption", 1e-4},
              {TC_MODEL_XRAY, "xray", 1e-4},         {TC_MODEL_MAXIMUM, "maximum", 4e-6},
              {TC_MODEL_MINIMUM, "minimum", 4e-6},   {TC_MODEL_AVERAGE, "average", 2e-5}};
enum { N_MODEL = sizeof models / sizeof *models };

static void a_model_sums_up_something_else(void **state)
{
    (void)state;
    for (int m = 0; m < N_MODEL; m++) {
        double worst = check_model(models[m].model, NULL, 0);
        suite_say("%s: off by %.2g at most", models[m].name, worst);
        assert_true(worst < models[m].bound);
    }
}

static void a_model_sees_what_is_cut_away(void **state)
{
    (void)state;
    const tc_plane plane[2] = {{{0.3, -0.2, 1}, 0.23}, {{-1, -0.1, -0.2}, -0.86}};
    for (int m = 0; m < N_MODEL; m += m == 0 ? 3 : 1) {
        double worst = check_model(models[m].model, plane, 2);
        suite_say("%s, cut by two planes: off by %.2g at most", models[m].name, worst);
        assert_true(worst < models[m].bound);
    }
}

/* ------------------------------------------------------------------------------------------- cells, missing values */

/* A value for each of eight layers along z; two layers of cells have none. */
static double layers(const double *x)
{
    static const double value[8] = {0.35, 0.62, NAN, 0.2, 0.81, NAN, 0.55, 0.4};
    return value[(int)(x[2] * 8)];
}

static void missing_values_are_taken_for_values(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(8, layers, TC_CELL_DATA);
    tc_transfer *tf = suite_function(knots, N_KNOT);
    const tc_camera camera = {.position = {0.5, 0.5, 9},
                              .focal_point = {0.5, 0.5, 0.5},
                              .view_up = {0, 1, 0},
                              .parallel = true,
                              .parallel_scale = 0.4};
    for (int way = 0; way < 2; way++) /* missing values transparent; of a colour */
        for (int m = 0; m < N_MODEL; m++) {
            const tc_look look = {.model = models[m].model};
            tc_render_options options = suite_options(WIDTH, HEIGHT);
            const double nan_color[4] = {0.3, 0.7, 0.5, 0.9};
            options.unit_distance = 1;
            options.opacity_stop = 1;
            options.look = &look;
            options.has_nan_color = way == 1;
            memcpy(options.nan_color, nan_color, sizeof nan_color);
            double rgba[4], value[4], depth = 0, light[3] = {0, 0, 0}, most = 0, least = 1, sum = 0;
            for (int i = 0; i < 8; i++) {
                const double at[3] = {0, 0, (i + 0.5) / 8};
                double s = layers(at);
                if (isnan(s)) {
                    memcpy(value, nan_color, sizeof value);
                    value[3] *= way;
                } else {
                    function_at(value, s);
                    most = fmax(most, s);
                    least = fmin(least, s);
                    sum += s / 6;
                }
                depth += value[3] / 8;
                for (int k = 0; k < 3; k++)
                    light[k] += value[k] * value[3] / 8;
            }
            show(rgba, models[m].model, least, most, sum, depth, light);
            tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
            double worst = 0;
            for (int i = 0; i < 4 * PIXELS; i++)
                worst = fmax(worst, fabs((double)image->rgba[i] - rgba[i % 4]));
            suite_say("%s of cells, some without a value, way %d: off by %.2g at most", models[m].name, way, worst);
            assert_true(worst < models[m].bound);
            tc_image_destroy(&image);
        }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void cells_without_any_value_are_met(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(8, layers, TC_CELL_DATA);
    tc_transfer *tf = suite_function(knots, N_KNOT);
    const tc_camera camera = suite_camera(mesh, 0.1, 0.2, 1, true);
    const tc_plane plane[2] = {{{0, 0, 1}, 0.27}, {{0, 0, -1}, -0.36}}; /* within the third layer */
    for (int m = 3; m < N_MODEL; m++) {
        const tc_look look = {.model = models[m].model, .n_plane = 2, .plane = plane};
        tc_render_options options = suite_options(WIDTH, HEIGHT);
        options.look = &look;
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        for (int i = 0; i < 4 * PIXELS; i++)
            assert_true(image->rgba[i] == 0);
        tc_image_destroy(&image);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* ------------------------------------------------------------------------------------------------------- reference */

static void check_reference(const char *what, const tc_mesh *mesh, const tc_camera *camera, tc_model model, int steps,
                            int samples)
{
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    const double *range = report.scalar_range;
    tc_knot moved[N_KNOT];
    for (int i = 0; i < N_KNOT; i++) {
        moved[i] = knots[i];
        moved[i].s = range[0] + knots[i].s * (range[1] - range[0]);
    }
    tc_transfer *tf = suite_function(moved, N_KNOT);
    const tc_look look = {.model = model};
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.steps_per_pass = steps;
    options.samples = samples;
    options.look = &look;
    suite_check(what, mesh, tf, camera, &options);
    tc_transfer_destroy(&tf);
}

static void gaps_are_met(void **state)
{
    (void)state;
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_synth("heatsink", 2000, way ? TC_REENTRY_PEEL : TC_REENTRY_CONVEXIFY);
        const tc_camera camera = suite_camera(mesh, 0.5, 0.3, 1, false);
        for (int m = 0; m < N_MODEL; m++)
            check_reference(models[m].name, mesh, &camera, models[m].model, m % 2 ? 7 : 0, m == 3 ? 4 : 1);
        tc_mesh_destroy(&mesh);
    }
}

static void a_field_that_goes_up_and_down_is_not_followed(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(7, wave, TC_POINT_DATA);
    const tc_camera camera = suite_camera(mesh, 0.5, 0.3, 1, false);
    for (int m = 0; m < N_MODEL; m++)
        check_reference(models[m].name, mesh, &camera, models[m].model, 0, m == 5 ? 4 : 1);
    tc_mesh_destroy(&mesh);
}

/* Where rays differ the picture is that of 16 rays a pixel, elsewhere that of 4. */
static void a_finer_grid_is_not_one_of_the_model(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(4, wave, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, N_KNOT);
    const tc_camera camera = suite_camera(mesh, 0.5, 0.3, 1, false);
    for (int m = 0; m < N_MODEL; m++) {
        const tc_look look = {.model = models[m].model};
        static const int samples[3] = {4, 16, TC_SAMPLES_ADAPTIVE};
        tc_image *image[3];
        int fine = 0;
        for (int i = 0; i < 3; i++) {
            tc_render_options options = suite_options(WIDTH, HEIGHT);
            options.samples = samples[i];
            options.look = &look;
            image[i] = suite_render(NULL, mesh, tf, &camera, &options);
        }
        for (int p = 0; p < PIXELS; p++) {
            const size_t bytes = 4 * sizeof(float);
            bool coarse = memcmp(image[2]->rgba + 4 * p, image[0]->rgba + 4 * p, bytes) == 0;
            fine += !coarse;
            assert_true(coarse || memcmp(image[2]->rgba + 4 * p, image[1]->rgba + 4 * p, bytes) == 0);
        }
        assert_true(fine > 10 && fine < PIXELS);
        for (int i = 0; i < 3; i++)
            tc_image_destroy(&image[i]);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

/* --------------------------------------------------------------------------------------------------- what is paid */

static void a_model_is_paid_for_by_another(void **state)
{
    (void)state;
    tc_mesh *mesh = look_box(4, tent, TC_POINT_DATA);
    tc_transfer *tf = suite_function(knots, N_KNOT);
    const tc_camera camera = suite_camera(mesh, 0.2, 0.3, 1, false);
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    tc_render_stats plain, stats;
    tc_image *image = suite_render(&plain, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    for (int m = 0; m < N_MODEL && suite_is_gpu(); m++) {
        const tc_look look = {.model = models[m].model};
        options.look = &look;
        image = suite_render(&stats, mesh, tf, &camera, &options);
        tc_image_destroy(&image);
        assert_string_equal(stats.effects, models[m].name);
        assert_true(stats.passes == plain.passes);
        bool projects = m >= 3; /* these keep the function's pieces: 48 bytes an end, one more at each side */
        assert_true(stats.gpu_bytes_other - plain.gpu_bytes_other == (projects ? 48 * (N_KNOT + 2) : 0));
    }
    options.look = NULL;
    image = suite_render(&stats, mesh, tf, &camera, &options);
    tc_image_destroy(&image);
    if (suite_is_gpu())
        assert_string_equal(stats.effects, "density-emitter");
    assert_true(stats.gpu_bytes_other == plain.gpu_bytes_other || !suite_is_gpu());
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_model_sums_up_something_else),
        cmocka_unit_test(a_model_sees_what_is_cut_away),
        cmocka_unit_test(missing_values_are_taken_for_values),
        cmocka_unit_test(cells_without_any_value_are_met),
        cmocka_unit_test(gaps_are_met),
        cmocka_unit_test(a_field_that_goes_up_and_down_is_not_followed),
        cmocka_unit_test(a_finer_grid_is_not_one_of_the_model),
        cmocka_unit_test(a_model_is_paid_for_by_another),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
