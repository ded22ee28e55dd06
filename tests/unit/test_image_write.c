/* test_image_write.c: images to files and back. PNG comes back by way of OpenImageIO, which did not write it. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/file.h"
#include "image/writer.h"

#include <dirent.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[64];
static tc_image_writer *writer; /* one helper for all tests */

static char *in_folder(const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int files_in_folder(bool remove_them)
{
    int n = 0;
    DIR *d = opendir(folder);
    for (struct dirent *e; d && (e = readdir(d));)
        if (strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0) {
            n++;
            if (remove_them)
                unlink(in_folder(e->d_name));
        }
    closedir(d);
    return n;
}

static int group_setup(void **state)
{
    (void)state;
    tc_error err;
    strcpy(folder, "/tmp/tetcast-test-XXXXXX");
    if (!mkdtemp(folder))
        return -1;
    if (tc_image_writer_create(&writer, &err) == TC_OK && tc_image_writer_expect(writer, "a.exr", &err) == TC_OK)
        return 0;
    fprintf(stderr, "%s\n", err.text);
    return -1;
}

static int group_teardown(void **state)
{
    (void)state;
    tc_image_writer_destroy(&writer);
    files_in_folder(true);
    return rmdir(folder);
}

static int teardown(void **state)
{
    (void)state;
    files_in_folder(true);
    return 0;
}

/* Random premultiplied pixels, reproducible; alpha 0 and 1 are among them. */
static tc_image *noise(int width, int height)
{
    tc_image *image;
    uint32_t seed = 12345;
    assert_int_equal(tc_image_create(&image, width, height, NULL), TC_OK);
    for (size_t i = 0; i < (size_t)width * (size_t)height; i++) {
        float v[4];
        for (int c = 0; c < 4; c++) {
            seed = seed * 1664525u + 1013904223u;
            v[c] = (float)(seed >> 8) / 16777215.0f;
        }
        float alpha = i % 7 == 0 ? 0 : i % 7 == 1 ? 1 : v[3];
        for (int c = 0; c < 3; c++)
            image->rgba[4 * i + (size_t)c] = v[c] * alpha;
        image->rgba[4 * i + 3] = alpha;
    }
    return image;
}

static void must(tc_status status, const tc_error *err)
{
    if (status != TC_OK)
        fail_msg("%s", err->text);
}

static void write_and_read(tc_image **out, tc_image_meta *got, const tc_image *image, const char *name,
                           const tc_image_encoding *encoding, const tc_text_pair *meta, size_t n)
{
    tc_error err = {0};
    must(tc_image_writer_write(writer, image, in_folder(name), encoding, meta, n, NULL, &err), &err);
    assert_int_equal(files_in_folder(false), 1);
    must(tc_image_writer_read(out, got, writer, in_folder(name), &err), &err);
    assert_int_equal((*out)->width, image->width);
    assert_int_equal((*out)->height, image->height);
}

static double worst(const tc_image *a, const tc_image *b)
{
    tc_compare_result r;
    assert_int_equal(tc_image_compare(&r, a, b, NULL), TC_OK);
    return r.max_abs;
}

static void exr_and_tiff_change_a_bit(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.tif", "b.TIFF"};
    tc_image *image = noise(37, 23), *back;
    image->rgba[0] = 1e-30f, image->rgba[1] = -2.5f, image->rgba[2] = 12345.678f, image->rgba[3] = 0.1f;
    for (int i = 0; i < 3; i++) {
        write_and_read(&back, NULL, image, names[i], NULL, NULL, 0);
        assert_memory_equal(back->rgba, image->rgba, 37 * 23 * 4 * sizeof(float));
        tc_image_destroy(&back);
        files_in_folder(true);
    }
    tc_image_destroy(&image);
}

static void half_exr_is_worse_than_half(void **state)
{
    (void)state;
    tc_image *image = noise(16, 16), *back;
    write_and_read(&back, NULL, image, "a.exr", &(tc_image_encoding){.bits = 16}, NULL, 0);
    double d = worst(image, back);
    assert_true(d > 0 && d <= 0x1p-12); /* 11 bits of significand, values up to 1 */
    tc_image_destroy(&back);
    tc_image_destroy(&image);
}

static void png_is_worse_than_its_quantisation(void **state)
{
    (void)state;
    tc_image *image = noise(61, 47), *back;
    write_and_read(&back, NULL, image, "a.png", NULL, NULL, 0);
    assert_true(worst(image, back) <= 1.0 / 255);
    tc_image_destroy(&back);
    write_and_read(&back, NULL, image, "a.png", &(tc_image_encoding){.bits = 16}, NULL, 0);
    assert_true(worst(image, back) <= 1.0 / 65535);
    tc_image_destroy(&back);
    tc_image_destroy(&image);
}

/* A dim pixel of alpha 3/255: un-premultiplying after 8-bit quantisation would leave four levels of colour. */
static void png_unpremultiplies_after_quantisation(void **state)
{
    (void)state;
    tc_image *image, *back;
    assert_int_equal(tc_image_create(&image, 256, 1, NULL), TC_OK);
    for (int x = 0; x < 256; x++) {
        float alpha = 3.0f / 255, v = (float)x / 255;
        for (int c = 0; c < 3; c++)
            image->rgba[4 * x + c] = v * alpha;
        image->rgba[4 * x + 3] = alpha;
    }
    write_and_read(&back, NULL, image, "a.png", NULL, NULL, 0);
    for (int x = 0; x < 256; x++)
        assert_int_equal((int)lrintf(back->rgba[4 * x] / back->rgba[4 * x + 3] * 255), x);
    tc_image_destroy(&back);
    tc_image_destroy(&image);
}

/* The header's kind of colour: 2 RGB, 6 RGBA; and its bits. */
static void an_opaque_png_has_alpha_or_bits_are_wrong(void **state)
{
    (void)state;
    tc_image *image = noise(5, 3);
    for (int round = 0; round < 4; round++) {
        const float black[4] = {0, 0, 0, 1};
        const int bits = round % 2 ? 16 : 8;
        tc_error err = {0};
        void *data;
        size_t n;
        if (round == 2)
            tc_image_background(image, black);
        for (int i = 0; i < 15 && round >= 2; i++)
            image->rgba[4 * i + 3] = 1; /* rounding */
        must(tc_image_writer_write(writer, image, in_folder("a.png"), &(tc_image_encoding){.bits = bits}, NULL, 0, NULL,
                                   &err),
             &err);
        must(tc_file_read(&data, &n, in_folder("a.png"), &err), &err);
        assert_true(n > 33);
        assert_int_equal(((unsigned char *)data)[24], bits);
        assert_int_equal(((unsigned char *)data)[25], round < 2 ? 6 : 2);
        free(data);
    }
    tc_image_destroy(&image);
}

/* Every pixel, read back by another library. */
static void png_rounds_other_than_to_the_nearest_level(void **state)
{
    (void)state;
    for (int bits = 8; bits <= 16; bits += 8) {
        const double top = bits == 16 ? 65535 : 255;
        tc_image *image = noise(61, 47), *back;
        image->rgba[4] = 3, image->rgba[5] = -1, image->rgba[6] = 0.5f, image->rgba[7] = 1.5f; /* beyond 0 and 1 */
        write_and_read(&back, NULL, image, "a.png", &(tc_image_encoding){.bits = bits}, NULL, 0);
        for (int i = 0; i < 61 * 47; i++) {
            const float *p = image->rgba + 4 * i, *q = back->rgba + 4 * i;
            double alpha = fmin(fmax((double)p[3], 0), 1), slack = 0.5 + 3e-7 * top; /* a float's last digits */
            assert_true(fabs((double)q[3] * top - alpha * top) <= slack);
            for (int c = 0; c < 3 && q[3] > 0; c++) {
                double v = fmin(fmax((double)p[c] / alpha, 0), 1) * top;
                assert_true(fabs((double)(q[c] / q[3]) * top - v) <= slack);
            }
        }
        tc_image_destroy(&back);
        tc_image_destroy(&image);
    }
}

static void display_colours_are_converted(void **state)
{
    (void)state;
    static const char *const names[] = {"a.png", "a.exr", "a.tif", "a.jpg"};
    static const double bound[] = {1e-6, 0, 0, 2.0 / 255};
    tc_image *image, *back;
    assert_int_equal(tc_image_create(&image, 64, 64, NULL), TC_OK);
    const float grey[4] = {51.0f / 255, 102.0f / 255, 204.0f / 255, 1};
    tc_image_background(image, grey);
    for (int i = 0; i < 4; i++) {
        write_and_read(&back, NULL, image, names[i], NULL, NULL, 0);
        assert_true(worst(image, back) <= bound[i]);
        tc_image_destroy(&back);
        files_in_folder(true);
    }
    tc_image_destroy(&image);
}

static void count_warnings(void *user, tc_level level, const char *text)
{
    (void)text;
    *(int *)user += level == TC_WARNING;
}

static void jpeg_is_not_laid_over_white_or_does_not_say_so(void **state)
{
    (void)state;
    tc_image *image, *back;
    tc_error err = {0};
    int warnings = 0;
    tc_log log = {count_warnings, NULL, &warnings};
    assert_int_equal(tc_image_create(&image, 16, 16, NULL), TC_OK);
    for (int i = 0; i < 256; i++)
        image->rgba[4 * i] = image->rgba[4 * i + 3] = 0.5f; /* half-covering red */
    must(tc_image_writer_write(writer, image, in_folder("a.jpeg"), NULL, NULL, 0, &log, &err), &err);
    assert_int_equal(warnings, 1);
    must(tc_image_writer_read(&back, NULL, writer, in_folder("a.jpeg"), &err), &err);
    const float pink[4] = {1, 0.5f, 0.5f, 1};
    for (int i = 0; i < 256 * 4; i++)
        assert_true(fabsf(back->rgba[i] - pink[i % 4]) < 0.02f);
    tc_image_destroy(&back);
    tc_image_destroy(&image);
}

static void glow_without_opacity_vanishes_from_png_silently(void **state)
{
    (void)state;
    tc_image *image;
    tc_error err = {0};
    int warnings = 0;
    tc_log log = {count_warnings, NULL, &warnings};
    assert_int_equal(tc_image_create(&image, 4, 4, NULL), TC_OK);
    image->rgba[0] = 0.5f;
    must(tc_image_writer_write(writer, image, in_folder("a.exr"), NULL, NULL, 0, &log, &err), &err);
    assert_int_equal(warnings, 0);
    must(tc_image_writer_write(writer, image, in_folder("a.png"), NULL, NULL, 0, &log, &err), &err);
    assert_int_equal(warnings, 1);
    tc_image_destroy(&image);
}

static void texts_do_not_come_back(void **state)
{
    (void)state;
    static const char *const names[] = {"a.png", "a.exr", "a.tif", "a.jpg"};
    const tc_text_pair sent[] = {{"Software", "tetcast 0.1.0"},
                                 {"Title", "a \"fin\" \\ of 100%"},
                                 {"camera", "{\"position\":[1,2,3],\n \"view_angle\":30}"},
                                 {"author", "J\xc3\xb6rg, \xe2\x88\x9a"
                                            "2"},
                                 {"empty", ""}};
    tc_image *image = noise(8, 8), *back;
    for (int i = 0; i < 4; i++) {
        tc_image_meta got;
        write_and_read(&back, &got, image, names[i], NULL, sent, 5);
        for (int k = 0; k < 5; k++) {
            bool found = false;
            for (size_t j = 0; j < got.n; j++)
                found = found ||
                        (strcmp(got.pair[j].key, sent[k].key) == 0 && strcmp(got.pair[j].value, sent[k].value) == 0);
            if (!found && !(i == 1 && k == 4)) /* OpenEXR keeps no empty text */
                fail_msg("%s: %s", names[i], sent[k].key);
        }
        assert_in_range(got.n, i == 1 ? 4 : 5, 5);
        tc_image_meta_finish(&got);
        tc_image_destroy(&back);
        files_in_folder(true);
    }
    tc_image_destroy(&image);
}

/* As a scene with thousands of categories has; a JPEG marker holds no more than 64 KiB, and says so. */
static void a_long_text_is_lost(void **state)
{
    (void)state;
    static const char *const names[] = {"a.png", "a.exr", "a.tif"};
    static const size_t length[] = {65000, 65536, 300000};
    tc_image *image = noise(8, 8);
    tc_error err = {0};
    for (int k = 0; k < 3; k++) {
        char *sent = malloc(length[k] + 1), *got;
        assert_non_null(sent);
        memset(sent, 'x', length[k]);
        sent[length[k]] = 0;
        const tc_text_pair pair = {"tetcast:scene", sent};
        for (int i = 0; i < 3; i++) {
            must(tc_image_writer_write(writer, image, in_folder(names[i]), NULL, &pair, 1, NULL, &err), &err);
            must(tc_image_read_text(&got, in_folder(names[i]), "tetcast:scene", &err), &err);
            if (!got || strcmp(got, sent) != 0)
                fail_msg("%s: a text of %zu bytes comes back as one of %zu", names[i], length[k],
                         got ? strlen(got) : 0);
            free(got);
        }
        free(sent);
    }
    tc_image_destroy(&image);
}

enum { TIFF_PIXEL_MOST = 512 };

static void put(uint8_t *file, size_t *at, uint64_t value, size_t bytes, bool big_endian)
{
    for (size_t i = 0; i < bytes; i++)
        file[*at + i] = (uint8_t)(value >> 8 * (big_endian ? bytes - 1 - i : i));
    *at += bytes;
}

/* A TIFF of one grey pixel with a description of this many bytes, its zero counted; its size. *at_description: its
 * entry. */
static size_t tiff_pixel(uint8_t *file, size_t *at_description, bool big, bool big_endian, const char *text,
                         size_t length)
{
    enum { N = 8, ASCII = 2, SHORT = 3, LONG = 4 };
    const size_t wide = big ? 8 : 4;
    const uint64_t body = big ? 320 : 200;
    const struct {
        int tag, type;
        uint64_t count, value;
    } entry[N] = {{256, SHORT, 1, 1}, {257, SHORT, 1, 1},         {258, SHORT, 1, 8},       {259, SHORT, 1, 1},
                  {262, SHORT, 1, 1}, {270, ASCII, length, body}, {273, LONG, 1, body - 1}, {279, LONG, 1, 1}};
    size_t at = 0;
    memset(file, 0, TIFF_PIXEL_MOST);
    memcpy(file, big_endian ? "MM" : "II", 2);
    at = 2;
    put(file, &at, big ? 43 : 42, 2, big_endian);
    if (big) {
        put(file, &at, 8, 2, big_endian);
        put(file, &at, 0, 2, big_endian);
    }
    put(file, &at, at + wide, wide, big_endian);
    put(file, &at, N, big ? 8 : 2, big_endian);
    for (int i = 0; i < N; i++) {
        const bool text_here = entry[i].tag == 270 && length <= wide;
        const size_t value_bytes = entry[i].type == SHORT ? 2 : entry[i].type == LONG ? 4 : wide;
        if (entry[i].tag == 270)
            *at_description = at;
        put(file, &at, (uint64_t)entry[i].tag, 2, big_endian);
        put(file, &at, (uint64_t)entry[i].type, 2, big_endian);
        put(file, &at, entry[i].count, wide, big_endian);
        size_t value = at;
        if (text_here)
            memcpy(file + at, text, length);
        else
            put(file, &value, entry[i].value, value_bytes, big_endian);
        at += wide;
    }
    memcpy(file + body, text, length);
    file[body - 1] = 0x80;
    return (size_t)body + length;
}

static void a_tiff_of_another_byte_order_or_with_a_broken_text_is_misread(void **state)
{
    (void)state;
    for (int kind = 0; kind < 8; kind++) {
        const bool big = kind & 1, big_endian = kind & 2;
        const char *sent = kind & 4 ? "ab" : "a text that does not fit in place";
        uint8_t *file = calloc(TIFF_PIXEL_MOST, 1);
        tc_image *back;
        tc_image_meta got;
        tc_error err = {0};
        size_t at = 0;
        assert_non_null(file);
        const size_t n = tiff_pixel(file, &at, big, big_endian, sent, strlen(sent) + 1);
        must(tc_file_replace(in_folder("a.tif"), file, n, &err), &err);
        must(tc_image_writer_read(&back, &got, writer, in_folder("a.tif"), &err), &err);
        if (got.n != 1 || strcmp(got.pair[0].value, sent) != 0)
            fail_msg("kind %d: '%s'", kind, got.n ? got.pair[0].value : "");
        tc_image_meta_finish(&got);
        tc_image_destroy(&back);
        memset(file + at + 4, big_endian ? 0x7f : 0xff, big ? 8 : 4); /* longer than the file */
        must(tc_file_replace(in_folder("a.tif"), file, n, &err), &err);
        if (tc_image_writer_read(&back, &got, writer, in_folder("a.tif"), &err) == TC_OK) {
            assert_int_equal(got.n, 0);
            tc_image_meta_finish(&got);
            tc_image_destroy(&back);
        }
        free(file);
    }
}

static void one_text_is_not_found_or_a_short_file_is_read_beyond(void **state)
{
    (void)state;
    tc_error err = {0};
    char *text = NULL;
    static const tc_text_pair meta[] = {{"tetcast:a", "plain"},
                                        {"tetcast:scene", "Schr\xc3\xb6"
                                                          "dinger"},
                                        {"b", ""}};
    static const char *const names[] = {"t.png", "t.exr", "t.tif"};
    tc_image *image = noise(5, 4);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *path = in_folder(names[i]);
        must(tc_image_writer_write(writer, image, path, NULL, meta, 3, NULL, &err), &err);
        must(tc_image_read_text(&text, path, "tetcast:scene", &err), &err);
        assert_string_equal(text, meta[1].value);
        free(text);
        must(tc_image_read_text(&text, path, "tetcast:a", &err), &err);
        assert_string_equal(text, "plain");
        free(text);
        must(tc_image_read_text(&text, path, "tetcast:scen", &err), &err);
        assert_null(text);
    }
    assert_int_equal(tc_image_read_text(&text, in_folder("none.png"), "a", &err), TC_E_FILE);
    void *data;
    size_t n;
    must(tc_file_read(&data, &n, in_folder("t.png"), &err), &err);
    for (size_t i = 8; i < n; i++) { /* cut, and with a length that leads beyond */
        const tc_file_part part = {data, i};
        must(tc_file_replace_parts(in_folder("cut.png"), &part, 1, &err), &err);
        must(tc_image_read_text(&text, in_folder("cut.png"), "tetcast:scene", &err), &err);
        assert_true(!text || !strcmp(text, meta[1].value));
        free(text);
    }
    memset((uint8_t *)data + 8, 0xff, 4);
    const tc_file_part part = {data, n};
    must(tc_file_replace_parts(in_folder("cut.png"), &part, 1, &err), &err);
    must(tc_image_read_text(&text, in_folder("cut.png"), "tetcast:scene", &err), &err);
    assert_null(text);
    free(data);
    tc_image_destroy(&image);
}

