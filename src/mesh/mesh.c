/* mesh.c: a tetrahedral mesh from arrays, its values and its report. */
#include "mesh/mesh.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/worker.h"
#include "mesh/repair.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Faces are numbered 4 * tet + face in 32 bits, imaginary tets included. */
static const size_t MAX_TETS = (size_t)1 << 29;

uint64_t tc_mesh_new_serial(void)
{
    static atomic_ullong next = 1; /* the one static: renderers tell meshes apart by it */
    return atomic_fetch_add(&next, 1);
}

static tc_status check_arrays(const tc_mesh_arrays *a, tc_error *err)
{
    if ((a->n_vertex && !a->vertex) || (a->n_tet && !a->tet))
        return tc_fail(err, TC_E_ARG, "tc_mesh_create: %s is NULL", a->n_vertex && !a->vertex ? "vertex" : "tet");
    if (a->n_vertex > INT32_MAX)
        return tc_fail(err, TC_E_ARG, "%zu vertices are more than the %d that ids of 32 bits can name", a->n_vertex,
                       INT32_MAX);
    if (a->n_tet > MAX_TETS)
        return tc_fail(err, TC_E_ARG, "%zu tetrahedra are more than the %zu this library takes; split the mesh",
                       a->n_tet, MAX_TETS);
    if (a->association != TC_POINT_DATA && a->association != TC_CELL_DATA &&
        (a->association != TC_ANY_DATA || a->scalar))
        return tc_fail(err, TC_E_ARG,
                       "tc_mesh_create: association %d of the scalars is neither TC_POINT_DATA nor TC_CELL_DATA",
                       (int)a->association);
    for (size_t i = 0; i < 4 * a->n_tet; i++)
        if (a->tet[i] < 0 || (size_t)a->tet[i] >= a->n_vertex)
            return tc_fail(err, TC_E_MESH, "tetrahedron %zu names vertex %d, but there are %zu vertices (0 to %lld)",
                           i / 4, (int)a->tet[i], a->n_vertex, (long long)a->n_vertex - 1);
    return TC_OK;
}

tc_status tc_mesh_create(tc_mesh **out, const tc_mesh_arrays *arrays, tc_error *err)
{
    if (!out || !arrays)
        return tc_fail(err, TC_E_ARG, "tc_mesh_create: %s is NULL", out ? "arrays" : "out");
    *out = NULL;
    tc_status status = check_arrays(arrays, err);
    if (status != TC_OK)
        return status;
    tc_mesh *m = tc_calloc(1, sizeof *m);
    if (!m)
        return tc_fail_memory(err, "a mesh", 1, sizeof *m);
    m->n_vertex = m->n_vertex_source = arrays->n_vertex;
    m->n_tet = m->n_tet_source = arrays->n_tet;
    m->association = arrays->association == TC_CELL_DATA ? TC_CELL_DATA : TC_POINT_DATA;
    size_t n_scalar = m->association == TC_CELL_DATA ? m->n_tet : m->n_vertex;
    m->vertex = tc_alloc(m->n_vertex, 3 * sizeof *m->vertex);
    m->tet = tc_alloc(m->n_tet, 4 * sizeof *m->tet);
    m->scalar = tc_calloc(n_scalar, sizeof *m->scalar);
    m->field_name = tc_strdup(arrays->field_name);
    if (!m->vertex || !m->tet || !m->scalar || (arrays->field_name && !m->field_name)) {
        tc_mesh_destroy(&m);
        return tc_fail_memory(err, "a mesh", arrays->n_vertex * 4 + arrays->n_tet * 2 + n_scalar, sizeof(double));
    }
    if (m->n_vertex)
        memcpy(m->vertex, arrays->vertex, m->n_vertex * 3 * sizeof *m->vertex);
    if (m->n_tet)
        memcpy(m->tet, arrays->tet, m->n_tet * 4 * sizeof *m->tet);
    if (arrays->scalar && n_scalar)
        memcpy(m->scalar, arrays->scalar, n_scalar * sizeof *m->scalar);
    m->serial = tc_mesh_new_serial();
    m->scalar_serial = tc_mesh_new_serial();
    m->report.n_vertex = m->n_vertex;
    m->report.n_tet = m->report.source_cells = m->n_tet;
    m->report.ms_check = m->report.ms_adjacency = m->report.ms_order = m->report.ms_convexify = NAN;
    status = tc_mesh_measure(m, 1, err);
    if (status != TC_OK) {
        tc_mesh_destroy(&m);
        return status;
    }
    tc_mesh_measure_scalar(m);
    *out = m;
    return TC_OK;
}

