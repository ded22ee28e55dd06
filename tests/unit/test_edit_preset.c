/* test_edit_preset.c: documents of the transfer-function window as presets, read and written, and from knots. */
#define _POSIX_C_SOURCE 200809L
#include "edit/document.h"

#include <jansson.h>
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "edit_make.h"

static void text_and_back_is_another_document(void **state)
{
    (void)state;
    uint64_t seed = 17;
    for (int run = 0; run < 200; run++) {
        tc_document *d = random_document(&seed), *e = copy(d);
        const tc_edit_space space = run % 6 == 0 ? TC_EDIT_CIEDE2000 : d->space;
        d->space = space;
        for (int unit = 0; unit < 2; unit++) {
            char *text = tc_document_text(d, unit);
            assert_non_null(text);
            take(e, text, NULL);
            check(e);
            assert_string_equal(e->name, d->name);
            assert_int_equal(e->space, d->space);
            assert_int_equal(e->hsv_wrap, d->hsv_wrap);
            assert_int_equal(e->n_point, d->n_point);
            assert_int_equal(e->n_color, d->n_color);
            for (size_t i = 0; i < d->n_point; i++) {
                const tc_edit_point *p = &d->point[i], *q = &e->point[i];
                assert_near(p->x, q->x, 1e-12);
                assert_true(p->a == q->a && p->midpoint == q->midpoint && p->sharpness == q->sharpness);
                assert_true(!unit || p->x == q->x);
            }
            for (size_t i = 0; i < d->n_color; i++) {
                assert_near(d->color[i].x, e->color[i].x, 1e-12);
                assert_memory_equal(d->color[i].rgb, e->color[i].rgb, sizeof d->color[i].rgb);
            }
            if (unit) {
                assert_true(tc_document_equal(d, e));
                char *again = tc_document_text(e, unit);
                assert_string_equal(again, text);
                free(again);
            }
            free(text);
        }
        tc_document_destroy(&d);
        tc_document_destroy(&e);
    }
}

static void saved_preset_renders_otherwise(void **state)
{
    (void)state;
    uint64_t seed = 19;
    char path[64];
    snprintf(path, sizeof path, "/tmp/tetcast_document_%ld.json", (long)getpid());
    for (int run = 0; run < 60; run++) {
        tc_document *d = random_document(&seed);
        tc_transfer *shown = function(d), *saved, *unit;
        for (int k = 0; k < 2; k++) {
            char *text = tc_document_text(d, k);
            FILE *file = fopen(path, "w");
            assert_true(file && fputs(text, file) >= 0 && fclose(file) == 0);
            free(text);
            const tc_transfer_options options = {
                .color_map = path, .has_range = true, .range = {d->range[0], d->range[1]}, .log = d->log};
            assert_int_equal(tc_transfer_create(k ? &unit : &saved, &options, NULL), TC_OK);
        }
        assert_true(difference(shown, saved) == 0); /* every bit */
        assert_string_equal(tc_transfer_name(shown), tc_transfer_name(saved));
        for (int i = 0; i < 500; i++) {
            double a[4], b[4], c[4];
            const double x = random01(&seed);
            evaluate(a, shown, tc_document_scalar(d, x), false);
            evaluate(b, unit, tc_document_scalar(d, x - 1e-9), false);
            evaluate(c, unit, tc_document_scalar(d, x + 1e-9), false);
            for (int k = 0; k < 4; k++)
                assert_true(a[k] >= fmin(b[k], c[k]) - 2e-3 && a[k] <= fmax(b[k], c[k]) + 2e-3);
        }
        tc_transfer_destroy(&shown);
        tc_transfer_destroy(&saved);
        tc_transfer_destroy(&unit);
        tc_document_destroy(&d);
    }
    unlink(path);
}

/* As vtkSMTransferFunctionProxy takes it: properties by name, points of four numbers, sorted, laid by the first and the
 * last. */
