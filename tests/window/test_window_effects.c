/* test_window_effects.c: the panel of effects: each option has a control that sets it, and what cannot be is told. */
#include "hand.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "window/effect_row.h"
#include "window/effects.h"

static tc_hand hand;
static GtkWidget *panel;

static tc_effect_row *row_below(GtkWidget *widget, const char *option)
{
    tc_effect_row *row = g_object_get_data(G_OBJECT(widget), "tc-row");
    if (row)
        return !strcmp(row->control.option->name, option) ? row : NULL;
    if (GTK_IS_EXPANDER(widget))
        return row_below(gtk_expander_get_child(GTK_EXPANDER(widget)), option);
    for (GtkWidget *child = gtk_widget_get_first_child(widget); child; child = gtk_widget_get_next_sibling(child))
        if ((row = row_below(child, option)))
            return row;
    return NULL;
}

static tc_effect_row *row_of(const char *option)
{
    tc_effect_row *row = row_below(panel, option);
    if (!row)
        fail_msg("%s has no row", option);
    return row;
}

static void wait_ms(int ms)
{
    const gint64 end = g_get_monotonic_time() + ms * (gint64)1000;
    while (g_get_monotonic_time() < end) {
        while (g_main_context_iteration(NULL, FALSE))
            ;
        g_usleep(2000);
    }
}

static void given(const char *option, const char *text)
{
    char *has = tc_effect_text(&hand.session, option);
    if (g_strcmp0(has, text) != 0)
        fail_msg("%s is %s, not %s", option, has ? has : "not given", text ? text : "nothing");
    g_free(has);
}

static int set_up(void **state)
{
    static const char *const option[] = {"--model", "--iso-color", "--iso-opacity", "--iso",   "--ambient",
                                         "--shade", "--surface",   "--clip-box",    "--title", "--background"};
    (void)state;
    for (size_t i = 0; i < sizeof option / sizeof *option; i++)
        if (tc_session_get(&hand.session, option[i]))
            assert_true(tc_session_set(&hand.session, option[i], NULL));
    wait_ms(20);
    return 0;
}

static void an_option_of_the_table_has_no_control(void **state)
{
    (void)state;
    for (size_t i = 0; i < TC_N_LOOK_OPTION; i++) {
        const char *name = tc_look_option[i].name;
        tc_control control;
        if (!name)
            continue;
        tc_control_make(&control, &tc_look_option[i]);
        const bool elsewhere =
            !strcmp(name, "--iso-color") || !strcmp(name, "--iso-opacity") || !strcmp(name, "--categories");
        assert_int_equal(control.kind == TC_CONTROL_NONE, elsewhere);
        if (elsewhere)
            continue;
        const tc_effect_row *row = row_of(name);
        assert_true(row->widget != NULL);
        if (control.kind == TC_CONTROL_SLIDER && !(control.low < control.value && control.value < control.high))
            fail_msg("%s: %g is no default from %g to %g", name, control.value, control.low, control.high);
    }
    tc_control control;
    for (size_t i = 0; i < TC_N_LOOK_OPTION; i++)
        if (tc_look_option[i].name && !strcmp(tc_look_option[i].name, "--color-bar-place")) {
            tc_control_make(&control, &tc_look_option[i]);
            assert_string_equal(control.title, "Colour bar place");
        }
}

static void surfaces_do_not_follow_their_lines(void **state)
{
    (void)state;
    tc_effect_row *row = row_of("--iso");
    const double *range = hand.session.run.report.scalar_range;
    g_signal_emit_by_name(row->widget, "clicked");
    wait_ms(50);
    assert_int_equal(hand.session.options.look.iso.n, 1);
    assert_float_equal(hand.session.options.look.iso.value[0], 0.5 * (range[0] + range[1]),
                       1e-6 * (range[1] - range[0]));
    assert_int_equal(hand.session.run.render.look->n_iso, 1);
    given("--iso-color", NULL); /* the map's */
    g_signal_emit_by_name(row->widget, "clicked");
    wait_ms(50);
    assert_int_equal(hand.session.options.look.iso.n, 2);
    GtkWidget *button = tc_hand_find(row->box, GTK_TYPE_COLOR_BUTTON, 1);
    const GdkRGBA red = {1, 0, 0, 1};
    gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(button), &red);
    wait_ms(50);
    assert_int_equal(hand.session.options.look.iso_color.n, 2);
    assert_float_equal(hand.session.options.look.iso_color.rgb[1][0], 1, 1e-6);
    GtkWidget *clear = tc_hand_find(row->box, GTK_TYPE_SCALE, 1); /* value, opacity, value, opacity */
    gtk_range_set_value(GTK_RANGE(clear), 0.25);
    assert_true(hand.session.moving); /* coarse while it goes */
    wait_ms(400);
    assert_false(hand.session.moving);
    given("--iso-opacity", "0.25,1");
    GtkWidget *line = gtk_widget_get_parent(clear), *away = gtk_widget_get_last_child(line);
    g_signal_emit_by_name(away, "clicked"); /* of two lists one goes, and what stays is the second's */
    wait_ms(50);
    assert_int_equal(hand.session.options.look.iso.n, 1);
    assert_float_equal(hand.session.options.look.iso_color.rgb[0][0], 1, 1e-6);
    given("--iso-opacity", NULL);
    assert_true(tc_session_set(&hand.session, "--iso-color", NULL) && tc_session_set(&hand.session, "--iso", NULL));
    wait_ms(20);
    assert_null(tc_hand_find(row->box, GTK_TYPE_SCALE, 0));
}

