/* test_suite_values.c: new values on a mesh that a renderer holds: the picture is that of a fresh mesh with these
 * values, bit for bit, and nothing but the values is sent. */
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 40, KINDS = 8 };

typedef struct scene {
    tc_mesh *mesh;         /* prepared once */
    tc_renderer *renderer; /* that holds it */
    tc_mesh_report made;   /* before it was prepared: lengths of values */
    double *value;
} scene;

static tc_mesh *bare(void)
{
    tc_mesh *mesh = NULL;
    assert_int_equal(tc_synth_create(&mesh, "heatsink", 3000, 1, NULL), TC_OK);
    return mesh;
}

static int set_up(void **state)
{
    scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    *state = s;
    s->mesh = bare();
    tc_mesh_get_report(&s->made, s->mesh);
    s->value = calloc(s->made.n_vertex + s->made.n_tet, sizeof *s->value);
    assert_non_null(s->value);
    suite_prepare(s->mesh, TC_REENTRY_CONVEXIFY);
    s->renderer = suite_renderer(NULL);
    return 0;
}

static int tear_down(void **state)
{
    scene *s = *state;
    tc_renderer_destroy(&s->renderer);
    tc_mesh_destroy(&s->mesh);
    free(s->value);
    free(s);
    return 0;
}

/* Values of one kind: smooth ones, of a greater and of a smaller range, some or all of which are not finite, or one. */
static tc_association fill(const scene *s, int kind)
{
    tc_association association = kind == 3 || kind == 5 ? TC_CELL_DATA : TC_POINT_DATA;
    size_t n = association == TC_CELL_DATA ? s->made.n_tet : s->made.n_vertex;
    for (size_t i = 0; i < n; i++) {
        double smooth = 0.5 + 0.5 * sin(0.01 * (double)i + kind);
        s->value[i] = kind == 1   ? 1e4 * smooth - 70
                      : kind == 2 ? 1e-3 * smooth + 0.4
                      : kind == 4 ? (i % 7 ? smooth : NAN)
                      : kind == 5 ? (i % 5 ? 3 * smooth : INFINITY)
                      : kind == 6 ? 0.25
                      : kind == 7 ? NAN
                                  : smooth;
    }
    return association;
}

static tc_image *render(tc_render_stats *stats, const scene *s, const tc_mesh *mesh, tc_integrator integrator)
{
    static const tc_knot knot[] = {{-70, 0.1, 0.2, 0.9, 0.1},
                                   {0, 0.2, 0.3, 0.8, 0.05},
                                   {0.45, 0.9, 0.8, 0.7, 1},
                                   {1, 0.8, 0.1, 0.2, 3},
                                   {1e4, 0.3, 0.9, 0.4, 9}};
    tc_transfer *tf = suite_function(knot, sizeof knot / sizeof *knot);
    tc_camera camera = suite_camera(mesh, 0.4, 0.5, 1, false);
    tc_render_options options = suite_options(SIZE, SIZE);
    options.integrator = integrator;
    options.has_nan_color = true;
    options.nan_color[1] = 1, options.nan_color[3] = 0.5;
    tc_image *image = suite_render_by(stats, s->renderer, mesh, tf, &camera, &options);
    tc_transfer_destroy(&tf);
    return image;
}

static bool same_bits(const tc_image *a, const tc_image *b)
{
    return memcmp(a->rgba, b->rgba, 4 * sizeof *a->rgba * SIZE * SIZE) == 0;
}

static void a_picture_after_new_values_is_not_that_of_a_fresh_mesh(void **state)
{
    const scene *s = *state;
    static const int order[] = {0, 1, 2, 4, 3, 5, 6, 3, 7, 0, 5, 1};
    static const tc_integrator integrator[] = {TC_INTEGRATOR_AUTO, TC_INTEGRATOR_TABLE};
    for (int k = 0; k < 2; k++) {
        tc_image *fresh[KINDS];
        for (int kind = 0; kind < KINDS; kind++) {
            tc_mesh *mesh = bare();
            assert_int_equal(tc_mesh_set_scalar(mesh, s->value, fill(s, kind), NULL), TC_OK);
            suite_prepare(mesh, TC_REENTRY_CONVEXIFY);
            fresh[kind] = render(NULL, s, mesh, integrator[k]);
            tc_mesh_destroy(&mesh);
        }
        assert_false(same_bits(fresh[0], fresh[2])); /* the values are to be seen */
        assert_false(same_bits(fresh[0], fresh[3]));
        for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
            assert_int_equal(tc_mesh_set_scalar(s->mesh, s->value, fill(s, order[i]), NULL), TC_OK);
            tc_image *image = render(NULL, s, s->mesh, integrator[k]);
            if (!same_bits(image, fresh[order[i]]))
                fail_msg("values %d, number %zu", order[i], i);
            tc_image_destroy(&image);
        }
        for (int kind = 0; kind < KINDS; kind++)
            tc_image_destroy(&fresh[kind]);
    }
}

