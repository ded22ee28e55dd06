/* test_edit_schedule.c: plans of pictures, on machines that are simulated: what a rendering takes is so much beside its
 * pixels and so much for each, with noise and accidents; a pointer moves, and the window renders what is next as soon
 * as it can. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "edit/schedule.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------------------------------ a machine */

enum { KEYS = 64 };

typedef struct tc_machine {
    double fixed_ms[2], ns[2]; /* new, along kept walks */
    double noise;              /* a time is off by up to this share */
    double accidents;          /* this share of renderings takes three times as long */
    bool keeps;
    bool crowded;    /* all of the mesh is in the middle half of the rows */
    double first_ms; /* programs are compiled, the mesh is uploaded */
    /* what is kept, by view and part */
    unsigned view;
    struct {
        unsigned view;
        int divide, from, rows, seen;
    } key[KEYS];
    size_t n_key;
} tc_machine;

static uint64_t state_of_random = 1;

static double uniform(double lo, double hi)
{
    state_of_random = state_of_random * 6364136223846793005u + 1442695040888963407u;
    return lo + (hi - lo) * ((double)(state_of_random >> 11) * 0x1p-53);
}

/* Blunt Fin on two cores: 70 ms for 800x600, a third of it along kept walks. */
static tc_machine blunt_fin(void)
{
    return (tc_machine){
        .fixed_ms = {10, 5}, .ns = {125, 38}, .noise = 0.2, .accidents = 0.02, .keeps = true, .first_ms = 300};
}

static double density(const tc_machine *machine, double y)
{
    return !machine->crowded ? 1 : y > 0.25 && y < 0.75 ? 2 : 0;
}

static double render(tc_machine *machine, const tc_schedule *schedule, const tc_step *step, bool *kept)
{
    int seen = 0;
    if (machine->keeps) {
        size_t i = 0;
        while (i < machine->n_key &&
               !(machine->key[i].view == machine->view && machine->key[i].divide == step->divide &&
                 machine->key[i].from == step->from && machine->key[i].rows == step->rows))
            i++;
        if (i == machine->n_key) {
            i = i < KEYS ? i : (size_t)uniform(0, KEYS);
            machine->n_key = i < machine->n_key ? machine->n_key : i + 1;
            memset(&machine->key[i], 0, sizeof machine->key[i]);
            machine->key[i].view = machine->view;
            machine->key[i].divide = step->divide;
            machine->key[i].from = step->from;
            machine->key[i].rows = step->rows;
        }
        seen = machine->key[i].seen++;
    }
    *kept = seen >= 2;
    int width = (schedule->width + step->divide - 1) / step->divide;
    int height = (schedule->height + step->divide - 1) / step->divide;
    double pixels = 0;
    for (int y = 0; y < step->rows; y++)
        pixels += width * density(machine, (step->from + y + 0.5) / height);
    double ms = machine->fixed_ms[*kept] + machine->ns[*kept] * pixels * 1e-6;
    ms *= seen == 1 ? 2 : 1; /* it is kept now */
    ms *= uniform(1 - machine->noise, 1 + machine->noise) * (uniform(0, 1) < machine->accidents ? 3 : 1);
    ms += machine->first_ms;
    machine->first_ms = 0;
    return ms;
}

/* ------------------------------------------------------------------------------------------ a window */

enum { MOST = 100000 };

typedef struct tc_seen {
    size_t n, n_latency;
    double ms[MOST], latency[MOST];
    int divide[MOST];
    int changes; /* of the size, from picture to picture */
} tc_seen;

typedef struct tc_window {
    tc_schedule schedule;
    tc_machine machine;
    bool same_view; /* as the last picture's */
    double now;
} tc_window;

static tc_seen seen;

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(double *value, size_t n, double share)
{
    assert_true(n > 0);
    qsort(value, n, sizeof *value, ascending);
    return value[(size_t)(share * (double)(n - 1))];
}

/* A pointer moves each `every` ms for so many of them; a picture that begins shows all that came before. On the screen
 * it is up to a frame of 60 Hz later. skip: pictures that are not looked at. */
