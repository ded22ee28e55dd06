/* history.c: the state at hand, packed into a few runs of bytes, and for each step which bytes of each run were
 * replaced by which. Applied backwards it is undo, forwards redo. So an hour of small edits of a large function stays
 * small, and a state that comes back is the one that went, bit by bit. */
#include "edit/history.h"
#include "edit/fail.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* What a state is packed into. */
enum { TC_POINTS, TC_COLORS, TC_NAME, TC_REST, TC_RUNS };

typedef struct tc_run {
    char *data; /* [room], from malloc */
    size_t bytes, room;
} tc_run;

typedef struct tc_packed {
    tc_run run[TC_RUNS];
} tc_packed;

/* From byte `at` of a run on, `before` bytes gave place to `after` others. */
typedef struct tc_splice {
    size_t at, before, after;
} tc_splice;

typedef struct tc_change_step {
    const char *what;
    tc_splice splice[TC_RUNS];
    char data[]; /* for each run the bytes before, then those after */
} tc_change_step;

struct tc_history {
    tc_packed now;
    tc_document view; /* of now: points into it */
    size_t n, at, room;
    tc_change_step **step; /* [n] of [room]; those before `at` are done, the others undone */
    unsigned gesture;      /* that the last step done may go on with; 0: none */
};

static tc_status tc_out_of_memory(tc_error *err)
{
    return tc_edit_fail(err, TC_E_MEMORY, "memory ran out while an edit was noted for undo: close other programs");
}

/* ------------------------------------------------------------------------------------------ packing */

static void tc_packed_finish(tc_packed *packed)
{
    for (int i = 0; i < TC_RUNS; i++)
        free(packed->run[i].data);
    *packed = (tc_packed){0};
}

/* Makes room for what `like` had room for, too, so that no undo ever needs memory. */
static bool tc_run_init(tc_run *run, size_t bytes, const tc_run *like)
{
    run->bytes = bytes;
    run->room = like && like->room > bytes ? like->room : bytes;
    run->data = calloc(run->room ? run->room : 1, 1);
    return run->data;
}

/* Members are copied one by one into zeroed memory: what lies between them is no part of a state. */
static bool tc_pack(tc_packed *out, const tc_document *state, const tc_packed *like)
{
    *out = (tc_packed){0};
    if (state->n_point > SIZE_MAX / sizeof(tc_edit_point) || state->n_color > SIZE_MAX / sizeof(tc_edit_color))
        return false;
    const size_t bytes[TC_RUNS] = {state->n_point * sizeof(tc_edit_point), state->n_color * sizeof(tc_edit_color),
                                   state->name ? strlen(state->name) + 1 : 0, sizeof(tc_document)};
    for (int i = 0; i < TC_RUNS; i++)
        if (!tc_run_init(&out->run[i], bytes[i], like ? &like->run[i] : NULL)) {
            tc_packed_finish(out);
            return false;
        }
    tc_edit_point *point = (tc_edit_point *)(void *)out->run[TC_POINTS].data;
    for (size_t i = 0; i < state->n_point; i++) {
        point[i].x = state->point[i].x;
        point[i].a = state->point[i].a;
        point[i].midpoint = state->point[i].midpoint;
        point[i].sharpness = state->point[i].sharpness;
        point[i].selected = state->point[i].selected;
    }
    tc_edit_color *color = (tc_edit_color *)(void *)out->run[TC_COLORS].data;
    for (size_t i = 0; i < state->n_color; i++) {
        color[i].x = state->color[i].x;
        memcpy(color[i].rgb, state->color[i].rgb, sizeof color[i].rgb);
        color[i].selected = state->color[i].selected;
    }
    if (state->name)
        memcpy(out->run[TC_NAME].data, state->name, bytes[TC_NAME]);
    tc_document *rest = (tc_document *)(void *)out->run[TC_REST].data;
    rest->space = state->space;
    rest->hsv_wrap = state->hsv_wrap;
    memcpy(rest->range, state->range, sizeof rest->range);
    rest->log = state->log;
    rest->unit_distance = state->unit_distance;
    rest->has_nan_color = state->has_nan_color;
    memcpy(rest->nan_color, state->nan_color, sizeof rest->nan_color);
    return true;
}

static tc_document tc_packed_view(const tc_packed *packed)
{
    tc_document view = *(const tc_document *)(const void *)packed->run[TC_REST].data;
    view.n_point = packed->run[TC_POINTS].bytes / sizeof *view.point;
    view.point = (tc_edit_point *)(void *)packed->run[TC_POINTS].data;
    view.n_color = packed->run[TC_COLORS].bytes / sizeof *view.color;
    view.color = (tc_edit_color *)(void *)packed->run[TC_COLORS].data;
    view.name = packed->run[TC_NAME].bytes ? packed->run[TC_NAME].data : NULL;
    return view;
}

/* ------------------------------------------------------------------------------------------ steps */

static size_t tc_step_bytes(const tc_change_step *step)
{
    size_t bytes = sizeof *step;
    for (int i = 0; i < TC_RUNS; i++)
        bytes += step->splice[i].before + step->splice[i].after;
    return bytes;
}

