/* field.c: values on a mesh beside its scalar, brought into the order that preparing gave it. */
#include "mesh/field.h"

#include "core/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of points that were merged the first one's value: the last one written. */
static void scatter_points(double *value, const double *from, const tc_mesh *m)
{
    for (size_t s = m->n_vertex_source; s-- > 0;) {
        const int32_t v = m->vertex_of_source ? m->vertex_of_source[s] : (int32_t)s;
        if (v >= 0)
            value[v] = from[s];
    }
}

/* Of what is finite, of points without the Steiner points, whose 0 is nobody's value. */
static void measure(tc_field *f, const tc_mesh *m)
{
    const size_t n = f->association == TC_CELL_DATA ? m->n_tet : m->n_vertex - m->report.n_steiner;
    double lo = INFINITY, hi = -INFINITY;
    f->finite = true;
    for (size_t i = 0; i < n; i++) {
        const double x = f->value[i];
        if (!isfinite(x)) {
            f->finite = false;
            continue;
        }
        lo = x < lo ? x : lo;
        hi = x > hi ? x : hi;
    }
    f->range[0] = lo <= hi ? lo : 0;
    f->range[1] = lo <= hi ? hi : 0;
}

tc_status tc_field_create(tc_field **out, const tc_mesh *mesh, const double *value, tc_association association,
                          const char *name, tc_error *err)
{
    if (!out || !mesh || !value)
        return tc_fail(err, TC_E_ARG, "tc_field_create: %s is NULL", !out ? "out" : mesh ? "value" : "mesh");
    *out = NULL;
    if (!mesh->prepared)
        return tc_fail(err, TC_E_ARG, "a field is of a mesh in its order: call tc_mesh_prepare before tc_field_create");
    if (association != TC_POINT_DATA && association != TC_CELL_DATA)
        return tc_fail(err, TC_E_ARG, "tc_field_create: association %d is neither TC_POINT_DATA nor TC_CELL_DATA",
                       (int)association);
    const size_t n = association == TC_CELL_DATA ? mesh->n_tet : mesh->n_vertex;
    tc_field *f = tc_calloc(1, sizeof *f);
    double *copy = tc_calloc(n, sizeof *copy);
    char *label = tc_strdup(name);
    if (!f || !copy || (name && !label)) {
        free(f);
        free(copy);
        free(label);
        return tc_fail_memory(err, "a field", n, sizeof *copy);
    }
    *f = (tc_field){.mesh_serial = mesh->serial,
                    .serial = tc_mesh_new_serial(),
                    .association = association,
                    .n = n,
                    .value = copy,
                    .name = label};
    if (association == TC_POINT_DATA) {
        scatter_points(copy, value, mesh);
    } else {
        tc_mesh_scatter_cells(copy, mesh, value);
    }
    measure(f, mesh);
    *out = f;
    return TC_OK;
}

void tc_field_destroy(tc_field **field)
{
    if (!field || !*field)
        return;
    free((*field)->value);
    free((*field)->name);
    free(*field);
    *field = NULL;
}

void tc_field_info(double range[2], tc_association *association, const char **name, const tc_field *field)
{
    if (range)
        memcpy(range, field->range, sizeof field->range);
    if (association)
        *association = field->association;
    if (name)
        *name = field->name;
}
