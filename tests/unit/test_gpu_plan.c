/* test_gpu_plan.c: which integrator is chosen for which function and mesh. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "gpu/transfer_plan.h"
#include "transfer_make.h"
#include "transfer_functions/thin.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A mesh whose cells all have this edge and hold this share of the range 0 to 1. */
static tc_pack_extent mesh_of(double edge, double share)
{
    tc_pack_extent extent;
    for (int b = 0; b < TC_PACK_BINS; b++) {
        extent.edge[b] = (float)edge;
        extent.edge_range[b] = (float)(edge * share);
        extent.held[b] = fmin(share, 1);
    }
    return extent;
}

static tc_transfer_plan plan_of(const tc_transfer *tf, const tc_pack_extent *extent, const tc_render_options *options,
                                char why[256])
{
    tc_transfer_plan plan;
    tc_error err = {0};
    char unused[256];
    tc_transfer *thin = NULL;
    if (tc_transfer_thin(&thin, tf, 2.5e-4, &err) != TC_OK)
        fail_msg("%s", err.text);
    const tc_transfer_gpu_request request = {.transfer = tf,
                                             .pieces = thin,
                                             .options = options,
                                             .scalar = {0, 1},
                                             .length_max = 1,
                                             .extent = extent,
                                             .length_unit = 1,
                                             .threads = 1};
    if (tc_transfer_plan_make(&plan, why ? why : unused, sizeof unused, &request, &err) != TC_OK)
        fail_msg("%s", err.text);
    tc_transfer_destroy(&thin);
    return plan;
}

static tc_transfer *standard(const char *name)
{
    tc_transfer *tf = NULL;
    tc_error err = {0};
    if (tc_transfer_standard(&tf, name, (const double[2]){0, 1}, &err) != TC_OK)
        fail_msg("%s", err.text);
    return tf;
}

static const tc_render_options automatic = {0};

/* The knots of a colour map at both ends of the range lie a rounding beside those of its opacity. */
static void a_smooth_map_is_taken_for_steep(void **state)
{
    (void)state;
    tc_transfer *tf = standard("smooth");
    const tc_pack_extent fine = mesh_of(1, 0.02);
    char why[256] = "";
    tc_transfer_plan plan = plan_of(tf, &fine, &automatic, why);
    assert_int_equal(plan.integrator, TC_INTEGRATOR_INTEGRAL);
    assert_true(plan.hard == 0 && plan.order == 2 && plan.split == 0 && !plan.dense);
    assert_non_null(strstr(why, "running integrals"));
    tc_transfer_destroy(&tf);
}

static void functions_of_few_knots_are_not_integrated_piece_by_piece(void **state)
{
    static const char *const name[] = {"knots12", "spike", "steps"};
    (void)state;
    const tc_pack_extent fine = mesh_of(1, 0.05);
    for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
        tc_transfer *tf = standard(name[i]);
        char why[256] = "";
        assert_int_equal(plan_of(tf, &fine, &automatic, why).integrator, TC_INTEGRATOR_EXACT);
        assert_non_null(strstr(why, "few"));
        tc_transfer_destroy(&tf);
    }
}

/* Pieces cost by the knot: where cells hold many of them, only what integrals cannot know is left to pieces. */
static void many_knots_in_a_cell_are_crossed_one_by_one(void **state)
{
    (void)state;
    enum { N = 201 };
    tc_knot knot[N];
    for (int i = 0; i < N; i++)
        knot[i] = (tc_knot){i / (N - 1.0), i % 2 ? 0.9 : 0.1, 0.5, 0.5, 0.3};
    tc_transfer *tf = make(knot, N);
    const tc_pack_extent coarse = mesh_of(1, 0.2);
    tc_transfer_plan plan = plan_of(tf, &coarse, &automatic, NULL);
    assert_int_equal(plan.integrator, TC_INTEGRATOR_INTEGRAL);
    assert_true(plan.hard > 0 && plan.hard_depth > 0);
    tc_transfer_destroy(&tf);
}

/* Values at random: the function comes and goes within every cell. */
static void a_function_within_a_cell_is_guessed_from_its_ends(void **state)
{
    (void)state;
    static const tc_knot knot[] = {{0.40, 0, 0, 1, 0}, {0.41, 0.9, 0.9, 0.9, 0.15}, {0.42, 1, 0, 0, 0.3}};
    tc_transfer *tf = make(knot, 3);
    tc_pack_extent wild = mesh_of(1.5, 0.9);
    tc_transfer_plan plan = plan_of(tf, &wild, &automatic, NULL);
    assert_true(plan.integrator == TC_INTEGRATOR_EXACT || plan.hard > 0);
    tc_transfer_destroy(&tf);
}