static void drag(tc_window *window, int events, double every, bool orbit, size_t skip)
{
    const double begin = window->now;
    int handled = 0;
    int last = 0;
    size_t n = 0;
    memset(&seen, 0, sizeof seen);
    while (handled < events) {
        int came = (int)fmin(floor((window->now - begin) / every), events);
        if (came == handled) {
            window->now = begin + (handled + 1) * every + 1e-9;
            continue;
        }
        tc_schedule_change(&window->schedule, true);
        if (orbit) {
            window->machine.view++;
            window->same_view = false;
        }
        tc_step step;
        assert_true(tc_schedule_next(&step, &window->schedule, window->same_view && window->machine.keeps));
        assert_true(step.from == 0 && step.rows == (window->schedule.height + step.divide - 1) / step.divide);
        bool kept;
        double ms = render(&window->machine, &window->schedule, &step, &kept);
        window->now += ms;
        window->same_view = true;
        /* what comes meanwhile is a change already, before it is told that this one is done */
        if (came < events && floor((window->now - begin) / every) > came)
            tc_schedule_change(&window->schedule, true);
        tc_schedule_done(&window->schedule, &step, ms, kept);
        double shown = window->now + uniform(0, 1000 / 60.);
        if (n++ >= skip) {
            for (int i = handled; i < came && seen.n_latency < MOST; i++)
                seen.latency[seen.n_latency++] = shown - (begin + (i + 1) * every);
            seen.changes += last != 0 && step.divide != last;
            last = step.divide;
            seen.divide[seen.n] = step.divide;
            seen.ms[seen.n++] = ms;
        }
        handled = came;
    }
}

/* Until the picture is whole: the time it took. Each picture is whole, finer than the one before, and the parts are its
 * rows. most: the longest part; parts: their number. */
static double rest(tc_window *window, double *most, int *parts)
{
    const double begin = window->now;
    tc_schedule_rest(&window->schedule);
    tc_step step;
    int row = 0, divide = 0, before = TC_COARSEST + 1;
    bool last = false;
    *most = 0;
    *parts = 0;
    while (tc_schedule_next(&step, &window->schedule, window->same_view && window->machine.keeps)) {
        assert_false(last);
        assert_true(step.divide < before || (step.divide == divide && row > 0));
        assert_int_equal(step.from, row);
        int height = (window->schedule.height + step.divide - 1) / step.divide;
        assert_true(step.rows > 0 && step.from + step.rows <= height);
        row = step.from + step.rows;
        divide = step.divide;
        last = divide == 1 && row == height;
        assert_true(step.last == last);
        if (row == height) {
            before = divide;
            row = 0;
        }
        bool kept;
        double ms = render(&window->machine, &window->schedule, &step, &kept);
        tc_schedule_done(&window->schedule, &step, ms, kept);
        window->same_view = true;
        window->now += ms;
        *most = fmax(*most, ms);
        ++*parts;
        assert_true(*parts < 10000);
    }
    return window->now - begin;
}

static void open_window(tc_window *window, const tc_machine *machine, int width, int height)
{
    *window = (tc_window){.machine = *machine};
    tc_schedule_begin(&window->schedule, width, height);
}

/* ------------------------------------------------------------------------------------------ tests */

static void the_first_picture_is_small(void **state)
{
    (void)state;
    tc_schedule schedule;
    tc_schedule_begin(&schedule, 801, 599);
    tc_step step;
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_int_equal(step.divide, 8);
    assert_int_equal(step.from, 0);
    assert_int_equal(step.rows, 75);
    assert_false(step.last);
    /* what is compiled in it is not taken for the pixels' for long */
    tc_schedule_done(&schedule, &step, 500, false);
    tc_schedule_change(&schedule, true);
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_int_equal(step.divide, 8);
    tc_schedule_done(&schedule, &step, 2, false);
    tc_schedule_change(&schedule, true);
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_true(step.divide <= 2);
}

