/* convexify.c: imaginary tets between a mesh and its convex hull (Williams 1992; Weiler et al. 2003, section 3.4). */
#include "mesh/convexify.h"

#include "core/memory.h"
#include "core/worker.h"
#include "mesh/adjacency.h"
#include "mesh/order.h"
#include "mesh/predicate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Dents of the outside that are let pass, in diagonals. TetGen takes points within 1e-8 of a plane as in it, so the
 * outside may be dented about that deep; coordinates in float, as the GPU has them, dent it by as much. */
static const double HULL_TOLERANCE = 1e-7;

/* TetGen works with absolute thresholds: it gets points of size near 1, near the origin where that costs no bit. */
typedef struct frame {
    double centre[3];
    int exponent; /* point = centre + 2^exponent * TetGen's */
} frame;

/* a - b without rounding? */
static bool exact_difference(double a, double b)
{
    double d = a - b, e = d - a;
    return (a - (d - e)) + (-b - e) == 0 && isfinite(d);
}

static frame frame_of(const double bounds[6], const double *vertex, size_t n)
{
    frame f = {{0, 0, 0}, 0};
    double extent = 0;
    for (int k = 0; k < 3; k++) {
        double e = 0.5 * bounds[2 * k + 1] - 0.5 * bounds[2 * k];
        extent = e > extent ? e : extent;
    }
    if (extent > 0)
        frexp(extent, &f.exponent);
    for (int k = 0; k < 3; k++) {
        double middle = 0.5 * bounds[2 * k] + 0.5 * bounds[2 * k + 1];
        if (fabs(middle) < 16 * extent)
            continue; /* near the origin already */
        double c = ldexp(nearbyint(ldexp(middle, -f.exponent)), f.exponent);
        bool exact = true;
        for (size_t v = 0; v < n && exact; v++)
            exact = exact_difference(vertex[3 * v + (size_t)k], c);
        f.centre[k] = exact ? c : 0;
    }
    return f;
}

/* What the helper gave back, with the arrays it was asked with. */
typedef struct filling {
    frame frame;
    double *sent; /* [n][3] */
    size_t n;     /* points of the boundary */
    tc_reply reply;
    const double *point; /* [n + n_steiner][3] in the frame */
    const int32_t *tet;  /* [n_tet][4] */
    size_t n_steiner, n_tet;
    double hull_volume; /* in the mesh's unit */
} filling;

static tc_status ask(filling *q, const tc_mesh *m, const tc_boundary *b, double limit_s, const tc_log *log,
                     tc_error *err)
{
    tc_status status;
    tc_worker *worker = NULL;
    json_t *request = NULL;
    q->n = b->n_vertex;
    q->frame = frame_of(m->report.bounds, m->vertex, m->n_vertex);
    q->sent = tc_alloc(q->n, 3 * sizeof *q->sent);
    if (!q->sent)
        return tc_fail_memory(err, "the boundary", q->n, 3 * sizeof *q->sent);
    for (size_t v = 0; v < q->n; v++)
        for (size_t k = 0; k < 3; k++)
            q->sent[3 * v + k] =
                ldexp(m->vertex[3 * (size_t)b->vertex[v] + k] - q->frame.centre[k], -q->frame.exponent);
    /* TetGen takes some 2 KiB a boundary face; beyond several times that it has gone astray */
    tc_worker_limits limits = {.total_s = limit_s > 0 ? limit_s : 120,
                               .memory_bytes = ((size_t)2 << 30) + (b->n_face << 14)};
    tc_array array[2] = {{"point", TC_F64, 3 * q->n, q->sent}, {"face", TC_I32, 3 * b->n_face, b->face}};
    status = tc_worker_start(&worker, "tetcast-convexify", &limits, err);
    if (status != TC_OK)
        goto done;
    request = json_pack("{s:s}", "do", "convexify");
    status = request ? tc_worker_call(&q->reply, worker, request, array, 2, log, err)
                     : tc_fail_memory(err, "a request", 1, 64);
    if (status == TC_E_FILE) { /* the helper's own sentence: it lives, but not with this boundary */
        status = TC_E_MESH;
        if (err)
            err->code = status;
    }
done:
    json_decref(request);
    tc_worker_stop(&worker);
    return status;
}

/* Points that TetGen added belong to its cells and lie within the bounds: others would only stretch the frame in which
 * the casters round coordinates. Rounding on the way from TetGen's frame may put them a little beyond. */
