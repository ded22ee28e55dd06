/* test_window_curve.c: the opacity curve under a pointer and keys. */
#include "hand.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "window/curve.h"
#include "window/curve_state.h"
#include "window/plot.h"

static tc_hand hand;
static tc_curve *curve;

static tc_document *document(void)
{
    return hand.session.document;
}

/* Pixels of the plot. */
static double px(double place)
{
    return tc_plot_x(gtk_widget_get_width(curve->area), place);
}

static double py(double opacity)
{
    tc_curve_frame frame;
    tc_curve_frame_get(&frame, curve);
    return tc_curve_y(curve, &frame, opacity);
}

static void drag(double x0, double a0, double x1, double a1)
{
    tc_hand_drag(&hand, curve->area, px(x0), py(a0), px(x1), py(a1));
}

static void key(const char *keys)
{
    tc_hand_act(&hand, "key --delay 12 %s", keys);
}

/* A pixel is some 0.003 of the axes. */
static void near(double value, double expected, double by)
{
    if (!(fabs(value - expected) <= by))
        fail_msg("%g is not %g", value, expected);
}

static size_t selected(void)
{
    size_t n = 0;
    for (size_t i = 0; i < document()->n_point; i++)
        n += document()->point[i].selected;
    return n;
}

/* The start: 0 to 0.3, on a linear axis up to 1. */
static int set_up(void **state)
{
    (void)state;
    tc_curve_tool_set(curve, TC_TOOL_SELECT);
    gtk_check_button_set_active(GTK_CHECK_BUTTON(curve->axis_button), false);
    tc_hand_fresh(&hand);
    tc_curve_top_set(curve, 1);
    tc_hand_act(&hand, "mousemove 2 2");
    return 0;
}

static void a_press_on_the_curve_makes_a_point_that_goes_along(void **state)
{
    (void)state;
    drag(0.4, 0.12, 0.6, 0.7);
    assert_int_equal(document()->n_point, 3);
    near(document()->point[1].x, 0.6, 0.006);
    near(document()->point[1].a, 0.7, 0.012);
    assert_true(document()->point[1].selected);
    assert_false(hand.session.moving);
    assert_int_equal(hand.session.gesture, 0);
    /* All of it is one step. */
    tc_session_undo(&hand.session);
    assert_true(tc_document_equal(document(), hand.start));
    tc_session_redo(&hand.session);
    assert_int_equal(document()->n_point, 3);
}

static void while_a_point_is_dragged_the_session_knows_of_a_hand(void **state)
{
    (void)state;
    tc_hand_press(&hand, curve->area, px(1), py(0.3), px(1), py(0.8));
    assert_true(hand.session.moving);
    near(document()->point[1].a, 0.8, 0.012); /* before the button is let go */
    tc_hand_act(&hand, "mouseup 1");
    assert_false(hand.session.moving);
}

static void escape_takes_a_drag_back(void **state)
{
    (void)state;
    tc_hand_press(&hand, curve->area, px(1), py(0.3), px(1), py(0.8));
    key("Escape");
    assert_true(tc_document_equal(document(), hand.start));
    assert_false(hand.session.moving);
    tc_hand_act(&hand, "mousemove_relative -- 0 30 mouseup 1");
    assert_true(tc_document_equal(document(), hand.start));
}

static void ends_keep_their_places_and_delete_leaves_them(void **state)
{
    (void)state;
    drag(0, 0, 0.3, 0.5);
    assert_true(document()->point[0].x == 0);
    near(document()->point[0].a, 0.5, 0.012);
    drag(0.25, 0.45, 0.25, 0.9);
    assert_int_equal(document()->n_point, 3);
    key("ctrl+a Delete");
    assert_int_equal(document()->n_point, 2);
    assert_true(document()->point[1].x == 1);
}