static void a_drag_of_a_curve_point_stays_within_100_ms(void **state)
{
    (void)state;
    for (int hz = 60; hz <= 1000; hz += 313) {
        tc_window window;
        tc_machine machine = blunt_fin();
        machine.accidents = 0.005;
        open_window(&window, &machine, 800, 600);
        drag(&window, 30, 1000. / hz, true, 0); /* all is known a little */
        drag(&window, 20 * hz, 1000. / hz, false, 4);
        assert_true(quantile(seen.latency, seen.n_latency, 0.5) <= 60);
        assert_true(quantile(seen.ms, seen.n, 0.97) <= 60);
        assert_true(seen.changes <= 4);
        assert_int_equal(seen.divide[seen.n - 1], 1); /* along kept walks there is time for all of it */
    }
}

static void an_orbit_stays_within_100_ms(void **state)
{
    (void)state;
    for (int hz = 60; hz <= 1000; hz += 313) {
        tc_window window;
        tc_machine machine = blunt_fin();
        machine.accidents = 0.005;
        open_window(&window, &machine, 800, 600);
        drag(&window, 20 * hz, 1000. / hz, true, 5);
        print_message("%d Hz: orbit %.0f ms median, a picture %.0f ms\n", hz,
                      quantile(seen.latency, seen.n_latency, 0.5), quantile(seen.ms, seen.n, 0.5));
        assert_true(quantile(seen.latency, seen.n_latency, 0.5) <= 100);
        assert_true(quantile(seen.ms, seen.n, 0.97) <= 60);
        assert_true(seen.divide[seen.n / 2] <= 2);
        assert_true(seen.changes <= 4);
    }
}

static void slower_machines_move_as_quickly_with_less(void **state)
{
    (void)state;
    int before = 1;
    for (double slow = 0.5; slow < 40; slow *= 1.3) {
        tc_window window;
        tc_machine machine = blunt_fin();
        for (int i = 0; i < 2; i++)
            machine.ns[i] *= slow;
        open_window(&window, &machine, 800, 600);
        drag(&window, 3000, 1000. / 60, true, 20);
        assert_true(quantile(seen.latency, seen.n_latency, 0.5) <= 110);
        /* within the budget, and, as there are but few sizes, not far below what it would suffice for */
        double ms = quantile(seen.ms, seen.n, 0.5);
        int divide = seen.divide[seen.n - 1];
        double finer = divide == 1 ? 100 : 10 + slow * 60 / (divide - 1) / (divide - 1);
        if (!(ms <= 60 && finer > 28))
            fail_msg("%.2f times slower: 1/%d, %.0f ms, finer %.0f ms", slow, divide, ms, finer);
        assert_true(divide >= before - 1);
        before = divide;
    }
    assert_true(before >= 6);
}

static void the_size_does_not_flicker(void **state)
{
    (void)state;
    int changes = 0, pictures = 0, machines = 0;
    for (double slow = 0.5; slow < 40; slow *= 1.05, machines++) { /* some are at the edge of a size */
        tc_window window;
        tc_machine machine = blunt_fin();
        machine.accidents = 0.005;
        for (int i = 0; i < 2; i++)
            machine.ns[i] *= slow;
        open_window(&window, &machine, 800, 600);
        drag(&window, 10000, 1000. / 60, true, 20);
        changes += seen.changes;
        pictures += (int)seen.n;
        assert_true(seen.changes <= 12);
    }
    print_message("%d changes of size in %d pictures on %d machines\n", changes, pictures, machines);
    assert_true(changes < pictures / 500);
}

static void full_accuracy_follows_rest_within_a_second(void **state)
{
    (void)state;
    for (int crowded = 0; crowded < 2; crowded++)
        for (double slow = 1; slow < 3; slow *= 1.5) {
            tc_window window;
            tc_machine machine = blunt_fin();
            machine.crowded = crowded;
            for (int i = 0; i < 2; i++)
                machine.ns[i] *= slow;
            open_window(&window, &machine, 800, 600);
            for (int i = 0; i < 30; i++) {
                double most;
                int parts;
                drag(&window, 60, 1000. / 60, i % 2, 0);
                double ms = rest(&window, &most, &parts);
                assert_int_equal(window.schedule.shown, 1);
                if (ms > (i < 2 ? 2500 : 1000))
                    fail_msg("%.2f times slower, rest %d: %.0f ms in %d parts", slow, i, ms, parts);
            }
        }
}

