/* test_window_colors.c: colours, range and unit distance under a pointer and keys. */
#include "hand.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "window/color_bar.h"
#include "window/plot.h"

static tc_hand hand;
static GtkWidget *bar, *strip, *range;

static tc_document *document(void)
{
    return hand.session.document;
}

static double px(double place)
{
    return tc_plot_x(gtk_widget_get_width(strip), place);
}

static void near(double value, double expected, double by)
{
    if (!(fabs(value - expected) <= by))
        fail_msg("%g is not %g", value, expected);
}

static void key(const char *keys)
{
    tc_hand_act(&hand, "key --delay 12 %s", keys);
}

static GtkWidget *labelled(const char *text)
{
    for (int i = 0;; i++) {
        GtkWidget *button = tc_hand_find(bar, GTK_TYPE_BUTTON, i);
        assert_non_null(button);
        const char *label = gtk_button_get_label(GTK_BUTTON(button));
        if (label && !strcmp(label, text))
            return button;
    }
}

static void push(const char *text)
{
    GtkWidget *button = labelled(text);
    tc_hand_click(&hand, button, 10, 10, 1);
}

static void type_into(GtkWidget *entry, const char *text)
{
    tc_hand_click(&hand, entry, 20, 12, 1);
    key("ctrl+a");
    tc_hand_act(&hand, "type --delay 12 %s", text);
    key("Return");
}

static int set_up(void **state)
{
    (void)state;
    tc_hand_fresh(&hand);
    return 0;
}

static void two_clicks_on_the_strip_make_a_colour_that_changes_nothing(void **state)
{
    (void)state;
    double before[3], after[3];
    const size_t n = document()->n_color;
    tc_document_color(before, document(), 0.25);
    tc_hand_click(&hand, strip, px(0.25), 10, 2);
    assert_int_equal(document()->n_color, n + 1);
    size_t i = 0;
    while (!document()->color[i].selected)
        i++;
    near(document()->color[i].x, 0.25, 0.006);
    tc_document_color(after, document(), 0.25);
    for (int c = 0; c < 3; c++)
        near(after[c], before[c], 0.02);
    gtk_widget_grab_focus(strip);
    key("Delete");
    assert_true(tc_document_equal(document(), hand.start));
}

static void a_colour_goes_where_it_is_dragged_as_one_step(void **state)
{
    (void)state;
    const double from = document()->color[1].x;
    tc_hand_press(&hand, strip, px(from), 28, px(0.7), 28);
    assert_true(hand.session.moving);
    near(document()->color[1].x, 0.7, 0.006);
    tc_hand_act(&hand, "mouseup 1");
    assert_false(hand.session.moving);
    assert_true(document()->color[0].x == 0);
    tc_session_undo(&hand.session);
    assert_true(tc_document_equal(document(), hand.start));
    /* The ends stay. */
    tc_hand_drag(&hand, strip, px(0), 28, px(0.3), 28);
    assert_true(document()->color[0].x == 0);
}

static void keys_walk_and_move_colours(void **state)
{
    (void)state;
    gtk_widget_grab_focus(strip);
    const double from = document()->color[1].x;
    key("Home Tab Right shift+Right");
    near(document()->color[1].x, from + 0.022, 1e-9);
    key("F2 ctrl+a");
    tc_hand_act(&hand, "type --delay 12 %g", tc_document_scalar(document(), 0.25));
    key("Return");
    near(document()->color[1].x, 0.25, 1e-5);
}

static void the_range_goes_by_its_ends_and_as_a_whole(void **state)
{
    (void)state;
    const double lo = hand.start->range[0], hi = hand.start->range[1], all = hi - lo;
    /* The bar shows 4 % more on both sides. */
    const double x_lo = 0.04 / 1.08, per = 1 / 1.08;
    tc_hand_drag(&hand, range, px(x_lo), 15, px(x_lo + 0.25 * per), 15);
    near(document()->range[0], lo + 0.25 * all, 0.01 * all);
    assert_true(document()->range[1] == hi);
    const double low = document()->range[0];
    tc_hand_drag(&hand, range, px(x_lo + 0.6 * per), 15, px(x_lo + 0.5 * per), 15);
    near(document()->range[0], low - 0.1 * all, 0.01 * all);
    near(document()->range[1], hi - 0.1 * all, 0.01 * all);
    tc_session_undo(&hand.session);
    tc_session_undo(&hand.session);
    assert_true(tc_document_equal(document(), hand.start));
}

