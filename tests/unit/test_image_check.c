/* test_image_check.c: whole files pass; cut, changed and foreign ones are told apart. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "core/file.h"
#include "image/writer.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

static char folder[64];
static tc_image_writer *writer;

static char *in_folder(const char *name)
{
    static char path[4][512];
    static int turn;
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder, name);
    return path[turn];
}

static int group_setup(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/tetcast-test-XXXXXX");
    return mkdtemp(folder) ? tc_image_writer_create(&writer, NULL) : -1;
}

static int teardown(void **state)
{
    (void)state;
    DIR *d = opendir(folder);
    for (struct dirent *e; d && (e = readdir(d));)
        if (e->d_name[0] != '.')
            unlink(in_folder(e->d_name));
    closedir(d);
    return 0;
}

static int group_teardown(void **state)
{
    (void)state;
    tc_image_writer_destroy(&writer);
    return rmdir(folder);
}

static void must(tc_status status, const tc_error *err)
{
    if (status != TC_OK)
        fail_msg("%s", err->text);
}

static const tc_text_pair texts[] = {{"tetcast:other", "no"},
                                     {"tetcast:scene", "{\"name\": \"Schr\xc3\xb6"
                                                       "dinger\"}"},
                                     {"plain", "text"}};
static const char *const names[] = {"a.png", "a.exr", "a.tif", "a.jpg"};

static void put_image(const char *name, int width, int height)
{
    tc_image *image;
    tc_error err = {0};
    assert_int_equal(tc_image_create(&image, width, height, NULL), TC_OK);
    uint32_t seed = 1;
    for (int i = 0; i < width * height; i++) {
        for (int c = 0; c < 3; c++) {
            seed = seed * 1664525u + 1013904223u;
            image->rgba[4 * i + c] = (float)(seed >> 8) / 16777215.0f;
        }
        image->rgba[4 * i + 3] = 1;
    }
    must(tc_image_writer_save(writer, image, in_folder(name), NULL, texts, 3, NULL, &err), &err);
    tc_image_destroy(&image);
}

static void put_bytes(const char *name, const void *data, size_t n)
{
    tc_error err = {0};
    must(tc_file_replace(in_folder(name), data, n, &err), &err);
}

static void assert_refused(const char *name, const char *part)
{
    tc_error err = {0};
    char *text = (char *)folder;
    tc_status status = tc_image_check(&text, in_folder(name), "tetcast:scene", writer, &err);
    if (status != TC_E_FILE || !strstr(err.text, part) || !strstr(err.text, name))
        fail_msg("%s: %d, \"%s\" does not say \"%s\"", name, (int)status, err.text, part);
    assert_null(text);
}

static void a_whole_file_is_refused_or_its_text_lost(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++)
        for (int own = 0; own < 2; own++) {
            tc_error err = {0};
            char *text;
            tc_image_writer *which = own ? NULL : writer;
            put_image(names[i], 40, 30);
            must(tc_image_check(&text, in_folder(names[i]), "tetcast:scene", which, &err), &err);
            assert_string_equal(text, texts[1].value);
            free(text);
            must(tc_image_check(&text, in_folder(names[i]), "none", which, &err), &err);
            assert_null(text);
            must(tc_image_check(NULL, in_folder(names[i]), NULL, which, &err), &err);
        }
}

static void a_changed_byte_of_a_png_is_not_found(void **state)
{
    (void)state;
    void *data;
    size_t n;
    int tried = 0;
    tc_error err = {0};
    put_image("a.png", 60, 40);
    must(tc_file_read(&data, &n, in_folder("a.png"), &err), &err);
    uint8_t *bytes = data;
    for (size_t i = 0; i < n; i += i < 400 || i + 30 > n ? 1 : 97) /* the first chunks and the last byte by byte */
        for (int bit = 0; bit < 8; bit += 5, tried++) {
            bytes[i] ^= (uint8_t)(1 << bit);
            put_bytes("b.png", data, n);
            bytes[i] ^= (uint8_t)(1 << bit);
            if (tc_image_check(NULL, in_folder("b.png"), NULL, writer, &err) != TC_E_FILE)
                fail_msg("byte %zu of %zu, bit %d", i, n, bit);
        }
    assert_true(tried > 800);
    bytes[n / 2] ^= 16;
    put_bytes("b.png", data, n);
    assert_refused("b.png", "is damaged: the checksum is wrong of the chunk that begins at byte");
    free(data);
}

static void a_short_png_is_whole(void **state)
{
    (void)state;
    void *data;
    size_t n;
    tc_error err = {0};
    put_image("a.png", 12, 12);
    must(tc_file_read(&data, &n, in_folder("a.png"), &err), &err);
    for (size_t i = 8; i < n; i++) {
        put_bytes("b.png", data, i);
        assert_refused("b.png", "is cut short: it ends after");
    }
    for (size_t i = 1; i < 8; i++) {
        put_bytes("b.png", data, i);
        assert_refused("b.png", "does not begin as an image does");
    }
    put_bytes("b.png", "", 0);
    assert_refused("b.png", "is empty");
    uint8_t *more = calloc(n + 1, 1);
    memcpy(more, data, n);
    put_bytes("b.png", more, n + 1);
    assert_refused("b.png", "more behind the end");
    free(more);
    free(data);
}

