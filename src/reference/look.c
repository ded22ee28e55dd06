/* look.c: makes a look ready for rays: which cells are seen, gradients, isosurfaces in order, triangles. */
#include "reference/look.h"

#include "core/memory.h"
#include "core/vec.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool lights(const tc_look *look)
{
    return look->shade.gradient != TC_GRADIENT_NONE && (look->shade.volume || look->shade.surfaces);
}

/* Nothing but the density emitter? */
static bool plain(const tc_look *look)
{
    return !look ||
           (look->model == TC_MODEL_DENSITY_EMITTER && look->n_iso == 0 && !lights(look) && !look->color_field &&
            look->n_plane == 0 && !look->has_box && look->n_select == 0 && look->n_geometry == 0);
}

static bool fits(const tc_field *field, const tc_mesh *mesh)
{
    return field->n == (field->association == TC_CELL_DATA ? mesh->n_tet : mesh->n_vertex);
}

static tc_status check(const tc_look *look, const tc_mesh *mesh, tc_error *err)
{
    static const char *const other = "has not as many values as the mesh has now; make the field anew from this mesh";
    if (look->color_field && !fits(look->color_field, mesh))
        return tc_fail(err, TC_E_ARG, "the field to colour by %s", other);
    if (look->color_field && (!look->color_function || look->color_function->n == 0))
        return tc_fail(err, TC_E_ARG, "a field to colour by was given without a function of its colours; give both");
    for (int k = 0; k < look->n_select; k++)
        if (look->select[k].field && !fits(look->select[k].field, mesh))
            return tc_fail(err, TC_E_ARG, "the field to select cells by %s", other);
    if (look->n_iso > 0 && mesh->association == TC_CELL_DATA)
        return tc_fail(err, TC_E_ARG, "isosurfaces of values of cells do not exist; convert them to values of points");
    return TC_OK;
}

static double width_of(const double *value, size_t n)
{
    double lo = INFINITY, hi = -INFINITY;
    for (size_t i = 0; value && i < n; i++)
        if (isfinite(value[i]))
            lo = fmin(lo, value[i]), hi = fmax(hi, value[i]);
    return lo < hi ? hi - lo : 0;
}

/* Of values at vertices: points that fill gaps have none. */
static size_t count_of(tc_association association, const tc_mesh *mesh)
{
    return association == TC_CELL_DATA ? mesh->n_tet : mesh->n_vertex - mesh->report.n_steiner;
}

/* Do the values of a tet all lie in one of the ranges? */
static bool selects(const tc_select *select, const tc_mesh *mesh, size_t tet)
{
    const double *value = select->field ? select->field->value : mesh->scalar;
    tc_association association = select->field ? select->field->association : mesh->association;
    bool cell = association == TC_CELL_DATA;
    for (int k = 0; k < select->n_range; k++) {
        bool inside = true;
        for (int i = 0; i < (cell ? 1 : 4); i++) {
            double s = !value ? 0 : cell ? value[tet] : value[mesh->tet[4 * tet + (size_t)i]];
            inside = inside && isfinite(s) && s >= select->range[k][0] && s <= select->range[k][1];
        }
        if (inside)
            return true;
    }
    return false;
}

static int iso_compare(const void *a, const void *b)
{
    double x = ((const tc_iso *)a)->value, y = ((const tc_iso *)b)->value;
    return (x > y) - (x < y);
}

static void finish(tc_look_ready *ready)
{
    free(ready->iso);
    free(ready->kept);
    free(ready->gradient);
    tc_shapes_finish(&ready->shapes);
    free(ready);
}

static tc_status make_gradient(tc_look_ready *ready, const tc_reference *reference)
{
    const tc_mesh *mesh = reference->mesh;
    double *cell = tc_alloc(mesh->n_tet, 3 * sizeof *cell);
    tc_status status = cell ? tc_gradient_of_cells(cell, reference) : TC_E_MEMORY;
    ready->smooth = ready->look->shade.gradient == TC_GRADIENT_VERTEX;
    ready->gradient = cell;
    if (status != TC_OK || !ready->smooth)
        return status;
    ready->gradient = tc_alloc(mesh->n_vertex, 3 * sizeof *cell);
    status = ready->gradient ? tc_gradient_of_vertices(ready->gradient, cell, reference) : TC_E_MEMORY;
    free(cell);
    return status;
}

