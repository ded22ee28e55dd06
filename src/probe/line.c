/* line.c: finds the cells that a line meets, and its part in each.
 *
 * Two rounds over the whole mesh choose the cells that can be met: one gives each vertex a byte, on which side of two
 * planes through the line it lies; the other leaves out the cells whose four bytes have a side in common. What is left,
 * some cells along the line, is judged exactly.
 *
 * Judging: corners are projected along the line, and a face is passed where the line's point lies within the projected
 * triangle, that is where its three edges turn the same way about it. Each turn is the sign of a 2 x 2 determinant,
 * exact (error-free products: Dekker 1971). A zero is decided as if the line were moved by (e, e^2), e -> 0
 * (Edelsbrunner and Muecke 1990), and where two corners fall on each other by their numbers: so all cells around an
 * edge or a vertex agree. A face's corners are always taken by ascending number, so that both of its cells find the
 * same depth, bit by bit. */
#include "probe/line.h"

#include "core/memory.h"
#include "core/parallel.h"
#include "core/vec.h"

#include <float.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

enum { VERTEX_CHUNK = 32768, TET_CHUNK = 65536, MOST_WORKERS = 256 };

/* Lengths are those of a mesh whose box is about 1 wide. Corners nearer to a plane than this lie on neither side: it
 * covers rounding, and lines moved aside. */
static const double BESIDE = 0x1p-30;
/* A depth that rounding may move by more than DOUBT is found on a line that is moved by ASIDE. */
static const double ROUNDING = 8e-16, DOUBT = 1e-8, ASIDE = 0x1p-40;

/* Parts that reach this little into each other do so by rounding. */
static const double REACH = 1e-12;

/* The line in the frame of the mesh: x = (vertex - center) * scale - base, then along u, v and d. */
typedef struct frame {
    const tc_mesh *mesh;
    double center[3], scale; /* a power of two: places keep all of their bits */
    double base[3];          /* the line's point nearest the middle: depths are counted from it */
    double u[3], v[3], d[3]; /* orthonormal */
    double start;            /* depth of the line's origin is -start */
} frame;

static void frame_init(frame *f, const tc_mesh *mesh, const double origin[3], const double direction[3])
{
    const double *b = mesh->report.bounds;
    double widest = 0, o[3];
    int exponent = 0, least = 0;
    f->mesh = mesh;
    for (int k = 0; k < 3; k++) {
        f->center[k] = 0.5 * b[2 * k] + 0.5 * b[2 * k + 1];
        widest = fmax(widest, 0.5 * b[2 * k + 1] - 0.5 * b[2 * k]);
    }
    if (widest > 0)
        frexp(widest, &exponent);
    f->scale = ldexp(1, -(exponent < -1000 ? -1000 : exponent) - 1);

    tc_vec_copy(f->d, direction);
    tc_vec_normalize(f->d);
    for (int k = 0; k < 3; k++) {
        o[k] = (origin[k] - f->center[k]) * f->scale;
        least = fabs(f->d[k]) < fabs(f->d[least]) ? k : least;
    }
    f->start = -tc_vec_dot(o, f->d);
    tc_vec_mul_add(f->base, o, f->start, f->d);
    const double axis[3] = {least == 0, least == 1, least == 2};
    tc_vec_cross(f->u, axis, f->d);
    tc_vec_normalize(f->u);
    tc_vec_cross(f->v, f->d, f->u);
}

/* ------------------------------------------------------------------------------------------ cells that may be met */

/* Tets that one thread found. */
typedef struct finds {
    uint32_t *tet;
    size_t n, room;
    char apart[64 - sizeof(void *) - 2 * sizeof(size_t)]; /* a cache line of one's own */
} finds;

typedef struct search {
    const frame *frame;
    uint8_t *side; /* [n_vertex] 1, 2: beyond, before the plane across u; 4, 8: v; 0: on both, or no place */
    finds found[MOST_WORKERS];
    atomic_bool memory_out;
} search;

