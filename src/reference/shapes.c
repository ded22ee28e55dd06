/* shapes.c: triangles of geometry in a hierarchy of their own: they may lie anywhere, the mesh's does not reach there.
 */
#include "reference/shapes.h"

#include "core/memory.h"
#include "core/vec.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Boxes are widened by this part of what rounding to float and the judge's moves of vertices may take: see
 * tc_line.rounding. */
static const double PAD = 4e-6;

static tc_status copy_vertices(double **out, const tc_geometry *geometry, int number, const tc_reference *r,
                               tc_error *err)
{
    double *x = *out = tc_alloc(geometry->n_vertex, 3 * sizeof *x);
    if (!x)
        return tc_fail_memory(err, "the geometry of the reference caster", geometry->n_vertex, 3 * sizeof *x);
    for (size_t i = 0; i < geometry->n_vertex; i++)
        for (int a = 0; a < 3; a++) {
            x[3 * i + (size_t)a] = (geometry->vertex[3 * i + (size_t)a] - r->center[a]) * r->scale;
            if (!isfinite(x[3 * i + (size_t)a]))
                return tc_fail(err, TC_E_ARG, "vertex %zu of geometry %d is not finite; leave it out", i, number);
        }
    return TC_OK;
}

static void order_two(int32_t *a, int32_t *b)
{
    if (*a > *b) {
        int32_t t = *a;
        *a = *b, *b = t;
    }
}

static tc_status take_triangles(tc_shapes *out, const tc_geometry *geometry, int number, tc_error *err)
{
    for (size_t i = 0; i < geometry->n_triangle; i++) {
        tc_shape *at = &out->triangle[out->n];
        at->geometry = (uint32_t)number;
        memcpy(at->id, &geometry->triangle[3 * i], sizeof at->id);
        for (int k = 0; k < 3; k++)
            if (at->id[k] < 0 || (size_t)at->id[k] >= geometry->n_vertex)
                return tc_fail(err, TC_E_ARG, "triangle %zu of geometry %d has vertex %d of %zu; count them from 0", i,
                               number, (int)at->id[k], geometry->n_vertex);
        order_two(&at->id[0], &at->id[1]), order_two(&at->id[1], &at->id[2]), order_two(&at->id[0], &at->id[1]);
        out->n += at->id[0] != at->id[1] && at->id[1] != at->id[2];
    }
    return TC_OK;
}

static tc_bvh_box box_of(const tc_shapes *s, const tc_shape *triangle)
{
    tc_bvh_box box;
    for (int a = 0; a < 3; a++) {
        double lo = DBL_MAX, hi = -DBL_MAX;
        for (int k = 0; k < 3; k++) {
            double x = s->vertex[triangle->geometry][3 * (size_t)triangle->id[k] + (size_t)a];
            lo = fmin(lo, x), hi = fmax(hi, x);
        }
        box.lo[a] = (float)fmax(lo - PAD * (1 + fabs(lo)), -FLT_MAX);
        box.hi[a] = (float)fmin(hi + PAD * (1 + fabs(hi)), FLT_MAX);
    }
    return box;
}

tc_status tc_shapes_build(tc_shapes *out, const tc_geometry *geometry, int n_geometry, const tc_reference *reference,
                          tc_error *err)
{
    memset(out, 0, sizeof *out);
    size_t all = 0;
    for (int g = 0; g < n_geometry; g++)
        all += geometry[g].n_triangle;
    if (all == 0)
        return TC_OK;
    out->n_geometry = n_geometry;
    out->vertex = tc_calloc((size_t)n_geometry, sizeof *out->vertex);
    out->triangle = tc_alloc(all, sizeof *out->triangle);
    tc_bvh_box *box = tc_alloc(all, sizeof *box);
    tc_status status = TC_OK;
    if (!out->vertex || !out->triangle || !box)
        status = tc_fail_memory(err, "the geometry of the reference caster", all, sizeof *box + sizeof *out->triangle);
    for (int g = 0; g < n_geometry && status == TC_OK; g++) {
        status = copy_vertices(&out->vertex[g], &geometry[g], g, reference, err);
        if (status == TC_OK)
            status = take_triangles(out, &geometry[g], g, err);
    }
    if (status == TC_OK) {
        for (size_t i = 0; i < out->n; i++)
            box[i] = box_of(out, &out->triangle[i]);
        status = tc_bvh_build(&out->bvh, box, out->n, 1, err);
    }
    free(box);
    if (status != TC_OK)
        tc_shapes_finish(out);
    return status;
}

