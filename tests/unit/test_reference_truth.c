/* test_reference_truth.c: colours traced once for many pictures, and what a sample says of the pixels not drawn. */
#include "reference_scene.h"

#include "reference/truth.h"

#include <float.h>
#include <stdio.h>

enum { W = 40, H = 30, N = W * H };

static void scene_init(scene *s, bool parallel)
{
    scene_of(s, &(scene_choice){.width = W,
                                .height = H,
                                .cells = 2,
                                .gradient = {0.2, 0.3, 0.5},
                                .knot = {{0, 0, 0, 1, 0.5}, {1, 1, 0.2, 0, 3}},
                                .front = {0.3, 0.2, 1},
                                .parallel = parallel,
                                .zoom = 1});
}

/* The image that the truth of all pixels holds. */
static void draw(scene *s)
{
    tc_reference_set_samples(s->reference, 1);
    scene_draw(s, 1);
}

/* Parallel rays along z; columns 0 and 8 lie in the sides x = 0 and x = 1, where a row has them at all. */
static void rays_in_sides(scene *s)
{
    s->rays.origin[0] = -0.5 / 8, s->rays.origin[1] = -0.5, s->rays.origin[2] = 2;
    for (int i = 0; i < 3; i++) {
        s->rays.origin_dx[i] = i == 0 ? 1.0 / 8 : 0, s->rays.origin_dy[i] = i == 1 ? 2.0 / H : 0;
        s->rays.direction[i] = s->rays.axis[i] = i == 2 ? -1 : 0;
    }
    s->rays.near = 0, s->rays.far = INFINITY;
    s->rays.eye[0] = s->rays.eye[1] = 0, s->rays.eye[2] = 2;
}

static tc_truth *truth_of(const scene *s, size_t n, uint64_t seed, int samples)
{
    tc_truth *truth;
    tc_error err;
    const tc_truth_view view = {.reference = s->reference,
                                .tf = &s->tf,
                                .unit = 1,
                                .rays = &s->rays,
                                .n = n,
                                .seed = seed,
                                .samples = samples,
                                .threads = 1};
    if (tc_truth_create(&truth, &view, &err) != TC_OK)
        fail_msg("%s", err.text);
    return truth;
}

static tc_verify_result compare(tc_truth *truth, tc_image *errors, const tc_image *image)
{
    tc_verify_result v;
    tc_error err;
    memset(&v, 0x55, sizeof v);
    if (tc_truth_compare(&v, errors, truth, image, &err) != TC_OK)
        fail_msg("%s", err.text);
    return v;
}

static tc_verify_result verify(const scene *s, size_t n, uint64_t seed)
{
    return scene_verify(s, n, seed, 1);
}

/* One truth and many pictures, among them such that err at ill-posed rays now and then. */
static void second_picture_is_judged_otherwise_than_a_first(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, true);
    rays_in_sides(&s);
    draw(&s);
    float right[N * 4];
    memcpy(right, s.pixels, sizeof right);
    tc_truth *all = truth_of(&s, N, 1, 1), *some = truth_of(&s, 300, 5, 0);
    size_t ill_posed = 0, well_posed = 0;
    for (int picture = 0; picture < 12; picture++) {
        uint64_t random = (uint64_t)picture + 1;
        memcpy(s.pixels, right, sizeof right);
        for (int y = 0; y < H; y++)
            for (int x = 0; x <= 8; x += 8) /* rays in sides: wrong by little, by much, or right */
                for (int i = 0; i < 4; i++)
                    s.pixels[4 * (y * W + x) + i] += (float)(random_bits(&random) % 3) * 9e-4f;
        for (int k = 0; k < picture; k++)
            s.pixels[random_bits(&random) % (4 * N)] += (float)uniform(&random, -0.01, 0.01);
        tc_verify_result a = compare(all, NULL, &s.image), b = verify(&s, N, 1);
        assert_memory_equal(&a, &b, sizeof a);
        assert_int_equal(a.n_all, N);
        NEAR(a.unseen_share, 0, 0);
        ill_posed += a.ill_posed;
        well_posed += a.max_abs_error > 1.0 / 1020;
        a = compare(some, NULL, &s.image), b = verify(&s, 300, 5);
        assert_memory_equal(&a, &b, sizeof a);
        assert_true(a.unseen_share > 0.005 && a.unseen_share < 0.02);
    }
    assert_true(ill_posed > 20 && ill_posed < 12 * 2 * H);
    assert_true(well_posed > 3);
    tc_truth_destroy(&all);
    tc_truth_destroy(&some);
    assert_null(some);
    tc_truth_destroy(&some);
    scene_finish(&s);
}

