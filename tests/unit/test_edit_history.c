/* test_edit_history.c: undo and redo, gestures, and the memory of an hour's editing. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "edit/history.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_POINTS = 40, MOST_COLORS = 300 };

/* A state with its memory. */
typedef struct tc_state {
    tc_document document;
    tc_edit_point point[MOST_POINTS];
    tc_edit_color color[MOST_COLORS];
    char name[40];
} tc_state;

static uint64_t state_of_random = 1;

static double uniform(void)
{
    state_of_random = state_of_random * 6364136223846793005u + 1442695040888963407u;
    return (double)(state_of_random >> 11) * 0x1p-53;
}

static size_t below(size_t n)
{
    return (size_t)(uniform() * (double)n);
}

static void aim(tc_state *state)
{
    state->document.name = state->name;
    state->document.point = state->point;
    state->document.color = state->color;
}

static void state_init(tc_state *state, size_t n_point, size_t n_color)
{
    memset(state, 0, sizeof *state);
    state->document = (tc_document){.n_point = n_point, .n_color = n_color, .range = {-1, 3}, .unit_distance = 0.5};
    for (size_t i = 0; i < n_point; i++)
        state->point[i] = (tc_edit_point){(double)i / (double)(n_point - 1), uniform(), 0.5, 0, false};
    for (size_t i = 0; i < n_color; i++)
        state->color[i] = (tc_edit_color){(double)i / (double)(n_color - 1), {uniform(), uniform(), uniform()}, false};
    strcpy(state->name, "Cool to Warm");
    aim(state);
}

static void state_copy(tc_state *to, const tc_state *from)
{
    *to = *from;
    aim(to);
}

/* Bit by bit, what tc_document_equal does not look at too. */
static bool same(const tc_document *a, const tc_document *b)
{
    if (a->n_point != b->n_point || a->n_color != b->n_color || strcmp(a->name, b->name) != 0 || a->space != b->space ||
        memcmp(a->range, b->range, sizeof a->range) != 0 || a->log != b->log ||
        memcmp(&a->unit_distance, &b->unit_distance, sizeof a->unit_distance) != 0 ||
        a->has_nan_color != b->has_nan_color || memcmp(a->nan_color, b->nan_color, sizeof a->nan_color) != 0)
        return false;
    for (size_t i = 0; i < a->n_point; i++) {
        const tc_edit_point *p = &a->point[i], *q = &b->point[i];
        if (memcmp(&p->x, &q->x, sizeof p->x) != 0 || memcmp(&p->a, &q->a, sizeof p->a) != 0 ||
            p->midpoint != q->midpoint || p->sharpness != q->sharpness || p->selected != q->selected)
            return false;
    }
    for (size_t i = 0; i < a->n_color; i++) {
        const tc_edit_color *p = &a->color[i], *q = &b->color[i];
        if (p->x != q->x || memcmp(p->rgb, q->rgb, sizeof p->rgb) != 0 || p->selected != q->selected)
            return false;
    }
    return true;
}

/* Some edit that makes another function, as a person might do it. */
static void edit(tc_state *state)
{
    tc_document *document = &state->document;
    switch (below(8)) {
    case 0: /* a new point */
        if (document->n_point < MOST_POINTS) {
            size_t i = 1 + below(document->n_point - 1);
            memmove(&state->point[i + 1], &state->point[i], (document->n_point - i) * sizeof *state->point);
            document->n_point++;
            state->point[i] = (tc_edit_point){state->point[i - 1].x, uniform(), uniform(), uniform(), true};
        }
        break;
    case 1: /* one less */
        if (document->n_point > 2) {
            size_t i = 1 + below(document->n_point - 2);
            memmove(&state->point[i], &state->point[i + 1], (document->n_point - i - 1) * sizeof *state->point);
            document->n_point--;
        }
        break;
    case 2: /* another map */
        document->n_color = 2 + below(MOST_COLORS - 1);
        for (size_t i = 0; i < document->n_color; i++)
            state->color[i] =
                (tc_edit_color){(double)i / (double)(document->n_color - 1), {uniform(), uniform(), 0.5}, false};
        snprintf(state->name, sizeof state->name, "Map %zu", below(1000000000));
        break;
    case 3:
        state->color[below(document->n_color)].rgb[below(3)] = uniform();
        break;
    case 4:
        document->range[1] = 1 + uniform();
        document->log = !document->log;
        break;
    case 5:
        document->space = (tc_edit_space)below(TC_EDIT_SPACES);
        document->has_nan_color = !document->has_nan_color;
        document->nan_color[below(4)] = uniform();
        break;
    default: {
        tc_edit_point *point = &state->point[below(document->n_point)];
        point->a = uniform();
        point->selected = !point->selected;
    }
    }
}

