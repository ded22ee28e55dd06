/* held.c: meshes and looks that several threads use. */
#include "window/held.h"

#include <stdatomic.h>
#include <stdlib.h>

struct tc_held {
    atomic_int n;
    tc_mesh *mesh;
    tc_look_parts *look;
    tc_held *under;
};

static tc_held *create(void)
{
    tc_held *held = calloc(1, sizeof *held);
    if (held)
        atomic_init(&held->n, 1);
    return held;
}

tc_held *tc_held_mesh(tc_mesh *mesh)
{
    tc_held *held = create();
    if (held)
        held->mesh = mesh;
    return held;
}

tc_held *tc_held_look(tc_look_parts *look, tc_held *mesh)
{
    tc_held *held = create();
    if (held) {
        held->look = look;
        held->under = tc_held_take(mesh);
    }
    return held;
}

tc_held *tc_held_take(tc_held *held)
{
    if (held)
        atomic_fetch_add(&held->n, 1);
    return held;
}

void tc_held_drop(tc_held **slot)
{
    tc_held *held = *slot;
    *slot = NULL;
    if (!held || atomic_fetch_sub(&held->n, 1) > 1)
        return;
    if (held->look)
        tc_look_parts_finish(held->look);
    free(held->look);
    tc_mesh_destroy(&held->mesh);
    tc_held_drop(&held->under);
    free(held);
}
