/* meshes.c: a mesh of the catalogue, its variants, and what was done to it. */
#include "meshes.h"

#include "core/vec.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *const hard_kind_name[HARD_KINDS] = {"plain",      "permuted",  "refined 1:4", "refined 1:8", "turned",
                                                "size 1e-20", "size 1e20", "offset 1e7",  "other gaps"};

static tc_status give_judges(hard_mesh *m, tc_error *err)
{
    tc_mesh_get_report(&m->report, m->mesh);
    const double *b = m->report.bounds;
    const double d[3] = {b[1] - b[0], b[3] - b[2], b[5] - b[4]};
    m->diagonal = tc_vec_length(d) > 0 ? tc_vec_length(d) : 1;
    tc_status status = hard_judge_create(&m->judge, m->mesh, err);
    if (status == TC_OK)
        status = tc_reference_create(&m->reference, m->mesh, 0, err);
    return status;
}

/* The library's no: kept, and no error of ours. */
static tc_status keep_refusal(hard_mesh *m, tc_status status, const tc_error *why, tc_error *err)
{
    if (status == TC_E_MEMORY)
        return tc_fail(err, status, "%s: %s", m->name, why->text);
    m->refused = *why;
    tc_mesh_destroy(&m->mesh);
    return TC_OK;
}

static tc_status make(hard_mesh *m, tc_reentry reentry, tc_error *err)
{
    const tc_prepare_options options = {.reentry = reentry, .convexify_limit_s = 20};
    tc_error why = {0};
    tc_status status = tc_mesh_create(&m->mesh, &m->source.arrays, &why);
    if (status == TC_OK)
        status = tc_mesh_prepare(m->mesh, &options, NULL, &why);
    return status == TC_OK ? give_judges(m, err) : keep_refusal(m, status, &why, err);
}

tc_status hard_mesh_open(hard_mesh *out, const char *name, size_t n_cells, uint64_t seed, tc_error *err)
{
    static const double here[3] = {0, 0, 0};
    memset(out, 0, sizeof *out);
    snprintf(out->name, sizeof out->name, "%s", name);
    out->n_cells = n_cells;
    out->generator = tc_synth_find(name);
    out->scale = 1;
    out->turn[0] = out->turn[4] = out->turn[8] = 1;
    if (!out->generator)
        return tc_fail(err, TC_E_ARG, "there is no synthetic mesh '%s'", name);
    tc_mesh *made = NULL;
    tc_error why = {0};
    tc_status status = tc_synth_create(&made, name, n_cells, seed, &why);
    if (status != TC_OK)
        return keep_refusal(out, status, &why, err);
    const tc_mesh_arrays arrays = {made->n_vertex, made->vertex,      made->n_tet, made->tet,
                                   made->scalar,   made->association, "field"};
    status = variant_move(&out->source, &arrays, NULL, 1, here, err);
    tc_mesh_destroy(&made);
    if (status == TC_OK)
        status = make(out, TC_REENTRY_AUTO, err);
    if (status == TC_OK && out->mesh)
        out->unit = tc_default_unit_distance(out->mesh);
    return status;
}

/* A turn by one radian about (1, 2, 3), after Rodrigues. */
static void turn_matrix(double *m)
{
    double axis[3] = {1, 2, 3}, c = cos(1), s = sin(1);
    tc_vec_normalize(axis);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            m[3 * i + k] = (1 - c) * axis[i] * axis[k] + (i == k ? c : 0);
    for (int i = 0; i < 3; i++) {
        int k = (i + 1) % 3, l = (i + 2) % 3;
        m[3 * k + l] -= s * axis[i];
        m[3 * l + k] += s * axis[i];
    }
}

tc_status hard_mesh_vary(hard_mesh *out, const hard_mesh *base, hard_kind kind, tc_error *err)
{
    memset(out, 0, sizeof *out);
    snprintf(out->name, sizeof out->name, "%.40s, %s", base->name, hard_kind_name[kind]);
    out->generator = base->generator;
    out->n_cells = base->n_cells;
    out->kind = kind;
    memcpy(out->turn, base->turn, sizeof out->turn);
    out->scale = kind == HARD_SMALL ? 1e-20 : kind == HARD_LARGE ? 1e20 : 1;
    if (kind == HARD_TURNED)
        turn_matrix(out->turn);
    for (int k = 0; k < 3 && kind == HARD_OFFSET; k++)
        out->offset[k] = 1e7 * base->diagonal * (k == 1 ? -1 : 1);
    const tc_mesh_arrays *from = &base->source.arrays;
    tc_status status =
        kind == HARD_PERMUTED   ? variant_permute(&out->source, from, 7, err)
        : kind == HARD_REFINED4 ? variant_refine4(&out->source, from, err)
        : kind == HARD_REFINED8
            ? variant_refine8(&out->source, from, err)
            : variant_move(&out->source, from, kind == HARD_TURNED ? out->turn : NULL, out->scale, out->offset, err);
    tc_reentry reentry = kind == HARD_OTHER_GAPS ? TC_REENTRY_PEEL : TC_REENTRY_AUTO;
    if (kind == HARD_OTHER_GAPS && base->report.reentry == TC_REENTRY_PEEL)
        return status;
    if (status == TC_OK)
        status = make(out, reentry, err);
    out->unit = base->unit * out->scale;
    return status;
}

