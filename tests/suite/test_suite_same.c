/* test_suite_same.c: what must not change the picture: refining, reordering, filling gaps or peeling, a second frame.
 */
#include "suite.h"

#include "datasets_synthetic/synth.h"
#include "tests/common/variants.h"

#include <stdlib.h>
#include <string.h>

enum { SIZE = 128 };

/* A generator's soup with its field. */
static mesh_variant build_plain(const char *name, size_t n_cells)
{
    const tc_synth_generator *g = tc_synth_find(name);
    static const double here[3] = {0, 0, 0};
    tc_synth_soup soup = {0};
    mesh_variant plain = {0};
    assert_int_equal(g->build(&soup, n_cells, 1, NULL), TC_OK);
    double *scalar = malloc(soup.n_vertex * sizeof *scalar);
    assert_non_null(scalar);
    for (size_t i = 0; i < soup.n_vertex; i++)
        scalar[i] = g->field(soup.vertex + 3 * i);
    const tc_mesh_arrays arrays = {soup.n_vertex, soup.vertex, soup.n_tet, soup.tet, scalar, TC_POINT_DATA, "field"};
    assert_int_equal(variant_move(&plain, &arrays, NULL, 1, here, NULL), TC_OK);
    free(scalar);
    tc_synth_soup_finish(&soup);
    return plain;
}

/* The picture of a mesh that is taken over, with a unit distance that does not depend on its cells. */
static tc_image *picture(tc_mesh *mesh, const tc_transfer *tf, double x, double y, double z)
{
    tc_render_options options = suite_options(SIZE, SIZE);
    options.unit_distance = suite_diagonal(mesh) / 30;
    tc_camera camera = suite_camera(mesh, x, y, z, false);
    tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
    tc_mesh_destroy(&mesh);
    return image;
}

static void expect_same(const char *what, double bound, tc_image *a, tc_image *b)
{
    double difference = suite_difference(a, b);
    suite_say("%s: largest difference %.2e", what, difference);
    if (!(difference <= bound))
        fail_msg("%s: the pictures differ by %.3e, more than %.3e", what, difference, bound);
    tc_image_destroy(&b);
}

static void a_finer_mesh_of_a_linear_field_looks_different(void **state)
{
    (void)state;
    static const tc_knot knot[] = {{0, 0.2, 0.3, 0.8, 0.02},
                                   {0.4, 0.9, 0.9, 0.8, 0.1},
                                   {0.45, 0.9, 0.2, 0.1, 0.6},
                                   {0.5, 0.9, 0.7, 0.1, 0.05},
                                   {1, 0.7, 0.1, 0.1, 0.3}};
    tc_transfer *tf = suite_function(knot, 5);
    tc_image *coarse = picture(suite_synth("kuhn", 800, TC_REENTRY_AUTO), tf, 1, 0.4, 0.7);
    expect_same("kuhn 800 and 30000", SUITE_HALF_STEP, coarse,
                picture(suite_synth("kuhn", 30000, TC_REENTRY_AUTO), tf, 1, 0.4, 0.7));
    mesh_variant plain = build_plain("kuhn", 800), fine = {0}, finer = {0};
    assert_int_equal(variant_refine4(&fine, &plain.arrays, NULL), TC_OK);
    assert_int_equal(variant_refine8(&finer, &plain.arrays, NULL), TC_OK);
    expect_same("kuhn refined 1:4", SUITE_HALF_STEP, coarse,
                picture(suite_mesh(&fine.arrays, TC_REENTRY_AUTO), tf, 1, 0.4, 0.7));
    expect_same("kuhn refined 1:8", SUITE_HALF_STEP, coarse,
                picture(suite_mesh(&finer.arrays, TC_REENTRY_AUTO), tf, 1, 0.4, 0.7));
    variant_finish(&plain);
    variant_finish(&fine);
    variant_finish(&finer);
    tc_image_destroy(&coarse);
    tc_transfer_destroy(&tf);
}

/* One cube in 8 x 8 x 8 blocks that are split in three ways, with one linear field. */
static void another_split_of_a_linear_field_looks_different(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        size_t n_cells;
    } splits[] = {{"grid-kuhn", 3072}, {"grid-five", 2560}, {"grid-bcc", 6144}};
    enum { N_SPLIT = sizeof splits / sizeof *splits };
    static const double from[][3] = {{1, 0.4, 0.7}, {-0.3, 0.2, 1}};
    tc_mesh_report first, other;
    for (size_t k = 0; k < sizeof from / sizeof *from; k++) {
        tc_image *image = NULL;
        tc_transfer *tf = NULL;
        for (size_t i = 0; i < N_SPLIT; i++) {
            tc_mesh *mesh = suite_synth(splits[i].name, splits[i].n_cells, TC_REENTRY_AUTO);
            tc_mesh_get_report(&other, mesh);
            assert_int_equal(other.n_tet, splits[i].n_cells);
            if (i == 0) {
                first = other;
                tf = suite_benchmark(mesh);
                image = picture(mesh, tf, from[k][0], from[k][1], from[k][2]);
                continue;
            }
            assert_memory_equal(other.bounds, first.bounds, sizeof first.bounds);
            for (int e = 0; e < 2; e++)
                assert_true(fabs(other.scalar_range[e] - first.scalar_range[e]) < 1e-12);
            expect_same(splits[i].name, SUITE_HALF_STEP, image, picture(mesh, tf, from[k][0], from[k][1], from[k][2]));
        }
        tc_image_destroy(&image);
        tc_transfer_destroy(&tf);
    }
}