void tc_mesh_destroy(tc_mesh **mesh)
{
    if (!mesh || !*mesh)
        return;
    tc_mesh *m = *mesh;
    if (m->ahead)
        m->ahead_leave(m->ahead);
    tc_mesh_finish_arrays(m);
    free(m->field_name);
    free(m->source);
    free(m->source_memory);
    tc_worker_stop(&m->reader);
    free(m);
    *mesh = NULL;
}

void tc_mesh_get_report(tc_mesh_report *out, const tc_mesh *mesh)
{
    *out = mesh->report;
}

const tc_source *tc_mesh_source(const tc_mesh *mesh)
{
    return mesh->source;
}

static bool same_value(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* Values of the source's points in this mesh's order; points that were merged must still agree. */
static tc_status scatter_points(double *value, const tc_mesh *m, const double *scalar, tc_error *err)
{
    int32_t *writer = tc_alloc(m->n_vertex, sizeof *writer);
    if (!writer)
        return tc_fail_memory(err, "new values", m->n_vertex, sizeof *writer);
    memset(writer, 0xff, m->n_vertex * sizeof *writer);
    tc_status status = TC_OK;
    for (size_t s = 0; s < m->n_vertex_source && status == TC_OK; s++) {
        int32_t v = m->vertex_of_source ? m->vertex_of_source[s] : (int32_t)s;
        if (v < 0)
            continue;
        if (writer[v] < 0) {
            writer[v] = (int32_t)s;
            value[v] = scalar[s];
        } else if (!same_value(value[v], scalar[s])) {
            status =
                tc_fail(err, TC_E_MESH,
                        "points %d and %zu lie at one place and were merged, but the new values there differ (%g and "
                        "%g); create the mesh again with these values",
                        (int)writer[v], s, value[v], scalar[s]);
        }
    }
    free(writer);
    return status;
}

typedef struct scatter {
    double *value;
    const double *scalar;
    const int32_t *to; /* each but -1 once; NULL: as they are */
} scatter;

static void scatter_cells(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const scatter *j = context;
    for (size_t s = begin; s < end; s++) {
        int32_t t = j->to ? j->to[s] : (int32_t)s;
        if (t >= 0)
            j->value[t] = j->scalar[s];
    }
}

void tc_mesh_scatter_cells(double *out, const tc_mesh *mesh, const double *value)
{
    scatter j = {out, value, mesh->tet_of_source};
    tc_parallel_for(mesh->n_tet_source, 1 << 14, 0, scatter_cells, &j);
}

tc_status tc_mesh_set_scalar(tc_mesh *m, const double *scalar, tc_association association, tc_error *err)
{
    if (!m || !scalar)
        return tc_fail(err, TC_E_ARG, "tc_mesh_set_scalar: %s is NULL", m ? "scalar" : "mesh");
    if (association != TC_POINT_DATA && association != TC_CELL_DATA)
        return tc_fail(err, TC_E_ARG, "tc_mesh_set_scalar: association %d is neither TC_POINT_DATA nor TC_CELL_DATA",
                       (int)association);
    size_t n = association == TC_CELL_DATA ? m->n_tet : m->n_vertex;
    /* values of cells cannot be refused, so they may take the place of the old ones */
    bool in_place = association == TC_CELL_DATA && m->association == TC_CELL_DATA;
    double *value = in_place ? m->scalar : tc_calloc(n, sizeof *value);
    if (!value)
        return tc_fail_memory(err, "new values", n, sizeof *value);
    if (association == TC_POINT_DATA) {
        tc_status status = scatter_points(value, m, scalar, err);
        if (status != TC_OK) {
            free(value);
            return status;
        }
    } else {
        tc_mesh_scatter_cells(value, m, scalar);
    }
    if (!in_place)
        free(m->scalar);
    m->scalar = value;
    m->association = association;
    m->scalar_serial = tc_mesh_new_serial();
    tc_mesh_measure_scalar(m);
    return TC_OK;
}
