/* test_study_run.c: a study that is stopped goes on to the same rows, and every knob turns what it says. */
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

/* Rows seen by the callback, and after which to stop. */
typedef struct seen {
    size_t n, stop_after;
    tc_study_row row[256];
} seen;

static bool on_row(void *user, const tc_study_row *row)
{
    seen *s = user;
    assert_true(s->n < 256);
    s->row[s->n++] = *row;
    return s->stop_after == 0 || s->n < s->stop_after;
}

static void remove_folder(const char *folder)
{
    static const char *const files[] = {"study.key",     "results.csv", "rotation.csv",
                                        "fragments.csv", "summary.csv", "study.json"};
    char path[256];
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, files[i]);
        unlink(path);
    }
    static const char *const plots[] = {"error-time", "table-size", "samples", "rotation", "fragments"};
    for (size_t i = 0; i < sizeof plots / sizeof *plots; i++) {
        snprintf(path, sizeof path, "%s/%s-it.gp", folder, plots[i]);
        unlink(path);
    }
    rmdir(folder);
}

static tc_mesh *make_mesh(const char *name, size_t cells)
{
    tc_mesh *mesh = NULL;
    tc_error err = {0};
    const tc_prepare_options prepare = {.reentry = TC_REENTRY_AUTO};
    if (tc_synth_create(&mesh, name, cells, 1, &err) != TC_OK || tc_mesh_prepare(mesh, &prepare, NULL, &err) != TC_OK)
        fail_msg("%s", err.text);
    return mesh;
}

static tc_transfer *make_function(const char *name, const tc_mesh *mesh)
{
    tc_transfer *tf = NULL;
    tc_error err = {0};
    tc_mesh_report report;
    tc_mesh_get_report(&report, mesh);
    if (tc_transfer_standard(&tf, name, report.scalar_range, &err) != TC_OK)
        fail_msg("%s", err.text);
    return tf;
}

/* One go at a study of all that options ask for. */
static tc_status go(seen *out, const tc_study_options *options, tc_mesh *mesh, const tc_transfer *tf)
{
    tc_error err = {0};
    tc_study *study = NULL;
    tc_study_options o = *options;
    o.row = on_row;
    o.user = out;
    tc_status status = tc_study_open(&study, &o, NULL, &err);
    if (status != TC_OK)
        fail_msg("%s", err.text);
    status = tc_study_scene(study, "it", mesh, "f", tf, &err);
    if (status == TC_OK) {
        size_t plots = 0;
        assert_true(tc_study_has(study, "it", "f"));
        assert_int_equal(tc_study_report(study, &plots, &err), TC_OK);
        assert_true(plots >= 1);
        assert_null(tc_study_plot(study, plots));
    } else {
        assert_int_equal(status, TC_E_CANCEL);
        assert_false(tc_study_has(study, "it", "f"));
    }
    tc_study_close(&study);
    return status;
}

static const tc_study_row *find(const seen *s, int view, const char *setting)
{
    for (size_t i = 0; i < s->n; i++)
        if (s->row[i].view == view && !strcmp(s->row[i].setting, setting))
            return &s->row[i];
    fail_msg("view %d has no row of %s", view, setting);
    return NULL;
}