static void more_than_the_values_is_sent(void **state)
{
    const scene *s = *state;
    if (!suite_is_gpu())
        skip();
    tc_mesh_report report;
    tc_mesh_get_report(&report, s->mesh);
    const double points = 16.0 * (double)(report.n_vertex + report.n_steiner), cells = 4.0 * (double)report.n_tet;
    const double all = 16.0 * (double)(report.n_tet + report.n_imaginary);
    const struct {
        int kind;
        double sent;
    } step[] = {{0, 0}, {1, points}, {3, points + cells}, {5, cells}, {3, cells}, {4, points}, {0, points}};
    for (size_t i = 0; i < sizeof step / sizeof *step; i++) {
        tc_render_stats stats;
        assert_int_equal(tc_mesh_set_scalar(s->mesh, s->value, fill(s, step[i].kind), NULL), TC_OK);
        tc_image *image = render(&stats, s, s->mesh, TC_INTEGRATOR_INTEGRAL);
        tc_image_destroy(&image);
        if (i == 0)
            assert_true(stats.gpu_bytes_sent > all);
        else
            assert_true(stats.gpu_bytes_sent == step[i].sent);
        assert_true(stats.ms_pack >= 0);
        assert_true(stats.gpu_bytes_mesh == points + all);
        image = render(&stats, s, s->mesh, TC_INTEGRATOR_INTEGRAL);
        tc_image_destroy(&image);
        assert_true(stats.gpu_bytes_sent == 0);
        assert_true(stats.ms_pack < 0);
    }
}

/* Where nearly all points have one value cells cross few knots of the function; with values at random they cross many.
 */
static void an_integrator_is_chosen_by_the_values_before(void **state)
{
    const scene *s = *state;
    if (!suite_is_gpu())
        skip();
    static const tc_knot knot[] = {{0, 1, 0, 0, 0.01},     {0.3, 1, 0.1, 0, 0.03}, {0.5, 1, 0.3, 0, 0.02},
                                   {0.7, 1, 0.1, 0, 0.03}, {0.8, 1, 0, 0, 0.01},   {1, 1, 0, 0, 0.04}};
    char first[2][288];
    tc_transfer *tf = suite_function(knot, sizeof knot / sizeof *knot);
    tc_camera camera = suite_camera(s->mesh, 0.4, 0.5, 1, false);
    tc_render_options options = suite_options(SIZE, SIZE);
    for (int i = 0; i < 4; i++) {
        tc_render_stats stats;
        for (size_t k = 0; k < s->made.n_vertex; k++)
            s->value[k] = k < 2 ? (double)k : i % 2 ? (double)(k * 2654435761u % 1009) / 1009 : 0.1;
        assert_int_equal(tc_mesh_set_scalar(s->mesh, s->value, TC_POINT_DATA, NULL), TC_OK);
        tc_image *image = suite_render_by(&stats, s->renderer, s->mesh, tf, &camera, &options);
        tc_image_destroy(&image);
        if (i < 2)
            snprintf(first[i], sizeof first[i], "%s, %s", stats.integrator, stats.integrator_why);
        char now[288];
        snprintf(now, sizeof now, "%s, %s", stats.integrator, stats.integrator_why);
        assert_string_equal(now, first[i % 2]);
        if (i == 1)
            assert_string_not_equal(first[0], first[1]);
    }
    tc_transfer_destroy(&tf);
}

int main(int argc, char **argv)
{
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_picture_after_new_values_is_not_that_of_a_fresh_mesh, set_up, tear_down),
        cmocka_unit_test_setup_teardown(more_than_the_values_is_sent, set_up, tear_down),
        cmocka_unit_test_setup_teardown(an_integrator_is_chosen_by_the_values_before, set_up, tear_down),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