static void color_is_not_the_mean_over_the_grid(void **state)
{
    (void)state;
    static const int samples[] = {1, 4, 9, 16, 64, TC_SAMPLES_ADAPTIVE};
    for (int parallel = 0; parallel < 2; parallel++) {
        scene s;
        scene_init(&s, parallel);
        for (size_t c = 0; c < sizeof samples / sizeof *samples; c++) {
            tc_truth *truth = truth_of(&s, 25, 3, samples[c]);
            assert_int_equal(tc_truth_count(truth), 25);
            int rays = samples[c] < 0 ? 16 : samples[c], edge = (int)lround(sqrt(rays));
            double most = 0;
            for (size_t k = 0; k < 25; k++) {
                uint32_t at = tc_truth_pixels(truth)[k];
                assert_true(at < N && (k == 0 || at > tc_truth_pixels(truth)[k - 1]));
                double sum[4] = {0};
                for (int i = 0; i < rays; i++) {
                    double o[3], d[3], range[2], X = at % W + (i % edge + 0.5) / edge,
                                                 Y = H - 1.0 - at / W + (i / edge + 0.5) / edge;
                    tc_reference_ray ray;
                    tc_rays_pixel(o, d, &s.rays, X, Y);
                    tc_rays_range(range, &s.rays, X, Y);
                    assert_int_equal(tc_reference_trace(&ray, s.reference, &s.tf, 1, o, d, range, 0), TC_OK);
                    for (int j = 0; j < 4; j++)
                        sum[j] += ray.rgba[j] / rays;
                }
                for (int j = 0; j < 4; j++)
                    NEAR(tc_truth_color(truth, k)[j], sum[j], 1e-13);
                most = fmax(most, sum[3]);
            }
            assert_true(most > 0.1);
            tc_truth_destroy(&truth);
        }
        /* What the caster draws with several rays is right by its truth, and not by that of one. */
        for (int rays = 4; rays <= 16; rays *= 4) {
            draw(&s);
            assert_true(verify(&s, N, 1).max_abs_error < 6e-8);
            tc_reference_set_samples(s.reference, rays);
            assert_true(verify(&s, N, 1).max_abs_error > 0.01);
            scene_draw(&s, 1);
            tc_verify_result v = verify(&s, N, 1);
            assert_true(v.max_abs_error < 6e-8 && v.ill_posed == 0);
        }
        scene_finish(&s);
    }
}

/* Of four rays of a pixel two lie in a side: half of the colour hangs on rounding. */
static void pixel_with_ill_posed_rays_counts_as_an_error(void **state)
{
    (void)state;
    scene s;
    scene_init(&s, true);
    rays_in_sides(&s);
    s.rays.origin[0] = -0.75 / 8; /* the first of two columns of rays in pixel 0 has X = 0.25, pixel 8's X = 8.25 */
    for (int i = 0; i < 2; i++)
        s.rays.origin[i] += i == 0 ? 0.5 / 8 : 0; /* x = (X - 0.25) / 8 */
    tc_reference_set_samples(s.reference, 4);
    scene_draw(&s, 1);
    size_t wrong = 0;
    for (int y = 0; y < H; y++)
        for (int x = 0; x <= 8; x += 8) {
            float *pixel = &s.pixels[4 * (y * W + x)];
            bool inside = s.pixels[4 * (y * W + 4) + 3] > 0;
            wrong += inside;
            for (int i = 0; i < 4 && inside; i++)
                pixel[i] += 0.01f;
        }
    assert_true(wrong > H / 2);
    tc_verify_result v = verify(&s, N, 1);
    assert_int_equal(v.ill_posed, wrong);
    assert_true(v.max_abs_error < 1e-6);
    NEAR(v.worst_error_ill_posed, 0.01, 1e-6);
    /* Where nobody asks, they count. */
    tc_truth *truth;
    const tc_truth_view view = {
        .reference = s.reference, .tf = &s.tf, .unit = 1, .rays = &s.rays, .n = N, .samples = 4, .no_judge = true};
    assert_int_equal(tc_truth_create(&truth, &view, NULL), TC_OK);
    v = compare(truth, NULL, &s.image);
    assert_int_equal(v.ill_posed, 0);
    NEAR(v.max_abs_error, 0.01, 1e-6);
    tc_truth_destroy(&truth);
    /* Errors that are too small to be asked about are, where it is doubted that they are errors. */
    for (int k = 0; k < 4 * N; k++) /* the colours that were found, and 4e-4 more */
        if (k / 4 % W == 0 || k / 4 % W == 8)
            s.pixels[k] -= s.pixels[4 * (k / 4 / W * W + 4) + 3] > 0 ? 0.0096f : 0;
    for (int doubted = 0; doubted < 2; doubted++) {
        const tc_truth_view small = {.reference = s.reference,
                                     .tf = &s.tf,
                                     .unit = 1,
                                     .rays = &s.rays,
                                     .n = N,
                                     .samples = 4,
                                     .doubt = doubted ? 1e-4 : 0};
        assert_int_equal(tc_truth_create(&truth, &small, NULL), TC_OK);
        v = compare(truth, NULL, &s.image);
        assert_int_equal(v.ill_posed, doubted ? wrong : 0);
        NEAR(doubted ? v.worst_error_ill_posed : v.max_abs_error, 4e-4, 3e-6);
        tc_truth_destroy(&truth);
    }
    scene_finish(&s);
}