static void tell_sides(void *context, size_t begin, size_t end, int worker)
{
    (void)worker;
    const search *j = context;
    const frame *f = j->frame;
    const double x0 = tc_vec_dot(f->base, f->u), y0 = tc_vec_dot(f->base, f->v), s = f->scale;
    for (size_t i = begin; i < end; i++) {
        const double *p = &f->mesh->vertex[3 * i];
        const double q[3] = {(p[0] - f->center[0]) * s, (p[1] - f->center[1]) * s, (p[2] - f->center[2]) * s};
        const double x = tc_vec_dot(q, f->u) - x0, y = tc_vec_dot(q, f->v) - y0;
        j->side[i] = (uint8_t)((x > BESIDE) | (x < -BESIDE) << 1 | (y > BESIDE) << 2 | (y < -BESIDE) << 3);
    }
}

static bool keep(finds *f, uint32_t tet)
{
    if (f->n == f->room) {
        const size_t room = f->room ? 2 * f->room : 1024;
        uint32_t *more = tc_realloc(f->tet, room, sizeof *more);
        if (!more)
            return false;
        f->tet = more, f->room = room;
    }
    f->tet[f->n++] = tet;
    return true;
}

static void choose(void *context, size_t begin, size_t end, int worker)
{
    search *j = context;
    const uint8_t *side = j->side;
    const int32_t *id = j->frame->mesh->tet + 4 * begin;
    for (size_t t = begin; t < end; t++, id += 4)
        if ((side[id[0]] & side[id[1]] & side[id[2]] & side[id[3]]) == 0 && !keep(&j->found[worker], (uint32_t)t)) {
            atomic_store(&j->memory_out, true);
            return;
        }
}

/* ---------------------------------------------------------------------------------------------------- one cell */

/* A corner seen along the line. */
typedef struct corner {
    double x, y, z, value;
} corner;

/* -1 or +1: how b is turned against a about the line; *area: twice the triangle's area, with that sign but for a tie.
 * a has the lesser number. */
static int turn(double *area, const corner *a, const corner *b)
{
    const double p = a->x * b->y, q = b->x * a->y;
    double decide = p - q; /* rounding keeps order: if it is not 0 its sign is right */
    if (decide == 0)
        decide = fma(a->x, b->y, -p) - fma(b->x, a->y, -q);
    *area = decide;
    if (decide == 0)
        decide = a->y - b->y;
    if (decide == 0)
        decide = b->x - a->x;
    return decide < 0 ? -1 : 1;
}

/* Mean of three values by weights, within them. */
static double mean(const double w[3], double sum, double a, double b, double c)
{
    const double m = sum > 0 ? (w[0] * a + w[1] * b + w[2] * c) / sum : (a + b + c) / 3;
    return fmin(fmax(m, fmin(fmin(a, b), c)), fmax(fmax(a, b), c));
}

/* Depth and scalar of the line's point in face a, b, c, corners by number, area those of ab, bc, ac. Gives by how much
 * rounding may have moved the depth; 0: by less than DOUBT. */
static double pass(double *t, double *s, const corner *a, const corner *b, const corner *c, const double area[3])
{
    const double w[3] = {fabs(area[1]), fabs(area[2]), fabs(area[0])}, sum = w[0] + w[1] + w[2];
    *t = mean(w, sum, a->z, b->z, c->z);
    *s = mean(w, sum, a->value, b->value, c->value);
    const double reach = fabs(a->x) + fabs(a->y) + fabs(b->x) + fabs(b->y) + fabs(c->x) + fabs(c->y);
    const double deep = fmax(fmax(a->z, b->z), c->z) - fmin(fmin(a->z, b->z), c->z);
    const double error = ROUNDING * reach * deep;
    return error < DOUBT * sum ? 0 : sum > 0 ? fmin(error / sum, deep) : deep;
}