static tc_status make(tc_look_ready *ready, const tc_reference *reference, tc_error *err)
{
    const tc_look *look = ready->look;
    const tc_mesh *mesh = reference->mesh;
    tc_status status = TC_OK;
    ready->range = width_of(mesh->scalar, count_of(mesh->association, mesh));
    if (look->color_field)
        ready->color_range = width_of(look->color_field->value, count_of(look->color_field->association, mesh));
    ready->diagonal = 2 * reference->half_diagonal;
    if (look->n_iso > 0) {
        ready->iso = tc_alloc((size_t)look->n_iso, sizeof *ready->iso);
        if (!ready->iso)
            return tc_fail_memory(err, "isosurfaces", (size_t)look->n_iso, sizeof *ready->iso);
        memcpy(ready->iso, look->iso, (size_t)look->n_iso * sizeof *ready->iso);
        qsort(ready->iso, (size_t)look->n_iso, sizeof *ready->iso, iso_compare);
    }
    if (look->n_select > 0) {
        ready->kept = tc_alloc(mesh->n_tet, sizeof *ready->kept);
        if (!ready->kept)
            return tc_fail_memory(err, "the selection of cells", mesh->n_tet, sizeof *ready->kept);
        for (size_t tet = 0; tet < mesh->n_tet; tet++) {
            ready->kept[tet] = 1;
            for (int k = 0; k < look->n_select; k++)
                ready->kept[tet] = ready->kept[tet] && selects(&look->select[k], mesh, tet);
        }
    }
    if (lights(look))
        status = make_gradient(ready, reference);
    if (status != TC_OK)
        return tc_fail_memory(err, "gradients of the reference caster", mesh->n_tet, 80);
    return tc_shapes_build(&ready->shapes, look->geometry, look->n_geometry, reference, err);
}

tc_status tc_reference_set_look(tc_reference *reference, const tc_look *look, tc_error *err)
{
    if (reference->look)
        finish(reference->look);
    reference->look = NULL;
    if (plain(look))
        return TC_OK;
    tc_status status = check(look, reference->mesh, err);
    if (status != TC_OK)
        return status;
    tc_look_ready *ready = tc_calloc(1, sizeof *ready);
    if (!ready)
        return tc_fail_memory(err, "the look of the reference caster", 1, sizeof *ready);
    ready->look = look;
    status = make(ready, reference, err);
    if (status == TC_OK)
        reference->look = ready;
    else
        finish(ready);
    return status;
}

/* Keeps the part of the line with normal . x >= offset, x in the mesh's frame. */
static void cut_plane(tc_line *line, const tc_reference *r, const double normal[3], double offset)
{
    double away = r->scale * (offset - tc_vec_dot(normal, r->center)) - tc_vec_dot(normal, line->base);
    double rise = tc_vec_dot(normal, line->d); /* the part: rise * t >= away */
    if (rise > 0)
        line->t_min = fmax(line->t_min, away / rise);
    else if (rise < 0)
        line->t_max = fmin(line->t_max, away / rise);
    else if (away > 0)
        line->t_max = -INFINITY;
}

void tc_look_cut(tc_line *line, const tc_reference *reference)
{
    const tc_look *look = reference->look->look;
    for (int k = 0; k < look->n_plane; k++)
        cut_plane(line, reference, look->plane[k].normal, look->plane[k].offset);
    for (int k = 0; look->has_box && k < 6; k++) {
        const double sign = k % 2 ? -1 : 1;
        double normal[3] = {0, 0, 0};
        normal[k / 2] = sign;
        cut_plane(line, reference, normal, sign * look->box[k]);
    }
}

void tc_look_depth(double rgba[4], const tc_reference *reference, const tc_rays *rays, const double origin[3],
                   const double direction[3])
{
    double from_eye[3];
    if (!reference->look || reference->look->look->model != TC_MODEL_DEPTH || rgba[3] == 0)
        return;
    tc_vec_sub(from_eye, origin, rays->eye);
    rgba[0] = tc_vec_dot(from_eye, rays->axis) + rgba[0] * tc_vec_dot(direction, rays->axis);
    for (int i = 0; i < 2; i++)
        rgba[i] = fmin(fmax(rgba[i], -FLT_MAX), FLT_MAX);
}