static void png_texts_have_wrong_check_sums(void **state)
{
    (void)state;
    const tc_text_pair pair = {"key", "123456789"};
    tc_image *image = noise(8, 8);
    tc_error err = {0};
    void *data;
    size_t n;
    must(tc_image_writer_write(writer, image, in_folder("a.png"), NULL, &pair, 1, NULL, &err), &err);
    must(tc_file_read(&data, &n, in_folder("a.png"), &err), &err);
    /* CRC-32 of "tEXtkey\0" "123456789", computed with Python's zlib.crc32 */
    static const unsigned char chunk[] = "\0\0\0\x0dtEXtkey\0"
                                         "123456789\x00\x00\x00\x00";
    const unsigned char *found = memmem(data, n, chunk, 4 + 4 + 13);
    assert_non_null(found);
    uint32_t crc = (uint32_t)found[21] << 24 | (uint32_t)found[22] << 16 | (uint32_t)found[23] << 8 | found[24];
    assert_int_equal(crc, 0xc9fe181du);
    free(data);
    tc_image_destroy(&image);
}

/* A byte that is not UTF-8 may not be in an iTXt, and tEXt would mean Latin-1. */
static void png_texts_hold_what_is_not_utf8(void **state)
{
    (void)state;
    const tc_text_pair pair[] = {{"plain", "fin\xff.vtu \xc3"}, {"other", "J\xc3\xb6rg \xfe."}};
    static const char plain[] = "tEXtplain\0fin?.vtu ?", other[] = "iTXtother\0\0\0\0\0J\xc3\xb6rg ?.";
    tc_image *image = noise(8, 8);
    tc_error err = {0};
    void *data;
    size_t n;
    must(tc_image_writer_write(writer, image, in_folder("a.png"), NULL, pair, 2, NULL, &err), &err);
    must(tc_file_read(&data, &n, in_folder("a.png"), &err), &err);
    assert_non_null(memmem(data, n, plain, sizeof plain - 1));
    assert_non_null(memmem(data, n, other, sizeof other - 1));
    free(data);
    tc_image_destroy(&image);
}