static void a_study_that_is_stopped_goes_on_to_the_same_rows(void **state)
{
    (void)state;
    char whole_folder[] = "/tmp/tc-study-XXXXXX", parts_folder[] = "/tmp/tc-study-XXXXXX";
    static seen whole, parts;
    tc_mesh *mesh = make_mesh("kuhn", 300);
    tc_transfer *tf = make_function("knots12", mesh);
    assert_non_null(mkdtemp(whole_folder));
    assert_non_null(mkdtemp(parts_folder));
    tc_study_options o = {.folder = whole_folder,
                          .knobs = "table8,exact,stop-0.99,reentry",
                          .width = 16,
                          .height = 12,
                          .views = 3,
                          .frames = 1,
                          .seed = 5};
    memset(&whole, 0, sizeof whole);
    memset(&parts, 0, sizeof parts);
    assert_int_equal(go(&whole, &o, mesh, tf), TC_OK);
    assert_int_equal(whole.n, 3 * 6);
    o.folder = parts_folder;
    int goes = 0;
    for (tc_status status = TC_E_CANCEL; status == TC_E_CANCEL; goes++) { /* 5 rows at a time */
        parts.stop_after = parts.n + 5;
        status = go(&parts, &o, mesh, tf);
        assert_true(goes < 6);
    }
    assert_true(goes >= 4);
    assert_int_equal(parts.n, whole.n);
    for (size_t i = 0; i < whole.n; i++) {
        const tc_study_row *a = &whole.row[i], *b = find(&parts, a->view, a->setting);
        assert_string_equal(a->truth, b->truth);
        assert_true(a->max_error == b->max_error || (isnan(a->max_error) && isnan(b->max_error)));
        assert_int_equal(a->steps, b->steps);
        assert_int_equal(a->ill_posed, b->ill_posed);
        assert_string_equal(a->note, b->note);
    }
    /* All is there: a further go measures nothing. */
    seen none = {0};
    assert_int_equal(go(&none, &o, mesh, tf), TC_OK);
    assert_int_equal(none.n, 0);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    remove_folder(whole_folder);
    remove_folder(parts_folder);
}

static void a_folder_of_another_request_is_refused_until_it_is_dropped(void **state)
{
    (void)state;
    char folder[] = "/tmp/tc-study-XXXXXX";
    tc_study *study = NULL;
    tc_error err = {0};
    assert_non_null(mkdtemp(folder));
    tc_study_options o = {.folder = folder, .width = 8, .height = 8, .views = 1, .request = "one"};
    assert_int_equal(tc_study_open(&study, &o, NULL, &err), TC_OK);
    tc_study_close(&study);
    o.views = 2;
    assert_int_equal(tc_study_open(&study, &o, NULL, &err), TC_E_ARG);
    assert_null(study);
    assert_non_null(strstr(err.text, folder));
    assert_non_null(strstr(err.text, "--restart"));
    o.views = 1;
    o.request = "two";
    assert_int_equal(tc_study_open(&study, &o, NULL, &err), TC_E_ARG);
    o.request = "one";
    o.knobs = "exact"; /* more knobs are no other request */
    assert_int_equal(tc_study_open(&study, &o, NULL, &err), TC_OK);
    tc_study_close(&study);
    o.request = "two";
    o.restart = true;
    assert_int_equal(tc_study_open(&study, &o, NULL, &err), TC_OK);
    tc_study_close(&study);
    o.knobs = "nonsense";
    assert_int_equal(tc_study_open(&study, &o, NULL, &err), TC_E_ARG);
    remove_folder(folder);
}