/* The line's part in a tet, depths from the base; false: none. *doubt is raised to that of its depths. */
static bool meet(tc_line_part *out, double *doubt, const frame *f, uint32_t tet)
{
    static const int face[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
    const tc_mesh *m = f->mesh;
    int32_t id[4];
    corner p[4];
    bool finite = true;
    for (int i = 0; i < 4; i++) { /* ascending */
        int k = i;
        const int32_t next = m->tet[4 * (size_t)tet + (size_t)i];
        for (; k > 0 && id[k - 1] > next; k--)
            id[k] = id[k - 1];
        id[k] = next;
    }
    for (int i = 0; i < 4; i++) {
        const double *x = &m->vertex[3 * (size_t)id[i]];
        double q[3];
        for (int k = 0; k < 3; k++)
            q[k] = (x[k] - f->center[k]) * f->scale - f->base[k];
        p[i] = (corner){tc_vec_dot(q, f->u), tc_vec_dot(q, f->v), tc_vec_dot(q, f->d),
                        m->association == TC_CELL_DATA ? m->scalar[tet] : m->scalar[id[i]]};
        finite = finite && isfinite(p[i].value);
    }
    int way[4][4], n = 0;
    double area[4][4], t[4], s[4];
    for (int i = 0; i < 3; i++)
        for (int k = i + 1; k < 4; k++)
            way[i][k] = turn(&area[i][k], &p[i], &p[k]);
    for (int k = 0; k < 4; k++) {
        const int a = face[k][0], b = face[k][1], c = face[k][2];
        if (way[a][b] != way[b][c] || way[b][c] == way[a][c])
            continue;
        const double areas[3] = {area[a][b], area[b][c], area[a][c]};
        *doubt = fmax(*doubt, pass(&t[n], &s[n], &p[a], &p[b], &p[c], areas));
        n++;
    }
    if (n < 2) /* no cell has one or more than two */
        return false;
    const int first = t[1] < t[0];
    *out = (tc_line_part){{t[first], t[1 - first]}, {s[first], s[1 - first]}, t[1 - first] - t[first], tet};
    if (!finite)
        out->s[0] = out->s[1] = NAN;
    return out->t[0] < out->t[1];
}

/* ------------------------------------------------------------------------------------------------- all of them */

/* Gives the largest doubt of a depth. */
static double meet_all(tc_line_part *out, size_t *n, const frame *f, const uint32_t *tet, size_t n_tet)
{
    double doubt = 0;
    *n = 0;
    for (size_t i = 0; i < n_tet; i++)
        *n += meet(&out[*n], &doubt, f, tet[i]);
    return doubt;
}

/* Where faces that the line runs along make depths doubtful, the line beside it that has the least doubt. */
static void meet_surely(tc_line_part *out, size_t *n, const frame *f, const uint32_t *tet, size_t n_tet)
{
    double least = meet_all(out, n, f, tet, n_tet), last = least;
    frame best = *f, moved = *f;
    for (int k = 0; k < 4 && least > 0; k++) {
        const double angle = 1 + 2.4 * k, by = k < 2 ? ASIDE : 16 * ASIDE; /* no direction of a grid */
        tc_vec_mul_add(moved.base, f->base, by * cos(angle), f->u);
        tc_vec_mul_add(moved.base, moved.base, by * sin(angle), f->v);
        last = meet_all(out, n, &moved, tet, n_tet);
        if (last < least)
            least = last, best = moved;
    }
    if (last > least)
        meet_all(out, n, &best, tet, n_tet);
}

/* The scalar at t of a part of some length. */
static double scalar_at(const tc_line_part *p, double t)
{
    const double w = (t - p->t[0]) / (p->t[1] - p->t[0]);
    return w < 0.5 ? p->s[0] + w * (p->s[1] - p->s[0]) : p->s[1] + (1 - w) * (p->s[0] - p->s[1]);
}

/* From depths to distances from the origin, and what of the part lies within range; false: nothing. */
static bool bound(tc_line_part *part, const frame *f, const double range[2])
{
    const tc_line_part whole = *part;
    for (int k = 0; k < 2; k++) {
        const double depth = range[k] * f->scale - f->start; /* of the bound; may be infinite */
        const bool cut = k == 0 ? whole.t[0] < depth : whole.t[1] > depth;
        if (cut && (k == 0 ? depth >= whole.t[1] : depth <= whole.t[0]))
            return false;
        if (cut)
            part->t[k] = depth, part->s[k] = scalar_at(&whole, depth);
    }
    part->length = (part->t[1] - part->t[0]) / f->scale;
    for (int k = 0; k < 2; k++)
        part->t[k] = fmin(fmax((part->t[k] + f->start) / f->scale, range[0]), range[1]);
    return part->t[0] < part->t[1];
}

static int by_depth(const void *a, const void *b)
{
    const tc_line_part *p = a, *q = b;
    for (int k = 0; k < 2; k++)
        if (p->t[k] != q->t[k])
            return p->t[k] < q->t[k] ? -1 : 1;
    return p->tet < q->tet ? -1 : p->tet > q->tet;
}

/* Cells of no length whose ends rounding has exchanged reach back by as little: the others' depths hold. */
static size_t join(tc_line_part *part, size_t n, const frame *f)
{
    size_t kept = 0;
    for (size_t i = 0; i < n; i++) {
        tc_line_part p = part[i];
        if (kept > 0 && p.t[0] < part[kept - 1].t[1]) {
            const double end = part[kept - 1].t[1];
            if (end - p.t[0] <= REACH / f->scale + 4 * DBL_EPSILON * fabs(end))
                p.t[0] = end;
        }
        if (p.t[0] < p.t[1])
            part[kept++] = p;
    }
    return kept;
}

static tc_status find(uint32_t **tet, size_t *n, search *j, int threads)
{
    const tc_mesh *m = j->frame->mesh;
    j->side = tc_alloc(m->n_vertex, 1);
    if (!j->side)
        return TC_E_MEMORY;
    tc_parallel_for(m->n_vertex, VERTEX_CHUNK, threads, tell_sides, j);
    tc_parallel_for(m->n_tet, TET_CHUNK, threads, choose, j);
    *n = 0;
    for (int w = 0; w < MOST_WORKERS; w++)
        *n += j->found[w].n;
    *tet = tc_alloc(*n, sizeof **tet);
    if (!*tet || atomic_load(&j->memory_out))
        return TC_E_MEMORY;
    size_t at = 0;
    for (int w = 0; w < MOST_WORKERS; w++)
        for (size_t i = 0; i < j->found[w].n; i++)
            (*tet)[at++] = j->found[w].tet[i];
    return TC_OK;
}

tc_status tc_line_meet(tc_line_part **out, size_t *n, const tc_mesh *mesh, const double origin[3],
                       const double direction[3], const double range[2], int threads, tc_error *err)
{
    frame f;
    size_t n_tet = 0;
    uint32_t *tet = NULL;
    *out = NULL, *n = 0;
    frame_init(&f, mesh, origin, direction);
    if (tc_vec_length(f.base) > 1) /* the mesh lies within sqrt(3) / 2 of its middle */
        return TC_OK;
    search *j = tc_calloc(1, sizeof *j);
    tc_status status = TC_E_MEMORY;
    if (!j)
        goto done;
    j->frame = &f;
    status = find(&tet, &n_tet, j, threads);
    if (status != TC_OK || n_tet == 0)
        goto done;
    *out = tc_alloc(n_tet, sizeof **out);
    if (!*out) {
        status = TC_E_MEMORY;
        goto done;
    }
    size_t met, seen = 0;
    meet_surely(*out, &met, &f, tet, n_tet);
    for (size_t i = 0; i < met; i++) {
        tc_line_part part = (*out)[i];
        if (bound(&part, &f, range))
            (*out)[seen++] = part;
    }
    qsort(*out, seen, sizeof **out, by_depth);
    *n = join(*out, seen, &f);
done:
    for (int w = 0; j && w < MOST_WORKERS; w++)
        free(j->found[w].tet);
    free(j ? j->side : NULL);
    free(j);
    free(tet);
    if (status != TC_OK || *n == 0) {
        free(*out);
        *out = NULL;
    }
    return status == TC_OK ? TC_OK : tc_fail_memory(err, "the cells along a ray", mesh->n_vertex, 1);
}
