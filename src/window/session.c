/* session.c: all that one window is about, and who wants to know of changes. */
#include "window/session.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --------------------------------------------------------------------------------------------------------- changes */

void tc_session_listen(tc_session *session, tc_session_heard *heard, void *user)
{
    const size_t most = sizeof session->listener / sizeof *session->listener;
    if (session->n_listener == most)
        return;
    session->listener[session->n_listener].heard = heard;
    session->listener[session->n_listener++].user = user;
}

void tc_session_tell(tc_session *session, unsigned changes)
{
    for (size_t i = 0; i < session->n_listener; i++)
        session->listener[i].heard(session->listener[i].user, changes);
}

void tc_session_say(tc_session *session, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(session->said, sizeof session->said, format, list);
    va_end(list);
    tc_session_tell(session, TC_CHANGE_SAID);
}

void tc_session_edited(tc_session *session, const char *what)
{
    tc_error err = {0};
    if (!what) {
        tc_session_tell(session, TC_CHANGE_SELECTION);
        return;
    }
    if (tc_history_push(session->history, session->document, what, session->gesture, &err) != TC_OK)
        tc_session_say(session, "%s", err.text);
    tc_session_tell(session, TC_CHANGE_FUNCTION | TC_CHANGE_SELECTION | TC_CHANGE_HISTORY);
}

void tc_session_grab(tc_session *session)
{
    session->moving = true;
    session->gesture = ++session->gestures;
}

void tc_session_release(tc_session *session)
{
    session->moving = false;
    session->gesture = 0;
    tc_session_tell(session, 0);
}

/* A state of the history takes the document's place. */
static void show_state(tc_session *session, const tc_document *state)
{
    tc_error err = {0};
    tc_document *copy = NULL;
    if (!state)
        return;
    if (tc_document_copy(&copy, state, &err) != TC_OK) {
        tc_session_say(session, "%s", err.text);
        return;
    }
    tc_document_destroy(&session->document);
    session->document = copy;
    tc_session_tell(session, TC_CHANGE_FUNCTION | TC_CHANGE_SELECTION | TC_CHANGE_HISTORY);
}

void tc_session_undo(tc_session *session)
{
    if (!session->gesture)
        show_state(session, tc_history_undo(session->history));
}

void tc_session_redo(tc_session *session)
{
    if (!session->gesture)
        show_state(session, tc_history_redo(session->history));
}

void tc_session_take(tc_session *session, tc_document *document, const char *what)
{
    tc_document_destroy(&session->document);
    session->document = document;
    tc_session_edited(session, what);
}

/* ---------------------------------------------------------------------------------------------------------- options */

/* These settings are in force. */
static void settings_take(tc_session *session, tc_settings *settings)
{
    tc_settings_destroy(&session->settings);
    session->settings = settings;
    session->options = settings->options;
    session->run.options = &session->options;
}

bool tc_session_reopen(tc_session *session, int argc, char **argv)
{
    tc_settings *made = NULL;
    if (session->busy) {
        tc_session_say(session, "data are being read: wait until they are there");
        return false;
    }
    session->talk.last[0] = 0;
    if (tc_settings_read(&made, NULL, &session->talk, session->command, argc, argv) >= 0) {
        tc_session_say(session, "%s", session->talk.last);
        return false;
    }
    tc_settings_destroy(&session->wanted);
    session->wanted = made;
    session->fresh = true;
    return true;
}

const char *tc_session_get(const tc_session *session, const char *option)
{
    return tc_settings_text(session->settings, option);
}

/* The look of other settings into run; what run had stays the session's. */
static bool look_make(tc_session *session, tc_render_run *run, tc_held **look, const tc_settings *settings)
{
    *run = session->run;
    run->options = &settings->options;
    run->look = NULL;
    run->render.look = NULL;
    const int code = tc_render_setup(run, run->report.scalar_range, &session->talk);
    if (code < 0 && !(*look = tc_held_look(run->look, session->mesh)))
        tc_talk_error(&session->talk, "memory ran out");
    if (code < 0 && *look)
        return true;
    if (run->look)
        tc_look_parts_finish(run->look);
    free(run->look);
    return false;
}

