/* renderer.c: the thread that makes the window's pictures. */
#include "window/renderer.h"
#include "edit/schedule.h"
#include "window/checker.h"
#include "window/host_gl.h"

#include <epoxy/gl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* SLOTS: textures: two layers being made, two ready, two shown, one to come. */
/* TELL_EVERY_MS: what is not whole is shown so often; in software showing a picture costs about what a part of one
 * does. */
/* PAINT_MS: a window that is not seen is not painted. */
/* BUDGET_MS: of a picture while something moves. A move waits for half of the picture at hand, for its own and for some
 * 30 ms until that is painted: 90 ms, so that 100 are kept with some room. */
enum { SLOTS = 8, KEEP_BYTES = 256 << 20, KEEP_STEPS = 8192, TELL_EVERY_MS = 400, BUDGET_MS = 40, PAINT_MS = 30 };

typedef struct request {
    tc_held *held; /* mesh and look; NULL: nothing to show */
    const tc_mesh *mesh;
    tc_document *document;
    tc_camera camera;
    tc_render_options options; /* at full size, with what was asked for */
    bool moving;
    unsigned id;
} request;

typedef struct slot {
    GLuint texture;
    int width, height, used;
} slot;

/* A layer by its slot; -1: none. */
typedef struct layer {
    int at;
    int rows;
    double stretch;
} layer;

typedef struct made {
    layer whole, over;
    unsigned id;
    int divide;
    bool last, checked;
    double ms, error;
    tc_render_stats stats;
} made;

struct tc_pictures {
    GThread *thread;
    GMutex lock;
    GCond more, painted;
    GdkGLContext *context;
    tc_trace *trace;
    tc_checker *checker;
    void (*arrived)(void *user);
    void *user;
    /* under the lock */
    bool quit, has_next, is_new, unpainted, told, has_check;
    request next;
    made ready, shown;
    slot pool[SLOTS];
    char error[1024];
    unsigned check_id;
    double check_error;
    guint idle;
    /* of the thread */
    request now;
    tc_transfer *tf; /* of now; NULL: not made yet */
    tc_renderer *renderer;
    tc_schedule schedule;
    made making;
    GLuint frame, part;
    int part_width, part_height;
    bool along; /* the function alone changed since the last picture, so that walks are kept */
    bool failed;
    double told_ms; /* when a picture was published last */
};

static void request_finish(request *r)
{
    tc_held_drop(&r->held);
    tc_document_destroy(&r->document);
    memset(r, 0, sizeof *r);
}

/* ---------------------------------------------------------------------------------------------------------- layers */

static const layer no_layer = {.at = -1};

static layer layer_take(tc_pictures *p, layer from)
{
    if (from.at >= 0)
        p->pool[from.at].used++;
    return from;
}

static void layer_drop(tc_pictures *p, layer *l)
{
    if (l->at >= 0)
        p->pool[l->at].used--;
    *l = no_layer;
}

/* A texture of that size that nobody uses. */
static layer layer_make(tc_pictures *p, int width, int height)
{
    int at = -1;
    g_mutex_lock(&p->lock);
    for (int i = 0; i < SLOTS; i++) /* one of that size, else one that is there, else a new one */
        if (!p->pool[i].used && (at < 0 || (p->pool[i].width == width && p->pool[i].height == height)))
            at = i;
    g_assert(at >= 0);
    slot *s = &p->pool[at];
    s->used = 1;
    g_mutex_unlock(&p->lock);
    if (!s->texture)
        glGenTextures(1, &s->texture);
    if (s->width != width || s->height != height) {
        glBindTexture(GL_TEXTURE_2D, s->texture);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, NULL);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
        glBindTexture(GL_TEXTURE_2D, 0);
        s->width = width;
        s->height = height;
    }
    return (layer){.at = at};
}

/* ---------------------------------------------------------------------------------------------------------- telling */

static gboolean tell(gpointer user)
{
    tc_pictures *p = user;
    g_mutex_lock(&p->lock);
    p->idle = 0;
    g_mutex_unlock(&p->lock);
    p->arrived(p->user);
    return G_SOURCE_REMOVE;
}