static void refined_or_permuted_heat_sink_looks_different(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("heatsink", 8000, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_image *plain = picture(mesh, tf, 0.5, 0.4, 1);
    mesh_variant f = build_plain("heatsink", 8000), fine = {0}, other = {0};
    assert_int_equal(variant_refine4(&fine, &f.arrays, NULL), TC_OK);
    assert_int_equal(variant_permute(&other, &f.arrays, 7, NULL), TC_OK);
    expect_same("heatsink refined 1:4", SUITE_HALF_STEP, plain,
                picture(suite_mesh(&fine.arrays, TC_REENTRY_AUTO), tf, 0.5, 0.4, 1));
    expect_same("heatsink permuted", SUITE_HALF_STEP, plain,
                picture(suite_mesh(&other.arrays, TC_REENTRY_AUTO), tf, 0.5, 0.4, 1));
    expect_same("heatsink permuted and peeled", SUITE_HALF_STEP, plain,
                picture(suite_mesh(&other.arrays, TC_REENTRY_PEEL), tf, 0.5, 0.4, 1));
    variant_finish(&f);
    variant_finish(&fine);
    variant_finish(&other);
    tc_image_destroy(&plain);
    tc_transfer_destroy(&tf);
}

static void check_both_ways(const char *name, size_t n_cells)
{
    static const double from[3][3] = {{0.2, 0.3, 1}, {1, 0.1, 0.05}, {-0.5, 1, 0.3}};
    tc_mesh *mesh = suite_synth(name, n_cells, TC_REENTRY_CONVEXIFY);
    tc_transfer *tf = suite_benchmark(mesh);
    const tc_render_options options = suite_options(SIZE, SIZE);
    tc_image *filled[3];
    for (int i = 0; i < 3; i++) {
        tc_camera camera = suite_camera(mesh, from[i][0], from[i][1], from[i][2], i == 1);
        filled[i] = suite_render(NULL, mesh, tf, &camera, &options);
        suite_verify(name, SUITE_HALF_STEP, SIZE_MAX, filled[i], mesh, tf, &camera, &options);
    }
    suite_prepare(mesh, TC_REENTRY_PEEL);
    for (int i = 0; i < 3; i++) {
        tc_render_stats stats;
        tc_camera camera = suite_camera(mesh, from[i][0], from[i][1], from[i][2], i == 1);
        tc_image *peeled = suite_render(&stats, mesh, tf, &camera, &options);
        if (suite_is_gpu())
            assert_true(stats.layers > 1);
        suite_verify("peeled", SUITE_HALF_STEP, SIZE_MAX, peeled, mesh, tf, &camera, &options);
        expect_same(name, SUITE_HALF_STEP, filled[i], peeled);
        tc_image_destroy(&filled[i]);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void gaps_of_the_heat_sink_are_crossed_wrongly(void **state)
{
    (void)state;
    check_both_ways("heatsink", 12000);
}

static void gaps_and_cavity_of_the_shells_are_crossed_wrongly(void **state)
{
    (void)state;
    check_both_ways("shells", 8000);
}

static void gaps_of_the_comb_are_crossed_wrongly(void **state)
{
    (void)state;
    check_both_ways("comb", 6000);
}

static void gaps_of_the_spiral_are_crossed_wrongly(void **state)
{
    (void)state;
    check_both_ways("spiral", 8000);
}

static void gaps_of_the_torus_knot_are_crossed_wrongly(void **state)
{
    (void)state;
    check_both_ways("torusknot", 8000);
}

static void parts_that_do_not_touch_hide_each_other(void **state)
{
    (void)state;
    /* Two tets apart; a third touches one of them in a vertex and another along an edge. */
    static const double vertex[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 2},  {3, 2, 2}, {2, 3, 2},
                                       {2, 2, 3}, {1, 1, 1}, {1, 2, 1}, {2, 1, 1}, {-1, 0, 0}, {0, -1, 0}};
    static const int32_t tet[][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 4}, {0, 3, 11, 12}};
    static const double scalar[13] = {0, 1, 2, 3, 1, 0, 2, 3, 1, 3, 0, 2, 1};
    const tc_mesh_arrays arrays = {13, &vertex[0][0], 4, &tet[0][0], scalar, TC_POINT_DATA, "field"};
    static const tc_knot knot[] = {{0, 1, 0, 0, 0.5}, {1.5, 0, 1, 0, 2}, {3, 0, 0, 1, 0.5}};
    tc_transfer *tf = suite_function(knot, 3);
    for (int way = 0; way < 2; way++) {
        tc_mesh *mesh = suite_mesh(&arrays, way ? TC_REENTRY_PEEL : TC_REENTRY_AUTO);
        tc_camera camera = suite_camera(mesh, 1, 1, 1, false);
        const tc_render_options options = suite_options(SIZE, SIZE);
        suite_check("loose tets", mesh, tf, &camera, &options);
        tc_mesh_destroy(&mesh);
    }
    tc_transfer_destroy(&tf);
}

static void a_renderer_keeps_something_of_the_frame_before(void **state)
{
    (void)state;
    tc_mesh *a = suite_synth("kuhn", 2000, TC_REENTRY_AUTO), *b = suite_synth("comb", 4000, TC_REENTRY_PEEL);
    tc_transfer *tf_a = suite_benchmark(a), *tf_b = suite_benchmark(b);
    tc_camera camera_a = suite_camera(a, 1, 1, 1, false), camera_b = suite_camera(b, 1, 0.2, 0.1, false);
    tc_render_options large = suite_options(96, 96), small = suite_options(64, 48), other = large;
    other.integrator = TC_INTEGRATOR_TABLE;
    other.opacity_stop = 0.5;
    other.count = true;
    tc_image *first = suite_render(NULL, a, tf_a, &camera_a, &large);
    tc_image *between[4] = {
        suite_render(NULL, b, tf_b, &camera_b, &small),
        suite_render(NULL, a, tf_b, &camera_a, &other),
        suite_render(NULL, a, tf_a, &camera_b, &large),
        suite_render(NULL, b, tf_a, &camera_b, &other),
    };
    tc_image *again = suite_render(NULL, a, tf_a, &camera_a, &large);
    assert_memory_equal(first->rgba, again->rgba, 96 * 96 * 4 * sizeof(float));
    for (int i = 0; i < 4; i++)
        tc_image_destroy(&between[i]);
    tc_image_destroy(&first);
    tc_image_destroy(&again);
    tc_transfer_destroy(&tf_a);
    tc_transfer_destroy(&tf_b);
    tc_mesh_destroy(&a);
    tc_mesh_destroy(&b);
}

/* A layer of cells in the middle of a lattice becomes flat; its two sides keep vertices at other places, so that they
 * interpolate the field differently, and the scalar jumps where a ray passes it. */
static void the_scalar_does_not_jump_at_a_flat_layer(void **state)
{
    (void)state;
    mesh_variant f = build_plain("kuhn", 10368);
    const int n = 12; /* 6 n^3 tets */
    assert_int_equal(f.arrays.n_tet, 6 * n * n * n);
    for (size_t i = 0; i < f.arrays.n_vertex; i++) {
        double *p = f.vertex + 3 * i;
        int layer = (int)lround(p[2] * n);
        p[2] = (layer > n / 2 ? layer - 1 : layer) / (double)n;
        f.scalar[i] = sin(25 * p[0]) * cos(21 * p[1]);
    }
    tc_mesh *mesh = suite_mesh(&f.arrays, TC_REENTRY_CONVEXIFY);
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    assert_true(report.zero_volume > 5 * n * n); /* those at corners repeat a vertex and go */
    tc_transfer *tf = suite_function((const tc_knot[]){{-1, 0, 0, 1, 0}, {0, 1, 1, 0, 0.1}, {1, 1, 0, 0, 3}}, 3);
    tc_render_options options = suite_options(SIZE, SIZE);
    static const double from[][3] = {{0.3, 0.2, 1}, {0.7, 0.1, 0.7}, {0.1, 1, 0.2}};
    for (size_t k = 0; k < sizeof from / sizeof *from; k++) {
        tc_camera camera = suite_camera(mesh, from[k][0], from[k][1], from[k][2], k == 1);
        suite_check("flat layer", mesh, tf, &camera, &options);
    }
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    variant_finish(&f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_scalar_does_not_jump_at_a_flat_layer),
        cmocka_unit_test(a_finer_mesh_of_a_linear_field_looks_different),
        cmocka_unit_test(another_split_of_a_linear_field_looks_different),
        cmocka_unit_test(refined_or_permuted_heat_sink_looks_different),
        cmocka_unit_test(gaps_of_the_heat_sink_are_crossed_wrongly),
        cmocka_unit_test(gaps_and_cavity_of_the_shells_are_crossed_wrongly),
        cmocka_unit_test(gaps_of_the_comb_are_crossed_wrongly),
        cmocka_unit_test(gaps_of_the_spiral_are_crossed_wrongly),
        cmocka_unit_test(gaps_of_the_torus_knot_are_crossed_wrongly),
        cmocka_unit_test(parts_that_do_not_touch_hide_each_other),
        cmocka_unit_test(a_renderer_keeps_something_of_the_frame_before),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
