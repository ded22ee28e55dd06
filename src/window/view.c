/* view.c: the picture, as a widget. */
#include "window/view.h"
#include "edit/camera_drag.h"
#include "window/plot.h"
#include "window/probing.h"
#include "window/view_draw.h"
#include "window/view_figure.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { REST_MS = 200 }; /* without a change, a hand that is still on something is taken for still */

typedef enum drag { DRAG_NONE = 0, DRAG_TURN, DRAG_SHIFT, DRAG_NEAR, DRAG_ROLL } drag;

typedef struct view {
    GtkWidget *area;
    tc_session *session;
    tc_pictures *pictures;
    tc_view_draw draw;
    tc_shown shown;
    char refused[1280];
    unsigned id, painted; /* of the last change, and of the last picture that was painted */
    bool whole_painted, checked_told, fresh;
    bool figure_due; /* title, bar and axes are to be drawn anew */
    bool hasty;      /* keys or wheel move the camera */
    guint rest;
    drag drag;
    double last_x, last_y; /* of the drag */
    double x, y;           /* of the pointer; NAN: not here */
    bool probing;
    tc_probing *rays;
    guint probe_idle;
    void (*changed)(void *user, const tc_shown *shown);
    void *changed_user;
    void (*probed)(void *user, const tc_probe *probe);
    void *probed_user;
} view;

static view *view_of(GtkWidget *widget)
{
    return g_object_get_data(G_OBJECT(widget), "tc-view");
}

static void ask(view *v, bool moving)
{
    const int scale = gtk_widget_get_scale_factor(v->area);
    const int width = gtk_widget_get_width(v->area) * scale, height = gtk_widget_get_height(v->area) * scale;
    if (width != v->session->width || height != v->session->height) {
        tc_trace_mark(v->session->trace, "size", v->id, "width", width);
        tc_trace_mark(v->session->trace, "size", v->id, "height", height);
    }
    v->session->width = width;
    v->session->height = height;
    if (v->pictures && v->id > 0)
        tc_pictures_ask(v->pictures, v->session, width, height, moving, v->id);
}

/* ----------------------------------------------------------------------------------------------------------- probe */

static void ray_met(void *user, const tc_probe *probe)
{
    view *v = user;
    if (v->probed)
        v->probed(v->probed_user, v->probing ? probe : NULL);
}

static gboolean probe_now(gpointer user)
{
    view *v = user;
    const tc_session *s = v->session;
    const int scale = gtk_widget_get_scale_factor(v->area);
    const double x = floor(v->x * scale), y = floor(v->y * scale); /* NAN: the pointer is elsewhere */
    const bool there = v->probing && x >= 0 && y >= 0 && x < s->width && y < s->height;
    v->probe_idle = 0;
    tc_probing_ask(v->rays, there ? (int)x : -1, there ? (int)y : -1);
    return G_SOURCE_REMOVE;
}

static void probe_soon(view *v)
{
    if (v->probing && v->rays && !v->probe_idle)
        v->probe_idle = g_idle_add_full(G_PRIORITY_DEFAULT_IDLE - 90, probe_now, v, NULL);
}

bool tc_view_is_probing(GtkWidget *widget)
{
    return view_of(widget)->probing;
}

void tc_view_probe(GtkWidget *widget, bool on)
{
    view *v = view_of(widget);
    if (v->probing == on)
        return;
    v->probing = on;
    gtk_widget_set_cursor_from_name(widget, on ? "crosshair" : NULL);
    if (v->rays && !v->probe_idle)
        v->probe_idle = g_idle_add_full(G_PRIORITY_DEFAULT_IDLE - 90, probe_now, v, NULL);
}

/* --------------------------------------------------------------------------------------------------------- changes */

static gboolean at_rest(gpointer user)
{
    view *v = user;
    v->rest = 0;
    v->hasty = false;
    ask(v, false);
    return G_SOURCE_REMOVE;
}