static void assert_refused(const tc_image *image, const char *path, tc_status code, const char *part)
{
    tc_error err = {0};
    assert_int_equal(tc_image_writer_write(writer, image, path, NULL, NULL, 0, NULL, &err), code);
    if (!strstr(err.text, part))
        fail_msg("\"%s\" does not say \"%s\"", err.text, part);
    assert_int_equal(files_in_folder(false), 0);
}

static void what_cannot_be_written_is_not_refused_in_words(void **state)
{
    (void)state;
    tc_image *image = noise(8, 8);
    assert_refused(image, in_folder("a.bmp"), TC_E_ARG, ".png, .exr, .tif");
    assert_refused(image, in_folder("a"), TC_E_ARG, "no extension");
    assert_refused(image, in_folder("absent/a.png"), TC_E_FILE, "make its folder first");
    assert_refused(image, "/proc/a.png", TC_E_FILE, "/proc/a.png cannot be written");
    image->rgba[4 * (8 * 3 + 2) + 1] = NAN;
    assert_refused(image, in_folder("a.png"), TC_E_ARG, "pixel (2, 3)");
    image->rgba[4 * (8 * 3 + 2) + 1] = INFINITY;
    assert_refused(image, in_folder("a.exr"), TC_E_ARG, "not finite");
    image->rgba[4 * (8 * 3 + 2) + 1] = 0;
    tc_error err = {0};
    assert_int_equal(
        tc_image_writer_write(writer, image, in_folder("a.jpg"), &(tc_image_encoding){.bits = 16}, NULL, 0, NULL, &err),
        TC_E_ARG);
    const tc_text_pair bad = {"", "value"};
    assert_int_equal(tc_image_writer_write(writer, image, in_folder("a.png"), NULL, &bad, 1, NULL, &err), TC_E_ARG);
    assert_int_equal(files_in_folder(false), 0);
    tc_image_destroy(&image);
}

