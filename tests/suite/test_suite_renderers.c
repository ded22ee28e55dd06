/* test_suite_renderers.c: renderers beside each other, and options that no renderer takes. */
#define _GNU_SOURCE
#include "suite.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIZE = 48 };

typedef struct scene {
    tc_mesh *mesh;
    tc_transfer *tf;
    tc_camera camera;
    tc_render_options options;
} scene;

static int set_up(void **state)
{
    scene *s = calloc(1, sizeof *s);
    assert_non_null(s);
    *state = s;
    s->mesh = suite_synth("heatsink", 3000, TC_REENTRY_PEEL);
    s->tf = suite_benchmark(s->mesh);
    s->camera = suite_camera(s->mesh, 0.4, 0.5, 1, false);
    s->options = suite_options(SIZE, SIZE);
    return 0;
}

static int tear_down(void **state)
{
    scene *s = *state;
    tc_transfer_destroy(&s->tf);
    tc_mesh_destroy(&s->mesh);
    free(s);
    return 0;
}

static tc_image *render(const scene *s, tc_renderer *renderer)
{
    return suite_render_by(NULL, renderer, s->mesh, s->tf, &s->camera, &s->options);
}

static void destroying_a_renderer_breaks_another(void **state)
{
    const scene *s = *state;
    tc_image *before = suite_render(NULL, s->mesh, s->tf, &s->camera, &s->options);
    tc_renderer *a = suite_renderer(NULL), *b = suite_renderer(NULL);
    tc_image *in_a = render(s, a), *in_b = render(s, b);
    assert_true(suite_difference(before, in_a) <= 0 && suite_difference(before, in_b) <= 0);
    tc_image_destroy(&in_a);
    tc_image_destroy(&in_b);
    tc_renderer_destroy(&a); /* the older one */
    in_b = render(s, b);
    assert_true(suite_difference(before, in_b) <= 0);
    tc_image_destroy(&in_b);
    a = suite_renderer(NULL);
    tc_renderer_destroy(&a); /* a newer one that never rendered */
    in_b = render(s, b);
    assert_true(suite_difference(before, in_b) <= 0);
    tc_image_destroy(&in_b);
    tc_renderer_destroy(&b);
    tc_image *after = suite_render(NULL, s->mesh, s->tf, &s->camera, &s->options); /* the suite's own */
    assert_true(suite_difference(before, after) <= 0);
    tc_image_destroy(&after);
    tc_image_destroy(&before);
}

/* What is said from another thread than that of main. */
typedef struct talk {
    pthread_t thread;
    int lines, elsewhere;
} talk;

static void hear(void *user, tc_level level, const char *text)
{
    talk *t = user;
    (void)level;
    t->lines += text[0] != 0;
    t->elsewhere += !pthread_equal(t->thread, pthread_self());
}

static void a_renderer_made_on_a_thread_of_its_own_draws_otherwise(void **state)
{
    const scene *s = *state;
    const bool compute = strstr(suite_backend(), "-compute") != NULL;
    const tc_renderer_options options = {.gl = suite_is_gpu() ? suite_context() : NULL,
                                         .driver = compute          ? "compute"
                                                   : suite_is_gpu() ? "pingpong"
                                                                    : "reference"};
    talk heard = {.thread = pthread_self()};
    const tc_log log = {.message = hear, .user = &heard};
    tc_renderer_start *start = NULL, *unwanted = NULL;
    tc_renderer *renderer = NULL;
    tc_error err = {0};
    assert_int_equal(tc_renderer_begin(&start, &options, &err), TC_OK);
    tc_image *before = suite_render(NULL, s->mesh, s->tf, &s->camera, &s->options); /* meanwhile */
    if (tc_renderer_end(&renderer, &start, &log, &err) != TC_OK)
        fail_msg("%s", err.text);
    assert_null(start);
    assert_int_equal(heard.elsewhere, 0);
    assert_int_equal(heard.lines > 0, suite_is_gpu()); /* which context it is */
    for (int i = 0; i < 2; i++) {
        tc_image *image = render(s, renderer);
        assert_true(suite_difference(before, image) <= 0);
        tc_image_destroy(&image);
    }
    assert_int_equal(tc_renderer_begin(&unwanted, &options, &err), TC_OK);
    assert_int_equal(tc_renderer_end(NULL, &unwanted, NULL, &err), TC_OK);
    assert_null(unwanted);
    tc_image *after = render(s, renderer);
    assert_true(suite_difference(before, after) <= 0);
    tc_image_destroy(&after);
    tc_image_destroy(&before);
    tc_renderer_destroy(&renderer);

    const tc_renderer_options wrong = {.gl = "osmosa", .driver = "pingpong"};
    assert_int_equal(tc_renderer_begin(&start, &wrong, &err), TC_OK);
    assert_int_equal(tc_renderer_end(&renderer, &start, NULL, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "osmosa"));
    assert_null(renderer);
}