static void a_change_never_waits_for_long(void **state)
{
    (void)state;
    for (int crowded = 0; crowded < 2; crowded++)
        for (double slow = 0.3; slow < 100; slow *= 1.7) {
            tc_window window;
            tc_machine machine = blunt_fin();
            machine.accidents = 0;
            machine.keeps = false;
            machine.crowded = crowded;
            machine.ns[0] *= slow;
            open_window(&window, &machine, 800, 600);
            drag(&window, 200, 1000. / 60, true, 0);
            double waits = 0;
            for (int i = 0; i < 20; i++) {
                double most;
                int parts;
                drag(&window, 20, 1000. / 60, true, 0);
                rest(&window, &most, &parts);
                if (i >= 5)
                    waits = fmax(waits, most);
            }
            if (waits > 2 * 40 * (1 + machine.noise))
                fail_msg("%.2f times slower%s: %.0f ms", slow, crowded ? ", crowded" : "", waits);
        }
}

static void a_picture_of_seconds_comes_by_and_by(void **state)
{
    (void)state;
    tc_window window;
    tc_machine machine = {.fixed_ms = {45, 30}, .ns = {9000, 3000}, .noise = 0.1}; /* ten million tets: 4.4 s */
    open_window(&window, &machine, 800, 600);
    drag(&window, 100, 1000. / 60, true, 5);
    assert_int_equal(seen.divide[seen.n - 1], 8);
    tc_schedule_rest(&window.schedule);
    int order[8], n = 0;
    double reached[8] = {0}, ms = 0, most = 0;
    tc_step step;
    bool kept;
    while (tc_schedule_next(&step, &window.schedule, false)) {
        if (n == 0 || order[n - 1] != step.divide)
            order[n++] = step.divide;
        double part = render(&machine, &window.schedule, &step, &kept);
        tc_schedule_done(&window.schedule, &step, part, kept);
        most = fmax(most, part);
        reached[n - 1] = ms += part;
    }
    print_message("ten million tets: 1/4 after %.0f ms, 1/2 after %.0f, all after %.0f; parts of %.0f at most\n",
                  reached[0], reached[1], reached[2], most);
    assert_int_equal(n, 3);
    assert_true(order[0] == 4 && order[1] == 2 && order[2] == 1);
    assert_true(reached[0] < 1300 && reached[1] < 4000 && reached[2] < 2.5 * 1.31 * 4400);
    assert_true(most <= 5 * 45); /* parts: no less than thrice what each takes beside its pixels */
}

static void parts_are_the_same_from_rest_to_rest(void **state)
{
    (void)state;
    tc_window window;
    tc_machine machine = blunt_fin();
    machine.ns[0] *= 6;
    machine.ns[1] *= 6;
    machine.accidents = 0;
    open_window(&window, &machine, 800, 600);
    drag(&window, 200, 1000. / 60, true, 0);
    int before = 0, changes = 0;
    for (int i = 0; i < 40; i++) {
        double most;
        int parts;
        drag(&window, 5, 1000. / 60, false, 0);
        rest(&window, &most, &parts);
        changes += i > 5 && window.schedule.parts != before;
        before = window.schedule.parts;
    }
    print_message("%d parts, %d changes of their number in 34 pictures\n", before, changes);
    assert_true(before > 4);
    assert_true(changes <= 8);
}

static void another_cost_is_learned_in_a_few_pictures(void **state)
{
    (void)state;
    tc_window window;
    tc_machine machine = blunt_fin();
    machine.accidents = 0;
    open_window(&window, &machine, 800, 600);
    drag(&window, 300, 1000. / 60, true, 0);
    window.machine.ns[0] *= 6; /* zoomed in */
    drag(&window, 600, 1000. / 60, true, 3);
    assert_true(quantile(seen.ms, seen.n, 0.97) <= 65);
    window.machine.ns[0] /= 6;
    drag(&window, 600, 1000. / 60, true, 12);
    assert_true(seen.divide[0] <= 2);
}