static void a_rectangle_selects_and_all_that_is_selected_goes_along(void **state)
{
    (void)state;
    drag(0.3, 0.09, 0.3, 0.6);
    drag(0.7, 0.43, 0.7, 0.6);
    drag(0.4, 0.6, 0.4, 0.65);
    assert_int_equal(document()->n_point, 5);
    drag(0.2, 0.9, 0.6, 0.5); /* from the background */
    assert_int_equal(selected(), 2);
    const double a1 = document()->point[1].a, a2 = document()->point[2].a, a3 = document()->point[3].a;
    drag(0.3, a1, 0.3, a1 - 0.2);
    near(document()->point[1].a, a1 - 0.2, 0.012);
    near(a2 - document()->point[2].a, a1 - document()->point[1].a, 1e-9);
    assert_true(document()->point[3].a == a3);
    /* Shift adds to what is selected; a press on nothing takes all away. */
    tc_hand_act(&hand, "keydown shift");
    tc_hand_click(&hand, curve->area, px(0.7), py(a3), 1);
    tc_hand_act(&hand, "keyup shift");
    assert_int_equal(selected(), 3);
    tc_hand_click(&hand, curve->area, px(0.9), py(0.95), 1);
    assert_int_equal(selected(), 0);
}

static void handles_between_points_bend_the_curve(void **state)
{
    (void)state;
    drag(0.5, 0.15, 0.7, 0.15);
    near(document()->point[0].midpoint, 0.7, 0.01);
    assert_true(document()->point[0].sharpness == 0);
    drag(0.7, 0.15, 0.7, 0.45);
    near(document()->point[0].midpoint, 0.7, 0.01);
    near(document()->point[0].sharpness, 0.5, 0.03);
    assert_int_equal(document()->n_point, 2);
    tc_hand_click(&hand, curve->area, px(document()->point[0].midpoint), py(0.15), 2);
    assert_true(document()->point[0].midpoint == 0.5 && document()->point[0].sharpness == 0);
}

static void a_logarithmic_axis_reaches_small_values_and_zero(void **state)
{
    (void)state;
    gtk_check_button_set_active(GTK_CHECK_BUTTON(curve->axis_button), true);
    drag(1, 0.3, 1, 3e-4);
    assert_true(document()->point[1].a > 2.4e-4 && document()->point[1].a < 3.7e-4);
    drag(1, document()->point[1].a, 1, 0);
    assert_true(document()->point[1].a == 0);
    /* Several keep their ratio. */
    tc_hand_fresh(&hand);
    drag(0.4, 0.12, 0.4, 0.1);
    key("ctrl+a");
    const double ratio = document()->point[2].a / document()->point[1].a;
    assert_int_equal(document()->n_point, 3);
    drag(0.4, document()->point[1].a, 0.4, 0.001);
    near(document()->point[2].a / document()->point[1].a, ratio, 1e-6 * ratio);
    assert_true(document()->point[0].a == 0 && document()->point[1].a < 0.0013);
}

static void a_line_by_hand_becomes_the_curve(void **state)
{
    (void)state;
    for (int log = 0; log < 2; log++) {
        tc_hand_fresh(&hand);
        gtk_check_button_set_active(GTK_CHECK_BUTTON(curve->axis_button), log);
        tc_curve_top_set(curve, 1);
        tc_hand_click(&hand, curve->tool_button[TC_TOOL_FREEHAND], 8, 8, 1);
        int a[2], b[2], c[2];
        const double low = log ? 0.001 : 0.1, high = log ? 0.5 : 0.8;
        tc_hand_place(a, &hand, curve->area, px(0.2), py(low));
        tc_hand_place(b, &hand, curve->area, px(0.5), py(high));
        tc_hand_place(c, &hand, curve->area, px(0.8), py(low));
        tc_hand_act(
            &hand,
            "mousemove %d %d sleep 0.05 mousedown 1 sleep 0.05 mousemove %d %d sleep 0.05 mousemove %d %d sleep "
            "0.05 mouseup 1",
            a[0], a[1], b[0], b[1], c[0], c[1]);
        const double axis_low = tc_axis_place(&curve->axis, low), axis_high = tc_axis_place(&curve->axis, high);
        for (double x = 0.22; x < 0.79; x += 0.01) {
            const double t = x < 0.5 ? (x - 0.2) / 0.3 : (0.8 - x) / 0.3;
            const double place = tc_axis_place(&curve->axis, tc_document_opacity(document(), x));
            near(place, axis_low + t * (axis_high - axis_low), 0.03);
        }
        /* Beside it all is as it was. */
        near(tc_document_opacity(document(), 0.1), 0.03, 1e-6);
        near(tc_document_opacity(document(), 0.9), 0.27, 1e-6);
        tc_session_undo(&hand.session);
        assert_true(tc_document_equal(document(), hand.start));
        tc_curve_tool_set(curve, TC_TOOL_SELECT);
    }
}

