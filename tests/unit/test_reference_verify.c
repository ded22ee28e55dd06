/* test_reference_verify.c: rendering whole images, and the judgement of a picture by sampled pixels. */
#include "reference_scene.h"

#include <float.h>

enum { W = 24, H = 16 };

/* The cube, denser and redder upwards, seen from +z. */
static void scene_init(scene *s, bool parallel, double zoom)
{
    scene_of(s, &(scene_choice){.width = W,
                                .height = H,
                                .cells = 3,
                                .gradient = {0, 1, 0},
                                .knot = {{0, 0, 0, 1, 0.5}, {1, 1, 0, 0, 3}},
                                .front = {0, 0, 1},
                                .parallel = parallel,
                                .zoom = zoom});
}

static void picture_is_upside_down_or_off_by_a_pixel(void **state)
{
    (void)state;
    for (int parallel = 0; parallel < 2; parallel++) {
        scene s;
        scene_init(&s, parallel, 1);
        scene_draw(&s, 2);
        size_t covered = 0;
        for (int y = 0; y < H; y++)
            for (int x = 0; x < W; x++) {
                double o[3], d[3];
                tc_rays_pixel(o, d, &s.rays, x + 0.5, H - y - 0.5);
                tc_reference_ray ray = trace(s.reference, &s.tf, o, d, parallel ? -1 : 0); /* the cube's middle: 0 */
                const float *pixel = &s.pixels[4 * (y * W + x)];
                for (int i = 0; i < 4; i++)
                    NEAR(pixel[i], ray.rgba[i], 6e-8);
                double chord = box_chord(o, d, 1, -INFINITY);
                assert_true((pixel[3] > 0) == (chord > 0));
                covered += pixel[3] > 0;
            }
        assert_true(covered > W * H / 8);
        const float *upper = &s.pixels[4 * (5 * W + W / 2)], *lower = &s.pixels[4 * (10 * W + W / 2)];
        assert_true(upper[3] > lower[3] && upper[0] > lower[0] && upper[2] < lower[2]);
        scene_finish(&s);
    }
}

static void threads_change_the_picture(void **state)
{
    (void)state;
    scene s;
    float one[W * H * 4];
    scene_init(&s, false, 1.3);
    scene_draw(&s, 1);
    memcpy(one, s.pixels, sizeof one);
    memset(s.pixels, 0x7f, sizeof one);
    scene_draw(&s, 5);
    assert_memory_equal(one, s.pixels, sizeof one);
    scene_finish(&s);
}

static void own_picture_is_found_wrong(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, false, 1);
    scene_draw(&s, 1);
    tc_verify_result v = scene_verify(&s, 1000000, 1, 2);
    assert_int_equal(v.pixels, W * H);
    assert_int_equal(v.ill_posed, 0);
    assert_true(v.max_abs_error < 6e-8 && v.max_abs_error > 0);
    assert_true(v.mean_abs_error <= v.p999_abs_error && v.p999_abs_error <= v.max_abs_error);
    assert_int_equal(v.rays_lost, 0);
    v = scene_verify(&s, 100, 1, 2);
    assert_int_equal(v.pixels, 100);
    v = scene_verify(&s, 0, 1, 2);
    assert_int_equal(v.pixels, 0);
    NEAR(v.max_abs_error, 0, 0);
    scene_finish(&s);
}

static void wrong_pixel_is_not_found_or_misplaced(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, false, 1);
    scene_draw(&s, 1);
    s.pixels[4 * (6 * W + 11) + 2] += 0.125f; /* well inside */
    s.pixels[4 * (9 * W + 13) + 3] -= 0.0625f;
    tc_verify_result v = scene_verify(&s, W * H, 7, 1);
    NEAR(v.max_abs_error, 0.125, 1e-6);
    assert_int_equal(v.worst_x, 11);
    assert_int_equal(v.worst_y, 6);
    assert_int_equal(v.ill_posed, 0);
    NEAR(v.mean_abs_error, 0.1875 / (W * H * 4), 1e-7);
    /* 1536 channels: 0.1 % is one of them; the second worst is left. */
    NEAR(v.p999_abs_error, 0.0625, 1e-6);
    scene_finish(&s);
}