static void every_knob_turns_what_it_says(void **state)
{
    (void)state;
    char folder[] = "/tmp/tc-study-XXXXXX";
    static seen s;
    tc_mesh *mesh = make_mesh("comb", 1500);
    tc_transfer *tf = make_function("steps", mesh);
    assert_non_null(mkdtemp(folder));
    const tc_study_options o = {.folder = folder,
                                .knobs = "integrator,split,stop,pass,lock,state,samples,stepper,reentry,driver,figure,"
                                         "table8-32x32,table8-64x64,table16f-32x32",
                                .width = 32,
                                .height = 32,
                                .views = 1,
                                .frames = 1,
                                .unit_distance = 0.05,
                                .seed = 1};
    memset(&s, 0, sizeof s);
    assert_int_equal(go(&s, &o, mesh, tf), TC_OK);
    for (size_t i = 0; i < s.n; i++) { /* each is measured, or says why not */
        const tc_study_row *r = &s.row[i];
        if (isnan(r->ms_median) || isnan(r->max_error))
            fail_msg("%s was not measured: %s", r->setting, r->note);
        if (strcmp(r->setting, "planes") != 0)
            assert_int_equal(r->rays_lost, 0);
    }
    assert_string_equal(find(&s, 0, "table8")->integrator, "table");
    assert_string_equal(find(&s, 0, "exact")->integrator, "exact");
    assert_string_equal(find(&s, 0, "integral2")->integrator, "integral");
    assert_int_equal(find(&s, 0, "integral1")->integral_order, 1);
    assert_int_equal(find(&s, 0, "integral2")->integral_order, 2);
    const double bytes8 = find(&s, 0, "table8")->bytes_table;
    assert_true(find(&s, 0, "table16f")->bytes_table > 1.9 * bytes8);
    assert_true(find(&s, 0, "table32f")->bytes_table > 1.9 * find(&s, 0, "table16f")->bytes_table);
    assert_true(find(&s, 0, "table8-64x64")->bytes_table > 7 * find(&s, 0, "table8-32x32")->bytes_table);
    assert_true(find(&s, 0, "table16f-32x32")->bytes_table > 1.9 * find(&s, 0, "table8-32x32")->bytes_table);
    assert_true(find(&s, 0, "table8-64x64")->bytes_table < bytes8);
    /* Rays that end later err less and take more steps. */
    static const char *const stop[] = {"stop-0.99", "stop-0.995", "stop-0.999", "stop-0.9995", "stop-0.9999", "stop-1"};
    static const double at[] = {0.99, 0.995, 0.999, 0.9995, 0.9999, 1};
    for (size_t i = 0; i < 6; i++) {
        assert_true(fabs(find(&s, 0, stop[i])->opacity_stop - at[i]) < 1e-7);
        if (i > 0)
            assert_true(find(&s, 0, stop[i])->steps >= find(&s, 0, stop[i - 1])->steps);
    }
    assert_true(find(&s, 0, "stop-1")->steps > find(&s, 0, "stop-0.99")->steps);
    assert_true(find(&s, 0, "stop-1")->max_error <= find(&s, 0, "stop-0.99")->max_error);
    assert_int_equal(find(&s, 0, "pass-1")->steps_per_pass, 1);
    assert_int_equal(find(&s, 0, "pass-8")->steps_per_pass, 8);
    assert_true(find(&s, 0, "pass-1")->passes > 2 * find(&s, 0, "pass-8")->passes);
    assert_int_equal(find(&s, 0, "lock-never")->z_update_every, -1);
    assert_true(find(&s, 0, "lock-never")->fragments > 2 * find(&s, 0, "lock-2")->fragments);
    assert_int_equal(find(&s, 0, "lock-2")->z_update_every, 2);
    assert_int_equal(find(&s, 0, "lock-14")->z_update_every, 14);
    assert_int_equal(find(&s, 0, "state-16f")->state_bits, 16);
    assert_int_equal(find(&s, 0, "state-32f")->state_bits, 32);
    assert_true(find(&s, 0, "state-16f")->bytes_state < find(&s, 0, "state-32f")->bytes_state);
    assert_string_equal(find(&s, 0, "samples-16")->samples, "16");
    assert_string_equal(find(&s, 0, "samples-adaptive")->samples, "adaptive");
    assert_string_equal(find(&s, 0, "samples-1")->truth, "area");
    assert_true(find(&s, 0, "samples-4")->steps > 3 * find(&s, 0, "samples-1")->steps);
    assert_true(find(&s, 0, "samples-16")->mean_error < 0.5 * find(&s, 0, "samples-1")->mean_error);
    assert_string_equal(find(&s, 0, "signs")->stepper, "signs");
    assert_string_equal(find(&s, 0, "planes")->stepper, "planes");
    assert_string_equal(find(&s, 0, "convexify")->reentry, "convexify");
    assert_string_equal(find(&s, 0, "peel")->reentry, "peel");
    assert_string_equal(find(&s, 0, "reference")->driver, "reference");
    assert_true(find(&s, 0, "reference")->max_error < 1e-6);
    tc_mesh_report report; /* gaps are as they were */
    tc_mesh_get_report(&report, mesh);
    assert_int_equal(report.reentry, TC_REENTRY_CONVEXIFY);
    tc_transfer_destroy(&tf);
    tc_mesh_destroy(&mesh);
    remove_folder(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_study_that_is_stopped_goes_on_to_the_same_rows),
        cmocka_unit_test(a_folder_of_another_request_is_refused_until_it_is_dropped),
        cmocka_unit_test(every_knob_turns_what_it_says),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
