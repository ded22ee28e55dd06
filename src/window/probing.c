/* probing.c: what the ray under the pointer meets. One thread at a time; what is asked for meanwhile waits, but for the
 * last. */
#include "window/probing.h"

#include <gio/gio.h>

/* A ray, and all that is needed to follow it. */
typedef struct ray {
    struct tc_probing *probing;
    tc_held *held;
    const tc_mesh *mesh;
    tc_document *document;
    tc_camera camera;
    int width, height, x, y;
    tc_probe *probe;
} ray;

struct tc_probing {
    const tc_session *session;
    void (*probed)(void *user, const tc_probe *probe);
    void *user;
    bool under_way, waits, over;
    int x, y; /* that wait */
};

static void begin(tc_probing *p);

static gboolean arrived(gpointer user)
{
    ray *r = user;
    tc_probing *p = r->probing;
    p->under_way = false;
    if (p->over) {
        g_free(p);
    } else {
        p->probed(p->user, r->probe);
        if (p->waits)
            begin(p);
    }
    tc_probe_destroy(&r->probe);
    tc_document_destroy(&r->document);
    tc_held_drop(&r->held);
    g_free(r);
    return G_SOURCE_REMOVE;
}

static gpointer work(gpointer user)
{
    ray *r = user;
    tc_transfer *tf = NULL;
    if (tc_document_function(&tf, r->document, NULL) == TC_OK)
        tc_mesh_probe(&r->probe, r->mesh, tf, r->document->unit_distance, &r->camera, r->width, r->height, r->x, r->y,
                      NULL);
    tc_transfer_destroy(&tf);
    g_idle_add_full(G_PRIORITY_DEFAULT, arrived, r, NULL);
    return NULL;
}

/* With what waits. */
static void begin(tc_probing *p)
{
    const tc_session *s = p->session;
    tc_document *document = NULL;
    p->waits = false;
    if (!s->run.mesh || p->x < 0 || p->y < 0 || p->x >= s->width || p->y >= s->height ||
        tc_document_copy(&document, s->document, NULL) != TC_OK) {
        p->probed(p->user, NULL);
        return;
    }
    ray *r = g_new0(ray, 1);
    *r = (ray){.probing = p,
               .held = tc_held_take(s->mesh),
               .mesh = s->run.mesh,
               .document = document,
               .camera = s->camera,
               .width = s->width,
               .height = s->height,
               .x = p->x,
               .y = p->y};
    p->under_way = true;
    g_thread_unref(g_thread_new("probe", work, r));
}

tc_probing *tc_probing_new(const tc_session *session, void (*probed)(void *user, const tc_probe *probe), void *user)
{
    tc_probing *p = g_new0(tc_probing, 1);
    p->session = session;
    p->probed = probed;
    p->user = user;
    return p;
}

void tc_probing_ask(tc_probing *p, int x, int y)
{
    p->x = x;
    p->y = y;
    p->waits = true;
    if (!p->under_way)
        begin(p);
}

void tc_probing_free(tc_probing *p)
{
    if (!p)
        return;
    p->over = true;
    if (!p->under_way)
        g_free(p);
}