static void heard(void *user, unsigned changes)
{
    view *v = user;
    if (changes & (TC_CHANGE_FUNCTION | TC_CHANGE_CAMERA | TC_CHANGE_LOOK | TC_CHANGE_DATA)) {
        const bool moving = v->session->moving || v->hasty;
        v->figure_due = true;
        v->id++;
        tc_trace_mark(v->session->trace, "pointer", v->id, "changes", changes);
        ask(v, moving);
        if (v->rest)
            g_source_remove(v->rest);
        v->rest = moving ? g_timeout_add(REST_MS, at_rest, v) : 0;
        probe_soon(v);
    }
    if (changes == 0)
        ask(v, false);
    if (changes & TC_CHANGE_LOOK)
        gtk_gl_area_queue_render(GTK_GL_AREA(v->area)); /* the background may be another */
}

static void arrived(void *user)
{
    view *v = user;
    char error[1024];
    tc_pictures_error(v->pictures, error);
    if (*error)
        tc_session_say(v->session, "%s", error);
    v->fresh = true;
    gtk_gl_area_queue_render(GTK_GL_AREA(v->area));
}

/* --------------------------------------------------------------------------------------------------------- drawing */

/* What the picture lies over: the scene's background, over the theme's where that is transparent. */
static void background(float out[3], const view *v)
{
    const tc_background *scene = &v->session->options.background;
    GdkRGBA theme = {1, 1, 1, 1};
    gtk_style_context_lookup_color(gtk_widget_get_style_context(v->area), "theme_base_color", &theme);
    const float under[3] = {theme.red, theme.green, theme.blue};
    for (int i = 0; i < 3; i++)
        out[i] = scene->there ? scene->rgba[i] + (1 - scene->rgba[3]) * under[i] : under[i];
}

/* Title, bar and axes, of the size and the state that the session has now. */
static void figure_draw(view *v, const float under[3])
{
    if (!v->figure_due)
        return;
    tc_image *image = tc_view_figure_asked(v->session)
                          ? tc_view_figure_make(v->session, v->session->width, v->session->height, under)
                          : NULL;
    tc_view_draw_figure(&v->draw, image);
    tc_image_destroy(&image);
    v->figure_due = false;
}

static gboolean draw(GtkGLArea *area, GdkGLContext *context, gpointer user)
{
    view *v = user;
    float under[3];
    (void)context;
    const int scale = gtk_widget_get_scale_factor(GTK_WIDGET(area));
    if (!v->pictures)
        return FALSE;
    tc_pictures_show(v->pictures, &v->shown);
    background(under, v);
    figure_draw(v, under);
    tc_view_draw_layers(&v->draw, &v->shown, under, gtk_widget_get_width(v->area) * scale,
                        gtk_widget_get_height(v->area) * scale);
    return TRUE;
}

/* The frame that held a new picture is on its way to the screen. */
static void painted(GdkFrameClock *clock, gpointer user)
{
    view *v = user;
    (void)clock;
    if (!v->fresh || !v->shown.id)
        return;
    tc_pictures_painted(v->pictures);
    v->fresh = false;
    const bool at_full = v->shown.last && !v->shown.over.texture;
    if (v->shown.id != v->painted)
        tc_trace_mark(v->session->trace, "shown", v->shown.id, "divide", v->shown.divide);
    if (at_full && (v->shown.id != v->painted || !v->whole_painted))
        tc_trace_mark(v->session->trace, "rest", v->shown.id, "ms", v->shown.ms);
    v->painted = v->shown.id;
    v->whole_painted = at_full;
    if (v->changed)
        v->changed(v->changed_user, &v->shown);
}

static void resized(GtkGLArea *area, int width, int height, gpointer user)
{
    view *v = user;
    (void)area;
    if (width == v->session->width && height == v->session->height)
        return;
    v->hasty = v->session->width > 0;
    heard(v, TC_CHANGE_CAMERA);
}

static void refuse(view *v, const char *why)
{
    snprintf(
        v->refused, sizeof v->refused,
        "OpenGL 4.3 is needed for the picture, and this display does not give it (%s); tetcast render makes pictures "
        "without a display",
        why);
    tc_session_say(v->session, "%s", v->refused);
}

