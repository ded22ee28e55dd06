/* prepare.c: the way of a mesh from arrays to what the casters read: repair, order, adjacency, gaps. */
#include "core/memory.h"
#include "core/parallel.h"
#include "core/room.h"
#include "mesh/adjacency.h"
#include "mesh/boundary.h"
#include "mesh/convexify.h"
#include "mesh/mesh.h"
#include "mesh/order.h"
#include "mesh/predicate.h"
#include "mesh/repair.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Takes the zero-volume tets that will be dropped out of the count. */
static void forget_flat(tc_mesh *m, const uint8_t *drop)
{
    const double *x = m->vertex;
    for (size_t t = 0; t < m->n_tet && m->report.zero_volume > 0; t++) {
        const int32_t *v = m->tet + 4 * t;
        if (drop[t] &&
            tc_orient3d(x + 3 * (size_t)v[0], x + 3 * (size_t)v[1], x + 3 * (size_t)v[2], x + 3 * (size_t)v[3]) == 0)
            m->report.zero_volume--;
    }
}

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
            forget_flat(m, duplicate);
            tc_mesh_drop_tets(m, duplicate);
        }
    } while (found.duplicates > 0);
    free(duplicate);
    r->faces_of_many = found.many, r->faces_one_side = found.one_side;
    r->unlinked_faces = found.many + found.one_side;
    return status;
}

/* Says what became of cells that do not fit together. Overlaps beyond these are not looked for: telling them all would
 * cost more than the picture. */
void tc_mesh_say_defects(const tc_log *log, const tc_mesh_report *r)
{
    static const char what[] = "these faces are treated as boundaries, where rays leave the mesh and enter again, and "
                               "overlapping cells are composited in the order of entry";
    if (r->faces_of_many > 0)
        tc_say(log, TC_WARNING, "%zu faces have three cells or more, some of which must overlap: %s", r->faces_of_many,
               what);
    if (r->faces_one_side > 0)
        tc_say(log, TC_WARNING, "%zu faces lie between two cells on one side, which overlap: %s", r->faces_one_side,
               what);
    if (r->dropped_duplicate > 0)
        tc_say(log, TC_INFO, "%zu cells are there more than once: the copies were dropped", r->dropped_duplicate);
}

/* Beside the mesh itself, at most: until the arrays it came in are given back, new ones (16 B a tet for its vertices, 4
 * for where it came from, 36 a vertex) with links (16) and what finds them (10); then, in place of the old ones (16 and
 * 32), what gpu/pack.c and GL's copy of it take (32 and 32). */
static size_t memory_of(const tc_mesh *m)
{
    size_t values = m->association == TC_CELL_DATA ? 8 : 0;
    return m->n_tet * (52 + values) + m->n_vertex * 36;
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
        status = tc_adjacency_components(&r->n_component, next.neighbour, next.n_tet, o->threads, err);
    if (status == TC_OK)
        status = tc_mesh_measure(&next, o->threads, err);
    if (status != TC_OK) {
        tc_mesh_finish_arrays(&next);
        return status;
    }
    r->n_vertex = next.n_vertex, r->n_tet = next.n_tet;
    for (size_t i = 0; i < 4 * next.n_tet; i++)
        r->n_boundary_face += next.neighbour[i] < 0;
    tc_mesh_measure_scalar(&next);
    next.file = mesh->file;
    r->dropped_degenerate += next.file.degenerate;
    r->reoriented += next.file.turned;
    r->unused_vertices += next.file.unused_points;
    r->merged_vertices += next.file.merged_points;
    r->reentry = TC_REENTRY_PEEL;
    r->ms_check = t1 - t0 + tc_now_ms() - t3;
    r->ms_order = t2 - t1, r->ms_adjacency = t3 - t2, r->ms_convexify = NAN;

    next.field_name = mesh->field_name;
    next.source = mesh->source, next.source_memory = mesh->source_memory;
    next.source_hash = mesh->source_hash, next.reader = mesh->reader;
    next.ahead = mesh->ahead, next.ahead_wait = mesh->ahead_wait, next.ahead_leave = mesh->ahead_leave;
    next.serial = tc_mesh_new_serial();
    next.scalar_serial = tc_mesh_new_serial();
    next.prepared = true;
    tc_mesh_finish_arrays(mesh);
    *mesh = next;
    tc_mesh_say_defects(log, &mesh->report);
    return TC_OK;
}