static tc_status judge_steiner(const filling *q, const double bounds[6], tc_error *err)
{
    if (q->n_steiner == 0)
        return TC_OK;
    uint8_t *used = tc_calloc(q->n_steiner, 1);
    if (!used)
        return tc_fail_memory(err, "the points that TetGen added", q->n_steiner, 1);
    for (size_t i = 0; i < 4 * q->n_tet; i++)
        if ((size_t)q->tet[i] >= q->n)
            used[(size_t)q->tet[i] - q->n] = 1;
    tc_status status = TC_OK;
    const double rounding = tc_boundary_rounding(bounds);
    for (size_t s = 0; s < q->n_steiner && status == TC_OK; s++) {
        const double *p = q->point + 3 * (q->n + s);
        if (!used[s])
            status = tc_fail(err, TC_E_MESH, "TetGen added a point that none of its tetrahedra has");
        for (int k = 0; k < 3 && status == TC_OK; k++) {
            double x = q->frame.centre[k] + ldexp(p[k], q->frame.exponent);
            if (!(x >= bounds[2 * k] - rounding && x <= bounds[2 * k + 1] + rounding))
                status = tc_fail(err, TC_E_MESH, "TetGen added a point outside the mesh's bounds");
        }
    }
    free(used);
    return status;
}

/* Is the reply well formed, and are the boundary's points as they were sent? */
static tc_status open_reply(filling *q, const double bounds[6], tc_error *err)
{
    const tc_array *point = tc_reply_array(&q->reply, "point", TC_F64);
    const tc_array *tet = tc_reply_array(&q->reply, "tet", TC_I32);
    if (!point || !tet || point->count % 3 != 0 || tet->count % 4 != 0 || point->count / 3 < q->n ||
        point->count / 3 > INT32_MAX)
        return tc_fail(err, TC_E_WORKER, "tetcast-convexify gave an answer without points and tetrahedra");
    q->point = point->data, q->n_steiner = point->count / 3 - q->n;
    q->tet = tet->data, q->n_tet = tet->count / 4;
    q->hull_volume = ldexp(json_number_value(json_object_get(q->reply.json, "hull_volume")), 3 * q->frame.exponent);
    if (memcmp(q->point, q->sent, q->n * 3 * sizeof *q->sent) != 0)
        return tc_fail(err, TC_E_MESH, "TetGen moved points of the boundary");
    for (size_t i = 3 * q->n; i < point->count; i++)
        if (!isfinite(q->point[i]))
            return tc_fail(err, TC_E_MESH, "TetGen added a point that is not finite");
    for (size_t t = 0; t < q->n_tet; t++) {
        const int32_t *v = q->tet + 4 * t;
        for (int i = 0; i < 4; i++) {
            if (v[i] < 0 || (size_t)v[i] >= q->n + q->n_steiner)
                return tc_fail(err, TC_E_MESH, "TetGen's tetrahedron %zu names point %d of %zu", t, (int)v[i],
                               q->n + q->n_steiner);
            for (int j = 0; j < i; j++)
                if (v[i] == v[j])
                    return tc_fail(err, TC_E_MESH, "TetGen's tetrahedron %zu repeats a point", t);
        }
    }
    return judge_steiner(q, bounds, err);
}

