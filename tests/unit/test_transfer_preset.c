/* Tests of reading and writing ParaView presets. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "transfer_functions/preset.h"
#include "transfer_functions/transfer.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static tc_preset_list parse(const char *text)
{
    tc_preset_list list;
    tc_error err = {0};
    if (tc_preset_parse(&list, text, strlen(text), "test.json", &err) != TC_OK)
        fail_msg("%s", err.text);
    return list;
}

static void temporary(char *out, const char *suffix)
{
    const char *folder = getenv("TMPDIR");
    snprintf(out, 200, "%s/tc_preset_%ld%s", folder ? folder : "/tmp", (long)getpid(), suffix);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static const char dirty[] =
    "\xEF\xBB\xBF/* maps */ [\n"
    "  { // the first\n"
    "    \"Name\": \"One, ] } // \\\" \xFF\", \"ColorSpace\" : \"CIELAB\", \"NanColor\": [NaN, 0, 0,],\n"
    "    \"Gamma\": -Infinity, # a shell's comment\n"
    "    \"RGBPoints\": [0, 0,0,0, 1, 1,1,1,],\n"
    "    \"Points\": [0, 0, 0.5, 0, 1, 1, 0.25, 0.5 ,  ],\n"
    "  },\n"
    "  {\"Name\": \"Two\", \"IndexedColors\": [1,0,0, 0,1,0, 0,0,1], \"NanColor\": [0.5, 0.25, 1]},\n"
    "  {\"Name\": \"Bad\", \"RGBPoints\": [0, 0,0,0, 1, 1,1]},\n"
    "  {\"Name\": \"Worse\", \"RGBPoints\": [0, 0,0,nan, 1, 1,1,1]},\n"
    "  {\"Name\": \"Odd\", \"ColorSpace\": \"Prolab2\", \"RGBPoints\": [0, 0,0,0, 1, 1,1,1]},\n"
    "  {\"Name\": \"Back\", \"RGBPoints\": [1, 1,0,0, 0, 0,0,1, 1, 0,1,0]},\n"
    "  {},\n"
    "],\n";

static void real_json_is_refused(void **state)
{
    (void)state;
    tc_preset_list list = parse(dirty);
    assert_int_equal(list.n, 7);
    const tc_preset *one = list.preset[0];
    assert_string_equal(one->name, "One, ] } // \" ?");
    assert_null(one->problem);
    assert_int_equal(one->space, TC_SPACE_LAB);
    assert_int_equal(one->n_color, 2);
    assert_int_equal(one->n_opacity, 2);
    assert_float_equal(one->opacity[1].midpoint, 0.25, 0);
    assert_float_equal(one->opacity[1].sharpness, 0.5, 0);
    assert_false(one->has_nan_color);
    const tc_preset *two = list.preset[1];
    assert_true(two->indexed && two->has_nan_color);
    assert_int_equal(two->n_color, 6);
    assert_float_equal(two->color[2].x, 1, 0);
    assert_float_equal(two->color[2].rgb[1], 1, 0);
    assert_float_equal(two->color[1].x, 1, 0);
    assert_float_equal(two->color[1].rgb[0], 1, 0);
    for (int i = 2; i < 5; i++)
        assert_non_null(list.preset[i]->problem);
    assert_non_null(strstr(list.preset[4]->problem, "Prolab2"));
    const tc_preset *back = list.preset[5]; /* sorted, equal ones in the file's order */
    assert_true(back->sorted && !back->problem);
    assert_float_equal(back->color[0].rgb[2], 1, 0);
    assert_float_equal(back->color[1].rgb[0], 1, 0);
    assert_float_equal(back->color[2].rgb[1], 1, 0);
    assert_non_null(list.preset[6]->problem);
    tc_preset_list_finish(&list);
}

static void maps_of_a_file_are_not_what_their_texts_make(void **state)
{
    (void)state;
    const char *const usable[] = {"One, ] } // \" ?", "Two", "Back"};
    char path[220];
    temporary(path, "_maps.json");
    write_text(path, dirty);
    tc_text_pair *pair;
    size_t n;
    tc_error err = {0};
    assert_int_equal(tc_transfer_presets(&pair, &n, path, &err), TC_OK);
    assert_int_equal(n, 3); /* what cannot be used is left out */
    for (size_t i = 0; i < n; i++) {
        assert_string_equal(pair[i].key, usable[i]);
        const tc_transfer_options whole = {.color_map = path, .preset = usable[i], .data_range = {-3, 7}},
                                  alone = {.color_map = pair[i].value, .data_range = {-3, 7}};
        tc_transfer *a, *b;
        assert_int_equal(tc_transfer_create(&a, &whole, &err), TC_OK);
        assert_int_equal(tc_transfer_create(&b, &alone, &err), TC_OK);
        assert_string_equal(a->name, b->name);
        assert_int_equal(a->n, b->n);
        for (size_t k = 0; k < a->n; k++) {
            assert_float_equal(a->knot[k].s, b->knot[k].s, 1e-12);
            assert_float_equal(a->knot[k].g, b->knot[k].g, 1e-12);
            assert_float_equal(a->knot[k].a, b->knot[k].a, 1e-12);
        }
        tc_transfer_destroy(&a);
        tc_transfer_destroy(&b);
    }
    free(pair);
    assert_int_equal(tc_transfer_presets(&pair, &n, "viridis", &err), TC_OK); /* a built-in one, as one writes it */
    assert_int_equal(n, 1);
    assert_string_equal(pair[0].key, "Viridis");
    free(pair);
    write_text(path, "[{\"Name\": \"Bad\", \"RGBPoints\": [0, 0,0,0, 1, 1,1]}]");
    assert_int_equal(tc_transfer_presets(&pair, &n, path, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "Bad"));
    unlink(path);
    assert_int_equal(tc_transfer_presets(&pair, &n, path, &err), TC_E_FILE);
    assert_int_equal(tc_transfer_presets(&pair, &n, "[{]", &err), TC_E_ARG);
    assert_int_equal(tc_transfer_presets(&pair, &n, "no such map", &err), TC_E_ARG);
    assert_null(pair);
}

static void logarithmic_maps_of_paraview_are_laid_by_their_scalars(void **state)
{
    (void)state;
    tc_preset_list list = parse("[{\"RGBPoints\": [1, 0,0,0, 10, 1,0,0, 1000, 1,1,1], \"UseLogScale\": 1,"
                                " \"Points\": [0.01, 0, 0.5, 0, 1, 0.5, 0.5, 0, 10000, 1, 0.5, 0]},"
                                " {\"RGBPoints\": [1, 0,0,0, 10, 1,0,0, 1000, 1,1,1], \"UseLogScale\": 0},"
                                " {\"RGBPoints\": [0, 0,0,0, 10, 1,0,0, 1000, 1,1,1], \"UseLogScale\": 1}]");
    assert_int_equal(list.n, 3);
    const double expected[3][3] = {{0, 1, 3}, {1, 10, 1000}, {0, 10, 1000}}; /* the last has no logarithm */
    for (int m = 0; m < 3; m++)
        for (int i = 0; i < 3; i++)
            assert_float_equal(list.preset[m]->color[i].x, expected[m][i], 1e-14);
    for (int i = 0; i < 3; i++)
        assert_float_equal(list.preset[0]->opacity[i].x, -2 + i * (i + 1), 1e-14);
    tc_preset_list_finish(&list);
}

static void bad_files_are_taken_or_not_explained(void **state)
{
    (void)state;
    const char *const bad[] = {"",
                               "  \n",
                               "[",
                               "{",
                               "[]",
                               "7",
                               "\"text\"",
                               "[1, 2]",
                               "hello",
                               "{\"a\" \"b\"}",
                               "[{\"Name\":}]",
                               "<ColorMap",
                               "<ColorMap name=\"x\">",
                               "<a><b/></a>",
                               "<ColorMap name=x></ColorMap>",
                               "/* open",
                               "// only",
                               "\xEF\xBB\xBF",
                               "[{\"Name\": \"x"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        tc_preset_list list;
        tc_error err = {0};
        if (tc_preset_parse(&list, bad[i], strlen(bad[i]), "bad.file", &err) != TC_E_FILE)
            fail_msg("\"%s\" was taken", bad[i]);
        assert_non_null(strstr(err.text, "bad.file"));
        assert_int_equal(list.n, 0);
    }
    tc_preset_list list;
    tc_error err = {0};
    assert_int_equal(tc_preset_read(&list, "/nowhere/at.all", &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "/nowhere/at.all"));
    assert_int_equal(tc_preset_read(&list, "/", &err), TC_E_FILE);
}

/* Every cut of a file ends in an error or a list, never elsewhere (run with sanitizers). */
static void truncated_text_breaks_the_parser(void **state)
{
    (void)state;
    static const char xml[] = "<?xml version='1.0'?><!DOCTYPE a><ColorMaps><!-- c --><ColorMap name=\"a &amp; b\" "
                              "space='Wrapped'><Point x='0' o='0' r='1' g='0' b='0'/><Point x='2' o='.5' r='0' g='0' "
                              "b='1'/><NaN r='1' g='1' b='0'/></ColorMap></ColorMaps>";
    const char *const whole[] = {dirty, xml};
    for (int f = 0; f < 2; f++)
        for (size_t length = 0; length <= strlen(whole[f]); length++) {
            char *cut = malloc(length + 1); /* its own block, so that a read behind the end is seen */
            memcpy(cut, whole[f], length);
            tc_preset_list list;
            if (tc_preset_parse(&list, cut, length, "cut", NULL) == TC_OK)
                assert_true(list.n > 0);
            tc_preset_list_finish(&list);
            free(cut);
        }
    tc_preset_list list = parse(xml);
    assert_int_equal(list.n, 1);
    assert_string_equal(list.preset[0]->name, "a & b");
    assert_int_equal(list.preset[0]->space, TC_SPACE_HSV);
    assert_true(list.preset[0]->hsv_wrap);
    assert_int_equal(list.preset[0]->n_opacity, 2);
    assert_float_equal(list.preset[0]->opacity[1].a, 0.5, 0);
    assert_true(list.preset[0]->has_nan_color);
    tc_preset_list_finish(&list);
    list = parse("<ColorMap name='o'><Point x='0' o='1' r='1' g='0' b='0'/><Point x='1' o='1' r='0' g='0' "
                 "b='0'/></ColorMap>");
    assert_int_equal(list.preset[0]->n_opacity, 0); /* filled in, not meant */
    tc_preset_list_finish(&list);
}

static void real_presets_do_not_all_parse(void **state)
{
    (void)state;
    static const char *const name[] = {"ParaView_ColorMaps.json", "OkuboWeiss.json", "GreenRedColorMap.xml"};
    static const size_t count[] = {199, 1, 1};
    size_t unordered = 0;
    for (int f = 0; f < 3; f++) {
        char path[1000];
        snprintf(path, sizeof path, "%s/tf/%s", TC_SHARED_DATA, name[f]);
        if (access(path, R_OK) != 0)
            skip();
        tc_preset_list list;
        tc_error err = {0};
        if (tc_preset_read(&list, path, &err) != TC_OK)
            fail_msg("%s", err.text);
        assert_int_equal(list.n, count[f]);
        for (size_t i = 0; i < list.n; i++) {
            if (list.preset[i]->problem)
                fail_msg("%s: %s", list.preset[i]->name, list.preset[i]->problem);
            for (size_t k = 1; k < list.preset[i]->n_color; k++)
                unordered += !list.preset[i]->indexed && list.preset[i]->color[k].x == list.preset[i]->color[k - 1].x;
            tc_transfer *tf = NULL;
            if (f == 0 && i % 9 != 0)
                continue;
            const tc_transfer_options options = {
                .color_map = path, .preset = list.preset[i]->name, .data_range = {-1, 3}};
            if (tc_transfer_create(&tf, &options, &err) != TC_OK)
                fail_msg("%s", err.text);
            tc_transfer_destroy(&tf);
        }
        tc_preset_list_finish(&list);
    }
    assert_true(unordered >= 5);
}

static void wrong_map_of_a_file_is_chosen(void **state)
{
    (void)state;
    char path[200];
    temporary(path, "_choose.json");
    write_text(path, dirty);
    tc_transfer *tf = NULL;
    tc_error err = {0};
    tc_transfer_options options = {.color_map = path, .preset = "two", .data_range = {0, 3}};
    assert_int_equal(tc_transfer_create(&tf, &options, &err), TC_OK);
    double v[4];
    tc_transfer_evaluate(v, tf, 1.5);
    assert_float_equal(v[1], 1, 0);
    tc_transfer_evaluate(v, tf, 0.999999);
    assert_float_equal(v[0], 1, 0);
    tc_transfer_evaluate(v, tf, NAN);
    assert_float_equal(v[0], 0.5, 0);
    tc_transfer_destroy(&tf);
    options.preset = "Tow";
    assert_int_equal(tc_transfer_create(&tf, &options, &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "\"Two\""));
    options.preset = "Worse";
    assert_int_equal(tc_transfer_create(&tf, &options, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "point 0"));
    options.preset = NULL; /* the first, with its own opacity */
    assert_int_equal(tc_transfer_create(&tf, &options, &err), TC_OK);
    tc_transfer_evaluate(v, tf, 1.5);
    assert_float_equal(v[3], 0.5, 1e-12);
    tc_transfer_evaluate(v, tf, 3);
    assert_float_equal(v[3], 1, 1e-12);
    tc_transfer_destroy(&tf);
    options.opacity = path; /* and as a file of opacity */
    options.color_map = "Jet";
    assert_int_equal(tc_transfer_create(&tf, &options, &err), TC_OK);
    tc_transfer_evaluate(v, tf, 0.75);
    assert_float_equal(v[3], 0.25, 1e-12);
    tc_transfer_destroy(&tf);
    write_text(path, "[{\"Name\": \"N\", \"RGBPoints\": [0, 0,0,0, 1, 1,1,1]}]");
    assert_int_equal(tc_transfer_create(&tf, &options, &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "Points"));
    unlink(path);
}

/* Written, read again over the range the file has, and compared everywhere. */
static void written_presets_differ(void **state)
{
    (void)state;
    const char *const opacity[] = {"linear", "sigmoid", "-4:0,0.5:1,0.5:3,9:2", "2:1"};
    const char *const suffix[] = {"_a.json", "_b.xml", "_C.XML"};
    const char *const map[] = {"Cool to Warm", "Jet", "Turbo"};
    for (int i = 0; i < 4 * 3 * 3; i++) {
        char path[200];
        temporary(path, suffix[i % 3]);
        tc_transfer_options options = {.color_map = map[i / 3 % 3], .opacity = opacity[i / 9], .data_range = {-1, 5}};
        tc_transfer *a = NULL, *b = NULL;
        tc_error err = {0};
        if (tc_transfer_create(&a, &options, &err) != TC_OK || tc_transfer_write(a, path, &err) != TC_OK)
            fail_msg("%s", err.text);
        double span[2];
        tc_transfer_span(span, a);
        const tc_transfer_options again = {.color_map = path, .has_range = true, .range = {span[0], span[1]}};
        if (tc_transfer_create(&b, &again, &err) != TC_OK)
            fail_msg("%s", err.text);
        for (int k = -100; k <= 1100; k++) {
            double v[4], w[4];
            const double s = -4.003 + 13 * k / 1000.0;
            tc_transfer_evaluate(v, a, s);
            tc_transfer_evaluate(w, b, s);
            for (int c = 0; c < 4; c++)
                if (fabs(v[c] - w[c]) > 2e-4)
                    fail_msg("%s, %s, %s: channel %d at %g is %g, not %g", map[i / 3 % 3], opacity[i / 9],
                             suffix[i % 3], c, s, w[c], v[c]);
        }
        assert_string_equal(tc_transfer_name(b), map[i / 3 % 3]);
        tc_transfer_destroy(&a);
        tc_transfer_destroy(&b);
        unlink(path);
    }
}

static void failed_write_leaves_a_file(void **state)
{
    (void)state;
    const tc_knot knot[] = {{0, 0, 0, 0, 0}, {1, 1, 1, 1, 1}};
    tc_transfer *tf = NULL;
    tc_error err = {0};
    assert_int_equal(tc_transfer_from_knots(&tf, knot, 2, NULL), TC_OK);
    assert_int_equal(tc_transfer_write(tf, "/nowhere/at/all.json", &err), TC_E_FILE);
    assert_non_null(strstr(err.text, "/nowhere/at/all.json"));
    assert_int_equal(tc_transfer_write(tf, "", &err), TC_E_ARG);
    char path[200];
    temporary(path, "_folder");
    rmdir(path);
    char inside[230];
    snprintf(inside, sizeof inside, "%s/x.json", path);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_int_equal(mkdir(inside, 0700), 0);
    assert_int_equal(tc_transfer_write(tf, inside, &err), TC_E_FILE); /* a folder stands in the way */
    assert_int_equal(rmdir(inside), 0);
    assert_int_equal(rmdir(path), 0); /* fails if anything was left beside */
    tc_transfer_destroy(&tf);
}

static void decimal_comma_of_a_locale_spoils_numbers(void **state)
{
    (void)state;
    const char *const comma[] = {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"};
    bool found = false;
    for (int i = 0; i < 4 && !found; i++)
        found = setlocale(LC_ALL, comma[i]) != NULL;
    if (!found)
        skip();
    tc_transfer *tf = NULL;
    const tc_transfer_options options = {.data_range = {0, 1}, .opacity = "0.5:0.25,1.5:0.75"};
    assert_int_equal(tc_transfer_create(&tf, &options, NULL), TC_OK);
    double v[4];
    tc_transfer_evaluate(v, tf, 1);
    assert_float_equal(v[3], 0.5, 1e-12);
    tc_transfer_destroy(&tf);
    setlocale(LC_ALL, "C");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(real_json_is_refused),
        cmocka_unit_test(maps_of_a_file_are_not_what_their_texts_make),
        cmocka_unit_test(logarithmic_maps_of_paraview_are_laid_by_their_scalars),
        cmocka_unit_test(bad_files_are_taken_or_not_explained),
        cmocka_unit_test(truncated_text_breaks_the_parser),
        cmocka_unit_test(real_presets_do_not_all_parse),
        cmocka_unit_test(wrong_map_of_a_file_is_chosen),
        cmocka_unit_test(written_presets_differ),
        cmocka_unit_test(failed_write_leaves_a_file),
        cmocka_unit_test(decimal_comma_of_a_locale_spoils_numbers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