void tc_shapes_finish(tc_shapes *shapes)
{
    for (int g = 0; shapes->vertex && g < shapes->n_geometry; g++)
        free(shapes->vertex[g]);
    free(shapes->vertex);
    free(shapes->triangle);
    tc_bvh_finish(&shapes->bvh);
    memset(shapes, 0, sizeof *shapes);
}

/* Does the line, without end, come by the box? */
static bool touches(const tc_line *line, const tc_bvh_box *box)
{
    double t0 = -INFINITY, t1 = INFINITY;
    for (int a = 0; a < 3; a++) {
        double d = fabs(line->d[a]) < 1e-30 ? copysign(1e-30, line->d[a]) : line->d[a];
        double low = ((double)box->lo[a] - line->base[a]) / d, high = ((double)box->hi[a] - line->base[a]) / d;
        t0 = fmax(t0, fmin(low, high)), t1 = fmin(t1, fmax(low, high));
    }
    return t0 <= t1;
}

static bool push(tc_scratch *scratch, size_t n, tc_meeting meeting)
{
    if (n == scratch->n_meeting) {
        size_t more = n ? 2 * n : 64;
        tc_meeting *larger = tc_realloc(scratch->meeting, more, sizeof *larger);
        if (!larger)
            return false;
        scratch->meeting = larger;
        scratch->n_meeting = more;
    }
    scratch->meeting[n] = meeting;
    return true;
}

static int compare(const void *a, const void *b)
{
    const tc_meeting *p = a, *q = b;
    if (p->t != q->t)
        return p->t < q->t ? -1 : 1;
    return p->shape < q->shape ? -1 : p->shape > q->shape;
}

bool tc_shapes_meet(size_t *n, tc_scratch *scratch, const tc_shapes *shapes, const tc_line *line)
{
    *n = 0;
    if (shapes->bvh.n_node == 0)
        return true;
    uint32_t stack[TC_BVH_STACK];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
        const tc_bvh_node *at = &shapes->bvh.node[stack[--top]];
        if (!touches(line, &at->box))
            continue;
        if (at->count == 0) {
            stack[top++] = at->first;
            stack[top++] = at->first + 1;
        }
        for (uint32_t i = 0; i < at->count; i++) {
            tc_meeting meeting = {.shape = shapes->bvh.order[at->first + i]};
            const tc_shape *triangle = &shapes->triangle[meeting.shape];
            if (tc_line_triangle(&meeting.t, line, shapes->vertex[triangle->geometry], triangle->id,
                                 triangle->geometry + 1) &&
                meeting.t >= line->t_min && meeting.t <= line->t_max && !push(scratch, (*n)++, meeting))
                return false;
        }
    }
    if (*n > 1)
        qsort(scratch->meeting, *n, sizeof *scratch->meeting, compare);
    return true;
}

bool tc_shapes_normal(double out[3], const tc_shapes *shapes, uint32_t shape)
{
    const tc_shape *triangle = &shapes->triangle[shape];
    const double *x = shapes->vertex[triangle->geometry];
    double a[3], b[3];
    tc_vec_sub(a, x + 3 * (size_t)triangle->id[1], x + 3 * (size_t)triangle->id[0]);
    tc_vec_sub(b, x + 3 * (size_t)triangle->id[2], x + 3 * (size_t)triangle->id[0]);
    tc_vec_cross(out, a, b);
    return tc_vec_normalize(out) > 0;
}