/* A texel a cell. */
static void a_mesh_at_the_limit_of_texels_looks_different(void **state)
{
    (void)state;
    if (!suite_is_gpu())
        skip();
    scene s = {.mesh = suite_synth("heatsink", 20000, TC_REENTRY_CONVEXIFY)};
    tc_mesh_report report;
    tc_mesh_get_report(&report, s.mesh);
    s.tf = suite_benchmark(s.mesh);
    s.camera = suite_camera(s.mesh, 0.4, 0.5, 1, false);
    s.options = suite_options(SIZE, SIZE);
    tc_image *before = suite_render(NULL, s.mesh, s.tf, &s.camera, &s.options);
    const size_t n_cell = report.n_tet + report.n_imaginary;
    char texels[32];
    snprintf(texels, sizeof texels, "%zu", n_cell);
    assert_int_equal(setenv("TETCAST_GL_TEXELS", texels, 1), 0);
    tc_renderer *renderer = suite_renderer(NULL);
    tc_image *image = render(&s, renderer);
    assert_memory_equal(image->rgba, before->rgba, (size_t)SIZE * SIZE * 4 * sizeof(float));
    tc_image_destroy(&image);
    tc_renderer_destroy(&renderer);
    snprintf(texels, sizeof texels, "%zu", n_cell - 1);
    assert_int_equal(setenv("TETCAST_GL_TEXELS", texels, 1), 0);
    renderer = suite_renderer(NULL);
    tc_error err = {0};
    tc_image *none = NULL;
    assert_int_equal(tc_render(&none, NULL, renderer, s.mesh, s.tf, &s.camera, &s.options, NULL, &err), TC_E_MEMORY);
    assert_non_null(strstr(err.text, "use a smaller mesh"));
    unsetenv("TETCAST_GL_TEXELS");
    tc_renderer_destroy(&renderer);
    tc_image_destroy(&before);
    tc_transfer_destroy(&s.tf);
    tc_mesh_destroy(&s.mesh);
}

static void asking_for_the_back_ends_breaks_a_renderer(void **state)
{
    const scene *s = *state;
    tc_image *before = suite_render(NULL, s->mesh, s->tf, &s->camera, &s->options);
    tc_backend_info info[16];
    size_t n = 0;
    bool found = false;
    assert_int_equal(tc_backends(info, 16, &n, NULL), TC_OK);
    for (size_t i = 0; i < n; i++)
        found = found || (info[i].works && strcmp(info[i].name, suite_context()) == 0);
    assert_true(found);
    tc_image *after = suite_render(NULL, s->mesh, s->tf, &s->camera, &s->options);
    assert_true(suite_difference(before, after) <= 0);
    tc_image_destroy(&after);
    tc_image_destroy(&before);
}

/* Renders with options that are wrong: TC_E_ARG, no picture, and a sentence with each word in it. */
static void expect_refusal(const scene *s, tc_renderer *renderer, const tc_render_options *options,
                           const char *const words[3])
{
    tc_image *image = NULL;
    tc_error err = {0};
    assert_int_equal(tc_render(&image, NULL, renderer, s->mesh, s->tf, &s->camera, options, NULL, &err), TC_E_ARG);
    assert_null(image);
    for (int i = 0; i < 3; i++)
        if (!strstr(err.text, words[i]))
            fail_msg("no word of '%s': %s", words[i], err.text);
}