static void shapes_lie_where_they_were_dragged(void **state)
{
    (void)state;
    for (int tool = TC_TOOL_GAUSSIAN; tool <= TC_TOOL_STEP; tool++) {
        tc_hand_fresh(&hand);
        tc_hand_click(&hand, curve->tool_button[tool], 8, 8, 1);
        drag(0.3, 0.5, 0.6, 0.8);
        near(tc_document_opacity(document(), 0.45), 0.8, 0.02);
        near(tc_document_opacity(document(), 0.2), 0.06, 1e-6);
        near(tc_document_opacity(document(), 0.7), 0.21, 1e-6);
        assert_true(selected() >= 3);
        assert_int_equal(curve->tool, TC_TOOL_SELECT);
        tc_session_undo(&hand.session);
        assert_true(tc_document_equal(document(), hand.start));
    }
}

static void keys_do_all_that_the_pointer_does(void **state)
{
    (void)state;
    gtk_widget_grab_focus(curve->area);
    key("Home Insert");
    assert_int_equal(document()->n_point, 3);
    near(document()->point[1].x, 0.5, 1e-12);
    key("Right Right shift+Right");
    near(document()->point[1].x, 0.524, 1e-9);
    key("shift+Up Down");
    near(document()->point[1].a, 0.15 + 0.05 - 0.005, 1e-9);
    assert_false(hand.session.moving);
    key("alt+Right alt+Up");
    assert_true(document()->point[1].midpoint > 0.5 && document()->point[1].sharpness > 0);
    /* Typed. */
    key("Return");
    assert_true(gtk_widget_get_mapped(curve->popover));
    key("ctrl+a");
    tc_hand_act(&hand, "type --delay 30 0.125");
    key("Return");
    assert_false(gtk_widget_get_mapped(curve->popover));
    assert_true(document()->point[1].a == 0.125);
    near(document()->point[1].x, 0.524, 1e-9);
    /* From point to point, and out of it at the last. */
    key("Tab");
    assert_int_equal(curve->focus, 2);
    assert_true(gtk_widget_has_focus(curve->area));
    key("shift+Tab Delete");
    assert_int_equal(document()->n_point, 2);
    key("End Tab");
    assert_false(gtk_widget_has_focus(curve->area));
}

static void the_axis_grows_over_what_is_typed_and_is_dragged_by_its_label(void **state)
{
    (void)state;
    gtk_widget_grab_focus(curve->area);
    key("End Return ctrl+a");
    tc_hand_act(&hand, "type --delay 30 7");
    key("Return");
    assert_true(document()->point[1].a == 7);
    assert_true(curve->axis.top >= 7 && curve->axis.top <= 10);
    const double top = curve->axis.top;
    tc_hand_drag(&hand, curve->area, TC_PLOT_LEFT - 20, TC_CURVE_ABOVE, TC_PLOT_LEFT - 20, TC_CURVE_ABOVE + 120);
    near(curve->axis.top, top / 10, 0.03 * top);
}