static void light_keeps_what_needs_it_from_being_put_off(void **state)
{
    (void)state;
    tc_effect_row *shade = row_of("--shade"), *ambient = row_of("--ambient");
    assert_false(gtk_widget_get_sensitive(ambient->line));
    gtk_drop_down_set_selected(GTK_DROP_DOWN(shade->widget), 2);
    wait_ms(50);
    given("--shade", "vertex");
    assert_true(gtk_widget_get_sensitive(ambient->line));
    gtk_range_set_value(GTK_RANGE(ambient->widget), 0.5);
    wait_ms(50);
    given("--ambient", "0.5");
    gtk_drop_down_set_selected(GTK_DROP_DOWN(shade->widget), 0);
    wait_ms(50);
    given("--shade", NULL);
    given("--ambient", NULL);
    assert_false(gtk_widget_get_visible(shade->wrong));
    gtk_drop_down_set_selected(GTK_DROP_DOWN(shade->widget), 1);
    wait_ms(50);
    given("--ambient", "0.5"); /* it comes again */
    gtk_range_set_value(GTK_RANGE(ambient->widget), 0.2);
    wait_ms(50);
    given("--ambient", NULL); /* the default */
}

static void what_cannot_be_is_not_told_or_changes_something(void **state)
{
    (void)state;
    tc_effect_row *model = row_of("--model");
    const guint surfaces = 7; /* the last of the choices */
    assert_string_equal(model->control.option->choice[surfaces].name, "isosurface");
    gtk_drop_down_set_selected(GTK_DROP_DOWN(model->widget), surfaces);
    wait_ms(50);
    assert_true(gtk_widget_get_visible(model->wrong));
    assert_non_null(strstr(gtk_label_get_text(GTK_LABEL(model->wrong)), "--iso"));
    given("--model", NULL);
    assert_null(hand.session.run.render.look);
    gtk_drop_down_set_selected(GTK_DROP_DOWN(model->widget), 3);
    wait_ms(50);
    given("--model", "mip");
    assert_false(gtk_widget_get_visible(model->wrong));
}

static void the_box_is_not_that_of_the_sliders(void **state)
{
    (void)state;
    tc_effect_row *row = row_of("--clip-box");
    const double *bounds = hand.session.run.report.bounds, width = bounds[1] - bounds[0];
    GtkWidget *from = tc_hand_find(row->box, GTK_TYPE_SCALE, 0);
    gtk_range_set_value(GTK_RANGE(from), bounds[0] + 0.25 * width);
    wait_ms(400);
    assert_true(hand.session.options.look.has_clip_box);
    assert_float_equal(hand.session.options.look.clip_box[0], bounds[0] + 0.25 * width, 1e-6 * width);
    assert_float_equal(hand.session.options.look.clip_box[1], bounds[1], 1e-6 * width);
    gtk_range_set_value(GTK_RANGE(from), bounds[1]); /* against the other end */
    wait_ms(400);
    assert_true(hand.session.options.look.clip_box[0] < hand.session.options.look.clip_box[1]);
    gtk_switch_set_active(GTK_SWITCH(row->second), false);
    wait_ms(50);
    given("--clip-box", NULL);
}

static void a_colour_or_a_text_is_not_taken(void **state)
{
    (void)state;
    tc_effect_row *background = row_of("--background"), *title = row_of("--title");
    const GdkRGBA color = {0.25, 0.5, 1, 1};
    gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(background->widget), &color);
    gtk_switch_set_active(GTK_SWITCH(background->second), true);
    wait_ms(50);
    given("--background", "0.25,0.5,1");
    gtk_editable_set_text(GTK_EDITABLE(title->widget), "A fin");
    g_signal_emit_by_name(title->widget, "activate");
    given("--title", "A fin");
    assert_true(tc_session_set(&hand.session, "--title", NULL)); /* by other hands */
    assert_string_equal(gtk_editable_get_text(GTK_EDITABLE(title->widget)), "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(an_option_of_the_table_has_no_control, set_up),
        cmocka_unit_test_setup(surfaces_do_not_follow_their_lines, set_up),
        cmocka_unit_test_setup(light_keeps_what_needs_it_from_being_put_off, set_up),
        cmocka_unit_test_setup(what_cannot_be_is_not_told_or_changes_something, set_up),
        cmocka_unit_test_setup(the_box_is_not_that_of_the_sliders, set_up),
        cmocka_unit_test_setup(a_colour_or_a_text_is_not_taken, set_up),
    };
    gtk_init();
    tc_hand_open(&hand, "synth:kuhn");
    panel = tc_effects_new(&hand.session);
    tc_hand_show(&hand, panel, 420, 700);
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    tc_hand_close(&hand);
    return failed;
}