static void ranges_come_from_data_percentiles_and_what_is_visible(void **state)
{
    (void)state;
    const double *data = hand.session.run.report.scalar_range;
    GtkWidget *entry = tc_hand_find(gtk_widget_get_next_sibling(range), GTK_TYPE_ENTRY, 0);
    type_into(entry, "0.25");
    assert_true(document()->range[0] == 0.25);
    push("Data");
    assert_true(document()->range[0] == data[0] && document()->range[1] == data[1]);
    push("Percentile");
    assert_true(document()->range[0] == tc_histogram_percentile(hand.session.histogram, 0.01));
    assert_true(document()->range[1] == tc_histogram_percentile(hand.session.histogram, 0.99));
    /* A look at a part of it: as the histogram of that camera has it. */
    tc_camera camera = hand.session.camera;
    hand.session.camera.parallel = true;
    hand.session.camera.parallel_scale = 0.2;
    hand.session.width = 300;
    hand.session.height = 200;
    const tc_histogram_options options = {.n = 16, .camera = &hand.session.camera, .aspect = 1.5};
    tc_histogram *seen = NULL;
    tc_error err;
    assert_int_equal(tc_mesh_histogram(&seen, hand.session.run.mesh, &options, &err), TC_OK);
    assert_true(seen->counted > 0 && (seen->range[0] > data[0] || seen->range[1] < data[1]));
    push("Visible");
    tc_hand_act(&hand, "sleep 0.4");
    assert_true(document()->range[0] == seen->range[0] && document()->range[1] == seen->range[1]);
    tc_histogram_destroy(&seen);
    hand.session.camera = camera;
}

static void a_range_that_is_none_is_refused_with_a_sentence(void **state)
{
    (void)state;
    GtkWidget *entry = tc_hand_find(gtk_widget_get_next_sibling(range), GTK_TYPE_ENTRY, 0);
    type_into(entry, "99");
    assert_true(tc_document_equal(document(), hand.start));
    assert_non_null(strstr(hand.session.said, "lower end"));
    type_into(entry, "nonsense");
    assert_true(tc_document_equal(document(), hand.start));
    char number[32];
    assert_string_equal(gtk_editable_get_text(GTK_EDITABLE(entry)), tc_plot_number(number, document()->range[0], 7));
}

static void a_logarithmic_scale_begins_above_zero(void **state)
{
    (void)state;
    GtkWidget *log = NULL;
    for (int i = 0; !log; i++) {
        GtkWidget *check = tc_hand_find(bar, GTK_TYPE_CHECK_BUTTON, i);
        assert_non_null(check);
        if (!strcmp(gtk_check_button_get_label(GTK_CHECK_BUTTON(check)), "Log scale"))
            log = check;
    }
    GtkWidget *entry = tc_hand_find(gtk_widget_get_next_sibling(range), GTK_TYPE_ENTRY, 0);
    type_into(entry, "0");
    tc_hand_click(&hand, log, 8, 8, 1);
    assert_true(document()->log && document()->range[0] > 0);
    near(document()->range[0], 1e-4 * document()->range[1], 1e-12);
    tc_hand_click(&hand, log, 8, 8, 1);
    assert_false(document()->log);
    hand.session.document->range[0] = -3;
    hand.session.document->range[1] = -1;
    tc_session_edited(&hand.session, "set range");
    tc_hand_click(&hand, log, 8, 8, 1);
    assert_false(document()->log);
    assert_false(gtk_check_button_get_active(GTK_CHECK_BUTTON(log)));
    assert_non_null(strstr(hand.session.said, "above 0"));
}

static void the_slider_of_the_unit_distance_is_one_step_a_drag(void **state)
{
    (void)state;
    GtkWidget *slider = tc_hand_find(bar, GTK_TYPE_SCALE, 0);
    const double unit = tc_default_unit_distance(hand.session.run.mesh);
    const double middle = 0.5 * gtk_widget_get_width(slider);
    assert_true(document()->unit_distance == 0);
    tc_hand_press(&hand, slider, middle, 8, 1.5 * middle, 8);
    assert_true(hand.session.moving);
    tc_hand_act(&hand, "mouseup 1");
    assert_false(hand.session.moving);
    assert_true(document()->unit_distance > 10 * unit && document()->unit_distance < 100 * unit);
    tc_session_undo(&hand.session);
    assert_true(tc_document_equal(document(), hand.start));
    tc_session_redo(&hand.session);
    push("Default");
    assert_true(tc_document_equal(document(), hand.start));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(two_clicks_on_the_strip_make_a_colour_that_changes_nothing, set_up),
        cmocka_unit_test_setup(a_colour_goes_where_it_is_dragged_as_one_step, set_up),
        cmocka_unit_test_setup(keys_walk_and_move_colours, set_up),
        cmocka_unit_test_setup(the_range_goes_by_its_ends_and_as_a_whole, set_up),
        cmocka_unit_test_setup(ranges_come_from_data_percentiles_and_what_is_visible, set_up),
        cmocka_unit_test_setup(a_range_that_is_none_is_refused_with_a_sentence, set_up),
        cmocka_unit_test_setup(a_logarithmic_scale_begins_above_zero, set_up),
        cmocka_unit_test_setup(the_slider_of_the_unit_distance_is_one_step_a_drag, set_up),
    };
    gtk_init();
    tc_hand_open(&hand, "synth:kuhn");
    bar = tc_color_bar_new(&hand.session);
    strip = gtk_widget_get_first_child(bar);
    range = gtk_widget_get_next_sibling(strip);
    tc_hand_show(&hand, bar, 500, 300);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    tc_hand_close(&hand);
    return failed;
}