/* With the lock. */
static void tell_soon(tc_pictures *p)
{
    if (!p->idle && !p->quit)
        p->idle = g_idle_add_full(G_PRIORITY_HIGH, tell, p, NULL);
}

/* In software both threads draw with the same workers: the next picture waits until this one is painted, so that the
 * main thread does not wait for it. */
static void publish(tc_pictures *p)
{
    p->told_ms = tc_trace_now();
    g_mutex_lock(&p->lock);
    layer_drop(p, &p->ready.whole);
    layer_drop(p, &p->ready.over);
    p->ready = p->making;
    layer_take(p, p->ready.whole);
    layer_take(p, p->ready.over);
    p->is_new = p->unpainted = true;
    tell_soon(p);
    const gint64 until = g_get_monotonic_time() + 1000 * PAINT_MS;
    while (p->unpainted && !p->quit && g_cond_wait_until(&p->painted, &p->lock, until))
        ;
    g_mutex_unlock(&p->lock);
}

static void fail(tc_pictures *p, const char *text)
{
    g_mutex_lock(&p->lock);
    snprintf(p->error, sizeof p->error, "%s", text);
    tell_soon(p);
    g_mutex_unlock(&p->lock);
}

static void checked(void *user, unsigned id, double error)
{
    tc_pictures *p = user;
    g_mutex_lock(&p->lock);
    p->has_check = true;
    p->check_id = id;
    p->check_error = error;
    tell_soon(p);
    g_mutex_unlock(&p->lock);
}

/* -------------------------------------------------------------------------------------------------------- requests */

/* Is it another picture but for function and camera? */
static bool is_other(const request *a, const request *b)
{
    tc_render_options x = a->options, y = b->options;
    x.unit_distance = y.unit_distance = 0;
    x.has_nan_color = y.has_nan_color = false;
    memset(x.nan_color, 0, sizeof x.nan_color);
    memset(y.nan_color, 0, sizeof y.nan_color);
    return a->held != b->held || memcmp(&x, &y, sizeof x) != 0;
}

/* The request that waits becomes the one at hand. */
static void take_next(tc_pictures *p, request *next)
{
    const bool first = !p->now.document;
    const bool sized =
        first || p->now.options.width != next->options.width || p->now.options.height != next->options.height;
    const bool other = sized || is_other(&p->now, next);
    const bool view = other || memcmp(&p->now.camera, &next->camera, sizeof next->camera) != 0;
    const bool function = first || !tc_document_equal(p->now.document, next->document);
    if (first)
        tc_schedule_begin(&p->schedule, next->options.width, next->options.height);
    else if (sized)
        tc_schedule_resize(&p->schedule, next->options.width, next->options.height);
    p->schedule.budget_ms = BUDGET_MS;
    if (view) { /* the walks of the view before will not come again */
        if (p->renderer)
            tc_renderer_forget(p->renderer);
        p->along = false;
    } else if (function) {
        p->along = true;
    }
    if (view || function)
        tc_schedule_change(&p->schedule, next->moving);
    if (!next->moving)
        tc_schedule_rest(&p->schedule);
    if (function)
        tc_transfer_destroy(&p->tf);
    if (view || function) {
        g_mutex_lock(&p->lock);
        layer_drop(p, &p->making.over);
        g_mutex_unlock(&p->lock);
        tc_checker_stop(p->checker);
    }
    request_finish(&p->now);
    p->now = *next;
    memset(next, 0, sizeof *next);
}

static bool function_make(tc_pictures *p)
{
    tc_error err = {0};
    if (p->tf)
        return true;
    const double begin = tc_trace_now();
    if (tc_document_function(&p->tf, p->now.document, &err) != TC_OK) {
        fail(p, err.text);
        return false;
    }
    tc_trace_span(p->trace, "function", begin, tc_trace_now(), p->now.id, NULL, 0);
    return true;
}

/* ------------------------------------------------------------------------------------------------------- rendering */

static bool target(tc_pictures *p, GLuint texture)
{
    static const GLfloat clear[4] = {0, 0, 0, 0};
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, p->frame);
    glFramebufferTexture(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, texture, 0);
    const bool good = glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    if (good)
        glClearBufferfv(GL_COLOR, 0, clear);
    return good;
}