/* The context of the thread; NULL: refused. */
static GdkGLContext *context_make(view *v)
{
    GError *error = NULL;
    GdkGLContext *context = gdk_display_create_gl_context(gtk_widget_get_display(v->area), &error);
    if (context) {
        gdk_gl_context_set_required_version(context, 4, 3);
        if (!gdk_gl_context_realize(context, &error))
            g_clear_object(&context);
    }
    if (!context)
        refuse(v, error ? error->message : "it gave no context");
    g_clear_error(&error);
    return context;
}

static void realized(GtkWidget *widget, gpointer user)
{
    view *v = user;
    char why[256] = "";
    tc_error err = {0};
    gtk_gl_area_make_current(GTK_GL_AREA(widget));
    const GError *error = gtk_gl_area_get_error(GTK_GL_AREA(widget));
    if (error) {
        refuse(v, error->message);
        return;
    }
    if (!tc_view_draw_init(&v->draw, why)) {
        refuse(v, why);
        return;
    }
    GdkGLContext *context = context_make(v);
    if (!context)
        return;
    if (tc_pictures_create(&v->pictures, context, v->session->trace, arrived, v, &err) != TC_OK)
        refuse(v, err.text);
    g_object_unref(context);
    g_signal_connect(gtk_widget_get_frame_clock(widget), "after-paint", G_CALLBACK(painted), v);
    if (v->session->run.mesh)
        heard(v, TC_CHANGE_DATA);
}

static void unrealized(GtkWidget *widget, gpointer user)
{
    view *v = user;
    g_signal_handlers_disconnect_by_func(gtk_widget_get_frame_clock(widget), painted, v);
    tc_pictures_destroy(&v->pictures);
    gtk_gl_area_make_current(GTK_GL_AREA(widget));
    if (!gtk_gl_area_get_error(GTK_GL_AREA(widget)))
        tc_view_draw_finish(&v->draw);
}

/* --------------------------------------------------------------------------------------------------------- pointer */

static void moved_camera(view *v, bool hasty)
{
    v->hasty = hasty;
    tc_session_tell(v->session, TC_CHANGE_CAMERA);
}

static void drag_begin(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    view *v = user;
    const guint button = gtk_gesture_single_get_current_button(GTK_GESTURE_SINGLE(gesture));
    const GdkModifierType keys = gtk_event_controller_get_current_event_state(GTK_EVENT_CONTROLLER(gesture));
    gtk_widget_grab_focus(v->area);
    v->drag = button == GDK_BUTTON_MIDDLE || (keys & GDK_SHIFT_MASK) ? DRAG_SHIFT
              : button == GDK_BUTTON_SECONDARY                       ? DRAG_NEAR
              : keys & GDK_CONTROL_MASK                              ? DRAG_ROLL
                                                                     : DRAG_TURN;
    v->last_x = x;
    v->last_y = y;
    tc_session_grab(v->session);
}

static void drag_to(view *v, double x, double y)
{
    tc_camera *camera = &v->session->camera;
    const int width = gtk_widget_get_width(v->area), height = gtk_widget_get_height(v->area);
    const double dx = x - v->last_x, dy = y - v->last_y;
    if ((dx == 0 && dy == 0) || !v->session->run.mesh)
        return;
    switch (v->drag) {
    case DRAG_TURN:
        tc_camera_orbit(camera, -180 * dx / height, 180 * dy / height);
        break;
    case DRAG_SHIFT:
        tc_camera_pan(camera, dx, dy, height);
        break;
    case DRAG_NEAR:
        tc_camera_approach(camera, pow(2, -4 * dy / height), NAN, NAN, width, height);
        break;
    case DRAG_ROLL:
        tc_camera_twist(camera, v->last_x, v->last_y, x, y, width, height);
        break;
    default:
        return;
    }
    v->last_x = x;
    v->last_y = y;
    moved_camera(v, false);
}

