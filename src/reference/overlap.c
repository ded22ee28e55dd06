/* overlap.c: the order in which a ray sees cells that overlap: run by run, in the order of entry.
 *
 * Where cells do not overlap, the order of their entries is the order in space. Where they do there is none, and one is
 * defined: cells that the ray passes one after the other through common faces are a run; runs are seen whole, in the
 * order of their first entries. It is what a caster sees that walks from cell to cell and enters again where it left
 * the mesh (tetcast's peeling), but it is found here from the vertex ids of the faces that the ray passes, ray by ray.
 * A face joins two cells when no third one on the ray has it and the ray leaves one where it enters the other; faces of
 * three cells and of two cells on one side join nothing. Where a ray that runs along an edge or in a face's plane
 * passes a cell without length, depths do not tell which of its two faces it enters by: the sign of the cell's volume
 * does. */
#include "reference/trace.h"

#include "core/memory.h"
#include "mesh/predicate.h"

#include <stdlib.h>
#include <string.h>

/* Cells that reach this little into each other (scaled unit) do so by rounding. */
static const double REACH = 1e-12;

bool tc_hits_overlap(const tc_hit *hit, size_t n)
{
    for (size_t i = 1; i < n; i++)
        if (hit[i].t0 < hit[i - 1].t1 - REACH)
            return true;
    return false;
}

/* One face that the ray passes, as seen from one cell. */
typedef struct pass {
    int32_t id[3]; /* ascending */
    uint32_t end;  /* 2 * hit + 1 where the ray leaves the cell here */
} pass;

typedef struct run {
    double t;       /* of its entry, moved by what the judge wants */
    uint32_t tet;   /* its first cell */
    uint32_t start; /* 2 * hit + its open end */
} run;

static int pass_compare(const void *a, const void *b)
{
    const pass *p = a, *q = b;
    for (int i = 0; i < 3; i++)
        if (p->id[i] != q->id[i])
            return p->id[i] < q->id[i] ? -1 : 1;
    return p->end < q->end ? -1 : p->end > q->end;
}

static int run_compare(const void *a, const void *b)
{
    const run *p = a, *q = b;
    if (p->t != q->t)
        return p->t < q->t ? -1 : 1;
    return p->tet < q->tet ? -1 : p->tet > q->tet;
}

static int tet_compare(const void *a, const void *b)
{
    const run *p = a, *q = b;
    return p->tet < q->tet ? -1 : p->tet > q->tet;
}

/* Makes `in` the face by which the ray enters the cell, and finds whether there is such a face. The corners of the face
 * opposite corner k run counter-clockwise around the ray, and corner k lies beyond it, or neither: entry. */
static void direct(tc_hit *hit, const int32_t *id, const double *vertex)
{
    int sign = tc_orient3d(vertex + 3 * (size_t)id[0], vertex + 3 * (size_t)id[1], vertex + 3 * (size_t)id[2],
                           vertex + 3 * (size_t)id[3]);
    hit->flat = sign == 0;
    bool beyond = hit->in % 2 ? sign > 0 : sign < 0; /* the parity of (the face's corners, k) */
    if (sign != 0 && hit->left != beyond) {
        uint8_t in = hit->in;
        hit->in = hit->out, hit->out = in;
    }
}

/* Both ends of hit number i; the hit gets its direction. */
static void name_passes(pass *out, const tc_reference *reference, tc_hit *hit, size_t i)
{
    const int32_t *id = reference->mesh->tet + 4 * (size_t)hit[i].tet;
    int32_t sorted[4] = {id[0], id[1], id[2], id[3]};
    for (int k = 1; k < 4; k++)
        for (int j = k; j > 0 && sorted[j] < sorted[j - 1]; j--) {
            int32_t t = sorted[j];
            sorted[j] = sorted[j - 1], sorted[j - 1] = t;
        }
    direct(&hit[i], sorted, reference->mesh->vertex);
    for (int end = 0; end < 2; end++) {
        int dropped = end ? hit[i].out : hit[i].in, n = 0;
        for (int k = 0; k < 4; k++)
            if (k != dropped)
                out[end].id[n++] = sorted[k];
        out[end].end = (uint32_t)(2 * i) + (uint32_t)end;
    }
}