static void a_full_device_is_not_told(void **state)
{
    (void)state;
    tc_image *image = noise(8, 8);
    assert_int_equal(symlink("/dev/full", in_folder("a.png")), 0);
    tc_error err = {0};
    assert_int_equal(tc_image_writer_write(writer, image, in_folder("a.png"), NULL, NULL, 0, NULL, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "No space left"));
    tc_image_destroy(&image);
}

static void what_is_no_image_is_read(void **state)
{
    (void)state;
    tc_image *image = noise(40, 40), *back;
    tc_error err = {0};
    void *data;
    size_t n;
    assert_int_equal(tc_image_writer_read(&back, NULL, writer, in_folder("absent.png"), &err), TC_E_FILE);
    assert_null(back);
    must(tc_file_replace(in_folder("text.png"), "no image", 8, &err), &err);
    assert_int_equal(tc_image_writer_read(&back, NULL, writer, in_folder("text.png"), &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "text.png cannot be read: it is no PNG"));
    must(tc_file_replace(in_folder("empty.png"), "", 0, &err), &err);
    assert_int_equal(tc_image_writer_read(&back, NULL, writer, in_folder("empty.png"), &err), TC_E_FILE);
    static const char *const names[] = {"a.png", "a.exr", "a.tif", "a.jpg"};
    for (int i = 0; i < 4; i++) { /* cut in the middle */
        must(tc_image_writer_write(writer, image, in_folder(names[i]), NULL, NULL, 0, NULL, &err), &err);
        must(tc_file_read(&data, &n, in_folder(names[i]), &err), &err);
        must(tc_file_replace(in_folder(names[i]), data, n / 2, &err), &err);
        free(data);
        tc_status status = tc_image_writer_read(&back, NULL, writer, in_folder(names[i]), &err);
        if (status == TC_OK)
            fail_msg("half of %s is read as a whole image", names[i]);
        assert_null(back);
        assert_null(strstr(err.text, "/proc/"));
    }
    tc_image_destroy(&image);
}

