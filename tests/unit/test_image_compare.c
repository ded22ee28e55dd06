/* test_image_compare.c: images in memory: limits, background, comparison. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/status.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static tc_image *blank(int width, int height)
{
    tc_image *image;
    assert_int_equal(tc_image_create(&image, width, height, NULL), TC_OK);
    return image;
}

static void impossible_sizes_are_made(void **state)
{
    (void)state;
    static const int sizes[][2] = {{0, 1}, {1, 0}, {-1, 5}, {INT_MAX, INT_MAX}, {1 << 15, (1 << 15) + 1}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        tc_image *image = (tc_image *)&sizes;
        tc_error err;
        assert_int_equal(tc_image_create(&image, sizes[i][0], sizes[i][1], &err), TC_E_ARG);
        assert_null(image);
    }
    tc_image *none = NULL; /* 16 GiB are asked for before they are taken */
    tc_error err;
    setenv("TETCAST_MEMORY", "8G", 1);
    assert_int_equal(tc_image_create(&none, 1 << 15, 1 << 15, &err), TC_E_MEMORY);
    unsetenv("TETCAST_MEMORY");
    assert_non_null(strstr(err.text, "needs 16.0 GiB of memory, and 8.0 GiB are free"));
    tc_image_destroy(&none);
    tc_image_destroy(NULL);
}

static void the_background_is_not_behind(void **state)
{
    (void)state;
    tc_image *image = blank(3, 1);
    const float pixels[12] = {0, 0, 0, 0, 0.25f, 0, 0, 0.5f, 0, 1, 0, 1}, back[4] = {0.5f, 0.25f, 0, 0.5f};
    const float expected[12] = {0.5f, 0.25f, 0, 0.5f, 0.5f, 0.125f, 0, 0.75f, 0, 1, 0, 1};
    memcpy(image->rgba, pixels, sizeof pixels);
    tc_image_background(image, back);
    for (int i = 0; i < 12; i++)
        assert_true(image->rgba[i] == expected[i]);
    tc_image_destroy(&image);
}

static void differences_are_not_the_closed_form(void **state)
{
    (void)state;
    tc_image *a = blank(100, 50), *b = blank(100, 50);
    tc_compare_result r;
    assert_int_equal(tc_image_compare(&r, a, b, NULL), TC_OK);
    assert_int_equal(r.pixels, 5000);
    assert_int_equal(r.covered, 0);
    assert_true(r.max_abs == 0 && r.mean_abs == 0 && r.p999_abs == 0 && r.rms == 0);
    for (int i = 0; i < 1000; i++) /* 1000 covered pixels, 4000 channel values: alpha alone */
        a->rgba[4 * i + 3] = b->rgba[4 * i + 3] = 1;
    a->rgba[4 * 307 + 1] = 0.5f;
    b->rgba[4 * 308 + 2] = 0.25f;
    b->rgba[4 * 999] = 1.0f / 512;
    assert_int_equal(tc_image_compare(&r, a, b, NULL), TC_OK);
    assert_int_equal(r.covered, 1000);
    assert_int_equal(r.differing, 2);
    assert_true(r.max_abs == 0.5);
    assert_int_equal(r.worst_x, 7);
    assert_int_equal(r.worst_y, 3);
    assert_true(fabs(r.mean_abs - (0.5 + 0.25 + 1.0 / 512) / 4000) < 1e-15);
    assert_true(fabs(r.rms - sqrt((0.25 + 0.0625 + 1.0 / 262144) / 4000)) < 1e-15);
    assert_true(r.p999_abs == 0); /* 4 values of 4000 may be larger; 3 are */
    assert_int_equal(tc_image_compare(&r, b, a, NULL), TC_OK);
    assert_true(r.max_abs == 0.5);
    tc_image_destroy(&a);
    tc_image_destroy(&b);
}

static int ascending(const void *p, const void *q)
{
    float a = *(const float *)p, b = *(const float *)q;
    return (a > b) - (a < b);
}

static void the_percentile_is_not_that_of_a_sorted_list(void **state)
{
    (void)state;
    tc_image *a = blank(97, 31), *b = blank(97, 31);
    size_t n = 97 * 31 * 4;
    float *sorted = malloc(n * sizeof *sorted);
    uint32_t seed = 7;
    for (size_t i = 0; i < n; i++) {
        seed = seed * 1664525u + 1013904223u;
        a->rgba[i] = 1 + (float)(seed >> 8) * 1e-9f;
        b->rgba[i] = 1 + (float)(seed & 0xffff) * 1e-8f;
        sorted[i] = (float)fabs((double)a->rgba[i] - (double)b->rgba[i]);
    }
    qsort(sorted, n, sizeof *sorted, ascending);
    tc_compare_result r;
    assert_int_equal(tc_image_compare(&r, a, b, NULL), TC_OK);
    assert_true(r.p999_abs == (double)sorted[n - 1 - n / 1000]);
    assert_true(r.max_abs == (double)sorted[n - 1]);
    free(sorted);
    tc_image_destroy(&a);
    tc_image_destroy(&b);
}

static void what_is_not_a_number_passes_for_equal(void **state)
{
    (void)state;
    tc_image *a = blank(4, 4), *b = blank(4, 4);
    tc_compare_result r;
    a->rgba[4 * 6] = b->rgba[4 * 6] = NAN;
    assert_int_equal(tc_image_compare(&r, a, b, NULL), TC_OK);
    assert_true(isinf(r.max_abs) && isinf(r.mean_abs) && isinf(r.p999_abs));
    assert_int_equal(r.differing, 1);
    assert_int_equal(r.worst_x, 2);
    assert_int_equal(r.worst_y, 1);
    tc_image_destroy(&a);
    tc_image_destroy(&b);
}

static void different_sizes_are_compared(void **state)
{
    (void)state;
    tc_image *a = blank(4, 2), *b = blank(2, 4);
    tc_compare_result r;
    tc_error err;
    assert_int_equal(tc_image_compare(&r, a, b, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "4 x 2 and 2 x 4"));
    tc_image_destroy(&a);
    tc_image_destroy(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(impossible_sizes_are_made),
        cmocka_unit_test(the_background_is_not_behind),
        cmocka_unit_test(differences_are_not_the_closed_form),
        cmocka_unit_test(the_percentile_is_not_that_of_a_sorted_list),
        cmocka_unit_test(what_is_not_a_number_passes_for_equal),
        cmocka_unit_test(different_sizes_are_compared),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