/* The texture that parts are made in before they are laid into a layer. */
static GLuint part_texture(tc_pictures *p, int width, int height)
{
    if (!p->part)
        glGenTextures(1, &p->part);
    if (p->part_width != width || p->part_height < height) {
        glBindTexture(GL_TEXTURE_2D, p->part);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, NULL);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
        glBindTexture(GL_TEXTURE_2D, 0);
        p->part_width = width;
        p->part_height = height;
    }
    return p->part;
}

static double positive(double ms)
{
    return ms > 0 ? ms : 0;
}

/* Begins the layer of a step, or finds the one that earlier parts are in. */
static layer *layer_of(tc_pictures *p, const tc_step *step, int width, int height)
{
    made *m = &p->making;
    if (step->from == 0) {
        const double view = (double)p->now.options.width / p->now.options.height;
        layer made_new = layer_make(p, width, height);
        made_new.stretch = (double)width / height / view;
        g_mutex_lock(&p->lock);
        layer_drop(p, &m->over);
        g_mutex_unlock(&p->lock);
        m->over = made_new;
    }
    return &m->over;
}

/* The picture at rest goes to the checker. */
static void check_begin(tc_pictures *p)
{
    const layer *whole = &p->making.whole;
    const slot *s = &p->pool[whole->at];
    tc_check check = {.mesh = p->now.mesh, .camera = p->now.camera, .options = p->now.options, .id = p->now.id};
    if (tc_image_create(&check.image, s->width, s->height, NULL) != TC_OK)
        return;
    const size_t row = 4 * (size_t)s->width;
    float *rgba = check.image->rgba, *swap = malloc(row * sizeof *swap);
    glBindTexture(GL_TEXTURE_2D, s->texture);
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, rgba);
    glBindTexture(GL_TEXTURE_2D, 0);
    for (int y = 0; swap && y < s->height / 2; y++) {
        float *a = rgba + (size_t)y * row, *b = rgba + (size_t)(s->height - 1 - y) * row;
        memcpy(swap, a, row * sizeof *swap);
        memcpy(a, b, row * sizeof *swap);
        memcpy(b, swap, row * sizeof *swap);
    }
    check.held = tc_held_take(p->now.held);
    if (swap && tc_document_function(&check.tf, p->now.document, NULL) == TC_OK)
        tc_checker_begin(p->checker, &check);
    free(swap);
    tc_check_finish(&check);
}

/* Renders one step; false: it failed, and the picture is given up. */
static bool render(tc_pictures *p, const tc_step *step, bool kept)
{
    const int divide = step->divide, full_width = p->now.options.width, full_height = p->now.options.height;
    const int width = (full_width + divide - 1) / divide, height = (full_height + divide - 1) / divide;
    const bool whole = step->from == 0 && step->rows >= height;
    tc_render_options options = p->now.options;
    tc_render_stats stats;
    tc_error err = {0};
    options.width = width;
    options.height = step->rows;
    if (!whole) {
        options.whole_width = width;
        options.whole_height = height;
        options.part_y = step->from;
    }
    if (!step->last && (divide > 1 || p->now.moving))
        options.samples = 1;
    const double begin = tc_trace_now();
    layer *into = layer_of(p, step, width, height);
    const GLuint layer_texture = p->pool[into->at].texture;
    const GLuint texture = whole ? layer_texture : part_texture(p, width, step->rows);
    const bool keep = p->along && p->now.moving && whole;
    tc_renderer_keep(p->renderer, keep ? KEEP_BYTES : 0, true);
    if (keep && options.steps_per_pass == 0) /* kept walks are gone along in one pass; sums are rounded elsewhere, which is
                                                not seen while something moves */
        options.steps_per_pass = KEEP_STEPS;
    tc_status status = TC_E_GL;
    if (!target(p, texture))
        snprintf(err.text, sizeof err.text, "OpenGL cannot draw into a texture of floats of %dx%d pixels", width,
                 height);
    else
        status = tc_render_gl(p->frame, &stats, p->renderer, p->now.mesh, p->tf, &p->now.camera, &options, NULL, &err);
    if (status != TC_OK) {
        fail(p, err.text);
        return false;
    }
    if (!whole)
        glCopyImageSubData(texture, GL_TEXTURE_2D, 0, 0, 0, 0, layer_texture, GL_TEXTURE_2D, 0, 0,
                           height - step->from - step->rows, 0, width, step->rows, 1);
    glFinish();
    const double end = tc_trace_now();
    const double once = positive(stats.ms_pack) + positive(stats.ms_upload) + positive(stats.ms_compile);
    tc_trace_span(p->trace, "render", begin, end, p->now.id, "divide", divide);
    if (stats.ms_table > 0.01) /* it was built for this picture */
        tc_trace_span(p->trace, "table", begin, begin + stats.ms_table, p->now.id, NULL, 0);
    const bool recorded = stats.bytes_kept > p->making.stats.bytes_kept; /* which takes as long as two pictures */
    tc_schedule_done(&p->schedule, step, fmax(end - begin - once, 0.01), kept && stats.kept && !recorded);
    into->rows = step->from + step->rows;
    made *m = &p->making;
    m->stats = stats;
    m->stats.fragments_per_pass = NULL;
    m->stats.n_fragments_per_pass = 0;
    m->ms = step->from == 0 ? end - begin : m->ms + (end - begin);
    m->id = p->now.id;
    m->last = step->last;
    m->checked = false;
    if (into->rows >= height) {
        g_mutex_lock(&p->lock);
        layer_drop(p, &m->whole);
        m->whole = m->over;
        m->over = no_layer;
        g_mutex_unlock(&p->lock);
        m->divide = divide;
    }
    return true;
}