static void who_asks_for_an_integrator_gets_another(void **state)
{
    (void)state;
    tc_transfer *tf = standard("knots12");
    const tc_pack_extent fine = mesh_of(1, 0.05);
    const tc_render_options integral = {.integrator = TC_INTEGRATOR_INTEGRAL}, first = {.integral_order = 1},
                            split = {.integral_split = 0.25}, exact = {.integrator = TC_INTEGRATOR_EXACT},
                            table = {.integrator = TC_INTEGRATOR_TABLE};
    tc_transfer_plan plan = plan_of(tf, &fine, &integral, NULL);
    assert_int_equal(plan.integrator, TC_INTEGRATOR_INTEGRAL);
    assert_true(plan.hard > 0);
    plan = plan_of(tf, &fine, &first, NULL);
    assert_int_equal(plan.integrator, TC_INTEGRATOR_INTEGRAL);
    assert_true(plan.hard == 0 && plan.order == 1);
    plan = plan_of(tf, &fine, &split, NULL);
    assert_int_equal(plan.integrator, TC_INTEGRATOR_INTEGRAL);
    assert_true(plan.hard == 0 && plan.split == 0.25);
    assert_int_equal(plan_of(tf, &fine, &exact, NULL).integrator, TC_INTEGRATOR_EXACT);
    assert_int_equal(plan_of(tf, &fine, &table, NULL).integrator, TC_INTEGRATOR_TABLE);
    tc_transfer_destroy(&tf);
}

/* Dense segments are cut, at a cost: only where a cell that long holds scalars that dense. */
static void dense_is_a_scene_in_which_no_cell_is(void **state)
{
    (void)state;
    static const tc_knot knot[] = {{0, 0, 0, 1, 0.5}, {0.5, 0, 0, 1, 0.5}, {0.5, 1, 0, 0, 20}, {1, 1, 0, 0, 20}};
    tc_transfer *tf = make(knot, 4);
    tc_pack_extent extent = mesh_of(0.01, 0.05);
    for (int b = 0; b < TC_PACK_BINS / 2 - 1; b++)
        extent.edge[b] = 1.5f; /* long, but clear: 0.75 deep */
    assert_false(plan_of(tf, &extent, &automatic, NULL).dense);
    for (int b = TC_PACK_BINS / 2 - 1; b <= TC_PACK_BINS / 2;
         b++) { /* a scalar of either side may be rounded to the step */
        tc_pack_extent one = extent;
        one.edge[b] = 1.5f;
        assert_true(plan_of(tf, &one, &automatic, NULL).dense);
    }
    extent = mesh_of(0.01, 0.05);
    extent.edge[TC_PACK_BINS - 1] = 0.06f;
    assert_true(plan_of(tf, &extent, &automatic, NULL).dense);
    tc_transfer_destroy(&tf);
}

/* A second round of pieces is for cells that cross many, and for the integrator that makes them. */
static void two_rounds_are_made_for_cells_of_few_knots(void **state)
{
    (void)state;
    enum { N = 201 };
    tc_knot knot[N];
    for (int i = 0; i < N; i++) /* no three on a line */
        knot[i] = (tc_knot){i / (N - 1.0), i % 2 ? 0.9 : 0.1, 0.5, 0.5, 0.3};
    tc_transfer *tf = make(knot, N);
    const tc_render_options exact = {.integrator = TC_INTEGRATOR_EXACT},
                            integral = {.integrator = TC_INTEGRATOR_INTEGRAL};
    const tc_pack_extent wide = mesh_of(0.01, 0.05), narrow = mesh_of(0.01, 0.005);
    assert_true(plan_of(tf, &wide, &exact, NULL).twice);
    assert_false(plan_of(tf, &narrow, &exact, NULL).twice);
    assert_false(plan_of(tf, &wide, &integral, NULL).twice);
    tc_transfer_destroy(&tf);
}

static void more_knots_than_can_be_crossed_are_promised(void **state)
{
    (void)state;
    enum { N = 50001 };
    tc_knot *knot = malloc(N * sizeof *knot);
    assert_non_null(knot);
    for (int i = 0; i < N; i++)
        knot[i] = (tc_knot){i / (N - 1.0), i % 2 ? 0.9 : 0.1, 0.5, 0.5, 0.3};
    tc_transfer *tf = make(knot, N);
    const tc_pack_extent fine = mesh_of(1, 0.001);
    const tc_render_options exact = {.integrator = TC_INTEGRATOR_EXACT};
    const tc_transfer_gpu_request request = {
        .transfer = tf, .pieces = tf, .options = &exact, .scalar = {0, 1}, .extent = &fine, .length_unit = 1};
    tc_transfer_plan plan;
    tc_error err = {0};
    assert_int_equal(tc_transfer_plan_make(&plan, NULL, 0, &request, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "fewer knots"));
    assert_int_equal(plan_of(tf, &fine, &automatic, NULL).integrator, TC_INTEGRATOR_INTEGRAL);
    tc_transfer_destroy(&tf);
    free(knot);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_smooth_map_is_taken_for_steep),
        cmocka_unit_test(functions_of_few_knots_are_not_integrated_piece_by_piece),
        cmocka_unit_test(many_knots_in_a_cell_are_crossed_one_by_one),
        cmocka_unit_test(a_function_within_a_cell_is_guessed_from_its_ends),
        cmocka_unit_test(who_asks_for_an_integrator_gets_another),
        cmocka_unit_test(dense_is_a_scene_in_which_no_cell_is),
        cmocka_unit_test(two_rounds_are_made_for_cells_of_few_knots),
        cmocka_unit_test(more_knots_than_can_be_crossed_are_promised),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
