/* test_image_png.c: the filters and levels of PNG files, decoded by libpng. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "image/png.h"

#include <png.h>
#include <stdlib.h>
#include <string.h>

typedef struct bytes {
    uint8_t *data;
    size_t n, room, at;
} bytes;

static bool keep(void *context, const void *data, size_t n, tc_error *err)
{
    (void)err;
    bytes *b = context;
    if (b->n + n > b->room) {
        b->room = 2 * (b->n + n);
        b->data = realloc(b->data, b->room);
        assert_non_null(b->data);
    }
    memcpy(b->data + b->n, data, n);
    b->n += n;
    return true;
}

static void give(png_structp png, png_bytep to, size_t n)
{
    bytes *b = png_get_io_ptr(png);
    assert_true(n <= b->n - b->at);
    memcpy(to, b->data + b->at, n);
    b->at += n;
}

static bytes encoded(const float *rgba, int width, int height, bool opaque, int bits, int level)
{
    bytes b = {0};
    tc_png *png;
    const tc_png_plan plan = {
        .width = width, .height = height, .opaque = opaque, .bits = bits, .level = level, .sink = keep, .context = &b};
    assert_int_equal(tc_png_begin(&png, &plan, NULL), TC_OK);
    for (int y = 0; y < height; y++)
        assert_int_equal(tc_png_row(png, rgba + (size_t)y * (size_t)width * 4, NULL), TC_OK);
    assert_int_equal(tc_png_end(png, NULL), TC_OK);
    tc_png_destroy(&png);
    return b;
}

/* Every sample of the file against the level that was put in. */
static void expect(bytes *b, const uint16_t *level, int width, int height, bool opaque, int bits)
{
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    assert_non_null(info);
    if (setjmp(png_jmpbuf(png)))
        fail_msg("libpng cannot decode it");
    png_set_read_fn(png, b, give);
    png_read_png(png, info, PNG_TRANSFORM_IDENTITY, NULL);
    const int channels = opaque ? 3 : 4, wide = bits / 8;
    assert_int_equal(png_get_image_width(png, info), width);
    assert_int_equal(png_get_image_height(png, info), height);
    assert_int_equal(png_get_channels(png, info), channels);
    assert_int_equal(png_get_bit_depth(png, info), bits);
    png_bytepp rows = png_get_rows(png, info);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < channels; c++) {
                const uint8_t *at = rows[y] + (x * channels + c) * wide;
                assert_int_equal(wide == 2 ? at[0] << 8 | at[1] : at[0], level[(y * width + x) * 4 + c]);
            }
    png_destroy_read_struct(&png, &info, NULL);
}

static uint32_t next(void)
{
    static uint32_t seed = 4711;
    seed = seed * 1664525u + 1013904223u;
    return seed >> 8;
}

typedef enum pattern { NOISE, SAME_ROWS, PLAIN_ROWS, MIXED } pattern;

/* Levels of pixels that are opaque or (0, 0, 0, 0), and the picture that has them. MIXED: rows like the one above, of
 * one colour, that rise evenly, of noise. */
static void fill(uint16_t *level, float *rgba, int width, int height, bool opaque, int bits, pattern kind)
{
    const unsigned top = bits == 16 ? 65535 : 255;
    for (int y = 0; y < height; y++) {
        uint16_t *row = level + (size_t)y * (size_t)width * 4;
        const unsigned of_row = kind == MIXED ? next() % 4 : 0, shade = next();
        for (int i = 0; i < 4 * width; i++) {
            const bool above = y > 0 && (kind == SAME_ROWS || (kind == MIXED && of_row == 0));
            const bool plain = kind == PLAIN_ROWS || (kind == MIXED && of_row == 1);
            const unsigned noise = next();
            row[i] = (uint16_t)(above                          ? row[i - 4 * width]
                                : plain                        ? (shade >> i % 4 * 3) % (top + 1)
                                : kind == MIXED && of_row == 2 ? (shade + (unsigned)i / 4 * 3) % (top + 1)
                                                               : noise % (top + 1));
            if (i % 4 == 3 && !above)
                row[i] = (uint16_t)(opaque || noise >> 8 & 3 || kind != MIXED ? top : 0);
            if (i % 4 == 3 && row[i] == 0)
                memset(row + i - 3, 0, 3 * sizeof *row);
        }
        for (int i = 0; i < 4 * width; i++)
            rgba[(size_t)y * (size_t)width * 4 + (size_t)i] = (float)row[i] / (float)top;
    }
}