/* As much of a text as fits, in whole UTF-8 characters. */
static void copy_text(char *out, size_t capacity, const char *text)
{
    size_t n = strlen(text);
    if (n >= capacity)
        for (n = capacity - 1; n > 0 && ((unsigned char)text[n] & 0xc0) == 0x80;)
            n--;
    memcpy(out, text, n);
    out[n] = 0;
}

/* Lets rays cross gaps in the way that was asked for. The mesh is linked; imaginary tets it has are taken away first.
 * On failure it stays prepared, for peeling. */
static tc_status fill_gaps(tc_mesh *m, const tc_prepare_options *o, const tc_log *log, tc_error *err)
{
    tc_mesh_report *r = &m->report;
    tc_boundary boundary;
    tc_error own = {0};
    tc_mesh_strip(m);
    r->reentry = m->asked = TC_REENTRY_PEEL;
    m->gaps_may_do = false;
    m->once_peeled = 0;
    r->reentry_why[0] = 0;
    r->ms_convexify = NAN;
    m->serial = tc_mesh_new_serial();
    tc_status status = tc_boundary_build(&boundary, m, m->n_tet, err);
    if (status != TC_OK)
        return status;
    r->convex = tc_boundary_is_convex(&boundary, m->vertex, tc_boundary_rounding(r->bounds));
    if (o->reentry == TC_REENTRY_AUTO && !r->convex && tc_mesh_peel_is_sooner(m, &boundary, o->once_pixels)) {
        tc_boundary_finish(&boundary);
        copy_text(r->reentry_why, sizeof r->reentry_why, "a single picture is there sooner than the gaps are filled");
        tc_say(log, TC_INFO, "re-entry by depth peeling is used: %s", r->reentry_why);
        m->once_peeled = o->once_pixels;
        return TC_OK; /* m->asked stays PEEL: a later call may fill them */
    }
    if (o->reentry != TC_REENTRY_PEEL && !r->convex) {
        double start = tc_now_ms();
        tc_progress(log, "filling gaps", -1);
        status = tc_mesh_convexify(m, &boundary, o->convexify_limit_s, o->threads, log, &own);
        r->ms_convexify = tc_now_ms() - start;
    }
    tc_boundary_finish(&boundary);
    if (status != TC_OK) {
        m->gaps_may_do = status == TC_E_WORKER || status == TC_E_MEMORY;
        copy_text(r->reentry_why, sizeof r->reentry_why, own.text);
        if (o->reentry == TC_REENTRY_CONVEXIFY)
            return tc_fail(err, status,
                           "the gaps of this mesh cannot be filled with imaginary cells: %s; use re-entry by "
                           "depth peeling",
                           own.text);
        tc_say(log, TC_INFO, "re-entry by depth peeling is used: %s", own.text);
    } else if (o->reentry != TC_REENTRY_PEEL) {
        r->reentry = TC_REENTRY_CONVEXIFY;
    }
    m->asked = o->reentry;
    return TC_OK;
}

/* Is a prepared mesh's way over gaps what is asked for now? Notes that it was asked for. */
static bool in_force(tc_mesh *m, tc_reentry asked)
{
    tc_reentry now = m->report.reentry;
    if (m->asked != asked && now != asked && !(asked == TC_REENTRY_AUTO && now == TC_REENTRY_CONVEXIFY))
        return false;
    if (now == asked)
        m->report.reentry_why[0] = 0; /* what was a way out is now the way asked for */
    m->asked = asked;
    return true;
}

tc_status tc_mesh_prepare(tc_mesh *mesh, const tc_prepare_options *options, const tc_log *log, tc_error *err)
{
    if (!mesh)
        return tc_fail(err, TC_E_ARG, "tc_mesh_prepare: mesh is NULL");
    tc_prepare_options none = {0};
    const tc_prepare_options *o = options ? options : &none;
    if ((int)o->reentry < TC_REENTRY_AUTO || (int)o->reentry > TC_REENTRY_PEEL)
        return tc_fail(err, TC_E_ARG, "tc_mesh_prepare: there is no reentry %d", (int)o->reentry);
    bool again = o->reentry == TC_REENTRY_AUTO && o->once_pixels > 0 && o->once_pixels == mesh->once_peeled;
    if (mesh->prepared && (again || in_force(mesh, o->reentry)))
        return TC_OK;
    if (!mesh->prepared) {
        tc_status status = tc_room_check(memory_of(mesh), err, "preparing and rendering %zu tetrahedra", mesh->n_tet);
        if (status != TC_OK)
            return status;
        status = prepare_first(mesh, o, log, err);
        if (status != TC_OK)
            return status;
    }
    return fill_gaps(mesh, o, log, err);
}