static void one_accident_changes_nothing(void **state)
{
    (void)state;
    tc_window window;
    tc_machine machine = blunt_fin();
    machine.accidents = 0;
    open_window(&window, &machine, 800, 600);
    drag(&window, 300, 1000. / 60, true, 0);
    int divide = window.schedule.coarse[0];
    tc_step step;
    tc_schedule_change(&window.schedule, true);
    assert_true(tc_schedule_next(&step, &window.schedule, false));
    tc_schedule_done(&window.schedule, &step, 2000, false);
    tc_schedule_change(&window.schedule, true);
    assert_true(tc_schedule_next(&step, &window.schedule, false));
    assert_int_equal(step.divide, divide);
}

static void walks_that_are_promised_and_never_kept_cost_little(void **state)
{
    (void)state;
    tc_window window;
    tc_machine machine = blunt_fin();
    machine.accidents = 0;
    machine.ns[0] *= 4;
    open_window(&window, &machine, 800, 600);
    drag(&window, 100, 1000. / 60, false, 0); /* kept ones are known to be quick */
    drag(&window, 100, 1000. / 60, true, 0);
    drag(&window, 100, 1000. / 60, false, 0);
    double long_ms = 0;
    int n = 0;
    for (int i = 0; i < 1000; i++) { /* now there is no memory for them any more */
        window.machine.keeps = false;
        tc_schedule_change(&window.schedule, true);
        tc_step step;
        bool kept;
        assert_true(tc_schedule_next(&step, &window.schedule, true));
        double ms = render(&window.machine, &window.schedule, &step, &kept);
        tc_schedule_done(&window.schedule, &step, ms, kept);
        n += ms > 75;
        long_ms = fmax(long_ms, ms);
    }
    assert_true(long_ms > 100); /* the promise was worth something */
    assert_true(n <= 4 * (1 + 1000 / 200));
}

static void while_it_moves_nothing_follows_the_coarse_picture(void **state)
{
    (void)state;
    tc_schedule schedule;
    tc_step step;
    tc_schedule_begin(&schedule, 800, 600);
    tc_schedule_change(&schedule, true);
    assert_true(tc_schedule_next(&step, &schedule, false));
    tc_schedule_done(&schedule, &step, 55, false);
    assert_false(tc_schedule_next(&step, &schedule, false));
    tc_schedule_rest(&schedule);
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_true(step.divide < 8);
    tc_schedule_change(&schedule, false); /* not by hand: coarse, and finer at once */
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_int_equal(step.divide, 8);
    tc_schedule_done(&schedule, &step, 55, false);
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_true(step.divide < 8);
}

static void what_was_changed_meanwhile_is_rendered_anew(void **state)
{
    (void)state;
    tc_schedule schedule;
    tc_step step, old;
    tc_schedule_begin(&schedule, 800, 600);
    assert_true(tc_schedule_next(&old, &schedule, false));
    tc_schedule_change(&schedule, false);
    tc_schedule_done(&schedule, &old, 55, false);
    assert_int_equal(schedule.shown, 0);
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_int_equal(step.divide, 8);
    tc_schedule_done(&schedule, &step, 55, false);
    assert_true(tc_schedule_next(&old, &schedule, false));
    assert_true(old.from == 0 && old.divide == 4);
    tc_schedule_change(&schedule, false);
    tc_schedule_done(&schedule, &old, 55, false); /* a part of before */
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_int_equal(step.divide, 8);
    tc_schedule_done(&schedule, &step, 55, false);
    tc_step again;
    assert_true(tc_schedule_next(&step, &schedule, false));
    assert_true(tc_schedule_next(&again, &schedule, false)); /* it was given up: it comes again */
    assert_true(step.divide == again.divide && step.from == again.from && step.rows == again.rows);
}

static void a_new_size_keeps_what_is_known(void **state)
{
    (void)state;
    tc_window window;
    tc_machine machine = blunt_fin();
    open_window(&window, &machine, 800, 600);
    double most;
    int parts;
    drag(&window, 300, 1000. / 60, true, 0);
    rest(&window, &most, &parts);
    tc_schedule_resize(&window.schedule, 800, 600);
    tc_step step;
    assert_false(tc_schedule_next(&step, &window.schedule, false));
    tc_schedule_resize(&window.schedule, 1600, 1200);
    assert_true(tc_schedule_next(&step, &window.schedule, false));
    assert_true(step.divide >= 2 && step.divide <= 4);
    tc_schedule_resize(&window.schedule, 400, 300);
    tc_schedule_done(&window.schedule, &step, 1e6, false); /* of the size before: says nothing here */
    assert_true(tc_schedule_next(&step, &window.schedule, false));
    assert_int_equal(step.divide, 1);
}