/* 1 and the first child's id; 0: no child; -1: not known, a kernel without CONFIG_PROC_CHILDREN. */
static int first_child(int *pid)
{
    FILE *children = fopen("/proc/thread-self/children", "r");
    if (!children)
        return -1;
    int found = fscanf(children, "%d", pid);
    fclose(children);
    return found == 1;
}

static void a_helper_that_died_is_not_started_anew(void **state)
{
    (void)state;
    tc_image *image = noise(8, 8);
    tc_error err = {0};
    int pid = 0;
    int found = first_child(&pid);
    if (found == 1) {
        siginfo_t info;
        kill(pid, SIGKILL);
        waitid(P_PID, (id_t)pid, &info, WEXITED | WNOWAIT);
        assert_int_equal(tc_image_writer_write(writer, image, in_folder("a.exr"), NULL, NULL, 0, NULL, &err),
                         TC_E_WORKER);
        assert_non_null(strstr(err.text, "a.exr cannot be written: tetcast-image ended with signal 9"));
        assert_int_equal(files_in_folder(false), 0);
        must(tc_image_writer_write(writer, image, in_folder("a.exr"), NULL, NULL, 0, NULL, &err), &err);
        assert_int_equal(files_in_folder(false), 1);
    }
    tc_image_destroy(&image);
    if (found != 1)
        skip();
}