static void drag_update(GtkGestureDrag *gesture, double offset_x, double offset_y, gpointer user)
{
    double x = 0, y = 0;
    gtk_gesture_drag_get_start_point(gesture, &x, &y);
    drag_to(user, x + offset_x, y + offset_y);
}

static void drag_end(GtkGestureDrag *gesture, double offset_x, double offset_y, gpointer user)
{
    view *v = user;
    (void)gesture;
    (void)offset_x;
    (void)offset_y;
    v->drag = DRAG_NONE;
    tc_session_release(v->session);
}

static gboolean scrolled(GtkEventControllerScroll *scroll, double dx, double dy, gpointer user)
{
    view *v = user;
    (void)scroll;
    (void)dx;
    if (!v->session->run.mesh)
        return FALSE;
    tc_camera_approach(&v->session->camera, pow(1.15, -dy), v->x, v->y, gtk_widget_get_width(v->area),
                       gtk_widget_get_height(v->area));
    moved_camera(v, true);
    return TRUE;
}

static void pointer_at(GtkEventControllerMotion *motion, double x, double y, gpointer user)
{
    view *v = user;
    (void)motion;
    v->x = x;
    v->y = y;
    probe_soon(v);
}

static void pointer_gone(GtkEventControllerMotion *motion, gpointer user)
{
    view *v = user;
    (void)motion;
    v->x = v->y = NAN;
    probe_soon(v);
}

/* ------------------------------------------------------------------------------------------------------------ keys */

static bool key_turns(view *v, guint key, GdkModifierType keys)
{
    tc_camera *camera = &v->session->camera;
    const int height = gtk_widget_get_height(v->area);
    const int right =
        (key == GDK_KEY_Right || key == GDK_KEY_KP_Right) - (key == GDK_KEY_Left || key == GDK_KEY_KP_Left);
    const int up = (key == GDK_KEY_Up || key == GDK_KEY_KP_Up) - (key == GDK_KEY_Down || key == GDK_KEY_KP_Down);
    if (right == 0 && up == 0)
        return false;
    if (keys & GDK_SHIFT_MASK)
        tc_camera_pan(camera, right * height / 20.0, -up * height / 20.0, height);
    else if (keys & GDK_CONTROL_MASK)
        tc_camera_roll(camera, 5 * (right ? right : up));
    else
        tc_camera_orbit(camera, 5 * right, 5 * up);
    return true;
}

static gboolean key_pressed(GtkEventControllerKey *controller, guint key, guint code, GdkModifierType keys,
                            gpointer user)
{
    view *v = user;
    tc_session *s = v->session;
    const int width = gtk_widget_get_width(v->area), height = gtk_widget_get_height(v->area);
    (void)controller;
    (void)code;
    if (keys & GDK_ALT_MASK || !s->run.mesh)
        return FALSE;
    if (key_turns(v, key, keys)) {
        moved_camera(v, true);
        return TRUE;
    }
    if (keys & GDK_CONTROL_MASK)
        return FALSE;
    if (key == GDK_KEY_plus || key == GDK_KEY_equal || key == GDK_KEY_KP_Add || key == GDK_KEY_minus ||
        key == GDK_KEY_KP_Subtract) {
        const bool in = key != GDK_KEY_minus && key != GDK_KEY_KP_Subtract;
        tc_camera_approach(&s->camera, in ? 1.1 : 1 / 1.1, NAN, NAN, width, height);
        moved_camera(v, true);
    } else if (key == GDK_KEY_r) {
        s->camera = s->home;
        moved_camera(v, false);
    } else if ((key >= GDK_KEY_x && key <= GDK_KEY_z) || (key >= GDK_KEY_X && key <= GDK_KEY_Z)) {
        const bool negative = key < GDK_KEY_a;
        tc_camera_stand(&s->camera, (int)(key - (negative ? GDK_KEY_X : GDK_KEY_x)), negative, s->run.report.bounds,
                        (double)width / height);
        moved_camera(v, false);
    } else if (key == GDK_KEY_p) {
        tc_view_probe(v->area, !v->probing);
    } else {
        return FALSE;
    }
    return TRUE;
}

/* ------------------------------------------------------------------------------------------------------------ life */