/* Appends a chunk with its right checksum. */
static size_t chunk(uint8_t *to, const char *type, const void *body, uint32_t n)
{
    const uint8_t length[4] = {(uint8_t)(n >> 24), (uint8_t)(n >> 16), (uint8_t)(n >> 8), (uint8_t)n};
    memcpy(to, length, 4);
    memcpy(to + 4, type, 4);
    if (n)
        memcpy(to + 8, body, n);
    const uint32_t crc = (uint32_t)crc32(0, to + 4, n + 4);
    for (int i = 0; i < 4; i++)
        to[8 + n + (size_t)i] = (uint8_t)(crc >> (24 - 8 * i));
    return n + 12;
}

static void chunks_out_of_order_are_a_png(void **state)
{
    (void)state;
    static const char header[13] = "\0\0\0\x01\0\0\0\x01\x08\0\0\0\0";
    static const struct {
        const char *order, *part;
    } cases[] = {{"DE", "no header"},  {"HHDE", "a second header"},       {"HE", "ends without pixels"},
                 {"HD", "cut short"},  {"HDED", "more behind the end"},   {"hDE", "no header"},
                 {"HbDE", "no chunk"}, {"HlDE", "a chunk of impossible"}, {"HDE", NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        uint8_t file[512];
        size_t n = 8;
        memcpy(file, "\x89PNG\r\n\x1a\n", 8);
        for (const char *c = cases[i].order; *c; c++) {
            const size_t at = n;
            n += *c == 'H'   ? chunk(file + n, "IHDR", header, 13)
                 : *c == 'h' ? chunk(file + n, "IHDR", header, 12)
                 : *c == 'D' ? chunk(file + n, "IDAT", "x", 1)
                 : *c == 'E' ? chunk(file + n, "IEND", NULL, 0)
                 : *c == 'b' ? chunk(file + n, "a\1bc", NULL, 0)
                             : chunk(file + n, "teXt", NULL, 0);
            if (*c == 'l')
                file[at] = 0xff;
        }
        put_bytes("c.png", file, n);
        if (cases[i].part)
            assert_refused("c.png", cases[i].part);
        else
            assert_int_equal(tc_image_check(NULL, in_folder("c.png"), NULL, writer, NULL), TC_OK);
    }
}

static void other_formats_are_not_decoded_to_the_end(void **state)
{
    (void)state;
    for (int i = 1; i < 4; i++) {
        void *data;
        size_t n;
        tc_error err = {0};
        put_image(names[i], 90, 70);
        must(tc_file_read(&data, &n, in_folder(names[i]), &err), &err);
        for (size_t part = 1; part < 10; part++) {
            put_bytes(names[i], data, n * part / 10);
            assert_refused(names[i], "is damaged or cut short: ");
        }
        if (i < 3) { /* compressed with a checksum */
            for (size_t k = 0; k < 40; k++)
                ((uint8_t *)data)[n * 5 / 10 + k] ^= 0x55;
            put_bytes(names[i], data, n);
            assert_refused(names[i], "is damaged or cut short: ");
        }
        free(data);
    }
}

static void what_is_no_such_file_is_not_told(void **state)
{
    (void)state;
    assert_refused("none.png", "none.png is not there");
    put_bytes("text.png", "a text of some length", 21);
    assert_refused("text.png", "does not begin as an image does");
    put_image("a.exr", 8, 8);
    assert_int_equal(rename(in_folder("a.exr"), in_folder("b.png")), 0);
    assert_refused("b.png", "is no png file, as its name says, but openexr");
    assert_int_equal(mkdir(in_folder("d.png"), 0700), 0);
    assert_refused("d.png", "is no file");
    rmdir(in_folder("d.png"));
    assert_int_equal(mkfifo(in_folder("p.png"), 0600), 0); /* which must not be waited for */
    assert_refused("p.png", "is no file");
    assert_int_equal(tc_image_check(NULL, NULL, NULL, NULL, NULL), TC_E_ARG);
}

#define TEST(f) cmocka_unit_test_teardown(f, teardown)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(a_whole_file_is_refused_or_its_text_lost),
        TEST(a_changed_byte_of_a_png_is_not_found),
        TEST(a_short_png_is_whole),
        TEST(chunks_out_of_order_are_a_png),
        TEST(other_formats_are_not_decoded_to_the_end),
        TEST(what_is_no_such_file_is_not_told),
    };
    return cmocka_run_group_tests(tests, group_setup, group_teardown);
}