static void preset_breaks_the_rules_of_paraview(void **state)
{
    (void)state;
    static const char *const space[] = {"RGB", "HSV", "Lab", "Diverging", "Lab/CIEDE2000", "Step"};
    static const char *const property[] = {"Name",      "ColorSpace", "HSVWrap",    "NanColor",
                                           "RGBPoints", "Points",     "UseLogScale"};
    uint64_t seed = 23;
    for (int run = 0; run < 60; run++) {
        tc_document *d = random_document(&seed);
        d->space = (tc_edit_space)(run % TC_EDIT_SPACES);
        char *text = tc_document_text(d, false);
        json_t *root = json_loads(text, 0, NULL);
        free(text);
        assert_true(json_is_array(root) && json_array_size(root) == 1);
        const json_t *map = json_array_get(root, 0);
        const char *key;
        json_t *value;
        json_object_foreach((json_t *)map, key, value)
        {
            size_t i = 0;
            while (i < sizeof property / sizeof *property && strcmp(key, property[i]) != 0)
                i++;
            assert_true(i < sizeof property / sizeof *property);
        }
        assert_string_equal(json_string_value(json_object_get(map, "Name")), d->name);
        assert_string_equal(json_string_value(json_object_get(map, "ColorSpace")), space[d->space]);
        assert_int_equal(json_integer_value(json_object_get(map, "UseLogScale")), d->log);
        assert_int_equal(json_integer_value(json_object_get(map, "HSVWrap")), d->hsv_wrap);
        assert_int_equal(json_array_size(json_object_get(map, "NanColor")), 3);
        for (size_t c = 0; c < 3; c++)
            assert_true(json_real_value(json_array_get(json_object_get(map, "NanColor"), c)) == d->nan_color[c]);
        const json_t *rows[] = {json_object_get(map, "RGBPoints"), json_object_get(map, "Points")};
        const size_t n[] = {d->n_color, d->n_point};
        for (int k = 0; k < 2; k++) {
            assert_int_equal(json_array_size(rows[k]), 4 * n[k]);
            for (size_t i = 0; i < 4 * n[k]; i++) {
                assert_true(json_is_real(json_array_get(rows[k], i)));
                assert_true(i % 4 != 0 || i < 4 ||
                            json_real_value(json_array_get(rows[k], i)) >=
                                json_real_value(json_array_get(rows[k], i - 4)));
            }
            assert_true(json_real_value(json_array_get(rows[k], 0)) == d->range[0]);
            assert_true(json_real_value(json_array_get(rows[k], 4 * n[k] - 4)) == d->range[1]);
        }
        for (size_t i = 0; i < d->n_color && d->log;
             i++) /* in log scale points are scalars, laid by their logarithms */
            assert_near(log(json_real_value(json_array_get(rows[0], 4 * i)) / d->range[0]) /
                            log(d->range[1] / d->range[0]),
                        d->color[i].x, 1e-12);
        json_decref(root);
        tc_document_destroy(&d);
    }
}

static void presets_of_paraview_are_not_taken(void **state)
{
    (void)state;
    static const char maps[] =
        "\xEF\xBB\xBF \n[ {\"Name\": \"Bad\", \"RGBPoints\": [0, 1, 1]}, // a comment\n"
        "{\"Name\": \"Bands\", \"IndexedColors\": [1,0,0, 0,1,0, 0,0,1], \"NanColor\": [0.5, 0.25, 0.75]},\n"
        "{\"Name\": \"Wide\", \"ColorSpace\": \"HSV\", \"HSVWrap\": 1, \"RGBPoints\": [-5, 0,0,0, 0, 1,0,0, 15, "
        "1,1,1],\n"
        " \"Points\": [100, 0.5, 0.25, 0.75, 200, 1, 0.5, 0]},\n"
        "{\"Name\": \"One\", \"RGBPoints\": [3, 0.5,0.25,0.125], \"Points\": [2, 0.75, 0.5, 0]},\n"
        "{\"Name\": \"Log (old)\", \"UseLogScale\": 1, \"RGBPoints\": [0.1, 0,0,0, 1, 1,0,0, 1000, 1,1,1]}, ]";
    tc_document *d = create(2, 4);
    d->nan_color[3] = 7;
    take(d, maps, NULL); /* the first that can be used */
    check(d);
    assert_string_equal(d->name, "Bands");
    assert_int_equal(d->n_color, 6);
    assert_int_equal(d->n_point, 2); /* it has no opacity */
    assert_near(d->point[1].a, 0.3, 0);
    assert_near(d->color[2].x, 1.0 / 3, 1e-15);
    assert_true(d->nan_color[1] == 0.25 && d->nan_color[3] == 7 && !d->has_nan_color);
    double rgb[3];
    tc_document_color(rgb, d, 0.3);
    assert_true(rgb[0] == 1 && rgb[1] == 0);
    tc_document_color(rgb, d, 0.34);
    assert_true(rgb[0] == 0 && rgb[1] == 1);
    take(d, maps, "Wide");
    check(d);
    assert_true(d->space == TC_EDIT_HSV && d->hsv_wrap && d->n_color == 3);
    assert_near(d->color[1].x, 0.25, 0);
    assert_true(d->point[0].a == 0.5 && d->point[0].midpoint == 0.25 && d->point[0].sharpness == 0.75);
    assert_true(d->range[0] == 2 && d->range[1] == 4);
    take(d, maps, "One");
    check(d);
    assert_int_equal(d->space, TC_EDIT_RGB);
    assert_false(d->hsv_wrap);
    assert_int_equal(d->n_color, 2);
    tc_document_color(rgb, d, 0.7);
    assert_near(rgb[1], 0.25, 1e-12);
    assert_near(tc_document_opacity(d, 0.2), 0.75, 0);
    take(d, maps, "log_(OLD)"); /* names as the library takes them */
    assert_string_equal(d->name, "Log (old)");
    assert_near(d->color[1].x, 0.25, 1e-14);
    take(d, "viridis", NULL);
    assert_string_equal(d->name, "Viridis");
    tc_document_destroy(&d);
}

