/* range_visible.c: see range_visible.h. */
#include "window/range_visible.h"

#include "window/range_bar.h"

typedef struct tc_visible {
    tc_session *session;
    tc_held *held;
    const tc_mesh *mesh;
    tc_camera camera;
    double aspect, range[2];
    tc_error err;
    tc_status status;
    bool any;
} tc_visible;

static void tc_visible_free(gpointer data)
{
    tc_visible *v = data;
    tc_held_drop(&v->held);
    g_free(v);
}

static void tc_visible_run(GTask *task, gpointer source, gpointer data, GCancellable *cancellable)
{
    (void)source, (void)cancellable;
    tc_visible *v = data;
    tc_histogram *histogram = NULL;
    const tc_histogram_options options = {.n = 16, .camera = &v->camera, .aspect = v->aspect};
    v->status = tc_mesh_histogram(&histogram, v->mesh, &options, &v->err);
    if (!v->status && histogram->counted > 0) {
        v->any = true;
        v->range[0] = histogram->range[0];
        v->range[1] = histogram->range[1];
    }
    tc_histogram_destroy(&histogram);
    g_task_return_boolean(task, true);
}

static void tc_visible_done(GObject *widget, GAsyncResult *result, gpointer user)
{
    (void)user;
    tc_visible *v = g_task_get_task_data(G_TASK(result));
    /* The session may be closed once its widgets are gone. */
    if (!gtk_widget_get_root(GTK_WIDGET(widget)) || v->session->run.mesh != v->mesh)
        return;
    if (v->status)
        tc_session_say(v->session, "%s", v->err.text);
    else if (!v->any)
        tc_session_say(v->session, "the picture shows no finite value: move the camera, or take the range of the data");
    else
        tc_range_set(v->session, v->range[0], v->range[1], "range of visible data");
}

void tc_range_visible(tc_session *session, GtkWidget *widget)
{
    if (!session->run.mesh) {
        tc_session_say(session, "no data are there yet: wait until they are read");
        return;
    }
    tc_visible *v = g_new0(tc_visible, 1);
    v->session = session;
    v->held = tc_held_take(session->mesh);
    v->mesh = session->run.mesh;
    v->camera = session->camera;
    v->aspect = session->width > 0 && session->height > 0 ? (double)session->width / session->height : 1;
    GTask *task = g_task_new(widget, NULL, tc_visible_done, NULL);
    g_task_set_task_data(task, v, tc_visible_free);
    g_task_run_in_thread(task, tc_visible_run);
    g_object_unref(task);
}