/* What leads from one state to the other. NULL: memory ran out. */
static tc_change_step *tc_step_make(const tc_packed *from, const tc_packed *to)
{
    tc_change_step plan = {0};
    for (int i = 0; i < TC_RUNS; i++) {
        const tc_run *a = &from->run[i], *b = &to->run[i];
        const size_t least = a->bytes < b->bytes ? a->bytes : b->bytes;
        size_t head = 0, tail = 0;
        while (head < least && a->data[head] == b->data[head])
            head++;
        while (tail < least - head && a->data[a->bytes - 1 - tail] == b->data[b->bytes - 1 - tail])
            tail++;
        plan.splice[i] = (tc_splice){head, a->bytes - head - tail, b->bytes - head - tail};
    }
    tc_change_step *step = malloc(tc_step_bytes(&plan));
    if (!step)
        return NULL;
    *step = plan;
    char *data = step->data;
    for (int i = 0; i < TC_RUNS; i++) {
        const tc_splice *s = &plan.splice[i];
        memcpy(data, from->run[i].data + s->at, s->before);
        memcpy(data + s->before, to->run[i].data + s->at, s->after);
        data += s->before + s->after;
    }
    return step;
}

/* The runs have room for both states. */
static void tc_step_apply(tc_packed *packed, const tc_change_step *step, bool back)
{
    const char *data = step->data;
    for (int i = 0; i < TC_RUNS; i++) {
        const tc_splice *s = &step->splice[i];
        tc_run *run = &packed->run[i];
        const size_t old = back ? s->after : s->before, new = back ? s->before : s->after;
        char *place = run->data + s->at;
        memmove(place + new, place + old, run->bytes - s->at - old);
        memcpy(place, data + (back ? 0 : s->before), new);
        run->bytes += new - old;
        data += s->before + s->after;
    }
}

/* ------------------------------------------------------------------------------------------ the history */

tc_status tc_history_create(tc_history **out, const tc_document *begin, tc_error *err)
{
    *out = NULL;
    tc_history *history = calloc(1, sizeof *history);
    if (!history || !tc_pack(&history->now, begin, NULL)) {
        free(history);
        return tc_out_of_memory(err);
    }
    history->view = tc_packed_view(&history->now);
    *out = history;
    return TC_OK;
}

/* Frees steps from `first` on. */
static void tc_history_forget(tc_history *history, size_t first)
{
    for (size_t i = first; i < history->n; i++)
        free(history->step[i]);
    history->n = first;
}

void tc_history_destroy(tc_history **history)
{
    if (!*history)
        return;
    tc_history_forget(*history, 0);
    free((*history)->step);
    tc_packed_finish(&(*history)->now);
    free(*history);
    *history = NULL;
}

static bool tc_history_room(tc_history *history)
{
    if (history->at < history->room)
        return true;
    if (history->room > SIZE_MAX / sizeof *history->step / 2)
        return false;
    const size_t room = history->room ? 2 * history->room : 16;
    tc_change_step **step = realloc(history->step, room * sizeof *step);
    if (!step)
        return false;
    history->step = step;
    history->room = room;
    return true;
}

/* The state at hand becomes `packed`, which is taken. */
static void tc_history_take(tc_history *history, tc_packed *packed)
{
    tc_packed_finish(&history->now);
    history->now = *packed;
    history->view = tc_packed_view(&history->now);
    *packed = (tc_packed){0};
}

tc_status tc_history_push(tc_history *history, const tc_document *state, const char *what, unsigned gesture,
                          tc_error *err)
{
    if (tc_document_equal(&history->view, state))
        return TC_OK;
    const bool goes_on = gesture != 0 && gesture == history->gesture;
    tc_packed next, base = {0};
    tc_change_step *step = NULL;
    if (!tc_pack(&next, state, &history->now))
        return tc_out_of_memory(err);
    if (goes_on) { /* from where the gesture began */
        if (!tc_pack(&base, &history->view, &history->now))
            goto failed;
        tc_step_apply(&base, history->step[history->at - 1], true);
        const tc_document began = tc_packed_view(&base);
        if (tc_document_equal(&began, state)) {
            tc_history_forget(history, history->at - 1);
            history->at--;
            history->gesture = 0;
            tc_history_take(history, &base);
            tc_packed_finish(&next);
            return TC_OK;
        }
    }
    step = tc_step_make(goes_on ? &base : &history->now, &next);
    if (!step || !tc_history_room(history))
        goto failed;
    step->what = goes_on ? history->step[history->at - 1]->what : what;
    history->at -= goes_on;
    tc_history_forget(history, history->at);
    history->step[history->at++] = step;
    history->n = history->at;
    history->gesture = gesture;
    tc_history_take(history, &next);
    tc_packed_finish(&base);
    return TC_OK;

failed:
    free(step);
    tc_packed_finish(&base);
    tc_packed_finish(&next);
    return tc_out_of_memory(err);
}

const tc_document *tc_history_undo(tc_history *history)
{
    if (history->at == 0)
        return NULL;
    history->gesture = 0;
    tc_step_apply(&history->now, history->step[--history->at], true);
    history->view = tc_packed_view(&history->now);
    return &history->view;
}

const tc_document *tc_history_redo(tc_history *history)
{
    if (history->at == history->n)
        return NULL;
    history->gesture = 0;
    tc_step_apply(&history->now, history->step[history->at++], false);
    history->view = tc_packed_view(&history->now);
    return &history->view;
}

const char *tc_history_undo_what(const tc_history *history)
{
    return history->at ? history->step[history->at - 1]->what : NULL;
}

const char *tc_history_redo_what(const tc_history *history)
{
    return history->at < history->n ? history->step[history->at]->what : NULL;
}

size_t tc_history_bytes(const tc_history *history)
{
    size_t bytes = sizeof *history + history->room * sizeof *history->step;
    for (int i = 0; i < TC_RUNS; i++)
        bytes += history->now.run[i].room;
    for (size_t i = 0; i < history->n; i++)
        bytes += tc_step_bytes(history->step[i]);
    return bytes;
}