static void an_unknown_integrator_is_taken(void **state)
{
    const scene *s = *state;
    tc_renderer *renderer = suite_renderer(NULL);
    tc_render_options options = s->options;
    options.integrator = (tc_integrator)4;
    expect_refusal(s, renderer, &options, (const char *const[]){"integrator 4", "3 (exact)", "2 (integral)"});
    options.integrator = (tc_integrator)-1;
    expect_refusal(s, renderer, &options, (const char *const[]){"integrator -1", "0 (auto)", "2 (integral)"});
    tc_renderer_destroy(&renderer);
}

static void an_unknown_table_format_is_taken(void **state)
{
    const scene *s = *state;
    tc_renderer *renderer = suite_renderer(NULL);
    tc_render_options options = s->options;
    options.integrator = TC_INTEGRATOR_TABLE;
    options.table_format = (tc_table_format)24;
    expect_refusal(s, renderer, &options, (const char *const[]){"table format 24", "16", "32"});
    options.table_format = (tc_table_format)-8;
    expect_refusal(s, renderer, &options, (const char *const[]){"table format -8", "0 (auto)", "16"});
    tc_renderer_destroy(&renderer);
}

static void a_z_update_interval_out_of_range_is_taken(void **state)
{
    static const int wrong[] = {-2, -2147483647 - 1, 65537, 2147483647}, right[] = {-1, 0, 1, 3, 65536};
    const scene *s = *state;
    tc_renderer *renderer = suite_renderer(NULL);
    tc_render_options options = s->options;
    for (int i = 0; i < 4; i++) {
        options.z_update_every = wrong[i];
        expect_refusal(s, renderer, &options, (const char *const[]){"z-updates", "65536", "-1 (never)"});
    }
    for (int i = 0; i < 5; i++) {
        tc_image *image = NULL;
        tc_render_stats stats;
        options.z_update_every = right[i];
        if (suite_locks() && right[i] == 65536)
            continue; /* that many passes would be made; the other drivers try it, by the same check */
        assert_int_equal(tc_render(&image, &stats, renderer, s->mesh, s->tf, &s->camera, &options, NULL, NULL), TC_OK);
        if (suite_locks() && right[i] != 0)
            assert_int_equal(stats.z_update_every, right[i] < 0 ? -1 : (right[i] + 1) / 2 * 2);
        tc_image_destroy(&image);
    }
    tc_renderer_destroy(&renderer);
}

/* Its sentence comes from tc_look_wrong, before any driver; the judge of pictures asks it, too. */
static void a_look_that_cannot_be_shown_is_taken(void **state)
{
    static const tc_iso twice[2] = {{.value = 0.5, .opacity = 1}, {.value = 0.5, .opacity = 1}};
    const scene *s = *state;
    tc_renderer *renderer = suite_renderer(NULL);
    tc_render_options options = s->options;
    tc_look look = {.n_iso = 2, .iso = twice};
    options.look = &look;
    expect_refusal(s, renderer, &options, (const char *const[]){"two isosurfaces", "0.5", "leave one"});
    tc_image *image = NULL;
    tc_verify_result result;
    tc_error err = {0};
    assert_int_equal(tc_image_create(&image, options.width, options.height, NULL), TC_OK);
    assert_int_equal(tc_verify(&result, image, 10, 1, s->mesh, s->tf, &s->camera, &options, NULL, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "two isosurfaces"));
    tc_image_destroy(&image);
    look = (tc_look){.color_function = s->tf};
    expect_refusal(s, renderer, &options, (const char *const[]){"function", "no field", "both or neither"});
    tc_renderer_destroy(&renderer);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(destroying_a_renderer_breaks_another),
        cmocka_unit_test(a_renderer_made_on_a_thread_of_its_own_draws_otherwise),
        cmocka_unit_test(a_mesh_at_the_limit_of_texels_looks_different),
        cmocka_unit_test(asking_for_the_back_ends_breaks_a_renderer),
        cmocka_unit_test(an_unknown_integrator_is_taken),
        cmocka_unit_test(an_unknown_table_format_is_taken),
        cmocka_unit_test(a_z_update_interval_out_of_range_is_taken),
        cmocka_unit_test(a_look_that_cannot_be_shown_is_taken),
    };
    if (!suite_begin(argc, argv))
        return SUITE_SKIPPED;
    int failed = cmocka_run_group_tests(tests, set_up, tear_down);
    suite_end();
    return failed;
}