static void push(tc_history *history, const tc_state *state, unsigned gesture)
{
    tc_error err = {0};
    assert_int_equal(tc_history_push(history, &state->document, "edit", gesture, &err), TC_OK);
}

static void undo_and_redo_go_through_each_state_bit_by_bit(void **unused)
{
    (void)unused;
    enum { STEPS = 1500 };
    tc_state *state = malloc((STEPS + 1) * sizeof *state);
    assert_non_null(state);
    state_init(&state[0], 5, 33);
    tc_history *history;
    assert_int_equal(tc_history_create(&history, &state[0].document, NULL), TC_OK);
    size_t n = 0;
    while (n < STEPS) {
        state_copy(&state[n + 1], &state[n]);
        edit(&state[n + 1]);
        if (tc_document_equal(&state[n].document, &state[n + 1].document))
            continue;
        push(history, &state[++n], 0);
        assert_string_equal(tc_history_undo_what(history), "edit");
        assert_null(tc_history_redo_what(history));
    }
    assert_null(tc_history_redo(history));
    for (int round = 0; round < 2; round++) {
        for (size_t i = STEPS; i-- > 0;) {
            const tc_document *document = tc_history_undo(history);
            assert_non_null(document);
            assert_true(same(document, &state[i].document));
        }
        assert_null(tc_history_undo(history));
        assert_null(tc_history_undo_what(history));
        for (size_t i = 1; i <= STEPS; i++) {
            const tc_document *document = tc_history_redo(history);
            assert_non_null(document);
            assert_true(same(document, &state[i].document));
        }
        assert_null(tc_history_redo(history));
    }
    tc_history_destroy(&history);
    assert_null(history);
    tc_history_destroy(&history);
    free(state);
}

static void what_was_undone_is_forgotten_by_a_new_edit(void **unused)
{
    (void)unused;
    tc_state a, b, c;
    state_init(&a, 3, 3);
    state_copy(&b, &a);
    b.point[1].a = 7;
    state_copy(&c, &a);
    c.point[1].a = 8;
    tc_history *history;
    assert_int_equal(tc_history_create(&history, &a.document, NULL), TC_OK);
    push(history, &b, 0);
    assert_true(same(tc_history_undo(history), &a.document));
    assert_string_equal(tc_history_redo_what(history), "edit");
    push(history, &a, 0); /* no edit */
    assert_non_null(tc_history_redo_what(history));
    push(history, &c, 0);
    assert_null(tc_history_redo(history));
    assert_true(same(tc_history_undo(history), &a.document));
    assert_true(same(tc_history_redo(history), &c.document));
    tc_history_destroy(&history);
}

static void a_gesture_is_one_step(void **unused)
{
    (void)unused;
    tc_state a, b, c;
    state_init(&a, 3, 3);
    state_copy(&b, &a);
    tc_history *history;
    assert_int_equal(tc_history_create(&history, &a.document, NULL), TC_OK);
    for (int i = 1; i <= 100; i++) {
        b.point[1].a = i;
        assert_int_equal(tc_history_push(history, &b.document, i == 1 ? "add point" : "move points", 5, NULL), TC_OK);
    }
    assert_string_equal(tc_history_undo_what(history), "add point");
    state_copy(&c, &b);
    for (int i = 1; i <= 100; i++) {
        c.point[2].a = i;
        push(history, &c, 6);
    }
    assert_true(same(tc_history_undo(history), &b.document));
    assert_true(same(tc_history_undo(history), &a.document));
    assert_null(tc_history_undo(history));
    assert_true(same(tc_history_redo(history), &b.document));
    assert_true(same(tc_history_redo(history), &c.document));
    assert_null(tc_history_redo(history));
    tc_history_destroy(&history);
}