static void pixels_change_with_the_filter_or_the_level(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 9}, {9, 1}, {2, 2}, {67, 61}, {700, 40}};
    static const int levels[] = {TC_PNG_RUNS, 0, 1, 4, 9};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (int round = 0; round < 4; round++) {
            const int width = sizes[s][0], height = sizes[s][1], bits = round & 1 ? 16 : 8;
            const bool opaque = round & 2;
            const size_t n = (size_t)width * (size_t)height * 4;
            uint16_t *level = malloc(n * sizeof *level);
            float *rgba = malloc(n * sizeof *rgba);
            assert_true(level && rgba);
            fill(level, rgba, width, height, opaque, bits, MIXED);
            for (size_t i = 0; i < sizeof levels / sizeof *levels; i++) {
                bytes b = encoded(rgba, width, height, opaque, bits, levels[i]);
                expect(&b, level, width, height, opaque, bits);
                free(b.data);
            }
            free(level);
            free(rgba);
        }
}

/* Sub alone would leave noise of rows that repeat, and Up alone the pixels of rows of one colour. */
static void rows_that_repeat_or_are_plain_are_not_small(void **state)
{
    (void)state;
    enum { W = 512, H = 96 };
    uint16_t *level = malloc(sizeof *level * W * H * 4);
    float *rgba = malloc(sizeof *rgba * W * H * 4);
    assert_true(level && rgba);
    static const int levels[] = {TC_PNG_RUNS, 1, 4};
    for (int round = 0; round < 4; round++)
        for (size_t i = 0; i < sizeof levels / sizeof *levels; i++) {
            const int bits = round & 1 ? 16 : 8, channels = round & 2 ? 3 : 4;
            const size_t row = (size_t)W * (size_t)(channels * bits / 8), small = (size_t)H * 64;
            fill(level, rgba, W, H, channels == 3, bits, SAME_ROWS);
            bytes same = encoded(rgba, W, H, channels == 3, bits, levels[i]);
            fill(level, rgba, W, H, channels == 3, bits, PLAIN_ROWS);
            bytes plain = encoded(rgba, W, H, channels == 3, bits, levels[i]);
            assert_true(same.n < row + small);
            assert_true(plain.n < small);
            free(same.data);
            free(plain.data);
        }
    free(level);
    free(rgba);
}

/* Runs of one byte alone are sought by TC_PNG_RUNS: rows that come again later are small by zlib's levels only. */
static void runs_alone_is_a_level_of_zlib(void **state)
{
    (void)state;
    enum { W = 256, H = 64 };
    uint16_t *level = malloc(sizeof *level * W * H * 4);
    float *rgba = malloc(sizeof *rgba * W * H * 4);
    assert_true(level && rgba);
    fill(level, rgba, W, H, true, 8, NOISE);
    for (int y = 4; y < H; y++)
        memcpy(rgba + (size_t)y * W * 4, rgba + (size_t)(y - 4) * W * 4, sizeof *rgba * W * 4);
    bytes runs = encoded(rgba, W, H, true, 8, TC_PNG_RUNS), one = encoded(rgba, W, H, true, 8, 1);
    assert_true(runs.n > (size_t)W * H * 3 * 9 / 10);
    assert_true(one.n < (size_t)W * H * 3 / 4);
    free(runs.data);
    free(one.data);
    free(level);
    free(rgba);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_change_with_the_filter_or_the_level),
        cmocka_unit_test(rows_that_repeat_or_are_plain_are_not_small),
        cmocka_unit_test(runs_alone_is_a_level_of_zlib),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
