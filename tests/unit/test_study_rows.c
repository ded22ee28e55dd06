/* test_study_rows.c: rows as CSV, files of lines that a killed process left, the table of settings, views. */
#define _GNU_SOURCE
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "study/study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static void a_row_reads_back_as_it_was_written(void **state)
{
    (void)state;
    size_t n;
    tc_text text = {0};
    tc_study_row a, b;
    tc_study_row_clear(&a);
    strcpy(a.scene, "disk_out_ref");
    strcpy(a.function, "smooth");
    strcpy(a.note, "one, \"two\"\nthree");
    a.view = 3;
    a.setting = tc_study_settings(&n)[4].name;
    a.ms_median = 12.25;
    a.max_error = 1e-300;
    a.steps = INT64_C(9007199254740993);
    a.knob = tc_study_settings(&n)[4].knob;
    tc_study_row_write(&text, &a);
    assert_false(text.failed);
    assert_null(strpbrk(text.text, "\"\n"));
    assert_true(tc_study_row_parse(&b, text.text, text.length));
    assert_string_equal(b.scene, a.scene);
    assert_string_equal(b.note, "one; 'two' three");
    assert_ptr_equal(b.setting, a.setting);
    assert_ptr_equal(b.knob, a.knob);
    assert_int_equal(b.view, 3);
    assert_true(b.ms_median == 12.25 && b.max_error == 1e-300 && b.steps == a.steps);
    assert_true(isnan(b.p999_error) && b.rays_lost == -1 && b.passes == -1); /* not measured stays so */
    for (size_t cut = 1; cut < text.length; cut++) /* no part of a row is a row, but for one whose last word is cut */
        if (memchr(text.text + text.length - cut, ',', cut))
            assert_false(tc_study_row_parse(&b, text.text, text.length - cut));
    tc_text_finish(&text);
}

static void what_is_no_row_is_refused(void **state)
{
    (void)state;
    tc_text text = {0};
    tc_study_row row;
    tc_study_row_header(&text);
    assert_false(tc_study_row_parse(&row, text.text, text.length));
    assert_false(tc_study_row_parse(&row, "", 0));
    assert_false(tc_study_row_parse(&row, ",,,", 3));
    tc_text_finish(&text);
}

static void write_file(const char *path, const char *text)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
}

static void a_line_that_was_not_finished_is_cut_off(void **state)
{
    (void)state;
    char folder[] = "/tmp/tc-study-XXXXXX", path[64];
    char *content;
    tc_error err = {0};
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.csv", folder);
    static const struct {
        const char *before, *after;
    } cases[] = {{"", "a,b\n"},
                 {"a", "a,b\n"},
                 {"a,b", "a,b\n"},
                 {"a,b\n", "a,b\n"},
                 {"a,b\n1,2", "a,b\n"},
                 {"a,b\n1,2\n", "a,b\n1,2\n"},
                 {"a,b\n1,2\n3", "a,b\n1,2\n"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        write_file(path, cases[i].before);
        assert_int_equal(tc_lines_open(&content, path, "a,b", &err), TC_OK);
        assert_string_equal(content, cases[i].after);
        free(content);
        assert_int_equal(tc_lines_append(path, "5,6", &err), TC_OK);
        assert_int_equal(tc_lines_open(&content, path, "a,b", &err), TC_OK);
        assert_string_equal(content + strlen(cases[i].after), "5,6\n");
        free(content);
    }
    write_file(path, "a,bc\n1,2\n"); /* another table */
    assert_int_equal(tc_lines_open(&content, path, "a,b", &err), TC_E_FILE);
    write_file(path, "x\n");
    assert_int_equal(tc_lines_open(&content, path, "a,b", &err), TC_E_FILE);
    unlink(path);
    rmdir(folder);
}

static void names_become_words(void **state)
{
    (void)state;
    char word[8];
    tc_study_word(word, sizeof word, "a b,c/d\"efgh");
    assert_string_equal(word, "a_b_c_d");
    tc_study_word(word, sizeof word, "");
    assert_string_equal(word, "_");
}

static void every_setting_has_its_own_name_and_changes_something(void **state)
{
    (void)state;
    size_t n;
    const tc_study_setting *s = tc_study_settings(&n);
    assert_int_equal(n, TC_STUDY_SETTINGS);
    for (size_t i = 0; i < n; i++) {
        tc_render_options plain, changed;
        tc_render_defaults(&plain);
        tc_render_defaults(&changed);
        tc_study_apply(&changed, i);
        const tc_study_change *c = &tc_study_changes[i];
        bool same = !memcmp(&plain, &changed, sizeof plain) && !c->reentry && !c->reference && !c->figure;
        bool is_default =
            !strcmp(s[i].name, "default") || !strcmp(s[i].name, "pingpong") || !strcmp(s[i].name, "signs");
        assert_int_equal(same, is_default);
        assert_int_equal(tc_study_find(s[i].name), (int)i);
        for (size_t j = 0; j < i; j++) {
            tc_render_options other;
            tc_render_defaults(&other);
            tc_study_apply(&other, j);
            bool equal = !memcmp(&other, &changed, sizeof other) && !memcmp(&tc_study_changes[j], c, sizeof *c);
            if (equal && !is_default)
                fail_msg("%s and %s are the same", s[i].name, s[j].name);
        }
    }
}

static void a_list_selects_knobs_and_settings(void **state)
{
    (void)state;
    bool on[TC_STUDY_SETTINGS];
    tc_error err = {0};
    assert_int_equal(tc_study_select(on, "stop,table8", &err), TC_OK);
    size_t n;
    const tc_study_setting *s = tc_study_settings(&n);
    for (size_t i = 0; i < n; i++)
        assert_int_equal(on[i], i == 0 || !strcmp(s[i].knob, "stop") || !strcmp(s[i].name, "table8"));
    assert_int_equal(tc_study_select(on, NULL, &err), TC_OK);
    for (size_t i = 0; i < n; i++)
        assert_true(on[i]);
    assert_int_equal(tc_study_select(on, "stop,nonsense", &err), TC_E_ARG);
    assert_non_null(strstr(err.text, "'nonsense'"));
    assert_non_null(strstr(err.text, "integrator"));
    assert_int_equal(tc_study_select(on, "stop,", &err), TC_E_ARG);
}

static void views_differ_and_some_lie_next_to_an_axis(void **state)
{
    (void)state;
    double a[64], e[64];
    int near_axis = 0;
    for (int i = 0; i < 64; i++) {
        tc_study_view(&a[i], &e[i], i);
        assert_true(fabs(e[i]) < 90 && a[i] >= 0 && a[i] < 360);
        near_axis += i < 8 && (fabs(e[i]) > 85 || (fabs(e[i]) < 3 && fabs(fmod(a[i] + 5, 90) - 5) < 3));
        for (int j = 0; j < i; j++)
            assert_true(fabs(a[i] - a[j]) > 1e-6 || fabs(e[i] - e[j]) > 1e-6);
    }
    assert_in_range(near_axis, 2, 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_row_reads_back_as_it_was_written),
        cmocka_unit_test(what_is_no_row_is_refused),
        cmocka_unit_test(a_line_that_was_not_finished_is_cut_off),
        cmocka_unit_test(names_become_words),
        cmocka_unit_test(every_setting_has_its_own_name_and_changes_something),
        cmocka_unit_test(a_list_selects_knobs_and_settings),
        cmocka_unit_test(views_differ_and_some_lie_next_to_an_axis),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