bool tc_session_set(tc_session *session, const char *option, const char *text)
{
    tc_settings *made = NULL;
    tc_held *look = NULL;
    tc_render_run run;
    if (session->busy) {
        tc_session_say(session, "data are being read: wait until they are there");
        return false;
    }
    session->talk.last[0] = 0;
    bool good = tc_settings_with(&made, session->settings, option, text, &session->talk, session->command) < 0;
    if (good && session->run.mesh)
        good = look_make(session, &run, &look, made);
    if (!good) {
        tc_settings_destroy(&made);
        tc_session_say(session, "%s", *session->talk.last ? session->talk.last : "this cannot be");
        return false;
    }
    if (look) {
        tc_held_drop(&session->look);
        session->look = look;
        session->run = run;
    }
    settings_take(session, made);
    tc_session_tell(session, TC_CHANGE_LOOK);
    return true;
}

/* ------------------------------------------------------------------------------------------------------------ scene */

/* Numbers with commas between them, as short as they can be read back. */
static const char *numbers(char *out, size_t capacity, const double *value, int n)
{
    size_t used = 0;
    for (int i = 0; i < n; i++) {
        char word[40];
        for (int digits = 9; digits <= 17; digits++) {
            snprintf(word, sizeof word, "%.*g", digits, value[i]);
            if (strtod(word, NULL) == value[i])
                break;
        }
        used += (size_t)snprintf(out + used, capacity - used, "%s%s", i ? "," : "", word);
    }
    return out;
}

tc_settings *tc_session_settings(tc_session *session)
{
    enum { MOST = 32, ROOM = 200 };
    const tc_document *d = session->document;
    const tc_camera *c = &session->camera;
    const double clip[2] = {c->clip_near, c->clip_far};
    const bool size =
        tc_settings_text(session->settings, "--size") == NULL && session->width > 0 && session->height > 0;
    char room[10][ROOM];
    char *text = tc_document_text(d, false);
    if (!text) {
        tc_session_say(session, "memory ran out");
        return NULL;
    }
    snprintf(room[0], ROOM, "%dx%d", session->width, session->height);
    const char *const change[][2] = {
        {"--color-map", text},
        {"--preset", NULL},
        {"--opacity", NULL},
        {"--categories", session->options.look.color_field ? session->options.look.categories : NULL},
        {"--range", numbers(room[1], ROOM, d->range, 2)},
        {"--log", d->log ? "on" : NULL},
        {"--unit-distance", d->unit_distance > 0 ? numbers(room[2], ROOM, &d->unit_distance, 1) : NULL},
        {"--nan-color", d->has_nan_color ? numbers(room[3], ROOM, d->nan_color, 4) : NULL},
        {"--camera-position", numbers(room[4], ROOM, c->position, 3)},
        {"--focal-point", numbers(room[5], ROOM, c->focal_point, 3)},
        {"--view-up", numbers(room[6], ROOM, c->view_up, 3)},
        {"--view-angle", numbers(room[7], ROOM, &c->view_angle, 1)},
        {"--parallel", NULL},
        {"--parallel-scale", c->parallel ? numbers(room[8], ROOM, &c->parallel_scale, 1) : NULL},
        {"--azimuth", NULL},
        {"--elevation", NULL},
        {"--roll", NULL},
        {"--zoom", NULL},
        {"--clipping-range", c->clip_far > 0 ? numbers(room[9], ROOM, clip, 2) : NULL},
        {"--size", size ? room[0] : tc_settings_text(session->settings, "--size")},
    };
    tc_settings *made = NULL;
    session->talk.last[0] = 0;
    if (tc_settings_change(&made, session->settings, change, sizeof change / sizeof *change, &session->talk,
                           session->command) >= 0)
        tc_session_say(session, "%s", session->talk.last);
    free(text);
    return made;
}

char *tc_session_command(tc_session *session)
{
    tc_settings *settings = tc_session_settings(session);
    char *text = settings ? tc_settings_command(settings) : NULL;
    tc_settings_destroy(&settings);
    return text;
}