void hard_mesh_close(hard_mesh *m)
{
    hard_judge_destroy(&m->judge);
    tc_reference_destroy(&m->reference);
    tc_mesh_destroy(&m->mesh);
    variant_finish(&m->source);
    m->kind = HARD_PLAIN;
}

tc_camera hard_mesh_camera(const hard_mesh *m, const tc_camera *base)
{
    tc_camera c = *base;
    double *point[2] = {c.position, c.focal_point}, up[3];
    for (int p = 0; p < 2; p++) {
        double from[3];
        tc_vec_copy(from, point[p]);
        for (int k = 0; k < 3; k++)
            point[p][k] = m->offset[k] + m->scale * tc_vec_dot(m->turn + 3 * k, from);
    }
    for (int k = 0; k < 3; k++)
        up[k] = tc_vec_dot(m->turn + 3 * k, base->view_up);
    tc_vec_copy(c.view_up, up);
    c.parallel_scale *= m->scale;
    c.clip_near *= m->scale;
    c.clip_far *= m->scale;
    return c;
}

static void add(char *out, size_t capacity, const char *format, ...) __attribute__((format(printf, 3, 4)));
static void add(char *out, size_t capacity, const char *format, ...)
{
    size_t used = strlen(out);
    va_list arguments;
    va_start(arguments, format);
    if (used > 0 && used + 2 < capacity)
        used += (size_t)snprintf(out + used, capacity - used, ", ");
    vsnprintf(out + used, capacity - used, format, arguments);
    va_end(arguments);
}

void hard_mesh_treatment(char *out, size_t capacity, const hard_mesh *m)
{
    const tc_mesh_report *r = &m->report;
    out[0] = 0;
    if (!m->mesh) {
        snprintf(out, capacity, "refused: %s", m->refused.text);
        return;
    }
    const struct {
        size_t n;
        const char *what;
    } done[] = {{r->dropped_degenerate, "degenerate dropped"},
                {r->dropped_nonfinite, "non-finite dropped"},
                {r->dropped_duplicate, "duplicates dropped"},
                {r->reoriented, "turned"},
                {r->zero_volume, "flat kept"},
                {r->merged_vertices, "points merged"},
                {r->unused_vertices, "unused points"},
                {r->unlinked_faces, "faces unlinked"},
                {r->nonfinite_scalars, "values not finite"}};
    for (size_t i = 0; i < sizeof done / sizeof *done; i++)
        if (done[i].n)
            add(out, capacity, "%zu %s", done[i].n, done[i].what);
    if (r->n_imaginary)
        add(out, capacity, "%zu imaginary", r->n_imaginary);
    else if (!r->convex)
        add(out, capacity, "peeled");
}

void hard_mesh_missing(char *out, size_t capacity, const hard_mesh *m)
{
    const tc_mesh_report *r = &m->report;
    unsigned d = m->generator->defects;
    out[0] = 0;
    if (d & (TC_SYNTH_NO_CELLS | TC_SYNTH_BAD_INDEX)) {
        if (m->mesh)
            add(out, capacity, "is not refused");
        return;
    }
    if (!m->mesh) {
        add(out, capacity, "is refused");
        return;
    }
    const struct {
        unsigned defect;
        size_t n;
        const char *what;
    } rows[] = {{TC_SYNTH_DEGENERATE, r->dropped_degenerate, "degenerate cells"},
                {TC_SYNTH_NONFINITE_POINTS, r->dropped_nonfinite, "non-finite points"},
                {TC_SYNTH_DUPLICATE_CELLS, r->dropped_duplicate, "duplicate cells"},
                {TC_SYNTH_INVERTED, r->reoriented, "inverted cells"},
                {TC_SYNTH_FLAT, r->zero_volume, "flat cells"},
                {TC_SYNTH_DUPLICATE_POINTS, r->merged_vertices, "duplicate points"},
                {TC_SYNTH_UNUSED_POINTS, r->unused_vertices, "unused points"},
                {TC_SYNTH_SHARED_FACES, r->unlinked_faces, "faces of too many cells"},
                {TC_SYNTH_NONFINITE_VALUES, r->nonfinite_scalars, "non-finite values"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if ((d & rows[i].defect) && rows[i].n == 0)
            add(out, capacity, "no %s were found", rows[i].what);
}