static void sample_repeats_or_favours_pixels(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, false, 1);
    scene_draw(&s, 1);
    for (int k = 0; k < W * H; k++)
        s.pixels[4 * k] += 0.25f; /* all wrong alike: mean, p999 and max say how many were looked at */
    tc_verify_result v = scene_verify(&s, 100, 3, 1);
    NEAR(v.mean_abs_error, 0.0625, 1e-6);
    NEAR(v.p999_abs_error, 0.25, 1e-6);
    scene_draw(&s, 1);
    /* One wrong pixel: found in all seeds by all pixels but one, save where that is the one; in half by half. */
    s.pixels[4 * (6 * W + 11)] += 0.25f;
    int most = 0, half = 0;
    for (uint64_t seed = 0; seed < 400; seed++) {
        most += scene_verify(&s, W * H - 1, seed, 1).max_abs_error > 0.2;
        half += scene_verify(&s, W * H / 2, seed, 1).max_abs_error > 0.2;
    }
    assert_true(most >= 390);
    assert_true(half > 150 && half < 250); /* five standard deviations */
    /* The same seed sees the same pixels, on any number of threads. */
    tc_verify_result a = scene_verify(&s, 50, 9, 1), b = scene_verify(&s, 50, 9, 4), c = scene_verify(&s, 50, 10, 4);
    assert_memory_equal(&a, &b, sizeof a);
    assert_true(a.mean_abs_error != c.mean_abs_error);
    scene_finish(&s);
}

/* Parallel rays in the plane of a side: in or out is a matter of the last bit. */
static void ray_in_a_side_counts_as_an_error(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, true, 1);
    s.rays.origin[0] = -0.5 / 8, s.rays.origin[1] = -0.5, s.rays.origin[2] = 2;
    for (int i = 0; i < 3; i++)
        s.rays.origin_dx[i] = i == 0 ? 1.0 / 8 : 0, s.rays.origin_dy[i] = i == 1 ? 2.0 / H : 0;
    scene_draw(&s, 1);
    /* Columns 0 and 8 lie in the sides x = 0 and x = 1: give them what their other side has. */
    size_t wrong = 0;
    for (int y = 0; y < H; y++)
        for (int side = 0; side < 2; side++) {
            float *pixel = &s.pixels[4 * (y * W + 8 * side)], *inner = &s.pixels[4 * (y * W + 4)];
            bool was_in = pixel[3] > 0;
            for (int i = 0; i < 4; i++)
                pixel[i] = was_in ? 0 : inner[i];
            wrong += inner[3] > 0;
        }
    assert_true(wrong >= H / 2);
    tc_verify_result v = scene_verify(&s, W * H, 1, 2);
    assert_int_equal(v.ill_posed, wrong);
    assert_true(v.max_abs_error < 1e-6);
    assert_true(v.worst_error_ill_posed > 0.3);
    /* A wrong pixel inside is an error all the same. */
    s.pixels[4 * (8 * W + 4)] += 0.01f;
    v = scene_verify(&s, W * H, 1, 2);
    NEAR(v.max_abs_error, 0.01, 1e-6);
    assert_int_equal(v.ill_posed, wrong);
    scene_finish(&s);
}

/* A ray that passes beside an edge that is parallel to it: it stays outside, or in a quarter of the cases inside, when
 * it moves to one of four sides; only a move to a corner tells. */
static void ray_at_a_corner_counts_as_an_error(void **state)
{
    (void)state;
    static const double beside[4][2] = {{1 + 1e-8, 1 + 1e-8}, {-1e-8, 1 + 1e-8}, {1 + 1e-8, -1e-8}, {-1e-8, -1e-8}};
    for (int corner = 0; corner < 4; corner++) {
        scene s;
        scene_init(&s, true, 1);
        s.rays.origin[0] = beside[corner][0] - 0.5 / 8, s.rays.origin[1] = beside[corner][1] - 0.5 / 8;
        for (int i = 0; i < 3; i++)
            s.rays.origin_dx[i] = i == 0 ? 1.0 / 8 : 0, s.rays.origin_dy[i] = i == 1 ? 1.0 / 8 : 0;
        scene_draw(&s, 1);
        float *pixel = &s.pixels[4 * ((H - 1) * W)]; /* bottom left */
        NEAR(pixel[3], 0, 0);
        pixel[3] = 0.5f;
        tc_verify_result v = scene_verify(&s, W * H, 1, 1);
        assert_int_equal(v.ill_posed, 1);
        NEAR(v.worst_error_ill_posed, 0.5, 1e-6);
        assert_true(v.max_abs_error < 1e-6);
        scene_finish(&s);
    }
}