/* ----------------------------------------------------------------------------------------------------------- thread */

static bool open_renderer(tc_pictures *p)
{
    tc_error err = {0};
    const tc_renderer_options options = {.get_proc_address = tc_host_proc_address, .keep_at_once = true};
    gdk_gl_context_make_current(p->context);
    if (!tc_host_gl_ready()) {
        fail(p, "the functions of OpenGL could not be found: neither EGL nor GLX gives their addresses");
        return false;
    }
    glGenFramebuffers(1, &p->frame);
    if (tc_renderer_create(&p->renderer, &options, NULL, &err) != TC_OK) {
        fail(p, err.text);
        return false;
    }
    return true;
}

static void close_renderer(tc_pictures *p)
{
    tc_renderer_destroy(&p->renderer);
    for (int i = 0; i < SLOTS; i++)
        glDeleteTextures(1, &p->pool[i].texture);
    glDeleteTextures(1, &p->part);
    glDeleteFramebuffers(1, &p->frame);
    gdk_gl_context_clear_current();
    tc_transfer_destroy(&p->tf);
    request_finish(&p->now);
}

/* Waits where there is nothing to do. False: it is to end. */
static bool receive(tc_pictures *p, bool idle)
{
    request next = {0};
    g_mutex_lock(&p->lock);
    while (idle && !p->has_next && !p->quit)
        g_cond_wait(&p->more, &p->lock);
    const bool quit = p->quit, has = p->has_next;
    if (has)
        next = p->next;
    memset(&p->next, 0, sizeof p->next);
    p->has_next = false;
    g_mutex_unlock(&p->lock);
    if (has && !quit) {
        p->failed = false;
        take_next(p, &next);
    }
    request_finish(&next);
    return !quit;
}

static void *work(void *user)
{
    tc_pictures *p = user;
    bool idle = true;
    const bool good = open_renderer(p);
    while (receive(p, idle)) {
        const bool kept = p->along && p->now.moving;
        tc_step step;
        idle = true;
        if (!good || p->failed || !p->now.held || !tc_schedule_next(&step, &p->schedule, kept))
            continue;
        if (!function_make(p) || !render(p, &step, kept)) {
            p->failed = true;
            continue;
        }
        idle = false;
        if (p->making.over.at < 0 || tc_trace_now() - p->told_ms > TELL_EVERY_MS)
            publish(p);
        if (step.last && p->making.over.at < 0)
            check_begin(p);
    }
    close_renderer(p);
    return NULL;
}

/* ------------------------------------------------------------------------------------------------------ from outside
 */

