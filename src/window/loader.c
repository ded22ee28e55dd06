/* loader.c: reads and prepares data on a thread. */
#include "window/loader.h"

#include <gio/gio.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BINS = 1024, PROGRESS_MS = 100 };

/* What is read, and what came of it. */
typedef struct load {
    tc_session *session;
    tc_settings *settings;
    tc_talk talk; /* the thread's own */
    tc_log say;   /* what talk's was */
    tc_render_run run;
    tc_histogram *histogram;
    bool by_volume;
    int code; /* -1: it is there */
    GMutex lock;
    char what[64]; /* of the progress, under the lock */
    double fraction;
    guint shows; /* the source that shows it */
} load;

static void load_free(load *l)
{
    tc_render_close(&l->run);
    tc_settings_destroy(&l->settings);
    tc_histogram_destroy(&l->histogram);
    g_mutex_clear(&l->lock);
    g_free(l);
}

static void message(void *user, tc_level level, const char *text)
{
    load *l = user;
    l->say.message(&l->talk, level, text);
}

static void progress(void *user, const char *what, double fraction)
{
    load *l = user;
    g_mutex_lock(&l->lock);
    snprintf(l->what, sizeof l->what, "%s", what);
    l->fraction = fraction;
    g_mutex_unlock(&l->lock);
    l->say.progress(&l->talk, what, fraction);
}

static gboolean progress_show(gpointer user)
{
    load *l = user;
    tc_session *session = l->session;
    g_mutex_lock(&l->lock);
    memcpy(session->progress.what, l->what, sizeof l->what);
    session->progress.fraction = l->fraction;
    g_mutex_unlock(&l->lock);
    tc_session_tell(session, TC_CHANGE_BUSY);
    return G_SOURCE_CONTINUE;
}

static void histogram_make(tc_histogram **out, const tc_mesh *mesh, bool by_volume)
{
    const tc_histogram_options options = {.n = BINS, .by_volume = by_volume};
    tc_mesh_histogram(out, mesh, &options, NULL); /* without one the curve has nothing behind it */
}

static gboolean arrived(gpointer user)
{
    load *l = user;
    tc_session *session = l->session;
    g_source_remove(l->shows);
    session->busy = false;
    session->code = l->code;
    if (l->code < 0) {
        tc_settings *settings = l->settings;
        tc_histogram *histogram = l->histogram;
        l->settings = NULL;
        l->histogram = NULL;
        tc_session_loaded(session, &l->run, settings, histogram);
        tc_session_say(session, "%s", ""); /* what was said before is over */
    } else {
        tc_session_say(session, "%s", *l->talk.last ? l->talk.last : "the data could not be read");
        tc_settings_destroy(&session->wanted); /* all is as it was */
        session->fresh = session->fresh && !session->run.mesh;
    }
    load_free(l);
    tc_session_tell(session, TC_CHANGE_BUSY);
    return G_SOURCE_REMOVE;
}

static gpointer work(gpointer user)
{
    load *l = user;
    l->code = tc_render_open(&l->run, &l->settings->options, &l->talk);
    if (l->code < 0) {
        progress(l, "counting values", -1);
        histogram_make(&l->histogram, l->run.mesh, l->by_volume);
    }
    g_idle_add_full(G_PRIORITY_DEFAULT, arrived, l, NULL); /* before redrawing, which may leave no time to idle ones */
    return NULL;
}

/* Begins with the session's settings, or those that are wanted, changed. */
static bool start(tc_session *session, const char *const (*change)[2], size_t n)
{
    tc_settings *settings = NULL;
    if (session->busy) {
        tc_session_say(session, "data are being read already: wait until they are there");
        return false;
    }
    session->talk.last[0] = 0;
    const tc_settings *from = session->wanted ? session->wanted : session->settings;
    if (tc_settings_change(&settings, from, change, n, &session->talk, session->command) >= 0) {
        tc_session_say(session, "%s", session->talk.last);
        tc_settings_destroy(&session->wanted);
        return false;
    }
    load *l = g_new0(load, 1);
    g_mutex_init(&l->lock);
    l->session = session;
    l->settings = settings;
    l->by_volume = session->by_volume;
    tc_talk_init(&l->talk);
    l->talk.quiet = session->talk.quiet;
    l->talk.verbose = session->talk.verbose;
    l->say = l->talk.log;
    l->talk.log = (tc_log){.message = message, .progress = progress, .user = l};
    l->fraction = -1;
    snprintf(l->what, sizeof l->what, "reading");
    session->busy = true;
    l->shows = g_timeout_add(PROGRESS_MS, progress_show, l);
    progress_show(l);
    g_thread_unref(g_thread_new("loader", work, l));
    return true;
}

bool tc_loader_start(tc_session *session)
{
    return start(session, NULL, 0);
}

bool tc_loader_field(tc_session *session, const char *field, tc_association association)
{
    const char *const change[][2] = {
        {"--field", field},
        {"--cell-data", association == TC_CELL_DATA ? "on" : NULL},
        {"--point-data", association == TC_POINT_DATA ? "on" : NULL},
    };
    return start(session, change, 3);
}

bool tc_loader_step(tc_session *session, int step)
{
    char text[16];
    const char *const change[][2] = {{"--step", text}, {"--time", NULL}};
    snprintf(text, sizeof text, "%d", step);
    return start(session, change, 2);
}

/* ------------------------------------------------------------------------------------------------------- histogram */

typedef struct count {
    tc_session *session;
    tc_held *held;
    const tc_mesh *mesh;
    tc_histogram *histogram;
    bool by_volume;
} count;

static gboolean counted(gpointer user)
{
    count *c = user;
    tc_session *session = c->session;
    if (session->run.mesh == c->mesh && session->by_volume == c->by_volume && c->histogram) {
        tc_histogram_destroy(&session->histogram);
        session->histogram = c->histogram;
        c->histogram = NULL;
        tc_session_tell(session, TC_CHANGE_SELECTION); /* nothing that makes the picture is new */
    }
    tc_histogram_destroy(&c->histogram);
    tc_held_drop(&c->held);
    g_free(c);
    return G_SOURCE_REMOVE;
}

static gpointer count_work(gpointer user)
{
    count *c = user;
    histogram_make(&c->histogram, c->mesh, c->by_volume);
    g_idle_add_full(G_PRIORITY_DEFAULT, counted, c, NULL);
    return NULL;
}

void tc_loader_histogram(tc_session *session)
{
    if (!session->run.mesh)
        return;
    count *c = g_new0(count, 1);
    c->session = session;
    c->held = tc_held_take(session->mesh);
    c->mesh = session->run.mesh;
    c->by_volume = session->by_volume;
    g_thread_unref(g_thread_new("histogram", count_work, c));
}