/* A ray in a side of one cell, and inside another by less than any shift: moved to either side it is in one of the two,
 * and shows the same; where it is it may be in both. */
static void ray_in_the_side_of_one_of_two_cells_counts_as_an_error(void **state)
{
    (void)state;
    for (int turned = 0; turned < 2; turned++) {
        double up = turned ? -1 : 1, e = up * 1e-16;
        const double vertex[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, up, 0},
                                     {0, e, 2}, {1, e, 2}, {0, e, 3}, {0, -up, 2}};
        struct tc_mesh mesh = mesh_alloc(8, 2);
        memcpy(mesh.vertex, vertex, sizeof vertex);
        for (int i = 0; i < 8; i++)
            mesh.tet[i] = i;
        tc_reference *reference = reference_of(&mesh);
        tc_knot knot = {0, 1, 1, 1, 1};
        struct tc_transfer tf = {.n = 1, .knot = &knot};
        tc_rays rays = {.parallel = true, .width = 1, .height = 1, .origin = {0.2, 0, -1}, .direction = {0, 0, 1}};
        rays.axis[2] = 1;
        rays.far = INFINITY;
        for (int cells = 1; cells <= 2; cells++) {
            float alpha = (float)-expm1(-0.8 * cells), pixel[4] = {alpha, alpha, alpha, alpha};
            tc_image image = {1, 1, pixel};
            tc_verify_result v;
            tc_error err;
            if (tc_reference_verify(&v, NULL, &image, 1, 1, reference, &tf, 1, &rays, 1, NULL, &err) != TC_OK)
                fail_msg("%s", err.text);
            assert_true(v.max_abs_error < 1e-6);
        }
        tc_reference_destroy(&reference);
        mesh_free(&mesh);
    }
}

/* A plate of 1e-5 of its width, opaque within a tenth of that: how thick it is, is rounded away in float. */
static void thickness_of_a_plate_counts_as_an_error(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, true, 1);
    for (size_t i = 0; i < s.mesh.n_vertex; i++)
        s.mesh.vertex[3 * i + 2] *= 1e-5;
    tc_reference_destroy(&s.reference);
    s.reference = reference_of(&s.mesh);
    tc_knot knot[3] = {{0, 1, 1, 1, 0}, {0.9, 1, 1, 1, 0}, {1, 1, 1, 1, 2e5}};
    s.tf.n = 3, s.tf.knot = knot;
    scene_draw(&s, 1);
    for (int k = 0; k < 4 * W * H; k++)
        s.pixels[k] *= 1.005f;
    tc_verify_result v = scene_verify(&s, W * H, 1, 1);
    assert_true(v.worst_error_ill_posed > 2e-3);
    assert_true(v.max_abs_error < 1.0 / 510);
    scene_finish(&s);
}

/* A cell value that lies on a step of the function: the data decide, not the ray. */
static void value_on_a_step_counts_as_an_error(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, false, 2.5);
    double *points = s.mesh.scalar, *cells = calloc(s.mesh.n_tet, sizeof *cells);
    assert_non_null(cells);
    cells[0] = 1; /* the range is 0 to 1 */
    for (size_t i = 1; i < s.mesh.n_tet; i++)
        cells[i] = i == 1 ? 0 : 0.5;
    s.mesh.scalar = cells, s.mesh.association = TC_CELL_DATA;
    tc_knot step[4] = {{0, 1, 1, 1, 1}, {0.5, 1, 1, 1, 1}, {0.5, 1, 1, 1, 4}, {1, 1, 1, 1, 4}};
    s.tf.n = 4, s.tf.knot = step;
    scene_draw(&s, 1);
    for (int k = 0; k < W * H; k++)
        if (s.pixels[4 * k + 3] > 0)
            for (int i = 0; i < 4; i++)
                s.pixels[4 * k + i] *= 0.8f;
    tc_verify_result v = scene_verify(&s, W * H, 1, 1);
    assert_true(v.ill_posed > W * H / 2);
    assert_true(v.worst_error_ill_posed > 0.1);
    s.mesh.scalar = points, s.mesh.association = TC_POINT_DATA;
    free(cells);
    scene_finish(&s);
}