static void refused_preset_changes_the_document(void **state)
{
    (void)state;
    static const struct {
        const char *text, *name, *said;
    } bad[] = {{"", NULL, "empty"},
               {" \n\t", NULL, "empty"},
               {"[{", NULL, "JSON"},
               {"[]", NULL, "no colour map"},
               {"{\"RGBPoints\": [0, 1]}", NULL, "RGBPoints"},
               {"{\"Name\": \"A\", \"RGBPoints\": [0, 0,0,0, 1, 1,1,1]}", "Blue", "\"A\""},
               {"{\"RGBPoints\": [0, 0,0,0, 1, 1,1,1], \"Points\": [0, -1, 0.5, 0, 1, 1, 0.5, 0]}", NULL, "negative"},
               {"Viridiss", NULL, "Viridis"}};
    uint64_t seed = 29;
    tc_document *d = random_document(&seed), *before = copy(d);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        tc_error err = {0};
        const tc_status status = tc_document_take_preset(d, bad[i].text, bad[i].name, &err);
        assert_true(status == TC_E_ARG || status == TC_E_FILE);
        assert_int_equal(err.code, status);
        if (!strstr(err.text, bad[i].said))
            fail_msg("%s: %s", bad[i].text, err.text);
        assert_true(tc_document_equal(d, before));
        assert_int_not_equal(tc_document_take_preset(d, bad[i].text, bad[i].name, NULL), TC_OK);
    }
    tc_document_destroy(&d);
    tc_document_destroy(&before);
}

static void knots_become_another_function(void **state)
{
    (void)state;
    uint64_t seed = 31;
    for (int run = 0; run < 100; run++) {
        tc_knot knot[40];
        const size_t n = 1 + random_below(&seed, 40);
        double s = run % 2 ? 0.01 : -3, at;
        for (size_t i = 0; i < n; i++) {
            s += i > 0 && random01(&seed) < 0.2 ? 0 : random01(&seed);
            knot[i] = (tc_knot){s, random01(&seed), random01(&seed), random01(&seed), 3 * random01(&seed)};
        }
        if (n > 3 && knot[1].s < knot[2].s && knot[2].s < knot[3].s) { /* one that is not needed */
            const double t = (knot[2].s - knot[1].s) / (knot[3].s - knot[1].s);
            knot[2].a = knot[1].a * (1 - t) + knot[3].a * t;
        }
        tc_transfer *tf, *back;
        assert_int_equal(tc_transfer_from_knots(&tf, knot, n, NULL), TC_OK);
        const double lo = knot[0].s, hi = knot[n - 1].s;
        tc_document *d = create(lo, hi > lo ? hi : lo + 1);
        assert_int_equal(tc_document_take_knots(d, tf, NULL), TC_OK);
        check(d);
        back = function(d);
        for (int i = 0; i < 300; i++) {
            double a[4], b[4], c[4];
            at = lo + (hi - lo) * random01(&seed);
            evaluate(a, tf, at, false);
            evaluate(b, back, at - 1e-10, false);
            evaluate(c, back, at + 1e-10, false);
            for (int k = 0; k < 4; k++)
                assert_true(a[k] >= fmin(b[k], c[k]) - 1e-6 && a[k] <= fmax(b[k], c[k]) + 1e-6);
        }
        if (n > 3 && knot[1].s < knot[2].s && knot[2].s < knot[3].s && knot[0].s < knot[1].s)
            assert_true(d->n_point < n);
        tc_transfer_destroy(&tf);
        tc_transfer_destroy(&back);
        tc_document_destroy(&d);
    }
}