/* Whatever was done, undo leads back to the start, and redo to the end. */
static void random_hands_can_be_undone(void **state)
{
    (void)state;
    static const char *const keys[] = {"Up",     "Down",   "shift+Left", "Right",  "Tab",       "shift+Tab",
                                       "Delete", "Insert", "Home",       "alt+Up", "ctrl+a",    "alt+Left",
                                       "space",  "Escape", "shift+Up",   "End",    "ctrl+Left", "BackSpace"};
    GRand *rand = g_rand_new_with_seed(7);
    for (int i = 0; i < 40; i++) {
        const double x0 = g_rand_double_range(rand, -0.1, 1.1), x1 = g_rand_double_range(rand, -0.2, 1.2);
        const double a1 = g_rand_double_range(rand, -0.2, 1.2);
        double a0 = g_rand_double_range(rand, -0.1, 1.1);
        if (g_rand_boolean(rand))
            a0 = tc_document_opacity(document(), fmin(fmax(x0, 0), 1));
        if (g_rand_int_range(rand, 0, 6) == 0)
            tc_curve_tool_set(curve, (tc_curve_tool)g_rand_int_range(rand, 0, TC_TOOLS));
        if (g_rand_int_range(rand, 0, 3) == 0)
            key(keys[g_rand_int_range(rand, 0, G_N_ELEMENTS(keys))]);
        else
            drag(x0, a0, x1, a1);
        const tc_document *d = document();
        assert_true(d->point[0].x == 0 && d->point[d->n_point - 1].x == 1);
        for (size_t k = 0; k < d->n_point; k++)
            assert_true(d->point[k].a >= 0 && (k == 0 || d->point[k].x >= d->point[k - 1].x));
        assert_false(hand.session.moving);
    }
    g_rand_free(rand);
    tc_document *end = NULL;
    tc_error err;
    assert_int_equal(tc_document_copy(&end, document(), &err), TC_OK);
    assert_false(tc_document_equal(end, hand.start));
    while (tc_history_undo_what(hand.session.history))
        tc_session_undo(&hand.session);
    assert_true(tc_document_equal(document(), hand.start));
    while (tc_history_redo_what(hand.session.history))
        tc_session_redo(&hand.session);
    assert_true(tc_document_equal(document(), end));
    tc_document_destroy(&end);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(a_press_on_the_curve_makes_a_point_that_goes_along, set_up),
        cmocka_unit_test_setup(while_a_point_is_dragged_the_session_knows_of_a_hand, set_up),
        cmocka_unit_test_setup(escape_takes_a_drag_back, set_up),
        cmocka_unit_test_setup(ends_keep_their_places_and_delete_leaves_them, set_up),
        cmocka_unit_test_setup(a_rectangle_selects_and_all_that_is_selected_goes_along, set_up),
        cmocka_unit_test_setup(handles_between_points_bend_the_curve, set_up),
        cmocka_unit_test_setup(a_logarithmic_axis_reaches_small_values_and_zero, set_up),
        cmocka_unit_test_setup(a_line_by_hand_becomes_the_curve, set_up),
        cmocka_unit_test_setup(shapes_lie_where_they_were_dragged, set_up),
        cmocka_unit_test_setup(keys_do_all_that_the_pointer_does, set_up),
        cmocka_unit_test_setup(the_axis_grows_over_what_is_typed_and_is_dragged_by_its_label, set_up),
        cmocka_unit_test_setup(random_hands_can_be_undone, set_up),
    };
    gtk_init();
    tc_hand_open(&hand, "synth:kuhn");
    GtkWidget *box = tc_curve_new(&hand.session);
    curve = g_object_get_data(G_OBJECT(box), "tetcast-curve");
    tc_hand_show(&hand, box, 500, 420);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    tc_hand_close(&hand);
    return failed;
}