static void error_image_shows_other_errors(void **state)
{
    (void)state;
    scene s;
    float shown[N * 4];
    tc_image errors = {W, H, shown};
    scene_init(&s, true);
    rays_in_sides(&s);
    draw(&s);
    for (int i = 0; i < 4; i++)
        s.pixels[4 * (15 * W + 8) + i] += 0.25f; /* in a side */
    s.pixels[4 * (15 * W + 4) + 1] -= 0.125f;    /* green */
    s.pixels[4 * (16 * W + 5) + 3] += 0.0625f;   /* alpha */
    s.pixels[4 * (17 * W + 5) + 2] = NAN;
    for (size_t n = 700; n <= N; n += 500) {
        memset(shown, 0x55, sizeof shown);
        tc_truth *truth = truth_of(&s, n, 8, 1);
        tc_verify_result v = compare(truth, &errors, &s.image);
        size_t looked = 0, ill_posed = 0;
        double worst = 0;
        for (size_t k = 0; k < N; k++) {
            const float *p = &shown[4 * k];
            if (p[3] == 1)
                worst = fmax(worst, fmax(fmax((double)p[0], (double)p[1]), (double)p[2]));
            if (p[3] == 0)
                assert_true(p[0] == 0 && p[1] == 0 && p[2] == 0);
            assert_true(p[3] == 0 || p[3] == 0.5f || p[3] == 1);
            looked += p[3] > 0;
            ill_posed += p[3] == 0.5f;
        }
        assert_int_equal(looked, v.pixels);
        assert_int_equal(ill_posed, v.ill_posed);
        NEAR(worst, v.max_abs_error, 1e-7 * v.max_abs_error);
        tc_truth_destroy(&truth);
    }
    const float *side = &shown[4 * (15 * W + 8)], *green = &shown[4 * (15 * W + 4)], *alpha = &shown[4 * (16 * W + 5)];
    NEAR(side[3], 0.5, 0);
    NEAR(side[0], 0.25, 1e-6);
    NEAR(green[0], 0, 1e-6);
    NEAR(green[1], 0.125, 1e-6);
    NEAR(green[3], 1, 0);
    for (int i = 0; i < 3; i++)
        NEAR(alpha[i], 0.0625, 1e-6);
    NEAR(shown[4 * (17 * W + 5) + 2], FLT_MAX, 0);
    tc_truth *truth = truth_of(&s, 10, 1, 1);
    tc_image other = {W, H - 1, shown};
    tc_error err;
    tc_verify_result v;
    assert_int_equal(tc_truth_compare(&v, &other, truth, &s.image, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "40 x 29"));
    assert_int_equal(tc_truth_compare(&v, NULL, truth, &other, &err), TC_E_ARG);
    tc_truth_destroy(&truth);
    scene_finish(&s);
}