static void knots_of_a_logarithmic_map_are_laid_otherwise(void **state)
{
    (void)state;
    uint64_t seed = 37;
    for (int run = 0; run < 20; run++) {
        tc_document *d = random_document(&seed), *e;
        d->range[0] = 0.01;
        d->range[1] = 200;
        d->log = true;
        tc_transfer *tf = function(d), *back;
        e = copy(d);
        assert_int_equal(tc_document_take_knots(e, tf, NULL), TC_OK);
        check(e);
        back = function(e);
        double top = 1;
        for (size_t i = 0; i < d->n_point; i++)
            top = fmax(top, d->point[i].a);
        for (int i = 0; i < 500; i++) {
            double a[4], b[4], c[4];
            const double x = random01(&seed);
            evaluate(a, tf, tc_document_scalar(d, x), false);
            evaluate(b, back, tc_document_scalar(d, x - 1e-7), false);
            evaluate(c, back, tc_document_scalar(d, x + 1e-7), false);
            for (int k = 0; k < 4; k++)
                assert_true(a[k] >= fmin(b[k], c[k]) - 2e-3 * top && a[k] <= fmax(b[k], c[k]) + 2e-3 * top);
        }
        tc_transfer_destroy(&tf);
        tc_transfer_destroy(&back);
        tc_document_destroy(&d);
        tc_document_destroy(&e);
    }
}

/* A smooth curve of so many knots that each is all but on the line between its neighbours. */
static void dense_knots_are_thinned_into_another_curve(void **state)
{
    (void)state;
    enum { N = 20001 };
    tc_knot *knot = calloc(N, sizeof *knot);
    assert_non_null(knot);
    for (int i = 0; i < N; i++)
        knot[i] = (tc_knot){i / (N - 1.0), 0.5, 0.5, 0.5, 1 + sin(0.3 * i / (N - 1.0))};
    tc_transfer *tf;
    assert_int_equal(tc_transfer_from_knots(&tf, knot, N, NULL), TC_OK);
    tc_document *d = create(0, 1);
    assert_int_equal(tc_document_take_knots(d, tf, NULL), TC_OK);
    assert_true(d->n_color < 100 && d->n_point < N / 2);
    for (int i = 0; i < N; i++)
        assert_near(tc_document_opacity(d, knot[i].s), knot[i].a, 1e-8);
    tc_document_destroy(&d);
    tc_transfer_destroy(&tf);
    free(knot);
}

static void decimal_comma_of_a_locale_spoils_texts(void **state)
{
    (void)state;
    static const char *const name[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "nl_NL.UTF-8"};
    bool found = false;
    for (size_t i = 0; i < sizeof name / sizeof *name && !found; i++)
        found = setlocale(LC_ALL, name[i]) != NULL;
    if (!found)
        skip();
    tc_document *d = create(-1.5, 2.25);
    char *text = tc_document_text(d, false);
    assert_non_null(strstr(text, "-1.5"));
    take(d, text, NULL);
    check(d);
    assert_int_equal(d->n_color, 3);
    free(text);
    setlocale(LC_ALL, "C");
    tc_document_destroy(&d);
}

/* Once it is read, what a document writes stays, to the last digit. */
static void preset_drifts_when_opened_and_saved_again(void **state)
{
    (void)state;
    uint64_t seed = 23;
    int n = 0;
    for (int run = 0; run < 400; run++) {
        tc_document *d = random_document(&seed), *e = copy(d);
        if (!d->log) {
            char *text = tc_document_text(d, false);
            for (int again = 0; again < 3; again++) {
                take(e, text, NULL);
                char *next = tc_document_text(e, false);
                assert_true(again == 0 || strcmp(text, next) == 0);
                free(text);
                text = next;
            }
            free(text);
            n++;
        }
        tc_document_destroy(&d);
        tc_document_destroy(&e);
    }
    assert_true(n > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_and_back_is_another_document),
        cmocka_unit_test(preset_drifts_when_opened_and_saved_again),
        cmocka_unit_test(saved_preset_renders_otherwise),
        cmocka_unit_test(preset_breaks_the_rules_of_paraview),
        cmocka_unit_test(presets_of_paraview_are_not_taken),
        cmocka_unit_test(refused_preset_changes_the_document),
        cmocka_unit_test(knots_become_another_function),
        cmocka_unit_test(knots_of_a_logarithmic_map_are_laid_otherwise),
        cmocka_unit_test(dense_knots_are_thinned_into_another_curve),
        cmocka_unit_test(decimal_comma_of_a_locale_spoils_texts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