char *tc_session_scene(tc_session *session)
{
    if (!session->run.mesh) {
        tc_session_say(session, "there are no data yet of which a scene could be made");
        return NULL;
    }
    tc_settings *settings = tc_session_settings(session);
    if (!settings)
        return NULL;
    tc_render_run run = session->run;
    run.options = &settings->options;
    run.camera = session->camera;
    memcpy(run.range, session->document->range, sizeof run.range);
    char *line = tc_scene_text(&run);
    json_t *json = line ? json_loads(line, 0, NULL) : NULL;
    char *text = json ? json_dumps(json, JSON_INDENT(2) | JSON_SORT_KEYS | JSON_REAL_PRECISION(17)) : NULL;
    if (!text)
        tc_session_say(session, "memory ran out");
    json_decref(json);
    free(line);
    tc_settings_destroy(&settings);
    return text;
}

/* -------------------------------------------------------------------------------------------------------------- life
 */

int tc_session_open(tc_session *session, const tc_command *command, int argc, char **argv)
{
    const double range[2] = {0, 1};
    const char *trace = NULL;
    tc_error err = {0};
    *session = (tc_session){.command = command, .fresh = true};
    tc_talk_init(&session->talk);
    tc_settings *settings = NULL;
    int code = tc_settings_read(&settings, &trace, &session->talk, command, argc, argv);
    if (code >= 0)
        return code;
    settings_take(session, settings);
    tc_status status = tc_trace_open(&session->trace, trace, &err);
    if (status == TC_OK)
        status = tc_document_create(&session->document, range, &err);
    if (status == TC_OK)
        status = tc_history_create(&session->history, session->document, &err);
    if (status == TC_OK)
        return -1;
    code = tc_talk_status(&session->talk, status, &err);
    tc_session_close(session);
    return code;
}

int tc_session_close(tc_session *session)
{
    tc_error err = {0};
    const tc_status status = session->trace ? tc_trace_close(&session->trace, &err) : TC_OK;
    session->n_listener = 0;
    tc_histogram_destroy(&session->histogram);
    tc_history_destroy(&session->history);
    tc_document_destroy(&session->document);
    session->run.mesh = NULL;
    session->run.look = NULL;
    tc_render_close(&session->run);
    tc_held_drop(&session->look);
    tc_held_drop(&session->mesh);
    tc_settings_destroy(&session->wanted);
    tc_settings_destroy(&session->settings);
    return status == TC_OK ? -1 : tc_talk_status(&session->talk, status, &err);
}

/* ------------------------------------------------------------------------------------------------------------ data */

/* The opacity of the options alone, over two grey points, as the document's curve. */
static tc_status opacity_take(tc_document *document, const tc_render_run *run, tc_error *err)
{
    static const char grey[] = "{\"Name\":\"grey\",\"ColorSpace\":\"RGB\",\"RGBPoints\":[0,0,0,0,1,1,1,1]}";
    tc_transfer *tf = NULL;
    tc_document *other = NULL;
    const tc_transfer_options make = {
        .color_map = grey,
        .opacity = run->options->opacity,
        .has_range = true,
        .range = {document->range[0], document->range[1]},
        .log = document->log,
    };
    tc_status status = tc_document_copy(&other, document, err);
    if (status == TC_OK)
        status = tc_transfer_create(&tf, &make, err);
    if (status == TC_OK)
        status = tc_document_take_knots(other, tf, err);
    if (status == TC_OK)
        status = tc_document_replace(document, 0, 1, other->point, other->n_point, err);
    tc_transfer_destroy(&tf);
    tc_document_destroy(&other);
    return status;
}

/* The knots of a function that has been given in no other way lie over a range of their own. */
static tc_status knots_take(tc_document *document, const tc_transfer *tf, tc_error *err)
{
    size_t n = 0;
    const tc_knot *knot = tc_transfer_knots(tf, &n);
    if (n > 1 && knot[0].s < knot[n - 1].s) {
        document->range[0] = knot[0].s;
        document->range[1] = knot[n - 1].s;
    }
    return tc_document_take_knots(document, tf, err);
}

/* Has opacity knots of its own at scalars, which may lie beyond the range of the colours? */
static bool has_own_knots(const char *opacity)
{
    return opacity && strcmp(opacity, "linear") != 0 && strcmp(opacity, "geom") != 0 && strcmp(opacity, "sigmoid") != 0;
}

