/* load.c: the mesh of one step and field after the other. */
#include "cli/batch/load.h"

#include <string.h>

static bool tc_text_same(const char *a, const char *b)
{
    return a == b || (a && b && !strcmp(a, b));
}

static bool tc_load_same(const tc_load *a, const tc_load *b)
{
    return a->step == b->step && tc_text_same(a->path, b->path) && tc_text_same(a->field, b->field);
}

/* The reader's options for a load. */
static tc_input_options tc_load_source(const tc_loader *l, const tc_load *load)
{
    tc_input_options source = l->source;
    source.field = load->field;
    source.has_time = false;
    source.has_step = load->step >= 0;
    source.step = load->step;
    source.keep_reader = true;
    return source;
}

int tc_loader_open(tc_loader *out, const tc_input_options *source, const tc_load *first, tc_talk *talk)
{
    double ms;
    *out = (tc_loader){.source = *source, .last = *first};
    tc_input_options options = tc_load_source(out, first);
    return tc_input_load(&out->mesh, &ms, &options, first->path, talk);
}

/* Another mesh in place of the one there is. */
static void tc_loader_replace(tc_loader *l, tc_mesh *mesh, bool prepared)
{
    tc_mesh_destroy(&l->mesh);
    l->mesh = mesh;
    l->prepared = prepared;
}

/* The end of what was begun for this load. */
static int tc_ahead_take(tc_loader *l, bool *fresh, tc_talk *talk)
{
    tc_error err = {0};
    tc_mesh *moved = NULL;
    tc_status status = tc_mesh_ahead_end(&moved, l->mesh, &l->ahead, &talk->log, &err);
    if (status && status != TC_E_MOVED)
        return tc_talk_status(talk, status, &err);
    *fresh = status == TC_E_MOVED;
    if (*fresh)
        tc_loader_replace(l, moved, true);
    return -1;
}

/* Reads a load now. */
static int tc_load_now(tc_loader *l, bool *fresh, const tc_load *load, tc_talk *talk)
{
    const tc_input_options source = tc_load_source(l, load);
    double ms;
    if (tc_input_is_synthetic(load->path) && l->mesh)
        return -1;
    if (l->mesh) {
        int code = tc_input_step(&l->mesh, fresh, &ms, &source, load->path, talk);
        l->prepared = l->prepared && !*fresh;
        return code;
    }
    *fresh = true;
    l->prepared = false;
    return tc_input_load(&l->mesh, &ms, &source, load->path, talk);
}

int tc_loader_get(tc_loader *l, bool *fresh, const tc_load *load, tc_talk *talk)
{
    int code = -1;
    const bool begun = l->ahead && tc_load_same(&l->next, load);
    *fresh = false;
    if (l->ahead && !begun)
        tc_mesh_ahead_end(NULL, NULL, &l->ahead, NULL, NULL);
    if (begun)
        code = tc_ahead_take(l, fresh, talk);
    else if (l->again || !l->mesh || !tc_load_same(&l->last, load))
        code = tc_load_now(l, fresh, load, talk);
    l->again = code >= 0;
    if (code >= 0)
        return code;
    l->last = *load;
    if (!l->prepared) {
        code = tc_input_prepare(l->mesh, &l->source, talk);
        l->prepared = code < 0;
        l->again = code >= 0;
        *fresh = true;
    }
    l->set_up += *fresh;
    return code;
}

void tc_loader_begin(tc_loader *l, const tc_load *load)
{
    const tc_input_options source = tc_load_source(l, load);
    const tc_read_options read = tc_input_read_options(&source);
    const tc_prepare_options prepare = tc_input_prepare_options(&source);
    if (l->never_ahead || l->ahead || !l->prepared || tc_input_is_synthetic(load->path))
        return;
    if (tc_mesh_ahead_begin(&l->ahead, l->mesh, load->path, &read, &prepare, NULL) == TC_OK)
        l->next = *load;
}

void tc_loader_finish(tc_loader *l)
{
    if (l->ahead)
        tc_mesh_ahead_end(NULL, NULL, &l->ahead, NULL, NULL);
    tc_mesh_destroy(&l->mesh);
}