static void listed_pixels_pass_for_a_draw(void **state)
{
    (void)state;
    scene s;
    tc_error err;
    scene_init(&s, false);
    draw(&s);
    s.pixels[4 * 615] += 0.5f;
    uint32_t pixel[] = {620, 615, 3};
    tc_truth *truth;
    tc_truth_view view = {.reference = s.reference, .tf = &s.tf, .unit = 1, .rays = &s.rays, .pixel = pixel, .n = 3};
    assert_int_equal(tc_truth_create(&truth, &view, &err), TC_OK);
    assert_memory_equal(tc_truth_pixels(truth), pixel, sizeof pixel);
    tc_verify_result v = compare(truth, NULL, &s.image);
    assert_int_equal(v.pixels, 3);
    NEAR(v.max_abs_error, 0.5, 1e-6);
    assert_true(v.worst_x == 615 % W && v.worst_y == 615 / W);
    assert_true(isnan(v.unseen_share));
    tc_truth_destroy(&truth);
    pixel[1] = N;
    assert_int_equal(tc_truth_create(&truth, &view, &err), TC_E_ARG);
    assert_null(truth);
    assert_non_null(strstr(err.text, "pixel 1200 is outside"));
    view.pixel = NULL;
    static const int bad[] = {2, 5, 15, -2, 4097, 8100};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        view.samples = bad[i];
        assert_int_equal(tc_truth_create(&truth, &view, &err), TC_E_ARG);
        assert_non_null(strstr(err.text, "square number"));
    }
    scene_finish(&s);
}

/* ------------------------------------------------------------------------------------------------- unseen pixels */

static int bits_of(unsigned set)
{
    int n = 0;
    for (; set; set &= set - 1)
        n++;
    return n;
}

/* All draws of n of `all` with these values, of which some are unusable: in how many is the bound, less by `less`
 * pixels, wrong? */
static double share_wrong(int all, int n, const int *value, unsigned unusable, double confidence, int less)
{
    int draws = 0, wrong = 0;
    for (unsigned set = 0; set < 1u << all; set++) {
        if (bits_of(set) != n)
            continue;
        int most = -1, above = 0;
        for (int i = 0; i < all; i++)
            if ((set & ~unusable) >> i & 1 && value[i] > most)
                most = value[i];
        for (int i = 0; i < all; i++)
            above += !((set | unusable) >> i & 1) && value[i] > most;
        size_t bad = (size_t)bits_of(set & unusable);
        double bound = tc_truth_unseen_share((size_t)all, (size_t)n, bad, confidence) * (all - n);
        assert_true(fabs(bound - round(bound)) < 1e-9);
        draws++;
        wrong += above > lround(bound) - less;
    }
    return (double)wrong / draws;
}

static void bound_is_wrong_too_often_or_loose(void **state)
{
    (void)state;
    static const int apart[11] = {4, 9, 1, 7, 10, 0, 3, 8, 2, 6, 5}, ties[11] = {3, 3, 1, 0, 3, 0, 0, 1, 2, 0, 1};
    static const double confidence[] = {0.5, 0.8, 0.95, 0.99};
    for (int all = 1; all <= 11; all++)
        for (int n = 1; n <= all; n++)
            for (size_t c = 0; c < sizeof confidence / sizeof *confidence; c++) {
                double may = 1 - confidence[c] + 1e-12;
                assert_true(share_wrong(all, n, apart, 0, confidence[c], 0) <= may);
                assert_true(share_wrong(all, n, ties, 0, confidence[c], 0) <= may);
                assert_true(share_wrong(all, n, apart, 0x12, confidence[c], 0) <= may); /* the two largest but one */
                assert_true(share_wrong(all, n, ties, 0x7e, confidence[c], 0) <= may);
                /* One pixel less would be wrong too often. */
                if (tc_truth_unseen_share((size_t)all, (size_t)n, 0, confidence[c]) > 0)
                    assert_true(share_wrong(all, n, apart, 0, confidence[c], 1) > may - 1e-9);
            }
}