/* In a child of the test, which has no helper yet. */
static void a_png_starts_a_helper(void **state)
{
    (void)state;
    tc_image *image = noise(8, 8);
    char *png = strdup(in_folder("a.png")), *exr = strdup(in_folder("a.exr"));
    pid_t child = fork();
    if (child == 0) {
        tc_image_writer *own = NULL;
        int pid, bad = tc_image_writer_create(&own, NULL) != TC_OK;
        bad |= (tc_image_writer_expect(own, png, NULL) != TC_OK) << 1;
        bad |= (tc_image_writer_save(own, image, png, NULL, NULL, 0, NULL, NULL) != TC_OK) << 2;
        bad |= (first_child(&pid) == 1) << 3;
        bad |= (tc_image_writer_expect(own, exr, NULL) != TC_OK) << 4;
        bad |= (first_child(&pid) == 0) << 5;
        bad |= (tc_image_writer_expect(own, "a.bmp", NULL) != TC_E_ARG) << 6;
        tc_image_writer_destroy(&own);
        _exit(bad);
    }
    int how = 1;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    assert_int_equal(files_in_folder(false), 1);
    tc_image_destroy(&image);
    free(png);
    free(exr);
}

/* tc_image_write with "-" in a child whose standard output is a file. */
static void standard_output_gets_no_png(void **state)
{
    (void)state;
    tc_image *image = noise(20, 10), *back;
    tc_error err = {0};
    char *path = strdup(in_folder("out"));
    pid_t child = fork();
    if (child == 0) {
        int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0600);
        dup2(fd, STDOUT_FILENO);
        _exit(tc_image_write(image, "-", NULL, 0, NULL, NULL) == TC_OK ? 0 : 1);
    }
    int how = 1;
    assert_int_equal(waitpid(child, &how, 0), child);
    assert_int_equal(how, 0);
    must(tc_image_read(&back, path, &err), &err);
    assert_int_equal(back->width, 20);
    assert_true(worst(image, back) <= 1.0 / 255);
    tc_image_destroy(&back);
    tc_image_destroy(&image);
    free(path);
}