static void a_gesture_that_leads_back_is_no_step(void **unused)
{
    (void)unused;
    tc_state a, b;
    state_init(&a, 3, 3);
    state_copy(&b, &a);
    tc_history *history;
    assert_int_equal(tc_history_create(&history, &a.document, NULL), TC_OK);
    b.point[1].a = 4;
    push(history, &b, 0);
    for (int i = 0; i < 5; i++) { /* away and back */
        b.point[0].a = 9;
        push(history, &b, 7);
        b.point[0].a = a.point[0].a;
        push(history, &b, 7);
    }
    b.point[0].a = 3; /* and away again: one step */
    push(history, &b, 7);
    b.point[0].a = 2;
    push(history, &b, 7);
    const tc_document *document = tc_history_undo(history);
    assert_true(document->point[0].a == a.point[0].a && document->point[1].a == 4);
    assert_true(same(tc_history_undo(history), &a.document));
    assert_null(tc_history_undo(history));
    tc_history_destroy(&history);
}

static void an_undo_within_a_gesture_ends_its_step(void **unused)
{
    (void)unused;
    tc_state a, b;
    state_init(&a, 3, 3);
    state_copy(&b, &a);
    tc_history *history;
    assert_int_equal(tc_history_create(&history, &a.document, NULL), TC_OK);
    b.point[1].a = 4;
    push(history, &b, 3);
    assert_true(same(tc_history_undo(history), &a.document));
    assert_true(same(tc_history_redo(history), &b.document));
    tc_state c;
    state_copy(&c, &b);
    c.point[1].a = 5;
    push(history, &c, 3);
    assert_true(same(tc_history_undo(history), &b.document));
    assert_true(same(tc_history_undo(history), &a.document));
    assert_null(tc_history_undo(history));
    tc_history_destroy(&history);
}

static void selections_and_names_alone_are_no_steps(void **unused)
{
    (void)unused;
    tc_state a, b;
    state_init(&a, 3, 3);
    state_copy(&b, &a);
    tc_history *history;
    assert_int_equal(tc_history_create(&history, &a.document, NULL), TC_OK);
    b.point[1].selected = b.color[2].selected = true;
    strcpy(b.name, "Another");
    push(history, &b, 0);
    assert_null(tc_history_undo(history));
    b.document.name = NULL; /* a document of no name is one too */
    b.point[1].a = 6;
    push(history, &b, 0);
    assert_true(same(tc_history_undo(history), &a.document));
    assert_null(tc_history_redo(history)->name);
    tc_history_destroy(&history);
}

static void a_step_of_a_large_function_costs_what_it_changed(void **unused)
{
    (void)unused;
    enum { STEPS = 20000 };
    tc_state state, begin;
    state_init(&begin, 20, MOST_COLORS);
    state_copy(&state, &begin);
    tc_history *history;
    assert_int_equal(tc_history_create(&history, &state.document, NULL), TC_OK);
    const size_t empty = tc_history_bytes(history);
    for (unsigned gesture = 1; gesture <= STEPS; gesture++) {
        size_t i = below(20);
        for (int move = 0; move < 5; move++) {
            state.point[i].a = uniform();
            push(history, &state, gesture);
        }
        if (gesture % 1000 == 0 && (tc_history_bytes(history) - empty) / gesture > 300)
            fail_msg("%zu bytes a step", (tc_history_bytes(history) - empty) / gesture);
    }
    size_t n = 0;
    const tc_document *document = NULL;
    for (const tc_document *at; (at = tc_history_undo(history)); document = at)
        n++;
    assert_int_equal(n, STEPS);
    assert_true(same(document, &begin.document));
    assert_true(tc_history_bytes(history) <= empty + (size_t)STEPS * 300);
    print_message("%zu bytes a step\n", (tc_history_bytes(history) - empty) / STEPS);
    edit(&begin); /* what was undone gives its memory back, but for a pointer a step */
    begin.point[0].a = 17;
    push(history, &begin, 0);
    assert_true(tc_history_bytes(history) <= empty + 3 * sizeof(tc_state) + (size_t)STEPS * 2 * sizeof(void *));
    tc_history_destroy(&history);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(undo_and_redo_go_through_each_state_bit_by_bit),
        cmocka_unit_test(what_was_undone_is_forgotten_by_a_new_edit),
        cmocka_unit_test(a_gesture_is_one_step),
        cmocka_unit_test(a_gesture_that_leads_back_is_no_step),
        cmocka_unit_test(an_undo_within_a_gesture_ends_its_step),
        cmocka_unit_test(selections_and_names_alone_are_no_steps),
        cmocka_unit_test(a_step_of_a_large_function_costs_what_it_changed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
