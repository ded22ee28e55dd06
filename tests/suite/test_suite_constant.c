/* test_suite_constant.c: constant extinction, where alpha is known in closed form: 1 - exp(-kappa L), L the analytic
 * chord of the very polyhedron. */
#include "suite.h"

#include "datasets_synthetic/synth.h"
#include "tests/common/shift.h"

#include <stdlib.h>

enum { WIDTH = 64, HEIGHT = 52 };

static const double KAPPA = 4; /* optical depth of the bounds' diagonal */
static const tc_knot function[1] = {{0, 0.9, 0.5, 0.2, 1}};

typedef struct shape {
    const char *name;
    size_t n_cells;
    tc_reentry reentry;
} shape;

static const shape shapes[] = {
    {"kuhn", 6000, TC_REENTRY_CONVEXIFY},     {"ball", 2500, TC_REENTRY_CONVEXIFY},
    {"heatsink", 8000, TC_REENTRY_CONVEXIFY}, {"cylinder", 3000, TC_REENTRY_CONVEXIFY},
    {"comb", 5000, TC_REENTRY_CONVEXIFY},     {"shells", 2500, TC_REENTRY_CONVEXIFY},
    {"heatsink", 8000, TC_REENTRY_PEEL},      {"shells", 2500, TC_REENTRY_PEEL},
};
enum { N_SHAPE = sizeof shapes / sizeof *shapes };

static const struct view {
    double direction[3];
    bool parallel;
} views[] = {{{0.3, 0.5, 1}, false}, {{1, 0.2, 0.1}, false}, {{0, 0, 1}, true}, {{-0.7, 0.3, -0.4}, true}};
enum { N_VIEW = sizeof views / sizeof *views };

static double alpha_of(const tc_synth_generator *g, size_t n_cells, const double *o, const double *d, double diagonal)
{
    return 1 - exp(-KAPPA * g->chord(o, d, n_cells) / diagonal);
}

/* The ray says nothing when alpha moves by more than `bound` with a shift of 2^-22 of the diagonal: positions on the
 * GPU are floats of half diagonals. */
static bool is_ill_posed(const tc_synth_generator *g, const shape *s, const double *o, const double *d, double diagonal,
                         double bound)
{
    double alpha = alpha_of(g, s->n_cells, o, d, diagonal);
    for (int k = 0; k < RAY_SIDES; k++) {
        double moved[3];
        ray_shift(moved, o, d, RAY_SHIFT * diagonal, k);
        if (fabs(alpha_of(g, s->n_cells, moved, d, diagonal) - alpha) > bound)
            return true;
    }
    return false;
}

static void check_shape(const shape *s, tc_integrator integrator, double bound)
{
    const tc_synth_generator *g = tc_synth_find(s->name);
    tc_mesh *mesh = suite_synth(s->name, s->n_cells, s->reentry);
    tc_transfer *tf = suite_function(function, 1);
    double diagonal = suite_diagonal(mesh), worst = 0;
    size_t ill_posed = 0, covered = 0;
    tc_render_options options = suite_options(WIDTH, HEIGHT);
    options.integrator = integrator;
    options.opacity_stop = 1;
    options.unit_distance = diagonal / KAPPA;
    for (int k = 0; k < N_VIEW; k++) {
        const double *from = views[k].direction;
        tc_camera camera = suite_camera(mesh, from[0], from[1], from[2], views[k].parallel);
        tc_image *image = suite_render(NULL, mesh, tf, &camera, &options);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            double o[3], d[3];
            suite_ray(o, d, &camera, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
            double alpha = alpha_of(g, s->n_cells, o, d, diagonal), error = 0;
            const double expected[4] = {alpha * function->r, alpha * function->g, alpha * function->b, alpha};
            for (int c = 0; c < 4; c++)
                error = fmax(error, fabs(image->rgba[4 * i + c] - expected[c]));
            covered += alpha > 0;
            if (error > bound && is_ill_posed(g, s, o, d, diagonal, bound))
                ill_posed++;
            else if (!(error <= bound))
                fail_msg("%s, view %d, pixel %d, %d: alpha %.9g, expected %.9g", s->name, k, i % WIDTH, i / WIDTH,
                         (double)image->rgba[4 * i + 3], alpha);
            else
                worst = fmax(worst, error);
        }
        tc_image_destroy(&image);
    }
    suite_say("%s %s: max error %.2e over %zu covered pixels, ill-posed %zu", s->name,
              s->reentry == TC_REENTRY_PEEL ? "peeled" : "convexified", worst, covered, ill_posed);
    assert_true(covered > (size_t)(WIDTH * HEIGHT * N_VIEW) / 12); /* the view is on the mesh */
    assert_true(ill_posed <= 1 || (double)ill_posed <= 1e-4 * WIDTH * HEIGHT * N_VIEW);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
}

static void check_shapes(tc_integrator integrator, double bound)
{
    for (int i = 0; i < N_SHAPE; i++)
        check_shape(&shapes[i], integrator, bound);
}

static void integral_gives_another_alpha_than_the_chord(void **state)
{
    (void)state;
    check_shapes(TC_INTEGRATOR_INTEGRAL, 1e-5);
}

static void table_gives_another_alpha_than_the_chord(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        skip(); /* it has one integrator */
    check_shapes(TC_INTEGRATOR_TABLE, 5e-4);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integral_gives_another_alpha_than_the_chord),
        cmocka_unit_test(table_gives_another_alpha_than_the_chord),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    suite_end();
    return failed;
}