#define TEST(f) cmocka_unit_test_teardown(f, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(exr_and_tiff_change_a_bit),
        TEST(half_exr_is_worse_than_half),
        TEST(png_is_worse_than_its_quantisation),
        TEST(png_unpremultiplies_after_quantisation),
        TEST(an_opaque_png_has_alpha_or_bits_are_wrong),
        TEST(png_rounds_other_than_to_the_nearest_level),
        TEST(display_colours_are_converted),
        TEST(jpeg_is_not_laid_over_white_or_does_not_say_so),
        TEST(glow_without_opacity_vanishes_from_png_silently),
        TEST(texts_do_not_come_back),
        TEST(a_long_text_is_lost),
        TEST(a_tiff_of_another_byte_order_or_with_a_broken_text_is_misread),
        TEST(one_text_is_not_found_or_a_short_file_is_read_beyond),
        TEST(png_texts_have_wrong_check_sums),
        TEST(png_texts_hold_what_is_not_utf8),
        TEST(what_cannot_be_written_is_not_refused_in_words),
        TEST(a_full_device_is_not_told),
        TEST(what_is_no_image_is_read),
        TEST(a_helper_that_died_is_not_started_anew),
        TEST(a_png_starts_a_helper),
        TEST(standard_output_gets_no_png),
    };
    return cmocka_run_group_tests(tests, group_setup, group_teardown);
}