/* Calls in any order, with any time. */
static void no_order_of_calls_breaks_the_plan(void **state)
{
    (void)state;
    static const double strange[] = {0, -1, NAN, INFINITY, 1e300, 1e-300};
    tc_schedule schedule;
    for (int round = 0; round < 200; round++) {
        int width = (int)pow(10, uniform(0, 4)), height = (int)pow(10, uniform(0, 4));
        tc_schedule_begin(&schedule, width, height);
        tc_step step;
        bool has_step = false;
        for (int i = 0; i < 2000; i++)
            switch ((int)uniform(0, 8)) {
            case 0:
                tc_schedule_change(&schedule, uniform(0, 1) < 0.7);
                break;
            case 1:
                tc_schedule_rest(&schedule);
                break;
            case 2:
                if (has_step) {
                    double ms = uniform(0, 1) < 0.1 ? strange[(int)uniform(0, 6)] : pow(10, uniform(-3, 5));
                    tc_schedule_done(&schedule, &step, ms, uniform(0, 1) < 0.5);
                }
                break;
            case 3:
                if (uniform(0, 1) < 0.05)
                    tc_schedule_resize(&schedule, (int)pow(10, uniform(0, 4)), (int)pow(10, uniform(0, 4)));
                break;
            default:
                if (tc_schedule_next(&step, &schedule, uniform(0, 1) < 0.5)) {
                    int rows = (schedule.height + step.divide - 1) / step.divide;
                    assert_true(step.divide >= 1 && step.divide <= TC_COARSEST);
                    assert_true(step.from >= 0 && step.rows >= 1 && step.from + step.rows <= rows);
                    assert_true(step.last == (step.divide == 1 && step.from + step.rows == rows));
                    has_step = true;
                    if (uniform(0, 1) < 0.7)
                        tc_schedule_done(&schedule, &step, pow(10, uniform(-1, 3)), uniform(0, 1) < 0.5);
                }
            }
        for (int i = 0; i < 2; i++)
            assert_true(isfinite(schedule.cost[i].fixed_ms) && schedule.cost[i].fixed_ms >= 0 &&
                        isfinite(schedule.cost[i].ns_a_pixel) && schedule.cost[i].ns_a_pixel >= 0);
        tc_schedule_rest(&schedule); /* whatever was, rest leads to the whole picture */
        int steps = 0;
        while (tc_schedule_next(&step, &schedule, false)) {
            tc_schedule_done(&schedule, &step, 20, false);
            assert_true(steps++ < 8 * 10000);
        }
        assert_int_equal(schedule.shown, 1);
    }
    tc_step step;
    tc_schedule_begin(&schedule, 0, 600);
    assert_false(tc_schedule_next(&step, &schedule, false));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_first_picture_is_small),
        cmocka_unit_test(a_drag_of_a_curve_point_stays_within_100_ms),
        cmocka_unit_test(an_orbit_stays_within_100_ms),
        cmocka_unit_test(slower_machines_move_as_quickly_with_less),
        cmocka_unit_test(the_size_does_not_flicker),
        cmocka_unit_test(full_accuracy_follows_rest_within_a_second),
        cmocka_unit_test(a_change_never_waits_for_long),
        cmocka_unit_test(a_picture_of_seconds_comes_by_and_by),
        cmocka_unit_test(parts_are_the_same_from_rest_to_rest),
        cmocka_unit_test(another_cost_is_learned_in_a_few_pictures),
        cmocka_unit_test(one_accident_changes_nothing),
        cmocka_unit_test(walks_that_are_promised_and_never_kept_cost_little),
        cmocka_unit_test(while_it_moves_nothing_follows_the_coarse_picture),
        cmocka_unit_test(what_was_changed_meanwhile_is_rendered_anew),
        cmocka_unit_test(a_new_size_keeps_what_is_known),
        cmocka_unit_test(no_order_of_calls_breaks_the_plan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