/* next: the mesh with the imaginary tets, its arrays new; not linked yet. *n_flat: zero-volume ones among them. */
static tc_status join(tc_mesh *next, size_t *n_flat, const tc_mesh *m, const filling *q, const tc_boundary *b,
                      int threads, tc_error *err)
{
    size_t nv = m->n_vertex + q->n_steiner, nt = m->n_tet + q->n_tet;
    bool point_data = m->association != TC_CELL_DATA;
    *n_flat = 0;
    if (nv > INT32_MAX || nt > (size_t)1 << 29)
        return tc_fail(err, TC_E_MESH, "with imaginary cells the mesh has %zu tetrahedra, too many for 32-bit ids", nt);
    *next = *m;
    next->n_vertex = nv, next->n_imaginary = q->n_tet;
    next->vertex = tc_alloc(nv, 3 * sizeof *next->vertex);
    next->scalar = tc_calloc(point_data ? nv : m->n_tet, sizeof *next->scalar);
    next->tet = tc_alloc(nt, 4 * sizeof *next->tet);
    next->neighbour = tc_alloc(nt, 4 * sizeof *next->neighbour);
    if (!next->vertex || !next->scalar || !next->tet || !next->neighbour)
        return tc_fail_memory(err, "imaginary cells", nt + nv, 32);
    memcpy(next->vertex, m->vertex, m->n_vertex * 3 * sizeof *m->vertex);
    memcpy(next->scalar, m->scalar, (point_data ? m->n_vertex : m->n_tet) * sizeof *m->scalar);
    memcpy(next->tet, m->tet, m->n_tet * 4 * sizeof *m->tet);
    memcpy(next->neighbour, m->neighbour, m->n_tet * 4 * sizeof *m->neighbour);
    for (size_t s = 0; s < q->n_steiner; s++)
        for (size_t k = 0; k < 3; k++)
            next->vertex[3 * (m->n_vertex + s) + k] =
                q->frame.centre[k] + ldexp(q->point[3 * (q->n + s) + k], q->frame.exponent);
    int32_t *tet = next->tet + 4 * m->n_tet;
    for (size_t i = 0; i < 4 * q->n_tet; i++)
        tet[i] = (size_t)q->tet[i] < q->n ? b->vertex[q->tet[i]] : (int32_t)(m->n_vertex + ((size_t)q->tet[i] - q->n));
    for (size_t i = 0; i < 4 * q->n_tet; i++)
        next->neighbour[4 * m->n_tet + i] = -1;
    tc_status status = tc_tets_order(tet, q->n_tet, next->vertex, m->report.bounds, threads, err);
    for (size_t t = 0; t < q->n_tet && status == TC_OK; t++) {
        int32_t *v = tet + 4 * t;
        const double *x = next->vertex;
        int sign = tc_orient3d(x + 3 * (size_t)v[0], x + 3 * (size_t)v[1], x + 3 * (size_t)v[2], x + 3 * (size_t)v[3]);
        if (sign < 0)
            return tc_fail(err, TC_E_MESH, "TetGen made a tetrahedron of negative volume");
        *n_flat += sign == 0;
    }
    return status;
}