static void destroyed(GtkWidget *widget, gpointer user)
{
    view *v = user;
    (void)widget;
    if (v->rest)
        g_source_remove(v->rest);
    if (v->probe_idle)
        g_source_remove(v->probe_idle);
    v->rest = v->probe_idle = 0;
    v->changed = NULL;
    v->probed = NULL;
    tc_plot_unlisten(v->session, v);
    tc_probing_free(v->rays);
    v->rays = NULL;
}

static void controllers_add(view *v)
{
    GtkGesture *drag_gesture = gtk_gesture_drag_new();
    gtk_gesture_single_set_button(GTK_GESTURE_SINGLE(drag_gesture), 0);
    g_signal_connect(drag_gesture, "drag-begin", G_CALLBACK(drag_begin), v);
    g_signal_connect(drag_gesture, "drag-update", G_CALLBACK(drag_update), v);
    g_signal_connect(drag_gesture, "drag-end", G_CALLBACK(drag_end), v);
    gtk_widget_add_controller(v->area, GTK_EVENT_CONTROLLER(drag_gesture));

    GtkEventController *scroll = gtk_event_controller_scroll_new(GTK_EVENT_CONTROLLER_SCROLL_VERTICAL);
    g_signal_connect(scroll, "scroll", G_CALLBACK(scrolled), v);
    gtk_widget_add_controller(v->area, scroll);

    GtkEventController *motion = gtk_event_controller_motion_new();
    g_signal_connect(motion, "motion", G_CALLBACK(pointer_at), v);
    g_signal_connect(motion, "leave", G_CALLBACK(pointer_gone), v);
    gtk_widget_add_controller(v->area, motion);

    GtkEventController *keys = gtk_event_controller_key_new();
    g_signal_connect(keys, "key-pressed", G_CALLBACK(key_pressed), v);
    gtk_widget_add_controller(v->area, keys);
}

GtkWidget *tc_view_new(tc_session *session)
{
    view *v = g_new0(view, 1);
    v->session = session;
    v->x = v->y = NAN;
    v->area = g_object_new(GTK_TYPE_GL_AREA, "accessible-role", GTK_ACCESSIBLE_ROLE_IMG, "focusable", TRUE, "hexpand",
                           TRUE, "vexpand", TRUE, "auto-render", FALSE, NULL);
    g_object_set_data_full(G_OBJECT(v->area), "tc-view", v, g_free);
    gtk_gl_area_set_required_version(GTK_GL_AREA(v->area), 4, 3);
    gtk_accessible_update_property(
        GTK_ACCESSIBLE(v->area), GTK_ACCESSIBLE_PROPERTY_LABEL, "Picture of the volume",
        GTK_ACCESSIBLE_PROPERTY_DESCRIPTION,
        "Arrow keys turn it, plus and minus draw near, r begins again, x, y and z look from these sides, p probes", -1);
    gtk_widget_set_size_request(v->area, 160, 120);
    g_signal_connect(v->area, "realize", G_CALLBACK(realized), v);
    g_signal_connect(v->area, "unrealize", G_CALLBACK(unrealized), v);
    g_signal_connect(v->area, "render", G_CALLBACK(draw), v);
    g_signal_connect(v->area, "resize", G_CALLBACK(resized), v);
    g_signal_connect(v->area, "destroy", G_CALLBACK(destroyed), v);
    controllers_add(v);
    v->rays = tc_probing_new(session, ray_met, v);
    tc_session_listen(session, heard, v);
    return v->area;
}

void tc_view_listen(GtkWidget *widget, void (*changed)(void *user, const tc_shown *shown), void *user)
{
    view *v = view_of(widget);
    v->changed = changed;
    v->changed_user = user;
}

void tc_view_listen_probe(GtkWidget *widget, void (*probed)(void *user, const tc_probe *probe), void *user)
{
    view *v = view_of(widget);
    v->probed = probed;
    v->probed_user = user;
}

const char *tc_view_refused(GtkWidget *widget)
{
    return view_of(widget)->refused;
}