/* The document of a run's options. */
static tc_status document_of_run(tc_document **out, const tc_render_run *run, tc_error *err)
{
    const tc_render_command *o = run->options;
    double range[2] = {run->range[0], run->range[1]};
    if (!(range[0] < range[1])) { /* one value, or none: a range about it */
        const double width = range[0] == range[1] && range[0] != 0 ? 0.5 * (range[0] < 0 ? -range[0] : range[0]) : 0.5;
        const double middle = range[0] == range[1] ? range[0] : 0.5;
        range[0] = middle - width;
        range[1] = middle + width;
    }
    tc_status status = tc_document_create(out, range, err);
    if (status != TC_OK)
        return status;
    tc_document *d = *out;
    d->log = o->log && range[0] > 0;
    d->unit_distance = o->unit_distance;
    if ((o->look.categories && !o->look.color_field) || has_own_knots(o->opacity)) {
        status = knots_take(d, run->tf, err);
    } else {
        if (o->color_map)
            status = tc_document_take_preset(d, o->color_map, o->preset, err);
        if (status == TC_OK && o->opacity)
            status = opacity_take(d, run, err);
    }
    d->has_nan_color = o->nan_color.there;
    if (o->nan_color.there)
        memcpy(d->nan_color, o->nan_color.rgba, sizeof d->nan_color);
    if (status != TC_OK)
        tc_document_destroy(out);
    return status;
}

/* Document and camera of what was loaded. */
static void begin_anew(tc_session *session)
{
    tc_error err = {0};
    tc_document *document = NULL;
    if (document_of_run(&document, &session->run, &err) != TC_OK) {
        tc_session_say(session, "%s", err.text);
    } else {
        tc_document_destroy(&session->document);
        session->document = document;
        if (session->gestures == 0 && !tc_history_undo_what(session->history)) { /* nothing was done before */
            tc_history_destroy(&session->history);
            tc_history_create(&session->history, document, &err);
        } else {
            tc_history_push(session->history, document, "open", 0, &err);
        }
    }
    session->camera = session->home = session->run.camera;
}

/* The document over the range of another field. */
static void lay_anew(tc_session *session)
{
    const double *range = session->run.report.scalar_range;
    tc_error err = {0};
    if (!(range[0] < range[1]))
        return;
    session->document->log = session->document->log && range[0] > 0;
    memcpy(session->document->range, range, sizeof session->document->range);
    tc_history_push(session->history, session->document, "another field", 0, &err);
}

void tc_session_loaded(tc_session *session, tc_render_run *run, tc_settings *settings, tc_histogram *histogram)
{
    tc_held *mesh = tc_held_mesh(run->mesh), *look = mesh ? tc_held_look(run->look, mesh) : NULL;
    if (!look) {
        free(mesh);
        tc_render_close(run);
        tc_settings_destroy(&settings);
        tc_histogram_destroy(&histogram);
        tc_session_say(session, "memory ran out");
        return;
    }
    char before[256];
    snprintf(before, sizeof before, "%s", session->run.mesh ? tc_run_field(&session->run) : "");
    session->run.mesh = NULL;
    session->run.look = NULL;
    tc_render_close(&session->run);
    session->run = *run;
    *run = (tc_render_run){0};
    if (settings)
        settings_take(session, settings);
    tc_settings_destroy(&session->wanted);
    session->run.options = &session->options;
    tc_held_drop(&session->look);
    tc_held_drop(&session->mesh);
    session->mesh = mesh;
    session->look = look;
    tc_histogram_destroy(&session->histogram);
    session->histogram = histogram;
    session->talk.muted = true; /* from here on sentences are shown, not printed */
    if (session->fresh)
        begin_anew(session);
    else if (strcmp(before, tc_run_field(&session->run)) != 0)
        lay_anew(session);
    session->fresh = false;
    tc_session_tell(session, TC_CHANGE_DATA | TC_CHANGE_LOOK | TC_CHANGE_CAMERA | TC_CHANGE_FUNCTION |
                                 TC_CHANGE_SELECTION | TC_CHANGE_HISTORY);
}
