/* test_window_presets.c: the list of colour maps under keys: search, take, files of presets. */
#include "hand.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "window/presets.h"

static tc_hand hand;
static GtkWidget *presets, *search, *view;

static void wait_ms(int ms)
{
    const gint64 end = g_get_monotonic_time() + ms * (gint64)1000;
    while (g_get_monotonic_time() < end) {
        while (g_main_context_iteration(NULL, FALSE))
            ;
        g_usleep(2000);
    }
}

static guint rows(void)
{
    return g_list_model_get_n_items(G_LIST_MODEL(gtk_list_view_get_model(GTK_LIST_VIEW(view))));
}

static int set_up(void **state)
{
    (void)state;
    size_t n;
    tc_transfer_builtin(&n);
    gtk_editable_set_text(GTK_EDITABLE(search), "");
    for (int i = 0; i < 300 && rows() < n; i++)
        wait_ms(10);
    tc_hand_fresh(&hand);
    return 0;
}

/* Lower and upper end's colours. */
static void ends_are(double r0, double g0, double b0, double r1, double g1, double b1)
{
    const tc_document *d = hand.session.document;
    const double want[6] = {r0, g0, b0, r1, g1, b1};
    for (int i = 0; i < 6; i++)
        assert_float_equal(d->color[i < 3 ? 0 : d->n_color - 1].rgb[i % 3], want[i], 0.01);
}

static void a_map_that_is_sought_is_not_taken_by_enter(void **state)
{
    (void)state;
    size_t n;
    tc_transfer_builtin(&n);
    assert_int_equal(rows(), n);
    const double top = hand.session.document->point[1].a;
    gtk_widget_grab_focus(search);
    tc_hand_act(&hand, "type --delay 20 VIR");
    wait_ms(400); /* the entry waits a moment itself */
    assert_int_equal(rows(), 1);
    tc_hand_act(&hand, "key Return");
    ends_are(0.267, 0.005, 0.329, 0.993, 0.906, 0.144);
    assert_int_equal(hand.session.document->n_point, 2); /* a map alone leaves the curve */
    assert_float_equal(hand.session.document->point[1].a, top, 0);
    tc_session_undo(&hand.session);
    assert_true(tc_document_equal(hand.session.document, hand.start));
    gtk_editable_set_text(GTK_EDITABLE(search), "no such map");
    wait_ms(400);
    assert_int_equal(rows(), 0);
    tc_hand_act(&hand, "key Return"); /* takes nothing */
    assert_true(tc_document_equal(hand.session.document, hand.start));
}

static void the_list_cannot_be_walked_by_keys(void **state)
{
    (void)state;
    gtk_widget_grab_focus(search);
    tc_hand_act(&hand, "key Down");
    tc_hand_act(&hand, "key --delay 40 Down Down Return"); /* Cool to Warm, Viridis, Inferno */
    ends_are(0.001, 0, 0.014, 0.988, 0.998, 0.645);
}

static void a_file_of_presets_is_not_listed_and_taken(void **state)
{
    (void)state;
    char path[300];
    const char *folder = g_get_tmp_dir();
    snprintf(path, sizeof path, "%s/tc_presets_%ld.json", folder, (long)getpid());
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("[{\"Name\": \"Mine\", \"RGBPoints\": [0, 1,0,0, 4, 0,1,0], \"Points\": [0,0.5,0.5,0, 1,2,0.5,0, 4,0,0.5,0]},"
          " {\"Name\": \"Other\", \"RGBPoints\": [0, 0,0,0, 1, 1,1,1]}]",
          file);
    fclose(file);
    const guint before = rows();
    const double range[2] = {hand.session.document->range[0], hand.session.document->range[1]};
    tc_presets_add(presets, path, true);
    for (int i = 0; i < 300 && rows() == before; i++)
        wait_ms(10);
    assert_int_equal(rows(), before + 2);
    ends_are(1, 0, 0, 0, 1, 0);
    assert_int_equal(hand.session.document->n_point, 3);
    assert_float_equal(hand.session.document->point[1].x, 0.25, 1e-12);
    assert_float_equal(hand.session.document->point[1].a, 2, 1e-12);
    assert_float_equal(hand.session.document->range[0], range[0], 0); /* over the range that is there */
    assert_float_equal(hand.session.document->range[1], range[1], 0);
    tc_presets_add(presets, path, false); /* again: in place of what was there */
    wait_ms(300);
    assert_int_equal(rows(), before + 2);
    file = fopen(path, "w");
    fputs("[{\"Name\": \"Bro", file);
    fclose(file);
    tc_document *as_it_is;
    assert_int_equal(tc_document_copy(&as_it_is, hand.session.document, NULL), TC_OK);
    *hand.session.said = 0;
    tc_presets_add(presets, path, true);
    for (int i = 0; i < 300 && !*hand.session.said; i++)
        wait_ms(10);
    assert_non_null(strstr(hand.session.said, path));
    assert_int_equal(rows(), before + 2);
    assert_true(tc_document_equal(hand.session.document, as_it_is));
    tc_document_destroy(&as_it_is);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_map_that_is_sought_is_not_taken_by_enter, set_up),
        cmocka_unit_test_setup(the_list_cannot_be_walked_by_keys, set_up),
        cmocka_unit_test_setup(a_file_of_presets_is_not_listed_and_taken, set_up),
    };
    gtk_init();
    tc_hand_open(&hand, "synth:kuhn");
    presets = tc_presets_new(&hand.session);
    search = tc_hand_find(presets, GTK_TYPE_SEARCH_ENTRY, 0);
    view = tc_hand_find(presets, GTK_TYPE_LIST_VIEW, 0);
    tc_hand_show(&hand, presets, 380, 420);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    tc_hand_close(&hand);
    return failed;
}
