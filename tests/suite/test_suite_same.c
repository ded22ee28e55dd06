/* test_suite_same.c: what must not change the picture: refining, reordering, filling gaps or peeling, a second frame.
 */
#include "suite.h"

#include "datasets_synthetic/synth.h"

#include <stdlib.h>
#include <string.h>

enum { SIZE = 128 };

/* A soup with values at its vertices. */
typedef struct field {
    tc_synth_soup soup;
    double *scalar;
} field;

static field build_field(const char *name, size_t n_cells)
{
    const tc_synth_generator *g = tc_synth_find(name);
    field f = {0};
    assert_int_equal(g->build(&f.soup, n_cells, 1, NULL), TC_OK);
    f.scalar = malloc((f.soup.n_vertex + f.soup.n_tet) * sizeof *f.scalar); /* room for refine */
    assert_non_null(f.scalar);
    for (size_t i = 0; i < f.soup.n_vertex; i++)
        f.scalar[i] = g->field(f.soup.vertex + 3 * i);
    return f;
}

static void free_field(field *f)
{
    free(f->scalar);
    tc_synth_soup_finish(&f->soup);
}

static tc_mesh *mesh_of(const field *f, tc_reentry reentry)
{
    const tc_mesh_arrays arrays = {f->soup.n_vertex, f->soup.vertex, f->soup.n_tet, f->soup.tet,
                                   f->scalar,        TC_POINT_DATA,  "field"};
    return suite_mesh(&arrays, reentry);
}

/* Every tet becomes four around its centre, where the value is the mean: the same piecewise linear field. */
static field refine(const field *coarse)
{
    const tc_synth_soup *c = &coarse->soup;
    field f = {.soup = {.n_vertex = c->n_vertex + c->n_tet, .n_tet = 4 * c->n_tet}};
    f.soup.vertex = malloc(f.soup.n_vertex * 3 * sizeof(double));
    f.soup.tet = malloc(f.soup.n_tet * 4 * sizeof(int32_t));
    f.scalar = malloc(f.soup.n_vertex * sizeof(double));
    assert_true(f.soup.vertex && f.soup.tet && f.scalar);
    memcpy(f.soup.vertex, c->vertex, c->n_vertex * 3 * sizeof(double));
    memcpy(f.scalar, coarse->scalar, c->n_vertex * sizeof(double));
    for (size_t i = 0; i < c->n_tet; i++) {
        const int32_t *tet = c->tet + 4 * i;
        size_t center = c->n_vertex + i;
        double *p = f.soup.vertex + 3 * center;
        p[0] = p[1] = p[2] = f.scalar[center] = 0;
        for (int k = 0; k < 4; k++) {
            for (int a = 0; a < 3; a++)
                p[a] += 0.25 * c->vertex[3 * tet[k] + a];
            f.scalar[center] += 0.25 * coarse->scalar[tet[k]];
            int32_t *part = f.soup.tet + 16 * i + 4 * k;
            memcpy(part, tet, 4 * sizeof *part);
            part[k] = (int32_t)center;
        }
    }
    return f;
}

static void shuffle(int32_t *order, size_t n, uint64_t seed)
{
    for (size_t i = 0; i < n; i++)
        order[i] = (int32_t)i;
    for (size_t i = n; i > 1; i--) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        size_t j = (size_t)(seed >> 33) % i;
        int32_t t = order[i - 1];
        order[i - 1] = order[j];
        order[j] = t;
    }
}

/* Vertices, cells and the vertices within a cell in another order; half of the cells are turned inside out. */
static field permute(const field *from)
{
    const tc_synth_soup *s = &from->soup;
    field f = {.soup = {.n_vertex = s->n_vertex, .n_tet = s->n_tet}};
    f.soup.vertex = malloc(s->n_vertex * 3 * sizeof(double));
    f.soup.tet = malloc(s->n_tet * 4 * sizeof(int32_t));
    f.scalar = malloc(s->n_vertex * sizeof(double));
    int32_t *vertex = malloc(s->n_vertex * sizeof *vertex), *tet = malloc(s->n_tet * sizeof *tet);
    assert_true(f.soup.vertex && f.soup.tet && f.scalar && vertex && tet);
    shuffle(vertex, s->n_vertex, 7);
    shuffle(tet, s->n_tet, 8);
    for (size_t i = 0; i < s->n_vertex; i++) {
        memcpy(f.soup.vertex + 3 * vertex[i], s->vertex + 3 * i, 3 * sizeof(double));
        f.scalar[vertex[i]] = from->scalar[i];
    }
    for (size_t i = 0; i < s->n_tet; i++) {
        int32_t corner[4];
        shuffle(corner, 4, i);
        for (int k = 0; k < 4; k++)
            f.soup.tet[4 * tet[i] + corner[k]] = vertex[s->tet[4 * i + (size_t)k]];
    }
    free(vertex);
    free(tet);
    return f;
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
    field f = build_field("kuhn", 800), fine = refine(&f);
    expect_same("kuhn refined 1:4", SUITE_HALF_STEP, coarse, picture(mesh_of(&fine, TC_REENTRY_AUTO), tf, 1, 0.4, 0.7));
    free_field(&fine);
    free_field(&f);
    tc_image_destroy(&coarse);
    tc_transfer_destroy(&tf);
}

static void refined_or_permuted_heat_sink_looks_different(void **state)
{
    (void)state;
    tc_mesh *mesh = suite_synth("heatsink", 8000, TC_REENTRY_AUTO);
    tc_transfer *tf = suite_benchmark(mesh);
    tc_image *plain = picture(mesh, tf, 0.5, 0.4, 1);
    field f = build_field("heatsink", 8000), fine = refine(&f), other = permute(&f);
    expect_same("heatsink refined 1:4", SUITE_HALF_STEP, plain,
                picture(mesh_of(&fine, TC_REENTRY_AUTO), tf, 0.5, 0.4, 1));
    expect_same("heatsink permuted", SUITE_HALF_STEP, plain,
                picture(mesh_of(&other, TC_REENTRY_AUTO), tf, 0.5, 0.4, 1));
    expect_same("heatsink permuted and peeled", SUITE_HALF_STEP, plain,
                picture(mesh_of(&other, TC_REENTRY_PEEL), tf, 0.5, 0.4, 1));
    free_field(&f);
    free_field(&fine);
    free_field(&other);
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
    field f = build_field("kuhn", 10368);
    const int n = 12; /* 6 n^3 tets */
    assert_int_equal(f.soup.n_tet, 6 * n * n * n);
    for (size_t i = 0; i < f.soup.n_vertex; i++) {
        double *p = f.soup.vertex + 3 * i;
        int layer = (int)lround(p[2] * n);
        p[2] = (layer > n / 2 ? layer - 1 : layer) / (double)n;
        f.scalar[i] = sin(25 * p[0]) * cos(21 * p[1]);
    }
    tc_mesh *mesh = mesh_of(&f, TC_REENTRY_CONVEXIFY);
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
    free_field(&f);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_scalar_does_not_jump_at_a_flat_layer),
        cmocka_unit_test(a_finer_mesh_of_a_linear_field_looks_different),
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