static void nan_in_the_picture_passes(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, false, 1);
    scene_draw(&s, 1);
    s.pixels[4 * (3 * W + 2) + 1] = NAN;
    tc_verify_result v = scene_verify(&s, W * H, 1, 1);
    NEAR(v.max_abs_error, FLT_MAX, 0);
    assert_int_equal(v.worst_x, 2);
    assert_int_equal(v.worst_y, 3);
    s.pixels[4 * (3 * W + 2) + 1] = -INFINITY;
    NEAR(scene_verify(&s, W * H, 1, 1).max_abs_error, FLT_MAX, 0);
    scene_finish(&s);
}

static void bad_arguments_are_accepted(void **state)
{
    (void)state;
    scene s;
    tc_error err;
    tc_verify_result v;
    scene_init(&s, false, 1);
    tc_image other = {W, H - 1, s.pixels};
    assert_int_equal(tc_reference_render(&other, s.reference, &s.tf, 1, &s.rays, 1, NULL, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "24 x 15"));
    assert_int_equal(tc_reference_verify(&v, NULL, &other, 1, 0, s.reference, &s.tf, 1, &s.rays, 1, NULL, &err),
                     TC_E_ARG);
    assert_int_equal(tc_reference_render(&s.image, s.reference, &s.tf, 0, &s.rays, 1, NULL, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "unit distance 0"));
    assert_int_equal(tc_reference_verify(&v, NULL, &s.image, 1, 0, s.reference, &s.tf, NAN, &s.rays, 1, NULL, &err),
                     TC_E_ARG);
    tc_reference_ray ray;
    const double o[3] = {0, 0, 3}, d[3] = {0, 0, -1};
    const double ahead[2] = {0, INFINITY};
    assert_int_equal(tc_reference_trace(&ray, s.reference, &s.tf, 1, o, d, ahead, -1), TC_E_ARG);
    assert_int_equal(tc_reference_trace(&ray, s.reference, &s.tf, 1, o, d, ahead, 256), TC_E_ARG);
    tc_reference *none;
    assert_int_equal(tc_reference_create(&none, NULL, 1, &err), TC_E_ARG);
    assert_null(none);
    scene_finish(&s);
}

typedef struct talk {
    double last;
    int calls;
} talk;

static void note(void *user, const char *what, double fraction)
{
    talk *t = user;
    assert_non_null(what);
    assert_true(fraction >= t->last && fraction <= 1);
    t->last = fraction;
    t->calls++;
}

static void progress_runs_backwards_or_is_silent(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, false, 1);
    talk t = {0, 0};
    tc_log log = {.progress = note, .user = &t};
    assert_int_equal(tc_reference_render(&s.image, s.reference, &s.tf, 1, &s.rays, 1, &log, NULL), TC_OK);
    assert_true(t.calls >= H);
    NEAR(t.last, 1, 0);
    t = (talk){0, 0};
    tc_verify_result v;
    assert_int_equal(tc_reference_verify(&v, NULL, &s.image, W * H, 1, s.reference, &s.tf, 1, &s.rays, 1, &log, NULL),
                     TC_OK);
    assert_true(t.calls > 1);
    NEAR(t.last, 1, 0);
    scene_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(picture_is_upside_down_or_off_by_a_pixel),
        cmocka_unit_test(threads_change_the_picture),
        cmocka_unit_test(own_picture_is_found_wrong),
        cmocka_unit_test(wrong_pixel_is_not_found_or_misplaced),
        cmocka_unit_test(sample_repeats_or_favours_pixels),
        cmocka_unit_test(ray_in_a_side_counts_as_an_error),
        cmocka_unit_test(ray_at_a_corner_counts_as_an_error),
        cmocka_unit_test(ray_in_the_side_of_one_of_two_cells_counts_as_an_error),
        cmocka_unit_test(thickness_of_a_plate_counts_as_an_error),
        cmocka_unit_test(value_on_a_step_counts_as_an_error),
        cmocka_unit_test(nan_in_the_picture_passes),
        cmocka_unit_test(bad_arguments_are_accepted),
        cmocka_unit_test(progress_runs_backwards_or_is_silent),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