/* Cells of no volume fit both ways; what they join must not turn the ray back: cut before them. */
static void cut_where_it_turns(uint32_t *link, const tc_hit *hit, size_t n)
{
    for (uint32_t end = 0; end < 2 * n; end++) {
        if (hit[end / 2].flat || link[end] == UINT32_MAX || !hit[link[end] / 2].flat)
            continue;
        uint32_t at = link[end];
        while (at != UINT32_MAX && hit[at / 2].flat)
            at = link[at ^ 1u];
        if (at != UINT32_MAX && at % 2 == end % 2) {
            link[link[end]] = UINT32_MAX;
            link[end] = UINT32_MAX;
        }
    }
}

/* link [2 n]: the end of another cell that each end of a cell is joined to; UINT32_MAX: none. */
static void join(uint32_t *link, pass *p, const tc_hit *hit, size_t n)
{
    memset(link, 0xff, 2 * n * sizeof *link);
    qsort(p, 2 * n, sizeof *p, pass_compare);
    for (size_t i = 0, j; i < 2 * n; i = j) {
        for (j = i + 1; j < 2 * n && memcmp(p[i].id, p[j].id, sizeof p->id) == 0; j++) {
        }
        if (j - i != 2)
            continue;
        uint32_t a = p[i].end, b = p[i + 1].end;
        const tc_hit *g = &hit[a / 2], *h = &hit[b / 2];
        bool across = a % 2 != b % 2 || g->flat || h->flat;
        if (a / 2 != b / 2 && across)
            link[a] = b, link[b] = a;
    }
    cut_where_it_turns(link, hit, n);
}

/* A number in [-1, 1] for a cell: how far, and to which side, the judge moves a run that begins in it. */
static double sway(uint32_t tet)
{
    uint32_t h = (tet + 1) * 0x9e3779b9u;
    h = (h ^ h >> 15) * 0x85ebca6bu;
    h ^= h >> 13;
    return (double)h / 2147483647.5 - 1;
}

static double end_depth(const tc_hit *hit, uint32_t end)
{
    return end % 2 ? hit[end / 2].t1 : hit[end / 2].t0;
}

/* Does one walk with the ray from the open end `start`? Of a run that is flat throughout, one end says yes. */
static bool is_entry(const uint32_t *link, const tc_hit *hit, uint32_t start)
{
    for (uint32_t at = start;;) {
        if (!hit[at / 2].flat)
            return at % 2 == 0;
        if (link[at ^ 1u] == UINT32_MAX)
            return start <= (at ^ 1u);
        at = link[at ^ 1u];
    }
}

bool tc_hits_order(tc_hit *hit, size_t n, const tc_reference *reference, double unsure)
{
    bool good = false;
    size_t n_run = 0, m = 0;
    pass *p = tc_alloc(2 * n, sizeof *p);
    uint32_t *link = tc_alloc(2 * n, sizeof *link);
    run *r = tc_alloc(n, sizeof *r);
    tc_hit *ordered = tc_alloc(n, sizeof *ordered);
    if (!p || !link || !r || !ordered || n > INT32_MAX)
        goto done;
    for (size_t i = 0; i < n; i++)
        name_passes(&p[2 * i], reference, hit, i);
    join(link, p, hit, n);
    for (uint32_t end = 0; end < 2 * n; end++) {
        if (link[end] != UINT32_MAX || !is_entry(link, hit, end))
            continue;
        uint32_t tet = hit[end / 2].tet;
        r[n_run++] = (run){end_depth(hit, end) + unsure * sway(tet), tet, end};
    }
    qsort(r, n_run, sizeof *r, run_compare);
    for (size_t i = 0, j; i < n_run;
         i = j) { /* boundaries at one place: rounding tells nothing, the cell's number does */
        for (j = i + 1; j < n_run && r[j].t < r[j - 1].t + REACH; j++) {
        }
        qsort(r + i, j - i, sizeof *r, tet_compare);
    }
    for (size_t i = 0; i < n_run; i++)
        for (uint32_t at = r[i].start;;) {
            ordered[m++] = hit[at / 2];
            at = link[at ^ 1u];
            if (at == UINT32_MAX)
                break;
        }
    memcpy(hit, ordered, m * sizeof *hit);
    for (size_t i = m; i < n; i++)
        hit[i].t1 = hit[i].t0; /* in a ring: depth grows along a run, so a ring has no length but by rounding */
    good = true;
done:
    free(p);
    free(link);
    free(r);
    free(ordered);
    return good;
}