static void bound_differs_from_the_rule_for_large_pictures(void **state)
{
    (void)state;
    static const size_t n[] = {1, 2, 10, 59, 1000, 4096, 100000};
    for (size_t i = 0; i < sizeof n / sizeof *n; i++) {
        double rule = -expm1(log(0.05) / (double)n[i]), all = 268435456;
        NEAR(tc_truth_unseen_share((size_t)all, n[i], 0, 0.95), rule,
             2e-6 * rule + 2 * (double)n[i] / all * rule + 2 / all);
        /* What cannot be used is as if it had not been drawn. */
        NEAR(tc_truth_unseen_share((size_t)all, n[i] + 7, 7, 0.95), rule,
             2e-6 * rule + 2 * (double)n[i] / all * rule + 2 / all);
    }
    /* The more are drawn, the fewer may be worse; from all but one pixel to none. */
    double last = 262144;
    for (size_t k = 1; k <= 262144; k += k / 8 + 1) {
        double may = round(tc_truth_unseen_share(262144, k, 0, 0.95) * (double)(262144 - k)); /* pixels */
        assert_true(may <= last && (may > 0) == (k < 0.95 * 262144));
        last = may;
    }
    NEAR(tc_truth_unseen_share(262144, 262143, 0, 0.95), 0, 0); /* the last would be the worst with 4e-6 */
    NEAR(tc_truth_unseen_share(262144, 262144, 5, 0.95), 0, 0);
    NEAR(tc_truth_unseen_share(10, 0, 0, 0.95), 1, 0);
    NEAR(tc_truth_unseen_share(10, 4, 4, 0.95), 1, 0);
    NEAR(tc_truth_unseen_share(0, 0, 0, 0.95), 0, 0);
}

/* A thousand draws of one picture with known errors: how often is what is said of the others wrong? */
static double wrong_in_a_thousand(const scene *s, size_t n)
{
    tc_truth *all = truth_of(s, N, 0, 1);
    tc_verify_result v = compare(all, NULL, &s->image);
    assert_int_equal(v.ill_posed, 0);
    double error[N];
    for (size_t k = 0; k < N; k++) {
        error[k] = 0;
        for (size_t i = 0; i < 4; i++)
            error[k] = fmax(error[k], fabs((double)s->pixels[4 * k + i] - tc_truth_color(all, k)[i]));
    }
    tc_truth_destroy(&all);
    int wrong = 0;
    for (uint64_t seed = 0; seed < 1000; seed++) {
        tc_truth *truth = truth_of(s, n, seed, 1);
        v = compare(truth, NULL, &s->image);
        size_t above = 0;
        for (size_t k = 0; k < N; k++)
            above += error[k] > v.max_abs_error; /* none of them was drawn */
        assert_true(v.unseen_share > 0);
        NEAR(v.confidence, 0.95, 0);
        wrong += (double)above > v.unseen_share * (double)(N - n) * (1 + 1e-12);
        tc_truth_destroy(&truth);
    }
    return wrong / 1000.0;
}

static void bound_of_a_sampled_picture_is_untrue(void **state)
{
    (void)state;
    static const size_t n[] = {20, 100, 400};
    scene s;
    scene_init(&s, false);
    /* Errors that all differ: the bound is tight there, and fails as often as it says. */
    draw(&s);
    uint64_t random = 77;
    for (int k = 0; k < N; k++)
        s.pixels[4 * k + k % 4] += (float)pow(10, uniform(&random, -5, -1));
    for (size_t i = 0; i < 3; i++) {
        double wrong = wrong_in_a_thousand(&s, n[i]);
        print_message("%zu of %d pixels, errors all over: wrong in %.1f %%\n", n[i], N, 100 * wrong);
        assert_true(wrong <= 0.07 && wrong >= 0.02);
    }
    /* A few bad pixels in a good picture. */
    for (int bad = 1; bad <= 64; bad *= 8) {
        draw(&s);
        for (int k = 0; k < bad; k++)
            s.pixels[4 * ((k * 37 + 411) % N)] += 0.02f + 0.001f * (float)k;
        for (size_t i = 0; i < 3; i++) {
            double wrong = wrong_in_a_thousand(&s, n[i]);
            print_message("%zu of %d pixels, %d bad: wrong in %.1f %%\n", n[i], N, bad, 100 * wrong);
            assert_true(wrong <= 0.07);
        }
    }
    scene_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(second_picture_is_judged_otherwise_than_a_first),
        cmocka_unit_test(color_is_not_the_mean_over_the_grid),
        cmocka_unit_test(pixel_with_ill_posed_rays_counts_as_an_error),
        cmocka_unit_test(error_image_shows_other_errors),
        cmocka_unit_test(listed_pixels_pass_for_a_draw),
        cmocka_unit_test(bound_is_wrong_too_often_or_loose),
        cmocka_unit_test(bound_differs_from_the_rule_for_large_pictures),
        cmocka_unit_test(bound_of_a_sampled_picture_is_untrue),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