static double volume_of(const tc_mesh *m, size_t begin, size_t end)
{
    double sum = 0;
    for (size_t t = begin; t < end; t++) {
        const int32_t *v = m->tet + 4 * t;
        const double *a = m->vertex + 3 * (size_t)v[0];
        double u[3][3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                u[i][k] = m->vertex[3 * (size_t)v[i + 1] + (size_t)k] - a[k];
        sum += (u[0][1] * u[1][2] - u[0][2] * u[1][1]) * u[2][0] + (u[0][2] * u[1][0] - u[0][0] * u[1][2]) * u[2][1] +
               (u[0][0] * u[1][1] - u[0][1] * u[1][0]) * u[2][2];
    }
    return sum / 6;
}

/* Links the imaginary tets and judges the whole. No cell has negative volume, every face but the outside's joins two
 * cells on opposite sides, and the outside is one closed convex surface that goes around its middle once: then every
 * point within it lies in one cell. (Passing through a face neither gains nor loses a cell, so all points that the
 * outside does not separate lie in as many cells as it goes around them: 1 within, 0 beyond.) Overlaps, cells in real
 * material and gaps cannot pass; the sum of volumes says the same about TetGen's own hull. */
static tc_status link_and_judge(tc_mesh *next, size_t n_flat, const filling *q, int threads, tc_error *err)
{
    tc_adjacency_result found;
    tc_adjacency_input in = {.vertex = next->vertex,
                             .n_vertex = next->n_vertex,
                             .tet = next->tet,
                             .n_tet = next->n_tet + next->n_imaginary,
                             .first = next->n_tet,
                             .n_zero_volume = n_flat,
                             .threads = threads};
    tc_status status = tc_adjacency_build(next->neighbour, NULL, &found, &in, err);
    if (status != TC_OK)
        return status;
    if (found.duplicates + found.many + found.one_side > 0)
        return tc_fail(
            err, TC_E_MESH,
            "TetGen's cells do not fit: %zu are double, %zu faces have three cells or more, %zu two on one side",
            found.duplicates, found.many, found.one_side);
    tc_boundary outside;
    status = tc_boundary_build(&outside, next, next->n_tet + next->n_imaginary, err);
    if (status != TC_OK)
        return status;
    const double *o = next->report.bounds;
    double diagonal = hypot(hypot(o[1] - o[0], o[3] - o[2]), o[5] - o[4]);
    double tolerance = HULL_TOLERANCE * diagonal + tc_boundary_rounding(o);
    if (!tc_boundary_is_convex(&outside, next->vertex, tolerance))
        status =
            tc_fail(err, TC_E_MESH, "TetGen's cells do not fill the convex hull (%zu of its edges are open, %zu parts)",
                    outside.n_odd_edge, outside.n_component);
    tc_boundary_finish(&outside);
    double real = next->report.volume, imaginary = volume_of(next, next->n_tet, next->n_tet + next->n_imaginary);
    if (status == TC_OK && !(fabs(real + imaginary - q->hull_volume) <= 1e-9 * q->hull_volume))
        status = tc_fail(err, TC_E_MESH,
                         "real (%g) and imaginary (%g) volumes do not add up to the hull's (%g): cells overlap", real,
                         imaginary, q->hull_volume);
    return status;
}

tc_status tc_mesh_convexify(tc_mesh *m, const tc_boundary *b, double limit_s, int threads, const tc_log *log,
                            tc_error *err)
{
    if (m->report.unlinked_faces > 0)
        return tc_fail(err, TC_E_MESH, "some faces belong to three cells or lie between two cells on one side (%zu)",
                       m->report.unlinked_faces);
    filling q = {0};
    tc_mesh next = {0};
    size_t n_flat = 0;
    bool joined = false;
    tc_status status = ask(&q, m, b, limit_s, log, err);
    if (status == TC_OK)
        status = open_reply(&q, m->report.bounds, err);
    if (status == TC_OK) {
        joined = true;
        status = join(&next, &n_flat, m, &q, b, threads, err);
    }
    if (status == TC_OK)
        status = link_and_judge(&next, n_flat, &q, threads, err);
    if (joined) { /* keep the new arrays or the old ones */
        const tc_mesh *gone = status == TC_OK ? m : &next;
        free(gone->vertex);
        free(gone->scalar);
        free(gone->tet);
        free(gone->neighbour);
    }
    if (status == TC_OK) {
        *m = next;
        m->report.n_imaginary = m->n_imaginary;
        m->report.n_steiner = q.n_steiner;
    }
    tc_reply_finish(&q.reply);
    free(q.sent);
    return status;
}

/* Peeling takes a pass or two more over the picture where a ray enters the mesh seldom more than twice. The mean number
 * of entries over all rays that meet the hull is the boundary's area over the hull's (Cauchy 1832), here that of the
 * bounds. Blunt Fin (ratio 0.9): TetGen takes 110 ms for 13 438 faces, peeling 22 ms more for 512 x 512 pixels and 76
 * for nine times as many; a heat sink of 48 fins (ratio 10) has 9 layers, which take longer than filling it. */
bool tc_mesh_peel_is_sooner(const tc_mesh *m, const tc_boundary *b, size_t pixels)
{
    static const double folds = 1.5, faces = 4000, pixels_a_face = 200;
    if (pixels == 0 || !((double)b->n_face >= faces + (double)pixels / pixels_a_face))
        return false;
    double area = 0, e[3];
    for (int k = 0; k < 3; k++)
        e[k] = m->report.bounds[2 * k + 1] - m->report.bounds[2 * k];
    for (size_t f = 0; f < b->n_face; f++) {
        const double *x[3];
        double u[3], v[3];
        for (int i = 0; i < 3; i++)
            x[i] = m->vertex + 3 * (size_t)b->vertex[b->face[3 * f + (size_t)i]];
        for (int k = 0; k < 3; k++)
            u[k] = x[1][k] - x[0][k], v[k] = x[2][k] - x[0][k];
        area += 0.5 * hypot(hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2]), u[0] * v[1] - u[1] * v[0]);
    }
    return area <= folds * 2 * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0]);
}

void tc_mesh_strip(tc_mesh *m)
{
    for (size_t i = 0; i < 4 * m->n_tet; i++)
        if (m->neighbour[i] >= 0 && (size_t)m->neighbour[i] >= m->n_tet)
            m->neighbour[i] = -1;
    m->n_vertex -= m->report.n_steiner;
    m->n_imaginary = m->report.n_imaginary = m->report.n_steiner = 0;
}