tc_status tc_pictures_create(tc_pictures **out, GdkGLContext *context, tc_trace *trace, void (*arrived)(void *user),
                             void *user, tc_error *err)
{
    tc_pictures *p = g_new0(tc_pictures, 1);
    *out = NULL;
    g_mutex_init(&p->lock);
    g_cond_init(&p->more);
    g_cond_init(&p->painted);
    p->context = g_object_ref(context);
    p->trace = trace;
    p->arrived = arrived;
    p->user = user;
    p->making.whole = p->making.over = p->ready.whole = p->ready.over = p->shown.whole = p->shown.over = no_layer;
    const tc_status status = tc_checker_create(&p->checker, checked, p, err);
    if (status != TC_OK) {
        g_object_unref(p->context);
        g_free(p);
        return status;
    }
    p->thread = g_thread_new("pictures", work, p);
    *out = p;
    return TC_OK;
}

void tc_pictures_destroy(tc_pictures **pictures)
{
    tc_pictures *p = *pictures;
    if (!p)
        return;
    g_mutex_lock(&p->lock);
    p->quit = true;
    g_cond_signal(&p->more);
    g_cond_signal(&p->painted);
    g_mutex_unlock(&p->lock);
    g_thread_join(p->thread);        /* the thread hands pictures to the checker until it ends */
    tc_checker_destroy(&p->checker); /* what it finds, it tells here */
    if (p->idle)
        g_source_remove(p->idle);
    request_finish(&p->next);
    g_object_unref(p->context);
    g_mutex_clear(&p->lock);
    g_cond_clear(&p->more);
    g_cond_clear(&p->painted);
    g_free(p);
    *pictures = NULL;
}

void tc_pictures_ask(tc_pictures *p, const tc_session *session, int width, int height, bool moving, unsigned id)
{
    request r = {.mesh = session->run.mesh, .camera = session->camera, .moving = moving, .id = id};
    if (!session->look || width < 1 || height < 1 || tc_document_copy(&r.document, session->document, NULL) != TC_OK)
        return;
    r.held = tc_held_take(session->look);
    r.options = session->run.render;
    r.options.width = width;
    r.options.height = height;
    r.options.unit_distance = session->document->unit_distance;
    r.options.has_nan_color = session->document->has_nan_color;
    memcpy(r.options.nan_color, session->document->nan_color, sizeof r.options.nan_color);
    g_mutex_lock(&p->lock);
    request_finish(&p->next);
    p->next = r;
    p->has_next = true;
    g_cond_signal(&p->more);
    g_mutex_unlock(&p->lock);
}

static tc_layer layer_show(const tc_pictures *p, const layer *l)
{
    if (l->at < 0)
        return (tc_layer){0};
    const slot *s = &p->pool[l->at];
    return (tc_layer){
        .texture = s->texture, .width = s->width, .height = s->height, .stretch = l->stretch, .rows = l->rows};
}

void tc_pictures_show(tc_pictures *p, tc_shown *out)
{
    g_mutex_lock(&p->lock);
    if (p->is_new) {
        layer_drop(p, &p->shown.whole);
        layer_drop(p, &p->shown.over);
        p->shown = p->ready;
        layer_take(p, p->shown.whole);
        layer_take(p, p->shown.over);
        p->is_new = false;
    }
    if (p->has_check && p->check_id == p->shown.id && p->shown.last) {
        p->shown.checked = true;
        p->shown.error = p->check_error;
        p->has_check = false;
    }
    *out = (tc_shown){
        .whole = layer_show(p, &p->shown.whole),
        .over = layer_show(p, &p->shown.over),
        .id = p->shown.id,
        .divide = p->shown.divide,
        .last = p->shown.last,
        .ms = p->shown.ms,
        .stats = p->shown.stats,
        .checked = p->shown.checked,
        .error = p->shown.error,
    };
    g_mutex_unlock(&p->lock);
}

void tc_pictures_painted(tc_pictures *p)
{
    g_mutex_lock(&p->lock);
    p->unpainted = p->is_new;
    g_cond_signal(&p->painted);
    g_mutex_unlock(&p->lock);
}

void tc_pictures_error(tc_pictures *p, char out[1024])
{
    g_mutex_lock(&p->lock);
    memcpy(out, p->error, sizeof p->error);
    p->error[0] = 0;
    g_mutex_unlock(&p->lock);
}
