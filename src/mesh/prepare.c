/* prepare.c: the way of a mesh from arrays to what the casters read: repair, order, adjacency, gaps. */
#include "core/memory.h"
#include "core/parallel.h"
#include "mesh/adjacency.h"
#include "mesh/mesh.h"
#include "mesh/order.h"
#include "mesh/repair.h"

#include <stdlib.h>
#include <string.h>

/* Links the repaired, ordered mesh; equal tets are found on the way and all but one of each dropped. */
static tc_status link_mesh(tc_mesh *m, int threads, tc_error *err)
{
    tc_mesh_report *r = &m->report;
    tc_adjacency_result found;
    tc_status status = TC_OK;
    uint8_t *duplicate = tc_alloc(m->n_tet, 1);
    m->neighbour = tc_alloc(m->n_tet, 4 * sizeof *m->neighbour);
    if (!duplicate || !m->neighbour) {
        free(duplicate);
        return tc_fail_memory(err, "the neighbours", m->n_tet, 17);
    }
    do {
        tc_adjacency_input in = {.vertex = m->vertex,
                                 .n_vertex = m->n_vertex,
                                 .tet = m->tet,
                                 .n_tet = m->n_tet,
                                 .n_zero_volume = r->zero_volume,
                                 .threads = threads};
        status = tc_adjacency_build(m->neighbour, duplicate, &found, &in, err);
        if (status != TC_OK)
            break;
        if (found.duplicates > 0) {
            r->dropped_duplicate += found.duplicates;
            tc_mesh_drop_tets(m, duplicate);
        }
    } while (found.duplicates > 0);
    free(duplicate);
    r->unlinked_faces = found.many + found.one_side;
    return status;
}

static tc_status prepare_first(tc_mesh *mesh, const tc_prepare_options *o, const tc_log *log, tc_error *err)
{
    tc_mesh next = {0};
    next.report.source_cells = mesh->report.source_cells;
    double t0 = tc_now_ms();
    tc_progress(log, "checking the mesh", -1);
    tc_status status = tc_mesh_repair(&next, mesh, o->threads, err);
    double t1 = tc_now_ms();
    if (status == TC_OK) {
        tc_progress(log, "ordering cells", -1);
        status = tc_mesh_order(&next, o->threads, err);
    }
    double t2 = tc_now_ms();
    if (status == TC_OK) {
        tc_progress(log, "linking cells", -1);
        status = link_mesh(&next, o->threads, err);
    }
    double t3 = tc_now_ms();
    tc_mesh_report *r = &next.report;
    if (status == TC_OK)
        status = tc_adjacency_components(&r->n_component, next.neighbour, next.n_tet, err);
    if (status != TC_OK) {
        tc_mesh_finish_arrays(&next);
        return status;
    }
    r->n_vertex = next.n_vertex, r->n_tet = next.n_tet;
    for (size_t i = 0; i < 4 * next.n_tet; i++)
        r->n_boundary_face += next.neighbour[i] < 0;
    tc_mesh_measure(&next, o->threads);
    tc_mesh_measure_scalar(&next);
    r->reentry = TC_REENTRY_PEEL;
    r->ms_check = t1 - t0 + tc_now_ms() - t3;
    r->ms_order = t2 - t1, r->ms_adjacency = t3 - t2;

    next.field_name = mesh->field_name;
    next.source = mesh->source, next.source_memory = mesh->source_memory;
    next.serial = tc_mesh_new_serial();
    next.scalar_serial = tc_mesh_new_serial();
    next.prepared = true;
    next.asked = TC_REENTRY_PEEL;
    tc_mesh_finish_arrays(mesh);
    *mesh = next;
    return TC_OK;
}

tc_status tc_mesh_prepare(tc_mesh *mesh, const tc_prepare_options *options, const tc_log *log, tc_error *err)
{
    if (!mesh)
        return tc_fail(err, TC_E_ARG, "tc_mesh_prepare: mesh is NULL");
    tc_prepare_options none = {0};
    const tc_prepare_options *o = options ? options : &none;
    if (o->reentry < TC_REENTRY_AUTO || o->reentry > TC_REENTRY_PEEL)
        return tc_fail(err, TC_E_ARG, "tc_mesh_prepare: there is no reentry %d", (int)o->reentry);
    if (!mesh->prepared)
        return prepare_first(mesh, o, log, err);
    return TC_OK;
}
