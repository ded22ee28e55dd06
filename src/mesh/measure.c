/* measure.c: what the report says about size and values. */
#include "core/memory.h"
#include "core/parallel.h"
#include "core/vec.h"
#include "mesh/mesh.h"

#include <math.h>
#include <stdlib.h>

void tc_mesh_measure_scalar(tc_mesh *m)
{
    /* Steiner points come last and carry no value */
    size_t n = m->association == TC_CELL_DATA ? m->n_tet : m->n_vertex - m->report.n_steiner, bad = 0;
    double lo = INFINITY, hi = -INFINITY;
    for (size_t i = 0; i < n; i++) {
        double s = m->scalar[i];
        if (!isfinite(s)) {
            bad++;
            continue;
        }
        lo = s < lo ? s : lo;
        hi = s > hi ? s : hi;
    }
    m->report.association = m->association;
    m->report.nonfinite_scalars = bad;
    m->report.scalar_range[0] = lo <= hi ? lo : 0;
    m->report.scalar_range[1] = lo <= hi ? hi : 0;
}

enum { CHUNK = 4096 };

typedef struct sums {
    const double *vertex;
    const int32_t *tet;
    double (*part)[2]; /* of each chunk: longest edge, volume */
} sums;

static void measure_range(void *context, size_t begin, size_t end, int worker)
{
    static const uint8_t pair[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    (void)worker;
    sums *j = context;
    double longest = 0, volume = 0;
    for (size_t t = begin; t < end; t++) {
        const double *p[4];
        double u[3], v[3], w[3], c[3];
        for (int i = 0; i < 4; i++)
            p[i] = j->vertex + 3 * (size_t)j->tet[4 * t + (size_t)i];
        for (int e = 0; e < 6; e++) {
            tc_vec_sub(u, p[pair[e][1]], p[pair[e][0]]);
            double l = hypot(hypot(u[0], u[1]), u[2]);
            longest = l > longest && isfinite(l) ? l : longest;
        }
        tc_vec_sub(u, p[1], p[0]);
        tc_vec_sub(v, p[2], p[0]);
        tc_vec_sub(w, p[3], p[0]);
        tc_vec_cross(c, u, v);
        double six = fabs(tc_vec_dot(c, w));
        volume += isfinite(six) ? six / 6 : 0;
    }
    j->part[begin / CHUNK][0] = longest;
    j->part[begin / CHUNK][1] = volume;
}

void tc_mesh_measure(tc_mesh *m, int threads)
{
    tc_mesh_report *r = &m->report;
    bool any = false;
    for (int k = 0; k < 6; k++)
        r->bounds[k] = 0;
    for (size_t v = 0; v < m->n_vertex - r->n_steiner; v++) {
        const double *p = m->vertex + 3 * v;
        if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]))
            continue;
        for (int k = 0; k < 3; k++) {
            r->bounds[2 * k] = any && r->bounds[2 * k] < p[k] ? r->bounds[2 * k] : p[k];
            r->bounds[2 * k + 1] = any && r->bounds[2 * k + 1] > p[k] ? r->bounds[2 * k + 1] : p[k];
        }
        any = true;
    }
    size_t n_part = (m->n_tet + CHUNK - 1) / CHUNK;
    sums j = {.vertex = m->vertex, .tet = m->tet, .part = tc_calloc(n_part, sizeof *j.part)};
    r->longest_edge = r->volume = 0;
    double one[2], (*own)[2] = j.part;
    if (own) {
        tc_parallel_for(m->n_tet, CHUNK, threads, measure_range, &j);
    }
    for (size_t i = 0; i < n_part; i++) {
        const double *part = own ? own[i] : one;
        if (!own) { /* no memory for the parts: one after another */
            sums k = {.vertex = m->vertex, .tet = m->tet + 4 * i * CHUNK, .part = &one};
            size_t left = m->n_tet - i * CHUNK;
            measure_range(&k, 0, left < CHUNK ? left : CHUNK, 0);
        }
        r->longest_edge = part[0] > r->longest_edge ? part[0] : r->longest_edge;
        r->volume += part[1];
    }
    free(own);
}
